/* Hard rays and triangles: of all sizes, exactly through edges and vertices, with t halfway between
   two floats, edge-on, without area. */
#ifndef TESTS_HARD_TRIANGLE_FIXTURE_H
#define TESTS_HARD_TRIANGLE_FIXTURE_H

#include "hard_fixture.h"

#include "coordinate_fixture.h"

struct subject {
    struct vec3 origin, dir, v[3];
};

static inline struct subject scattered(float (*coordinate)(void))
{
    struct subject s;
    s.origin = point_of(coordinate);
    s.dir = point_of(coordinate);
    for (int i = 0; i < 3; ++i)
        s.v[i] = point_of(coordinate);
    return s;
}

static inline struct vec3 weighted(const struct vec3 v[3], float a, float b)
{
    struct vec3 p = vec3_add(vec3_scale(v[0], a), vec3_scale(v[1], b));
    return vec3_add(p, vec3_scale(v[2], 1.0f - a - b));
}

/* A point inside of the triangle, well away from its edges. */
static inline struct vec3 inner_point(const struct vec3 v[3])
{
    float a = 0.1f + 0.3f * random_float(&random_state),
          b = 0.1f + 0.3f * random_float(&random_state);
    return weighted(v, a, b);
}

/* A triangle within `spread` of a point in a cube of half size `around`, and a ray from a cube of
   half size `away`, aimed to miss it by up to `beside` of its size. */
static inline struct subject seen_from(float spread, float around, float away, float beside)
{
    struct subject s = {.origin = random_point(away)};
    struct vec3 middle = random_point(around);
    for (int i = 0; i < 3; ++i)
        s.v[i] = vec3_add(middle, random_point(spread));
    float a = (1.0f + 2.0f * beside) * random_float(&random_state) - beside,
          b = (1.0f + 2.0f * beside) * random_float(&random_state) - beside;
    s.dir = vec3_sub(weighted(s.v, a, b), s.origin);
    return s;
}

static inline struct subject make_ordinary(void)
{
    return seen_from(1.0f, 3.0f, 10.0f, 0.25f);
}

static inline struct subject make_far(void)
{
    return seen_from(0.05f, 0.0f, 1e7f, 0.0f);
}

static inline struct subject make_tiny(void)
{
    return seen_from(1e-8f, 1e-6f, 1e-6f, 0.0f);
}

static inline struct subject make_huge(void)
{
    return seen_from(1e6f, 1e7f, 1e11f, 0.0f);
}

static inline struct subject make_unit(void)
{
    struct subject s = scattered(in_cube);
    s.origin = vec3_scale(s.origin, 3.0f);
    s.dir = vec3_sub(inner_point(s.v), s.origin);
    return s;
}

/* A triangle that is seen neither at a grazing angle nor from near by. */
static inline struct subject make_well_conditioned(void)
{
    struct subject s;
    float facing;
    do {
        s = make_unit();
        struct vec3 n = vec3_cross(vec3_sub(s.v[1], s.v[0]), vec3_sub(s.v[2], s.v[0]));
        facing = fabsf(vec3_dot(n, s.dir)) / vec3_length(s.dir);
    } while (facing <= 0.25f || vec3_length(vec3_sub(s.origin, s.v[0])) <= 0.5f);
    return s;
}

static inline struct subject make_any_size(void)
{
    struct subject s = scattered(of_any_size);
    s.dir = vec3_sub(inner_point(s.v), s.origin);
    return s;
}

/* A ray at a vertex or a point of an edge, with its direction rounded to floats. */
static inline struct subject make_at_edge(void)
{
    struct subject s = make_unit();
    float along = random_below(&random_state, 2) ? 0.0f : random_float(&random_state);
    s.dir = vec3_sub(vec3_add(s.v[0], vec3_scale(vec3_sub(s.v[1], s.v[0]), along)), s.origin);
    return s;
}

/* A ray exactly through a vertex, or the middle of an edge. */
static inline struct subject make_at_edge_of_grid(void)
{
    struct subject s = scattered(of_grid);
    struct vec3 target = s.v[0];
    if (random_below(&random_state, 2))
        target = vec3_scale(vec3_add(s.v[0], s.v[1]), 0.5f);
    s.dir = vec3_scale(vec3_sub(target, s.origin), either(1.0f, -0.25f));
    return s;
}

static inline float of_large_grid(void)
{
    return (float)((int)random_below(&random_state, 1 << 22) - (1 << 21));
}

