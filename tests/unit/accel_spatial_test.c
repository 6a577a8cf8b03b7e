/* Spatial splits: no part of a triangle gets lost, no more references than allowed, the same tree
   for any number of threads, and the hits of every other builder. */
#include "accel_fixture.h"

#include "bvh/clip.h"
#include "twin/traverse.h"

__extension__ typedef __float128 quad;

static void build(const struct soup *soup, const struct bvh_params *params, struct bvh *out)
{
    struct bvh_params all = *params;
    all.builder = BVH_SPATIAL;
    all.triangles = &soup->triangles;
    assert_int_equal(bvh_build(&silent, soup->boxes, soup->count, &all, out), WHIT_OK);
}

/* ---- Nothing gets lost ---- */

/* Points of a triangle in sixths: corners, middles of edges, and inside. All of them in doubles,
   scaled by six, are exact where the coordinates are not too far apart; quads keep them exact. */
enum { STEPS = 6, POINTS = (STEPS + 1) * (STEPS + 2) / 2 };
#define POINTS_ALL ((1u << POINTS) - 1)

static void triangle_points(const struct soup *soup, uint32_t triangle, quad out[POINTS][3])
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

/* Bits of the points that are in a box. */
static uint32_t points_inside(quad points[POINTS][3], const float lo[3], const float hi[3])
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

/* Every point of a triangle is in one of the leaves that hold the triangle, and no leaf holds one
   twice. */
static void assert_covered(const struct soup *soup, const struct bvh *bvh)
{
    uint32_t *seen = calloc(soup->count, sizeof *seen);
    assert_non_null(seen);
    for (uint32_t i = 0; i < bvh->node_count; ++i) {
        const struct gpu_bvh_node *node = &bvh->nodes[i];
        for (uint32_t k = 0; i != 1 && k < bvh_count(node); ++k) {
            quad points[POINTS][3];
            uint32_t triangle = bvh->order[node->first + k];
            triangle_points(soup, triangle, points);
            seen[triangle] |= points_inside(points, node->lo, node->hi);
            for (uint32_t other = 0; other < k; ++other)
                assert_int_not_equal(bvh->order[node->first + other], triangle);
        }
    }
    for (uint32_t i = 0; i < soup->count; ++i)
        assert_int_equal(seen[i], POINTS_ALL);
    free(seen);
}

static void check(const struct soup *soup, const struct bvh_params *params)
{
    uint32_t limit = params->leaf_limit ? params->leaf_limit : 4;
    double share = params->spatial_budget == 0.0f ? 0.5 : fmax((double)params->spatial_budget, 0.0);
    struct bvh bvh;
    build(soup, params, &bvh);
    assert_int_equal(bvh_validate(&silent, &bvh, soup->boxes, limit), WHIT_OK);
    assert_int_equal(bvh.primitive_count, soup->count);
    assert_true(bvh.reference_count >= soup->count);
    assert_true(bvh.reference_count - soup->count <= share * soup->count);
    assert_int_equal(bvh.clipped, bvh.reference_count > soup->count);
    assert_true(bvh.leaf_largest <= limit && bvh.depth <= BVH_DEPTH_MAX && isfinite(bvh.sah_cost));
    assert_covered(soup, &bvh);
    bvh_finish(&bvh);
}

static void check_all(const struct soup *soup)
{
    static const struct bvh_params params[] = {
        {.thread_count = 1},
        {.thread_count = 2, .leaf_limit = 1, .spatial_alpha = 1e-9f, .spatial_budget = 2.0f},
        {.leaf_limit = BVH_LEAF_MAX, .spatial_budget = 0.03f, .traversal_cost = 3.0f},
        {.leaf_limit = 2, .spatial_budget = -1.0f},
        {.leaf_limit = 1, .optimize = true},
    };
    for (size_t i = 0; i < sizeof params / sizeof *params; ++i)
        check(soup, &params[i]);
}

static void nothing_is_lost(void **state)
{
    (void)state;
    random_state = 1;
    struct soup soups[] = {soup_sphere(30, 20),    soup_terrain(20),      soup_rooms(1000),
                           soup_hair(1200, 1e-3f), soup_hair(1000, 0.0f), soup_hair(300, 1e-7f),
                           soup_hair(1200, 0.02f)};
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        check_all(&soups[i]);
        soup_finish(&soups[i]);
    }
}

