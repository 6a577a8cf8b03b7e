/* Images of a shader's aov functions, saved as layers in the picture's file. */
#ifndef APP_RENDER_LAYERS_H
#define APP_RENDER_LAYERS_H

#include "app/job.h"

struct recipe;

/* Names live as long as the shader. A zeroed one has none. */
struct layers {
    whit_image_layer items[WHIT_LAYERS_MAX];
    whit_image *images[WHIT_LAYERS_MAX]; /* the images of the items, owned */
    uint32_t count;
};

/* The images of a picture to be saved, owned. A zeroed one has none: then the renderer has them. */
struct drawn_images {
    whit_image *color; /* overlays are drawn into it */
    whit_image *ids;
    struct layers layers;
};
void drawn_images_finish(struct drawn_images *images);

/* Reads the aov images of the shader (NULL: none) from `renderer`, which has drawn the picture, or
   from `refine` where `renderer` is NULL. After an error there are none. */
WHIT_CHECK whit_result layers_read(const whit_shader *shader, whit_renderer *renderer,
                                   const whit_refine *refine, struct layers *layers);
void layers_finish(struct layers *layers);

/* Whether the shader has the function of --aov NAME; prints an error where it does not. */
bool layers_check(const struct job *job);
/* Writes the image of an aov: all four numbers into an .exr, the first three, as red, green and
   blue, into other files. */
WHIT_CHECK whit_result layers_save_image(const whit_image *image, const char *path,
                                         const struct recipe *recipe, const whit_log *log);
/* The same for the image of --aov NAME, which layers_check has found. */
WHIT_CHECK whit_result layers_save(const struct layers *layers, const char *name, const char *path,
                                   const struct recipe *recipe);

#endif
