/* Which specialization constants a scene gets, and the pipelines made with them. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/material_bits.h"
#include "base/platform.h"
#include "device/pipeline.h"
#include "render/effects.h"
#include "render/hooks.h"
#include "render/lights.h"
#include "render/pixels.h"
#include "render/stage_set.h"
#include "render/textures.h"
#include "render/upload.h"
#include "render/variants.h"
#include "scene/effects.h"

#include "kernels.h"

uint32_t variant_camera(const struct renderer *renderer)
{
    const bool *called = renderer->effects.called;
    if (renderer->views.count)
        return renderer->views.camera;
    return called[SCENE_EFFECT_ORTHOGRAPHIC] ? CAMERA_ORTHOGRAPHIC
           : called[SCENE_EFFECT_PANORAMA]   ? CAMERA_PANORAMA
           : called[SCENE_EFFECT_LENS]       ? CAMERA_LENS
                                             : CAMERA_PERSPECTIVE;
}

bool variant_has_deferred(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    return renderer->params.numerics == NUMERICS_EXACT && !renderer->params.count &&
           !target->probed;
}

uint32_t variant_hit_rows(const struct gpu_spec *spec)
{
    bool has_key = spec->SPEC_NUMERICS == NUMERICS_EXACT && spec->SPEC_MEDIA == MEDIA_TOUCH;
    return has_key || spec->SPEC_INSTANCED ? 2 : 1;
}

static bool only_spheres(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        if (scene->meshes[i].triangle_count > 0)
            return false;
    }
    return true;
}

/* Sets constants that depend on several effects or on a parameter. */
static void refine_effects(const struct renderer *renderer, const struct scene_effects *effects,
                           struct gpu_spec *spec)
{
    const bool *called = effects->called;
    if (spec->SPEC_FRESNEL != FRESNEL_NONE && renderer->params.schlick)
        spec->SPEC_FRESNEL = FRESNEL_SCHLICK;
    bool detail = called[SCENE_EFFECT_TINTED_SHADOWS] &&
                  (called[SCENE_EFFECT_TEXTURES] || called[SCENE_EFFECT_ABSORPTION] ||
                   called[SCENE_EFFECT_VERTEX_COLORS] || called[SCENE_EFFECT_CUTOUTS]);
    spec->SPEC_FILTER_DETAIL = detail ? FILTERS_PATTERNED : FILTERS_PLAIN;
}

static bool priorities_differ(const struct scene *scene)
{
    for (uint32_t i = 1; i < scene->material_count; ++i) {
        if (scene->materials[i].priority != scene->materials[0].priority)
            return true;
    }
    return false;
}

/* Whether rows are written in words of 64 bits. lavapipe writes a vector's elements to a buffer one
   by one: for each it stores the whole vector on the stack and reads the element back. Tests choose
   by WHIT_WIDE_ROWS, 0 or 1, what other processors would have. */
static bool writes_wide_rows(const struct device *device)
{
    const whit_device_info *info = device_get_info(device);
    const char *chosen = getenv("WHIT_WIDE_ROWS");
    bool slow = chosen ? strcmp(chosen, "0") == 0 : platform_reads_back_slowly();
    return info->kind == WHIT_DEVICE_CPU && info->int64 && !slow;
}

/* A user's shape is asked about one light at a time, and so is a probed pixel. The many rays to a
   light with an area, rays without trees, and integers of NUMERICS_EXACT in all kernels can fill an
   invocation's loops, whose iterations drivers limit. Where others do, stages_sample() goes on with
   one light at a time. At NUMERICS_EXACT without packets, STAGE_SHADE_DIRECT may leave some lights
   of a hit to the shadow stages. */
static bool lights_share_dispatches(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    bool exact = renderer->params.numerics == NUMERICS_EXACT;
    return !target->probed && lights_share_hits(&renderer->pose) && !renderer->accel->no_trees &&
           (!exact || (variant_has_deferred(target) && renderer->packets)) &&
           (lights_kinds(&renderer->pose) & LIGHT_FLAT_BITS) == 0 &&
           !shader_has(renderer->params.shader, WHIT_HOOK_INTERSECT);
}

