/* Kernels with their constants filled in, kept from one run to the next: filling them in takes 4 to
   8 ms, and 200 where SPIRV-Tools has to do it, reading them less than one. A file each, of a fixed
   number of names, so that the folder stays bounded; a name that another kernel takes is written
   anew. */
#include "device/vulkan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"

enum { KERNEL_FILES = 128, KERNEL_LIMIT_BYTES = 16 << 20 };

/* In front of the words. */
struct kernel_header {
    char magic[8]; /* changes with evaluate*.c and the passes of specialize.cpp */
    uint64_t key[2];
    uint64_t bindings;
    uint32_t instructions, word_count;
    uint64_t flat;
    uint64_t checksum; /* of all that, with 0 here, and the words */
};

static const char kernel_magic[8] = {'w', 'h', 'i', 't', 's', 'k', '0', '3'};
static const struct log silent;

/* Of the kernel as it came, its constants, and who fills them in: two hashes from two starts. */
static void key_of(const struct pipeline_params *params, uint64_t key[2])
{
    const char *tools = spirv_tools_version();
    for (uint64_t i = 0; i < 2; ++i) {
        uint64_t hash = HASH_START ^ i * UINT64_C(0x9e3779b97f4a7c15);
        hash = hash_bytes(hash, params->spirv, params->spirv_bytes);
        hash = hash_bytes(hash, params->spec, params->spec_count * sizeof *params->spec);
        key[i] = hash_bytes(hash, tools, strlen(tools));
    }
}

static char *path_of(const uint64_t key[2], bool make_folder)
{
    char *folder = cache_is_off() ? NULL : cache_folder(make_folder);
    char *path =
        folder ? string_format("%s/kernel-%02x.bin", folder, (unsigned)(key[0] % KERNEL_FILES))
               : NULL;
    free(folder);
    return path;
}

static uint64_t checksum_of(struct kernel_header header, const uint32_t *words)
{
    header.checksum = 0;
    uint64_t hash = hash_bytes(HASH_START, &header, sizeof header);
    return hash_bytes(hash, words, header.word_count * sizeof *words);
}

static bool take_over(const uint64_t key[2], const uint8_t *file, size_t file_bytes,
                      struct kernel_words *out)
{
    struct kernel_header header;
    if (file_bytes < sizeof header)
        return false;
    memcpy(&header, file, sizeof header);
    size_t bytes = file_bytes - sizeof header;
    if (memcmp(header.magic, kernel_magic, sizeof kernel_magic) != 0 ||
        memcmp(header.key, key, sizeof header.key) != 0 || bytes == 0 ||
        bytes != (size_t)header.word_count * sizeof *out->specialized)
        return false;
    uint32_t *words = array_alloc(header.word_count, sizeof *words);
    if (!words)
        return false;
    memcpy(words, file + sizeof header, bytes);
    if (checksum_of(header, words) != header.checksum) {
        free(words);
        return false;
    }
    *out = (struct kernel_words){
        .specialized = words,
        .word_count = header.word_count,
        .flat = header.flat != 0,
        .info = {.instructions = header.instructions, .bindings = header.bindings},
    };
    return true;
}

bool kernel_cache_load(const struct pipeline_params *params, struct kernel_words *out)
{
    uint64_t key[2];
    uint8_t *file = NULL;
    size_t file_bytes = 0;
    key_of(params, key);
    char *path = path_of(key, false);
    bool found =
        path && file_exists(path) &&
        file_read(&silent, NULL, path, KERNEL_LIMIT_BYTES, &file, &file_bytes) == WHIT_OK &&
        take_over(key, file, file_bytes, out);
    free(file);
    free(path);
    return found;
}

void kernel_cache_save(const struct pipeline_params *params, const struct kernel_words *kernel)
{
    size_t bytes = kernel->word_count * sizeof *kernel->specialized;
    struct kernel_header header = {
        .bindings = kernel->info.bindings,
        .instructions = kernel->info.instructions,
        .word_count = (uint32_t)kernel->word_count,
        .flat = kernel->flat,
    };
    memcpy(header.magic, kernel_magic, sizeof kernel_magic);
    key_of(params, header.key);
    header.checksum = checksum_of(header, kernel->specialized);
    char *path = path_of(header.key, true);
    struct file_write file = {0};
    if (path && file_write_begin(&silent, path, &file) == WHIT_OK) {
        if (fwrite(&header, sizeof header, 1, file.stream) == 1 &&
            fwrite(kernel->specialized, 1, bytes, file.stream) == bytes)
            (void)!file_write_commit(&silent, &file);
        else
            file_write_abandon(&file);
    }
    free(path);
}
