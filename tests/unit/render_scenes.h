/* Scenes for tests of kernels. */
#ifndef TESTS_RENDER_SCENES_H
#define TESTS_RENDER_SCENES_H

#include "load/load.h"
#include "render_fixture.h"

/* Reads scenes/NAME.json; the scene is not frozen. */
static inline struct scene *file_scene(const char *name)
{
    char path[512];
    struct scene *scene = scene_begin(&fixture_log, name);
    snprintf(path, sizeof path, "%s/%s.json", WHIT_SCENES_DIR, name);
    assert_int_equal(roots_init(&scene->roots, path), WHIT_OK);
    assert_int_equal(load_scene_file(scene, path, NULL), WHIT_OK);
    return scene;
}

/* A scene of one mesh without a transform. */
static inline struct scene *terrain_scene(void)
{
    struct scene *scene = scene_begin(&fixture_log, "terrain");
    scene_put(scene, mesh_terrain(10.0, 2.0, 40, 3), NULL);
    return scene;
}

/* Forty instances of a ring: turned, stretched, some of them mirrored. */
static inline struct scene *ring_scene(void)
{
    struct scene *scene = scene_begin(&fixture_log, "rings");
    uint32_t ring = scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    uint64_t random = 5;
    for (int i = 0; i < 40; ++i) {
        struct affine placed = placement_random(&random, 4.0, i % 3 == 0);
        scene_put_again(scene, ring, &(struct put){.matrix = &placed});
    }
    return scene;
}

/* Rings of glass and mirror over terrain, under two lights: with 2 * cells^2 triangles of ground,
   and 4 * sides^2 a ring. */
static inline struct scene *glass_scene_of(uint32_t cells, uint32_t sides)
{
    struct scene *scene = scene_begin(&fixture_log, "glass");
    struct scene_material glass = material_grey("glass");
    set_rgb(glass.transmission, 0.9f, 0.9f, 0.9f);
    set_rgb(glass.reflection, 0.3f, 0.3f, 0.3f);
    scene_put_material(scene, material_grey("grey"));
    uint32_t index = scene_put_material(scene, glass);
    uint32_t ring =
        scene_put_mesh(scene, mesh_wearing(mesh_torus(1.0, 0.3, 2 * sides, sides), index));
    for (int i = 0; i < 3; ++i) {
        double t[3] = {1.5 * (i - 1), 1.0, 0.4 * i}, q[4] = {0.5, 0.3 * i, 0, 1}, s[3] = {1, 1, 1};
        struct affine placed = affine_from_trs(t, q, s);
        scene_put_again(scene, ring, &(struct put){.matrix = &placed});
    }
    scene_put(scene, mesh_terrain(10.0, 1.0, cells, 3), NULL);
    for (int i = 0; i < 2; ++i) {
        scene_put_lamp(scene, i ? -4 : 5, 6, 3, 0.6f);
        scene->lights[i].falloff = false;
    }
    return scene;
}

static inline struct scene *glass_scene(void)
{
    return glass_scene_of(24, 12);
}

#define GLASS_CAMERA CAMERA_AT(0, 4, 8, 0, 0.5, 0, 0, 1, 0, 40)
static const whit_camera glass_camera = GLASS_CAMERA;

#endif
