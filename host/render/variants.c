/* Which specialization constants a scene gets, and the pipelines made with them. */
#include "render/renderer.h"

#include "kernels.h"

struct gpu_spec variant_spec(const struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    const struct scene_effects *effects = &renderer->effects;
    struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    uint32_t depth = accel->mesh_depth + (accel->single_identity ? 0 : accel->instance_depth);
    spec.SPEC_GROUP_SIZE = RENDER_GROUP_SIZE;
    spec.SPEC_LOAD_PATH = renderer->scene_buffers.texel_loads ? LOAD_TEXEL : LOAD_STORAGE;
    spec.SPEC_STACK_SIZE = depth > 0 ? depth : 1;
    spec.SPEC_INSTANCED = !accel->single_identity;
    spec.SPEC_SECONDARY = renderer->has_secondary;
    spec.SPEC_INTERLEAVE = device_get_info(renderer->device)->kind == DEVICE_CPU;
    spec.SPEC_SHORT_STACK = device_get_info(renderer->device)->kind == DEVICE_CPU;
    /* Shadows and camera kind are asked for by the user, not found in the scene. */
    spec.SPEC_SHADOWS = !renderer->params.no_shadows;
    spec.SPEC_ORTHOGRAPHIC = renderer->effects.called[SCENE_EFFECT_ORTHOGRAPHIC];
    if (renderer->params.all_effects)
        return spec;
    const bool *called = effects->called;
    spec.SPEC_REFRACTION = called[SCENE_EFFECT_REFRACTION];
    spec.SPEC_REFLECTION = called[SCENE_EFFECT_REFLECTION] || called[SCENE_EFFECT_FRESNEL];
    spec.SPEC_ABSORPTION = called[SCENE_EFFECT_ABSORPTION];
    spec.SPEC_CUTOUTS = called[SCENE_EFFECT_CUTOUTS];
    spec.SPEC_TEXTURES = called[SCENE_EFFECT_TEXTURES];
    spec.SPEC_NORMAL_MAPS = called[SCENE_EFFECT_NORMAL_MAPS];
    spec.SPEC_ENVIRONMENT_MAP = called[SCENE_EFFECT_ENVIRONMENT_MAP];
    spec.SPEC_SMOOTH_NORMALS = called[SCENE_EFFECT_SMOOTH_NORMALS];
    spec.SPEC_VERTEX_COLORS = called[SCENE_EFFECT_VERTEX_COLORS];
    spec.SPEC_METAL_ROUGH = called[SCENE_EFFECT_METAL_ROUGH];
    spec.SPEC_HIGHLIGHTS = called[SCENE_EFFECT_HIGHLIGHTS] || called[SCENE_EFFECT_METAL_ROUGH];
    spec.SPEC_LIGHTS = renderer->pose.light_count > 0;
    spec.SPEC_FILTERS = called[SCENE_EFFECT_REFRACTION] || called[SCENE_EFFECT_CUTOUTS];
    return spec;
}

/* The scene lacks what is NULL. */
static void bind_or_none(struct buffer **at, struct buffer *buffer, struct buffer *none)
{
    *at = buffer ? buffer : none;
}

/* The bindings that every kernel has. */
static void bind_shared(const struct renderer *renderer, enum binding_kind *kinds,
                        struct buffer **buffers)
{
    const struct scene_buffers *scene = &renderer->scene_buffers;
    struct buffer *none = scene->none;
    const struct {
        int storage, texels;
        struct buffer *buffer;
    } doubles[] = {
        {BIND_NODES, BIND_NODE_TEXELS, scene->nodes},
        {BIND_TRIANGLES, BIND_TRIANGLE_TEXELS, scene->triangles},
        {BIND_INSTANCES, BIND_INSTANCE_TEXELS, scene->instances},
        {BIND_TEXELS, BIND_TEXEL_TEXELS, scene->texels},
    };
    for (size_t i = 0; i < sizeof doubles / sizeof *doubles; ++i) {
        kinds[doubles[i].storage] = BINDING_STORAGE;
        kinds[doubles[i].texels] = BINDING_TEXELS;
        bind_or_none(&buffers[doubles[i].storage], scene->texel_loads ? NULL : doubles[i].buffer,
                     none);
        bind_or_none(&buffers[doubles[i].texels], scene->texel_loads ? doubles[i].buffer : NULL,
                     none);
    }
    kinds[BIND_STATUS] = kinds[BIND_MATERIALS] = BINDING_STORAGE;
    kinds[BIND_TEXTURES] = kinds[BIND_TRIANGLE_UVS] = BINDING_STORAGE;
    bind_or_none(&buffers[BIND_STATUS], renderer->pixel_buffers.status, none);
    bind_or_none(&buffers[BIND_MATERIALS], scene->materials, none);
    bind_or_none(&buffers[BIND_TEXTURES], scene->textures, none);
    bind_or_none(&buffers[BIND_TRIANGLE_UVS], scene->uvs, none);
}

