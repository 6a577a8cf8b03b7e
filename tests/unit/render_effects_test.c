/* Kernels have only the effects that a scene calls for: they draw the same picture as the kernel
   with every effect, and an effect that is not called for is in no kernel, descriptor or buffer. */
#include "../cases.h"
#include "device/pipeline.h"
#include "picture_fixture.h"
#include "render/renderer.h"
#include "render_scenes.h"
#include "scene/effects.h"
#include "unit.h"

static const whit_renderer_params small = {.width = 24, .height = 18, .depth = 5};

/* ---- Scenes ---- */

/* A floor under a lamp. */
static struct scene *plain_scene(void)
{
    struct scene *scene = dark_scene((double[]){0, 5, 6}, (double[]){0, 0, 0});
    add_object(scene, mesh_plane(10), matte(0.7f, 0.6f, 0.5f), 0.1, 0,
               0); /* moved, as something is in all scenes */
    scene_put_lamp(scene, 2, 4, 1, 9.0f);
    return scene;
}

static uint32_t add_chequers(struct scene *scene)
{
    static const uint8_t texels[] = {255, 200, 90, 255, 10,  40,  90,  0,
                                     90,  90,  90, 120, 255, 255, 255, 255};
    return scene_put_texture(scene, 2, 2, texels);
}

static struct scene_material textured(uint32_t texture, enum scene_slot slot)
{
    struct scene_material m = matte(0.8f, 0.8f, 0.8f);
    m.textures[slot].texture = texture;
    return m;
}

static struct scene_mesh ring(void)
{
    return mesh_torus(0.7, 0.25, 16, 8);
}

static struct scene_mesh painted_box(void)
{
    struct scene_mesh mesh = mesh_box(1, 1, 1);
    mesh.colors = malloc(4 * sizeof *mesh.colors * mesh.vertex_count);
    assert_non_null(mesh.colors);
    for (uint32_t i = 0; i < 4 * mesh.vertex_count; ++i)
        mesh.colors[i] = i % 4 == 3 ? 1.0f : (float)(i % 7) / 7.0f;
    return mesh;
}

static struct scene_material glass(void)
{
    struct scene_material m = material_plain("glass");
    set_rgb(m.transmission, 0.9f, 0.9f, 0.9f);
    return m;
}

static void add_glass(struct scene *scene, double x, double y, double z)
{
    struct scene_material m = glass();
    set_rgb(m.absorption, 0.1f, 0.5f, 0.9f);
    m.ior = 1.5f;
    m.fresnel = true;
    add_object(scene, ring(), m, x, y, z);
}

static void add_spot(struct scene *scene)
{
    scene_put_light(scene, (struct scene_light){.kind = WHIT_LIGHT_SPOT,
                                                .node = SCENE_NONE,
                                                .position = {-3, 4, 2},
                                                .direction = {0.6, -0.8, 0},
                                                .color = {0.5f, 0.4f, 0.3f},
                                                .versine_inner = 0.05f,
                                                .versine_outer = 0.3f});
}

static void add_lights(struct scene *scene)
{
    scene_put_lamp(scene, 2, 4, 1, 6.0f);
    scene_put_sun(scene, 0.3, -1, -0.4, 0.4f);
    add_spot(scene);
    scene_put_light(scene, (struct scene_light){.kind = WHIT_LIGHT_AREA_SAMPLE,
                                                .node = SCENE_NONE,
                                                .position = {0, 6, 0},
                                                .direction = {0, -1, 0},
                                                .color = {5, 5, 6},
                                                .falloff = true});
}

/* Flat emitters of both shapes. */
static void add_emitters(struct scene *scene)
{
    for (int i = 0; i < 2; ++i)
        scene_put_light(scene, emitter(i ? WHIT_LIGHT_TRIANGLE : WHIT_LIGHT_RECTANGLE,
                                       (double[]){i ? -1.9 : -0.3, 2.4, -0.3},
                                       (double[]){0.6, 0, 0}, (double[]){0, 0, 0.6}, 6));
}

