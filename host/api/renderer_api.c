#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/pose.h"
#include "api/handles.h"
#include "base/threads.h"
#include "image/edges.h"
#include "picture/params.h"
#include "scene/effects.h"
#include "scene/pose.h"
#include "twin/traverse.h"
#include "whit/whit_program.h"

_Static_assert(sizeof(whit_ray) == sizeof(struct gpu_ray), "rays are handed on as they are");
_Static_assert(sizeof(whit_hit) == sizeof(struct gpu_hit), "hits are handed on as they are");
_Static_assert(offsetof(whit_ray, t_max) == offsetof(struct gpu_ray, t_max), "ray layout");
_Static_assert(offsetof(whit_hit, instance) == offsetof(struct gpu_hit, instance), "hit layout");

_Static_assert((uint32_t)WHIT_RAY_KINDS == RAY_KIND_COUNT &&
                   (uint32_t)WHIT_RAY_REFRACTED == RAY_REFRACTED,
               "kinds of rays");

/* Grey level and opacity of grid lines, visible on bright and on dark pictures. */
#define GRID_LIGHT  0.15f
#define GRID_WEIGHT 0.7f

enum { DEPTH_DEFAULT = 8, LIGHT_SAMPLES_DEFAULT = 16, CPU_BATCH = 4096 };

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
                                  .sampling.count = 1,
                                  .depth = DEPTH_DEFAULT,
                                  .light_samples = LIGHT_SAMPLES_DEFAULT,
                                  .bailout = WHIT_BAILOUT_DEFAULT};
}

whit_renderer_params api_params(const whit_renderer_params *params)
{
    return params ? *params : whit_renderer_defaults();
}

/* Poses the accel, which another renderer may have moved to its own time. */
static whit_result pose_on_cpu(struct accel *accel, double time_s)
{
    struct scene_pose pose = {0};
    if (accel->posed_s == time_s)
        return WHIT_OK;
    whit_result result = scene_pose_init(accel->scene, time_s, &pose);
    if (result == WHIT_OK)
        result = accel_pose(accel, &pose);
    scene_pose_finish(&pose);
    return result;
}

whit_result whit_renderer_create(whit_device *device, whit_accel *accel,
                                 const whit_renderer_params *asked, whit_renderer **out)
{
    const whit_renderer_params params = api_params(asked);
    *out = NULL;
    whit_log log = device ? device->log : accel->log;
    whit_renderer *renderer = calloc(1, sizeof *renderer);
    if (!renderer)
        return API_FAIL(&log, WHIT_ERROR_MEMORY, "out of memory");
    renderer->log = log;
    renderer->accel = accel->accel;
    renderer->params = params;
    whit_result result = WHIT_OK;
    if (device)
        result = renderer_create(&log, device->device, accel->accel, &params, &renderer->renderer);
    else if ((result = params_check(&log, &renderer->params)) == WHIT_OK)
        result = pose_on_cpu(accel->accel, params.time_s);
    if (result == WHIT_OK)
        *out = renderer;
    else
        whit_renderer_destroy(renderer);
    return result;
}

void whit_renderer_destroy(whit_renderer *renderer)
{
    if (!renderer)
        return;
    renderer_destroy(renderer->renderer);
    free(renderer);
}

whit_result whit_renderer_render(whit_renderer *renderer)
{
    whit_result result = api_need_device(renderer);
    return result == WHIT_OK ? renderer_render(renderer->renderer) : result;
}

whit_result whit_renderer_render_views(whit_renderer *renderer, const whit_camera *cameras,
                                       uint32_t count)
{
    whit_result result = api_need_device(renderer);
    return result == WHIT_OK ? renderer_render_views(renderer->renderer, cameras, count) : result;
}

whit_result whit_renderer_set_time(whit_renderer *renderer, double time_s)
{
    if (!isfinite(time_s))
        return API_FAIL(&renderer->log, WHIT_ERROR_USAGE, "a time of %g s: it must be finite",
                        time_s);
    whit_result result = renderer->renderer ? renderer_set_time(renderer->renderer, time_s)
                                            : pose_on_cpu(renderer->accel, time_s);
    if (result == WHIT_OK)
        renderer->params.time_s = time_s;
    return result;
}

