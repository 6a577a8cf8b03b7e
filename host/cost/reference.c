/* Pictures of the reference in double, which are kept in a cache. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/log.h"
#include "base/store.h"
#include "cost/measure.h"
#include "whit/whit_program.h"

/* KEPT_VERSION is raised when pictures of the reference change, so that cached ones are not
   used. */
enum { KEPT_VERSION = 4, KEPT_CHANNELS = 4, SHRINK_MAX = 16, SHRINK_GOOD = 4, SIDE_MIN = 16 };
enum { SAMPLES_MANY = 64, SAMPLES_FEW = 16 };

static bool calls_for_area_lights(const whit_scene *scene)
{
    const struct knob *knob = &knob_table[knob_find("light-samples")];
    return knob_absence(knob, 1, scene, WHIT_LOAD_AUTO) == NULL;
}

static whit_renderer_params reference_params(const struct measure *measure, uint32_t shrink,
                                             uint32_t samples)
{
    whit_renderer_params params = settings_picture(&measure->usual);
    params.width = measure->report->width / shrink ? measure->report->width / shrink : 1;
    params.height = measure->report->height / shrink ? measure->report->height / shrink : 1;
    params.sampling.count = samples;
    params.cancel = measure->request->cancel;
    params.time_limit_s = measure_left_s(measure);
    params.sampling.kind = WHIT_SAMPLING_FIXED;
    params.depth = MEASURE_DEPTH;
    params.bailout = MEASURE_BAILOUT;
    params.light_samples = measure->report->reference_light_samples;
    return params;
}

enum { KEPT_NAME = 48 };
static void kept_name(const struct measure *measure, const whit_renderer_params *params,
                      char name[KEPT_NAME])
{
    char key[512];
    snprintf(key, sizeof key, "%d %s %016" PRIx64 " %ux%u %u %u %u %.17g %s", KEPT_VERSION,
             WHIT_VERSION, measure->report->scene_hash, params->width, params->height,
             params->sampling.count, params->depth, params->light_samples, params->time_s,
             measure->usual.camera);
    snprintf(name, KEPT_NAME, "reference-%016" PRIx64, hash_bytes(HASH_START, key, strlen(key)));
}

/* Reads a picture from the cache; NULL: it is not there. */
static whit_image *read_kept(const struct measure *measure, const whit_renderer_params *params)
{
    char name[KEPT_NAME];
    whit_image *image = NULL;
    uint8_t *data;
    size_t bytes;
    size_t pixels = (size_t)params->width * params->height;
    kept_name(measure, params, name);
    if (store_read(measure->request->log, name, &data, &bytes) &&
        bytes == pixels * KEPT_CHANNELS * sizeof(float) &&
        whit_image_create(params->width, params->height, KEPT_CHANNELS, (const float *)data,
                          &image) != WHIT_OK)
        image = NULL;
    if (image)
        whit_image_display_as(image, params);
    free(data);
    return image;
}

static void keep(const struct measure *measure, const whit_renderer_params *params,
                 const whit_image *image)
{
    char name[KEPT_NAME];
    whit_image_info info;
    whit_image_get_info(image, &info);
    kept_name(measure, params, name);
    if (info.channels == KEPT_CHANNELS && !info.integers)
        store_write(measure->request->log, name, whit_image_floats(image),
                    (size_t)info.width * info.height * KEPT_CHANNELS * sizeof(float));
}

static bool is_kept(const struct measure *measure, uint32_t shrink)
{
    bool all = true;
    for (uint32_t i = 0; i < 2; ++i) {
        const whit_renderer_params params =
            reference_params(measure, shrink, i ? measure->report->reference_samples : 1);
        whit_image *image = read_kept(measure, &params);
        all = all && image;
        whit_image_destroy(image);
    }
    return all;
}

static whit_result render(const struct measure *measure, const whit_renderer_params *params,
                          whit_image **out, double *ms)
{
    whit_reference *reference = NULL;
    double start_ms = whit_clock_ms();
    whit_result result = whit_reference_create(measure->request->accel, params, 0, &reference);
    if (result == WHIT_OK)
        result = whit_reference_render(reference, out, NULL);
    whit_reference_destroy(reference);
    *ms = whit_clock_ms() - start_ms;
    return result;
}

/* Says beforehand that the picture of all samples takes longer than all that was asked for, by the
   one of a single sample. */
static void say_time(const struct measure *measure)
{
    const struct cost_report *report = measure->report;
    double seconds = report->reference_ms[0] * report->reference_samples * 1e-3;
    if (seconds > measure->request->seconds)
        log_info(measure->request->log,
                 "the reference in double takes about %.0f s, more than the %.3g s that all should "
                 "take; a smaller --size takes less, and so does --reference-samples 16 or 4",
                 seconds, measure->request->seconds);
}

