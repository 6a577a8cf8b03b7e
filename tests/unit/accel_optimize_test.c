/* Reinsertion: a tree of the same leaves that costs less, with the same hits, the same for any
   number of threads. */
#include "accel_fixture.h"

static void build(const struct soup *soup, const struct bvh_params *params, struct bvh *out)
{
    struct bvh_params all = *params;
    all.triangles = &soup->triangles;
    assert_int_equal(bvh_build(&silent, soup->boxes, soup->count, &all, out), WHIT_OK);
}

static void assert_trees_equal(const struct bvh *a, const struct bvh *b)
{
    assert_int_equal(a->node_count, b->node_count);
    assert_int_equal(a->reference_count, b->reference_count);
    assert_memory_equal(a->nodes, b->nodes, a->node_count * sizeof *a->nodes);
    assert_memory_equal(a->order, b->order, a->reference_count * sizeof *a->order);
    assert_true(a->sah_cost == b->sah_cost);
    assert_int_equal(a->depth, b->depth);
}

/* Leaf boxes and what is in them, as sums that do not depend on the order. */
static uint64_t leaves_digest(const struct bvh *bvh)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < bvh->node_count; ++i) {
        const struct gpu_bvh_node *node = &bvh->nodes[i];
        if (i == 1 || bvh_count(node) == 0)
            continue;
        uint64_t leaf = 1469598103934665603u;
        uint32_t words[6];
        memcpy(words, node->lo, 12);
        memcpy(words + 3, node->hi, 12);
        for (int k = 0; k < 6; ++k)
            leaf = (leaf ^ words[k]) * 1099511628211u;
        for (uint32_t k = 0; k < bvh_count(node); ++k)
            leaf = (leaf ^ bvh->order[node->first + k]) * 1099511628211u;
        sum += leaf;
    }
    return sum;
}

/* Leaves stand in the order of the records they name, pairs in that of the walk. */
static void assert_depth_first(const struct bvh *bvh)
{
    uint32_t stack[BVH_DEPTH_MAX + 2] = {0}, top = 1, pair = 2, slot = 0;
    while (top > 0) {
        const struct gpu_bvh_node *node = &bvh->nodes[stack[--top]];
        assert_int_equal(node->first, bvh_count(node) > 0 ? slot : pair);
        if (bvh_count(node) > 0) {
            slot += bvh_count(node);
            continue;
        }
        pair += 2;
        stack[top++] = node->first + 1;
        stack[top++] = node->first;
    }
    assert_int_equal(slot, bvh->reference_count);
}

/* How the costs compare. */
static double check_optimized(const struct soup *soup, struct bvh_params params)
{
    uint32_t limit = params.leaf_limit ? params.leaf_limit : 4;
    struct bvh plain, better;
    params.optimize = false;
    build(soup, &params, &plain);
    params.optimize = true;
    build(soup, &params, &better);
    assert_int_equal(bvh_validate(&silent, &better, soup->boxes, limit), WHIT_OK);
    assert_true(better.sah_cost <= plain.sah_cost);
    assert_int_equal(better.leaf_count, plain.leaf_count);
    assert_true(leaves_digest(&better) == leaves_digest(&plain));
    if (better.sah_cost < plain.sah_cost)
        assert_depth_first(&better);
    else
        assert_trees_equal(&better, &plain);
    double ratio = plain.sah_cost > 0.0 ? better.sah_cost / plain.sah_cost : 1.0;
    bvh_finish(&plain);
    bvh_finish(&better);
    return ratio;
}

static const struct bvh_params all_params[] = {
    {.builder = BVH_BINNED},
    {.builder = BVH_MEDIAN, .leaf_limit = 1},
    {.builder = BVH_BINNED, .leaf_limit = BVH_LEAF_MAX, .bins = 2, .traversal_cost = 3.0f},
    {.builder = BVH_MEDIAN, .thread_count = 2},
};
enum { ALL_PARAMS = sizeof all_params / sizeof all_params[0] };

static void costs_fall_on_every_mesh(void **state)
{
    (void)state;
    random_state = 1;
    struct soup soups[] = {soup_sphere(40, 30), soup_terrain(30), soup_hair(3000, 1e-3f),
                           soup_rooms(1500), soup_hair(400, 0.0f)};
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        for (int k = 0; k < ALL_PARAMS; ++k) {
            double ratio = check_optimized(&soups[i], all_params[k]);
            assert_true(ratio < 1.0);
            if (all_params[k].builder == BVH_MEDIAN && all_params[k].leaf_limit == 1 && i == 3)
                assert_true(ratio < 0.7); /* there was much to gain */
        }
        soup_finish(&soups[i]);
    }
}

static void few_primitives(void **state)
{
    (void)state;
    for (uint32_t count = 0; count <= 40; ++count) {
        random_state = count;
        struct soup soup = soup_hair(count, 0.1f);
        for (int k = 0; k < ALL_PARAMS; ++k)
            (void)check_optimized(&soup, all_params[k]);
        soup_finish(&soup);
    }
}

