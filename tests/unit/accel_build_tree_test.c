/* Trees over boxes that builders get wrong, the same tree for any number of threads, and a
   validator that refuses every way of breaking one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdalign.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"

static const struct log silent;

static uint64_t random_state;

/* splitmix64 */
static uint32_t random_bits(void)
{
    random_state += 0x9e3779b97f4a7c15u;
    uint64_t z = random_state;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return (uint32_t)(z >> 32);
}

static float random_float(void)
{
    return (float)(random_bits() >> 8) * 0x1p-24f;
}

static struct bvh_box *boxes_alloc(uint32_t count)
{
    struct bvh_box *boxes = calloc(count ? count : 1, sizeof *boxes);
    assert_non_null(boxes);
    return boxes;
}

/* Of three random corners around a random centre. */
static struct bvh_box *soup(uint32_t count, float size)
{
    struct bvh_box *boxes = boxes_alloc(count);
    for (uint32_t i = 0; i < count; ++i) {
        for (int a = 0; a < 3; ++a) {
            float centre = random_float();
            boxes[i].lo[a] = FLT_MAX, boxes[i].hi[a] = -FLT_MAX;
            for (int k = 0; k < 3; ++k) {
                float x = centre + size * (random_float() - 0.5f);
                boxes[i].lo[a] = fminf(boxes[i].lo[a], x);
                boxes[i].hi[a] = fmaxf(boxes[i].hi[a], x);
            }
        }
    }
    return boxes;
}

static bool boxes_equal(const struct gpu_bvh_node *node, const struct bvh_box *box)
{
    bool equal = true;
    for (int a = 0; a < 3; ++a)
        equal &= node->lo[a] == box->lo[a] && node->hi[a] == box->hi[a];
    return equal;
}

static void box_unite(struct bvh_box *a, const float lo[3], const float hi[3])
{
    for (int i = 0; i < 3; ++i) {
        a->lo[i] = fminf(a->lo[i], lo[i]);
        a->hi[i] = fmaxf(a->hi[i], hi[i]);
    }
}

struct found {
    uint32_t depth, leaves;
    double cost; /* not yet divided by the root's area */
};

static double area(const struct gpu_bvh_node *n)
{
    double x = (double)n->hi[0] - (double)n->lo[0], y = (double)n->hi[1] - (double)n->lo[1],
           z = (double)n->hi[2] - (double)n->lo[2];
    return x * y + y * z + z * x;
}

/* Every box is exactly the union of what is below; depth and cost are counted on the way. */
static void walk_exact(const struct bvh *bvh, const struct bvh_box *boxes, uint32_t index,
                       uint32_t depth, struct found *found)
{
    const struct gpu_bvh_node *node = &bvh->nodes[index];
    struct bvh_box sum = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    if (bvh_count(node) > 0) {
        for (uint32_t i = 0; i < bvh_count(node); ++i) {
            const struct bvh_box *box = &boxes[bvh->order[node->first + i]];
            box_unite(&sum, box->lo, box->hi);
        }
        found->depth = depth > found->depth ? depth : found->depth;
        found->cost += area(node) * bvh_count(node);
        ++found->leaves;
    } else {
        const struct gpu_bvh_node *pair = &bvh->nodes[node->first];
        box_unite(&sum, pair[0].lo, pair[0].hi);
        box_unite(&sum, pair[1].lo, pair[1].hi);
        found->cost += area(node);
        walk_exact(bvh, boxes, node->first, depth + 1, found);
        walk_exact(bvh, boxes, node->first + 1, depth + 1, found);
    }
    assert_true(boxes_equal(node, &sum));
}

static void build_and_check(const struct bvh_box *boxes, uint32_t count,
                            const struct bvh_params *params, struct bvh *bvh)
{
    uint32_t limit = params && params->leaf_limit ? params->leaf_limit : 4;
    assert_int_equal(bvh_build(&silent, boxes, count, params, bvh), WHIT_OK);
    assert_int_equal(bvh_validate(&silent, bvh, boxes, limit), WHIT_OK);
    assert_int_equal(bvh->primitive_count, count);
    assert_true(bvh->leaf_largest <= limit);
    assert_true(isfinite(bvh->sah_cost));
    assert_true(bvh->depth < 128);
    if (count == 0)
        return;
    struct found found = {0};
    walk_exact(bvh, boxes, 0, 0, &found);
    assert_int_equal(found.depth, bvh->depth);
    assert_int_equal(found.leaves, bvh->leaf_count);
    double root = area(&bvh->nodes[0]);
    if (root > 0.0)
        assert_true(fabs(found.cost / root - bvh->sah_cost) <= 1e-9 * bvh->sah_cost);
}

