#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/threads.h"
#include "twin/traverse.h"

_Static_assert(sizeof(whit_ray) == sizeof(struct gpu_ray), "rays are handed on as they are");
_Static_assert(sizeof(whit_hit) == sizeof(struct gpu_hit), "hits are handed on as they are");
_Static_assert(offsetof(whit_ray, t_max) == offsetof(struct gpu_ray, t_max), "ray layout");
_Static_assert(offsetof(whit_hit, instance) == offsetof(struct gpu_hit, instance), "hit layout");

_Static_assert((uint32_t)WHIT_RAY_KINDS == RAY_KIND_COUNT &&
                   (uint32_t)WHIT_RAY_REFRACTED == RAY_REFRACTED,
               "kinds of rays");

enum { DEPTH_DEFAULT = 8, LIGHT_SAMPLES_DEFAULT = 16, CPU_BATCH = 4096 };

static uint32_t effect_by_name(const char *name, size_t length)
{
    for (uint32_t i = 0; i < SCENE_EFFECT_COUNT; ++i) {
        const char *own = scene_effect_name((enum scene_effect)i);
        if (strlen(own) == length && strncmp(own, name, length) == 0)
            return i;
    }
    return SCENE_EFFECT_COUNT;
}

/* One "+name" or "-name" of `length` characters. */
static whit_result switch_effect(const struct log *log, const char *text, size_t length,
                                 struct render_params *out)
{
    bool adds = text[0] == '+';
    if (!adds && text[0] != '-') {
        log_error(log, "effects: `%.*s`: after auto or all, every name has a + or a - in front",
                  (int)length, text);
        return WHIT_ERROR_USAGE;
    }
    uint32_t effect = effect_by_name(text + 1, length - 1);
    if (effect == SCENE_EFFECT_COUNT) {
        log_error(log, "effects: there is no effect `%.*s`", (int)length - 1, text + 1);
        return WHIT_ERROR_USAGE;
    }
    if (adds ? !render_effect_can_add(effect) : !render_effect_can_remove(effect)) {
        log_error(log, "effects: `%s` cannot be %s: the scene's %s decides",
                  scene_effect_name(effect), adds ? "added" : "left out",
                  effect == SCENE_EFFECT_INSTANCES || effect == SCENE_EFFECT_SPHERES ? "geometry"
                                                                                     : "camera");
        return WHIT_ERROR_USAGE;
    }
    uint64_t bit = UINT64_C(1) << effect;
    if ((adds ? out->effects_removed : out->effects_added) & bit) {
        log_error(log, "effects: `%s` is both added and left out", scene_effect_name(effect));
        return WHIT_ERROR_USAGE;
    }
    *(adds ? &out->effects_added : &out->effects_removed) |= bit;
    return WHIT_OK;
}

/* "auto", "all", "+a,-b", "all,-b". */
static whit_result effects_from_text(const struct log *log, const char *text,
                                     struct render_params *out)
{
    whit_result result = WHIT_OK;
    const char *at = text ? text : "auto";
    for (bool first = true; result == WHIT_OK && at; first = false) {
        size_t length = strcspn(at, ",");
        if (first && length == 3 && strncmp(at, "all", length) == 0)
            out->all_effects = true;
        else if (!first || length != 4 || strncmp(at, "auto", length) != 0)
            result = switch_effect(log, at, length, out);
        at = at[length] ? at + length + 1 : NULL;
    }
    return result;
}

const char *whit_effect_name(uint32_t index)
{
    return index < SCENE_EFFECT_COUNT ? scene_effect_name((enum scene_effect)index) : NULL;
}

bool whit_effect_can_add(uint32_t index)
{
    return index < SCENE_EFFECT_COUNT && render_effect_can_add((enum scene_effect)index);
}

bool whit_effect_can_remove(uint32_t index)
{
    return index < SCENE_EFFECT_COUNT && render_effect_can_remove((enum scene_effect)index);
}

