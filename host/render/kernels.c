/* The kernels of a picture, one by one, with what the driver tells of them. */
#include "base/clock.h"
#include "device/pipeline.h"
#include "render/frame_uniform.h"
#include "render/renderer.h"
#include "render/stages.h"
#include "render/upload.h"
#include "render/variants.h"

_Static_assert(STAGE_COUNT * 2 <= WHIT_KERNELS_MAX, "room for all kernels");

/* Without a pipeline of it. */
static void count_kernel(const struct pipeline_params *params, bool deferred, whit_kernel *kernel)
{
    struct pipeline_info info = {0};
    bool counted = pipeline_count(params, &info);
    *kernel = (whit_kernel){.name = params->name,
                            .deferred = deferred,
                            .instructions = counted ? info.instructions : 0};
}

static whit_result list_kernel(struct device *device, const struct pipeline_params *params,
                               bool deferred, whit_kernel *kernel)
{
    struct pipeline *pipeline = NULL;
    struct pipeline_info info;
    double start_ms = clock_ms();
    whit_result result = pipeline_create(device, params, &pipeline);
    *kernel = (whit_kernel){
        .name = params->name, .deferred = deferred, .create_ms = clock_ms() - start_ms};
    if (result != WHIT_OK)
        return result;
    pipeline_get_info(pipeline, &info);
    kernel->instructions = info.instructions;
    result = pipeline_get_statistics(pipeline, kernel->statistics, &kernel->statistic_count);
    pipeline_destroy(pipeline);
    return result;
}

static whit_result list_or_count(struct renderer *renderer, bool make,
                                 const struct pipeline_params *params, bool deferred,
                                 whit_kernel *kernel)
{
    if (make)
        return list_kernel(renderer->device, params, deferred, kernel);
    count_kernel(params, deferred, kernel);
    return WHIT_OK;
}

static whit_result list_stages(struct renderer *renderer, bool make, whit_kernel *kernels,
                               uint32_t *count)
{
    struct stages_job job;
    struct gpu_spec spec = variant_spec(&renderer->picture), deferred;
    whit_result result = WHIT_OK;
    stages_job_init(&renderer->picture, &spec, true, renderer->few_kernels, &job);
    for (int i = 0; result == WHIT_OK && i < STAGE_COUNT; ++i) {
        struct pipeline_params params = job.stages[i].params;
        if (!job.wanted[i])
            continue;
        params.asks_statistics = true;
        bool defers = variant_defers(&params, &deferred);
        result = list_or_count(renderer, make, &params, false, &kernels[(*count)++]);
        params.spec = (const uint32_t *)&deferred;
        if (result == WHIT_OK && defers)
            result = list_or_count(renderer, make, &params, true, &kernels[(*count)++]);
    }
    return result;
}

whit_result render_list_kernels(const whit_log *log, struct device *device, struct accel *accel,
                                const whit_renderer_params *params, bool make, whit_kernel *kernels,
                                uint32_t *count)
{
    struct renderer renderer = {0};
    *count = 0;
    whit_result result = renderer_init(&renderer, log, device, accel, params);
    if (result == WHIT_OK) {
        upload_choose(&renderer);
        result = upload_widen(&renderer);
    }
    if (result == WHIT_OK)
        result = frame_fill(&renderer);
    if (result == WHIT_OK)
        result = list_stages(&renderer, make, kernels, count);
    renderer_finish(&renderer);
    return result;
}
