/* Parameters that no picture can have are refused by name, and NULL means the defaults. */
#include "../wrapped.h"
#include "scene_fixture.h"

static int begin(void **state)
{
    messages = (struct messages){0};
    scene_open(WHIT_SCENES_DIR "/cube.json");
    return device_begin(state);
}

static whit_renderer_params small(void)
{
    return params_sized(16, 16, NULL);
}

/* `result` is that of a call which was refused with `reason`, the last error. */
static void refused(whit_result result, const char *reason)
{
    assert_int_equal(result, WHIT_ERROR_USAGE);
    assert_non_null(strstr(messages.last_error, reason));
    messages = (struct messages){0};
}

/* With a device (`on` is it) and without (NULL). */
static void refuse(whit_device *on, const whit_renderer_params *params, const char *reason)
{
    whit_renderer *renderer = NULL;
    refused(whit_renderer_create(on, accel, params, &renderer), reason);
    assert_null(renderer);
}

TEST_IN(values_out_of_range_are_refused, begin, device_end)
{
    static const struct {
        size_t at;
        double value;
        const char *reason;
    } numbers[] = {
        {offsetof(whit_renderer_params, bailout), NAN, "a bail-out of nan: must be finite"},
        {offsetof(whit_renderer_params, time_s), INFINITY, "a time of inf s"},
        {offsetof(whit_renderer_params, exposure_ev), NAN,
         "an exposure of nan and a time limit of 0 s"},
        {offsetof(whit_renderer_params, time_limit_s), NAN, "a time limit of nan s"},
        {offsetof(whit_renderer_params, time_limit_s), -1.0, "a time limit of -1 s"},
    };
    for (size_t i = 0; i < 2 * sizeof numbers / sizeof *numbers; ++i) {
        whit_renderer_params params = small();
        memcpy((char *)&params + numbers[i / 2].at, &numbers[i / 2].value, sizeof(double));
        refuse(i % 2 ? device : NULL, &params, numbers[i / 2].reason);
        params = small();
        params.depth = 999;
        refuse(i % 2 ? device : NULL, &params, "depth 999: must be 0..255");
    }
    whit_renderer_params params = small();
    params.camera = (whit_camera){
        .own = true, .eye = {0, 1, 5}, .up = {0, 1, 0}, .fov_y_degrees = 40, .lens_radius = -1.0};
    refuse(device, &params, "the lens or its focus is below 0");
    params.camera.lens_radius = 0.1;
    params.camera.focus_distance = -1.0;
    refuse(device, &params, "the lens or its focus is below 0");
    params.camera.focus_distance = 1e-30;
    refuse(device, &params, "the lens is too wide for its focus or its field of view");
    params.camera.focus_distance = 1.0;
    params.camera.fov_y_degrees = 1e-38;
    refuse(device, &params, "the lens is too wide for its focus or its field of view");
    params.camera.kind = WHIT_CAMERA_ORTHOGRAPHIC;
    refuse(device, &params, "the height of the picture is not above 0");
    params = small();
    params.step_aov = 7;
    refuse(device, &params, "steps of the aov number 7: the shader has 0");
    params.packets = (whit_packets)9;
    refuse(device, &params, "packets 9: the enumeration has 0 to 2");
    params.packets = (whit_packets)-1;
    refuse(NULL, &params, "packets -1: the enumeration has 0 to 2");
    double *const values[] = {params.camera.eye, params.camera.target, params.camera.up};
    const double bad[] = {NAN, -INFINITY, 1e39, 1e300};
    for (int i = 0; i < 12; ++i) {
        params = small();
        params.camera =
            (whit_camera){.own = true, .eye = {0, 1, 5}, .up = {0, 1, 0}, .fov_y_degrees = 40};
        values[i % 3][1] = bad[i / 3];
        refuse(device, &params, "eye, target or up is not finite, or too large for a float");
    }
}