static void add_sky(struct scene *scene)
{
    struct scene_environment *sky = &scene->environment;
    sky->kind = WHIT_ENVIRONMENT_MAP;
    sky->width = 4;
    sky->height = 2;
    sky->rgb = malloc(24 * sizeof *sky->rgb);
    assert_non_null(sky->rgb);
    for (int i = 0; i < 24; ++i)
        sky->rgb[i] = 0.1f + 0.03f * (float)i;
}

/* Every effect that needs no camera or primitive of its own. */
static struct scene *rich_scene(void)
{
    struct scene *scene = dark_scene((double[]){0, 4, 7}, (double[]){0, 0.4, 0});
    uint32_t chequers = add_chequers(scene);
    add_sky(scene);
    add_lights(scene);
    add_object(scene, mesh_plane(10), textured(chequers, SCENE_SLOT_DIFFUSE), 0, 0, 0);
    struct scene_material m = material_plain("mirror");
    set_rgb(m.reflection, 0.6f, 0.6f, 0.6f);
    set_rgb(m.specular, 0.4f, 0.4f, 0.4f);
    set_rgb(m.emission, 0.05f, 0.0f, 0.0f);
    m.shininess = 20;
    add_object(scene, mesh_box(1, 1.5, 1), m, -2, 0.75, -1);
    add_glass(scene, 0, 0.9, 0.6);
    m = textured(chequers, SCENE_SLOT_BUMP);
    add_object(scene, painted_box(), m, 1.8, 0.5, -0.5);
    m = textured(chequers, SCENE_SLOT_OPACITY);
    m.alpha = SCENE_ALPHA_MASK;
    m.alpha_cutoff = 0.5f;
    add_object(scene, mesh_box(0.8, 0.8, 0.1), m, -0.9, 0.5, 1.8);
    m = material_plain("metal");
    m.model = WHIT_MODEL_METAL_ROUGH;
    set_rgb(m.diffuse, 0.9f, 0.7f, 0.4f);
    set_rgb(m.specular, 1, 1, 1);
    m.metallic = 0.8f;
    m.roughness = 0.3f;
    m.one_sided = true;
    add_object(scene, ring(), m, 1.2, 0.3, 1.6);
    m = material_plain("catcher");
    m.shadow_catcher = true;
    add_object(scene, mesh_box(1, 0.1, 1), m, -2.4, 0.05, 1.4);
    return scene;
}

/* ---- Pictures ---- */

static uint64_t bit(enum scene_effect effect)
{
    return UINT64_C(1) << effect;
}

/* Asserts that the kernel for the scene and the one with every effect draw the same picture. */
static whit_stats assert_auto_is_all(struct scene *(*make)(void))
{
    whit_renderer_params all = small;
    all.all_effects = true;
    own_picture a = picture_of(make(), NULL, &small), b = picture_of(make(), NULL, &all);
    assert_same_picture("with every effect", &a, &b);
    print_message("  %u of %u instructions\n", a.stats.kernel_instructions,
                  b.stats.kernel_instructions);
    return a.stats;
}

TEST(kernels_for_a_scene_draw_the_same)
{
    whit_stats plain = assert_auto_is_all(plain_scene);
    assert_int_equal(plain.rays_reflected + plain.rays_refracted, 0);
    assert_true(plain.rays_shadow > 0);
    whit_stats rich = assert_auto_is_all(rich_scene);
    assert_true(rich.rays_reflected > 0 && rich.rays_refracted > 0);
    assert_true(plain.kernel_instructions < rich.kernel_instructions);
}

/* A driver that gets kernels whole and fills the constants in itself draws the same picture. Run
   only where WHIT_TEST_WHOLE_KERNELS is set, since lavapipe takes a quarter of a minute to inline
   the calls of the whole kernel. The tests of device_compute check that kernels do go to the driver
   whole. */
TEST(the_driver_draws_the_same)
{
    if (!getenv("WHIT_TEST_WHOLE_KERNELS"))
        skip();
    own_picture a = picture_of(rich_scene(), NULL, &small);
    assert_int_equal(setenv("WHIT_NO_SPECIALIZE", "1", 1), 0);
    own_picture b = picture_of(rich_scene(), NULL, &small);
    assert_int_equal(unsetenv("WHIT_NO_SPECIALIZE"), 0);
    assert_same_picture("whole kernels", &a, &b);
    assert_int_not_equal(a.stats.kernel_instructions, b.stats.kernel_instructions);
}

