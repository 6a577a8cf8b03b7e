/* lavapipe translates kernels to machine code when they are first dispatched, one after another on
   one core, and keeps the code in a cache of files. Where the cache lacks some, a second device
   translates kernels on another core meanwhile, and the first device finds them in the cache.
   Dispatches of zero workgroups suffice: they translate and run nothing. */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "device/buffer.h"
#include "device/commands.h"
#include "device/pipeline.h"
#include "render/stage_set.h"
#include "render/tiles.h"
#include "render/variants.h"

/* The first dispatch of a kernel takes less than this if its code is in the cache, and more if it
   has to be translated. */
static const double CACHED_MS = 10.0;
enum { KERNELS_MIN = 3, KERNELS_MAX = 2 * STAGE_COUNT };

struct kernel {
    const struct pass *pass;
    const struct variant_job *job;
    bool deferred;
    uint32_t instructions;
};

/* Kernels that both devices translate: each takes the largest that is left, so that both end at
   nearly the same time. */
struct work {
    const struct renderer *renderer;
    struct kernel kernels[KERNELS_MAX];
    uint32_t count;
    atomic_uint taken;
    uint32_t done_there;
};

/* The next kernel to translate; NULL: none is left, or the picture is to stop, which it will do
   before its first dispatch. */
static const struct kernel *take(struct work *work)
{
    bool stops = render_stop_due(work->renderer) != WHIT_OK;
    uint32_t index = stops ? work->count : atomic_fetch_add(&work->taken, 1);
    return index < work->count ? &work->kernels[index] : NULL;
}

static struct kernel kernel_of(const struct pass *pass, const struct variant_job *job,
                               bool deferred)
{
    struct pipeline_info info;
    pipeline_get_info(deferred ? pass->deferred : pass->pipeline, &info);
    return (struct kernel){pass, job, deferred, info.instructions};
}

static int by_size(const void *a, const void *b)
{
    const struct kernel *x = a, *y = b;
    return (x->instructions < y->instructions) - (x->instructions > y->instructions);
}

/* Sets work to all kernels of the set, the largest first. */
static void add_kernels(struct work *work, const struct target *target,
                        const struct stages_job *job)
{
    for (int i = 0; i < STAGE_COUNT; ++i) {
        const struct pass *pass = &target->stages.set.passes[i];
        for (int deferred = 0; pass->pipeline && deferred < 1 + (pass->deferred != NULL);
             ++deferred)
            work->kernels[work->count++] = kernel_of(pass, &job->stages[i], deferred);
    }
    qsort(work->kernels, work->count, sizeof *work->kernels, by_size);
}

static whit_result submit_nothing(struct commands *commands, struct pipeline *pipeline,
                                  struct binding_set *set)
{
    const struct gpu_chunk chunk = {0};
    whit_result result = commands_begin(commands);
    if (result != WHIT_OK)
        return result;
    commands_bind(commands, pipeline, set);
    commands_push(commands, &chunk, sizeof chunk);
    commands_dispatch(commands, 0, 0, 0);
    return commands_submit(commands);
}

static whit_result submit_here(const struct renderer *renderer, const struct kernel *kernel)
{
    const struct pass *pass = kernel->pass;
    return kernel->deferred ? submit_nothing(renderer->commands, pass->deferred, pass->deferred_set)
                            : submit_nothing(renderer->commands, pass->pipeline, pass->set);
}

static whit_result translate_here(struct work *work)
{
    const struct kernel *kernel;
    whit_result result = WHIT_OK;
    while (result == WHIT_OK && (kernel = take(work)) != NULL) {
        result = submit_here(work->renderer, kernel);
        if (result == WHIT_OK)
            result = commands_wait(work->renderer->commands, -1.0);
    }
    return result;
}

static whit_result translate_there(struct device *device, struct commands *commands,
                                   struct buffer *buffer, const struct kernel *kernel)
{
    struct buffer *buffers[BIND_STAGES_COUNT];
    struct pipeline *pipeline = NULL;
    struct binding_set *set = NULL;
    struct gpu_spec spec;
    struct pipeline_params params = kernel->job->params;
    if (kernel->deferred && variant_defers(&kernel->job->params, &spec))
        params.spec = (const uint32_t *)&spec;
    for (uint32_t i = 0; i < BIND_STAGES_COUNT; ++i)
        buffers[i] = buffer;
    whit_result result = pipeline_create(device, &params, &pipeline);
    if (result == WHIT_OK)
        result = binding_set_create(pipeline, buffers, BIND_STAGES_COUNT, &set);
    if (result == WHIT_OK)
        result = submit_nothing(commands, pipeline, set);
    if (result == WHIT_OK)
        result = commands_wait(commands, -1.0);
    binding_set_destroy(set);
    pipeline_destroy(pipeline);
    return result;
}

/* Translates kernels with a second device. An error here costs only time: the first device
   translates a kernel that is missing in the cache when it dispatches it. */
static void translate_beside(void *context)
{
    struct work *work = context;
    const struct kernel *kernel;
    const whit_log silent = {0};
    char selector[16];
    struct device *device = NULL;
    struct commands *commands = NULL;
    struct buffer *buffer = NULL;
    snprintf(selector, sizeof selector, "%u", device_get_info(work->renderer->device)->index);
    const whit_device_params params = {.selector = selector};
    whit_result result = device_create(&silent, &params, NULL, &device);
    if (result == WHIT_OK)
        result = commands_create(device, "translation", &commands);
    if (result == WHIT_OK)
        result = buffer_create(device, 16, BUFFER_STORAGE | BUFFER_TEXELS, "translation", &buffer);
    while (result == WHIT_OK && (kernel = take(work)) != NULL) {
        result = translate_there(device, commands, buffer, kernel);
        work->done_there += result == WHIT_OK;
    }
    buffer_destroy(buffer);
    commands_destroy(commands);
    device_destroy(device);
}

static bool keeps_machine_code(const struct renderer *renderer)
{
    const char *off = getenv("MESA_SHADER_CACHE_DISABLE");
    return device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU &&
           device_compile_threads(renderer->device) != 1 && threads_available() > 1 &&
           !(off && (strcmp(off, "1") == 0 || strcmp(off, "true") == 0));
}

/* Dispatches kernels, the smallest first, until one takes longer than the cache allows, or none is
   left. WHIT_ERROR_TIME_LIMIT: the device is still translating that kernel. */
static whit_result find_slow(struct work *work)
{
    whit_result result = WHIT_OK;
    while (result == WHIT_OK && work->count > 0 && render_stop_due(work->renderer) == WHIT_OK) {
        result = submit_here(work->renderer, &work->kernels[--work->count]);
        if (result == WHIT_OK)
            result = commands_wait(work->renderer->commands, CACHED_MS);
    }
    return result;
}

whit_result translation_share(struct target *target, const struct stages_job *job)
{
    const struct renderer *renderer = target->renderer;
    struct work work = {.renderer = renderer};
    add_kernels(&work, target, job);
    if (!keeps_machine_code(renderer) || work.count < KERNELS_MIN)
        return WHIT_OK;
    whit_result result = find_slow(&work);
    if (result != WHIT_ERROR_TIME_LIMIT)
        return result;
    struct thread *thread = work.count > 0 ? thread_start(translate_beside, &work) : NULL;
    result = commands_wait(renderer->commands, -1.0);
    if (result == WHIT_OK)
        result = translate_here(&work);
    thread_join(thread);
    target->stats.kernels_beside = work.done_there;
    return result;
}
