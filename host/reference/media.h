/* Media that rays are in, and the crossing of their surfaces. */
#ifndef REFERENCE_MEDIA_H
#define REFERENCE_MEDIA_H

#include "reference/surface.h"

/* The medium with the highest priority, as material index; SCENE_NONE: air. */
uint32_t media_top(const struct media *media);
/* Transmittance by Beer's law along distance t in the medium of media_top. */
struct dvec3 media_transmittance(const struct reference *reference, const struct media *media,
                                 double t);
/* Sum of the absorption of all media. */
struct dvec3 media_absorption(const struct reference *reference, const struct media *media);
struct media media_around_eye(const struct reference *reference);

struct crossing {
    struct media before, after;
    double eta; /* index of refraction of `before` over that of `after` */
    bool seen;  /* false: same medium on both sides, the ray goes on as if nothing were there */
    /* Start of transmitted rays: on the last of the surfaces that are crossed here. */
    struct dvec3 p, ng;
    double room;
    uint32_t instance, primitive;
};

/* Crosses the surface `s` at a hit, and all surfaces that touch it. `s` faces the ray; it may
   become another one of these, which faces the ray too. `inside`: the ray comes from inside of
   `s`. */
struct crossing media_cross(struct tracer *tracer, const struct ray *ray, const struct hit *hit,
                            struct surface *s, bool inside);

#endif
