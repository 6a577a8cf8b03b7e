#include "hard/run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/clock.h"
#include "base/hash.h"
#include "hard/judge.h"
#include "hard/mesh.h"
#include "hard/rays.h"

/* The seed of a case is its number. The report's hash is of the first RAYS_HASHED rays of each
   case. */
enum {
    LEVELS = 3,
    RAYS_DEFAULT = 20000,
    RAYS_HASHED = 512,
    PIECE = 1 << 20, /* rays in memory at a time */
};

struct hard_run {
    const whit_hard_params *params;
    whit_log log;
    const struct hard_device *device; /* NULL: only the twin traces */
    uint32_t levels;
    uint64_t ray_count; /* rays per row */
    uint64_t piece;     /* number of rays in memory now */
    double deadline_ms; /* 0: none */
    whit_hard_report *report;
    uint32_t row_capacity;
    struct hard_ray *rays;
    struct gpu_ray *plain; /* the same rays, as the device takes them */
    struct rational_hit *exact;
    struct gpu_hit *hits, *twin;
};

static whit_result allocate(struct hard_run *run)
{
    size_t count = (size_t)(run->ray_count < PIECE ? run->ray_count : PIECE);
    run->rays = array_alloc(count, sizeof *run->rays);
    run->plain = array_alloc(count, sizeof *run->plain);
    run->exact = array_alloc(count, sizeof *run->exact);
    run->hits = array_alloc(count, sizeof *run->hits);
    run->twin = array_alloc(count, sizeof *run->twin);
    run->report = calloc(1, sizeof *run->report);
    if (run->rays && run->plain && run->exact && run->hits && run->twin && run->report)
        return WHIT_OK;
    return log_failure(&run->log, WHIT_ERROR_MEMORY, "out of memory for %llu rays",
                       (unsigned long long)count);
}

static whit_result still_wanted(const struct hard_run *run)
{
    if (run->params->cancel && *run->params->cancel)
        return WHIT_ERROR_CANCELLED;
    if (run->deadline_ms > 0.0 && clock_ms() > run->deadline_ms)
        return log_failure(&run->log, WHIT_ERROR_TIME_LIMIT, "the time limit has passed");
    return WHIT_OK;
}

static void say_progress(const struct hard_run *run, double done)
{
    if (run->params->progress)
        run->params->progress(run->params->progress_user, done);
}

/* Holds the last error message until it is known whether it must be logged. */
struct held_log {
    char text[512];
};

static void hold_back(void *user, whit_log_level level, const char *message)
{
    struct held_log *held = user;
    if (level == WHIT_LOG_ERROR)
        snprintf(held->text, sizeof held->text, "%s", message);
}

/* *cut: the device reported that its hits cannot be trusted; this is shown in the table and is no
   error. */
static whit_result trace_on_device(struct hard_run *run, const struct hard_scene *hard,
                                   uint32_t numerics, double *device_ms, bool *cut)
{
    struct held_log held = {""};
    const whit_log log = {.fn = hold_back, .user = &held};
    double ms = 0.0;
    whit_result result = run->device->trace(run->device, &log, hard->accel, 0.0, numerics,
                                            run->plain, run->piece, run->hits, &ms);
    *cut = result == WHIT_ERROR_STATUS;
    *device_ms += *cut ? 0.0 : ms;
    if (*cut)
        return WHIT_OK;
    if (result != WHIT_OK && held.text[0])
        log_error(&run->log, "%s", held.text);
    return result;
}

/* Continues the hash `value` by the ids of hits; `hits` NULL: leaves it unchanged. */
static uint64_t hash_hits(uint64_t value, const struct gpu_hit *hits, uint64_t count)
{
    for (uint64_t i = 0; i < count && hits; ++i) {
        const struct rational_hit id = {.primitive = hits[i].primitive,
                                        .instance = hits[i].instance};
        value = hard_hash(value, &id, 1);
    }
    return value;
}

