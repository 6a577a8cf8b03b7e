/* All that a picture depends on, how it is found and how it is shown: one record, and one table
   with a row for each option that says what is in it. Every command that makes pictures or trees
   takes its options from this table; the viewer, `whit cost` and recipes write them by it. */
#ifndef SETTINGS_SETTINGS_H
#define SETTINGS_SETTINGS_H

#include "settings/setting.h"
#include "whit/whit_program.h"

/* What is painted. Costs are heat maps, of what whit_view tells. */
enum settings_paint {
    PAINT_COLOR,
    PAINT_DEPTH, /* from here on 1 + whit_view */
    PAINT_VISITS,
    PAINT_BOXES,
    PAINT_TRIS,
    PAINT_STACK,
    PAINT_COUNT,
};
enum settings_boxes { BOXES_OFF, BOXES_MESHES, BOXES_INSTANCES };
enum settings_edges { EDGES_OFF, EDGES_OBJECTS, EDGES_TRIANGLES };
enum settings_stats { STATS_NONE, STATS_TEXT, STATS_JSON };

/* A plain record: copied freely, compared by the rows of the table. */
struct settings {
    char scene[SETTING_PATH_BYTES]; /* the file */
    uint32_t reload;                /* another number: the scene is read again */
    uint64_t given;                 /* bits of rows that options named: see settings_given */

    whit_load_params load;                                 /* without pointers */
    char environment[SETTING_TEXT_BYTES];                  /* "": the file's */
    char allowed[SETTING_FOLDERS_MAX][SETTING_PATH_BYTES]; /* folders; "" behind the last */
    whit_accel_params trees;
    whit_renderer_params picture;    /* without camera and pointers: see settings_picture */
    char camera[SETTING_TEXT_BYTES]; /* "": the scene's first */
    bool exposure_auto;       /* the exposure in `picture` is the scene's: see settings_expose */
    double scene_exposure_ev; /* what auto stands for, once the scene is known */
    uint32_t frame;           /* in place of a time, with `fps`: see settings_check */
    double fps;

    char shader[SETTING_TEXT_BYTES];  /* a file of functions; "": none */
    char stages[SETTING_TEXT_BYTES];  /* a checkout's shaders/, in place of whit's; "": those */
    char sliders[SETTING_TEXT_BYTES]; /* of it: "NAME=VALUE,NAME=VALUE" */
    char aov[SETTING_TEXT_BYTES];     /* a function of it in place of the colour; "": none */
    uint32_t shader_reload;           /* another number: the file is read again */
    bool trust;                       /* its loops and indices are not bounded */

    uint32_t paint;              /* enum settings_paint */
    uint32_t paint_rays;         /* whit_ray_kind, or WHIT_RAY_KINDS: all */
    double paint_scale;          /* of the heat map; 0: by the picture */
    uint32_t edges;              /* enum settings_edges */
    bool grid;                   /* on the ground */
    double fps_goal;             /* pictures a second that the viewer holds */
    uint32_t boxes, boxes_level; /* enum settings_boxes, which the viewer draws over the picture */

    bool refines;                /* the viewer draws more samples of a picture at rest */
    double budget_ms, max_error; /* 0: not asked for; else settings are chosen by `whit cost` */

    char device[SETTING_TEXT_BYTES]; /* "": auto */
    bool validation, no_cache, quiet;
    uint32_t stats; /* enum settings_stats */
    double time_limit_s;
};

/* Bits of setting.commands. */
enum settings_command {
    IN_RENDER = 1 << 0,
    IN_VIEW = 1 << 1,
    IN_PROBE = 1 << 2,
    IN_COST = 1 << 3,
    IN_SCENE = 1 << 4,
    IN_BVH = 1 << 5,
    IN_TRACE = 1 << 6,
    IN_HARD = 1 << 7,
    IN_COMPARE = 1 << 8,
    IN_BENCH = 1 << 9,
    IN_SHADER = 1 << 10,
    IN_CHECK = 1 << 11,
    IN_MERGE = 1 << 12,
    IN_BATCH = 1 << 13,
};

/* The table; it ends with a row that has no name. */
extern const struct setting settings_table[];
/* Its row of that name, which must be there. */
const struct setting *settings_row(const char *name);

/* What no option says: the defaults of the public parameters, in numbers. */
struct settings settings_usual(void);
/* Whether an option named the row. */
bool settings_given(const struct settings *settings, const char *name);
/* Takes over what an option says, and that it did. */
bool settings_read(const struct setting *row, const char *text, struct settings *settings,
                   char why[SETTING_WHY_BYTES]);
