/* Settings that must not change a picture, and errors that end one. The tests of light, shadows,
   refraction and energy compare radiance with formulas. */
#include "../wrapped.h"
#include "device/buffer.h"
#include "picture_fixture.h"
#include "render/pixels.h"
#include "render/readback.h"
#include "render/renderer.h"
#include "render/stages.h"
#include "render/tiles.h"
#include "render/upload.h"
#include "unit.h"

TEST_BY_TURNS(glass_slab_passes_and_absorbs, 0, 4)
{
    const double ior = 1.5, thickness = 2.0, sigma = 0.3;
    struct scene *scene = dark_scene((double[]){0, 0, 9}, (double[]){0, 0, 0});
    struct scene_material glass = matte(0, 0, 0);
    set_rgb(glass.transmission, 1, 1, 1);
    set_rgb(glass.absorption, (float)sigma, 0, 0);
    glass.ior = (float)ior;
    glass.fresnel = true;
    add_object(scene, mesh_box(8, 8, thickness), glass, 0, 0, 0);
    add_object(scene, mesh_box(9, 9, 0.1), unlit(1, 1, 1), 0, 0, -4);
    whit_renderer_params params = picture_params;
    params.depth = 12;
    own_image image = color_of(scene, NULL, &params);
    /* A slab with inner reflections: T = (1-R)^2 a / (1 - R^2 a^2), a = exp(-sigma d), wall 1
       behind and darkness before. Rays below 1/1024 of the pixel are not followed. */
    double r = pow((ior - 1) / (ior + 1), 2), a = exp(-sigma * thickness);
    assert_near(middle(&image)[0], (1 - r) * (1 - r) * a / (1 - r * r * a * a), 3e-3);
    assert_near(middle(&image)[1], (1 - r) * (1 - r) / (1 - r * r), 3e-3);
}

/* A picture of one texel, all channels `value`. */
static uint32_t add_texel(struct scene *scene, int value)
{
    uint8_t texel = (uint8_t)value;
    return scene_put_texture(scene, 1, 1, (uint8_t[4]){texel, texel, texel, texel});
}

/* A lit box of metal-rough material that transmits `transmission` times a texture of `texel`. */
static struct image transmitting_box(float transmission, int texel)
{
    struct scene *scene = dark_scene((double[]){0, 0, 5}, (double[]){0, 0, 0});
    struct scene_material m = matte(0.8f, 0.6f, 0.4f);
    m.model = WHIT_MODEL_METAL_ROUGH;
    set_rgb(m.specular, 1, 1, 1);
    set_rgb(m.transmission, transmission, transmission, transmission);
    m.roughness = 1.0f;
    m.fresnel = true;
    if (texel >= 0)
        m.textures[SCENE_SLOT_TRANSMISSION].texture = add_texel(scene, texel);
    add_object(scene, mesh_box(4, 4, 0.5), m, 0, 0, 0);
    scene_put_sun(scene, 0, 0, -1, 1.0f);
    return color_of(scene, NULL, &picture_params);
}

TEST_BY_TURNS(texture_of_transmission_decides, 1, 4)
{
    own_image opaque = transmitting_box(0.0f, -1);
    own_image masked = transmitting_box(1.0f, 0);
    own_image clear = transmitting_box(1.0f, 255);
    for (int c = 0; c < 3; ++c) {
        assert_near(middle(&masked)[c], (double)middle(&opaque)[c], 1e-6);
        assert_true(middle(&opaque)[c] > 0.3f);
        assert_true(middle(&clear)[c] < 0.1f);
    }
}

/* The radiance of a smooth black box under a white sky, which only reflects the sky. */
static float mirrored(float level, float tint, enum scene_slot slot, int texel)
{
    struct scene *scene = dark_scene((double[]){0, 0, 5}, (double[]){0, 0, 0});
    set_sky(scene, 1, 1, 1);
    struct scene_material m = matte(0, 0, 0);
    m.model = WHIT_MODEL_METAL_ROUGH;
    set_rgb(m.specular, tint, tint, tint);
    m.specular_level = level;
    m.roughness = 0.0f;
    m.metallic = 0.0f;
    m.fresnel = true;
    m.textures[slot].texture = add_texel(scene, texel);
    add_object(scene, mesh_box(4, 4, 0.5), m, 0, 0, 0);
    scene_put_sun(scene, 0, -1, 0, 0.0f); /* no light of whit's own */
    whit_renderer_params params = picture_params;
    params.bailout = 0.0;
    own_image image = color_of(scene, NULL, &params);
    return middle(&image)[1];
}