TEST_IN(a_view_out_of_range_leaves_the_picture, begin, device_end)
{
    whit_renderer_params params = small();
    whit_image *image = NULL;
    const whit_camera nowhere = {.own = true};
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    params.exposure_ev = INFINITY;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_ERROR_USAGE);
    params = small();
    params.step_aov = 1;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_ERROR_USAGE);
    params = small();
    params.camera.name = "nobody";
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_ERROR_USAGE);
    assert_int_equal(whit_renderer_render_views(renderer, NULL, 0), WHIT_ERROR_USAGE);
    assert_int_equal(whit_renderer_image(renderer, WHIT_AOV_COLOR, &image), WHIT_OK);
    whit_image_destroy(image);
    assert_int_equal(whit_renderer_render_views(renderer, &nowhere, 1), WHIT_ERROR_USAGE);
    refused(whit_renderer_image(renderer, WHIT_AOV_COLOR, &image),
            "since the renderer was made, changed or failed");
}

TEST_IN(rays_are_traced_in_one_of_the_ways_that_there_are, begin, device_end)
{
    const whit_ray ray = {{0, 9, 0}, 0, {0, -1, 0}, INFINITY};
    const whit_renderer_params params = small();
    own_whit_renderer *renderer = NULL;
    whit_hit hit;
    assert_int_equal(whit_renderer_create(NULL, accel, &params, &renderer), WHIT_OK);
    refused(whit_trace(renderer, (whit_trace_on)9, &ray, 1, false, &hit, NULL), "not on 9");
}

TEST_IN(without_a_device_nothing_is_drawn_over, begin, device_end)
{
    const float light[4] = {0};
    const whit_overlay overlay = {.grid = true};
    const whit_renderer_params params = small();
    own_whit_renderer *renderer = NULL;
    own_whit_image *image = NULL;
    assert_int_equal(whit_renderer_create(NULL, accel, &params, &renderer), WHIT_OK);
    assert_int_equal(whit_image_create(1, 1, 4, light, &image), WHIT_OK);
    refused(whit_renderer_draw_over(renderer, &overlay, image), "made without a device");
}

TEST(limits_of_importers_are_not_below_0)
{
    const whit_load_params bad[] = {{.import_limit_s = NAN},
                                    {.import_limit_s = -1.0},
                                    {.time_limit_s = NAN},
                                    {.time_limit_s = -1.0}};
    const char *path = WHIT_SCENES_DIR "/cube.json";
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        whit_scene *loaded = NULL;
        whit_image *image = NULL;
        whit_text *texts = NULL;
        uint32_t count;
        messages = (struct messages){0};
        assert_int_equal(whit_scene_load(path, &bad[i], &warnings_log, &loaded), WHIT_ERROR_USAGE);
        assert_int_equal(whit_image_load(path, &bad[i], &warnings_log, &image), WHIT_ERROR_USAGE);
        assert_int_equal(whit_image_load_texts(path, &bad[i], &warnings_log, &texts, &count),
                         WHIT_ERROR_USAGE);
        assert_int_equal(messages.errors, 3);
        assert_non_null(strstr(messages.last_error, "s for importers: must not be below 0"));
    }
}

TEST(files_need_a_path)
{
    whit_scene *loaded = NULL;
    whit_image *image = NULL;
    whit_text *texts = NULL;
    whit_camera *cameras = NULL;
    uint32_t count;
    messages = (struct messages){0};
    assert_int_equal(whit_cameras_load(NULL, &warnings_log, &cameras, &count), WHIT_ERROR_USAGE);
    assert_int_equal(whit_scene_load(NULL, NULL, &warnings_log, &loaded), WHIT_ERROR_USAGE);
    assert_int_equal(whit_image_load(NULL, NULL, &warnings_log, &image), WHIT_ERROR_USAGE);
    assert_int_equal(whit_image_load_texts(NULL, NULL, &warnings_log, &texts, &count),
                     WHIT_ERROR_USAGE);
    assert_int_equal(messages.errors, 4);
    assert_string_equal(messages.last_error, "there is no path of a file to load");
    const float grey = 0.5f;
    assert_int_equal(whit_image_create(1, 1, 1, &grey, &image), WHIT_OK);
    assert_int_equal(whit_image_save(image, NULL, NULL, 0, &warnings_log), WHIT_ERROR_USAGE);
    assert_string_equal(messages.last_error, "there is no path of a file to write");
    whit_image_destroy(image);
}

