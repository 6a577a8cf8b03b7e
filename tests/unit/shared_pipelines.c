/* Linked into tests around pipeline_create, pipeline_destroy and device_destroy (-Wl,--wrap): who
   asks a device twice for the same pipeline gets the one of the first time, which is destroyed with
   the device. The driver takes up to half a second for a pipeline, and tests make many small
   pictures with few kernels. One is made at a time. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/device.h"

whit_result __real_pipeline_create(struct device *device, const struct pipeline_params *params,
                                   struct pipeline **out);
whit_result __wrap_pipeline_create(struct device *device, const struct pipeline_params *params,
                                   struct pipeline **out);
void __real_pipeline_destroy(struct pipeline *pipeline);
void __wrap_pipeline_destroy(struct pipeline *pipeline);
void __real_device_destroy(struct device *device);
void __wrap_device_destroy(struct device *device);

/* A pipeline and all that it was made from. */
struct shared {
    struct shared *next;
    struct device *device;
    struct pipeline *pipeline;
    struct pipeline_params params;
    uint32_t *spec;
    enum binding_kind *bindings;
    char *name, *specializing;
};

static struct shared *first;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static const char *specializing(void)
{
    const char *value = getenv("WHIT_NO_SPECIALIZE");
    return value ? value : "";
}

static bool same(const struct shared *shared, const struct device *device,
                 const struct pipeline_params *params)
{
    const struct pipeline_params *own = &shared->params;
    return shared->device == device && own->spirv == params->spirv &&
           own->spirv_bytes == params->spirv_bytes && own->push_bytes == params->push_bytes &&
           own->rewrite == params->rewrite && own->rewrite_as == params->rewrite_as &&
           own->spec_count == params->spec_count && own->binding_count == params->binding_count &&
           memcmp(shared->spec, params->spec, params->spec_count * sizeof *params->spec) == 0 &&
           memcmp(shared->bindings, params->bindings,
                  params->binding_count * sizeof *params->bindings) == 0 &&
           strcmp(shared->name, params->name) == 0 &&
           strcmp(shared->specializing, specializing()) == 0;
}

static void *copy(const void *from, size_t count, size_t size_bytes)
{
    void *to = array_alloc_zeroed(count + 1, size_bytes);
    if (!to)
        abort();
    memcpy(to, from, count * size_bytes);
    return to;
}

static whit_result share(struct device *device, const struct pipeline_params *params,
                         struct pipeline **out)
{
    for (const struct shared *i = first; i; i = i->next) {
        if (same(i, device, params)) {
            *out = i->pipeline;
            return WHIT_OK;
        }
    }
    whit_result result = __real_pipeline_create(device, params, out);
    if (result != WHIT_OK)
        return result;
    const struct shared made = {
        .next = first,
        .device = device,
        .pipeline = *out,
        .params = *params,
        .spec = copy(params->spec, params->spec_count, sizeof *params->spec),
        .bindings = copy(params->bindings, params->binding_count, sizeof *params->bindings),
        .name = string_copy(params->name),
        .specializing = string_copy(specializing())};
    first = copy(&made, 1, sizeof made);
    return WHIT_OK;
}

whit_result __wrap_pipeline_create(struct device *device, const struct pipeline_params *params,
                                   struct pipeline **out)
{
    pthread_mutex_lock(&lock);
    whit_result result = share(device, params, out);
    pthread_mutex_unlock(&lock);
    return result;
}

void __wrap_pipeline_destroy(struct pipeline *pipeline)
{
    (void)pipeline;
}

void __wrap_device_destroy(struct device *device)
{
    for (struct shared **i = &first; *i;) {
        struct shared *shared = *i;
        if (shared->device != device) {
            i = &shared->next;
            continue;
        }
        *i = shared->next;
        __real_pipeline_destroy(shared->pipeline);
        free(shared->spec);
        free(shared->bindings);
        free(shared->name);
        free(shared->specializing);
        free(shared);
    }
    __real_device_destroy(device);
}