static void few_triangles(void **state)
{
    (void)state;
    for (uint32_t count = 0; count <= 30; ++count) {
        random_state = count;
        struct soup soup = soup_hair(count, 0.3f);
        check_all(&soup);
        soup_finish(&soup);
    }
}

static void degenerate_meshes(void **state)
{
    (void)state;
    random_state = 2;
    const uint32_t count = cases_of(10000);
    struct soup soups[] = {soup_make("points", count),      soup_make("equal", count),
                           soup_make("crossing", count),    soup_exponential(120, 2.0),
                           soup_exponential(600, 1.3),      soup_garbage(500, 1e18f),
                           soup_garbage(500, FLT_MAX / 16), soup_garbage(500, 1e-30f)};
    for (uint32_t i = 0; i < 9 * count; ++i) {
        soups[1].positions[i] = (float)(i * 7 % 9);
        soups[2].positions[i] = (i / 9 % 2 ? 1.0f : -1.0f) * (float)(i * 5 % 9 - 4);
    }
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        soup_box(&soups[i]);
        check_all(&soups[i]);
        soup_finish(&soups[i]);
    }
}

static void garbage_of_all_sizes(void **state)
{
    (void)state;
    for (uint32_t round = 0; round < 60; ++round) {
        random_state = 100 + round;
        float limit = round % 3 == 0 ? FLT_MAX : round % 3 == 1 ? 1e18f : 10.0f;
        struct soup soup = soup_garbage(1 + random_below(&random_state, 200), limit);
        check_all(&soup);
        soup_finish(&soup);
    }
}

/* ---- Clipping ---- */

