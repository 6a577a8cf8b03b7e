/* One tree over all triangles in world space, against the same scene with instances. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../cases.h"
#include "../random.h"
#include "../scenes.h"
#include "accel/accel.h"
#include "oracle/oracle.h"
#include "twin/traverse.h"

static char last_error[512];

static void keep_error(void *user, whit_log_level level, const char *message)
{
    (void)user;
    if (level == WHIT_LOG_ERROR)
        snprintf(last_error, sizeof last_error, "%s", message);
}

static const struct log quiet = {.fn = keep_error, .level = WHIT_LOG_ERROR};

static struct scene *new_scene(void)
{
    struct scene *scene = scene_begin(&quiet, "flat");
    struct scene_material glass = material_grey("glass");
    glass.transmission[0] = 0.5f;
    scene_put_material(scene, material_grey("grey"));
    scene_put_material(scene, glass);
    return scene;
}

static uint32_t add_sphere(struct scene *scene, uint32_t segments, uint32_t rings,
                           uint32_t material)
{
    return scene_put_mesh(scene, mesh_wearing(mesh_sphere(1.0, segments, rings), material));
}

/* Turned, scaled, mirrored (every third) and sheared. */
static struct affine random_matrix(uint64_t *state, uint32_t i)
{
    double at[3], rotation[4], scale[3];
    for (int k = 0; k < 3; ++k) {
        at[k] = 6.0 * random_signed(state);
        rotation[k] = random_signed(state);
        scale[k] = 0.3 + 1.2 * random_unit(state);
    }
    rotation[3] = 0.5;
    if (i % 3 == 0)
        scale[i / 3 % 3] = -scale[i / 3 % 3];
    struct affine placed = affine_from_trs(at, rotation, scale), shear = affine_identity();
    shear.m[1] = 0.7 * random_signed(state);
    shear.m[6] = 0.5 * random_signed(state);
    return affine_multiply(&placed, &shear);
}

enum { OBJECTS = 40 };

static struct scene *mixed_scene(void)
{
    struct scene *scene = new_scene();
    uint64_t state = 7;
    add_sphere(scene, 24, 16, 0);
    add_sphere(scene, 9, 6, 1);
    uint32_t empty = scene_put_mesh(scene, (struct scene_mesh){0});
    for (uint32_t i = 0; i < OBJECTS; ++i) {
        struct affine matrix = random_matrix(&state, i);
        scene_put_again(scene, i % 13 == 5 ? empty : i % 2,
                        &(struct put){.name = "object", .matrix = &matrix});
    }
    scene_ready(scene);
    return scene;
}

static struct accel *build(const struct scene *scene, enum bvh_builder builder, bool flatten)
{
    const struct accel_params params = {
        .mesh = {.builder = builder}, .flatten = flatten, .validate = true};
    struct accel *accel = NULL;
    assert_int_equal(accel_create(&quiet, scene, &params, &accel), WHIT_OK);
    assert_int_equal(accel->flat, flatten);
    return accel;
}

static struct gpu_ray random_ray(uint64_t *state)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    for (int i = 0; i < 3; ++i) {
        double from = 9.0 * random_signed(state), to = 6.0 * random_signed(state);
        ray.origin[i] = (float)from;
        ray.dir[i] = (float)(to - from);
    }
    return ray;
}

static struct gpu_hit trace(const struct accel *accel, const struct gpu_ray *ray)
{
    struct gpu_hit hit;
    uint32_t status = 0;
    traverse_float(accel, ORDER_DISTANCE, ray, false, HIT_NONE, HIT_NONE, &hit, NULL, &status);
    assert_int_equal(status, 0);
    return hit;
}

/* Cosine of the angle between the normals of two hits. */
static double normals_cosine(const struct gpu_hit *a, const struct gpu_hit *b)
{
    double x[3] = {(double)a->ng_x, (double)a->ng_y, (double)a->ng_z};
    double y[3] = {(double)b->ng_x, (double)b->ng_y, (double)b->ng_z};
    double xy = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    return xy / sqrt((x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) *
                     (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]));
}

