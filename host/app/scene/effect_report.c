/* The report of `whit scene --effects`: what each effect costs in this scene, and how much it
   changes the picture. */
#include <math.h>
#include <stdlib.h>

#include "app/document.h"
#include "app/render/stats.h"
#include "app/scene/listing.h"
#include "app/settings_json.h"
#include "cost/cost.h"

enum { EFFECT_ROWS_MAX = 64 };
struct effect_report {
    const struct job *job;
    struct cli_progress progress;
    whit_kernel_info kernel;
    struct sample_median frame_ms; /* time of the picture with the scene's own effects; by the
                                      device's clock where it has one */
    uint32_t row_count;
    struct cost_effect rows[EFFECT_ROWS_MAX]; /* by the index of whit_effect_name */
};

/* ---- Measuring ---- */

/* Time to spend on the frames of all effects together, unless the fewest rounds that give a
   confidence interval take longer. */
static const double MEASURE_MS = 15e3;

static uint32_t rounds_for(const struct effect_report *report, uint32_t effects)
{
    double pair_ms = 2.0 * fmax(report->frame_ms.median, 0.1);
    double rounds = MEASURE_MS / (effects ? effects : 1) / pair_ms;
    return rounds < COST_ROUNDS_MIN   ? COST_ROUNDS_MIN
           : rounds > COST_ROUNDS_MAX ? COST_ROUNDS_MAX
                                      : (uint32_t)rounds;
}

static whit_result begin(void *user, double done, const char *name)
{
    struct effect_report *report = user;
    (void)name;
    cli_progress_update(&report->progress, done);
    return job_still_wanted();
}

static void found(void *user, uint32_t index, const struct cost_effect *effect)
{
    struct effect_report *report = user;
    if (index >= EFFECT_ROWS_MAX)
        return;
    report->rows[index] = *effect;
    report->row_count = index + 1;
}

static whit_result measure(struct effect_report *report)
{
    const struct job *job = report->job;
    const whit_renderer_params params = job_picture(job);
    struct cost_effects effects = {.scene = job->scene,
                                   .device = job->device,
                                   .accel = job->accel,
                                   .params = &params,
                                   .added = true,
                                   .log = &cli_log,
                                   .begin = begin,
                                   .found = found,
                                   .user = report};
    struct cost_times times;
    whit_result result = whit_renderer_create(job->device, job->accel, &params, &effects.usual);
    if (result == WHIT_OK)
        result = whit_renderer_get_kernel(effects.usual, &report->kernel);
    if (result == WHIT_OK)
        result = cost_time(effects.usual, &params, COST_ROUNDS_MIN, &times);
    if (result == WHIT_OK) {
        report->frame_ms = times.ms[cost_clock_of(job->device, effects.usual)];
        effects.rounds = rounds_for(report, cost_effects_count(&effects));
        cli_progress_init(&report->progress, job->settings.quiet);
        result = cost_effects_measure(&effects);
        cli_progress_finish(&report->progress);
    }
    whit_renderer_destroy(effects.usual);
    return result;
}

/* ---- Text ---- */

static void print_head(const struct effect_report *report)
{
    const whit_renderer_params *picture = &report->job->settings.picture;
    printf("%s\n  picture   %u x %u, ", cli_shown(report->job->settings.scene), picture->width,
           picture->height);
    if (picture->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        printf("adaptive samples, ");
    else
        printf("%u sample%s a pixel, ", picture->sampling.count,
               picture->sampling.count == 1 ? "" : "s");
    printf("depth %u\n", picture->depth);
    stats_print_device("  device    ", report->job->device);
    printf("  kernel    %u of %u instructions, %u of %u bindings\n", report->kernel.instructions,
           report->kernel.general_instructions, report->kernel.bindings,
           report->kernel.general_bindings);
    printf("  frame     %.2f ms (%.2f to %.2f)\n\n", report->frame_ms.median, report->frame_ms.low,
           report->frame_ms.high);
}

/* The time of a frame with the effect less that of one without it. */
static struct sample_median cost_of(const struct cost_effect *row)
{
    struct sample_median cost = row->price.difference[row->clock];
    if (row->compiled) /* the priced picture is the one without the effect */
        cost = (struct sample_median){.median = -cost.median,
                                      .low = -cost.high,
                                      .high = -cost.low,
                                      .coverage = cost.coverage,
                                      .count = cost.count};
    return cost;
}

static void print_price(const struct cost_effect *row)
{
    char loss[64] = "";
    unsigned long long pixels = row->error.differing_pixels;
    if (!row->priced) {
        printf("%9s %19s  %-32s", "-", "", row->compiled ? "not to be left out" : "");
        return;
    }
    if (row->compiled && pixels)
        snprintf(loss, sizeof loss, "%llu pixel%s, by up to %.3g", pixels, pixels == 1 ? "" : "s",
                 row->error.largest);
    else if (row->compiled)
        snprintf(loss, sizeof loss, "nothing in this picture");
    else if (pixels)
        snprintf(loss, sizeof loss, "NOT THE SAME PICTURE");
    const struct sample_median cost = cost_of(row);
    printf("%+9.2f %+9.2f %+9.2f  %-32s", cost.median, cost.low, cost.high, loss);
}

#define NOT_ASKED "; the shader does not ask for it"

/* Whether the scene needs the effect, but the kernel leaves it out because no function of the
   shader reads it. */
static bool is_left_out(const struct effect_report *report, const whit_effect_info *effect,
                        const struct cost_effect *row)
{
    return report->job->shader && effect->called && !row->compiled;
}

static int print_text(const struct effect_report *report)
{
    print_head(report);
    printf("  %-19s%-9s%8s %19s  %-32s%s\n", "effect", "compiled", "ms here", "interval",
           "the picture without it loses", "where it comes from");
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_effect *row = &report->rows[i];
        whit_effect_info effect;
        whit_scene_get_effect(report->job->scene, i, &effect);
        printf("  %-19s%-8s", effect.name, row->compiled ? "yes" : "-");
        print_price(row);
        printf("%s%s\n", cli_shown(effect.reason),
               is_left_out(report, &effect, row) ? NOT_ASKED : "");
    }
    puts("\n  ms of one frame, with the effect less without it, measured in turns, and the interval"
         "\n  that holds the median 19 times of 20; of what is not compiled: what it would cost if"
         "\n  it were on.");
    return cli_finish_stdout(EXIT_FINE);
}

