/* Top-down building, whatever chooses the splits. While it grows, a subtree over n records owns n -
   1 pair slots in depth-first order; what it does not use is squeezed out at the end. So subtrees
   can be built by any thread at any time, and the nodes are the same for any number of threads. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/build.h"

enum {
    TASK_MIN = 2048,      /* smaller subtrees are not worth a task of their own */
    TASKS_PER_THREAD = 4, /* evens out subtrees of unequal cost */
    TASKS_MAX = 4096,
};

struct build {
    struct build_output output;
    const struct build_methods *methods;
    uint32_t count, leaf_limit, thread_count;
    struct build_task *tasks;
    uint32_t task_count;
    _Atomic bool stopped;
};

/* A subtree still to be built. */
struct build_task {
    struct build_range range;
    struct build_range halves[2];
    bool split;
};

/* ---- Subtrees ---- */

static void node_write(struct gpu_bvh_node *node, const struct build_bounds *bounds, uint32_t first,
                       uint32_t count)
{
    build_node_write(node, bounds->lo, bounds->hi, first, count);
}

/* True: *range became an inner node with the two halves below it. False: it is a leaf now. */
static bool range_split(struct build *build, const struct build_range *range, uint32_t thread_count,
                        struct build_range halves[2])
{
    struct gpu_bvh_node *nodes = build->output.nodes;
    const struct build_methods *methods = build->methods;
    struct build_bounds bounds[2];
    uint32_t left = 0, child = 2 + 2 * range->pair;
    enum build_choice choice = range->count <= 1 ? BUILD_LEAF : BUILD_NONE;
    if (choice == BUILD_NONE && methods->split && range->depth < BUILD_DEPTH_OF_MEDIANS)
        choice =
            methods->split(methods->context, range, thread_count, &nodes[child], &left, bounds);
    if (choice == BUILD_NONE && range->count <= build->leaf_limit)
        choice = BUILD_LEAF;
    if (choice == BUILD_STOP)
        atomic_store(&build->stopped, true);
    if (choice == BUILD_LEAF || choice == BUILD_STOP) {
        node_write(&nodes[range->node], &range->bounds, range->first, range->count);
        return false;
    }
    if (choice == BUILD_NONE)
        methods->halve(methods->context, range, &nodes[child], &left, bounds);

    node_write(&nodes[range->node], &range->bounds, child, 0);
    build->output.slots[range->pair] = 1;
    halves[0] = (struct build_range){bounds[0],    child, range->pair + 1,
                                     range->first, left,  range->depth + 1};
    halves[1] = (struct build_range){bounds[1],           child + 1,           range->pair + left,
                                     range->first + left, range->count - left, range->depth + 1};
    return true;
}

static void build_subtree(void *context, uint32_t index)
{
    struct build *build = context;
    const struct build_methods *methods = build->methods;
    struct build_range stack[BVH_DEPTH_MAX], halves[2], range = build->tasks[index].range;
    uint32_t top = 0;
    for (;;) {
        bool small = range.count <= methods->small_count;
        if (!small && range_split(build, &range, 1, halves)) {
            stack[top++] = halves[1];
            range = halves[0];
            continue;
        }
        if (small)
            methods->small(methods->context, &build->output, &range);
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
    uint32_t threads = build->thread_count;
    build->tasks[0] = (struct build_task){.range = {.bounds = *bounds, .count = build->count}};
    build->task_count = 1;
    uint32_t limit = build->count / (threads * TASKS_PER_THREAD);
    if (limit < TASK_MIN)
        limit = TASK_MIN;
    while (threads > 1 && !atomic_load(&build->stopped)) {
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

/* Not zeroed: slots that stay empty should cost no memory. */
static void *alloc_lines(size_t count, size_t element_bytes)
{
    return aligned_alloc(64, (count * element_bytes + 63) & ~(size_t)63);
}

static whit_result grow_alloc(const struct log *log, struct build *build, struct bvh *out)
{
    build->output.slots = array_alloc_zeroed(build->count, sizeof *build->output.slots);
    build->tasks = alloc_lines(build->thread_count > 1 ? TASKS_MAX : 1, sizeof *build->tasks);
    build->output.nodes = out->nodes = alloc_lines(2 * (size_t)build->count, sizeof *out->nodes);
    out->order = array_alloc(build->count, sizeof *out->order);
    if (build->output.slots && build->tasks && out->nodes && out->order)
        return WHIT_OK;
    log_error(log, "tree over %u boxes: out of memory", build->count);
    return WHIT_ERROR_MEMORY;
}

whit_result topdown_grow(const struct log *log, const struct build_methods *methods,
                         const struct bvh_params *params, const struct build_bounds *bounds,
                         uint32_t count, struct bvh *out)
{
    struct build build = {.methods = methods,
                          .count = count,
                          .leaf_limit = params->leaf_limit,
                          .thread_count = count <= TASK_MIN ? 1 : params->thread_count};
    atomic_init(&build.stopped, false);
    whit_result result = grow_alloc(log, &build, out);
    if (result != WHIT_OK)
        goto done;
    build_tree(&build, bounds);
    if (atomic_load(&build.stopped)) {
        result = WHIT_ERROR_CANCELLED;
        goto done;
    }
    out->node_count = squeeze(&build.output, count - 1);
    build_complete(out, (double)params->traversal_cost, build.thread_count);
done:
    free(build.output.slots);
    free(build.tasks);
    return result;
}
