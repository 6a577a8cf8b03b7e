/* Compares distances to a scene by trees, by testing every triangle, and by formula. */
#include "accel_fixture.h"

#include "oracle/nearest.h"
#include "unit.h"

/* A ring in a few places, turned, stretched and mirrored. */
static struct scene *ring_scene(void)
{
    struct scene *scene = scene_begin(&silent, "rings");
    uint32_t ring = scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    for (int i = 0; i < 12; ++i) {
        struct affine matrix = placement_random(&random_state, 4.0, i % 3 == 0);
        uint32_t node = scene_put_matrix(scene, SCENE_NONE, &matrix);
        scene_put_again(scene, ring, &(struct put){.node = &node});
    }
    return scene;
}

/* Distances by trees have the bits of those by testing all triangles. A single-level tree is
   compared within rounding, since its vertices are rounded once more. */
TEST(trees_find_the_nearest)
{
    random_state = 3;
    own_world world = world_of(ring_scene(), (whit_accel_params){.build = WHIT_BUILD_NONE});
    own_accel *tree = accel_of(world.scene, (whit_accel_params){0}),
              *flat = accel_of(world.scene, (whit_accel_params){.instances = WHIT_INSTANCES_OFF});
    for (int n = 0; n < 300; ++n) {
        double p[3];
        random_vec3(&random_state, p);
        for (int k = 0; k < 3; ++k)
            p[k] *= 7.0;
        double all = accel_distance(world.accel, &world.pose, p);
        assert_true(accel_distance(tree, &world.pose, p) == all);
        assert_true(fabs(accel_distance(flat, &world.pose, p) - all) < 8 * 0x1p-24);
    }
}

/* Distances to faces, edges and corners of a box. */
TEST(distances_are_those_of_a_box)
{
    random_state = 5;
    own_world world = world_of_soup(soup_of_mesh("box", mesh_box(2, 2, 2)), (whit_accel_params){0});
    for (int n = 0; n < 300; ++n) {
        double p[3], outside = 0.0, inside = INFINITY;
        for (int k = 0; k < 3; ++k) {
            p[k] = 4.0 * (double)random_float(&random_state) - 2.0;
            outside += pow(fmax(fabs(p[k]) - 1.0, 0.0), 2.0);
            inside = fmin(inside, 1.0 - fabs(p[k]));
        }
        double expected = outside > 0.0 ? sqrt(outside) : inside;
        assert_true(fabs(accel_distance(world.accel, &world.pose, p) - expected) < 1e-12);
    }
}