/* Both builders, several leaf limits and bin counts. */
static void check_all(const struct bvh_box *boxes, uint32_t count)
{
    static const struct bvh_params params[] = {
        {.thread_count = 1},
        {.thread_count = 2, .leaf_limit = 1, .bins = 7},
        {.thread_count = 1, .leaf_limit = BVH_LEAF_MAX, .bins = 256},
        {.thread_count = 1, .leaf_limit = 2, .bins = 2},
        {.thread_count = 2, .builder = BVH_MEDIAN},
    };
    for (size_t i = 0; i < sizeof params / sizeof *params; ++i) {
        struct bvh bvh;
        build_and_check(boxes, count, &params[i], &bvh);
        bvh_finish(&bvh);
    }
}

static void soups_of_all_sizes(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 3, 4, 5, 7, 8, 9, 31, 100, 1000, 2049, 5000};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
        random_state = i;
        struct bvh_box *boxes = soup(counts[i], 0.1f);
        check_all(boxes, counts[i]);
        free(boxes);
    }
}

static void nothing_is_a_tree_too(void **state)
{
    (void)state;
    struct bvh bvh;
    build_and_check(NULL, 0, NULL, &bvh);
    assert_int_equal(bvh.node_count, 0);
    bvh_finish(&bvh);
}

static void one_box_is_a_leaf_at_the_root(void **state)
{
    (void)state;
    struct bvh_box box = {{-1, -2, -3}, {1, 2, 3}};
    struct bvh bvh;
    build_and_check(&box, 1, NULL, &bvh);
    assert_int_equal(bvh.node_count, 2);
    assert_int_equal(bvh.depth, 0);
    assert_int_equal(bvh_count(&bvh.nodes[0]), 1);
    bvh_finish(&bvh);
}

static void identical_boxes(void **state)
{
    (void)state;
    enum { COUNT = 10000 };
    struct bvh_box *boxes = boxes_alloc(COUNT);
    for (uint32_t i = 0; i < COUNT; ++i)
        boxes[i] = (struct bvh_box){{1, 2, 3}, {4, 5, 6}};
    check_all(boxes, COUNT);
    memset(boxes, 0, COUNT * sizeof *boxes); /* points at the origin */
    check_all(boxes, COUNT);
    free(boxes);
}

static void nested_with_one_centre(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    struct bvh_box *boxes = boxes_alloc(COUNT);
    for (uint32_t i = 0; i < COUNT; ++i) {
        float r = (float)(i + 1);
        boxes[i] = (struct bvh_box){{-r, -r, -r}, {r, r, r}};
    }
    check_all(boxes, COUNT);
    free(boxes);
}

static void on_a_line_and_in_a_plane(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    struct bvh_box *boxes = boxes_alloc(COUNT);
    for (int axes = 1; axes <= 2; ++axes) {
        for (uint32_t i = 0; i < COUNT; ++i) {
            for (int a = 0; a < 3; ++a) {
                float x = a < axes ? random_float() : 0.25f;
                boxes[i].lo[a] = x;
                boxes[i].hi[a] = a < axes ? x + 0.01f : x;
            }
        }
        check_all(boxes, COUNT);
    }
    free(boxes);
}

/* Sizes and places by powers of `ratio` over 2^-60 to 2^60. */
static void exponential_scales(void **state)
{
    (void)state;
    static const double ratios[] = {2.0, 1.3, 1.01};
    for (size_t k = 0; k < 3; ++k) {
        uint32_t count = (uint32_t)(120.0 / log2(ratios[k]));
        struct bvh_box *boxes = boxes_alloc(count);
        for (uint32_t i = 0; i < count; ++i) {
            float at = (float)(0x1p-60 * pow(ratios[k], i));
            boxes[i] = (struct bvh_box){{at, at, at}, {1.1f * at, 1.2f * at, 1.3f * at}};
        }
        check_all(boxes, count);
        free(boxes);
    }
}

/* Two bins halve the extent, so each split takes off one box: deeper than any stack but for the
   medians. */
