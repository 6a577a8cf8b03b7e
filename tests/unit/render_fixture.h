/* Scenes, devices and pictures for tests of traversal and rendering. */
#ifndef TESTS_RENDER_FIXTURE_H
#define TESTS_RENDER_FIXTURE_H

#include "../random.h"
#include "../scenes.h"
#include "accel/validate.h"
#include "base/array.h"
#include "owned_image.h"
#include "render/render.h"
#include "unit.h"

/* How many messages the validation layers have given since fixture_validate last looked. */
static int fixture_validation;

static void fixture_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fixture_validation += strncmp(message, "validation: ", 12) == 0;
    print_message("  %s\n", message);
}

static const whit_log fixture_log = {.fn = fixture_message, .level = WHIT_LOG_WARNING};

/* The device that all checks of a program share, because layers and driver take longer to start
   than most pictures take to draw. Checks with the same kernel share its pipeline. */
static struct device *fixture_shared;

/* Ends a program in which `failed` checks failed. If there were none, the device is destroyed, and
   the validation layers report what the checks left on it. */
static inline int fixture_end(int failed)
{
    if (failed == 0) {
        device_destroy(fixture_shared);
        fixture_shared = NULL;
    }
    return failed + (fixture_validation > 0);
}

static inline struct device *fixture_device(void)
{
    if (!fixture_shared) {
        assert_int_equal(device_create(&fixture_log, NULL, NULL, &fixture_shared), WHIT_OK);
        device_keep_pipelines(fixture_shared);
        unit_at_end(fixture_end);
    }
    return fixture_shared;
}

static inline void fixture_validate(void)
{
    int said = fixture_validation;
    fixture_validation = 0;
    assert_int_equal(said, 0);
}

/* A scene with its trees, renderer and device. */
struct fixture {
    struct scene *scene;
    struct accel *accel;
    struct device *device;
    struct renderer *renderer;
};

/* Puts a renderer with these params in place of the present one. */
static inline void fixture_renew(struct fixture *f, const whit_renderer_params *params)
{
    renderer_destroy(f->renderer);
    assert_int_equal(renderer_create(&fixture_log, f->device, f->accel, params, &f->renderer),
                     WHIT_OK);
}

static inline struct fixture fixture_open(struct scene *scene,
                                          const whit_accel_params *accel_params,
                                          const whit_renderer_params *render_params)
{
    static const whit_accel_params usual = {0};
    struct fixture f = {.scene = scene};
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    assert_int_equal(
        accel_create(&fixture_log, scene, accel_params ? accel_params : &usual, &f.accel), WHIT_OK);
    assert_int_equal(accel_validate(f.accel), WHIT_OK);
    f.device = fixture_device();
    const whit_renderer_params small = {.width = 16, .height = 16, .depth = 4};
    fixture_renew(&f, render_params ? render_params : &small);
    return f;
}

static inline void fixture_close(struct fixture *f)
{
    renderer_destroy(f->renderer);
    fixture_validate();
    accel_destroy(f->accel);
    scene_destroy(f->scene);
}

/* Another renderer over the trees of `f`, which is destroyed at the end of its block, before `f`:
   own_renderer other = fixture_beside(&f, &params). */
static inline struct fixture fixture_beside(const struct fixture *f,
                                            const whit_renderer_params *params)
{
    struct fixture other = {.device = f->device, .accel = f->accel};
    fixture_renew(&other, params);
    return other;
}

static inline void drop_fixture_beside(struct fixture *other)
{
    renderer_destroy(other->renderer);
}

#define own_renderer __attribute__((cleanup(drop_fixture_beside), unused)) struct fixture

/* Closed at the end of its block. */
#define own_fixture  __attribute__((cleanup(fixture_close), unused)) struct fixture

/* Asserts that no renderer of the trees of `f` can be made with any params of `wrong`. */
static inline void fixture_refuses(const struct fixture *f, const whit_renderer_params *wrong,
                                   size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        struct renderer *renderer = NULL;
        if (renderer_create(&fixture_log, f->device, f->accel, &wrong[i], &renderer) !=
            WHIT_ERROR_USAGE)
            fail_msg("params %zu are not refused", i);
        assert_null(renderer);
    }
}

