/* Views of many cameras drawn together: each is the picture of its camera alone, byte for byte. */
#include "../cases.h"
#include "picture/camera.h"
#include "render/readback.h"
#include "render/upload.h"
#include "render_scenes.h"
#include "twin/traverse.h"
#include "unit.h"

enum { MANY = 23, THRONG = 40 };

/* Places cameras around the scene; with `mixed` each is of another kind. */
static void place_cameras(whit_camera *cameras, int count, bool mixed)
{
    for (int i = 0; i < count; ++i) {
        double turn = 6.28318530718 * i / count, far = 4.0 + 0.3 * i;
        cameras[i] = (whit_camera)CAMERA_AT(far * sin(turn), 1.0 + 0.1 * i, far * cos(turn), 0.1,
                                            0.7, -0.2, 0, 1, 0, 30.0 + i);
        cameras[i].lens_radius = mixed && i % 4 == 1 ? 0.2 : 0.0;
        cameras[i].focus_distance = mixed && i % 8 == 1 ? 3.0 : 0.0;
        cameras[i].kind = !mixed || i % 4 < 2 ? WHIT_CAMERA_PERSPECTIVE
                          : i % 4 == 2        ? WHIT_CAMERA_ORTHOGRAPHIC
                                              : WHIT_CAMERA_PANORAMA;
        cameras[i].height = 4.0;
    }
}

/* One view of a picture of several views, as an image that borrows its pixels. */
static struct image view_of(const struct image *all, uint32_t view, uint32_t height)
{
    struct image image = *all;
    size_t first = (size_t)view * height * all->width * all->channels;
    image.height = height;
    image.pixels = all->pixels ? all->pixels + first : NULL;
    image.words = all->words ? all->words + first : NULL;
    return image;
}

/* Asserts that a view of distances has those of the float mirror for each camera ray. */
static void check_distances(const struct fixture *f, const whit_camera *camera,
                            const struct image *view)
{
    const struct renderer *r = f->renderer;
    const struct traverse_params params = {.order = (uint32_t)r->params.traversal,
                                           .numerics = (uint32_t)r->params.numerics};
    bool exact = r->params.numerics == WHIT_NUMERICS_EXACT; /* shading uses the t of floats */
    size_t count = (size_t)view->width * view->height;
    own_memory struct gpu_ray *rays = malloc(count * sizeof *rays);
    assert_non_null(rays);
    assert_int_equal(camera_all_rays(NULL, &r->pose, camera, view->width, view->height, rays),
                     WHIT_OK);
    for (size_t i = 0; i < count; ++i) {
        struct gpu_hit hit;
        uint32_t status = 0;
        traverse_ray(f->accel, &params, &rays[i], &hit, NULL, &status);
        double off =
            fabs((double)hit.t - (double)view->pixels[i]); /* NaN where both are infinite */
        if (hit.t != view->pixels[i] && !(exact && off <= 0x1p-18 * (double)hit.t))
            fail_msg("pixel %zu is %.9g away, not %.9g", i, (double)view->pixels[i], (double)hit.t);
    }
}

/* Compares the views with the pictures of their cameras, which `single` draws. */
static void check_views(const struct fixture *f, const struct fixture *single,
                        const whit_camera *cameras, uint32_t count)
{
    whit_renderer_params params = f->renderer->params;
    own_image color = {0}, ids = {0}, distances = {0};
    assert_int_equal(renderer_render_views(f->renderer, cameras, count), WHIT_OK);
    assert_int_equal(renderer_read_color(f->renderer, &color), WHIT_OK);
    assert_int_equal(renderer_read_ids(f->renderer, &ids), WHIT_OK);
    assert_int_equal(renderer_read_distances(f->renderer, &distances), WHIT_OK);
    assert_int_equal(color.height, count * params.height);
    for (uint32_t i = 0; i < count; ++i) {
        params.camera = cameras[i];
        assert_int_equal(renderer_set_view(single->renderer, &params), WHIT_OK);
        own_picture picture = render_picture(single);
        struct image own_color = view_of(&color, i, params.height),
                     own_ids = view_of(&ids, i, params.height),
                     own_distances = view_of(&distances, i, params.height);
        char what[64];
        snprintf(what, sizeof what, "view %u", i);
        assert_same_image(what, &own_color, &picture.color);
        assert_same_image(what, &own_ids, &picture.ids);
        check_distances(f, &cameras[i], &own_distances);
    }
}

