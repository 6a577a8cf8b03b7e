/* The camera that whit makes for a file without one, and the intensity of the lights of models. */
#include "../scenes.h"
#include "base/array.h"
#include "base/vec.h"
#include "scene/scene.h"
#include "scene/shapes.h"
#include "unit.h"

static struct scene *empty_scene(void)
{
    struct scene *scene = scene_begin(NULL, "test");
    scene_put_material(scene, material_grey("plain"));
    return scene;
}

/* Freezes a model that is seen from `eye`. */
static struct scene *seen_from(struct scene *scene, const double eye[3], const double target[3],
                               double fov_y)
{
    scene_put_camera(scene, eye, target, fov_y);
    scene->is_model = true;
    return scene_ready(scene);
}

/* The walls of a box of half size `half` around the origin, seen from inside, but for those in
   `open`: bit 2 * axis + (1: the high side). `turned`: seen from outside. */
static struct scene_mesh walls(const float half[3], unsigned open, bool turned)
{
    struct scene_mesh mesh = mesh_zeroed(6 * 4, 6 * 2);
    mesh.vertex_count = mesh.triangle_count = 0;
    for (uint32_t wall = 0; wall < 6; ++wall) {
        if (open >> wall & 1)
            continue;
        uint32_t axis = wall / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        float side = wall & 1 ? 1.0f : -1.0f;
        for (uint32_t i = 0; i < 4; ++i) {
            float *p = mesh.positions + 3 * (size_t)(mesh.vertex_count + i);
            p[axis] = side * half[axis];
            p[u] = (i == 1 || i == 2 ? 1.0f : -1.0f) * half[u];
            p[v] = (i >= 2 ? 1.0f : -1.0f) * half[v];
        }
        bool outward = side > 0.0f; /* of u, v going round as 0 1 2 3 */
        const uint32_t order[2][6] = {{0, 1, 2, 0, 2, 3}, {0, 2, 1, 0, 3, 2}};
        for (uint32_t i = 0; i < 6; ++i)
            mesh.indices[3 * mesh.triangle_count + i] =
                mesh.vertex_count + order[outward != turned][i];
        mesh.vertex_count += 4;
        mesh.triangle_count += 2;
    }
    return mesh;
}

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

/* A sphere around everything, turned inwards or not, or the upper half of one on a floor. No light
   gets in from outside. */