static struct gpu_spec make_spec(const struct target *target, const struct scene_effects *effects,
                                 bool secondary)
{
    const struct renderer *renderer = target->renderer;
    const struct accel *accel = renderer->accel;
    struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    spec.SPEC_GROUP_SIZE = spec.SPEC_LIST_GROUP = spec.SPEC_DEFERRED_GROUP = RENDER_GROUP_SIZE;
    spec.SPEC_LOAD_PATH = renderer->scene_buffers.texel_loads ? LOAD_TEXEL : LOAD_STORAGE;
    spec.SPEC_STACK_SIZE = renderer->node_stack_size;
    spec.SPEC_INSTANCED = !renderer->single_identity && !accel->flat;
    spec.SPEC_FLAT = accel->flat;
    spec.SPEC_CLIPPED = renderer->clipped;
    spec.SPEC_ORDER = (uint32_t)renderer->params.traversal;
    /* Counters, and the leaks of NUMERICS_FAST, are those of the nodes that the twin visits. */
    spec.SPEC_QUANTIZED = renderer->quantized && !spec.SPEC_INSTANCED && !renderer->params.count &&
                          spec.SPEC_ORDER == ORDER_DISTANCE &&
                          renderer->params.numerics != WHIT_NUMERICS_FAST;
    spec.SPEC_NUMERICS = renderer->params.numerics;
    spec.SPEC_COUNT = renderer->params.count;
    spec.SPEC_PROBE = target->probed;
    spec.SPEC_SETTLES = !variant_has_deferred(target);
    /* Few rays are deferred, by a large kernel. lavapipe runs all of it for each subgroup of a
       workgroup, also for those without rays. */
    if (variant_has_deferred(target))
        spec.SPEC_DEFERRED_GROUP = device_get_info(renderer->device)->subgroup_size;
    spec.SPEC_SECONDARY = secondary;
    spec.SPEC_EIGHT_LANES = device_get_info(renderer->device)->subgroup_size == 8;
    spec.SPEC_INTERLEAVE = device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU;
    spec.SPEC_WIDE_ROWS = writes_wide_rows(renderer->device);
    /* The counters need all entries of the node stack in memory. */
    spec.SPEC_SHORT_STACK =
        device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU && !renderer->params.count;
    spec.SPEC_CAMERA = variant_camera(renderer);
    spec.SPEC_LISTED = renderer->params.sampling.kind == WHIT_SAMPLING_ADAPTIVE || target->probed;
    spec.SPEC_VIEWS = renderer->views.count > 0;
    spec.SPEC_PIXEL_DATA = pixels_have_data(target);
    spec.SPEC_AOVS = hooks_aov_count(target);
    spec.SPEC_MINIFICATION = textures_minify(renderer);
    effects_switch(effects, &spec);
    refine_effects(renderer, effects, &spec);
    if (lights_share_dispatches(target))
        spec.SPEC_LIGHTS_EACH = LIGHTS_EACH;
    if (renderer->params.shader) {
        spec.SPEC_HOOKS = renderer->params.shader->hooks;
        spec.SPEC_FUEL = renderer->params.shader->fuel;
    }
    return spec;
}

/* SPEC_LIGHTS bits of the kinds of lights that params.effects_added adds. */
static uint32_t added_lights(const struct renderer *renderer)
{
    struct scene_effects added = {.called = {false}};
    struct gpu_spec spec = GPU_SPEC_DEFAULTS;
    for (int i = 0; i < SCENE_EFFECT_COUNT; ++i)
        added.called[i] = renderer->params.effects_added >> i & 1;
    effects_switch(&added, &spec);
    return spec.SPEC_LIGHTS;
}

struct gpu_spec variant_spec(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    struct gpu_spec spec = make_spec(target, &renderer->effects, renderer->has_secondary);
    if (spec.SPEC_SPHERES != SPHERES_NONE && !renderer->params.all_effects &&
        only_spheres(renderer->scene))
        spec.SPEC_SPHERES = SPHERES_ONLY;
    if (!renderer->params.all_effects)
        spec.SPEC_LIGHTS &= lights_kinds(&renderer->pose) | added_lights(renderer);
    if (!renderer->params.all_effects && spec.SPEC_FILTER_DETAIL)
        spec.SPEC_FILTER_DETAIL = !accel_filters_vary(renderer->accel)       ? FILTERS_PLAIN
                                  : accel_filters_patterned(renderer->accel) ? FILTERS_PATTERNED
                                  : spec.SPEC_ABSORPTION                     ? FILTERS_ABSORB
                                                                             : FILTERS_PLAIN;
    if (!renderer->params.all_effects && spec.SPEC_MEDIA &&
        !media_touch(renderer->scene, &renderer->bodies, &renderer->frame))
        spec.SPEC_MEDIA = MEDIA_ALONE;
    spec.SPEC_PRIORITIES = renderer->params.all_effects || priorities_differ(renderer->scene);
    effects_narrow_textures(renderer, SCENE_MATERIALS_ALL, &spec);
    return spec;
}

struct gpu_spec variant_general_spec(const struct target *target)
{
    struct scene_effects effects = target->renderer->effects;
    const whit_renderer_params all = {.all_effects = true};
    effects_choose(&all, &effects);
    struct gpu_spec spec = make_spec(target, &effects, true);
    spec.SPEC_LISTED = 1;
    return spec;
}