TEST_BY_TURNS(textures_of_specular_scale_it, 2, 4)
{
    /* ior 1.5: 0.04 straight on. The tint is sRGB, the level linear. */
    assert_near(mirrored(1.0f, 1.0f, SCENE_SLOT_SPECULAR, 255), 0.04, 1e-5);
    assert_near(mirrored(1.0f, 1.0f, SCENE_SLOT_SPECULAR, 188), 0.04 * 0.50288646, 1e-5);
    assert_near(mirrored(1.0f, 0.5f, SCENE_SLOT_SPECULAR, 255), 0.02, 1e-5);
    assert_near(mirrored(1.0f, 1.0f, SCENE_SLOT_SPECULAR_LEVEL, 51), 0.04 * 0.2, 1e-5);
    assert_near(mirrored(0.5f, 1.0f, SCENE_SLOT_SPECULAR_LEVEL, 51), 0.04 * 0.1, 1e-5);
}

static struct scene *mixed_scene(void)
{
    struct scene *scene = dark_scene((double[]){1, 2, 7}, (double[]){0, 0.5, 0});
    set_rgb(scene->environment.zenith, 0.2f, 0.4f, 0.9f);
    set_rgb(scene->environment.horizon, 0.8f, 0.9f, 1.0f);
    struct scene_material shiny = matte(0.1f, 0.1f, 0.1f), glass = matte(0, 0, 0);
    set_rgb(shiny.reflection, 0.8f, 0.8f, 0.8f);
    set_rgb(shiny.specular, 0.5f, 0.5f, 0.5f);
    shiny.shininess = 60.0f;
    set_rgb(glass.transmission, 0.9f, 1, 0.9f);
    glass.fresnel = true;
    add_object(scene, mesh_plane(12), matte(0.6f, 0.5f, 0.4f), 0, -1, 0);
    add_object(scene, mesh_sphere(1.0, 32, 16), shiny, -1.3, 0, 0);
    add_object(scene, mesh_sphere(1.0, 32, 16), glass, 1.3, 0, 1);
    scene_put_sun(scene, -1, -2, -1, 0.8f);
    scene_put_lamp(scene, 3, 4, 3, 6.0f);
    return scene;
}

static struct scene *plain_scene(void)
{
    struct scene *scene = dark_scene((double[]){1, 2, 7}, (double[]){0, 0.5, 0});
    add_object(scene, mesh_box(2, 2, 2), matte(0.6f, 0.5f, 0.4f), 0.1, 0, 0);
    scene_put_sun(scene, -1, -2, -1, 0.8f);
    return scene;
}

TEST(tiles_do_not_matter)
{
    whit_renderer_params params = {
        .width = 75, .height = 51, .depth = 6, .sampling.count = 4, .tile_size = 16};
    own_picture small = picture_of(mixed_scene(), NULL, &params);
    assert_true(small.stats.tiles > 1);
    for (uint32_t tile = 32; tile <= 512; tile *= 4) {
        params.tile_size = tile;
        own_picture large = picture_of(mixed_scene(), NULL, &params);
        assert_same_picture("larger tiles", &large, &small);
    }
}

static struct scene *panes_scene(uint32_t count)
{
    static const float pane_corners[9] = {-5, 2, -5, 5, 2, -5, 0, 2, 9};
    struct scene *scene = floor_scene(1);
    struct scene_material pane = material_plain("pane");
    set_rgb(pane.transmission, 1, 1, 1);
    pane.thin_walled = true;
    add_object(scene, mesh_stack(count, pane_corners, 1, 1e-5f), pane, 0, 0, 0);
    scene_put_sun(scene, 0, -1, 0, 1.0f);
    return scene;
}

