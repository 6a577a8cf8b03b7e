/* Compares reports on trees with the same numbers by hand, by brute force and by rays. */
#include "accel_fixture.h"

#include "twin/epo.h"
#include "twin/report.h"
#include "unit.h"

#define assert_near(value, expected, by) assert_true(fabs((value) - (expected)) <= (by))

static whit_accel_report report_of(const struct world *world, uint32_t rays)
{
    whit_accel_report report;
    memset(&report, 0, sizeof report);
    assert_int_equal(accel_report(world->accel, rays, &report), WHIT_OK);
    return report;
}

/* ---- Clipping ---- */

TEST(a_triangle_is_cut_to_a_box)
{
    static const float a[3] = {0, 0, 0}, b[3] = {4, 0, 0}, c[3] = {0, 4, 0};
    static const struct {
        struct bvh_box box;
        double area;
    } cases[] = {
        {{{-9, -9, -9}, {9, 9, 9}}, 8.0}, {{{0, 0, 0}, {4, 4, 0}}, 8.0},
        {{{0, 0, 0}, {1, 1, 1}}, 1.0},    {{{1, 1, -1}, {9, 9, 1}}, 2.0},
        {{{0, 0, 0.5f}, {4, 4, 1}}, 0.0}, {{{3, 3, -1}, {9, 9, 1}}, 0.0},
        {{{1, 1, -1}, {2, 2, 1}}, 1.0},   {{{1, 1, -1}, {2.5f, 2.5f, 1}}, 1.75},
        {{{-1, -1, -1}, {0, 9, 1}}, 0.0}, {{{2, 2, -1}, {2, 2, 1}}, 0.0},
        {{{1, -5, -1}, {2, 5, 1}}, 2.5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; ++i) {
        assert_near(epo_clipped_area(a, b, c, &cases[i].box), cases[i].area, 1e-12);
        assert_near(epo_clipped_area(c, b, a, &cases[i].box), cases[i].area, 1e-12);
    }
}

/* The areas of the clipped part and of the rest add up to the whole. */
TEST(pieces_add_up)
{
    uint64_t seed = 1;
    for (int round = 0; round < 2000; ++round) {
        float v[3][3], cut[3];
        for (int i = 0; i < 9; ++i)
            v[i / 3][i % 3] = (float)random_unit(&seed);
        for (int i = 0; i < 3; ++i)
            cut[i] = (float)random_unit(&seed);
        double sum = 0.0;
        for (int part = 0; part < 8; ++part) {
            struct bvh_box box;
            for (int i = 0; i < 3; ++i) {
                box.lo[i] = part >> i & 1 ? cut[i] : 0.0f;
                box.hi[i] = part >> i & 1 ? 1.0f : cut[i];
            }
            sum += epo_clipped_area(v[0], v[1], v[2], &box);
        }
        static const struct bvh_box all = {{0, 0, 0}, {1, 1, 1}};
        assert_near(sum, epo_clipped_area(v[0], v[1], v[2], &all), 1e-12);
    }
}

/* ---- End-point overlap ---- */

/* Marks the primitives in the subtree of a node. */
static void mark(const struct accel *accel, uint32_t node, uint8_t *inside)
{
    const struct gpu_bvh_node *at = &accel->nodes[node];
    for (uint32_t i = 0; i < bvh_count(at); ++i)
        inside[accel->triangles[at->first + i].primitive] = 1;
    if (bvh_count(at) > 0)
        return;
    mark(accel, at->first, inside);
    mark(accel, at->first + 1, inside);
}

/* The end-point overlap, computed from all pairs of a node and a triangle. */
static double brute_overlap(const struct accel *accel, const struct scene_mesh *mesh)
{
    const struct accel_mesh *m = &accel->meshes[0];
    own_memory uint8_t *inside = malloc(mesh->triangle_count);
    double sum = 0.0;
    assert_non_null(inside);
    for (uint32_t i = 0; i < m->node_count; ++i) {
        const struct gpu_bvh_node *node = &accel->nodes[m->first_node + i];
        if (i == 1)
            continue;
        memset(inside, 0, mesh->triangle_count);
        mark(accel, m->first_node + i, inside);
        struct bvh_box box;
        memcpy(box.lo, node->lo, sizeof box.lo);
        memcpy(box.hi, node->hi, sizeof box.hi);
        uint32_t count = bvh_count(node);
        for (uint32_t k = 0; k < mesh->triangle_count; ++k) {
            const uint32_t *corner = &mesh->indices[3 * k];
            if (!inside[k])
                sum +=
                    (count ? count : 1) * epo_clipped_area(&mesh->positions[3 * corner[0]],
                                                           &mesh->positions[3 * corner[1]],
                                                           &mesh->positions[3 * corner[2]], &box);
        }
    }
    return sum;
}

/* Long triangles that cross each other, some on planes of the axes. */
static struct soup soup_crossing(uint32_t count, uint64_t seed)
{
    struct soup soup = soup_make("crossing", count);
    for (uint32_t i = 0; i < count; ++i) {
        float *v = &soup.positions[9 * i];
        for (uint32_t k = 0; k < 9; ++k)
            v[k] = (float)(random_unit(&seed) * (k % 3 == i % 3 ? 0.2 : 1.0));
        for (uint32_t k = 0; i % 5 == 0 && k < 3; ++k)
            v[3 * k] = 0.5f;
    }
    return soup;
}

static const whit_accel_params builds[] = {
    {.build = WHIT_BUILD_BINNED},
    {.build = WHIT_BUILD_MEDIAN},
    {.build = WHIT_BUILD_BINNED, .leaf_limit = 1, .bins = 4},
    {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 15},
    {.build = WHIT_BUILD_BINNED, .threads = 1},
};
enum { BUILD_COUNT = sizeof builds / sizeof builds[0] };

TEST(overlap_is_that_of_brute_force)
{
    static const uint32_t counts[] = {1, 2, 3, 40, 300};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) {
        for (size_t k = 0; k < BUILD_COUNT; ++k) {
            own_world world = world_of_soup(soup_crossing(counts[i], 7 + i), builds[k]);
            struct bvh_epo epo;
            assert_int_equal(accel_mesh_epo(world.accel, 0, &epo), WHIT_OK);
            double brute = brute_overlap(world.accel, &world.scene->meshes[0]);
            assert_true(counts[i] < 40 || brute > 0.0);
            assert_near(epo.overlap, brute, 1e-10 * (1.0 + brute));
        }
    }
}

