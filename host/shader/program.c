#include "shader/program.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "shader/annotations.h"
#include "shader/expand.h"
#include "shader/scan.h"
#include "shader/sliders.h"
#include "whit/whit_program.h"

enum { DEFINES_MAX = WHIT_HOOKS + 1, DEFINE_BYTES = 48 };

/* Processor time to compile a kernel. A few thousand lines take half of it, and a text that would
   compile for ever is reported within a second. */
#define FUNCTIONS_CPU_S 0.8

static const char *const hook_names[WHIT_HOOKS] = {
    [WHIT_HOOK_CAMERA] = "camera", [WHIT_HOOK_SURFACE] = "surface",
    [WHIT_HOOK_SHADE] = "shade",   [WHIT_HOOK_SCATTER] = "scatter",
    [WHIT_HOOK_MISS] = "miss",     [WHIT_HOOK_POST] = "post",
    [WHIT_HOOK_AOV] = "aov",       [WHIT_HOOK_INTERSECT] = "intersect"};

#define BIT(hook) (1u << WHIT_HOOK_##hook)

/* camera() is in several kernels, as each of these stages makes
   the camera rays anew. */
static const struct {
    const char *path;
    uint32_t hooks;
} kernel_table[HOOK_KERNEL_COUNT] = {
    [HOOK_KERNEL_CLOSEST] = {"kernel/closest.comp", BIT(CAMERA)},
    [HOOK_KERNEL_SHADE] = {"kernel/shade.comp", BIT(CAMERA) | BIT(SCATTER)},
    [HOOK_KERNEL_SHADOW] = {"kernel/shadow.comp", BIT(CAMERA)},
    [HOOK_KERNEL_RESOLVE] = {"kernel/resolve.comp", 0},
    [HOOK_KERNEL_MISS] = {"kernel/miss.comp", BIT(MISS)},
    [HOOK_KERNEL_SHAPE] = {"kernel/shape.comp", BIT(INTERSECT)},
    [HOOK_KERNEL_HIT] = {"kernel/hit.comp", BIT(SURFACE) | BIT(SHADE)},
    [HOOK_KERNEL_AOV] = {"kernel/aov.comp", BIT(AOV)},
    [HOOK_KERNEL_POST] = {"kernel/post.comp", BIT(POST)},
    [HOOK_KERNEL_TEST] = {"kernel/test.comp", 0},
};

const char *whit_hook_name(whit_hook hook)
{
    return (unsigned)hook < WHIT_HOOKS ? hook_names[hook] : "";
}

/* The index of a kernel by name; HOOK_KERNEL_COUNT: hooks are no part of it. */
static uint32_t find_kernel(const char *name)
{
    uint32_t i = 0;
    while (i < HOOK_KERNEL_COUNT && strcmp(hook_kernels[i].name, name) != 0)
        i++;
    return i;
}

const struct shader_code *shader_code_of(const whit_shader *shader, const char *kernel, bool dbg)
{
    uint32_t i = find_kernel(kernel);
    if (!shader || i == HOOK_KERNEL_COUNT)
        return NULL;
    const struct shader_code *code = &shader->dbg_codes[i];
    code = dbg && code->words ? code : &shader->codes[i];
    return code->words ? code : NULL;
}

bool shader_is_hooked(const whit_shader *shader, const char *kernel)
{
    uint32_t i = find_kernel(kernel);
    return shader && i < HOOK_KERNEL_COUNT && (kernel_table[i].hooks & shader->hooks);
}

uint32_t shader_reaches(const whit_shader *shader)
{
    /* Stages of the user's own may call functions that reach.c does not know. */
    uint32_t reaches = shader->stages ? SHADER_REACHES_ALL : 0;
    for (uint32_t i = 0; i < HOOK_KERNEL_TEST; ++i)
        reaches |= shader->codes[i].reaches;
    return reaches;
}