/* Whether the options go together; else why not. Makes a time of a frame. */
bool settings_check(struct settings *settings, char why[SETTING_WHY_BYTES]);

/* Takes the exposure that suits the scene, where --exposure is auto. */
void settings_expose(struct settings *settings, const whit_scene_info *scene);

/* The parameters for libwhit, with their strings, which point into `settings`; `folders` is theirs.
 */
whit_renderer_params settings_picture(const struct settings *settings);
/* What is drawn over the picture. */
whit_overlay settings_overlay(const struct settings *settings);
whit_load_params settings_load(const struct settings *settings,
                               const char *folders[SETTING_FOLDERS_MAX]);

/* ---- Comparing ---- */

/* Whether a renderer that was made for `a` draws `b` by whit_renderer_set_view alone. */
bool settings_same_kernel(const struct settings *a, const struct settings *b);
/* Whether the scene of `a` is that of `b`. */
bool settings_same_scene(const struct settings *a, const struct settings *b);
/* The same number wherever settings_same_scene and settings_same_kernel hold, and hardly ever
   elsewhere: to find in long lists what may be shared. */
uint64_t settings_hash_scene(const struct settings *settings);
uint64_t settings_hash_kernel(const struct settings *settings);
/* Whether the trees of `a` are those of `b`. */
bool settings_same_trees(const struct settings *a, const struct settings *b);
/* Camera, time and size alone, of whatever scenes. */
bool settings_same_camera(const struct settings *a, const struct settings *b);
/* Takes them over. */
void settings_set_camera(struct settings *settings, const struct settings *from);
/* Whether what `a` and `b` see is the same: camera, time, size; not how it is found or shaded. */
bool settings_same_place(const struct settings *a, const struct settings *b);
/* What changes colours alone, trees and scene left as they are. */
bool settings_same_light(const struct settings *a, const struct settings *b);
void settings_set_light(struct settings *settings, const struct settings *from);
/* Whether ids and pixels of both pictures are the same bytes; what is left may change their time.
 */
bool settings_same_pixels(const struct settings *a, const struct settings *b);
/* Whether kernels are compiled for it: of functions of the user's, of other stages, or both. */
bool settings_compiles(const struct settings *settings);
/* Whether the shader of both is one, compiled once. */
bool settings_same_shader(const struct settings *a, const struct settings *b);
/* All that a picture shows. */
bool settings_same(const struct settings *a, const struct settings *b);

/* ---- Writing ---- */

/* Which rows are written, beside those that are not at their default. */
enum settings_words {
    SETTINGS_RECIPE, /* what decides the pixels; some at their default too */
    SETTINGS_STATE,  /* of a file of settings: what decides pixels or time, but for what files may
                        reach */
    SETTINGS_LINE,   /* all of these */
};
/* The options that say the same as `settings`, each word in quotes where a shell needs them.
   `separator`: between an option and the next, " " or "\n". The number of bytes written, without
   the 0 at the end; text that does not fit is cut. */
size_t settings_write(const struct settings *settings, enum settings_words which,
                      const char *separator, char *text, size_t text_bytes);
/* `whit render SCENE ... -o OUTPUT`, which makes the picture. */
size_t settings_write_render(const struct settings *settings, enum settings_words which,
                             const char *output, char *text, size_t text_bytes);

/* ---- Kinds of their own ---- */

/* builder.c: a builder as --build names it. False: why not. */
bool builder_read(const char *text, whit_accel_params *trees, char why[SETTING_WHY_BYTES]);
void builder_write(const whit_accel_params *trees, char *text, size_t text_bytes);
/* effects.c: effects as --effects names them. False: why not, and nothing is changed. */
bool effects_read(const char *text, whit_renderer_params *picture, char why[SETTING_WHY_BYTES]);
void effects_write(const whit_renderer_params *picture, char text[SETTING_VALUE_BYTES]);
/* Switches effect `index` on or off, which the scene calls for or not. */
void effects_set(whit_renderer_params *picture, uint32_t index, bool called, bool on);
/* camera.c: a camera as --camera names it; its name is borrowed. "": the scene's first. */
whit_camera camera_of_text(const char *text);
/* Puts the numbers of a camera of one's own in the place of --camera; false, and the scene's first,
   where it is no pinhole. */
bool settings_name_camera(struct settings *settings, const whit_camera *camera);
/* Puts the numbers of whit's own camera in the place of --camera auto; where the scene's first
   camera is that, nothing. */
WHIT_CHECK whit_result settings_choose_camera(struct settings *settings, const whit_scene *scene);

#endif
