/* Scenes of models, and boxes to look into. */
#ifndef TESTS_SCENE_MODEL_FIXTURE_H
#define TESTS_SCENE_MODEL_FIXTURE_H

#include "../scenes.h"
#include "base/array.h"
#include "base/vec.h"
#include "scene/scene.h"
#include "scene/shapes.h"
#include "unit.h"

static inline struct scene *empty_scene(void)
{
    struct scene *scene = scene_begin(NULL, "test");
    scene_put_material(scene, material_grey("plain"));
    return scene;
}

/* Freezes a model that is seen from `eye`. */
static inline struct scene *seen_from(struct scene *scene, const double eye[3],
                                      const double target[3], double fov_y)
{
    scene_put_camera(scene, eye, target, fov_y);
    scene->is_model = true;
    return scene_ready(scene);
}

/* The walls of a box of half size `half` around the origin, seen from inside, but for those in
   `open`: bit 2 * axis + (1: the high side). `turned`: seen from outside. */
static inline struct scene_mesh walls(const float half[3], unsigned open, bool turned)
{
    struct scene_mesh mesh = mesh_zeroed(6 * 4, 6 * 2);
    mesh.vertex_count = mesh.triangle_count = 0;
    for (uint32_t wall = 0; wall < 6; ++wall) {
        if (open >> wall & 1)
            continue;
        uint32_t axis = wall / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        float side = wall & 1 ? 1.0f : -1.0f;
        for (uint32_t i = 0; i < 4; ++i) {
            float *p = mesh.positions + 3 * (size_t)(mesh.vertex_count + i);
            p[axis] = side * half[axis];
            p[u] = (i == 1 || i == 2 ? 1.0f : -1.0f) * half[u];
            p[v] = (i >= 2 ? 1.0f : -1.0f) * half[v];
        }
        bool outward = side > 0.0f; /* of u, v going round as 0 1 2 3 */
        const uint32_t order[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 2, 1, 0, 3, 2}};
        for (uint32_t i = 0; i < 6; ++i)
            mesh.indices[3 * mesh.triangle_count + i] =
                mesh.vertex_count + order[outward != turned][i];
        mesh.vertex_count += 4;
        mesh.triangle_count += 2;
    }
    return mesh;
}

#endif