/* `number`: kernel << 16 | loop, as report_hooks() of hook/prelude.glsl stores it. */
bool shader_find_loop(const whit_shader *shader, uint32_t number, const char **file, uint32_t *line)
{
    uint32_t kernel = number >> 16, loop = number & 0xffff;
    if (kernel >= HOOK_KERNEL_COUNT || loop == 0 || loop > shader->codes[kernel].loop_count)
        return false;
    const struct shader_loop *found = &shader->codes[kernel].loops[loop - 1];
    *file = shader->text.files[found->file].name;
    *line = found->line;
    return true;
}

bool shader_find_open(const whit_shader *shader, uint32_t number, const char **file, uint32_t *line)
{
    for (uint32_t i = 0; i < HOOK_KERNEL_COUNT * SHADER_OPENS_MAX; ++i) {
        const struct shader_open *open =
            &shader->codes[i / SHADER_OPENS_MAX].opens[i % SHADER_OPENS_MAX];
        if (!number || open->number != number || open->file >= shader->text.file_count)
            continue;
        *file = shader->text.files[open->file].name;
        *line = open->line;
        return true;
    }
    return false;
}

#define HOOK_TEXT "kernel/hook.comp"

enum { AOV_BYTES = 256 };

/* The GLSL of aov(), which hook/declare.glsl declares: it calls the functions below //@ aov. NULL:
   no memory. */
static char *declare_aovs(const whit_shader *shader)
{
    size_t bytes = (size_t)(shader->aov_count + 1) * AOV_BYTES, used = 0;
    char *text = calloc(bytes, 1);
    if (!text || shader->aov_count == 0)
        return text;
    for (uint32_t i = 0; i < shader->aov_count; ++i)
        used += (size_t)snprintf(text + used, bytes - used, "vec4 %s(Surface s);\n",
                                 shader->aovs[i].name);
    used += (size_t)snprintf(text + used, bytes - used,
                             "vec4 aov(uint whit_index, Surface whit_s)\n{\n"
                             "    vec4 whit_value = vec4(0.0);\n");
    for (uint32_t i = 0; i < shader->aov_count; ++i)
        used += (size_t)snprintf(text + used, bytes - used,
                                 "    if (whit_index == %uu)\n        whit_value = %s(whit_s);\n",
                                 i, shader->aovs[i].name);
    snprintf(text + used, bytes - used, "    return whit_value;\n}\n");
    return text;
}

/* The GLSL of shape_box(), which hook/declare.glsl declares. NULL: no memory. */
static char *declare_box(const whit_shader *shader)
{
    const struct shader_box *box = &shader->box;
    if (!shader_has(shader, WHIT_HOOK_INTERSECT))
        return string_copy("");
    return string_format("void shape_box(out vec3 lo, out vec3 hi, out float error)\n{\n"
                         "    lo = vec3(%.9e, %.9e, %.9e);\n    hi = vec3(%.9e, %.9e, %.9e);\n"
                         "    error = %.9e;\n}\n",
                         (double)box->lo[0], (double)box->lo[1], (double)box->lo[2],
                         (double)box->hi[0], (double)box->hi[1], (double)box->hi[2],
                         (double)box->error);
}

/* The parts of the user's text that a kernel has besides hooks: no others, the tests, or calls of
   dbg(). */
enum kernel_text {
    TEXT_PLAIN,
    TEXT_TESTS,
    TEXT_DBG /* dbg(x) is replaced by code that records x */
};

/* The user's text for a kernel, and the declarations in front of it. */
struct kernel_parts {
    enum kernel_text kind;
    struct shader_text user;
    char *declared;
};

/* The step that keeps byte offsets comes first, so that the second one finds its places too. */
static bool make_text(const whit_shader *shader, enum kernel_text kind, struct shader_text *out)
{
    struct shader_text between;
    bool fine;
    if (kind == TEXT_DBG)
        fine = shader_tests_text(&shader->tests, &shader->text, false, &between) &&
               shader_dbg_text(&shader->dbg, &between, true, out);
    else
        fine = shader_dbg_text(&shader->dbg, &shader->text, false, &between) &&
               shader_tests_text(&shader->tests, &between, kind == TEXT_TESTS, out);
    shader_text_end_copy(&between);
    return fine;
}