struct gpu_spec variant_async_spec(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    /* The general kernel has code for all effects, except for these where the scene does not call
       for them: buffers then lack the data that their code would read. */
    static const enum scene_effect held[] = {SCENE_EFFECT_SMOOTH_NORMALS,
                                             SCENE_EFFECT_VERTEX_COLORS, SCENE_EFFECT_MEDIA};
    struct scene_effects effects = renderer->effects;
    whit_renderer_params all = renderer->params;
    all.all_effects = true;
    for (size_t i = 0; i < sizeof held / sizeof *held; ++i) {
        if (!effects.called[held[i]])
            all.effects_removed |= UINT64_C(1) << held[i];
    }
    effects_choose(&all, &effects);
    struct gpu_spec spec = make_spec(target, &effects, renderer->has_secondary);
    spec.SPEC_SETTLES = 1; /* one kernel is made sooner than two */
    return spec;
}

/* The bindings of a kernel, while they are put together. */
struct bindings {
    enum binding_kind kinds[BIND_STAGES_COUNT];
    struct buffer *buffers[BIND_STAGES_COUNT];
    struct buffer *none; /* bound in place of buffers that do not exist */
};

static void bind(struct bindings *bindings, int at, enum binding_kind kind, struct buffer *buffer)
{
    bindings->kinds[at] = kind;
    bindings->buffers[at] = buffer ? buffer : bindings->none;
}

/* Binds a buffer that kernels read either as storage buffer or as texel buffer. */
static void bind_loads(struct bindings *bindings, int storage, int texels, bool texel_loads,
                       struct buffer *buffer)
{
    bind(bindings, storage, BINDING_STORAGE, texel_loads ? NULL : buffer);
    bind(bindings, texels, BINDING_TEXELS, texel_loads ? buffer : NULL);
}

/* The bindings that every kernel has. */
static struct bindings bind_trees(const struct target *target)
{
    const struct scene_buffers *scene = &target->renderer->scene_buffers;
    struct bindings bindings = {.none = scene->none};
    bool texels = scene->texel_loads;
    bind_loads(&bindings, BIND_NODES, BIND_NODE_TEXELS, texels, scene->nodes);
    bind_loads(&bindings, BIND_TRIANGLES, BIND_TRIANGLE_TEXELS, texels, scene->triangles);
    bind_loads(&bindings, BIND_INSTANCES, BIND_INSTANCE_TEXELS, texels, scene->instances);
    bind(&bindings, BIND_NODE8_TEXELS, BINDING_TEXELS, scene->nodes8);
    bind(&bindings, BIND_QUANTIZED_TEXELS, BINDING_TEXELS, scene->quantized);
    bind(&bindings, BIND_STATUS, BINDING_STORAGE, target->buffers.status);
    bind(&bindings, BIND_DEFERRED, BINDING_STORAGE, NULL);
    return bindings;
}

/* Parameters of a kernel's pipeline. Its code is the shader's if that has functions in this
   kernel. */
static struct pipeline_params pass_params(const struct target *target,
                                          const struct kernel_code *own,
                                          const struct gpu_spec *spec,
                                          const struct bindings *bindings, uint32_t binding_count,
                                          uint32_t push_bytes, const char *name)
{
    const struct shader_code *code = hooks_code(target, own->name);
    return (struct pipeline_params){
        .spirv = code ? code->words : own->words,
        .spirv_bytes = code ? code->bytes : own->bytes,
        .rewrite = target->renderer->params.portable ? portable_rewrite : NULL,
        .rewrite_user = &target->renderer->portable,
        .rewrite_as = portable_number(&target->renderer->portable),
        .spec = (const uint32_t *)spec,
        .spec_count = GPU_SPEC_COUNT,
        .bindings = bindings->kinds,
        .binding_count = binding_count,
        .push_bytes = push_bytes,
        .name = name,
    };
}

