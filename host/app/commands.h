/* The subcommands, and the pieces of `render` that stand alone. */
#ifndef APP_COMMANDS_H
#define APP_COMMANDS_H

#include "app/frames.h"
#include "app/job.h"
#include "app/picture.h"
#include "app/view_image.h"

extern const struct cli_command command_render, command_scene, command_trace, command_bvh,
    command_devices, command_bench, command_hard, command_compare, command_cost, command_view,
    command_probe;

/* What `whit render` was asked for beside the job. */
struct render_request {
    const char *output, *ids; /* ids: NULL when not given */
    struct picture picture;
    double bailout; /* 0: every ray is traced */
    uint32_t light_samples, tile_size, segments;
    whit_packets packets;
    whit_classes classes;
    whit_shadows shadows;
    bool schlick;
    const char *effects; /* NULL: auto */
    /* 0: not asked for; else settings are chosen (cost_choice.c), none may be given. */
    double budget_ms, max_error;
    bool has_shading;         /* some were given */
    char chosen_effects[256]; /* that `effects` may point to */
    struct cost_view view;    /* instead of colours */
    bool counters;            /* costs in --stats */
    struct frames frames;     /* with them `output` and `ids` are patterns */
};

/* Makes the kernels of a picture and prints them (kernels.c). Gives the exit code. */
int kernels_run(struct job *job, const struct picture *picture, bool json);

/* ---- Options of pictures: what `render` and `view` share (picture.c) ---- */

enum { PICTURE_DEPTH_MOST = 255 };
enum picture_id {
    PICTURE_SIZE = JOB_ID_END,
    PICTURE_CAMERA,
    PICTURE_AA,
    PICTURE_DEPTH,
    PICTURE_BAILOUT,
    PICTURE_NO_SHADOWS,
    PICTURE_OPAQUE_SHADOWS,
    PICTURE_LIGHT_SAMPLES,
    PICTURE_FRESNEL,
    PICTURE_EFFECTS,
    PICTURE_BUDGET,
    PICTURE_MAX_ERROR,
    PICTURE_VIEW,
    PICTURE_VIEW_RAYS,
    PICTURE_VIEW_SCALE,
    PICTURE_ID_END,
};
#define PICTURE_OPTION_PLACE                                                                       \
    {PICTURE_SIZE, "size", "WxH", "pixels (640x480)", NULL},                                       \
    {                                                                                              \
        PICTURE_CAMERA, "camera", "NAME|N|numbers",                                                \
            "a camera of the scene, by name or number, or\n"                                       \
            "ex,ey,ez,tx,ty,tz,ux,uy,uz,fov: eye, target, up and\n"                                \
            "vertical angle in degrees (the scene's first)",                                       \
            NULL                                                                                   \
    }
#define PICTURE_OPTION_SHADING                                                                     \
    {PICTURE_AA, "aa", "1|4|16|...|4096|adaptive:X",                                               \
     "samples a pixel; adaptive: 4, where neighbours differ by\n"                                  \
     "more than X 16, and then 64 (1)",                                                            \
     values_samples},                                                                              \
        {PICTURE_DEPTH, "depth", "N", "most bounces; 0: only what is seen directly (8)", NULL},    \
        {PICTURE_BAILOUT, "bailout", "X",                                                          \
         "rays that can add less than X to a pixel are not traced;\n"                              \
         "0: all are (1/1024)",                                                                    \
         NULL},                                                                                    \
        {PICTURE_NO_SHADOWS, "no-shadows", NULL, "light reaches everything", NULL},                \
        {PICTURE_OPAQUE_SHADOWS, "opaque-shadows", NULL,                                           \
         "glass and blended surfaces cast full shadows", NULL},                                    \
        {PICTURE_LIGHT_SAMPLES, "light-samples", NULL,                                             \
         "points of an area light that are tested (16)", values_light_samples},                    \
        {PICTURE_FRESNEL, "fresnel", NULL, "or Schlick's approximation in its place (exact)",      \
         values_fresnel},                                                                          \
    {                                                                                              \
        PICTURE_EFFECTS, "effects", "auto|all|+NAME,-NAME",                                        \
            "compile what the scene calls for, or everything: the\n"                               \
            "picture is the same; or more and less by name: less\n"                                \
            "changes it. Names and prices: `whit scene --effects`\n"                               \
            "(auto)",                                                                              \
            values_effects                                                                         \
    }
