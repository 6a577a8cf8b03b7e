/* Compares the device with the reference in scenes that have all effects at once, which no scene in
   scenes/ has. */
#include "picture_fixture.h"
#include "reference_fixture.h"
#include "unit.h"

enum { SIDE = 48 };

/* Adds a texture of 4 x 4 random texels from `lowest` on; `alpha`: with alpha from 0 to 255. */
static uint32_t add_noise(struct scene *scene, uint8_t lowest, bool alpha)
{
    uint64_t random = 17;
    uint8_t rgba[64];
    for (int i = 0; i < 64; ++i)
        rgba[i] =
            i % 4 == 3 && !alpha ? 255 : (uint8_t)(lowest + random_below(&random, 256u - lowest));
    return scene_put_texture(scene, 4, 4, rgba);
}

static void use_smooth(struct scene_material *m, enum scene_slot slot, uint32_t texture,
                       float scale, enum scene_wrap wrap)
{
    use_filtered(m, slot, texture, (float[]){scale, 0.3f, 0.1f, -0.2f, scale, 0.2f}, wrap);
}

static struct scene_mesh ball(double radius)
{
    return mesh_sphere(radius, 16, 8);
}

static struct scene_mesh ring(void)
{
    return mesh_torus(0.8, 0.3, 16, 8);
}

static struct scene_mesh true_ball(float radius)
{
    return mesh_balls((double[]){0, 0, 0, (double)radius}, 1);
}

static struct scene_mesh coloured(struct scene_mesh mesh)
{
    uint64_t random = 9;
    mesh.colors = array_alloc_zeroed(mesh.vertex_count, 4 * sizeof *mesh.colors);
    assert_non_null(mesh.colors);
    for (uint32_t i = 0; i < 4 * mesh.vertex_count; ++i)
        mesh.colors[i] = 0.75f + 0.25f * random_float_signed(&random);
    return mesh;
}

static struct scene_material glass(float ior, uint32_t priority)
{
    struct scene_material m = matte(0, 0, 0);
    set_rgb(m.transmission, 0.9f, 1, 0.8f);
    set_rgb(m.absorption, 0.3f, 0.1f, 0.9f);
    m.fresnel = true;
    m.ior = ior;
    m.priority = priority;
    return m;
}

static void add_ground(struct scene *scene)
{
    struct scene_material ground = matte(0.8f, 0.7f, 0.6f), catcher = material_plain("catcher");
    set_rgb(ground.ambient, 1, 1, 1);
    set_rgb(ground.specular, 0.3f, 0.3f, 0.3f);
    ground.shininess = 20;
    use_smooth(&ground, SCENE_SLOT_DIFFUSE, add_noise(scene, 60, false), 7, SCENE_WRAP_REPEAT);
    use_smooth(&ground, SCENE_SLOT_NORMAL, add_noise(scene, 120, false), 5, SCENE_WRAP_MIRROR);
    ground.normal_scale = 0.4f;
    add_object(scene, mesh_plane(30), ground, 0, 0, 0);
    catcher.shadow_catcher = true;
    add_object(scene, mesh_plane(3), catcher, -2, 0.1, 2);
}