static void hits_are_those_of_the_instances(void **state)
{
    (void)state;
    enum { RAYS = 300000 };
    struct scene *scene = mixed_scene();
    struct accel *instanced = build(scene, BVH_BINNED, false),
                 *flat = build(scene, BVH_BINNED, true);
    uint32_t other = 0, met = 0;
    uint64_t seed = 1;
    double t_worst = 0.0, cosine_worst = 1.0;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_ray ray = random_ray(&seed);
        struct gpu_hit a = trace(instanced, &ray), b = trace(flat, &ray);
        met += a.primitive != HIT_NONE;
        if (a.primitive != b.primitive || a.instance != b.instance) {
            ++other;
        } else if (a.primitive != HIT_NONE) {
            double cosine = normals_cosine(&a, &b);
            double off = fabs((double)a.t - (double)b.t);
            t_worst = off > t_worst ? off : t_worst;
            cosine_worst = cosine < cosine_worst ? cosine : cosine_worst;
        }
    }
    print_message("  %u of %u rays hit another triangle, %u met one; t is off by up to %.2g, "
                  "1 - cosine of normals up to %.2g\n",
                  other, RAYS, met, t_worst, 1.0 - cosine_worst);
    assert_true(met > RAYS / 3);
    assert_true(other <= RAYS / 100000);
    assert_true(t_worst < 1e-4); /* t is 1 at a distance of some 10: grazing hits */
    assert_true(cosine_worst > 1.0 - 1e-6);
    accel_destroy(instanced);
    accel_destroy(flat);
    scene_destroy(scene);
}

static void builders_agree_bit_for_bit(void **state)
{
    (void)state;
    static const enum bvh_builder builders[] = {BVH_MEDIAN, BVH_SWEEP, BVH_SPATIAL, BVH_NONE};
    struct scene *scene = mixed_scene();
    struct accel *first = build(scene, BVH_BINNED, true);
    for (size_t b = 0; b < sizeof builders / sizeof *builders; ++b) {
        struct accel *accel = build(scene, builders[b], true);
        uint64_t seed = 3;
        assert_int_equal(accel->triangle_count, first->triangle_count);
        assert_true(builders[b] != BVH_SPATIAL || accel->record_count > accel->triangle_count);
        for (uint32_t i = 0; i < cases_of(600); ++i) {
            struct gpu_ray ray = random_ray(&seed);
            struct gpu_hit x = trace(first, &ray), y = trace(accel, &ray), z;
            traverse_brute_float(accel, &ray, &z);
            assert_memory_equal(&x, &y, sizeof x);
            assert_memory_equal(&x, &z, sizeof x);
        }
        accel_destroy(accel);
    }
    accel_destroy(first);
    scene_destroy(scene);
}

static void the_oracle_agrees(void **state)
{
    (void)state;
    struct scene *scene = mixed_scene();
    struct accel *accel = build(scene, BVH_BINNED, true);
    const uint32_t rays = cases_of(1500);
    uint32_t sure = 0;
    uint64_t seed = 5;
    for (uint32_t i = 0; i < rays; ++i) {
        struct gpu_ray ray = random_ray(&seed);
        struct gpu_hit hit = trace(accel, &ray);
        struct oracle_hit tree, brute;
        oracle_trace(accel, &ray, false, &tree);
        oracle_trace(accel, &ray, true, &brute);
        assert_int_equal(tree.primitive, brute.primitive);
        assert_int_equal(tree.instance, brute.instance);
        if (fabs(tree.edge_margin) < 1.0)
            continue;
        ++sure;
        assert_int_equal(hit.primitive, tree.primitive);
        assert_int_equal(hit.instance, tree.instance);
        if (hit.primitive != HIT_NONE)
            assert_true(fabs((double)hit.t - tree.t) <= tree.t_error);
    }
    assert_true(sure > rays * 29 / 30);
    accel_destroy(accel);
    scene_destroy(scene);
}