/* Stores the parameters of a picture, except those that stay as the renderer was made with (cancel
   flag, traversal, numerics, for rays on the CPU) and its shader, which only
   whit_renderer_set_shader changes. */
static void take_params(whit_renderer *renderer, const whit_renderer_params *params)
{
    const whit_renderer_params made = renderer->params;
    renderer->params = *params;
    renderer->params.cancel = made.cancel;
    renderer->params.traversal = made.traversal;
    renderer->params.numerics = made.numerics;
    renderer->params.shader = made.shader;
}

whit_result whit_renderer_set_view(whit_renderer *renderer, const whit_renderer_params *asked)
{
    const whit_renderer_params params = api_params(asked);
    whit_result result = api_need_device(renderer);
    if (result == WHIT_OK)
        result = renderer_set_view(renderer->renderer, &params);
    if (result == WHIT_OK)
        take_params(renderer, &params);
    return result;
}

whit_result whit_renderer_set_shader(whit_renderer *renderer, const whit_renderer_params *asked)
{
    const whit_renderer_params params = api_params(asked);
    whit_result result = api_need_device(renderer);
    if (result == WHIT_OK && !renderer_takes_shader(renderer->renderer, params.shader))
        result = API_FAIL(&renderer->log, WHIT_ERROR_USAGE,
                          "a shader of other functions needs a renderer of its own");
    if (result == WHIT_OK)
        result = renderer_set_shader(renderer->renderer, &params);
    if (result == WHIT_OK) {
        take_params(renderer, &params);
        renderer->params.shader = params.shader;
    }
    return result;
}

bool whit_renderer_takes_shader(const whit_renderer *renderer, const whit_shader *shader)
{
    return renderer->renderer && renderer_takes_shader(renderer->renderer, shader);
}

whit_result whit_renderer_get_kernel(const whit_renderer *renderer, whit_kernel_info *info)
{
    *info = (whit_kernel_info){0};
    whit_result result = api_need_device(renderer);
    return result == WHIT_OK ? renderer_get_kernel(renderer->renderer, info) : result;
}

whit_result whit_kernels_list(whit_device *device, whit_accel *accel,
                              const whit_renderer_params *params, bool make, whit_kernel *kernels,
                              uint32_t *count)
{
    const whit_renderer_params taken = api_params(params);
    return render_list_kernels(&device->log, device->device, accel->accel, &taken, make, kernels,
                               count);
}

static whit_result read_aov(struct renderer *renderer, whit_aov aov, struct image *out)
{
    if (aov >= WHIT_AOV_SHADER)
        return renderer_read_aov(renderer, (uint32_t)(aov - WHIT_AOV_SHADER), out);
    switch (aov) {
    case WHIT_AOV_IDS:
        return renderer_read_ids(renderer, out);
    case WHIT_AOV_CUTS:
        return renderer_read_cuts(renderer, out);
    case WHIT_AOV_DISTANCES:
        return renderer_read_distances(renderer, out);
    case WHIT_AOV_COLOR:
    case WHIT_AOV_SHADER:
        break;
    }
    return renderer_read_color(renderer, out);
}

/* Reads an aov, or borrows the colours. */
static whit_result make_image(whit_renderer *renderer, whit_aov aov, bool borrow, whit_image **out)
{
    *out = NULL;
    whit_result result = api_need_device(renderer);
    if (result == WHIT_OK && aov > WHIT_AOV_DISTANCES && aov < WHIT_AOV_SHADER)
        result = API_FAIL(&renderer->log, WHIT_ERROR_USAGE, "there is no aov %u", (unsigned)aov);
    if (result != WHIT_OK)
        return result;
    struct image image = {0};
    result = borrow ? renderer_borrow_color(renderer->renderer, &image)
                    : read_aov(renderer->renderer, aov, &image);
    result = api_hand_out(&renderer->log, &image, result, out);
    if (result == WHIT_OK && aov == WHIT_AOV_COLOR)
        whit_image_display_as(*out, &renderer->params);
    return result;
}

