/* The camera that whit makes for a file without one. */
#include "scene_model_fixture.h"

static const struct scene_camera *camera_of(struct scene *scene, double forward[3])
{
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    assert_int_equal(scene->camera_count, 1);
    const struct scene_camera *camera = &scene->cameras[0];
    for (int i = 0; i < 3; ++i)
        forward[i] = camera->target[i] - camera->eye[i];
    double3_unit(forward);
    return camera;
}

static double reach(const struct scene_camera *camera, const double forward[3], const float *p,
                    double slope[2])
{
    double right[3] = {-forward[2], 0, forward[0]}, up[3], way[3];
    double3_unit(right);
    double3_cross(right, forward, up);
    for (int i = 0; i < 3; ++i)
        way[i] = (double)p[i] - camera->eye[i];
    double tangent = tan(0.5 * (double)camera->fov_y), depth = double3_dot(way, forward);
    slope[0] = double3_dot(way, right) / depth / (tangent * 4.0 / 3.0);
    slope[1] = double3_dot(way, up) / depth / tangent;
    return depth;
}

/* Asserts that a point lies in the picture, at most at this share of its half height. */
static void assert_shown(const struct scene_camera *camera, const double forward[3], const float *p,
                         double most)
{
    double slope[2];
    assert_true(reach(camera, forward, p, slope) > 0.0);
    assert_true(fabs(slope[1]) < most);
}

/* All vertices lie in a 4:3 picture, and some near its border on both sides. */
TEST(closed_shapes_fill_the_usual_view)
{
    const double scales[] = {1.0, 1e-6, 1e9};
    for (size_t k = 0; k < 3; ++k) {
        own_scene *scene = empty_scene();
        struct scene_mesh ball;
        assert_int_equal(shape_sphere(scales[k], 24, 12, &ball), WHIT_OK);
        scene_put(scene, ball, NULL);
        double forward[3], lo[2] = {1, 1}, hi[2] = {-1, -1};
        const struct scene_camera *camera = camera_of(scene, forward);
        const struct scene_mesh *mesh = &scene->meshes[0];
        for (uint32_t i = 0; i < mesh->vertex_count; ++i) {
            double slope[2];
            assert_true(reach(camera, forward, mesh->positions + 3 * (size_t)i, slope) > 0.0);
            for (int a = 0; a < 2; ++a) {
                lo[a] = fmin(lo[a], slope[a]);
                hi[a] = fmax(hi[a], slope[a]);
            }
        }
        assert_true(lo[0] > -0.95 && hi[0] < 0.95 && lo[1] > -0.95 && hi[1] < 0.95);
        assert_true(lo[1] < -0.9 && hi[1] > 0.9);
        assert_true(forward[0] < -0.3 && forward[1] < -0.2 && forward[2] < -0.7);
        assert_true(scene_noted(scene, "one was added that shows all of it"));
    }
}

TEST(open_boxes_are_seen_through_their_opening)
{
    const float half[3] = {1, 1, 1};
    const unsigned sides[] = {1, 0, 5, 4};
    const double expected[][3] = {{-1, 0, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}};
    for (size_t k = 0; k < 4; ++k) {
        own_scene *scene = empty_scene();
        scene_put(scene, walls(half, 1u << sides[k], false), NULL);
        double forward[3];
        const struct scene_camera *camera = camera_of(scene, forward);
        assert_true(double3_distance(forward, expected[k]) < 1e-6);
        assert_true(fabs(camera->eye[0]) + fabs(camera->eye[2]) > 2.0);
        assert_true(scene_noted(scene, "straight on"));
    }
}

/* A mirrored copy of a box that faces inwards still shows its inside. */
TEST(mirrors_do_not_turn_surfaces)
{
    const float half[3] = {1, 1, 1};
    own_scene *scene = empty_scene();
    struct scene_node node;
    scene_node_init(&node, "mirror", SCENE_NONE);
    node.scale[0] = -1.0;
    uint32_t mirror = scene_add_node(scene, node);
    scene_put(scene, walls(half, 1u << 5, false), &(struct put){.node = &mirror});
    double forward[3];
    camera_of(scene, forward);
    assert_true(fabs(forward[2] + 1.0) < 1e-6);
}

