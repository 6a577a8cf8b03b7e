/* All settings of a picture, of how it is computed and how it is shown: one record, and one table
   with a row for each of its options. Every command that makes pictures or trees takes its options
   from this table; the viewer, `whit cost` and recipes write options by it. */
#ifndef SETTINGS_SETTINGS_H
#define SETTINGS_SETTINGS_H

#include "settings/setting.h"
#include "whit/whit_program.h"

/* The content of the picture: colours, or a heat map of a cost of whit_view. */
enum settings_paint {
    PAINT_COLOR,
    PAINT_DEPTH, /* this value and the following ones are 1 + whit_view */
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
    uint32_t reload;                /* counter: another number makes the scene be read again */
    uint64_t given;                 /* bits of the rows that options have set: see settings_given */

    whit_load_params load;                                 /* its pointers are not used: see
                                                              settings_load */
    char clip[SETTING_TEXT_BYTES];                         /* "": whit_load_params.clip NULL */
    char environment[SETTING_TEXT_BYTES];                  /* "": the file's */
    char allowed[SETTING_FOLDERS_MAX][SETTING_PATH_BYTES]; /* allowed folders; the last is followed
                                                              by "" */
    whit_accel_params trees;
    whit_renderer_params picture;    /* its camera and pointers are not used: see
                                        settings_picture */
    char camera[SETTING_TEXT_BYTES]; /* "": the scene's first */
    bool exposure_auto;              /* the exposure is chosen for the scene: see settings_expose */
    double scene_exposure_ev;        /* the exposure that auto chooses, once the scene is known */
    uint32_t frame;                  /* with `fps`, replaces a time: see settings_check */
    double fps;

    char shader[SETTING_TEXT_BYTES];      /* a file of functions; "": none */
    char shader_said[SETTING_TEXT_BYTES]; /* where `shader` is a picture that is repeated: the
                                             shader of its recipe, for the new one; else "" */
    char stages[SETTING_TEXT_BYTES];  /* a checkout's shaders/ in place of the built-in stages; "":
                                         the built-in ones */
    char sliders[SETTING_TEXT_BYTES]; /* of the shader: "NAME=VALUE,NAME=VALUE" */
    char aov[SETTING_TEXT_BYTES];     /* an aov of the shader that is drawn in place of the colour;
                                         "": none */
    uint32_t shader_reload;           /* counter: another number makes the shader be read again */
    bool trust;                       /* loops and indices of the shader are not bounded */

    uint32_t paint;              /* enum settings_paint */
    uint32_t paint_rays;         /* whit_ray_kind, or WHIT_RAY_KINDS: all */
    double paint_scale;          /* scale of the heat map; 0: chosen by the picture */
    uint32_t edges;              /* enum settings_edges */
    bool grid;                   /* a grid on the ground */
    double fps_goal;             /* pictures per second that the viewer tries to reach */
    uint32_t boxes, boxes_level; /* enum settings_boxes, which the viewer draws over the picture */