/* Packets are chosen for scenes that are one large tree, and for a single picture only if it has so
   many rays that the kernels pay. */
TEST_BY_TURNS(packets_are_chosen_where_they_pay, 3, 4)
{
    static const struct {
        uint32_t steps, side;
        bool instances, beside, many;
        uint32_t points; /* of an area light; 0: a lamp */
        uint32_t rays;   /* of a lane */
    } cases[] = {
        {96, 16, false, false, false, 0, 1},   {96, 1024, false, false, false, 0, 2},
        {96, 4096, false, false, false, 0, 4}, {96, 1024, true, false, false, 0, 1},
        {96, 16, false, true, false, 0, 4},    {96, 16, false, false, true, 0, 2},
        {4, 1024, false, false, false, 0, 1},  {4, 16, false, true, false, 0, 1},
        {4, 16, false, false, true, 0, 1},     {96, 1024, false, false, false, 16, 4},
        {96, 1024, false, false, false, 1, 2}, {96, 256, false, false, false, 0, 1},
        {96, 256, false, false, false, 16, 1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const whit_renderer_params params = {.width = cases[i].side,
                                             .height = cases[i].side,
                                             .depth = 1,
                                             .compile_async = cases[i].beside,
                                             .many_pictures = cases[i].many,
                                             .light_samples = cases[i].points};
        struct scene *scene = dark_scene((double[]){0, 9, 9}, (double[]){0, 0, 0});
        add_object(scene, mesh_terrain(8, 1, cases[i].steps, 1), material_plain("ground"), 0, 0, 0);
        if (cases[i].points)
            scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){-1, 4, -1},
                                           (double[]){2, 0, 0}, (double[]){0, 0, 2}, 1));
        else
            scene_put_lamp(scene, 3, 4, 3, 1);
        if (cases[i].instances)
            add_object(scene, mesh_box(1, 1, 1), material_plain("box"), 0, 3, 0);
        own_fixture f = fixture_open(scene, NULL, &params);
        bool can = upload_can_widen(f.renderer); /* what lavapipe is for */
        print_message("  %u steps, %u pixels a side: %u rays a lane\n", cases[i].steps,
                      cases[i].side, f.renderer->packet_rays);
        assert_int_equal(f.renderer->packets, can && cases[i].rays > 1);
        assert_int_equal(f.renderer->packet_rays, cases[i].rays);
    }
}

/* If a loop needs more iterations than lavapipe allows, that is an error, never a silently wrong
   picture. A shadow ray passes all panes of a stack, with each kind of tree and traversal. */
TEST_BY_TURNS(cut_loops_are_reported, 0, 4)
{
    for (int i = 0; i < 4; ++i) {
        const whit_renderer_params params = {.width = 8,
                                             .height = 8,
                                             .depth = 0,
                                             .packets = i & 1 ? WHIT_PACKETS_ON : WHIT_PACKETS_OFF};
        const whit_accel_params accel = {.instances =
                                             i & 2 ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON};
        own_fixture f = fixture_open(panes_scene(70000), &accel, &params);
        whit_result result = renderer_render(f.renderer);
        print_message("  70000 panes, packets %d, one tree %d: %s\n", i & 1, (i & 2) / 2,
                      whit_result_name(result));
        assert_int_equal(result,
                         device_get_limits(f.device)->loop_limited ? WHIT_ERROR_STATUS : WHIT_OK);
    }
}

/* The clock of this program moves only where the test sets it (-Wl,--wrap=clock_ms). */
static double now_ms;
static bool *cancelled_by_clock; /* set to true at the next reading of the clock; NULL: none */

WRAPPED(double, clock_ms, void)
{
    if (cancelled_by_clock)
        *cancelled_by_clock = true;
    return now_ms;
}

static struct scene *lamps_scene(int lamps)
{
    struct scene *scene = plain_scene();
    for (int i = 0; i < lamps; ++i)
        scene_put_lamp(scene, 3 + 0.01 * i, 4, 3, 0.001f);
    return scene;
}

