/* Trees are the same for any number of threads and any order of the input; the sweep builder finds
   the splits of a quadratic search; some builders give better trees than others. */
#include "accel_build_fixture.h"
#include "unit.h"

/* Scattered triangles; every fourth is at one place, which only medians can split. Some coordinates
   are 0 and -0. */
static struct soup soup_with_heap(uint32_t count)
{
    struct soup soup = soup_scattered(count, 0.02f);
    for (uint32_t i = 0; i < count; i += 4)
        soup_set(&soup, i, (float[3]){-0.0f, 0.0f, -0.0f}, (float[3]){0.0f, -0.0f, 0.0f},
                 (float[3]){0.0f, 0.0f, 1.0f});
    soup_box(&soup);
    return soup;
}

/* Under ThreadSanitizer (accel_race) there are fewer triangles and rows, by WHIT_TEST_TRIANGLES,
   and optimizing builders, which take longest there, have fewer soups: memory accesses depend on
   code rather than on shapes. The output is the same with vectors and with scalars in f4.h
   (accel_scalar). */
TEST(same_bytes_for_any_thread_count)
{
    enum { SOUPS = 5 };
    const char *few = getenv("WHIT_TEST_TRIANGLES");
    const uint32_t count = few ? (uint32_t)atoi(few) : cases_of(12000);
    random_state = 7;
    /* The first soup has enough nodes for several threads to complete its trees. In the grid, the
       costs of planes differ only by rounding. */
    struct soup soups[SOUPS] = {soup_with_heap(few ? 2 * count : 40000), soup_with_heap(count),
                                soup_grid(13), soup_hair(count, 1e-3f), soup_rooms(count / 2)};
    for (size_t i = 0; i < SOUPS * EVERY_BUILDER; ++i) {
        const struct soup *soup = &soups[i % SOUPS];
        whit_accel_params params = every_builder[i / SOUPS];
        bool plain = params.build != WHIT_BUILD_SPATIAL && !params.optimize;
        if (i % SOUPS == 0 ? i > 0 : i % SOUPS > 2 && plain)
            continue;
        if (few && (i / SOUPS % 2 == 1 || /* the remaining rows have every builder, too */
                    (params.optimize && i % SOUPS > 2)))
            continue;
        params.threads = 1;
        own_bvh one = soup_build(soup, params);
        uint64_t hash = hash_bytes(HASH_START, one.nodes, one.node_count * sizeof *one.nodes);
        hash = hash_bytes(hash, one.order, one.reference_count * sizeof *one.order);
        print_message("  row %2zu of every_builder, %-9s %u nodes %016llx\n", i / SOUPS, soup->name,
                      one.node_count, (unsigned long long)hash);
        for (params.threads = 2; params.threads <= 5;
             params.threads += few || !cases_times() ? 2 : 1) {
            own_bvh other = soup_build(soup, params);
            if (!trees_equal(&one, &other) || !orders_equal(&one, &other))
                fail_msg("%s, row %zu of every_builder: another tree by %u threads", soup->name,
                         i / SOUPS, params.threads);
        }
    }
    for (size_t i = 0; i < SOUPS; ++i)
        soup_finish(&soups[i]);
}

/* Splitting planes depend only on the set of triangles. The order decides only between triangles
   that no plane separates: those with equal centroids on all three axes. */
TEST(same_tree_for_any_order)
{
    static const whit_accel_params params[] = {{.build = WHIT_BUILD_BINNED},
                                               {.build = WHIT_BUILD_BINNED, .bins = 7},
                                               {.build = WHIT_BUILD_SWEEP},
                                               {.build = WHIT_BUILD_SPATIAL}};
    random_state = 8;
    struct soup soups[] = {soup_scattered(2500, 0.05f), soup_grid(13), soup_hair(3000, 1e-3f)};
    for (uint32_t i = 0; i < soups[0].count; ++i) /* both zeros */
        soups[0].positions[9 * i + 2] = i % 2 ? 0.0f : -0.0f;
    soup_box(&soups[0]);
    for (size_t i = 0; i < 3 * 4; ++i) {
        struct soup *soup = &soups[i % 3];
        if (i % 3 != 2 && params[i / 3].build == WHIT_BUILD_SPATIAL)
            continue; /* spatial splits round the boxes of parts */
        own_bvh first = soup_build(soup, params[i / 3]);
        soup_shuffle(soup);
        own_bvh second = soup_build(soup, params[i / 3]);
        if (!trees_equal(&first, &second))
            fail_msg("%s, row %zu of params: another tree in another order", soup->name, i / 3);
    }
    for (size_t i = 0; i < 3; ++i)
        soup_finish(&soups[i]);
}