static void depth_is_capped(void **state)
{
    (void)state;
    enum { COUNT = 230 };
    struct bvh_box *boxes = boxes_alloc(COUNT);
    for (uint32_t i = 0; i < COUNT; ++i) {
        float at = (float)ldexp(1.0, (int)i - 112);
        boxes[i] = (struct bvh_box){{at, 0, 0}, {1.5f * at, 1.5f * at, 1.5f * at}};
    }
    struct bvh bvh;
    build_and_check(boxes, COUNT, &(struct bvh_params){.bins = 2, .leaf_limit = 1}, &bvh);
    assert_in_range(bvh.depth, 97, 127);
    bvh_finish(&bvh);
    free(boxes);
}

static void one_giant_and_many_tiny(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    struct bvh_box *boxes = soup(COUNT, 1e-4f);
    boxes[COUNT / 2] = (struct bvh_box){{-1e18f, -1e18f, -1e18f}, {1e18f, 1e18f, 1e18f}};
    boxes[COUNT / 3] = (struct bvh_box){{9e17f, 9e17f, 9e17f}, {1e18f, 1e18f, 1e18f}};
    check_all(boxes, COUNT);
    free(boxes);
}

/* Any finite bits, up to the largest float: extents overflow, areas overflow, denormals vanish. */
static void garbage_bits(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 100; ++round) {
        random_state = 1000 + round;
        uint32_t count = 1 + random_bits() % 300;
        struct bvh_box *boxes = boxes_alloc(count);
        for (uint32_t i = 0; i < count; ++i) {
            for (int a = 0; a < 3; ++a) {
                float x[2];
                for (int k = 0; k < 2; ++k) {
                    uint32_t bits;
                    do {
                        bits = random_bits();
                        memcpy(&x[k], &bits, sizeof bits);
                    } while (!isfinite(x[k]));
                }
                boxes[i].lo[a] = fminf(x[0], x[1]);
                boxes[i].hi[a] = fmaxf(x[0], x[1]);
            }
        }
        check_all(boxes, count);
        free(boxes);
    }
}

/* Extents whose reciprocal is infinite, and planes that rounding puts beside a centroid. */
static void extents_at_the_edge_of_floats(void **state)
{
    (void)state;
    static const float steps[] = {0x1p-149f, 0x1p-130f, 0x1p-118f, 0x1p-23f};
    static const float embree[] = {-6.4000024f, 25.6f, 57.6000022f};
    for (size_t s = 0; s < 4; ++s) {
        struct bvh_box boxes[64];
        for (uint32_t i = 0; i < 64; ++i) {
            for (int a = 0; a < 3; ++a) {
                float x = (s == 3 ? 1.0f : 0.0f) + steps[s] * (float)(i * ((uint32_t)a + 1) % 64);
                boxes[i].lo[a] = boxes[i].hi[a] = x;
            }
        }
        check_all(boxes, 64);
    }
    struct bvh_box boxes[300];
    for (uint32_t i = 0; i < 300; ++i) {
        for (int a = 0; a < 3; ++a) {
            float x = embree[(i + (uint32_t)a) % 3], y = embree[i * 7 / 3 % 3];
            boxes[i].lo[a] = fminf(x, y);
            boxes[i].hi[a] = fmaxf(x, y);
        }
    }
    check_all(boxes, 300);
}

static void same_bytes_for_any_thread_count(void **state)
{
    (void)state;
    enum { COUNT = 40000 };
    random_state = 7;
    struct bvh_box *boxes = soup(COUNT, 0.02f);
    for (uint32_t i = 0; i < COUNT / 4; ++i) /* a heap that needs medians, and both zeros */
        boxes[i * 4] = (struct bvh_box){{-0.0f, 0.0f, -0.0f}, {0.0f, -0.0f, 1.0f}};
    for (int builder = 0; builder < 2; ++builder) {
        struct bvh one, other;
        struct bvh_params params = {.thread_count = 1, .builder = (enum bvh_builder)builder};
        build_and_check(boxes, COUNT, &params, &one);
        for (uint32_t threads = 2; threads <= 7; ++threads) {
            params.thread_count = threads;
            assert_int_equal(bvh_build(&silent, boxes, COUNT, &params, &other), WHIT_OK);
            assert_int_equal(other.node_count, one.node_count);
            assert_memory_equal(other.nodes, one.nodes, one.node_count * sizeof *one.nodes);
            assert_memory_equal(other.order, one.order, COUNT * sizeof *one.order);
            assert_int_equal(other.depth, one.depth);
            assert_true(other.sah_cost == one.sah_cost);
            bvh_finish(&other);
        }
        bvh_finish(&one);
    }
    free(boxes);
}

