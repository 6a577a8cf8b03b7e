/* Refined pictures equal those with the same number of samples at once, and the estimated error is
   compared with the reference in double, pixel by pixel. */
#include <glob.h>

#include "../cases.h"
#include "scene_fixture.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

struct refining {
    whit_renderer *renderer;
    whit_refine *refine;
    whit_renderer_params params;
};

static struct refining begin(const whit_renderer_params *params)
{
    struct refining o = {.params = *params};
    o.renderer = renderer_of(&o.params);
    assert_int_equal(whit_refine_create(o.renderer, &o.params, &o.refine), WHIT_OK);
    return o;
}

static whit_renderer_params params_of(uint32_t depth, double bailout)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.depth = depth;
    params.bailout = bailout;
    return params;
}

static void end(struct refining *o)
{
    whit_refine_destroy(o->refine);
    whit_renderer_destroy(o->renderer);
}

static whit_refine_info step(const struct refining *o)
{
    whit_refine_info info;
    assert_int_equal(whit_refine_step(o->refine), WHIT_OK);
    whit_refine_get_info(o->refine, &info);
    return info;
}

static whit_refine_info refine_to(const struct refining *o, uint32_t samples)
{
    whit_refine_info info;
    do
        info = step(o);
    while (info.samples < samples);
    assert_int_equal(info.samples, samples);
    return info;
}

/* Ends with its block: own_refining o = begin(...); */
#define own_refining __attribute__((cleanup(end), unused)) struct refining

/* Rays of the last part that the renderer drew. */
static uint64_t rays_of(const whit_renderer *renderer)
{
    whit_stats stats;
    whit_renderer_get_stats(renderer, &stats);
    return whit_stats_rays(&stats);
}

static whit_image *picture_of(const struct refining *o)
{
    whit_image *image = NULL;
    assert_int_equal(whit_refine_image(o->refine, &image), WHIT_OK);
    return image;
}

TEST(a_refined_picture_is_that_of_as_many_samples)
{
    const whit_renderer_params few = params_of(3, 0.05);
    scene_open(WHIT_SCENES_DIR "/balls.json");
    own_refining o = begin(&few);
    whit_refine_info info = step(&o);
    uint64_t rays = rays_of(o.renderer); /* of all steps */
    assert_int_equal(info.samples, 1);
    assert_true(info.error < 0.0);
    info = step(&o); /* of rays that were cut */
    rays += rays_of(o.renderer);
    assert_int_equal(info.samples, 1);
    assert_true(info.cut_radiance > 0.0);
    for (uint32_t samples = 2; samples <= 8; samples *= 2) {
        whit_renderer_params params = o.params;
        whit_stats stats, drawn_stats;
        info = step(&o);
        rays += rays_of(o.renderer);
        assert_int_equal(info.samples, samples);
        assert_true(info.error > info.error_of_cuts && info.error_of_cuts > 0.0 && !info.last);
        own_whit_image *refined = picture_of(&o);
        whit_refine_get_stats(o.refine, &stats);
        params.sampling.count = samples;
        own_whit_renderer *renderer = renderer_of(&params);
        own_whit_image *drawn = drawn_by(renderer), *cuts = image_of(renderer, WHIT_AOV_CUTS);
        whit_renderer_get_stats(renderer, &drawn_stats);
        assert_same_image(refined, drawn);
        double depth = 0.0, bailout = 0.0;
        for (int i = 0; i < PIXELS; ++i) {
            depth = fmax(depth, (double)whit_image_floats(cuts)[2 * i]);
            bailout = fmax(bailout, (double)whit_image_floats(cuts)[2 * i + 1]);
        }
        assert_true(depth == drawn_stats.weight_cut_depth && depth > 0.0);
        assert_true(bailout == drawn_stats.weight_cut_bailout && bailout > 0.0);
        assert_true(fabs(stats.weight_cut_depth - depth) < 1e-6 * depth);
        assert_true(fabs(stats.weight_cut_bailout - bailout) < 1e-5 * bailout);
        assert_int_equal(stats.rays_reflected, drawn_stats.rays_reflected);
        assert_int_equal(stats.rays_refracted, drawn_stats.rays_refracted);
        assert_int_equal(stats.rays_shadow, drawn_stats.rays_shadow);
        assert_int_equal(stats.rays_primary, drawn_stats.rays_primary);
        assert_int_equal(stats.rays_cut_depth, drawn_stats.rays_cut_depth);
        assert_true(stats.rays_of_estimate >= PIXELS);
        assert_int_equal(rays, whit_stats_rays(&drawn_stats) + stats.rays_of_estimate);
        assert_memory_equal(stats.pixels_by_samples, drawn_stats.pixels_by_samples,
                            sizeof stats.pixels_by_samples);
    }
}

