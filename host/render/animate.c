/* Moves an existing renderer to another time of the animation. */
#include "accel/pose.h"
#include "base/clock.h"
#include "render/async.h"
#include "render/frame_uniform.h"
#include "render/upload.h"
#include "render/variants.h"
#include "scene/pose.h"

/* Rebuilt trees are not equally deep at all times. A stack that has to grow gets these spare
   entries, since a new pipeline takes longer to compile than many a picture to render. */
enum { STACK_SPARE = 4 };

static whit_result take_pose(struct renderer *renderer, double time_s)
{
    struct scene_pose pose;
    whit_result result = scene_pose_init(renderer->scene, time_s, &pose);
    if (result != WHIT_OK)
        return result;
    result = accel_pose(renderer->accel, &pose);
    if (result != WHIT_OK) {
        scene_pose_finish(&pose);
        return result;
    }
    scene_pose_finish(&renderer->pose);
    renderer->pose = pose;
    renderer->params.time_s = time_s;
    return WHIT_OK;
}

static whit_result upload_all(struct renderer *renderer)
{
    whit_result result = upload_pose(renderer);
    return result == WHIT_OK ? frame_upload(renderer) : result;
}

/* Drops the passes whose specialization constants no longer fit. New ones are made when needed. */
static void passes_check(struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    uint32_t needed = accel_stack_size(accel);
    bool outgrown = needed > renderer->node_stack_size;
    if (outgrown)
        renderer->node_stack_size = needed + STACK_SPARE;
    bool quantized = upload_chooses_quantized(renderer);
    if (outgrown || accel->single_identity != renderer->single_identity ||
        accel->clipped != renderer->clipped || quantized != renderer->quantized)
        passes_finish(renderer);
    renderer->quantized = quantized;
    renderer->single_identity = accel->single_identity;
    renderer->clipped = accel->clipped;
}

whit_result renderer_set_time(struct renderer *renderer, double time_s)
{
    renderer->rendered = false;
    whit_result result = take_pose(renderer, time_s);
    double posed_ms = clock_ms();
    if (result == WHIT_OK) {
        uint32_t stack_size = renderer->packet_stack_size;
        passes_check(renderer);
        result = upload_all(renderer);
        if (renderer->packet_stack_size != stack_size) { /* known once bvh8 nodes are made */
            async_finish(renderer);
            passes_finish(renderer);
        }
        renderer->between_times = result != WHIT_OK;
    }
    renderer->picture.stats.upload_ms = clock_ms() - posed_ms;
    renderer->picture.stats.compile_ms = 0.0;
    renderer->picture.stats.device_bytes = renderer->scene_buffers.bytes;
    return result;
}