/* Planes depend on the set of boxes alone. Only equal centroids are told apart by index. */
static void same_tree_for_any_order(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    random_state = 8;
    struct bvh_box *boxes = soup(COUNT, 0.05f);
    for (uint32_t i = 0; i < COUNT; ++i) { /* both zeros */
        boxes[i].lo[2] = i % 2 ? 0.0f : -0.0f;
        boxes[i].hi[2] = 0.01f + fabsf(boxes[i].hi[2]);
    }
    struct bvh first, second;
    build_and_check(boxes, COUNT, NULL, &first);
    for (uint32_t i = COUNT - 1; i > 0; --i) {
        uint32_t j = random_bits() % (i + 1);
        struct bvh_box moved = boxes[i];
        boxes[i] = boxes[j];
        boxes[j] = moved;
    }
    build_and_check(boxes, COUNT, NULL, &second);
    assert_int_equal(first.node_count, second.node_count);
    assert_true(first.sah_cost == second.sah_cost);
    assert_memory_equal(first.nodes, second.nodes, first.node_count * sizeof *first.nodes);
    bvh_finish(&first);
    bvh_finish(&second);
    free(boxes);
}

/* Points in ten heaps on a line, shuffled: what is left of a median is not right of it. */
static void medians_separate(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    random_state = 13;
    struct bvh_box boxes[COUNT];
    for (uint32_t i = 0; i < COUNT; ++i) {
        float x = (float)(random_bits() % 10);
        boxes[i] = (struct bvh_box){{x, 0, 0}, {x, 0, 0}};
    }
    struct bvh bvh;
    struct bvh_params params = {.builder = BVH_MEDIAN, .leaf_limit = 1};
    build_and_check(boxes, COUNT, &params, &bvh);
    assert_int_equal(bvh.depth, 8);
    for (uint32_t i = 2; i < bvh.node_count; i += 2)
        assert_true(bvh.nodes[i].hi[0] <= bvh.nodes[i + 1].lo[0]);
    bvh_finish(&bvh);
}

static void sah_is_better_than_medians(void **state)
{
    (void)state;
    enum { COUNT = 5000 };
    random_state = 9;
    struct bvh_box *boxes = soup(COUNT, 0.02f);
    for (uint32_t i = 0; i < COUNT; i += 2) { /* uneven density */
        for (int a = 0; a < 3; ++a) {
            boxes[i].lo[a] = 0.01f * boxes[i].lo[a];
            boxes[i].hi[a] = 0.01f * boxes[i].hi[a];
        }
    }
    struct bvh binned, median;
    build_and_check(boxes, COUNT, &(struct bvh_params){.builder = BVH_BINNED}, &binned);
    build_and_check(boxes, COUNT, &(struct bvh_params){.builder = BVH_MEDIAN}, &median);
    assert_true(binned.sah_cost < 0.9 * median.sah_cost);
    bvh_finish(&binned);
    bvh_finish(&median);
    free(boxes);
}

static void bad_input_is_refused(void **state)
{
    (void)state;
    struct bvh bvh;
    struct bvh_box boxes[3] = {{{0, 0, 0}, {1, 1, 1}}, {{2, 2, 2}, {3, 3, 3}}, {{0}, {0}}};
    const float bad[] = {NAN, INFINITY, -INFINITY, 4.0f};
    for (int k = 0; k < 4; ++k) {
        boxes[1].lo[1] = bad[k];
        assert_int_equal(bvh_build(&silent, boxes, 3, NULL, &bvh), WHIT_ERROR_INPUT);
        assert_null(bvh.nodes);
    }
    boxes[1].lo[1] = 2.0f;
    static const struct bvh_params params[] = {
        {.bins = 1}, {.bins = 257}, {.leaf_limit = 16}, {.traversal_cost = -1.0f}};
    for (int k = 0; k < 4; ++k)
        assert_int_equal(bvh_build(&silent, boxes, 3, &params[k], &bvh), WHIT_ERROR_USAGE);
}

