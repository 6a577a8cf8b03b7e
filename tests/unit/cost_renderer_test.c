/* Small pictures that `whit cost` times have the kernels of the full size, for which it gives their
   times. */
#include "scene_fixture.h"

#include "cost/row.h"

enum { WIDTH = 1280, HEIGHT = 720 };

/* What a renderer has chosen by the size that it was made for, after a picture of another one. */
static whit_stats draw_small(whit_renderer *renderer)
{
    const whit_renderer_params small = params_sized(32, 18, NULL);
    whit_stats stats;
    assert_int_equal(whit_renderer_set_view(renderer, &small), WHIT_OK);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    whit_renderer_get_stats(renderer, &stats);
    return stats;
}

static void check(const char *name)
{
    const whit_renderer_params full = params_sized(WIDTH, HEIGHT, NULL);
    const whit_renderer_params small = params_sized(32, 18, NULL);
    const struct settings usual = settings_usual();
    struct cost_report report = {.width = WIDTH, .height = HEIGHT};
    char path[256];
    snprintf(path, sizeof path, WHIT_SCENES_DIR "/%s.json", name);
    scene_open(path);
    const struct cost_request request = {
        .device = device, .scene = scene, .accel = accel, .settings = &usual};
    const struct measure measure = {.request = &request, .report = &report};
    whit_renderer *measured = NULL, *other[2] = {renderer_of(&full), renderer_of(&small)};
    assert_int_equal(measure_renderer(&measure, &usual, accel, &measured), WHIT_OK);
    const whit_stats stats = draw_small(measured);
    const whit_stats wanted = draw_small(other[0]), unlike = draw_small(other[1]);
    assert_int_equal(stats.packets, wanted.packets);
    assert_int_equal(stats.kernel_instructions, wanted.kernel_instructions);
    assert_int_not_equal(stats.kernel_instructions, unlike.kernel_instructions);
    whit_renderer_destroy(measured);
    for (size_t i = 0; i < 2; ++i)
        whit_renderer_destroy(other[i]);
    scene_close();
}

TEST(timed_pictures_have_the_packets_of_the_full_size)
{
    check("34k");
}

TEST(timed_pictures_have_the_classes_of_the_full_size)
{
    check("whitted");
}

TESTS_IN(device_begin, device_end)
