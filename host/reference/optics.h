/* Reflection, refraction and highlights of a surface. */
#ifndef REFERENCE_OPTICS_H
#define REFERENCE_OPTICS_H

#include "reference/surface.h"

struct optics {
    struct dvec3 diffuse, ambient, highlight, emission;
    struct dvec3 reflected, refracted; /* weights of the two rays */
    double straight;                   /* share of light that passes straight through */
    double shininess, alpha, eta;
    bool thin, unlit, metal_rough;
};

/* `eta`: index of refraction on the ray's side over that on the other. Applies the normal or bump
   map to s->ns. */
struct optics optics_at(const struct reference *reference, struct surface *s, struct dvec3 dir,
                        double eta);
/* Turns it into the optics of a shadow catcher: all light passes straight through. */
void optics_make_catcher(struct optics *o);
/* Gives the refracted direction; false: total reflection. */
bool optics_refract(struct dvec3 dir, struct dvec3 n, double eta, struct dvec3 *out);
struct dvec3 optics_reflect(struct dvec3 dir, struct dvec3 n);
/* pi * BRDF * cosine of the highlight, for light from `to_light` seen from `view`. */
struct dvec3 optics_highlight(const struct optics *o, struct dvec3 n, struct dvec3 to_light,
                              struct dvec3 view);

#endif