TEST(skies_do_not_count)
{
    for (int kind = 0; kind < 3; ++kind) {
        struct scene_mesh sky = mesh_sphere(60, 32, 16);
        for (uint32_t i = 0; kind != 0 && i < 3 * sky.triangle_count; i += 3) {
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

/* A floor under a lamp that glows with `emission`, both stated in `file`. */
static struct scene *lamp_scene(float emission, const char *file)
{
    struct scene *scene = empty_scene();
    struct scene_material glowing = material_grey("lamp");
    set_rgb(glowing.emission, emission, emission, emission);
    glowing.origin.file = string_copy(file);
    scene_put(scene, mesh_plane(4.0), NULL);
    scene_put(scene, mesh_plane(1.0), &(struct put){.material = &glowing, .at = {0, 3, 0}});
    return scene_ready(scene);
}

/* The sum of the intensities of all lights, straight ahead and from far away. Flat lights state
   their radiance, which is multiplied by area over pi. */
static double light_total(const struct scene *scene)
{
    double total = 0.0;
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        const struct scene_light *light = &scene->lights[i];
        double area = double3_area(light->edge_u, light->edge_v);
        double share = light->kind == WHIT_LIGHT_RECTANGLE  ? area / PI
                       : light->kind == WHIT_LIGHT_TRIANGLE ? area / (2.0 * PI)
                                                            : 1.0;
        total += share * (double)light->color[1];
    }
    return total;
}

/* Straight under the lamp: total / height^2, somewhat above what 9 of 10 points get. */
TEST(lamps_of_models_light_their_scene)
{
    const float emissions[] = {0.5f, 17.0f, 900.0f};
    for (size_t i = 0; i < 3; ++i) {
        own_scene *scene = lamp_scene(emissions[i], "lamp.mtl");
        double under = light_total(scene) / 9.0;
        assert_true(under > 0.7 && under < 1.2);
        assert_true(scene->ambient[0] == 0.1f);
    }
    own_scene *scene = lamp_scene(17.0f, "lamp.json");
    assert_true(fabs(light_total(scene) - 17.0 / PI) < 1e-4);
    assert_true(scene->ambient[0] == 0.03f);
}

static struct scene *lit_scene(float level, const char *file)
{
    struct scene *scene = empty_scene();
    struct scene_light light = {.kind = WHIT_LIGHT_POINT,
                                .node = SCENE_NONE,
                                .position = {0, 2, 0},
                                .color = {level, level, level},
                                .falloff = true};
    light.origin.file = string_copy(file);
    scene_put(scene, mesh_plane(4.0), NULL);
    scene_put_light(scene, light);
    return scene_ready(scene);
}

TEST(stated_lights_change_only_where_nothing_is_seen)
{
    const struct {
        float level;
        const char *file;
        double lo, hi;
    } cases[] = {{1000.0f, "a.glb", 2.5, 4.5},
                 {4.0f, "a.glb", 4.0, 4.0},
                 {0.001f, "a.glb", 2.5, 4.5},
                 {1000.0f, "a.json", 1000.0, 1000.0}};
    for (size_t i = 0; i < 4; ++i) {
        own_scene *scene = lit_scene(cases[i].level, cases[i].file);
        double level = (double)scene->lights[0].color[1];
        assert_true(level >= cases[i].lo && level <= cases[i].hi);
        assert_int_equal(scene_noted(scene, "times as strong"), cases[i].lo != cases[i].hi);
    }
}

/* ---- Exposure ---- */

/* A wide floor with a lamp above the middle, which the camera looks at. */
static struct scene *lamp_over_floor(float level, float albedo, bool is_model, whit_lights lights)
{
    struct scene *scene = empty_scene();
    struct scene_material floor = material_plain("floor");
    struct scene_light light = {.kind = WHIT_LIGHT_SPOT,
                                .node = SCENE_NONE,
                                .position = {0, 2, 0},
                                .direction = {0, -1, 0},
                                .color = {level, level, level},
                                .versine_inner = 0.4f,
                                .versine_outer = 0.5f,
                                .falloff = true};
    light.origin.file = string_copy("a.glb");
    set_rgb(floor.diffuse, albedo, albedo, albedo);
    scene_put(scene, mesh_plane(100.0), &(struct put){.material = &floor});
    scene_put_light(scene, light);
    scene_put_camera(scene, (const double[]){0, 3, 3}, (const double[]){0, 0, 0}, 0.5);
    scene->is_model = is_model;
    scene->lights_wanted = lights;
    return scene_ready(scene);
}

/* The spot lights less than a tenth of the floor, so that its strength is left as it is. */
TEST(a_model_that_burns_out_is_exposed_less)
{
    const struct {
        float level, albedo;
        bool is_model;
        double lo, hi;
    } cases[] = {{4000.0f, 0.8f, true, -11.0, -8.5}, {4.0f, 0.8f, true, 0.0, 0.0},
                 {4000.0f, 0.8f, false, 0.0, 0.0},   {4.0f, 0.01f, true, 0.0, 0.0},
                 {0.01f, 0.8f, true, 6.0, 10.0},     {8.0f, 0.3f, true, 0.0, 0.0},
                 {5.9f, 0.8f, true, -0.5, -0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        own_scene *scene =
            lamp_over_floor(cases[i].level, cases[i].albedo, cases[i].is_model, WHIT_LIGHTS_FILE);
        double ev = scene->exposure_ev;
        assert_true(ev >= cases[i].lo && ev <= cases[i].hi && 2.0 * ev == floor(2.0 * ev));
        assert_int_equal(scene_noted(scene, "`--exposure auto` is"), ev != 0.0);
    }
}

/* Metal reflects its surroundings, so that its own colour does not count, unless its texture says
   that it is no metal. */
TEST(metal_is_not_taken_for_its_colour)
{
    static const uint8_t texels[2][4] = {{0, 0, 255, 255}, {0, 0, 0, 255}};
    for (int plastic = 0; plastic < 2; ++plastic) {
        own_scene *scene = empty_scene();
        struct scene_material m = material_plain("shiny");
        m.model = WHIT_MODEL_METAL_ROUGH;
        m.metallic = 1.0f;
        set_rgb(m.diffuse, 1, 1, 1);
        m.textures[SCENE_SLOT_METAL_ROUGH].texture =
            scene_put_texture(scene, 1, 1, texels[plastic]);
        scene_put(scene, mesh_plane(4.0), &(struct put){.material = &m});
        scene_put_sun(scene, 0, -1, 0, 1.9f);
        seen_from(scene, (const double[]){0, 3, 3}, (const double[]){0, 0, 0}, 0.5);
        assert_true((scene->exposure_ev < 0.0) == plastic);
    }
}

/* A lamp in a box above the floor lights nothing of it. */
TEST(light_that_does_not_arrive_burns_nothing_out)
{
    own_scene *scene = empty_scene();
    scene_put(scene, mesh_plane(100.0), NULL);
    scene_put(scene, mesh_plane(100.0), &(struct put){.at = {0, 4, 0}});
    struct scene_light light = {.kind = WHIT_LIGHT_DIRECTIONAL,
                                .node = SCENE_NONE,
                                .direction = {0, -1, 0},
                                .color = {1.9f, 1.9f, 1.9f}};
    light.origin.file = string_copy("a.glb");
    scene_put_light(scene, light);
    seen_from(scene, (const double[]){0, 3, 3}, (const double[]){0, 0, 0}, 0.5);
    assert_true(scene->exposure_ev == 0.0);
}

/* ---- Lights that light nothing in view ---- */

static uint32_t lights_by_whit(const struct scene *scene, whit_light_kind kind)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->light_count; ++i)
        count += scene->lights[i].made_by_whit && scene->lights[i].kind == kind;
    return count;
}

/* Asserts how many lights whit added to the scene, which it destroys. */
static void assert_added(struct scene *scene, uint32_t directional, uint32_t point)
{
    assert_int_equal(lights_by_whit(scene, WHIT_LIGHT_DIRECTIONAL), directional);
    assert_int_equal(lights_by_whit(scene, WHIT_LIGHT_POINT), point);
    scene_destroy(scene);
}

/* A block with a glowing plate, in front of it or on the far side, out of the camera's view. */
static struct scene *block_with_lamp(bool is_model, bool in_front)
{
    struct scene *scene = empty_scene();
    struct scene_material glow = material_plain("glow");
    set_rgb(glow.emission, 5, 5, 5);
    scene_put(scene, mesh_box(2, 2, 2), NULL);
    scene_put(scene, mesh_box(1, 1, 0.01),
              &(struct put){.material = &glow, .at = {0, 0, in_front ? 3 : -1.1}});
    scene_put_camera(scene, (const double[]){1, 1, 9}, (const double[]){0, 0, 0}, 0.5);
    scene->is_model = is_model;
    return scene_ready(scene);
}

TEST(lamps_that_nobody_sees_get_help)
{
    struct scene *scene = block_with_lamp(true, false);
    assert_true(scene_noted(scene, "the file's light reaches 0 % of what is seen: a directional "
                                   "one was added, over the camera's left shoulder"));
    assert_true(scene_noted(scene, "no environment in the file: a sky was added"));
    assert_added(scene, 1, 0);
    assert_added(block_with_lamp(true, true), 0, 0);
    assert_added(block_with_lamp(false, false), 0, 0); /* not in whit's own scene files */
}

/* A block of one material, with a little emission, which some exporters call transparent. */
static struct scene *block_that_emits(float emission)
{
    struct scene *scene = empty_scene();
    struct scene_material glow = material_plain("glow");
    glow.alpha = SCENE_ALPHA_BLEND;
    for (int i = 0; i < 3; ++i)
        glow.emission[i] = emission * glow.diffuse[i];
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &glow});
    return seen_from(scene, (const double[]){0, 0, 60}, (const double[]){0, 0, 0}, 0.5);
}

