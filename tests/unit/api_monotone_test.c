/* In every scene of scenes/ the error falls with more samples and with more bounces; each rise is
   printed, and must have the one known reason. Errors are RMSE against the reference in double. */
#include <glob.h>

#include "scene_fixture.h"

/* The values that `whit cost` uses (host/cost/measure.h). */
enum { WIDTH = 32, HEIGHT = 24, SAMPLES = 64, DEPTH = 32, LIGHT_SAMPLES = 64 };
static const double BAILOUT = 0x1p-16;

static whit_renderer_params usual;
static whit_renderer *renderer;

static whit_image *reference_of(uint32_t samples)
{
    whit_renderer_params params = usual;
    params.sampling.count = samples;
    params.depth = DEPTH;
    params.bailout = BAILOUT;
    params.light_samples = LIGHT_SAMPLES;
    return reference_image(&params);
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

static struct error measure(const whit_image *reference, const whit_renderer_params *view)
{
    assert_int_equal(whit_renderer_set_view(renderer, view), WHIT_OK);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    own_whit_image *image = image_of(renderer, WHIT_AOV_COLOR);
    return error_of(reference, image);
}

/* ---- Rises ---- */

struct tally {
    int steps, rises, unexplained;
};

/* The one known reason is pixels brighter than white, whose linear light few samples estimate
   badly; the error of the displayed picture must not rise then. */
static void compare(struct tally *tally, const char *name, const char *knob, uint32_t setting,
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
                  name, knob, setting, before->linear, after->linear, before->shown, after->shown,
                  after->bright, WIDTH * HEIGHT, is_bright ? "bright pixels" : "UNEXPLAINED");
}

/* Draws pictures with more and more samples or bounces, and compares them with one reference. */
static void check_knob(const char *name, bool depth, struct tally *tally)
{
    static const uint32_t samples[] = {1, 4, 16, SAMPLES}, depths[] = {0, 1, 2, 4, 8, 16};
    own_whit_image *reference = reference_of(depth ? 1 : SAMPLES);
    struct error before = {.linear = INFINITY, .shown = INFINITY};
    for (size_t i = 0; i < (depth ? sizeof depths : sizeof samples) / sizeof *samples; ++i) {
        whit_renderer_params view = usual;
        uint32_t *knob = depth ? &view.depth : &view.sampling.count;
        *knob = depth ? depths[i] : samples[i];
        const struct error error = measure(reference, &view);
        compare(tally, name, depth ? "depth" : "aa", *knob, &before, &error);
        before = error;
    }
}

TEST_IN(error_falls_or_it_is_said_why, device_begin, device_end)
{
    glob_t paths;
    struct tally tally = {0};
    usual = params_sized(WIDTH, HEIGHT, NULL);
    assert_int_equal(glob(WHIT_SCENES_DIR "/*.json", 0, NULL, &paths), 0);
    for (size_t i = 0; i < paths.gl_pathc; ++i) {
        const char *name = strrchr(paths.gl_pathv[i], '/') + 1;
        scene_open(paths.gl_pathv[i]);
        renderer = renderer_of(&usual);
        check_knob(name, false, &tally);
        check_knob(name, true, &tally);
        whit_renderer_destroy(renderer);
    }
    print_message("%zu scenes, %d steps: %d rises, %d of them unexplained\n", paths.gl_pathc,
                  tally.steps, tally.rises, tally.unexplained);
    globfree(&paths);
    assert_int_equal(tally.unexplained, 0);
}
