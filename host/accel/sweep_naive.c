/* The exact sweep as the report did it: for every axis and the centroid of every primitive the two
   sides are summed up anew, so a node costs the square of its primitives. Chooses what sweep.c
   chooses. */
#include <stdatomic.h>
#include <stdlib.h>

#include "accel/build.h"
#include "base/clock.h"
#include "base/threads.h"

enum {
    ITEM_VISITS = 1000000, /* boxes visited between two looks at the clock */
    ITEMS = 64,            /* of one round; a round is spread over the threads */
};

struct naive {
    const struct bvh_params *params;
    struct build_record *records;
    _Atomic uint64_t visits;
    _Atomic uint32_t splits;
};

struct candidate {
    uint32_t axis, left_count;
    float plane, cost;
};

/* Candidates [begin, begin + ITEMS * item) of one range: three axes of its records. */
struct search {
    struct naive *naive;
    const struct build_record *records;
    uint32_t count;
    f4 scale;
    uint64_t begin, item;
    struct candidate best[ITEMS];
    _Atomic bool stop;
};

static bool wanted_no_more(const struct bvh_params *params)
{
    return (params->cancel && *params->cancel) ||
           (params->deadline_ms > 0.0 && clock_ms() > params->deadline_ms);
}

static bool better(const struct candidate *a, const struct candidate *b)
{
    if (a->cost != b->cost || !(a->cost < INFINITY))
        return a->cost < b->cost;
    return a->axis != b->axis ? a->axis < b->axis : a->left_count < b->left_count;
}

static inline f4 record_centroid(const struct build_record *record)
{
    return build_centroid(build_record_lo(record), build_record_hi(record));
}

static float centroid_along(const struct build_record *record, uint32_t axis)
{
    alignas(16) float centroid[4];
    f4_store(centroid, record_centroid(record));
    return centroid[axis];
}

/* Left is what lies below the plane. */
static struct candidate evaluate(const struct search *s, uint32_t axis, float plane)
{
    f4 big = f4_splat(FLT_MAX), small = f4_splat(-FLT_MAX), limit = f4_splat(plane);
    f4 lo[2] = {big, big}, hi[2] = {small, small};
    uint32_t left_count = 0;
    for (uint32_t i = 0; i < s->count; ++i) {
        const struct build_record *record = &s->records[i];
        uint32_t left = f4_below(record_centroid(record), limit) >> axis & 1u;
        lo[left] = f4_min(lo[left], build_record_lo(record));
        hi[left] = f4_max(hi[left], build_record_hi(record));
        left_count += left;
    }
    struct candidate candidate = {axis, left_count, plane, INFINITY};
    if (left_count > 0)
        candidate.cost = build_scaled_area(lo[1], hi[1], s->scale) * (float)left_count +
                         build_scaled_area(lo[0], hi[0], s->scale) * (float)(s->count - left_count);
    return candidate;
}

static void search_item(void *user, uint32_t index)
{
    struct search *s = user;
    struct candidate best = {.cost = INFINITY};
    uint64_t begin = s->begin + index * s->item, all = 3 * (uint64_t)s->count;
    uint64_t end = begin + s->item < all ? begin + s->item : all;
    if (atomic_load(&s->stop) || wanted_no_more(s->naive->params)) {
        atomic_store(&s->stop, true);
        return;
    }
    for (uint64_t i = begin; i < end; ++i) {
        uint32_t axis = (uint32_t)(i / s->count);
        const struct build_record *record = &s->records[i % s->count];
        struct candidate candidate = evaluate(s, axis, centroid_along(record, axis));
        if (better(&candidate, &best))
            best = candidate;
    }
    if (begin < end)
        atomic_fetch_add(&s->naive->visits, (end - begin) * s->count);
    s->best[index] = best;
}

/* False: stopped. */
static bool search_run(struct search *s, uint32_t thread_count, struct candidate *best)
{
    uint64_t all = 3 * (uint64_t)s->count;
    s->item = ITEM_VISITS / s->count + 1;
    for (s->begin = 0; s->begin < all; s->begin += ITEMS * s->item) {
        uint64_t items = (all - s->begin + s->item - 1) / s->item;
        uint32_t count = items < ITEMS ? (uint32_t)items : ITEMS;
        threads_for(thread_count, count, search_item, s);
        if (atomic_load(&s->stop))
            return false;
        for (uint32_t i = 0; i < count; ++i) {
            if (better(&s->best[i], best))
                *best = s->best[i];
        }
    }
    return true;
}

static void partition(struct build_record *records, uint32_t count, const struct candidate *by,
                      struct build_record *scratch, struct build_bounds halves[2])
{
    uint32_t left = 0, right = 0;
    halves[0] = halves[1] = build_bounds_empty();
    for (uint32_t i = 0; i < count; ++i) {
        struct build_record record = records[i];
        bool is_left = centroid_along(&record, by->axis) < by->plane;
        build_bounds_add(&halves[!is_left], build_record_lo(&record), build_record_hi(&record));
        if (is_left)
            records[left++] = record;
        else
            scratch[right++] = record;
    }
    memcpy(records + left, scratch, right * sizeof *records);
}

static enum build_choice split(void *user, const struct build_range *range, uint32_t thread_count,
                               void *scratch, uint32_t *left_count, struct build_bounds halves[2])
{
    struct naive *naive = user;
    const struct bvh_params *params = naive->params;
    struct search search = {.naive = naive,
                            .records = naive->records + range->first,
                            .count = range->count,
                            .scale = build_area_scale(&range->bounds)};
    atomic_init(&search.stop, false);
    float area = build_scaled_area(range->bounds.lo, range->bounds.hi, search.scale);
    struct candidate best = {.cost = INFINITY};
    if (area > 0.0f && !search_run(&search, thread_count, &best))
        return BUILD_STOP;
    if (range->count <= params->leaf_limit &&
        area * (float)range->count <= area * params->traversal_cost + best.cost)
        return BUILD_LEAF;
    if (!(best.cost < INFINITY))
        return BUILD_NONE;
    partition(naive->records + range->first, range->count, &best, scratch, halves);
    *left_count = best.left_count;
    atomic_fetch_add(&naive->splits, 1);
    return BUILD_SPLIT;
}

static void halve(void *user, const struct build_range *range, void *scratch, uint32_t *left_count,
                  struct build_bounds halves[2])
{
    (void)scratch;
    split_median(((const struct naive *)user)->records, range, left_count, halves);
}

/* Why, and how far it got. */
static whit_result stopped(const struct log *log, struct naive *naive, uint32_t count)
{
    bool cancelled = naive->params->cancel && *naive->params->cancel;
    log_error(log,
              "tree over %u boxes by the naive sweep: %s after %u splits and %.3g box visits, of "
              "which the first split alone takes %.3g",
              count, cancelled ? "cancelled" : "out of time", atomic_load(&naive->splits),
              (double)atomic_load(&naive->visits), 3.0 * count * (double)count);
    return cancelled ? WHIT_ERROR_CANCELLED : WHIT_ERROR_TIME_LIMIT;
}

whit_result naive_build(const struct log *log, struct build_record *records,
                        const struct build_bounds *bounds, uint32_t count,
                        const struct bvh_params *params, struct bvh *out)
{
    struct naive naive = {.params = params, .records = records};
    atomic_init(&naive.visits, 0);
    atomic_init(&naive.splits, 0);
    struct build_methods methods = {.context = &naive, .split = split, .halve = halve};
    whit_result result = topdown_grow(log, &methods, params, bounds, count, out);
    return result == WHIT_ERROR_CANCELLED ? stopped(log, &naive, count) : result;
}
