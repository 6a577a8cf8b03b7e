/* Triangles that builders get wrong, each with all builders and settings. */
#include "accel_build_fixture.h"
#include "bvh/complete.h"
#include "bvh/optimize.h"
#include "unit.h"

/* ---- Meshes ---- */

/* Equal triangles; with `size` 0 points at the origin. */
static struct soup soup_equal(uint32_t count, float size)
{
    struct soup soup = soup_make("equal", count);
    for (uint32_t i = 0; i < 9 * count; ++i)
        soup.positions[i] = size * (float)(i * 7 % 9);
    soup_box(&soup);
    return soup;
}

/* Two triangles, each the other's mirror image, in alternation. */
static struct soup soup_crossing(uint32_t count)
{
    struct soup soup = soup_make("crossing", count);
    for (uint32_t i = 0; i < 9 * count; ++i)
        soup.positions[i] = (i / 9 % 2 ? 1.0f : -1.0f) * (float)(i * 5 % 9 - 4);
    soup_box(&soup);
    return soup;
}

static struct soup soup_nested(uint32_t count)
{
    struct soup soup = soup_make("nested with one centre", count);
    for (uint32_t i = 0; i < count; ++i) {
        float r = (float)(i + 1);
        soup_set_box(&soup, i, (float[3]){-r, -r, -r}, (float[3]){r, r, r});
    }
    soup_box(&soup);
    return soup;
}

/* Triangles whose centres differ along `axes` axes only: on a line or in a plane. */
static struct soup soup_along(uint32_t count, int axes)
{
    struct soup soup = soup_make("on a line or in a plane", count);
    for (uint32_t i = 0; i < count; ++i) {
        float lo[3], hi[3];
        for (int a = 0; a < 3; ++a) {
            lo[a] = a < axes ? random_float(&random_state) : 0.25f;
            hi[a] = a < axes ? lo[a] + 0.01f : lo[a];
        }
        soup_set_box(&soup, i, lo, hi);
    }
    soup_box(&soup);
    return soup;
}

static struct soup soup_giants(uint32_t count)
{
    const float lo[3] = {-1e18f, -1e18f, -1e18f}, hi[3] = {1e18f, 1e18f, 1e18f};
    struct soup soup = soup_scattered(count, 1e-4f);
    soup.name = "giants and many tiny";
    soup_set_box(&soup, count / 2, lo, hi);
    soup_set_box(&soup, count / 3, (float[3]){9e17f, 9e17f, 9e17f}, hi);
    soup_box(&soup);
    return soup;
}

/* Points at multiples of a tiny `step`, so that the reciprocal of extents is infinite. */
static struct soup soup_steps(float from, float step)
{
    struct soup soup = soup_make("points in steps", 64);
    for (uint32_t i = 0; i < 64; ++i) {
        float p[3];
        for (uint32_t a = 0; a < 3; ++a)
            p[a] = from + step * (float)(i * (a + 1) % 64);
        soup_set(&soup, i, p, p, p);
    }
    soup_box(&soup);
    return soup;
}

/* Rounding puts a bin's plane on the wrong side of a centroid (github.com/RenderKit/embree). */
static struct soup soup_beside_planes(void)
{
    static const float at[] = {-6.4000024f, 25.6f, 57.6000022f};
    struct soup soup = soup_make("planes beside centroids", 300);
    for (uint32_t i = 0; i < 300; ++i) {
        float lo[3], hi[3];
        for (uint32_t a = 0; a < 3; ++a) {
            float x = at[(i + a) % 3], y = at[i * 7 / 3 % 3];
            lo[a] = fminf(x, y);
            hi[a] = fmaxf(x, y);
        }
        soup_set_box(&soup, i, lo, hi);
    }
    soup_box(&soup);
    return soup;
}

/* ---- Every way to build ---- */

