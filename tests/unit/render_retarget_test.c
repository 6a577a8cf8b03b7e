/* A renderer draws several views in turn: each picture is, byte for byte, that of a renderer made
   for it. */
#include "../wrapped.h"
#include "device/buffer.h"
#include "render/renderer.h"
#include "render_scenes.h"
#include "unit.h"

#define ASIDE CAMERA_AT(3, 2.5, 4, 0, 0.6, 0, 0, 1, 0, 35)

/* Whether the device has no memory for buffers of pixels and queues. */
static bool no_room;

WRAPPED(whit_result, buffer_create_all, struct device *device, const struct buffer_request *all,
        size_t count, uint64_t *bytes)
{
    return no_room ? WHIT_ERROR_MEMORY : __real_buffer_create_all(device, all, count, bytes);
}

/* Every step changes something else: size, samples, camera, limits, and back. */
static const whit_renderer_params steps[] = {
    {.width = 20, .height = 16, .depth = 4},
    {.width = 12, .height = 20, .depth = 4},
    {.width = 12, .height = 20, .depth = 4, .camera = ASIDE},
    {.width = 12, .height = 20, .depth = 4, .camera = ASIDE, .sampling.count = 4},
    {.width = 31, .height = 17, .depth = 9, .sampling.count = 1},
    {.width = 31, .height = 17, .depth = 0},
    {.width = 31, .height = 17, .depth = 2, .light_samples = 4},
    {.width = 20,
     .height = 16,
     .depth = 4,
     .sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1}},
    {.width = 16,
     .height = 16,
     .depth = 4,
     .sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1},
     .time_s = 0.7},
    {.width = 20, .height = 16, .depth = 4},
};
enum { STEPS = sizeof steps / sizeof *steps };

static void check_same(const struct fixture *f, const char *name,
                       const whit_renderer_params *params)
{
    whit_renderer_params own = *params;
    own.packets = WHIT_PACKETS_OFF; /* else it would depend on the size that it was made with */
    own_picture picture = render_picture(f);
    own_renderer fresh = fixture_beside(f, &own);
    own_picture expected = render_picture(&fresh);
    assert_int_equal(picture.color.width, params->width);
    assert_int_equal(picture.color.height, params->height);
    assert_same_picture(name, &picture, &expected);
    assert_int_equal(picture.stats.device_bytes, expected.stats.device_bytes);
}

static void walk(const char *name, const whit_accel_params *accel, int count)
{
    own_fixture f = fixture_open(file_scene(name), accel, &steps[0]);
    for (int i = 0; i < count; ++i) {
        assert_int_equal(renderer_set_view(f.renderer, &steps[i]), WHIT_OK);
        check_same(&f, name, &steps[i]);
    }
    print_message("  %s: 0 of %d views differ\n", name, count);
}

TEST(views_are_those_of_new_renderers)
{
    walk("spin", NULL, STEPS);
    walk("whitted", NULL, STEPS);
    walk("cube", &(whit_accel_params){.build = WHIT_BUILD_NONE}, 3);
}

/* Seen from afar, a ray may meet the glass and its hollow at one place, but for rounding. */
TEST_BY_TURNS(media_touch_for_cameras_far_away, 0, 2)
{
    whit_renderer_params far_away = steps[0];
    far_away.camera = (whit_camera)CAMERA_AT(0.6, 2.35, 900, 0.42, 1.62, 0, 0, 1, 0, 0.3);
    own_fixture f = fixture_open(file_scene("whitted"), NULL, &steps[0]);
    assert_false(media_touch(f.renderer->scene, &f.renderer->bodies, &f.renderer->frame));
    assert_int_equal(renderer_set_view(f.renderer, &far_away), WHIT_OK);
    assert_true(media_touch(f.renderer->scene, &f.renderer->bodies, &f.renderer->frame));
    check_same(&f, "far away", &far_away);
    assert_int_equal(renderer_set_view(f.renderer, &steps[0]), WHIT_OK);
    assert_false(media_touch(f.renderer->scene, &f.renderer->bodies, &f.renderer->frame));
    check_same(&f, "near", &steps[0]);
}