#define PICTURE_OPTION_CHOICE                                                                      \
    {PICTURE_BUDGET, "budget-ms", "T",                                                             \
     "choose the best of these settings that take at most T ms, by\n"                              \
     "`whit cost`, which measures the scene for 20 s the first time",                              \
     NULL},                                                                                        \
    {                                                                                              \
        PICTURE_MAX_ERROR, "max-error", "E", "the cheapest ones with an RMSE of at most E", NULL   \
    }
#define PICTURE_OPTION_VIEW                                                                        \
    {PICTURE_VIEW, "view", NULL,                                                                   \
     "what traversals cost instead of colours: a heat map\n"                                       \
     "(.png) or the numbers (.exr, .pfm)",                                                         \
     values_view},                                                                                 \
        {PICTURE_VIEW_RAYS, "view-rays", "KIND",                                                   \
         "of primary, shadow, reflected, refracted or all rays\n"                                  \
         "(primary)",                                                                              \
         values_rays},                                                                             \
    {                                                                                              \
        PICTURE_VIEW_SCALE, "view-scale", "auto|X", "the number of the brightest colour (auto)",   \
            NULL                                                                                   \
    }
/* False when `id` is none of them. */
bool picture_option(struct cli_reader *reader, int id, struct render_request *request);
/* Whether budget_ms and max_error go with the rest of it; else misuse, and false. */
bool picture_check_choice(struct cli_reader *reader, const struct render_request *request);
struct render_request picture_request_default(void);
/* Without what only some commands have. */
whit_renderer_params picture_request_params(const struct render_request *request,
                                            const struct job *job);

/* From the scene to a renderer on a device; failures were said (render_command.c). */
WHIT_CHECK whit_result render_prepare(struct job *job, struct render_request *request,
                                      struct frames_progress *progress, whit_renderer **renderer);

/* A renderer of what `request` says (render_command.c). */
WHIT_CHECK whit_result render_create(const struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

/* Settings for budget_ms or max_error, by figures of `whit cost`, which are measured when none are
   kept; says which, and makes their renderer (cost_choice.c). What is within budget_ms is tried
   before, for the device may be slower at this moment. The device is open.
   WHIT_ERROR_FAILED: none does it. The renderer is the caller's, also after a failure. */
WHIT_CHECK whit_result render_choose(struct job *job, struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

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
    char *command, *options, *counters, *view, *scene, *name, *driver; /* owned */
    char hash[17];
    whit_device_info device;
};

/* False when memory ran out, which was said. `device`: NULL: that of the job. */
bool recipe_init(struct recipe *recipe, const struct job *job, const struct render_request *request,
                 const whit_device_info *device, const whit_stats *stats);
/* Adds what a picture of costs shows; false as above. */
bool recipe_add_view(struct recipe *recipe, const struct cost_view *view,
                     const struct view_figures *figures);
void recipe_finish(struct recipe *recipe);
/* Appends a space and `word`, an argument, quoted for a POSIX shell. */
void recipe_put_word(FILE *to, const char *word);

/* The device's driver without the name of the device in front. */
const char *stats_driver(const whit_device_info *device);

/* --stats of `whit render`: on standard output. `sequence`: with --frames, else NULL. */
int stats_print(const struct job *job, const struct render_request *request,
                const whit_renderer *renderer, const whit_stats *stats, double save_ms,
                const struct sequence *sequence);

#endif