/* From so far away, points a little before the block would be lit by its own front. */
TEST(surfaces_brighter_by_light_than_by_emission_get_help)
{
    assert_added(block_that_emits(0.9f), 1, 0);
    assert_added(block_that_emits(2.0f), 0, 0);
}

/* A wall with a circle of light of this radius, in a view of 5.1 by 6.8 units. `is_stated`: it is
   strong, and the file states an ambient light and wants no other. */
static struct scene *wall_with_spot(double radius, bool is_stated)
{
    struct scene *scene = empty_scene();
    float edge = (float)(1.0 - cos(atan(radius / 5.0)));
    float level = is_stated ? 3.0f : 1.0f;
    scene_put(scene, mesh_box(100, 100, 0.1), NULL);
    if (is_stated) {
        scene->lights_wanted = WHIT_LIGHTS_FILE;
        scene->has_ambient = true;
        set_rgb(scene->ambient, 0.1f, 0.1f, 0.1f);
    }
    scene_put_light(scene, (struct scene_light){.kind = WHIT_LIGHT_SPOT,
                                                .node = SCENE_NONE,
                                                .position = {0, 0, 5.05},
                                                .direction = {0, 0, -1},
                                                .color = {level, level, level},
                                                .versine_inner = edge,
                                                .versine_outer = edge});
    return seen_from(scene, (const double[]){0, 0, 10.05}, (const double[]){0, 0, 0}, 0.5);
}

