/* Pipelines that a device keeps, so that asking for the same one again takes no time: a driver
   takes long to make one, even from its cache. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "device/kept.h"

/* The most pipelines that the device keeps. Beyond that it drops those without users, the oldest
   first. */
enum { KEPT_MAX = 128 };

static struct pipeline *take(struct device *device, size_t key_of_pipeline, const uint64_t key[2])
{
    struct pipeline *found = NULL;
    pthread_mutex_lock(&device->kept_lock);
    for (struct pipeline *i = device->kept; i && !found; i = i->next) {
        if (memcmp((const char *)i + key_of_pipeline, key, 2 * sizeof *key) == 0)
            found = i;
    }
    if (found)
        ++found->users;
    pthread_mutex_unlock(&device->kept_lock);
    return found;
}

/* Hashes all that decides which pipeline is made. It takes two hashes of 64 bits, since if two
   different kernels had one key, a picture would be drawn by the wrong one. */
static void key_of(const struct pipeline_params *params, bool specializes, uint64_t key[2])
{
    const uint64_t sizes[] = {
        params->spec_count, params->binding_count,   params->push_bytes, params->asks_statistics,
        specializes,        params->rewrite != NULL, params->rewrite_as};
    for (int i = 0; i < 2; ++i) {
        uint64_t hash = hash_bytes(HASH_START + (uint64_t)i, sizes, sizeof sizes);
        hash = hash_bytes(hash, params->spirv, params->spirv_bytes);
        hash = hash_bytes(hash, params->spec, params->spec_count * sizeof *params->spec);
        key[i] =
            hash_bytes(hash, params->bindings, params->binding_count * sizeof *params->bindings);
    }
}

bool kept_take(struct device *device, const struct pipeline_params *params, bool specializes,
               struct pipeline **out)
{
    uint64_t key[2];
    if (!device->keeps || !params->spirv)
        return false;
    key_of(params, specializes, key);
    *out = take(device, offsetof(struct pipeline, key), key);
    return *out != NULL;
}

struct pipeline *kept_take_code(struct pipeline *made, const struct pipeline_params *params,
                                const uint32_t *words, size_t word_count)
{
    const struct pipeline_params as_code = {
        .spirv = words,
        .spirv_bytes = word_count * sizeof *words,
        .bindings = params->bindings,
        .binding_count = params->binding_count,
        .push_bytes = params->push_bytes,
        .asks_statistics = params->asks_statistics,
    };
    if (!made->device->keeps)
        return NULL;
    key_of(&as_code, true, made->code_key);
    return take(made->device, offsetof(struct pipeline, code_key), made->code_key);
}

/* Removes the oldest pipeline without users from the list and returns it; NULL: there is none. */
static struct pipeline *take_oldest(struct device *device)
{
    struct pipeline **at = &device->kept, **oldest = NULL;
    for (; *at; at = &(*at)->next) {
        if (!(*at)->users)
            oldest = at;
    }
    struct pipeline *gone = oldest ? *oldest : NULL;
    if (oldest)
        *oldest = gone->next;
    device->kept_count -= oldest != NULL;
    return gone;
}

static void destroy_all(struct pipeline *list)
{
    while (list) {
        struct pipeline *pipeline = list;
        list = pipeline->next;
        pipeline->kept = false;
        pipeline_destroy(pipeline);
    }
}

void kept_add(struct pipeline *pipeline, const struct pipeline_params *params, bool specializes)
{
    struct device *device = pipeline->device;
    struct pipeline *oldest, *gone = NULL;
    if (!device->keeps)
        return;
    key_of(params, specializes, pipeline->key);
    pthread_mutex_lock(&device->kept_lock);
    /* There are more than KEPT_MAX if that many had users at the same time. */
    while (device->kept_count >= KEPT_MAX && (oldest = take_oldest(device))) {
        oldest->next = gone;
        gone = oldest;
    }
    pipeline->kept = true;
    pipeline->users = 1;
    pipeline->next = device->kept;
    device->kept = pipeline;
    ++device->kept_count;
    pthread_mutex_unlock(&device->kept_lock);
    destroy_all(gone);
}

bool kept_give_back(struct pipeline *pipeline)
{
    if (!pipeline->kept)
        return false;
    pthread_mutex_lock(&pipeline->device->kept_lock);
    --pipeline->users;
    pthread_mutex_unlock(&pipeline->device->kept_lock);
    return true;
}

void kept_finish(struct device *device)
{
    destroy_all(device->kept);
    device->kept = NULL;
}
