/* Checks the parameters of all builders, and calls the one that is asked for. */
#include <float.h>
#include <stdlib.h>

#include "base/threads.h"
#include "bvh/build.h"
#include "bvh/complete.h"
#include "bvh/optimize.h"

static build_fn *const builders[] = {
    [WHIT_BUILD_NONE] = records_build,    [WHIT_BUILD_BINNED] = records_build,
    [WHIT_BUILD_MEDIAN] = records_build,  [WHIT_BUILD_SWEEP] = sweep_build,
    [WHIT_BUILD_SPATIAL] = spatial_build,
};

/* Replaces every 0 by its default. */
static void params_resolve(const whit_accel_params *in, whit_accel_params *out)
{
    *out = in ? *in : (whit_accel_params){0};
    if (out->bins == 0 && out->build != WHIT_BUILD_BINNED)
        out->bins = 16;
    out->leaf_limit = out->leaf_limit ? out->leaf_limit : 4;
    out->threads = out->threads ? out->threads : threads_available();
    out->spatial_alpha = out->spatial_alpha != 0.0f ? out->spatial_alpha : 1e-5f;
    out->spatial_budget = out->spatial_budget != 0.0f ? out->spatial_budget : 0.5f;
    if (out->spatial_budget < 0.0f)
        out->spatial_budget = 0.0f;
}

whit_result bvh_check(const whit_log *log, const whit_accel_params *params)
{
    whit_result result = WHIT_ERROR_USAGE;
    if ((size_t)params->build >= sizeof builders / sizeof *builders)
        log_error(log, "there is no builder %d", (int)params->build);
    else if (params->bins == 1 || params->bins > 256)
        log_error(log, "%u bins: 2 to 256 are possible", params->bins);
    else if (params->leaf_limit > BVH_LEAF_MAX)
        log_error(log, "%u triangles in a leaf: 1 to %u are possible", params->leaf_limit,
                  BVH_LEAF_MAX);
    else if (!(params->spatial_alpha >= 0.0f && params->spatial_budget <= FLT_MAX))
        log_error(log,
                  "spatial_alpha %g and spatial_budget %g: the first must not be below 0, the "
                  "second must be finite",
                  (double)params->spatial_alpha, (double)params->spatial_budget);
    else
        result = WHIT_OK;
    return result;
}

whit_result bvh_build(const whit_log *log, const struct bvh_box *boxes, uint32_t count,
                      const struct bvh_triangles *triangles, const whit_accel_params *params,
                      struct bvh *out)
{
    *out = (struct bvh){.primitive_count = count, .reference_count = count};
    whit_accel_params resolved;
    params_resolve(params, &resolved);
    whit_result result = bvh_check(log, &resolved);
    if (result != WHIT_OK || count == 0)
        return result;
    if (count > BVH_FIRST_MASK / 2)
        return log_failure(log, WHIT_ERROR_INPUT,
                           "tree: %u primitives are more than the %u that a node can address",
                           count, BVH_FIRST_MASK / 2);
    result = builders[resolved.build](log, boxes, count, triangles, &resolved, out);
    if (result == WHIT_OK)
        bvh_complete(out, resolved.threads);
    if (result == WHIT_OK && resolved.optimize)
        result = bvh_optimize(log, resolved.threads, out);
    if (result != WHIT_OK)
        bvh_finish(out);
    return result;
}

void bvh_finish(struct bvh *bvh)
{
    if (!bvh)
        return;
    free(bvh->nodes);
    free(bvh->order);
    *bvh = (struct bvh){0};
}