static void add_bodies(struct scene *scene)
{
    struct scene_material metal = matte(0.9f, 0.7f, 0.3f), sheet = matte(0.2f, 0.5f, 0.9f),
                          leaf = matte(0.3f, 0.8f, 0.2f), paint = matte(0.9f, 0.9f, 0.9f);
    metal.model = WHIT_MODEL_METAL_ROUGH;
    set_rgb(metal.specular, 1, 1, 1);
    metal.metallic = 0.9f;
    metal.roughness = 0.6f;
    use_smooth(&metal, SCENE_SLOT_METAL_ROUGH, add_noise(scene, 100, false), 3, SCENE_WRAP_CLAMP);
    add_object(scene, ball(0.9), metal, 2.2, 0.95, 0);
    sheet.alpha = SCENE_ALPHA_BLEND;
    use_smooth(&sheet, SCENE_SLOT_DIFFUSE, add_noise(scene, 30, true), 2, SCENE_WRAP_REPEAT);
    add_object(scene, mesh_box(0.9, 1.5, 0.05), sheet, 1, 0.8, 2.4);
    leaf.alpha = SCENE_ALPHA_MASK;
    leaf.alpha_cutoff = 0.45f;
    set_rgb(leaf.emission, 0.05f, 0.1f, 0);
    use_smooth(&leaf, SCENE_SLOT_OPACITY, add_noise(scene, 0, true), 2, SCENE_WRAP_REPEAT);
    use_smooth(&leaf, SCENE_SLOT_BUMP, add_noise(scene, 0, false), 2, SCENE_WRAP_REPEAT);
    add_object(scene, true_ball(0.6f), leaf, 0.2, 1.9, -1);
    set_rgb(paint.ambient, 0.9f, 0.9f, 0.9f);
    set_rgb(paint.reflection, 0.1f, 0.1f, 0.1f);
    paint.fresnel = true;
    paint.one_sided = true;
    add_object(scene, coloured(ring()), paint, -2.4, 1, -0.5);
}

static void add_glass(struct scene *scene)
{
    add_object(scene, true_ball(0.8f), glass(1.5f, 2), -0.6, 0.85, 1);
    add_object(scene, mesh_box(0.9, 0.9, 0.9), glass(1.33f, 1), -0.3, 0.6, 0.6);
    struct scene_material pane = glass(1.5f, 0);
    pane.thin_walled = true;
    set_rgb(pane.absorption, 0, 0, 0);
    add_object(scene, mesh_box(0.1, 1.2, 1.2), pane, 1.4, 0.7, 1.2);
}

static void add_lights(struct scene *scene)
{
    const struct scene_light lights[] = {{.kind = WHIT_LIGHT_SPOT,
                                          .node = SCENE_NONE,
                                          .position = {3, 5, 3},
                                          .direction = {-0.5, -0.75, -0.4330127},
                                          .color = {20, 18, 15},
                                          .falloff = true,
                                          .range = 30,
                                          .versine_inner = 0.03f,
                                          .versine_outer = 0.2f},
                                         {.kind = WHIT_LIGHT_RECTANGLE,
                                          .node = SCENE_NONE,
                                          .position = {-3, 3, -2},
                                          .color = {2, 2, 3},
                                          .edge_u = {1.5, 0, 0.2},
                                          .edge_v = {0, 0.5, 1.5}},
                                         {.kind = WHIT_LIGHT_TRIANGLE,
                                          .node = SCENE_NONE,
                                          .position = {-3, 0.5, 3},
                                          .color = {1, 0.5f, 0.5f},
                                          .edge_u = {0, 2, 0.5},
                                          .edge_v = {1, 0.5, 0.5},
                                          .two_sided = true}};
    for (int i = 0; i < 3; ++i)
        scene_put_light(scene, lights[i]);
    scene_put_lamp(scene, 2, 4, -3, 6);
    scene_put_sun(scene, 0.3, -1, -0.2, 0.4f);
}

/* A map of 16 x 8 pixels. */
static void add_sky(struct scene *scene)
{
    uint64_t random = 3;
    scene->environment.kind = WHIT_ENVIRONMENT_MAP;
    scene->environment.width = 16;
    scene->environment.height = 8;
    scene->environment.rgb = array_alloc(16 * 8, 3 * sizeof(float));
    assert_non_null(scene->environment.rgb);
    for (int i = 0; i < 16 * 8 * 3; ++i)
        scene->environment.rgb[i] = 0.5f + 0.4f * random_float_signed(&random);
}

static struct scene *all_effects(void)
{
    struct scene *scene = dark_scene((double[]){0.5, 3, 8}, (double[]){0, 0.8, 0});
    add_sky(scene);
    set_rgb(scene->ambient, 0.1f, 0.1f, 0.1f);
    add_ground(scene);
    add_bodies(scene);
    add_glass(scene);
    add_lights(scene);
    return scene;
}

