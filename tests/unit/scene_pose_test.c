/* Animation against values worked out by hand, and the effects that a scene calls for. */
#include "../scenes.h"
#include "base/array.h"
#include "scene/effects.h"
#include "scene/pose.h"
#include "scene/scene.h"
#include "scene/shapes.h"
#include "unit.h"

/* A box below a moving node below a still one at x = 10. */
static struct scene *raw_scene(enum scene_path path, enum scene_interpolation interpolation,
                               const float *times, uint32_t keys, const float *values)
{
    struct scene *scene = scene_begin(NULL, "test");
    uint32_t still = scene_put_node(scene, SCENE_NONE, 10, 0, 0);
    uint32_t moving = scene_put_node(scene, still, 0, 0, 0);
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.name = "box", .node = &moving});
    struct scene_channel channel = {
        .node = moving, .path = path, .interpolation = interpolation, .key_count = keys};
    channel.times_s = array_copy(times, keys, sizeof *times);
    channel.values = array_copy(values, keys, scene_channel_width(&channel) * sizeof *values);
    scene_add_channel(scene, channel);
    return scene;
}

static struct scene *moving_scene(enum scene_path path, enum scene_interpolation interpolation,
                                  const float *times, uint32_t keys, const float *values)
{
    return scene_ready(raw_scene(path, interpolation, times, keys, values));
}

static struct affine matrix_at(const struct scene *scene, double time_s)
{
    own_pose pose;
    assert_int_equal(scene_pose_init(scene, time_s, &pose), WHIT_OK);
    struct affine matrix = pose.instances[0];
    return matrix;
}

static void assert_near(double a, double b)
{
    assert_true(fabs(a - b) < 1e-6);
}

TEST(linear_and_held_ends)
{
    const float times[] = {1, 2, 4}, values[] = {0, 0, 0, 4, 2, 0, 4, 2, 8};
    own_scene *scene = moving_scene(SCENE_PATH_TRANSLATION, SCENE_LINEAR, times, 3, values);
    assert_near((double)scene->time_begin_s, 1.0);
    assert_near((double)scene->time_end_s, 4.0);
    assert_near(matrix_at(scene, -5.0).m[3], 10.0);
    assert_near(matrix_at(scene, 1.25).m[3], 11.0);
    assert_near(matrix_at(scene, 1.25).m[7], 0.5);
    assert_near(matrix_at(scene, 2.0).m[3], 14.0);
    assert_near(matrix_at(scene, 3.5).m[11], 6.0);
    assert_near(matrix_at(scene, 99.0).m[11], 8.0);
}

TEST(steps_hold_until_the_next_key)
{
    const float times[] = {0, 1, 2}, values[] = {1, 0, 0, 2, 0, 0, 3, 0, 0};
    own_scene *scene = moving_scene(SCENE_PATH_TRANSLATION, SCENE_STEP, times, 3, values);
    assert_near(matrix_at(scene, 0.999).m[3], 11.0);
    assert_near(matrix_at(scene, 1.0).m[3], 12.0);
    assert_near(matrix_at(scene, 1.999).m[3], 12.0);
    assert_near(matrix_at(scene, 2.0).m[3], 13.0);
}

/* Times of keys are floats, 0.1f more than 0.1: the time of a picture is rounded as they are. */
TEST(a_key_begins_at_its_time_in_double)
{
    const double fps[] = {10.0, 24.0, 30.0};
    for (uint32_t f = 0; f < 3; ++f) {
        float times[40], values[120] = {0};
        for (uint32_t i = 0; i < 40; ++i) {
            times[i] = (float)(i / fps[f]);
            values[3 * i] = (float)i;
        }
        own_scene *scene = moving_scene(SCENE_PATH_TRANSLATION, SCENE_STEP, times, 40, values);
        for (uint32_t i = 0; i < 40; ++i)
            assert_near(matrix_at(scene, i / fps[f]).m[3], 10.0 + i);
    }
}

/* Tangents are per second: with 2 s between keys they count double. Compares with the polynomial
   p(s) from value 0 to 1 with the slopes 3 and 5. */
