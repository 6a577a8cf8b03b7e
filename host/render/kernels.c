/* The kernels of a picture, one by one, with what the driver reports of them. */
#include "base/clock.h"
#include "device/pipeline.h"
#include "render/frame_uniform.h"
#include "render/renderer.h"
#include "render/stage_set.h"
#include "render/upload.h"
#include "render/variants.h"

_Static_assert(STAGE_COUNT * 2 <= WHIT_KERNELS_MAX, "room for all kernels");

/* Makes a kernel, or only counts its instructions. */
static whit_result list_kernel(struct renderer *renderer, bool make,
                               const struct pipeline_params *params, bool deferred,
                               whit_kernel *kernel)
{
    struct pipeline *pipeline = NULL;
    struct pipeline_info info = {0};
    double start_ms = clock_ms();
    *kernel = (whit_kernel){.name = params->name, .deferred = deferred};
    if (!make) {
        if (pipeline_count(params, &info))
            kernel->instructions = info.instructions;
        return WHIT_OK;
    }
    whit_result result = pipeline_create(renderer->device, params, &pipeline);
    kernel->create_ms = clock_ms() - start_ms;
    if (result != WHIT_OK)
        return result;
    pipeline_get_info(pipeline, &info);
    kernel->instructions = info.instructions;
    result = pipeline_get_statistics(pipeline, kernel->statistics, &kernel->statistic_count);
    pipeline_destroy(pipeline);
    return result;
}

static whit_result list_stages(struct renderer *renderer, bool make, whit_kernel *list,
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
        result = list_kernel(renderer, make, &params, false, &list[(*count)++]);
        params.spec = (const uint32_t *)&deferred;
        if (result == WHIT_OK && defers)
            result = list_kernel(renderer, make, &params, true, &list[(*count)++]);
    }
    return result;
}

whit_result render_list_kernels(const whit_log *log, struct device *device, struct accel *accel,
                                const whit_renderer_params *params, bool make, whit_kernel *list,
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
        result = list_stages(&renderer, make, list, count);
    renderer_finish(&renderer);
    return result;
}

static uint32_t count_bits(uint64_t bits)
{
    uint32_t count = 0;
    for (; bits; bits &= bits - 1)
        ++count;
    return count;
}

/* Counts all kernels of a set: the sum of their instructions, the bindings that any of them uses,
   and the instructions of the largest. False: a kernel cannot be specialized. */
static bool count_set(const struct stages_job *job, struct pipeline_info *sum, uint32_t *largest)
{
    *sum = (struct pipeline_info){0};
    *largest = 0;
    for (int i = 0; i < STAGE_COUNT; ++i) {
        struct pipeline_info info = {0};
        if (job->wanted[i] && !pipeline_count(&job->stages[i].params, &info))
            return false;
        sum->instructions += info.instructions;
        sum->bindings |= info.bindings;
        *largest = info.instructions > *largest ? info.instructions : *largest;
    }
    return true;
}

whit_result renderer_get_kernel(const struct renderer *renderer, whit_kernel_info *info)
{
    const struct target *target = &renderer->picture;
    struct gpu_spec own = variant_spec(target), general = variant_general_spec(target);
    struct stages_job job;
    struct pipeline_info own_info, general_info;
    uint32_t largest, general_largest;
    *info = (whit_kernel_info){0};
    bool few = variant_few_kernels(target);
    stages_job_init(target, &own, true, few, &job);
    bool counted = count_set(&job, &own_info, &largest);
    stages_job_init(target, &general, false, few, &job);
    if (!counted || !count_set(&job, &general_info, &general_largest))
        return log_failure(&renderer->log, WHIT_ERROR_DEVICE, "the kernels cannot be specialized");
    *info = (whit_kernel_info){
        .instructions = own_info.instructions,
        .largest_instructions = largest,
        .general_instructions = general_info.instructions,
        .bindings = count_bits(own_info.bindings),
        .general_bindings = count_bits(general_info.bindings),
    };
    return WHIT_OK;
}
