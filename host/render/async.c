/* General kernels draw while a thread compiles those for the scene. The thread touches nothing of
   the renderer: it works on a job with copies of all it needs, and leaves the pipelines there. All
   else happens in calls of the renderer. Both sets of kernels give the same picture, byte for
   byte. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "render/async.h"
#include "render/stage_set.h"
#include "render/variants.h"

struct async_job {
    struct device *device;
    struct stages_job stages;
    struct thread *thread;
    struct stage_set set; /* not bound; owned by the thread until `done`; empty after an error */
    atomic_bool done;
};

static void compile_job(void *context)
{
    struct async_job *job = context;
    if (stages_job_run(job->device, &job->stages, &job->set) != WHIT_OK)
        job->set = (struct stage_set){0};
    atomic_store(&job->done, true);
}

static void job_destroy(struct async_job *job)
{
    if (!job)
        return;
    thread_join(job->thread);
    stage_set_finish(&job->set);
    free(job);
}

void async_finish(struct renderer *renderer)
{
    job_destroy(renderer->async.job);
    renderer->async = (struct async_state){0};
}

/* NULL when memory or threads run out: the general kernels then stay until the next picture. */
static struct async_job *job_start(const struct renderer *renderer, const struct gpu_spec *spec)
{
    struct async_job *job = calloc(1, sizeof *job);
    if (!job)
        return NULL;
    job->device = renderer->device;
    stages_job_init(&renderer->picture, spec, true, renderer->few_kernels, &job->stages);
    job->thread = thread_start(compile_job, job);
    if (job->thread)
        return job;
    free(job);
    return NULL;
}

static whit_result create_general(struct renderer *renderer, const struct gpu_spec *spec)
{
    struct stages_job job;
    struct stage_set set;
    stages_job_init(&renderer->picture, spec, false, true, &job);
    whit_result result = stages_job_run(renderer->device, &job, &set);
    if (result == WHIT_OK)
        result = stages_take(&renderer->picture, &set);
    renderer->async.general = result == WHIT_OK;
    return result;
}

/* Puts the kernels of the finished job in place of the general ones. */
static whit_result take_over(struct renderer *renderer)
{
    whit_result result = stages_take(&renderer->picture, &renderer->async.job->set);
    async_finish(renderer);
    return result;
}

whit_result async_prepare(struct renderer *renderer)
{
    struct async_state *async = &renderer->async;
    struct gpu_spec own = variant_spec(&renderer->picture),
                    general = variant_async_spec(&renderer->picture);
    if (stage_set_is_made(&renderer->picture.stages.set) && !async->general)
        return stages_bind(&renderer->picture);
    /* Another time may need other constants than those that are being compiled. */
    if (async->job && memcmp(&async->job->stages.spec, &own, sizeof own) != 0) {
        job_destroy(async->job);
        async->job = NULL;
    }
    if (!async->job && memcmp(&own, &general, sizeof own) != 0)
        async->job = job_start(renderer, &own);
    if (async->job && atomic_load(&async->job->done) && stage_set_is_made(&async->job->set))
        return take_over(renderer);
    return stage_set_is_made(&renderer->picture.stages.set) ? stages_bind(&renderer->picture)
                                                            : create_general(renderer, &general);
}