TEST(lamps_that_light_less_than_half_get_help)
{
    assert_added(wall_with_spot(2.1, false), 1, 0);
    assert_added(wall_with_spot(2.55, false), 0, 0);
}

TEST(what_lamps_leave_dark_gets_ambient_light)
{
    const struct {
        double radius;
        float ambient;
    } cases[] = {{2.1, 0.1f}, {2.55, 0.1f}, {4.5, 0.0f}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        own_scene *scene = wall_with_spot(cases[i].radius, false);
        assert_float_equal(scene->ambient[1], cases[i].ambient, 0.0);
    }
}

/* Burnt out are 40 % of what is seen, and half of it is as dark before. */
TEST(a_spot_in_the_dark_is_exposed_less)
{
    own_scene *scene = wall_with_spot(2.1, true);
    assert_true(scene->exposure_ev < 0.0 && scene->exposure_ev >= -1.5);
}

/* The camera stands in a box under the sun. `open`: as for walls(). `glass`: of the top. */
static struct scene *box_under_sun(unsigned open, bool glass)
{
    struct scene *scene = empty_scene();
    struct scene_material pane = material_plain("pane");
    set_rgb(pane.transmission, 0.9f, 0.9f, 0.9f);
    scene_put(scene, walls((const float[]){2, 2, 2}, open | (glass ? 8u : 0u), false), NULL);
    if (glass)
        scene_put(scene, mesh_plane(4), &(struct put){.material = &pane, .at = {0, 2, 0}});
    scene_put_sun(scene, 0.1, -1, 0.2, 1.0f);
    return seen_from(scene, (const double[]){0, 0, 1.9}, (const double[]){0, -1.4, 0}, 0.9);
}

TEST(boxes_that_shut_the_sun_out_get_a_lamp)
{
    struct scene *scene = box_under_sun(0, false);
    assert_true(scene_noted(scene, "light from outside reaches 0 % of what is seen: a lamp was "
                                   "added at the camera"));
    assert_added(scene, 1, 1);
    assert_added(box_under_sun(8, false), 0, 0);
    assert_added(box_under_sun(8, true), 0, 0);
    /* Whit's light over the shoulder reaches 41 % of what is seen in this open box: it is no closed
     * one.
     */
    scene = empty_scene();
    scene_put(scene, walls((const float[]){2, 3.5f, 2}, 8, false), NULL);
    seen_from(scene, (const double[]){0, 0, 1.9}, (const double[]){0, -0.5, 0}, 1.2);
    assert_added(scene, 1, 0);
}
