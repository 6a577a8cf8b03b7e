/* Points an existing renderer at another picture: size, camera, time, samples, limits. */
#include "picture/camera.h"
#include "render/async.h"
#include "render/frame_uniform.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/renderer.h"
#include "render/variants.h"
#include "render/views.h"

/* Takes over parameters of `from`, but for those that would need other kernels or uploads. */
static whit_renderer_params merge(const whit_renderer_params *own, const whit_renderer_params *from)
{
    whit_renderer_params params = *own;
    params.width = from->width;
    params.height = from->height;
    params.first_row = from->first_row;
    params.row_count = from->row_count;
    params.camera = from->camera;
    params.time_s = from->time_s;
    params.sampling = from->sampling;
    params.step_spacing = from->step_spacing;
    params.step_aov = from->step_aov;
    params.light_samples = from->light_samples;
    params.reuse_rays = from->reuse_rays;
    params.few_pixels = from->few_pixels;
    params.bailout = from->bailout;
    params.depth = from->depth;
    params.exposure_ev = from->exposure_ev;
    params.time_stages = from->time_stages;
    return params;
}

static bool same_buffers(const whit_renderer_params *a, const whit_renderer_params *b)
{
    return a->width == b->width && a->height == b->height && params_rows(a) == params_rows(b) &&
           a->depth == b->depth && a->light_samples == b->light_samples &&
           a->sampling.kind == b->sampling.kind;
}

whit_result retarget_pixels(struct renderer *renderer)
{
    target_drop_pixels(&renderer->picture);
    target_drop_pixels(&renderer->probe);
    whit_result result =
        pixels_create(&renderer->picture, views_rows(renderer), renderer->params.tile_size);
    if (result != WHIT_OK)
        target_drop_pixels(&renderer->picture);
    renderer->picture.stats.device_bytes = renderer->scene_buffers.bytes;
    return result;
}

/* Refuses a camera before anything is changed. */
static whit_result check_camera(const struct renderer *renderer, const whit_renderer_params *params)
{
    struct gpu_frame frame;
    uint32_t kind;
    return camera_frame(&renderer->log, &renderer->pose, &params->camera, params->width,
                        params->height, &frame, &kind);
}

whit_result renderer_set_view(struct renderer *renderer, const whit_renderer_params *params)
{
    whit_renderer_params wanted = merge(&renderer->params, params);
    whit_result result = params_check(&renderer->log, &wanted);
    if (result == WHIT_OK)
        result = hooks_check_step_aov(renderer, wanted.step_aov);
    /* A change that failed halfway is made again, even if the parameters are the same. */
    bool redo = renderer->between_times || renderer->between_views;
    bool moved = redo || wanted.time_s != renderer->params.time_s;
    if (result == WHIT_OK && !moved)
        result = check_camera(renderer, &wanted);
    if (result == WHIT_OK)
        result = hooks_read_sliders(renderer, params->sliders);
    if (result != WHIT_OK)
        return result;
    bool many = renderer->views.count > 0;
    bool same = !many && same_buffers(&renderer->params, &wanted) &&
                renderer->picture.buffers.pixels &&
                pixels_levels(&wanted) <= renderer->picture.buffers.levels;
    bool listed = renderer->params.sampling.kind == WHIT_SAMPLING_ADAPTIVE,
         had_secondary = renderer->has_secondary;
    renderer->rendered = false;
    stats_clear(&renderer->picture);
    renderer->picture.stats.compile_ms = 0.0;
    renderer->params = wanted;
    renderer->views.count = renderer->views.held = 0;
    renderer->has_secondary = renderer_bounces(renderer);
    uint32_t camera = variant_camera(renderer);
    bool touched = media_touch(renderer->scene, &renderer->bodies, &renderer->frame);
    if (!same)
        result = retarget_pixels(renderer);
    if (result == WHIT_OK && moved)
        result = renderer_set_time(renderer, wanted.time_s);
    else if (result == WHIT_OK)
        result = frame_upload(renderer);
    bool other_kernel =
        redo || many || variant_camera(renderer) != camera ||
        (wanted.sampling.kind == WHIT_SAMPLING_ADAPTIVE) != listed ||
        renderer->has_secondary != had_secondary ||
        media_touch(renderer->scene, &renderer->bodies, &renderer->frame) != touched;
    if (result == WHIT_OK && other_kernel) {
        async_finish(renderer);
        passes_finish(renderer);
    }
    renderer->between_views = result != WHIT_OK;
    return result;
}