/* The buffers hold only 24 rows, so that pictures are drawn in bands that end within views. */
static void check_bands(const struct fixture *f, const struct fixture *single,
                        const whit_camera *cameras, uint32_t count)
{
    f->renderer->picture.buffers.band_rows = 24;
    assert_false(readback_is_late(f->renderer));
    check_views(f, single, cameras, count);
    assert_int_equal(f->renderer->picture.buffers.band_rows, 24);
}

static void check_scene(const char *name, const whit_renderer_params *params, bool mixed,
                        uint32_t count)
{
    whit_camera cameras[MANY];
    own_fixture f = fixture_open(file_scene(name), NULL, params);
    whit_renderer_params plain = *params;
    plain.packets = WHIT_PACKETS_OFF;
    own_renderer single = fixture_beside(&f, &plain);
    assert_int_equal(f.renderer->packets, params->packets == WHIT_PACKETS_ON);
    place_cameras(cameras, MANY, mixed);
    check_views(&f, &single, cameras, count);
    if (count == MANY)
        check_bands(&f, &single, cameras, count);
    print_message("  %s: 0 of %u views differ\n", name, count);
}

/* Sizes are no multiples of blocks, and tiles have several views and parts of views. The other
   levels of numerics take turns. */
TEST(views_are_the_pictures_of_their_cameras)
{
    check_scene("whitted",
                &(whit_renderer_params){.width = 20,
                                        .height = 13,
                                        .depth = 4,
                                        .sampling.count = 4,
                                        .tile_size = 32,
                                        .packets = WHIT_PACKETS_ON},
                false, MANY);
    if (cases_turn(0, 2))
        check_scene("spin",
                    &(whit_renderer_params){.width = 9,
                                            .height = 16,
                                            .depth = 2,
                                            .time_s = 0.4,
                                            .numerics = WHIT_NUMERICS_FAST},
                    false, MANY);
    if (cases_turn(1, 2))
        check_scene("room",
                    &(whit_renderer_params){
                        .width = 16, .height = 10, .depth = 3, .numerics = WHIT_NUMERICS_EXACT},
                    false, 5);
}

TEST_BY_TURNS(views_of_all_kinds_of_cameras_and_lenses, 0, 2)
{
    check_scene("whitted",
                &(whit_renderer_params){.width = 12,
                                        .height = 9,
                                        .depth = 2,
                                        .sampling.count = 16,
                                        .portable = true,
                                        .tile_size = 16},
                true, MANY);
}

/* Many views together have so many rays that packets and more kernels pay; for one view they do
   not. */
TEST_BY_TURNS(many_views_have_the_kernels_of_a_large_picture, 1, 2)
{
    const whit_renderer_params small = {.width = 64, .height = 64, .depth = 2};
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    whit_camera cameras[THRONG];
    own_fixture f = fixture_open(file_scene("34k"), &flat, &small);
    own_renderer single = fixture_beside(&f, &small);
    assert_true(f.renderer->few_kernels && !f.renderer->packets);
    place_cameras(cameras, THRONG, false);
    check_views(&f, &single, cameras, THRONG);
    assert_false(f.renderer->few_kernels);
    assert_int_equal(f.renderer->packets, upload_can_widen(f.renderer));
}

/* From far away the glass and its hollow may be hit at one place within rounding. Then touching
   surfaces are searched for in all views, also in the last one, which is near. */
