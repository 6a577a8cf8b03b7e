/* Top-down building, for any way to choose splits. While the tree grows, a subtree over n records
   owns a run of memory: places for its records and pair slots in depth-first order, and spare ones
   for the references that splitting records may add. The spare places that a split leaves are
   shared by the halves in proportion to their records; unused pair slots are squeezed out at the
   end. So any thread can build any subtree at any time, the nodes are the same for any number of
   threads, and there are never more references than spare places. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/topdown.h"

enum {
    TASK_MIN = 2048, /* smaller subtrees are not worth a task of their own */
    TASKS_MAX = 4096,
};

/* A queue of subtrees that wait for a thread. The one that has waited longest goes first, as it is
   about the largest. */
struct build_queue {
    struct build_range *ranges; /* ring buffer of TASKS_MAX */
    uint32_t first, count;
    uint32_t working; /* threads that may still add subtrees */
    pthread_mutex_t lock;
    pthread_cond_t changed;
};

struct build {
    struct build_output output;
    const struct builder *builder;
    uint32_t count, spare, thread_count;
    struct build_queue queue;
};

/* ---- Subtrees ---- */

/* Gives each half its run of memory. */
static void halves_place(const struct build *build, const struct build_range *range,
                         const struct build_halves *split, struct build_range halves[2])
{
    uint32_t left = split->count[0], right = split->count[1], child = 2 + 2 * range->pair;
    uint32_t spare = range->count + range->spare - (left + right), depth = range->depth + 1;
    uint32_t left_spare = (uint32_t)((uint64_t)spare * left / (left + right));
    uint32_t room = left + left_spare;
    struct build_record *from = build->builder->records + range->first + left;
    if (left_spare > 0) { /* as few as possible move; their order may change */
        uint32_t moved = left_spare < right ? left_spare : right;
        memmove(from + (left_spare < right ? right : left_spare), from, moved * sizeof *from);
    }
    halves[0] = (struct build_range){split->bounds[0], child, range->pair + 1, range->first, left,
                                     left_spare,       depth};
    halves[1] = (struct build_range){
        split->bounds[1],   child + 1, range->pair + room, range->first + room, right,
        spare - left_spare, depth};
}

/* True: the range became an inner node with *halves below it. False: it became a leaf. */
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
    build->output.slots[range->pair] = range->depth + 1;
    halves_place(build, range, &split, halves);
    return true;
}

