/* Top-down building, whatever chooses the splits. While it grows, a subtree over n records owns n -
   1 pair slots in depth-first order; what it does not use is squeezed out at the end. So subtrees
   can be built by any thread at any time, and the nodes are the same for any number of threads. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/build.h"
#include "base/array.h"
#include "base/threads.h"

enum {
    RECORD_CHUNK = 16384,  /* records made by one call */
    TASK_LEAST = 2048,     /* smaller subtrees are not worth a task of their own */
    TASKS_PER_THREAD = 16, /* evens out subtrees of unequal cost */
    TASKS_MAX = 4096,
    DEPTH_OF_MEDIANS = 96, /* from here on halves: 28 levels more for 2^28 primitives */
};

struct build {
    struct bvh_params params;
    const struct bvh_box *boxes;
    struct build_record *records;
    struct gpu_bvh_node *nodes;
    uint32_t *slots; /* 1: pair slot in use; later its place when squeezed */
    uint32_t count;
    struct build_task *tasks;
    uint32_t task_count;
};

/* A subtree still to be built. */
struct build_task {
    struct build_range range;
    struct build_range halves[2];
    bool split;
};

/* ---- Records ---- */

struct record_chunk {
    struct build_bounds bounds;
    bool bad;
};

struct record_context {
    struct build *build;
    struct record_chunk *chunks;
};

static bool box_is_good(const struct bvh_box *box)
{
    bool good = true;
    for (int i = 0; i < 3; ++i)
        good &= box->lo[i] >= -FLT_MAX && box->lo[i] <= box->hi[i] && box->hi[i] <= FLT_MAX;
    return good;
}