/* Only a part of the bound grows with the weights of cut rays. */
TEST(the_bound_is_that_of_the_picture)
{
    whit_renderer_params params = params_of(3, 0.05);
    whit_stats stats, drawn_stats;
    scene_open(WHIT_SCENES_DIR "/whitted.json");
    own_refining o = begin(&params);
    for (int i = 0; i < 4; ++i)
        step(&o);
    whit_refine_get_stats(o.refine, &stats);
    params.sampling.count = 4;
    own_whit_renderer *renderer = renderer_of(&params);
    own_whit_image *drawn = drawn_by(renderer);
    whit_renderer_get_stats(renderer, &drawn_stats);
    double bound = drawn_stats.bailout_bound;
    assert_true(bound > 0.0 && fabs(stats.bailout_bound - bound) < 1e-5 * bound);
}

/* What surfaces get without the rays that they send on is a picture without bounces, which has the
   weights of these rays as cut by depth. */
TEST(cut_rays_are_assumed_to_bring_what_others_bring_beside_the_light_of_lights)
{
    whit_renderer_params params = params_of(3, 0.05);
    double brought = 0.0, weights = 0.0;
    scene_open(WHIT_SCENES_DIR "/balls.json");
    own_refining o = begin(&params);
    step(&o);
    own_whit_image *whole = picture_of(&o);
    whit_refine_info info = step(&o);
    params.depth = 0;
    own_whit_renderer *renderer = renderer_of(&params);
    own_whit_image *own = drawn_by(renderer), *cuts = image_of(renderer, WHIT_AOV_CUTS);
    for (int i = 0; i < PIXELS; ++i) {
        const float *a = whit_image_floats(whole) + 4 * i, *b = whit_image_floats(own) + 4 * i;
        brought += fmax(fmax((double)a[0] - (double)b[0], (double)a[1] - (double)b[1]),
                        fmax((double)a[2] - (double)b[2], 0.0));
        weights += (double)whit_image_floats(cuts)[2 * i];
    }
    assert_true(fabs(info.cut_radiance - brought / weights) < 0.01 * info.cut_radiance);
}

TEST(a_step_that_is_cancelled_can_be_taken_again)
{
    volatile bool cancel = false;
    whit_renderer_params params = params_of(8, 0.0);
    scene_open(WHIT_SCENES_DIR "/cube.json");
    own_refining other = begin(&params);
    params.cancel = &cancel;
    own_refining o = begin(&params);
    refine_to(&o, 2);
    own_whit_image *before = picture_of(&o);
    cancel = true;
    assert_int_equal(whit_refine_step(o.refine), WHIT_ERROR_CANCELLED);
    own_whit_image *kept = picture_of(&o);
    assert_same_image(kept, before);
    cancel = false;
    whit_refine_info info = refine_to(&o, 4), wanted = refine_to(&other, 4);
    assert_true(info.error == wanted.error && info.error > 0.0);
    own_whit_image *after = picture_of(&o), *straight = picture_of(&other);
    assert_same_image(after, straight);
}

TEST(what_is_not_there_is_refused)
{
    const whit_renderer_params params = params_of(8, 0.0);
    scene_open(WHIT_SCENES_DIR "/cube.json");
    own_refining o = begin(&params);
    const float none[4][4] = {{0}};
    whit_image *image = NULL;
    assert_int_equal(whit_refine_image(o.refine, &image), WHIT_ERROR_USAGE);
    assert_null(image);
    step(&o);
    assert_int_equal(whit_refine_error_image(o.refine, &image), WHIT_ERROR_USAGE);
    assert_null(image);
    whit_refine_destroy(o.refine);
    o.params.width = o.params.height = 2;
    assert_int_equal(whit_refine_create(o.renderer, &o.params, &o.refine), WHIT_OK);
    assert_int_equal(whit_refine_begin(o.refine, WHIT_SAMPLES_MAX + 1, &none[0][0], &none[0][0]),
                     WHIT_ERROR_USAGE);
    assert_true(refine_to(&o, WHIT_SAMPLES_MAX).last);
    assert_int_equal(whit_refine_step(o.refine), WHIT_ERROR_USAGE);
    own_whit_renderer *no_device = NULL, *bare = NULL;
    whit_refine *refine = NULL;
    assert_int_equal(whit_renderer_create(NULL, accel, &o.params, &no_device), WHIT_OK);
    assert_int_equal(whit_refine_create(no_device, &o.params, &refine), WHIT_ERROR_USAGE);
    assert_null(refine);
    o.params.color_only = true;
    bare = renderer_of(&o.params);
    assert_int_equal(whit_refine_create(bare, &o.params, &refine), WHIT_ERROR_USAGE);
    assert_null(refine);
}

