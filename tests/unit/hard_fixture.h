/* The settings of numerics (levels) and what each promises, for tests of the catalogue of hard
   cases (docs/hard-cases.md). Letters and numbers in these tests are entries of that catalogue: B
   box, T triangle, W watertight. */
#ifndef TESTS_HARD_FIXTURE_H
#define TESTS_HARD_FIXTURE_H

#include "accel_fixture.h"

#include "owned_rational.h"
#include "twin/exact.h"
#include "twin/intersect.h"
#include "twin/moller.h"

struct level {
    const char *name;
    uint32_t numerics; /* NUMERICS_* */
    bool watertight;   /* promises that no ray gets through a closed surface */
    bool exact;        /* promises the hits of oracle/rational.h */
};

static const struct level levels[] = {
    {"watertight", NUMERICS_WATERTIGHT, true, false},
    {"exact", NUMERICS_EXACT, true, true},
};

enum { LEVELS = sizeof levels / sizeof *levels };

/* `fast` promises nothing, also not that closed surfaces have no leaks. */
static const struct level fast_level = {"fast", NUMERICS_FAST, false, false};

/* The test of a box by the traversal (step_siblings in traverse.c): t of entry and exit. */
static inline bool level_enters(const struct level *level, const struct ray_setup *ray,
                                const float lo[3], const float hi[3], float t_min, float t_max,
                                float *t_near, float *t_far)
{
    struct ray_setup bounded = *ray;
    if (level->exact) {
        t_min = fmaxf(t_min, 0x1p-144f); /* NEAR_MIN */
        bound_ray_setup(&bounded);
    }
    slab_interval(&bounded, vec3_sub(vec3_load(lo), ray->origin),
                  vec3_sub(vec3_load(hi), ray->origin), t_min, t_near, t_far);
    if (level->exact)
        *t_near = float_of_bits(float_bits(*t_near) - 32); /* NEAR_STEPS */
    return *t_near <= *t_far && *t_near <= t_max;
}

/* The test of a single triangle at a level, without a tree. */
static inline bool level_meets(const struct level *level, const struct gpu_ray *ray,
                               const struct vec3 v[3], struct gpu_hit *hit)
{
    struct ray_setup setup = make_ray_setup(vec3_load(ray->origin), vec3_load(ray->dir));
    if (level->numerics == NUMERICS_EXACT) {
        struct exact_candidate exact;
        exact_meet(setup.origin, setup.dir, v[0], v[1], v[2], &exact);
        *hit = (struct gpu_hit){.t = exact.key, .u = exact.u, .v = exact.v};
        return exact.met && exact.key >= ray->t_min && exact.key <= ray->t_max;
    }
    bool met = level->numerics == NUMERICS_FAST
                   ? intersect_moller(setup.origin, setup.dir, v[0], v[1], v[2], ray->t_min,
                                      &hit->t, &hit->u, &hit->v)
                   : intersect_triangle(&setup, vec3_sub(v[0], setup.origin),
                                        vec3_sub(v[1], setup.origin), vec3_sub(v[2], setup.origin),
                                        ray->t_min, &hit->t, &hit->u, &hit->v);
    return met && hit->t <= ray->t_max;
}

static inline struct gpu_hit level_trace(const struct level *level, const struct accel *accel,
                                         uint32_t order, bool any, const struct gpu_ray *ray)
{
    const struct traverse_params params = {.order = order, .numerics = level->numerics, .any = any};
    return trace_with(accel, params, ray, NULL);
}

/* The closest hit at a level by testing all triangles. */
static inline struct gpu_hit level_brute(const struct level *level, const struct accel *accel,
                                         const struct gpu_ray *ray)
{
    const struct traverse_params params = {.numerics = level->numerics, .brute = true};
    return trace_with(accel, params, ray, NULL);
}

#endif