TEST(rooms_are_seen_from_inside)
{
    const float half[3] = {6, 2, 3};
    for (int thick = 0; thick < 2; ++thick) {
        own_scene *scene = empty_scene();
        scene_put(scene, walls(half, 0, false), NULL);
        if (thick)
            scene_put(scene, walls((const float[]){6.3f, 2.3f, 3.3f}, 0, true), NULL);
        double forward[3];
        const struct scene_camera *camera = camera_of(scene, forward);
        assert_true(scene_noted(scene, "for it is a room"));
        assert_true(fabs(fabs(forward[0]) - 1.0) < 1e-9);
        for (int i = 0; i < 3; ++i)
            assert_true(fabs(camera->eye[i]) < (double)half[i]);
        assert_true(camera->eye[0] * forward[0] < -3.0);
        assert_int_equal(scene->light_count, 2);
        for (uint32_t i = 0; i < 2; ++i) {
            assert_int_equal(scene->lights[i].kind, WHIT_LIGHT_POINT);
            assert_true(fabs(scene->lights[i].position[0]) < 6.0);
        }
        /* The lamp is in front of the camera, half-way to the left wall and to the ceiling. */
        const double *lamp = scene->lights[0].position;
        assert_true((lamp[0] - camera->eye[0]) * forward[0] > 1.0);
        assert_true(fabs(lamp[1] - 0.5 * (camera->eye[1] + 2.0)) < 0.02);
        assert_true(fabs(lamp[2] * forward[0] + 1.5) < 0.02);
    }
    /* The same walls as a solid. */
    own_scene *scene = empty_scene();
    scene_put(scene, walls(half, 0, true), NULL);
    double forward[3];
    camera_of(scene, forward);
    assert_false(scene_noted(scene, "room"));
    assert_int_equal(scene->lights[0].kind, WHIT_LIGHT_DIRECTIONAL);
}

TEST(boards_are_seen_straight_on)
{
    own_scene *scene = empty_scene();
    scene_put(scene, walls((const float[]){2, 1, 0.02f}, 0, true), NULL);
    double forward[3];
    camera_of(scene, forward);
    assert_true(fabs(forward[2] + 1.0) < 1e-9);
}

/* A board with a picture on its far side, and a plate before most of it. */
TEST(boards_show_their_pictures)
{
    own_scene *scene = empty_scene();
    struct scene_material printed = material_grey("printed");
    printed.textures[SCENE_SLOT_DIFFUSE].texture = scene_put_texture(scene, 1, 1, (uint8_t[4]){0});
    struct scene_mesh board = walls((const float[]){1.2f, 1.2f, 0.02f}, 0x2f, true);
    scene_put(scene, board, &(struct put){.material = &printed});
    scene_put(scene, walls((const float[]){1, 1, 0.02f}, 0x1f, true), NULL);
    double forward[3];
    camera_of(scene, forward);
    assert_true(fabs(forward[2] - 1.0) < 1e-9);
}

/* A ball beside the middle of a floor, which is `wide` times as wide as the ball. */
static struct scene *ball_on_floor(double wide)
{
    struct scene *scene = empty_scene();
    scene_put(scene, mesh_plane(2.0 * wide), NULL);
    scene_put(scene, mesh_icosphere(1.0, 3), &(struct put){.at = {3, 1, -2}});
    return scene;
}

