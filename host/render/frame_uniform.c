/* The record that every ray of a picture reads: camera, sky, roots of the trees, limits. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "accel/pose.h"
#include "device/buffer.h"
#include "picture/mipmap.h"
#include "render/frame_uniform.h"
#include "render/lights.h"
#include "render/pixels.h"
#include "render/upload.h"

whit_result frame_fill(struct renderer *renderer)
{
    struct gpu_frame *frame = &renderer->frame;
    const struct accel *accel = renderer->accel;
    const struct scene_environment *environment = &renderer->scene->environment;
    uint32_t kind;
    whit_result result = accel_pose_again(renderer->accel, &renderer->pose);
    if (result != WHIT_OK)
        return result;
    result = camera_frame(&renderer->log, &renderer->pose, &renderer->params.camera,
                          renderer->params.width, renderer->params.height, frame, &kind);
    if (result != WHIT_OK)
        return result;
    frame->texel_area = (float)(camera_pixel_area(frame, kind) / MIPMAP_PIXEL_TEXELS);
    /* The scene may have other cameras: only the kind of the one in use counts. */
    renderer->effects.called[SCENE_EFFECT_ORTHOGRAPHIC] = kind == CAMERA_ORTHOGRAPHIC;
    renderer->effects.called[SCENE_EFFECT_LENS] =
        kind == CAMERA_LENS && !(renderer->params.effects_removed >> SCENE_EFFECT_LENS & 1);
    renderer->effects.called[SCENE_EFFECT_PANORAMA] = kind == CAMERA_PANORAMA;
    for (int i = 0; i < 3; ++i) {
        frame->zenith[i] = environment->zenith[i] * environment->scale[i];
        frame->horizon[i] = environment->horizon[i] * environment->scale[i];
        frame->ground[i] = environment->ground[i] * environment->scale[i];
        frame->ambient[i] = renderer->scene->ambient[i];
    }
    frame->light_count = renderer->pose.light_count;
    frame->light_samples = lights_samples(renderer);
    frame->environment_size = renderer->scene_buffers.environment_size;
    frame->root = accel->instance_root;
    frame->root8 = accel->bvh8.instance_root;
    frame->shade_base = 0;
    if (accel->flat) {
        frame->root = accel->meshes[0].root;
        frame->root8 = renderer->packets ? accel->bvh8.mesh_roots[0] : 0;
    } else if (accel->single_identity) {
        const struct accel_mesh *mesh = &accel->meshes[renderer->scene->instances[0].mesh];
        frame->root = mesh->root;
        frame->root8 =
            renderer->packets ? accel->bvh8.mesh_roots[renderer->scene->instances[0].mesh] : 0;
        frame->shade_base = mesh->shade_base;
    }
    frame->iterations = 2;
    frame->depth = renderer->params.depth;
    frame->slot_shift = pixels_slot_shift(renderer->params.depth);
    double bailout = renderer->params.bailout;
    frame->bailout = bailout > 0.0 ? (float)bailout : FLT_MIN;
    frame->bailout_shadow = fmaxf(frame->bailout * (float)BAILOUT_SHADOW_SHARE, FLT_MIN);
    return media_frame(&renderer->log, renderer->accel, &renderer->pose, &renderer->bodies, frame);
}

whit_result frame_write(struct renderer *renderer)
{
    struct { /* laid out as struct FrameBuffer of shaders/bind/shading.glsl */
        struct gpu_frame frame;
        float sliders[SLIDERS_MAX];
    } words = {.frame = renderer->frame};
    memcpy(words.sliders, renderer->sliders, sizeof words.sliders);
    return upload_words(renderer, &words, sizeof words, BUFFER_STORAGE, "frame",
                        &renderer->scene_buffers.frame);
}

whit_result frame_upload(struct renderer *renderer)
{
    whit_result result = frame_fill(renderer);
    return result == WHIT_OK ? frame_write(renderer) : result;
}
