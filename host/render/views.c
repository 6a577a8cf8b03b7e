/* Views of many cameras as one picture, which has them one below the other: each in whole rows of
   blocks, so that the rays of a packet are of one view. A view is the picture of its camera, byte
   for byte. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/buffer.h"
#include "render/async.h"
#include "render/frame_uniform.h"
#include "render/pixels.h"
#include "render/renderer.h"
#include "render/stage_set.h"
#include "render/tiles.h"
#include "render/upload.h"
#include "render/variants.h"
#include "render/views.h"

uint32_t views_stride(const struct renderer *renderer)
{
    return pixels_blocks_across(renderer->params.height) * 8;
}

uint32_t views_rows(const struct renderer *renderer)
{
    return renderer->views.count ? renderer->views.count * views_stride(renderer)
                                 : params_rows(&renderer->params);
}

uint32_t views_picture_rows(const struct renderer *renderer)
{
    uint32_t count = renderer->views.count;
    return renderer->params.height * (count ? count : 1);
}

uint32_t views_image_rows(const struct renderer *renderer)
{
    return renderer->views.count ? views_picture_rows(renderer) : params_rows(&renderer->params);
}

uint32_t renderer_view_count(const struct renderer *renderer)
{
    return renderer->views.count;
}

void views_finish(struct views *views)
{
    buffer_destroy(views->buffer);
    free(views->all);
    *views = (struct views){0};
}

static whit_result refuse(const struct renderer *renderer, const char *what)
{
    return log_usage(&renderer->log, "views of many cameras are not drawn with %s", what);
}

static whit_result check(const struct renderer *renderer, uint32_t count)
{
    const whit_renderer_params *params = &renderer->params;
    uint64_t rows = (uint64_t)count * views_stride(renderer);
    if (params->sampling.kind == WHIT_SAMPLING_ADAPTIVE)
        return refuse(renderer, "adaptive samples");
    if (params->row_count)
        return refuse(renderer, "some of their rows");
    if (params->count)
        return refuse(renderer, "costs that are counted");
    if (params->shader)
        return refuse(renderer, "functions of a shader");
    if (renderer->between_times || renderer->between_views)
        return refuse(renderer, "a time or size that could not be set");
    if (count > 0 && rows <= INT32_MAX &&
        rows / 8 * pixels_blocks_across(params->width) <= UINT32_MAX)
        return WHIT_OK;
    return log_usage(&renderer->log, "%u views of %u x %u pixels: %s", count, params->width,
                     params->height, count ? "too many for one call" : "there must be one");
}

/* The values of the frame, for the camera that it was filled for. */
static struct gpu_view view_of(const struct renderer *renderer)
{
    const struct gpu_frame *frame = &renderer->frame;
    struct gpu_view view = {.texel_area = frame->texel_area,
                            .focus_distance = frame->focus_distance,
                            .lens_radius = frame->lens_radius,
                            .camera = variant_camera(renderer),
                            .eye_media0 = frame->eye_media0,
                            .eye_media1 = frame->eye_media1,
                            .eye_media2 = frame->eye_media2,
                            .eye_media3 = frame->eye_media3};
    memcpy(view.eye, frame->eye, sizeof view.eye);
    memcpy(view.right, frame->right, sizeof view.right);
    memcpy(view.up, frame->up, sizeof view.up);
    memcpy(view.forward, frame->forward, sizeof view.forward);
    return view;
}

/* Fills in all views, and the values of the frame that all of them share. */
static whit_result take_cameras(struct renderer *renderer, const whit_camera *cameras,
                                uint32_t count)
{
    const whit_camera own = renderer->params.camera;
    struct views *views = &renderer->views;
    whit_result result = WHIT_OK;
    uint32_t nested = 0;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
        renderer->params.camera = cameras[i];
        result = frame_fill(renderer);
        if (result != WHIT_OK) {
            log_error(&renderer->log, "view %u of %u cannot be drawn", i, count);
            break;
        }
        views->all[i] = view_of(renderer);
        views->camera =
            i == 0 || views->camera == views->all[i].camera ? views->all[i].camera : CAMERA_EACH;
        nested |= renderer->frame.nested;
    }
    renderer->params.camera = own;
    renderer->frame.nested = nested;
    return result;
}