/* Wrapped at link time: while it is set, there is no memory for as many pixels. */
static size_t starved_of;

WRAPPED(void *, array_alloc_zeroed, size_t count, size_t element_bytes)
{
    return starved_of && count == starved_of ? NULL
                                             : __real_array_alloc_zeroed(count, element_bytes);
}

TEST_IN(a_picture_without_memory_is_one_line_in_the_log, begin, device_end)
{
    const whit_renderer_params params = small();
    whit_reference *reference = NULL;
    whit_image *image = NULL;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_reference_create(accel, &params, 1, &reference), WHIT_OK);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    messages = (struct messages){0};
    starved_of = 16 * 16;
    whit_result drawn = whit_renderer_image(renderer, WHIT_AOV_COLOR, &image);
    whit_result referred = whit_reference_render(reference, &image, NULL);
    starved_of = 0;
    assert_int_equal(drawn, WHIT_ERROR_MEMORY);
    assert_int_equal(referred, WHIT_ERROR_MEMORY);
    assert_int_equal(messages.errors, 2);
    assert_non_null(strstr(messages.last_error, "out of memory for 16 x 16 pixels"));
    whit_reference_destroy(reference);
}

/* The grid of camera rays has as many columns as wanted rays at most, however wide the picture. */
TEST_IN(judges_of_wide_pictures_have_no_more_rays_than_asked, begin, device_end)
{
    const uint32_t sizes[][3] = {{4096, 16, 100}, {65535, 1, 1}, {1, 65535, 100}, {4, 3, 12}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        const whit_judge_params params = {
            .width = sizes[i][0], .height = sizes[i][1], .count = sizes[i][2]};
        whit_judge *judge = NULL;
        uint64_t count;
        assert_int_equal(whit_judge_create(scene, &params, &warnings_log, &judge), WHIT_OK);
        whit_judge_rays(judge, &count);
        assert_int_equal(count, sizes[i][2]);
        whit_judge_destroy(judge);
    }
}

static void refuse_judge(const whit_judge_params *params, const char *reason)
{
    whit_judge *judge = NULL;
    refused(whit_judge_create(scene, params, &warnings_log, &judge), reason);
    assert_null(judge);
}

static void refuse_hard_view(const whit_hard_view_params *params, const char *reason)
{
    uint64_t wrong, other;
    whit_image *image = NULL;
    refused(whit_hard_view(NULL, scene, params, &warnings_log, &wrong, &other, &image), reason);
    assert_null(image);
}

TEST_IN(judges_refuse_values_out_of_range, begin, device_end)
{
    const whit_judge_params good = {.count = 12};
    whit_judge *judge = NULL;
    whit_judgement judgement;
    whit_hard_report *report = NULL;
    refuse_judge(&(whit_judge_params){.width = 70000, .height = 2}, "70000 x 2: at most 65535");
    refuse_judge(&(whit_judge_params){.time_s = NAN}, "a time of nan s: it must be finite");
    refuse_judge(&(whit_judge_params){.instances = (whit_instances)9}, "instances 9: auto");
    assert_int_equal(whit_judge_create(scene, &good, &warnings_log, &judge), WHIT_OK);
    refused(whit_judge_hits(judge, (whit_numerics)9, NULL, &judgement),
            "there is no level of numerics 9");
    whit_judge_destroy(judge);
    refuse_hard_view(&(whit_hard_view_params){.numerics = (whit_numerics)9}, "numerics 9");
    refuse_hard_view(&(whit_hard_view_params){.instances = (whit_instances)9}, "instances 9");
    refuse_hard_view(&(whit_hard_view_params){.width = 8, .height = 8, .time_s = NAN},
                     "a time of nan s");
    const whit_hard_params run = {.instances = (whit_instances)9};
    refused(whit_hard_run(NULL, scene, &run, &warnings_log, &report), "instances 9");
    const double limits[] = {NAN, -1.0};
    for (int i = 0; i < 2; ++i) {
        const whit_hard_params never = {.time_limit_s = limits[i]};
        refused(whit_hard_run(NULL, scene, &never, &warnings_log, &report), "a time limit of");
    }
}

