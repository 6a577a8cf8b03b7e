/* Hard rays and spheres for numerics `exact`: near and far, of all sizes, exactly tangent, with t
   halfway between two floats, from the surface. */
#ifndef TESTS_HARD_SPHERE_FIXTURE_H
#define TESTS_HARD_SPHERE_FIXTURE_H

#include "hard_fixture.h"

#include "coordinate_fixture.h"
#include "twin/exact_sphere.h"

struct subject {
    struct vec3 origin, dir, center;
    float radius, t_min;
};

typedef struct subject (*make_fn)(void);

/* A ray through the sphere or past it; a third of them graze it. */
static inline struct subject aim(float radius, float away, float size)
{
    struct subject s = {.radius = radius, .center = random_point(size)};
    s.origin = vec3_add(s.center, random_point(away));
    struct vec3 to = random_point(1.0f);
    uint32_t kind = random_below(&random_state, 3);
    if (kind == 0) { /* from the line's side at about one radius */
        struct vec3 along = vec3_sub(s.center, s.origin), side = vec3_cross(along, to);
        float length = sqrtf(vec3_dot(side, side));
        to = length > 0.0f ? vec3_scale(side, 1.0f / length) : to;
    }
    s.dir = vec3_sub(vec3_add(s.center, vec3_scale(to, radius)), s.origin);
    return s;
}

static inline struct subject make_ordinary(void)
{
    return aim(0.1f + random_float(&random_state), 5.0f, 3.0f);
}

static inline struct subject make_inside(void)
{
    return aim(1.0f + random_float(&random_state), 0.5f, 3.0f);
}

static inline struct subject make_far(void)
{
    return aim(0.1f + random_float(&random_state), 1e7f, 3.0f);
}

static inline struct subject make_tiny(void)
{
    return aim(1e-9f * random_float(&random_state), 1e-7f, 1e-8f);
}

static inline struct subject make_huge(void)
{
    return aim(1e11f * random_float(&random_state), 1e13f, 1e12f);
}

/* Numbers so small that their squares are 0 in floats. */
static inline struct subject make_denormal(void)
{
    return aim(1e-40f * random_float(&random_state), 1e-38f, 1e-39f);
}

/* Directions whose squares or reciprocals overflow or vanish in floats, or that have components
   that are lost in sums. */
static inline struct subject make_stretched(void)
{
    struct subject s = make_ordinary();
    static const float sizes[] = {1e-40f, 1e-33f, 1e33f};
    s.dir = vec3_scale(s.dir, sizes[random_below(&random_state, 3)]);
    if (random_below(&random_state, 2))
        s.dir.x *= 1e-30f;
    s.radius = random_below(&random_state, 2) ? 3.0f : s.radius;
    return s;
}

/* Directions within one float of the shortest that the filter accepts. */
static inline struct subject make_short(void)
{
    static const float next_to[] = {0.0f, 1.0f, 0x1p-100f};
    struct subject s = make_ordinary();
    float *axis[] = {&s.dir.x, &s.dir.y, &s.dir.z};
    uint32_t longest = 0;
    for (uint32_t k = 1; k < 3; ++k)
        longest = fabsf(*axis[k]) > fabsf(*axis[longest]) ? k : longest;
    float scale = 0x1p-100f / fabsf(*axis[longest]);
    float length = nextafterf(0x1p-100f, next_to[random_below(&random_state, 3)]);
    *axis[longest] = *axis[longest] < 0.0f ? -length : length;
    for (uint32_t k = 0; k < 3; ++k)
        *axis[k] *= k == longest ? 1.0f : scale;
    return s;
}

/* Rays that pass a sphere as close as its radius, a float, can express: within 2^-25 of it. */
static inline struct subject make_grazing(void)
{
    struct subject s = {.origin = random_point(1.0f), .center = random_point(1.0f)};
    float way = powf(0.1f, 9.0f * random_float(&random_state));
    s.dir = vec3_sub(vec3_add(s.center, random_point(way)), s.origin);
    const double m[3] = {(double)s.center.x - (double)s.origin.x,
                         (double)s.center.y - (double)s.origin.y,
                         (double)s.center.z - (double)s.origin.z};
    const double d[3] = {(double)s.dir.x, (double)s.dir.y, (double)s.dir.z};
    double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], cross2 = 0.0;
    for (int k = 0; k < 3; ++k) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        cross2 += (m[i] * d[j] - m[j] * d[i]) * (m[i] * d[j] - m[j] * d[i]);
    }
    s.radius = (float)sqrt(cross2 / dd);
    return s;
}