static struct bindings bind_stages(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    const struct scene_buffers *scene = &renderer->scene_buffers;
    const struct pixel_buffers *pixels = &target->buffers;
    const struct queue_buffers *queues = &target->buffers.queues;
    struct bindings bindings = bind_trees(target);
    bool texels = scene->texel_loads;
    bind_loads(&bindings, BIND_SHADING, BIND_SHADING_TEXELS, texels, scene->shading);
    bind_loads(&bindings, BIND_TEXELS, BIND_TEXEL_TEXELS, texels, scene->texels);
    bind(&bindings, BIND_FRAME, BINDING_STORAGE, scene->frame);
    bind(&bindings, BIND_ENVIRONMENT, BINDING_STORAGE, scene->environment);
    bind(&bindings, BIND_PIXELS, BINDING_STORAGE, pixels->pixels);
    bind(&bindings, BIND_IDS, BINDING_STORAGE, pixels->ids);
    bind(&bindings, BIND_LISTED, BINDING_STORAGE, pixels->listed);
    bind(&bindings, BIND_COSTS, BINDING_STORAGE, pixels->costs);
    bind(&bindings, BIND_PROBE, BINDING_STORAGE, target->records);
    bind(&bindings, BIND_DBG, BINDING_STORAGE, target->dbg);
    bind(&bindings, BIND_GENERATIONS, BINDING_STORAGE, queues->generations);
    bind(&bindings, BIND_GENERATION_TEXELS, BINDING_TEXELS, queues->generations);
    bind(&bindings, BIND_RAY_ROWS, BINDING_STORAGE, queues->rays);
    bind(&bindings, BIND_RAY_TEXELS, BINDING_TEXELS, queues->rays);
    bind(&bindings, BIND_DEFERRED, BINDING_STORAGE, queues->deferred);
    bind(&bindings, BIND_RAY_KINDS, BINDING_STORAGE, queues->kinds);
    bind(&bindings, BIND_HIT_ROWS, BINDING_STORAGE, queues->hits);
    bind(&bindings, BIND_HIT_TEXELS, BINDING_TEXELS, queues->hits);
    bind(&bindings, BIND_HIT_LIST, BINDING_STORAGE, queues->hit_list);
    bind(&bindings, BIND_LIT_ROWS, BINDING_STORAGE, queues->lit);
    bind(&bindings, BIND_LIT_TEXELS, BINDING_TEXELS, queues->lit);
    bind(&bindings, BIND_SUMS, BINDING_STORAGE, queues->sums);
    bind(&bindings, BIND_SUM_TEXELS, BINDING_TEXELS, queues->sums);
    bind(&bindings, BIND_LIST_TEXELS, BINDING_TEXELS, queues->hit_list);
    bind(&bindings, BIND_LIT_LIST, BINDING_STORAGE, queues->lit_list);
    bind(&bindings, BIND_LIT_LIST_TEXELS, BINDING_TEXELS, queues->lit_list);
    bind(&bindings, BIND_CUTS, BINDING_STORAGE, queues->cuts);
    bind(&bindings, BIND_CUT_TEXELS, BINDING_TEXELS, queues->cuts);
    bind(&bindings, BIND_AOVS, BINDING_STORAGE, pixels->aovs);
    bind(&bindings, BIND_VIEWS, BINDING_STORAGE, renderer->views.buffer);
    bind(&bindings, BIND_DISTANCES, BINDING_STORAGE, pixels->distances);
    bind(&bindings, BIND_HOOK_ROWS, BINDING_STORAGE, queues->hook_rows);
    bind(&bindings, BIND_HOOK_TEXELS, BINDING_TEXELS, queues->hook_rows);
    bind(&bindings, BIND_SHAPE_SHADOWS, BINDING_STORAGE, queues->shape_shadows);
    bind(&bindings, BIND_CUT_SUMS, BINDING_STORAGE, queues->cut_sums);
    return bindings;
}

bool variant_defers(const struct pipeline_params *params, struct gpu_spec *spec)
{
    memcpy(spec, params->spec, sizeof *spec);
    /* STAGE_SHADE_DIRECT leaves such rays to the shadow stages. */
    if (spec->SPEC_SETTLES || spec->SPEC_DIRECT)
        return false;
    spec->SPEC_SETTLES = 1;
    spec->SPEC_GROUP_SIZE = spec->SPEC_DEFERRED_GROUP;
    spec->SPEC_PACKETS = 0; /* few rays are deferred */
    spec->SPEC_PACKET_RAYS = 1;
    return true;
}

/* Creates the pipelines of a pass: `params` describes the first one. */
static whit_result create_pipelines(struct device *device, const struct pipeline_params *params,
                                    struct pass *pass)
{
    struct gpu_spec spec;
    whit_result result = pipeline_create(device, params, &pass->pipeline);
    if (result != WHIT_OK || !variant_defers(params, &spec))
        return result;
    struct pipeline_params deferred = *params;
    deferred.spec = (const uint32_t *)&spec;
    return pipeline_create(device, &deferred, &pass->deferred);
}

static whit_result create_sets(struct pass *pass, const struct bindings *bindings, uint32_t count)
{
    whit_result result = binding_set_create(pass->pipeline, bindings->buffers, count, &pass->set);
    if (result == WHIT_OK && pass->deferred)
        result = binding_set_create(pass->deferred, bindings->buffers, count, &pass->deferred_set);
    return result;
}