static bool first_triangle(void *user, const whit_triangle *triangle)
{
    (void)triangle;
    *(bool *)user = true;
    return false;
}

TEST_IN(there_is_nothing_at_a_time_that_is_not_finite, begin, device_end)
{
    bool called = false;
    whit_box *boxes = NULL;
    uint64_t total;
    messages = (struct messages){0};
    assert_int_equal(whit_scene_triangles(scene, NAN, first_triangle, &called), WHIT_ERROR_USAGE);
    assert_false(called);
    assert_int_equal(whit_accel_boxes(accel, INFINITY, true, 0, 1, &boxes, &total),
                     WHIT_ERROR_USAGE);
    assert_non_null(strstr(messages.text, "a time of nan s: it must be finite\n"));
    assert_non_null(strstr(messages.text, "a time of inf s: it must be finite\n"));
}

TEST_IN(no_params_are_the_defaults, begin, device_end)
{
    const whit_renderer_params params = small();
    whit_image_info info;
    whit_refine *refine = NULL;
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_set_view(renderer, NULL), WHIT_OK);
    own_whit_image *image = drawn_by(renderer);
    whit_image_get_info(image, &info);
    assert_int_equal(info.width, 640);
    whit_image_display_as(image, NULL);
    assert_int_equal(whit_refine_create(renderer, NULL, &refine), WHIT_OK);
    whit_refine_move(refine, renderer, NULL);
    whit_refine_destroy(refine);
}

/* Draws a picture, and gives its bytes as displayed. */
static void draw_bytes(whit_renderer *renderer, uint8_t rgba[4 * 16 * 16])
{
    own_whit_image *image = drawn_by(renderer);
    whit_image_display_bytes(image, rgba);
}

TEST_IN(a_view_is_displayed_as_its_params_say, begin, device_end)
{
    whit_renderer_params params = small();
    uint8_t usual[4 * 16 * 16], moved[4 * 16 * 16], fresh[4 * 16 * 16];
    own_whit_renderer *renderer = renderer_of(&params);
    draw_bytes(renderer, usual);
    params.exposure_ev = 0.5;
    params.soft_highlights = true;
    assert_int_equal(whit_renderer_set_view(renderer, &params), WHIT_OK);
    draw_bytes(renderer, moved);
    own_whit_renderer *another = renderer_of(&params);
    draw_bytes(another, fresh);
    assert_memory_equal(moved, fresh, sizeof fresh);
    params.soft_highlights = false;
    assert_int_equal(whit_renderer_set_view(another, &params), WHIT_OK);
    draw_bytes(another, fresh);
    assert_memory_not_equal(moved, fresh, sizeof fresh);
    assert_memory_not_equal(usual, fresh, sizeof fresh);
}

TEST_IN(images_that_there_are_none_of_are_refused, begin, device_end)
{
    whit_renderer_params params = small();
    own_whit_image *image = NULL;
    params.sampling = (whit_sampling){.count = 4, .first = 4};
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    refused(whit_renderer_image(renderer, WHIT_AOV_IDS, &image), "those of the first sample");
    refused(whit_renderer_image(renderer, (whit_aov)7, &image), "there is no aov 7");
    assert_int_equal(whit_renderer_image(renderer, WHIT_AOV_COLOR, &image), WHIT_OK);
    const whit_compare_params from_afar = {.pixels_per_degree = 0.5};
    whit_difference difference;
    refused(whit_image_compare(image, image, &from_afar, &warnings_log, &difference, NULL),
            "0.5 pixels a degree: must be 1 to 1000");
}

TEST_IN(identities_are_not_displayed, begin, device_end)
{
    const whit_renderer_params params = small();
    uint8_t rgba[16 * 16 * 4] = {7};
    own_whit_renderer *renderer = renderer_of(&params);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    own_whit_image *ids = image_of(renderer, WHIT_AOV_IDS);
    whit_image_display_bytes(ids, rgba);
    assert_int_equal(rgba[0], 7);
}
