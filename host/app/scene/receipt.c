#include "app/scene/receipt.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "cost/cost.h"

/* Rounds follow from the time of a frame: all frames of all effects take about this long, but never
   fewer rounds than give a median and quartiles. */
static const double MEASURE_MS = 15e3;
enum { ROUNDS_MIN = 5, ROUNDS_MAX = 41 };

static whit_result make_renderer(const struct receipt *receipt, const char *effects,
                                 whit_renderer **out)
{
    const struct job *job = receipt->job;
    whit_renderer_params params = job_picture(job);
    params.effects = effects;
    return whit_renderer_create(job->device, job->accel, &params, out);
}

static whit_result time_frame(whit_renderer *renderer, double *ms)
{
    whit_stats stats;
    whit_result result = job_still_wanted();
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    whit_renderer_get_stats(renderer, &stats);
    *ms = stats.render_ms;
    return result;
}

static whit_result compare_pictures(whit_renderer *a, whit_renderer *b, struct receipt_row *row)
{
    whit_difference found;
    whit_result result = cost_colors(a, b, &cli_log, &found);
    if (result == WHIT_OK) {
        row->pixels = found.differing_pixels;
        row->largest = found.largest;
    }
    return result;
}

static uint32_t rounds_for(const struct receipt *receipt, uint32_t effects)
{
    double pair_ms = 2.0 * fmax(sample_of(&receipt->frame).median, 0.1);
    double rounds = MEASURE_MS / (effects ? effects : 1) / pair_ms;
    return rounds < ROUNDS_MIN ? ROUNDS_MIN : rounds > ROUNDS_MAX ? ROUNDS_MAX : (uint32_t)rounds;
}

/* The renderer for the scene, and one that has the effect more, or less. */
struct pair {
    whit_renderer *renderers[2];
    double ms[2];
    struct receipt_row *row;
};

static whit_result price_once(void *user, uint32_t index, uint32_t round)
{
    struct pair *pair = user;
    whit_result result = time_frame(pair->renderers[index], &pair->ms[index]);
    bool complete = index == (round % 2 ? 0 : 1);
    if (result == WHIT_OK && complete)
        sample_add(&pair->row->cost,
                   pair->row->compiled ? pair->ms[0] - pair->ms[1] : pair->ms[1] - pair->ms[0]);
    return result;
}

static whit_result price(const struct receipt *receipt, whit_renderer *base, uint32_t rounds,
                         struct receipt_row *row)
{
    char effects[64];
    whit_renderer *other = NULL;
    double ms;
    snprintf(effects, sizeof effects, "%c%s", row->compiled ? '-' : '+', row->name);
    whit_result result = make_renderer(receipt, effects, &other);
    if (result == WHIT_OK)
        result = time_frame(other, &ms); /* compiles, and warms up */
    if (result == WHIT_OK)
        result = compare_pictures(base, other, row);
    struct pair pair = {.renderers = {base, other}, .row = row};
    if (result == WHIT_OK)
        result = sample_in_turns(2, rounds, price_once, &pair);
    row->priced = result == WHIT_OK;
    whit_renderer_destroy(other);
    return result;
}

static bool can_switch(const struct receipt_row *row, uint32_t index)
{
    return row->compiled ? whit_effect_can_remove(index) : whit_effect_can_add(index);
}

static uint32_t list_effects(struct receipt *receipt, const whit_renderer *base)
{
    whit_scene_info scene;
    uint32_t switched = 0;
    whit_scene_get_info(receipt->job->scene, &scene);
    receipt->row_count =
        scene.effect_count < RECEIPT_ROWS_MAX ? scene.effect_count : RECEIPT_ROWS_MAX;
    for (uint32_t i = 0; i < receipt->row_count; ++i) {
        whit_effect_info effect;
        whit_scene_get_effect(receipt->job->scene, i, &effect);
        receipt->rows[i] = (struct receipt_row){
            .name = effect.name,
            .reason = effect.reason,
            .called = effect.called,
            .compiled = whit_renderer_compiles(base, i),
        };
        switched += can_switch(&receipt->rows[i], i);
    }
    return switched;
}

static whit_result time_base(struct receipt *receipt, whit_renderer *base)
{
    double ms;
    whit_result result = time_frame(base, &ms); /* compiles, and warms up */
    for (int i = 0; result == WHIT_OK && i < ROUNDS_MIN; ++i) {
        result = time_frame(base, &ms);
        sample_add(&receipt->frame, ms);
    }
    return result;
}

static whit_result measure(struct receipt *receipt)
{
    whit_renderer *base = NULL;
    struct cli_progress progress;
    whit_result result = make_renderer(receipt, NULL, &base);
    if (result == WHIT_OK)
        result = whit_renderer_get_kernel(base, &receipt->kernel);
    cli_progress_init(&progress, receipt->job->settings.quiet);
    if (result == WHIT_OK)
        result = time_base(receipt, base);
    uint32_t switched = result == WHIT_OK ? list_effects(receipt, base) : 0, done = 0;
    for (uint32_t i = 0; result == WHIT_OK && i < receipt->row_count; ++i) {
        struct receipt_row *row = &receipt->rows[i];
        if (!can_switch(row, i))
            continue;
        result = price(receipt, base, rounds_for(receipt, switched), row);
        cli_progress_update(&progress, (double)++done / switched);
    }
    cli_progress_finish(&progress);
    whit_renderer_destroy(base);
    return result;
}

/* What the scene does not call for may not show. */
static int check_promises(const struct receipt *receipt)
{
    int status = EXIT_FINE;
    for (uint32_t i = 0; i < receipt->row_count; ++i) {
        const struct receipt_row *row = &receipt->rows[i];
        if (row->compiled || !row->priced || row->pixels == 0)
            continue;
        cli_error("%s: the scene does not call for it, yet it changes %llu pixels", row->name,
                  (unsigned long long)row->pixels);
        status = EXIT_DIFFERS;
    }
    return status;
}

int receipt_run(struct job *job, bool json)
{
    struct receipt *receipt = calloc(1, sizeof *receipt);
    if (!receipt) {
        cli_error("out of memory");
        return cli_exit_of(WHIT_ERROR_MEMORY);
    }
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
