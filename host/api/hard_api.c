/* Runs the hard cases on the caller's device. */
#include "api/handles.h"
#include "hard/run.h"

enum { WIDTH_DEFAULT = 640, HEIGHT_DEFAULT = 480, SIDE_MAX = 32768, RENDERER_SIDE = 16 };

/* The `user` of struct hard_device. */
struct traced_on {
    struct device *device;
    const volatile bool *cancel;
    bool portable;
};

static whit_result trace(const struct hard_device *device, const whit_log *log, struct accel *accel,
                         double time_s, uint32_t numerics, const struct gpu_ray *rays,
                         uint64_t count, struct gpu_hit *hits, double *device_ms)
{
    const struct traced_on *on = device->user;
    const whit_renderer_params params = {.width = RENDERER_SIDE,
                                         .height = RENDERER_SIDE,
                                         .time_s = time_s,
                                         .cancel = on->cancel,
                                         .numerics = (whit_numerics)numerics,
                                         .portable = on->portable,
                                         .trace_rays = (uint32_t)count};
    struct renderer *renderer = NULL;
    whit_result result = renderer_create(log, on->device, accel, &params, &renderer);
    if (result == WHIT_OK) /* warms up: some drivers finish compiling when a kernel first runs */
        result = renderer_trace(renderer, rays, 1, false, hits, NULL);
    if (result == WHIT_OK)
        result = renderer_trace(renderer, rays, count, false, hits, NULL);
    if (result == WHIT_OK)
        *device_ms = renderer_trace_device_ms(renderer);
    renderer_destroy(renderer);
    return result;
}

/* Whether hits on this device must equal those of the float mirror (twin) in all bits: see
   docs/numerics.md. */
static whit_result find_equal_bits(whit_device *device, bool portable, bool *equal)
{
    whit_device_floats floats = {.own_division = true, .own_comparison = true};
    whit_result result = device && !portable ? whit_device_find_floats(device, &floats) : WHIT_OK;
    *equal = floats.own_division && floats.own_comparison;
    return result;
}

whit_result whit_hard_run(whit_device *device, const whit_scene *scene,
                          const whit_hard_params *params, const whit_log *log,
                          whit_hard_report **out)
{
    const whit_hard_params defaults = {0};
    params = params ? params : &defaults;
    struct traced_on on = {device ? device->device : NULL, params->cancel, params->portable};
    struct hard_device hard_device = {trace, &on, true};
    *out = NULL;
    whit_result result = api_check_instances(log, params->instances);
    if (result == WHIT_OK)
        result = find_equal_bits(device, params->portable, &hard_device.equal_bits);
    if (result != WHIT_OK)
        return result;
    return hard_run(device ? &hard_device : NULL, scene ? scene->scene : NULL,
                    scene && api_one_tree(scene, params->instances), params, log, out);
}

void whit_hard_report_destroy(whit_hard_report *report)
{
    hard_report_destroy(report);
}

whit_result whit_hard_view(whit_device *device, const whit_scene *scene,
                           const whit_hard_view_params *params, const whit_log *log,
                           uint64_t *wrong_pixels, uint64_t *other_pixels, whit_image **out)
{
    whit_hard_view_params own = params ? *params : (whit_hard_view_params){0};
    struct traced_on on = {device ? device->device : NULL, NULL, own.portable};
    const struct hard_device hard_device = {trace, &on, true};
    *out = NULL;
    own.width = own.width ? own.width : WIDTH_DEFAULT;
    own.height = own.height ? own.height : HEIGHT_DEFAULT;
    if (own.width > SIDE_MAX || own.height > SIDE_MAX)
        return API_FAIL(log, WHIT_ERROR_USAGE, "%u x %u: at most %d on a side", own.width,
                        own.height, SIDE_MAX);
    whit_result result = api_check_numerics(log, own.numerics);
    if (result == WHIT_OK)
        result = api_check_instances(log, own.instances);
    if (result != WHIT_OK)
        return result;
    struct image image;
    result = image_init_logged(log, &image, own.width, own.height, 3, false);
    if (result == WHIT_OK)
        result = hard_view(device ? &hard_device : NULL, scene ? scene->scene : NULL,
                           scene && api_one_tree(scene, own.instances), &own, log, image.pixels,
                           wrong_pixels, other_pixels);
    return api_hand_out(log, &image, result, out);
}