static whit_result create_pass(struct renderer *renderer, enum kernel kernel,
                               const struct gpu_spec *spec, const enum binding_kind *kinds,
                               uint32_t binding_count, uint32_t push_bytes, const char *name,
                               struct pass *pass)
{
    const struct pipeline_params params = {
        .spirv = kernels[kernel].words,
        .spirv_bytes = kernels[kernel].bytes,
        .spec = (const uint32_t *)spec,
        .spec_count = GPU_SPEC_COUNT,
        .bindings = kinds,
        .binding_count = binding_count,
        .push_bytes = push_bytes,
        .name = name,
    };
    return pipeline_create(renderer->device, &params, &pass->pipeline);
}

whit_result variant_create_whitted(struct renderer *renderer, struct pass *pass)
{
    const struct scene_buffers *scene = &renderer->scene_buffers;
    const struct pixel_buffers *pixels = &renderer->pixel_buffers;
    enum binding_kind kinds[BIND_WHITTED_COUNT] = {BINDING_NONE};
    struct buffer *buffers[BIND_WHITTED_COUNT] = {NULL};
    bind_shared(renderer, kinds, buffers);
    const struct {
        int binding;
        struct buffer *buffer;
    } own[] = {
        {BIND_TRIANGLE_MATERIALS, scene->triangle_materials},
        {BIND_TRIANGLE_NORMALS, scene->normals},
        {BIND_TRIANGLE_COLORS, scene->colors},
        {BIND_FRAME, scene->frame},
        {BIND_LIGHTS, scene->lights},
        {BIND_ENVIRONMENT, scene->environment},
        {BIND_PIXELS, pixels->pixels},
        {BIND_IDS, pixels->ids},
        {BIND_COUNTS, pixels->counts},
        {BIND_RAY_STACKS, pixels->ray_stacks},
        {BIND_WORK_IN, pixels->work[0]},
        {BIND_WORK_OUT, pixels->work[1]},
    };
    for (size_t i = 0; i < sizeof own / sizeof *own; ++i) {
        kinds[own[i].binding] = BINDING_STORAGE;
        bind_or_none(&buffers[own[i].binding], own[i].buffer, scene->none);
    }
    struct gpu_spec spec = variant_spec(renderer);
    whit_result result = create_pass(renderer, KERNEL_WHITTED, &spec, kinds, BIND_WHITTED_COUNT,
                                     sizeof(struct gpu_chunk), "whitted", pass);
    for (int i = 0; result == WHIT_OK && i < 2; ++i) {
        bind_or_none(&buffers[BIND_WORK_IN], pixels->work[i], scene->none);
        bind_or_none(&buffers[BIND_WORK_OUT], pixels->work[1 - i], scene->none);
        result = binding_set_create(pass->pipeline, buffers, BIND_WHITTED_COUNT, &pass->sets[i]);
    }
    return result;
}

whit_result variant_create_trace(struct renderer *renderer, bool any, struct pass *pass)
{
    enum binding_kind kinds[BIND_TRACE_COUNT] = {BINDING_NONE};
    struct buffer *buffers[BIND_TRACE_COUNT] = {NULL};
    bind_shared(renderer, kinds, buffers);
    kinds[BIND_RAYS] = kinds[BIND_HITS] = BINDING_STORAGE;
    buffers[BIND_RAYS] = renderer->trace.rays;
    buffers[BIND_HITS] = renderer->trace.hits;
    struct gpu_spec spec = variant_spec(renderer);
    spec.SPEC_ANY_HIT = any;
    spec.SPEC_CUTOUTS = 0;
    spec.SPEC_FILTERS = 0;
    whit_result result =
        create_pass(renderer, KERNEL_TRACE, &spec, kinds, BIND_TRACE_COUNT,
                    sizeof(struct gpu_batch), any ? "trace any" : "trace closest", pass);
    if (result == WHIT_OK)
        result = binding_set_create(pass->pipeline, buffers, BIND_TRACE_COUNT, &pass->sets[0]);
    return result;
}

void pass_finish(struct pass *pass)
{
    binding_set_destroy(pass->sets[0]);
    binding_set_destroy(pass->sets[1]);
    pipeline_destroy(pass->pipeline);
    *pass = (struct pass){0};
}
