/* Vectors and colours in double, beyond those of base/vec.h. */
#ifndef REFERENCE_VECTOR_H
#define REFERENCE_VECTOR_H

#include <math.h>
#include <stdbool.h>

#include "base/vec.h"

static inline struct dvec3 d3(double x, double y, double z)
{
    return (struct dvec3){x, y, z};
}

static inline struct dvec3 d3_all(double value)
{
    return d3(value, value, value);
}

static inline struct dvec3 d3_load(const float *p)
{
    return dvec3_from(vec3_load(p));
}

static inline struct dvec3 d3_add(struct dvec3 a, struct dvec3 b)
{
    return d3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct dvec3 d3_scale(struct dvec3 a, double s)
{
    return d3(a.x * s, a.y * s, a.z * s);
}

/* Product by components, for colours. */
static inline struct dvec3 d3_times(struct dvec3 a, struct dvec3 b)
{
    return d3(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline struct dvec3 d3_mix(struct dvec3 a, struct dvec3 b, double part)
{
    return dvec3_along(d3_scale(a, 1.0 - part), b, part);
}

static inline double d3_largest(struct dvec3 a)
{
    return fmax(a.x, fmax(a.y, a.z));
}

static inline double d3_size(struct dvec3 a)
{
    return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
}

static inline double d3_length(struct dvec3 a)
{
    return sqrt(dvec3_dot(a, a));
}

static inline bool d3_is_zero(struct dvec3 a)
{
    return a.x == 0.0 && a.y == 0.0 && a.z == 0.0;
}

/* The unit vector of a; `otherwise` where its length is 0 or not finite. */
static inline struct dvec3 d3_unit_or(struct dvec3 a, struct dvec3 otherwise)
{
    double size = d3_size(a);
    if (!(size > 0.0) || !isfinite(size))
        return otherwise;
    a = d3_scale(a, 1.0 / size);
    return d3_scale(a, 1.0 / d3_length(a));
}

static inline double clamp_unit(double x)
{
    return fmin(fmax(x, 0.0), 1.0);
}

#endif
