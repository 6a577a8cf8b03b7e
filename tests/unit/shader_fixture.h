/* Texts of users, and a kernel of a few lines that calls them. */
#ifndef SHADER_FIXTURE_H
#define SHADER_FIXTURE_H

#include <ctype.h>

#include <spirv-tools/libspirv.h>

#include "base/spirv.h"
#include "messages_fixture.h"
#include "shader/compile.h"
#include "unit.h"

/* Calls the user's f(x, n) for each case, and tells which loop ran out of fuel. */
static const char test_kernel[] =
    "#version 460\n"
    "#extension GL_GOOGLE_include_directive : require\n"
    "layout(local_size_x = 64) in;\n"
    "layout(set = 0, binding = 0) readonly buffer Cases { ivec2 cases[]; };\n"
    "layout(set = 0, binding = 1) writeonly buffer Answers { uvec2 answers[]; };\n"
    "uint whit_fuel = 1000u;\n"
    "uint whit_fuel_loop = 0u;\n"
    "#include \"../hook/user.glsl\"\n"
    "void main()\n"
    "{\n"
    "    uint i = gl_GlobalInvocationID.x;\n"
    "    if (i < cases.length())\n"
    "        answers[i].x = uint(f(float(cases[i].x), cases[i].y));\n"
    "    if (i < cases.length())\n"
    "        answers[i].y = whit_fuel_loop;\n"
    "}\n";

static struct shader_compiler *compiler;
static struct shader_errors errors;

static inline void compiler_open(const whit_shader_limits *limits, double clock_s)
{
    compiler = shader_compiler_create(&warnings_log, limits, clock_s);
    assert_non_null(compiler);
}

static inline int compiler_begin(void **state)
{
    (void)state;
    messages = (struct messages){0};
    compiler_open(NULL, 0.0);
    return 0;
}

static inline int compiler_end(void **state)
{
    (void)state;
    shader_compiler_destroy(compiler);
    return 0;
}

/* Compiles a kernel with the user's files: names and texts, in turns, up to a NULL. */
static inline whit_result compile_in(const char *kernel, const char *const *files, bool trust,
                                     struct shader_code *code)
{
    struct shader_text_source sources[16];
    const struct shader_request request = {
        .kernel = "kernel/test.comp", .kernel_text = kernel, .trust = trust};
    struct shader_text text;
    uint32_t count = 0;
    errors = (struct shader_errors){0};
    *code = (struct shader_code){0};
    messages = (struct messages){0};
    for (; *files; files += 2)
        sources[count++] = (struct shader_text_source){files[0], files[1], strlen(files[1])};
    whit_result result = shader_text_from(&warnings_log, sources, count, &text, &errors);
    if (result == WHIT_OK)
        result = shader_compile(compiler, &text, &request, code, &errors);
    shader_text_free(&text);
    return result;
}

/* Compiles text `a` as the user's file "a.glsl" with the kernel above. */
static inline whit_result compile_file(const char *a, bool trust, struct shader_code *code)
{
    return compile_in(test_kernel, (const char *const[]){"a.glsl", a, NULL}, trust, code);
}

static inline bool is_remark(const char *line)
{
    static const char *const remarks[] = {"OpSource", "OpName",   "OpMemberName",     "OpString",
                                          "OpLine",   "OpNoLine", "OpModuleProcessed"};
    const char *equals = strstr(line, " = ");
    line = equals && line[0] == '%' ? equals + 3 : line;
    for (size_t i = 0; i < sizeof remarks / sizeof *remarks; ++i) {
        if (strncmp(line, remarks[i], strlen(remarks[i])) == 0)
            return true;
    }
    return false;
}

/* The text of a module without comments, with ids numbered in the order of the text; free() it. */
static inline char *disassemble(const uint32_t *words, size_t bytes)
{
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_2);
    spv_text text = NULL;
    assert_int_equal(spvBinaryToText(context, words, bytes / 4, SPV_BINARY_TO_TEXT_OPTION_NO_HEADER,
                                     &text, NULL),
                     SPV_SUCCESS);
    char *out = malloc(2 * text->length + 1), *to = out;
    uint32_t *numbers = calloc(words[3], sizeof *numbers), count = 0;
    for (char *line = strtok((char *)text->str, "\n"); line; line = strtok(NULL, "\n")) {
        if (is_remark(line))
            continue;
        for (const char *at = line; *at;) {
            if (*at == '%' && isdigit((unsigned char)at[1])) {
                uint32_t id = (uint32_t)strtoul(at + 1, (char **)&at, 10);
                assert_true(id < words[3]);
                numbers[id] = numbers[id] ? numbers[id] : ++count;
                to += sprintf(to, "%%%u", numbers[id]);
            } else {
                *to++ = *at++;
            }
        }
        *to++ = '\n';
    }
    *to = 0;
    free(numbers);
    spvTextDestroy(text);
    spvContextDestroy(context);
    return out;
}

/* spirv-val for Vulkan 1.2. */
static inline void assert_valid(const struct shader_code *code)
{
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_2);
    spv_diagnostic diagnostic = NULL;
    if (spvValidateBinary(context, code->words, code->bytes / 4, &diagnostic) != SPV_SUCCESS)
        fail_msg("%s\n%s", diagnostic ? diagnostic->error : "not valid",
                 disassemble(code->words, code->bytes));
    spvDiagnosticDestroy(diagnostic);
    spvContextDestroy(context);
}

/* Freed at the end of its block. */
#define own_shader_code __attribute__((cleanup(shader_code_free), unused)) struct shader_code

/* Fails with what was logged. */
static inline struct shader_code must_compile(const char *a)
{
    struct shader_code code;
    if (compile_file(a, false, &code) != WHIT_OK)
        fail_msg("%s\n%s", a, messages.text);
    return code;
}

#endif
