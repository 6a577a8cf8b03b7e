/* Builders that move records as they split them: binned and median; and the one that splits
   nothing. */
#include <stdlib.h>

#include "base/threads.h"
#include "bvh/build.h"

enum {
    RECORD_CHUNK = 16384, /* records made by one call */
    SMALL_OF_BINS = 8,    /* where the number of bins is given, larger nodes have that many */
};

struct record_chunk {
    struct build_bounds bounds;
    bool bad;
};

struct record_context {
    const struct bvh_box *boxes;
    struct build_record *records;
    uint32_t count;
    struct record_chunk *chunks;
};

static bool box_is_good(const struct bvh_box *box)
{
    bool good = true;
    for (int i = 0; i < 3; ++i)
        good &= box->lo[i] >= -FLT_MAX && box->lo[i] <= box->hi[i] && box->hi[i] <= FLT_MAX;
    return good;
}

static void make_chunk(void *user, uint32_t index)
{
    const struct record_context *context = user;
    uint32_t begin = index * RECORD_CHUNK;
    uint32_t end = context->count - begin > RECORD_CHUNK ? begin + RECORD_CHUNK : context->count;
    struct record_chunk chunk = {build_bounds_empty(), false};
    for (uint32_t i = begin; i < end; ++i) {
        const struct bvh_box *box = &context->boxes[i];
        struct build_record *record = &context->records[i];
        chunk.bad |= !box_is_good(box);
        for (int a = 0; a < 3; ++a) {
            /* + 0: one zero, so that bounds do not depend on the order of their parts. */
            record->lo[a] = box->lo[a] + 0.0f;
            record->hi[a] = box->hi[a] + 0.0f;
        }
        record->primitive = i;
        record->pad = 0;
        build_bounds_add(&chunk.bounds, build_record_lo(record), build_record_hi(record));
    }
    context->chunks[index] = chunk;
}

static bool chunks_unite(const struct record_chunk *chunks, uint32_t count,
                         struct build_bounds *bounds)
{
    bool bad = false;
    *bounds = build_bounds_empty();
    for (uint32_t i = 0; i < count; ++i) {
        build_bounds_merge(bounds, &chunks[i].bounds);
        bad |= chunks[i].bad;
    }
    return !bad;
}

whit_result records_make(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                         uint32_t spare, uint32_t thread_count, struct build_record **records,
                         struct build_bounds *bounds)
{
    uint32_t chunk_count = (count - 1) / RECORD_CHUNK + 1;
    struct record_context context = {
        .boxes = boxes,
        .records =
            aligned_alloc(64, (((size_t)count + spare) * sizeof **records + 63) & ~(size_t)63),
        .count = count,
        .chunks = aligned_alloc(64, chunk_count * ((sizeof *context.chunks + 63) & ~(size_t)63)),
    };
    whit_result result = WHIT_OK;
    if (!context.records || !context.chunks) {
        log_error(log, "tree over %u boxes: out of memory", count);
        result = WHIT_ERROR_MEMORY;
    } else {
        threads_for(thread_count, chunk_count, make_chunk, &context);
        if (!chunks_unite(context.chunks, chunk_count, bounds)) {
            log_error(log, "tree over %u boxes: a box is not finite, or inside out", count);
            result = WHIT_ERROR_INPUT;
        }
    }
    free(context.chunks);
    if (result != WHIT_OK) {
        free(context.records);
        context.records = NULL;
    }
    *records = context.records;
    return result;
}

/* ---- Methods ---- */

struct context {
    const struct bvh_params *params;
    struct build_record *records;
};

static enum build_choice split(void *user, const struct build_range *range, uint32_t thread_count,
                               void *scratch, uint32_t *left_count, struct build_bounds halves[2])
{
    const struct context *c = user;
    return split_binned(c->records, range, c->params, thread_count, scratch, left_count, halves);
}

static void halve(void *user, const struct build_range *range, void *scratch, uint32_t *left_count,
                  struct build_bounds halves[2])
{
    (void)scratch;
    split_median(((const struct context *)user)->records, range, left_count, halves);
}

/* Without trees: the records stay where they are, in leaves that are full but for the last, and
   every box is that of everything. */
static void halve_nothing(void *user, const struct build_range *range, void *scratch,
                          uint32_t *left_count, struct build_bounds halves[2])
{
    uint32_t limit = ((const struct context *)user)->params->leaf_limit;
    uint32_t leaves = (range->count - 1) / limit + 1;
    (void)scratch;
    *left_count = leaves / 2 * limit;
    halves[0] = halves[1] = range->bounds;
}

static void grow_small(void *user, const struct build_output *output,
                       const struct build_range *range)
{
    const struct context *c = user;
    struct build_record *own = c->records + range->first, moved[BUILD_SMALL];
    struct small small;
    for (uint32_t i = 0; i < range->count; ++i) {
        moved[i] = own[i];
        small.lo[i] = build_record_lo(&own[i]);
        small.hi[i] = build_record_hi(&own[i]);
        f4_store(small.centroid[i], build_centroid(small.lo[i], small.hi[i]));
    }
    small_sort(&small, range->count);
    small_grow(&small, output, c->params, range);
    for (uint32_t i = 0; i < range->count; ++i)
        own[i] = moved[small.leaves[i]];
}

whit_result records_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out)
{
    struct context context = {.params = resolved};
    struct build_bounds bounds;
    whit_result result =
        records_make(log, boxes, count, 0, resolved->thread_count, &context.records, &bounds);
    if (result != WHIT_OK)
        return result;
    struct build_methods methods = {.context = &context, .halve = halve};
    if (resolved->builder == BVH_BINNED) {
        methods.split = split;
        methods.small = grow_small;
        methods.small_count = resolved->bins ? SMALL_OF_BINS : BUILD_SMALL;
    }
    if (resolved->builder == BVH_NONE)
        methods.halve = halve_nothing;
    result = topdown_grow(log, &methods, resolved, &bounds, count, out);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        out->order[i] = context.records[i].primitive;
    free(context.records);
    return result;
}
