/* Without trees: the hits, pictures and ids that trees give, whatever the number of triangles. */
#include "load/load.h"
#include "render/renderer.h"
#include "render_fixture.h"
#include "render_scenes.h"

enum { RAYS = 500 };

static const struct accel_params no_trees = {.mesh = {.builder = BVH_NONE}};

static void make_rays(const struct fixture *f, struct gpu_ray *rays)
{
    struct scene_pose pose;
    assert_int_equal(scene_pose_init(f->scene, 0.0, &pose), WHIT_OK);
    uint64_t state = 31;
    for (uint32_t i = 0; i < RAYS; ++i) {
        rays[i] = (struct gpu_ray){.t_max = i % 8 == 7 ? 0.7f : INFINITY};
        for (int k = 0; k < 3; ++k) {
            double center = 0.5 * (pose.lo[k] + pose.hi[k]), size = pose.hi[k] - pose.lo[k] + 1e-3;
            rays[i].origin[k] = (float)(center + size * 1.2 * (double)random_float_signed(&state));
            double at = center + 0.5 * size * (double)random_float_signed(&state);
            rays[i].dir[k] = (float)(at - (double)rays[i].origin[k]);
        }
    }
    rays[1] = (struct gpu_ray){.dir = {0, 0, 0}};
    rays[2] = (struct gpu_ray){.dir = {0, -0.0f, 1}, .t_max = INFINITY};
    scene_pose_finish(&pose);
}

/* Against the C twin without trees, hits and costs, and against another one's trees. */
static void check_rays(struct fixture *f, const struct accel *trees)
{
    struct gpu_ray rays[RAYS];
    struct gpu_hit hits[RAYS], any[RAYS];
    struct gpu_cost costs[RAYS], any_costs[RAYS];
    uint32_t bad = 0, costs_bad = 0, any_bad = 0, status = 0, met = 0;
    make_rays(f, rays);
    assert_int_equal(renderer_trace(f->renderer, rays, RAYS, false, hits, costs), WHIT_OK);
    assert_int_equal(renderer_trace(f->renderer, rays, RAYS, true, any, any_costs), WHIT_OK);
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_hit twin, tree, twin_any;
        struct gpu_cost cost = {0}, any_cost = {0};
        traverse_float(f->accel, ORDER_DISTANCE, &rays[i], false, HIT_NONE, HIT_NONE, &twin, &cost,
                       &status);
        traverse_float(f->accel, ORDER_DISTANCE, &rays[i], true, HIT_NONE, HIT_NONE, &twin_any,
                       &any_cost, &status);
        traverse_float(trees, ORDER_DISTANCE, &rays[i], false, HIT_NONE, HIT_NONE, &tree, NULL,
                       &status);
        bad += memcmp(&twin, &hits[i], sizeof twin) != 0;
        bad += memcmp(&tree, &hits[i], sizeof twin) != 0;
        any_bad += memcmp(&twin_any, &any[i], sizeof twin) != 0;
        costs_bad += memcmp(&cost, &costs[i], sizeof cost) != 0;
        costs_bad += memcmp(&any_cost, &any_costs[i], sizeof cost) != 0;
        met += twin.primitive != HIT_NONE;
        assert_int_equal(cost.pairs + cost.leaves + cost.stack + cost.depth, 0);
        assert_int_equal(cost.triangles, i == 1 ? 0 : f->scene->triangle_total);
    }
    assert_true(met > RAYS / 10 && met < RAYS);
    assert_int_equal(bad, 0);
    assert_int_equal(any_bad, 0);
    assert_int_equal(costs_bad, 0);
    assert_int_equal(status, 0);
}

static void rays_equal_those_of_trees(void **state)
{
    (void)state;
    struct scene *(*const make[])(void) = {terrain_scene, ring_scene};
    for (int i = 0; i < 2; ++i) {
        const struct render_params params = {.width = 16, .height = 16, .count = true};
        struct fixture f = fixture_open(make[i](), &no_trees, &params);
        assert_true(f.accel->no_trees);
        struct accel *trees;
        assert_int_equal(accel_create(&fixture_log, f.scene, NULL, &trees), WHIT_OK);
        check_rays(&f, trees);
        accel_destroy(trees);
        fixture_close(&f);
    }
}