/* The only effect that is added to the plain scene. */
static enum scene_effect alone;

static struct scene_material alone_material(struct scene *scene)
{
    struct scene_material m = matte(0.5f, 0.4f, 0.3f);
    if (alone == SCENE_EFFECT_TEXTURES)
        m.textures[SCENE_SLOT_DIFFUSE].texture = add_chequers(scene);
    if (alone == SCENE_EFFECT_NORMAL_MAPS)
        m.textures[SCENE_SLOT_BUMP].texture = add_chequers(scene);
    if (alone == SCENE_EFFECT_CUTOUTS || alone == SCENE_EFFECT_SPHERES) {
        m.alpha = SCENE_ALPHA_BLEND;
        m.opacity = 0.4f;
    }
    if (alone == SCENE_EFFECT_REFLECTION || alone == SCENE_EFFECT_FRESNEL)
        set_rgb(m.reflection, 0.3f, 0.3f, 0.3f);
    if (alone == SCENE_EFFECT_REFRACTION || alone == SCENE_EFFECT_ABSORPTION)
        set_rgb(m.transmission, 0.8f, 0.8f, 0.8f);
    if (alone == SCENE_EFFECT_ABSORPTION)
        set_rgb(m.absorption, 0.2f, 0.4f, 0.6f);
    if (alone == SCENE_EFFECT_HIGHLIGHTS)
        set_rgb(m.specular, 0.7f, 0.7f, 0.7f);
    if (alone == SCENE_EFFECT_EMISSION)
        set_rgb(m.emission, 0.1f, 0.2f, 0.3f);
    m.fresnel = alone == SCENE_EFFECT_FRESNEL;
    m.one_sided = alone == SCENE_EFFECT_CULLING;
    m.shadow_catcher = alone == SCENE_EFFECT_CATCHERS;
    if (alone == SCENE_EFFECT_METAL_ROUGH) {
        m.model = WHIT_MODEL_METAL_ROUGH;
        m.roughness = 0.4f;
    }
    return m;
}

static struct scene *alone_scene(void)
{
    struct scene *scene = plain_scene();
    struct scene_material m = alone_material(scene);
    struct scene_mesh body = alone == SCENE_EFFECT_VERTEX_COLORS ? painted_box()
                             : alone == SCENE_EFFECT_SPHERES
                                 ? mesh_balls((double[]){0, 0, 0, 0.6}, 1)
                                 : mesh_box(1, 1, 1);
    add_object(scene, body, m, 0, 0.5, 0);
    add_object(scene, ring(), m, 0.5, 1.5, 0.5);
    if (alone == SCENE_EFFECT_ENVIRONMENT_MAP)
        add_sky(scene);
    if (alone == SCENE_EFFECT_DIRECTIONAL_LIGHTS)
        scene_put_sun(scene, 0.3, -1, -0.4, 0.4f);
    if (alone == SCENE_EFFECT_SPOT_LIGHTS)
        add_spot(scene);
    if (alone == SCENE_EFFECT_AREA_LIGHTS)
        add_emitters(scene);
    return scene;
}

/* Each effect is alone in its scene, so that no other effect can hide what the scan for it misses.
   Each commit tests a third of them. */
TEST(effects_alone_draw_the_same)
{
    static const enum scene_effect effects[] = {
        SCENE_EFFECT_REFLECTION,      SCENE_EFFECT_REFRACTION,    SCENE_EFFECT_FRESNEL,
        SCENE_EFFECT_ABSORPTION,      SCENE_EFFECT_CUTOUTS,       SCENE_EFFECT_TEXTURES,
        SCENE_EFFECT_NORMAL_MAPS,     SCENE_EFFECT_EMISSION,      SCENE_EFFECT_HIGHLIGHTS,
        SCENE_EFFECT_ENVIRONMENT_MAP, SCENE_EFFECT_VERTEX_COLORS, SCENE_EFFECT_METAL_ROUGH,
        SCENE_EFFECT_CULLING,         SCENE_EFFECT_CATCHERS,      SCENE_EFFECT_DIRECTIONAL_LIGHTS,
        SCENE_EFFECT_SPOT_LIGHTS,     SCENE_EFFECT_AREA_LIGHTS,   SCENE_EFFECT_SPHERES};
    for (size_t i = 0; i < sizeof effects / sizeof *effects; ++i) {
        if (!cases_turn(i, 3))
            continue;
        alone = effects[i];
        print_message("  %s:", scene_effect_name(alone));
        assert_auto_is_all(alone_scene);
    }
}

