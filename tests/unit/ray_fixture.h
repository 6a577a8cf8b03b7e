/* Rays that meet a scene where tests break. */
#ifndef TESTS_RAY_FIXTURE_H
#define TESTS_RAY_FIXTURE_H

#include "render_fixture.h"

enum { RAYS = 20000 };

/* A vertex or a point of an edge of a random triangle in world space, where tests break. */
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

/* A quarter each: random, aimed, axis-parallel, short. */
static inline void aim_rays(const struct fixture *f, struct gpu_ray *rays, uint64_t state)
{
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(f->scene, 0.0, &pose), WHIT_OK);
    for (uint32_t i = 0; i < RAYS; ++i) {
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

#endif
