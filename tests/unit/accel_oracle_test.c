/* The double-precision oracle: right where the answer is known, the same by tree and by brute
   force, and its margin explains every difference from the float twin. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../cases.h"
#include "../scenes.h"
#include "accel/accel.h"
#include "oracle/oracle.h"
#include "random_fixture.h"
#include "twin/traverse.h"

static const struct log silent;

static struct scene_mesh soup(uint32_t count, double size)
{
    float *corners = calloc((size_t)count * 9, sizeof *corners);
    assert_non_null(corners);
    for (uint32_t i = 0; i < count; ++i) {
        double centre[3] = {random_signed(&random_state), random_signed(&random_state),
                            random_signed(&random_state)};
        for (uint32_t k = 0; k < 9; ++k)
            corners[9 * i + k] = (float)(centre[k % 3] + size * random_signed(&random_state));
    }
    struct scene_mesh mesh = mesh_triangles(corners, count);
    free(corners);
    return mesh;
}

struct world {
    struct scene *scene;
    struct accel *accel;
};

static struct world finish(struct scene *scene)
{
    struct world world = {.scene = scene};
    scene_ready(scene);
    assert_int_equal(accel_create(&silent, scene, NULL, &world.accel), WHIT_OK);
    return world;
}

static void world_destroy(struct world *world)
{
    accel_destroy(world->accel);
    scene_destroy(world->scene);
}

static struct world soup_world(void)
{
    random_state = 1;
    struct scene *scene = scene_begin(&silent, "test");
    scene_put(scene, soup(400, 0.2), NULL);
    return finish(scene);
}

static struct world sphere_world(void)
{
    struct scene *scene = scene_begin(&silent, "test");
    scene_put(scene, mesh_sphere(1.0, 20, 20), NULL);
    return finish(scene);
}

/* Turned, stretched, mirrored and pushed off the origin, some on top of each other. */
static struct world instances_world(void)
{
    random_state = 2;
    struct scene *scene = scene_begin(&silent, "test");
    for (int i = 0; i < 12; ++i) {
        const double at[3] = {random_signed(&random_state), random_signed(&random_state),
                              i % 3 ? random_signed(&random_state) : 1000.0};
        const double rotation[4] = {random_signed(&random_state), random_signed(&random_state),
                                    random_signed(&random_state), 1.0};
        const double scale[3] = {i % 2 ? 1.0 : -0.5, 0.3, 0.1 + 0.1 * i};
        struct affine m = affine_from_trs(at, rotation, scale);
        scene_put(scene, i % 2 ? mesh_sphere(1.0, 10, 10) : soup(50, 0.3),
                  &(struct put){.matrix = &m});
    }
    return finish(scene);
}

static struct gpu_ray ray_between(const double from[3], const double to[3])
{
    struct gpu_ray ray = {.t_min = 0.0f, .t_max = INFINITY};
    for (int i = 0; i < 3; ++i) {
        ray.origin[i] = (float)from[i];
        ray.dir[i] = (float)(to[i] - (double)ray.origin[i]);
    }
    return ray;
}

static struct gpu_ray random_ray(const struct world *world, uint32_t i)
{
    double centre_z = world->accel->instance_count > 3 && i % 4 == 0 ? 1000.0 : 0.0;
    double from[3], to[3];
    for (int k = 0; k < 3; ++k) {
        from[k] = 3.0 * random_signed(&random_state) + (k == 2 ? centre_z : 0.0);
        to[k] = random_signed(&random_state) + (k == 2 ? centre_z : 0.0);
    }
    struct gpu_ray ray = ray_between(from, to);
    if (i % 5 == 0)
        ray.t_min = 0.7f;
    if (i % 7 == 0)
        ray.t_max = 1.1f;
    if (i % 11 == 0)
        ray.dir[i % 3] = i % 2 ? 0.0f : -0.0f;
    return ray;
}

/* Through a vertex, or a point of an edge, of some triangle. */
static struct gpu_ray aimed_ray(const struct world *world, uint32_t i)
{
    uint32_t instance = random_below(&random_state, world->accel->instance_count);
    const struct gpu_instance *in = &world->accel->instances[instance];
    const struct accel_mesh *mesh = &world->accel->meshes[in->mesh];
    const struct gpu_triangle *t =
        &world->accel
             ->triangles[mesh->first_triangle + random_below(&random_state, mesh->triangle_count)];
    double s = i % 2 ? 0.0 : 0.5 + 0.5 * random_signed(&random_state), p[3], to[3], from[3];
    for (int k = 0; k < 3; ++k)
        p[k] = (1.0 - s) * (double)t->v0[k] + s * (double)t->v1[k];
    const float *rows[3] = {in->forward0, in->forward1, in->forward2};
    const float at[3] = {in->origin_x, in->origin_y, in->origin_z};
    for (int k = 0; k < 3; ++k) {
        to[k] = (double)rows[k][0] * p[0] + (double)rows[k][1] * p[1] + (double)rows[k][2] * p[2] +
                (double)at[k];
        from[k] = to[k] + 2.0 * random_signed(&random_state);
    }
    return ray_between(from, to);
}