static void clips_are_known(void **state)
{
    (void)state;
    const float a[3] = {0, 0, 0}, b[3] = {4, 0, 0}, c[3] = {0, 4, 8};
    const struct clip_triangle triangle = {{a, b, c}};
    static const struct {
        struct bvh_box cell, box;
        bool some;
    } rows[] = {
        {{{-9, -9, -9}, {9, 9, 9}}, {{0, 0, 0}, {4, 4, 8}}, true},
        {{{1, 0, 0}, {4, 4, 8}}, {{1, 0, 0}, {4, 3, 6}}, true},
        {{{0, 0, 0}, {1, 4, 8}}, {{0, 0, 0}, {1, 4, 8}}, true},
        {{{1, 0, 0}, {2, 1, 8}}, {{1, 0, 0}, {2, 1, 2}}, true},
        {{{0, 0, 6}, {4, 4, 8}}, {{0, 3, 6}, {1, 4, 8}}, true},
        {{{4, 0, 0}, {4, 4, 8}}, {{4, 0, 0}, {4, 0, 0}}, true},    /* a corner */
        {{{0, 4, 0}, {4, 4, 8}}, {{0, 4, 8}, {0, 4, 8}}, true},    /* another */
        {{{-1, 0, 0}, {0, 4, 8}}, {{0, 0, 0}, {0, 4, 8}}, true},   /* an edge */
        {{{-1, -1, -1}, {9, 0, 9}}, {{0, 0, 0}, {4, 0, 0}}, true}, /* another */
        {{{3, 3, 0}, {4, 4, 8}}, {{0}, {0}}, false},
        {{{0, 0, 5}, {4, 1, 8}}, {{0}, {0}}, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        struct bvh_box box;
        assert_int_equal(clip_triangle_box(&triangle, &rows[i].cell, &box), rows[i].some);
        if (rows[i].some)
            assert_memory_equal(&box, &rows[i].box, sizeof box);
    }
}

/* Planes through vertices, and anywhere; slivers down to lines and points, near and far. */
static void clips_hold_what_is_inside(void **state)
{
    (void)state;
    random_state = 3;
    uint32_t empty = 0;
    for (int round = 0; round < 10000; ++round) {
        int power = (int)random_below(&random_state, 40);
        float at = (float)ldexp(random_float(&random_state) - 0.5, power);
        float thin =
            round % 4 == 0 ? 0.0f : (float)ldexp(1.0, -(int)random_below(&random_state, 30));
        struct soup soup = soup_hair(1, thin);
        for (int k = 0; k < 9; ++k)
            soup.positions[k] += at;
        soup_box(&soup);
        struct bvh_box cell = soup.boxes[0], box;
        for (int k = 0; k < 6; ++k) {
            float *bound = k < 3 ? &cell.lo[k] : &cell.hi[k - 3];
            uint32_t pick = random_below(&random_state, 8);
            if (pick < 3)
                *bound = soup_vertex(&soup, 0, pick)[k % 3];
            else if (pick < 5)
                *bound = cell.lo[k % 3] +
                         random_float(&random_state) * (cell.hi[k % 3] - cell.lo[k % 3]);
            if (pick == 7)
                *bound = nextafterf(*bound, k < 3 ? INFINITY : -INFINITY);
        }
        quad points[POINTS][3];
        triangle_points(&soup, 0, points);
        uint32_t inside = points_inside(points, cell.lo, cell.hi);
        const struct clip_triangle triangle = clip_fetch(&soup.triangles, 0);
        if (clip_triangle_box(&triangle, &cell, &box)) {
            struct bvh_box wide = clip_widen(&box, &soup.boxes[0]);
            assert_int_equal(inside & ~points_inside(points, wide.lo, wide.hi), 0);
            for (int k = 0; k < 3; ++k)
                assert_true(box.lo[k] >= cell.lo[k] && box.lo[k] <= box.hi[k] &&
                            box.hi[k] <= cell.hi[k]);
        } else {
            /* Only what touches the cell may be lost to rounding. */
            for (int k = 0; k < 3; ++k) {
                cell.lo[k] = nextafterf(cell.lo[k], INFINITY);
                cell.hi[k] = nextafterf(cell.hi[k], -INFINITY);
            }
            assert_int_equal(points_inside(points, cell.lo, cell.hi), 0);
            ++empty;
        }
        soup_finish(&soup);
    }
    assert_true(empty > 300 && empty < 7000);
}

/* ---- What is split ---- */

static void budgets_are_kept_and_used(void **state)
{
    (void)state;
    random_state = 4;
    struct soup soup = soup_rooms(2000);
    static const float budgets[] = {-1.0f, 1e-4f, 0.01f, 0.1f, 0.5f, 1.0f, 3.0f};
    double last = INFINITY;
    for (size_t i = 0; i < sizeof budgets / sizeof *budgets; ++i) {
        struct bvh bvh;
        build(&soup, &(struct bvh_params){.spatial_budget = budgets[i]}, &bvh);
        double max = budgets[i] < 0.0f ? 0.0 : floor(4000.0 * (double)budgets[i]);
        assert_true(bvh.reference_count - 4000 <= max);
        if (budgets[i] >= 0.1f && budgets[i] <= 1.0f)
            assert_true(bvh.reference_count - 4000 >= 0.7 * max);
        assert_true(bvh.sah_cost <= last);
        last = bvh.sah_cost;
        bvh_finish(&bvh);
    }
    soup_finish(&soup);
}

static void costs_fall_where_boxes_overlap(void **state)
{
    (void)state;
    random_state = 5;
    struct soup soups[] = {soup_rooms(2000), soup_hair(4000, 1e-3f), soup_sphere(60, 40)};
    static const double ratios[] = {0.9, 0.97, 1.01};
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        struct bvh binned, spatial;
        assert_int_equal(
            bvh_build(&silent, soups[i].boxes, soups[i].count, &(struct bvh_params){0}, &binned),
            WHIT_OK);
        build(&soups[i], &(struct bvh_params){0}, &spatial);
        assert_true(spatial.sah_cost < ratios[i] * binned.sah_cost);
        bvh_finish(&binned);
        bvh_finish(&spatial);
        soup_finish(&soups[i]);
    }
}

/* Splits are tried only where enough overlaps. */
static void overlap_decides(void **state)
{
    (void)state;
    random_state = 6;
    struct soup soup = soup_rooms(1000);
    uint32_t last = UINT32_MAX;
    for (int i = 0; i < 4; ++i) {
        static const float alphas[] = {1e-9f, 1e-2f, 0.1f, 1.0f};
        struct bvh bvh;
        build(&soup, &(struct bvh_params){.spatial_alpha = alphas[i]}, &bvh);
        assert_true(bvh.reference_count < last);
        last = bvh.reference_count;
        bvh_finish(&bvh);
    }
    assert_int_equal(last, soup.count);
    soup_finish(&soup);
}

/* References that would cost less whole are not split: without that there are 15,679. */
static void cheap_references_are_not_split(void **state)
{
    (void)state;
    random_state = 5;
    struct soup soup = soup_rooms(2000);
    struct bvh bvh;
    build(&soup, &(struct bvh_params){.spatial_budget = 10.0f, .spatial_alpha = 1e-9f}, &bvh);
    assert_true(bvh.clipped && bvh.reference_count < 15000);
    bvh_finish(&bvh);
    soup_finish(&soup);
}