TEST_BY_TURNS(media_touch_where_they_do_for_one_view, 0, 2)
{
    const whit_renderer_params small = {.width = 12, .height = 9, .depth = 4};
    const whit_camera cameras[] = {CAMERA_AT(0.6, 2.35, 900, 0.42, 1.62, 0, 0, 1, 0, 0.3),
                                   CAMERA_AT(3, 2.5, 4, 0, 0.6, 0, 0, 1, 0, 35)};
    own_fixture f = fixture_open(file_scene("whitted"), NULL, &small);
    own_renderer single = fixture_beside(&f, &small);
    check_views(&f, &single, cameras, 2);
    assert_true(media_touch(f.renderer->scene, &f.renderer->bodies, &f.renderer->frame));
    assert_false(media_touch(f.renderer->scene, &f.renderer->bodies, &single.renderer->frame));
}

/* Pictures of one camera and of several take turns, and do not change each other. */
TEST_BY_TURNS(pictures_of_one_camera_in_between, 1, 2)
{
    const whit_renderer_params small = {.width = 12, .height = 9, .depth = 2};
    whit_camera cameras[MANY];
    own_fixture f = fixture_open(file_scene("spin"), NULL, &small);
    own_renderer single = fixture_beside(&f, &small);
    place_cameras(cameras, MANY, true);
    own_picture before = render_picture(&f);
    check_views(&f, &single, cameras, 4);
    cameras[6] = (whit_camera)CAMERA_AT(1, 1, 1, 1, 1, 1, 0, 1, 0, 40);
    assert_int_equal(renderer_render_views(f.renderer, cameras, MANY), WHIT_ERROR_USAGE);
    check_views(&f, &single, cameras, 6);
    check_views(&f, &single, cameras, 1);
    own_picture after = render_picture(&f);
    assert_same_picture("one camera", &before, &after);
    struct image distances;
    assert_int_equal(renderer_read_distances(f.renderer, &distances), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_set_time(f.renderer, 0.3), WHIT_OK);
    assert_int_equal(renderer_set_time(single.renderer, 0.3), WHIT_OK);
    check_views(&f, &single, cameras, 3);
}

/* Parameters that are read when a renderer is made are not read again. */
TEST(a_text_of_sliders_may_go)
{
    const whit_camera camera = CAMERA_AT(0, 1, 4, 0, 0, 0, 0, 1, 0, 40);
    char sliders[] = "";
    const whit_renderer_params params = {.width = 16, .height = 16, .sliders = sliders};
    own_fixture f = fixture_open(file_scene("cube"), NULL, &params);
    assert_int_equal(renderer_render_views(f.renderer, &camera, 1), WHIT_OK);
    sliders[0] = 'x';
    assert_int_equal(renderer_render(f.renderer), WHIT_OK);
}

TEST(what_views_do_not_go_with_is_refused)
{
    const whit_camera camera = CAMERA_AT(0, 1, 4, 0, 0, 0, 0, 1, 0, 40);
    const whit_renderer_params wrong[] = {
        {.width = 16, .height = 16, .sampling = {.kind = WHIT_SAMPLING_ADAPTIVE, .contrast = 0.1}},
        {.width = 16, .height = 16, .row_count = 8},
        {.width = 16, .height = 16, .count = true},
    };
    own_fixture f = fixture_open(file_scene("cube"), NULL, NULL);
    assert_int_equal(renderer_render_views(f.renderer, &camera, 0), WHIT_ERROR_USAGE);
    assert_int_equal(renderer_render_views(f.renderer, &camera, UINT32_MAX), WHIT_ERROR_USAGE);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        fixture_renew(&f, &wrong[i]);
        assert_int_equal(renderer_render_views(f.renderer, &camera, 1), WHIT_ERROR_USAGE);
    }
    whit_camera none[] = {camera, camera, camera}; /* flat, of no kind, without an angle */
    none[0].kind = WHIT_CAMERA_ORTHOGRAPHIC;
    none[1].kind = WHIT_CAMERA_PANORAMA + 1;
    none[2].fov_y_degrees = 0.0;
    fixture_renew(&f, &(whit_renderer_params){.width = 16, .height = 16});
    for (size_t i = 0; i < 3; ++i)
        assert_int_equal(renderer_render_views(f.renderer, &none[i], 1), WHIT_ERROR_USAGE);
}
