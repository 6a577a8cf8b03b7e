/* Rays with their exact hits, and judging other hits of them. */
#include <math.h>
#include <stdlib.h>

#include "api/handles.h"
#include "base/array.h"
#include "hard/judge.h"
#include "hard/mesh.h"
#include "hard/rays.h"
#include "picture/camera.h"

enum { RAYS_DEFAULT = 20000, RAYS_MAX = 1 << 24, SIDE_MAX = 65535, SEED = 77 };

struct whit_judge {
    whit_log log;
    struct hard_scene hard;
    uint32_t threads;
    uint64_t count;
    struct hard_ray *rays;
    whit_ray *plain;
    struct rational_hit *exact;
};

/* ---- Rays ---- */

/* A grid of camera rays with the picture's aspect, as far as at most `wanted` points allow. */
static void grid_of(const whit_judge_params *params, uint32_t wanted, uint32_t *width,
                    uint32_t *height)
{
    double shape =
        params->width && params->height ? (double)params->width / params->height : 4. / 3.;
    double across = floor(sqrt(wanted * shape));
    *width = (uint32_t)fmin(fmax(across, 1.0), wanted);
    *height = wanted / *width;
}

static whit_result camera_rays(whit_judge *judge, const whit_judge_params *params, uint32_t wanted)
{
    uint32_t width, height;
    grid_of(params, wanted, &width, &height);
    judge->count = (uint64_t)width * height;
    return camera_all_rays(&judge->log, &judge->hard.pose, &params->camera, width, height,
                           (struct gpu_ray *)judge->plain);
}

static whit_result make_rays(whit_judge *judge, const whit_judge_params *params, uint32_t wanted)
{
    struct gpu_ray *plain = (struct gpu_ray *)judge->plain;
    whit_result result = WHIT_OK;
    if (!params->aimed)
        result = camera_rays(judge, params, wanted);
    else
        judge->count = wanted;
    for (uint64_t i = 0; result == WHIT_OK && i < judge->count; ++i) {
        if (params->aimed) {
            judge->rays[i] = hard_ray_make(&judge->hard, judge->hard.rays, SEED, i);
            plain[i] = judge->rays[i].ray;
        } else {
            judge->rays[i] = (struct hard_ray){plain[i], HIT_NONE, HIT_NONE};
        }
    }
    return result;
}

/* ---- Life ---- */

static whit_result check(const whit_log *log, const whit_judge_params *params)
{
    if (params->count > RAYS_MAX)
        return API_FAIL(log, WHIT_ERROR_USAGE, "%u rays: at most %d", params->count, RAYS_MAX);
    if (params->width > SIDE_MAX || params->height > SIDE_MAX)
        return API_FAIL(log, WHIT_ERROR_USAGE, "%u x %u: at most %d on a side", params->width,
                        params->height, SIDE_MAX);
    return api_check_instances(log, params->instances);
}

static whit_result fill(whit_judge *judge, const whit_scene *scene, const whit_judge_params *params)
{
    uint32_t wanted = params->count ? params->count : RAYS_DEFAULT;
    whit_result result = check(&judge->log, params);
    judge->threads = params->threads;
    if (result != WHIT_OK || scene->scene->triangle_total == 0)
        return result;
    judge->rays = array_alloc(wanted, sizeof *judge->rays);
    judge->plain = array_alloc(wanted, sizeof *judge->plain);
    judge->exact = array_alloc(wanted, sizeof *judge->exact);
    if (!judge->rays || !judge->plain || !judge->exact)
        return API_FAIL(&judge->log, WHIT_ERROR_MEMORY, "out of memory for %u rays", wanted);
    result = hard_scene_borrow(&judge->log, scene->scene, params->time_s,
                               api_one_tree(scene, params->instances), &judge->hard);
    if (result == WHIT_OK)
        result = make_rays(judge, params, wanted);
    if (result == WHIT_OK)
        result =
            hard_trace_exact(&judge->hard, judge->rays, judge->count, judge->threads, judge->exact);
    return result;
}

whit_result whit_judge_create(const whit_scene *scene, const whit_judge_params *params,
                              const whit_log *log, whit_judge **out)
{
    const whit_judge_params defaults = {0};
    whit_judge *judge = calloc(1, sizeof *judge);
    *out = NULL;
    if (!judge)
        return API_FAIL(log, WHIT_ERROR_MEMORY, "out of memory");
    judge->log = log_or_silence(log);
    whit_result result = fill(judge, scene, params ? params : &defaults);
    if (result == WHIT_OK)
        *out = judge;
    else
        whit_judge_destroy(judge);
    return result;
}

void whit_judge_destroy(whit_judge *judge)
{
    if (!judge)
        return;
    hard_scene_finish(&judge->hard);
    free(judge->rays);
    free(judge->plain);
    free(judge->exact);
    free(judge);
}

const whit_ray *whit_judge_rays(const whit_judge *judge, uint64_t *count)
{
    *count = judge->count;
    return judge->plain;
}

/* ---- Hits ---- */

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The `rank`/1000 quantile of the sorted values; 0 when there are none. */
static double at_share(const float *sorted, uint64_t count, uint64_t rank)
{
    uint64_t at = (count * rank + 999) / 1000;
    return count ? (double)sorted[at ? at - 1 : 0] : 0.0;
}

static whit_result measure_t(const whit_judge *judge, const whit_hit *hits, whit_judgement *out)
{
    float *ulps = array_alloc((size_t)judge->count, sizeof *ulps);
    uint64_t count = 0;
    if (!ulps)
        return API_FAIL(&judge->log, WHIT_ERROR_MEMORY, "out of memory");
    for (uint64_t i = 0; i < judge->count; ++i) {
        const struct rational_hit *exact = &judge->exact[i];
        const whit_hit *hit = &hits[i];
        if (hit->primitive == WHIT_NONE)
            continue;
        bool finite = isfinite(hit->t) && isfinite(hit->u) && isfinite(hit->v);
        out->non_finite += !finite;
        if (finite && hit->primitive == exact->primitive && hit->instance == exact->instance &&
            hard_goes_far(&judge->rays[i].ray, exact->t))
            ulps[count++] = (float)hard_ulps_between(hit->t, exact->t);
    }
    qsort(ulps, (size_t)count, sizeof *ulps, compare_floats);
    out->ulp_rays = count;
    out->ulp_median = at_share(ulps, count, 500);
    out->ulp_999 = at_share(ulps, count, 999);
    out->ulp_max = at_share(ulps, count, 1000);
    free(ulps);
    return WHIT_OK;
}

whit_result whit_judge_hits(const whit_judge *judge, whit_numerics numerics, const whit_hit *hits,
                            whit_judgement *out)
{
    const struct hard_judgement judgement = {.hard = &judge->hard,
                                             .rays = judge->rays,
                                             .exact = judge->exact,
                                             .hits = (const struct gpu_hit *)hits,
                                             .numerics = (uint32_t)numerics,
                                             .count = judge->count};
    *out = (whit_judgement){.tally = {.rays = judge->count}};
    whit_result result = api_check_numerics(&judge->log, numerics);
    if (result != WHIT_OK || judge->count == 0)
        return result;
    result = hard_judge(&judgement, judge->threads, &out->tally);
    if (result != WHIT_OK)
        return result;
    return measure_t(judge, hits, out);
}