whit_result variant_job_run(struct device *device, const struct variant_job *job, struct pass *pass)
{
    pass->rays_each = job->spec.SPEC_PACKET_RAYS;
    return create_pipelines(device, &job->params, pass);
}

/* Number of camera rays from which on separate kernels for each stage and class pay. In whitted,
   glass and hollow they save 10 to 25 % of a picture's time, some 0.3 us of processor time a camera
   ray. They take 30 ms longer to make if the driver has them in its cache, 300 to 500 ms if not. */
enum { RAYS_FOR_MANY = 150000 };

bool render_few_kernels(const whit_renderer_params *params)
{
    if (params->classes != WHIT_CLASSES_AUTO)
        return params->classes == WHIT_CLASSES_ONE;
    return !params->many_pictures && !params->compile_async &&
           (double)params->width * params->height * fmax((double)params->sampling.count, 1.0) <
               RAYS_FOR_MANY;
}

bool variant_few_kernels(const struct target *target)
{
    return target->probed || target->renderer->few_kernels;
}

uint32_t variant_classes(const struct target *target)
{
    const struct renderer *renderer = target->renderer;
    struct scene_effects none = {.called = {false}};
    /* Rays that a user's function traces may hit materials of either class. */
    bool hooked = shader_is_hooked(renderer->params.shader, kernels[KERNEL_SHADE].name);
    bool both = !hooked && !renderer->params.all_effects && !variant_few_kernels(target) &&
                scene_effects_scan_materials(renderer->scene, SCENE_MATERIALS_OPAQUE, &none) > 0 &&
                scene_effects_scan_materials(renderer->scene, SCENE_MATERIALS_GLASS, &none) > 0;
    return both ? CLASSES_MAX : 1;
}

/* Shadow rays of glass, and of many lights, would leave most lanes of their subgroup idle; those to
   all points of a light with an area would fill an invocation's loops. Rays that read textures or
   pass cut-outs need more of the scene than the kernel of a class knows. Probes and counters, which
   have rows for each light's rays, and shadow catchers are left to the shadow stages. On a GPU it
   was not measured. */
bool variant_lights_directly(const struct target *target, const struct gpu_spec *spec,
                             uint32_t classes)
{
    enum { LIGHTS_MAX = 4 };
    const struct renderer *renderer = target->renderer;
    struct scene_effects none = {.called = {false}};
    bool plain = classes > 1 ||
                 scene_effects_scan_materials(renderer->scene, SCENE_MATERIALS_GLASS, &none) == 0;
    bool patterned = spec->SPEC_FILTERS && spec->SPEC_FILTER_DETAIL == FILTERS_PATTERNED;
    return device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU && plain &&
           !renderer->packets && !target->stages.no_direct && !target->probed &&
           !spec->SPEC_COUNT && !spec->SPEC_CATCHERS && !spec->SPEC_CUTOUTS && !patterned &&
           !renderer->params.shader && !renderer->params.all_effects &&
           !renderer->accel->no_trees && spec->SPEC_SHADOWS && spec->SPEC_LIGHTS &&
           !(spec->SPEC_LIGHTS & LIGHT_FLAT_BITS) && renderer->pose.light_count > 0 &&
           renderer->pose.light_count <= LIGHTS_MAX;
}

bool variant_calls_rays(const struct gpu_spec *spec)
{
    return spec->SPEC_SECONDARY && (spec->SPEC_REFLECTION || spec->SPEC_REFRACTION ||
                                    spec->SPEC_CUTOUTS || spec->SPEC_CATCHERS);
}

static uint32_t lit_parts(const struct renderer *renderer, const struct gpu_spec *spec)
{
    bool bent = spec->SPEC_SMOOTH_NORMALS || spec->SPEC_NORMAL_MAPS ||
                shader_has(renderer->params.shader, WHIT_HOOK_SURFACE);
    bool absorbing = spec->SPEC_FILTER_DETAIL && spec->SPEC_ABSORPTION && spec->SPEC_MEDIA;
    return (bent ? LIT_HAS_NG : 0) | (spec->SPEC_HIGHLIGHTS ? LIT_HAS_HIGHLIGHT : 0) |
           (absorbing ? LIT_HAS_ABSORPTION : 0);
}

/* Rays that a lane has in packets of a ray batch, whose rays start at one point and go about the
   same way. */
enum { BEAM_RAYS = 8 };

/* Whether packets may find records that need a closer look, as settles() of bind/traverse.glsl:
   that is done for one ray of a lane only, so such packets have one ray a lane. */
static bool packets_look(const struct gpu_spec *spec, bool shadow)
{
    return (spec->SPEC_NUMERICS == NUMERICS_EXACT && spec->SPEC_SETTLES) || spec->SPEC_CUTOUTS ||
           (shadow && spec->SPEC_FILTERS && spec->SPEC_FILTER_DETAIL == FILTERS_PATTERNED) ||
           (!shadow && spec->SPEC_SPHERES != SPHERES_NONE && spec->SPEC_CULLING);
}