/* Nothing to gain, costs beyond floats, boxes without volume. */
static void degenerate_meshes(void **state)
{
    (void)state;
    random_state = 2;
    struct soup soups[] = {soup_make("points", 10000),      soup_make("equal", 10000),
                           soup_exponential(120, 2.0),      soup_exponential(600, 1.3),
                           soup_garbage(500, FLT_MAX / 16), soup_garbage(500, 1e18f)};
    for (uint32_t i = 0; i < 90000; ++i)
        soups[1].positions[i] = (float)(i * 7 % 9);
    soup_box(&soups[1]);
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        for (int k = 0; k < ALL_PARAMS; ++k)
            (void)check_optimized(&soups[i], all_params[k]);
        soup_finish(&soups[i]);
    }
}

static void same_bytes_for_any_thread_count(void **state)
{
    (void)state;
    random_state = 3;
    struct soup soup = soup_rooms(cases_of(12000));
    struct bvh one, other;
    struct bvh_params params = {.thread_count = 1, .optimize = true};
    build(&soup, &params, &one);
    for (uint32_t threads = 1; threads <= 4; ++threads) {
        params.thread_count = threads;
        build(&soup, &params, &other);
        assert_trees_equal(&one, &other);
        bvh_finish(&other);
    }
    bvh_finish(&one);
    soup_finish(&soup);
}

/* A tree by hand: `chain` leaves that hang beside each other on one path, the deepest first to
   leave room for; the boxes are points of a line in an order that pays to change. */
static void chain_make(uint32_t chain, struct bvh *bvh)
{
    *bvh = (struct bvh){.primitive_count = chain, .reference_count = chain};
    bvh->node_count = 2 * chain;
    bvh->nodes = aligned_alloc(64, 2 * (size_t)chain * sizeof *bvh->nodes);
    bvh->order = calloc(chain, sizeof *bvh->order);
    assert_true(bvh->nodes && bvh->order);
    memset(bvh->nodes, 0, 2 * (size_t)chain * sizeof *bvh->nodes);
    for (uint32_t i = 0; i < chain; ++i) {
        struct gpu_bvh_node *leaf = &bvh->nodes[i + 1 < chain ? 2 * i + 2 : 2 * i + 1];
        float x = (float)(i % 2 ? i : 2 * chain - i);
        *leaf = (struct gpu_bvh_node){{x, 0, 0}, i, {x + 1, 1, 1}, 1};
        bvh->order[i] = i;
    }
    for (uint32_t i = chain - 1; i-- > 0;) {
        const struct gpu_bvh_node *a = &bvh->nodes[2 * i + 2], *b = a + 1;
        struct gpu_bvh_node *node = &bvh->nodes[i == 0 ? 0 : 2 * i + 1];
        *node = (struct gpu_bvh_node){{0}, 2 * i + 2, {0}, 0};
        for (int k = 0; k < 3; ++k) {
            node->lo[k] = fminf(a->lo[k], b->lo[k]);
            node->hi[k] = fmaxf(a->hi[k], b->hi[k]);
        }
    }
    bvh_complete(bvh, 1.0);
}

static void deep_trees_stay_within_the_limit(void **state)
{
    (void)state;
    for (uint32_t depth = 2; depth <= BVH_DEPTH_MAX; ++depth) {
        struct bvh bvh;
        chain_make(depth + 1, &bvh);
        assert_int_equal(bvh.depth, depth);
        double before = bvh.sah_cost;
        assert_int_equal(bvh_optimize(&silent, 1, 1.0, &bvh), WHIT_OK);
        assert_int_equal(bvh_validate(&silent, &bvh, NULL, 1), WHIT_OK);
        assert_true(bvh.depth <= BVH_DEPTH_MAX);
        assert_true(bvh.sah_cost <= before);
        if (depth == 64)
            assert_true(bvh.sah_cost < 0.5 * before && bvh.depth < 32);
        bvh_finish(&bvh);
    }
}

static void hits_are_the_same(void **state)
{
    (void)state;
    const uint32_t rays = cases_of(20000);
    random_state = 4;
    struct soup soups[] = {soup_sphere(30, 20), soup_terrain(20), soup_hair(1500, 1e-3f),
                           soup_rooms(700)};
    struct gpu_hit *expected = malloc(rays * sizeof *expected);
    struct gpu_hit *hits = malloc(rays * sizeof *hits);
    assert_true(expected && hits);
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        struct scene *scene = soup_scene(&soups[i]);
        struct accel *plain = soup_accel(scene, &(struct bvh_params){.builder = BVH_BINNED});
        soup_trace(&soups[i], plain, i, rays, expected, NULL);
        assert_true(hits_count(expected, rays) > rays / 8);
        accel_destroy(plain);
        for (int k = 0; k < ALL_PARAMS; ++k) {
            struct bvh_params params = all_params[k];
            params.optimize = true;
            struct accel *accel = soup_accel(scene, &params);
            soup_trace(&soups[i], accel, i, rays, hits, NULL);
            assert_memory_equal(hits, expected, rays * sizeof *hits);
            accel_destroy(accel);
        }
        scene_destroy(scene);
        soup_finish(&soups[i]);
    }
    free(expected);
    free(hits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(costs_fall_on_every_mesh),
        cmocka_unit_test(few_primitives),
        cmocka_unit_test(degenerate_meshes),
        cmocka_unit_test(same_bytes_for_any_thread_count),
        cmocka_unit_test(deep_trees_stay_within_the_limit),
        cmocka_unit_test(hits_are_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
