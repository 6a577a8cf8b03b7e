/* The reference in double beside the pictures of the device, of the scenes of scenes/. Pixels that
   differ must be at edges, where floats may tell another side. */
#include <glob.h>

#include "load/load.h"
#include "reference/reference.h"
#include "render_fixture.h"

enum { WIDTH = 64, HEIGHT = 48 };

/* How the device's picture of a scene differs from the reference. */
struct difference {
    uint32_t over;      /* pixels further than 1e-3 apart in some channel */
    uint32_t other_ids; /* whose first hit is another primitive */
    uint32_t edges;     /* of those over: see is_at_edge */
    double largest;
};

static double channel_difference(const double a[3], const float *b)
{
    double max = 0.0;
    for (int c = 0; c < 3; ++c)
        max = fmax(max, fabs(a[c] - (double)b[c]));
    return max;
}

static void pixel_color(const struct reference *reference, uint32_t x, uint32_t y, double color[3])
{
    struct reference_ray *rays = NULL;
    uint32_t count = 0;
    color[0] = color[1] = color[2] = 0.0;
    assert_int_equal(reference_ray_tree(reference, x, y, 0, &rays, &count), WHIT_OK);
    for (uint32_t i = 0; i < count; ++i) {
        for (int c = 0; c < 3; ++c)
            color[c] += rays[i].radiance[c];
    }
    free(rays);
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

/* References whose camera stands some roundings of floats aside: what the device's rays may be off
   by when they start. Mirrors and glass make more of it. */
enum { MOVES = 6 };

struct moved {
    struct reference *all[MOVES];
};

static struct moved move_camera(struct accel *accel, const struct reference_params *params)
{
    struct scene_camera *camera = &((struct scene *)accel->scene)->cameras[0];
    const struct scene_camera kept = *camera;
    struct moved moved;
    double away = 0.0;
    for (int k = 0; k < 3; ++k)
        away = fmax(away, fabs(kept.eye[k] - kept.target[k]) + fabs(kept.eye[k]));
    for (int i = 0; i < MOVES; ++i) {
        double step = (i & 1 ? -0x1p-21 : 0x1p-21) * away;
        camera->eye[i / 2] += step;
        camera->target[i / 2] += step;
        assert_int_equal(reference_create(&fixture_log, accel, params, &moved.all[i]), WHIT_OK);
        *camera = kept;
    }
    return moved;
}

/* The reference itself changes by as much, or a quarter of it, for so little: the pixel looks at an
   edge, in itself or in a mirror, a lens or the outline of a shadow. */
static bool is_at_edge(const struct moved *moved, uint32_t x, uint32_t y, const float *reference,
                       double difference)
{
    for (int i = 0; i < MOVES; ++i) {
        double color[3];
        pixel_color(moved->all[i], x, y, color);
        if (channel_difference(color, reference) >= 0.25 * difference)
            return true;
    }
    return false;
}

static struct difference compare(const struct moved *moved, const struct image device[2],
                                 const struct image reference[2])
{
    struct difference d = {0};
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
        const float *a = &device[0].pixels[4 * (size_t)i], *b = &reference[0].pixels[4 * (size_t)i];
        const double color[3] = {(double)a[0], (double)a[1], (double)a[2]};
        double max = channel_difference(color, b);
        d.other_ids += memcmp(&device[1].words[2 * i], &reference[1].words[2 * i], 8) != 0;
        d.largest = fmax(d.largest, max);
        if (!(max <= 1e-3)) {
            ++d.over;
            d.edges += is_at_edge(moved, i % WIDTH, i / WIDTH, b, max);
        }
    }
    return d;
}

static struct difference compare_scene(struct device *device, struct scene *scene, const char *name)
{
    struct accel *accel = NULL;
    struct image by_device[2] = {{0}, {0}}, by_reference[2] = {{0}, {0}};
    struct reference_stats stats;
    const struct reference_params params = {
        .picture = {.width = WIDTH, .height = HEIGHT, .depth = 6}, .whole_stops = true};
    assert_int_equal(accel_create(&fixture_log, scene, NULL, &accel), WHIT_OK);
    draw_device(device, accel, &params.picture, &by_device[0], &by_device[1]);
    draw_reference(accel, &params, &by_reference[0], &by_reference[1], &stats);
    struct moved moved = move_camera(accel, &params);
    struct difference d = compare(&moved, by_device, by_reference);
    print_message("  %-20s %2u of %u pixels over 1e-3, %u of them at edges; %u other ids; largest "
                  "%.2g; reference %.0f ms\n",
                  name, d.over, WIDTH * HEIGHT, d.edges, d.other_ids, d.largest, stats.render_ms);
    assert_int_equal(stats.non_finite, 0);
    for (int i = 0; i < MOVES; ++i)
        reference_destroy(moved.all[i]);
    for (int i = 0; i < 2; ++i) {
        image_finish(&by_device[i]);
        image_finish(&by_reference[i]);
    }
    accel_destroy(accel);
    return d;
}

/* Most of the time goes into compiling a kernel for each: these call for the most effects. */
static const char *const quick_scenes[] = {"balls.json", "default.json", "glass-of-water.json",
                                           "many.json", "room.json"};

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
    const struct load_params load = {.foreign.cpu_s = 60.0};
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
        struct difference d = compare_scene(device, scene, name);
        assert_true(d.over * 100 <= WIDTH * HEIGHT);
        assert_int_equal(d.edges, d.over);
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
