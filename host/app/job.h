/* A scene that is loaded, built and traced on a device: what `render` and `trace` share. */
#ifndef APP_JOB_H
#define APP_JOB_H

#include "app/cli.h"

enum job_stats { JOB_STATS_NONE, JOB_STATS_TEXT, JOB_STATS_JSON };

struct job {
    const char *scene_path;
    const char *device_name; /* NULL: auto */
    double time_s, fps;
    bool has_time, has_frame;
    uint32_t frame;
    whit_build build;
    uint32_t bins, threads, texture_limit;
    const char *load_path; /* NULL: auto */
    bool validation, quiet;
    double time_limit_s;
    uint32_t stats; /* enum job_stats */

    whit_scene *scene;
    whit_accel *accel;
    whit_device *device;
    double start_ms, load_ms, accel_ms, device_ms;
};

enum job_id {
    JOB_DEVICE = 256,
    JOB_TIME,
    JOB_FRAME,
    JOB_FPS,
    JOB_BUILD,
    JOB_THREADS,
    JOB_TEXTURE_LIMIT,
    JOB_LOAD_PATH,
    JOB_VALIDATION,
    JOB_TIME_LIMIT,
    JOB_STATS,
    JOB_ID_END,
};

/* Rows of a command's table of options. */
#define JOB_OPTION_TIME                                                                            \
    {JOB_TIME, "time", "T", "seconds of the animation (0)"},                                       \
        {JOB_FRAME, "frame", "N", "instead of --time: frame N of the animation"},                  \
    {                                                                                              \
        JOB_FPS, "fps", "F", "frames in a second, for --frame (24)"                                \
    }
#define JOB_OPTION_DEVICE                                                                          \
    {                                                                                              \
        JOB_DEVICE, "device", "auto|N|NAME", "Vulkan device; see `whit devices` (auto)"            \
    }
#define JOB_OPTION_TREES                                                                           \
    {JOB_BUILD, "build", "binned[:K]|median", "how trees are built; K bins, 2 to 256 (binned)"},   \
        {JOB_LOAD_PATH, "load-path", "auto|storage|texel", "how kernels read the trees (auto)"},   \
    {                                                                                              \
        JOB_THREADS, "threads", "N", "threads that build trees (0: one a core)"                    \
    }
#define JOB_OPTION_TEXTURES                                                                        \
    {                                                                                              \
        JOB_TEXTURE_LIMIT, "texture-limit", "N", "halve textures with a longer side (4096)"        \
    }
#define JOB_OPTION_RUN                                                                             \
    {JOB_STATS, "stats", "text|json", "print times, rays and figures of the trees"},               \
        {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5"},          \
        {JOB_VALIDATION, "validation", NULL, "run with the Vulkan validation layers"},             \
    {                                                                                              \
        'q', "quiet", NULL, "no notes, no progress, only errors"                                   \
    }

void job_init(struct job *job);
/* False when `id` is not one of the shared options. */
bool job_option(struct job *job, struct cli_reader *reader, int id);
/* Checks options against each other, and starts the clock of --time-limit. */
bool job_options_done(struct job *job, struct cli_reader *reader);

/* Each step before the next one. Failures were said. */
whit_result job_load(struct job *job);
whit_result job_build(struct job *job);
whit_result job_open_device(struct job *job);
/* Of the scene: warnings, and with `all` what was added as well. */
void job_print_notes(const struct job *job, bool all);
/* EXIT_DIFFERS when the validation layers had anything to say. */
int job_check_validation(const struct job *job);
void job_finish(struct job *job);

#endif
