#include "cost/choose.h"
#include "cost/rays.h"
#include "cost/row.h"
#include "whit/whit_program.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SMALL_SHRINK = 4, SMALL_SIDE = 16, PROBES = 6 };
/* Shares of the requested time: for references and the pictures judged by them; for the row of the
   usual settings. */
static const double REFERENCE_SHARE = 0.35, USUAL_SHARE = 0.1;
/* A time limit that has passed leaves this time, since 0 means that there is no limit. */
static const double LEFT_MIN_S = 1e-6;
/* Added to limits given as multiples of the usual time: four times as many samples take a little
   more than four times as long. */
static const double OF_USUAL_ROOM = 1.2;

whit_result measure_still_wanted(const struct measure *measure)
{
    const volatile bool *cancel = measure->request->cancel;
    bool limited = measure->request->end_ms > 0.0;
    if (cancel && *cancel)
        return WHIT_ERROR_CANCELLED;
    return limited && measure_left_s(measure) <= LEFT_MIN_S ? WHIT_ERROR_TIME_LIMIT : WHIT_OK;
}

double measure_left_s(const struct measure *measure)
{
    double end_ms = measure->request->end_ms;
    return end_ms > 0.0 ? fmax((end_ms - whit_clock_ms()) * 1e-3, LEFT_MIN_S) : 0.0;
}

/* Estimate of the time left: what is left of the requested time, or more, by the time that the last
   rows took. */
static double seconds_left(const struct measure *measure, double spent_s)
{
    const struct cost_report *report = measure->report;
    double rows = measure->row < report->row_count ? report->row_count - measure->row : 0;
    return fmax(measure->request->seconds - spent_s, rows * measure->row_s);
}

void measure_say(const struct measure *measure, const char *what)
{
    const struct cost_request *request = measure->request;
    double spent_s = (whit_clock_ms() - measure->start_ms) * 1e-3;
    double left_s = seconds_left(measure, spent_s);
    if (request->progress)
        request->progress(request->progress_user,
                          fmin(spent_s / fmax(spent_s + left_s, 1e-3), 0.99), left_s, what);
}

/* ---- Renderers, references and rays ---- */

static void describe(const struct cost_request *request, struct cost_report *report)
{
    whit_device_info device;
    whit_scene_info scene;
    whit_device_get_info(request->device, &device);
    whit_scene_get_info(request->scene, &scene);
    report->width = request->settings->picture.width;
    report->height = request->settings->picture.height;
    report->scene_hash = scene.hash;
    snprintf(report->device, sizeof report->device, "%s", device.name);
    snprintf(report->driver, sizeof report->driver, "%s", device.driver);
    report->kind = device.kind;
}

void cost_small_size(const struct cost_report *report, uint32_t *width, uint32_t *height)
{
    *width = report->width / SMALL_SHRINK;
    *height = report->height / SMALL_SHRINK;
    *width = *width > SMALL_SIDE ? *width : SMALL_SIDE;
    *height = *height > SMALL_SIDE ? *height : SMALL_SIDE;
}

/* Makes the renderer of the usual settings, and measures its time per pixel. */
static whit_result open_renderer(struct measure *measure)
{
    struct cost_report *report = measure->report;
    whit_stats stats;
    uint32_t width, height;
    cost_small_size(report, &width, &height);
    const whit_renderer_params params = measure_sized(measure, &measure->usual, width, height);
    measure_say(measure, "the usual settings");
    whit_result result =
        measure_renderer(measure, &measure->usual, measure->request->accel, &measure->renderer);
    if (result == WHIT_OK)
        result = whit_renderer_set_view(measure->renderer, &params);
    if (result == WHIT_OK)
        result = whit_renderer_render(measure->renderer); /* to learn which clocks there are */
    if (result != WHIT_OK)
        return result;
    whit_renderer_get_stats(measure->renderer, &stats);
    report->clock = cost_clock_of(measure->request->device, measure->renderer);
    struct cost_times times;
    result = cost_time(measure->renderer, &params, PROBES, &times);
    if (result != WHIT_OK)
        return result;
    report->small_ms = times.ms[COST_WALL].median;
    measure->usual_pixel_ms = times.ms[COST_WALL].median / ((double)width * height);
    report->load_path = stats.load_path;
    return WHIT_OK;
}

/* Makes the renderer, references and rays with which rows are measured. */
static whit_result open_all(struct measure *measure, const struct cost_request *request,
                            struct cost_report *report)
{
    *measure = (struct measure){.request = request, .report = report, .start_ms = whit_clock_ms()};
    measure->usual = *request->settings;
    measure->usual.picture.sampling.count = 1;
    measure->usual.picture.sampling.kind = WHIT_SAMPLING_FIXED;
    measure->usual.paint = PAINT_COLOR;
    whit_result result = open_renderer(measure);
    if (result == WHIT_OK)
        result = measure_references(measure, REFERENCE_SHARE * request->seconds);
    return result == WHIT_OK ? measure_judges(measure) : result;
}

