#include "shader/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "kernels.h"
#include "sources.h"

enum { DEFINE_BYTES = 48 };

#define USER_INCLUDE "#include \"../hook/user.glsl\"\n"

static const char *const hook_names[SHADER_HOOK_COUNT] = {
    [SHADER_HOOK_CAMERA] = "camera", [SHADER_HOOK_SURFACE] = "surface",
    [SHADER_HOOK_SHADE] = "shade",   [SHADER_HOOK_SCATTER] = "scatter",
    [SHADER_HOOK_MISS] = "miss",     [SHADER_HOOK_POST] = "post"};

#define BIT(hook) (1u << SHADER_HOOK_##hook)

/* In the order of enum hook_kernel. Every stage makes the camera's rays anew. */
static const uint32_t kernel_hooks[SHADER_KERNEL_COUNT] = {
    [SHADER_KERNEL_CLOSEST] = BIT(CAMERA) | BIT(MISS),
    [SHADER_KERNEL_SHADE] = BIT(CAMERA) | BIT(SURFACE) | BIT(SHADE) | BIT(SCATTER),
    [SHADER_KERNEL_SHADOW] = BIT(CAMERA),
    [SHADER_KERNEL_RESOLVE] = BIT(POST),
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

static const struct shader_source *find_source(const char *path)
{
    for (size_t i = 0; i < shader_source_count; ++i) {
        if (strcmp(shader_sources[i].path, path) == 0)
            return &shader_sources[i];
    }
    return NULL;
}

#define HOOK_TEXT "kernel/hook.comp"

/* Its text, with the sliders declared in front of the user's. NULL: no memory. */
static char *hook_text(const char *sliders)
{
    const struct shader_source *source = find_source(HOOK_TEXT);
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
                           whit_shader *shader, enum shader_kernel kernel, const char *sliders,
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
    char *text = hook_text(sliders);
    if (!text) {
        log_error(log, "out of memory for the text of a kernel");
        return WHIT_ERROR_MEMORY;
    }
    const struct shader_request request = {.kernel = HOOK_TEXT,
                                           .kernel_text = text,
                                           .defines = defines,
                                           .define_count = count,
                                           .trust = shader->trust,
                                           .links = 1 + (uint32_t)kernel};
    whit_result result =
        shader_compile(compiler, &shader->text, &request, &shader->codes[kernel], errors);
    free(text);
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
        if (kernel_hooks[i] & shader->hooks)
            result = compile(log, compiler, shader, (enum shader_kernel)i, sliders, errors);
    }
    free(sliders);
    return result;
}

whit_result shader_program_create_of(const whit_log *log, struct shader_compiler *compiler,
                                     struct shader_text *text, bool trust, whit_shader **out,
                                     struct shader_errors *errors)
{
    *out = NULL;
    whit_shader *shader = calloc(1, sizeof *shader);
    if (!shader) {
        log_error(log, "out of memory");
        shader_text_free(text);
        return WHIT_ERROR_MEMORY;
    }
    shader->fuel = SHADER_FUEL_USUAL;
    shader->trust = trust;
    shader->text = *text;
    *text = (struct shader_text){0};
    whit_result result = shader_annotations_read(log, shader, errors);
    if (result == WHIT_OK)
        result = find_hooks(log, shader, errors);
    if (result == WHIT_OK)
        result = compile_all(log, compiler, shader, errors);
    if (result != WHIT_OK) {
        shader_program_destroy(shader);
        return result;
    }
    for (uint32_t i = 0; i < shader->text.file_count; ++i)
        shader->files[i] = shader->text.files[i].name;
    *out = shader;
    return WHIT_OK;
}

whit_result shader_program_create(const whit_log *log, struct shader_compiler *compiler,
                                  const char *path, bool trust, whit_shader **out,
                                  struct shader_errors *errors)
{
    struct shader_text text;
    *out = NULL;
    whit_result result = shader_text_read(log, path, &text, errors);
    return result == WHIT_OK ? shader_program_create_of(log, compiler, &text, trust, out, errors)
                             : result;
}

void shader_program_destroy(whit_shader *shader)
{
    if (!shader)
        return;
    for (uint32_t i = 0; i < SHADER_KERNEL_COUNT; ++i)
        shader_code_free(&shader->codes[i]);
    shader_text_free(&shader->text);
    free(shader);
}

char *shader_template(const char *hook)
{
    char path[64];
    bool known = false;
    for (uint32_t i = 0; i < SHADER_HOOK_COUNT; ++i)
        known = known || strcmp(hook, hook_names[i]) == 0;
    snprintf(path, sizeof path, "hook/%.40s.glsl", hook);
    const struct shader_source *source = known ? find_source(path) : NULL;
    if (!source)
        return NULL;
    const char *first = "//@ whit 1\n";
    char *text = calloc(source->bytes + strlen(first) + 1, 1);
    if (text) {
        strcpy(text, first);
        memcpy(text + strlen(first), source->text, source->bytes);
    }
    return text;
}
