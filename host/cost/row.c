/* Measures one row of a report: errors, times and hits. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cost/rays.h"
#include "cost/row.h"
#include "whit/whit_program.h"

enum { SHRINK_MAX = 16, BUILDS = 3, WARM_SIDE = 16, FULL_MIN = 6 };
/* Timed pictures are not shrunk until they take less than this, since the fixed cost of a dispatch
   would distort the ratio. */
static const double FRAME_MS_MIN = 10.0;

whit_renderer_params measure_sized(const struct measure *measure, const struct settings *target,
                                   uint32_t width, uint32_t height)
{
    whit_renderer_params params = settings_picture(target);
    params.width = width;
    params.height = height;
    params.cancel = measure->request->cancel;
    params.time_limit_s = measure_left_s(measure);
    return params;
}

whit_result measure_renderer(const struct measure *measure, const struct settings *target,
                             whit_accel *accel, whit_renderer **out)
{
    const struct cost_report *report = measure->report;
    const whit_renderer_params full = measure_sized(measure, target, report->width, report->height);
    whit_result result = whit_renderer_create(measure->request->device, accel, &full, out);
    /* The renderer's own limit counts from its start, and so not what making it took. */
    return result == WHIT_OK ? measure_still_wanted(measure) : result;
}

/* ---- Errors ---- */

static whit_result compare(const struct measure *measure, const whit_image *reference,
                           const whit_image *image, bool flip, whit_difference *out,
                           whit_image **map)
{
    const whit_compare_params params = {.no_flip = !flip};
    return whit_image_compare(reference, image, &params, measure->request->log, out, map);
}

/* Counts the pixels whose colour or ids differ from the usual picture's in any bit. */
static whit_result compare_with_usual(const struct measure *measure, const whit_image *color,
                                      const whit_image *ids, struct cost_row *row)
{
    whit_difference found;
    whit_result result = compare(measure, measure->usual_color, color, false, &found, NULL);
    if (result != WHIT_OK)
        return result;
    row->pixels_changed = found.differing_pixels;
    result = compare(measure, measure->usual_ids, ids, false, &found, NULL);
    row->ids_changed = found.differing_pixels;
    row->broken = row->change == SETTING_COST && (row->pixels_changed || row->ids_changed) &&
                  result == WHIT_OK;
    return result;
}

static bool changes_samples(const struct settings *target)
{
    const whit_sampling *sampling = &target->picture.sampling;
    return sampling->kind != WHIT_SAMPLING_FIXED || sampling->count != 1;
}

/* Compares images with the references. The first images, those of the usual settings, become
   measure->usual_color and usual_ids; later ones stay the caller's. */
static whit_result judge_images(struct measure *measure, const struct settings *target,
                                whit_image *color, whit_image *ids, struct cost_row *row)
{
    whit_image *map = NULL;
    if (!measure->usual_color) {
        measure->usual_color = color;
        measure->usual_ids = ids;
    }
    whit_result result = compare_with_usual(measure, color, ids, row);
    if (result == WHIT_OK)
        result = compare(measure, measure->references[1], color, true, &row->error, &map);
    if (result == WHIT_OK && !changes_samples(target))
        result = compare(measure, measure->references[0], color, true, &row->alone, NULL);
    row->non_finite = row->error.nonfinite_b;
    if (measure->request->keep_pictures && result == WHIT_OK)
        row->flip = map;
    else
        whit_image_destroy(map);
    return result;
}

static void drop(const struct measure *measure, whit_image *color, whit_image *ids)
{
    if (color != measure->usual_color)
        whit_image_destroy(color);
    if (ids != measure->usual_ids)
        whit_image_destroy(ids);
}

/* Judges the picture that the renderer has drawn last, at the judged size. */
static whit_result judge(struct measure *measure, const struct settings *target,
                         whit_renderer *renderer, struct cost_row *row)
{
    whit_image *color = NULL, *ids = NULL;
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &color);
    if (result == WHIT_OK)
        result = whit_renderer_image(renderer, WHIT_AOV_IDS, &ids);
    if (result == WHIT_OK)
        result = judge_images(measure, target, color, ids, row);
    if (result == WHIT_OK && measure->request->keep_pictures)
        result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &row->picture);
    drop(measure, color, ids);
    return result;
}