/* ---- Broken trees ---- */

/* Each way must be refused for its own reason. */
struct breakage {
    const char *name;
    void (*apply)(struct bvh *bvh);
    const char *reason;
};

static void keep_message(void *user, whit_log_level level, const char *message)
{
    assert_int_equal(level, WHIT_LOG_ERROR);
    strncat(user, message, 200);
}

static uint32_t find_node(const struct bvh *bvh, bool leaf)
{
    for (uint32_t i = 2; i < bvh->node_count; ++i) {
        if ((bvh_count(&bvh->nodes[i]) > 0) == leaf)
            return i;
    }
    fail();
    return 0;
}

static void break_none(struct bvh *b)
{
    (void)b;
}
static void break_children_swapped(struct bvh *b)
{
    /* Another inner node's children. */
    b->nodes[find_node(b, false)].first = b->nodes[0].first;
}
static void break_parent_shrunk(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, false)];
    n->hi[1] = nextafterf(n->hi[1], -INFINITY);
}
static void break_leaf_shrunk(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, true)];
    n->lo[2] = nextafterf(n->lo[2], INFINITY);
}
static void break_duplicate(struct bvh *b)
{
    b->order[0] = b->order[1];
}
static void break_primitive_range(struct bvh *b)
{
    b->order[3] = b->primitive_count;
}
static void break_cycle(struct bvh *b)
{
    b->nodes[b->nodes[0].first] = b->nodes[0];
}
/* A cycle that never meets a leaf. */
static void break_cycle_of_inner(struct bvh *b)
{
    b->nodes[b->nodes[0].first] = b->nodes[b->nodes[0].first + 1] = b->nodes[0];
}
static void break_child_range(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = b->node_count;
}
static void break_child_huge(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = 0xfffffffeu;
}
static void break_child_root(struct bvh *b)
{
    b->nodes[find_node(b, false)].first = 0;
}
static void break_child_odd(struct bvh *b)
{
    ++b->nodes[0].first;
}
static void break_leaf_range(struct bvh *b)
{
    b->nodes[find_node(b, true)].first = b->primitive_count;
}
static void break_leaf_huge(struct bvh *b)
{
    b->nodes[find_node(b, true)].first = 0xfffffffeu;
}
static void break_count_bits(struct bvh *b)
{
    b->nodes[find_node(b, true)].count = 0xfffffff0u;
}
static void break_count_high(struct bvh *b)
{
    b->nodes[2].count |= 128u;
}
static void break_root_bits(struct bvh *b)
{
    b->nodes[0].count |= 1u << BVH_AXIS_SHIFT;
}
static void break_second_bits(struct bvh *b)
{
    b->nodes[3].count |= BVH_SECOND_LOW;
}
static void break_axis(struct bvh *b)
{
    uint32_t *count = &b->nodes[2].count;
    uint32_t axis = *count >> BVH_AXIS_SHIFT & BVH_AXIS_MASK;
    *count ^= (axis ^ (axis + 1) % 3) << BVH_AXIS_SHIFT;
}
static void break_axis_three(struct bvh *b)
{
    b->nodes[2].count |= BVH_AXIS_MASK << BVH_AXIS_SHIFT;
}
static void break_axis_sign(struct bvh *b)
{
    b->nodes[2].count ^= BVH_SECOND_LOW;
}
static void break_leaf_over_limit(struct bvh *b)
{
    b->nodes[find_node(b, true)].count = 5;
}
static void break_leaf_overlap(struct bvh *b)
{
    struct gpu_bvh_node *n = &b->nodes[find_node(b, true)];
    n->first = n->first > 0 ? n->first - 1 : n->first + 1;
}
static void break_leaf_lost(struct bvh *b)
{
    for (uint32_t i = 0; i < b->node_count; ++i) {
        if (bvh_count(&b->nodes[i]) > 1) {
            --b->nodes[i].count;
            return;
        }
    }
    fail();
}
static void break_orphans(struct bvh *b)
{
    b->node_count -= 2;
}
static void break_unreached(struct bvh *b)
{
    /* Two leaves under one node become one leaf. */
    for (uint32_t i = 2; i < b->node_count; ++i) {
        struct gpu_bvh_node *n = &b->nodes[i];
        const struct gpu_bvh_node *pair = &b->nodes[n->first];
        if (bvh_count(n) == 0 && bvh_count(&pair[0]) > 0 && bvh_count(&pair[1]) > 0 &&
            bvh_count(&pair[0]) + bvh_count(&pair[1]) <= 4) {
            n->count += bvh_count(&pair[0]) + bvh_count(&pair[1]);
            n->first = pair[0].first;
            return;
        }
    }
    fail();
}
static void break_odd_count(struct bvh *b)
{
    ++b->node_count;
}
static void break_nan(struct bvh *b)
{
    b->nodes[0].lo[0] = NAN;
}
static void break_infinite(struct bvh *b)
{
    b->nodes[0].hi[0] = INFINITY;
}
static void break_depth(struct bvh *b)
{
    ++b->depth;
}
static void break_leaf_count_stated(struct bvh *b)
{
    --b->leaf_count;
}
static void break_largest_stated(struct bvh *b)
{
    ++b->leaf_largest;
}
static void break_empty(struct bvh *b)
{
    b->node_count = 0;
}