/* Without an effect there are no rays of its kind, but still some of the other kinds: also where
   all other effects are compiled in. */
TEST_BY_TURNS(effects_left_out_are_gone, 0, 2)
{
    static const enum scene_effect effects[] = {SCENE_EFFECT_SHADOWS, SCENE_EFFECT_REFLECTION,
                                                SCENE_EFFECT_REFRACTION};
    static const struct {
        bool without[3], all;
    } cases[] = {{{true, false, false}, false},
                 {{false, true, false}, false},
                 {{false, false, true}, false},
                 {{true, true, false}, true},
                 {{false, false, true}, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        whit_renderer_params params = small;
        if (cases[i].all && !cases_turn(i, 2))
            continue;
        params.all_effects = cases[i].all;
        for (int k = 0; k < 3; ++k)
            params.effects_removed |= cases[i].without[k] ? bit(effects[k]) : 0;
        own_picture picture = picture_of(glass_scene(), NULL, &params);
        const uint64_t rays[] = {picture.stats.rays_shadow, picture.stats.rays_reflected,
                                 picture.stats.rays_refracted};
        for (int k = 0; k < 3; ++k)
            assert_true((rays[k] == 0) == cases[i].without[k]);
    }
}

/* Glass of one model on the floor, or the body that stands in for it where nothing refracts. */
static bool is_glass, is_metal_rough;

static struct scene *glass_or_body_scene(void)
{
    struct scene *scene = plain_scene();
    struct scene_material m = material_plain("glass");
    const float color[] = {0.9f, 0.6f, 0.3f};
    m.model = is_metal_rough ? WHIT_MODEL_METAL_ROUGH : WHIT_MODEL_PHONG;
    m.ior = 3.0f; /* of which a quarter is reflected head-on */
    m.fresnel = true;
    for (int c = 0; c < 3; ++c) {
        float body = 0.75f * color[c];
        m.diffuse[c] = is_metal_rough ? color[c] : is_glass ? 0.0f : body;
        m.ambient[c] = m.diffuse[c];
        m.reflection[c] = is_glass || is_metal_rough ? 0.0f : 0.25f;
        m.transmission[c] = !is_glass ? 0.0f : is_metal_rough ? 1.0f : color[c];
    }
    add_object(scene, ring(), m, 0, 0.5, 0);
    return scene;
}

static struct picture glass_or_body(bool glass, bool metal_rough, whit_classes classes, bool all)
{
    whit_renderer_params params = small;
    is_glass = glass;
    is_metal_rough = metal_rough;
    params.effects_removed = bit(SCENE_EFFECT_REFRACTION);
    params.shadows = WHIT_SHADOWS_NONE; /* those of glass stay light */
    params.classes = classes;
    params.all_effects = all;
    return picture_of(glass_or_body_scene(), NULL, &params);
}

TEST(glass_that_refracts_nothing_is_a_body_of_its_colour)
{
    static const struct {
        whit_classes classes;
        bool all;
    } cases[] = {{WHIT_CLASSES_ONE, false}, {WHIT_CLASSES_MANY, false}, {WHIT_CLASSES_AUTO, true}};
    for (size_t model = 0; model < 2; ++model) {
        if (!cases_turn(model, 2))
            continue;
        own_picture body = glass_or_body(false, model, WHIT_CLASSES_ONE, false);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
            own_picture glass = glass_or_body(true, model, cases[i].classes, cases[i].all);
            assert_same_picture("glass", &glass, &body);
        }
    }
}

