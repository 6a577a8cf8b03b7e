/* The same tree whatever the number of threads and the order of the input; the naive sweep finds
   the tree of the fast one, and knows when to stop. */
#include "../cases.h"
#include "accel_boxes_fixture.h"

#include <stdatomic.h>

#include "base/clock.h"

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
        uint32_t count = params.builder == BVH_SWEEP_NAIVE ? 2500
                         : i == 0                          ? 40000
                                                           : cases_of(40000);
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
    static const struct bvh_params params[] = {{.builder = BVH_BINNED},
                                               {.builder = BVH_BINNED, .bins = 7},
                                               {.builder = BVH_SWEEP},
                                               {.builder = BVH_SWEEP_NAIVE}};
    for (uint32_t k = 0; k < 8; ++k) {
        random_state = 8;
        uint32_t count = k < 4 ? 2500 : 13 * 13 * 13;
        struct bvh_box *boxes = k < 4 ? soup(count, 0.05f) : grid(13);
        for (uint32_t i = 0; k < 4 && i < count; ++i) { /* both zeros */
            boxes[i].lo[2] = i % 2 ? 0.0f : -0.0f;
            boxes[i].hi[2] = 0.01f + fabsf(boxes[i].hi[2]);
        }
        struct bvh first, second;
        build_and_check(boxes, count, &params[k % 4], &first);
        shuffle(boxes, count);
        build_and_check(boxes, count, &params[k % 4], &second);
        assert_same_tree(&first, &second);
        bvh_finish(&first);
        bvh_finish(&second);
        free(boxes);
    }
}

/* ---- The naive sweep ---- */

static int compare_indices(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* What is in a leaf, not how it is ordered there. */
static void leaves_sort(struct bvh *bvh)
{
    for (uint32_t i = 0; i < bvh->node_count; ++i) {
        const struct gpu_bvh_node *node = &bvh->nodes[i];
        if (i != 1 && bvh_count(node) > 0)
            qsort(bvh->order + node->first, bvh_count(node), sizeof *bvh->order, compare_indices);
    }
}

static void assert_naive_agrees(const struct bvh_box *boxes, uint32_t count)
{
    static const uint32_t leaf_limits[] = {1, 4, BVH_LEAF_MAX};
    for (size_t k = 0; k < 3; ++k) {
        struct bvh fast, naive;
        struct bvh_params params = {.builder = BVH_SWEEP, .leaf_limit = leaf_limits[k]};
        build_and_check(boxes, count, &params, &fast);
        params.builder = BVH_SWEEP_NAIVE;
        build_and_check(boxes, count, &params, &naive);
        assert_same_tree(&fast, &naive);
        leaves_sort(&fast);
        leaves_sort(&naive);
        assert_memory_equal(fast.order, naive.order, count * sizeof *fast.order);
        bvh_finish(&fast);
        bvh_finish(&naive);
    }
}

static void naive_sweep_finds_the_tree_of_the_fast_one(void **state)
{
    (void)state;
    static const uint32_t counts[] = {1, 2, 3, 5, 16, 31, 32, 33, 34, 64, 65, 200, 1000, 3000};
    const size_t last = sizeof counts / sizeof *counts - (cases_times() > 0 ? 0 : 1);
    for (size_t i = 0; i < last; ++i) {
        random_state = 100 + i;
        struct bvh_box *boxes = soup(counts[i], counts[i] > 500 ? 0.03f : 0.3f);
        assert_naive_agrees(boxes, counts[i]);
        for (uint32_t k = 0; k < counts[i]; k += 2) /* equal centroids, other sizes */
            boxes[k] = (struct bvh_box){{-(float)(k % 40), 0, 0}, {(float)(k % 40), 1, 0}};
        assert_naive_agrees(boxes, counts[i]);
        free(boxes);
    }
    for (uint32_t side = 2; side <= 9; ++side) {
        struct bvh_box *boxes = grid(side);
        assert_naive_agrees(boxes, side * side * side);
        free(boxes);
    }
    for (uint32_t round = 0; round < 50; ++round) {
        random_state = round;
        struct bvh_box *boxes = garbage(150);
        assert_naive_agrees(boxes, 150);
        free(boxes);
    }
}

/* In place of clock_ms: a millisecond passes whenever somebody asks for the time. */
static _Atomic uint32_t asked = 1000; /* a deadline of 0 is none */

double __wrap_clock_ms(void);
double __wrap_clock_ms(void)
{
    return (double)atomic_fetch_add(&asked, 1);
}

/* The time is asked for, or the order read, many times in the first split and seldom after the end.
 */
static void assert_stops(struct bvh_params params, whit_result expected, const char *reason)
{
    enum { COUNT = 20000, ASKED_MOST = 20 }; /* 1.2e9 visits for the first split */
    char said[201] = "";
    struct log log = {keep_message, said, WHIT_LOG_ERROR};
    random_state = 3;
    struct bvh_box *boxes = soup(COUNT, 0.02f);
    struct bvh bvh;
    params.builder = BVH_SWEEP_NAIVE;
    for (params.thread_count = 1; params.thread_count <= 2; ++params.thread_count) {
        const double end_ms = fmax(clock_ms(), params.deadline_ms);
        said[0] = '\0';
        assert_int_equal(bvh_build(&log, boxes, COUNT, &params, &bvh), expected);
        assert_null(bvh.nodes);
        assert_null(bvh.order);
        assert_non_null(strstr(said, reason));
        assert_non_null(strstr(said, "of which the first split alone takes 1.2e+09"));
        assert_true(clock_ms() - end_ms < ASKED_MOST);
    }
    free(boxes);
}

static void naive_sweep_stops_when_told(void **state)
{
    (void)state;
    volatile bool cancel = true;
    assert_stops((struct bvh_params){.deadline_ms = clock_ms() - 1.0}, WHIT_ERROR_TIME_LIMIT,
                 "out of time after 0 splits");
    assert_stops((struct bvh_params){.deadline_ms = clock_ms() + 50.0}, WHIT_ERROR_TIME_LIMIT,
                 "out of time after 0 splits");
    assert_stops((struct bvh_params){.cancel = &cancel}, WHIT_ERROR_CANCELLED,
                 "cancelled after 0 splits");
    cancel = false;
    random_state = 4;
    struct bvh_box *boxes = soup(300, 0.1f);
    struct bvh bvh;
    struct bvh_params params = {
        .builder = BVH_SWEEP_NAIVE, .deadline_ms = clock_ms() + 1e6, .cancel = &cancel};
    build_and_check(boxes, 300, &params, &bvh);
    bvh_finish(&bvh);
    free(boxes);
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
        cmocka_unit_test(naive_sweep_finds_the_tree_of_the_fast_one),
        cmocka_unit_test(naive_sweep_stops_when_told),
        cmocka_unit_test(sah_is_better_than_medians),
        cmocka_unit_test(sweeping_is_as_good_as_bins),
        cmocka_unit_test(no_tree_is_one_box_for_all),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