/* A ray exactly through the middle of an edge, where the edge function is 0 and its terms have 68
   bits. */
static inline struct subject make_on_edge(void)
{
    struct subject s = {.origin = vec3_scale(point_of(of_large_grid), 2.0f)};
    struct vec3 middle = point_of(of_large_grid), half = vec3_scale(point_of(of_grid), 0x1p18f);
    half = vec3_add(half, point_of(of_grid));
    s.v[0] = vec3_sub(middle, half);
    s.v[1] = vec3_add(middle, half);
    s.v[2] = point_of(of_large_grid);
    s.dir = vec3_sub(middle, s.origin);
    return s;
}

static inline float of_even_grid(void)
{
    return 2.0f * (float)((int)random_below(&random_state, 10001) - 5000);
}

/* A hit at t = 2^24 + 1, exactly halfway between two floats. */
static inline struct subject make_between(void)
{
    struct subject s = {.dir = vec3_make(either(-1, 1), either(-1, 1), either(-1, 1))};
    s.origin = vec3_add(vec3_scale(point_of(of_grid), 16.0f), vec3_make(1, 1, 1));
    struct vec3 p = vec3_add(vec3_scale(s.dir, 0x1p24f), vec3_add(s.origin, s.dir));
    struct vec3 a = point_of(of_even_grid), b = point_of(of_even_grid);
    s.v[0] = vec3_add(p, a);
    s.v[1] = vec3_add(p, b);
    s.v[2] = vec3_sub(p, vec3_add(a, b));
    return s;
}

/* A triangle in the plane of height `z`, and a ray along the z axis: t = (z - origin) / dir. */
static inline struct subject wall(float z, float origin, float dir)
{
    return (struct subject){{0, 0, origin}, {0, 0, dir}, {{-2, -1, z}, {2, -1, z}, {0, 2, z}}};
}

/* Hits with t halfway between two floats, or close to that: from 2^25 to 2^26 floats are 4
   apart. */
static inline struct subject make_tie(void)
{
    static const float origins[] = {-1.0f, -2.0f, -3.0f, -2.0f - 0x1p-22f, -2.0f + 0x1p-23f};
    float z = 0x1p25f + 4.0f * (float)random_below(&random_state, 1u << 23);
    int scale = (int)random_below(&random_state, 40) - 20;
    return wall(z, origins[random_below(&random_state, 5)], ldexpf(1.0f, scale));
}

/* Hits with t a multiple of 2^-150. */
static inline struct subject make_denormal_tie(void)
{
    return wall(ldexpf((float)random_below(&random_state, 20000), -100), 0.0f, 0x1p50f);
}

static inline struct subject make_needle(void)
{
    struct subject s = make_unit();
    float width = (float)pow(10.0, -6.0 - 6.0 * (double)random_float(&random_state));
    s.v[2] = vec3_add(s.v[1], random_point(width));
    s.dir = vec3_sub(random_below(&random_state, 2) ? inner_point(s.v) : s.v[0], s.origin);
    return s;
}

/* A ray that starts 1e-3 to 1e-7 above the triangle's plane, almost parallel to it. */
static inline struct subject make_grazing(void)
{
    struct subject s = make_unit();
    struct vec3 n = vec3_cross(vec3_sub(s.v[1], s.v[0]), vec3_sub(s.v[2], s.v[0])),
                far = vec3_sub(vec3_scale(s.v[0], 3.0f), vec3_scale(s.v[1], 2.0f));
    float height = (float)pow(10.0, -3.0 - 4.0 * (double)random_float(&random_state));
    s.origin = vec3_add(far, vec3_scale(vec3_normalize(n), height));
    s.dir = vec3_sub(inner_point(s.v), s.origin);
    return s;
}

/* Origin and direction are in the triangle's plane, which is axis-aligned. */
static inline struct subject make_coplanar(void)
{
    struct subject s = scattered(random_below(&random_state, 2) ? of_grid : in_cube);
    uint32_t axis = random_below(&random_state, 3);
    float *of[5] = {&s.origin.x, &s.dir.x, &s.v[0].x, &s.v[1].x, &s.v[2].x};
    for (int i = 0; i < 5; ++i)
        of[i][axis] = i == 1 ? 0.0f : 0.75f;
    return s;
}

