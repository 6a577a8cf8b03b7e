#include "app/scene/receipt_output.h"

#include <math.h>
#include <stdlib.h>

/* Time to spend on the frames of all effects together, unless the fewest rounds that give a
   confidence interval take longer. */
static const double MEASURE_MS = 15e3;

static uint32_t rounds_for(const struct receipt *receipt, uint32_t effects)
{
    double pair_ms = 2.0 * fmax(receipt->frame_ms.median, 0.1);
    double rounds = MEASURE_MS / (effects ? effects : 1) / pair_ms;
    return rounds < COST_ROUNDS_MIN   ? COST_ROUNDS_MIN
           : rounds > COST_ROUNDS_MAX ? COST_ROUNDS_MAX
                                      : (uint32_t)rounds;
}

static whit_result begin(void *user, double done, const char *name)
{
    struct receipt *receipt = user;
    (void)name;
    cli_progress_update(&receipt->progress, done);
    return job_still_wanted();
}

static void found(void *user, uint32_t index, const struct cost_effect *effect)
{
    struct receipt *receipt = user;
    if (index >= RECEIPT_ROWS_MAX)
        return;
    receipt->rows[index] = *effect;
    receipt->row_count = index + 1;
}

static whit_result measure(struct receipt *receipt)
{
    const struct job *job = receipt->job;
    const whit_renderer_params params = job_picture(job);
    struct cost_effects effects = {.scene = job->scene,
                                   .device = job->device,
                                   .accel = job->accel,
                                   .params = &params,
                                   .added = true,
                                   .log = &cli_log,
                                   .begin = begin,
                                   .found = found,
                                   .user = receipt};
    struct cost_times times;
    whit_result result = whit_renderer_create(job->device, job->accel, &params, &effects.usual);
    if (result == WHIT_OK)
        result = whit_renderer_get_kernel(effects.usual, &receipt->kernel);
    if (result == WHIT_OK)
        result = cost_time(effects.usual, &params, COST_ROUNDS_MIN, &times);
    if (result == WHIT_OK) {
        receipt->frame_ms = times.ms[cost_clock_of(job->device, effects.usual)];
        effects.rounds = rounds_for(receipt, cost_effects_count(&effects));
        cli_progress_init(&receipt->progress, job->settings.quiet);
        result = cost_effects_measure(&effects);
        cli_progress_finish(&receipt->progress);
    }
    whit_renderer_destroy(effects.usual);
    return result;
}

/* An effect that the scene does not need must not change the picture. */
static int check_promises(const struct receipt *receipt)
{
    int status = EXIT_FINE;
    for (uint32_t i = 0; i < receipt->row_count; ++i) {
        const struct cost_effect *row = &receipt->rows[i];
        if (row->compiled || !row->priced || row->error.differing_pixels == 0)
            continue;
        cli_error("%s: the scene does not call for it, yet it changes %llu pixels",
                  whit_effect_name(i), (unsigned long long)row->error.differing_pixels);
        status = EXIT_DIFFERS;
    }
    return status;
}

int receipt_run(struct job *job, bool json)
{
    struct receipt *receipt = calloc(1, sizeof *receipt);
    if (!receipt)
        return cli_exit_of(cli_no_memory());
    receipt->job = job;
    whit_result result = job_build(job);
    if (result == WHIT_OK)
        result = job_open_device(job);
    if (result == WHIT_OK)
        result = measure(receipt);
    int status = cli_exit_of(result);
    if (result == WHIT_OK)
        status = json ? receipt_print_json(receipt) : receipt_print_text(receipt);
    if (status == EXIT_FINE)
        status = check_promises(receipt);
    if (status == EXIT_FINE)
        status = job_check_validation(job);
    free(receipt);
    return status;
}
