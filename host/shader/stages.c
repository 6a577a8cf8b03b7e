#include "shader/stages.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "shader/expand.h"

struct reading {
    const whit_log *log;
    struct shader_errors *errors;
    const char *folder;
    struct roots roots;
    struct shader_stages *stages;
    uint32_t depth;
};

/* The #include that leads to a file; for a kernel `file` is NULL. */
struct place {
    const char *file;
    uint32_t line;
};

const struct shader_source *shader_stages_list(const struct shader_stages *stages, uint32_t *count)
{
    *count = stages ? stages->count : shader_source_count;
    return stages ? stages->files : shader_sources;
}

uint32_t shader_stages_find(const struct shader_stages *stages, const char *path)
{
    uint32_t count, i = 0;
    const struct shader_source *files = shader_stages_list(stages, &count);
    while (i < count && (!files[i].text || strcmp(files[i].path, path) != 0))
        i++;
    return i;
}

static whit_result refuse(struct reading *r, const struct place *place, const char *name,
                          const char *why)
{
    if (place->file)
        shader_error_add(r->log, r->errors, place->file, place->line, 0, "#include \"%s\": %s",
                         text_token(name).text, why);
    else
        shader_error_add(r->log, r->errors, name, 0, 0, "%s", why);
    return WHIT_ERROR_INPUT;
}

/* Index of a path in stages->files, to which it is added if needed; SHADER_STAGES_MAX: full, or no
   memory. */
static uint32_t place_of(struct shader_stages *stages, const char *path)
{
    for (uint32_t i = 0; i < stages->count; ++i) {
        if (strcmp(stages->files[i].path, path) == 0)
            return i;
    }
    if (stages->count == SHADER_STAGES_MAX)
        return SHADER_STAGES_MAX;
    stages->files[stages->count].path = string_copy(path);
    return stages->files[stages->count].path ? stages->count++ : SHADER_STAGES_MAX;
}

static bool is_other_abi(const struct shader_source *file, uint32_t index)
{
    return strncmp(file->path, "abi/", 4) == 0 &&
           (index >= shader_source_count || strcmp(file->text, shader_sources[index].text) != 0);
}

static whit_result read_file(struct reading *r, const struct place *place, const char *path);

static whit_result read_includes(struct reading *r, uint32_t index)
{
    uint32_t line = 1;
    const struct shader_source *file = &r->stages->files[index];
    for (const char *at = file->text; at && *at; ++line) {
        const char *name;
        char path[EXPAND_NAME_BYTES];
        const struct place place = {r->stages->names[index], line};
        size_t length = expand_included(at, &name);
        if (length) {
            expand_join(file->path, name, length, path);
            whit_result result = read_file(r, &place, path);
            if (result != WHIT_OK)
                return result;
        }
        at = strchr(at, '\n');
        at = at ? at + 1 : NULL;
    }
    return WHIT_OK;
}

static whit_result read_text(struct reading *r, const struct place *place, uint32_t index)
{
    struct shader_source *file = &r->stages->files[index];
    char *name = string_format("%s/%s", r->folder, file->path);
    r->stages->names[index] = name;
    enum reach reach = name ? roots_reach(&r->roots, name) : REACH_MISSING;
    if (!name)
        return log_failure(r->log, WHIT_ERROR_MEMORY, "no memory for the stages");
    if (reach != REACH_FILE)
        return refuse(r, place, place->file ? file->path : name, reach_words(reach));
    uint8_t *data;
    size_t bytes;
    whit_result result =
        file_read(r->log, &r->roots, name, SHADER_STAGES_FILE_BYTES, &data, &bytes);
    if (result != WHIT_OK)
        return result;
    file->text = (char *)data;
    file->bytes = bytes;
    if (is_other_abi(file, index))
        return refuse(r, &(struct place){0}, name,
                      "not as this whit was built with it: what is in abi/ takes a build");
    return WHIT_OK;
}

static whit_result read_file(struct reading *r, const struct place *place, const char *path)
{
    enum { DEPTH_MAX = 32 };
    uint32_t index = place_of(r->stages, path);
    if (index == SHADER_STAGES_MAX || r->depth == DEPTH_MAX)
        return refuse(r, place, path, "too many files, or too deep in each other");
    if (r->stages->files[index].text)
        return WHIT_OK;
    whit_result result = read_text(r, place, index);
    r->depth++;
    if (result == WHIT_OK)
        result = read_includes(r, index);
    r->depth--;
    return result;
}

static uint64_t hash_of(const struct shader_stages *stages)
{
    uint64_t hash = HASH_START;
    for (uint32_t i = 0; i < stages->count; ++i) {
        const struct shader_source *file = &stages->files[i];
        if (!file->text)
            continue;
        hash = hash_bytes(hash, file->path, strlen(file->path));
        hash = hash_bytes(hash, file->text, file->bytes);
    }
    return hash;
}

static whit_result read_all(struct reading *r, const char *const *kernels)
{
    const struct place nobody = {0};
    whit_result result = WHIT_OK;
    if (r->roots.count == 0)
        return refuse(r, &nobody, r->folder, "there is no such folder");
    for (uint32_t i = 0; i < shader_source_count; ++i)
        r->stages->files[i].path = shader_sources[i].path;
    r->stages->count = shader_source_count;
    for (uint32_t i = 0; kernels[i] && result == WHIT_OK; ++i)
        result = read_file(r, &nobody, kernels[i]);
    r->stages->hash = hash_of(r->stages);
    return result;
}

whit_result shader_stages_read(const whit_log *log, const char *folder, const char *const *kernels,
                               struct shader_stages **out, struct shader_errors *errors)
{
    struct reading r = {.log = log, .errors = errors, .folder = folder};
    char *inside = string_format("%s/x", folder);
    *out = NULL;
    r.stages = calloc(1, sizeof *r.stages);
    whit_result result = r.stages && inside ? roots_init(&r.roots, inside) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        result = read_all(&r, kernels);
    else
        log_error(log, "no memory for the stages");
    roots_finish(&r.roots);
    free(inside);
    if (result == WHIT_OK)
        *out = r.stages;
    else
        shader_stages_destroy(r.stages);
    return result;
}

void shader_stages_destroy(struct shader_stages *stages)
{
    for (uint32_t i = 0; stages && i < stages->count; ++i) {
        free((void *)(uintptr_t)stages->files[i].text);
        free(stages->names[i]);
        if (i >= shader_source_count)
            free((void *)(uintptr_t)stages->files[i].path);
    }
    free(stages);
}
