/* Top-down building with object and spatial splits: Stich, Friedrich and Dietrich 2009, "Spatial
   splits in bounding volume hierarchies". A reference is a triangle, or the part of one in a box.

   As in topdown.c a subtree owns a run of memory: that of its references and of those it may add.
   What is left of the latter after a split is shared by the halves in proportion to their
   references, so that the tree is the same for any number of threads and the budget is never
   exceeded. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/clip.h"
#include "bvh/spatial.h"

enum {
    TASK_MIN = 1024,       /* smaller subtrees are not worth a task of their own */
    TASKS_PER_THREAD = 16, /* evens out subtrees of unequal cost */
    TASKS_MAX = 4096,
};

/* References [first, first + count), room for `spare` more behind them, and count + spare - 1 pair
   slots from `range.pair` on. */
struct subtree {
    struct build_range range;
    uint32_t spare;
};

/* A subtree still to be built. */
struct task {
    struct subtree subtree, halves[2];
    bool split;
};

struct build {
    struct bvh_params params;
    const struct bvh_box *boxes;
    struct build_record *records;
    struct gpu_bvh_node *nodes;
    uint32_t *slots; /* 1: pair slot in use; later its place when squeezed */
    struct task *tasks;
    uint32_t task_count, count, spare;
    double overlap_min; /* of the halves, from which spatial splits are tried */
};

/* ---- Nodes ---- */

static double extent_area(f4 lo_in, f4 hi_in)
{
    alignas(16) float lo[4], hi[4];
    double side[3];
    f4_store(lo, lo_in);
    f4_store(hi, hi_in);
    for (int k = 0; k < 3; ++k) {
        side[k] = (double)hi[k] - (double)lo[k];
        if (side[k] < 0.0)
            return 0.0;
    }
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
}

/* Parts get their margin here: until now costs were those of the parts alone. */
static void leaf_write(struct build *build, const struct build_range *range)
{
    struct build_bounds bounds = build_bounds_empty();
    for (uint32_t i = 0; i < range->count; ++i) {
        struct build_record record = build->records[range->first + i];
        if (record.pad & SPATIAL_PART) {
            struct bvh_box part;
            memcpy(part.lo, record.lo, sizeof part.lo);
            memcpy(part.hi, record.hi, sizeof part.hi);
            part = clip_widen(&part, &build->boxes[record.primitive]);
            memcpy(record.lo, part.lo, sizeof part.lo);
            memcpy(record.hi, part.hi, sizeof part.hi);
        }
        build_bounds_add(&bounds, build_record_lo(&record), build_record_hi(&record));
    }
    build_node_write(&build->nodes[range->node], bounds.lo, bounds.hi, range->first, range->count);
}

/* ---- Splits ---- */

struct split {
    uint32_t left_count, right_count;
    struct build_bounds halves[2];
};

/* Whether a spatial split may pay: there is room, and the halves of the best object split overlap.
   Where there is no object split all lie on each other. */
static bool spatial_worthwhile(const struct build *build, const struct subtree *subtree,
                               const struct object_plane *object)
{
    if (subtree->spare == 0)
        return false;
    const struct build_bounds *bounds = &subtree->range.bounds;
    double overlap = object->cost < INFINITY ? extent_area(object->overlap_lo, object->overlap_hi)
                                             : extent_area(bounds->lo, bounds->hi);
    return overlap > build->overlap_min;
}

/* Finds and makes the best split; false: none is to be made. */
static bool best_split(struct build *build, const struct subtree *subtree, struct split *split)
{
    const struct build_range *range = &subtree->range;
    const struct bvh_triangles *triangles = build->params.triangles;
    struct build_record *own = build->records + range->first;
    f4 scale = build_area_scale(&range->bounds);
    struct object_plane object;
    struct spatial_plane plane;
    bool has_object = object_find(own, &range->bounds, range->count, scale, &object);
    bool spatial =
        spatial_worthwhile(build, subtree, &object) &&
        spatial_find(own, &range->bounds, range->count, subtree->spare, triangles, scale, &plane) &&
        plane.cost < object.cost;
    float area = build_scaled_area(range->bounds.lo, range->bounds.hi, scale);
    float cost = area * build->params.traversal_cost + (spatial ? plane.cost : object.cost);
    if (range->count <= build->params.leaf_limit && area * (float)range->count <= cost)
        return false;
    if (spatial && spatial_apply(own, range->count, subtree->spare, &plane, triangles,
                                 &split->left_count, &split->right_count, split->halves))
        return true;
    if (!has_object)
        return false;
    object_apply(own, range->count, &object, split->halves);
    split->left_count = object.left_count;
    split->right_count = range->count - object.left_count;
    return true;
}