/* Traces and judges the rays in run->rays at one level. */
static whit_result trace_level(struct hard_run *run, const struct hard_scene *hard,
                               whit_hard_row *row)
{
    struct hard_judgement judgement = {.hard = hard,
                                       .rays = run->rays,
                                       .exact = run->exact,
                                       .hits = run->twin,
                                       .numerics = (uint32_t)row->numerics,
                                       .count = run->piece};
    whit_tally tally;
    bool cut = false, first = row->tally.rays == 0;
    double start_ms = clock_ms();
    whit_result result = hard_trace_twin(hard, judgement.numerics, run->rays, run->piece,
                                         run->params->threads, run->twin);
    row->twin_ms += clock_ms() - start_ms;
    if (result == WHIT_OK && run->device)
        result = trace_on_device(run, hard, judgement.numerics, &row->device_ms, &cut);
    bool answered = run->device && !cut;
    if (answered)
        judgement.hits = run->hits;
    if (result == WHIT_OK)
        result = hard_judge(&judgement, run->params->threads, &tally);
    if (result != WHIT_OK)
        return result;
    row->unanswered |= cut;
    if (answered)
        row->differing += hard_count_differing(run->hits, run->twin, run->piece);
    if (first && run->device && run->report->hash && row->numerics == WHIT_NUMERICS_EXACT)
        run->report->hash_met =
            hash_hits(run->report->hash_met, answered ? run->hits : NULL, RAYS_HASHED);
    hard_add_tally(&row->tally, &tally);
    return WHIT_OK;
}

static whit_result keep_row(struct hard_run *run, whit_hard_row *row)
{
    row->kept =
        hard_promise_kept((uint32_t)row->numerics, row->promised, &row->tally) &&
        (row->numerics == WHIT_NUMERICS_FAST || row->differing == 0 || !run->report->equal_bits);
    if (!run->device || row->unanswered)
        row->device_ms = -1.0;
    run->report->broken += !row->kept;
    run->report->unanswered += row->unanswered;
    if (ARRAY_PUSH(run->report->rows, run->report->row_count, run->row_capacity, *row))
        return WHIT_OK;
    return log_failure(&run->log, WHIT_ERROR_MEMORY, "out of memory");
}

static void make_rays(struct hard_run *run, const struct hard_scene *hard, enum hard_rays kind,
                      uint64_t seed, uint64_t first)
{
    run->piece = run->ray_count - first < PIECE ? run->ray_count - first : PIECE;
    for (uint64_t i = 0; i < run->piece; ++i) {
        run->rays[i] = hard_ray_make(hard, kind, seed, first + i);
        run->plain[i] = run->rays[i].ray;
    }
}

/* Traces all rays of a case at every level, a row for each. The rows' names come from `names`. */
static whit_result shoot(struct hard_run *run, const struct hard_scene *hard, enum hard_rays kind,
                         uint64_t seed, const whit_hard_row *names)
{
    static const whit_numerics order[LEVELS] = {WHIT_NUMERICS_FAST, WHIT_NUMERICS_WATERTIGHT,
                                                WHIT_NUMERICS_EXACT};
    whit_hard_row rows[LEVELS];
    whit_result result = WHIT_OK;
    for (int l = 0; l < LEVELS; ++l) {
        rows[l] = *names;
        rows[l].numerics = order[l];
    }
    for (uint64_t first = 0; result == WHIT_OK && first < run->ray_count; first += PIECE) {
        make_rays(run, hard, kind, seed, first);
        result = hard_trace_exact(hard, run->rays, run->piece, run->params->threads, run->exact);
        if (result == WHIT_OK && first == 0 && run->report->hash)
            run->report->hash = hard_hash(run->report->hash, run->exact, RAYS_HASHED);
        for (int l = 0; result == WHIT_OK && l < LEVELS; ++l) {
            result = still_wanted(run);
            if (result == WHIT_OK && (run->levels >> order[l] & 1u))
                result = trace_level(run, hard, &rows[l]);
        }
    }
    for (int l = 0; result == WHIT_OK && l < LEVELS; ++l)
        if (run->levels >> order[l] & 1u)
            result = keep_row(run, &rows[l]);
    return result;
}

/* ---- The built-in cases ---- */

static const char *place_of(double offset)
{
    return offset == 0.0 ? "0" : offset == 1e3 ? "1e3" : offset == 1e5 ? "1e5" : "1e7";
}

static whit_result run_cases(struct hard_run *run)
{
    uint32_t count;
    const struct hard_case *cases = hard_cases(&count);
    whit_result result = WHIT_OK;
    bool all = run->params->filter == NULL;
    run->report->hash = run->report->hash_met = all ? HASH_START : 0;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        const whit_hard_row names = {.name = cases[i].name,
                                     .place = place_of(cases[i].offset),
                                     .promised = !cases[i].not_promised};
        struct hard_scene hard;
        if (!all && !strstr(names.name, run->params->filter))
            continue;
        say_progress(run, (double)i / count);
        result = hard_scene_init(&run->log, &cases[i], &hard);
        if (result != WHIT_OK)
            break;
        result = shoot(run, &hard, hard.rays, i + 1, &names);
        hard_scene_finish(&hard);
    }
    if (!run->device || !(run->levels >> NUMERICS_EXACT & 1u))
        run->report->hash_met = 0;
    if (result == WHIT_OK && run->report->row_count == 0) {
        log_error(&run->log, "no case has `%s` in its name", run->params->filter);
        result = WHIT_ERROR_USAGE;
    }
    return result;
}

