/* No length is built in: a scene that is larger or smaller by a power of two, where floats round as
   before, gives the same picture. */
#include "media_fixture.h"

static struct scene_mesh torus(void)
{
    return mesh_torus(0.8, 0.3, 24, 12);
}

/* Shadows, mirror images, glass in glass, smooth normals, analytic balls. */
static struct scene *still_life(bool lamp)
{
    struct scene *scene = dark_scene((double[]){0.3, 2.1, 6.2}, (double[]){0.1, 0.2, 0});
    struct scene_material m = material_plain("floor");
    set_sky(scene, 0.2f, 0.5f, 0.1f);
    set_rgb(m.diffuse, 0.8f, 0.7f, 0.6f);
    add_object(scene, mesh_plane(9), m, 0, -0.9, 0);
    add_object(scene, torus(), m, -1.3, 0.1, -0.4);
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

/* Of lamps, what arrives stays the same. */
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
    enum { WIDTH = 48, HEIGHT = 36 };
    struct image first = {0};
    for (size_t i = 0; i < count; ++i) {
        const struct render_params params = {.width = WIDTH, .height = HEIGHT, .depth = 6};
        struct scene *scene = still_life(lamp);
        scale_scene(scene, scales[i]);
        struct fixture f = fixture_open(scene, NULL, &params);
        struct image image = render(&f);
        uint32_t differ = 0;
        if (i == 0) {
            first = image;
        } else {
            for (size_t p = 0; p < WIDTH * HEIGHT; ++p)
                differ += memcmp(&image.pixels[4 * p], &first.pixels[4 * p], 16) != 0;
            print_message("  %g times as large: %u of %d pixels differ\n", scales[i], differ,
                          WIDTH * HEIGHT);
            image_finish(&image);
        }
        fixture_close(&f);
        assert_int_equal(differ, 0);
    }
    image_finish(&first);
}

static void pictures_do_not_depend_on_the_unit(void **state)
{
    (void)state;
    const double scales[] = {1, 0x1p-20, 0x1p-8, 0x1p8, 0x1p20};
    const double extremes[] = {1, 0x1p-34, 0x1p45}; /* for which no lamp is strong enough */
    compare_sizes(true, scales, sizeof scales / sizeof *scales);
    compare_sizes(false, extremes, sizeof extremes / sizeof *extremes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_do_not_depend_on_the_unit),
    };
    return fixture_end(cmocka_run_group_tests(tests, NULL, NULL));
}