static void make_records(void *user, uint32_t index)
{
    const struct record_context *context = user;
    const struct build *build = context->build;
    uint32_t begin = index * RECORD_CHUNK;
    uint32_t end = build->count - begin > RECORD_CHUNK ? begin + RECORD_CHUNK : build->count;
    struct record_chunk chunk = {build_bounds_empty(), false};
    for (uint32_t i = begin; i < end; ++i) {
        const struct bvh_box *box = &build->boxes[i];
        struct build_record *record = &build->records[i];
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

static whit_result build_records(const struct log *log, struct build *build,
                                 struct build_bounds *bounds)
{
    uint32_t chunk_count = (build->count - 1) / RECORD_CHUNK + 1;
    struct record_chunk *chunks = array_alloc_aligned(chunk_count, sizeof *chunks);
    if (!chunks) {
        log_error(log, "tree over %u boxes: out of memory", build->count);
        return WHIT_ERROR_MEMORY;
    }
    struct record_context context = {build, chunks};
    threads_for(build->params.thread_count, chunk_count, make_records, &context);
    *bounds = build_bounds_empty();
    bool bad = false;
    for (uint32_t i = 0; i < chunk_count; ++i) {
        build_bounds_merge(bounds, &chunks[i].bounds);
        bad |= chunks[i].bad;
    }
    free(chunks);
    if (!bad)
        return WHIT_OK;
    log_error(log, "tree over %u boxes: a box is not finite, or inside out", build->count);
    return WHIT_ERROR_INPUT;
}

/* ---- Subtrees ---- */

static void node_write(struct gpu_bvh_node *node, const struct build_bounds *bounds, uint32_t first,
                       uint32_t count)
{
    alignas(16) float lo[4], hi[4];
    f4_store(lo, bounds->lo);
    f4_store(hi, bounds->hi);
    memcpy(node->lo, lo, sizeof node->lo);
    memcpy(node->hi, hi, sizeof node->hi);
    node->first = first;
    node->count = count;
}

/* True: *range became an inner node with the two halves below it. False: it is a leaf now. */
static bool range_split(struct build *build, const struct build_range *range, uint32_t thread_count,
                        struct build_range halves[2])
{
    struct build_bounds bounds[2];
    uint32_t left = 0;
    enum build_choice choice = range->count <= 1 ? BUILD_LEAF : BUILD_NONE;
    bool heuristic = build->params.builder == BVH_BINNED && range->depth < DEPTH_OF_MEDIANS;
    if (choice == BUILD_NONE && heuristic)
        choice =
            range->count <= BUILD_FEW
                ? split_few(build->records, range, &build->params, &left, bounds)
                : split_binned(build->records, range, &build->params, thread_count, &left, bounds);
    if (choice == BUILD_NONE && range->count <= build->params.leaf_limit)
        choice = BUILD_LEAF;
    if (choice == BUILD_LEAF) {
        node_write(&build->nodes[range->node], &range->bounds, range->first, range->count);
        return false;
    }
    if (choice == BUILD_NONE)
        split_median(build->records, range, &left, bounds);

    uint32_t child = 2 + 2 * range->pair;
    node_write(&build->nodes[range->node], &range->bounds, child, 0);
    build->slots[range->pair] = 1;
    halves[0] = (struct build_range){bounds[0],    child, range->pair + 1,
                                     range->first, left,  range->depth + 1};
    halves[1] = (struct build_range){bounds[1],           child + 1,           range->pair + left,
                                     range->first + left, range->count - left, range->depth + 1};
    return true;
}

static void build_subtree(void *context, uint32_t index)
{
    struct build *build = context;
    struct build_task *task = &build->tasks[index];
    struct build_range stack[BVH_DEPTH_MAX], halves[2], range = task->range;
    uint32_t top = 0;
    for (;;) {
        if (range_split(build, &range, 1, halves)) {
            stack[top++] = halves[1];
            range = halves[0];
            continue;
        }
        if (top == 0)
            return;
        range = stack[--top];
    }
}

static void split_task(void *context, uint32_t index)
{
    struct build *build = context;
    struct build_task *task = &build->tasks[index];
    task->split = range_split(build, &task->range, 1, task->halves);
}

/* Splits the first `large` tasks, each into itself and one at the end. */
static void split_tasks(struct build *build, uint32_t large)
{
    uint32_t threads = build->params.thread_count;
    if (large >= threads) {
        threads_for(threads, large, split_task, build);
    } else {
        for (uint32_t i = 0; i < large; ++i) {
            struct build_task *task = &build->tasks[i];
            task->split = range_split(build, &task->range, threads, task->halves);
        }
    }
    for (uint32_t i = 0; i < large; ++i) {
        struct build_task *task = &build->tasks[i];
        if (!task->split)
            continue;
        build->tasks[build->task_count++] = (struct build_task){.range = task->halves[1]};
        task->range = task->halves[0];
    }
}

static int larger_first(const void *a, const void *b)
{
    const struct build_task *x = a, *y = b;
    if (x->range.count != y->range.count)
        return x->range.count < y->range.count ? 1 : -1;
    return x->range.first < y->range.first ? -1 : x->range.first > y->range.first;
}

/* Splits the top of the tree until there are enough subtrees for all threads, then builds these. */
static void build_tree(struct build *build, const struct build_bounds *bounds)
{
    uint32_t threads = build->params.thread_count;
    build->tasks[0] = (struct build_task){.range = {.bounds = *bounds, .count = build->count}};
    build->task_count = 1;
    uint32_t limit = build->count / (threads * TASKS_PER_THREAD);
    if (limit < TASK_LEAST)
        limit = TASK_LEAST;
    while (threads > 1) {
        qsort(build->tasks, build->task_count, sizeof *build->tasks, larger_first);
        uint32_t large = 0;
        while (large < build->task_count && build->tasks[large].range.count > limit)
            ++large;
        if (large == 0 || build->task_count + large > TASKS_MAX)
            break;
        split_tasks(build, large);
    }
    threads_for(threads, build->task_count, build_subtree, build);
}

/* ---- The finished tree ---- */

static void node_link(struct gpu_bvh_node *node, const uint32_t *slots)
{
    if (node->count == 0)
        node->first = 2 + 2 * slots[(node->first - 2) / 2];
}

/* Slots are in depth-first order, and pairs only move down. */
static void squeeze(struct build *build, struct bvh *out)
{
    uint32_t pair_count = 0, slot_count = build->count - 1;
    for (uint32_t i = 0; i < slot_count; ++i) {
        uint32_t used = build->slots[i];
        build->slots[i] = used ? pair_count : UINT32_MAX;
        pair_count += used;
    }
    node_link(&build->nodes[0], build->slots);
    memset(&build->nodes[1], 0, sizeof build->nodes[1]);
    for (uint32_t i = 0; i < slot_count; ++i) {
        if (build->slots[i] == UINT32_MAX)
            continue;
        struct gpu_bvh_node *pair = &build->nodes[2 + 2 * build->slots[i]];
        memmove(pair, &build->nodes[2 + 2 * i], 2 * sizeof *pair);
        node_link(&pair[0], build->slots);
        node_link(&pair[1], build->slots);
    }
    out->node_count = 2 + 2 * pair_count;
}

/* Not zeroed: slots that stay empty should cost no memory. */
static void *alloc_lines(size_t count, size_t element_bytes)
{
    return aligned_alloc(64, (count * element_bytes + 63) & ~(size_t)63);
}

static whit_result build_alloc(const struct log *log, struct build *build, struct bvh *out)
{
    build->records = alloc_lines(build->count, sizeof *build->records);
    build->slots = array_alloc_zeroed(build->count, sizeof *build->slots);
    build->tasks =
        alloc_lines(build->params.thread_count > 1 ? TASKS_MAX : 1, sizeof *build->tasks);
    build->nodes = out->nodes = alloc_lines(2 * (size_t)build->count, sizeof *out->nodes);
    out->order = array_alloc(build->count, sizeof *out->order);
    if (build->records && build->slots && build->tasks && out->nodes && out->order)
        return WHIT_OK;
    log_error(log, "tree over %u boxes: out of memory", build->count);
    return WHIT_ERROR_MEMORY;
}

whit_result topdown_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out)
{
    struct build build = {.params = *resolved, .boxes = boxes, .count = count};
    if (count <= TASK_LEAST)
        build.params.thread_count = 1;
    struct build_bounds bounds;
    whit_result result = build_alloc(log, &build, out);
    if (result == WHIT_OK)
        result = build_records(log, &build, &bounds);
    if (result != WHIT_OK)
        goto done;
    build_tree(&build, &bounds);
    squeeze(&build, out);
    bvh_complete(out, (double)build.params.traversal_cost);
    for (uint32_t i = 0; i < count; ++i)
        out->order[i] = build.records[i].primitive;
done:
    free(build.records);
    free(build.slots);
    free(build.tasks);
    return result;
}