TEST(every_effect_agrees_with_the_device)
{
    struct reference_params params = {.picture = {.width = SIDE,
                                                  .height = SIDE,
                                                  .depth = 6,
                                                  .sampling.count = 4,
                                                  .schlick = true,
                                                  .light_samples = 4},
                                      .whole_stops = true};
    own_fixture f = fixture_open(all_effects(), NULL, &params.picture);
    own_image device = render(&f);
    own_picture whole = reference_picture(f.accel, &params);
    params.whole_stops = false;
    own_picture ideal = reference_picture(f.accel, &params);
    struct difference d = difference_of(&device, &whole.color),
                      stops = difference_of(&whole.color, &ideal.color);
    print_message("  %u of %u pixels over 1e-3, largest %.2g; for whole stops %u, largest %.2g\n",
                  d.over, SIDE * SIDE, d.largest, stops.over, stops.largest);
    assert_true(d.over * 500 <= SIDE * SIDE); /* 0.2 %, for edges */
    /* Rounding to 1/64 stops changes the light by at most 0.6 % per filter, with up to four on the
       way. The change must be larger than the device's error, else it would not show whether the
       reference rounds. */
    assert_true(stops.largest > d.largest && stops.largest < 4 * 0.006);
}

/* Two smooth bodies of one shape that touch everywhere. The inner one has the higher priority and
   is rotated, so that the instance hit first is not the visible one. Beside them a sphere and a
   mesh touch in the same way. The light comes from the side, so that shadow rays graze the
   surfaces. */
static struct scene *touching_smooth_bodies(void)
{
    struct scene *scene = dark_scene((double[]){0, 1.5, 5}, (double[]){0, 0, 0});
    struct scene_material outer = glass(1.33f, 1), inner = glass(1.5f, 2);
    set_rgb(inner.diffuse, 0.8f, 0.6f, 0.4f);
    add_object(scene, ball(1), outer, -1.1, 0, 0);
    add_object(scene, ball(1), inner, -1.1, 0, 0);
    scene->nodes[scene->node_count - 1].rotation[1] = sqrt(0.5); /* by 90 degrees, about y */
    scene->nodes[scene->node_count - 1].rotation[3] = sqrt(0.5);
    add_object(scene, true_ball(1), outer, 1.1, 0, 0);
    add_object(scene, ball(1), inner, 1.1, 0, 0);
    scene->contact = 0.12f; /* the mesh of the ball is up to that far inside the sphere */
    scene_put_sun(scene, -0.2, -1, 0.3, 1.0f);
    return scene;
}

static const whit_renderer_params usual = {.width = SIDE, .height = SIDE, .depth = 3};

TEST(touching_smooth_bodies_agree)
{
    assert_agrees("touching", touching_smooth_bodies(), NULL, usual);
}

/* ---- Where floats are short of digits ---- */

/* The shadow of an absorbing ball under a lamp far away. */
static struct scene *far_lamp(void)
{
    struct scene *scene = dark_scene((double[]){0, 2, 5}, (double[]){0, 0.7, 0});
    add_object(scene, mesh_plane(8), matte(0.7f, 0.7f, 0.7f), 0, 0, 0);
    add_object(scene, true_ball(1), glass(1.3f, 0), 0, 1.01, 0);
    scene_put_lamp(scene, -4e6, 1e7, 5e6, 1e14f);
    return scene;
}

/* A spot light 1e4 above the floor, whose cones end 0.4 and 0.5 from its middle. */
static struct scene *narrow_spot(void)
{
    struct scene *scene = dark_scene((double[]){0, 2, 2}, (double[]){0, 0, 0});
    struct scene_light light = {.kind = WHIT_LIGHT_SPOT,
                                .node = SCENE_NONE,
                                .position = {0, 1e4, 0},
                                .direction = {0, -1, 0}};
    set_rgb(light.color, 1, 1, 1);
    scene_light_cones(&light, 0.4e-4, 0.5e-4);
    add_object(scene, mesh_plane(8), matte(1, 1, 1), 0, 0, 0);
    scene_put_light(scene, light);
    return scene;
}