TEST_BY_TURNS(many_lights_are_drawn, 1, 4)
{
    const whit_renderer_params params = {.width = 8, .height = 8, .depth = 0};
    own_picture picture = picture_of(lamps_scene(4000), NULL, &params);
    assert_true(picture.stats.rays_shadow > 4000);
}

/* In a single tile a cancellation during the first submission waits for a few lights, but not for
   all of many. */
TEST_BY_TURNS(many_lights_defer_no_one, 2, 4)
{
    bool cancel = false;
    whit_renderer_params params = {.width = 8, .height = 8, .depth = 0, .cancel = &cancel};
    for (int lights = 4; lights <= 4000; lights += 3996) {
        own_fixture f = fixture_open(lamps_scene(lights), NULL, &params);
        struct progress progress = {.share = 1.0, .work_total = 1};
        struct gpu_chunk chunk = {.block_count = 1, .blocks_x = 1, .band_rows = 8};
        double longest_ms = 0.0;
        assert_int_equal(renderer_compile(f.renderer), WHIT_OK);
        render_take_sample(&f.renderer->picture, 0, 1, &chunk);
        cancelled_by_clock = &cancel;
        whit_result result = stages_sample(&f.renderer->picture, &chunk, &progress, &longest_ms);
        cancelled_by_clock = NULL;
        assert_true(cancel);
        cancel = false;
        assert_int_equal(result, lights == 4 ? WHIT_OK : WHIT_ERROR_CANCELLED);
    }
}

struct glass_picture {
    struct picture picture;
    struct image refracted; /* costs of refracted rays, if they are counted */
    bool was_full;
};

static struct glass_picture glass_picture(uint32_t tile_size, bool count)
{
    struct scene *scene = dark_scene((double[]){0, 0, 3.5}, (double[]){0, 0, 0});
    struct scene_material glass = material_plain("glass");
    set_rgb(scene->environment.zenith, 0.3f, 0.6f, 1.0f);
    set_rgb(glass.transmission, 1, 1, 1);
    glass.fresnel = true;
    glass.ior = 1.5f;
    add_object(scene, mesh_icosphere(1, 2), glass, 0, 0, 0);
    const whit_renderer_params params = {
        .width = 64, .height = 64, .depth = 13, .tile_size = tile_size, .count = count};
    own_fixture f = fixture_open(scene, NULL, &params);
    struct glass_picture glass_picture = {.picture = render_picture(&f)};
    if (count)
        assert_int_equal(renderer_read_costs(f.renderer, RAY_REFRACTED, &glass_picture.refracted),
                         WHIT_OK);
    glass_picture.was_full = f.renderer->picture.stages.blocks_max > 0;
    return glass_picture;
}

/* Checks the shares of materials in the hits of timed tiles. The picture has two tiles of two rows
   of blocks, of which the second is timed. */
static void check_shares(const whit_accel_params *accel)
{
    enum { WIDTH = 64, HEIGHT = 32 };
    const whit_renderer_params params = {.width = WIDTH,
                                         .height = HEIGHT,
                                         .tile_size = 32,
                                         .classes = WHIT_CLASSES_MANY,
                                         .time_stages = true};
    own_fixture f = fixture_open(mixed_scene(), accel, &params);
    own_picture picture = render_picture(&f);
    const whit_stats *stats = &picture.stats;
    uint32_t worn[2][8] = {{0}}, all[2] = {0}, known = 0;
    assert_int_equal(stats->tiles, 2);
    assert_true(f.scene->material_count <= 8);
    for (uint32_t i = WIDTH * HEIGHT / 2; i < WIDTH * HEIGHT; ++i) {
        const uint32_t *id = &picture.ids.words[2 * (size_t)i];
        if (id[1] == HIT_NONE)
            continue;
        uint32_t m = f.scene->meshes[f.scene->instances[id[0]].mesh].materials[id[1]];
        bool glass = f.scene->materials[m].transmission[0] > 0.0f;
        ++worn[glass][m];
        ++all[glass];
    }
    for (uint32_t i = 0; i < stats->share_count; ++i) {
        const whit_share *share = &stats->shares[i];
        bool glass = share->stage == RENDER_STAGE_SHADE_GLASS;
        print_message("  %s: %.3f\n", f.scene->materials[share->material].name, share->share);
        assert_true(fabs(share->share - (double)worn[glass][share->material] / all[glass]) < 1e-9);
        assert_true(i == 0 || share->share <= stats->shares[i - 1].share);
        known += worn[glass][share->material];
    }
    assert_int_equal(known, all[0] + all[1]); /* none is left out */
    assert_true(stats->share_count == 3);
}

