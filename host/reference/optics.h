/* What a surface does with light. */
#ifndef REFERENCE_OPTICS_H
#define REFERENCE_OPTICS_H

#include "reference/surface.h"

struct optics {
    struct dvec3 diffuse, ambient, highlight, emission;
    struct dvec3 reflected, refracted; /* weights of the two rays */
    double straight;                   /* share that passes undisturbed */
    double shininess, alpha, eta;
    bool thin, unlit, metal_rough;
};

/* `eta`: index of the ray's side over that of the other. Bends s->ns. */
struct optics optics_at(const struct reference *reference, struct surface *s, struct dvec3 dir,
                        double eta);
/* A shadow catcher: light goes straight on. */
void optics_make_catcher(struct optics *o);
/* Unpolarised light that a smooth face reflects; 1 under total reflection. */
double optics_fresnel(double cos_in, double eta);
/* False under total reflection. */
bool optics_refract(struct dvec3 dir, struct dvec3 n, double eta, struct dvec3 *out);
struct dvec3 optics_reflect(struct dvec3 dir, struct dvec3 n);
/* Highlight of light along `to_light` seen along `view`, times pi of a BRDF times cosine. */
struct dvec3 optics_highlight(const struct optics *o, struct dvec3 n, struct dvec3 to_light,
                              struct dvec3 view);

#endif