/* A floor with a texture that is moved by many periods. */
static struct scene *far_offset(enum scene_wrap wrap)
{
    struct scene *scene = dark_scene((double[]){0, 8, 0}, (double[]){0, 0, 0});
    struct scene_material m = unlit(1, 1, 1);
    use_smooth(&m, SCENE_SLOT_DIFFUSE, add_noise(scene, 0, false), 3, wrap);
    m.textures[SCENE_SLOT_DIFFUSE].transform[2] = 1e6f + 1.0f;
    m.textures[SCENE_SLOT_DIFFUSE].transform[5] = -1e6f - 0.25f;
    add_object(scene, mesh_plane(4), m, 0, 0, 0);
    return scene;
}

/* A floor whose texture coordinates are far from 0. */
static struct scene *far_coordinates(void)
{
    struct scene *scene = dark_scene((double[]){0, 8, 0}, (double[]){0, 0, 0});
    struct scene_material m = unlit(1, 1, 1);
    struct scene_mesh plane = mesh_plane(4);
    use_filtered(&m, SCENE_SLOT_DIFFUSE, add_noise(scene, 0, false), (float[]){1, 0, 0, 0, 1, 0},
                 SCENE_WRAP_MIRROR);
    for (uint32_t i = 0; i < 2 * plane.vertex_count; ++i)
        plane.uvs[0][i] += i % 2 ? 65537.0f : -65537.0f;
    add_object(scene, plane, m, 0, 0, 0);
    return scene;
}

TEST(scarce_digits_agree)
{
    assert_agrees("far coordinates", far_coordinates(), NULL, usual);
    assert_agrees("far repeated", far_offset(SCENE_WRAP_REPEAT), NULL, usual);
    assert_agrees("far mirrored", far_offset(SCENE_WRAP_MIRROR), NULL, usual);
    assert_agrees("narrow spot", narrow_spot(), NULL, usual);
    assert_agrees("far lamp", far_lamp(), NULL, usual);
}

/* A floor in the whole view, with the opacity `texel` / 255 times `alpha`. */
static struct scene *cut_floor(uint8_t texel, float alpha, float cutoff)
{
    struct scene *scene = dark_scene((double[]){0, 8, 0}, (double[]){0, 0, 0});
    struct scene_material m = unlit(1, 1, 1);
    struct scene_mesh plane = mesh_plane(40);
    const uint8_t rgba[8] = {255, 255, 255, texel, 255, 255, 255, texel};
    m.alpha = SCENE_ALPHA_MASK;
    m.alpha_cutoff = cutoff;
    use_smooth(&m, SCENE_SLOT_DIFFUSE, scene_put_texture(scene, 2, 1, rgba), 9, SCENE_WRAP_REPEAT);
    if (alpha < 1.0f) {
        plane = coloured(plane);
        for (uint32_t i = 0; i < 4 * plane.vertex_count; ++i)
            plane.colors[i] = i % 4 == 3 ? alpha : 1.0f;
    }
    add_object(scene, plane, m, 0, 0, 0);
    return scene;
}

TEST(opacities_that_equal_the_cutoff_are_solid)
{
    static const struct {
        uint8_t texel;
        float alpha, cutoff;
    } floors[] = {{102, 1, 0.4f},
                  {204, 1, 0.8f},
                  {255, 0.75f, 0.75f},
                  {255, 0.35f, 0.35f},
                  {255, 0.95f, 0.95f}};
    for (size_t i = 0; i < sizeof floors / sizeof *floors; ++i) {
        const struct reference_params params = {.picture = {.width = SIDE, .height = SIDE}};
        struct scene *scene = cut_floor(floors[i].texel, floors[i].alpha, floors[i].cutoff);
        own_fixture f = fixture_open(scene, NULL, &params.picture);
        own_image device = render(&f);
        own_picture reference = reference_picture(f.accel, &params);
        for (size_t k = 0; k < SIDE * SIDE; ++k)
            assert_true(device.pixels[4 * k] == 1.0f && reference.color.pixels[4 * k] == 1.0f);
    }
}