TEST(shares_are_those_of_hits)
{
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    check_shares(NULL);
    check_shares(&flat);
}

/* Submissions may take 100 ms. */
TEST(tiles_grow_into_the_room_there_is)
{
    assert_int_equal(tiles_adapt(128, 512, 20.0), 256);
    assert_int_equal(tiles_adapt(128, 512, 26.0), 128);
    assert_int_equal(tiles_adapt(128, 192, 26.0), 192);
    assert_int_equal(tiles_adapt(128, 192, 45.0), 128);
    assert_int_equal(tiles_adapt(192, 192, 1.0), 192);
    assert_int_equal(tiles_adapt(16, 8, 1.0), 16);
    assert_int_equal(tiles_adapt(192, 192, 101.0), 96);
    assert_int_equal(tiles_adapt(24, 192, 101.0), 16);
    assert_int_equal(tiles_adapt(16, 192, 101.0), 16);
}

/* 160 x 90 pixels are 240 blocks of 8 x 8: no square number of them. */
TEST(a_small_picture_is_one_tile)
{
    whit_renderer_params params = {.width = 160, .height = 90};
    own_picture picture = picture_of(mixed_scene(), NULL, &params);
    assert_int_equal(picture.stats.tiles, 1);
}

TEST(a_picture_begins_with_the_tile_that_the_last_one_came_to)
{
    const whit_renderer_params params = {.width = 320, .height = 240};
    own_fixture f = fixture_open(plain_scene(), NULL, &params);
    uint32_t usual = render_progress(f.renderer).tile;
    assert_int_equal(f.renderer->tile, 0);
    f.renderer->tile = usual + 8;
    assert_int_equal(render_progress(f.renderer).tile, usual + 8);
    f.renderer->tile = 4096;
    assert_true(render_progress(f.renderer).tile <= 320);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_true(f.renderer->tile != 4096);
}

TEST(stages_are_timed_only_where_asked)
{
    whit_renderer_params params = {.width = 64, .height = 32, .tile_size = 32};
    for (int timed = 0; timed < 2; ++timed) {
        params.time_stages = timed == 1;
        own_picture picture = picture_of(mixed_scene(), NULL, &params);
        const whit_stage *camera = &picture.stats.stages[RENDER_STAGE_CAMERA];
        assert_int_equal(camera->rays, 64 * 32);
        assert_int_equal(camera->ms > 0.0, timed == 1);
        assert_int_equal(picture.stats.share_count > 0, timed == 1);
    }
}

/* Several tiles share the sums of weights of a renderer that keeps colours alone, and each sample
   adds to them. */
static void check_colors_alone(whit_sampling sampling)
{
    whit_renderer_params params = {.width = 64,
                                   .height = 48,
                                   .tile_size = 32,
                                   .depth = 2,
                                   .bailout = 0.05,
                                   .sampling = sampling};
    own_picture all = picture_of(mixed_scene(), NULL, &params);
    params.color_only = true;
    own_fixture f = fixture_open(mixed_scene(), NULL, &params);
    own_image color = render(&f);
    struct image borrowed, none;
    whit_stats stats;
    renderer_get_stats(f.renderer, &stats);
    assert_same_image("colours alone", &color, &all.color);
    assert_int_equal(renderer_borrow_color(f.renderer, &borrowed), WHIT_OK);
    assert_same_image("borrowed", &borrowed, &all.color);
    image_finish(&borrowed); /* the renderer keeps its pixels */
    own_image again = render(&f);
    assert_same_image("drawn again", &again, &all.color);
    assert_true(stats.weight_cut_depth > 0.0 && stats.weight_cut_bailout > 0.0);
    assert_true(stats.weight_cut_depth == all.stats.weight_cut_depth);
    assert_true(stats.weight_cut_bailout == all.stats.weight_cut_bailout);
    assert_int_equal(whit_stats_rays(&stats), whit_stats_rays(&all.stats));
    assert_true(stats.device_bytes < all.stats.device_bytes);
    assert_int_equal(renderer_read_ids(f.renderer, &none), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_read_cuts(f.renderer, &none), WHIT_ERROR_USAGE);
}

