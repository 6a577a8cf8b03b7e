/* Small scenes for tests of kernels. */
#ifndef TESTS_RENDER_SCENES_H
#define TESTS_RENDER_SCENES_H

#include "render_fixture.h"

/* One mesh, not moved. */
static inline struct scene *terrain_scene(void)
{
    struct scene_mesh mesh = {0};
    assert_int_equal(shape_terrain(10.0, 2.0, 40, 3, &mesh), WHIT_OK);
    struct scene *scene = fixture_scene(mesh);
    fixture_place(scene, NULL);
    return scene;
}

/* Forty rings, turned, stretched, some mirrored. */
static inline struct scene *ring_scene(void)
{
    struct scene_mesh mesh = {0};
    assert_int_equal(shape_torus(1.0, 0.3, 20, 10, &mesh), WHIT_OK);
    struct scene *scene = fixture_scene(mesh);
    uint32_t random = 5;
    for (int i = 0; i < 40; ++i) {
        double t[3], q[4], s[3] = {i % 3 == 0 ? -1.0 : 1.0, 0.6, 1.4};
        for (int k = 0; k < 3; ++k)
            t[k] = 4.0 * (double)fixture_signed(&random);
        for (int k = 0; k < 4; ++k)
            q[k] = (double)fixture_signed(&random);
        struct affine placed = affine_from_trs(t, q, s);
        fixture_place(scene, &placed);
    }
    return scene;
}

/* Rings of glass and mirror over terrain, under two lights: with 2 * cells^2 triangles of ground,
   and 4 * sides^2 a ring. */
static inline struct scene *glass_scene_of(uint32_t cells, uint32_t sides)
{
    struct scene_mesh ring = {0}, ground = {0};
    assert_int_equal(shape_torus(1.0, 0.3, 2 * sides, sides, &ring), WHIT_OK);
    assert_int_equal(shape_terrain(10.0, 1.0, cells, 3, &ground), WHIT_OK);
    struct scene *scene = fixture_scene(ring);
    struct scene_material glass;
    scene_material_init(&glass, "glass");
    for (int k = 0; k < 3; ++k) {
        glass.transmission[k] = 0.9f;
        glass.reflection[k] = 0.3f;
    }
    uint32_t index = scene_add_material(scene, glass);
    assert_int_not_equal(index, SCENE_NONE);
    for (uint32_t i = 0; i < scene->meshes[0].triangle_count; ++i)
        scene->meshes[0].materials[i] = index;
    for (int i = 0; i < 3; ++i) {
        double t[3] = {1.5 * (i - 1), 1.0, 0.4 * i}, q[4] = {0.5, 0.3 * i, 0, 1}, s[3] = {1, 1, 1};
        struct affine placed = affine_from_trs(t, q, s);
        fixture_place(scene, &placed);
    }
    ground.name = string_copy("ground");
    struct scene_instance instance = {
        .name = string_copy("ground"), .mesh = scene_add_mesh(scene, ground), .node = SCENE_NONE};
    assert_int_not_equal(scene_add_instance(scene, instance), SCENE_NONE);
    for (int i = 0; i < 2; ++i) {
        struct scene_light light = {.name = string_copy("lamp"),
                                    .kind = SCENE_LIGHT_POINT,
                                    .node = SCENE_NONE,
                                    .position = {i ? -4 : 5, 6, 3},
                                    .color = {0.6f, 0.6f, 0.6f}};
        assert_int_not_equal(scene_add_light(scene, light), SCENE_NONE);
    }
    return scene;
}

static inline struct scene *glass_scene(void)
{
    return glass_scene_of(24, 12);
}

static const char glass_camera[] = "0,4,8,0,0.5,0,0,1,0,40";

#endif
