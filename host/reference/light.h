/* Light from each light, and from the sky. */
#ifndef REFERENCE_LIGHT_H
#define REFERENCE_LIGHT_H

#include "reference/inside.h"

struct light_sample_info {
    struct dvec3 to_light; /* unit */
    double distance;       /* infinity: a directional light */
    struct dvec3 arriving; /* irradiance / pi of a surface that faces the light, without shadows */
    double strength;       /* flat emitters: arriving = color * light_area_share() * strength */
};

/* Gives the light from sample point `index` of a light at p. False: none arrives. */
bool light_at(const struct tracer *tracer, const struct scene_light *light, uint32_t index,
              struct dvec3 p, struct light_sample_info *from);
/* The light's area / (pi * light samples). */
double light_area_share(const struct reference *reference, const struct scene_light *light);
double light_form_factor(const struct scene_light *light, struct dvec3 p, struct dvec3 n);
struct dvec3 light_sky(const struct reference *reference, struct dvec3 dir);

#endif