bool whit_renderer_compiles(const whit_renderer *renderer, uint32_t effect)
{
    return renderer->renderer && effect < SCENE_EFFECT_COUNT &&
           renderer_compiles(renderer->renderer, (enum scene_effect)effect);
}

whit_renderer_params whit_renderer_defaults(void)
{
    return (whit_renderer_params){.width = 640,
                                  .height = 480,
                                  .samples = 1,
                                  .depth = DEPTH_DEFAULT,
                                  .light_samples = LIGHT_SAMPLES_DEFAULT,
                                  .bailout = WHIT_BAILOUT_DEFAULT};
}

whit_result render_params_from_public(const struct log *log, const whit_renderer_params *params,
                                      struct render_params *out)
{
    *out = (struct render_params){
        .width = params->width,
        .height = params->height,
        .camera = params->camera,
        .time_s = params->time_s,
        .samples = params->samples,
        .depth = params->depth,
        .bailout = params->bailout != 0.0 ? params->bailout : -1.0,
        .no_shadows = params->shadows == WHIT_SHADOWS_NONE,
        .adaptive = params->adaptive,
        .light_samples = params->light_samples,
        .schlick = params->schlick,
        .opaque_shadows = params->shadows == WHIT_SHADOWS_OPAQUE,
        .compile_async = params->compile_async,
        .many_pictures = params->many_pictures,
        .tile_size = params->tile_size,
        .cancel = params->cancel,
        .progress = params->progress,
        .progress_user = params->progress_user,
        .time_limit_s = params->time_limit_s,
        .order = params->traversal == WHIT_TRAVERSAL_SIGN    ? ORDER_SIGN
                 : params->traversal == WHIT_TRAVERSAL_BASIC ? ORDER_BASIC
                                                             : ORDER_DISTANCE,
        .numerics = params->numerics == WHIT_NUMERICS_FAST    ? NUMERICS_FAST
                    : params->numerics == WHIT_NUMERICS_EXACT ? NUMERICS_EXACT
                                                              : NUMERICS_WATERTIGHT,
        .packets = params->packets == WHIT_PACKETS_ON    ? RENDER_PACKETS_ON
                   : params->packets == WHIT_PACKETS_OFF ? RENDER_PACKETS_OFF
                                                         : RENDER_PACKETS_AUTO,
        .classes = params->classes == WHIT_CLASSES_ONE    ? RENDER_CLASSES_ONE
                   : params->classes == WHIT_CLASSES_MANY ? RENDER_CLASSES_MANY
                                                          : RENDER_CLASSES_AUTO,
        .segments = params->segments,
        .load_path = params->load_path == WHIT_LOAD_STORAGE ? RENDER_LOAD_STORAGE
                     : params->load_path == WHIT_LOAD_TEXEL ? RENDER_LOAD_TEXEL
                                                            : RENDER_LOAD_AUTO,
        .count = params->count,
    };
    return effects_from_text(log, params->effects, out);
}

whit_classes whit_classes_of(const whit_renderer_params *params)
{
    struct render_params inner;
    whit_result result = render_params_from_public(&(struct log){0}, params, &inner);
    return result == WHIT_OK && render_few_kernels(&inner) ? WHIT_CLASSES_ONE : WHIT_CLASSES_MANY;
}

static whit_result pose_on_cpu(struct accel *accel, double time_s)
{
    struct scene_pose pose = {0};
    whit_result result = scene_pose_init(accel->scene, time_s, &pose);
    if (result == WHIT_OK)
        result = accel_pose(accel, &pose);
    scene_pose_finish(&pose);
    return result;
}

