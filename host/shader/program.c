#include "shader/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"

enum { DEFINE_BYTES = 48 };

#define USER_INCLUDE "#include \"../hook/user.glsl\"\n"

static const char *const hook_names[SHADER_HOOK_COUNT] = {
    [SHADER_HOOK_CAMERA] = "camera", [SHADER_HOOK_SURFACE] = "surface",
    [SHADER_HOOK_SHADE] = "shade",   [SHADER_HOOK_SCATTER] = "scatter",
    [SHADER_HOOK_MISS] = "miss",     [SHADER_HOOK_POST] = "post"};

#define BIT(hook) (1u << SHADER_HOOK_##hook)

/* In the order of enum hook_kernel. Every stage makes the camera's rays anew. */
static const struct {
    const char *path;
    uint32_t hooks;
} kernel_table[SHADER_KERNEL_COUNT] = {
    [SHADER_KERNEL_CLOSEST] = {"kernel/closest.comp", BIT(CAMERA) | BIT(MISS)},
    [SHADER_KERNEL_SHADE] = {"kernel/shade.comp",
                             BIT(CAMERA) | BIT(SURFACE) | BIT(SHADE) | BIT(SCATTER)},
    [SHADER_KERNEL_SHADOW] = {"kernel/shadow.comp", BIT(CAMERA)},
    [SHADER_KERNEL_RESOLVE] = {"kernel/resolve.comp", BIT(POST)},
};
_Static_assert((int)SHADER_KERNEL_COUNT == (int)HOOK_KERNEL_COUNT &&
                   (int)SHADER_KERNEL_RESOLVE == (int)HOOK_KERNEL_RESOLVE,
               "the same kernels");

const char *shader_hook_name(enum shader_hook hook)
{
    return (unsigned)hook < SHADER_HOOK_COUNT ? hook_names[hook] : NULL;
}

const char *shader_kernel_name(enum shader_kernel kernel)
{
    return hook_kernels[kernel].name;
}

const struct shader_code *shader_code_of(const whit_shader *shader, const char *kernel)
{
    for (uint32_t i = 0; shader && i < SHADER_KERNEL_COUNT; ++i) {
        if (strcmp(hook_kernels[i].name, kernel) == 0 && shader->codes[i].words)
            return &shader->codes[i];
    }
    return NULL;
}

bool shader_is_hooked(const whit_shader *shader, const char *kernel)
{
    for (uint32_t i = 0; shader && i < SHADER_KERNEL_COUNT; ++i) {
        if (strcmp(hook_kernels[i].name, kernel) == 0)
            return kernel_table[i].hooks & shader->hooks;
    }
    return false;
}

/* As report_hooks() of hook/prelude.glsl puts it together. */
bool shader_find_loop(const whit_shader *shader, uint32_t number, const char **file, uint32_t *line)
{
    uint32_t kernel = number >> 16, loop = number & 0xffff;
    if (kernel >= SHADER_KERNEL_COUNT || loop == 0 || loop > shader->codes[kernel].loop_count)
        return false;
    const struct shader_loop *found = &shader->codes[kernel].loops[loop - 1];
    *file = shader->text.files[found->file].name;
    *line = found->line;
    return true;
}

#define HOOK_TEXT "kernel/hook.comp"

/* Its text, with the sliders declared in front of the user's. NULL: no memory, or it has no place
   for them. */
static char *hook_text(const struct shader_stages *stages, const char *sliders)
{
    uint32_t count, index = shader_stages_find(stages, HOOK_TEXT);
    const struct shader_source *sources = shader_stages_list(stages, &count);
    const struct shader_source *source = index < count ? &sources[index] : NULL;
    const char *at = source ? strstr(source->text, USER_INCLUDE) : NULL;
    if (!at)
        return NULL;
    size_t front = (size_t)(at - source->text), bytes = strlen(sliders);
    char *text = calloc(source->bytes + bytes + 1, 1);
    if (text) {
        memcpy(text, source->text, front);
        memcpy(text + front, sliders, bytes);
        memcpy(text + front + bytes, at, source->bytes - front);
    }
    return text;
}

