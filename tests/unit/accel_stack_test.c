/* The float mirror's traversal of trees written by hand: deep trees, and its counters. */
#include "accel_fixture.h"

#include "tree_fixture.h"
#include "unit.h"

enum { ORDERS = 3, STACK_SIZE = 512 /* of the traversal */ };

static struct accel *caterpillar(uint32_t depth)
{
    struct accel *accel = array_alloc_zeroed(1, sizeof *accel);
    assert_non_null(accel);
    accel->nodes = caterpillar_nodes(depth, 0);
    accel->triangles = array_alloc_aligned(depth + 1, sizeof *accel->triangles);
    accel->instances = array_alloc_aligned(1, sizeof *accel->instances);
    accel->meshes = array_alloc_zeroed(1, sizeof *accel->meshes);
    assert_true(accel->nodes && accel->triangles && accel->instances && accel->meshes);
    for (uint32_t i = 0; i <= depth; ++i) {
        struct gpu_triangle *triangle = &accel->triangles[i];
        float corners[9];
        caterpillar_corners(i, corners);
        *triangle = (struct gpu_triangle){.primitive = i};
        memcpy(triangle->v0, corners, sizeof triangle->v0);
        memcpy(triangle->v1, corners + 3, sizeof triangle->v1);
        memcpy(triangle->v2, corners + 6, sizeof triangle->v2);
    }
    accel->instances[0] = (struct gpu_instance){.root = accel->nodes[0].first};
    accel->meshes[0] =
        (struct accel_mesh){.record_count = depth + 1, .triangle_count = depth + 1, .depth = depth};
    accel->node_count = 2 * depth + 2;
    accel->record_count = accel->triangle_count = depth + 1;
    accel->instance_count = accel->mesh_count = 1;
    accel->mesh_depth = depth;
    accel->single_identity = true;
    return accel;
}

static const uint32_t levels[] = {NUMERICS_WATERTIGHT, NUMERICS_FAST, NUMERICS_EXACT};
enum { LEVELS = sizeof levels / sizeof *levels };

TEST(deep_trees_are_walked)
{
    const uint32_t depths[] = {1, 31, 32, 33, 63, 64, 65, 128, 200, 511, 512};
    for (size_t d = 0; d < sizeof depths / sizeof *depths; ++d) {
        uint32_t depth = depths[d];
        own_accel *accel = caterpillar(depth);
        for (uint32_t way = 0; way < 2 * ORDERS * LEVELS; ++way) {
            uint32_t order = way / 2 % ORDERS, nearest = way % 2 ? depth : 0;
            struct gpu_ray ray = caterpillar_ray(depth, way % 2);
            struct gpu_cost cost = {0};
            struct traverse_params params = {.order = order,
                                             .numerics = levels[way / (2 * ORDERS)]};
            struct gpu_hit hit = trace_with(accel, params, &ray, &cost);
            assert_int_equal(hit.primitive, nearest);
            assert_true(hit.t == 1.0f);
            /* Order BASIC keeps as much from below: the rest of the chain is first in each pair. */
            bool deep = way % 2 || order == ORDER_BASIC;
            assert_int_equal(cost.stack, deep ? depth : 1);
            /* A node that was pushed is opened once it is popped, even if it is behind the hit. */
            assert_int_equal(cost.depth, deep || depth == 1 ? depth : 2);
            params.any = true;
            assert_int_not_equal(trace_with(accel, params, &ray, NULL).primitive, HIT_NONE);
        }
    }
}

TEST(too_deep_trees_are_reported)
{
    own_accel *accel = caterpillar(STACK_SIZE + 1);
    for (uint32_t way = 0; way < ORDERS * LEVELS; ++way) {
        uint32_t status = 0;
        struct gpu_ray ray = caterpillar_ray(STACK_SIZE + 1, true);
        struct gpu_hit hit;
        const struct traverse_params params = {.order = way % ORDERS,
                                               .numerics = levels[way / ORDERS]};
        traverse_ray(accel, &params, &ray, &hit, NULL, &status);
        assert_int_equal(status, STATUS_NODE_STACK_OVERFLOW);
    }
}