/* ---- Every position ---- */

static float centroid_of(const struct bvh_box *box, uint32_t axis)
{
    return box->lo[axis] * 0.25f + box->hi[axis] * 0.25f;
}

/* Writes the primitives below `node` to `out`; gives their number. */
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

/* The SAH cost of a split at `plane`; infinity where a side is empty. */
static double split_cost(const struct bvh_box *boxes, const uint32_t *primitives, uint32_t count,
                         uint32_t axis, float plane)
{
    struct bvh_box sides[2] = {no_box, no_box};
    uint32_t counts[2] = {0};
    for (uint32_t i = 0; i < count; ++i) {
        const struct bvh_box *box = &boxes[primitives[i]];
        int side = centroid_of(box, axis) >= plane;
        box_unite(&sides[side], box->lo, box->hi);
        ++counts[side];
    }
    if (counts[0] == 0)
        return INFINITY;
    return half_area(sides[0].lo, sides[0].hi) * counts[0] +
           half_area(sides[1].lo, sides[1].hi) * counts[1];
}

/* The least cost of all splits on the three axes, by quadratic search. */
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

/* Checks all splits below `node` against min_cost; gives how many were compared. */
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
        cost += half_area(pair[side].lo, pair[side].hi) * counts[side];
    }
    gather(bvh, node, primitives);
    double min = min_cost(boxes, primitives, counts[0] + counts[1]);
    free(primitives);
    /* 1e-5: the builder's costs are floats. Without a split (equal centroids on all axes)
       primitives are halved in their order. */
    if (min < INFINITY)
        assert_true(cost <= min * (1.0 + 1e-5));
    return (min < INFINITY) + check_splits(bvh, boxes, &pair[0]) +
           check_splits(bvh, boxes, &pair[1]);
}

TEST(sweep_finds_the_splits_of_the_quadratic_search)
{
    static const uint32_t counts[] = {2, 3, 5, 16, 33, 64, 65, 200, 700};
    uint32_t compared = 0;
    for (size_t i = 0; i < 2 * sizeof counts / sizeof *counts; ++i) {
        random_state = 100 + i;
        uint32_t count = counts[i / 2];
        own_soup soup = soup_scattered(count, count > 500 && i % 2 == 0 ? 0.03f : 0.3f);
        for (uint32_t k = 0; k < count && i % 2 == 1; k += 2) { /* equal centroids, other sizes */
            float x = (float)(k % 40);
            soup_set_box(&soup, k, (float[3]){-x, 0, 0}, (float[3]){x, 1, 0});
        }
        soup_box(&soup);
        own_bvh bvh =
            soup_build(&soup, (whit_accel_params){.build = WHIT_BUILD_SWEEP, .leaf_limit = 1});
        compared += check_splits(&bvh, soup.boxes, &bvh.nodes[0]);
    }
    assert_in_range(compared, 1500, 2200);
}

/* ---- Quality ---- */

static double cost_of(const struct soup *soup, whit_accel_params params)
{
    own_bvh bvh = soup_build(soup, params);
    return bvh.sah_cost;
}

static struct soup soup_uneven(uint32_t count)
{
    struct soup soup = soup_scattered(count, 0.02f);
    for (uint32_t i = 0; i < 9 * count; ++i)
        soup.positions[i] *= i / 9 % 2 ? 1.0f : 0.01f;
    soup_box(&soup);
    return soup;
}

