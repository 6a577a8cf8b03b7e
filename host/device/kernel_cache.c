/* Kernels with their constants filled in, kept from one run to the next: filling them in takes 4 to
   8 ms, and 200 where SPIRV-Tools has to do it, reading them less than one. */
#include "device/vulkan.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/store.h"

/* Raised with evaluate*.c and the passes of specialize.cpp. */
enum { KERNEL_VERSION = 5 };

/* In front of the words. */
struct kernel_header {
    uint64_t bindings;
    uint32_t instructions, flat;
};

/* Of the kernel as it came, its constants, and who fills them in: two hashes from two starts.
   free() it. */
static char *kept_name(const struct pipeline_params *params)
{
    const char *tools = spirv_tools_version();
    uint64_t key[2];
    for (uint64_t i = 0; i < 2; ++i) {
        uint64_t hash = HASH_START ^ i * UINT64_C(0x9e3779b97f4a7c15);
        hash = hash_bytes(hash, params->spirv, params->spirv_bytes);
        hash = hash_bytes(hash, params->spec, params->spec_count * sizeof *params->spec);
        key[i] = hash_bytes(hash, tools, strlen(tools));
    }
    return string_format("kernel-%d-%016" PRIx64 "%016" PRIx64, KERNEL_VERSION, key[0], key[1]);
}

bool kernel_cache_load(const struct pipeline_params *params, struct kernel_words *out)
{
    const struct log silent = {0};
    struct kernel_header header;
    uint8_t *data = NULL;
    size_t size_bytes = 0;
    char *name = kept_name(params);
    bool found = name && store_read(&silent, name, &data, &size_bytes) &&
                 size_bytes > sizeof header && size_bytes % sizeof *out->specialized == 0;
    free(name);
    if (!found) {
        free(data);
        return false;
    }
    memcpy(&header, data, sizeof header);
    size_bytes -= sizeof header;
    memmove(data, data + sizeof header, size_bytes);
    *out = (struct kernel_words){
        .specialized = (uint32_t *)data,
        .word_count = size_bytes / sizeof *out->specialized,
        .flat = header.flat != 0,
        .info = {.instructions = header.instructions, .bindings = header.bindings},
    };
    return true;
}

void kernel_cache_save(const struct pipeline_params *params, const struct kernel_words *kernel)
{
    const struct log silent = {0};
    const struct kernel_header header = {
        .bindings = kernel->info.bindings,
        .instructions = kernel->info.instructions,
        .flat = kernel->flat,
    };
    size_t words_bytes = kernel->word_count * sizeof *kernel->specialized;
    uint8_t *data = array_alloc(sizeof header + words_bytes, 1);
    char *name = kept_name(params);
    if (data && name) {
        memcpy(data, &header, sizeof header);
        memcpy(data + sizeof header, kernel->specialized, words_bytes);
        store_write(&silent, name, data, sizeof header + words_bytes);
    }
    free(name);
    free(data);
}