static void broken_trees_are_refused(void **state)
{
    (void)state;
#define ROW(fn, reason)                                                                            \
    {                                                                                              \
#fn, fn, reason                                                                            \
    }
    static const struct breakage rows[] = {
        ROW(break_children_swapped, "two parents"),
        ROW(break_parent_shrunk, "a child is not inside"),
        ROW(break_leaf_shrunk, "does not contain its primitive"),
        ROW(break_duplicate, "twice"),
        ROW(break_primitive_range, "names a primitive out of range"),
        ROW(break_cycle, "two parents"),
        ROW(break_cycle_of_inner, "two parents"),
        ROW(break_child_range, "children out of range"),
        ROW(break_child_huge, "children out of range"),
        ROW(break_child_root, "children out of range"),
        ROW(break_child_odd, "do not start at an even"),
        ROW(break_leaf_range, "reaches out of range"),
        ROW(break_leaf_huge, "reaches out of range"),
        ROW(break_count_bits, "stray bits"),
        ROW(break_count_high, "stray bits"),
        ROW(break_root_bits, "stray bits"),
        ROW(break_second_bits, "stray bits"),
        ROW(break_axis, "the axis is not"),
        ROW(break_axis_three, "the axis is not"),
        ROW(break_axis_sign, "the axis is not"),
        ROW(break_leaf_over_limit, "over the limit"),
        ROW(break_leaf_overlap, "share a record"),
        ROW(break_leaf_lost, "primitives are missing"),
        ROW(break_orphans, "children out of range"),
        ROW(break_unreached, "not reached"),
        ROW(break_odd_count, "aligned pairs"),
        ROW(break_nan, "not finite"),
        ROW(break_infinite, "not finite"),
        ROW(break_depth, "stated depth"),
        ROW(break_leaf_count_stated, "stated number of leaves"),
        ROW(break_largest_stated, "stated largest leaf"),
        ROW(break_empty, "no nodes for primitives"),
    };
#undef ROW
    random_state = 11;
    struct bvh_box *boxes = soup(500, 0.1f);
    for (size_t i = 0; i <= sizeof rows / sizeof *rows; ++i) {
        struct bvh bvh;
        build_and_check(boxes, 500, NULL, &bvh);
        void (*apply)(struct bvh *) = i == 0 ? break_none : rows[i - 1].apply;
        apply(&bvh);
        char said[201] = "";
        struct log log = {keep_message, said, WHIT_LOG_ERROR};
        whit_result result = bvh_validate(&log, &bvh, boxes, 4);
        assert_int_equal(result, i == 0 ? WHIT_OK : WHIT_ERROR_FAILED);
        if (i > 0 && !strstr(said, rows[i - 1].reason))
            fail_msg("%s: said `%s`", rows[i - 1].name, said);
        bvh_finish(&bvh);
    }
    free(boxes);
}

/* ---- Split primitives ---- */

/* Box 0 along x is split at 2 between two leaves, which boxes 1 and 2 share with it. */
struct split_tree {
    alignas(64) struct gpu_bvh_node nodes[4];
    struct bvh_box boxes[3];
    uint32_t order[4];
    struct bvh bvh;
};