/* Makes room for `spare` records between the halves. */
static void right_half_move(struct build_record *right, uint32_t count, uint32_t spare)
{
    uint32_t moved = spare < count ? spare : count;
    memmove(right + (spare < count ? count : spare), right, moved * sizeof *right);
}

/* True: the subtree became an inner node with the two halves below it. False: it is a leaf now. */
static bool subtree_split(struct build *build, const struct subtree *subtree,
                          struct subtree halves[2])
{
    const struct build_range *range = &subtree->range;
    struct split split;
    bool found = range->count > 1 && range->depth < BUILD_DEPTH_OF_MEDIANS &&
                 best_split(build, subtree, &split);
    if (!found && range->count <= build->params.leaf_limit) {
        leaf_write(build, range);
        return false;
    }
    if (!found) {
        split_median(build->records, range, &split.left_count, split.halves);
        split.right_count = range->count - split.left_count;
    }
    uint32_t total = split.left_count + split.right_count;
    uint32_t spare = range->count + subtree->spare - total;
    uint32_t left_spare = (uint32_t)((uint64_t)spare * split.left_count / total);
    uint32_t left_room = split.left_count + left_spare;
    right_half_move(build->records + range->first + split.left_count, split.right_count,
                    left_spare);
    uint32_t child = 2 + 2 * range->pair;
    build_node_write(&build->nodes[range->node], range->bounds.lo, range->bounds.hi, child, 0);
    build->slots[range->pair] = 1;
    halves[0].spare = left_spare;
    halves[0].range = (struct build_range){
        split.halves[0], child, range->pair + 1, range->first, split.left_count, range->depth + 1};
    halves[1].spare = spare - left_spare;
    halves[1].range =
        (struct build_range){split.halves[1],          child + 1,         range->pair + left_room,
                             range->first + left_room, split.right_count, range->depth + 1};
    return true;
}

/* ---- Subtrees ---- */

static void build_subtree(void *context, uint32_t index)
{
    struct build *build = context;
    struct subtree stack[BVH_DEPTH_MAX], halves[2], at = build->tasks[index].subtree;
    uint32_t top = 0;
    for (;;) {
        if (subtree_split(build, &at, halves)) {
            stack[top++] = halves[1];
            at = halves[0];
            continue;
        }
        if (top == 0)
            return;
        at = stack[--top];
    }
}

static void split_task(void *context, uint32_t index)
{
    struct build *build = context;
    struct task *task = &build->tasks[index];
    task->split = subtree_split(build, &task->subtree, task->halves);
}

/* Splits the first `large` tasks, each into itself and one at the end. */
static void split_tasks(struct build *build, uint32_t large)
{
    threads_for(build->params.thread_count, large, split_task, build);
    for (uint32_t i = 0; i < large; ++i) {
        struct task *task = &build->tasks[i];
        if (!task->split)
            continue;
        build->tasks[build->task_count++] = (struct task){.subtree = task->halves[1]};
        task->subtree = task->halves[0];
    }
}

static int larger_first(const void *a, const void *b)
{
    const struct build_range *x = &((const struct task *)a)->subtree.range;
    const struct build_range *y = &((const struct task *)b)->subtree.range;
    if (x->count != y->count)
        return x->count < y->count ? 1 : -1;
    return x->first < y->first ? -1 : x->first > y->first;
}

/* Splits the top of the tree until there are enough subtrees for all threads, then builds these. */
static void build_tree(struct build *build, const struct build_bounds *bounds)
{
    uint32_t threads = build->params.thread_count;
    build->overlap_min = (double)build->params.spatial_alpha * extent_area(bounds->lo, bounds->hi);
    build->tasks[0] = (struct task){
        .subtree = {.range = {.bounds = *bounds, .count = build->count}, .spare = build->spare}};
    build->task_count = 1;
    uint32_t limit = build->count / (threads * TASKS_PER_THREAD);
    if (limit < TASK_MIN)
        limit = TASK_MIN;
    while (threads > 1) {
        qsort(build->tasks, build->task_count, sizeof *build->tasks, larger_first);
        uint32_t large = 0;
        while (large < build->task_count && build->tasks[large].subtree.range.count > limit)
            ++large;
        if (large == 0 || build->task_count + large > TASKS_MAX)
            break;
        split_tasks(build, large);
    }
    threads_for(threads, build->task_count, build_subtree, build);
}

/* ---- The finished tree ---- */