TEST(cubic_is_hermite)
{
    const float times[] = {0, 2};
    const float values[] = {7, 7, 7, 0, 0, 0, 3, 0, 0, 5, 0, 0, 1, 0, 0, 7, 7, 7};
    own_scene *scene = moving_scene(SCENE_PATH_TRANSLATION, SCENE_CUBIC, times, 2, values);
    for (int i = 1; i < 8; ++i) {
        double s = i / 8.0, s2 = s * s, s3 = s2 * s;
        double expected =
            2.0 * 3.0 * (s3 - 2.0 * s2 + s) + (3.0 * s2 - 2.0 * s3) + 2.0 * 5.0 * (s3 - s2);
        assert_near(matrix_at(scene, 2.0 * s).m[3], 10.0 + expected);
    }
    assert_near(matrix_at(scene, 0.0).m[3], 10.0);
    assert_near(matrix_at(scene, 2.0).m[3], 11.0);
}

TEST(rotation_is_slerp_by_the_shorter_way)
{
    /* 0 to 90 degrees about y, the second key written with its sign turned. */
    const float half = 0.70710678f, times[] = {0, 1};
    const float values[] = {0, 0, 0, 1, 0, -half, 0, -half};
    own_scene *scene = moving_scene(SCENE_PATH_ROTATION, SCENE_LINEAR, times, 2, values);
    for (int i = 0; i <= 4; ++i) {
        double angle = i / 4.0 * 1.5707963267948966;
        struct affine matrix = matrix_at(scene, i / 4.0);
        assert_near(matrix.m[0], cos(angle));
        assert_near(matrix.m[2], sin(angle));
    }
}

/* Between equal keys interpolation must not divide by the sine of the angle, which is 0. */
TEST(rotation_between_equal_keys)
{
    const float times[] = {0, 1}, values[] = {0, 0, 0, 2, 0, 0, 0, 2};
    own_scene *scene = moving_scene(SCENE_PATH_ROTATION, SCENE_LINEAR, times, 2, values);
    struct affine matrix = matrix_at(scene, 0.5);
    assert_near(matrix.m[0], 1.0);
    assert_near(matrix.m[5], 1.0);
}

/* The scene can be drawn at all other times: the view of whit's own camera leaves this one out. */
TEST(what_floats_cannot_place_is_refused_at_its_time)
{
    const float times[] = {0, 2}, near[] = {0, 0, 0, 4e29f, 0, 0}, far[] = {0, 0, 0, 4e30f, 0, 0};
    own_scene *reached = moving_scene(SCENE_PATH_TRANSLATION, SCENE_LINEAR, times, 2, near);
    own_scene *missed = moving_scene(SCENE_PATH_TRANSLATION, SCENE_LINEAR, times, 2, far);
    struct scene_pose pose;
    assert_true(matrix_at(reached, 2.0).m[3] > 3.9e29);
    assert_near(matrix_at(missed, 0.0).m[3], 10.0);
    assert_int_equal(scene_pose_init(missed, 2.0, &pose), WHIT_ERROR_INPUT);
}

TEST(vanishing_scale_keeps_an_inverse)
{
    const float times[] = {0, 1}, values[] = {0, 0, 0, 1, 1, 1};
    own_scene *scene = moving_scene(SCENE_PATH_SCALE, SCENE_LINEAR, times, 2, values);
    assert_true(matrix_at(scene, 0.0).m[0] > 0.0 && matrix_at(scene, 0.0).m[0] < 1e-5);
    assert_near(matrix_at(scene, 0.5).m[0], 0.5);
}

/* A box at x = 7 below six nodes, each scaled from one of these scales to the other. */
static struct scene *nested_scene(const float scales[6])
{
    struct scene *scene = scene_begin(NULL, "test");
    uint32_t node = SCENE_NONE;
    for (uint32_t i = 0; i < 6; ++i) {
        node = scene_put_node(scene, node, i == 0 ? 7 : 0, 0, 0);
        scene_put_channel(scene, node, SCENE_PATH_SCALE, 2, (float[]){0, 1}, scales);
    }
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.node = &node});
    return scene_ready(scene);
}

/* Six nested scales of zero, each raised to 1e-6, have no inverse in floats. */
TEST(nested_scales_of_zero_hide_an_instance)
{
    own_scene *scene = nested_scene((float[]){0, 0, 0, 1, 1, 1});
    struct affine hidden = matrix_at(scene, 0.0);
    assert_near(hidden.m[3], 7.0);
    assert_true(hidden.m[0] > 0.0 && hidden.m[0] < 1e-9 && scene_can_place(&hidden));
    assert_near(matrix_at(scene, 1.0).m[0], 1.0);
}