whit_result whit_renderer_create(whit_device *device, whit_accel *accel,
                                 const whit_renderer_params *params, whit_renderer **out)
{
    const whit_renderer_params defaults = whit_renderer_defaults();
    if (!params)
        params = &defaults;
    *out = NULL;
    struct log log = device ? device->log : accel->log;
    struct render_params inner;
    whit_result result = render_params_from_public(&log, params, &inner);
    if (result != WHIT_OK)
        return result;
    whit_renderer *renderer = calloc(1, sizeof *renderer);
    if (!renderer) {
        log_error(&log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    renderer->log = log;
    renderer->accel = accel->accel;
    renderer->params = *params;
    renderer->order = inner.order;
    renderer->numerics = inner.numerics;
    result = device
                 ? renderer_create(&log, device->device, accel->accel, &inner, &renderer->renderer)
                 : pose_on_cpu(accel->accel, params->time_s);
    if (result != WHIT_OK) {
        whit_renderer_destroy(renderer);
        return result;
    }
    *out = renderer;
    return WHIT_OK;
}

void whit_renderer_destroy(whit_renderer *renderer)
{
    if (!renderer)
        return;
    renderer_destroy(renderer->renderer);
    free(renderer);
}

whit_result api_need_device(const whit_renderer *renderer)
{
    if (renderer->renderer)
        return WHIT_OK;
    log_error(&renderer->log, "this renderer was made without a device");
    return WHIT_ERROR_USAGE;
}

whit_result whit_renderer_render(whit_renderer *renderer)
{
    whit_result result = api_need_device(renderer);
    return result == WHIT_OK ? renderer_render(renderer->renderer) : result;
}

whit_result whit_renderer_set_time(whit_renderer *renderer, double time_s)
{
    if (!isfinite(time_s)) {
        log_error(&renderer->log, "a time of %g s: it must be finite", time_s);
        return WHIT_ERROR_USAGE;
    }
    return renderer->renderer ? renderer_set_time(renderer->renderer, time_s)
                              : pose_on_cpu(renderer->accel, time_s);
}

whit_result whit_renderer_set_view(whit_renderer *renderer, const whit_renderer_params *params)
{
    struct render_params inner;
    whit_result result = api_need_device(renderer);
    if (result == WHIT_OK)
        result = render_params_from_public(&renderer->log, params, &inner);
    if (result == WHIT_OK)
        result = renderer_set_view(renderer->renderer, &inner);
    if (result == WHIT_OK) {
        const volatile bool *cancel = renderer->params.cancel;
        renderer->params = *params;
        renderer->params.cancel = cancel;
    }
    return result;
}

whit_result whit_renderer_get_kernel(const whit_renderer *renderer, whit_kernel_info *info)
{
    struct render_kernel_info inner;
    *info = (whit_kernel_info){0};
    whit_result result = api_need_device(renderer);
    if (result == WHIT_OK)
        result = renderer_get_kernel(renderer->renderer, &inner);
    if (result == WHIT_OK)
        *info = (whit_kernel_info){
            .instructions = inner.instructions,
            .general_instructions = inner.general_instructions,
            .largest_instructions = inner.largest_instructions,
            .bindings = inner.bindings,
            .general_bindings = inner.general_bindings,
        };
    return result;
}

whit_result whit_kernels_list(whit_device *device, whit_accel *accel,
                              const whit_renderer_params *params, whit_kernel *kernels,
                              uint32_t *count)
{
    const whit_renderer_params defaults = whit_renderer_defaults();
    struct render_params inner;
    *count = 0;
    whit_result result =
        render_params_from_public(&device->log, params ? params : &defaults, &inner);
    return result == WHIT_OK ? render_list_kernels(&device->log, device->device, accel->accel,
                                                   &inner, kernels, count)
                             : result;
}

whit_result whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out)
{
    *out = NULL;
    whit_result result = api_need_device(renderer);
    if (result != WHIT_OK)
        return result;
    whit_image *image = calloc(1, sizeof *image);
    if (!image) {
        log_error(&renderer->log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    result = aov == WHIT_AOV_IDS ? renderer_read_ids(renderer->renderer, &image->image)
                                 : renderer_read_color(renderer->renderer, &image->image);
    if (result != WHIT_OK) {
        whit_image_destroy(image);
        return result;
    }
    if (aov == WHIT_AOV_COLOR)
        whit_image_display_as(image, &renderer->params);
    *out = image;
    return WHIT_OK;
}

/* ---- Costs ---- */

static double cost_value(whit_view view, const struct gpu_cost *cost)
{
    switch (view) {
    case WHIT_VIEW_DEPTH:
        return cost->depth;
    case WHIT_VIEW_VISITS:
        return (double)cost->inner_nodes + cost->leaves + cost->instances;
    case WHIT_VIEW_BOXES:
        return 2.0 * cost->inner_nodes;
    case WHIT_VIEW_TRIS:
        return cost->triangles;
    case WHIT_VIEW_STACK:
        return cost->stack;
    }
    return 0.0;
}

/* Puts the values of one kind of rays to those that are there; the first one makes *values. */
static whit_result add_costs(const whit_renderer *renderer, whit_view view, uint32_t kind,
                             struct image *values)
{
    struct image costs = {0};
    bool largest = view == WHIT_VIEW_DEPTH || view == WHIT_VIEW_STACK;
    whit_result result = renderer_read_costs(renderer->renderer, kind, &costs);
    if (result == WHIT_OK && !values->pixels)
        result = image_init(values, costs.width, costs.height, 1, false);
    size_t pixel_count = (size_t)costs.width * costs.height;
    for (size_t i = 0; result == WHIT_OK && i < pixel_count; ++i) {
        struct gpu_cost cost;
        memcpy(&cost, costs.words + i * costs.channels, sizeof cost);
        float value = (float)cost_value(view, &cost);
        values->pixels[i] = largest ? fmaxf(values->pixels[i], value) : values->pixels[i] + value;
    }
    image_finish(&costs);
    return result;
}

whit_result whit_renderer_cost_image(whit_renderer *renderer, whit_view view, whit_ray_kind kind,
                                     whit_image **out)
{
    *out = NULL;
    whit_result result = api_need_device(renderer);
    if (result != WHIT_OK)
        return result;
    if ((uint32_t)view > WHIT_VIEW_STACK || (uint32_t)kind > WHIT_RAY_KINDS) {
        log_error(&renderer->log, "there is no such view of costs");
        return WHIT_ERROR_USAGE;
    }
    whit_image *image = calloc(1, sizeof *image);
    if (!image) {
        log_error(&renderer->log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t k = 0; result == WHIT_OK && k < RAY_KIND_COUNT; ++k) {
        if (kind == WHIT_RAY_KINDS || (uint32_t)kind == k)
            result = add_costs(renderer, view, k, &image->image);
    }
    if (result != WHIT_OK) {
        whit_image_destroy(image);
        return result;
    }
    *out = image;
    return WHIT_OK;
}

static whit_cost cost_to_public(const struct cost_sum *cost)
{
    return (whit_cost){
        .rays = cost->rays,
        .inner_nodes = cost->inner_nodes,
        .leaves = cost->leaves,
        .instances = cost->instances,
        .triangles = cost->triangles,
        .stack = cost->stack,
        .depth = cost->depth,
        .records = cost->records,
        .stack_sum = cost->stack_sum,
        .depth_sum = cost->depth_sum,
        .max_inner_nodes = cost->max_inner_nodes,
        .max_leaves = cost->max_leaves,
        .max_instances = cost->max_instances,
        .max_triangles = cost->max_triangles,
    };
}

void whit_renderer_get_stats(const whit_renderer *renderer, whit_stats *stats)
{
    *stats = (whit_stats){.render_device_ms = -1.0, .bailout_bound = -1.0, .load_path = "storage"};
    if (!renderer->renderer)
        return;
    struct render_stats inner = {0};
    renderer_get_stats(renderer->renderer, &inner);
    *stats = (whit_stats){
        .upload_ms = inner.upload_ms,
        .compile_ms = inner.compile_ms,
        .render_ms = inner.render_ms,
        .render_device_ms = inner.render_device_ms,
        .rays_primary = inner.rays_primary,
        .rays_shadow = inner.rays_shadow,
        .rays_reflected = inner.rays_reflected,
        .rays_refracted = inner.rays_refracted,
        .rays_cut_depth = inner.rays_cut_depth,
        .rays_cut_bailout = inner.rays_cut_bailout,
        .weight_cut_depth = inner.weight_cut_depth,
        .weight_cut_bailout = inner.weight_cut_bailout,
        .bailout_bound = inner.bailout_bound,
        .kernel_instructions = inner.kernel_instructions,
        .general = inner.general,
        .device_bytes = inner.device_bytes,
        .dispatches = inner.dispatches,
        .tiles = inner.tiles,
        .deferred = inner.deferred,
        .tile_size = inner.tile_size,
        .load_path = inner.texel_loads ? "texel" : "storage",
        .packets = inner.packets,
    };
    memcpy(stats->pixels_by_samples, inner.pixels_by_samples, sizeof stats->pixels_by_samples);
    for (uint32_t kind = 0; kind < RAY_KIND_COUNT; ++kind)
        stats->costs[kind] = cost_to_public(&inner.costs[kind]);
    _Static_assert(WHIT_STAGES == RENDER_STAGE_COUNT, "a row for each");
    for (uint32_t i = 0; i < WHIT_STAGES; ++i) {
        stats->stages[i].rays = inner.stages[i].items;
        stats->stages[i].ms = inner.stages[i].ms;
        memcpy(stats->stages[i].name, inner.stages[i].name, sizeof stats->stages[i].name);
    }
    _Static_assert(WHIT_SHARES == RENDER_SHARES, "room for each");
    stats->share_count = inner.share_count;
    for (uint32_t i = 0; i < inner.share_count; ++i)
        stats->shares[i] = (whit_share){.stage = inner.shares[i].stage,
                                        .material = inner.shares[i].material,
                                        .share = inner.shares[i].share};
    uint64_t rays =
        inner.rays_primary + inner.rays_shadow + inner.rays_reflected + inner.rays_refracted;
    if (inner.render_ms > 0.0)
        stats->mrays_per_s = (double)rays / inner.render_ms * 1e-3;
}

/* ---- Rays on the CPU ---- */

struct cpu_trace {
    const whit_renderer *renderer;
    const struct gpu_ray *rays;
    struct gpu_hit *hits;
    uint64_t count;
    bool any, brute;
    struct cost_sum *costs; /* one a batch, or NULL */
    uint32_t *statuses;     /* one a batch: threads share nothing */
};

static bool cancelled(const whit_renderer *renderer)
{
    return renderer->params.cancel && *renderer->params.cancel;
}

static void trace_batch(void *context, uint32_t index)
{
    const struct cpu_trace *trace = context;
    const struct accel *accel = trace->renderer->accel;
    uint64_t first = (uint64_t)index * CPU_BATCH;
    uint64_t end = first + CPU_BATCH < trace->count ? first + CPU_BATCH : trace->count;
    const struct traverse_params params = {
        .order = trace->renderer->order,
        .numerics = trace->renderer->numerics,
        .any = trace->any,
        .brute = trace->brute,
        .skip_instance = HIT_NONE,
        .skip_primitive = HIT_NONE,
    };
    for (uint64_t i = first; i < end; ++i) {
        if ((i & 63) == 0 && cancelled(trace->renderer))
            return;
        struct gpu_cost cost = {0};
        traverse_ray(accel, &params, &trace->rays[i], &trace->hits[i], trace->costs ? &cost : NULL,
                     &trace->statuses[index]);
        if (trace->costs)
            cost_add(&trace->costs[index], &cost);
    }
}

static whit_result trace_on_cpu(const whit_renderer *renderer, struct cpu_trace *trace,
                                whit_cost *cost)
{
    uint64_t batches = (trace->count + CPU_BATCH - 1) / CPU_BATCH;
    if (batches > UINT32_MAX) {
        log_error(&renderer->log, "more rays than one call takes");
        return WHIT_ERROR_USAGE;
    }
    size_t at_least_one = batches ? (size_t)batches : 1;
    trace->statuses = calloc(at_least_one, sizeof *trace->statuses);
    trace->costs = cost ? calloc(at_least_one, sizeof *trace->costs) : NULL;
    if (!trace->statuses || (cost && !trace->costs)) {
        free(trace->statuses);
        free(trace->costs);
        log_error(&renderer->log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    threads_for(renderer->accel->params.mesh.thread_count, (uint32_t)batches, trace_batch, trace);
    uint32_t status = 0;
    struct cost_sum sum = {0};
    for (uint64_t i = 0; i < batches; ++i) {
        status |= trace->statuses[i];
        if (cost)
            cost_merge(&sum, &trace->costs[i]);
    }
    free(trace->costs);
    free(trace->statuses);
    if (cancelled(renderer))
        return WHIT_ERROR_CANCELLED;
    if (status) {
        log_error(&renderer->log,
                  "the traversal reported status %#x: its hits are not to be "
                  "trusted",
                  status);
        return WHIT_ERROR_STATUS;
    }
    if (cost)
        *cost = cost_to_public(&sum);
    return WHIT_OK;
}

static whit_result trace_on_device(whit_renderer *renderer, const struct gpu_ray *rays,
                                   uint64_t count, bool any, struct gpu_hit *hits, whit_cost *cost)
{
    struct gpu_cost *costs = NULL;
    if (cost) {
        costs = calloc(count ? (size_t)count : 1, sizeof *costs);
        if (!costs) {
            log_error(&renderer->log, "out of memory");
            return WHIT_ERROR_MEMORY;
        }
    }
    whit_result result = renderer_trace(renderer->renderer, rays, count, any, hits, costs);
    struct cost_sum sum = {0};
    for (uint64_t i = 0; cost && result == WHIT_OK && i < count; ++i)
        cost_add(&sum, &costs[i]);
    if (cost && result == WHIT_OK)
        *cost = cost_to_public(&sum);
    free(costs);
    return result;
}

double whit_trace_device_ms(const whit_renderer *renderer)
{
    return renderer->renderer ? renderer_trace_device_ms(renderer->renderer) : -1.0;
}

whit_result whit_trace(whit_renderer *renderer, whit_trace_on on, const whit_ray *rays,
                       uint64_t count, bool any, whit_hit *hits, whit_cost *cost)
{
    const void *from = rays;
    void *to = hits;
    if (on == WHIT_TRACE_DEVICE) {
        whit_result result = api_need_device(renderer);
        return result == WHIT_OK ? trace_on_device(renderer, from, count, any, to, cost) : result;
    }
    struct cpu_trace trace = {
        .renderer = renderer,
        .rays = from,
        .hits = to,
        .count = count,
        .any = any,
        .brute = on == WHIT_TRACE_CPU_BRUTE,
    };
    return trace_on_cpu(renderer, &trace, cost);
}

whit_result whit_renderer_sample_costs(whit_renderer *renderer, uint32_t pixels, whit_cost *cost)
{
    struct cpu_trace trace = {.renderer = renderer};
    struct gpu_ray *rays = NULL;
    whit_result result = api_need_device(renderer);
    if (result == WHIT_OK)
        result = renderer_camera_rays(renderer->renderer, pixels, &rays, &trace.count);
    if (result != WHIT_OK)
        return result;
    trace.rays = rays;
    trace.hits = malloc((size_t)trace.count * sizeof *trace.hits);
    result = trace.hits ? trace_on_cpu(renderer, &trace, cost) : WHIT_ERROR_MEMORY;
    if (!trace.hits)
        log_error(&renderer->log, "out of memory");
    free(trace.hits);
    free(rays);
    return result;
}