/* Chooses kernels as for a single picture of as many rays. *others: they differ from before. */
static whit_result choose_kernels(struct renderer *renderer, bool *others)
{
    whit_renderer_params all = renderer->params;
    uint32_t packet_rays = renderer->packet_rays, stack_size = renderer->packet_stack_size;
    bool packets = renderer->packets, few = renderer->few_kernels;
    all.height = views_picture_rows(renderer);
    renderer->few_kernels = few && render_few_kernels(&all);
    whit_result result = upload_choose_packets(renderer);
    *others = renderer->few_kernels != few || renderer->packets != packets ||
              renderer->packet_rays != packet_rays || renderer->packet_stack_size != stack_size;
    return result;
}

/* Makes the renderer's picture one of these cameras. */
static whit_result views_take(struct renderer *renderer, const whit_camera *cameras, uint32_t count)
{
    struct views *views = &renderer->views;
    uint32_t camera = views->camera;
    bool touched = media_touch(renderer->scene, &renderer->bodies, &renderer->frame);
    bool others = false;
    free(views->all);
    views->all = array_alloc(count, sizeof *views->all);
    views->count = count;
    whit_result result =
        views->all ? choose_kernels(renderer, &others) : render_no_memory(renderer, "views");
    views->count = 0; /* so that variant_camera gives the kind of each camera */
    if (result == WHIT_OK)
        result = take_cameras(renderer, cameras, count);
    if (result == WHIT_OK)
        result = upload_words(renderer, views->all, count * sizeof *views->all, BUFFER_STORAGE,
                              "views", &views->buffer);
    if (result == WHIT_OK)
        result = frame_write(renderer);
    views->count = count;
    if (result == WHIT_OK && count != views->held)
        result = retarget_pixels(renderer);
    if (result == WHIT_OK &&
        (!views->held || others || views->camera != camera ||
         media_touch(renderer->scene, &renderer->bodies, &renderer->frame) != touched)) {
        async_finish(renderer);
        passes_finish(renderer);
    }
    views->held = result == WHIT_OK ? count : 0; /* 0: the next call makes everything anew */
    return result;
}

whit_result views_take_sample(struct renderer *renderer, const struct gpu_chunk *chunk)
{
    const struct views *views = &renderer->views;
    if (!views->count || (views->camera != CAMERA_LENS && views->camera != CAMERA_EACH))
        return WHIT_OK;
    uint32_t rows = views_stride(renderer) / 8;
    uint32_t first = chunk->first_block / chunk->blocks_x / rows;
    uint32_t last = (chunk->first_block + chunk->block_count - 1) / chunk->blocks_x / rows;
    for (uint32_t i = first; i <= last; ++i) {
        struct gpu_view *view = &views->all[i];
        struct gpu_frame frame = renderer->frame;
        struct gpu_chunk sample = {0};
        memcpy(frame.right, view->right, sizeof frame.right);
        memcpy(frame.up, view->up, sizeof frame.up);
        frame.lens_radius = view->lens_radius;
        frame.focus_distance = view->focus_distance;
        camera_sample(&frame, chunk->sample_index, &sample);
        memcpy(view->lens_xy, sample.lens_xy, sizeof view->lens_xy);
    }
    return buffer_write(views->buffer, first * sizeof *views->all, &views->all[first],
                        (last - first + 1) * sizeof *views->all);
}

whit_result views_leave(struct renderer *renderer)
{
    const whit_renderer_params params = renderer->params;
    uint32_t count = renderer->views.count;
    whit_result result = count ? renderer_set_view(renderer, &params) : WHIT_OK;
    if (result == WHIT_OK)
        return WHIT_OK;
    renderer->views.count = count; /* the next call leaves them, or makes everything anew */
    renderer->between_views = false;
    return result;
}

whit_result renderer_render_views(struct renderer *renderer, const whit_camera *cameras,
                                  uint32_t count)
{
    whit_result result = check(renderer, count);
    if (result != WHIT_OK)
        return result;
    renderer->rendered = false;
    result = views_take(renderer, cameras, count);
    return result == WHIT_OK ? render_all(renderer) : result;
}