/* On lavapipe, camera rays and the shadow rays of their hits go in packets. Later rays, which go in
   all directions, are quicker ray by ray. */
static void choose_packets(const struct renderer *renderer, enum stage stage, struct gpu_spec *spec)
{
    uint32_t stack = renderer->packet_stack_size;
    if (!renderer->packets || spec->SPEC_PROBE || stack > PACKET_STACK_MAX)
        return;
    spec->SPEC_LIT_RAYS = packets_look(spec, true) ? 1 : renderer->packet_rays;
    if (stage != STAGE_CAMERA && stage != STAGE_SHADOW)
        return;
    spec->SPEC_PACKETS = 1;
    bool from_eye = stage == STAGE_CAMERA && spec->SPEC_CAMERA == CAMERA_PERSPECTIVE &&
                    !shader_has(renderer->params.shader, WHIT_HOOK_CAMERA);
    bool to_point = stage == STAGE_SHADOW && !(spec->SPEC_LIGHTS & 1u << LIGHT_DIRECTIONAL);
    spec->SPEC_BEAM = spec->SPEC_INSTANCED ? BEAM_NONE
                      : from_eye           ? BEAM_STARTS
                      : to_point           ? BEAM_ENDS
                                           : BEAM_NONE;
    spec->SPEC_PACKET_STACK = stack;
    spec->SPEC_PACKET_RAYS = packets_look(spec, stage == STAGE_SHADOW) ? 1 : renderer->packet_rays;
}

bool variant_can_split_hits(const struct target *target)
{
    const whit_renderer_params *params = &target->renderer->params;
    const bool *called = target->renderer->effects.called;
    const whit_shader *shader = params->shader;
    /* STAGE_HIT_FETCH is whit's own kernel, which cannot call a surface() or camera() of the
       user's. */
    return !target->probed && params->step && shader_has(shader, WHIT_HOOK_SHADE) &&
           !shader_has(shader, WHIT_HOOK_SURFACE) && !shader_has(shader, WHIT_HOOK_CAMERA) &&
           !shader->stages && (called[SCENE_EFFECT_TEXTURES] || called[SCENE_EFFECT_NORMAL_MAPS]);
}

bool variant_splits_hits(const struct target *target)
{
    enum { LOOKED_UP = SHADER_REACHES_TEXTURES | SHADER_REACHES_NORMALS };
    const struct shader_code *code = hooks_code(target, hook_kernels[HOOK_KERNEL_HIT].name);
    return target->renderer->params.few_pixels && variant_can_split_hits(target) && code &&
           (code->reaches & LOOKED_UP);
}

/* Switches off in the kernel of surface() and shade() what neither of them reads, though other
   kernels may need it. Vertex colours stay if there is a surface(): its kernel stores them for
   shade.comp. */
static void narrow_to_functions(const struct target *target, struct gpu_spec *spec)
{
    const struct renderer *renderer = target->renderer;
    const struct shader_code *code = hooks_code(target, hook_kernels[HOOK_KERNEL_HIT].name);
    if (!code || renderer->params.all_effects || renderer->params.shader->stages)
        return;
    uint32_t reaches = code->reaches;
    if (!(reaches & SHADER_REACHES_TEXTURES))
        spec->SPEC_TEXTURES = 0;
    if (!(reaches & SHADER_REACHES_METAL_ROUGH))
        spec->SPEC_METAL_ROUGH = 0;
    if (!(reaches & SHADER_REACHES_EMISSION))
        spec->SPEC_EMISSION = 0;
    if (!(reaches & SHADER_REACHES_HIGHLIGHTS))
        spec->SPEC_HIGHLIGHTS = 0;
    if (!(reaches & SHADER_REACHES_SHARES))
        spec->SPEC_FRESNEL = FRESNEL_NONE;
    if (!(reaches & SHADER_REACHES_NORMALS))
        spec->SPEC_NORMAL_MAPS = 0;
    bool changes = shader_has(renderer->params.shader, WHIT_HOOK_SURFACE);
    if (!(reaches & SHADER_REACHES_VERTEX_COLORS) && !changes)
        spec->SPEC_VERTEX_COLORS = 0;
}

/* Whether shading traces rays: to surfaces in contact, to lights, or where a user's functions do.
   If not, its code is the same at all levels of numerics. */
static bool shading_traces(const struct target *target, const struct gpu_spec *spec)
{
    return spec->SPEC_MEDIA == MEDIA_TOUCH || spec->SPEC_PROBE || spec->SPEC_DIRECT ||
           hooks_code(target, kernels[KERNEL_SHADE].name);
}

