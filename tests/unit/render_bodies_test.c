/* The distance found between the surfaces of bodies of media is never more than the true one. */
#include "../cases.h"
#include "../random.h"
#include "../scenes.h"
#include "../wrapped.h"
#include "picture/bodies.h"
#include "scene/pose.h"
#include "unit.h"

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

static bool come_within(const struct scene *scene, double distance)
{
    own_pose pose;
    struct bodies bodies = {0};
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_true(bodies_list(scene, &pose, &bodies));
    bool within = bodies_come_within(scene, &pose, &bodies, distance);
    bodies_finish(&bodies);
    return within;
}

static bool no_memory; /* for arrays with elements */

WRAPPED(bool, array_reserve, void **items, uint32_t count, uint32_t *capacity, size_t bytes)
{
    return (!no_memory || count == 0) && __real_array_reserve(items, count, capacity, bytes);
}

/* Asserts that the distance found between two bodies is `gap`, within 0.1 %; 0: they touch. */
static void assert_gap(struct scene *scene, double gap)
{
    scene_ready(scene);
    print_message("  %s: %g\n", scene->name, gap);
    if (gap > 0)
        assert_false(come_within(scene, gap * 0.999));
    assert_true(come_within(scene, gap > 0 ? gap * 1.001 : 1e-6));
    scene_destroy(scene);
}

/* A ball of radius size[0]; a box; or, where size[1] is 0 and size[2] is not, a plane. */
struct solid {
    double size[3], at[3];
};

static void put_solid(struct scene *scene, const struct solid *solid)
{
    const double *size = solid->size, *at = solid->at;
    if (size[2] == 0.0)
        put_glass(scene, mesh_balls((double[]){0, 0, 0, size[0]}, 1), "ball", at[0], at[1], at[2]);
    else if (size[1] == 0.0)
        put_glass(scene, mesh_plane(size[0]), "table", at[0], at[1], at[2]);
    else
        put_glass(scene, mesh_box(size[0], size[1], size[2]), "box", at[0], at[1], at[2]);
}

TEST(gaps_are_known)
{
    const struct {
        const char *name;
        struct solid solids[3];
        double gap; /* 0: they touch */
    } rows[] = {
        {"balls beside", {{{1}, {0}}, {{1.5}, {1, 2, 2}}, {{1}, {9, 9, 9}}}, 0.5},
        {"balls within", {{{1}, {0}}, {{0.93}, {0, 0.01, 0}}}, 0.06},
        {"above the middle of a table", {{{1}, {3, 1.25, -2}}, {{20, 0, 20}, {0}}}, 0.25},
        {"beside its corner", {{{1}, {11, 2, 12}}, {{20, 0, 20}, {0}}}, 2.0},
        {"ball in a box", {{{1}, {0.5, 0, 0}}, {{4, 4, 4}, {0}}}, 0.5},
        {"around a box", {{{3}, {0}}, {{2, 2, 4}, {0}}}, 3.0 - sqrt(1 + 1 + 4)},
        {"box in a box", {{{4, 4, 4}, {0}}, {{2, 2, 2}, {0.25, 0, 0}}}, 0.75},
        {"on a table", {{{1}, {0, 1, 0}}, {{20, 0, 20}, {0}}}, 0},
        {"water in a glass", {{{2, 2, 2}, {0}}, {{1, 2, 1}, {0}}}, 0},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        struct scene *scene = scene_begin(NULL, rows[i].name);
        for (int k = 0; k < 3 && rows[i].solids[k].size[0] > 0; ++k)
            put_solid(scene, &rows[i].solids[k]);
        assert_gap(scene, rows[i].gap);
    }
}

/* A lone body has no other to be near to, whatever its shape; and opaque or thin-walled objects are
   no bodies. */
TEST(one_body)
{
    own_scene *scene = scene_begin(NULL, "one");
    struct scene_material thin = glass("thin");
    thin.thin_walled = true;
    put_glass(scene, mesh_box(2, 2, 2), "glass", 0, 0, 0);
    struct scene_material stone = material_plain("stone");
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &stone, .at = {1, 0, 0}});
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &thin, .at = {0, 1, 0}});
    scene_ready(scene);
    assert_false(come_within(scene, 100.0));
}

/* A stretched sphere is taken as its box; a sphere that is only turned and made
   larger is taken as the sphere it is. */
TEST(placed_spheres)
{
    const double ball[4] = {0, 0, 0, 1};
    const struct affine stretched = {{1, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1, 0}};
    const struct affine turned = {{0, -2, 0, 4, 2, 0, 0, 0, 0, 0, 2, 0}};
    struct scene_material m = glass("placed");
    struct scene *scene = scene_begin(NULL, "stretched");
    scene_put(scene, mesh_balls(ball, 1), &(struct put){.material = &m, .matrix = &stretched});
    put_solid(scene, &(struct solid){{1}, {1.9, 2.9, 0}});
    assert_gap(scene, 0);
    scene = scene_begin(NULL, "turned");
    scene_put(scene, mesh_balls(ball, 1), &(struct put){.material = &m, .matrix = &turned});
    put_solid(scene, &(struct solid){{1}, {0}});
    assert_gap(scene, 1.0);
}

static double apart(const double a[3], const double b[3])
{
    double d2 = 0.0;
    for (int k = 0; k < 3; ++k)
        d2 += (a[k] - b[k]) * (a[k] - b[k]);
    return sqrt(d2);
}

/* Compares with the distance between a ball and the nearest of many points of a triangle. */
TEST(no_distance_is_too_large)
{
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
        own_scene *scene = scene_begin(NULL, "any");
        put_glass(scene, mesh_triangles(corners, 1), "triangle", 0, 0, 0);
        put_glass(scene, mesh_balls(ball, 1), "ball", 0, 0, 0);
        scene_ready(scene);
        assert_true(come_within(scene, nearest + 1e-6));
    }
}

/* A list that memory did not suffice for is made anew, not taken for the whole one. */
TEST(half_a_list_is_none)
{
    own_scene *scene = scene_begin(NULL, "balls");
    put_glass(scene, mesh_balls((double[]){0, 0, 0, 1}, 1), "ball", 0, 0, 0);
    scene_put_again(scene, 0, &(struct put){.at = {1, 0, 0}});
    own_pose pose;
    struct bodies bodies = {0};
    assert_int_equal(scene_pose_init(scene_ready(scene), 0.0, &pose), WHIT_OK);
    no_memory = true;
    assert_false(bodies_list(scene, &pose, &bodies));
    no_memory = false;
    assert_true(bodies_list(scene, &pose, &bodies));
    assert_int_equal(bodies.count, 2);
    bodies_finish(&bodies);
}
