/* How near the surfaces of bodies of media come: never said to be farther apart than they are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../cases.h"
#include "../random.h"
#include "../scenes.h"
#include "picture/bodies.h"

static struct scene_material glass(const char *name)
{
    struct scene_material m = material_plain(name);
    m.transmission[0] = m.transmission[1] = m.transmission[2] = 1.0f;
    m.ior = 1.5f;
    return m;
}

static void put_glass(struct scene *scene, struct scene_mesh mesh, const char *name, double x,
                      double y, double z)
{
    struct scene_material m = glass(name);
    scene_put(scene, mesh, &(struct put){.material = &m, .at = {x, y, z}});
}

static void put_ball(struct scene *scene, const char *name, double x, double y, double z,
                     double radius)
{
    const double ball[4] = {0, 0, 0, radius};
    put_glass(scene, mesh_balls(ball, 1), name, x, y, z);
}

static bool come_within(const struct scene *scene, double distance)
{
    struct scene_pose pose;
    struct bodies bodies = {0};
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_true(bodies_list(scene, &pose, &bodies));
    bool within = bodies_come_within(scene, &pose, &bodies, distance);
    bodies_finish(&bodies);
    scene_pose_finish(&pose);
    return within;
}

/* And nothing much less is said. */
static void assert_gap(struct scene *scene, double gap)
{
    scene_ready(scene);
    assert_false(come_within(scene, gap * 0.999));
    assert_true(come_within(scene, gap * 1.001));
    scene_destroy(scene);
}

static void spheres(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(NULL, "beside");
    put_ball(scene, "a", 0, 0, 0, 1);
    put_ball(scene, "b", 1, 2, 2, 1.5);
    put_ball(scene, "far", 9, 9, 9, 1);
    assert_gap(scene, 0.5);
    scene = scene_begin(NULL, "within");
    put_ball(scene, "a", 0, 0, 0, 1);
    put_ball(scene, "b", 0, 0.01, 0, 0.93);
    assert_gap(scene, 0.06);
}

static void spheres_and_triangles(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(NULL, "above the middle of a table");
    put_ball(scene, "ball", 3, 1.25, -2, 1);
    put_glass(scene, mesh_plane(20), "table", 0, 0, 0);
    assert_gap(scene, 0.25);
    scene = scene_begin(NULL, "beside its corner");
    put_ball(scene, "ball", 11, 2, 12, 1);
    put_glass(scene, mesh_plane(20), "table", 0, 0, 0);
    assert_gap(scene, 2.0);
    scene = scene_begin(NULL, "in a box");
    put_ball(scene, "ball", 0.5, 0, 0, 1);
    put_glass(scene, mesh_box(4, 4, 4), "box", 0, 0, 0);
    assert_gap(scene, 0.5);
    scene = scene_begin(NULL, "around a box");
    put_ball(scene, "ball", 0, 0, 0, 3);
    put_glass(scene, mesh_box(2, 2, 4), "box", 0, 0, 0);
    assert_gap(scene, 3.0 - sqrt(1 + 1 + 4));
}

static void triangles(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(NULL, "in a box");
    put_glass(scene, mesh_box(4, 4, 4), "outer", 0, 0, 0);
    put_glass(scene, mesh_box(2, 2, 2), "inner", 0.25, 0, 0);
    assert_gap(scene, 0.75);
}

static void what_touches(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(NULL, "on a table");
    put_ball(scene, "ball", 0, 1, 0, 1);
    put_glass(scene, mesh_plane(20), "table", 0, 0, 0);
    scene_ready(scene);
    assert_true(come_within(scene, 1e-6));
    scene_destroy(scene);
    scene = scene_begin(NULL, "water in a glass");
    put_glass(scene, mesh_box(2, 2, 2), "glass", 0, 0, 0);
    put_glass(scene, mesh_box(1, 2, 1), "water", 0, 0, 0);
    scene_ready(scene);
    assert_true(come_within(scene, 1e-6));
    scene_destroy(scene);
}

/* One body has none beside it, whatever its own shape; what is opaque or thin is none. */
static void one_body(void **state)
{
    (void)state;
    struct scene *scene = scene_begin(NULL, "one");
    struct scene_material thin = glass("thin");
    thin.thin_walled = true;
    put_glass(scene, mesh_box(2, 2, 2), "glass", 0, 0, 0);
    struct scene_material stone = material_plain("stone");
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &stone, .at = {1, 0, 0}});
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &thin, .at = {0, 1, 0}});
    scene_ready(scene);
    assert_false(come_within(scene, 100.0));
    scene_destroy(scene);
}

/* A stretched sphere is known by its box alone, one that is turned and made larger as it is. */
static void placed_spheres(void **state)
{
    (void)state;
    const double ball[4] = {0, 0, 0, 1};
    const struct affine stretched = {{1, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0}};
    const struct affine turned = {{0, -2, 0, 4, 2, 0, 0, 0, 0, 0, 2, 0}};
    struct scene_material m = glass("placed");
    struct scene *scene = scene_begin(NULL, "stretched");
    scene_put(scene, mesh_balls(ball, 1), &(struct put){.material = &m, .matrix = &stretched});
    put_ball(scene, "b", 1.9, 2.9, 0, 1);
    scene_ready(scene);
    assert_true(come_within(scene, 1e-6));
    scene_destroy(scene);
    scene = scene_begin(NULL, "turned");
    scene_put(scene, mesh_balls(ball, 1), &(struct put){.material = &m, .matrix = &turned});
    put_ball(scene, "b", 0, 0, 0, 1);
    assert_gap(scene, 1.0);
}

static double apart(const double a[3], const double b[3])
{
    double d2 = 0.0;
    for (int k = 0; k < 3; ++k)
        d2 += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(d2);
}

/* Beside the nearest of many points of a triangle. */
static void no_distance_is_too_large(void **state)
{
    (void)state;
    enum { STEPS = 24 };
    uint64_t random = 1;
    for (int n = 0; n < (int)cases_of(1600); ++n) {
        float corners[9];
        double ball[4] = {0, 0, 0, random_unit(&random) + 0.1}, nearest = INFINITY;
        for (int i = 0; i < 9; ++i)
            corners[i] = (float)(4.0 * random_unit(&random) - 2.0);
        for (int i = 0; i <= STEPS; ++i) {
            for (int j = 0; i + j <= STEPS; ++j) {
                double u = (double)i / STEPS, v = (double)j / STEPS, p[3];
                for (int k = 0; k < 3; ++k)
                    p[k] = (double)corners[k] * (1 - u - v) + (double)corners[3 + k] * u +
                           (double)corners[6 + k] * v;
                nearest = fmin(nearest, fabs(apart(p, ball) - ball[3]));
            }
        }
        struct scene *scene = scene_begin(NULL, "any");
        put_glass(scene, mesh_triangles(corners, 1), "triangle", 0, 0, 0);
        put_glass(scene, mesh_balls(ball, 1), "ball", 0, 0, 0);
        scene_ready(scene);
        assert_true(come_within(scene, nearest + 1e-6));
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres),
        cmocka_unit_test(spheres_and_triangles),
        cmocka_unit_test(triangles),
        cmocka_unit_test(what_touches),
        cmocka_unit_test(one_body),
        cmocka_unit_test(placed_spheres),
        cmocka_unit_test(no_distance_is_too_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
