/* The reference through the public header: no device. */
#include "scene_fixture.h"

enum { WIDTH = 16, HEIGHT = 12 };

static void note_progress(void *user, double done)
{
    double *last = user;
    assert_true(done > *last && done <= 1.0);
    *last = done;
}

TEST(draws_pictures_and_ray_trees)
{
    scene_open(WHIT_SCENES_DIR "/layers.json");
    double last = 0.0;
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.all_effects = true;
    params.progress = note_progress;
    params.progress_user = &last;
    whit_reference *reference = NULL;
    own_whit_image *color = NULL, *ids = NULL;
    assert_int_equal(whit_reference_create(accel, &params, 0, &reference), WHIT_OK);
    assert_int_equal(whit_reference_render(reference, &color, &ids), WHIT_OK);
    assert_true(last == 1.0);
    whit_stats stats;
    uint64_t of_kind[WHIT_RAY_KINDS] = {0}, straight = 0;
    whit_reference_get_stats(reference, &stats);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
        whit_probe_ray *rays = NULL;
        uint32_t count = 0;
        double sum = 0.0;
        assert_int_equal(whit_reference_rays(reference, i % WIDTH, i / WIDTH, 0, &rays, &count),
                         WHIT_OK);
        assert_true(count > 0);
        for (uint32_t k = 0; k < count; ++k)
            sum += rays[k].kind == WHIT_RAY_SHADOW ? 0.0 : (double)rays[k].added[1];
        for (uint32_t k = 0; k < count; ++k)
            *(rays[k].straight ? &straight : &of_kind[rays[k].kind]) +=
                rays[k].end != WHIT_PROBE_DEPTH && rays[k].end != WHIT_PROBE_BAILOUT;
        assert_true(fabs(sum - (double)whit_image_floats(color)[4 * i + 1]) <= 1e-6 * sum);
        assert_int_equal(rays[0].device.instance, whit_image_words(ids)[2 * i]);
        assert_int_equal(rays[0].device.primitive, whit_image_words(ids)[2 * i + 1]);
        whit_memory_destroy(rays);
    }
    assert_int_equal(stats.rays_primary, of_kind[WHIT_RAY_PRIMARY]);
    assert_int_equal(stats.rays_shadow, of_kind[WHIT_RAY_SHADOW]);
    assert_int_equal(stats.rays_reflected, of_kind[WHIT_RAY_REFLECTED]);
    assert_int_equal(stats.rays_refracted, of_kind[WHIT_RAY_REFRACTED]);
    assert_true(straight > 0);
    assert_int_equal(stats.rays_straight, straight);
    whit_reference_destroy(reference);
    scene_close();
}

static whit_image *draw_samples(uint32_t first, uint32_t count)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, NULL);
    params.sampling = (whit_sampling){.first = first, .count = count};
    return reference_image(&params);
}

TEST(any_number_of_samples_is_their_mean)
{
    enum { COUNT = 13 };
    scene_open(WHIT_SCENES_DIR "/cube.json");
    double sums[WIDTH * HEIGHT * 4] = {0};
    for (uint32_t count = 1; count <= COUNT; ++count) {
        own_whit_image *one = draw_samples(count - 1, 1);
        own_whit_image *all = draw_samples(0, count);
        for (int i = 0; i < WIDTH * HEIGHT * 4; ++i) {
            sums[i] += (double)whit_image_floats(one)[i];
            double mean = sums[i] / count, drawn = (double)whit_image_floats(all)[i];
            if (fabs(drawn - mean) > 1e-6 * fabs(mean))
                fail_msg("%u samples, float %d: %.9g is not %.9g", count, i, drawn, mean);
        }
    }
    scene_close();
}

TEST(refuses_what_it_cannot_draw)
{
    scene_open(WHIT_SCENES_DIR "/cube.json");
    const whit_renderer_params refused[] = {
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1}},
        {.effects_removed = 1},
        {.camera = {.name = "nobody"}},
        {.sampling.count = 4097}};
    whit_reference *reference = NULL;
    for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
        assert_int_equal(whit_reference_create(accel, &refused[i], 0, &reference),
                         WHIT_ERROR_USAGE);
        assert_null(reference);
    }
    const volatile bool cancel = true;
    const whit_renderer_params cancelled = {.cancel = &cancel};
    whit_image *color = NULL;
    assert_int_equal(whit_reference_create(accel, &cancelled, 0, &reference), WHIT_OK);
    assert_int_equal(whit_reference_render(reference, &color, NULL), WHIT_ERROR_CANCELLED);
    assert_null(color);
    whit_probe_ray *rays = NULL;
    uint32_t count = 1;
    assert_int_equal(whit_reference_rays(reference, 640, 0, 0, &rays, &count), WHIT_ERROR_USAGE);
    assert_null(rays);
    whit_reference_destroy(reference);
    scene_close();
}