void variant_job_init(const struct target *target, const struct gpu_spec *set_spec,
                      uint32_t classes, enum stage stage, struct variant_job *job)
{
    const struct renderer *renderer = target->renderer;
    static const struct {
        const struct kernel_code *kernel;
        const char *name;
        bool deferred;
        uint32_t generations;
    } stages[STAGE_COUNT] = {
        [STAGE_CAMERA] = {&kernels[KERNEL_CLOSEST], "camera", true, 1},
        [STAGE_CLOSEST] = {&kernels[KERNEL_CLOSEST], "closest", true, 2},
        [STAGE_SHADE] = {&kernels[KERNEL_SHADE], "shade", true, 3},
        [STAGE_SHADE_GLASS] = {&kernels[KERNEL_SHADE], "shade glass", true, 3},
        [STAGE_SHADE_DIRECT] = {&kernels[KERNEL_SHADE], "shade and light", true, 3},
        [STAGE_SHADOW] = {&kernels[KERNEL_SHADOW], "shadow", true, 1},
        [STAGE_SHADOW_LATER] = {&kernels[KERNEL_SHADOW], "shadow later", true, 2},
        [STAGE_RESOLVE] = {&kernels[KERNEL_RESOLVE], "resolve", false, 1},
        [STAGE_RESOLVE_LATER] = {&kernels[KERNEL_RESOLVE], "resolve later", false, 2},
        [STAGE_MISS] = {&hook_kernels[HOOK_KERNEL_MISS], "miss", false, 3},
        [STAGE_SHAPE] = {&hook_kernels[HOOK_KERNEL_SHAPE], "shape", false, 3},
        [STAGE_SHAPE_LIGHT] = {&hook_kernels[HOOK_KERNEL_SHAPE], "shape, lights", false, 3},
        [STAGE_HIT] = {&hook_kernels[HOOK_KERNEL_HIT], "hit", false, 3},
        [STAGE_HIT_FETCH] = {&hook_kernels[HOOK_KERNEL_HIT], "hit, fetched", false, 3},
        [STAGE_HIT_CALL] = {&hook_kernels[HOOK_KERNEL_HIT], "hit, called", false, 3},
        [STAGE_AOV] = {&hook_kernels[HOOK_KERNEL_AOV], "aov", false, 1},
        [STAGE_POST] = {&hook_kernels[HOOK_KERNEL_POST], "post", false, 1},
    };
    struct bindings bindings = bind_stages(target);
    *job = (struct variant_job){.spec = *set_spec};
    struct gpu_spec *spec = &job->spec;
    memcpy(job->kinds, bindings.kinds, sizeof job->kinds);
    spec->SPEC_SETTLES |= !stages[stage].deferred;
    spec->SPEC_DIRECT = stage == STAGE_SHADE_DIRECT;
    spec->SPEC_ANY_HIT = stage == STAGE_SHAPE_LIGHT;
    if (stages[stage].kernel == &kernels[KERNEL_SHADE] && !shading_traces(target, spec)) {
        spec->SPEC_NUMERICS = NUMERICS_WATERTIGHT;
        spec->SPEC_SETTLES = 1;
    }
    spec->SPEC_LIT_PARTS = lit_parts(renderer, spec);
    spec->SPEC_CLASSES = classes;
    spec->SPEC_SEGMENTS = renderer->params.segments ? renderer->params.segments
                          : spec->SPEC_INTERLEAVE   ? 2
                                                    : 1;
    spec->SPEC_GENERATIONS = renderer->has_secondary ? stages[stage].generations : 1;
    choose_packets(renderer, stage, spec);
    if (classes > 1 && stages[stage].kernel == &kernels[KERNEL_SHADE])
        effects_narrow_to_class(renderer, stage == STAGE_SHADE_GLASS ? CLASS_GLASS : CLASS_PLAIN,
                                spec);
    if (spec->SPEC_DIRECT) /* its shadow rays meet the primitives of both classes */
        spec->SPEC_SPHERES = set_spec->SPEC_SPHERES;
    if (stage == STAGE_HIT || stage == STAGE_HIT_CALL)
        narrow_to_functions(target, spec);
    spec->SPEC_HIT_PART = stage == STAGE_HIT_FETCH  ? HIT_PART_FETCH
                          : stage == STAGE_HIT_CALL ? HIT_PART_CALL
                                                    : HIT_PART_ALL;
    job->params = pass_params(target, stages[stage].kernel, spec, &bindings, BIND_STAGES_COUNT,
                              sizeof(struct gpu_chunk), stages[stage].name);
    job->params.bindings = job->kinds;
    if (stage == STAGE_HIT_FETCH) { /* the same kernel for any file of the user */
        job->params.spirv = stages[stage].kernel->words;
        job->params.spirv_bytes = stages[stage].kernel->bytes;
    }
}