/* ---- Times ---- */

/* Plans timing: the largest picture of which at least COST_ROUNDS_MIN pairs fit into `ms`, and how
   many *rounds fit. `ratio`: expected time of the setting / usual time. */
static void plan(const struct measure *measure, double ratio, double ms, uint32_t *width,
                 uint32_t *height, uint32_t *rounds)
{
    const struct cost_report *report = measure->report;
    double pair_ms = 0.0;
    for (uint32_t shrink = 1; shrink <= SHRINK_MAX; shrink *= 2) {
        uint32_t w = report->width / shrink, h = report->height / shrink;
        double usual_ms = measure->usual_pixel_ms * w * h;
        if (shrink > 1 && (w < 16 || h < 16 || usual_ms * sqrt(fmax(ratio, 1.0)) < FRAME_MS_MIN))
            break;
        *width = w;
        *height = h;
        pair_ms = usual_ms * (1.0 + ratio);
        /* One pair more, to warm up. */
        if (pair_ms * (COST_ROUNDS_MIN + 1) <= ms)
            break;
    }
    double fit = ms / fmax(pair_ms, 1e-3) - 1.0;
    *rounds = fit < COST_ROUNDS_MIN   ? COST_ROUNDS_MIN
              : fit > COST_ROUNDS_MAX ? COST_ROUNDS_MAX
                                      : (uint32_t)fit;
}

/* Sets the row's times: its ratios times the usual picture's time at full size. */
static void scale_times(const struct cost_report *report, struct cost_row *row)
{
    const struct cost_row *usual = &report->rows[0];
    for (uint32_t c = 0; c < COST_CLOCKS; ++c) {
        bool known = row->price.ratio[c].count > 0 && usual->ms[c] >= 0.0;
        row->ms[c] = known ? usual->ms[c] * row->price.ratio[c].median : -1.0;
    }
    row->ms_low = usual->ms[report->clock] * row->price.ratio[report->clock].low;
    row->ms_high = usual->ms[report->clock] * row->price.ratio[report->clock].high;
}

/* Prices the target as `renderer` draws it, or the reference in double where that is NULL. `ratio`:
   expected time of the target / usual time. */
static whit_result price(struct measure *measure, const struct settings *target,
                         whit_renderer *renderer, double end_ms, double ratio, struct cost_row *row)
{
    uint32_t width, height, rounds;
    whit_reference *reference = NULL;
    whit_result result = WHIT_OK;
    plan(measure, ratio, end_ms - whit_clock_ms(), &width, &height, &rounds);
    const whit_renderer_params first = measure_sized(measure, &measure->usual, width, height);
    const whit_renderer_params second = measure_sized(measure, target, width, height);
    if (!renderer)
        result = whit_reference_create(measure->request->accel, &second, 0, &reference);
    if (result == WHIT_OK)
        result = cost_price(measure->renderer, &first, renderer, &second, reference,
                            measure->report->clock, rounds, &row->price);
    whit_reference_destroy(reference);
    if (result == WHIT_OK && row != &measure->report->rows[0])
        scale_times(measure->report, row);
    return result;
}

/* ---- A setting ---- */

static whit_result build(struct measure *measure, const struct settings *target, whit_accel **out,
                         double *build_ms)
{
    double times[BUILDS];
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < BUILDS; ++i) {
        whit_accel_info info;
        whit_accel *accel = NULL;
        result = whit_accel_create(measure->request->scene, &target->trees, &accel);
        if (result != WHIT_OK)
            break;
        whit_accel_get_info(accel, &info);
        times[i] = info.build_ms;
        whit_accel_destroy(*out);
        *out = accel;
        result = measure_still_wanted(measure);
    }
    if (result == WHIT_OK)
        *build_ms = sample_median_of(times, BUILDS).median;
    return result;
}

