/* Nodes of 16 bytes: the hits of nodes of 32 bytes, which the float mirror reads, bit for bit. */
#include "../cases.h"
#include "accel/quantized.h"
#include "ray_fixture.h"
#include "unit.h"

static const whit_renderer_params small_nodes = {
    .width = 16, .height = 16, .depth = 4, .node_bytes = 16};

static struct scene *scaled_terrain(float scale, float offset)
{
    struct scene *scene = scene_begin(&fixture_log, "terrain");
    struct scene_mesh mesh = mesh_terrain(10.0, 2.0, 24, 3);
    for (uint32_t i = 0; i < 3 * mesh.vertex_count; ++i)
        mesh.positions[i] = (mesh.positions[i] + (i % 3 == 1 ? offset : -offset)) * scale;
    scene_put(scene, mesh, NULL);
    return scene;
}

/* Makes rays whose origins are up to 10^6 sizes of the scene away, whose directions are
   2^-135 to 2^165 times as long, and some of which start behind their origin. At NUMERICS_EXACT
   origins are at most 10^2 sizes away and directions 2^-104 times as long or more, as other rays
   meet more candidates than lavapipe's loops can settle. */
static void make_hard(struct gpu_ray *rays, uint32_t count, bool exact)
{
    const float away[] = {0.0f, 1e1f, 1e2f, exact ? 1e2f : 1e6f};
    const int exponents[] = {0, 100, exact ? -104 : -135, 20, -20, 120, 165};
    uint64_t random = 5;
    for (uint32_t i = 0; i < count; ++i) {
        struct gpu_ray *ray = &rays[i];
        float far = away[i / 4 % 4];
        int exponent = exponents[i / 16 % 7];
        for (int k = 0; k < 3; ++k) {
            ray->origin[k] -= ray->dir[k] * far;
            ray->dir[k] = ldexpf(ray->dir[k], exponent);
        }
        ray->t_min = i % 3 ? 0.0f : ldexpf(-2.0f * fabsf(random_float_signed(&random)), -exponent);
        ray->t_max = i % 5 ? INFINITY : ldexpf(far + 1.0f, -exponent);
    }
}

/* Makes rays in the plane of a side of the grid or of boxes, and beside it. Directions of every
   second ray are 2^-118 times as long, and go beside a side by a denormal. */
static void run_along_sides(const struct accel *accel, struct gpu_ray *rays, uint32_t count)
{
    const struct accel_mesh *mesh = &accel->meshes[0];
    uint64_t random = 17;
    for (uint32_t i = 0; i < count; ++i) {
        uint32_t at = 2 + random_below(&random, mesh->node_count - 2), axis = i % 3;
        const struct gpu_bvh_node *node = &accel->nodes[mesh->first_node + at];
        rays[i].origin[axis] = i & 4 ? node->lo[axis] : node->hi[axis];
        for (int k = 0; i & 32 && k < 3; ++k)
            rays[i].dir[k] = ldexpf(rays[i].dir[k], -118);
        float beside = ldexpf(rays[i].dir[axis], i & 32 ? -15 : -60);
        rays[i].dir[axis] = i & 8 ? 0.0f : i & 16 ? -0.0f : beside;
    }
}

static void check(float scale, float offset, uint32_t numerics)
{
    const uint32_t count = cases_of(32000);
    const whit_renderer_params params = {
        .width = 16, .height = 16, .numerics = numerics, .node_bytes = 16};
    own_fixture unscaled = fixture_open(scaled_terrain(1.0f, offset), NULL, &params);
    own_fixture f = fixture_open(scaled_terrain(scale, offset), NULL, &params);
    own_memory struct gpu_ray *rays = array_alloc(count, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(count, sizeof *hits);
    uint32_t met = 0, unlike = 0;
    assert_true(rays && hits);
    assert_true(f.renderer->quantized);
    for (uint32_t i = 0; i < 2; ++i) {
        aim_rays(&unscaled, rays, count, 3 + i);
        for (uint32_t k = 0; k < count; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                rays[k].origin[axis] *= scale;
                rays[k].dir[axis] *= scale;
            }
        }
        if (i == 0)
            make_hard(rays, count, numerics == NUMERICS_EXACT);
        else
            run_along_sides(f.accel, rays, count);
        unlike += trace_beside_twin(&f, false, rays, count, hits, NULL).hits;
        for (uint32_t k = 0; k < count; ++k)
            met += hits[k].primitive != HIT_NONE;
    }
    print_message("  scale %g, offset %g, level %u: %u of %u rays hit, %u unlike the mirror\n",
                  (double)scale, (double)offset, numerics, met, 2 * count, unlike);
    assert_true(met > count / 8);
    assert_int_equal(unlike, 0);
}

