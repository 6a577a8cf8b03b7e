/* Builds trees over triangles by all builders and settings, and checks them completely. */
#ifndef TESTS_ACCEL_BUILD_FIXTURE_H
#define TESTS_ACCEL_BUILD_FIXTURE_H

#include "accel_fixture.h"

#include "accel/validate.h"
#include "base/hash.h"

__extension__ typedef __float128 quad;

/* ---- Meshes ---- */

/* A triangle whose box has these corners. */
static inline void soup_set_box(struct soup *soup, uint32_t i, const float lo[3], const float hi[3])
{
    soup_set(soup, i, lo, (float[3]){hi[0], hi[1], lo[2]}, (float[3]){lo[0], hi[1], hi[2]});
}

/* Cells of a grid: on each axis many boxes share a centroid coordinate, but no two boxes share the
   whole centroid. */
static inline struct soup soup_grid(uint32_t side)
{
    struct soup soup = soup_make("grid", side * side * side);
    for (uint32_t i = 0; i < soup.count; ++i) {
        const float lo[3] = {(float)(i % side) - 0.5f, (float)(i / side % side) - 0.5f,
                             (float)(i / side / side) - 0.5f};
        soup_set_box(&soup, i, lo, (float[3]){lo[0] + 1.0f, lo[1] + 4.0f, lo[2] + 1.0f});
    }
    soup_box(&soup);
    return soup;
}

static inline void soup_shuffle(struct soup *soup)
{
    for (uint32_t i = soup->count - 1; i > 0; --i) {
        uint32_t j = random_below(&random_state, i + 1);
        float moved[9], *a = &soup->positions[9 * (size_t)i], *b = &soup->positions[9 * (size_t)j];
        memcpy(moved, a, sizeof moved);
        memcpy(a, b, sizeof moved);
        memcpy(b, moved, sizeof moved);
    }
    soup_box(soup);
}

/* ---- Builds ---- */

/* Freed at the end of its block. */
#define own_bvh __attribute__((cleanup(bvh_finish), unused)) struct bvh

static inline struct bvh soup_build(const struct soup *soup, whit_accel_params params)
{
    struct bvh bvh;
    assert_int_equal(bvh_build(&silent, soup->boxes, soup->count, &soup->triangles, &params, &bvh),
                     WHIT_OK);
    return bvh;
}

/* Whether `count` bytes are equal; pointers may be NULL if `count` is 0. */
static inline bool bytes_equal(const void *a, const void *b, size_t count)
{
    return count == 0 || memcmp(a, b, count) == 0;
}

static inline bool trees_equal(const struct bvh *a, const struct bvh *b)
{
    return a->node_count == b->node_count && a->depth == b->depth && a->sah_cost == b->sah_cost &&
           a->reference_count == b->reference_count &&
           bytes_equal(a->nodes, b->nodes, a->node_count * sizeof *a->nodes);
}

static inline bool orders_equal(const struct bvh *a, const struct bvh *b)
{
    return bytes_equal(a->order, b->order, a->reference_count * sizeof *a->order);
}

static inline double half_area(const float lo[3], const float hi[3])
{
    double x = (double)hi[0] - (double)lo[0], y = (double)hi[1] - (double)lo[1],
           z = (double)hi[2] - (double)lo[2];
    return x * y + y * z + z * x;
}

static const struct bvh_box no_box = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

static inline void box_unite(struct bvh_box *a, const float lo[3], const float hi[3])
{
    for (int i = 0; i < 3; ++i) {
        a->lo[i] = fminf(a->lo[i], lo[i]);
        a->hi[i] = fmaxf(a->hi[i], hi[i]);
    }
}

/* ---- What bvh_validate does not check ---- */

struct found {
    uint32_t depth;
    double cost; /* not yet divided by the root's area */
    bool exact;  /* every box is the union of the boxes below it */
};

/* Walks the tree and fills `found`: checks boxes, counts depth and cost. */
static inline void walk_exact(const struct bvh *bvh, const struct bvh_box *boxes, uint32_t index,
                              uint32_t depth, struct found *found)
{
    const struct gpu_bvh_node *node = &bvh->nodes[index];
    struct bvh_box sum = no_box;
    double area = half_area(node->lo, node->hi);
    if (bvh_count(node) > 0) {
        for (uint32_t i = 0; i < bvh_count(node); ++i) {
            const struct bvh_box *box = &boxes[bvh->order[node->first + i]];
            box_unite(&sum, box->lo, box->hi);
        }
        found->depth = depth > found->depth ? depth : found->depth;
        found->cost += area * bvh_count(node);
    } else {
        const struct gpu_bvh_node *pair = &bvh->nodes[node->first];
        box_unite(&sum, pair[0].lo, pair[0].hi);
        box_unite(&sum, pair[1].lo, pair[1].hi);
        found->cost += area;
        walk_exact(bvh, boxes, node->first, depth + 1, found);
        walk_exact(bvh, boxes, node->first + 1, depth + 1, found);
    }
    for (int a = 0; a < 3; ++a)
        found->exact &= node->lo[a] == sum.lo[a] && node->hi[a] == sum.hi[a];
}

