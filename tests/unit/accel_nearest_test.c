/* Distances to a scene: by trees, by every triangle, and by formula. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../scenes.h"
#include "accel/accel.h"
#include "oracle/nearest.h"
#include "random_fixture.h"

static const struct log quiet = {0};

/* A ring in a few places, turned, stretched and mirrored. */
static struct scene *ring_scene(void)
{
    struct scene *scene = scene_begin(&quiet, "rings");
    uint32_t ring = scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    for (int i = 0; i < 12; ++i) {
        double t[3], q[4], s[3] = {i % 3 ? 1.0 : -1.0, 0.6, 1.4};
        for (int k = 0; k < 3; ++k)
            t[k] = 8.0 * (double)random_float(&random_state) - 4.0;
        for (int k = 0; k < 4; ++k)
            q[k] = 2.0 * (double)random_float(&random_state) - 1.0;
        struct affine matrix = affine_from_trs(t, q, s);
        uint32_t node = scene_put_matrix(scene, SCENE_NONE, &matrix);
        scene_put_again(scene, ring, &(struct put){.node = &node});
    }
    return scene_ready(scene);
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
            p[k] = 14.0 * (double)random_float(&random_state) - 7.0;
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
    struct scene *scene = scene_begin(&quiet, "box");
    scene_put(scene, mesh_box(2, 2, 2), NULL);
    scene_ready(scene);
    struct accel *accel;
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_int_equal(accel_create(&quiet, scene, NULL, &accel), WHIT_OK);
    for (int n = 0; n < 300; ++n) {
        double p[3], outside = 0.0, inside = INFINITY;
        for (int k = 0; k < 3; ++k) {
            p[k] = 4.0 * (double)random_float(&random_state) - 2.0;
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
