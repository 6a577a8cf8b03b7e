/* Shading that traces shadow rays itself: the same pictures as by stages of their own. */
#include <inttypes.h>

#include "picture_fixture.h"
#include "render_scenes.h"

#include "render/renderer.h"

/* Scenes without packets: coloured glass and one light; mirrors and two lights. */
static const char *const names[] = {"glass-of-water", "sphereflake"};

static whit_renderer_params params_of(whit_numerics level, whit_classes classes)
{
    return (whit_renderer_params){.width = 64,
                                  .height = 48,
                                  .depth = 4,
                                  .tile_size = 16,
                                  .numerics = level,
                                  .packets = WHIT_PACKETS_OFF,
                                  .classes = classes};
}

static bool is_direct(const struct fixture *f)
{
    const struct stages *stages = &f->renderer->picture.stages;
    return stages->set.passes[STAGE_SHADE_DIRECT].pipeline && !stages->no_direct;
}

static void assert_same_light(const struct picture *a, const struct picture *b)
{
    assert_same_picture("shaded directly", a, b);
    for (int row = RENDER_STAGE_SHADOW; row < RENDER_STAGE_COUNT; ++row)
        assert_int_equal(a->stats.stages[row].rays, b->stats.stages[row].rays);
    assert_int_equal(a->stats.rays_shadow, b->stats.rays_shadow);
    assert_true(a->stats.weight_cut_bailout == b->stats.weight_cut_bailout);
    assert_true(a->stats.rays_shadow > 0);
}

/* At NUMERICS_EXACT some shadow rays are deferred: their hits go on to the shadow stages. */
TEST(pictures_are_those_of_shadow_stages)
{
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        for (int level = WHIT_NUMERICS_WATERTIGHT; level <= WHIT_NUMERICS_EXACT; ++level) {
            if (!unit_turn(i + (size_t)level, 3))
                continue;
            whit_renderer_params apart = params_of((whit_numerics)level, WHIT_CLASSES_ONE),
                                 directly = params_of((whit_numerics)level, WHIT_CLASSES_MANY);
            own_fixture f = fixture_open(file_scene(names[i]), NULL, &apart);
            own_renderer other = fixture_beside(&f, &directly);
            own_picture a = render_picture(&f), b = render_picture(&other);
            print_message("  %s, level %d: %" PRIu64 " shadow rays, %" PRIu64 " rays deferred\n",
                          names[i], level, b.stats.rays_shadow,
                          b.stats.stages[RENDER_STAGE_DEFERRED].rays);
            assert_false(is_direct(&f));
            assert_true(is_direct(&other));
            assert_same_light(&a, &b);
            if (level == WHIT_NUMERICS_EXACT)
                assert_true(b.stats.stages[RENDER_STAGE_DEFERRED].rays > 0);
        }
    }
}

/* Timed tiles are shaded apart, by kernels that are made when they are first asked for. */
TEST(timed_tiles_know_the_time_of_each_light)
{
    whit_renderer_params params = params_of(WHIT_NUMERICS_WATERTIGHT, WHIT_CLASSES_MANY);
    own_fixture f = fixture_open(file_scene("sphereflake"), NULL, &params);
    own_picture a = render_picture(&f);
    const struct pass *passes = f.renderer->picture.stages.set.passes;
    assert_null(passes[STAGE_SHADE].pipeline);
    assert_true(a.stats.stages[RENDER_STAGE_SHADOW].ms < 0.0);
    params.time_stages = true;
    assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
    own_picture b = render_picture(&f);
    assert_non_null(passes[STAGE_SHADE].pipeline);
    assert_same_light(&a, &b);
    for (uint32_t light = 0; light < 2; ++light)
        assert_true(b.stats.stages[RENDER_STAGE_SHADOW + light].ms > 0.0);
    assert_true(is_direct(&f));
}

/* Where a loop that several lights share is cut short, lights get stages of their own: at the only
   sample of a pixel, or at a later one, where the first has passed by the floor. */
TEST(loops_that_are_cut_short_are_left_to_the_shadow_stages)
{
    enum { SHEETS = 16000, LIGHTS = 4, SAMPLES = 4 };
    static const float corners[9] = {-2, 10, -2, 0, 10, 3, 2, 10, -2};
    for (int late = 0; late < 2; ++late) {
        whit_renderer_params params = params_of(WHIT_NUMERICS_WATERTIGHT, WHIT_CLASSES_MANY);
        struct scene *scene = dark_scene((double[]){0, 2, 0}, (double[]){0, 0, 0});
        struct scene_material sheet = material_plain("sheet"), clear = material_plain("floor");
        set_rgb(clear.reflection, 0.1f, 0.1f, 0.1f); /* a reflected ray is cut by --bailout */
        set_rgb(sheet.transmission, 0.999f, 0.999f, 0.999f); /* under 1/64 stop: nothing is lost */
        params.width = params.height = 1;
        params.sampling.count = late ? SAMPLES : 1;
        params.bailout = 0.5;
        add_object(scene, mesh_stack(SHEETS, corners, 1, 1e-4f), sheet, 0, 0, 0);
        add_object(scene, mesh_box(4, 0.1, 4), clear, late ? 2.1 : 0, 0, 0);
        for (int i = 0; i < LIGHTS; ++i)
            scene_put_sun(scene, 0, -1, 0, 0.1f);
        own_fixture f = fixture_open(scene, NULL, &params);
        params.classes = WHIT_CLASSES_ONE;
        own_renderer apart = fixture_beside(&f, &params);
        own_picture a = render_picture(&f), b = render_picture(&apart);
        print_message("  %" PRIu64 " shadow rays, %g\n", b.stats.rays_shadow, b.color.pixels[0]);
        assert_same_light(&a, &b);
        assert_true(a.stats.weight_cut_bailout > 0);
        assert_true(a.stats.rays_shadow < SAMPLES * LIGHTS);
        assert_int_equal(is_direct(&f), !device_get_limits(f.device)->loop_limited);
    }
}

/* Without lights there is nothing to trace, whatever effects are added. */
TEST(without_lights_nothing_is_added)
{
    whit_renderer_params params = params_of(WHIT_NUMERICS_WATERTIGHT, WHIT_CLASSES_MANY);
    struct scene *scene = dark_scene((double[]){0, 2, 0}, (double[]){0, 0, 0});
    add_object(scene, mesh_box(4, 0.1, 4), material_plain("floor"), 0, 0, 0);
    scene->lights_wanted = WHIT_LIGHTS_NONE;
    params.effects_added = UINT64_C(1) << SCENE_EFFECT_POINT_LIGHTS | UINT64_C(1)
                                                                          << SCENE_EFFECT_SHADOWS;
    own_fixture f = fixture_open(scene, NULL, &params);
    own_picture picture = render_picture(&f);
    assert_false(is_direct(&f));
    assert_int_equal(picture.stats.rays_shadow, 0);
}