TEST(colors_alone_are_the_same)
{
    check_colors_alone((whit_sampling){.count = 1});
    check_colors_alone((whit_sampling){.count = 5});
    check_colors_alone((whit_sampling){.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1});
}

TEST(weights_of_cut_rays_are_those_of_their_pixels)
{
    const whit_renderer_params params = {.width = 64, .height = 48, .bailout = 0.05};
    own_fixture f = fixture_open(mixed_scene(), NULL, &params);
    own_picture picture = render_picture(&f);
    own_image cuts = {0};
    size_t missed = 0, cut = 0;
    assert_int_equal(renderer_read_cuts(f.renderer, &cuts), WHIT_OK);
    for (size_t i = 0; i < (size_t)params.width * params.height; ++i) {
        bool has = cuts.pixels[2 * i] > 0.0f || cuts.pixels[2 * i + 1] > 0.0f;
        bool misses = picture.ids.words[2 * i + 1] == HIT_NONE;
        assert_false(has && misses);
        missed += misses;
        cut += has;
    }
    assert_true(missed > 0 && cut > 0);
}

/* With two segments lists are filled from both ends. The hits of camera rays are counted only after
   later generations of rays have listed theirs, and must still be there. */
TEST(shares_are_the_same_by_one_segment_and_by_two)
{
    whit_renderer_params params = {
        .width = 64, .height = 32, .tile_size = 32, .depth = 4, .segments = 1, .time_stages = true};
    own_picture one = picture_of(mixed_scene(), NULL, &params);
    params.segments = 2;
    own_picture two = picture_of(mixed_scene(), NULL, &params);
    assert_same_picture("two segments", &one, &two);
    assert_true(one.stats.rays_refracted > 0 && one.stats.share_count > 1);
    assert_int_equal(one.stats.share_count, two.stats.share_count);
    for (uint32_t i = 0; i < one.stats.share_count; ++i) {
        const whit_share *a = &one.stats.shares[i], *b = &two.stats.shares[i];
        print_message("  material %u: %.6f, %.6f\n", a->material, a->share, b->share);
        assert_int_equal(a->material, b->material);
        assert_true(a->share == b->share);
    }
}

/* Each of these rays calls for two others. */
TEST_BY_TURNS(full_queues_end_in_smaller_tiles, 3, 4)
{
    for (int count = 0; count < 2; ++count) {
        struct glass_picture large = glass_picture(64, count), small = glass_picture(16, count);
        assert_true(large.was_full && !small.was_full);
        assert_same_picture("smaller tiles", &large.picture, &small.picture);
        const whit_cost *sum = &large.picture.stats.costs[RAY_REFRACTED];
        assert_memory_equal(sum, &small.picture.stats.costs[RAY_REFRACTED], sizeof *sum);
        assert_true((sum->rays > 0) == (count > 0));
        if (count)
            assert_same_image("costs", &large.refracted, &small.refracted);
        picture_finish(&large.picture);
        picture_finish(&small.picture);
        image_finish(&large.refracted);
        image_finish(&small.refracted);
    }
}

TEST(cancel_and_time_limit_stop)
{
    bool cancel = true;
    whit_renderer_params params = {.width = 64, .height = 64, .cancel = &cancel};
    own_fixture f = fixture_open(plain_scene(), NULL, &params);
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_CANCELLED);
    struct image image = {0};
    assert_int_equal(renderer_read_color(f.renderer, &image), WHIT_ERROR_USAGE);
    params.cancel = NULL;
    params.time_limit_s = 2.0;
    fixture_renew(&f, &params);
    now_ms += 1999.0;
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    now_ms += 2.0;
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_TIME_LIMIT);
}