TEST(small_parts_with_nearly_all_triangles_fill_the_picture)
{
    double forward[3], to_ball[3] = {3, 1, -2};
    struct scene *scene = ball_on_floor(20.0);
    const struct scene_camera *camera = camera_of(scene, forward);
    assert_true(scene_noted(scene, "shows the small part of it that nearly all triangles are in"));
    double distance = double3_distance(camera->eye, to_ball);
    assert_true(distance > 2.5 && distance < 3.5);
    for (int i = 0; i < 3; ++i)
        assert_true(fabs(camera->eye[i] + distance * forward[i] - to_ball[i]) < 0.05);
    scene_destroy(scene);

    scene = ball_on_floor(4.0);
    camera = camera_of(scene, forward);
    assert_true(scene_noted(scene, "shows all of it"));
    assert_true(double3_length(camera->eye) > 8.0);
    scene_destroy(scene);
}

/* Whether whit's own camera shows only a part of the scene, which is then the ball of radius 1 at
   (3, 1, -2). */
static bool shows_ball(struct scene *scene)
{
    double forward[3], to_ball[3] = {3, 1, -2};
    const struct scene_camera *camera = camera_of(scene, forward);
    bool part = scene_noted(scene, "shows the small part");
    double distance = double3_distance(camera->eye, to_ball);
    for (int i = 0; part && i < 3; ++i)
        assert_true(fabs(camera->eye[i] + distance * forward[i] - to_ball[i]) < 0.2);
    assert_int_equal(part, distance < 5.0);
    assert_int_equal(part, scene->shown_lo[0] <= scene->shown_hi[0]);
    for (int k = 0; part && k < 3; ++k) {
        assert_true(fabs(scene->shown_lo[k] - to_ball[k] + 1.0) < 0.1);
        assert_true(fabs(scene->shown_hi[k] - to_ball[k] - 1.0) < 0.1);
    }
    return part;
}

static struct scene *ball_and(struct scene_mesh mesh, const double at[3], uint32_t level)
{
    struct scene *scene = empty_scene();
    scene_put(scene, mesh, &(struct put){.at = {at[0], at[1], at[2]}});
    scene_put(scene, mesh_icosphere(1.0, level), &(struct put){.at = {3, 1, -2}});
    return scene;
}

/* Floors of many triangles, and thick ones under a ball of few. The board stands on the floor
   beside the ball, so that both are shown. */
TEST(floors_do_not_count)
{
    own_scene *scene = ball_and(mesh_terrain(60, 1e-9, 60, 1), (const double[3]){0}, 1);
    assert_true(shows_ball(scene));
    own_scene *slab = ball_and(mesh_box(60, 0.2, 60), (const double[3]){0, -0.1, 0}, 1);
    assert_true(shows_ball(slab));
    own_scene *hills = ball_and(mesh_terrain(60, 8.0, 60, 1), (const double[3]){0}, 1);
    assert_false(shows_ball(hills));
    own_scene *two = ball_and(mesh_plane(60), (const double[3]){0}, 3);
    scene_put(two, mesh_box(2, 6, 0.5), &(struct put){.at = {6, 3, -2}});
    double forward[3];
    const struct scene_camera *camera = camera_of(two, forward);
    assert_true(scene_noted(two, "shows the small part"));
    assert_shown(camera, forward, (const float[]){7, 6, -2}, 1.0);
    assert_shown(camera, forward, (const float[]){2, 0, -2}, 1.0);
}

/* A ball of nearly all triangles is shown alone before a wall that faces it, between walls, and
   beside a stray, but not at the side of a solid, nor behind a wall. */
TEST(dense_parts_stand_for_all_only_before_a_backdrop)
{
    own_scene *wall =
        ball_and(walls((const float[]){20, 10, 5}, 0x2f, false), (const double[3]){0}, 4);
    assert_true(shows_ball(wall));
    own_scene *court =
        ball_and(walls((const float[]){20, 5, 20}, 0xc, true), (const double[3]){0, 5, 0}, 4);
    assert_true(shows_ball(court));
    own_scene *stray = ball_and(mesh_plane(1), (const double[3]){-90, 30, 0}, 4);
    assert_true(shows_ball(stray));
    own_scene *house = ball_and(mesh_box(30, 20, 10), (const double[3]){0, 8, -8}, 4);
    assert_false(shows_ball(house));
    own_scene *hidden = ball_and(mesh_box(40, 20, 0.1), (const double[3]){3, 8, -8}, 4);
    scene_put(hidden, mesh_box(40, 20, 0.1), &(struct put){.at = {3, 8, 0.2}});
    assert_false(shows_ball(hidden));
}