static void whole_triangles_stay_whole(void **state)
{
    (void)state;
    random_state = 7;
    struct soup soup = soup_rooms(1500);
    uint8_t *whole = calloc(soup.count, 1);
    uint32_t *times = calloc(soup.count, sizeof *times);
    assert_true(whole && times);
    soup.triangles.whole = whole;
    for (int round = 0; round < 3; ++round) {
        for (uint32_t i = 0; i < soup.count; ++i)
            whole[i] = round == 0 ? 0 : round == 1 ? i / 2 % 2 : 1;
        struct bvh bvh;
        build(&soup, &(struct bvh_params){.spatial_budget = 2.0f}, &bvh);
        memset(times, 0, soup.count * sizeof *times);
        for (uint32_t i = 0; i < bvh.reference_count; ++i)
            ++times[bvh.order[i]];
        for (uint32_t i = 0; i < soup.count; ++i)
            assert_true(times[i] == 1 || (times[i] > 1 && !whole[i]));
        assert_int_equal(bvh.clipped, round < 2);
        assert_covered(&soup, &bvh);
        bvh_finish(&bvh);
    }
    free(whole);
    free(times);
    soup_finish(&soup);
}

static void keep_message(void *user, whit_log_level level, const char *message)
{
    assert_int_equal(level, WHIT_LOG_ERROR);
    strncat(user, message, 200);
}

static void triangles_are_needed(void **state)
{
    (void)state;
    char said[201] = "";
    struct log log = {keep_message, said, WHIT_LOG_ERROR};
    struct bvh_box box = {{0, 0, 0}, {1, 1, 1}};
    struct bvh bvh;
    assert_int_equal(bvh_build(&log, &box, 1, &(struct bvh_params){.builder = BVH_SPATIAL}, &bvh),
                     WHIT_ERROR_USAGE);
    assert_null(bvh.nodes);
    assert_non_null(strstr(said, "triangles"));
}

/* ---- One tree ---- */

static void same_bytes_for_any_thread_count(void **state)
{
    (void)state;
    random_state = 8;
    struct soup soups[] = {soup_hair(cases_of(20000), 1e-3f), soup_rooms(cases_of(8000))};
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        struct bvh one, other;
        struct bvh_params params = {.thread_count = 1, .optimize = i == 1};
        build(&soups[i], &params, &one);
        assert_true(one.clipped);
        for (uint32_t threads = 1; threads <= 5; ++threads) {
            params.thread_count = threads;
            build(&soups[i], &params, &other);
            assert_int_equal(other.node_count, one.node_count);
            assert_int_equal(other.reference_count, one.reference_count);
            assert_memory_equal(other.nodes, one.nodes, one.node_count * sizeof *one.nodes);
            assert_memory_equal(other.order, one.order, one.reference_count * sizeof *one.order);
            assert_true(other.sah_cost == one.sah_cost);
            bvh_finish(&other);
        }
        bvh_finish(&one);
        soup_finish(&soups[i]);
    }
}

static void same_cost_for_any_order(void **state)
{
    (void)state;
    random_state = 9;
    struct soup soup = soup_hair(3000, 1e-3f);
    struct bvh first, second;
    build(&soup, &(struct bvh_params){0}, &first);
    for (uint32_t i = soup.count - 1; i > 0; --i) {
        uint32_t j = random_below(&random_state, i + 1);
        for (uint32_t k = 0; k < 9; ++k) {
            float moved = soup.positions[9 * i + k];
            soup.positions[9 * i + k] = soup.positions[9 * j + k];
            soup.positions[9 * j + k] = moved;
        }
    }
    soup_box(&soup);
    build(&soup, &(struct bvh_params){0}, &second);
    assert_true(first.sah_cost == second.sah_cost);
    assert_int_equal(first.reference_count, second.reference_count);
    assert_memory_equal(first.nodes, second.nodes, first.node_count * sizeof *first.nodes);
    bvh_finish(&first);
    bvh_finish(&second);
    soup_finish(&soup);
}

/* ---- Hits ---- */

enum { RAYS = 12000 };

/* At where edges of triangles pass faces of leaves, from near and far: where a part's box has its
   corners. Every fourth ray goes nearly along the triangle. */
