/* All that a picture in the window depends on: what the options of `whit render` say, and how the
   window shows it. A plain record: copied freely, compared field by field. */
#ifndef VIEW_SETTINGS_H
#define VIEW_SETTINGS_H

#include "api/whit.h"
#include "settings/values.h"

enum { VIEW_PATH = 1024, VIEW_TEXT = 256, VIEW_ALLOWED = 8 };

/* What is painted. Costs are heat maps, of what whit_view tells. */
enum view_paint {
    VIEW_PAINT_COLOR,
    VIEW_PAINT_DEPTH, /* from here on 1 + whit_view */
    VIEW_PAINT_VISITS,
    VIEW_PAINT_BOXES,
    VIEW_PAINT_TRIS,
    VIEW_PAINT_STACK,
    VIEW_PAINT_COUNT,
};

enum view_boxes { VIEW_BOXES_OFF, VIEW_BOXES_MESHES, VIEW_BOXES_INSTANCES, VIEW_BOXES_COUNT };

struct view_settings {
    char scene[VIEW_PATH];
    uint32_t reload;                       /* another number: the scene is read again */
    char device[VIEW_TEXT];                /* "": auto */
    uint32_t texture_limit;                /* 0: the default */
    uint64_t memory_limit;                 /* of --memory-limit */
    char allowed[VIEW_ALLOWED][VIEW_PATH]; /* folders of --allow-path; "" behind the last */
    bool validation;
    double import_limit_s; /* as --import-limit; 0: the default */
    bool require_sandbox;

    whit_accel_params trees; /* without pointers */
    char build[VIEW_TEXT];   /* `trees` as --build names it, without +opt; "": the default */

    /* Without pointers; width and height are those of the window. */
    whit_renderer_params picture;
    char camera[VIEW_TEXT];  /* as --camera takes it; "": the scene's first */
    char effects[VIEW_TEXT]; /* as --effects takes it; "": auto */

    uint32_t paint;      /* enum view_paint */
    uint32_t paint_rays; /* whit_ray_kind, or WHIT_RAY_KINDS: all */
    double paint_scale;  /* 0: by the picture */
    uint32_t boxes;      /* enum view_boxes, drawn over the picture */
    uint32_t boxes_level;
};

/* Whether a renderer that was made for `a` draws `b` by whit_renderer_set_view alone. */
bool settings_same_kernel(const struct view_settings *a, const struct view_settings *b);
/* Whether the scene of `a` is that of `b`. */
bool settings_same_scene(const struct view_settings *a, const struct view_settings *b);
/* Camera, time and size alone, of whatever scenes. */
bool settings_same_camera(const struct view_settings *a, const struct view_settings *b);
/* Takes them over. */
void settings_set_camera(struct view_settings *settings, const struct view_settings *from);
/* Whether what `a` and `b` see is the same: camera, time, size; not how it is found or shaded. */
bool settings_same_place(const struct view_settings *a, const struct view_settings *b);
/* All of it. */
bool settings_same(const struct view_settings *a, const struct view_settings *b);

/* The public parameters, with their strings, which point into `settings`. */
whit_renderer_params settings_picture(const struct view_settings *settings);

/* The words of the command line that say the same as `settings`, each in quotes where a shell needs
   them; what is at its default is left out. `separator`: between an option and the next, " " or
   "\n". The number of bytes written, without the 0 at the end; text that does not fit is cut. */
size_t settings_words(const struct view_settings *settings, const char *separator, char *text,
                      size_t text_bytes);
/* `whit render SCENE ... -o picture.png`, which makes the picture of the window. */
size_t settings_render_line(const struct view_settings *settings, char *text, size_t text_bytes);

#endif