struct frame {
    struct vec3 x, y;
    float length; /* of x and y, which are orthogonal; all are integers */
};

/* Makes two vectors of integers at right angles from a random integer quaternion (Euler,
   Rodrigues). */
static inline struct frame integer_frame(int max)
{
    int a = 1 + (int)random_below(&random_state, (uint32_t)max),
        b = (int)random_below(&random_state, (uint32_t)max);
    int c = (int)random_below(&random_state, (uint32_t)max),
        d = (int)random_below(&random_state, (uint32_t)max);
    return (struct frame){
        .x = vec3_make((float)(a * a + b * b - c * c - d * d), (float)(2 * (b * c + a * d)),
                       (float)(2 * (b * d - a * c))),
        .y = vec3_make((float)(2 * (b * c - a * d)), (float)(a * a - b * b + c * c - d * d),
                       (float)(2 * (c * d + a * b))),
        .length = (float)(a * a + b * b + c * c + d * d)};
}

static inline struct vec3 grid_point(int max)
{
    float range = (float)(2 * max + 1), middle = (float)max;
    float x = floorf(random_float(&random_state) * range) - middle,
          y = floorf(random_float(&random_state) * range) - middle;
    return vec3_make(x, y, floorf(random_float(&random_state) * range) - middle);
}

/* A ray that touches the sphere in exactly one point. */
static inline struct subject make_tangent(void)
{
    struct frame f = integer_frame(20);
    struct subject s = {.origin = grid_point(10000), .dir = f.x};
    float k = (float)(1 + random_below(&random_state, 50)), along = floorf(random_within(100.0f));
    s.radius = k * f.length;
    s.center = vec3_add(s.origin, vec3_add(vec3_scale(f.y, either(k, -k)), vec3_scale(f.x, along)));
    return s;
}

/* The same with the radius one float larger or smaller. */
static inline struct subject make_nearly_tangent(void)
{
    struct subject s = make_tangent();
    s.radius = nextafterf(s.radius, random_below(&random_state, 2) ? INFINITY : 0.0f);
    return s;
}

/* A ray through the centre; both t are integers with one bit more than a float has. */
static inline struct subject make_between(void)
{
    struct frame f = integer_frame(3);
    float half = (float)random_below(&random_state, 64),
          t = (float)(64 + random_below(&random_state, 64));
    struct subject s = {.dir = f.x, .radius = (half + 1.0f) * f.length};
    s.origin = vec3_scale(f.x, -16777216.0f);
    s.center = vec3_scale(f.x, t);
    return s;
}

/* Rays that start on the sphere and go inwards, outwards or along it. */
static inline struct subject make_on_surface(void)
{
    struct frame f = integer_frame(20);
    struct subject s = {.center = grid_point(10000), .radius = f.length, .dir = f.x};
    uint32_t kind = random_below(&random_state, 3);
    if (kind < 2)
        s.dir = vec3_add(f.x, vec3_scale(f.y, floorf(random_within(10.0f))));
    s.origin = vec3_add(s.center, f.y);
    return s;
}

/* A ray along z and a sphere at height `z`, with its centre `aside` of the ray. */
static inline struct subject upright(float z, float radius, float aside, float origin, float dir)
{
    return (struct subject){{aside, 0, origin}, {0, 0, dir}, {0, 0, z}, radius, 0.0f};
}

/* The t of both ends of the chord are z -+ half. From 2^25 to 2^26 floats are 4 apart, and half is
   2 more than a multiple of 4, or less than that by 2^-302 to 2^-19. The ray starts outside or
   inside, or touches the sphere in the middle between two floats. */
static inline struct subject make_tie(void)
{
    static const struct {
        float radius, aside, origin;
    } shapes[] = {{6, 0, 0},         {10, 8, 0},           {26, 24, 0},
                  {6, 0x1p-149f, 0}, {2, 0x1p-140f, 0},    {10, 0x1.000002p3f, 0},
                  {5, 5, -2},        {0x1.7ffffep2f, 0, 0}};
    uint32_t shape = random_below(&random_state, 9);
    float z = 4.0f * (float)random_below(&random_state, 1u << 20);
    int scale = (int)random_below(&random_state, 40) - 20;
    if (shape == 8)
        return upright(-2, 0x1.8p25f + z, either(0x1p-149f, 0.0f), 0, 1);
    return upright(0x1p25f + 64.0f + z, shapes[shape].radius, shapes[shape].aside,
                   shapes[shape].origin, ldexpf(1.0f, scale));
}