/* Renders the judged picture and times it. Unless `ran`, a small picture comes first, since some
   drivers finish compiling a kernel when it first runs. */
static whit_result draw_judged(struct measure *measure, whit_renderer *renderer,
                               const whit_renderer_params *judged, bool ran, double *ms)
{
    whit_renderer_params small = *judged;
    small.width = small.height = WARM_SIDE;
    whit_result result = WHIT_OK;
    if (!ran) {
        result = whit_renderer_set_view(renderer, &small);
        if (result == WHIT_OK)
            result = whit_renderer_render(renderer);
        if (result == WHIT_OK)
            result = measure_still_wanted(measure);
    }
    if (result == WHIT_OK)
        result = whit_renderer_set_view(renderer, judged);
    double start_ms = whit_clock_ms();
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    *ms = whit_clock_ms() - start_ms;
    return result;
}

static bool is_refusal(whit_result result)
{
    return result == WHIT_ERROR_STATUS || result == WHIT_ERROR_USAGE ||
           result == WHIT_ERROR_DEVICE || result == WHIT_ERROR_INPUT;
}

/* Takes a renderer for `target`, to be given back by give_renderer. Rows of KNOB_VIEW share one,
   since making another would compile its kernel again. *ran: its kernel has run before. */
static whit_result take_renderer(struct measure *measure, const struct settings *target,
                                 enum knob_level level, whit_accel *accel, whit_renderer **out,
                                 bool *ran)
{
    *ran = level == KNOB_VIEW && measure->beside;
    if (!*ran)
        return measure_renderer(measure, target, accel, out);
    *out = measure->beside;
    measure->beside = NULL;
    return WHIT_OK;
}

static void give_renderer(struct measure *measure, enum knob_level level, whit_renderer *renderer)
{
    if (level == KNOB_VIEW)
        measure->beside = renderer;
    else
        whit_renderer_destroy(renderer);
}

static whit_result find_out(struct measure *measure, const struct settings *target,
                            enum knob_level level, whit_accel *accel, double end_ms,
                            struct cost_row *row)
{
    const struct cost_report *report = measure->report;
    const whit_renderer_params params =
        measure_sized(measure, target, report->judged_width, report->judged_height);
    whit_renderer *renderer = NULL;
    double ms = 0.0;
    bool ran;
    whit_result result = take_renderer(measure, target, level, accel, &renderer, &ran);
    if (result == WHIT_OK)
        result = draw_judged(measure, renderer, &params, ran, &ms);
    if (result == WHIT_OK)
        result = judge(measure, target, renderer, row);
    if (result == WHIT_OK && row->change != SETTING_LIGHT)
        result = measure_hits(measure, renderer, target, row);
    double usual_ms = measure->usual_pixel_ms * params.width * params.height;
    if (result == WHIT_OK)
        result =
            price(measure, target, renderer, end_ms, fmin(fmax(ms / usual_ms, 0.1), 100.0), row);
    give_renderer(measure, level, renderer);
    return result;
}

/* ---- In double ---- */

/* The row "arithmetic double": the usual settings drawn by the reference. It differs from the usual
   row only by the effects of float arithmetic. */
static whit_result find_out_double(struct measure *measure, const struct settings *target,
                                   double end_ms, struct cost_row *row)
{
    const whit_renderer_params params = measure_sized(
        measure, target, measure->report->judged_width, measure->report->judged_height);
    whit_reference *reference = NULL;
    whit_image *color = NULL, *ids = NULL;
    double start_ms = whit_clock_ms();
    whit_result result = whit_reference_create(measure->request->accel, &params, 0, &reference);
    if (result == WHIT_OK)
        result = whit_reference_render(reference, &color, &ids);
    double ms = whit_clock_ms() - start_ms;
    whit_reference_destroy(reference);
    if (result == WHIT_OK)
        result = judge_images(measure, target, color, ids, row);
    if (result == WHIT_OK && measure->request->keep_pictures) {
        row->picture = color;
        color = NULL;
    }
    drop(measure, color, ids);
    double usual_ms = measure->usual_pixel_ms * params.width * params.height;
    if (result == WHIT_OK)
        result = price(measure, target, NULL, end_ms, ms / usual_ms, row);
    return result;
}

