/* Adaptive anti-aliasing: every pixel is that of the picture of 1, 4, 16 or 64 samples, bit for
   bit, by the rule of docs/effects.md. This file has a second, simple implementation of the rule.
 */
#include "render/adaptive_samples.h"
#include "render_scenes.h"
#include "unit.h"

enum { WIDTH = 29, HEIGHT = 19, PIXELS = WIDTH * HEIGHT };

static float clamped(float x)
{
    return fminf(fmaxf(x, 0.0f), 1.0f);
}

static bool differs(const float *pixels, int x, int y, float contrast)
{
    const float *own = &pixels[4 * (y * WIDTH + x)];
    for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
            if (u < 0 || v < 0 || u >= WIDTH || v >= HEIGHT)
                continue;
            const float *other = &pixels[4 * (v * WIDTH + u)];
            for (int c = 0; c < 3; ++c) {
                if (fabsf(clamped(own[c]) - clamped(other[c])) > contrast)
                    return true;
            }
        }
    }
    return false;
}

/* The expected picture. `min`, `max`: limits of the numbers of other rays than camera rays: at
   least those of the first pass; at most those of each level that has pixels, for all pixels. */
struct expected {
    float pixels[PIXELS][4];
    uint64_t by_samples[4], primary;
    whit_stats min, max;
};

static void add_rays(whit_stats *sum, const whit_stats *rays)
{
    sum->rays_shadow += rays->rays_shadow;
    sum->rays_reflected += rays->rays_reflected;
    sum->rays_refracted += rays->rays_refracted;
}

static void check_between(uint64_t min, uint64_t rays, uint64_t max)
{
    assert_true(min <= rays && rays <= max);
}

/* Makes the expected picture from those of 1, 4, 16 and 64 samples: `first` and `last` are the
   indices of the least and the most. */
static void expect(const struct picture plain[4], uint32_t first, uint32_t last, float contrast,
                   struct expected *e)
{
    uint32_t level_of[PIXELS];
    memset(e, 0, sizeof *e);
    memcpy(e->pixels, plain[first].color.pixels, sizeof e->pixels);
    for (int i = 0; i < PIXELS; ++i)
        level_of[i] = first;
    e->primary = (1u << (2 * first)) * PIXELS;
    e->min = e->max = plain[first].stats;
    for (uint32_t level = first + 1; level <= last; ++level) {
        bool marked[PIXELS], some = false;
        for (int i = 0; i < PIXELS; ++i)
            marked[i] = differs(&e->pixels[0][0], i % WIDTH, i / WIDTH, contrast);
        for (int i = 0; i < PIXELS; ++i) {
            if (!marked[i])
                continue;
            level_of[i] = level;
            memcpy(e->pixels[i], &plain[level].color.pixels[4 * i], sizeof e->pixels[i]);
            e->primary += 1u << (2 * level);
            some = true;
        }
        if (some)
            add_rays(&e->max, &plain[level].stats);
    }
    for (int i = 0; i < PIXELS; ++i)
        ++e->by_samples[level_of[i]];
}

static void check(struct fixture *f, const struct picture *first, const struct expected *e)
{
    own_picture p = render_picture(f);
    assert_memory_equal(p.color.pixels, e->pixels, sizeof e->pixels);
    assert_same_image("ids", &p.ids, &first->ids);
    assert_memory_equal(p.stats.pixels_by_samples, e->by_samples, sizeof e->by_samples);
    assert_true(p.stats.rays_primary == e->primary);
    check_between(e->min.rays_shadow, p.stats.rays_shadow, e->max.rays_shadow);
    check_between(e->min.rays_reflected, p.stats.rays_reflected, e->max.rays_reflected);
    check_between(e->min.rays_refracted, p.stats.rays_refracted, e->max.rays_refracted);
}

/* 1: nothing differs by more, so all pixels keep 4. */
static const double contrasts[] = {0.05, 1.0};

/* Draws pictures of 1, 4, 16 and 64 samples, and compares them with adaptive ones in tiles and
   bands of several sizes. The first contrast is tried with other limits of samples too. */