TEST(the_better_way_costs_less)
{
    enum { UNEVEN, ROOMS, HAIR, THICK_HAIR, SPHERE, TERRAIN, SOUPS };
    static const whit_accel_params plain = {0}, spatial = {.build = WHIT_BUILD_SPATIAL},
                                   median = {.build = WHIT_BUILD_MEDIAN},
                                   halves = {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 1},
                                   full = {.build = WHIT_BUILD_MEDIAN, .leaf_limit = BVH_LEAF_MAX};
    /* `better` NULL: `other` with optimization */
    static const struct {
        const char *name;
        const whit_accel_params *better, *other;
        double share[SOUPS]; /* largest cost, as a share of the cost of `other`; 0: any */
    } rows[] = {
        {"SAH beside medians", &plain, &median, {[UNEVEN] = 0.9}},
        {"spatial splits", &spatial, &plain, {[ROOMS] = 0.9, [HAIR] = 0.97, [SPHERE] = 1.01}},
        {"bins, optimized", NULL, &plain, {0, 1, 1, 1, 1, 1}},
        {"medians, optimized", NULL, &median, {0, 1, 1, 1, 1, 1}},
        {"full leaves, optimized", NULL, &full, {0, 1, 1, 1, 1, 1}},
        {"medians of one, optimized", NULL, &halves, {0, 0.7, 1, 1, 1, 1}}, /* much to gain */
    };
    random_state = 5;
    struct soup soups[] = {
        soup_uneven(5000),     soup_rooms(2000),    soup_hair(4000, 1e-3f),
        soup_hair(400, 0.01f), soup_sphere(60, 40), soup_terrain(30),
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows * SOUPS; ++i) {
        const struct soup *soup = &soups[i % SOUPS];
        whit_accel_params better = *rows[i / SOUPS].other;
        better.optimize = true;
        if (rows[i / SOUPS].better)
            better = *rows[i / SOUPS].better;
        double share = rows[i / SOUPS].share[i % SOUPS];
        if (share > 0.0 && !(cost_of(soup, better) < share * cost_of(soup, *rows[i / SOUPS].other)))
            fail_msg("%s: costs too much of %s", rows[i / SOUPS].name, soup->name);
    }
    for (size_t i = 0; i < SOUPS; ++i)
        soup_finish(&soups[i]);
}

/* Both builders are greedy, so sweeping is better only on average. */
TEST(sweeping_is_as_good_as_bins)
{
    static const float sizes[] = {0.003f, 0.03f, 0.3f};
    static const uint32_t bins[] = {0, 2, 4, 7, 8, 16, 32, 64, 128, 256};
    for (uint32_t round = 0; round < 3; ++round) {
        random_state = 20 + round;
        own_soup soup = soup_scattered(20000, sizes[round]);
        double costs[sizeof bins / sizeof *bins], best = INFINITY;
        for (size_t k = 0; k < sizeof bins / sizeof *bins; ++k) {
            costs[k] = cost_of(&soup, (whit_accel_params){.bins = bins[k]});
            best = fmin(best, costs[k]);
        }
        assert_true(cost_of(&soup, (whit_accel_params){.build = WHIT_BUILD_SWEEP}) <= 1.005 * best);
        assert_true(costs[0] <= 1.02 * best);
    }
}

/* ---- No tree ---- */

/* All leaves but one are full and in the order of the input, and no box excludes any ray. */
TEST(no_tree_is_one_box_for_all)
{
    static const uint32_t counts[] = {1, 15, 16, 1000};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; ++c) {
        uint32_t count = counts[c], leaves = (count + BVH_LEAF_MAX - 1) / BVH_LEAF_MAX;
        own_soup soup = soup_scattered(count, 0.1f);
        own_bvh bvh = soup_build(
            &soup, (whit_accel_params){.build = WHIT_BUILD_NONE, .leaf_limit = BVH_LEAF_MAX});
        assert_int_equal(bvh_validate(&silent, &bvh, soup.boxes, BVH_LEAF_MAX), WHIT_OK);
        assert_int_equal(bvh.node_count, 2 * leaves);
        assert_int_equal(bvh.reference_count, count);
        assert_true(1u << bvh.depth < 2 * leaves);
        for (uint32_t i = 2; i < bvh.node_count; ++i) {
            assert_memory_equal(bvh.nodes[i].lo, bvh.nodes[0].lo, sizeof bvh.nodes->lo);
            assert_memory_equal(bvh.nodes[i].hi, bvh.nodes[0].hi, sizeof bvh.nodes->hi);
        }
        for (uint32_t i = 0; i < count; ++i)
            assert_int_equal(bvh.order[i], i);
    }
}