/* A ray in the plane of an integer triangle. */
static inline struct subject make_in_plane(void)
{
    struct subject s = scattered(of_grid);
    struct vec3 e = vec3_sub(s.v[1], s.v[0]), f = vec3_sub(s.v[2], s.v[0]);
    s.origin = vec3_sub(vec3_sub(s.v[0], e), f);
    s.dir = vec3_sub(vec3_add(s.v[0], random_below(&random_state, 2) ? e : f), s.origin);
    return s;
}

static inline struct subject make_equal_corners(void)
{
    struct subject s = make_ordinary();
    uint32_t i = random_below(&random_state, 3);
    s.v[i] = s.v[(i + 1) % 3];
    s.dir = vec3_sub(s.v[i], s.origin);
    return s;
}

/* A triangle with two or three equal corners, or three on a line. */
static inline struct subject make_without_area(void)
{
    struct subject s = make_at_edge_of_grid();
    uint32_t kind = random_below(&random_state, 3);
    if (kind == 0)
        s.v[1] = s.v[0];
    s.v[2] = kind == 2 ? vec3_sub(vec3_scale(s.v[1], 2.0f), s.v[0]) : s.v[0];
    return s;
}

/* Kinds of triangles that no ray hits have integer coordinates, so that no point is moved by
   rounding. The shear of the watertight test is rounded all the same, so that it may hit a triangle
   that is seen edge-on; scenes have no triangle without area. */
enum {
    FLOATS = 1, /* sizes are within what `watertight` promises */
    EDGES = 2,  /* some rays go exactly through edges and vertices */
    PLAIN = 4,  /* easy: nearly all answers of all levels are right */
    GOOD = 8,   /* t is far more accurate than its bound */
};

static const struct triangle_kind {
    const char *name;
    float (*coordinate)(void); /* for scattered triangles */
    struct subject (*make)(void);
    double met_min;            /* least share of rays that hit; 0: no ray may hit */
    double sure_min, sure_max; /* share that float-floats decide */
    int what;
} triangle_kinds[] = {
    {"cube", in_cube, NULL, 0.01, 0, 1, FLOATS},
    {"T1 10^-8 to 10^8, anywhere", of_any_size, NULL, 0.01, 0, 1, FLOATS},
    {"2^-100 to 2^100", of_extreme_size, NULL, 0.01, 0, 1, 0},
    {"grid", of_grid, NULL, 0.01, 0, 1, FLOATS | EDGES},
    {"denormals", denormal, NULL, 0.01, 0, 1, 0},
    {"any bits", of_any_bits, NULL, 0.01, 0, 1, 0},
    {"ordinary", NULL, make_ordinary, 0.1, 0.999, 1, FLOATS},
    {"inside", NULL, make_unit, 0.9, 0, 1, FLOATS | PLAIN},
    {"T1 well conditioned", NULL, make_well_conditioned, 0.9, 0, 1, FLOATS | PLAIN | GOOD},
    {"T1 10^-8 to 10^8", NULL, make_any_size, 0.05, 0, 1, FLOATS},
    {"at edges", NULL, make_at_edge, 0.05, 0, 1, FLOATS},
    {"at edges of a grid", NULL, make_at_edge_of_grid, 0.05, 0, 1, FLOATS | EDGES},
    {"exactly on an edge", NULL, make_on_edge, 0.9, 0, 0.01, FLOATS},
    {"t between two floats", NULL, make_between, 0.9, 0, 0.01, FLOATS},
    {"t beside the middle of floats", NULL, make_tie, 0.9, 0, 1, FLOATS},
    {"t between denormals", NULL, make_denormal_tie, 0.9, 0, 1, 0},
    {"from far away", NULL, make_far, 0.1, 0.99, 1, FLOATS},
    {"tiny", NULL, make_tiny, 0.1, 0.99, 1, FLOATS},
    {"huge", NULL, make_huge, 0.1, 0.99, 1, FLOATS},
    {"T2 needles", NULL, make_needle, 0.05, 0, 1, FLOATS},
    {"T4 grazing", NULL, make_grazing, 0.05, 0, 1, FLOATS},
    {"T5 coplanar", NULL, make_coplanar, 0, 0, 1, FLOATS},
    {"T5 in a plane of integers", NULL, make_in_plane, 0, 0, 1, FLOATS},
    {"T3 without area", NULL, make_without_area, 0, 0, 1, FLOATS},
    {"T3 equal corners", NULL, make_equal_corners, 0, 1, 1, 0},
};

#endif
