/* Traces the two sets of rays with a renderer, and judges its hits. */
#include <stdlib.h>

#include "cost/rays.h"
#include "whit/whit_program.h"

enum { TRACES = 3 };

const char *cost_set_name(enum cost_set set)
{
    static const char *const names[] = {"picture", "aimed"};
    return names[set];
}

/* Makes the judges of both sets. With and without instances triangles are rounded differently, so
   each needs its own rays and exact hits. */
static whit_result make_judges(struct measure *measure, whit_instances instances,
                               whit_judge **judges, uint64_t *max)
{
    const struct cost_request *request = measure->request;
    whit_result result = WHIT_OK;
    *max = 0;
    for (uint32_t set = 0; result == WHIT_OK && request->rays && set < COST_SETS; ++set) {
        const whit_judge_params params = {
            .aimed = set == COST_AIMED,
            .count = request->rays,
            .camera = camera_of_text(measure->usual.camera),
            .width = measure->report->width,
            .height = measure->report->height,
            .time_s = measure->usual.picture.time_s,
            .instances = instances,
        };
        uint64_t count = 0;
        measure_say(measure, "exact hits");
        result = whit_judge_create(request->scene, &params, request->log, &judges[set]);
        if (result == WHIT_OK)
            whit_judge_rays(judges[set], &count);
        *max = count > *max ? count : *max;
        if (result == WHIT_OK)
            result = measure_still_wanted(measure);
    }
    return result;
}

whit_result measure_judges(struct measure *measure)
{
    uint64_t max;
    whit_result result =
        make_judges(measure, measure->usual.trees.instances, measure->judges, &max);
    measure->hits = result == WHIT_OK && max ? calloc((size_t)max, sizeof *measure->hits) : NULL;
    return result == WHIT_OK && max && !measure->hits ? WHIT_ERROR_MEMORY : result;
}

/* Traces a judge's rays: once to warm up, then TRACES times. *min_ms: the least of these times. */
static whit_result trace(struct measure *measure, whit_renderer *renderer, const whit_judge *judge,
                         double *min_ms)
{
    uint64_t count;
    const whit_ray *rays = whit_judge_rays(judge, &count);
    whit_result result = WHIT_OK;
    *min_ms = -1.0;
    for (int i = 0; result == WHIT_OK && i <= TRACES; ++i) {
        double start_ms = whit_clock_ms();
        result = whit_trace(renderer, WHIT_TRACE_DEVICE, rays, count, false, measure->hits, NULL);
        double ms = whit_trace_device_ms(renderer);
        ms = ms >= 0.0 ? ms : whit_clock_ms() - start_ms;
        if (i > 0 && (*min_ms < 0.0 || ms < *min_ms))
            *min_ms = ms;
    }
    return result;
}

static whit_result judge_hits(struct measure *measure, whit_renderer *renderer,
                              whit_judge *const *judges, whit_numerics numerics,
                              struct cost_row *row)
{
    whit_result result = WHIT_OK;
    for (uint32_t set = 0; result == WHIT_OK && set < COST_SETS; ++set) {
        struct cost_hits *hits = &row->hits[set];
        uint64_t count = 0;
        if (judges[set])
            whit_judge_rays(judges[set], &count);
        if (count == 0)
            continue;
        result = trace(measure, renderer, judges[set], &hits->ms);
        hits->unanswered = result == WHIT_ERROR_STATUS;
        hits->traced = result == WHIT_OK || hits->unanswered;
        if (result == WHIT_OK)
            result = whit_judge_hits(judges[set], numerics, measure->hits, &hits->judged);
        else if (hits->unanswered)
            result = WHIT_OK;
        if (result == WHIT_OK)
            result = measure_still_wanted(measure);
    }
    return result;
}

whit_result measure_hits(struct measure *measure, whit_renderer *renderer,
                         const struct settings *target, struct cost_row *row)
{
    whit_judge *own[COST_SETS] = {NULL};
    bool as_usual = target->trees.instances == measure->usual.trees.instances;
    uint64_t max;
    whit_result result =
        as_usual ? WHIT_OK : make_judges(measure, target->trees.instances, own, &max);
    if (result == WHIT_OK)
        result = judge_hits(measure, renderer, as_usual ? measure->judges : own,
                            target->picture.numerics, row);
    for (uint32_t set = 0; set < COST_SETS; ++set)
        whit_judge_destroy(own[set]);
    return result;
}
