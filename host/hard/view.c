/* `whit hard --view`: pictures that show where a level of numerics is wrong. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/vec.h"
#include "hard/judge.h"
#include "hard/mesh.h"
#include "hard/rays.h"
#include "hard/run.h"
#include "picture/camera.h"

static const float red[3] = {1.0f, 0.0f, 0.0f}, yellow[3] = {1.0f, 0.7f, 0.0f};

struct view {
    const whit_hard_view_params *params;
    whit_log log;
    struct hard_scene hard;
    uint32_t width, height;
    struct hard_ray *rays;
    struct gpu_ray *plain;
    struct rational_hit *exact;
    struct gpu_hit *hits;
    uint64_t wrong, other;
};

static whit_result open_scene(struct view *view, const struct scene *scene, bool flatten)
{
    uint32_t count;
    if (!scene)
        return hard_scene_init(&view->log, hard_cases(&count), &view->hard);
    return hard_scene_borrow(&view->log, scene, view->params->time_s, flatten, &view->hard);
}

/* Allocates and makes the rays. The case of the built-in sphere promises hits from inside, but here
   it is seen from outside, so the truth is HARD_ORACLE. */
static whit_result prepare(struct view *view)
{
    size_t count = (size_t)view->width * view->height;
    view->hard.truth = HARD_ORACLE;
    view->rays = array_alloc(count, sizeof *view->rays);
    view->plain = array_alloc(count, sizeof *view->plain);
    view->exact = array_alloc(count, sizeof *view->exact);
    view->hits = array_alloc(count, sizeof *view->hits);
    if (!view->rays || !view->plain || !view->exact || !view->hits)
        return log_failure(&view->log, WHIT_ERROR_MEMORY, "out of memory for %u x %u rays",
                           view->width, view->height);
    whit_result result = camera_all_rays(&view->log, &view->hard.pose, &view->params->camera,
                                         view->width, view->height, view->plain);
    for (size_t i = 0; result == WHIT_OK && i < count; ++i)
        view->rays[i] = (struct hard_ray){view->plain[i], HIT_NONE, HIT_NONE};
    return result;
}

static whit_result trace(struct view *view, const struct hard_device *device)
{
    uint64_t count = (uint64_t)view->width * view->height;
    uint32_t numerics = (uint32_t)view->params->numerics, threads = view->params->threads;
    double ms;
    whit_result result = hard_trace_exact(&view->hard, view->rays, count, threads, view->exact);
    if (result != WHIT_OK)
        return result;
    return device ? device->trace(device, &view->log, view->hard.accel, view->params->time_s,
                                  numerics, view->plain, count, view->hits, &ms)
                  : hard_trace_twin(&view->hard, numerics, view->rays, count, threads, view->hits);
}

/* Grey by |cosine| between ray and normal; misses are nearly black. */
static float headlight(const struct gpu_ray *ray, const struct gpu_hit *hit)
{
    double dir[3], n[3] = {(double)hit->ng_x, (double)hit->ng_y, (double)hit->ng_z};
    if (hit->primitive == HIT_NONE)
        return 0.02f;
    for (int k = 0; k < 3; ++k)
        dir[k] = (double)ray->dir[k];
    double3_unit(dir);
    double3_unit(n);
    return (float)(0.05 + 0.6 * fabs(double3_dot(dir, n)));
}

static whit_result paint(struct view *view, float *pixels)
{
    whit_result result = WHIT_OK;
    size_t count = (size_t)view->width * view->height;
    for (size_t i = 0; result == WHIT_OK && i < count; ++i) {
        float *to = &pixels[3 * i];
        const struct gpu_hit *hit = &view->hits[i];
        const struct rational_hit *exact = &view->exact[i];
        to[0] = to[1] = to[2] = headlight(&view->plain[i], hit);
        if (hit->primitive == exact->primitive && hit->instance == exact->instance)
            continue;
        const struct hard_judgement judgement = {.hard = &view->hard,
                                                 .rays = &view->rays[i],
                                                 .exact = exact,
                                                 .hits = hit,
                                                 .numerics = (uint32_t)view->params->numerics,
                                                 .count = 1};
        whit_tally tally;
        result = hard_judge(&judgement, 1, &tally);
        bool wrong = result == WHIT_OK && tally.leaks + tally.wrong > 0;
        const float *color = wrong ? red : yellow;
        view->wrong += wrong;
        view->other += !wrong;
        for (int k = 0; k < 3; ++k)
            to[k] = color[k];
    }
    return result;
}

static void finish(struct view *view)
{
    hard_scene_finish(&view->hard);
    free(view->rays);
    free(view->plain);
    free(view->exact);
    free(view->hits);
}

whit_result hard_view(const struct hard_device *device, const struct scene *scene, bool flatten,
                      const whit_hard_view_params *params, const whit_log *log, float *pixels,
                      uint64_t *wrong, uint64_t *other)
{
    struct view view = {.params = params,
                        .log = log_or_silence(log),
                        .width = params->width,
                        .height = params->height};
    whit_result result = open_scene(&view, scene, flatten);
    if (result == WHIT_OK)
        result = prepare(&view);
    if (result == WHIT_OK)
        result = trace(&view, device);
    if (result == WHIT_OK)
        result = paint(&view, pixels);
    finish(&view);
    *wrong = view.wrong;
    *other = view.other;
    return result;
}
