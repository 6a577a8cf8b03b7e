/* The general kernel draws while a thread compiles the one for the scene. The thread touches
   nothing of the renderer: it takes a job that stands alone and leaves a pipeline in it; all else
   happens in calls of the renderer. Both kernels give the same picture, byte for byte. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "render/renderer.h"

struct beside_job {
    struct device *device;
    struct variant_job variant;
    struct thread *thread;
    struct pass pass; /* pipelines alone; of the thread until it is done; empty when it failed */
    atomic_bool done;
};

static void compile_job(void *context)
{
    struct beside_job *job = context;
    if (variant_job_run(job->device, &job->variant, &job->pass) != WHIT_OK)
        pass_finish(&job->pass);
    atomic_store(&job->done, true);
}

static void job_destroy(struct beside_job *job)
{
    if (!job)
        return;
    thread_join(job->thread);
    pass_finish(&job->pass);
    free(job);
}

/* NULL when memory or threads run out: then the general kernel stays until the next picture. */
static struct beside_job *job_start(const struct renderer *renderer, const struct gpu_spec *spec)
{
    struct beside_job *job = calloc(1, sizeof *job);
    if (!job)
        return NULL;
    job->device = renderer->device;
    variant_job_init(renderer, spec, &job->variant);
    job->thread = thread_start(compile_job, job);
    if (job->thread)
        return job;
    free(job);
    return NULL;
}

static whit_result create_general(struct renderer *renderer, const struct gpu_spec *spec)
{
    struct variant_job variant;
    struct pass pass = {0};
    variant_job_init(renderer, spec, &variant);
    whit_result result = variant_job_run(renderer->device, &variant, &pass);
    if (result == WHIT_OK)
        result = variant_bind_whitted(renderer, &pass);
    if (result != WHIT_OK) {
        pass_finish(&pass);
        return result;
    }
    renderer->whitted = pass;
    renderer->beside.general = true;
    return WHIT_OK;
}

/* The job is done: its kernel in place of the general one. */
static whit_result take_over(struct renderer *renderer)
{
    struct beside_job *job = renderer->beside.job;
    struct pass pass = job->pass;
    if (!pass.pipeline)
        return WHIT_OK;
    job->pass = (struct pass){0};
    whit_result result = variant_bind_whitted(renderer, &pass);
    if (result != WHIT_OK) {
        pass_finish(&pass);
        return result;
    }
    pass_finish(&renderer->whitted);
    renderer->whitted = pass;
    renderer->beside.general = false;
    job_destroy(job);
    renderer->beside.job = NULL;
    return WHIT_OK;
}

whit_result beside_prepare(struct renderer *renderer)
{
    struct beside_state *beside = &renderer->beside;
    struct gpu_spec own = variant_spec(renderer), general = variant_beside_spec(renderer);
    if (renderer->whitted.pipeline && !beside->general)
        return WHIT_OK;
    /* Another time may ask for other constants than those that are being compiled. */
    if (beside->job && memcmp(&beside->job->variant.spec, &own, sizeof own) != 0) {
        job_destroy(beside->job);
        beside->job = NULL;
    }
    if (!beside->job && memcmp(&own, &general, sizeof own) != 0)
        beside->job = job_start(renderer, &own);
    if (beside->job && atomic_load(&beside->job->done)) {
        whit_result result = take_over(renderer);
        if (result != WHIT_OK || !beside->general)
            return result;
    }
    return renderer->whitted.pipeline ? WHIT_OK : create_general(renderer, &general);
}

void beside_finish(struct renderer *renderer)
{
    job_destroy(renderer->beside.job);
    renderer->beside = (struct beside_state){0};
}
