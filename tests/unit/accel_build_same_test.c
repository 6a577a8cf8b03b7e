/* The same tree whatever the number of threads and the order of the input; the sweep finds the
   splits of a quadratic search. */
#include "../cases.h"
#include "accel_boxes_fixture.h"

static void assert_same_tree(const struct bvh *a, const struct bvh *b)
{
    assert_int_equal(a->node_count, b->node_count);
    assert_memory_equal(a->nodes, b->nodes, a->node_count * sizeof *a->nodes);
    assert_int_equal(a->depth, b->depth);
    assert_true(a->sah_cost == b->sah_cost);
}

/* Also a heap that needs medians, and both zeros. */
static struct bvh_box *soup_with_heap(uint32_t count)
{
    random_state = 7;
    struct bvh_box *boxes = soup(count, 0.02f);
    for (uint32_t i = 0; i < count / 4; ++i)
        boxes[i * 4] = (struct bvh_box){{-0.0f, 0.0f, -0.0f}, {0.0f, -0.0f, 1.0f}};
    return boxes;
}

static void same_bytes_for_any_thread_count(void **state)
{
    (void)state;
    for (size_t i = 0; i < EVERY_BUILDER; ++i) {
        struct bvh_params params = every_builder[i];
        /* The first tree has so many nodes that several threads complete it. */
        uint32_t count = i == 0 ? 40000 : cases_of(40000);
        struct bvh_box *boxes = soup_with_heap(count);
        struct bvh_triangles triangles = triangles_of_boxes(boxes, count);
        struct bvh one, other;
        params.triangles = &triangles;
        params.thread_count = 1;
        build_and_check(boxes, count, &params, &one);
        for (uint32_t threads = 2; threads <= 5; ++threads) {
            params.thread_count = threads;
            assert_int_equal(bvh_build(&silent, boxes, count, &params, &other), WHIT_OK);
            assert_same_tree(&one, &other);
            assert_int_equal(other.reference_count, one.reference_count);
            assert_memory_equal(other.order, one.order, one.reference_count * sizeof *one.order);
            bvh_finish(&other);
        }
        bvh_finish(&one);
        triangles_free(&triangles);
        free(boxes);
    }
}

/* Cells of a grid: every centroid is met many times on each axis, but no two boxes have the same.
 */
static struct bvh_box *grid(uint32_t side)
{
    struct bvh_box *boxes = boxes_alloc(side * side * side);
    for (uint32_t i = 0; i < side * side * side; ++i) {
        const uint32_t at[3] = {i % side, i / side % side, i / side / side};
        for (int a = 0; a < 3; ++a) {
            boxes[i].lo[a] = (float)at[a] - 0.5f;
            boxes[i].hi[a] = (float)at[a] + (a == 1 ? 3.5f : 0.5f);
        }
    }
    return boxes;
}

static void shuffle(struct bvh_box *boxes, uint32_t count)
{
    for (uint32_t i = count - 1; i > 0; --i) {
        uint32_t j = random_below(&random_state, i + 1);
        struct bvh_box moved = boxes[i];
        boxes[i] = boxes[j];
        boxes[j] = moved;
    }
}

/* Planes depend on the set of boxes alone, and what they do not part is told apart by index only
   where all three centroids agree. */
static void same_tree_for_any_order(void **state)
{
    (void)state;
    static const struct bvh_params params[] = {
        {.builder = BVH_BINNED}, {.builder = BVH_BINNED, .bins = 7}, {.builder = BVH_SWEEP}};
    enum { BUILDS = sizeof params / sizeof *params };
    for (uint32_t k = 0; k < 2 * BUILDS; ++k) {
        random_state = 8;
        uint32_t count = k < BUILDS ? 2500 : 13 * 13 * 13;
        struct bvh_box *boxes = k < BUILDS ? soup(count, 0.05f) : grid(13);
        for (uint32_t i = 0; k < BUILDS && i < count; ++i) { /* both zeros */
            boxes[i].lo[2] = i % 2 ? 0.0f : -0.0f;
            boxes[i].hi[2] = 0.01f + fabsf(boxes[i].hi[2]);
        }
        struct bvh first, second;
        build_and_check(boxes, count, &params[k % BUILDS], &first);
        shuffle(boxes, count);
        build_and_check(boxes, count, &params[k % BUILDS], &second);
        assert_same_tree(&first, &second);
        bvh_finish(&first);
        bvh_finish(&second);
        free(boxes);
    }
}

