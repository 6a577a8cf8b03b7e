/* Moves subtrees of a finished tree to where they cost less. After Meister and Bittner 2018,
   "Parallel reinsertion for bounding volume hierarchy optimization": threads search the best place
   of each node by branch and bound over the tree as it stands; then the moves are made one by one,
   those that gain most first. Earlier moves have changed the tree by then, so each gain is computed
   anew, and a move that would raise the cost is undone.

   Leaves stay as they are, so that only the areas of inner nodes change the cost. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/threads.h"
#include "bvh/build.h"
#include "bvh/complete.h"
#include "bvh/optimize.h"

enum {
    ROUNDS_MAX = 10,
    SEARCH_CHUNK = 256, /* searches made by one call */
    SEARCH_MAX = 1024,  /* nodes visited by one search: bounds its time in degenerate trees */
    STACK_SIZE = BVH_DEPTH_MAX + 2,
};

/* A round that lowers the cost by less than this share of it is the last. */
static const double ROUND_MIN = 0.001;

struct move {
    float gain; /* scaled area */
    uint32_t from, to;
};

struct optimizer {
    struct gpu_bvh_node *nodes; /* a copy; without axis bits */
    uint32_t *parents;          /* of each pair: the node above it */
    struct move *moves;         /* one for each node but the root */
    uint32_t node_count, thread_count;
    f4 scale;
};

/* ---- Boxes ---- */

/* Sets the node's box. True: it was another one before. */
static bool node_set_box(struct gpu_bvh_node *node, struct build_box box)
{
    bool same = memcmp(node->lo, &box.lo, sizeof node->lo) == 0 &&
                memcmp(node->hi, &box.hi, sizeof node->hi) == 0;
    build_node_write(node, box, node->first, node->count);
    return !same;
}

/* ---- Where to ---- */

struct candidate {
    struct build_box extent;
    float area;
    uint32_t node, visits;
    struct move best;
};

/* Searches `root` and all nodes below it for a better place. `gained`: the area that the tree loses
   by taking the candidate out, before it is put anywhere. */
static void search_subtree(const struct optimizer *o, struct candidate *c, uint32_t root,
                           float gained)
{
    struct {
        uint32_t node;
        float gained;
    } stack[STACK_SIZE];
    uint32_t top = 0;
    stack[top].node = root;
    stack[top++].gained = gained;
    while (top > 0 && c->visits < SEARCH_MAX) {
        uint32_t at = stack[--top].node;
        gained = stack[top].gained;
        if (gained - c->area <= c->best.gain)
            continue;
        ++c->visits;
        const struct gpu_bvh_node *node = &o->nodes[at];
        struct build_box own = build_node_box(node);
        float gain = gained - build_area(build_box_unite(own, c->extent), o->scale);
        if (gain > c->best.gain)
            c->best = (struct move){gain, c->node, at};
        float below = gain + build_area(own, o->scale);
        if (node->count > 0 || below - c->area <= c->best.gain || top + 2 > STACK_SIZE)
            continue;
        stack[top].node = node->first + 1;
        stack[top++].gained = below;
        stack[top].node = node->first;
        stack[top++].gained = below;
    }
}

/* The best place for `node`. Goes up the path from it to the root, and tries the subtrees beside
   the path and the places above the nodes of the path. */
static struct move search(const struct optimizer *o, uint32_t node)
{
    struct candidate c = {.extent = build_node_box(&o->nodes[node]), .node = node};
    c.area = build_area(c.extent, o->scale);
    uint32_t at = o->parents[node / 2];
    struct build_box left =
        build_node_box(&o->nodes[node ^ 1]); /* box of the path's node without the candidate */
    float gained = build_area(build_node_box(&o->nodes[at]), o->scale);
    search_subtree(o, &c, node ^ 1, gained);
    while (at != 0 && c.visits < SEARCH_MAX) {
        search_subtree(o, &c, at ^ 1, gained);
        left = build_box_unite(left, build_node_box(&o->nodes[at ^ 1]));
        at = o->parents[at / 2];
        gained -= build_area(left, o->scale);
        if (gained > c.best.gain)
            c.best = (struct move){gained, node, at};
        gained += build_area(build_node_box(&o->nodes[at]), o->scale);
    }
    return c.best;
}