static bool same_double(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* What needs no trees does not read a node. */
static struct accel without_nodes(const struct world *world)
{
    struct accel accel = *world->accel;
    accel.nodes = NULL;
    return accel;
}

static void assert_tree_is_brute(const struct world *world, const struct gpu_ray *ray)
{
    struct oracle_hit tree, brute;
    struct accel bare = without_nodes(world);
    oracle_trace(world->accel, ray, false, &tree);
    oracle_trace(&bare, ray, true, &brute);
    assert_int_equal(tree.primitive, brute.primitive);
    assert_int_equal(tree.instance, brute.instance);
    assert_true(same_double(tree.t, brute.t));
    assert_true(same_double(tree.u, brute.u) && same_double(tree.v, brute.v));
    assert_true(same_double(tree.second_t, brute.second_t));
    assert_true(fmin(fabs(tree.edge_margin), 1.0) == fmin(fabs(brute.edge_margin), 1.0));
}

static void tree_gives_what_brute_force_gives(void **state)
{
    (void)state;
    struct world worlds[] = {soup_world(), sphere_world(), instances_world()};
    for (size_t w = 0; w < 3; ++w) {
        random_state = 3 + w;
        for (uint32_t i = 0; i < 1500; ++i) {
            struct gpu_ray ray = i % 3 ? random_ray(&worlds[w], i) : aimed_ray(&worlds[w], i);
            assert_tree_is_brute(&worlds[w], &ray);
        }
        world_destroy(&worlds[w]);
    }
}

struct tally {
    uint32_t rays, hits, differ, doubtful;
};

/* A different answer must be one that the margin allows; an equal one must have a t within reach.
 */
static void compare_with_twin(const struct world *world, const struct gpu_ray *ray,
                              struct tally *tally)
{
    struct oracle_hit exact;
    struct gpu_hit hit, by_tree;
    struct accel bare = without_nodes(world);
    uint32_t status = 0;
    oracle_trace(world->accel, ray, false, &exact);
    traverse_float(world->accel, ORDER_DISTANCE, ray, false, HIT_NONE, HIT_NONE, &by_tree, NULL,
                   &status);
    traverse_brute_float(&bare, ray, &hit);
    assert_int_equal(status, 0);
    assert_int_equal(by_tree.primitive, hit.primitive);
    assert_int_equal(by_tree.instance, hit.instance);
    bool differ = hit.primitive != exact.primitive || hit.instance != exact.instance;
    ++tally->rays;
    tally->hits += exact.primitive != HIT_NONE;
    tally->differ += differ;
    tally->doubtful += fabs(exact.edge_margin) < 1.0;
    if (differ && !(fabs(exact.edge_margin) < 1.0))
        fail_msg("float %u, exact %u, but the margin is %g", hit.primitive, exact.primitive,
                 exact.edge_margin);
}

static void margins_explain_the_float_twin(void **state)
{
    (void)state;
    struct world worlds[] = {soup_world(), sphere_world(), instances_world()};
    for (size_t w = 0; w < 3; ++w) {
        struct tally random = {0}, aimed = {0};
        random_state = 30 + w;
        for (uint32_t i = 0; i < cases_of(20000); ++i) {
            struct gpu_ray ray = random_ray(&worlds[w], i);
            compare_with_twin(&worlds[w], &ray, &random);
        }
        for (uint32_t i = 0; i < cases_of(5000); ++i) {
            struct gpu_ray ray = aimed_ray(&worlds[w], i);
            compare_with_twin(&worlds[w], &ray, &aimed);
        }
        /* The bound is no excuse for everything: random rays are nearly all certain, and aimed ones
           do reach what it covers. */
        assert_true(random.hits > random.rays / 20);
        assert_true(random.doubtful < random.rays / 200);
        assert_true(random.differ <= random.doubtful);
        assert_true(aimed.doubtful > aimed.rays / 10);
        assert_true(aimed.differ > 0);
        world_destroy(&worlds[w]);
    }
}

static const float unit_triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static void one_triangle_is_known(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(&silent, "test");
    scene_put(scene, mesh_triangles(unit_triangle, 1), NULL);
    struct world world = finish(scene);
    struct oracle_hit hit;
    struct gpu_ray ray = {{0.25f, 0.5f, 4.0f}, 0.0f, {0, 0, -2}, INFINITY};
    oracle_trace(world.accel, &ray, false, &hit);
    assert_int_equal(hit.primitive, 0);
    assert_int_equal(hit.instance, 0);
    assert_true(hit.t == 2.0 && hit.u == 0.25 && hit.v == 0.5);
    assert_true(hit.edge_margin > 1e4);
    assert_true(hit.second_t == INFINITY);

    ray.t_max = 2.0f; /* the interval is closed */
    oracle_trace(world.accel, &ray, false, &hit);
    assert_int_equal(hit.primitive, 0);
    assert_true(hit.edge_margin < 1.0);
    ray.t_max = 1.99f;
    oracle_trace(world.accel, &ray, false, &hit);
    assert_int_equal(hit.primitive, HIT_NONE);
    assert_true(hit.t == INFINITY);
    ray.t_max = INFINITY;
    ray.t_min = 2.01f;
    oracle_trace(world.accel, &ray, false, &hit);
    assert_int_equal(hit.primitive, HIT_NONE);
    ray.t_min = 0.0f;

    ray.origin[0] = -1e-7f; /* beside it, but by how little the float test may not know */
    oracle_trace(world.accel, &ray, true, &hit);
    assert_int_equal(hit.primitive, HIT_NONE);
    assert_true(hit.edge_margin < -1.0); /* coordinates this small are exact */
    ray.origin[0] = 0.0f;
    oracle_trace(world.accel, &ray, false, &hit);
    assert_int_equal(hit.primitive, 0);
    assert_true(hit.edge_margin < 1.0);
    world_destroy(&world);
}

static void ties_go_to_the_smaller_index(void **state)
{
    (void)state;
    float corners[27];
    for (int i = 0; i < 27; ++i)
        corners[i] = unit_triangle[i % 9];
    struct scene *scene = scene_begin(&silent, "test");
    scene_put(scene, mesh_triangles(corners, 3), NULL);
    scene_put(scene, mesh_triangles(corners, 3), NULL);
    struct world world = finish(scene);
    struct gpu_ray ray = {{0.25f, 0.25f, 1.0f}, 0.0f, {0, 0, -1}, INFINITY};
    for (int brute = 0; brute < 2; ++brute) {
        struct oracle_hit hit;
        oracle_trace(world.accel, &ray, brute, &hit);
        assert_int_equal(hit.instance, 0);
        assert_int_equal(hit.primitive, 0);
        assert_true(hit.second_t == hit.t);
        assert_true(hit.edge_margin == 0.0);
    }
    world_destroy(&world);
}

/* A square across each axis, met along that axis at its middle, its borders and its corners, by
   rays that lie in faces of its box (NUMERICS B3): 0 and -0, from both sides. */
static void borders_are_met_along_the_axes(void **state)
{
    (void)state;
    uint32_t rays = 0, missed = 0;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        float corners[18] = {0};
        for (uint32_t i = 0; i < 6; ++i) {
            uint32_t corner = (const uint32_t[]){0, 1, 2, 0, 2, 3}[i];
            corners[3 * i + axis] = 0.5f;
            corners[3 * i + u] = corner == 1 || corner == 2 ? 3.0f : -1.0f;
            corners[3 * i + v] = corner >= 2 ? 3.0f : -1.0f;
        }
        struct scene *scene = scene_begin(&silent, "test");
        scene_put(scene, mesh_triangles(corners, 2), NULL);
        struct world world = finish(scene);
        for (uint32_t way = 0; way < 9 * 8; ++way) {
            struct gpu_ray ray = {.t_max = INFINITY};
            struct gpu_hit hit;
            uint32_t status = 0;
            float side = way & 1 ? 1.0f : -1.0f;
            ray.origin[axis] = 0.5f - 4.0f * side;
            ray.origin[u] = (float)(way / 8 % 3) * 2.0f - 1.0f;
            ray.origin[v] = (float)(way / 24) * 2.0f - 1.0f;
            ray.dir[axis] = side;
            ray.dir[u] = way & 2 ? -0.0f : 0.0f;
            ray.dir[v] = way & 4 ? -0.0f : 0.0f;
            traverse_float(world.accel, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &hit, NULL,
                           &status);
            missed += hit.t != 4.0f;
            ++rays;
        }
        world_destroy(&world);
    }
    print_message("  %u of %u rays miss\n", missed, rays);
    assert_int_equal(missed, 0);
}

static void senseless_rays_hit_nothing(void **state)
{
    (void)state;
    struct world world = sphere_world();
    const struct gpu_ray rays[] = {
        {{0, 0, 0}, 0, {0, 0, 0}, INFINITY},         {{NAN, 0, 0}, 0, {0, 0, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, INFINITY, 1}, INFINITY},  {{0, 0, 0}, 2, {0, 0, 1}, 1},
        {{0, 0, 0}, NAN, {0.1f, 0.2f, 1}, INFINITY}, {{0, 0, 0}, 0, {0.1f, 0.2f, 1}, -1},
    };
    for (size_t i = 0; i < sizeof rays / sizeof *rays; ++i) {
        struct oracle_hit hit;
        oracle_trace(world.accel, &rays[i], false, &hit);
        assert_int_equal(hit.primitive, HIT_NONE);
        assert_tree_is_brute(&world, &rays[i]);
    }
    world_destroy(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tree_gives_what_brute_force_gives),
        cmocka_unit_test(margins_explain_the_float_twin),
        cmocka_unit_test(one_triangle_is_known),
        cmocka_unit_test(ties_go_to_the_smaller_index),
        cmocka_unit_test(borders_are_met_along_the_axes),
        cmocka_unit_test(senseless_rays_hit_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