/* A ball in a closed box, or sunk into the surface of a larger ball, is under no sky. */
TEST(solids_are_no_skies)
{
    own_scene *crate = ball_and(mesh_box(20, 20, 20), (const double[3]){0}, 0);
    assert_false(shows_ball(crate));
    own_scene *planet = ball_and(mesh_sphere(20, 32, 16), (const double[3]){0, -16, -2}, 1);
    assert_false(shows_ball(planet));
}

/* A sphere around everything, turned inwards or not, the upper half of one on a floor, or a box. No
   light gets in from outside. */
TEST(skies_do_not_count)
{
    for (int kind = 0; kind < 4; ++kind) {
        struct scene_mesh sky =
            kind == 3 ? walls((const float[]){60, 60, 60}, 0, false) : mesh_sphere(60, 32, 16);
        for (uint32_t i = 0; (kind == 1 || kind == 2) && i < 3 * sky.triangle_count; i += 3) {
            uint32_t first = sky.indices[i];
            sky.indices[i] = sky.indices[i + 1];
            sky.indices[i + 1] = first;
        }
        for (uint32_t i = 0; kind == 2 && i < sky.vertex_count; ++i)
            sky.positions[3 * (size_t)i + 1] = fmaxf(sky.positions[3 * (size_t)i + 1], 0.0f);
        own_scene *scene = ball_and(sky, (const double[3]){0}, 1);
        assert_true(shows_ball(scene));
        assert_int_equal(scene->light_count, 2);
        assert_true(scene_noted(scene, "two lamps were added, at the camera and above it"));
        for (int k = 0; k < 3; ++k)
            assert_true(scene->lights[0].position[k] != scene->lights[1].position[k]);
    }
}

/* A box of sky may have a floor at half of its height. In a room things stand on its bottom. */
TEST(what_stands_on_the_bottom_of_a_box_is_in_a_room)
{
    const float half[] = {60, 60, 60};
    own_scene *floor = ball_and(walls(half, 0, false), (const double[3]){0}, 1);
    scene_put(floor, mesh_plane(120), NULL);
    assert_true(shows_ball(floor));
    own_scene *room = ball_and(walls(half, 0, false), (const double[3]){0, 60, 0}, 1);
    double forward[3];
    camera_of(room, forward);
    assert_true(scene_noted(room, "for it is a room"));
}

/* The tips of these cones are far from the centroids of their triangles. */
TEST(long_triangles_of_a_part_are_in_the_picture)
{
    own_scene *scene = empty_scene();
    struct scene_mesh cone;
    assert_int_equal(shape_cylinder(0.5, 0.0, 2.0, 64, &cone), WHIT_OK);
    scene_put(scene, mesh_plane(20), NULL);
    scene_put(scene, cone, &(struct put){.at = {0, 1, 0}});
    double forward[3];
    const struct scene_camera *camera = camera_of(scene, forward);
    assert_true(scene_noted(scene, "shows the small part of it that nearly all triangles are in"));
    assert_shown(camera, forward, (const float[]){0, 2, 0}, 1.0);
}

/* The picture has room for an object that flies away later, also where it is far away only at one
   key, between even steps, or before the time 0. */
