/* The subcommands, and the pieces of `render` that stand alone. */
#ifndef APP_COMMANDS_H
#define APP_COMMANDS_H

#include "app/frames.h"
#include "app/job.h"
#include "app/picture.h"
#include "app/view_image.h"

extern const struct cli_command command_render, command_scene, command_trace, command_bvh,
    command_devices, command_bench, command_hard, command_compare;

/* What `whit render` was asked for beside the job. */
struct render_request {
    const char *output, *ids; /* ids: NULL when not given */
    struct picture picture;
    double bailout; /* 0: every ray is traced */
    uint32_t light_samples, tile_size;
    bool no_shadows, opaque_shadows, schlick;
    const char *effects;   /* NULL: auto */
    struct cost_view view; /* instead of colours */
    bool counters;         /* costs in --stats */
    struct frames frames;  /* with them `output` and `ids` are patterns */
};

/* Saves what `request` names of the picture just rendered (render_command.c). */
whit_result render_save(const struct job *job, const struct render_request *request,
                        whit_renderer *renderer, const whit_stats *stats);

/* --effects of the current option; on nonsense misuse, and false. */
bool effects_check(struct cli_reader *reader, const char *text);

/* What a picture says about itself: only what decides its pixels, so that the same inputs give the
   same bytes. */
enum { RECIPE_TEXTS = 9 };
struct recipe {
    whit_text texts[RECIPE_TEXTS];
    uint32_t count;
    char *command, *options, *counters, *view; /* owned */
    char hash[17];
    whit_device_info device;
};

/* False when memory ran out, which was said. */
bool recipe_init(struct recipe *recipe, const struct job *job, const struct render_request *request,
                 const whit_stats *stats);
/* Adds what a picture of costs shows; false as above. */
bool recipe_add_view(struct recipe *recipe, const struct cost_view *view,
                     const struct view_figures *figures);
void recipe_finish(struct recipe *recipe);

/* The device's driver without the name of the device in front. */
const char *stats_driver(const whit_device_info *device);

/* --stats of `whit render`: on standard output. `sequence`: with --frames, else NULL. */
int stats_print(const struct job *job, const struct render_request *request,
                const whit_renderer *renderer, const whit_stats *stats, double save_ms,
                const struct sequence *sequence);

#endif