    bool refines;                /* the viewer draws more samples while nothing changes */
    double budget_ms, max_error; /* above 0: settings are chosen by figures of `whit cost` to meet
                                    this limit */

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
/* The row of that name, which must exist. */
const struct setting *settings_row(const char *name);

/* The settings without any option: the defaults of the public params, as explicit numbers. */
struct settings settings_usual(void);
/* Whether an option has set the row of that name. */
bool settings_given(const struct settings *settings, const char *name);
/* Reads the value of an option, and notes in `given` that it was set. */
bool settings_read(const struct setting *row, const char *text, struct settings *settings,
                   char why[SETTING_WHY_BYTES]);
/* Whether the options go together; false with the reason. Computes the time of `frame`. */
bool settings_check(struct settings *settings, char why[SETTING_WHY_BYTES]);

/* Where --exposure is auto, sets the exposure that was chosen for the scene. */
void settings_expose(struct settings *settings, const whit_scene_info *scene);

/* The params for libwhit. Their strings point into `settings`, and the list of allowed folders of
   settings_load is `folders`. */
whit_renderer_params settings_picture(const struct settings *settings);
/* The device that the settings name, with its validation. */
whit_device_params settings_device(const struct settings *settings);
/* The overlays of the picture. */
whit_overlay settings_overlay(const struct settings *settings);
whit_load_params settings_load(const struct settings *settings,
                               const char *folders[SETTING_FOLDERS_MAX]);

/* ---- Comparing ---- */

/* Whether a renderer made for `a` can draw `b` by whit_renderer_set_view alone. */
bool settings_same_kernel(const struct settings *a, const struct settings *b);
/* Whether `a` and `b` load the same scene. */
bool settings_same_scene(const struct settings *a, const struct settings *b);
/* Hashes that are equal where settings_same_scene and settings_same_kernel hold, and hardly ever
   elsewhere, to find settings that can share scenes or kernels in long lists. */
uint64_t settings_hash_scene(const struct settings *settings);
uint64_t settings_hash_kernel(const struct settings *settings);
/* Whether `a` and `b` build the same trees. */
bool settings_same_trees(const struct settings *a, const struct settings *b);
/* Copies the scene, and all settings that it is loaded with. */
void settings_set_scene(struct settings *settings, const struct settings *from);
/* Whether camera, time and size are the same, even of different scenes. */
bool settings_same_camera(const struct settings *a, const struct settings *b);
/* Copies camera, time and size. */
void settings_set_camera(struct settings *settings, const struct settings *from);
/* Whether `a` and `b` see the same: scene, camera, time and size, whatever trees and shading
   are. */
bool settings_same_place(const struct settings *a, const struct settings *b);
/* Whether the settings that change only colours, and the shader, are the same. settings_set_light
   copies these settings, without the shader. */
bool settings_same_light(const struct settings *a, const struct settings *b);
void settings_set_light(struct settings *settings, const struct settings *from);
/* Whether ids and pixels of both pictures have the same bytes; other settings may differ in time
   and memory. */
bool settings_same_pixels(const struct settings *a, const struct settings *b);
/* Whether the settings need kernels to be compiled from GLSL: for --shader, --stages or both. */
bool settings_compiles(const struct settings *settings);
/* Whether both have the same shader, so that it is compiled once. */
bool settings_same_shader(const struct settings *a, const struct settings *b);
/* Whether all settings are the same that decide what is shown. */
bool settings_same(const struct settings *a, const struct settings *b);

/* ---- Writing ---- */

/* The rows to write, of those that are not at their default. */
enum settings_words {
    SETTINGS_RECIPE, /* those that decide pixels; some of them also at their default */
    SETTINGS_STATE,  /* for a file of settings: those that decide pixels or time, without those that
                        grant access to files */
    SETTINGS_LINE,   /* those that decide pixels or time */
};
/* Writes the options that give these settings, with words quoted where a shell needs it.
   `separator`: between two options, " " or "\n". Gives the number of bytes written, without the 0
   at the end; text that does not fit is cut. */
size_t settings_write(const struct settings *settings, enum settings_words which,
                      const char *separator, char *text, size_t text_bytes);
/* Writes the command `whit render SCENE ... -o OUTPUT` that makes the picture. */
size_t settings_write_render(const struct settings *settings, enum settings_words which,
                             const char *output, char *text, size_t text_bytes);

/* ---- Kinds of their own ---- */

/* builder.c: a builder in the syntax of --build. False, with the reason in `why`. */
bool builder_read(const char *text, whit_accel_params *trees, char why[SETTING_WHY_BYTES]);
void builder_write(const whit_accel_params *trees, char *text, size_t text_bytes);
/* effects.c: effects in the syntax of --effects. False, with the reason in `why`, and nothing is
   changed. */
bool effects_read(const char *text, whit_renderer_params *picture, char why[SETTING_WHY_BYTES]);
void effects_write(const whit_renderer_params *picture, char text[SETTING_VALUE_BYTES]);
/* Switches effect `index` on or off; `called`: whether the scene needs it. */
void effects_set(whit_renderer_params *picture, uint32_t index, bool called, bool on);
/* camera.c: a camera in the syntax of --camera; its name is borrowed. "": the scene's first
   camera. */
whit_camera camera_of_text(const char *text);
/* Sets --camera to the ten numbers of `camera`; where it is not a pinhole camera, which numbers
   cannot describe, gives false and sets the scene's first camera. */
bool settings_name_camera(struct settings *settings, const whit_camera *camera);
/* Replaces --camera auto by the numbers of whit's own camera, or by "" where that is the scene's
   first camera. */
WHIT_CHECK whit_result settings_choose_camera(struct settings *settings, const whit_scene *scene);

#endif