TEST(every_builder_on_every_mesh)
{
    const uint32_t many = cases_few(10000);
    random_state = 1;
    const struct soup soups[] = {
        soup_sphere(40, 30),
        soup_terrain(30),
        soup_rooms(1500),
        soup_hair(2000, 1e-3f),
        soup_hair(1000, 0.0f),
        soup_hair(300, 1e-7f),
        soup_hair(1200, 0.02f),
        soup_scattered(5000, 0.1f),
        soup_equal(many, 0.0f),
        soup_equal(many, 1.0f),
        soup_crossing(many),
        soup_nested(3000),
        soup_along(3000, 1),
        soup_along(3000, 2),
        soup_giants(5000),
        soup_exponential(120, 2.0),
        soup_exponential(600, 1.3),
        soup_exponential(8000, 1.01),
        soup_garbage(500, 1e18f),
        soup_garbage(500, FLT_MAX / 16),
        soup_garbage(500, 1e-30f),
        soup_steps(0.0f, 0x1p-149f),
        soup_steps(0.0f, 0x1p-130f),
        soup_steps(0.0f, 0x1p-118f),
        soup_steps(1.0f, 0x1p-23f),
        soup_beside_planes(),
    };
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i)
        check_all(soups[i]);
}

TEST(few_triangles)
{
    for (uint32_t count = 0; count <= 40; ++count) {
        random_state = count;
        check_all(soup_hair(count, 0.3f));
    }
    own_soup none = soup_make("none", 0), one = soup_scattered(1, 1.0f);
    own_bvh empty = soup_build(&none, (whit_accel_params){0});
    own_bvh leaf = soup_build(&one, (whit_accel_params){0});
    assert_int_equal(empty.node_count, 0);
    assert_int_equal(leaf.node_count, 2);
    assert_int_equal(leaf.depth, 0);
    assert_int_equal(bvh_count(&leaf.nodes[0]), 1);
}

/* Random floats: extents and areas overflow, denormals vanish, many centroids coincide. */
TEST(a_thousand_trees_are_right)
{
    for (uint32_t round = 0; round < cases_few(1000); ++round) {
        random_state = 5000 + round;
        uint32_t count = 1 + random_below(&random_state, round % 10 == 0 ? 300 : 80);
        static const float limits[] = {FLT_MAX, 1e18f, 10.0f};
        struct soup soup = round % 2 == 0 ? soup_garbage(count, limits[round / 2 % 3])
                                          : soup_scattered(count, round % 4 == 1 ? 0.1f : 1e-3f);
        for (uint32_t i = 0; round % 8 == 3 && i < 9 * count; ++i)
            soup.positions[i] = floorf(8.0f * soup.positions[i]) + (i % 9 < 3 ? 1.0f : 0.0f);
        soup_box(&soup);
        check_all(soup);
    }
}

/* ---- One way ---- */

/* With two bins each split separates a single box, since these get smaller by half each: without
   the builder's switch to medians the tree would be deeper than the stack. */
TEST(depth_is_capped)
{
    const whit_accel_params params = {.bins = 2, .leaf_limit = 1};
    own_soup soup = soup_make("halves", 230);
    for (uint32_t i = 0; i < soup.count; ++i) {
        float at = (float)ldexp(1.0, (int)i - 112);
        soup_set_box(&soup, i, (float[3]){at, 0, 0}, (float[3]){1.5f * at, 1.5f * at, 1.5f * at});
    }
    soup_box(&soup);
    own_bvh bvh = soup_build(&soup, params);
    assert_null(find_fault(&soup, &params, &bvh));
    assert_in_range(bvh.depth, 97, 127);
}

/* Points at ten places on a line, shuffled: no point on the left side of a median split lies to the
   right of it. */
TEST(medians_separate)
{
    const whit_accel_params params = {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 1};
    random_state = 13;
    own_soup soup = soup_make("heaps", 200);
    for (uint32_t i = 0; i < soup.count; ++i) {
        const float p[3] = {(float)random_below(&random_state, 10), 0, 0};
        soup_set(&soup, i, p, p, p);
    }
    soup_box(&soup);
    own_bvh bvh = soup_build(&soup, params);
    assert_null(find_fault(&soup, &params, &bvh));
    assert_int_equal(bvh.depth, 8);
    for (uint32_t i = 2; i < bvh.node_count; i += 2)
        assert_true(bvh.nodes[i].hi[0] <= bvh.nodes[i + 1].lo[0]);
}