/* Two leaves of one triangle each. The box of the second, [1, 3] x [0, 2], contains the part of the
   first triangle, (0, 0) (2, 0) (0, 2), that is right of x = 1: area 1/2. The box of the first,
   [0, 2] x [0, 2], contains the part of the second, (1, 2) (3, 0) (3, 2), that is left of x = 2:
   area 1/2. Each triangle has an area of 2. */
TEST(overlap_by_hand)
{
    static const float v[] = {0, 0, 0, 2, 0, 0, 0, 2, 0, 1, 2, 0, 3, 0, 0, 3, 2, 0};
    own_world world =
        world_of_soup(soup_of_mesh("two", mesh_triangles(v, 2)),
                      (whit_accel_params){.build = WHIT_BUILD_MEDIAN, .leaf_limit = 1});
    struct bvh_epo epo;
    assert_int_equal(world.accel->meshes[0].node_count, 4);
    assert_int_equal(accel_mesh_epo(world.accel, 0, &epo), WHIT_OK);
    assert_near(epo.surface, 4.0, 1e-12);
    assert_near(epo.overlap, 1.0, 1e-12);
    whit_accel_report report = report_of(&world, 0);
    assert_near(report.epo, 0.25, 1e-12);
    /* Half areas: of the root 3 x 2, of the children 2 x 2 each, of what they share 1 x 2. */
    assert_near(report.overlap, 2.0 / 6.0, 1e-12);
    assert_near(report.predicted_inner_nodes, 1.0, 1e-12);
    assert_near(report.predicted_triangles, 8.0 / 6.0, 1e-12);
    assert_near(report.sah_cost, 1.0 + 8.0 / 6.0, 1e-12);
    assert_int_equal(report.measured_rays, 0);
    assert_int_equal(report.leaves_at_depth[1], 2);
    assert_int_equal(report.leaves_of_size[1], 2);
}

/* ---- Shape ---- */

TEST(report_agrees_with_the_tree)
{
    for (size_t i = 0; i < BUILD_COUNT; ++i) {
        own_world world = world_of_soup(soup_sphere(60, 60), builds[i]);
        const struct accel *accel = world.accel;
        whit_accel_report report = report_of(&world, 0);
        uint64_t leaves = 0, triangles = 0, deepest = 0, at_depth = 0;
        for (uint32_t k = 0; k < WHIT_LEAF_BINS; ++k) {
            leaves += report.leaves_of_size[k];
            triangles += k * report.leaves_of_size[k];
        }
        for (uint32_t k = 0; k < WHIT_DEPTH_BINS; ++k) {
            at_depth += report.leaves_at_depth[k];
            deepest = report.leaves_at_depth[k] ? k : deepest;
        }
        assert_int_equal(triangles, accel->record_count);
        assert_int_equal(leaves, at_depth);
        assert_int_equal(2 * leaves, accel->meshes[0].node_count); /* pairs, and the unused node */
        assert_int_equal(deepest, accel->mesh_depth);
        assert_near(report.sah_cost, accel->meshes[0].sah_cost, 1e-5 * accel->meshes[0].sah_cost);
    }
}

TEST(threads_change_nothing)
{
    whit_accel_report reports[2];
    for (uint32_t i = 0; i < 2; ++i) {
        own_world world =
            world_of_soup(soup_crossing(3000, 3), (whit_accel_params){.threads = i ? 5 : 1});
        reports[i] = report_of(&world, 5000);
    }
    assert_memory_equal(&reports[0], &reports[1], sizeof reports[0]);
}

/* ---- Visits ---- */