/* Puts a node where it stays: its pair, or the records of its leaf. */
static void node_place(const struct build *build, struct gpu_bvh_node *node, struct bvh *out)
{
    if (node->count == 0) {
        node->first = 2 + 2 * build->slots[(node->first - 2) / 2];
        return;
    }
    const struct build_record *records = &build->records[node->first];
    node->first = out->reference_count;
    for (uint32_t i = 0; i < node->count; ++i) {
        out->order[out->reference_count++] = records[i].primitive;
        out->clipped |= (records[i].pad & SPATIAL_PART) != 0;
    }
}

/* Slots are in depth-first order, and pairs only move down. */
static void squeeze(struct build *build, struct bvh *out)
{
    uint32_t pair_count = 0, slot_count = build->count + build->spare - 1;
    for (uint32_t i = 0; i < slot_count; ++i) {
        uint32_t used = build->slots[i];
        build->slots[i] = used ? pair_count : UINT32_MAX;
        pair_count += used;
    }
    out->reference_count = 0;
    node_place(build, &build->nodes[0], out);
    memset(&build->nodes[1], 0, sizeof build->nodes[1]);
    for (uint32_t i = 0; i < slot_count; ++i) {
        if (build->slots[i] == UINT32_MAX)
            continue;
        struct gpu_bvh_node *pair = &build->nodes[2 + 2 * build->slots[i]];
        memmove(pair, &build->nodes[2 + 2 * i], 2 * sizeof *pair);
        node_place(build, &pair[0], out);
        node_place(build, &pair[1], out);
    }
    out->node_count = 2 + 2 * pair_count;
}

/* Children come after their parents. */
static void refit(struct bvh *bvh)
{
    for (uint32_t i = bvh->node_count; i-- > 0;) {
        struct gpu_bvh_node *node = &bvh->nodes[i];
        if (node->count > 0 || i == 1)
            continue;
        const struct gpu_bvh_node *a = &bvh->nodes[node->first], *b = a + 1;
        build_node_write(node, f4_min(f4_load(a->lo), f4_load(b->lo)),
                         f4_max(f4_load(a->hi), f4_load(b->hi)), node->first, 0);
    }
}

/* ---- The whole build ---- */

static void flag_whole(struct build *build)
{
    const uint8_t *whole = build->params.triangles->whole;
    for (uint32_t i = 0; whole && i < build->count; ++i)
        build->records[i].pad = whole[i] ? SPATIAL_WHOLE : 0;
}

/* Not zeroed: room that stays empty should cost no memory. */
static void *alloc_lines(size_t count, size_t element_bytes)
{
    return aligned_alloc(64, (count * element_bytes + 63) & ~(size_t)63);
}

static whit_result build_alloc(const struct log *log, struct build *build, struct bvh *out)
{
    size_t room = (size_t)build->count + build->spare;
    build->slots = array_alloc_zeroed(room, sizeof *build->slots);
    build->tasks =
        alloc_lines(build->params.thread_count > 1 ? TASKS_MAX : 1, sizeof *build->tasks);
    build->nodes = out->nodes = alloc_lines(2 * room, sizeof *out->nodes);
    out->order = array_alloc(room, sizeof *out->order);
    if (build->slots && build->tasks && out->nodes && out->order)
        return WHIT_OK;
    log_error(log, "tree over %u boxes: out of memory", build->count);
    return WHIT_ERROR_MEMORY;
}

/* References that may be added; all must be within what a node can address. */
static uint32_t budget(uint32_t count, float share)
{
    double max = floor((double)count * (double)share);
    double room = (double)(BVH_FIRST_MASK / 2 - count);
    return (uint32_t)(max < room ? max : room);
}

whit_result spatial_build(const struct log *log, const struct bvh_box *boxes, uint32_t count,
                          const struct bvh_params *resolved, struct bvh *out)
{
    if (!resolved->triangles) {
        log_error(log, "tree over %u boxes: spatial splits need the triangles in them", count);
        return WHIT_ERROR_USAGE;
    }
    struct build build = {.params = *resolved, .boxes = boxes, .count = count};
    build.spare = budget(count, resolved->spatial_budget);
    if (count <= TASK_MIN)
        build.params.thread_count = 1;
    struct build_bounds bounds;
    whit_result result = records_make(log, boxes, count, build.spare, build.params.thread_count,
                                      &build.records, &bounds);
    if (result == WHIT_OK)
        result = build_alloc(log, &build, out);
    if (result != WHIT_OK)
        goto done;
    flag_whole(&build);
    build_tree(&build, &bounds);
    squeeze(&build, out);
    if (out->clipped)
        refit(out);
    bvh_complete(out, (double)build.params.traversal_cost);
done:
    free(build.records);
    free(build.slots);
    free(build.tasks);
    return result;
}