/* ---- A scene of the user's ---- */

static void describe_surface(whit_hard_report *report, const struct hard_topology *topology)
{
    report->triangles = topology->triangles;
    report->edges = topology->edges;
    report->open_edges = topology->open_edges;
    report->crowded_edges = topology->crowded_edges;
    report->flipped_edges = topology->flipped_edges;
    report->duplicates = topology->duplicates;
}

static whit_result run_variants(struct hard_run *run, const struct hard_scene *given,
                                double progress)
{
    uint32_t count;
    const struct hard_variant *variants = hard_variants(&count);
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        const whit_hard_row names = {
            .name = hard_rays_name(HARD_MIXED), .place = variants[i].name, .promised = true};
        struct hard_scene hard;
        say_progress(run, progress + (1.0 - progress) * i / count);
        result = hard_scene_vary(&run->log, given, &variants[i], &hard);
        if (result != WHIT_OK || !hard.scene)
            continue;
        result = shoot(run, &hard, HARD_MIXED, i + 100, &names);
        hard_scene_finish(&hard);
    }
    return result;
}

static whit_result run_scene(struct hard_run *run, const struct scene *scene, bool flatten)
{
    struct hard_scene given;
    whit_result result = hard_scene_borrow(&run->log, scene, 0.0, flatten, &given);
    if (result != WHIT_OK)
        return result;
    describe_surface(run->report, &given.topology);
    for (uint32_t i = 0; result == WHIT_OK && i < HARD_MIXED_KINDS; ++i) {
        const whit_hard_row names = {
            .name = hard_rays_name((enum hard_rays)i), .place = "as given", .promised = true};
        say_progress(run, 0.3 * i / HARD_MIXED_KINDS);
        result = shoot(run, &given, (enum hard_rays)i, i + 1, &names);
    }
    if (result == WHIT_OK)
        result = run_variants(run, &given, 0.3);
    hard_scene_finish(&given);
    return result;
}

/* ---- From outside ---- */

static whit_result check_params(const struct hard_run *run)
{
    if (run->ray_count < RAYS_HASHED || run->ray_count > UINT32_MAX / 2)
        return log_failure(&run->log, WHIT_ERROR_USAGE, "%llu rays: %d to %u are possible",
                           (unsigned long long)run->ray_count, RAYS_HASHED, UINT32_MAX / 2);
    if (run->levels >> LEVELS)
        return log_failure(&run->log, WHIT_ERROR_USAGE, "levels %#x: there are three", run->levels);
    if (!(run->params->time_limit_s >= 0.0))
        return log_failure(&run->log, WHIT_ERROR_USAGE, "a time limit of %g s: must not be below 0",
                           run->params->time_limit_s);
    return WHIT_OK;
}

whit_result hard_run(const struct hard_device *device, const struct scene *scene, bool flatten,
                     const whit_hard_params *params, const whit_log *log, whit_hard_report **out)
{
    struct hard_run run = {.params = params, .log = log_or_silence(log), .device = device};
    *out = NULL;
    run.levels = params->levels ? params->levels : (1u << LEVELS) - 1;
    run.ray_count = params->rays ? params->rays : RAYS_DEFAULT;
    if (params->time_limit_s > 0.0)
        run.deadline_ms = clock_ms() + 1e3 * params->time_limit_s;
    whit_result result = check_params(&run);
    if (result == WHIT_OK)
        result = allocate(&run);
    if (result == WHIT_OK) {
        run.report->equal_bits = !device || device->equal_bits;
        result = scene ? run_scene(&run, scene, flatten) : run_cases(&run);
    }
    free(run.rays);
    free(run.plain);
    free(run.exact);
    free(run.hits);
    free(run.twin);
    if (result == WHIT_OK)
        *out = run.report;
    else
        hard_report_destroy(run.report);
    return result;
}

void hard_report_destroy(whit_hard_report *report)
{
    if (!report)
        return;
    free(report->rows);
    free(report);
}