/* A two-sided flat emitter, or a half of it, of the given radiance. */
static inline struct scene_light emitter(whit_light_kind kind, const double corner[3],
                                         const double u[3], const double v[3], float radiance)
{
    struct scene_light light = {.kind = kind, .node = SCENE_NONE, .two_sided = true};
    memcpy(light.position, corner, sizeof light.position);
    memcpy(light.edge_u, u, sizeof light.edge_u);
    memcpy(light.edge_v, v, sizeof light.edge_v);
    set_rgb(light.color, radiance, radiance, radiance);
    return light;
}

/* `count` triangles, each of them `step` farther along an axis than the one before. */
static inline struct scene_mesh mesh_stack(uint32_t count, const float corners[9], int axis,
                                           float step)
{
    own_memory float *all = array_alloc(count, 9 * sizeof *all);
    assert_non_null(all);
    for (uint32_t i = 0; i < 9 * count; ++i)
        all[i] = corners[i % 9] + ((int)(i % 3) == axis ? step * (float)(i / 9) : 0.0f);
    return mesh_triangles(all, count);
}

/* ---- Pictures ---- */

struct picture {
    struct image color, ids;
    whit_stats stats;
};

static inline struct image render(const struct fixture *f)
{
    struct image image = {0};
    assert_int_equal(renderer_render(f->renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(f->renderer, &image), WHIT_OK);
    return image;
}

static inline struct picture render_picture(const struct fixture *f)
{
    struct picture picture = {.color = render(f)};
    assert_int_equal(renderer_read_ids(f->renderer, &picture.ids), WHIT_OK);
    renderer_get_stats(f->renderer, &picture.stats);
    return picture;
}

static inline void picture_finish(struct picture *picture)
{
    image_finish(&picture->color);
    image_finish(&picture->ids);
}

/* Freed at the end of its block. */
#define own_picture __attribute__((cleanup(picture_finish), unused)) struct picture

/* The picture of a scene, which it destroys. */
static inline struct image color_of(struct scene *scene, const whit_accel_params *accel,
                                    const whit_renderer_params *params)
{
    own_fixture f = fixture_open(scene, accel, params);
    return render(&f);
}

static inline struct picture picture_of(struct scene *scene, const whit_accel_params *accel,
                                        const whit_renderer_params *params)
{
    own_fixture f = fixture_open(scene, accel, params);
    return render_picture(&f);
}

/* The number of pixels whose bytes differ. */
static inline uint32_t pixels_unlike(const struct image *a, const struct image *b)
{
    const char *x = a->pixels ? (const char *)a->pixels : (const char *)a->words;
    const char *y = b->pixels ? (const char *)b->pixels : (const char *)b->words;
    size_t bytes = 4 * (size_t)a->channels;
    uint32_t unlike = 0;
    assert_true(a->width == b->width && a->height == b->height && a->channels == b->channels);
    for (size_t i = 0; i < (size_t)a->width * a->height; ++i)
        unlike += memcmp(x + i * bytes, y + i * bytes, bytes) != 0;
    return unlike;
}

static inline void assert_same_image(const char *what, const struct image *a, const struct image *b)
{
    uint32_t unlike = pixels_unlike(a, b);
    if (unlike > 0)
        fail_msg("%s: %u pixels of other bytes", what, unlike);
}

/* Asserts that two pictures have the same colours, identities and number of rays of every kind. */
static inline void assert_same_picture(const char *what, const struct picture *a,
                                       const struct picture *b)
{
    assert_same_image(what, &a->color, &b->color);
    assert_same_image(what, &a->ids, &b->ids);
    assert_int_equal(a->stats.rays_shadow, b->stats.rays_shadow);
    assert_int_equal(a->stats.rays_reflected, b->stats.rays_reflected);
    assert_int_equal(a->stats.rays_refracted, b->stats.rays_refracted);
}

#endif