/* As `whit scene --triangles` has it: in double, and rounded once. */
static void assert_placed(const struct scene *scene, const struct scene_pose *pose,
                          const struct gpu_triangle *record)
{
    uint32_t instance = record->flags >> TRIANGLE_INSTANCE_SHIFT;
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    const float *corners[3] = {record->v0, record->v1, record->v2};
    for (size_t i = 0; i < 3; ++i) {
        size_t vertex = mesh->indices[3 * (size_t)record->primitive + i];
        double world[3];
        for (size_t k = 0; k < 3; ++k)
            world[k] = (double)mesh->positions[3 * vertex + k];
        affine_point(&pose->instances[instance], world, world);
        for (size_t k = 0; k < 3; ++k)
            assert_true(corners[i][k] == (float)world[k]);
    }
}

static void records_say_whose_they_are(void **state)
{
    (void)state;
    struct scene *scene = mixed_scene();
    struct accel *accel = build(scene, BVH_SWEEP, true);
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    uint32_t mirrored = 0, filters = 0;
    for (uint32_t i = 0; i < accel->record_count; ++i) {
        uint32_t flags = accel->triangles[i].flags;
        uint32_t instance = flags >> TRIANGLE_INSTANCE_SHIFT;
        assert_true(instance < OBJECTS);
        assert_placed(scene, &pose, &accel->triangles[i]);
        assert_int_equal((flags & TRIANGLE_MIRRORED) != 0,
                         affine_determinant(&pose.instances[instance]) < 0.0);
        assert_int_equal((flags & TRIANGLE_FILTER) != 0, scene->instances[instance].mesh == 1);
        mirrored += (flags & TRIANGLE_MIRRORED) != 0;
        filters += (flags & TRIANGLE_FILTER) != 0;
    }
    assert_true(mirrored > 0 && filters > 0);
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        assert_int_equal(accel->instances[i].mesh, scene->instances[i].mesh);
        assert_int_equal(
            accel->instances[i].shade_base,
            scene->instances[i].mesh
                ? scene->meshes[0].triangle_count +
                      (scene->instances[i].mesh > 1 ? scene->meshes[1].triangle_count : 0)
                : 0);
    }
    scene_pose_finish(&pose);
    accel_destroy(accel);
    scene_destroy(scene);
}

static void a_pose_builds_anew(void **state)
{
    (void)state;
    struct scene *scene = mixed_scene();
    struct accel *flat = build(scene, BVH_BINNED, true),
                 *instanced = build(scene, BVH_BINNED, false);
    struct scene_pose pose;
    uint64_t seed = 11, rays = 13;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    for (int step = 0; step < 5; ++step) {
        uint32_t other = 0, met = 0;
        for (uint32_t i = 0; i < pose.instance_count; ++i)
            pose.instances[i] = random_matrix(&seed, i + (uint32_t)step);
        assert_int_equal(accel_pose(flat, &pose), WHIT_OK);
        assert_int_equal(accel_pose(instanced, &pose), WHIT_OK);
        assert_int_equal(accel_validate(flat), WHIT_OK);
        for (int i = 0; i < 5000; ++i) {
            struct gpu_ray ray = random_ray(&rays);
            struct gpu_hit a = trace(instanced, &ray), b = trace(flat, &ray);
            met += a.primitive != HIT_NONE;
            other += a.primitive != b.primitive || a.instance != b.instance;
        }
        assert_true(met > 1000 && other <= 1);
    }
    const struct gpu_bvh_node *nodes = flat->nodes;
    assert_int_equal(accel_pose(flat, &pose), WHIT_OK);
    assert_ptr_equal(flat->nodes, nodes); /* nothing has moved */
    /* What is refused leaves everything as it was. */
    struct gpu_ray ray = random_ray(&rays);
    struct gpu_hit before = trace(flat, &ray), after;
    pose.instances[3].m[3] = 1e30;
    assert_int_equal(accel_pose(flat, &pose), WHIT_ERROR_INPUT);
    assert_non_null(strstr(last_error, "instance 3 `object`"));
    assert_int_equal(accel_validate(flat), WHIT_OK);
    after = trace(flat, &ray);
    assert_memory_equal(&before, &after, sizeof before);
    scene_pose_finish(&pose);
    accel_destroy(flat);
    accel_destroy(instanced);
    scene_destroy(scene);
}

