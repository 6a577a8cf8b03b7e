/* A scene that is loaded, built and traced on a device: what `render` and `trace` share. */
#ifndef APP_JOB_H
#define APP_JOB_H

#include "app/cli.h"
#include "settings/values.h"

enum job_stats { JOB_STATS_NONE, JOB_STATS_TEXT, JOB_STATS_JSON };
extern const struct setting_value job_stats_values[];

/* A builder as --build names it (builder.c); the zeroed one is the default. */
struct job_build {
    whit_build build;
    bool optimize;
    uint32_t bins;       /* WHIT_BUILD_BINNED; 0: not given */
    float alpha, budget; /* WHIT_BUILD_SPATIAL, as in whit_accel_params; 0: not given */
};
enum { JOB_BUILD_NAME = 96 };
/* One builder, of the current option; on nonsense misuse, and false. */
bool job_read_build(struct cli_reader *reader, const char *text, struct job_build *out);
/* What reads back as `build`; without a tree it is `none`. */
void job_build_name(const struct job_build *build, char name[JOB_BUILD_NAME]);

enum { JOB_ALLOWED_MOST = 8 };

struct job {
    const char *scene_path;
    const char *device_name; /* NULL: auto */
    double time_s, fps;
    bool has_time, has_frame;
    uint32_t frame;
    struct job_build build;
    bool has_build, no_trees, instance_refit;
    whit_instances instances;
    whit_build instance_build;
    uint32_t leaf_limit; /* 0: the default */
    whit_traversal traversal;
    whit_numerics numerics;
    uint32_t threads, texture_limit;
    uint64_t memory_limit;
    const char *load_path; /* NULL: auto */
    const char *allowed[JOB_ALLOWED_MOST];
    uint32_t allowed_count;
    double import_limit_s; /* 0: the default */
    bool require_sandbox;
    bool validation, quiet, no_cache;
    double time_limit_s;
    uint32_t stats; /* enum job_stats */

    whit_scene *scene;
    whit_accel *accel;
    whit_device *device;
    whit_device_opening *opening;
    double start_ms, load_ms, accel_ms, device_ms; /* of the device: that the program waited */
};

enum job_id {
    JOB_DEVICE = 256,
    JOB_NO_CACHE,
    JOB_TIME,
    JOB_FRAME,
    JOB_FPS,
    JOB_BUILD,
    JOB_NO_TREES,
    JOB_LEAF,
    JOB_TRAVERSAL,
    JOB_NUMERICS,
    JOB_INSTANCES,
    JOB_INSTANCE_BUILD,
    JOB_INSTANCE_UPDATE,
    JOB_THREADS,
    JOB_TEXTURE_LIMIT,
    JOB_ALLOW_PATH,
    JOB_IMPORT_LIMIT,
    JOB_REQUIRE_SANDBOX,
    JOB_MEMORY_LIMIT,
    JOB_LOAD_PATH,
    JOB_VALIDATION,
    JOB_TIME_LIMIT,
    JOB_STATS,
    JOB_ID_END,
};

/* Rows of a command's table of options. */
#define JOB_OPTION_TIME                                                                            \
    {JOB_TIME, "time", "T", "seconds of the animation (0)", NULL},                                 \
        {JOB_FRAME, "frame", "N", "instead of --time: frame N of the animation", NULL},            \
    {                                                                                              \
        JOB_FPS, "fps", "F", "frames in a second, for --frame (24)", NULL                          \
    }
#define JOB_NO_CACHE_HELP "keep nothing for the next run, and use nothing that was kept"
#define JOB_OPTION_DEVICE                                                                          \
    {JOB_DEVICE, "device", "auto|N|NAME", "Vulkan device; see `whit devices` (auto)", NULL},       \
    {                                                                                              \
        JOB_NO_CACHE, "no-cache", NULL, JOB_NO_CACHE_HELP, NULL                                    \
    }
/* How trees are built and walked. A command that has its own --build takes JOB_OPTION_BUILDING
   and JOB_OPTION_WALKING alone. */
#define JOB_OPTION_INSTANCES                                                                       \
    {                                                                                              \
        JOB_INSTANCES, "instances", NULL,                                                          \
            "off: one tree over the triangles of all instances, placed\n"                          \
            "in the world; auto: where nothing moves and no mesh but a\n"                          \
            "single ball is there twice (auto)",                                                   \
            values_instances                                                                       \
    }
#define JOB_OPTION_BUILDING                                                                        \
    {JOB_LEAF, "leaf", "N", "most triangles in a leaf, 1 to 15 (4)", NULL}, JOB_OPTION_INSTANCES,  \
        {JOB_INSTANCE_BUILD, "instance-build", NULL, "how the tree over instances is built (sah)", \
         values_instance_build},                                                                   \
    {                                                                                              \
        JOB_INSTANCE_UPDATE, "instance-update", NULL,                                              \
            "for another time: a new tree over instances, or new\n"                                \
            "boxes for the old one (rebuild)",                                                     \
            values_instance_update                                                                 \
    }