static bool parts_init(const whit_log *log, const whit_shader *shader, enum kernel_text kind,
                       struct kernel_parts *parts)
{
    *parts = (struct kernel_parts){.kind = kind};
    char *sliders = shader_sliders_declare(shader);
    char *aovs = declare_aovs(shader), *box = declare_box(shader);
    char *calls = kind == TEXT_TESTS ? shader_tests_call(&shader->tests) : string_copy("");
    if (sliders && aovs && box && calls)
        parts->declared = string_format("%s%s%s%s", sliders, aovs, box, calls);
    free(calls);
    free(box);
    free(aovs);
    free(sliders);
    bool fine = parts->declared && make_text(shader, kind, &parts->user);
    if (!fine)
        log_error(log, "no memory for the text of a kernel");
    return fine;
}

static void parts_finish(struct kernel_parts *parts)
{
    shader_text_end_copy(&parts->user);
    free(parts->declared);
}

/* A request and what it points to. It points into itself: do not move it. */
struct kernel_request {
    char texts[DEFINES_MAX][DEFINE_BYTES];
    const char *defines[DEFINES_MAX];
    struct shader_request request;
};

/* Prepares the request to compile the user's functions. */
static void kernel_request_init(const whit_shader *shader, const struct kernel_parts *parts,
                                struct kernel_request *of)
{
    uint32_t count = 0;
    if (parts->kind != TEXT_PLAIN)
        snprintf(of->texts[count++], DEFINE_BYTES,
                 parts->kind == TEXT_TESTS ? "HAS_TESTS" : "HAS_DBG");
    for (uint32_t i = 0; i < WHIT_HOOKS; ++i) {
        if (!shader_has(shader, (whit_hook)i))
            continue;
        snprintf(of->texts[count], DEFINE_BYTES, "HAS_%s", hook_names[i]);
        for (char *c = of->texts[count]; *c; ++c)
            *c = (char)(*c >= 'a' && *c <= 'z' ? *c - 'a' + 'A' : *c);
        count++;
    }
    for (uint32_t i = 0; i < count; ++i)
        of->defines[i] = of->texts[i];
    of->request = (struct shader_request){.kernel = HOOK_TEXT,
                                          .declared = parts->declared,
                                          .defines = of->defines,
                                          .define_count = count,
                                          .stages = shader->stages,
                                          .trust = shader->trust};
}

/* Finds whit's functions in the file. False: it lacks something, see explain_lack. */
static bool find_hooks(whit_shader *shader)
{
    for (uint32_t i = 0; i < WHIT_HOOKS; ++i) {
        if (i == WHIT_HOOK_AOV ? shader->aov_count == 0
                               : !shader_text_defines(&shader->text, hook_names[i], NULL, NULL))
            continue;
        shader->hooks |= 1u << i;
    }
    return (shader->hooks || shader->tests.test_count) &&
           shader_has(shader, WHIT_HOOK_INTERSECT) == (shader->box.line > 0);
}

/* Compiles a kernel of shader->stages: as it is, or (`hooks`) as a base that the user's functions
   can be linked into. */
