#include <stdlib.h>
#include <string.h>

#include "api/handles.h"
#include "base/path.h"
#include "base/text.h"
#include "image/image_reply.h"
#include "shader/disassemble.h"
#include "shader/pack.h"
#include "shader/program.h"
#include "shader/sliders.h"
#include "whit/whit_program.h"

struct whit_shader_compiler {
    struct shader_compiler *compiler;
    struct shader_errors errors; /* of the file compiled last */
    whit_shader_error shown[SHADER_ERROR_MAX];
    whit_shader_limits limits;
    whit_log log;
};

whit_result whit_shader_compiler_create(const whit_shader_limits *limits, const whit_log *log,
                                        whit_shader_compiler **out)
{
    *out = NULL;
    whit_shader_compiler *compiler = calloc(1, sizeof *compiler);
    if (compiler) {
        compiler->log = log_or_silence(log);
        compiler->limits = limits ? *limits : (whit_shader_limits){0};
        compiler->compiler = shader_compiler_create(&compiler->log, &compiler->limits, 0.0);
    }
    if (!compiler || !compiler->compiler) {
        free(compiler);
        return API_FAIL(log, WHIT_ERROR_MEMORY, "out of memory");
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

/* Converts the errors for the caller; valid until the next call. */
static void show_errors(whit_shader_compiler *compiler)
{
    const struct shader_errors *errors = &compiler->errors;
    for (uint32_t i = 0; i < errors->count; ++i)
        compiler->shown[i] = (whit_shader_error){errors->items[i].file, errors->items[i].line,
                                                 errors->items[i].reason, errors->items[i].column};
}

uint32_t whit_shader_compiler_errors_left(const whit_shader_compiler *compiler)
{
    return compiler->errors.more;
}

/* ---- In pictures ---- */

/* Reads the text of the functions that a picture file carries. */
static whit_result read_picture(whit_shader_compiler *compiler, const char *path,
                                struct shader_text *text)
{
    const whit_shader_limits *limits = &compiler->limits;
    const struct foreign_params foreign = {.require_sandbox = limits->require_sandbox,
                                           .cancel = limits->cancel};
    whit_text *texts;
    struct shader_pack pack;
    uint32_t count;
    whit_result result = image_load_texts(&compiler->log, path, &foreign, &texts, &count);
    if (result != WHIT_OK)
        return result;
    const char *packed = text_value(texts, count, WHIT_SHADER_KEY);
    if (packed) {
        result = shader_pack_read(&compiler->log, path, packed, &pack);
    } else {
        result = API_FAIL(&compiler->log, WHIT_ERROR_INPUT, "%s: a picture without functions in it",
                          path);
    }
    free(texts);
    if (result != WHIT_OK)
        return result;
    result = shader_text_from(&compiler->log, pack.sources, pack.count, text, &compiler->errors);
    shader_pack_free(&pack);
    return result;
}

char *whit_shader_pack(const whit_shader *shader, const char **why)
{
    return shader_pack_write(&shader->text, why);
}

/* Copies the files into one block: the list, then all texts. */
static whit_shader_file *list_files(const struct shader_pack *pack)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < pack->count; ++i)
        bytes += strlen(pack->sources[i].relative) + pack->sources[i].bytes + 2;
    whit_shader_file *files = malloc(pack->count * sizeof *files + bytes);
    char *at = files ? (char *)(files + pack->count) : NULL;
    for (uint32_t i = 0; files && i < pack->count; ++i) {
        const struct shader_text_source *from = &pack->sources[i];
        size_t name_bytes = strlen(from->relative) + 1;
        files[i] = (whit_shader_file){at, at + name_bytes, from->bytes};
        memcpy(at, from->relative, name_bytes);
        memcpy(at + name_bytes, from->text, from->bytes + 1);
        at += name_bytes + from->bytes + 1;
    }
    return files;
}

whit_result whit_shader_unpack(const char *packed, const char *where, const whit_log *log,
                               whit_shader_file **files, uint32_t *count)
{
    struct shader_pack pack;
    *files = NULL;
    *count = 0;
    whit_result result = shader_pack_read(log, where, packed, &pack);
    if (result != WHIT_OK)
        return result;
    *files = list_files(&pack);
    *count = *files ? pack.count : 0;
    shader_pack_free(&pack);
    if (*files)
        return WHIT_OK;
    return API_FAIL(log, WHIT_ERROR_MEMORY, "%s: out of memory", where);
}

/* ---- Loading ---- */

/* Reads the text of functions from a GLSL file or a picture; none if `path` is NULL. */
static whit_result read_functions(whit_shader_compiler *compiler, const char *path,
                                  struct shader_text *text)
{
    *text = (struct shader_text){0};
    if (!path)
        return WHIT_OK;
    bool picture = path_is(path, "png") || path_is(path, "exr");
    return picture ? read_picture(compiler, path, text)
                   : shader_text_read(&compiler->log, path, text, &compiler->errors);
}

