/* Hits of rays, in double. */
#ifndef REFERENCE_HITS_H
#define REFERENCE_HITS_H

#include "reference/inside.h"

struct hit hit_closest(const struct reference *reference, const struct ray *ray);
/* The next hit of the ray behind `known`, up to t_max. */
struct hit hit_next(const struct reference *reference, const struct ray *ray,
                    const struct hit *known, double t_max);

struct shadow_ray {
    struct dvec3 origin, dir;
    double distance; /* to the light; infinity: a directional light */
    uint32_t skip_instance, skip_primitive;
};

/* The result of a shadow ray: surfaces between a point and a light. */
struct shadow {
    bool blocked;
    struct hit blocker; /* if `blocked` */
    double stops[3];    /* light lost in filters, in 1/256 stops; may be negative */
    double filter_end;  /* the t from which absorption is measured */
};

struct shadow hit_shadow(const struct reference *reference, const struct shadow_ray *ray);

#endif