/* False: the queue is full. */
static bool queue_add(struct build_queue *queue, const struct build_range *range)
{
    pthread_mutex_lock(&queue->lock);
    bool room = queue->count < TASKS_MAX;
    if (room)
        queue->ranges[(queue->first + queue->count++) % TASKS_MAX] = *range;
    pthread_cond_signal(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
    return room;
}

/* Waits for the next subtree. False: the queue is empty, and nothing more will come. */
static bool queue_take(struct build_queue *queue, struct build_range *range)
{
    pthread_mutex_lock(&queue->lock);
    while (queue->count == 0 && queue->working > 0)
        pthread_cond_wait(&queue->changed, &queue->lock);
    bool some = queue->count > 0;
    if (some) {
        *range = queue->ranges[queue->first];
        queue->first = (queue->first + 1) % TASKS_MAX;
        --queue->count;
        ++queue->working;
    }
    pthread_mutex_unlock(&queue->lock);
    return some;
}

static void queue_done(struct build_queue *queue)
{
    pthread_mutex_lock(&queue->lock);
    if (--queue->working == 0)
        pthread_cond_broadcast(&queue->changed);
    pthread_mutex_unlock(&queue->lock);
}

/* Builds a subtree, and queues those of its parts for other threads that are large enough. */
static void build_subtree(struct build *build, struct build_range range)
{
    const struct builder *builder = build->builder;
    struct build_range stack[BVH_DEPTH_MAX], halves[2];
    uint32_t top = 0;
    for (;;) {
        bool small = range.count <= builder->small_count;
        if (!small && range_split(build, &range, 1, halves)) {
            bool shared = build->thread_count > 1 && halves[1].count > TASK_MIN;
            if (!shared || !queue_add(&build->queue, &halves[1]))
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

static void build_subtrees(void *context, uint32_t index)
{
    struct build *build = context;
    struct build_range range;
    (void)index;
    while (queue_take(&build->queue, &range)) {
        build_subtree(build, range);
        queue_done(&build->queue);
    }
}

/* All threads split the top of the tree together, until there is a subtree for each. */
static void build_top(struct build *build)
{
    struct build_queue *queue = &build->queue;
    struct build_range range, halves[2];
    while (queue->count > 0 && queue->count < build->thread_count) {
        range = queue->ranges[queue->first % TASKS_MAX];
        if (range.count <= TASK_MIN)
            return;
        queue->first = (queue->first + 1) % TASKS_MAX;
        --queue->count;
        if (!range_split(build, &range, build->thread_count, halves))
            continue;
        queue_add(queue, &halves[0]);
        queue_add(queue, &halves[1]);
    }
}

static void build_tree(struct build *build, const struct build_bounds *bounds)
{
    struct build_range all = {.bounds = *bounds, .count = build->count, .spare = build->spare};
    if (build->thread_count == 1) {
        build_subtree(build, all);
        return;
    }
    pthread_mutex_init(&build->queue.lock, NULL);
    pthread_cond_init(&build->queue.changed, NULL);
    queue_add(&build->queue, &all);
    if (build->builder->threaded)
        build_top(build);
    threads_for(build->thread_count, build->thread_count, build_subtrees, build);
    pthread_cond_destroy(&build->queue.changed);
    pthread_mutex_destroy(&build->queue.lock);
}

/* ---- The finished tree ---- */

static void node_link(struct gpu_bvh_node *node, const uint32_t *slots)
{
    if (node->count == 0)
        node->first = 2 + 2 * slots[(node->first - 2) / 2];
}

/* Removes unused pair slots, and finds the depth. Slots are in depth-first order, so that pairs
   only move to lower ones. out->order holds the slots in use meanwhile. */
static void squeeze(const struct build_output *output, uint32_t slot_count, struct bvh *out)
{
    struct gpu_bvh_node *nodes = output->nodes;
    uint32_t pair_count = 0, *slots = output->slots, *used = out->order;
    for (uint32_t i = 0; i < slot_count; ++i) {
        uint32_t depth = slots[i];
        out->depth = depth > out->depth ? depth : out->depth;
        used[pair_count] = i;
        slots[i] = pair_count;
        pair_count += depth > 0;
    }
    node_link(&nodes[0], slots);
    memset(&nodes[1], 0, sizeof nodes[1]);
    for (uint32_t p = 0; p < pair_count; ++p) {
        struct gpu_bvh_node *pair = &nodes[2 + 2 * p], *from = &nodes[2 + 2 * used[p]];
        struct gpu_bvh_node first = from[0], second = from[1];
        node_link(&first, slots);
        node_link(&second, slots);
        pair[0] = first;
        pair[1] = second;
    }
    out->node_count = 2 + 2 * pair_count;
}

static whit_result grow_alloc(const whit_log *log, struct build *build, struct bvh *out)
{
    size_t room = (size_t)build->count + build->spare;
    build->output.slots = array_alloc_zeroed(room, sizeof *build->output.slots);
    build->queue.ranges =
        array_alloc_lines(build->thread_count > 1 ? TASKS_MAX : 1, sizeof *build->queue.ranges);
    build->output.nodes = out->nodes = array_alloc_lines(2 * room, sizeof *out->nodes);
    out->order = array_alloc(room, sizeof *out->order);
    if (build->output.slots && build->queue.ranges && out->nodes && out->order)
        return WHIT_OK;
    return log_failure(log, WHIT_ERROR_MEMORY, "tree over %u boxes: out of memory", build->count);
}

whit_result topdown_grow(const whit_log *log, const struct builder *builder,
                         const struct build_bounds *bounds, uint32_t count, uint32_t spare,
                         struct bvh *out)
{
    struct build build = {.builder = builder,
                          .count = count,
                          .spare = spare,
                          .thread_count = count <= TASK_MIN ? 1 : builder->params->threads};
    whit_result result = grow_alloc(log, &build, out);
    if (result == WHIT_OK) {
        build_tree(&build, bounds);
        squeeze(&build.output, count + spare - 1, out);
    }
    free(build.output.slots);
    free(build.queue.ranges);
    return result;
}
