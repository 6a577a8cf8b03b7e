/* Creates and destroys renderers. */
#include "render/async.h"

#include <stdlib.h>

#include "accel/pose.h"
#include "base/clock.h"
#include "device/commands.h"
#include "render/costs.h"
#include "render/effects.h"
#include "render/frame_uniform.h"
#include "render/hooks.h"
#include "render/pixels.h"
#include "render/readback.h"
#include "render/stage_set.h"
#include "render/upload.h"
#include "render/variants.h"
#include "render/views.h"
#include "scene/effects.h"
#include "scene/pose.h"

whit_result render_no_memory(const struct renderer *renderer, const char *what)
{
    return log_failure(&renderer->log, WHIT_ERROR_MEMORY, "out of memory for %s", what);
}

bool renderer_bounces(const struct renderer *renderer)
{
    const bool *called = renderer->effects.called;
    return renderer->params.depth > 0 &&
           (called[SCENE_EFFECT_REFLECTION] || called[SCENE_EFFECT_REFRACTION] ||
            called[SCENE_EFFECT_CUTOUTS] || called[SCENE_EFFECT_CATCHERS]);
}

static whit_result create_parts(struct renderer *renderer)
{
    double start_ms = clock_ms();
    whit_result result =
        pixels_create(&renderer->picture, views_rows(renderer), renderer->params.tile_size);
    if (result == WHIT_OK)
        result = upload_scene(renderer);
    if (result == WHIT_OK)
        result = frame_upload(renderer);
    renderer->picture.stats.upload_ms = clock_ms() - start_ms;
    if (result == WHIT_OK)
        result = commands_create(renderer->device, "render", &renderer->commands);
    renderer->picture.stats.load_path =
        renderer->scene_buffers.texel_loads ? WHIT_LOAD_TEXEL : WHIT_LOAD_STORAGE;
    renderer->picture.stats.device_bytes = renderer->scene_buffers.bytes;
    return result;
}

/* Called late, since renderers that only trace batches never need the kernels of pictures. */
whit_result renderer_compile(struct renderer *renderer)
{
    if (stage_set_is_made(&renderer->picture.stages.set) && !renderer->async.general)
        return stages_complete(&renderer->picture);
    double start_ms = clock_ms();
    whit_result result = renderer->params.compile_async ? async_prepare(renderer)
                                                        : stages_compile(&renderer->picture);
    /* Stages may be timed only since the thread began to make the kernels. */
    if (result == WHIT_OK && !renderer->async.general)
        result = stages_complete(&renderer->picture);
    if (result == WHIT_OK)
        renderer->picture.stats.general = renderer->async.general;
    else
        passes_finish(renderer);
    renderer->picture.stats.compile_ms = clock_ms() - start_ms;
    return result;
}

whit_result renderer_init(struct renderer *renderer, const whit_log *log, struct device *device,
                          struct accel *accel, const whit_renderer_params *params)
{
    renderer->picture.renderer = renderer->probe.renderer = renderer;
    renderer->probe.probed = true;
    renderer->log = log_or_silence(log);
    renderer->create_ms = clock_ms();
    renderer->device = device;
    renderer->accel = accel;
    renderer->scene = accel->scene;
    if (params)
        renderer->params = *params;
    scene_effects_scan(renderer->scene, renderer->params.shader != NULL, &renderer->effects);
    hooks_take(renderer);
    effects_choose(&renderer->params, &renderer->effects);
    whit_result result = params_check(log, &renderer->params);
    if (result == WHIT_OK)
        result = effects_check(log, &renderer->params);
    if (result == WHIT_OK)
        result = hooks_check_step_aov(renderer, renderer->params.step_aov);
    if (result == WHIT_OK)
        result = hooks_read_sliders(renderer, renderer->params.sliders);
    renderer->params.sliders = NULL; /* the caller's text, which may be gone after this call */
    if (result == WHIT_OK)
        result = hooks_find_material(renderer);
    if (result == WHIT_OK && !(renderer->worn = scene_worn_materials(renderer->scene)))
        result = render_no_memory(renderer, "materials");
    if (renderer->scene->pictures_dropped)
        result =
            log_usage(log, "%s: its textures were dropped, no further renderer can be made from it",
                      renderer->scene->name);
    if (result == WHIT_OK)
        result = scene_pose_init(renderer->scene, renderer->params.time_s, &renderer->pose);
    if (result == WHIT_OK)
        result = accel_pose(accel, &renderer->pose);
    if (result == WHIT_OK && renderer->params.portable)
        result = portable_choose(log, device, &renderer->portable);
    renderer->portable.shader = renderer->params.shader;
    renderer->has_secondary = renderer_bounces(renderer);
    renderer->few_kernels = render_few_kernels(&renderer->params);
    renderer->node_stack_size = accel_stack_size(accel);
    renderer->single_identity = accel->single_identity;
    renderer->clipped = accel->clipped;
    return result;
}

whit_result renderer_create(const whit_log *log, struct device *device, struct accel *accel,
                            const whit_renderer_params *params, struct renderer **out)
{
    *out = NULL;
    struct renderer *renderer = calloc(1, sizeof *renderer);
    if (!renderer)
        return WHIT_ERROR_MEMORY;
    whit_result result = renderer_init(renderer, log, device, accel, params);
    if (result == WHIT_OK)
        hooks_warn_material(renderer);
    if (result == WHIT_OK)
        result = create_parts(renderer);
    if (result == WHIT_OK && renderer->params.compile_async)
        result = renderer_compile(renderer);
    if (result != WHIT_OK) {
        renderer_destroy(renderer);
        return result;
    }
    *out = renderer;
    return WHIT_OK;
}

void renderer_finish(struct renderer *renderer)
{
    commands_destroy(renderer->commands);
    passes_finish(renderer);
    async_finish(renderer);
    trace_finish(&renderer->trace);
    target_finish(&renderer->probe);
    target_finish(&renderer->picture);
    views_finish(&renderer->views);
    costs_clear(renderer);
    upload_finish(&renderer->scene_buffers);
    bodies_finish(&renderer->bodies);
    scene_pose_finish(&renderer->pose);
    free(renderer->worn);
    readback_drop_images(renderer);
}

void renderer_destroy(struct renderer *renderer)
{
    if (!renderer)
        return;
    renderer_finish(renderer);
    free(renderer);
}
