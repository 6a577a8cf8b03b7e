/* Error falls with samples and with bounces in every scene of scenes/, or it is said why not: each
   rise is listed, and its reason is checked. Errors are RMSE against the reference in double. */
#include <dirent.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "whit.h"

/* As `whit cost` has it (host/cost/measure.h). */
enum { WIDTH = 32, HEIGHT = 24, SAMPLES = 64, DEPTH = 32, LIGHT_SAMPLES = 64 };
static const double BAILOUT = 0x1p-16;

struct opened {
    whit_scene *scene;
    whit_accel *accel;
    whit_renderer *renderer;
};

static whit_renderer_params usual;

static struct opened open_scene(whit_device *device, const char *name)
{
    usual = whit_renderer_defaults();
    usual.width = WIDTH;
    usual.height = HEIGHT;
    char path[1024];
    struct opened o = {0};
    snprintf(path, sizeof path, "%s/%s", WHIT_SCENES_DIR, name);
    assert_int_equal(whit_scene_load(path, NULL, NULL, &o.scene), WHIT_OK);
    assert_int_equal(whit_accel_create(o.scene, NULL, &o.accel), WHIT_OK);
    assert_int_equal(whit_renderer_create(device, o.accel, &usual, &o.renderer), WHIT_OK);
    return o;
}

static void close_scene(struct opened *o)
{
    whit_renderer_destroy(o->renderer);
    whit_accel_destroy(o->accel);
    whit_scene_destroy(o->scene);
}

static whit_image *reference_of(const struct opened *o, uint32_t samples)
{
    whit_renderer_params params = usual;
    whit_reference *reference = NULL;
    whit_image *image = NULL;
    params.sampling.count = samples;
    params.depth = DEPTH;
    params.bailout = BAILOUT;
    params.light_samples = LIGHT_SAMPLES;
    assert_int_equal(whit_reference_create(o->accel, &params, 0, &reference), WHIT_OK);
    assert_int_equal(whit_reference_render(reference, &image, NULL), WHIT_OK);
    whit_reference_destroy(reference);
    return image;
}

/* ---- Errors ---- */

/* These are errors of linear RGB, and of what a display shows of it: clamped to white. `bright`:
   pixels in which one of the two pictures has a channel over white. */
struct error {
    double linear, shown;
    int bright;
};

static struct error error_of(const whit_image *a, const whit_image *b)
{
    const float *x = whit_image_floats(a), *y = whit_image_floats(b);
    struct error out = {0};
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
        bool is_bright = false;
        for (int k = 4 * i; k < 4 * i + 3; ++k) {
            double p = (double)x[k], q = (double)y[k];
            is_bright = is_bright || fmax(p, q) > 1.0;
            out.linear += (p - q) * (p - q);
            out.shown += pow(fmin(p, 1.0) - fmin(q, 1.0), 2.0);
        }
        out.bright += is_bright;
    }
    out.linear = sqrt(out.linear / (3.0 * WIDTH * HEIGHT));
    out.shown = sqrt(out.shown / (3.0 * WIDTH * HEIGHT));
    return out;
}

static struct error measure(struct opened *o, const whit_image *reference,
                            const whit_renderer_params *view)
{
    whit_image *image = NULL;
    assert_int_equal(whit_renderer_set_view(o->renderer, view), WHIT_OK);
    assert_int_equal(whit_renderer_render(o->renderer), WHIT_OK);
    assert_int_equal(whit_renderer_image(o->renderer, WHIT_AOV_COLOR, &image), WHIT_OK);
    struct error error = error_of(reference, image);
    whit_image_destroy(image);
    return error;
}

/* ---- Rises ---- */

struct tally {
    int steps, rises, unexplained;
};

/* The one reason there is: linear light of pixels over white, of which few samples say anything;
   then what is shown of them does not get worse. */
static void compare(struct tally *tally, const char *scene, const char *knob, uint32_t setting,
                    const struct error *before, const struct error *after)
{
    ++tally->steps;
    if (after->linear <= before->linear)
        return;
    bool is_bright = after->bright > 0 && after->shown <= before->shown;
    ++tally->rises;
    tally->unexplained += !is_bright;
    print_message("%s, %s %u: RMSE rises from %.4g to %.4g, as shown from %.4g to %.4g, %d of %d "
                  "pixels over white: %s\n",
                  scene, knob, setting, before->linear, after->linear, before->shown, after->shown,
                  after->bright, WIDTH * HEIGHT, is_bright ? "bright pixels" : "UNEXPLAINED");
}

/* One picture after the other with more of one knob, beside one reference. */
static void check_knob(struct opened *o, const char *name, bool depth, struct tally *tally)
{
    static const uint32_t samples[] = {1, 4, 16, SAMPLES}, depths[] = {0, 1, 2, 4, 8, 16};
    whit_image *reference = reference_of(o, depth ? 1 : SAMPLES);
    struct error before = {.linear = INFINITY, .shown = INFINITY};
    for (size_t i = 0; i < (depth ? sizeof depths : sizeof samples) / sizeof *samples; ++i) {
        whit_renderer_params view = usual;
        uint32_t *knob = depth ? &view.depth : &view.sampling.count;
        *knob = depth ? depths[i] : samples[i];
        const struct error error = measure(o, reference, &view);
        compare(tally, name, depth ? "depth" : "aa", *knob, &before, &error);
        before = error;
    }
    whit_image_destroy(reference);
}

static int is_scene(const struct dirent *entry)
{
    const char *dot = strrchr(entry->d_name, '.');
    return dot && strcmp(dot, ".json") == 0;
}

static void error_falls_or_it_is_said_why(void **state)
{
    (void)state;
    struct dirent **names = NULL;
    struct tally tally = {0};
    whit_device *device = NULL;
    assert_int_equal(whit_device_create(NULL, NULL, &device), WHIT_OK);
    int count = scandir(WHIT_SCENES_DIR, &names, is_scene, alphasort);
    assert_true(count > 0);
    for (int i = 0; i < count; ++i) {
        struct opened o = open_scene(device, names[i]->d_name);
        check_knob(&o, names[i]->d_name, false, &tally);
        check_knob(&o, names[i]->d_name, true, &tally);
        close_scene(&o);
        free(names[i]);
    }
    free(names);
    whit_device_destroy(device);
    print_message("%d scenes, %d steps: %d rises, %d of them unexplained\n", count, tally.steps,
                  tally.rises, tally.unexplained);
    assert_int_equal(tally.unexplained, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(error_falls_or_it_is_said_why)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