/* More triangles than a driver grants loop turns, the nearest hit in any range. */
static void long_lists_are_cut(void **state)
{
    (void)state;
    uint32_t count = 70000;
    struct scene_mesh mesh = mesh_zeroed(3 * count, count);
    for (uint32_t i = 0; i < count; ++i) {
        float z = (float)(i * 7919 % count); /* each once, in every range far and near ones */
        const float corners[9] = {0, 0, z, 1, 1, z, 0.5f, 1, z};
        memcpy(&mesh.positions[9 * (size_t)i], corners, sizeof corners);
        for (uint32_t k = 0; k < 3; ++k)
            mesh.indices[3 * i + k] = 3 * i + k;
    }
    struct scene *scene = scene_begin(&fixture_log, "ranges");
    scene_put(scene, mesh, NULL);
    struct fixture f = fixture_open(scene, &no_trees, NULL);
    assert_true(f.renderer->brute.range_count >= 4);
    struct gpu_ray rays[16];
    struct gpu_hit hits[16];
    for (int i = 0; i < 16; ++i) /* a hit in each range, or none at all */
        rays[i] = (struct gpu_ray){{i == 15 ? 0.9f : 0.5f, i == 15 ? 0.1f : 0.75f, -1},
                                   4999.0f * (float)i,
                                   {0, 0, 1},
                                   INFINITY};
    for (int any = 0; any < 2; ++any) {
        assert_int_equal(renderer_trace(f.renderer, rays, 16, any, hits, NULL), WHIT_OK);
        for (int i = 0; i < 16; ++i) {
            struct gpu_hit twin;
            uint32_t status = 0;
            traverse_float(f.accel, ORDER_DISTANCE, &rays[i], any, HIT_NONE, HIT_NONE, &twin, NULL,
                           &status);
            assert_memory_equal(&hits[i], &twin, sizeof twin);
            assert_int_equal(hits[i].primitive == HIT_NONE, i == 15);
        }
    }
    fixture_close(&f);
}

struct picture {
    struct image color, ids, costs;
    struct render_stats stats;
};