static inline bool is_whole(const struct bvh *bvh, const struct bvh_box *boxes)
{
    struct found found = {.exact = true};
    walk_exact(bvh, boxes, 0, 0, &found);
    double root = half_area(bvh->nodes[0].lo, bvh->nodes[0].hi);
    bool cost_right =
        root <= 0.0 || fabs(found.cost / root - bvh->sah_cost) <= 1e-9 * bvh->sah_cost;
    return found.exact && found.depth == bvh->depth && cost_right;
}

/* Points of a triangle in sixths: corners, middles of edges, and inside. All of them in doubles,
   scaled by six, are exact where the coordinates are not too far apart; quads keep them exact. */
enum { STEPS = 6, POINTS = (STEPS + 1) * (STEPS + 2) / 2 };
#define POINTS_ALL ((1u << POINTS) - 1)

static inline void triangle_points(const struct soup *soup, uint32_t triangle, quad out[POINTS][3])
{
    const float *a = soup_vertex(soup, triangle, 0), *b = soup_vertex(soup, triangle, 1),
                *c = soup_vertex(soup, triangle, 2);
    int point = 0;
    for (int i = 0; i <= STEPS; ++i) {
        for (int j = 0; i + j <= STEPS; ++j, ++point) {
            for (int k = 0; k < 3; ++k)
                out[point][k] = (quad)a[k] * i + (quad)b[k] * j + (quad)c[k] * (STEPS - i - j);
        }
    }
}

/* The points that are in a box, as bits by index. */
static inline uint32_t points_inside(quad points[POINTS][3], const float lo[3], const float hi[3])
{
    uint32_t inside = 0;
    for (int p = 0; p < POINTS; ++p) {
        bool in = true;
        for (int k = 0; k < 3; ++k)
            in &= points[p][k] >= (quad)lo[k] * STEPS && points[p][k] <= (quad)hi[k] * STEPS;
        inside |= (uint32_t)in << p;
    }
    return inside;
}

/* Whether every point of each triangle is in one of the leaves that have the triangle, and no leaf
   has a triangle twice. */
static inline bool is_covered(const struct soup *soup, const struct bvh *bvh)
{
    own_memory uint32_t *seen = calloc(soup->count + 1, sizeof *seen);
    bool covered = seen != NULL;
    for (uint32_t i = 0; i < bvh->node_count && covered; ++i) {
        const struct gpu_bvh_node *node = &bvh->nodes[i];
        for (uint32_t k = 0; i != 1 && k < bvh_count(node); ++k) {
            quad points[POINTS][3];
            uint32_t triangle = bvh->order[node->first + k];
            triangle_points(soup, triangle, points);
            seen[triangle] |= points_inside(points, node->lo, node->hi);
            for (uint32_t other = 0; other < k; ++other)
                covered &= bvh->order[node->first + other] != triangle;
        }
    }
    for (uint32_t i = 0; i < soup->count && covered; ++i)
        covered = seen[i] == POINTS_ALL;
    return covered;
}

/* Describes what is wrong with a tree; NULL: nothing. */
static inline const char *find_fault(const struct soup *soup, const whit_accel_params *params,
                                     const struct bvh *bvh)
{
    uint32_t limit = params->leaf_limit ? params->leaf_limit : 4;
    uint32_t parts = bvh->reference_count - soup->count;
    double share = params->spatial_budget == 0.0f ? 0.5 : fmax((double)params->spatial_budget, 0.0);
    if (bvh_validate(&silent, bvh, soup->boxes, limit) != WHIT_OK)
        return messages.last_error;
    if (bvh->primitive_count != soup->count || bvh->depth >= BVH_DEPTH_MAX ||
        !isfinite(bvh->sah_cost))
        return "counts or costs out of range";
    if (bvh->reference_count < soup->count || bvh->clipped != (parts > 0) ||
        parts > (params->build == WHIT_BUILD_SPATIAL ? share * soup->count : 0.0))
        return "more parts than allowed";
    if (parts == 0 && soup->count > 0 && !is_whole(bvh, soup->boxes))
        return "boxes, depth or costs are not those of what is below";
    if (params->build == WHIT_BUILD_SPATIAL && !is_covered(soup, bvh))
        return "a part of a triangle is lost, or one is in a leaf twice";
    return NULL;
}

/* ---- Reinsertion ---- */

/* A digest of all leaf boxes and their primitives that does not depend on the order of leaves. */
static inline uint64_t leaves_digest(const struct bvh *bvh)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < bvh->node_count; ++i) {
        const struct gpu_bvh_node *node = &bvh->nodes[i];
        if (i == 1 || bvh_count(node) == 0)
            continue;
        uint64_t leaf = HASH_START;
        leaf = hash_bytes(leaf, node->lo, sizeof node->lo);
        leaf = hash_bytes(leaf, node->hi, sizeof node->hi);
        sum += hash_bytes(leaf, &bvh->order[node->first], bvh_count(node) * sizeof *bvh->order);
    }
    return sum;
}