TEST(a_picture_of_the_usual_size_begins_as_any)
{
    const whit_renderer_params params = params_sized(0, 0, NULL);
    scene_open(WHIT_SCENES_DIR "/cube.json");
    own_refining o = begin(&params);
    float *zeros = calloc(640 * 480, 4 * sizeof *zeros);
    assert_non_null(zeros);
    assert_int_equal(whit_refine_begin(o.refine, 4, zeros, zeros), WHIT_OK);
    /* Another one has no size once it was moved, as only its creation looks at that. */
    whit_refine *moved = NULL;
    assert_int_equal(whit_refine_create(o.renderer, &params, &moved), WHIT_OK);
    whit_refine_move(moved, o.renderer, &params);
    assert_int_equal(whit_refine_begin(moved, 4, zeros, zeros), WHIT_ERROR_USAGE);
    whit_refine_destroy(moved);
    free(zeros);
}

/* ---- The estimate compared with the true error ---- */

/* Requirements for the estimate, from SAMPLES_FIRST on, over the pixels where it or the error
   exceeds SEEN: it is at least the error in COVERED_MIN % of them, and the median of estimate /
   error is at most RATIO_MAX. */
static const double COVERED_MIN = 95.0, RATIO_MAX = 8.0, SEEN = 1.0 / 512.0;
enum { SAMPLES_FIRST = 16, SAMPLES_LAST = 64, TRUTH_SAMPLES = 256, TRUTH_DEPTH = 255 };

/* Without a bail-out rays would not end, since glass before glass doubles their number at each
   bounce. So the true picture cuts rays with a weight below this. Half of the value changes no
   channel of a pixel by more than 3e-4 in any scene but the one below. */
static const double TRUTH_BAILOUT = 1e-5;

/* Scenes whose true picture would still take hours: it is smaller, and its bail-out is larger. */
static const struct {
    const char *name;
    uint32_t sides_by;
    double bailout;
} dear[] = {{"glass-of-water.json", 2, 1e-4}};

struct question {
    whit_renderer_params params;
    double truth_bailout;
};

static struct question question_of(const char *name)
{
    const whit_renderer_params usual = whit_renderer_defaults();
    struct question question = {params_of(usual.depth, usual.bailout), TRUTH_BAILOUT};
    for (size_t i = 0; i < sizeof dear / sizeof *dear; ++i) {
        if (strcmp(dear[i].name, name) != 0)
            continue;
        question.params.width /= dear[i].sides_by;
        question.params.height /= dear[i].sides_by;
        question.truth_bailout = dear[i].bailout;
    }
    return question;
}

/* Scenes whose estimate misses the requirements at some number of samples, with the reason. */
static const char few_edges[] =
    "most pixels are smooth, and next to edges the estimate tells of more than there is";
static const char noisy[] = "changes are like noise, and are small by chance in too many pixels";
static const char level[] =
    "samples meet edges that run along rows of pixels exactly, and their changes do not tell so";
static const struct {
    const char *name, *why;
} short_of_it[] = {
    {"cube.json", few_edges},      {"room.json", few_edges}, {"spin.json", level},
    {"spotlight.json", few_edges}, {"strands.json", noisy},
};

static whit_image *truth_of(const struct refining *o, double bailout)
{
    whit_renderer_params params = o->params;
    params.sampling.count = TRUTH_SAMPLES;
    params.depth = TRUTH_DEPTH;
    params.bailout = bailout;
    return reference_image(&params);
}