static void close_all(struct measure *measure)
{
    whit_image_destroy(measure->references[0]);
    if (measure->request->keep_pictures && !measure->report->reference)
        measure->report->reference = measure->references[1];
    else
        whit_image_destroy(measure->references[1]);
    whit_image_destroy(measure->usual_color);
    whit_image_destroy(measure->usual_ids);
    for (uint32_t set = 0; set < COST_SETS; ++set)
        whit_judge_destroy(measure->judges[set]);
    free(measure->hits);
    whit_renderer_destroy(measure->renderer);
    whit_renderer_destroy(measure->beside);
}

/* ---- Rows ---- */

static void note_absence(struct cost_report *report, const struct knob *knob, uint32_t setting,
                         const char *why)
{
    if (report->absent_count == COST_ABSENT_MAX)
        return;
    struct cost_absent *absent = &report->absent[report->absent_count++];
    snprintf(absent->name, sizeof absent->name, "%s %s", knob->name,
             knob_setting_name(knob, setting));
    snprintf(absent->why, sizeof absent->why, "%s", why);
}

static void add_row(struct cost_report *report, const struct knob *knob, uint32_t index,
                    uint32_t setting)
{
    struct cost_row *row = &report->rows[report->row_count++];
    *row = (struct cost_row){.knob_index = index,
                             .setting_index = setting,
                             .change = knob_change(knob),
                             .build_ms = -1.0,
                             .ms = {-1.0, -1.0, -1.0}};
    snprintf(row->knob, sizeof row->knob, "%s", knob->name);
    snprintf(row->setting, sizeof row->setting, "%s", knob_setting_name(knob, setting));
    knob_option(knob, setting, row->option, sizeof row->option);
}

/* Why the knob's setting is not measured; NULL: it is. */
static const char *find_absence(const struct cost_request *request,
                                const struct cost_report *report, const struct knob *knob,
                                uint32_t setting)
{
    struct cost_row row;
    knob_option(knob, setting, row.option, sizeof row.option);
    if (cost_samples(&row) > report->reference_samples)
        return "more samples than the reference, which cannot judge it";
    return knob_absence(knob, setting, request->scene, report->load_path);
}

static void list_rows(const struct cost_request *request, struct cost_report *report)
{
    report->rows[0] = (struct cost_row){.knob = "usual",
                                        .knob_index = WHIT_NONE,
                                        .setting_index = WHIT_NONE,
                                        .change = SETTING_COST,
                                        .ms = {-1.0, -1.0, -1.0}};
    report->row_count = 1;
    for (uint32_t k = 0; k < KNOBS; ++k) {
        if (request->knobs != COST_KNOBS_ALL && !(request->knobs >> k & 1))
            continue;
        for (uint32_t s = 0; s < knob_table[k].count; ++s) {
            if (s == knob_table[k].usual)
                continue;
            const char *why = find_absence(request, report, &knob_table[k], s);
            if (why)
                note_absence(report, &knob_table[k], s, why);
            else if (report->row_count < COST_ROWS_MAX)
                add_row(report, &knob_table[k], k, s);
        }
    }
}

static whit_result measure_setting(struct measure *measure, uint32_t index)
{
    struct cost_report *report = measure->report;
    struct cost_row *row = &report->rows[index];
    struct settings target = measure->usual;
    const struct knob *knob = &knob_table[row->knob_index];
    char what[COST_NAME];
    snprintf(what, sizeof what, "%s %s", row->knob, row->setting);
    measure->row = index;
    measure_say(measure, what);
    knob_apply(knob, row->setting_index, &target);
    double begun_ms = whit_clock_ms();
    double left_s = measure->request->seconds - (begun_ms - measure->start_ms) * 1e-3;
    double share_s = fmax(left_s, 0.0) / (report->row_count - index);
    whit_result result = measure_row(measure, &target, knob_level(knob), share_s, row);
    /* Rows of knob `aa` do not predict how long the rows after them take. */
    double row_s = (whit_clock_ms() - begun_ms) * 1e-3;
    measure->row_s = strcmp(row->knob, "aa") == 0 ? 0.0
                     : measure->row_s == 0.0      ? row_s
                                                  : 0.75 * measure->row_s + 0.25 * row_s;
    return result;
}

static whit_result measure_rows(struct measure *measure)
{
    struct cost_report *report = measure->report;
    list_rows(measure->request, report);
    measure_say(measure, "the usual settings");
    whit_result result =
        measure_usual(measure, USUAL_SHARE * measure->request->seconds, &report->rows[0]);
    for (uint32_t i = 1; result == WHIT_OK && i < report->row_count; ++i) {
        result = measure_still_wanted(measure);
        if (result == WHIT_OK)
            result = measure_setting(measure, i);
    }
    return result;
}