static whit_result make(struct measure *measure, uint32_t shrink, uint32_t index)
{
    struct cost_report *report = measure->report;
    const whit_renderer_params params =
        reference_params(measure, shrink, index ? report->reference_samples : 1);
    measure->references[index] = read_kept(measure, &params);
    report->reference_cached[index] = measure->references[index] != NULL;
    whit_result result = WHIT_OK;
    if (!measure->references[index]) {
        if (index > 0)
            say_time(measure);
        result =
            render(measure, &params, &measure->references[index], &report->reference_ms[index]);
        if (result == WHIT_OK)
            keep(measure, &params, measure->references[index]);
    }
    return result;
}

/* Estimated time to draw the judged pictures of all `aa` rows, in usual pictures. Rows with fixed
   numbers of samples (1, 4, 16 ...) add up to 4/3 of reference_samples, adaptive sampling takes up
   to reference_samples. */
static double pictures_to_judge(const struct cost_report *report)
{
    return (4.0 / 3.0 + 1.0) * report->reference_samples;
}

/* The largest factor by which the judged picture may be smaller than the requested one. */
static uint32_t shrink_most(const struct measure *measure)
{
    const double width_min = fmax(SIDE_MIN, measure->request->judged_width_min),
                 height_min = fmax(SIDE_MIN, measure->request->judged_height_min);
    uint32_t shrink = 1;
    while (shrink < SHRINK_MAX && measure->report->width / shrink / 2.0 >= width_min &&
           measure->report->height / shrink / 2.0 >= height_min)
        shrink *= 2;
    return shrink;
}

/* Whether references and judged pictures take at most `seconds`. Cached references take no time. */
static bool fits(const struct measure *measure, double pixel_ms, uint32_t shrink, double seconds)
{
    const struct cost_report *report = measure->report;
    double width = report->width / shrink, height = report->height / shrink;
    double all_ms = measure->usual_pixel_ms * pictures_to_judge(report);
    if (!is_kept(measure, shrink))
        all_ms += pixel_ms * (report->reference_samples + 1);
    return all_ms * width * height <= seconds * 1e3;
}

static uint32_t shrink_to_fit(const struct measure *measure, double pixel_ms, uint32_t most,
                              double seconds)
{
    uint32_t shrink = 1;
    while (shrink < most && !fits(measure, pixel_ms, shrink, seconds))
        shrink *= 2;
    return shrink;
}

/* Chooses by which factor the judged picture is smaller than the requested one, so that references
   and judged pictures take at most `seconds`, or else as little as the least size allows. Where
   SHRINK_GOOD would not do, the reference gets fewer samples. */
static whit_result choose_shrink(struct measure *measure, double seconds, uint32_t *shrink)
{
    struct cost_report *report = measure->report;
    const uint32_t most = shrink_most(measure), good = most < SHRINK_GOOD ? most : SHRINK_GOOD;
    bool free_samples = measure->request->samples_max == 0;
    whit_image *image = NULL;
    double ms = 0.0;
    const whit_renderer_params probe = reference_params(measure, SHRINK_MAX, 1);
    whit_result result = render(measure, &probe, &image, &ms);
    whit_image_destroy(image);
    double pixel_ms = ms / ((double)probe.width * probe.height);
    *shrink = shrink_to_fit(measure, pixel_ms, free_samples ? good : most, seconds);
    if (free_samples && !fits(measure, pixel_ms, *shrink, seconds)) {
        report->reference_samples = SAMPLES_FEW;
        *shrink = shrink_to_fit(measure, pixel_ms, most, seconds);
    }
    return result;
}

whit_result measure_references(struct measure *measure, double seconds)
{
    struct cost_report *report = measure->report;
    uint32_t shrink = 1;
    report->reference_depth = MEASURE_DEPTH;
    report->reference_samples =
        measure->request->samples_max ? measure->request->samples_max : SAMPLES_MANY;
    report->reference_light_samples =
        calls_for_area_lights(measure->request->scene) ? MEASURE_LIGHT_SAMPLES : 16;
    measure_say(measure, "reference in double");
    whit_result result = choose_shrink(measure, seconds, &shrink);
    const whit_renderer_params params = reference_params(measure, shrink, 1);
    report->judged_width = params.width;
    report->judged_height = params.height;
    for (uint32_t i = 0; result == WHIT_OK && i < 2; ++i) {
        measure_say(measure, "reference in double");
        result = make(measure, shrink, i);
    }
    return result;
}
