/* The subcommands, and the pieces of `render` that stand alone. */
#ifndef APP_COMMANDS_H
#define APP_COMMANDS_H

#include "app/document.h"
#include "app/job.h"
#include "app/render/cameras.h"
#include "app/render/frames.h"
#include "app/render/layers.h"
#include "app/render/part.h"
#include "app/render/refine.h"
#include "app/render/repeat.h"
#include "app/render/resume.h"
#include "app/render/view_image.h"

extern const struct cli_command command_render, command_scene, command_trace, command_bvh,
    command_devices, command_bench, command_hard, command_compare, command_cost, command_view,
    command_probe, command_shader, command_check, command_merge, command_batch;

/* The options of `whit render` itself; those of the picture are in the job's settings. */
struct render_request {
    const char *output, *ids; /* ids: NULL when not given */
    bool counters;            /* costs in --stats */
    bool fresh;               /* for a choice what is kept with the scene is measured anew */
    struct refine_goal refine;
    struct repeat repeat;
    struct frames frames; /* with them `output` and `ids` are patterns */
    struct cameras cameras;
    struct part part;
    bool resume;        /* what is finished is kept */
    bool many;          /* one of many pictures by one device */
    bool keep_unread;   /* what no function of the shader reads is to be seen */
    bool scene_stays;   /* whole, for another renderer */
    bool leaves;        /* with `resume`: a picture that another process draws is not waited for */
    uint32_t thumbnail; /* pixels on a side, of a PNG whatever its name; 0: none */
};

/* Makes the kernels of a picture and prints them (kernels.c). Gives the exit code. */
int kernels_run(struct job *job, bool json);

/* Adds to an object what decides the pixels of a picture, by those rows of the table of settings
   that a command takes (settings_json.c). */
void settings_describe(const struct settings *settings, enum settings_command command,
                       json_t *object);

/* From the scene to a renderer on a device; what the job has already is taken as it is, and a
   renderer that is there, of the same kernels, becomes one of this picture. Failures were said
   (render_command.c). */
WHIT_CHECK whit_result render_prepare(struct job *job, const struct render_request *request,
                                      struct frames_progress *progress, whit_renderer **renderer);

/* Reads what `whit render` is told: reader->status is < 0 where there is work to do
   (render_command.c). */
bool render_read(struct job *job, struct cli_reader *reader, struct render_request *request,
                 int argc, char **argv);
/* Draws and saves what `request` says, and tells of it; gives the exit code. `sequence`: zeroed,
   for sequence_finish (render_command.c). */
int render_draw(struct job *job, const struct render_request *request, whit_renderer *renderer,
                struct frames_progress *progress, struct sequence *sequence);

/* Whether the job's scene has its camera, before trees are built; else says what there is
   (render_command.c). */
WHIT_CHECK whit_result render_check_camera(const struct job *job);

/* A renderer of what `request` says (render_command.c). */
WHIT_CHECK whit_result render_create(const struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

/* Settings for budget_ms or max_error, by figures of `whit cost`, which are measured when none are
   kept; says which, and makes their renderer (cost_choice.c). What is within budget_ms is tried
   before, for the device may be slower at this moment. The device is open.
   WHIT_ERROR_FAILED: none does it. The renderer is the caller's, also after a failure. */
WHIT_CHECK whit_result render_choose(struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

/* Saves what `request` names of the picture just rendered (render_command.c). `color`: its colours
   where they are not the renderer's, else NULL; what is drawn over is drawn into it. `layers`: the
   shader's functions beside them, those of the renderer where `color` is NULL. */
whit_result render_save(const struct job *job, const struct render_request *request,
                        whit_renderer *renderer, whit_image *color, struct layers *layers,
                        const whit_stats *stats);

/* The texts that a picture carries about itself: only what decides its pixels, so that the same
   inputs give the same bytes. */
enum { RECIPE_TEXTS = 11 };
struct recipe {
    whit_text texts[RECIPE_TEXTS];
    uint32_t count;
    char *command, *options, *counters, *view, *part, *camera, *scene, *name, *driver,
        *functions; /* owned */
    char hash[17];
    whit_device_info device;
};

/* False when memory ran out, which was said. `shader`: NULL without one. `output`: whose ending
   says what is saved. */
bool recipe_init(struct recipe *recipe, const struct settings *settings, const whit_scene *scene,
                 const whit_shader *shader, const whit_device_info *device, const whit_stats *stats,
                 const char *output);
/* Adds what a picture of costs shows; false as above. */
bool recipe_add_view(struct recipe *recipe, const struct settings *settings,
                     const struct view_figures *figures);
/* Adds which part of a picture it is; false as above. */
bool recipe_add_part(struct recipe *recipe, const struct part *part,
                     const struct settings *settings);
/* How many rays of each kind there were, as an object. */
json_t *recipe_rays(const whit_stats *stats);
/* whit:counters of these numbers; free() it. NULL: memory ran out. */
char *recipe_counters(const whit_stats *stats);
void recipe_finish(struct recipe *recipe);

/* The device's driver without the name of the device in front. */
const char *stats_driver(const whit_device_info *device);

/* --stats of `whit render`: on standard output. `sequence`: with --frames, else NULL; `refined`:
   with --refine, else NULL. */
int stats_print(const struct job *job, const struct render_request *request,
                const whit_renderer *renderer, const whit_stats *stats, double save_ms,
                const struct sequence *sequence, const struct refined *refined);

#endif
