/* A device that keeps its kernels, and a scene with its trees, through the public header. */
#ifndef SCENE_FIXTURE_H
#define SCENE_FIXTURE_H

#include "messages_fixture.h"
#include "unit.h"
#include "whit.h"
#include "whit_program.h"

static whit_device *device;
static whit_scene *scene;
static whit_accel *accel;

static inline int device_begin(void **state)
{
    (void)state;
    if (whit_device_create(NULL, &warnings_log, &device) != WHIT_OK)
        fail_msg("%s", messages.last_error);
    whit_device_keep_kernels(device);
    return 0;
}

static inline void scene_close(void)
{
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
    accel = NULL;
    scene = NULL;
}

static inline int device_end(void **state)
{
    (void)state;
    scene_close();
    whit_device_destroy(device);
    return 0;
}

/* The last scene is closed; nothing of it may be left. */
static inline void scene_open(const char *path)
{
    scene_close();
    if (whit_scene_load(path, NULL, &warnings_log, &scene) != WHIT_OK)
        fail_msg("%s", messages.last_error);
    assert_int_equal(whit_accel_create(scene, NULL, &accel), WHIT_OK);
}

static inline whit_renderer_params params_sized(uint32_t width, uint32_t height,
                                                const whit_shader *shader)
{
    whit_renderer_params params = whit_renderer_defaults();
    params.width = width;
    params.height = height;
    params.shader = shader;
    return params;
}

static inline void drop_renderer(whit_renderer **at)
{
    whit_renderer_destroy(*at);
}

/* Freed at the end of its block, where its scene must still be open:
   own_whit_renderer *renderer = renderer_of(...); */
#define own_whit_renderer __attribute__((cleanup(drop_renderer), unused)) whit_renderer

static inline whit_renderer *renderer_of(const whit_renderer_params *params)
{
    whit_renderer *renderer = NULL;
    assert_int_equal(whit_renderer_create(device, accel, params, &renderer), WHIT_OK);
    return renderer;
}

static inline void drop_image(whit_image **at)
{
    whit_image_destroy(*at);
}

/* Freed at the end of its block: own_whit_image *image = image_of(...); */
#define own_whit_image __attribute__((cleanup(drop_image), unused)) whit_image

static inline whit_image *image_of(whit_renderer *renderer, whit_aov aov)
{
    whit_image *image = NULL;
    assert_int_equal(whit_renderer_image(renderer, aov, &image), WHIT_OK);
    return image;
}

/* Draws a picture, and gives its colours. */
static inline whit_image *drawn_by(whit_renderer *renderer)
{
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    return image_of(renderer, WHIT_AOV_COLOR);
}

static inline void assert_same_image(const whit_image *a, const whit_image *b)
{
    whit_image_info info, other;
    whit_image_get_info(a, &info);
    whit_image_get_info(b, &other);
    assert_true(info.width == other.width && info.height == other.height);
    assert_memory_equal(whit_image_floats(a), whit_image_floats(b),
                        (size_t)info.width * info.height * 4 * sizeof(float));
}

static inline whit_image *reference_image(const whit_renderer_params *params)
{
    whit_reference *reference = NULL;
    whit_image *image = NULL;
    assert_int_equal(whit_reference_create(accel, params, 0, &reference), WHIT_OK);
    assert_int_equal(whit_reference_render(reference, &image, NULL), WHIT_OK);
    whit_reference_destroy(reference);
    return image;
}

#endif