/* A new size must keep what the kernels of ray batches are bound to. */
TEST_BY_TURNS(rays_are_traced_in_between, 1, 2)
{
    own_fixture f = fixture_open(file_scene("cube"), NULL, &steps[0]);
    const struct gpu_ray ray = {.origin = {3, 2.5f, 4}, .dir = {-3, -2, -4}, .t_max = INFINITY};
    struct gpu_hit before = {0}, after = {0};
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &before, NULL), WHIT_OK);
    assert_int_equal(renderer_set_view(f.renderer, &steps[4]), WHIT_OK);
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &after, NULL), WHIT_OK);
    assert_memory_equal(&before, &after, sizeof before);
    assert_int_not_equal(before.primitive, HIT_NONE);
}

TEST(nonsense_is_refused)
{
    own_fixture f = fixture_open(file_scene("cube"), NULL, &steps[0]);
    whit_renderer_params wrong = steps[0];
    wrong.camera = (whit_camera){.name = "no such camera"};
    const struct gpu_ray ray = {.dir = {0, 0, 1}, .t_max = INFINITY};
    struct gpu_hit hit;
    assert_int_equal(renderer_set_view(f.renderer, &wrong), WHIT_ERROR_USAGE);
    check_same(&f, "after a wrong camera", &steps[0]);
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_OK);
    wrong.time_s = 0.7;
    assert_int_equal(renderer_set_view(f.renderer, &wrong), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_trace(f.renderer, &ray, 1, false, &hit, NULL), WHIT_ERROR_USAGE);
    wrong = steps[0];
    wrong.sampling.count = 4097;
    assert_int_equal(renderer_set_view(f.renderer, &wrong), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_set_view(f.renderer, &steps[1]), WHIT_OK);
    check_same(&f, "after nonsense", &steps[1]);
}

/* Nothing of what a failed call has already changed may be missing from the next one, even if that
   asks for the same view. */
TEST(a_view_that_failed_is_set_as_a_whole)
{
    const whit_renderer_params *before = &steps[5], *view = &steps[8];
    own_fixture f = fixture_open(file_scene("spin"), NULL, before);
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
    for (int moves = 0; moves < 2; ++moves) {
        no_room = true;
        assert_int_equal(renderer_set_view(f.renderer, moves ? before : view), WHIT_ERROR_MEMORY);
        no_room = false;
        if (moves)
            assert_int_equal(renderer_set_time(f.renderer, view->time_s), WHIT_OK);
        assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_USAGE);
        assert_int_equal(renderer_set_view(f.renderer, view), WHIT_OK);
        check_same(&f, "after an error", view);
    }
}

/* A picture after views needs other buffers. Where there is no room for them, the next call makes
   them. */
TEST(a_picture_after_views_can_be_asked_for_again)
{
    static const whit_camera cameras[2] = {CAMERA_AT(3, 2.5, 4, 0, 0.6, 0, 0, 1, 0, 35),
                                           CAMERA_AT(4, 2.5, 3, 0, 0.6, 0, 0, 1, 0, 35)};
    own_fixture f = fixture_open(file_scene("cube"), NULL, &steps[0]);
    own_image before = render(&f);
    for (int i = 0; i < 2; ++i) {
        assert_int_equal(renderer_render_views(f.renderer, cameras, 2), WHIT_OK);
        no_room = true;
        assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_MEMORY);
        assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_MEMORY);
        no_room = false;
    }
    own_image again = render(&f);
    assert_same_image("after views", &before, &again);
}

/* The rays of one block need larger queues, for which there is no memory in the first picture. */
TEST(queues_that_could_not_grow_are_made_anew)
{
    const whit_renderer_params params = {.width = 32, .height = 24, .depth = 12, .tile_size = 16};
    own_fixture f = fixture_open(file_scene("whitted"), NULL, &params);
    no_room = true;
    assert_int_equal(renderer_render(f.renderer), WHIT_ERROR_MEMORY);
    no_room = false;
    check_same(&f, "after queues", &params);
}

/* Whether a renderer uses few kernels follows from the picture for which it was made, and a larger
   view does not change it. */
TEST(a_larger_view_keeps_the_kernels)
{
    const whit_renderer_params small = {.width = 20, .height = 16, .depth = 4};
    const whit_renderer_params large = {.width = 600, .height = 300, .depth = 4};
    own_fixture f = fixture_open(file_scene("whitted"), NULL, &small);
    assert_true(f.renderer->few_kernels && render_few_kernels(&small));
    assert_false(render_few_kernels(&large));
    own_picture before = render_picture(&f);
    assert_int_equal(renderer_set_view(f.renderer, &large), WHIT_OK);
    own_picture after = render_picture(&f);
    assert_true(f.renderer->few_kernels);
    assert_int_equal(after.stats.kernel_instructions, before.stats.kernel_instructions);
}
