/* Light from all lights. */
#ifndef REFERENCE_LIGHTING_H
#define REFERENCE_LIGHTING_H

#include "reference/optics.h"
#include "reference/surface.h"

/* Light from all lights towards the eye. `open`: what lights would add without shadows. `media`: on
   the surface's side. */
struct dvec3 lighting_local(struct tracer *tracer, const struct surface *s, const struct optics *o,
                            const struct ray *ray, const struct hit *hit, const struct media *media,
                            struct dvec3 *open);
/* What a shadow catcher shows of what is behind it. */
struct dvec3 lighting_caught(struct dvec3 light, struct dvec3 open);

#endif