static void broken_records_are_refused(void **state)
{
    (void)state;
    struct scene *scene = mixed_scene();
    for (int k = 0; k < 7; ++k) {
        struct accel *accel = build(scene, BVH_BINNED, true);
        struct gpu_triangle *triangle = &accel->triangles[accel->record_count / 2];
        switch (k) {
        case 0:
            break;
        case 1:
            triangle->flags += 200u << TRIANGLE_INSTANCE_SHIFT;
            break;
        case 2:
            triangle->flags ^= 2u << TRIANGLE_INSTANCE_SHIFT;
            break;
        case 3:
            triangle->primitive += 100000;
            break;
        case 4:
            triangle->v1[1] = triangle->v1[1] * 0.999f + triangle->v0[1] * 0.001f;
            break;
        case 5:
            accel->meshes[0].depth += 1;
            break;
        case 6:
            accel->nodes[2].hi[0] = accel->nodes[2].lo[0];
            break;
        }
        if ((accel_validate(accel) == WHIT_OK) != (k == 0))
            fail_msg("case %d was misjudged", k);
        accel_destroy(accel);
    }
    scene_destroy(scene);
}

static void scenes_without_anything(void **state)
{
    (void)state;
    for (int k = 0; k < 3; ++k) {
        struct scene *scene = new_scene();
        if (k > 0)
            scene_put_mesh(scene, (struct scene_mesh){0});
        if (k > 1)
            scene_put_again(scene, 0, NULL);
        scene_ready(scene);
        struct accel *accel = build(scene, BVH_BINNED, true);
        uint64_t seed = 1;
        struct gpu_ray ray = random_ray(&seed);
        struct gpu_hit hit = trace(accel, &ray);
        struct oracle_hit sure;
        oracle_trace(accel, &ray, false, &sure);
        assert_int_equal(hit.primitive, HIT_NONE);
        assert_int_equal(sure.primitive, HIT_NONE);
        accel_destroy(accel);
        scene_destroy(scene);
    }
}

/* ---- Where nobody says ---- */

/* Triangles and a ball of the same size, each once, where `place` says. */
static struct scene *two_objects(const struct affine *place)
{
    const double ball[4] = {0, 0, 0, 1};
    struct scene *scene = new_scene();
    scene_put(scene, mesh_sphere(1.0, 8, 6), &(struct put){.matrix = place});
    scene_put(scene, mesh_balls(ball, 1), &(struct put){.matrix = place});
    return scene;
}

static void takes_one_tree(struct scene *scene, uint64_t memory_limit, bool expected)
{
    struct scene_pose pose;
    bool suits;
    scene_ready(scene);
    scene->memory_limit = memory_limit;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_int_equal(accel_flat_suits(scene, &pose, &suits), WHIT_OK);
    assert_int_equal(suits, expected);
    scene_pose_finish(&pose);
    scene_destroy(scene);
}

static struct affine moved_by(double x, double scale)
{
    struct affine place = affine_identity();
    place.m[0] = place.m[5] = place.m[10] = scale;
    place.m[3] = x;
    return place;
}

static void a_scene_takes_one_tree_where_nothing_is_lost(void **state)
{
    (void)state;
    struct affine aside = moved_by(3, 2), turned = moved_by(0, 1);
    turned.m[1] = 0.5;
    takes_one_tree(two_objects(&aside), 0, true);
    takes_one_tree(two_objects(NULL), 0, true);
    takes_one_tree(two_objects(&turned), 0, false); /* a sphere no more */
    takes_one_tree(two_objects(&aside), 1 << 10, false);
    takes_one_tree(new_scene(), 0, false);

    struct scene *twice = two_objects(&aside);
    scene_put_again(twice, 0, NULL);
    takes_one_tree(twice, 0, false);

    struct scene *balls = two_objects(&aside);
    scene_put_again(balls, 1, NULL);
    takes_one_tree(balls, 0, true);
}

