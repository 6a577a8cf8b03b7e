/* The sum of samples is pairwise by index, so that parts of the samples merge to the bytes of the
   whole picture. */
#include "device/buffer.h"
#include "picture_fixture.h"
#include "render/renderer.h"
#include "unit.h"

enum { WIDTH = 20, HEIGHT = 18, FLOATS = WIDTH * HEIGHT * 4, SAMPLES = 16 };

static struct fixture f;
static float parts[SAMPLES][FLOATS], whole[FLOATS];

/* A mirror and a ball under an area light, seen through a lens: samples differ in all of these. */
static struct scene *scene_of_samples(void)
{
    struct scene *scene = dark_scene((double[]){0, 1.2, 3.0}, (double[]){0, 0.2, 0});
    struct scene_material floor = matte(0.5f, 0.4f, 0.3f), ball = matte(0.7f, 0.2f, 0.1f);
    set_rgb(scene->environment.zenith, 0.3f, 0.6f, 0.9f);
    set_rgb(floor.reflection, 0.3f, 0.3f, 0.3f);
    set_rgb(ball.reflection, 0.2f, 0.3f, 0.4f);
    add_object(scene, mesh_plane(3), floor, 0, 0, 0);
    add_object(scene, mesh_sphere(0.5, 12, 8), ball, 0, 0.5, 0);
    scene_put_light(scene, emitter(WHIT_LIGHT_RECTANGLE, (double[]){-1.1, 2.7, -0.8},
                                   (double[]){1.9, 0, 0}, (double[]){0, 0, 1.3}, 1.7f));
    scene->cameras[0].lens_radius = 0.15f;
    return scene;
}

static int open_scene(void **state)
{
    (void)state;
    const whit_renderer_params params = {.width = WIDTH, .height = HEIGHT, .depth = 3};
    f = fixture_open(scene_of_samples(), NULL, &params);
    return 0;
}

static int close_scene(void **state)
{
    (void)state;
    fixture_close(&f);
    return 0;
}

static void draw(uint32_t first, uint32_t count, uint32_t tile_size, float *pixels)
{
    const whit_renderer_params params = {.width = WIDTH,
                                         .height = HEIGHT,
                                         .depth = 3,
                                         .light_samples = 4,
                                         .sampling.first = first,
                                         .sampling.count = count};
    f.renderer->params.tile_size = tile_size;
    assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
    own_image image = render(&f);
    memcpy(pixels, image.pixels, FLOATS * sizeof *pixels);
}

static void draw_parts(uint32_t each)
{
    for (uint32_t i = 0; i < SAMPLES / each; ++i)
        draw(i * each, each, i % 2 ? 16 : 0, parts[i]);
}

/* The mean of `count` pictures by its definition: half of the sum of the means of both halves. */
static float mean_of(uint32_t first, uint32_t count, int at)
{
    if (count == 1)
        return parts[first][at];
    return 0.5f * mean_of(first, count / 2, at) + 0.5f * mean_of(first + count / 2, count / 2, at);
}

static uint32_t count_differing(uint32_t count)
{
    uint32_t differing = 0;
    for (int i = 0; i < FLOATS; ++i)
        differing += mean_of(0, count, i) != whole[i];
    return differing;
}

TEST(samples_are_summed_in_pairs)
{
    uint32_t differing = 0;
    draw_parts(1);
    draw(0, SAMPLES, 0, whole);
    assert_int_equal(count_differing(SAMPLES), 0);
    for (int i = 0; i < FLOATS; ++i) { /* one by one they come to something else */
        float sum = 0.0f;
        for (int s = 0; s < SAMPLES; ++s)
            sum += parts[s][i] / SAMPLES;
        differing += sum != whole[i];
    }
    assert_true(differing > FLOATS / 10);
}

TEST(sets_merge_to_the_whole)
{
    draw(0, SAMPLES, 16, whole);
    draw_parts(4);
    assert_int_equal(count_differing(SAMPLES / 4), 0);
    assert_memory_not_equal(parts[0], parts[1], sizeof *parts);
}

/* For every number of samples the picture is the mean of the samples, on the device and in
   double. */
