/* Trees over boxes that builders get wrong. */
#include "accel_boxes_fixture.h"

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
                float x = a < axes ? random_float(&random_state) : 0.25f;
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

/* Extents overflow, areas overflow, denormals vanish. */
static void garbage_bits(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 100; ++round) {
        random_state = 1000 + round;
        uint32_t count = 1 + random_below(&random_state, 300);
        struct bvh_box *boxes = garbage(count);
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

/* Points in ten heaps on a line, shuffled: what is left of a median is not right of it. */
static void medians_separate(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    random_state = 13;
    struct bvh_box boxes[COUNT];
    for (uint32_t i = 0; i < COUNT; ++i) {
        float x = (float)random_below(&random_state, 10);
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
        cmocka_unit_test(medians_separate),
        cmocka_unit_test(bad_input_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