/* Once a renderer has uploaded a scene's pictures, the scene may drop them; no other renderer can
   be made for it then. */
TEST(pictures_may_be_dropped)
{
    own_fixture f = fixture_open(mixed_scene(), NULL, &picture_params);
    own_image before = render(&f);
    scene_drop_pictures(f.scene);
    own_image after = render(&f);
    assert_same_image("dropped pictures", &before, &after);
    fixture_refuses(&f, &picture_params, 1);
}

/* Pixels of blocks that stick out of the picture may hold anything. */
TEST(only_pixels_of_the_picture_are_counted)
{
    const whit_renderer_params params = {.width = 20, .height = 12, .depth = 1};
    own_fixture f = fixture_open(plain_scene(), NULL, &params);
    own_image image = render(&f);
    const float bad[4] = {NAN, NAN, NAN, NAN};
    uint32_t x, y, count;
    struct buffer *pixels = f.renderer->picture.buffers.pixels;
    assert_int_equal(buffer_write(pixels, (13 * 20 + 3) * sizeof bad, bad, sizeof bad), WHIT_OK);
    assert_int_equal(readback_non_finite(&f.renderer->picture, &x, &y, &count), WHIT_OK);
    assert_int_equal(count, 0);
    assert_int_equal(buffer_write(pixels, (11 * 20 + 3) * sizeof bad, bad, sizeof bad), WHIT_OK);
    assert_int_equal(readback_non_finite(&f.renderer->picture, &x, &y, &count), WHIT_OK);
    assert_true(count == 1 && x == 3 && y == 11);
}

/* The state of a queued ray holds the most steps that a depth allows, and the slots of a picture's
 * tiles. */
TEST(a_slot_has_the_bits_that_steps_leave)
{
    for (uint32_t depth = 0; depth < 256; ++depth) {
        uint32_t shift = pixels_slot_shift(depth);
        uint32_t steps = depth << STATE_BOUNCES_SHIFT | ((1u << STATE_BOUNCES_SHIFT) - 1);
        assert_true(steps >> shift == 0 && steps >> (shift - 1) == 1);
        const whit_renderer_params params = {
            .width = 1024, .height = 1024, .depth = depth, .tile_size = 1024};
        if (depth % 85)
            continue;
        own_fixture f = fixture_open(plain_scene(), NULL, &params);
        assert_int_equal(f.renderer->frame.slot_shift, shift);
        assert_true(f.renderer->picture.buffers.chunk_slots <= (UINT32_MAX >> shift) + 1);
    }
}

TEST(nonsense_is_refused)
{
    own_fixture f = fixture_open(plain_scene(), NULL, NULL);
    const whit_renderer_params bad[] = {
        {.width = 0, .height = 4},
        {.width = 70000, .height = 4},
        {.sampling.count = 4097},
        {.tile_size = 8},
        {.depth = 1000},
        {.camera = {.name = "nobody"}},
        {.effects_removed = UINT64_C(1) << SCENE_EFFECT_INSTANCES},
        {.effects_added = UINT64_C(1) << SCENE_EFFECT_INSTANCES},
        {.effects_added = UINT64_C(1) << 63},
        {.effects_added = 1, .effects_removed = 1},
        {.numerics = (whit_numerics)3},
        {.classes = (whit_classes)9},
        {.node_bytes = 8},
        {.camera = CAMERA_AT(0, 0, 0, 0, 0, 0, 0, 1, 0, 40)},
        {.camera = CAMERA_AT(0, 0, 1, 0, 0, 0, 0, 1, 0, 180)},
        {.camera = {.name = "0,0,1,0,0,0,0,1,0"}},
        {.camera = {.name = "nan,0,1,0,0,0,0,1,0,40"}},
    };
    fixture_refuses(&f, bad, sizeof bad / sizeof *bad);
}