static whit_result compile_stage(struct shader_compiler *compiler, const whit_shader *shader,
                                 enum hook_kernel kernel, bool hooks, struct shader_code *code,
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

/* Compiles the user's functions and links them into a kernel. */
static whit_result compile_hooked(struct shader_compiler *compiler, whit_shader *shader,
                                  const struct kernel_parts *parts, enum hook_kernel kernel,
                                  struct shader_errors *errors)
{
    struct shader_code base = {0},
                       *codes = parts->kind == TEXT_DBG ? shader->dbg_codes : shader->codes;
    struct kernel_request of;
    whit_result result = WHIT_OK;
    kernel_request_init(shader, parts, &of);
    if (shader->stages)
        result = compile_stage(compiler, shader, kernel, true, &base, errors);
    of.request.base = shader->stages ? base.words : hook_kernels[kernel].words;
    of.request.base_bytes = shader->stages ? base.bytes : hook_kernels[kernel].bytes;
    of.request.cpu_s = parts->kind == TEXT_TESTS ? 0.0 : FUNCTIONS_CPU_S;
    if (result == WHIT_OK)
        result = shader_compile(compiler, &parts->user, &of.request, &codes[kernel], errors);
    shader_code_free(&base);
    return result;
}

/* Whether a kernel of this kind has functions of the user. The shadow stage records no dbg(x): it
   makes the camera rays again, which the first stage has recorded. */
static bool has_functions(const whit_shader *shader, enum kernel_text kind, uint32_t kernel)
{
    if (kind == TEXT_TESTS)
        return kernel == HOOK_KERNEL_TEST;
    return (kernel_table[kernel].hooks & shader->hooks) &&
           !(kind == TEXT_DBG && kernel == HOOK_KERNEL_SHADOW);
}

static whit_result compile_all(const whit_log *log, struct shader_compiler *compiler,
                               whit_shader *shader, enum kernel_text kind,
                               struct shader_errors *errors)
{
    struct kernel_parts parts;
    whit_result result = parts_init(log, shader, kind, &parts) ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; result == WHIT_OK && i < HOOK_KERNEL_COUNT; ++i) {
        enum hook_kernel kernel = (enum hook_kernel)i;
        if (has_functions(shader, kind, i))
            result = compile_hooked(compiler, shader, &parts, kernel, errors);
        else if (kind == TEXT_PLAIN && shader->stages && i < HOOK_KERNEL_MISS)
            result = compile_stage(compiler, shader, kernel, false, &shader->codes[i], errors);
    }
    parts_finish(&parts);
    return result;
}

/* Whether the files call or declare a function of this name. A variable may have the name, too. */
static bool has_call(const struct shader_text *text, const char *name)
{
    for (uint32_t i = 0; i < text->file_count; ++i) {
        struct scan scan;
        bool named = false;
        scan_begin(&scan, text->files[i].text, text->files[i].bytes);
        while (scan_next(&scan)) {
            if (named && (scan_is(&scan, SCAN_SIGN, "(") || scan.kind == SCAN_NEWLINE))
                return true;
            named = scan_is(&scan, SCAN_WORD, name);
        }
    }
    return false;
}

/* Reports what a file lacks: functions, or intersect() for its //@ box, or the box. A brace or
   bracket without its other one hides functions, and then the compiler knows where it is. */
static whit_result explain_lack(const whit_log *log, struct shader_compiler *compiler,
                                whit_shader *shader, struct shader_errors *errors)
{
    struct kernel_parts parts;
    uint32_t file, line;
    whit_result result = WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < WHIT_HOOKS; ++i) {
        if (i != WHIT_HOOK_AOV && has_call(&shader->text, hook_names[i]))
            shader->hooks |= 1u << i;
    }
    if (parts_init(log, shader, TEXT_PLAIN, &parts))
        result = compile_hooked(compiler, shader, &parts, HOOK_KERNEL_POST, errors);
    parts_finish(&parts);
    if (result != WHIT_OK)
        return result;
    if (shader->box.line)
        shader_error_add(log, errors, shader->text.files[shader->box.file].name, shader->box.line,
                         0, "the box has no shape: there is no function intersect()");
    else if (shader_text_defines(&shader->text, "intersect", &file, &line))
        shader_error_add(log, errors, shader->text.files[file].name, line, 0,
                         "intersect() needs `//@ box` with the box that its shape is in");
    else
        shader_error_add(log, errors, shader->text.files[0].name, 0, 0,
                         "has none of the functions camera, surface, shade, scatter, miss, post, "
                         "intersect, and none below `//@ aov NAME`");
    return WHIT_ERROR_INPUT;
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
    const char *paths[HOOK_KERNEL_COUNT + 2] = {[HOOK_KERNEL_COUNT] = HOOK_TEXT};
    for (uint32_t i = 0; i < HOOK_KERNEL_COUNT; ++i)
        paths[i] = kernel_table[i].path;
    *stages = NULL;
    return folder ? shader_stages_read(log, folder, paths, stages, errors) : WHIT_OK;
}

