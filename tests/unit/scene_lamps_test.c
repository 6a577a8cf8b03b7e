/* The lights that whit adds to models, and the intensity of those that models bring. */
#include "scene_model_fixture.h"

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