static struct gpu_ray ray_at_leaf(const struct accel *accel, double distance)
{
    const struct accel_mesh *mesh = &accel->meshes[0];
    for (;;) {
        uint32_t index = random_below(&random_state, mesh->node_count),
                 edge = random_below(&random_state, 3), axis = random_below(&random_state, 3);
        const struct gpu_bvh_node *leaf = &accel->nodes[mesh->first_node + index];
        if (index == 1 || bvh_count(leaf) == 0)
            continue;
        const struct gpu_triangle *t =
            &accel->triangles[leaf->first + random_bits(&random_state) % bvh_count(leaf)];
        const float *v[3] = {t->v0, t->v1, t->v2}, *a = v[edge], *b = v[(edge + 1) % 3];
        double s = ((double)(random_below(&random_state, 2) ? leaf->lo : leaf->hi)[axis] -
                    (double)a[axis]) /
                   ((double)b[axis] - (double)a[axis]);
        if (!(s >= 0.0 && s <= 1.0))
            continue;
        bool along = random_below(&random_state, 4) == 0;
        double w = (double)random_float(&random_state) * distance;
        struct gpu_ray ray = {.t_max = INFINITY};
        for (int k = 0; k < 3; ++k) {
            double target = (double)a[k] + s * ((double)b[k] - (double)a[k]);
            double size = (double)mesh->box.hi[k] - (double)mesh->box.lo[k];
            double off = size * ((double)random_float(&random_state) - 0.5);
            ray.origin[k] = (float)(along ? target + w * ((double)v[(edge + 2) % 3][k] - target) +
                                                1e-7 * distance * off
                                          : target + distance * off);
            ray.dir[k] = (float)(target - (double)ray.origin[k]);
        }
        return ray;
    }
}

static void assert_same_at_leaves(const struct scene *scene)
{
    const uint32_t rays = cases_of(RAYS);
    struct accel *plain = soup_accel(scene, &(struct bvh_params){.builder = BVH_BINNED});
    struct accel *split = soup_accel(
        scene, &(struct bvh_params){.builder = BVH_SPATIAL, .leaf_limit = 1, .spatial_budget = 4});
    uint32_t status = 0, found = 0;
    for (uint32_t i = 0; i < rays; ++i) {
        struct gpu_ray ray = ray_at_leaf(split, i % 3 == 0 ? 1e3 : i % 3 == 1 ? 30.0 : 1.0);
        struct gpu_hit expected, hit;
        traverse_float(plain, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &expected, NULL,
                       &status);
        traverse_float(split, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &hit, NULL, &status);
        assert_memory_equal(&hit, &expected, sizeof hit);
        found += hit.primitive != HIT_NONE;
    }
    assert_int_equal(status, 0);
    assert_true(found > rays / 2);
    accel_destroy(plain);
    accel_destroy(split);
}

static void assert_same_hits(const struct soup *soup, const struct scene *scene, double visits)
{
    const uint32_t rays = cases_of(RAYS);
    struct gpu_hit *expected = malloc(rays * sizeof *expected), *hits = malloc(rays * sizeof *hits);
    assert_true(expected && hits);
    struct gpu_cost before = {0}, after = {0};
    struct accel *plain = soup_accel(scene, &(struct bvh_params){.builder = BVH_BINNED});
    soup_trace(soup, plain, 1, rays, expected, &before);
    assert_true(hits_count(expected, rays) > rays / 8);
    accel_destroy(plain);
    static const struct bvh_params params[] = {
        {.builder = BVH_SPATIAL},
        {.builder = BVH_SPATIAL, .optimize = true},
        {.builder = BVH_SPATIAL, .leaf_limit = 1, .spatial_budget = 4.0f, .spatial_alpha = 1e-9f},
    };
    for (size_t i = 0; i < sizeof params / sizeof *params; ++i) {
        struct accel *accel = soup_accel(scene, &params[i]);
        soup_trace(soup, accel, 1, rays, hits, i == 0 ? &after : NULL);
        assert_memory_equal(hits, expected, rays * sizeof *hits);
        accel_destroy(accel);
    }
    assert_true(after.inner_nodes < visits * before.inner_nodes);
    free(expected);
    free(hits);
}

static void hits_are_the_same(void **state)
{
    (void)state;
    random_state = 10;
    struct soup soups[] = {soup_rooms(1500), soup_hair(2500, 1e-3f), soup_hair(1500, 0.05f),
                           soup_sphere(30, 20), soup_terrain(20)};
    static const double visits[] = {0.7, 0.99, 0.99, 1.02, 1.02};
    for (size_t i = 0; i < sizeof soups / sizeof *soups; ++i) {
        struct scene *scene = soup_scene(&soups[i]);
        assert_same_hits(&soups[i], scene, visits[i]);
        if (i < 3)
            assert_same_at_leaves(scene);
        scene_destroy(scene);
        soup_finish(&soups[i]);
    }
}