/* Whether leaves are in the order of their records, and pairs of siblings in depth-first order. */
static inline bool is_depth_first(const struct bvh *bvh)
{
    uint32_t stack[BVH_DEPTH_MAX + 2] = {0}, top = 1, pair = 2, slot = 0;
    bool ordered = true;
    while (top > 0) {
        const struct gpu_bvh_node *node = &bvh->nodes[stack[--top]];
        ordered &= node->first == (bvh_count(node) > 0 ? slot : pair);
        if (bvh_count(node) > 0) {
            slot += bvh_count(node);
            continue;
        }
        pair += 2;
        stack[top++] = node->first + 1;
        stack[top++] = node->first;
    }
    return ordered && slot == bvh->reference_count;
}

/* Describes what is wrong with an optimized tree, which must have the leaves of the tree that it
   was made from; NULL: nothing. */
static inline const char *find_optimizing_fault(const struct soup *soup, whit_accel_params params,
                                                const struct bvh *better)
{
    const char *fault = NULL;
    params.optimize = false;
    own_bvh plain = soup_build(soup, params);
    if (better->sah_cost > plain.sah_cost)
        fault = "optimizing made it worse";
    else if (better->node_count != plain.node_count ||
             leaves_digest(better) != leaves_digest(&plain))
        fault = "optimizing changed the leaves";
    else if (better->sah_cost < plain.sah_cost && !is_depth_first(better))
        fault = "optimizing left another order of nodes";
    else if (better->sah_cost == plain.sah_cost &&
             !(trees_equal(better, &plain) && orders_equal(better, &plain)))
        fault = "optimizing changed the tree for nothing";
    return fault;
}

/* ---- Every way to build ---- */

static const whit_accel_params every_builder[] = {
    {.build = WHIT_BUILD_BINNED, .threads = 1},
    {.build = WHIT_BUILD_BINNED, .threads = 2, .leaf_limit = 1, .bins = 7},
    {.build = WHIT_BUILD_BINNED, .threads = 1, .leaf_limit = BVH_LEAF_MAX, .bins = 256},
    {.build = WHIT_BUILD_BINNED, .threads = 1, .leaf_limit = 2, .bins = 2},
    {.build = WHIT_BUILD_BINNED, .threads = 2, .leaf_limit = 1, .optimize = true},
    {.build = WHIT_BUILD_BINNED, .leaf_limit = BVH_LEAF_MAX, .bins = 2, .optimize = true},
    {.build = WHIT_BUILD_BINNED, .optimize = true},
    {.build = WHIT_BUILD_MEDIAN, .threads = 2},
    {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 1, .optimize = true},
    {.build = WHIT_BUILD_MEDIAN, .threads = 2, .optimize = true},
    {.build = WHIT_BUILD_MEDIAN, .leaf_limit = BVH_LEAF_MAX, .optimize = true},
    {.build = WHIT_BUILD_SWEEP, .threads = 2},
    {.build = WHIT_BUILD_SWEEP, .threads = 1, .leaf_limit = 1},
    {.build = WHIT_BUILD_SWEEP, .threads = 1, .leaf_limit = BVH_LEAF_MAX},
    {.build = WHIT_BUILD_SPATIAL, .threads = 2},
    {.build = WHIT_BUILD_SPATIAL, .threads = 1, .leaf_limit = 1, .spatial_alpha = 1e-9f},
    {.build = WHIT_BUILD_SPATIAL, .leaf_limit = 1, .spatial_alpha = 1e-9f, .spatial_budget = 2.0f},
    {.build = WHIT_BUILD_SPATIAL, .leaf_limit = BVH_LEAF_MAX, .spatial_budget = 0.03f},
    {.build = WHIT_BUILD_SPATIAL, .leaf_limit = 2, .spatial_budget = -1.0f},
    {.build = WHIT_BUILD_SPATIAL, .leaf_limit = 1, .optimize = true},
};
enum { EVERY_BUILDER = sizeof every_builder / sizeof *every_builder };
_Static_assert(WHIT_BUILD_NONE == 4, "every builder is in the list");

/* Checks all builders on the same triangles, which it releases. */
static inline void check_all(struct soup soup)
{
    for (size_t i = 0; i < EVERY_BUILDER; ++i) {
        const whit_accel_params *params = &every_builder[i];
        own_bvh bvh = soup_build(&soup, *params);
        const char *fault = find_fault(&soup, params, &bvh);
        if (!fault && params->optimize)
            fault = find_optimizing_fault(&soup, *params, &bvh);
        if (fault)
            fail_msg("%s, %u triangles, row %zu of every_builder: %s", soup.name, soup.count, i,
                     fault);
    }
    soup_finish(&soup);
}

#endif