TEST(animations_stay_in_the_picture)
{
    static const struct {
        uint32_t keys;
        float times[4];
    } rows[] = {{2, {0, 2}}, {4, {0, 0.1f, 0.2f, 16}}, {4, {-4, -3, -2, -1}}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        own_scene *scene = empty_scene();
        uint32_t flies = scene_put_node(scene, SCENE_NONE, 0, 0, 0);
        scene_put(scene, walls((const float[]){1, 1, 1}, 0, true), &(struct put){.node = &flies});
        scene_put_channel(scene, flies, SCENE_PATH_TRANSLATION, rows[i].keys, rows[i].times,
                          (float[]){0, 0, 0, 0, 20, 0, 0, 0, 0, 0, 0, 0});
        double forward[3];
        const struct scene_camera *camera = camera_of(scene, forward);
        assert_shown(camera, forward, (const float[]){1, 21, 1}, 0.95);
        assert_shown(camera, forward, (const float[]){1, -1, 1}, 0.95);
        assert_true(scene->time_end_s == rows[i].times[rows[i].keys - 1]);
    }
}

/* A triangle turns once around its corner of 90 degrees. Corners of the box around it would go 1.4
   times as far as its own. */
TEST(animations_fill_the_picture)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    own_scene *scene = empty_scene();
    struct scene_mesh mesh = mesh_zeroed(3, 1);
    memcpy(mesh.positions, corners, sizeof corners);
    memcpy(mesh.indices, (uint32_t[]){0, 1, 2}, 3 * sizeof *mesh.indices);
    uint32_t turns = scene_put_node(scene, SCENE_NONE, 0, 0, 0);
    scene_put(scene, mesh, &(struct put){.node = &turns});
    scene_put_channel(scene, turns, SCENE_PATH_ROTATION, 3, (float[]){0, 1, 2},
                      (float[]){0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, -1});
    double forward[3], slope[2];
    const struct scene_camera *camera = camera_of(scene, forward);
    assert_true(reach(camera, forward, (const float[]){0, 1, 0}, slope) > 0.0);
    assert_true(slope[1] > 0.85 && slope[1] < 0.95);
}

/* Cameras of a model, of which some or all look past a box: in the latter case whit adds its own.
 */
TEST(cameras_that_see_nothing_are_dropped)
{
    const struct {
        double eye[3], target[3];
        bool blind, parallel;
    } rows[] = {{{0, 0, 9}, {0, 0, 0}, false, false}, {{0, 0, 9}, {0, 0, 99}, true, false},
                {{0, 0, 9}, {0, 9, 0}, true, false},  {{0, 0, 9}, {0, -9, 0}, true, false},
                {{0, 0, 9}, {9, 0, 7}, true, false},  {{0, 0, 9}, {-9, 0, 7}, true, false},
                {{0, 0, 9}, {0, 3, 0}, false, false}, {{0, 0, 0.5}, {0, 0, 99}, false, false},
                {{0, 0, 9}, {0, 0, 0}, false, true},  {{0, 0, 9}, {0, 0, 99}, true, true},
                {{0, 9, 9}, {0, 9, 0}, true, true}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        for (int other = 0; other < 3; ++other) {
            own_scene *scene = empty_scene();
            scene_put(scene, mesh_box(2, 2, 2), NULL);
            if (other == 1) /* which sees it */
                scene_put_camera(scene, (const double[]){9, 0, 0}, (const double[]){0, 0, 0}, 0.7);
            scene_put_camera(scene, rows[i].eye, rows[i].target, 0.7);
            struct scene_camera *camera = &scene->cameras[scene->camera_count - 1];
            camera->kind = rows[i].parallel ? WHIT_CAMERA_ORTHOGRAPHIC : WHIT_CAMERA_PERSPECTIVE;
            camera->height = 4.0f;
            scene->is_model = other < 2;
            scene_ready(scene);
            bool dropped = rows[i].blind && other == 0;
            assert_int_equal(scene_noted(scene, "no camera of the file sees anything"), dropped);
            assert_int_equal(scene->cameras[0].made_by_whit, dropped);
            assert_int_equal(scene->camera_count, other == 1 ? 2 : 1);
        }
    }
}
