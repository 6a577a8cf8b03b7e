/* Guessing which axis is up, for models whose files do not state it. */
#include "../scenes.h"
#include "load/up.h"
#include "unit.h"

static struct scene_mesh laid(struct scene_mesh mesh)
{
    for (uint32_t i = 0; i < mesh.vertex_count; ++i) {
        float *p = mesh.positions + 3 * (size_t)i, y = p[1];
        p[1] = -p[2];
        p[2] = y;
    }
    return mesh;
}

/* A scene of one model, made with +y up; `along_z`: rotated so that +z is up. */
static struct scene *lying(struct scene_mesh mesh, bool along_z)
{
    struct scene *scene = scene_begin(NULL, "test");
    scene_put(scene, along_z ? laid(mesh) : mesh, NULL);
    return scene;
}

static struct scene_mesh raised(struct scene_mesh mesh, float by)
{
    for (uint32_t i = 0; i < mesh.vertex_count; ++i)
        mesh.positions[3 * (size_t)i + 1] += by;
    return mesh;
}

/* A pyramid that stands on the square around the origin. */
static struct scene_mesh pyramid(float at)
{
    static const float corners[] = {-1, 0, -1, 1, 0, -1, 1,  0, 1,  -1, 0, -1, 1, 0, 1, -1, 0, 1,
                                    -1, 0, -1, 0, 3, 0,  1,  0, -1, 1,  0, -1, 0, 3, 0, 1,  0, 1,
                                    1,  0, 1,  0, 3, 0,  -1, 0, 1,  -1, 0, 1,  0, 3, 0, -1, 0, -1};
    return raised(mesh_triangles(corners, 6), at);
}

static whit_up guess(struct scene_mesh mesh, bool along_z, bool z_usual)
{
    own_scene *scene = lying(mesh, along_z);
    return up_guess(scene, z_usual);
}

TEST(what_stands_on_z_is_turned)
{
    assert_int_equal(guess(pyramid(0), false, false), WHIT_UP_Y);
    assert_int_equal(guess(pyramid(0), true, false), WHIT_UP_Z);
    /* Not at z = 0 it may be a relief whose back is in the z plane. */
    assert_int_equal(guess(pyramid(-1), true, false), WHIT_UP_Y);
    assert_int_equal(guess(mesh_box(1, 1, 1), true, false), WHIT_UP_Y);
    assert_int_equal(guess(raised(mesh_box(1, 1, 1), 0.5f), true, false), WHIT_UP_Y);
    assert_int_equal(guess(mesh_icosphere(1, 3), true, false), WHIT_UP_Y);
}

/* A table whose four legs cover a hundredth of the ground, or a chair, which also has a back. */
static whit_up guess_table(bool along_z, float at, bool back)
{
    own_scene *scene = scene_begin(NULL, "test");
    struct scene_mesh parts[5] = {raised(mesh_box(2, 0.1, 2), at + 0.95f)};
    float side = back ? 0.93f : 0.9f;
    struct scene_mesh leaned = raised(mesh_box(2, 1.3, 0.1), 1.65f);
    for (uint32_t k = 0; k < leaned.vertex_count; ++k)
        leaned.positions[3 * (size_t)k + 2] -= 0.95f;
    if (back)
        scene_put(scene, along_z ? laid(leaned) : leaned, NULL);
    else
        scene_mesh_finish(&leaned);
    for (int i = 1; i < 5; ++i) {
        parts[i] = raised(mesh_box(0.1, 0.9, 0.1), at + 0.45f);
        for (uint32_t k = 0; k < parts[i].vertex_count; ++k) {
            parts[i].positions[3 * (size_t)k] += i & 1 ? side : -side;
            parts[i].positions[3 * (size_t)k + 2] += i & 2 ? side : -side;
        }
    }
    for (int i = 0; i < 5; ++i)
        scene_put(scene, along_z ? laid(parts[i]) : parts[i], NULL);
    return up_guess(scene, false);
}

TEST(what_stands_on_feet_is_turned)
{
    assert_int_equal(guess_table(true, 0, false), WHIT_UP_Z);
    assert_int_equal(guess_table(false, 0, false), WHIT_UP_Y);
    assert_int_equal(guess_table(true, -0.5f, false), WHIT_UP_Y);
    assert_int_equal(guess_table(true, 0, true), WHIT_UP_Z);
    assert_int_equal(guess_table(false, 0, true), WHIT_UP_Y);
}