#define JOB_OPTION_WALKING                                                                         \
    {JOB_TRAVERSAL, "traversal", NULL,                                                             \
     "which of two nodes comes first: the nearer, by the ray's\n"                                  \
     "sign, as they come (distance)",                                                              \
     values_traversal},                                                                            \
        {JOB_NUMERICS, "numerics", NULL,                                                           \
         "what decides hits: quick tests that leak, tests that do\n"                               \
         "not, exact arithmetic (watertight)",                                                     \
         values_numerics},                                                                         \
    {                                                                                              \
        JOB_LOAD_PATH, "load-path", NULL, "how kernels read the trees (auto)", values_load_path    \
    }
#define JOB_OPTION_BUILD                                                                           \
    {JOB_BUILD, "build", "BUILDER[+opt]",                                                          \
     "how trees are built: binned[:K] with 2 to 256 bins,\n"                                       \
     "median, sweep, spatial[:ALPHA[,BUDGET]];\n"                                                  \
     "+opt improves them by reinsertion (binned)",                                                 \
     values_build},                                                                                \
    {                                                                                              \
        JOB_NO_TREES, "no-bvh", NULL, "no trees: rays test every triangle", NULL                   \
    }
#define JOB_OPTION_TREES                                                                           \
    JOB_OPTION_BUILD, {CLI_GONE, "tree", NULL, "is gone: trees are built for each run", NULL},     \
        JOB_OPTION_BUILDING, JOB_OPTION_WALKING,                                                   \
    {                                                                                              \
        JOB_THREADS, "threads", "N", "threads that build trees (0: one a core)", NULL              \
    }
/* What code that reads foreign files may do. */
#define JOB_OPTION_DECODING                                                                        \
    {JOB_IMPORT_LIMIT, "import-limit", "S",                                                        \
     "seconds of the processor for each file that foreign code\n"                                  \
     "reads (by its size, 8 to 60); ten times that by the clock",                                  \
     NULL},                                                                                        \
    {                                                                                              \
        JOB_REQUIRE_SANDBOX, "require-sandbox", NULL,                                              \
            "fail where such code cannot be locked in, in place of a\n"                            \
            "warning",                                                                             \
            NULL                                                                                   \
    }
/* And what these files may ask for. */
#define JOB_OPTION_FOREIGN                                                                         \
    {JOB_ALLOW_PATH, "allow-path", "FOLDER",                                                       \
     "files of the scene may name files below FOLDER too, not\n"                                   \
     "only below the scene's own; may be given again",                                             \
     NULL},                                                                                        \
        {JOB_MEMORY_LIMIT, "memory-limit", "SIZE",                                                 \
         "refuse a scene that takes more on host and device, in bytes\n"                           \
         "or with K, M, G (half of the machine's)",                                                \
         NULL},                                                                                    \
        JOB_OPTION_DECODING
#define JOB_OPTION_LOADING                                                                         \
    {JOB_TEXTURE_LIMIT, "texture-limit", "N", "halve textures with a longer side (4096)", NULL},   \
        JOB_OPTION_FOREIGN
#define JOB_OPTION_RUN                                                                             \
    {JOB_STATS, "stats", NULL, "print times, rays and figures of the trees", job_stats_values},    \
        {JOB_TIME_LIMIT, "time-limit", "S", "give up after S seconds, with exit code 5", NULL},    \
        {JOB_VALIDATION, "validation", NULL, "run with the Vulkan validation layers", NULL},       \
    {                                                                                              \
        'q', "quiet", NULL, "no notes, no progress, only errors", NULL                             \
    }

void job_init(struct job *job);
/* False when `id` is not one of the shared options. */
bool job_option(struct job *job, struct cli_reader *reader, int id);
/* Checks options against each other, prepares the caches unless they come from a file, and starts
   the clock of --time-limit. */
bool job_options_done(struct job *job, struct cli_reader *reader);

/* Starts to open the device in a thread, for job_open_device to wait for; what fails is said
   there, and nowhere if the program ends before. */
void job_begin_device(struct job *job);
/* Each step before the next one. Failures were said. */
whit_result job_load(struct job *job);
/* What job_load loads by. */
whit_load_params job_load_params(const struct job *job);
whit_result job_build(struct job *job);
/* What job_build asks for. */
whit_accel_params job_accel_params(const struct job *job);
whit_result job_open_device(struct job *job);
/* Whether nobody has stopped the program, and its time limit has not passed. */
whit_result job_still_wanted(void);
/* Of the scene: warnings, and with `all` what was added as well. */
void job_print_notes(const struct job *job, bool all);
/* EXIT_DIFFERS when the validation layers had anything to say. */
int job_check_validation(const struct job *job);
void job_finish(struct job *job);

#endif