/* ---- Every position ---- */

static double area_of(const struct bvh_box *box)
{
    double x = (double)box->hi[0] - box->lo[0], y = (double)box->hi[1] - box->lo[1],
           z = (double)box->hi[2] - box->lo[2];
    return x * y + y * z + z * x;
}

static float centroid_of(const struct bvh_box *box, uint32_t axis)
{
    return box->lo[axis] * 0.25f + box->hi[axis] * 0.25f;
}

/* Primitives below `node`, written to `out`: how many. */
static uint32_t gather(const struct bvh *bvh, const struct gpu_bvh_node *node, uint32_t *out)
{
    uint32_t count = bvh_count(node);
    if (count > 0) {
        memcpy(out, bvh->order + node->first, count * sizeof *out);
        return count;
    }
    count = gather(bvh, &bvh->nodes[node->first], out);
    return count + gather(bvh, &bvh->nodes[node->first + 1], out + count);
}

/* What it costs to split the primitives before `plane`; infinity where a side is empty. */
static double split_cost(const struct bvh_box *boxes, const uint32_t *primitives, uint32_t count,
                         uint32_t axis, float plane)
{
    struct bvh_box sides[2];
    sides[0] = sides[1] =
        (struct bvh_box){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    uint32_t counts[2] = {0};
    for (uint32_t i = 0; i < count; ++i) {
        const struct bvh_box *box = &boxes[primitives[i]];
        int side = centroid_of(box, axis) >= plane;
        box_unite(&sides[side], box->lo, box->hi);
        ++counts[side];
    }
    if (counts[0] == 0)
        return INFINITY;
    return area_of(&sides[0]) * counts[0] + area_of(&sides[1]) * counts[1];
}

/* The least cost of all splits of three axes, each summed up anew: quadratic. */
static double min_cost(const struct bvh_box *boxes, const uint32_t *primitives, uint32_t count)
{
    double min = INFINITY;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        for (uint32_t i = 0; i < count; ++i) {
            float plane = centroid_of(&boxes[primitives[i]], axis);
            min = fmin(min, split_cost(boxes, primitives, count, axis, plane));
        }
    }
    return min;
}

/* Inner nodes whose split was compared. */
static uint32_t check_splits(const struct bvh *bvh, const struct bvh_box *boxes,
                             const struct gpu_bvh_node *node)
{
    if (bvh_count(node) > 0)
        return 0;
    const struct gpu_bvh_node *pair = &bvh->nodes[node->first];
    uint32_t *primitives = malloc(bvh->primitive_count * sizeof *primitives), counts[2];
    assert_non_null(primitives);
    double cost = 0.0;
    for (int side = 0; side < 2; ++side) {
        counts[side] = gather(bvh, &pair[side], primitives);
        cost += area(&pair[side]) * counts[side];
    }
    gather(bvh, node, primitives);
    double min = min_cost(boxes, primitives, counts[0] + counts[1]);
    free(primitives);
    /* The builder's costs are floats; equal centroids on all axes are halved by their order. */
    if (min < INFINITY)
        assert_true(cost <= min * (1.0 + 1e-5));
    return (min < INFINITY) + check_splits(bvh, boxes, &pair[0]) +
           check_splits(bvh, boxes, &pair[1]);
}