static void one_object_takes_it_if_it_is_moved(void **state)
{
    (void)state;
    struct affine turned = moved_by(3, 2);
    turned.m[1] = 0.5;
    for (int moved = 0; moved < 2; ++moved) {
        struct scene *scene = new_scene();
        scene_put(scene, mesh_sphere(1.0, 8, 6), &(struct put){.matrix = moved ? &turned : NULL});
        takes_one_tree(scene, 0, moved);
    }
}

/* From 256 of its longest sides on, which are 2, an object's vertices are rounded too much. */
static void far_objects_keep_their_instances(void **state)
{
    (void)state;
    struct affine near = moved_by(510, 1), far = moved_by(512, 1);
    takes_one_tree(two_objects(&near), 0, true);
    takes_one_tree(two_objects(&far), 0, false);

    /* Of a mesh that is where it was made nothing is rounded. */
    struct scene *there = two_objects(NULL);
    scene_put(there, mesh_triangles((float[]){9e3f, 0, 0, 9e3f, 1, 0, 9e3f, 0, 1}, 1), NULL);
    takes_one_tree(there, 0, true);
}

static void what_may_move_keeps_its_instances(void **state)
{
    (void)state;
    struct scene *scene = two_objects(NULL);
    scene_put_channel(scene, scene_put_node(scene, SCENE_NONE, 0, 0, 0), SCENE_PATH_TRANSLATION, 1,
                      (float[]){0}, (float[]){0, 0, 0});
    takes_one_tree(scene, 0, false);
}

static void too_many_triangles_are_refused(void **state)
{
    (void)state;
    struct scene *scene = new_scene();
    uint32_t mesh = add_sphere(scene, 150, 100, 0);
    for (int i = 0; i < 5000; ++i)
        scene_put_again(scene, mesh, NULL);
    scene_ready(scene);
    const struct accel_params params = {.flatten = true};
    struct accel *accel = NULL;
    assert_int_equal(accel_create(&quiet, scene, &params, &accel), WHIT_ERROR_INPUT);
    assert_null(accel);
    assert_non_null(strstr(last_error, "flat: its 148500000 triangles without instances are more"));
    scene_destroy(scene);
}

static void more_than_the_limit_is_refused(void **state)
{
    (void)state;
    struct scene *scene = new_scene();
    uint32_t mesh = add_sphere(scene, 150, 100, 0);
    for (int i = 0; i < 9; ++i)
        scene_put_again(scene, mesh, NULL);
    scene_ready(scene);
    const struct accel_params params = {.flatten = true};
    struct accel *accel = NULL;
    scene->memory_limit = UINT64_C(16) << 20;
    assert_int_equal(accel_create(&quiet, scene, &params, &accel), WHIT_ERROR_INPUT);
    assert_non_null(strstr(last_error, "flat: its 267300 triangles without instances would take"));
    assert_non_null(strstr(last_error, "--memory-limit"));
    scene->memory_limit = UINT64_C(160) << 20;
    assert_int_equal(accel_create(&quiet, scene, &params, &accel), WHIT_OK);
    accel_destroy(accel);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_are_those_of_the_instances),
        cmocka_unit_test(builders_agree_bit_for_bit),
        cmocka_unit_test(the_oracle_agrees),
        cmocka_unit_test(records_say_whose_they_are),
        cmocka_unit_test(a_pose_builds_anew),
        cmocka_unit_test(broken_records_are_refused),
        cmocka_unit_test(scenes_without_anything),
        cmocka_unit_test(a_scene_takes_one_tree_where_nothing_is_lost),
        cmocka_unit_test(one_object_takes_it_if_it_is_moved),
        cmocka_unit_test(far_objects_keep_their_instances),
        cmocka_unit_test(what_may_move_keeps_its_instances),
        cmocka_unit_test(too_many_triangles_are_refused),
        cmocka_unit_test(more_than_the_limit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