static void split_tree_init(struct split_tree *tree)
{
    *tree = (struct split_tree){
        .nodes = {{{0, 0, 0}, 2, {4, 1, 1}, 0},
                  {{0}, 0, {0}, 0},
                  {{0, 0, 0}, 0, {2, 1, 1}, 2},
                  {{2, 0, 0}, 2, {4, 1, 1}, 2}},
        .boxes = {{{0, 0, 0}, {4, 1, 1}}, {{0, 0, 0}, {1, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}},
        .order = {0, 1, 0, 2},
        .bvh = {.node_count = 4, .primitive_count = 3, .reference_count = 4, .clipped = true},
    };
    tree->bvh.nodes = tree->nodes;
    tree->bvh.order = tree->order;
    bvh_complete(&tree->bvh, 1.0);
}

static void split_tree_said(const struct split_tree *tree, const char *reason)
{
    char said[201] = "";
    struct log log = {keep_message, said, WHIT_LOG_ERROR};
    whit_result result = bvh_validate(&log, &tree->bvh, tree->boxes, 4);
    assert_int_equal(result, reason ? WHIT_ERROR_FAILED : WHIT_OK);
    if (reason && !strstr(said, reason))
        fail_msg("expected `%s`, said `%s`", reason, said);
}

static void split_primitives_must_be_covered(void **state)
{
    (void)state;
    struct split_tree tree;
    split_tree_init(&tree);
    split_tree_said(&tree, NULL);
    tree.order[1] = 0;
    split_tree_said(&tree, "in a leaf twice");
    tree.order[1] = 2;
    split_tree_said(&tree, "holds nothing of its primitive");
    split_tree_init(&tree);
    tree.boxes[0].hi[1] = 2.0f;
    split_tree_said(&tree, "do not cover it");
    split_tree_init(&tree);
    tree.nodes[3].count = 1;
    split_tree_said(&tree, "primitives are missing");
    tree.order[2] = 2;
    split_tree_said(&tree, "records are in no leaf");
    split_tree_init(&tree);
    tree.bvh.reference_count = 3;
    split_tree_said(&tree, "reaches out of range");
    split_tree_init(&tree);
    tree.bvh.primitive_count = 4; /* as if none were split */
    split_tree_said(&tree, "does not contain its primitive");
}

/* Whatever bytes stand in the arrays, the validator ends and reads nothing outside. */
static void validator_survives_any_bytes(void **state)
{
    (void)state;
    random_state = 12;
    struct bvh_box *boxes = soup(200, 0.1f);
    uint32_t accepted = 0;
    for (int round = 0; round < 5000; ++round) {
        struct bvh bvh;
        assert_int_equal(bvh_build(&silent, boxes, 200, NULL, &bvh), WHIT_OK);
        uint32_t flips = 1 + random_bits() % 4;
        for (uint32_t k = 0; k < flips; ++k) {
            uint8_t *bytes = random_bits() % 8 ? (uint8_t *)bvh.nodes : (uint8_t *)bvh.order;
            size_t size = bytes == (uint8_t *)bvh.order ? 200 * sizeof *bvh.order
                                                        : bvh.node_count * sizeof *bvh.nodes;
            bytes[random_bits() % size] = (uint8_t)random_bits();
        }
        accepted += bvh_validate(&silent, &bvh, NULL, 4) == WHIT_OK;
        bvh_finish(&bvh);
    }
    assert_true(accepted < 2500); /* widened boxes and the unused node are no faults */
    free(boxes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(soups_of_all_sizes),
        cmocka_unit_test(nothing_is_a_tree_too),
        cmocka_unit_test(one_box_is_a_leaf_at_the_root),
        cmocka_unit_test(identical_boxes),
        cmocka_unit_test(nested_with_one_centre),
        cmocka_unit_test(on_a_line_and_in_a_plane),
        cmocka_unit_test(exponential_scales),
        cmocka_unit_test(depth_is_capped),
        cmocka_unit_test(one_giant_and_many_tiny),
        cmocka_unit_test(garbage_bits),
        cmocka_unit_test(extents_at_the_edge_of_floats),
        cmocka_unit_test(same_bytes_for_any_thread_count),
        cmocka_unit_test(same_tree_for_any_order),
        cmocka_unit_test(medians_separate),
        cmocka_unit_test(sah_is_better_than_medians),
        cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(broken_trees_are_refused),
        cmocka_unit_test(split_primitives_must_be_covered),
        cmocka_unit_test(validator_survives_any_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
