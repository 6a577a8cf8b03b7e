/* Functions of a shader that are kept beside the colour, as images of a picture's file. */
#ifndef APP_RENDER_LAYERS_H
#define APP_RENDER_LAYERS_H

#include "app/job.h"

struct recipe;

enum { LAYERS_MAX = 16 };

/* Names live as long as the shader. A zeroed one has none. */
struct layers {
    whit_image_layer items[LAYERS_MAX];
    whit_image *images[LAYERS_MAX]; /* of the items, owned */
    uint32_t count;
};

/* All that the shader (NULL: none) has: of the picture that `renderer` has drawn, or where that is
   NULL of `refine`. After an error there are none. */
WHIT_CHECK whit_result layers_read(const whit_shader *shader, whit_renderer *renderer,
                                   const whit_refine *refine, struct layers *layers);
bool layers_is_exr(const char *path); /* what holds layers */
void layers_finish(struct layers *layers);

/* Whether the shader of --aov NAME has that function; says so where it has not. */
bool layers_check(const struct job *job);
/* Writes the image of --aov NAME, which layers_check has found: all four numbers into an .exr, the
   first three, as red, green and blue, into other files. */
WHIT_CHECK whit_result layers_save(const struct layers *layers, const char *name, const char *path,
                                   const struct recipe *recipe);

#endif
