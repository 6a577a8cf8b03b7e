/* Spheres for tests: scattered, of many sizes, some twice at one place. */
#ifndef TESTS_SPHERE_FIXTURE_H
#define TESTS_SPHERE_FIXTURE_H

#include <math.h>

#include "../scenes.h"
#include "random_fixture.h"

static inline double sphere_random(void)
{
    return (double)random_float_signed(&random_state);
}

/* Centres are within a cube of half side `spread`; radii from `max` down to a thousandth of it.
   Every tenth sphere repeats the one before, so that rays hit both at the same distance. */
static inline struct scene_mesh scattered_spheres(uint32_t count, double spread, double max)
{
    own_memory double *spheres = malloc(4 * sizeof(double) * count);
    assert_non_null(spheres);
    for (uint32_t i = 0; i < count; ++i) {
        for (size_t k = 0; k < 3; ++k)
            spheres[4 * (size_t)i + k] = spread * sphere_random();
        spheres[4 * (size_t)i + 3] = max * pow(10.0, -3.0 * (double)random_float(&random_state));
        if (i % 10 == 9)
            memcpy(&spheres[4 * (size_t)i], &spheres[4 * (size_t)i - 4], 4 * sizeof(double));
    }
    return mesh_balls(spheres, count);
}

/* A scene of `mesh`, not frozen: once without a transform and, with `placed`, also as eleven
   instances at random places. */
static inline struct scene *sphere_scene(const whit_log *log, struct scene_mesh mesh, bool placed)
{
    struct scene *scene = scene_begin(log, "spheres");
    scene_put(scene, mesh, NULL);
    for (uint32_t i = 1; i < 12 && placed; ++i) {
        struct affine matrix = placement_random(&random_state, 1.5, i % 3 == 0);
        scene_put_again(scene, 0, &(struct put){.matrix = &matrix});
    }
    return scene;
}

/* A ray; a quarter each goes anywhere, to a sphere, past it within a millionth of its radius, or
   starts inside of it. Origins are up to `away` radii from that sphere. */
static inline struct gpu_ray ray_at_spheres(const struct scene_mesh *mesh, uint32_t index,
                                            double away)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    const float *sphere =
        &mesh->spheres[4 * (size_t)random_below(&random_state, mesh->sphere_count)];
    double radius = (double)sphere[3], out[3], side[3], length = 0.0, along = 0.0;
    double far = index % 4 == 3 ? (double)random_float(&random_state)
                                : pow(away, (double)random_float(&random_state));
    for (int k = 0; k < 3; ++k) {
        out[k] = sphere_random();
        side[k] = sphere_random();
        length += out[k] * out[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; ++k)
        along += out[k] * side[k] / (length * length);
    double width = 0.0;
    for (int k = 0; k < 3; ++k) {
        side[k] -= along * out[k];
        width += side[k] * side[k];
    }
    width = sqrt(width);
    double offset =
        index % 4 == 2 ? 1.0 + 1e-6 * sphere_random() : (double)random_float(&random_state);
    for (int k = 0; k < 3; ++k) {
        double from = (double)sphere[k] + radius * far * out[k] / length;
        double to = (double)sphere[k] + radius * offset * side[k] / width;
        ray.origin[k] = (float)from;
        ray.dir[k] = (float)(index % 4 == 0 ? sphere_random() : to - (double)ray.origin[k]);
    }
    return ray;
}

#endif