whit_result whit_shader_load(whit_shader_compiler *compiler, const char *path, bool trust,
                             whit_shader **out)
{
    return whit_shader_load_stages(compiler, path, NULL, trust, out);
}

whit_result whit_shader_load_stages(whit_shader_compiler *compiler, const char *path,
                                    const char *folder, bool trust, whit_shader **out)
{
    struct shader_errors *errors = &compiler->errors;
    struct shader_text text;
    struct shader_stages *stages;
    *errors = (struct shader_errors){0};
    *out = NULL;
    if (!path && !folder)
        return API_FAIL(&compiler->log, WHIT_ERROR_USAGE, "there is no path of a file to load");
    whit_result result = read_functions(compiler, path, &text);
    if (result == WHIT_OK) {
        result = shader_program_stages(&compiler->log, folder, &stages, errors);
        if (result == WHIT_OK)
            result = shader_program_create(&compiler->log, compiler->compiler, &text, stages, trust,
                                           out, errors);
        else
            shader_text_free(&text);
    }
    show_errors(compiler);
    return result;
}

whit_result whit_shader_compile_tests(whit_shader_compiler *compiler, whit_shader *shader)
{
    compiler->errors = (struct shader_errors){0};
    if (!shader->tests.test_count)
        return API_FAIL(&compiler->log, WHIT_ERROR_USAGE, "%s: it has no tests", shader->files[0]);
    whit_result result =
        shader_program_compile_tests(&compiler->log, compiler->compiler, shader, &compiler->errors);
    show_errors(compiler);
    return result;
}

whit_result whit_renderer_run_tests(whit_renderer *renderer, whit_check_result *results,
                                    double *compile_ms, double *run_ms)
{
    whit_result result = api_need_device(renderer);
    return result == WHIT_OK ? renderer_run_tests(renderer->renderer, results, compile_ms, run_ms)
                             : result;
}

whit_result whit_renderer_check_expectations(whit_renderer *renderer, bool *held)
{
    whit_result result = api_need_device(renderer);
    *held = false;
    return result == WHIT_OK ? renderer_check_expectations(renderer->renderer, held) : result;
}

void whit_shader_destroy(whit_shader *shader)
{
    shader_program_destroy(shader);
}

void whit_shader_get_info(const whit_shader *shader, whit_shader_info *info)
{
    *info = (whit_shader_info){.files = shader->files,
                               .file_count = shader->file_count,
                               .hooks = shader->hooks,
                               .sliders = shader->sliders,
                               .slider_count = shader->slider_count,
                               .tests = shader->test_infos,
                               .checks = shader->check_infos,
                               .test_count = shader->tests.test_count,
                               .check_count = shader->tests.check_count,
                               .expectations = shader->expectations,
                               .expectation_count = shader->expectation_count,
                               .aovs = shader->aov_names,
                               .aov_count = shader->aov_count,
                               .dbg_count = shader->dbg.count,
                               .fuel = shader->trust ? 0 : shader->fuel,
                               .hash = shader_text_hash(&shader->text) ^
                                       (shader->stages ? shader->stages->hash : 0)};
    for (uint32_t i = 0; i < HOOK_KERNEL_COUNT; ++i) {
        info->kernel_count += shader->codes[i].words != NULL;
        info->instructions += shader->codes[i].instructions;
        info->traces = info->traces ||
                       (i != HOOK_KERNEL_TEST && (shader->codes[i].reaches & SHADER_REACHES_RAYS));
    }
}

bool whit_shader_keep_sliders(const whit_shader *shader, char *sliders)
{
    return shader_sliders_keep(shader, sliders);
}

/* The kernel of the index-th code that the shader has; HOOK_KERNEL_COUNT: there is none. */
static enum hook_kernel find_kernel(const whit_shader *shader, uint32_t index)
{
    uint32_t kernel = 0;
    while (kernel < HOOK_KERNEL_COUNT && (!shader->codes[kernel].words || index-- > 0))
        kernel++;
    return (enum hook_kernel)kernel;
}

const char *whit_shader_kernel(const whit_shader *shader, uint32_t index, const uint32_t **words,
                               size_t *bytes)
{
    enum hook_kernel kernel = find_kernel(shader, index);
    if (kernel == HOOK_KERNEL_COUNT)
        return NULL;
    *words = shader->codes[kernel].words;
    *bytes = shader->codes[kernel].bytes;
    return hook_kernels[kernel].name;
}

char *whit_shader_kernel_text(const whit_shader *shader, uint32_t index)
{
    const whit_log silent = log_or_silence(NULL);
    enum hook_kernel kernel = find_kernel(shader, index);
    return kernel == HOOK_KERNEL_COUNT ? NULL : shader_program_expand(&silent, shader, kernel);
}

char *whit_spirv_text(const uint32_t *words, size_t bytes)
{
    return shader_disassemble(words, bytes);
}