/* A ball on a pole is the same on all sides, a seat with a back stands on a large bottom. */
TEST(what_has_equal_sides_is_turned)
{
    for (int along_z = 0; along_z < 2; ++along_z) {
        for (int stl = 0; stl < 2; ++stl) {
            own_scene *scene = scene_begin(NULL, "test");
            struct scene_mesh parts[2] = {raised(mesh_box(0.1, 3, 0.1), 1.5f),
                                          raised(mesh_icosphere(1, 3), 4)};
            for (int i = 0; i < 2; ++i)
                scene_put(scene, along_z ? laid(parts[i]) : parts[i], NULL);
            assert_int_equal(up_guess(scene, stl), along_z ? WHIT_UP_Z : WHIT_UP_Y);
            own_scene *seat = scene_begin(NULL, "test");
            parts[0] = raised(mesh_box(2, 0.4, 1), 0.2f);
            parts[1] = raised(mesh_box(2, 0.6, 0.1), 0.7f);
            for (uint32_t k = 0; k < parts[1].vertex_count; ++k)
                parts[1].positions[3 * (size_t)k + 2] -= 0.45f;
            for (int i = 0; i < 2; ++i)
                scene_put(seat, along_z ? laid(parts[i]) : parts[i], NULL);
            assert_int_equal(up_guess(seat, stl), along_z ? WHIT_UP_Z : WHIT_UP_Y);
        }
    }
}

/* A half shell, such as a mask, whose rim is at z = 0. */
TEST(what_ends_in_a_rim_keeps_standing)
{
    own_scene *scene = scene_begin(NULL, "test");
    struct scene_mesh shell = mesh_icosphere(1, 3);
    for (uint32_t k = 0; k < shell.vertex_count; ++k)
        shell.positions[3 * (size_t)k + 2] = fabsf(shell.positions[3 * (size_t)k + 2]);
    scene_put(scene, shell, NULL);
    assert_int_equal(up_guess(scene, false), WHIT_UP_Y);
}

TEST(boards_keep_standing_and_floors_lie)
{
    assert_int_equal(guess(mesh_plane(4), true, false), WHIT_UP_Y);
    assert_int_equal(guess(raised(mesh_box(4, 0.1, 4), 0.05f), true, false), WHIT_UP_Y);
    own_scene *scene = lying(mesh_plane(20), true);
    scene_put(scene, laid(raised(mesh_box(1, 1, 1), 0.6f)), NULL);
    assert_int_equal(up_guess(scene, false), WHIT_UP_Z);
}

/* A surface of waves, with equal slopes along x and z or (`folds`) along x alone. */
static struct scene_mesh waves(bool folds)
{
    struct scene_mesh mesh = mesh_terrain(4, 1, 32, 1);
    for (uint32_t k = 0; k < mesh.vertex_count; ++k) {
        float *p = mesh.positions + 3 * (size_t)k;
        p[1] = 0.3f * sinf(3 * p[0]) + (folds ? 0.0f : 0.3f * sinf(3 * p[2]));
    }
    return mesh;
}

TEST(terrains_lie_and_curtains_hang)
{
    for (int high = 0; high < 2; ++high) {
        float at = high ? 300 : 0;
        assert_int_equal(guess(raised(waves(false), at), true, false), WHIT_UP_Z);
        assert_int_equal(guess(raised(waves(false), at), false, false), WHIT_UP_Y);
        assert_int_equal(guess(raised(waves(false), at), false, true), WHIT_UP_Y);
    }
    assert_int_equal(guess(waves(true), true, false), WHIT_UP_Y);
    /* A rough wall that stands on the ground. */
    assert_int_equal(guess(raised(laid(waves(false)), 2), false, false), WHIT_UP_Y);
    /* A shell without corners. */
    struct scene_mesh shell = waves(false);
    for (uint32_t k = 0; k < 3 * shell.triangle_count; k += 3) {
        const float *p = shell.positions + 3 * (size_t)shell.indices[k];
        if (hypotf(p[0], p[2]) > 2.0f)
            shell.indices[k] = shell.indices[k + 1] = shell.indices[k + 2];
    }
    assert_int_equal(guess(shell, true, false), WHIT_UP_Y);
}

/* A flat surface of waves that faces z, centred along x, may be a relief; one at the corner of a
   grid, or far from the origin, is a terrain. */