TEST_BY_TURNS(effects_added_do_not_matter, 1, 2)
{
    static const enum scene_effect added[] = {SCENE_EFFECT_ABSORPTION,  SCENE_EFFECT_CUTOUTS,
                                              SCENE_EFFECT_NORMAL_MAPS, SCENE_EFFECT_AREA_LIGHTS,
                                              SCENE_EFFECT_CULLING,     SCENE_EFFECT_SPHERES};
    own_picture plain = picture_of(plain_scene(), NULL, &small);
    for (size_t i = 0; i < sizeof added / sizeof *added; ++i) {
        whit_renderer_params more = small;
        if (!cases_turn(i, 3))
            continue;
        more.effects_added = bit(added[i]);
        own_picture picture = picture_of(plain_scene(), NULL, &more);
        print_message("  with %-16s %+6d instructions\n", scene_effect_name(added[i]),
                      (int)picture.stats.kernel_instructions -
                          (int)plain.stats.kernel_instructions);
        assert_same_picture(scene_effect_name(added[i]), &plain, &picture);
        assert_true(picture.stats.kernel_instructions > plain.stats.kernel_instructions);
    }
}

/* ---- Kernels ---- */

static whit_kernel_info kernel_of(struct scene *scene, const whit_renderer_params *params)
{
    whit_kernel_info info;
    own_fixture f = fixture_open(scene, NULL, params);
    assert_int_equal(renderer_get_kernel(f.renderer, &info), WHIT_OK);
    return info;
}

/* A kernel without one of the effects that can be left out has fewer instructions. */
TEST(every_effect_has_its_code)
{
    struct scene_effects effects;
    struct scene *rich = rich_scene();
    assert_int_equal(scene_freeze(rich), WHIT_OK);
    scene_effects_scan(rich, false, &effects);
    scene_destroy(rich);
    uint32_t whole = kernel_of(rich_scene(), &small).instructions, missing = 0;
    print_message("  %-20s %6u instructions\n", "all of the rich scene", whole);
    for (int i = 0; i < SCENE_EFFECT_COUNT; ++i) {
        whit_renderer_params params = small;
        if (!effects.called[i] || !render_effect_can_remove((enum scene_effect)i))
            continue;
        params.effects_removed = bit((enum scene_effect)i);
        uint32_t left = kernel_of(rich_scene(), &params).instructions;
        print_message("  without %-20s %6d\n", scene_effect_name((enum scene_effect)i),
                      (int)left - (int)whole);
        /* Spot lights need all the code of point lights, so that it stays. */
        missing += i != SCENE_EFFECT_POINT_LIGHTS && left >= whole;
    }
    assert_int_equal(missing, 0);
}

static uint64_t bindings_of(const struct fixture *f)
{
    uint64_t bindings = 0;
    for (int i = 0; i < STAGE_COUNT; ++i) {
        const struct pass *pass = &f->renderer->picture.stages.set.passes[i];
        struct pipeline_info info = {.specialized = true};
        if (pass->pipeline)
            pipeline_get_info(pass->pipeline, &info);
        assert_true(info.specialized);
        bindings |= info.bindings;
    }
    return bindings;
}

static bool has(uint64_t bindings, int binding)
{
    return bindings >> binding & 1;
}

TEST(plain_scenes_bind_little)
{
    struct fixture f = fixture_open(plain_scene(), NULL, &small);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    uint64_t plain = bindings_of(&f);
    static const int absent[] = {BIND_TEXELS,   BIND_TEXEL_TEXELS, BIND_ENVIRONMENT,
                                 BIND_RAY_ROWS, BIND_RAY_TEXELS,   BIND_LISTED,
                                 BIND_COSTS};
    for (size_t i = 0; i < sizeof absent / sizeof *absent; ++i)
        if (has(plain, absent[i]))
            fail_msg("binding %d", absent[i]);
    assert_true(has(plain, BIND_PIXELS) && has(plain, BIND_FRAME));
    const struct scene_buffers *scene = &f.renderer->scene_buffers;
    const struct pixel_buffers *pixels = &f.renderer->picture.buffers;
    assert_null(scene->texels);
    assert_null(scene->environment);
    assert_null(pixels->queues.rays);
    assert_null(pixels->listed);
    assert_null(pixels->queues.cut_sums);
    assert_null(pixels->costs);
    assert_int_equal(scene->uv_sets, 0);
    fixture_close(&f);
    f = fixture_open(rich_scene(), NULL, &small);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    uint64_t rich = bindings_of(&f);
    assert_true(has(rich, BIND_ENVIRONMENT) && has(rich, BIND_RAY_ROWS));
    assert_true(has(rich, BIND_TEXELS) || has(rich, BIND_TEXEL_TEXELS));
    fixture_close(&f);
}