/* A tree by hand: `chain` leaves that hang beside each other on one path, the deepest first to
   leave room for; the boxes are points of a line in an order that pays to change. */
static void chain_make(uint32_t chain, struct bvh *bvh, struct bvh_box *boxes)
{
    *bvh = (struct bvh){.primitive_count = chain, .reference_count = chain, .depth = chain - 1};
    bvh->node_count = 2 * chain;
    bvh->nodes = aligned_alloc(64, 2 * (size_t)chain * sizeof *bvh->nodes);
    bvh->order = calloc(chain, sizeof *bvh->order);
    assert_true(bvh->nodes && bvh->order);
    memset(bvh->nodes, 0, 2 * (size_t)chain * sizeof *bvh->nodes);
    for (uint32_t i = 0; i < chain; ++i) {
        struct gpu_bvh_node *leaf = &bvh->nodes[i + 1 < chain ? 2 * i + 2 : 2 * i + 1];
        float x = (float)(i % 2 ? i : 2 * chain - i);
        *leaf = (struct gpu_bvh_node){{x, 0, 0}, i, {x + 1, 1, 1}, 1};
        boxes[i] = bvh_node_box(leaf);
        bvh->order[i] = i;
    }
    for (uint32_t i = chain - 1; i-- > 0;) {
        const struct gpu_bvh_node *a = &bvh->nodes[2 * i + 2], *b = a + 1;
        struct bvh_box box = no_box;
        box_unite(&box, a->lo, a->hi);
        box_unite(&box, b->lo, b->hi);
        struct gpu_bvh_node *node = &bvh->nodes[i == 0 ? 0 : 2 * i + 1];
        *node = (struct gpu_bvh_node){.first = 2 * i + 2};
        memcpy(node->lo, box.lo, sizeof node->lo);
        memcpy(node->hi, box.hi, sizeof node->hi);
    }
    bvh_complete(bvh, 1);
}

TEST(optimizing_keeps_the_limit_of_depth)
{
    for (uint32_t depth = 2; depth <= BVH_DEPTH_MAX; ++depth) {
        own_bvh bvh = {0};
        struct bvh_box boxes[BVH_DEPTH_MAX + 1];
        chain_make(depth + 1, &bvh, boxes);
        double before = bvh.sah_cost;
        assert_int_equal(bvh_optimize(&silent, 1, &bvh), WHIT_OK);
        assert_int_equal(bvh_validate(&silent, &bvh, boxes, 1), WHIT_OK);
        assert_true(bvh.depth <= BVH_DEPTH_MAX);
        assert_true(bvh.sah_cost <= before);
        if (depth == 64)
            assert_true(bvh.sah_cost < 0.5 * before && bvh.depth < 32);
    }
}

TEST(bad_input_is_refused)
{
    struct bvh bvh;
    struct bvh_box boxes[3] = {{{0, 0, 0}, {1, 1, 1}}, {{2, 2, 2}, {3, 3, 3}}, {{0}, {0}}};
    const float bad[] = {NAN, INFINITY, -INFINITY, 4.0f};
    for (int k = 0; k < 4; ++k) {
        boxes[1].lo[1] = bad[k];
        assert_int_equal(bvh_build(&silent, boxes, 3, NULL, NULL, &bvh), WHIT_ERROR_INPUT);
        assert_null(bvh.nodes);
    }
    boxes[1].lo[1] = 2.0f;
    static const whit_accel_params params[] = {{.bins = 1},
                                               {.bins = 257},
                                               {.leaf_limit = 16},
                                               {.spatial_alpha = -1.0f},
                                               {.build = WHIT_BUILD_SPATIAL}};
    for (int k = 0; k < 5; ++k) {
        assert_int_equal(bvh_build(&silent, boxes, 3, NULL, &params[k], &bvh), WHIT_ERROR_USAGE);
        assert_null(bvh.nodes);
    }
    assert_non_null(
        strstr(messages.last_error, "triangles")); /* there are no triangles for it to split */
}
