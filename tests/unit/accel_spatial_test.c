/* Spatial splits: the conditions for a split, the clipping of triangles, and hits at the seams.
   accel_build_tree_test.c tests that every tree is right. */
#include "accel_build_fixture.h"

#include "bvh/clip.h"
#include "bvh/complete.h"
#include "unit.h"

/* ---- Clipping ---- */

TEST(clips_are_known)
{
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
        bool some = clip_triangle_box(&triangle, &rows[i].cell, &box);
        if (some != rows[i].some || (some && memcmp(&box, &rows[i].box, sizeof box) != 0))
            fail_msg("row %zu", i);
    }
}

/* Clips by planes through vertices and at random places, of triangles down to lines and points,
   near and far from the origin. */
TEST(clips_hold_what_is_inside)
{
    random_state = 3;
    uint32_t empty = 0;
    for (int round = 0; round < 10000; ++round) {
        int power = (int)random_below(&random_state, 40);
        float at = (float)ldexp(random_float(&random_state) - 0.5, power);
        float thin =
            round % 4 == 0 ? 0.0f : (float)ldexp(1.0, -(int)random_below(&random_state, 30));
        own_soup soup = soup_hair(1, thin);
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
            /* Rounding may lose only a part that just touches the cell. */
            for (int k = 0; k < 3; ++k) {
                cell.lo[k] = nextafterf(cell.lo[k], INFINITY);
                cell.hi[k] = nextafterf(cell.hi[k], -INFINITY);
            }
            assert_int_equal(points_inside(points, cell.lo, cell.hi), 0);
            ++empty;
        }
    }
    assert_true(empty > 300 && empty < 7000);
}

/* ---- Budgets ---- */

/* The number of references by budget, and by the overlap that a split needs. In the last row there
   would be 15,679 references without the rule that a reference is not split if it costs less as a
   whole. */
TEST(budgets_are_kept_and_used)
{
    enum { COUNT = 4000 };
    static const struct {
        float budget, alpha;
        uint32_t min, max;
    } rows[] = {{-1.0f, 0, COUNT, COUNT},
                {1e-4f, 0, COUNT, COUNT},
                {0.01f, 0, COUNT, COUNT + 40},
                {0.1f, 0, COUNT + 280, COUNT + 400},
                {0.5f, 0, COUNT + 1400, COUNT + 2000},
                {1.0f, 0, COUNT + 2800, COUNT + 4000},
                {3.0f, 0, COUNT, COUNT + 12000},
                {10.0f, 1e-9f, COUNT + 1, 15000}};
    random_state = 5;
    own_soup soup = soup_rooms(COUNT / 2);
    double last = INFINITY;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        own_bvh bvh = soup_build(&soup, (whit_accel_params){.build = WHIT_BUILD_SPATIAL,
                                                            .spatial_budget = rows[i].budget,
                                                            .spatial_alpha = rows[i].alpha});
        if (bvh.reference_count < rows[i].min || bvh.reference_count > rows[i].max ||
            bvh.sah_cost > last)
            fail_msg("budget %g: %u references, cost %g after %g", (double)rows[i].budget,
                     bvh.reference_count, bvh.sah_cost, last);
        last = rows[i].alpha > 0.0f ? last : bvh.sah_cost;
    }
}

/* Splits are tried only where children overlap enough. */
TEST(overlap_decides)
{
    static const float alphas[] = {1e-9f, 1e-2f, 0.1f, 1.0f};
    random_state = 6;
    own_soup soup = soup_rooms(1000);
    uint32_t last = UINT32_MAX;
    for (int i = 0; i < 4; ++i) {
        own_bvh bvh = soup_build(
            &soup, (whit_accel_params){.build = WHIT_BUILD_SPATIAL, .spatial_alpha = alphas[i]});
        assert_true(bvh.reference_count < last);
        last = bvh.reference_count;
    }
    assert_int_equal(last, soup.count);
}