static void search_chunk(void *context, uint32_t index)
{
    struct optimizer *o = context;
    uint32_t begin = 2 + index * SEARCH_CHUNK;
    uint32_t end = o->node_count - begin > SEARCH_CHUNK ? begin + SEARCH_CHUNK : o->node_count;
    for (uint32_t i = begin; i < end; ++i)
        o->moves[i - 2] = search(o, i);
}

/* ---- Moving ---- */

static void adopt(struct optimizer *o, uint32_t node)
{
    if (o->nodes[node].count == 0)
        o->parents[o->nodes[node].first / 2] = node;
}

/* Computes the boxes of all nodes above `node` anew. Returns by how much the area of inner nodes
   grows. */
static double refit(struct optimizer *o, uint32_t node)
{
    double grown = 0.0;
    while (node != 0) {
        uint32_t above = o->parents[node / 2];
        double before = bvh_half_area(&o->nodes[above]);
        struct build_box sum =
            build_box_unite(build_node_box(&o->nodes[node]), build_node_box(&o->nodes[node ^ 1]));
        if (!node_set_box(&o->nodes[above], sum))
            break;
        grown += bvh_half_area(&o->nodes[above]) - before;
        node = above;
    }
    return grown;
}

/* Takes `from` out: its sibling takes their parent's place. The pair of nodes stays, for attach.
   Returns by how much the area of inner nodes grows. */
static double detach(struct optimizer *o, uint32_t from)
{
    uint32_t above = o->parents[from / 2];
    double grown = -bvh_half_area(&o->nodes[above]);
    o->nodes[above] = o->nodes[from ^ 1];
    adopt(o, above);
    return grown + refit(o, above);
}

static double attach(struct optimizer *o, uint32_t from, uint32_t to)
{
    o->nodes[from ^ 1] = o->nodes[to];
    adopt(o, from ^ 1);
    struct build_box sum =
        build_box_unite(build_node_box(&o->nodes[from]), build_node_box(&o->nodes[from ^ 1]));
    o->nodes[to].first = from & ~1u;
    o->nodes[to].count = 0;
    o->parents[from / 2] = to;
    (void)node_set_box(&o->nodes[to], sum);
    return bvh_half_area(&o->nodes[to]) + refit(o, to);
}

static bool is_below(const struct optimizer *o, uint32_t node, uint32_t above)
{
    while (node != 0 && node != above)
        node = o->parents[node / 2];
    return node == above;
}

/* Makes the move if it lowers the cost. Returns by how much the cost falls, or 0. */
static double move_make(struct optimizer *o, const struct move *move)
{
    uint32_t from = move->from, to = move->to, above = o->parents[from / 2];
    if (to == above || to == (from ^ 1) || is_below(o, to, from))
        return 0.0;
    double removed = detach(o, from);
    double grown = removed + attach(o, from, to);
    if (grown < 0.0)
        return -grown;
    (void)detach(o, from);
    /* `above` holds the former sibling again, so this restores the former place. */
    (void)attach(o, from, above);
    return 0.0;
}

static int larger_gain_first(const void *a, const void *b)
{
    const struct move *x = a, *y = b;
    if (x->gain != y->gain)
        return x->gain < y->gain ? 1 : -1;
    return x->from < y->from ? -1 : x->from > y->from;
}

/* Runs one round of moves. Returns by how much the cost falls. */
static double round_run(struct optimizer *o)
{
    uint32_t count = o->node_count - 2, kept = 0;
    threads_for(o->thread_count, (count + SEARCH_CHUNK - 1) / SEARCH_CHUNK, search_chunk, o);
    for (uint32_t i = 0; i < count; ++i) {
        if (o->moves[i].gain > 0.0f)
            o->moves[kept++] = o->moves[i];
    }
    qsort(o->moves, kept, sizeof *o->moves, larger_gain_first);
    double gained = 0.0;
    for (uint32_t i = 0; i < kept; ++i)
        gained += move_make(o, &o->moves[i]);
    return gained;
}

/* ---- The whole tree ---- */