whit_result shader_program_compile_tests(const whit_log *log, struct shader_compiler *compiler,
                                         whit_shader *shader, struct shader_errors *errors)
{
    shader_code_free(&shader->codes[HOOK_KERNEL_TEST]);
    return compile_all(log, compiler, shader, TEXT_TESTS, errors);
}

char *shader_program_expand(const whit_log *log, const whit_shader *shader, enum hook_kernel kernel)
{
    struct kernel_parts parts;
    struct kernel_request of;
    struct expanded expanded;
    char *text = NULL;
    if (parts_init(log, shader, kernel == HOOK_KERNEL_TEST ? TEXT_TESTS : TEXT_PLAIN, &parts)) {
        kernel_request_init(shader, &parts, &of);
        if (expand_kernel(log, &parts.user, &of.request, "whit.", &expanded, NULL) == WHIT_OK)
            text = expanded.text;
    }
    parts_finish(&parts);
    return text;
}

/* Fills in what whit_shader_info points to. */
static whit_result fill_infos(const whit_log *log, whit_shader *shader)
{
    const struct shader_tests *tests = &shader->tests;
    list_files(shader);
    shader->test_infos = array_alloc_zeroed(tests->test_count, sizeof *shader->test_infos);
    shader->check_infos = array_alloc_zeroed(tests->check_count, sizeof *shader->check_infos);
    if (!shader->test_infos || !shader->check_infos)
        return log_failure(log, WHIT_ERROR_MEMORY, "no memory for a list of tests");
    for (uint32_t i = 0; i < tests->test_count; ++i) {
        const struct shader_test *test = &tests->tests[i];
        shader->test_infos[i] =
            (whit_shader_test){test->name, shader->files[test->file], test->line, test->first_check,
                               test->check_count};
    }
    for (uint32_t i = 0; i < tests->check_count; ++i) {
        const struct shader_check *check = &tests->checks[i];
        shader->check_infos[i] =
            (whit_shader_check){check->text, shader->files[check->file], check->line};
    }
    return WHIT_OK;
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
        result = shader_tests_read(log, &shader->text, &shader->tests, errors);
    if (result == WHIT_OK && has_text)
        result = shader_dbg_read(log, &shader->text, &shader->tests, &shader->dbg, errors);
    if (result == WHIT_OK && has_text && !find_hooks(shader))
        result = explain_lack(log, compiler, shader, errors);
    if (result == WHIT_OK)
        result = compile_all(log, compiler, shader, TEXT_PLAIN, errors);
    if (result == WHIT_OK && shader->dbg.count)
        result = compile_all(log, compiler, shader, TEXT_DBG, errors);
    if (result == WHIT_OK)
        result = fill_infos(log, shader);
    if (result != WHIT_OK) {
        shader_program_destroy(shader);
        return result;
    }
    *out = shader;
    return WHIT_OK;
}

void shader_program_destroy(whit_shader *shader)
{
    if (!shader)
        return;
    for (uint32_t i = 0; i < HOOK_KERNEL_COUNT; ++i) {
        shader_code_free(&shader->codes[i]);
        shader_code_free(&shader->dbg_codes[i]);
    }
    shader_text_free(&shader->text);
    shader_stages_destroy(shader->stages);
    shader_tests_free(&shader->tests);
    free(shader->test_infos);
    free(shader->check_infos);
    free(shader);
}

char *whit_shader_template(whit_hook hook)
{
    static const char first[] = "//@ whit 1\n";
    char path[64];
    snprintf(path, sizeof path, "hook/%s.glsl", whit_hook_name(hook));
    uint32_t index = shader_stages_find(NULL, path);
    return index == shader_source_count
               ? NULL
               : string_format("%s%.*s", first, (int)shader_sources[index].bytes,
                               (const char *)shader_sources[index].text);
}