/* ---- JSON ---- */

static json_t *times_document(const struct sample_median *times, uint32_t rounds)
{
    json_t *object = document_object();
    document_ms(object, "median", times->median);
    document_ms(object, "low", times->low);
    document_ms(object, "high", times->high);
    document_count(object, "rounds", rounds);
    return object;
}

static void put_row(json_t *object, const struct effect_report *report,
                    const whit_effect_info *effect, const struct cost_effect *row)
{
    const struct sample_median cost = cost_of(row);
    document_text(object, "name", effect->name);
    document_flag(object, "called", effect->called);
    document_flag(object, "compiled", row->compiled);
    document_text(object, "reason", effect->reason);
    document_flag(object, "asked", !is_left_out(report, effect, row));
    document_put(object, "cost_ms",
                 row->priced ? times_document(&cost, row->price.rounds) : json_null());
    if (!row->priced) {
        document_put(object, "difference", json_null());
        return;
    }
    json_t *difference = document_child(object, "difference");
    document_count(difference, "pixels", row->error.differing_pixels);
    document_number(difference, "largest", row->error.largest);
}

static int print_json(const struct effect_report *report)
{
    whit_scene_info scene;
    whit_device_info info;
    whit_scene_get_info(report->job->scene, &scene);
    whit_device_get_info(report->job->device, &info);
    json_t *root = document_root();
    document_text(root, "file", report->job->settings.scene);
    document_hash(root, "hash", scene.hash);
    document_put(root, "device", document_device(&info));
    settings_describe(&report->job->settings, IN_SCENE, document_child(root, "picture"));
    json_t *kernel = document_child(root, "kernel");
    document_count(kernel, "instructions", report->kernel.instructions);
    document_count(kernel, "general_instructions", report->kernel.general_instructions);
    document_count(kernel, "bindings", report->kernel.bindings);
    document_count(kernel, "general_bindings", report->kernel.general_bindings);
    document_put(root, "frame_ms", times_document(&report->frame_ms, COST_ROUNDS_MIN));
    json_t *effects = document_list(root, "effects");
    for (uint32_t i = 0; i < report->row_count; ++i) {
        whit_effect_info effect;
        whit_scene_get_effect(report->job->scene, i, &effect);
        put_row(document_entry(effects), report, &effect, &report->rows[i]);
    }
    return cli_print_json(root);
}

/* ---- All of it ---- */

/* An effect that the scene does not need must not change the picture. */
static int check_promises(const struct effect_report *report)
{
    int status = EXIT_FINE;
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_effect *row = &report->rows[i];
        if (row->compiled || !row->priced || row->error.differing_pixels == 0)
            continue;
        cli_error("%s: the scene does not call for it, yet it changes %llu pixels",
                  whit_effect_name(i), (unsigned long long)row->error.differing_pixels);
        status = EXIT_DIFFERS;
    }
    return status;
}

int effect_report_run(struct job *job, bool json)
{
    struct effect_report *report = calloc(1, sizeof *report);
    if (!report)
        return cli_exit_of(cli_no_memory());
    report->job = job;
    whit_result result = job_build(job);
    if (result == WHIT_OK)
        result = job_open_device(job);
    if (result == WHIT_OK)
        result = measure(report);
    int status = cli_exit_of(result);
    if (result == WHIT_OK)
        status = json ? print_json(report) : print_text(report);
    if (status == EXIT_FINE)
        status = check_promises(report);
    if (status == EXIT_FINE)
        status = job_check_validation(job);
    free(report);
    return status;
}
