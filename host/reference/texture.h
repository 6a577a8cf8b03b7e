/* Textures, in double. */
#ifndef REFERENCE_TEXTURE_H
#define REFERENCE_TEXTURE_H

#include "reference/surface.h"

struct texel {
    struct dvec3 rgb;
    double alpha;
};

/* White where the slot is empty. */
struct texel texture_sample(const struct reference *reference, const struct surface *s,
                            enum scene_slot slot);
/* Opacity of masked and blended materials, colours of vertices left out. */
double texture_opacity(const struct reference *reference, const struct surface *s);
/* Normal or bump map: s->ns. */
void texture_bend_normal(const struct reference *reference, struct surface *s);

#endif