static void check_scene(struct scene *scene, const whit_accel_params *accel,
                        const whit_camera *camera, int contrast_count)
{
    whit_renderer_params params = {.width = WIDTH, .height = HEIGHT, .depth = 3, .camera = *camera};
    static struct expected e;
    struct picture plain[4];
    own_fixture f = fixture_open(scene, accel, &params);
    for (int i = 0; i < 4; ++i) {
        params.sampling.count = 1u << (2 * i);
        fixture_renew(&f, &params);
        plain[i] = render_picture(&f);
        assert_int_equal(plain[i].stats.pixels_by_samples[i], PIXELS);
    }
    static const uint32_t limits[][2] = {{0, 1}, {0, 3}, {2, 3}, {1, 2}};
    for (int i = 0; i < 4; ++i) {
        params.sampling = (whit_sampling){.kind = WHIT_SAMPLING_ADAPTIVE,
                                          .count = 1u << (2 * limits[i][0]),
                                          .count_max = 1u << (2 * limits[i][1]),
                                          .contrast = contrasts[0]};
        expect(plain, limits[i][0], limits[i][1], (float)contrasts[0], &e);
        assert_true(e.by_samples[limits[i][0]] > 0 && e.by_samples[limits[i][1]] > 0);
        assert_int_equal(renderer_set_view(f.renderer, &params), WHIT_OK);
        check(&f, &plain[limits[i][0]], &e);
    }
    for (int i = 0; i < contrast_count; ++i) {
        params.sampling = (whit_sampling){.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = contrasts[i]};
        expect(plain, 1, 3, (float)contrasts[i], &e);
        print_message("  contrast %g: %u, %u and %u pixels of 4, 16 and 64\n", contrasts[i],
                      (unsigned)e.by_samples[1], (unsigned)e.by_samples[2],
                      (unsigned)e.by_samples[3]);
        /* The last one has short queues, and halves its tiles. Their size is given, as by itself it
           depends on time. */
        const uint32_t tiles[] = {0, 16, 64}, bands[] = {0, 8, 0}, rays[] = {0, 0, 640};
        for (int k = 0; k < (i == 0 ? 3 : 1); ++k) {
            params.tile_size = tiles[k];
            fixture_renew(&f, &params);
            struct pixel_buffers *p = &f.renderer->picture.buffers;
            p->band_rows = bands[k] ? bands[k] : p->band_rows;
            p->queues.ray_capacity = rays[k] ? rays[k] : p->queues.ray_capacity;
            check(&f, &plain[1], &e);
            bool full = rays[k] > 0 && f.renderer->has_secondary;
            assert_int_equal(f.renderer->picture.stages.blocks_max > 0, full);
        }
        params.tile_size = 0;
    }
    for (int i = 0; i < 4; ++i)
        picture_finish(&plain[i]);
}

TEST(pixels_are_those_of_plain_pictures)
{
    check_scene(glass_scene(), NULL, &glass_camera, 2);
}

TEST_BY_TURNS(so_they_are_without_trees, 0, 2)
{
    const whit_accel_params no_trees = {.build = WHIT_BUILD_NONE};
    check_scene(glass_scene_of(1, 3), &no_trees, &glass_camera, 1);
}

TEST_BY_TURNS(lens_and_plain_scenes_too, 1, 2)
{
    struct scene *scene = terrain_scene();
    scene_put_camera(scene, (double[]){0, 4, 9}, (double[]){0, 0, 0}, 0.7);
    scene->cameras[0].lens_radius = 0.4f;
    check_scene(scene, NULL, &(whit_camera){.name = NULL}, 1);
}

TEST(marks_come_in_pairs)
{
    own_image image = {0};
    uint8_t levels[12];
    assert_int_equal(image_init(&image, 4, 3, 4, false), WHIT_OK);
    memset(levels, 1, sizeof levels);
    image.pixels[4 * 5 + 1] = 7.0f; /* green of (1, 1) shows as 1 */
    image.pixels[4 * 7 + 3] = 9.0f; /* alpha is not looked at */
    assert_true(adaptive_mark(&image, 1.0, 2, levels) == 0);
    assert_true(adaptive_mark(&image, 0.999, 2, levels) == 9);
    const uint8_t expected[12] = {2, 2, 2, 1, 2, 2, 2, 1, 2, 2, 2, 1};
    assert_memory_equal(levels, expected, sizeof levels);
}

static bool stop_now;
static double last_done;
static uint32_t calls, backwards;

static void watch(void *user, double done)
{
    backwards += done < last_done;
    last_done = done;
    if (user && ++calls == *(const uint32_t *)user)
        stop_now = true;
}

TEST(progress_goes_on_to_the_end)
{
    whit_renderer_params params = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .depth = 3,
                                   .camera = GLASS_CAMERA,
                                   .sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.05},
                                   .progress = watch,
                                   .tile_size = 16};
    last_done = 0.0;
    own_fixture f = fixture_open(glass_scene(), NULL, &params);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    assert_int_equal(backwards, 0);
    assert_true(last_done > 0.999 && last_done < 1.001);
    /* The picture is cancelled in the pass of 64 samples, and then drawn as a whole. */
    uint32_t stop_at = 4 * 3 + 20;
    params.cancel = &stop_now;
    params.progress_user = &stop_at;
    fixture_renew(&f, &params);
    last_done = 0.0;
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_CANCELLED);
    assert_true(last_done > 0.6 && last_done < 0.9);
    stop_now = false;
    last_done = 0.0;
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
}

TEST(nonsense_is_refused)
{
    const whit_renderer_params wrong[] = {
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE + 1, .contrast = 0.5}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.5, .first = 4}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = -0.5}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 1.5}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = NAN}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.5, .count = 2}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.5, .count = 64}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.5, .count_max = 8}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.5, .count_max = 256}},
        {.sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1}, .count = true}};
    own_fixture f = fixture_open(terrain_scene(), NULL, NULL);
    fixture_refuses(&f, wrong, sizeof wrong / sizeof *wrong);
}