/* ---- Rays of each pixel ---- */

static void add_pane(struct scene *scene, struct scene_material m, double width, double height,
                     double x, double y, double z)
{
    add_object(scene, mesh_box(width, height, 0.2), m, x, y, z);
}

/* The view is in four quarters around the eye at the origin: upper left a mirror that shows glass
   behind the eye, lower left the same mirror without glass, lower right glass, upper right nothing.
   All edges run through the eye or through its mirror image, between pixels. */
static struct scene *quarters_scene(void)
{
    struct scene *scene = dark_scene((double[]){0, 0, 0}, (double[]){0, 0, -1});
    struct scene_material pane = glass();
    pane.fresnel = true;
    add_pane(scene, mirror(0.9f, 0.9f, 0.9f), 10, 20, -5, 0, -5);
    add_pane(scene, pane, 10, 10, 5, -5, -4);
    add_pane(scene, pane, 40, 40, -20, 20, 5);
    set_rgb(scene->environment.zenith, 1, 1, 1);
    scene_put_lamp(scene, 0, 0, 1, 5.0f);
    return scene;
}

/* The costs of each pixel's one sample tell which kinds of rays it had. */
static void check_who_refracts(whit_classes classes)
{
    whit_renderer_params params = small;
    params.count = true;
    params.classes = classes;
    own_fixture f = fixture_open(quarters_scene(), NULL, &params);
    own_image reflected = {0}, refracted = {0};
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_int_equal(renderer_read_costs(f.renderer, RAY_REFLECTED, &reflected), WHIT_OK);
    assert_int_equal(renderer_read_costs(f.renderer, RAY_REFRACTED, &refracted), WHIT_OK);
    const struct gpu_cost *mirrored = (const struct gpu_cost *)reflected.words;
    const struct gpu_cost *passed = (const struct gpu_cost *)refracted.words;
    for (uint32_t y = 0; y < small.height; ++y) {
        for (uint32_t x = 0; x < small.width; ++x) {
            bool sees = (x < small.width / 2) == (y < small.height / 2);
            uint32_t at = y * small.width + x;
            if ((passed[at].rays > 0) != sees)
                fail_msg("pixel %u, %u: %u refracted rays", x, y, passed[at].rays);
            if (x < small.width / 2)
                assert_true(mirrored[at].rays > 0);
        }
    }
}

/* One kernel for all materials must send no rays into materials other than glass; a kernel for each
   class must have the effects of its materials. */
TEST_BY_TURNS(only_pixels_that_see_glass_refract, 0, 2)
{
    check_who_refracts(WHIT_CLASSES_ONE);
    check_who_refracts(WHIT_CLASSES_MANY);
}

/* Glass that stands below the view until second 1. */
static struct scene *rising_glass_scene(void)
{
    struct scene *scene = plain_scene();
    add_pane(scene, glass(), 2, 2, 0, -30, 2);
    scene_put_channel(scene, scene->node_count - 1, SCENE_PATH_TRANSLATION, 2, (float[]){0, 1},
                      (float[]){0, -30, 2, 0, 2, 2});
    scene->channels[0].interpolation = SCENE_STEP;
    return scene;
}

TEST_BY_TURNS(what_comes_into_view_is_right_at_once, 1, 2)
{
    whit_renderer_params later = small;
    later.time_s = 1.0;
    own_picture expected = picture_of(rising_glass_scene(), NULL, &later);
    assert_true(expected.stats.rays_refracted > 0);
    own_fixture f = fixture_open(rising_glass_scene(), NULL, &small);
    own_picture before = render_picture(&f);
    assert_int_equal(before.stats.rays_refracted, 0);
    const struct pipeline *pipeline = f.renderer->picture.stages.set.passes[STAGE_SHADE].pipeline;
    assert_int_equal(renderer_set_time(f.renderer, 1.0), WHIT_OK);
    own_picture after = render_picture(&f);
    assert_same_picture("risen glass", &after, &expected);
    assert_ptr_equal(f.renderer->picture.stages.set.passes[STAGE_SHADE].pipeline, pipeline);
}