/* A box that stands flat, below a node that turns or grows: it would be seen, so that it is told,
   not hidden. One that is flat for a time is refused at that time. */
TEST(flat_instances_are_never_hidden)
{
    static const float turn[] = {0, 0, 0, 1, 0, 1, 0, 0}, grow[] = {0, 0, 0, 1, 1, 1};
    for (int i = 0; i < 2; ++i) {
        own_scene *scene = raw_scene(i ? SCENE_PATH_ROTATION : SCENE_PATH_SCALE, SCENE_LINEAR,
                                     (float[]){0, 1}, 2, i ? turn : grow);
        scene->nodes[0].scale[2] = 0.0;
        assert_int_equal(scene_freeze(scene), WHIT_OK);
        assert_int_equal(scene->instance_count, 0);
        assert_true(scene_noted(scene, "`box` dropped: its transform has no inverse"));
    }
    own_scene *folded = nested_scene((float[]){1, 1, 1, 1, 1, 0});
    struct scene_pose pose;
    assert_near(matrix_at(folded, 0.0).m[10], 1.0);
    assert_int_equal(scene_pose_init(folded, 1.0, &pose), WHIT_ERROR_INPUT);
}

TEST(unordered_times_are_dropped)
{
    const float times[] = {0, 0}, values[] = {5, 0, 0, 6, 0, 0};
    own_scene *scene = moving_scene(SCENE_PATH_TRANSLATION, SCENE_LINEAR, times, 2, values);
    assert_int_equal(scene->channel_count, 0);
    assert_near(matrix_at(scene, 0.0).m[3], 10.0);
}

TEST(lights_cameras_and_bounds_follow_their_nodes)
{
    const float times[] = {0, 1}, values[] = {0, 0, 0, 0, 4, 0};
    own_scene *scene = moving_scene(SCENE_PATH_TRANSLATION, SCENE_LINEAR, times, 2, values);
    scene->frozen = false; /* so that the test can change the scene */
    scene_add_light(scene, (struct scene_light){.kind = WHIT_LIGHT_POINT,
                                                .node = 1,
                                                .position = {1, 0, 0},
                                                .direction = {0, -1, 0}});
    scene_add_camera(
        scene, (struct scene_camera){.node = 1, .eye = {0, 0, 5}, .up = {0, 1, 0}, .fov_y = 1.0f});
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    own_pose pose;
    assert_int_equal(scene_pose_init(scene, 0.5, &pose), WHIT_OK);
    const struct scene_light *light = &pose.lights[pose.light_count - 1];
    const struct scene_camera *camera = &pose.cameras[pose.camera_count - 1];
    assert_near(light->position[0], 11.0);
    assert_near(light->position[1], 2.0);
    assert_near(camera->eye[1], 2.0);
    assert_near(camera->target[0], 10.0);
    assert_near(pose.lo[1], 1.0);
    assert_near(pose.hi[0], 11.0);
}

static struct scene *glass_scene(void)
{
    struct scene *scene = scene_begin(NULL, "test");
    struct scene_mesh mesh = mesh_box(2, 2, 2);
    free(mesh.normals);
    mesh.normals = NULL;
    struct scene_material material = material_grey("glass");
    material.origin = (struct scene_origin){string_copy("models/box.mtl"), 41};
    material.illum = 7;
    material.fresnel = true;
    material.transmission[0] = 1.0f;
    scene_put(scene, mesh, &(struct put){.material = &material});
    material = material_grey("worn by nothing");
    material.textures[SCENE_SLOT_NORMAL].texture = 0;
    material.alpha = SCENE_ALPHA_MASK;
    material.absorption[0] = 1.0f;
    scene_put_material(scene, material);
    scene_put_texture(scene, 1, 1, (uint8_t[4]){0});
    scene_put_sun(scene, 0, -1, 0, 1.0f);
    return scene_ready(scene);
}

