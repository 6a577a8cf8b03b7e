/* Top-down building, whatever chooses the splits. While it grows, a subtree over n records owns a
   run of memory: their places and pair slots in depth-first order, and as much more as the
   references that splits of records may add to it. What is left of these after a split is shared by
   the halves in proportion to their records; what is not used is squeezed out at the end. So
   subtrees can be built by any thread at any time, the nodes are the same for any number of
   threads, and the spare references are never exceeded. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/build.h"

enum {
    TASK_MIN = 2048,       /* smaller subtrees are not worth a task of their own */
    TASKS_PER_THREAD = 16, /* evens out subtrees of unequal cost */
    TASKS_MAX = 4096,
};

struct build {
    struct build_output output;
    const struct builder *builder;
    uint32_t count, spare, thread_count;
    struct build_task *tasks;
    uint32_t task_count;
};

/* A subtree still to be built. */
struct build_task {
    struct build_range range;
    struct build_range halves[2];
    bool split;
};

/* ---- Subtrees ---- */

/* Gives each half its memory. */
static void halves_place(const struct build *build, const struct build_range *range,
                         const struct build_halves *split, struct build_range halves[2])
{
    uint32_t left = split->count[0], right = split->count[1], child = 2 + 2 * range->pair;
    uint32_t spare = range->count + range->spare - (left + right), depth = range->depth + 1;
    uint32_t left_spare = (uint32_t)((uint64_t)spare * left / (left + right));
    uint32_t room = left + left_spare;
    struct build_record *from = build->builder->records + range->first + left;
    if (left_spare > 0) { /* order is kept only as far as it must be */
        uint32_t moved = left_spare < right ? left_spare : right;
        memmove(from + (left_spare < right ? right : left_spare), from, moved * sizeof *from);
    }
    halves[0] = (struct build_range){split->bounds[0], child, range->pair + 1, range->first, left,
                                     left_spare,       depth};
    halves[1] = (struct build_range){
        split->bounds[1],   child + 1, range->pair + room, range->first + room, right,
        spare - left_spare, depth};
}

/* True: *range became an inner node with the two halves below it. False: it is a leaf now. */
static bool range_split(struct build *build, const struct build_range *range, uint32_t thread_count,
                        struct build_range halves[2])
{
    struct gpu_bvh_node *nodes = build->output.nodes, *node = &nodes[range->node];
    const struct builder *builder = build->builder;
    struct build_halves split;
    uint32_t child = 2 + 2 * range->pair;
    enum build_choice choice = range->count <= 1 ? BUILD_LEAF : BUILD_NONE;
    if (choice == BUILD_NONE && builder->split && range->depth < BUILD_DEPTH_OF_MEDIANS)
        choice = builder->split(builder, range, thread_count, &nodes[child], &split);
    if (choice == BUILD_NONE && range->count <= builder->params->leaf_limit)
        choice = BUILD_LEAF;
    if (choice == BUILD_LEAF) {
        build_node_write(node, range->bounds.box, range->first, range->count);
        return false;
    }
    if (choice == BUILD_NONE)
        builder->halve(builder, range, &nodes[child], &split);
    build_node_write(node, range->bounds.box, child, 0);
    build->output.slots[range->pair] = 1;
    halves_place(build, range, &split, halves);
    return true;
}

static void build_subtree(void *context, uint32_t index)
{
    struct build *build = context;
    const struct builder *builder = build->builder;
    struct build_range stack[BVH_DEPTH_MAX], halves[2], range = build->tasks[index].range;
    uint32_t top = 0;
    for (;;) {
        bool small = range.count <= builder->small_count;
        if (!small && range_split(build, &range, 1, halves)) {
            stack[top++] = halves[1];
            range = halves[0];
            continue;
        }
        if (small)
            builder->small(builder, &build->output, &range);
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
    uint32_t threads = build->thread_count;
    if (large >= threads || !build->builder->threaded) {
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
    uint32_t threads = build->thread_count;
    build->tasks[0] = (struct build_task){
        .range = {.bounds = *bounds, .count = build->count, .spare = build->spare}};
    build->task_count = 1;
    uint32_t limit = build->count / (threads * TASKS_PER_THREAD);
    if (limit < TASK_MIN)
        limit = TASK_MIN;
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

/* Slots are in depth-first order, and pairs only move down. Returns the number of nodes. */
static uint32_t squeeze(const struct build_output *output, uint32_t slot_count)
{
    struct gpu_bvh_node *nodes = output->nodes;
    uint32_t pair_count = 0, *slots = output->slots;
    for (uint32_t i = 0; i < slot_count; ++i) {
        uint32_t used = slots[i];
        slots[i] = used ? pair_count : UINT32_MAX;
        pair_count += used;
    }
    node_link(&nodes[0], slots);
    memset(&nodes[1], 0, sizeof nodes[1]);
    for (uint32_t i = 0; i < slot_count; ++i) {
        if (slots[i] == UINT32_MAX)
            continue;
        struct gpu_bvh_node *pair = &nodes[2 + 2 * slots[i]];
        struct gpu_bvh_node first = nodes[2 + 2 * i], second = nodes[3 + 2 * i];
        node_link(&first, slots);
        node_link(&second, slots);
        pair[0] = first;
        pair[1] = second;
    }
    return 2 + 2 * pair_count;
}

void *build_alloc_lines(size_t count, size_t element_bytes)
{
    return aligned_alloc(64, (count * element_bytes + 63) & ~(size_t)63);
}

static whit_result grow_alloc(const whit_log *log, struct build *build, struct bvh *out)
{
    size_t room = (size_t)build->count + build->spare;
    build->output.slots = array_alloc_zeroed(room, sizeof *build->output.slots);
    build->tasks = build_alloc_lines(build->thread_count > 1 ? TASKS_MAX : 1, sizeof *build->tasks);
    build->output.nodes = out->nodes = build_alloc_lines(2 * room, sizeof *out->nodes);
    out->order = array_alloc(room, sizeof *out->order);
    if (build->output.slots && build->tasks && out->nodes && out->order)
        return WHIT_OK;
    log_error(log, "tree over %u boxes: out of memory", build->count);
    return WHIT_ERROR_MEMORY;
}

whit_result topdown_grow(const whit_log *log, const struct builder *builder,
                         const struct build_bounds *bounds, uint32_t count, uint32_t spare,
                         struct bvh *out)
{
    struct build build = {.builder = builder,
                          .count = count,
                          .spare = spare,
                          .thread_count = count <= TASK_MIN ? 1 : builder->params->thread_count};
    whit_result result = grow_alloc(log, &build, out);
    if (result == WHIT_OK) {
        build_tree(&build, bounds);
        out->node_count = squeeze(&build.output, count + spare - 1);
    }
    free(build.output.slots);
    free(build.tasks);
    return result;
}
