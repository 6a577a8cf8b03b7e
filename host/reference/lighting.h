/* Direct light from all lights. */
#ifndef REFERENCE_LIGHTING_H
#define REFERENCE_LIGHTING_H

#include "reference/optics.h"
#include "reference/surface.h"

/* Radiance towards the ray's origin: direct light from all lights, ambient light and emission.
 *open: the direct light without shadows. `media`: on the ray's side of the surface. */
struct dvec3 lighting_local(struct tracer *tracer, const struct surface *s, const struct optics *o,
                            const struct ray *ray, const struct hit *hit, const struct media *media,
                            struct dvec3 *open);
/* The share of the background that a shadow catcher shows: direct light / light without shadows. */
struct dvec3 lighting_caught(struct dvec3 light, struct dvec3 open);

#endif