static void check_objects(double floor_side, double low, double high)
{
    own_scene *scene = scene_begin(NULL, "test");
    own_pose pose;
    double lo[3], hi[3];
    uint32_t node = scene_put_node(scene, SCENE_NONE, 0, 1, 0);
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.name = "box", .node = &node});
    if (floor_side > 0.0)
        scene_put(scene, mesh_box(floor_side, 0.01, floor_side), &(struct put){.name = "floor"});
    scene = scene_ready(scene);
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    scene_pose_objects(scene, &pose, lo, hi);
    assert_float_equal(lo[0], low, 1e-5);
    assert_float_equal(hi[0], high, 1e-5);
}

TEST(objects_are_framed_without_a_wide_floor)
{
    check_objects(48.0, -1.0, 1.0);
    check_objects(2.5, -1.25, 1.25); /* hardly wider than what stands on it */
    check_objects(0.0, -1.0, 1.0);
}

TEST(effects_have_reasons)
{
    own_scene *scene = glass_scene();
    struct scene_effects effects;
    scene_effects_scan(scene, false, &effects);
    assert_string_equal(effects.reasons[SCENE_EFFECT_REFRACTION],
                        "material `glass`, illum 7, box.mtl:41");
    assert_true(effects.called[SCENE_EFFECT_FRESNEL]);
    assert_true(effects.called[SCENE_EFFECT_REFLECTION]); /* glass reflects by Fresnel */
    assert_true(effects.called[SCENE_EFFECT_DIRECTIONAL_LIGHTS]);
    assert_string_equal(effects.reasons[SCENE_EFFECT_SHADOWS], "light `sun`");
    static const enum scene_effect others[] = {
        SCENE_EFFECT_ABSORPTION,  SCENE_EFFECT_CUTOUTS,        SCENE_EFFECT_TEXTURES,
        SCENE_EFFECT_NORMAL_MAPS, SCENE_EFFECT_EMISSION,       SCENE_EFFECT_POINT_LIGHTS,
        SCENE_EFFECT_SPOT_LIGHTS, SCENE_EFFECT_AREA_LIGHTS,    SCENE_EFFECT_ENVIRONMENT_MAP,
        SCENE_EFFECT_METAL_ROUGH, SCENE_EFFECT_SMOOTH_NORMALS, SCENE_EFFECT_VERTEX_COLORS,
        SCENE_EFFECT_INSTANCES,   SCENE_EFFECT_ORTHOGRAPHIC,   SCENE_EFFECT_HIGHLIGHTS};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i)
        assert_false(effects.called[others[i]]);
    for (int i = 0; i < SCENE_EFFECT_COUNT; ++i)
        assert_non_null(scene_effect_name((enum scene_effect)i));
}

/* The effects of a box of this model under a sun of this strength. */
static struct scene_effects effects_under(whit_material_model model, float strength, bool functions)
{
    own_scene *scene = scene_begin(NULL, "test");
    struct scene_effects effects;
    struct scene_material material = material_grey("box");
    material.model = model;
    scene_put(scene, mesh_box(2, 2, 2), &(struct put){.material = &material});
    scene_put_sun(scene, 0, -1, 0, strength);
    scene_ready(scene);
    scene_effects_scan(scene, functions, &effects);
    return effects;
}

TEST(lights_that_light_nothing_call_for_nothing)
{
    static const enum scene_effect lights[] = {SCENE_EFFECT_DIRECTIONAL_LIGHTS,
                                               SCENE_EFFECT_SHADOWS};
    struct scene_effects lit = effects_under(WHIT_MODEL_PHONG, 1.0f, false),
                         black = effects_under(WHIT_MODEL_PHONG, 0.0f, false),
                         unlit = effects_under(WHIT_MODEL_UNLIT, 1.0f, false);
    for (size_t i = 0; i < sizeof lights / sizeof *lights; ++i) {
        assert_true(lit.called[lights[i]]);
        assert_false(black.called[lights[i]]);
        assert_false(unlit.called[lights[i]]);
        assert_string_equal(unlit.reasons[lights[i]], "");
    }
    /* Functions of a user may read them. */
    black = effects_under(WHIT_MODEL_PHONG, 0.0f, true);
    unlit = effects_under(WHIT_MODEL_UNLIT, 1.0f, true);
    assert_true(black.called[SCENE_EFFECT_DIRECTIONAL_LIGHTS]);
    assert_true(unlit.called[SCENE_EFFECT_SHADOWS]);
}