static bool optimizer_init(struct optimizer *o, const struct bvh *bvh, uint32_t thread_count)
{
    *o = (struct optimizer){.node_count = bvh->node_count, .thread_count = thread_count};
    o->nodes = array_alloc_aligned(bvh->node_count, sizeof *o->nodes);
    o->parents = array_alloc_zeroed(bvh->node_count / 2, sizeof *o->parents);
    o->moves = array_alloc(bvh->node_count, sizeof *o->moves);
    if (!o->nodes || !o->parents || !o->moves)
        return false;
    memcpy(o->nodes, bvh->nodes, bvh->node_count * sizeof *o->nodes);
    for (uint32_t i = 0; i < bvh->node_count; ++i) {
        o->nodes[i].count = bvh_count(&o->nodes[i]);
        if (i != 1)
            adopt(o, i);
    }
    o->scale = build_scale(build_node_box(&o->nodes[0]));
    return true;
}

static void optimizer_finish(struct optimizer *o)
{
    free(o->nodes);
    free(o->parents);
    free(o->moves);
}

static double inner_area(const struct gpu_bvh_node *nodes, uint32_t node_count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < node_count; ++i)
        sum += i != 1 && bvh_count(&nodes[i]) == 0 ? bvh_half_area(&nodes[i]) : 0.0;
    return sum;
}

/* The depth of the subtree below `node`, 0 for a leaf; above `max` where it is more than that. */
static uint32_t subtree_depth(const struct gpu_bvh_node *nodes, uint32_t node, uint32_t max)
{
    if (nodes[node].count > 0 || max == 0)
        return nodes[node].count == 0;
    uint32_t a = subtree_depth(nodes, nodes[node].first, max - 1);
    uint32_t b = subtree_depth(nodes, nodes[node].first + 1, max - 1);
    return 1 + (a > b ? a : b);
}

/* Writes the tree to `bvh`: pairs of nodes in depth-first order, primitives in the order of the
   leaves. */
static void emit(const struct optimizer *o, struct bvh *bvh, uint32_t *order)
{
    struct {
        uint32_t from, to;
    } stack[STACK_SIZE], at = {0, 0};
    uint32_t top = 0, pair = 2, slot = 0;
    for (;;) {
        struct gpu_bvh_node *node = &bvh->nodes[at.to];
        *node = o->nodes[at.from];
        uint32_t first = node->first;
        if (node->count > 0) {
            memcpy(&order[slot], &bvh->order[first], node->count * sizeof *order);
            node->first = slot;
            slot += node->count;
            if (top == 0)
                return;
            at = stack[--top];
            continue;
        }
        node->first = pair;
        stack[top].from = first + 1;
        stack[top++].to = pair + 1;
        at.from = first;
        at.to = pair;
        pair += 2;
    }
}

whit_result bvh_optimize(const whit_log *log, uint32_t thread_count, struct bvh *bvh)
{
    if (bvh->node_count <= 4)
        return WHIT_OK;
    struct optimizer o;
    uint32_t *order = array_alloc(bvh->reference_count, sizeof *order);
    if (!optimizer_init(&o, bvh, thread_count) || !order) {
        log_error(log, "tree over %u boxes: out of memory to optimize it", bvh->primitive_count);
        optimizer_finish(&o);
        free(order);
        return WHIT_ERROR_MEMORY;
    }
    double before = inner_area(o.nodes, o.node_count), now = before;
    for (uint32_t i = 0; i < ROUNDS_MAX && now > 0.0; ++i) {
        double gained = round_run(&o);
        now -= gained;
        if (!(gained > ROUND_MIN * now))
            break;
    }
    bool better = inner_area(o.nodes, o.node_count) < before;
    uint32_t depth = better ? subtree_depth(o.nodes, 0, BVH_DEPTH_MAX) : 0;
    if (better && depth <= BVH_DEPTH_MAX) {
        bvh->depth = depth;
        emit(&o, bvh, order);
        uint32_t *old = bvh->order;
        bvh->order = order;
        order = old;
        bvh_complete(bvh, 1);
    }
    optimizer_finish(&o);
    free(order);
    return WHIT_OK;
}