/* The counters of a traversal of a chain have the values that were worked out by hand. */
TEST(costs_are_those_of_the_chain)
{
    enum { DEPTH = 10 };
    const struct traverse_params closest = {.order = ORDER_DISTANCE},
                                 any = {.order = ORDER_DISTANCE, .any = true},
                                 sign = {.order = ORDER_SIGN, .any = true};
    own_accel *accel = caterpillar(DEPTH);
    struct gpu_ray above = caterpillar_ray(DEPTH, true), below = caterpillar_ray(DEPTH, false);
    struct gpu_cost cost = {0};
    /* Down to triangle DEPTH; then every leaf on the stack is popped and tested: its box was met
       when it was pushed. */
    trace_with(accel, closest, &above, &cost);
    assert_int_equal(cost.rays, 1);
    assert_int_equal(cost.inner_nodes, DEPTH);
    assert_int_equal(cost.leaves, DEPTH + 1);
    assert_int_equal(cost.triangles, DEPTH + 1);
    assert_int_equal(cost.instances, 0);
    /* Added on top; stack and depth are the largest. */
    trace_with(accel, any, &above, &cost);
    assert_int_equal(cost.rays, 2);
    assert_int_equal(cost.inner_nodes, 2 * DEPTH);
    assert_int_equal(cost.leaves, DEPTH + 2);
    assert_int_equal(cost.triangles, DEPTH + 2);
    assert_int_equal(cost.stack, DEPTH);
    assert_int_equal(cost.depth, DEPTH);
    /* From below: one pair and one leaf, the rest lies behind the hit. */
    cost = (struct gpu_cost){0};
    trace_with(accel, sign, &below, &cost);
    assert_int_equal(cost.inner_nodes, 1);
    assert_int_equal(cost.leaves, 1);
    assert_int_equal(cost.triangles, 1);
    assert_int_equal(cost.stack, 1);
    assert_int_equal(cost.depth, 1);
}

/* A node that was pushed keeps its level, however deep the way went meanwhile. */
TEST(levels_come_back_with_their_nodes)
{
    own_accel *accel = caterpillar(4);
    struct gpu_ray ray = caterpillar_ray(4, true);
    struct gpu_cost cost = {0};
    /* In place of the topmost leaf, which is popped last: the deepest pair once more. */
    accel->nodes[3].first = 8;
    accel->nodes[3].count = 0;
    trace_with(accel, (struct traverse_params){.order = ORDER_DISTANCE}, &ray, &cost);
    assert_int_equal(cost.inner_nodes, 5);
    assert_int_equal(cost.depth, 4);
}

/* A box that a clip left short of its triangle by less than the margin. */
TEST(clipped_boxes_get_a_margin)
{
    own_accel *accel = caterpillar(1);
    struct gpu_ray ray = {.origin = {1.9999f, -0.99999f, -1}, .dir = {0, 0, 1}, .t_max = INFINITY};
    accel->instances[0].reach = 2.0f;
    for (uint32_t i = 2; i < 4; ++i)
        accel->nodes[i].lo[1] = -0.99999f + 0x1.8p-18f; /* short of what the ray needs */
    assert_int_equal(trace(accel, &ray).primitive, HIT_NONE);
    accel->clipped = true;
    assert_int_equal(trace(accel, &ray).primitive, 0);
    /* The margin is (2 + 2) * 2^-19 = 2^-17: nothing beyond that is forgiven. */
    for (uint32_t i = 2; i < 4; ++i)
        accel->nodes[i].lo[1] = -0.99999f + 0x1.1p-17f;
    assert_int_equal(trace(accel, &ray).primitive, HIT_NONE);
}

/* Without instances to go through, records say whose they are. */
TEST(flat_records_name_their_instance)
{
    own_accel *accel = caterpillar(1);
    struct gpu_ray ray = {.origin = {0, 0, -1}, .dir = {0, 0, 1}, .t_max = INFINITY};
    struct gpu_hit plain = trace(accel, &ray);
    accel->single_identity = false;
    accel->flat = true;
    accel->meshes[0].root = accel->nodes[0].first;
    /* Both in one place, as primitive 0 of two instances: the smaller instance is the second. */
    accel->triangles[1] = accel->triangles[0];
    caterpillar_box(0, 0, &accel->nodes[2]);
    accel->triangles[0].flags = 7u << TRIANGLE_INSTANCE_SHIFT;
    accel->triangles[1].flags = 5u << TRIANGLE_INSTANCE_SHIFT | TRIANGLE_MIRRORED;
    struct gpu_hit hit = trace(accel, &ray), brute = trace_brute(accel, &ray);
    assert_int_equal(hit.instance, 5);
    assert_true(hit.ng_z == -plain.ng_z && plain.ng_z != 0.0f);
    assert_memory_equal(&hit, &brute, sizeof hit);
    hit = trace_with(accel, (struct traverse_params){.own = &brute}, &ray, NULL);
    assert_int_equal(hit.instance, 7);
    assert_true(hit.ng_z == plain.ng_z);
}