/* Triangles with hardly any area, along the diagonals of their boxes, so that no ray hits one. */
static struct soup soup_apart(uint32_t side, double size)
{
    uint32_t count = side * side * side;
    uint64_t seed = 11;
    struct soup soup = soup_make("hair apart", count);
    for (uint32_t i = 0; i < count; ++i) {
        float *p = &soup.positions[9 * i];
        const uint32_t cell[3] = {i % side, i / side % side, i / side / side};
        for (int k = 0; k < 3; ++k) {
            p[k] = (float)(cell[k] + 0.5 * (1.0 - size) * random_unit(&seed));
            p[3 + k] = p[k] + (float)(size * (0.3 + 0.7 * random_unit(&seed)));
            p[6 + k] = p[3 + k];
        }
        p[6] = nextafterf(p[6], -1.0f);
    }
    return soup;
}

TEST(nothing_hit_is_visited_as_predicted)
{
    for (size_t i = 0; i < BUILD_COUNT; ++i) {
        own_world world = world_of_soup(soup_apart(12, 0.6), builds[i]);
        whit_accel_report report = report_of(&world, 40000);
        assert_int_equal(world.scene->triangle_total, 12 * 12 * 12);
        assert_int_equal(report.measured_rays, 40000);
        assert_near(report.measured_inner_nodes / report.predicted_inner_nodes, 1.0, 0.02);
        assert_near(report.measured_triangles / report.predicted_triangles, 1.0, 0.02);
    }
}

/* Nodes behind a hit are not opened, so that rays at a closed sphere open fewer than predicted from
   areas. */
TEST(hits_save_visits)
{
    own_world world = world_of_soup(soup_sphere(80, 80), builds[0]);
    whit_accel_report report = report_of(&world, 20000);
    assert_true(report.measured_inner_nodes < 0.9 * report.predicted_inner_nodes);
    assert_true(report.measured_inner_nodes > 0.3 * report.predicted_inner_nodes);
}

/* Rays widen the boxes of split triangles by a share of how far away the mesh is. */
TEST(split_triangles_are_visited_alike_anywhere)
{
    whit_accel_report reports[2];
    for (int far = 0; far < 2; ++far) {
        random_state = 5;
        struct soup soup = soup_rooms(500);
        for (uint32_t i = 0; i < 9 * soup.count; ++i)
            soup.positions[i] += far ? 0x1p16f : 0.0f;
        own_world world =
            world_of_soup(soup, (whit_accel_params){.build = WHIT_BUILD_SPATIAL, .leaf_limit = 1});
        assert_true(world.accel->clipped);
        reports[far] = report_of(&world, 20000);
    }
    assert_near(reports[1].measured_inner_nodes / reports[0].measured_inner_nodes, 1.0, 0.01);
    assert_near(reports[1].measured_triangles / reports[0].measured_triangles, 1.0, 0.01);
}

/* A mesh counts once, whatever the number of its instances, and by the area of its box. */
TEST(meshes_are_weighed_by_area)
{
    struct scene *scene = scene_begin(&silent, "test");
    static const uint32_t sides[] = {4, 60, 0, 12};
    static const double sizes[] = {100.0, 1.0, 0.0, 5.0};
    for (uint32_t i = 0; i < 4; ++i) {
        struct scene_mesh none = {0};
        scene_put_mesh(scene, sides[i] ? mesh_sphere(sizes[i], sides[i], sides[i]) : none);
        for (uint32_t k = 0; k <= i; ++k) {
            const double at[3] = {300.0 * k, 200.0 * i, 0}, turn[4] = {0, 0, 0, 1};
            struct affine matrix = affine_from_trs(at, turn, (double[]){1, 2, 3});
            scene_put_again(scene, i, &(struct put){.matrix = &matrix});
        }
    }
    own_world world = world_of(scene, builds[0]);
    const struct accel *accel = world.accel;
    whit_accel_report report = report_of(&world, 20000);
    assert_true(accel->mesh_count >= 3); /* the one without triangles may be gone */
    uint64_t leaves = 0;
    double area = 0.0, cost = 0.0;
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        const struct accel_mesh *m = &accel->meshes[i];
        leaves += m->node_count / 2;
        double x = (double)m->box.hi[0] - (double)m->box.lo[0];
        double y = (double)m->box.hi[1] - (double)m->box.lo[1];
        double z = (double)m->box.hi[2] - (double)m->box.lo[2];
        double weight = m->node_count ? x * y + y * z + z * x : 0.0;
        area += weight;
        cost += weight * m->sah_cost;
    }
    for (uint32_t i = 0; i < WHIT_DEPTH_BINS; ++i)
        leaves -= report.leaves_at_depth[i];
    assert_int_equal(leaves, 0);
    assert_near(report.sah_cost, cost / area, 1e-5 * cost / area);
    assert_true(report.measured_inner_nodes > 0.3 * report.predicted_inner_nodes);
    assert_true(report.measured_inner_nodes < report.predicted_inner_nodes);
}

TEST(nothing_has_a_report)
{
    own_world world = world_of_soup(soup_make("nothing", 0), builds[0]);
    whit_accel_report report;
    memset(&report, 1, sizeof report);
    assert_int_equal(accel_report(world.accel, 20000, &report), WHIT_OK);
    assert_near(report.sah_cost, 0.0, 0.0);
    assert_int_equal(report.measured_rays, 0);
}
