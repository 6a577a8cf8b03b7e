/* Which meshes a ray that leaves them cannot meet again. */
#include "accel_fixture.h"

#include "accel/hull.h"
#include "unit.h"

static uint32_t hull_of(struct scene_mesh mesh)
{
    struct scene *scene = scene_begin(&silent, "hull");
    scene_put(scene, mesh, NULL);
    scene_ready(scene);
    uint32_t hull = accel_hull(&scene->meshes[0]);
    scene_destroy(scene);
    return hull;
}

/* Turns all triangles, so that the inside becomes the outside. */
static struct scene_mesh turned(struct scene_mesh mesh)
{
    for (uint32_t i = 0; i < mesh.triangle_count; ++i) {
        uint32_t *corner = &mesh.indices[3 * (size_t)i], first = corner[0];
        corner[0] = corner[1];
        corner[1] = first;
    }
    return mesh;
}

TEST(convex_bodies_are_their_hulls)
{
    assert_int_equal(hull_of(mesh_box(0.3, 0.7, 0.1)), HULL_CONVEX);
    assert_int_equal(hull_of(mesh_icosphere(0.7, 2)), HULL_CONVEX);
    assert_int_equal(hull_of(mesh_balls((const double[]){1, 2, 3, 0.5}, 1)), HULL_CONVEX);
    assert_int_equal(hull_of(turned(mesh_box(1, 1, 1))), HULL_NONE);
    assert_int_equal(hull_of(turned(mesh_icosphere(1, 1))), HULL_NONE);
    assert_int_equal(hull_of(mesh_torus(1.0, 0.3, 20, 10)), HULL_NONE);
    assert_int_equal(hull_of(mesh_balls((const double[]){0, 0, 0, 1, 3, 0, 0, 1}, 2)), HULL_NONE);
}

/* Too many vertices to compare all of them with all triangles. */
TEST(large_meshes_are_not_examined)
{
    assert_int_equal(hull_of(mesh_icosphere(1, 3)), HULL_NONE);
}

TEST(planes_are_those_of_an_axis)
{
    assert_int_equal(hull_of(mesh_plane(2)), HULL_PLANAR);
    const float slanted[] = {0, 0, 0, 1, 1, 0, 0, 0, 1, 1, 1, 0, 1, 1, 1, 0, 0, 1};
    assert_int_equal(hull_of(mesh_triangles(slanted, 2)), HULL_NONE);
}

/* Two triangles of a square, of which one corner is moved: a ray that leaves one may meet the other
   if they make a valley, not if they make a ridge. */
TEST(valleys_are_seen)
{
    static const float depths[] = {1e-3f, 1e-7f, 1e-20f, 1e-45f};
    for (size_t i = 0; i < sizeof depths / sizeof *depths; ++i)
        for (int up = 0; up < 2; ++up) {
            float z = up ? depths[i] : -depths[i];
            const float square[] = {0, 0, 0, 1, 0, z, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
            assert_int_equal(hull_of(mesh_triangles(square, 2)), up ? HULL_NONE : HULL_CONVEX);
        }
}
