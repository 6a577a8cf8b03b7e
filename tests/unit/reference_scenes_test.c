/* The reference in double beside the pictures of the device: every scene of scenes/, and scenes of
   effects that those lack. */
#include <glob.h>

#include "load/load.h"
#include "reference/reference.h"
#include "render_fixture.h"

enum { WIDTH = 64, HEIGHT = 48 };

/* How two pictures of a scene differ. */
struct difference {
    uint64_t pixels, over, other_ids;
    uint64_t over_with_same_ids;
    double largest, largest_same; /* largest_same: of pixels with the same ids */
};

static double channel_difference(const float *a, const float *b)
{
    double most = 0.0;
    for (int c = 0; c < 3; ++c)
        most = fmax(most, fabs((double)a[c] - (double)b[c]));
    return most;
}

static struct difference compare(const struct image *color_a, const struct image *ids_a,
                                 const struct image *color_b, const struct image *ids_b,
                                 double tolerance)
{
    struct difference d = {.pixels = (uint64_t)color_a->width * color_a->height};
    assert_int_equal(color_a->width, color_b->width);
    assert_int_equal(color_a->height, color_b->height);
    for (size_t i = 0; i < d.pixels; ++i) {
        double most = channel_difference(&color_a->pixels[4 * i], &color_b->pixels[4 * i]);
        bool same = memcmp(&ids_a->words[2 * i], &ids_b->words[2 * i], 8) == 0;
        d.other_ids += !same;
        d.over += most > tolerance;
        d.over_with_same_ids += same && most > tolerance;
        d.largest = fmax(d.largest, most);
        if (same)
            d.largest_same = fmax(d.largest_same, most);
    }
    return d;
}

static void draw_device(struct device *device, struct accel *accel,
                        const struct render_params *params, struct image *color, struct image *ids)
{
    struct renderer *renderer = NULL;
    assert_int_equal(renderer_create(&fixture_log, device, accel, params, &renderer), WHIT_OK);
    assert_int_equal(renderer_render(renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(renderer, color), WHIT_OK);
    assert_int_equal(renderer_read_ids(renderer, ids), WHIT_OK);
    renderer_destroy(renderer);
}

static void draw_reference(struct accel *accel, const struct reference_params *params,
                           struct image *color, struct image *ids, struct reference_stats *stats)
{
    struct reference *reference = NULL;
    assert_int_equal(reference_create(&fixture_log, accel, params, &reference), WHIT_OK);
    assert_int_equal(reference_render(reference, color, ids, stats), WHIT_OK);
    reference_destroy(reference);
}

static struct difference compare_scene(struct device *device, struct scene *scene, const char *name,
                                       const struct render_params *picture, bool whole_stops)
{
    struct accel *accel = NULL;
    struct image device_color = {0}, device_ids = {0}, color = {0}, ids = {0};
    struct reference_stats stats;
    const struct reference_params params = {.picture = *picture, .whole_stops = whole_stops};
    assert_int_equal(accel_create(&fixture_log, scene, NULL, &accel), WHIT_OK);
    draw_device(device, accel, picture, &device_color, &device_ids);
    draw_reference(accel, &params, &color, &ids, &stats);
    struct difference d = compare(&device_color, &device_ids, &color, &ids, 1e-3);
    print_message(
        "  %-20s %2llu of %llu pixels over 1e-3 (%llu with the same ids), other ids %llu, "
        "largest %.2g (%.2g), %.0f ms\n",
        name, (unsigned long long)d.over, (unsigned long long)d.pixels,
        (unsigned long long)d.over_with_same_ids, (unsigned long long)d.other_ids, d.largest,
        d.largest_same, stats.render_ms);
    assert_int_equal(stats.non_finite, 0);
    image_finish(&device_color);
    image_finish(&device_ids);
    image_finish(&color);
    image_finish(&ids);
    accel_destroy(accel);
    return d;
}

/* Most of the time goes into compiling a kernel for each: these call for the most effects. */
static const char *const quick_scenes[] = {"balls.json",  "default.json", "glass-of-water.json",
                                           "layers.json", "many.json",    "room.json",
                                           "whitted.json"};

static bool is_wanted(const char *name)
{
    bool wanted = getenv("WHIT_TEST_ALL_SCENES") != NULL;
    for (size_t i = 0; i < sizeof quick_scenes / sizeof *quick_scenes; ++i)
        wanted |= strcmp(quick_scenes[i], name) == 0;
    return wanted;
}

static void default_scenes_agree(void **state)
{
    (void)state;
    const struct render_params picture = {.width = WIDTH, .height = HEIGHT, .depth = 6};
    const struct load_params load = {.time_limit_s = 60.0};
    glob_t paths;
    struct device *device = NULL;
    size_t compared = 0;
    assert_int_equal(glob(WHIT_SCENES_DIR "/*.json", 0, NULL, &paths), 0);
    assert_int_equal(device_create(&fixture_log, NULL, &device), WHIT_OK);
    for (size_t i = 0; i < paths.gl_pathc; ++i) {
        const char *name = strrchr(paths.gl_pathv[i], '/') + 1;
        struct scene *scene = NULL;
        if (!is_wanted(name))
            continue;
        assert_int_equal(load_scene(&fixture_log, paths.gl_pathv[i], &load, &scene), WHIT_OK);
        struct difference d = compare_scene(device, scene, name, &picture, true);
        assert_true(d.over * 100 <= d.pixels);
        scene_destroy(scene);
        ++compared;
    }
    assert_true(compared >= sizeof quick_scenes / sizeof *quick_scenes);
    assert_int_equal(device_validation_messages(device), 0);
    device_destroy(device);
    globfree(&paths);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(default_scenes_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
