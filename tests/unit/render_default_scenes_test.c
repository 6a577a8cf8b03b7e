/* Every scene of scenes/ by the kernel made for it and by the one with every effect: the same
   picture, and no ray of a kind that the scene does not call for. One of them at every level. */
#include <glob.h>

#include "load/load.h"
#include "render_fixture.h"

struct drawn {
    struct image color, ids;
    struct render_stats stats;
};

static struct drawn draw(const struct fixture *f, const struct render_params *params)
{
    struct drawn drawn = {0};
    struct renderer *renderer = NULL;
    assert_int_equal(renderer_create(&fixture_log, f->device, f->accel, params, &renderer),
                     WHIT_OK);
    assert_int_equal(renderer_render(renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(renderer, &drawn.color), WHIT_OK);
    assert_int_equal(renderer_read_ids(renderer, &drawn.ids), WHIT_OK);
    renderer_get_stats(renderer, &drawn.stats);
    renderer_destroy(renderer);
    return drawn;
}

static void assert_same(const struct drawn *a, const struct drawn *b)
{
    size_t pixels = (size_t)a->color.width * a->color.height;
    assert_memory_equal(a->color.pixels, b->color.pixels, pixels * 4 * sizeof(float));
    assert_memory_equal(a->ids.words, b->ids.words, pixels * 2 * sizeof(uint32_t));
    assert_int_equal(a->stats.rays_shadow, b->stats.rays_shadow);
    assert_int_equal(a->stats.rays_reflected, b->stats.rays_reflected);
    assert_int_equal(a->stats.rays_refracted, b->stats.rays_refracted);
}

static void assert_no_ray_uncalled(const struct scene *scene, const struct render_stats *stats)
{
    struct scene_effects effects;
    scene_effects_scan(scene, &effects);
    if (!effects.called[SCENE_EFFECT_SHADOWS])
        assert_int_equal(stats->rays_shadow, 0);
    if (!effects.called[SCENE_EFFECT_REFLECTION])
        assert_int_equal(stats->rays_reflected, 0);
    if (!effects.called[SCENE_EFFECT_REFRACTION])
        assert_int_equal(stats->rays_refracted, 0);
}

static void check_scene(struct device *device, const char *path, uint32_t numerics)
{
    const struct load_params load = {.time_limit_s = 60.0};
    struct fixture f = {.device = device};
    assert_int_equal(load_scene(&fixture_log, path, &load, &f.scene), WHIT_OK);
    assert_int_equal(accel_create(&fixture_log, f.scene, NULL, &f.accel), WHIT_OK);
    const struct render_params params = {
        .width = 40, .height = 30, .depth = 6, .numerics = numerics};
    struct render_params all = params;
    all.all_effects = true;
    struct drawn a = draw(&f, &params), b = draw(&f, &all);
    print_message("  %-40s %5u of %5u instructions\n", strrchr(path, '/') + 1,
                  a.stats.kernel_instructions, b.stats.kernel_instructions);
    assert_same(&a, &b);
    assert_no_ray_uncalled(f.scene, &b.stats);
    assert_true(a.stats.kernel_instructions < b.stats.kernel_instructions);
    image_finish(&a.color);
    image_finish(&a.ids);
    image_finish(&b.color);
    image_finish(&b.ids);
    accel_destroy(f.accel);
    scene_destroy(f.scene);
}

static void default_scenes_are_the_same(void **state)
{
    (void)state;
    glob_t paths;
    struct device *device = NULL;
    assert_int_equal(glob(WHIT_SCENES_DIR "/*.json", 0, NULL, &paths), 0);
    assert_true(paths.gl_pathc >= 10);
    assert_int_equal(device_create(&fixture_log, NULL, &device), WHIT_OK);
    for (size_t i = 0; i < paths.gl_pathc; ++i)
        check_scene(device, paths.gl_pathv[i], NUMERICS_WATERTIGHT);
    globfree(&paths);
    device_destroy(device);
}

/* The other levels, in one scene: their kernels take as long again to compile. */
static void other_levels_draw_the_same(void **state)
{
    (void)state;
    struct device *device = NULL;
    assert_int_equal(device_create(&fixture_log, NULL, &device), WHIT_OK);
    check_scene(device, WHIT_SCENES_DIR "/default.json", NUMERICS_FAST);
    check_scene(device, WHIT_SCENES_DIR "/default.json", NUMERICS_EXACT);
    device_destroy(device);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_scenes_are_the_same),
        cmocka_unit_test(other_levels_draw_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
