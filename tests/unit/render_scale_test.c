/* No length is built in: a scene that is scaled by a power of two, with which floats round in the
   same way, gives the same picture. */
#include "media_fixture.h"
#include "unit.h"

/* Squares of one texel, small enough on the floor to be filtered. */
static uint32_t put_squares(struct scene *scene)
{
    enum { SIDE = 32 };
    uint8_t rgba[SIDE * SIDE * 4];
    for (uint32_t i = 0; i < SIDE * SIDE; ++i) {
        memset(rgba + 4 * i, (i / SIDE + i) % 2 ? 230 : 40, 3);
        rgba[4 * i + 3] = 255;
    }
    return scene_put_texture(scene, SIDE, SIDE, rgba);
}

/* Shadows, mirror images, glass in glass, smooth normals, analytic balls, a texture. */
static struct scene *still_life(bool lamp)
{
    struct scene *scene = dark_scene((double[]){0.3, 2.1, 6.2}, (double[]){0.1, 0.2, 0});
    struct scene_material m = matte(0.8f, 0.7f, 0.6f);
    set_sky(scene, 0.2f, 0.5f, 0.1f);
    m.textures[SCENE_SLOT_DIFFUSE].texture = put_squares(scene);
    add_object(scene, mesh_plane(9), m, 0, -0.9, 0);
    m = matte(0.8f, 0.7f, 0.6f);
    add_object(scene, mesh_torus(0.8, 0.3, 24, 12), m, -1.3, 0.1, -0.4);
    m = material_plain("mirror");
    set_rgb(m.reflection, 0.9f, 0.9f, 0.9f);
    add_object(scene, mesh_box(1.1, 1.7, 0.9), m, 1.7, 0.05, -0.8);
    add_object(scene, mesh_balls((double[]){0, 0, 0, 0.8}, 1), clear_glass(1.5f, 0), 0.3, 0.1, 0.7);
    add_object(scene, mesh_box(0.5, 0.4, 0.5), clear_glass(1.33f, 1), 0.3, 0.1, 0.7);
    scene_put_sun(scene, 0.4, -1, -0.3, 0.6f);
    if (lamp)
        scene_put_lamp(scene, -2.2, 3.1, 2.3, 9.0f);
    return scene;
}

/* Scales all lengths of a scene. The power of its lamps is scaled too, so that as much light
   arrives. */
static void scale_scene(struct scene *scene, double by)
{
    for (int k = 0; k < 3; ++k) {
        scene->cameras[0].eye[k] *= by;
        scene->cameras[0].target[k] *= by;
    }
    for (uint32_t i = 0; i < scene->node_count; ++i)
        for (int k = 0; k < 3; ++k)
            scene->nodes[i].translation[k] *= by;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        struct scene_mesh *mesh = &scene->meshes[i];
        for (size_t k = 0; k < 3 * (size_t)mesh->vertex_count; ++k)
            mesh->positions[k] *= (float)by;
        for (size_t k = 0; k < 4 * (size_t)mesh->sphere_count; ++k)
            mesh->spheres[k] *= (float)by;
    }
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        struct scene_light *light = &scene->lights[i];
        for (int k = 0; k < 3; ++k) {
            light->position[k] *= by;
            light->color[k] *= light->falloff ? (float)(by * by) : 1.0f;
        }
    }
}

static void compare_sizes(bool lamp, const double *scales, size_t count)
{
    const whit_renderer_params params = {
        .width = 48, .height = 36, .depth = 6, .minification = WHIT_MINIFICATION_MIPMAP};
    own_image first = color_of(still_life(lamp), NULL, &params);
    for (size_t i = 0; i < count; ++i) {
        struct scene *scene = still_life(lamp);
        scale_scene(scene, scales[i]);
        own_image image = color_of(scene, NULL, &params);
        print_message("  %g times as large\n", scales[i]);
        assert_same_image("another size", &image, &first);
    }
}

TEST(pictures_do_not_depend_on_the_unit)
{
    const double scales[] = {0x1p-20, 0x1p-8, 0x1p8, 0x1p20};
    const double extremes[] = {0x1p-34, 0x1p45}; /* for which no lamp is strong enough */
    compare_sizes(true, scales, sizeof scales / sizeof *scales);
    compare_sizes(false, extremes, sizeof extremes / sizeof *extremes);
}