static whit_result compile(const whit_log *log, struct shader_compiler *compiler,
                           whit_shader *shader, enum shader_kernel kernel,
                           const struct kernel_code *base, const char *sliders,
                           struct shader_errors *errors)
{
    char texts[SHADER_HOOK_COUNT][DEFINE_BYTES];
    const char *defines[SHADER_HOOK_COUNT];
    uint32_t count = 0;
    for (uint32_t i = 0; i < SHADER_HOOK_COUNT; ++i) {
        if (!shader_has(shader, (enum shader_hook)i))
            continue;
        snprintf(texts[count], DEFINE_BYTES, "HAS_%s", hook_names[i]);
        for (char *c = texts[count]; *c; ++c)
            *c = (char)(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
        defines[count] = texts[count];
        count++;
    }
    char *text = hook_text(shader->stages, sliders);
    if (!text) {
        log_error(log, "%s: no memory, or it does not include hook/user.glsl", HOOK_TEXT);
        return WHIT_ERROR_MEMORY;
    }
    const struct shader_request request = {.kernel = HOOK_TEXT,
                                           .kernel_text = text,
                                           .defines = defines,
                                           .define_count = count,
                                           .stages = shader->stages,
                                           .trust = shader->trust,
                                           .base = base->words,
                                           .base_bytes = base->bytes};
    whit_result result =
        shader_compile(compiler, &shader->text, &request, &shader->codes[kernel], errors);
    free(text);
    return result;
}

/* A kernel of other stages than the embedded ones: as it is, or with room for the user's functions.
 */
static whit_result compile_stage(struct shader_compiler *compiler, const whit_shader *shader,
                                 enum shader_kernel kernel, bool hooks, struct shader_code *code,
                                 struct shader_errors *errors)
{
    char number[DEFINE_BYTES];
    snprintf(number, sizeof number, "HOOK_KERNEL %uu", (unsigned)kernel);
    const char *const defines[] = {"HOOKS", number};
    const struct shader_request request = {.kernel = kernel_table[kernel].path,
                                           .defines = defines,
                                           .define_count = hooks ? 2 : 0,
                                           .stages = shader->stages,
                                           .names = hooks};
    return shader_compile(compiler, NULL, &request, code, errors);
}

static whit_result compile_hooked(const whit_log *log, struct shader_compiler *compiler,
                                  whit_shader *shader, enum shader_kernel kernel,
                                  const char *sliders, struct shader_errors *errors)
{
    struct shader_code code = {0};
    whit_result result = WHIT_OK;
    if (shader->stages)
        result = compile_stage(compiler, shader, kernel, true, &code, errors);
    const struct kernel_code base = {hook_kernels[kernel].name, code.words, code.bytes};
    if (result == WHIT_OK)
        result = compile(log, compiler, shader, kernel,
                         shader->stages ? &base : &hook_kernels[kernel], sliders, errors);
    shader_code_free(&code);
    return result;
}

static whit_result find_hooks(const whit_log *log, whit_shader *shader,
                              struct shader_errors *errors)
{
    for (uint32_t i = 0, count = 0; i < SHADER_HOOK_COUNT; ++i) {
        if (!shader_text_defines(&shader->text, hook_names[i], NULL, NULL))
            continue;
        shader->hooks |= 1u << i;
        shader->names[count++] = hook_names[i];
    }
    if (shader->hooks)
        return WHIT_OK;
    shader_error_add(log, errors, shader->text.files[0].name, 0,
                     "has none of the functions camera, surface, shade, scatter, miss, post");
    return WHIT_ERROR_INPUT;
}

static whit_result compile_all(const whit_log *log, struct shader_compiler *compiler,
                               whit_shader *shader, struct shader_errors *errors)
{
    char *sliders = shader_sliders_declare(shader);
    whit_result result = sliders ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; result == WHIT_OK && i < SHADER_KERNEL_COUNT; ++i) {
        if (kernel_table[i].hooks & shader->hooks)
            result = compile_hooked(log, compiler, shader, (enum shader_kernel)i, sliders, errors);
        else if (shader->stages)
            result = compile_stage(compiler, shader, (enum shader_kernel)i, false,
                                   &shader->codes[i], errors);
    }
    free(sliders);
    return result;
}

static void list_files(whit_shader *shader)
{
    for (uint32_t i = 0; i < shader->text.file_count; ++i)
        shader->files[shader->file_count++] = shader->text.files[i].name;
    for (uint32_t i = 0; shader->stages && i < shader->stages->count; ++i) {
        if (shader->stages->names[i])
            shader->files[shader->file_count++] = shader->stages->names[i];
    }
}

whit_result shader_program_stages(const whit_log *log, const char *folder,
                                  struct shader_stages **stages, struct shader_errors *errors)
{
    const char *paths[SHADER_KERNEL_COUNT + 2] = {[SHADER_KERNEL_COUNT] = HOOK_TEXT};
    for (uint32_t i = 0; i < SHADER_KERNEL_COUNT; ++i)
        paths[i] = kernel_table[i].path;
    *stages = NULL;
    return folder ? shader_stages_read(log, folder, paths, stages, errors) : WHIT_OK;
}

whit_result shader_program_create(const whit_log *log, struct shader_compiler *compiler,
                                  struct shader_text *text, struct shader_stages *stages,
                                  bool trust, whit_shader **out, struct shader_errors *errors)
{
    *out = NULL;
    whit_shader *shader = calloc(1, sizeof *shader);
    if (!shader) {
        log_error(log, "out of memory");
        shader_text_free(text);
        shader_stages_destroy(stages);
        return WHIT_ERROR_MEMORY;
    }
    shader->fuel = SHADER_FUEL_USUAL;
    shader->trust = trust;
    shader->text = *text;
    shader->stages = stages;
    *text = (struct shader_text){0};
    bool has_text = shader->text.file_count > 0;
    whit_result result = has_text ? shader_annotations_read(log, shader, errors) : WHIT_OK;
    if (result == WHIT_OK && has_text)
        result = find_hooks(log, shader, errors);
    if (result == WHIT_OK)
        result = compile_all(log, compiler, shader, errors);
    if (result != WHIT_OK) {
        shader_program_destroy(shader);
        return result;
    }
    list_files(shader);
    *out = shader;
    return WHIT_OK;
}

void shader_program_destroy(whit_shader *shader)
{
    if (!shader)
        return;
    for (uint32_t i = 0; i < SHADER_KERNEL_COUNT; ++i)
        shader_code_free(&shader->codes[i]);
    shader_text_free(&shader->text);
    shader_stages_destroy(shader->stages);
    free(shader);
}

char *shader_template(const char *hook)
{
    char path[64];
    bool known = false;
    for (uint32_t i = 0; i < SHADER_HOOK_COUNT; ++i)
        known = known || strcmp(hook, hook_names[i]) == 0;
    snprintf(path, sizeof path, "hook/%.40s.glsl", hook);
    uint32_t index = shader_stages_find(NULL, path);
    const struct shader_source *source = &shader_sources[index];
    if (!known || index == shader_source_count)
        return NULL;
    const char *first = "//@ whit 1\n";
    char *text = calloc(source->bytes + strlen(first) + 1, 1);
    if (text) {
        strcpy(text, first);
        memcpy(text + strlen(first), source->text, source->bytes);
    }
    return text;
}
