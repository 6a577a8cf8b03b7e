/* Media that rays are in, and what they are crossed by. */
#ifndef REFERENCE_MEDIA_H
#define REFERENCE_MEDIA_H

#include "reference/surface.h"

/* The medium that counts: material; SCENE_NONE: air. */
uint32_t media_top(const struct media *media);
/* Beer's law along t in the medium that counts. */
struct dvec3 media_transmittance(const struct reference *reference, const struct media *media,
                                 double t);
/* Sum of the absorption of all of them. */
struct dvec3 media_absorption(const struct reference *reference, const struct media *media);
struct media media_around_eye(const struct reference *reference);

struct crossing {
    struct media before, after;
    double eta;
    bool seen;
    /* Where what passes goes on: the last of the surfaces that are crossed here. */
    struct dvec3 p, ng;
    double room;
    uint32_t instance, primitive;
};

/* `s` faces the ray, afterwards too, when it is another one of those that touch. */
struct crossing media_cross(struct tracer *tracer, const struct ray *ray, const struct hit *hit,
                            struct surface *s, bool inside);

#endif
