/* Floats and small vectors. Every operation is written out, one rounding each, so that C built with
   contraction off gives the bits that the shaders give (docs/numerics.md). */
#ifndef BASE_VEC_H
#define BASE_VEC_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

static inline uint32_t float_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline float float_of_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* The largest float not above x; the smallest not below it. */
static inline float float_below(double x)
{
    float f = (float)x;
    return (double)f > x ? nextafterf(f, -INFINITY) : f;
}

static inline float float_above(double x)
{
    float f = (float)x;
    return (double)f < x ? nextafterf(f, INFINITY) : f;
}

#define PI 3.14159265358979323846

struct vec3 {
    float x, y, z;
};

struct dvec3 {
    double x, y, z;
};

static inline struct vec3 vec3_make(float x, float y, float z)
{
    return (struct vec3){x, y, z};
}

static inline struct vec3 vec3_load(const float *p)
{
    return (struct vec3){p[0], p[1], p[2]};
}

static inline void vec3_store(float *p, struct vec3 v)
{
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 vec3_scale(struct vec3 a, float s)
{
    return (struct vec3){a.x * s, a.y * s, a.z * s};
}

/* ((x + y) + z), the order of lavapipe's dot(). */
static inline float vec3_dot(struct vec3 a, struct vec3 b)
{
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline float vec3_length(struct vec3 a)
{
    return sqrtf(vec3_dot(a, a));
}

/* The zero vector stays zero. */
static inline struct vec3 vec3_normalize(struct vec3 a)
{
    float length = vec3_length(a);
    return length > 0.0f ? vec3_scale(a, 1.0f / length) : a;
}

static inline struct dvec3 dvec3_from(struct vec3 a)
{
    return (struct dvec3){a.x, a.y, a.z};
}

static inline struct dvec3 dvec3_load(const double *p)
{
    return (struct dvec3){p[0], p[1], p[2]};
}

/* a + b s */
static inline struct dvec3 dvec3_along(struct dvec3 a, struct dvec3 b, double s)
{
    return (struct dvec3){a.x + b.x * s, a.y + b.y * s, a.z + b.z * s};
}

static inline struct dvec3 dvec3_sub(struct dvec3 a, struct dvec3 b)
{
    return (struct dvec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline double dvec3_dot(struct dvec3 a, struct dvec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct dvec3 dvec3_cross(struct dvec3 a, struct dvec3 b)
{
    return (struct dvec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/* The zero vector stays zero. */
static inline struct dvec3 dvec3_unit(struct dvec3 a)
{
    double length = sqrt(dvec3_dot(a, a));
    return length > 0.0 ? (struct dvec3){a.x / length, a.y / length, a.z / length} : a;
}

/* Three doubles in a row. */
static inline double double3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void double3_sub(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = a[i] - b[i];
}

static inline void double3_cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static inline double double3_length(const double v[3])
{
    return sqrt(double3_dot(v, v));
}

/* The area of the parallelogram with these sides. */
static inline double double3_area(const double u[3], const double v[3])
{
    double across[3];
    double3_cross(u, v, across);
    return double3_length(across);
}

static inline double double3_distance(const double a[3], const double b[3])
{
    double d[3];
    double3_sub(a, b, d);
    return double3_length(d);
}

/* The zero vector stays zero. */
static inline void double3_unit(double v[3])
{
    double length = sqrt(double3_dot(v, v));
    for (int i = 0; length > 0.0 && i < 3; ++i)
        v[i] /= length;
}

/* Makes v unit, whatever its size. False, with v unchanged: it is 0 or not finite. */
static inline bool double3_normalize(double v[3])
{
    double largest = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(largest > 0.0) || !isfinite(largest))
        return false;
    for (int i = 0; i < 3; ++i)
        v[i] /= largest;
    double length = double3_length(v);
    for (int i = 0; i < 3; ++i)
        v[i] /= length;
    return true;
}

/* Boxes from lo to hi: an empty one, and one that grows by a point. */
static inline void double3_no_box(double lo[3], double hi[3])
{
    for (int i = 0; i < 3; ++i) {
        lo[i] = INFINITY;
        hi[i] = -INFINITY;
    }
}

static inline void double3_grow_box(double lo[3], double hi[3], const double at[3])
{
    for (int i = 0; i < 3; ++i) {
        lo[i] = fmin(lo[i], at[i]);
        hi[i] = fmax(hi[i], at[i]);
    }
}

#endif
