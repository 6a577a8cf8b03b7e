/* Compares the device with the reference in double, for the scenes of scenes/. Pixels that differ
   must be at edges, where rounding may decide the other way. */
#include <glob.h>

#include "load/load.h"
#include "reference_fixture.h"
#include "unit.h"

enum { WIDTH = 64, HEIGHT = 48 };

/* The difference of the device's picture of a scene from the reference. */
struct compared {
    uint32_t over;      /* pixels further than 1e-3 apart in some channel */
    uint32_t other_ids; /* pixels whose first hit is another primitive */
    uint32_t edges;     /* pixels of `over` that are at edges: see is_at_edge */
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
    struct rays rays = reference_rays(reference, x, y, 0);
    color[0] = color[1] = color[2] = 0.0;
    for (uint32_t i = 0; i < rays.count; ++i) {
        for (int c = 0; c < 3; ++c)
            color[c] += rays.all[i].radiance[c];
    }
    free(rays.all);
}

/* References whose camera is moved aside by some roundings of floats: so large is the error with
   which rays of the device may start. Mirrors and glass magnify it. */
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

/* Whether the reference itself changes by at least a quarter of the difference if the camera moves
   so little: then the pixel shows an edge, directly or in a mirror or a lens, or the outline of a
   shadow. */
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

static struct compared compare(const struct moved *moved, const struct picture *device,
                               const struct picture *reference)
{
    struct compared d = {.other_ids = pixels_unlike(&device->ids, &reference->ids)};
    for (uint32_t i = 0; i < WIDTH * HEIGHT; ++i) {
        const float *a = &device->color.pixels[4 * (size_t)i];
        const float *b = &reference->color.pixels[4 * (size_t)i];
        double max =
            channel_difference((const double[]){(double)a[0], (double)a[1], (double)a[2]}, b);
        d.largest = fmax(d.largest, max);
        if (!(max <= 1e-3)) {
            ++d.over;
            d.edges += is_at_edge(moved, i % WIDTH, i / WIDTH, b, max);
        }
    }
    return d;
}

static struct compared compare_scene(struct scene *scene, const char *name)
{
    const struct reference_params params = {
        .picture = {.width = WIDTH, .height = HEIGHT, .depth = 6}, .whole_stops = true};
    own_fixture f = fixture_open(scene, &(whit_accel_params){0}, &params.picture);
    own_picture device = render_picture(&f), reference = reference_picture(f.accel, &params);
    struct moved moved = move_camera(f.accel, &params);
    struct compared d = compare(&moved, &device, &reference);
    print_message("  %-20s %2u of %u pixels over 1e-3, %u of them at edges; %u other ids; largest "
                  "%.2g; reference %.0f ms\n",
                  name, d.over, WIDTH * HEIGHT, d.edges, d.other_ids, d.largest,
                  reference.stats.render_ms);
    for (int i = 0; i < MOVES; ++i)
        reference_destroy(moved.all[i]);
    return d;
}

/* The scenes of a short run: those that call for the most effects. Most of the time is spent in
   compiling a kernel for each scene. */
static const char *const quick_scenes[] = {"balls.json", "default.json", "glass-of-water.json",
                                           "many.json", "room.json"};

static bool is_wanted(const char *name)
{
    bool wanted = getenv("WHIT_TEST_ALL_SCENES") != NULL;
    for (size_t i = 0; i < sizeof quick_scenes / sizeof *quick_scenes; ++i)
        wanted |= strcmp(quick_scenes[i], name) == 0;
    return wanted;
}

TEST(default_scenes_agree)
{
    const whit_load_params load = {.import_limit_s = 60.0};
    glob_t paths;
    size_t compared = 0;
    assert_int_equal(glob(WHIT_SCENES_DIR "/*.json", 0, NULL, &paths), 0);
    for (size_t i = 0; i < paths.gl_pathc; ++i) {
        const char *name = strrchr(paths.gl_pathv[i], '/') + 1;
        struct scene *scene = NULL;
        if (!is_wanted(name))
            continue;
        assert_int_equal(load_scene(&fixture_log, paths.gl_pathv[i], &load, &scene), WHIT_OK);
        struct compared d = compare_scene(scene, name);
        assert_true(d.over * 100 <= WIDTH * HEIGHT);
        assert_int_equal(d.edges, d.over);
        ++compared;
    }
    assert_true(compared >= sizeof quick_scenes / sizeof *quick_scenes);
    globfree(&paths);
}
