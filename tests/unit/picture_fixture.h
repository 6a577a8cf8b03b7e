/* Scenes put together by hand, whose radiance is known by formula, and their pictures. */
#ifndef TESTS_PICTURE_FIXTURE_H
#define TESTS_PICTURE_FIXTURE_H

#include "base/vec.h"
#include "render_fixture.h"

static inline void set_sky(struct scene *scene, float zenith, float horizon, float ground)
{
    set_rgb(scene->environment.zenith, zenith, zenith, zenith);
    set_rgb(scene->environment.horizon, horizon, horizon, horizon);
    set_rgb(scene->environment.ground, ground, ground, ground);
}

/* ---- Materials with a single property ---- */

static inline struct scene_material matte(float r, float g, float b)
{
    struct scene_material m = material_plain("matte");
    set_rgb(m.diffuse, r, g, b);
    return m;
}

static inline struct scene_material unlit(float r, float g, float b)
{
    struct scene_material m = matte(r, g, b);
    m.model = WHIT_MODEL_UNLIT;
    return m;
}

static inline struct scene_material mirror(float r, float g, float b)
{
    struct scene_material m = matte(0, 0, 0);
    set_rgb(m.reflection, r, g, b);
    return m;
}

/* ---- Scenes ---- */

/* A scene with nothing but a black background and a camera at `eye` looking at `target`. */
static inline struct scene *dark_scene(const double eye[3], const double target[3])
{
    struct scene *scene = scene_begin(&fixture_log, "picture");
    scene->has_environment = true;
    scene->environment.kind = WHIT_ENVIRONMENT_GRADIENT;
    set_rgb(scene->environment.scale, 1.0f, 1.0f, 1.0f);
    scene->has_ambient = true;
    scene_put_camera(scene, eye, target, 0.6);
    return scene;
}

/* Adds `mesh` with material `m`, moved; gives the index of the material. */
static inline uint32_t add_object(struct scene *scene, struct scene_mesh mesh,
                                  struct scene_material m, double x, double y, double z)
{
    scene_put(scene, mesh, &(struct put){.material = &m, .at = {x, y, z}});
    return scene->material_count - 1;
}

/* A white floor at y = 0, seen from `height` above. */
static inline struct scene *floor_scene(double height)
{
    struct scene *scene = dark_scene((double[]){0, height, 0}, (double[]){0, 0, 0});
    add_object(scene, mesh_plane(40), matte(1, 1, 1), 0, 0, 0);
    return scene;
}

/* A panel at y = `height` with a two-sided light in its plane, seen from 3 above. */
static inline struct scene *glowing_panel(double height)
{
    struct scene *scene = dark_scene((double[]){0, height + 3, 0}, (double[]){0, height, 0});
    add_object(scene, mesh_plane(4), matte(1, 1, 1), 0, height, 0);
    scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){-2, height, -2},
                                   (double[]){4, 0, 0}, (double[]){0, 0, 4}, 1));
    return scene;
}

/* A texture of two texels side by side; see use_texture. */
static inline uint32_t add_two_texels(struct scene *scene, uint8_t first, uint8_t second)
{
    uint8_t rgba[8] = {first, first, first, 255, second, second, second, 255};
    return scene_put_texture(scene, 2, 1, rgba);
}

/* Uses a texture with nearest texels, clamped at its edges. */
static inline void use_texture(struct scene_material *m, enum scene_slot slot, uint32_t texture)
{
    struct scene_texture_use *use = &m->textures[slot];
    scene_texture_use_init(use);
    use->texture = texture;
    use->nearest = true;
    use->wrap_u = use->wrap_v = SCENE_WRAP_CLAMP;
}

/* Uses a texture with filtered texels; `transform`: of its coordinates. */
static inline void use_filtered(struct scene_material *m, enum scene_slot slot, uint32_t texture,
                                const float transform[6], enum scene_wrap wrap)
{
    struct scene_texture_use *use = &m->textures[slot];
    *use = (struct scene_texture_use){.texture = texture, .wrap_u = wrap, .wrap_v = wrap};
    memcpy(use->transform, transform, sizeof use->transform);
}

/* ---- Pixels ---- */

static const whit_renderer_params picture_params = {.width = 33, .height = 33, .depth = 8};

static inline const float *middle(const struct image *image)
{
    return &image->pixels[4 * ((size_t)image->height / 2 * image->width + image->width / 2)];
}

/* The sum of the red channel over all pixels. */
static inline double red_sum(const struct image *image)
{
    double sum = 0.0;
    for (size_t i = 0; i < (size_t)image->width * image->height; ++i)
        sum += (double)image->pixels[4 * i];
    return sum;
}

/* Checks that all colours are from `min` to `max`, and alpha from 0 to 1. */
static inline void assert_range(const struct image *image, double min, double max)
{
    for (size_t i = 0; i < (size_t)image->width * image->height * 4; ++i) {
        double value = (double)image->pixels[i];
        if (!(i % 4 == 3 ? value >= 0 && value <= 1 : value >= min && value <= max))
            fail_msg("pixel %zu: %g is not between %g and %g", i / 4, value, min, max);
    }
}

static inline void assert_near(float value, double expected, double relative)
{
    if (!(fabs((double)value - expected) <= relative * fabs(expected) + 1e-30))
        fail_msg("%.9g is not %.9g within %g", (double)value, expected, relative);
}

#endif