TEST_BY_TURNS(any_number_of_samples_is_their_mean, 0, 2)
{
    draw_parts(1);
    for (uint32_t count = 2; count < SAMPLES; ++count) {
        draw(0, count, 0, whole);
        for (int i = 0; i < FLOATS; ++i) {
            double sum = 0.0;
            for (uint32_t s = 0; s < count; ++s)
                sum += (double)parts[s][i] / count;
            if (fabs(sum - (double)whole[i]) > 1e-6 * fabs(sum) + 1e-7)
                fail_msg("%u samples, float %d: %.9g is not %.9g", count, i, (double)whole[i], sum);
        }
    }
}

/* Draws with colours alone, so that weights of cut rays are summed by slot and not by pixel. */
static whit_stats draw_colors(uint32_t ray_capacity, float *pixels)
{
    whit_renderer_params params = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .depth = 3,
                                   .bailout = 0.1,
                                   .light_samples = 4,
                                   .sampling.count = SAMPLES,
                                   .color_only = true};
    own_fixture colors = fixture_open(scene_of_samples(), NULL, &params);
    struct target *picture = &colors.renderer->picture;
    if (ray_capacity)
        picture->buffers.queues.ray_capacity = ray_capacity;
    own_image image = render(&colors);
    assert_int_equal(picture->stages.blocks_max > 0, ray_capacity > 0);
    memcpy(pixels, image.pixels, FLOATS * sizeof *pixels);
    return picture->stats;
}

/* Where full queues halve a tile, each half has sums of its own, and the picture is the same. */
TEST(full_queues_do_not_matter)
{
    static float smaller[FLOATS];
    whit_stats stats = draw_colors(0, whole), halved = draw_colors(640, smaller);
    assert_memory_equal(smaller, whole, sizeof whole);
    assert_true(stats.weight_cut_bailout > 0.0);
    assert_true(halved.weight_cut_bailout == stats.weight_cut_bailout);
    assert_true(halved.weight_cut_depth == stats.weight_cut_depth);
}

/* ---- Rows ---- */

static whit_result set_rows(uint32_t first, uint32_t count, whit_sampling_kind kind)
{
    const whit_renderer_params params = {
        .width = WIDTH,
        .height = HEIGHT,
        .depth = 3,
        .light_samples = 4,
        .sampling = {.kind = kind, .count = SAMPLES, .contrast = 0.1},
        .first_row = first,
        .row_count = count};
    return renderer_set_view(f.renderer, &params);
}

TEST_BY_TURNS(rows_drawn_alone_are_those_of_the_picture, 1, 2)
{
    static const uint32_t rows[][2] = {{8, 8}, {0, 8}, {16, 2}, {0, 16}, {0, 0}};
    struct picture all, some;
    assert_int_equal(set_rows(0, 0, WHIT_SAMPLING_FIXED), WHIT_OK);
    all = render_picture(&f);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        uint32_t first = rows[i][0], count = rows[i][1] ? rows[i][1] : HEIGHT;
        assert_int_equal(set_rows(first, rows[i][1], WHIT_SAMPLING_FIXED), WHIT_OK);
        some = render_picture(&f);
        assert_int_equal(some.color.height, count);
        assert_memory_equal(some.color.pixels, &all.color.pixels[4 * first * WIDTH],
                            count * WIDTH * 4 * sizeof(float));
        assert_memory_equal(some.ids.words, &all.ids.words[2 * first * WIDTH],
                            count * WIDTH * 2 * sizeof(uint32_t));
        picture_finish(&some);
    }
    picture_finish(&all);
    assert_int_equal(set_rows(4, 8, WHIT_SAMPLING_FIXED), WHIT_ERROR_USAGE);
    assert_int_equal(set_rows(8, 9, WHIT_SAMPLING_FIXED), WHIT_ERROR_USAGE);
    assert_int_equal(set_rows(16, 8, WHIT_SAMPLING_FIXED), WHIT_ERROR_USAGE);
    assert_int_equal(set_rows(8, 0, WHIT_SAMPLING_FIXED), WHIT_ERROR_USAGE);
    assert_int_equal(set_rows(8, 8, WHIT_SAMPLING_ADAPTIVE), WHIT_ERROR_USAGE);
}

/* ---- Steps ---- */

static uint32_t steps, steps_wrong;

/* Each pixel of a step is that of the whole picture at one place of the pixel's square. Where the
   picture's border cuts this place off, it is that of the square before. */
