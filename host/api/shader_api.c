#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "shader/program.h"

struct whit_shader_compiler {
    struct shader_compiler *compiler;
    struct shader_errors errors; /* of the last file */
    whit_shader_error shown[SHADER_ERROR_MAX];
    whit_log log;
};

whit_result whit_shader_compiler_create(const whit_shader_limits *limits, const whit_log *log,
                                        whit_shader_compiler **out)
{
    *out = NULL;
    whit_shader_compiler *compiler = calloc(1, sizeof *compiler);
    const whit_shader_limits none = {0};
    limits = limits ? limits : &none;
    const struct shader_limits inner = {.cpu_s = limits->cpu_s,
                                        .memory_bytes = limits->memory_bytes,
                                        .require_sandbox = limits->require_sandbox,
                                        .cancel = limits->cancel};
    if (compiler) {
        compiler->log = log_or_silence(log);
        compiler->compiler = shader_compiler_create(&compiler->log, &inner);
    }
    if (!compiler || !compiler->compiler) {
        const whit_log silent = log_or_silence(log);
        log_error(&silent, "out of memory");
        free(compiler);
        return WHIT_ERROR_MEMORY;
    }
    *out = compiler;
    return WHIT_OK;
}

void whit_shader_compiler_destroy(whit_shader_compiler *compiler)
{
    if (!compiler)
        return;
    shader_compiler_destroy(compiler->compiler);
    free(compiler);
}

uint32_t whit_shader_compiler_errors(const whit_shader_compiler *compiler,
                                     const whit_shader_error **errors)
{
    *errors = compiler->shown;
    return compiler->errors.count;
}

whit_result whit_shader_load(whit_shader_compiler *compiler, const char *path, bool trust,
                             whit_shader **out)
{
    struct shader_errors *errors = &compiler->errors;
    *errors = (struct shader_errors){0};
    whit_result result =
        shader_program_create(&compiler->log, compiler->compiler, path, trust, out, errors);
    for (uint32_t i = 0; i < errors->count; ++i)
        compiler->shown[i] = (whit_shader_error){errors->items[i].file, errors->items[i].line,
                                                 errors->items[i].reason};
    return result;
}

void whit_shader_destroy(whit_shader *shader)
{
    shader_program_destroy(shader);
}

void whit_shader_get_info(const whit_shader *shader, whit_shader_info *info)
{
    *info = (whit_shader_info){.files = shader->files,
                               .file_count = shader->text.file_count,
                               .hooks = shader->names,
                               .sliders = shader->sliders,
                               .slider_count = shader->slider_count,
                               .fuel = shader->trust ? 0 : shader->fuel,
                               .hash = shader_text_hash(&shader->text)};
    while (info->hook_count < SHADER_HOOK_COUNT && shader->names[info->hook_count])
        info->hook_count++;
    for (uint32_t i = 0; i < SHADER_KERNEL_COUNT; ++i) {
        info->kernel_count += shader->codes[i].words != NULL;
        info->instructions += shader->codes[i].instructions;
    }
}

const char *whit_shader_kernel(const whit_shader *shader, uint32_t index, const uint32_t **words,
                               size_t *bytes)
{
    for (uint32_t i = 0; i < SHADER_KERNEL_COUNT; ++i) {
        const struct shader_code *code = &shader->codes[i];
        if (!code->words || index-- > 0)
            continue;
        *words = code->words;
        *bytes = code->bytes;
        return shader_kernel_name((enum shader_kernel)i);
    }
    return NULL;
}

char *whit_shader_template(const char *hook)
{
    return shader_template(hook);
}

const char *whit_shader_hook_name(uint32_t index)
{
    return shader_hook_name((enum shader_hook)index);
}