TEST(reliefs_stand_and_flat_terrains_lie)
{
    static const struct {
        float thick, x, y;
        whit_up up;
    } cases[] = {{0.2f, 0, 0, WHIT_UP_Y},
                 {0.2f, 0, 3.6f, WHIT_UP_Y},
                 {1, 0, 0, WHIT_UP_Z},
                 {0.2f, 2, 2, WHIT_UP_Z},
                 {0.2f, 500, 4000, WHIT_UP_Z}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct scene_mesh mesh = laid(waves(false));
        for (uint32_t k = 0; k < mesh.vertex_count; ++k) {
            float *p = mesh.positions + 3 * (size_t)k;
            p[0] += cases[i].x;
            p[1] += cases[i].y;
            p[2] *= cases[i].thick;
        }
        assert_int_equal(guess(mesh, false, false), cases[i].up);
    }
}

/* A cave that is open at the front, with a ball in it. */
TEST(caves_with_something_inside_stand)
{
    own_scene *scene = lying(waves(false), true);
    scene_put(scene, mesh_icosphere(1.9, 3), NULL);
    assert_int_equal(up_guess(scene, false), WHIT_UP_Y);
}

/* A cabinet with a knob, whose back is in the plane z = 0, above the floor. */
TEST(what_hangs_on_a_wall_is_not_laid)
{
    own_scene *scene = scene_begin(NULL, "test");
    struct scene_mesh parts[] = {mesh_box(1, 0.7, 0.35), mesh_box(0.02, 0.02, 0.04)};
    for (int i = 0; i < 2; ++i) {
        for (uint32_t k = 0; k < parts[i].vertex_count; ++k)
            parts[i].positions[3 * (size_t)k + 2] += i ? 0.37f : 0.175f;
        scene_put(scene, raised(parts[i], 1.6f), NULL);
    }
    assert_int_equal(up_guess(scene, false), WHIT_UP_Y);
}

/* A ball on a plane, nearer to one side; a share of its height is below the plane. */
static whit_up guess_site(double share)
{
    own_scene *scene = scene_begin(NULL, "test");
    scene_put(scene, laid(raised(mesh_plane(4), (float)(2 * share))), NULL);
    struct scene_mesh ball = raised(mesh_icosphere(1, 3), 1);
    for (uint32_t k = 0; k < ball.vertex_count; ++k)
        ball.positions[3 * (size_t)k + 2] += 0.5f;
    scene_put(scene, laid(ball), NULL);
    return up_guess(scene, false);
}

TEST(a_floor_may_have_something_below)
{
    assert_int_equal(guess_site(0.05), WHIT_UP_Z);
    assert_int_equal(guess_site(0.2), WHIT_UP_Y);
}

TEST(stl_is_of_machines_that_print)
{
    assert_int_equal(guess(mesh_icosphere(1, 3), false, true), WHIT_UP_Z);
    assert_int_equal(guess(pyramid(-1), true, true), WHIT_UP_Z);
    assert_int_equal(guess(pyramid(0), false, true), WHIT_UP_Y);
}

TEST(nothing_and_odd_numbers_stay)
{
    struct scene *scene = scene_begin(NULL, "test");
    assert_int_equal(up_guess(scene, true), WHIT_UP_Y);
    scene_destroy(scene);
    struct scene_mesh mesh = mesh_box(1, 1, 1);
    mesh.positions[4] = (float)INFINITY;
    assert_int_equal(guess(mesh, false, true), WHIT_UP_Y);
}

/* Rotations are exact, and turn the axis to +y. */
TEST(turns_are_of_whole_numbers)
{
    static const double axes[][3] = {
        [WHIT_UP_X] = {1, 0, 0},        [WHIT_UP_Y] = {0, 1, 0},
        [WHIT_UP_Z] = {0, 0, 1},        [WHIT_UP_MINUS_X] = {-1, 0, 0},
        [WHIT_UP_MINUS_Y] = {0, -1, 0}, [WHIT_UP_MINUS_Z] = {0, 0, -1}};
    own_scene *scene = scene_begin(NULL, "test");
    for (uint32_t up = WHIT_UP_Y; up <= WHIT_UP_MINUS_Z; ++up) {
        uint32_t node = up_add_node(scene, (whit_up)up);
        double out[3];
        affine_vector(&scene->nodes[node].matrix, axes[up], out);
        assert_true(out[0] == 0.0 && out[1] == 1.0 && out[2] == 0.0);
        assert_true(affine_determinant(&scene->nodes[node].matrix) == 1.0);
    }
}
