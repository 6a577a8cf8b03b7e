/* Distances to a scene: by trees, by every triangle, and by formula. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "accel/accel.h"
#include "base/array.h"
#include "random_fixture.h"
#include "scene/shapes.h"

static const struct log quiet = {0};

/* A ring in a few places, turned, stretched and mirrored. */
static struct scene *ring_scene(void)
{
    struct scene *scene = scene_create(&quiet, "rings");
    struct scene_material grey;
    struct scene_mesh mesh = {0};
    scene_material_init(&grey, "grey");
    assert_int_not_equal(scene_add_material(scene, grey), SCENE_NONE);
    assert_int_equal(shape_torus(1.0, 0.3, 20, 10, &mesh), WHIT_OK);
    mesh.name = string_copy("ring");
    assert_int_not_equal(scene_add_mesh(scene, mesh), SCENE_NONE);
    for (int i = 0; i < 12; ++i) {
        double t[3], q[4], s[3] = {i % 3 ? 1.0 : -1.0, 0.6, 1.4};
        for (int k = 0; k < 3; ++k)
            t[k] = 8.0 * (double)random_float() - 4.0;
        for (int k = 0; k < 4; ++k)
            q[k] = 2.0 * (double)random_float() - 1.0;
        struct scene_node node;
        scene_node_init(&node, "node", SCENE_NONE);
        node.has_matrix = true;
        node.matrix = affine_from_trs(t, q, s);
        struct scene_instance instance = {.name = string_copy("ring"),
                                          .node = scene_add_node(scene, node)};
        assert_int_not_equal(scene_add_instance(scene, instance), SCENE_NONE);
    }
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    return scene;
}

/* Trees leave nothing out: the bits are those of all triangles in turn. A tree over the scene in
   world space has other vertices, rounded once more. */
static void trees_find_the_nearest(void **state)
{
    (void)state;
    random_state = 3;
    struct scene *scene = ring_scene();
    const struct accel_params ways[] = {
        {.mesh.builder = BVH_NONE}, {.mesh = {0}}, {.flatten = true}};
    struct accel *accels[3];
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    for (int i = 0; i < 3; ++i)
        assert_int_equal(accel_create(&quiet, scene, &ways[i], &accels[i]), WHIT_OK);
    for (int n = 0; n < 300; ++n) {
        double p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = 14.0 * (double)random_float() - 7.0;
        double all = accel_distance(accels[0], &pose, p);
        assert_true(accel_distance(accels[1], &pose, p) == all);
        assert_true(fabs(accel_distance(accels[2], &pose, p) - all) < 8 * 0x1p-24);
    }
    for (int i = 0; i < 3; ++i)
        accel_destroy(accels[i]);
    scene_pose_finish(&pose);
    scene_destroy(scene);
}

/* To a box: faces, edges, corners. */
static void distances_are_those_of_a_box(void **state)
{
    (void)state;
    random_state = 5;
    struct scene *scene = scene_create(&quiet, "box");
    struct scene_material grey;
    struct scene_mesh mesh = {0};
    scene_material_init(&grey, "grey");
    assert_int_not_equal(scene_add_material(scene, grey), SCENE_NONE);
    assert_int_equal(shape_box((double[]){2, 2, 2}, &mesh), WHIT_OK);
    mesh.name = string_copy("box");
    assert_int_not_equal(scene_add_mesh(scene, mesh), SCENE_NONE);
    struct scene_instance instance = {.name = string_copy("box"), .node = SCENE_NONE};
    assert_int_not_equal(scene_add_instance(scene, instance), SCENE_NONE);
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    struct accel *accel;
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_int_equal(accel_create(&quiet, scene, NULL, &accel), WHIT_OK);
    for (int n = 0; n < 300; ++n) {
        double p[3], outside = 0.0, inside = INFINITY;
        for (int k = 0; k < 3; ++k) {
            p[k] = 4.0 * (double)random_float() - 2.0;
            outside += pow(fmax(fabs(p[k]) - 1.0, 0.0), 2.0);
            inside = fmin(inside, 1.0 - fabs(p[k]));
        }
        double expected = outside > 0.0 ? sqrt(outside) : inside;
        assert_true(fabs(accel_distance(accel, &pose, p) - expected) < 1e-12);
    }
    accel_destroy(accel);
    scene_pose_finish(&pose);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trees_find_the_nearest),
        cmocka_unit_test(distances_are_those_of_a_box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
