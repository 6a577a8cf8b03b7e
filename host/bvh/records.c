/* Builders that move records as they split them: binned, median, and WHIT_BUILD_NONE, which splits
   nothing. */
#include <stdlib.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/records.h"
#include "bvh/split_binned.h"
#include "bvh/sweep_small.h"
#include "bvh/topdown.h"

enum {
    RECORD_CHUNK = 16384, /* records made by one call */
    SMALL_OF_BINS = 8,    /* with a given number of bins: nodes of more records use bins */
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

static void make_chunk(void *user, uint32_t index)
{
    const struct record_context *context = user;
    uint32_t begin = index * RECORD_CHUNK;
    uint32_t end = context->count - begin > RECORD_CHUNK ? begin + RECORD_CHUNK : context->count;
    struct record_chunk chunk = {build_bounds_empty(), false};
    i4 good = {-1, -1, -1, -1};
    for (uint32_t i = begin; i < end; ++i) {
        const struct bvh_box *box = &context->boxes[i];
        struct build_record *record = &context->records[i];
        /* + 0 turns -0 into +0, so that bounds do not depend on the order of their parts. */
        struct build_box own = {f4_three(box->lo) + 0.0f, f4_three(box->hi) + 0.0f};
        good &= (own.lo >= -FLT_MAX) & (own.lo <= own.hi) & (own.hi <= FLT_MAX);
        *record = (struct build_record){.primitive = i};
        memcpy(record->lo, &own.lo, sizeof record->lo);
        memcpy(record->hi, &own.hi, sizeof record->hi);
        build_bounds_add(&chunk.bounds, own);
    }
    chunk.bad = (good[0] & good[1] & good[2]) == 0;
    context->chunks[index] = chunk;
}

static bool chunks_unite(const struct record_chunk *chunks, uint32_t count,
                         struct build_bounds *bounds)
{
    bool bad = false;
    *bounds = build_bounds_empty();
    for (uint32_t i = 0; i < count; ++i) {
        bounds->box = build_box_unite(bounds->box, chunks[i].bounds.box);
        bounds->centroids = build_box_unite(bounds->centroids, chunks[i].bounds.centroids);
        bad |= chunks[i].bad;
    }
    return !bad;
}

whit_result records_make(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                         uint32_t spare, uint32_t thread_count, struct build_record **records,
                         struct build_bounds *bounds)
{
    uint32_t chunk_count = (count - 1) / RECORD_CHUNK + 1;
    struct record_context context = {
        .boxes = boxes,
        .records = array_alloc_lines((size_t)count + spare, sizeof **records),
        .count = count,
        .chunks = array_alloc_lines(chunk_count, sizeof *context.chunks),
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

void records_bound(const struct build_record *records, uint32_t count, struct build_halves *halves)
{
    uint32_t left = halves->count[0];
    halves->count[1] = count - left;
    halves->bounds[0] = halves->bounds[1] = build_bounds_empty();
    for (uint32_t i = 0; i < count; ++i)
        build_bounds_add(&halves->bounds[i >= left], build_record_box(&records[i]));
}

/* ---- Builders ---- */

/* For WHIT_BUILD_NONE: the records stay in their order, in leaves that are all full except the
   last, and every node has the root's box. */
static void halve_nothing(const struct builder *builder, const struct build_range *range,
                          void *scratch, struct build_halves *halves)
{
    uint32_t limit = builder->params->leaf_limit;
    uint32_t leaves = (range->count - 1) / limit + 1;
    (void)scratch;
    halves->count[0] = leaves / 2 * limit;
    halves->count[1] = range->count - halves->count[0];
    halves->bounds[0] = halves->bounds[1] = range->bounds;
}

static void grow_small(const struct builder *builder, const struct build_output *output,
                       const struct build_range *range)
{
    struct build_record *own = builder->records + range->first, moved[BUILD_SMALL];
    struct small small;
    for (uint32_t i = 0; i < range->count; ++i) {
        moved[i] = own[i];
        small_put(&small, i, &own[i]);
    }
    small_sort(&small, range->count);
    small_grow(&small, builder, output, range);
    for (uint32_t i = 0; i < range->count; ++i)
        own[i] = moved[small.leaves[i]];
}

whit_result records_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_triangles *triangles, const whit_accel_params *resolved,
                          struct bvh *out)
{
    (void)triangles;
    struct builder builder = {.params = resolved, .halve = split_median};
    struct build_bounds bounds;
    whit_result result =
        records_make(log, boxes, count, 0, resolved->threads, &builder.records, &bounds);
    if (result != WHIT_OK)
        return result;
    if (resolved->build == WHIT_BUILD_BINNED) {
        builder.split = split_binned;
        builder.threaded = true;
        builder.small = grow_small;
        builder.small_count = resolved->bins ? SMALL_OF_BINS : BUILD_SMALL;
    }
    if (resolved->build == WHIT_BUILD_NONE)
        builder.halve = halve_nothing;
    result = topdown_grow(log, &builder, &bounds, count, 0, out);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        out->order[i] = builder.records[i].primitive;
    free(builder.records);
    return result;
}
