/* Parameters that no picture can have are refused by name, and NULL means the defaults. */
#include "messages_fixture.h"
#include "unit.h"
#include "whit.h"

static whit_scene *scene;
static whit_accel *accel;
static whit_device *device;

static int begin(void **state)
{
    (void)state;
    messages = (struct messages){0};
    assert_int_equal(whit_scene_load(WHIT_SCENES_DIR "/cube.json", NULL, &warnings_log, &scene),
                     WHIT_OK);
    assert_int_equal(whit_accel_create(scene, NULL, &accel), WHIT_OK);
    assert_int_equal(whit_device_create(NULL, &warnings_log, &device), WHIT_OK);
    return 0;
}

static int end(void **state)
{
    (void)state;
    whit_device_destroy(device);
    whit_accel_destroy(accel);
    whit_scene_destroy(scene);
    return 0;
}

static whit_renderer_params small(void)
{
    whit_renderer_params params = whit_renderer_defaults();
    params.width = params.height = 16;
    return params;
}

/* With a device (`on` is it) and without (NULL). */
static void refuse(whit_device *on, const whit_renderer_params *params, const char *reason)
{
    whit_renderer *renderer = NULL;
    messages = (struct messages){0};
    assert_int_equal(whit_renderer_create(on, accel, params, &renderer), WHIT_ERROR_USAGE);
    assert_null(renderer);
    assert_non_null(strstr(messages.last_error, reason));
}

TEST_IN(values_out_of_range_are_refused, begin, end)
{
    for (int i = 0; i < 2; ++i) {
        whit_renderer_params params = small();
        params.bailout = NAN;
        refuse(i ? device : NULL, &params, "a bail-out of nan: must be finite");
        params = small();
        params.time_s = INFINITY;
        refuse(i ? device : NULL, &params, "a time of inf s");
        params = small();
        params.depth = 999;
        refuse(i ? device : NULL, &params, "depth 999: must be 0..255");
    }
    whit_renderer_params params = small();
    params.camera = (whit_camera){
        .own = true, .eye = {0, 1, 5}, .up = {0, 1, 0}, .fov_y_degrees = 40, .lens_radius = -1.0};
    refuse(device, &params, "the lens or its focus is below 0");
    params.camera.lens_radius = 0.1;
    params.camera.focus_distance = -1.0;
    refuse(device, &params, "the lens or its focus is below 0");
    params.camera.kind = WHIT_CAMERA_ORTHOGRAPHIC;
    refuse(device, &params, "the height of the picture is not above 0");
}

TEST_IN(no_params_are_the_defaults, begin, end)
{
    const whit_renderer_params params = small();
    whit_image_info info;
    whit_renderer *renderer = NULL;
    whit_refine *refine = NULL;
    whit_image *image = NULL;
    assert_int_equal(whit_renderer_create(device, accel, &params, &renderer), WHIT_OK);
    assert_int_equal(whit_renderer_set_view(renderer, NULL), WHIT_OK);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    assert_int_equal(whit_renderer_image(renderer, WHIT_AOV_COLOR, &image), WHIT_OK);
    whit_image_get_info(image, &info);
    assert_int_equal(info.width, 640);
    whit_image_destroy(image);
    assert_int_equal(whit_refine_create(renderer, NULL, &refine), WHIT_OK);
    whit_refine_destroy(refine);
    whit_renderer_destroy(renderer);
}

TEST_IN(images_that_there_are_none_of_are_refused, begin, end)
{
    whit_renderer_params params = small();
    whit_renderer *renderer = NULL;
    whit_image *image = NULL;
    params.sampling = (whit_sampling){.count = 4, .first = 4};
    assert_int_equal(whit_renderer_create(device, accel, &params, &renderer), WHIT_OK);
    assert_int_equal(whit_renderer_render(renderer), WHIT_OK);
    messages = (struct messages){0};
    assert_int_equal(whit_renderer_image(renderer, WHIT_AOV_IDS, &image), WHIT_ERROR_USAGE);
    assert_non_null(strstr(messages.last_error, "those of the first sample"));
    assert_int_equal(whit_renderer_image(renderer, (whit_aov)7, &image), WHIT_ERROR_USAGE);
    assert_non_null(strstr(messages.last_error, "there is no aov 7"));
    assert_int_equal(whit_renderer_image(renderer, WHIT_AOV_COLOR, &image), WHIT_OK);
    const whit_compare_params from_afar = {.pixels_per_degree = 0.5};
    whit_difference difference;
    assert_int_equal(whit_image_compare(image, image, &from_afar, &warnings_log, &difference, NULL),
                     WHIT_ERROR_USAGE);
    assert_non_null(strstr(messages.last_error, "0.5 pixels a degree: must be 1 to 1000"));
    whit_image_destroy(image);
    whit_renderer_destroy(renderer);
}