TEST(hits_are_those_of_large_nodes)
{
    check(1.0f, 0.0f, NUMERICS_WATERTIGHT);
    check(1e-15f, 1e4f, NUMERICS_WATERTIGHT);
    check(1e15f, 0.0f, NUMERICS_WATERTIGHT);
    check(1.0f, 0.0f, NUMERICS_EXACT);
    check(1e-2f, 1e2f, NUMERICS_EXACT);
    check(1e6f, 0.0f, NUMERICS_EXACT);
}

/* A box on the grid contains the box of its node. */
TEST(boxes_are_rounded_outwards)
{
    own_fixture f = fixture_open(scaled_terrain(3.7f, 1.3f), NULL, NULL);
    const struct accel_mesh *mesh = &f.accel->meshes[0];
    assert_true(accel_can_quantize(mesh));
    own_memory struct gpu_quantized_node *nodes = accel_quantize(f.accel, mesh);
    assert_non_null(nodes);
    struct gpu_quantized_grid head;
    memcpy(&head, nodes, sizeof head);
    for (uint32_t i = mesh->first_node + 2; i < mesh->first_node + mesh->node_count; ++i) {
        const uint32_t sides[3] = {nodes[i].x, nodes[i].y, nodes[i].z};
        for (int k = 0; k < 3; ++k) {
            double corner = (double)head.corner[k], step = 1.0 / (double)head.scale;
            double lo = corner + step * (double)(sides[k] & 0xffff);
            double hi = corner + step * (double)(sides[k] >> 16);
            const struct gpu_bvh_node *node = &f.accel->nodes[i];
            assert_true(lo <= (double)node->lo[k] && (double)node->lo[k] < lo + step);
            assert_true(hi >= (double)node->hi[k] && (double)node->hi[k] > hi - step);
        }
    }
}

/* The only object moves to where its file puts it at 1 s, and so needs no tree over instances from
   then on. */
TEST(a_tree_that_loses_its_instances_gets_nodes)
{
    static const float times[] = {0, 1}, path[] = {3, 1, 0, 0, 0, 0};
    struct scene *scene = scene_begin(&fixture_log, "terrain that moves");
    uint32_t node = scene_put_node(scene, SCENE_NONE, 0, 0, 0);
    scene_put(scene, mesh_terrain(10.0, 2.0, 24, 3), &(struct put){.node = &node});
    scene_put_channel(scene, node, SCENE_PATH_TRANSLATION, 2, times, path);
    own_fixture f = fixture_open(scene, NULL, &small_nodes);
    struct gpu_ray rays[256];
    struct gpu_hit hits[256];
    assert_false(f.renderer->quantized);
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    assert_true(f.renderer->quantized);
    aim_rays(&f, rays, 256, 3);
    for (int i = 0; i < 256; ++i) {
        rays[i].origin[0] -= path[0];
        rays[i].origin[1] -= path[1];
    }
    assert_int_equal(trace_beside_twin(&f, false, rays, 256, hits, NULL).hits, 0);
    assert_true(count_met(hits, 256) > 64);
}

/* A ray would meet all boxes, more than lavapipe's loops have turns for, if the margin grew with
   how far behind its origin it starts, or for short directions. */
TEST(boxes_stay_narrow)
{
    const whit_accel_params trees = {.leaf_limit = 1};
    struct scene *scene = scene_begin(&fixture_log, "large terrain");
    scene_put(scene, mesh_terrain(10.0, 2.0, 256, 3), NULL);
    own_fixture f = fixture_open(scene, &trees, &small_nodes);
    struct gpu_ray rays[64];
    struct gpu_hit hits[64];
    aim_rays(&f, rays, 64, 3);
    for (int i = 0; i < 64; ++i) {
        for (int k = 0; i % 3 == 0 && k < 3; ++k)
            rays[i].dir[k] *= 0x1p-110f;
        rays[i].t_min = i % 2 ? -1e7f : -INFINITY;
    }
    assert_true(f.renderer->quantized);
    assert_int_equal(trace_beside_twin(&f, false, rays, 64, hits, NULL).hits, 0);
    assert_true(count_met(hits, 64) > 16);
}

/* On a ground 1000 times as large as the rest, boxes of the rest have few steps of the grid. */
TEST(only_trees_that_stay_small_on_the_grid_get_nodes)
{
    static const double sizes[] = {10, 1e4};
    const whit_accel_params trees = {.instances = WHIT_INSTANCES_OFF};
    for (int i = 0; i < 2; ++i) {
        struct scene *scene = scene_begin(&fixture_log, "terrain on a ground");
        scene_put(scene, mesh_terrain(10.0, 2.0, 80, 3), NULL);
        scene_put(scene, mesh_terrain(sizes[i], 2.0, 1, 3), NULL);
        own_fixture f = fixture_open(scene, &trees, NULL);
        assert_int_equal(f.renderer->quantized, i == 0);
    }
}