static void sweep_finds_the_splits_of_the_quadratic_search(void **state)
{
    (void)state;
    static const uint32_t counts[] = {2, 3, 5, 16, 33, 64, 65, 200, 700};
    uint32_t compared = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; ++i) {
        random_state = 100 + i;
        uint32_t count = counts[i];
        struct bvh_box *all[] = {soup(count, count > 500 ? 0.03f : 0.3f), soup(count, 0.3f)};
        for (uint32_t k = 0; k < count; k += 2) /* equal centroids, other sizes */
            all[1][k] = (struct bvh_box){{-(float)(k % 40), 0, 0}, {(float)(k % 40), 1, 0}};
        for (int kind = 0; kind < 2; ++kind) {
            struct bvh bvh;
            build_and_check(all[kind], count,
                            &(struct bvh_params){.builder = BVH_SWEEP, .leaf_limit = 1}, &bvh);
            compared += check_splits(&bvh, all[kind], &bvh.nodes[0]);
            bvh_finish(&bvh);
            free(all[kind]);
        }
    }
    assert_in_range(compared, 1500, 2200);
}

/* ---- Quality ---- */

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

/* Greedy, so better on the whole and not at each node. */
static void sweeping_is_as_good_as_bins(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    for (uint32_t round = 0; round < 3; ++round) {
        random_state = 20 + round;
        static const float sizes[] = {0.003f, 0.03f, 0.3f};
        struct bvh_box *boxes = soup(COUNT, sizes[round]);
        struct bvh sweep, binned;
        build_and_check(boxes, COUNT, &(struct bvh_params){.builder = BVH_SWEEP}, &sweep);
        double best = INFINITY, free_bins = INFINITY;
        static const uint32_t bins[] = {0, 2, 4, 7, 8, 16, 32, 64, 128, 256};
        for (size_t k = 0; k < sizeof bins / sizeof *bins; ++k) {
            build_and_check(boxes, COUNT, &(struct bvh_params){.bins = bins[k]}, &binned);
            best = fmin(best, binned.sah_cost);
            free_bins = k == 0 ? binned.sah_cost : free_bins;
            bvh_finish(&binned);
        }
        assert_true(sweep.sah_cost <= 1.005 * best);
        assert_true(free_bins <= 1.02 * best);
        bvh_finish(&sweep);
        free(boxes);
    }
}

/* ---- No tree ---- */

/* Full leaves but for one, in the order of the input, and not a box that leaves anything out. */
static void no_tree_is_one_box_for_all(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 15, 16, 1000};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c) {
        uint32_t count = counts[c], leaves = (count + BVH_LEAF_MAX - 1) / BVH_LEAF_MAX;
        struct bvh_box *boxes = soup(count, 0.1f);
        struct bvh bvh;
        const struct bvh_params params = {.builder = BVH_NONE, .leaf_limit = BVH_LEAF_MAX};
        assert_int_equal(bvh_build(&silent, boxes, count, &params, &bvh), WHIT_OK);
        assert_int_equal(bvh_validate(&silent, &bvh, boxes, BVH_LEAF_MAX), WHIT_OK);
        assert_int_equal(bvh.leaf_count, leaves);
        assert_int_equal(bvh.reference_count, count);
        assert_true(1u << bvh.depth < 2 * leaves);
        for (uint32_t i = 2; i < bvh.node_count; ++i)
            assert_memory_equal(bvh.nodes[i].lo, bvh.nodes[0].lo, sizeof bvh.nodes->lo);
        for (uint32_t i = 2; i < bvh.node_count; ++i)
            assert_memory_equal(bvh.nodes[i].hi, bvh.nodes[0].hi, sizeof bvh.nodes->hi);
        for (uint32_t i = 0; i < count; ++i)
            assert_int_equal(bvh.order[i], i);
        bvh_finish(&bvh);
        free(boxes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_bytes_for_any_thread_count),
        cmocka_unit_test(same_tree_for_any_order),
        cmocka_unit_test(sweep_finds_the_splits_of_the_quadratic_search),
        cmocka_unit_test(sah_is_better_than_medians),
        cmocka_unit_test(sweeping_is_as_good_as_bins),
        cmocka_unit_test(no_tree_is_one_box_for_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