static struct picture render(const struct fixture *f, struct accel *accel,
                             const struct render_params *params)
{
    struct picture picture = {0};
    struct renderer *renderer;
    assert_int_equal(renderer_create(&fixture_log, f->device, accel, params, &renderer), WHIT_OK);
    assert_int_equal(renderer_render(renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(renderer, &picture.color), WHIT_OK);
    assert_int_equal(renderer_read_ids(renderer, &picture.ids), WHIT_OK);
    if (params->count)
        assert_int_equal(renderer_read_costs(renderer, RAY_SHADOW, &picture.costs), WHIT_OK);
    renderer_get_stats(renderer, &picture.stats);
    renderer_destroy(renderer);
    return picture;
}

static void picture_finish(struct picture *picture)
{
    image_finish(&picture->color);
    image_finish(&picture->ids);
    image_finish(&picture->costs);
}

static void check_picture(struct scene *scene, const struct render_params *params)
{
    struct fixture f = {.scene = scene};
    struct accel *trees;
    assert_int_equal(accel_create(&fixture_log, scene, NULL, &trees), WHIT_OK);
    assert_int_equal(accel_create(&fixture_log, scene, &no_trees, &f.accel), WHIT_OK);
    assert_int_equal(accel_validate(f.accel), WHIT_OK);
    f.device = fixture_device();
    struct picture with = render(&f, trees, params), without = render(&f, f.accel, params);
    size_t pixels = (size_t)params->width * params->height;
    assert_memory_equal(with.color.pixels, without.color.pixels, pixels * 16);
    assert_memory_equal(with.ids.words, without.ids.words, pixels * 8);
    assert_true(with.stats.rays_shadow == without.stats.rays_shadow);
    assert_true(with.stats.rays_reflected == without.stats.rays_reflected);
    assert_true(with.stats.rays_refracted == without.stats.rays_refracted);
    print_message("  %llu shadow, %llu reflected, %llu refracted rays; %u dispatches\n",
                  (unsigned long long)without.stats.rays_shadow,
                  (unsigned long long)without.stats.rays_reflected,
                  (unsigned long long)without.stats.rays_refracted, without.stats.dispatches);
    for (uint32_t k = 0; params->count && k < RAY_KIND_COUNT; ++k) {
        const struct cost_sum *a = &with.stats.costs[k], *b = &without.stats.costs[k];
        assert_true(a->rays == b->rays && b->pairs == 0 && a->triangles < b->triangles);
        if (k != RAY_SHADOW) /* which end at what blocks them */
            assert_true(b->triangles == b->rays * scene->triangle_total);
    }
    picture_finish(&with);
    picture_finish(&without);
    accel_destroy(trees);
    fixture_validate();
    accel_destroy(f.accel);
    scene_destroy(scene);
}

/* Two lights, four instances, mirror and glass. */
static void glass_equals_that_of_trees(void **state)
{
    (void)state;
    struct scene *scene = glass_scene();
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    const struct render_params params = {
        .width = 19, .height = 11, .depth = 5, .samples = 4, .camera = glass_camera, .count = true};
    check_picture(scene, &params);
}

/* Hits and shadows that go on from one dispatch to the next. */
static void many_ranges_equal_trees(void **state)
{
    (void)state;
    struct scene *scene = glass_scene_of(130, 4);
    assert_int_equal(scene_freeze(scene), WHIT_OK);
    assert_true(scene->triangle_total > 2 * 16384);
    const struct render_params params = {
        .width = 9, .height = 7, .depth = 3, .camera = glass_camera, .count = true};
    check_picture(scene, &params);
}

/* Cut-outs, blending, thin glass. */
static void layers_equal_those_of_trees(void **state)
{
    (void)state;
    struct scene *scene;
    assert_int_equal(load_scene(&fixture_log, WHIT_SCENES_DIR "/layers.json", NULL, &scene),
                     WHIT_OK);
    const struct render_params params = {.width = 12, .height = 9, .depth = 6};
    check_picture(scene, &params);
}

/* The clock of this program goes on by this much whenever it is looked at (-Wl,--wrap=clock_ms). */
static double step_ms;
double __wrap_clock_ms(void);

double __wrap_clock_ms(void)
{
    static double now_ms;
    return now_ms += step_ms;
}

/* Refused from a part of it, before anything long begins; where that part takes no time, or with
   room for all of it, not refused. */
static void long_pictures_are_refused(void **state)
{
    (void)state;
    struct fixture f = fixture_open(terrain_scene(), &no_trees, NULL);
    struct render_params params = {.width = 2000, .height = 2000, .samples = 64};
    renderer_destroy(f.renderer);
    assert_int_equal(renderer_create(&fixture_log, f.device, f.accel, &params, &f.renderer),
                     WHIT_OK);
    struct image image;
    step_ms = 1000.0;
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_TIME_LIMIT);
    assert_int_equal(renderer_read_color(f.renderer, &image), WHIT_ERROR_USAGE);
    assert_int_equal(brute_check_time(f.renderer), WHIT_ERROR_TIME_LIMIT);
    f.renderer->params.time_limit_s = 1e9;
    assert_int_equal(brute_check_time(f.renderer), WHIT_OK);
    f.renderer->params.time_limit_s = 0.0;
    f.renderer->brute.time_checked = false;
    step_ms = 0.0;
    assert_int_equal(brute_check_time(f.renderer), WHIT_OK);
    fixture_close(&f);
}

static void empty_scenes_have_a_picture(void **state)
{
    (void)state;
    struct fixture f = fixture_open(scene_begin(&fixture_log, "empty"), &no_trees, NULL);
    struct gpu_ray ray = {{0, 0, 5}, 0, {0, 0, -1}, INFINITY};
    struct gpu_hit hit;
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_OK);
    assert_int_equal(hit.primitive, HIT_NONE);
    struct image ids;
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_int_equal(renderer_read_ids(f.renderer, &ids), WHIT_OK);
    for (uint32_t i = 0; i < 2 * ids.width * ids.height; ++i)
        assert_int_equal(ids.words[i], HIT_NONE);
    image_finish(&ids);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_equal_those_of_trees),
        cmocka_unit_test(long_lists_are_cut),
        cmocka_unit_test(glass_equals_that_of_trees),
        cmocka_unit_test(layers_equal_those_of_trees),
        cmocka_unit_test(many_ranges_equal_trees),
        cmocka_unit_test(long_pictures_are_refused),
        cmocka_unit_test(empty_scenes_have_a_picture),
    };
    return fixture_end(cmocka_run_group_tests(tests, NULL, NULL));
}