struct judged {
    int pixels;             /* number of pixels where estimate or error exceeds SEEN */
    double covered, median; /* % of these where estimate >= error; median of estimate / error */
    double rmse;
};

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static struct judged judge(const float *estimate, const float *picture, const float *truth,
                           int pixels)
{
    static double ratios[PIXELS];
    struct judged judged = {.covered = 100.0, .median = 1.0};
    double squares = 0.0;
    int covered = 0;
    for (int i = 0; i < pixels; ++i) {
        double error = 0.0, told = (double)estimate[i];
        for (int c = 4 * i; c < 4 * i + 3; ++c) {
            double off = fabs((double)picture[c] - (double)truth[c]);
            error = fmax(error, off);
            squares += off * off;
        }
        if (error <= SEEN && told <= SEEN)
            continue;
        covered += told >= error;
        ratios[judged.pixels++] = told / fmax(error, 1e-12);
    }
    judged.rmse = sqrt(squares / (3.0 * pixels));
    if (judged.pixels == 0)
        return judged;
    qsort(ratios, (size_t)judged.pixels, sizeof *ratios, compare_doubles);
    judged.covered = 100.0 * covered / judged.pixels;
    judged.median = ratios[judged.pixels / 2];
    return judged;
}

static bool is_good(const struct judged *judged)
{
    return judged->covered >= COVERED_MIN && judged->median <= RATIO_MAX;
}

/* The estimated RMSE is no less than the actual one from 2 samples on. It may be less where few
   pixels show small images of lights, and these samples met only some of them. */
static bool is_too_few(const char *name, uint32_t samples)
{
    return strcmp(name, "default.json") == 0 && samples < 8;
}

/* Prints a row for each number of samples; true if the estimate meets the requirements in all. */
static bool judge_scene(const char *path, const char *name)
{
    const struct question question = question_of(name);
    scene_open(path);
    own_refining o = begin(&question.params);
    own_whit_image *truth = truth_of(&o, question.truth_bailout);
    int pixels = (int)(question.params.width * question.params.height);
    bool good = true;
    for (uint32_t samples = 2; samples <= SAMPLES_LAST; samples *= 2) {
        whit_refine_info info = refine_to(&o, samples);
        own_whit_image *picture = picture_of(&o), *estimate = NULL;
        assert_int_equal(whit_refine_error_image(o.refine, &estimate), WHIT_OK);
        struct judged judged = judge(whit_image_floats(estimate), whit_image_floats(picture),
                                     whit_image_floats(truth), pixels);
        if (info.error < judged.rmse && !is_too_few(name, samples))
            fail_msg("%s: %u samples have an RMSE of %g, estimated as %g", name, samples,
                     judged.rmse, info.error);
        if (samples < SAMPLES_FIRST)
            continue;
        print_message("| `%s` | %u | %d | %.1f | %.1f | %.4f | %.4f | %s |\n", name, samples,
                      judged.pixels, judged.covered, judged.median, info.error, judged.rmse,
                      is_good(&judged) ? "" : "short");
        good &= is_good(&judged);
    }
    return good;
}

/* The scenes of a short run, one at each commit. */
static const char *const quick_scenes[] = {"balls.json", "many.json", "swarm.json"};

static bool is_wanted(const char *name)
{
    bool wanted = getenv("WHIT_TEST_ALL_SCENES") != NULL;
    for (size_t i = 0; i < sizeof quick_scenes / sizeof *quick_scenes; ++i)
        wanted |= strcmp(quick_scenes[i], name) == 0 && cases_turn(i, 3);
    return wanted;
}

static const char *why_short(const char *name)
{
    for (size_t i = 0; i < sizeof short_of_it / sizeof *short_of_it; ++i) {
        if (strcmp(short_of_it[i].name, name) == 0)
            return short_of_it[i].why;
    }
    return NULL;
}

/* The scenes that do not meet the requirements are exactly those of the list above. */
TEST(the_estimate_is_no_less_than_the_error_and_not_much_more)
{
    glob_t paths;
    int other = 0;
    assert_int_equal(glob(WHIT_SCENES_DIR "/*.json", 0, NULL, &paths), 0);
    print_message("| scene | samples | pixels over 1/512 | covered, %% | times the error, median | "
                  "RMSE, estimated | RMSE | |\n");
    for (size_t i = 0; i < paths.gl_pathc; ++i) {
        const char *name = strrchr(paths.gl_pathv[i], '/') + 1;
        if (!is_wanted(name))
            continue;
        bool good = judge_scene(paths.gl_pathv[i], name);
        const char *why = why_short(name);
        if (why)
            print_message("  %s falls short: %s\n", name, why);
        if (good == (why != NULL)) {
            print_message("  %s: %s\n", name, good ? "no longer falls short" : "falls short");
            ++other;
        }
    }
    globfree(&paths);
    assert_int_equal(other, 0);
}

TESTS_IN(device_begin, device_end)