whit_result whit_renderer_image(whit_renderer *renderer, whit_aov aov, whit_image **out)
{
    return make_image(renderer, aov, false, out);
}

whit_result whit_renderer_borrow_color(whit_renderer *renderer, whit_image **out)
{
    return make_image(renderer, WHIT_AOV_COLOR, true, out);
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

/* Combines the cost values of one kind of rays with *values: the larger ones for depth and stack,
   else sums. The first kind makes *values. */
static whit_result add_costs(const whit_renderer *renderer, whit_view view, uint32_t kind,
                             struct image *values)
{
    struct image costs = {0};
    bool largest = view == WHIT_VIEW_DEPTH || view == WHIT_VIEW_STACK;
    whit_result result = renderer_read_costs(renderer->renderer, kind, &costs);
    if (result == WHIT_OK && !values->pixels)
        result = image_init_logged(&renderer->log, values, costs.width, costs.height, 1, false);
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
    if ((uint32_t)view > WHIT_VIEW_STACK || (uint32_t)kind > WHIT_RAY_KINDS)
        return API_FAIL(&renderer->log, WHIT_ERROR_USAGE, "there is no such view of costs");
    struct image image = {0};
    for (uint32_t k = 0; result == WHIT_OK && k < RAY_KIND_COUNT; ++k) {
        if (kind == WHIT_RAY_KINDS || (uint32_t)kind == k)
            result = add_costs(renderer, view, k, &image);
    }
    return api_hand_out(&renderer->log, &image, result, out);
}

void whit_renderer_get_stats(const whit_renderer *renderer, whit_stats *stats)
{
    *stats = (whit_stats){
        .render_device_ms = -1.0, .bailout_bound = -1.0, .load_path = WHIT_LOAD_STORAGE};
    if (renderer->renderer)
        renderer_get_stats(renderer->renderer, stats);
}

/* ---- Rays on the CPU ---- */

struct cpu_trace {
    const whit_renderer *renderer;
    const struct gpu_ray *rays;
    struct gpu_hit *hits;
    uint64_t count;
    bool any, brute;
    whit_cost *costs;   /* one per batch, or NULL */
    uint32_t *statuses; /* one per batch, so that threads share nothing */
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
        .order = (uint32_t)trace->renderer->params.traversal,
        .numerics = (uint32_t)trace->renderer->params.numerics,
        .any = trace->any,
        .brute = trace->brute,
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
    if (batches > UINT32_MAX)
        return API_FAIL(&renderer->log, WHIT_ERROR_USAGE, "more rays than one call takes");
    whit_result result = pose_on_cpu(renderer->accel, renderer->params.time_s);
    if (result != WHIT_OK)
        return result;
    size_t at_least_one = batches ? (size_t)batches : 1;
    trace->statuses = calloc(at_least_one, sizeof *trace->statuses);
    trace->costs = cost ? calloc(at_least_one, sizeof *trace->costs) : NULL;
    if (!trace->statuses || (cost && !trace->costs)) {
        free(trace->statuses);
        free(trace->costs);
        return API_FAIL(&renderer->log, WHIT_ERROR_MEMORY, "out of memory");
    }
    threads_for(renderer->accel->params.threads, (uint32_t)batches, trace_batch, trace);
    uint32_t status = 0;
    whit_cost sum = {0};
    for (uint64_t i = 0; i < batches; ++i) {
        status |= trace->statuses[i];
        if (cost)
            cost_merge(&sum, &trace->costs[i]);
    }
    free(trace->costs);
    free(trace->statuses);
    if (cancelled(renderer))
        return WHIT_ERROR_CANCELLED;
    if (status)
        return API_FAIL(&renderer->log, WHIT_ERROR_STATUS,
                        "the traversal reported status %#x: its hits are not to be "
                        "trusted",
                        status);
    if (cost)
        *cost = sum;
    return WHIT_OK;
}

/* As trace_on_cpu, with room for the hits, which is the caller's to free after a failure too. */
static whit_result find_hits(const whit_renderer *renderer, struct cpu_trace *trace,
                             whit_cost *cost)
{
    trace->hits = malloc((size_t)trace->count * sizeof *trace->hits);
    if (!trace->hits)
        return API_FAIL(&renderer->log, WHIT_ERROR_MEMORY, "out of memory");
    return trace_on_cpu(renderer, trace, cost);
}

static whit_result draw_grid(whit_renderer *renderer, struct image *color)
{
    struct cpu_trace trace = {.renderer = renderer, .any = true};
    struct gpu_ray *rays;
    float *cover;
    whit_result result = renderer_grid_rays(renderer->renderer, &rays, &cover, &trace.count);
    if (result != WHIT_OK)
        return result;
    trace.rays = rays;
    result = find_hits(renderer, &trace, NULL);
    for (size_t i = 0; result == WHIT_OK && i < trace.count; ++i) {
        float share = trace.hits[i].primitive == HIT_NONE ? GRID_WEIGHT * cover[i] : 0.0f;
        for (size_t c = 0; share > 0.0f && c < 3; ++c) {
            float *light = &color->pixels[color->channels * i + c];
            *light += (GRID_LIGHT - *light) * share;
        }
    }
    free(trace.hits);
    free(cover);
    free(rays);
    return result;
}

static whit_result draw_edges(whit_renderer *renderer, const whit_overlay *overlay,
                              struct image *color)
{
    whit_image *ids;
    if (overlay->ids) {
        const struct image given = {color->width, color->height, 2,
                                    .words = (uint32_t *)(uintptr_t)overlay->ids};
        image_draw_edges(color, &given, overlay->edges_of_primitives);
        return WHIT_OK;
    }
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_IDS, &ids);
    if (result != WHIT_OK)
        return result;
    image_draw_edges(color, &ids->image, overlay->edges_of_primitives);
    whit_image_destroy(ids);
    return WHIT_OK;
}

