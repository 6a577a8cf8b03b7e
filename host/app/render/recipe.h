/* The recipe: texts in a picture's file that say how it was made. */
#ifndef APP_RENDER_RECIPE_H
#define APP_RENDER_RECIPE_H

#include "app/document.h"
#include "app/render/part.h"

/* The texts that a picture carries about itself: only what decides its pixels, so that the same
   inputs give the same bytes. */
enum { RECIPE_TEXTS = 11 };
struct recipe {
    whit_text texts[RECIPE_TEXTS]; /* their values are owned */
    uint32_t count;
};

/* Key in the recipe of a view whose camera cannot be given by --camera, in place of the command:
   the camera as a line of a file for --cameras. */
#define VIEW_CAMERA_KEY "whit:camera"

/* False when memory ran out, with a message. `shader`: NULL without one. `output`: its ending is
   the format of the picture. `camera`: NULL, or what VIEW_CAMERA_KEY holds, which is taken over. */
bool recipe_init(struct recipe *recipe, const struct settings *settings, const whit_scene *scene,
                 const whit_shader *shader, const whit_device_info *device, const whit_stats *stats,
                 const char *output, json_t *camera);
/* The mean, the largest value and the scale of a picture of costs. */
struct view_figures {
    double mean, max, scale; /* mean and max over pixels; scale of the heat map, whether or not one
                                is drawn */
};

/* The cost image of the picture just rendered: as a heat map with a legend for a .png, as numbers
   for other files. */
WHIT_CHECK whit_result view_image(whit_renderer *renderer, const struct settings *settings,
                                  const char *output, struct view_figures *figures,
                                  whit_image **out);
/* Adds view, scale and figures of a picture of costs. */
void recipe_add_view(struct recipe *recipe, const struct settings *settings,
                     const struct view_figures *figures);
/* Adds to the recipe which part of a picture was drawn, if it is not all of it. */
void recipe_add_part(struct recipe *recipe, const struct part *part,
                     const struct settings *settings);
/* How many rays of each kind there were, as an object. */
json_t *recipe_rays(const whit_stats *stats);
/* The text of whit:counters for these statistics; free() it. */
char *recipe_counters(const whit_stats *stats);
void recipe_finish(struct recipe *recipe);

#endif