/* A ray with hits at t = i 2^-150 and (i + 2048) 2^-150. */
static inline struct subject make_denormal_tie(void)
{
    float at = (float)(1024 + random_below(&random_state, 10000));
    return upright(ldexpf(at, -100), 0x1p-90f, 0.0f, 0.0f, 0x1p50f);
}

/* A sphere so small and far away that the keys of both hits are neighbouring floats, or equal. */
static inline struct subject make_small(void)
{
    struct subject s = {.origin = point_of(in_cube), .center = point_of(in_cube)};
    s.radius = ldexpf(random_float(&random_state), -15 - (int)random_below(&random_state, 12));
    s.dir = vec3_add(vec3_sub(s.center, s.origin), vec3_make(random_within(s.radius), 0, 0));
    return s;
}

static inline struct subject scattered(float (*coordinate)(void))
{
    struct subject s = {.origin = point_of(coordinate),
                        .dir = point_of(coordinate),
                        .center = point_of(coordinate)};
    s.radius = fabsf(coordinate());
    return s;
}

static const struct sphere_kind {
    const char *name;
    make_fn make;
    float (*coordinate)(void); /* for scattered subjects */
    double filtered, sure;     /* least shares that the filter, and float-floats, decide */
} sphere_kinds[] = {
    {"ordinary", make_ordinary, NULL, 0.6, 0.99},
    {"grazing", make_grazing, NULL, 0.0, 0.3},
    {"from inside", make_inside, NULL, 0.9, 0.99},
    {"from far away", make_far, NULL, 0.0, 0.99},
    {"tiny", make_tiny, NULL, 0.6, 0.99},
    {"huge", make_huge, NULL, 0.6, 0.0},
    {"denormals", make_denormal, NULL, 0.0, 0.0},
    {"long and short directions", make_stretched, NULL, 0.0, 0.0},
    {"directions of 2^-100", make_short, NULL, 0.03, 0.0},
    {"exactly tangent", make_tangent, NULL, 0.0, 0.0},
    {"tangent but for one float", make_nearly_tangent, NULL, 0.0, 0.9},
    {"t between two floats", make_between, NULL, 0.0, 0.0},
    {"from the surface", make_on_surface, NULL, 0.4, 0.1},
    {"t beside the middle of floats", make_tie, NULL, 0.0, 0.0},
    {"t between denormals", make_denormal_tie, NULL, 0.0, 0.0},
    {"small", make_small, NULL, 0.0, 0.0},
    {"cube", NULL, in_cube, 0.0, 0.0},
    {"10^-8 to 10^8", NULL, of_any_size, 0.0, 0.0},
    {"2^-100 to 2^100", NULL, of_extreme_size, 0.0, 0.0},
    {"grid", NULL, of_grid, 0.0, 0.0},
    {"any denormals", NULL, denormal, 0.0, 0.0},
    {"any bits", NULL, of_any_bits, 0.0, 0.0},
};

enum { SPHERE_KINDS = sizeof sphere_kinds / sizeof *sphere_kinds };

static inline void set_t_min(struct subject *s)
{
    s->t_min = 0.0f;
    struct sphere_candidate m;
    uint32_t kind = random_below(&random_state, 4);
    exact_meet_sphere(s->origin, s->dir, s->center, s->radius, random_below(&random_state, 2), 0.0f,
                      &m);
    if (m.met && kind > 0)
        s->t_min = kind == 1 ? m.key : nextafterf(m.key, kind == 2 ? INFINITY : 0.0f);
}

static inline struct subject make_subject(uint32_t kind)
{
    struct subject s;
    do
        s = sphere_kinds[kind].make ? sphere_kinds[kind].make()
                                    : scattered(sphere_kinds[kind].coordinate);
    while (s.radius == 0.0f || vec3_largest_magnitude(s.dir) == 0.0f);
    set_t_min(&s);
    return s;
}

#endif