static void look_at_step(void *user, const whit_step *step)
{
    const struct picture *all = user;
    uint32_t first = step->spacing == 8 ? 5 : 1;
    steps_wrong += step->spacing != 8u >> steps++ ||
                   step->width != (WIDTH + step->spacing - 1) / step->spacing ||
                   step->height != (HEIGHT + step->spacing - 1) / step->spacing;
    for (uint32_t i = 0; i < step->width * step->height; ++i) {
        uint32_t x = i % step->width * step->spacing + first,
                 y = i / step->width * step->spacing + first;
        x -= x < WIDTH ? 0 : step->spacing;
        y -= y < HEIGHT ? 0 : step->spacing;
        steps_wrong += memcmp(&step->rgba[4 * i], &all->color.pixels[4 * (y * WIDTH + x)], 16) != 0;
    }
}

static uint64_t all_rays(const whit_stats *s)
{
    return whit_stats_rays(s);
}

static void check_steps(uint32_t spacing, uint32_t samples, uint32_t ray_capacity)
{
    whit_renderer_params params = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .depth = 3,
                                   .light_samples = 4,
                                   .sampling.count = samples};
    assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
    own_picture all = render_picture(&f);
    f.renderer->params.step = look_at_step;
    f.renderer->params.progress_user = &all;
    params.step_spacing = spacing;
    steps = spacing == 8 ? 0 : spacing == 4 ? 1 : 2;
    steps_wrong = 0;
    assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
    if (ray_capacity)
        f.renderer->picture.buffers.queues.ray_capacity = ray_capacity;
    const struct pixel_buffers *p = &f.renderer->picture.buffers;
    assert_int_equal(buffer_write(p->pixels, 0, parts, sizeof *parts), WHIT_OK);
    assert_int_equal(buffer_write(p->ids, 0, parts, sizeof *parts / 2), WHIT_OK);
    own_picture stepped = render_picture(&f);
    assert_int_equal(steps_wrong, 0);
    assert_int_equal(steps, 3);
    assert_memory_equal(stepped.color.pixels, all.color.pixels, FLOATS * sizeof(float));
    assert_memory_equal(stepped.ids.words, all.ids.words, WIDTH * HEIGHT * 2 * sizeof(uint32_t));
    assert_int_equal(all_rays(&stepped.stats), all_rays(&all.stats));
    f.renderer->params.step = NULL;
}

TEST(steps_draw_each_pixel_once)
{
    check_steps(8, 1, 0);
    check_steps(4, 1, 0);
    check_steps(2, 4, 0);
    check_steps(8, 1, 640);
}

TEST(other_steps_are_refused)
{
    whit_log silent = {.level = WHIT_LOG_ERROR};
    for (uint32_t spacing = 0; spacing <= 16; ++spacing) {
        whit_renderer_params params = {.step_spacing = spacing};
        bool right = spacing == 0 || spacing == 2 || spacing == 4 || spacing == 8;
        assert_int_equal(params_check(&silent, &params), right ? WHIT_OK : WHIT_ERROR_USAGE);
    }
}

/* A picture of which one buffer of the device can hold a single sample, but not the sums of more
   samples too. */
TEST(large_pictures_have_room_for_sums)
{
    const whit_renderer_params params = {.width = 4096, .height = 2048, .sampling.count = 4096};
    const struct pixel_buffers *p = &f.renderer->picture.buffers;
    assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
    uint64_t limit = device_get_info(f.device)->max_storage_range_bytes;
    assert_int_equal(p->levels, 12);
    assert_true(p->band_rows > 0 && p->band_rows % 8 == 0);
    assert_true(buffer_size(p->pixels) <= limit);
    assert_true(p->band_rows == params.height || limit == UINT64_C(4096) * 2048 * 16);
}

TEST(other_samples_are_refused)
{
    static const whit_renderer_params wrong[] = {{.sampling.count = 4097},
                                                 {.sampling.count = 16384},
                                                 {.sampling.count = ~0u},
                                                 {.light_samples = 256},
                                                 {.light_samples = 2},
                                                 {.sampling.count = 4, .sampling.first = 2},
                                                 {.sampling.count = 4, .sampling.first = 4096}};
    whit_log silent = {.level = WHIT_LOG_ERROR};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        whit_renderer_params params = wrong[i];
        assert_int_equal(params_check(&silent, &params), WHIT_ERROR_USAGE);
    }
    for (uint32_t n = 1; n <= WHIT_SAMPLES_MAX; ++n) {
        whit_renderer_params params = {.sampling.count = n,
                                       .sampling.first = (WHIT_SAMPLES_MAX / n - 1) * n};
        assert_int_equal(params_check(&silent, &params), WHIT_OK);
    }
}

TESTS_IN(open_scene, close_scene)
