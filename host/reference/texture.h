/* Textures, in double. */
#ifndef REFERENCE_TEXTURE_H
#define REFERENCE_TEXTURE_H

#include "reference/surface.h"

struct texel {
    struct dvec3 rgb;
    double alpha;
};

/* Samples a slot's texture; white where there is none. */
struct texel texture_sample(const struct reference *reference, const struct surface *s,
                            enum scene_slot slot);
/* Opacity of masked and blended materials, without vertex alpha. */
double texture_opacity(const struct reference *reference, const struct surface *s);
/* Applies the normal or bump map to s->ns. */
void texture_bend_normal(const struct reference *reference, struct surface *s);

#endif
