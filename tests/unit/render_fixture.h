/* Scenes, devices and rays for tests of traversal and rendering. */
#ifndef TESTS_RENDER_FIXTURE_H
#define TESTS_RENDER_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../random.h"
#include "../scenes.h"
#include "base/array.h"
#include "render/render.h"

/* Messages of the validation layers since fixture_validate. */
static int fixture_validation;

static void fixture_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    (void)level;
    fixture_validation += strncmp(message, "validation: ", 12) == 0;
    print_message("  %s\n", message);
}

static const struct log fixture_log = {.fn = fixture_message, .level = WHIT_LOG_WARNING};

/* The one device of all checks of a program: layers and driver take longer to start than most
   pictures take to draw. */
static struct device *fixture_shared;

static inline struct device *fixture_device(void)
{
    if (!fixture_shared)
        assert_int_equal(device_create(&fixture_log, NULL, &fixture_shared), WHIT_OK);
    return fixture_shared;
}

static inline void fixture_validate(void)
{
    int messages = fixture_validation;
    fixture_validation = 0;
    assert_int_equal(messages, 0);
}

/* Ends a program of which `failed` checks failed: after none, what they did not destroy on the
   device becomes messages here. */
static inline int fixture_end(int failed)
{
    if (failed == 0) {
        device_destroy(fixture_shared);
        fixture_shared = NULL;
    }
    return failed + (fixture_validation > 0);
}

/* Scenes whose trees are of other depths take the same kernels. */
static const struct accel_params fixture_accel = {.stack_floor = 32};

/* Everything between a scene and its hits. */
struct fixture {
    struct scene *scene;
    struct accel *accel;
    struct device *device;
    struct renderer *renderer;
};

static inline struct fixture fixture_open(struct scene *scene,
                                          const struct accel_params *accel_params,
                                          const struct render_params *render_params)
{
    struct fixture f = {.scene = scene};
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    assert_int_equal(
        accel_create(&fixture_log, scene, accel_params ? accel_params : &fixture_accel, &f.accel),
        WHIT_OK);
    assert_int_equal(accel_validate(f.accel), WHIT_OK);
    f.device = fixture_device();
    const struct render_params small = {.width = 16, .height = 16, .depth = 4};
    assert_int_equal(renderer_create(&fixture_log, f.device, f.accel,
                                     render_params ? render_params : &small, &f.renderer),
                     WHIT_OK);
    return f;
}

static inline void fixture_close(struct fixture *f)
{
    renderer_destroy(f->renderer);
    fixture_validate();
    accel_destroy(f->accel);
    scene_destroy(f->scene);
}

#endif