whit_result measure_row(struct measure *measure, const struct settings *target,
                        enum knob_level level, double seconds, struct cost_row *row)
{
    double end_ms = whit_clock_ms() + seconds * 1e3;
    whit_accel *accel = NULL;
    whit_result result = WHIT_OK;
    row->build_ms = -1.0;
    if (level == KNOB_TREE)
        result = build(measure, target, &accel, &row->build_ms);
    if (measure->request->hush)
        measure->request->hush(true);
    if (result == WHIT_OK && level == KNOB_DOUBLE)
        result = find_out_double(measure, target, end_ms, row);
    else if (result == WHIT_OK)
        result =
            find_out(measure, target, level, accel ? accel : measure->request->accel, end_ms, row);
    if (measure->request->hush)
        measure->request->hush(false);
    whit_accel_destroy(accel);
    row->measured = result == WHIT_OK;
    if (!is_refusal(result))
        return result;
    snprintf(row->note, sizeof row->note, "%s",
             result == WHIT_ERROR_STATUS ? "no answer: the device says that its picture is not to "
                                           "be trusted"
                                         : "this device or scene refuses it");
    return WHIT_OK;
}

/* ---- The usual settings ---- */

/* Times the usual picture at full size, as often as `seconds` allow, but at least FULL_MIN
   times. */
static whit_result time_full(struct measure *measure, double seconds)
{
    struct cost_report *report = measure->report;
    struct cost_row *row = &report->rows[0];
    const whit_renderer_params full =
        measure_sized(measure, &measure->usual, report->width, report->height);
    double full_ms = measure->usual_pixel_ms * full.width * full.height;
    double fit = seconds * 1e3 / full_ms - 1.0;
    uint32_t rounds = fit < FULL_MIN          ? FULL_MIN
                      : fit > COST_ROUNDS_MAX ? COST_ROUNDS_MAX
                                              : (uint32_t)fit;
    struct cost_times times;
    whit_result result = cost_time(measure->renderer, &full, rounds, &times);
    for (uint32_t c = 0; result == WHIT_OK && c < COST_CLOCKS; ++c)
        row->ms[c] = times.ms[c].count > 0 ? times.ms[c].median : -1.0;
    report->usual_ms_max = times.wall_max_ms;
    row->ms_low = times.ms[report->clock].low;
    row->ms_high = times.ms[report->clock].high;
    return result;
}

/* The usual row's price compares the usual picture with itself: its ratio shows how well this
   machine measures. */
whit_result measure_usual(struct measure *measure, double seconds, struct cost_row *row)
{
    const struct cost_report *report = measure->report;
    double end_ms = whit_clock_ms() + seconds * 1e3;
    const whit_renderer_params judged =
        measure_sized(measure, &measure->usual, report->judged_width, report->judged_height);
    whit_accel *again = NULL; /* trees that are built only to be timed, as in other rows */
    double ms;
    whit_result result = build(measure, &measure->usual, &again, &row->build_ms);
    whit_accel_destroy(again);
    if (result == WHIT_OK)
        result = draw_judged(measure, measure->renderer, &judged, true, &ms);
    if (result == WHIT_OK)
        result = judge(measure, &measure->usual, measure->renderer, row);
    if (result == WHIT_OK)
        result = measure_hits(measure, measure->renderer, &measure->usual, row);
    if (result == WHIT_OK)
        result = time_full(measure, 0.7 * (end_ms - whit_clock_ms()) * 1e-3);
    if (result == WHIT_OK)
        result = measure_still_wanted(measure);
    if (result == WHIT_OK)
        result = price(measure, &measure->usual, measure->renderer, end_ms, 1.0, row);
    row->measured = result == WHIT_OK;
    return result;
}