whit_result variant_bind_stage(const struct target *target, struct pass *pass)
{
    struct bindings bindings = bind_stages(target);
    return create_sets(pass, &bindings, BIND_STAGES_COUNT);
}

whit_result variant_create_tests(const struct target *target, struct buffer *found,
                                 struct pass *pass)
{
    const struct renderer *renderer = target->renderer;
    struct bindings bindings = bind_stages(target);
    struct gpu_spec spec = variant_spec(target);
    spec.SPEC_SETTLES = 1;
    spec.SPEC_CHECK_WORDS = shader_tests_words(&renderer->params.shader->tests);
    spec.SPEC_LIT_PARTS = lit_parts(renderer, &spec);
    bind(&bindings, BIND_PROBE, BINDING_STORAGE, found);
    const struct pipeline_params params =
        pass_params(target, &hook_kernels[HOOK_KERNEL_TEST], &spec, &bindings, BIND_STAGES_COUNT,
                    sizeof(struct gpu_chunk), "tests");
    whit_result result = pipeline_create(renderer->device, &params, &pass->pipeline);
    return result == WHIT_OK ? create_sets(pass, &bindings, BIND_STAGES_COUNT) : result;
}

bool variant_has_beams(const struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    const whit_renderer_params *params = &renderer->params;
    return params->numerics == WHIT_NUMERICS_WATERTIGHT && upload_can_widen(renderer) &&
           (!params->count || params->packets == WHIT_PACKETS_ON) &&
           (renderer->single_identity || accel->flat);
}

whit_result variant_create_trace(struct renderer *renderer, bool any, bool beams, struct pass *pass)
{
    struct bindings bindings = bind_trees(&renderer->picture);
    bind(&bindings, BIND_DEFERRED, BINDING_STORAGE, renderer->trace.deferred);
    bind_loads(&bindings, BIND_RAYS, BIND_BATCH_TEXELS, renderer->scene_buffers.texel_loads,
               renderer->trace.rays);
    bind(&bindings, BIND_HITS, BINDING_STORAGE, renderer->trace.hits);
    bind(&bindings, BIND_TRACE_COSTS, BINDING_STORAGE, renderer->trace.costs);
    struct gpu_spec spec = variant_spec(&renderer->picture);
    spec.SPEC_ANY_HIT = any;
    spec.SPEC_CUTOUTS = 0;
    spec.SPEC_FILTERS = 0;
    spec.SPEC_FILTER_DETAIL = 0;
    spec.SPEC_CULLING = 0;
    if (beams) {
        spec.SPEC_PACKETS = 1;
        spec.SPEC_BEAM = BEAM_STARTS;
        spec.SPEC_PACKET_RAYS = BEAM_RAYS;
        spec.SPEC_PACKET_STACK = renderer->packet_stack_size;
    }
    pass->rays_each = spec.SPEC_PACKET_RAYS;
    const struct pipeline_params params =
        pass_params(&renderer->picture, &kernels[KERNEL_TRACE], &spec, &bindings, BIND_TRACE_COUNT,
                    sizeof(struct gpu_batch),
                    beams ? any ? "trace any together" : "trace closest together"
                    : any ? "trace any"
                          : "trace closest");
    whit_result result = create_pipelines(renderer->device, &params, pass);
    return result == WHIT_OK ? create_sets(pass, &bindings, BIND_TRACE_COUNT) : result;
}

bool renderer_compiles(const struct renderer *renderer, enum scene_effect effect)
{
    return (unsigned)effect < SCENE_EFFECT_COUNT && renderer->effects.called[effect];
}

void pass_unbind(struct pass *pass)
{
    binding_set_destroy(pass->set);
    binding_set_destroy(pass->deferred_set);
    pass->set = pass->deferred_set = NULL;
}

void pass_finish(struct pass *pass)
{
    pass_unbind(pass);
    pipeline_destroy(pass->pipeline);
    pipeline_destroy(pass->deferred);
    *pass = (struct pass){0};
}

void passes_unbind(struct renderer *renderer)
{
    stages_unbind(&renderer->picture.stages);
    stages_unbind(&renderer->probe.stages);
    for (int i = 0; i < 4; ++i)
        pass_finish(&renderer->trace.passes[i / 2][i % 2]);
}

void passes_finish(struct renderer *renderer)
{
    renderer->kept.known = false;
    renderer->async.general = false;
    passes_unbind(renderer);
    stage_set_finish(&renderer->picture.stages.set);
    stage_set_finish(&renderer->probe.stages.set);
}
