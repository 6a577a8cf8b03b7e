/* Scenes put together by hand, whose radiance is known by formula, and their pictures. */
#ifndef TESTS_PICTURE_FIXTURE_H
#define TESTS_PICTURE_FIXTURE_H

#include "render_fixture.h"

static inline void set_rgb(float *rgb, float r, float g, float b)
{
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
}

/* A scene with nothing but a black background and a camera at `eye` looking at `target`. */
static inline struct scene *dark_scene(const double eye[3], const double target[3])
{
    struct scene *scene = scene_begin(&fixture_log, "picture");
    scene->has_environment = true;
    scene->environment.kind = SCENE_ENVIRONMENT_GRADIENT;
    set_rgb(scene->environment.scale, 1.0f, 1.0f, 1.0f);
    scene->has_ambient = true;
    scene_put_camera(scene, eye, target, 0.6);
    return scene;
}

/* `mesh` with `m`, moved; the index of the material. */
static inline uint32_t add_object(struct scene *scene, struct scene_mesh mesh,
                                  struct scene_material m, double x, double y, double z)
{
    scene_put(scene, mesh, &(struct put){.material = &m, .at = {x, y, z}});
    return scene->material_count - 1;
}

/* A texture of two texels side by side; see use_texture. */
static inline uint32_t add_two_texels(struct scene *scene, uint8_t first, uint8_t second)
{
    uint8_t rgba[8] = {first, first, first, 255, second, second, second, 255};
    return scene_put_texture(scene, 2, 1, rgba);
}

/* Nearest texels, held beyond the edges. */
static inline void use_texture(struct scene_material *m, enum scene_slot slot, uint32_t texture)
{
    struct scene_texture_use *use = &m->textures[slot];
    scene_texture_use_init(use);
    use->texture = texture;
    use->nearest = true;
    use->wrap_u = use->wrap_v = SCENE_WRAP_CLAMP;
}

static inline struct image render(struct fixture *f)
{
    struct image image = {0};
    assert_int_equal(renderer_render(f->renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(f->renderer, &image), WHIT_OK);
    return image;
}

static const struct render_params picture_params = {.width = 33, .height = 33, .depth = 8};

static inline const float *middle(const struct image *image)
{
    return &image->pixels[4 * ((size_t)image->height / 2 * image->width + image->width / 2)];
}

static inline void assert_near(float value, double expected, double relative)
{
    if (!(fabs((double)value - expected) <= relative * fabs(expected) + 1e-30))
        fail_msg("%.9g is not %.9g within %g", (double)value, expected, relative);
}

#endif
