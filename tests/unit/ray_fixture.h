/* Rays at the hardest points of a scene, and comparison of their hits with the float mirror. */
#ifndef TESTS_RAY_FIXTURE_H
#define TESTS_RAY_FIXTURE_H

#include "render/renderer.h"
#include "render_fixture.h"
#include "scene/pose.h"
#include "twin/traverse.h"

/* A vertex or a point of an edge of a random triangle, in world space. */
static inline void aim_at_scene(const struct fixture *f, const struct scene_pose *pose,
                                uint64_t *state, double out[3])
{
    const struct scene *scene = f->scene;
    uint32_t i = random_below(state, scene->instance_count);
    while (scene->meshes[scene->instances[i].mesh].triangle_count == 0)
        i = (i + 1) % scene->instance_count;
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
    uint32_t triangle = random_below(state, mesh->triangle_count);
    double s = random_below(state, 2) ? 0.0 : random_unit(state);
    const float *a = &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)triangle]];
    const float *b = &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)triangle + 1]];
    double at[3];
    for (int k = 0; k < 3; ++k)
        at[k] = (double)a[k] + s * ((double)b[k] - (double)a[k]);
    affine_point(&pose->instances[i], at, out);
}

/* Makes rays, a quarter each: random, aimed at the scene, parallel to an axis, short. */
static inline void aim_rays(const struct fixture *f, struct gpu_ray *rays, uint32_t count,
                            uint64_t state)
{
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(f->scene, 0.0, &pose), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_ray *ray = &rays[i];
        double target[3];
        aim_at_scene(f, &pose, &state, target);
        *ray = (struct gpu_ray){.t_max = INFINITY};
        for (int k = 0; k < 3; ++k) {
            double center = 0.5 * (pose.lo[k] + pose.hi[k]);
            double size = pose.hi[k] - pose.lo[k] + 1e-3;
            ray->origin[k] = (float)(center + size * 1.5 * random_signed(&state));
            ray->dir[k] = i % 4 == 0 ? random_float_signed(&state)
                                     : (float)(target[k] - (double)ray->origin[k]);
        }
        if (i % 4 == 2) {
            uint32_t axis = random_below(&state, 3);
            for (uint32_t k = 0; k < 3; ++k) {
                if (k != axis) {
                    ray->origin[k] = (float)target[k];
                    ray->dir[k] = i & 8 ? -0.0f : 0.0f;
                }
            }
        }
        if (i % 4 == 3) {
            ray->t_min = 0.25f;
            ray->t_max = 1.0f;
        }
    }
    scene_pose_finish(&pose);
}

/* Makes rays, half of them towards random points in the scene's bounds, half in any direction. */
static inline void aim_at_bounds(const struct fixture *f, struct gpu_ray *rays, uint32_t count,
                                 uint64_t state)
{
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(f->scene, 0.0, &pose), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        rays[i] = (struct gpu_ray){.t_max = i % 8 == 7 ? 0.7f : INFINITY};
        for (int k = 0; k < 3; ++k) {
            double center = 0.5 * (pose.lo[k] + pose.hi[k]), size = pose.hi[k] - pose.lo[k] + 1e-3;
            rays[i].origin[k] = (float)(center + size * 1.2 * (double)random_float_signed(&state));
            double at = center + 0.5 * size * (double)random_float_signed(&state);
            rays[i].dir[k] =
                i & 1 ? random_float_signed(&state) : (float)(at - (double)rays[i].origin[k]);
        }
    }
    rays[1] = (struct gpu_ray){.dir = {0, 0, 0}}; /* an empty interval: valid, hits nothing */
    rays[2] = (struct gpu_ray){.dir = {0, -0.0f, 1}, .t_max = INFINITY};
    scene_pose_finish(&pose);
}

/* ---- Device and float mirror ---- */

/* Numbers of the device's hits, and of its costs where they are counted, that differ in some bit
   from those of the float mirror. Two answers of an any-hit query differ where only one of them is
   a hit. The costs of the float mirror are added to *sum. */
struct unlike {
    uint32_t hits, costs;
};

static inline struct unlike trace_beside_twin(const struct fixture *f, bool any,
                                              const struct gpu_ray *rays, uint32_t count,
                                              struct gpu_hit *hits, whit_cost *sum)
{
    const whit_renderer_params *params = &f->renderer->params;
    const struct traverse_params twin = {
        .order = (uint32_t)params->traversal, .numerics = params->numerics, .any = any};
    own_memory struct gpu_cost *costs = params->count ? array_alloc(count, sizeof *costs) : NULL;
    struct unlike unlike = {0};
    uint32_t status = 0;
    assert_int_equal(renderer_trace(f->renderer, rays, count, any, hits, costs), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_hit hit;
        struct gpu_cost cost = {0};
        traverse_ray(f->accel, &twin, &rays[i], &hit, &cost, &status);
        unlike.hits += any ? (hit.primitive != HIT_NONE) != (hits[i].primitive != HIT_NONE)
                           : memcmp(&hit, &hits[i], sizeof hit) != 0;
        unlike.costs += costs && memcmp(&cost, &costs[i], sizeof cost) != 0;
        if (sum)
            cost_add(sum, &cost);
    }
    assert_int_equal(status, 0);
    return unlike;
}

/* Number of rays that hit something. */
static inline uint32_t count_met(const struct gpu_hit *hits, uint32_t count)
{
    uint32_t met = 0;
    for (uint32_t i = 0; i < count; ++i)
        met += hits[i].primitive != HIT_NONE;
    return met;
}

/* Checks that the device's closest hits, which are left in `hits`, equal those of the float mirror,
   that any-hit finds a hit exactly where closest-hit does, and that costs of both equal those of
   the float mirror. */
static inline void check_rays(const struct fixture *f, const char *label,
                              const struct gpu_ray *rays, uint32_t count, struct gpu_hit *hits)
{
    own_memory struct gpu_hit *any = array_alloc(count, sizeof *any);
    assert_non_null(any);
    struct unlike closest = trace_beside_twin(f, false, rays, count, hits, NULL);
    struct unlike blocked = trace_beside_twin(f, true, rays, count, any, NULL);
    uint32_t met = count_met(hits, count), torn = 0;
    for (uint32_t i = 0; i < count; ++i)
        torn += (any[i].primitive != HIT_NONE) != (hits[i].primitive != HIT_NONE);
    print_message("  %s: %u rays, %u hit; unlike the twin %u, any hits %u, by their costs %u and "
                  "%u; any hits unlike the closest %u\n",
                  label, count, met, closest.hits, blocked.hits, closest.costs, blocked.costs,
                  torn);
    if (closest.hits + blocked.hits + closest.costs + blocked.costs + torn > 0)
        fail_msg("%s: device and twin differ", label);
    assert_in_range(met, count / 10, count - 1);
}

#endif