TEST(whole_triangles_stay_whole)
{
    random_state = 7;
    own_soup soup = soup_rooms(1500);
    own_memory uint8_t *whole = calloc(soup.count, 1);
    own_memory uint32_t *times = calloc(soup.count, sizeof *times);
    assert_true(whole && times);
    soup.triangles.whole = whole;
    for (int round = 0; round < 3; ++round) {
        for (uint32_t i = 0; i < soup.count; ++i)
            whole[i] = round == 0 ? 0 : round == 1 ? i / 2 % 2 : 1;
        own_bvh bvh = soup_build(
            &soup, (whit_accel_params){.build = WHIT_BUILD_SPATIAL, .spatial_budget = 2.0f});
        memset(times, 0, soup.count * sizeof *times);
        for (uint32_t i = 0; i < bvh.reference_count; ++i)
            ++times[bvh.order[i]];
        for (uint32_t i = 0; i < soup.count; ++i)
            assert_true(times[i] == 1 || (times[i] > 1 && !whole[i]));
        assert_int_equal(bvh.clipped, round < 2);
        assert_true(is_covered(&soup, &bvh));
    }
}

/* ---- Hits ---- */

/* A ray, from near or far, to a point where an edge of a triangle crosses a face of a leaf: there
   the box of a part has its corners. Every fourth ray is nearly parallel to the triangle. */
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

TEST(hits_are_the_same)
{
    const uint32_t rays = cases_of(12000);
    random_state = 10;
    struct soup soups[] = {soup_rooms(1500), soup_hair(2500, 1e-3f), soup_hair(1500, 0.05f)};
    for (size_t s = 0; s < sizeof soups / sizeof *soups; ++s) {
        own_world plain = world_of_soup(soups[s], (whit_accel_params){0});
        own_accel *split = accel_of(
            plain.scene,
            (whit_accel_params){.build = WHIT_BUILD_SPATIAL, .leaf_limit = 1, .spatial_budget = 4});
        uint32_t found = 0;
        for (uint32_t i = 0; i < rays; ++i) {
            struct gpu_ray ray = ray_at_leaf(split, i % 3 == 0 ? 1e3 : i % 3 == 1 ? 30.0 : 1.0);
            struct gpu_hit expected = trace(plain.accel, &ray), hit = trace(split, &ray);
            assert_memory_equal(&hit, &expected, sizeof hit);
            found += hit.primitive != HIT_NONE;
        }
        assert_true(found > rays / 2);
    }
}

/* The validator notices a leaf whose box lacks a piece of a part. */
TEST(lost_parts_are_noticed)
{
    random_state = 12;
    own_world world = world_of_soup(
        soup_rooms(300),
        (whit_accel_params){.build = WHIT_BUILD_SPATIAL, .leaf_limit = 1, .spatial_budget = 3});
    struct accel *accel = world.accel;
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
        messages.last_error[0] = 0;
        refused += accel_validate(accel) != WHIT_OK;
        by_points += strstr(messages.last_error, "a part of a primitive") != NULL;
        memcpy(pair, kept, sizeof kept);
    }
    assert_true(refused > 50 && by_points > 10);
}

/* Shadow rays add up filters record by record: each must be there once. */
TEST(filters_are_met_once)
{
    random_state = 11;
    own_soup soup = soup_rooms(1500);
    struct scene *scene = soup_scene(&soup);
    struct scene_material glass = material_grey("glass");
    set_rgb(glass.transmission, 0.5f, 0.5f, 0.5f);
    uint32_t index = scene_put_material(scene, glass);
    for (uint32_t i = 0; i < scene->meshes[0].triangle_count; ++i)
        scene->meshes[0].materials[i] = i / 2 % 3 == 0 ? index : 0;
    own_world world = world_of(scene, (whit_accel_params){.build = WHIT_BUILD_SPATIAL});
    const struct accel *accel = world.accel;
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
}