/* A leaf that loses a piece of a part: the validator misses it. */
static void lost_parts_are_noticed(void **state)
{
    (void)state;
    random_state = 12;
    struct soup soup = soup_rooms(300);
    struct scene *scene = soup_scene(&soup);
    char said[201] = "";
    struct accel_params params = {
        .mesh = {.builder = BVH_SPATIAL, .leaf_limit = 1, .spatial_budget = 3}};
    struct accel *accel = NULL;
    assert_int_equal(accel_create(&silent, scene, &params, &accel), WHIT_OK);
    accel->log = (struct log){keep_message, said, WHIT_LOG_ERROR};
    assert_int_equal(accel_validate(accel), WHIT_OK);
    const struct accel_mesh *mesh = &accel->meshes[0];
    uint32_t refused = 0, by_points = 0;
    for (uint32_t i = 2; i < mesh->node_count; i += 7) {
        struct gpu_bvh_node *leaf = &accel->nodes[mesh->first_node + i];
        struct gpu_bvh_node *pair = &accel->nodes[mesh->first_node + (i & ~1u)];
        struct gpu_bvh_node kept[2] = {pair[0], pair[1]};
        uint32_t axis = 0;
        for (uint32_t a = 1; a < 3; ++a)
            axis = leaf->hi[a] - leaf->lo[a] > leaf->hi[axis] - leaf->lo[axis] ? a : axis;
        if (bvh_count(leaf) == 0)
            continue;
        leaf->hi[axis] = leaf->lo[axis] + 0.05f * (leaf->hi[axis] - leaf->lo[axis]);
        bvh_set_axis(pair);
        said[0] = 0;
        refused += accel_validate(accel) != WHIT_OK;
        by_points += strstr(said, "a part of a primitive") != NULL;
        memcpy(pair, kept, sizeof kept);
    }
    assert_true(refused > 50 && by_points > 10);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

/* Shadow rays add up filters record by record: each must be there once. */
static void filters_are_met_once(void **state)
{
    (void)state;
    random_state = 11;
    struct soup soup = soup_rooms(1500);
    struct scene *scene = soup_scene(&soup);
    struct scene_material glass;
    scene_material_init(&glass, "glass");
    for (int c = 0; c < 3; ++c)
        glass.transmission[c] = 0.5f;
    uint32_t index = scene_add_material(scene, glass);
    assert_int_not_equal(index, SCENE_NONE);
    for (uint32_t i = 0; i < scene->meshes[0].triangle_count; ++i)
        scene->meshes[0].materials[i] = i / 2 % 3 == 0 ? index : 0;
    struct accel *accel = soup_accel(scene, &(struct bvh_params){.builder = BVH_SPATIAL});
    assert_true(accel->clipped && accel->record_count > accel->triangle_count);
    uint32_t *times = calloc(accel->triangle_count, sizeof *times), filters = 0;
    assert_non_null(times);
    for (uint32_t i = 0; i < accel->record_count; ++i) {
        const struct gpu_triangle *triangle = &accel->triangles[i];
        bool filter = (triangle->flags & TRIANGLE_FILTER) != 0;
        assert_int_equal(filter, triangle->primitive / 2 % 3 == 0);
        filters += filter;
        assert_true(++times[triangle->primitive] == 1 || !filter);
    }
    assert_true(filters >= accel->triangle_count / 3);
    free(times);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_lost),
        cmocka_unit_test(few_triangles),
        cmocka_unit_test(degenerate_meshes),
        cmocka_unit_test(garbage_of_all_sizes),
        cmocka_unit_test(clips_are_known),
        cmocka_unit_test(clips_hold_what_is_inside),
        cmocka_unit_test(budgets_are_kept_and_used),
        cmocka_unit_test(costs_fall_where_boxes_overlap),
        cmocka_unit_test(overlap_decides),
        cmocka_unit_test(cheap_references_are_not_split),
        cmocka_unit_test(whole_triangles_stay_whole),
        cmocka_unit_test(triangles_are_needed),
        cmocka_unit_test(same_bytes_for_any_thread_count),
        cmocka_unit_test(same_cost_for_any_order),
        cmocka_unit_test(hits_are_the_same),
        cmocka_unit_test(lost_parts_are_noticed),
        cmocka_unit_test(filters_are_met_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
