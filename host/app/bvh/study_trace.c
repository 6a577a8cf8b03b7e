#include <stdlib.h>
#include <string.h>

#include "app/bvh/study.h"
#include "app/bvh/study_rays.h"
#include "whit/whit_program.h"

/* The hits of the first row, and those of another row to compare with them. */
struct tracing {
    struct study *study;
    whit_hit *expected[STUDY_KINDS], *hits;
    double *rates; /* [kind][row][run] */
    uint32_t kind; /* the kind of rays that trace_run traces */
};

static double *rates_of(const struct tracing *tracing, uint32_t kind, uint32_t row)
{
    const struct study *study = tracing->study;
    return &tracing->rates[((size_t)kind * study->row_count + row) * study->run_count];
}

static whit_result create_renderers(struct study *study)
{
    const whit_renderer_params params = {
        .width = 16,
        .height = 16,
        .time_s = study->job.settings.picture.time_s,
        .cancel = &cli_cancel,
        .load_path = study->job.settings.picture.load_path,
        .traversal = study->job.settings.picture.traversal,
        .numerics = study->job.settings.picture.numerics,
    };
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < study->row_count; ++i) {
        result = whit_renderer_create(study->job.device, study->rows[i].accel, &params,
                                      &study->rows[i].renderer);
        if (result == WHIT_OK)
            result = study_step(study);
    }
    return result;
}

static whit_result trace(struct tracing *tracing, uint32_t row, uint32_t kind, whit_hit *hits,
                         double *mrays_per_s)
{
    const struct study_rays *rays = &tracing->study->rays[kind];
    whit_renderer *renderer = tracing->study->rows[row].renderer;
    double start_ms = whit_clock_ms();
    whit_result result = whit_trace(renderer, WHIT_TRACE_DEVICE, rays->rays, rays->count,
                                    kind == STUDY_SHADOW, hits, NULL);
    double time_ms = whit_trace_device_ms(renderer);
    if (!(time_ms > 0.0))
        time_ms = whit_clock_ms() - start_ms;
    *mrays_per_s = time_ms > 0.0 ? rays->count / time_ms * 1e-3 : 0.0;
    return result == WHIT_OK ? study_step(tracing->study) : result;
}

/* Whether two hits are the same. Any-hit (shadow) rays only tell whether there is a hit. */
static bool same_hit(uint32_t kind, const whit_hit *a, const whit_hit *b)
{
    if (kind == STUDY_SHADOW)
        return (a->primitive == WHIT_NONE) == (b->primitive == WHIT_NONE);
    return memcmp(a, b, sizeof *a) == 0;
}

static void compare(struct tracing *tracing, uint32_t row, uint32_t kind)
{
    struct study *study = tracing->study;
    const struct study_rays *rays = &study->rays[kind];
    uint64_t before = study->differing;
    uint32_t first = 0;
    for (uint32_t i = 0; i < rays->count; ++i) {
        if (same_hit(kind, &tracing->expected[kind][i], &tracing->hits[i]))
            continue;
        if (study->differing++ == before)
            first = i;
    }
    study->compared += rays->count;
    if (study->differing > before)
        cli_error("%s: %llu hits of %u %s rays differ from those of %s, first that of ray %u",
                  study->rows[row].name, (unsigned long long)(study->differing - before),
                  rays->count, study_kind_names[kind], study->rows[0].name, first);
}

/* Traces each row once, to warm up and to get the hits that are compared. */
static whit_result trace_once(struct tracing *tracing, uint32_t kind)
{
    struct study *study = tracing->study;
    whit_result result = WHIT_OK;
    double rate;
    for (uint32_t row = 0; result == WHIT_OK && row < study->row_count; ++row) {
        whit_hit *hits = row ? tracing->hits : tracing->expected[kind];
        result = trace(tracing, row, kind, hits, &rate);
        if (result == WHIT_OK && row > 0)
            compare(tracing, row, kind);
    }
    return result;
}

static whit_result trace_run(void *user, uint32_t row, uint32_t run)
{
    struct tracing *tracing = user;
    return trace(tracing, row, tracing->kind, tracing->hits,
                 &rates_of(tracing, tracing->kind, row)[run]);
}

static whit_result trace_runs(struct tracing *tracing, uint32_t kind)
{
    struct study *study = tracing->study;
    tracing->kind = kind;
    whit_result result = sample_in_turns(study->row_count, study->run_count, trace_run, tracing);
    for (uint32_t row = 0; result == WHIT_OK && row < study->row_count; ++row)
        study->rows[row].mrays_per_s[kind] =
            sample_sum_up(rates_of(tracing, kind, row), study->run_count);
    return result;
}

static whit_result trace_kinds(struct tracing *tracing)
{
    struct study *study = tracing->study;
    whit_result result = WHIT_OK;
    for (uint32_t kind = 0; result == WHIT_OK && kind < STUDY_KINDS; ++kind) {
        if (study->rays[kind].count == 0)
            continue;
        result = trace_once(tracing, kind);
        if (result == WHIT_OK)
            result = trace_runs(tracing, kind);
        if (result == WHIT_OK && kind == STUDY_PRIMARY)
            result = study_secondary_rays(study, tracing->expected[STUDY_PRIMARY]);
    }
    return result;
}

static whit_result tracing_alloc(struct tracing *tracing)
{
    const struct study *study = tracing->study;
    size_t count = study->rays[STUDY_PRIMARY].count;
    bool all = true;
    for (uint32_t kind = 0; kind < STUDY_KINDS; ++kind) {
        tracing->expected[kind] = calloc(count, sizeof(whit_hit));
        all = all && tracing->expected[kind];
    }
    tracing->hits = calloc(count, sizeof(whit_hit));
    tracing->rates =
        calloc((size_t)STUDY_KINDS * study->row_count * study->run_count, sizeof *tracing->rates);
    return all && tracing->hits && tracing->rates ? WHIT_OK : cli_no_memory();
}

static void tracing_free(struct tracing *tracing)
{
    for (uint32_t kind = 0; kind < STUDY_KINDS; ++kind)
        free(tracing->expected[kind]);
    free(tracing->hits);
    free(tracing->rates);
}

whit_result study_trace(struct study *study)
{
    struct tracing tracing = {.study = study};
    whit_result result = study_primary_rays(study);
    if (result == WHIT_OK)
        result = tracing_alloc(&tracing);
    if (result == WHIT_OK)
        result = create_renderers(study);
    if (result == WHIT_OK)
        result = trace_kinds(&tracing);
    study->traced = result == WHIT_OK;
    tracing_free(&tracing);
    return result;
}