whit_result whit_renderer_draw_over(whit_renderer *renderer, const whit_overlay *overlay,
                                    whit_image *color)
{
    whit_result result = api_need_device(renderer);
    bool any = overlay->grid || overlay->edges_of_instances || overlay->edges_of_primitives;
    if (result == WHIT_OK && any &&
        (renderer->params.row_count || renderer_view_count(renderer->renderer)))
        result = API_FAIL(&renderer->log, WHIT_ERROR_USAGE,
                          "grid and edges are drawn over whole pictures");
    if (result == WHIT_OK && overlay->grid)
        result = draw_grid(renderer, &color->image);
    if (result == WHIT_OK && (overlay->edges_of_instances || overlay->edges_of_primitives))
        result = draw_edges(renderer, overlay, &color->image);
    return result;
}

static whit_result trace_on_device(whit_renderer *renderer, const struct gpu_ray *rays,
                                   uint64_t count, bool any, struct gpu_hit *hits, whit_cost *cost)
{
    struct gpu_cost *costs = NULL;
    if (cost) {
        costs = calloc(count ? (size_t)count : 1, sizeof *costs);
        if (!costs)
            return API_FAIL(&renderer->log, WHIT_ERROR_MEMORY, "out of memory");
    }
    whit_result result = renderer_trace(renderer->renderer, rays, count, any, hits, costs);
    whit_cost sum = {0};
    for (uint64_t i = 0; cost && result == WHIT_OK && i < count; ++i)
        cost_add(&sum, &costs[i]);
    if (cost && result == WHIT_OK)
        *cost = sum;
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
    if ((unsigned)on > WHIT_TRACE_CPU_BRUTE)
        return API_FAIL(&renderer->log, WHIT_ERROR_USAGE,
                        "rays are traced on the device or on the CPU, not on %d", (int)on);
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
    result = find_hits(renderer, &trace, cost);
    free(trace.hits);
    free(rays);
    return result;
}