/* ---- Choices ---- */

static void destroy_pictures(struct cost_row *row)
{
    whit_image_destroy(row->picture);
    whit_image_destroy(row->flip);
    row->picture = row->flip = NULL;
}

static enum knob_level level_of(const struct cost_choice *choice)
{
    enum knob_level level = KNOB_VIEW;
    for (uint32_t k = 0; k < KNOBS; ++k)
        if (choice->settings[k] != knob_table[k].usual && knob_level(&knob_table[k]) > level)
            level = knob_level(&knob_table[k]);
    return level;
}

static whit_result measure_choice(struct measure *measure, const struct cost_choice *choice,
                                  struct cost_answer *answer)
{
    struct cost_report *report = measure->report;
    struct settings target = measure->usual;
    struct cost_row *row = &report->rows[report->row_count];
    *row = (struct cost_row){.knob_index = WHIT_NONE,
                             .setting_index = WHIT_NONE,
                             .change = SETTING_LIGHT,
                             .ms = {-1.0, -1.0, -1.0}};
    snprintf(row->knob, sizeof row->knob, "chosen");
    snprintf(row->setting, sizeof row->setting, "%s %.6g%s",
             answer->goal.kind == COST_WITHIN ? "within" : "under", answer->goal.limit,
             answer->goal.kind == COST_WITHIN ? " ms" : "");
    cost_choice_text(choice, row->option, sizeof row->option);
    measure_say(measure, row->setting);
    cost_choice_apply(choice, &target);
    answer->row = report->row_count++;
    whit_result result =
        measure_row(measure, &target, level_of(choice), 0.05 * measure->request->seconds, row);
    double error = cost_is_judged(report, row) ? cost_error_of(&row->error, answer->goal.metric)
                                               : answer->error;
    answer->kept = result == WHIT_OK && row->measured && choose_keeps(&answer->goal, row, error);
    return result;
}

/* Predicts settings for a goal and measures them. Where they exceed the limit, tries again with a
   narrower limit for the prediction. */
static whit_result answer_goal(struct measure *measure, const struct cost_goal *goal)
{
    enum { TRIES = 3 };
    struct cost_report *report = measure->report;
    struct cost_answer *answer = &report->answers[report->answer_count++];
    struct cost_goal aim = *goal;
    if (goal->of_usual > 0.0)
        aim.limit = OF_USUAL_ROOM * goal->of_usual * report->usual_ms_max;
    const struct cost_goal wanted = aim;
    whit_result result = WHIT_OK;
    for (int i = 0; result == WHIT_OK && i < TRIES; ++i) {
        const struct cost_choice choice = cost_choose(report, &aim);
        if (answer->row && choice.found)
            --report->row_count; /* drops the row of the try before */
        if (!choice.found && i > 0)
            break;
        *answer = (struct cost_answer){.goal = wanted,
                                       .found = choice.found,
                                       .row = WHIT_NONE,
                                       .ms = choice.ms,
                                       .error = choice.error};
        if (!choice.found || report->row_count == COST_ROWS_MAX)
            break;
        destroy_pictures(&report->rows[report->row_count]);
        result = measure_choice(measure, &choice, answer);
        if (answer->kept)
            break;
        aim.limit *= 0.8;
    }
    if (result == WHIT_OK)
        choose_measured(report, answer);
    return result;
}

whit_result cost_measure(const struct cost_request *request, struct cost_report **out)
{
    struct measure measure;
    struct cost_report *report = calloc(1, sizeof *report);
    *out = NULL;
    if (!report)
        return WHIT_ERROR_MEMORY;
    describe(request, report);
    whit_result result = open_all(&measure, request, report);
    if (result == WHIT_OK)
        result = measure_rows(&measure);
    for (uint32_t i = 0; result == WHIT_OK && i < request->goal_count; ++i)
        result = answer_goal(&measure, &request->goals[i]);
    report->complete = result == WHIT_OK;
    close_all(&measure);
    report->spent_ms = whit_clock_ms() - measure.start_ms;
    cost_mark_best(report, COST_FLIP);
    bool stopped = result == WHIT_ERROR_CANCELLED || result == WHIT_ERROR_TIME_LIMIT;
    if ((result == WHIT_OK || stopped) && report->rows[0].measured)
        *out = report;
    else
        cost_report_destroy(report);
    return result;
}

void cost_report_drop_pictures(struct cost_report *report)
{
    for (uint32_t i = 0; i < COST_ROWS_MAX; ++i)
        destroy_pictures(&report->rows[i]);
    whit_image_destroy(report->reference);
    report->reference = NULL;
}

void cost_report_destroy(struct cost_report *report)
{
    if (report)
        cost_report_drop_pictures(report);
    free(report);
}
