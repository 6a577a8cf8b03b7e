/* Kernels with texts of users: the compiler makes the same code as the build, errors name the
   user's file and line, and after any text the compiler works for the next one. */
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "kernels.h"
#include "shader/expand.h"
#include "shader/portable.h"
#include "shader_fixture.h"
#include "sources.h"

#if defined(__SANITIZE_ADDRESS__)
#define HAS_ASAN 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAS_ASAN 1
#endif
#endif
#ifndef HAS_ASAN
#define HAS_ASAN 0 /* under ASan there is no limit on memory */
#endif

#define FINE "float f(float x, int n) { return x + 1.0; }\n"

/* ---- The same as at build time ---- */

TEST_IN(kernels_without_a_user_are_those_of_the_build, compiler_begin, compiler_end)
{
    for (uint32_t i = 0; i < KERNEL_COUNT; ++i) {
        char name[64];
        snprintf(name, sizeof name, "kernel/%s.comp", kernels[i].name);
        const struct shader_request request = {.kernel = name};
        own_shader_code code = {0};
        assert_int_equal(shader_compile(compiler, NULL, &request, &code, &errors), WHIT_OK);
        own_memory char *built = disassemble(kernels[i].words, kernels[i].bytes);
        own_memory char *made = disassemble(code.words, code.bytes);
        assert_true(strlen(built) > 1000 && strstr(built, "NoContraction"));
        assert_true(strcmp(built, made) == 0);
        assert_int_equal(code.loop_count, 0);
        assert_true(code.instructions > 10);
    }
    assert_string_equal(messages.text, "");
}

/* Every function without a portable form is named, each alone in a file. */
TEST_IN(what_has_no_portable_form_is_named, compiler_begin, compiler_end)
{
    static const char *const calls[] = {"sinh(x)",
                                        "cosh(x)",
                                        "tanh(x)",
                                        "asinh(x)",
                                        "acosh(x)",
                                        "atanh(x)",
                                        "determinant(mat2(x))",
                                        "inverse(mat2(x))[0].x",
                                        "frexp(x, e)",
                                        "ldexp(x, n)",
                                        "float(packSnorm4x8(vec4(x)))",
                                        "float(packUnorm4x8(vec4(x)))",
                                        "float(packSnorm2x16(vec2(x)))",
                                        "float(packUnorm2x16(vec2(x)))",
                                        "float(packHalf2x16(vec2(x)))",
                                        "unpackSnorm2x16(uint(n)).x",
                                        "unpackHalf2x16(uint(n)).x",
                                        "unpackSnorm4x8(uint(n)).x"};
    for (size_t i = 0; i < sizeof calls / sizeof *calls; ++i) {
        char text[256], why[PORTABLE_WHY_BYTES], name[64] = "";
        const struct portable_params params = {.own_division = true, .own_comparison = true};
        own_shader_code code = {0};
        uint32_t *words;
        size_t count;
        const char *at = strncmp(calls[i], "float(", 6) == 0 ? calls[i] + 6 : calls[i];
        snprintf(name, sizeof name, "%.*s has no portable form", (int)strcspn(at, "("), at);
        snprintf(text, sizeof text,
                 "float f(float x, int n) { float w = x; int e = n; return %s + w + float(e); }\n",
                 calls[i]);
        assert_int_equal(compile_file(text, false, &code), WHIT_OK);
        assert_int_equal(
            shader_make_portable(&params, code.words, code.bytes / 4, &words, &count, why),
            WHIT_ERROR_INPUT);
        assert_string_equal(why, name);
    }
}

/* The number of uses of an operation in the first `functions` functions of a module. `number`: that
   of the operation, in GLSL.std.450 if it is below 100. *ends: number of all functions. */
static uint32_t count_in(const uint32_t *words, size_t count, uint32_t functions, uint32_t number,
                         uint32_t *ends)
{
    uint32_t found = 0;
    *ends = 0;
    for (size_t at = SPV_HEADER_WORDS; at < count; at += spv_length(words + at)) {
        uint32_t op = spv_op(words + at);
        *ends += op == OP_FUNCTION_END;
        if (*ends < functions)
            found += number < 100 ? op == OP_EXT_INST && words[at + 4] == number : op == number;
    }
    return found;
}

/* For devices whose own comparisons are wrong, functions replace all comparisons of GLSL. `number`
   is that of the operation in SPIR-V. */
TEST_IN(comparisons_are_left_to_devices_that_are_right, compiler_begin, compiler_end)
{
    static const struct {
        const char *text;
        uint32_t number;
    } all[] = {{"x == y", 180},
               {"x != y", 183},
               {"x < y", 184},
               {"x > y", 186},
               {"x <= y", 188},
               {"x >= y", 190},
               {"any(lessThan(vec3(x), vec3(y)))", 184},
               {"any(equal(vec4(x), vec4(y)))", 180},
               {"bool(abs(x))", 4},
               {"bool(abs(vec2(x)).y)", 4},
               {"bool(step(x, y))", 48}};
    for (size_t i = 0; i < 2 * sizeof all / sizeof *all; ++i) {
        const struct portable_params params = {.own_division = true, .own_comparison = i & 1};
        char text[128], why[PORTABLE_WHY_BYTES];
        own_shader_code code = {0};
        uint32_t *words, functions, all_functions;
        size_t count;
        snprintf(text, sizeof text, "bool f(float x, float y) { return %s; }\n", all[i / 2].text);
        assert_int_equal(compile_file(text, false, &code), WHIT_OK);
        assert_int_equal(
            shader_make_portable(&params, code.words, code.bytes / 4, &words, &count, why),
            WHIT_OK);
        uint32_t number = all[i / 2].number;
        uint32_t before = count_in(code.words, code.bytes / 4, UINT32_MAX, number, &functions);
        uint32_t after = count_in(words, count, functions, number, &all_functions);
        assert_true(before > 0);
        assert_int_equal(after, params.own_comparison ? before : 0);
        assert_int_equal(all_functions > functions, !params.own_comparison);
        free(words);
    }
}

TEST(all_shaders_are_embedded_as_they_are)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < shader_source_count; ++i) {
        char path[512], *text = malloc(shader_sources[i].bytes + 2);
        snprintf(path, sizeof path, WHIT_SCENES_DIR "/../shaders/%s", shader_sources[i].path);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        assert_int_equal(fread(text, 1, shader_sources[i].bytes + 1, file),
                         shader_sources[i].bytes);
        assert_memory_equal(text, shader_sources[i].text, shader_sources[i].bytes);
        assert_int_equal(shader_sources[i].text[shader_sources[i].bytes], 0);
        assert_true(i == 0 || strcmp(shader_sources[i - 1].path, shader_sources[i].path) < 0);
        count += strncmp(shader_sources[i].path, "kernel/", 7) == 0;
        fclose(file);
        free(text);
    }
    /* The other 8: hook, miss, shape, hit, aov, post and test.comp, for files of users, and
       portable.comp. */
    assert_int_equal(count, KERNEL_COUNT + 8);
    FILE *list =
        popen("cd " WHIT_SCENES_DIR "/../shaders && ls */*.comp */*.glsl */*.h | wc -l", "r");
    unsigned files = 0;
    assert_non_null(list);
    assert_int_equal(fscanf(list, "%u", &files), 1);
    assert_int_equal(pclose(list), 0);
    assert_int_equal(files, shader_source_count);
}

TEST_IN(defines_stand_behind_the_extensions, compiler_begin, compiler_end)
{
    const char *const defines[] = {"HOOK_A", "HOOK_B 7"};
    struct shader_request request = {.kernel = "kernel/test.comp",
                                     .kernel_text =
                                         "// first\n"
                                         "#version 460\n"
                                         "#extension GL_GOOGLE_include_directive : require\n"
                                         "layout(local_size_x = 1) in;\n"
                                         "#ifdef HOOK_A\n"
                                         "#include \"../lib/turn.glsl\"\n"
                                         "#endif\n"
                                         "#include \"../lib/turn.glsl\"\n"
                                         "void main() {}\n",
                                     .defines = defines,
                                     .define_count = 2};
    struct expanded expanded;
    assert_int_equal(expand_kernel(&warnings_log, NULL, &request, "whit.", &expanded, &errors),
                     WHIT_OK);
    const char *text = expanded.text;
    assert_int_equal(strlen(text), expanded.bytes);
    const char *extension = strstr(text, "#extension GL_GOOGLE_include_directive");
    const char *define = strstr(text, "\n#define HOOK_A\n#define HOOK_B 7\n#line 4 ");
    assert_true(extension && define && extension < define);
    assert_true(define < strstr(text, "layout(local_size_x = 1) in;\n"));
    /* A file that is included under a condition is included again further below. */
    const char *first = strstr(text, "#ifndef LIB_TURN_GLSL");
    assert_true(first && strstr(first + 1, "#ifndef LIB_TURN_GLSL"));
    free(expanded.text);
    request.kernel = "kernel/none.comp";
    request.kernel_text = NULL;
    struct shader_code code;
    errors.count = 0;
    assert_int_equal(shader_compile(compiler, NULL, &request, &code, &errors), WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.text, "no shader kernel/none.comp is embedded"));
}

/* ---- Errors ---- */

static const struct {
    const char *content;
    uint32_t line;
    const char *reason;
} broken[] = {
    {"float f(float x, int n) { return y; }\n", 1, "'y': undeclared identifier"},
    {"\n\nfloat f(float x, int n) {\n  return x\n}\n", 5, "unexpected '}'"},
    {"float f(float x, int n) { return vec3(1.0); }\n", 1, "return"},
    {"float f(float x, int n) {\n  int i = 1.0;\n  return x;\n}\n", 2, "cannot convert"},
    {"float f(float x, int n) {\n  return g(x);\n}\n", 2, "no matching overloaded function"},
    {"float f(float x, int n) {\n  vec3 v = vec3(1.0);\n  return v.w;\n}\n", 3, "w"},
    {"float f(float x, int n) {\n  float x2 = 1.0;\n  float x2 = 2.0;\n  return x2;\n}\n", 3,
     "redefinition"},
    {FINE "\n" FINE, 3, "already has a body"},
    {FINE "struct S { float a; float a; };\n", 2, "duplicate"},
    {FINE "float a[0];\n", 2, "array size"},
    {FINE "float a[-1];\n", 2, "array size"},
    {FINE "const float c;\n", 2, "const"},
    {"float f(float x, int n) {\n  const float c = 1.0;\n  c = 2.0;\n  return c;\n}\n", 3, "const"},
    {"float f(float x, int n) {\n  float a[4];\n  return a[4];\n}\n", 3, "out of range"},
    {"float f(float x, int n) {\n  if (x) return 1.0;\n  return x;\n}\n", 2, "boolean"},
    {"float f(float x, int n) {\n  break;\n  return x;\n}\n", 2, "break"},
    {"float f(float x, int n) {\n  continue;\n  return x;\n}\n", 2, "continue"},
    {"float f(float x, int n) {\n  case 1: return x;\n}\n", 2, "case"},
    {"float f(float x, int n) {\n  return;\n}\n", 2, "return"},
    {"float f(float x, int n) {\n  discard;\n  return x;\n}\n", 2, "discard"},
    {"float f(float x, int n) {\n  x = x @ 1.0;\n  return x;\n}\n", 2, "'@' is not GLSL"},
    {"float f(float x, int n) {\n  return 1.0e;\n}\n", 2, ""},
    {"float f(float x, int n) {\n  return 99999999999;\n}\n", 2, "too big"},
    {"float f(float x, int n) {\n  return texture(s, vec2(x)).x;\n}\n", 2, "undeclared"},
    {"float f(float x, int n) {\n  return x % 2.0;\n}\n", 2, "%"},
    {"float f(float x, int n) {\n  mat3 m = mat2(1.0) * mat3(1.0);\n  return m[0].x;\n}\n", 2, "*"},
    {"#define A(x) x\nfloat f(float x, int n) { return A(1.0; }\n", 2, ""},
    {FINE "#if X(\n#endif\n", 2, ""},
    {FINE "#error \"stop\"\n", 2, "stop"},
    {FINE "#foo\n", 2, "directive"},
    {FINE "\n#undef GL_x\n", 3, "GL_"},
    {"import x;\n" FINE, 1, "unexpected"},
    {FINE "float half = 1.0;\n", 2, "half"},
    {FINE "float sample = 1.0;\n", 2, "unexpected 'sample', expecting"},
    {"float f(float x, int n) {\n  float y = x return y;\n}\n", 2, "unexpected 'return'"},
    {"float f(float x, int n) {\n  x += *= 2.0;\n  return x;\n}\n", 2, "unexpected '*='"},
    {"float f(float x, int n) {\n  return x * DOT;\n}\n", 2, "'DOT': undeclared identifier"},
    {FINE "float gl_x;\n", 2, "gl_"},
    {"float g(float x);\nfloat f(float x, int n) { return g(x); }\n", 1,
     "g is called and has no body"},
    {"float f(float x, int n) {\n  dvec2 v = dvec2(1.0);\n  return float(v.x);\n}\n", 2,
     "no double"},
    {"float f(float x, int n) {\n  while (true) {\n  return x;\n}\n", 1, "brace"},
    {"float g(float x) {\n  return x;\n\nfloat f(float x, int n) {\n  return g(x);\n}\n", 1,
     "brace"},
    {FINE "}\n", 2, ""},
    {"float f(float x) {\n return x;\n}\n", 0, "whit's own text"},
    {"float f(float x, int n) {\n  return dFdx(x);\n}\n", 2,
     "'dFdx' is not there in whit's shaders"},
    {"float f(float x, int n) {\n  return subgroupAdd(x);\n}\n", 2,
     "'subgroupAdd' is not there in whit's shaders"},
    {"float f(float x, int n) {\n  debugPrintfEXT(\"x\"); return x;\n}\n", 2,
     "there are no strings in whit's shaders: dbg(x) shows the value of x"},
    {"float f(float x, int n) {\n  return float(gl_FragCoord.x);\n}\n", 2, "gl_FragCoord"},
    {"#extension_of mine\n" FINE, 1, "directive"},
    {"float f(float x, int n) { if (x > 0.0) return x; }\n", 1,
     "function 'f' does not return a value on every path"},
    {"\n\nfloat f(float x, int n)\n{\n  switch (n) { case 0: return 1.0; case 1: return 2.0; "
     "}\n}\n",
     3, "'f' does not return"},
    {"float f(float x, int n) { while (true) { if (n > 3) break; return 1.0; } }\n", 1,
     "'f' does not return"},
    {"float f(float x, int n) { for (int i = 0; i < n; ++i) return 1.0; }\n", 1,
     "'f' does not return"},
};

/* The end of none of these functions can be reached. */
TEST_IN(functions_that_return_on_every_path_are_taken, compiler_begin, compiler_end)
{
    static const char *const bodies[] = {
        "if (x > 0.0) return 1.0; else return 2.0;",
        "if (x > 0.0) { if (x > 1.0) return 1.0; else return 2.0; } else { return 3.0; }",
        "while (true) { if (n > 3) return x; n++; }",
        "do { if (n > 3) return x; n++; } while (true);",
        "for (;;) { switch (n) { case 0: return x; case 1: n++; break; default: n--; } }",
        "switch (n) { case 0: return 1.0; case 1: default: return 2.0; }",
        "switch (n) { case 0: if (x > 1.0) return 1.0; else return 2.0; default: return 2.0; }",
        "if (true) return x;",
        "while (true) { if (x > 3.0) { while (true) { if (n > 9) return x; n++; } } x++; }",
        "{ return x; } n = 3;"};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; ++i) {
        char text[256];
        snprintf(text, sizeof text, "float f(float x, int n) { %s }\n", bodies[i]);
        own_shader_code code = must_compile(text);
        assert_valid(&code);
    }
}

/* The line of a text, without its end. */
static void copy_line(const char *text, uint32_t line, char *out, size_t bytes)
{
    for (; line > 1; --line)
        text = strchr(text, '\n') + 1;
    snprintf(out, bytes, "%.*s", (int)strcspn(text, "\n"), text);
}

/* The column of the token that the reason quotes, found by splitting the line; 0: the reason quotes
   none, or the token is on the line more than once. */
static uint32_t column_of(const struct shader_error *error, const char *text)
{
    char line[256], token[64];
    uint32_t column = 0, count = 0;
    const char *open = strchr(error->reason, '\'');
    if (!open || sscanf(open, "'%63[^']'", token) != 1)
        return 0;
    copy_line(text, error->line, line, sizeof line);
    for (size_t at = 0, length; line[at]; at += length) {
        length =
            strspn(line + at, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789");
        bool same = length ? length == strlen(token) && strncmp(line + at, token, length) == 0
                           : strncmp(line + at, token, strlen(token)) == 0;
        length += !length;
        column = same ? (uint32_t)at + 1 : column;
        count += same;
    }
    return count == 1 ? column : 0;
}

TEST_IN(errors_name_the_line, compiler_begin, compiler_end)
{
    uint32_t bad = 0, columns = 0;
    for (size_t i = 0; i < sizeof broken / sizeof *broken; ++i) {
        struct shader_code code;
        if (compile_file(broken[i].content, false, &code) != WHIT_ERROR_INPUT)
            fail_msg("no error: %s", broken[i].content);
        assert_true(!code.words && !code.loops);
        assert_true(errors.count >= 1);
        const struct shader_error *error = &errors.items[0];
        bool own = broken[i].line == 0;
        uint32_t column = own ? 0 : column_of(error, broken[i].content);
        char place[64];
        snprintf(place, sizeof place,
                 own      ? "whit:kernel/test.comp:13: "
                 : column ? "a.glsl:%u:%u: "
                          : "a.glsl:%u: ",
                 broken[i].line, column);
        bool right =
            strcmp(error->file, own ? "whit:kernel/test.comp" : "a.glsl") == 0 &&
            error->line == (own ? 13 : broken[i].line) && strstr(error->reason, broken[i].reason) &&
            strncmp(messages.text, place, strlen(place)) == 0 &&
            !strstr(messages.text, "compilation terminated") && !strstr(messages.text, "No code");
        columns += column != 0;
        right = right && error->column == column;
        if (!right)
            print_error("%s\nline %u, column %u, not %u, %s:\n%s\n", broken[i].content,
                        broken[i].line, column, error->column, broken[i].reason, messages.text);
        bad += !right;
    }
    const uint32_t all = sizeof broken / sizeof *broken;
    print_message("line and column are right in %u of %u broken files, a column in %u\n", all - bad,
                  all, columns);
    assert_true(columns > all / 3);
    assert_int_equal(bad, 0);
}

TEST_IN(lines_are_right_through_two_levels, compiler_begin, compiler_end)
{
    static const char *const files[] = {
        "a.glsl",
        "// a\n#include \"lib/b.glsl\"\n#include \"lib/c.glsl\"\nfloat h = missing_a;\n"
        "float f(float x, int n) { return g(x); }\n",
        "lib/b.glsl",
        "#include \"c.glsl\"\r\n\r\nfloat g(float x) { return missing_b; }\r\n",
        "lib/c.glsl",
        "#ifndef C\n#define C\n/*\n*/ float c = missing_c; // \\\n\n#endif",
        NULL};
    struct shader_code code;
    assert_int_equal(compile_in(test_kernel, files, false, &code), WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.text, "lib/c.glsl:4:14: 'missing_c'"));
    assert_non_null(strstr(messages.text, "lib/b.glsl:3:27: 'missing_b'"));
    assert_non_null(strstr(messages.text, "a.glsl:4:11: 'missing_a'"));
    static const char *const open[] = {
        "a.glsl", "#include \"b.glsl\"\nfloat f(float x, int n)\n{\n return g(x);\n}\n", "b.glsl",
        "\nfloat g(float x) {\n return x;\n", NULL};
    assert_int_equal(compile_in(test_kernel, open, false, &code), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 1);
    assert_non_null(strstr(messages.text, "b.glsl:2:18: a brace without its other one"));
}

TEST_IN(a_line_has_one_error_and_a_text_has_many, compiler_begin, compiler_end)
{
    struct shader_code code;
    char text[4096] = "float f(float x, int n) {\n";
    assert_int_equal(compile_file("float f(float x, int n) {\n vec2 a = b + c + d;\n return e; }\n",
                                  false, &code),
                     WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 2);
    assert_true(errors.items[0].line == 2 && errors.items[1].line == 3);
    for (int i = 0; i < 40; ++i)
        sprintf(text + strlen(text), " x += missing_%d;\n", i);
    strcat(text, " return x; }\n");
    assert_int_equal(compile_file(text, false, &code), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 32);
    assert_int_equal(errors.more, 8);
    assert_int_equal(errors.items[31].line, 33);
}

/* Errors have the column, from 1, of a quoted token that is once on its line. */
TEST_IN(errors_name_the_column, compiler_begin, compiler_end)
{
    struct shader_code code;
    const char *text = "float f(float x, int n) {\r\n"
                       "\tx += here;\r\n"
                       " x += twice * twice;\r\n"
                       " return last; }";
    assert_int_equal(compile_file(text, false, &code), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 3);
    assert_true(errors.items[0].line == 2 && errors.items[0].column == 7);
    assert_true(errors.items[1].line == 3 && errors.items[1].column == 0);
    assert_true(errors.items[2].line == 4 && errors.items[2].column == 9);
}

TEST_IN(recursion_is_told_at_the_function, compiler_begin, compiler_end)
{
    struct shader_code code;
    assert_int_equal(compile_file("\nfloat f(float x, int n) { return n < 1 ? x : f(x, n - 1); }\n",
                                  false, &code),
                     WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.text, "a.glsl:2: f calls itself"));
    assert_int_equal(compile_file("float g(float x, int n);\n"
                                  "float f(float x, int n) { return n < 1 ? x : g(x, n - 1); }\n"
                                  "float g(float x, int n) { return f(x, n); }\n",
                                  false, &code),
                     WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.text, "which leads back to it"));
    assert_true(strstr(messages.text, "a.glsl:2: f calls g") ||
                strstr(messages.text, "a.glsl:3: g calls f"));
}

/* A macro that the user's file defines does not change whit's own text behind it. */
TEST_IN(macros_of_users_end_with_their_text, compiler_begin, compiler_end)
{
    static const char *const texts[] = {"#define uint while(true) uint\n#define i j\n"
                                        "#define answers cases\n#define __x 1\n" FINE,
                                        "float f(float x, int n) { return x; } // \\",
                                        "float f(float x, int n) { return x; } \\\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        own_shader_code code = must_compile(texts[i]);
        assert_int_equal(code.loop_count, 0);
    }
}

TEST_IN(a_file_included_again_and_again_is_refused, compiler_begin, compiler_end)
{
    const char *files[2 * 14 + 1] = {NULL};
    char texts[14][10000] = {FINE}, names[14][16];
    struct shader_code code;
    for (int i = 0; i < 14; ++i) {
        snprintf(names[i], sizeof names[i], "%c.glsl", 'a' + i);
        for (int j = 0; i < 13 && j < 3; ++j)
            sprintf(texts[i] + strlen(texts[i]), "#include \"%c.glsl\"\n", 'a' + i + 1);
        files[2 * i] = names[i];
        files[2 * i + 1] = texts[i];
    }
    memset(texts[13], '/', sizeof texts[13] - 1);
    assert_int_equal(compile_in(test_kernel, files, false, &code), WHIT_ERROR_INPUT);
    assert_non_null(strstr(errors.items[0].reason, "larger than 16 MiB"));
}

static char *repeat(const char *before, const char *what, size_t count, const char *behind)
{
    size_t length = strlen(what), used = strlen(before);
    char *text = malloc(used + count * length + strlen(behind) + 1);
    memcpy(text, before, used);
    for (size_t i = 0; i < count; ++i, used += length)
        memcpy(text + used, what, length);
    strcpy(text + used, behind);
    return text;
}

/* ---- The process ---- */

/* The number of child processes; *last, which may be NULL: one of them. */
static uint32_t children(pid_t *last)
{
    char path[64];
    uint32_t count = 0;
    snprintf(path, sizeof path, "/proc/self/task/%d/children", getpid());
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    for (int pid; fscanf(file, "%d", &pid) == 1; count++) {
        if (last)
            *last = pid;
    }
    fclose(file);
    return count;
}

TEST(one_process_is_kept_and_none_is_left)
{
    pid_t first, now;
    assert_int_equal(children(NULL), 0);
    compiler_open(NULL, 0.0);
    assert_int_equal(children(&first), 1);
    for (int i = 0; i < 3; ++i) {
        own_shader_code code = must_compile(FINE);
        assert_int_equal(children(&now), 1);
        assert_int_equal(now, first);
    }
    /* If the process dies, the compiler starts another one. */
    assert_int_equal(kill(first, SIGKILL), 0);
    own_shader_code code = must_compile(FINE);
    assert_int_equal(children(&now), 1);
    assert_true(now != first);
    /* A process that hangs is given up. */
    shader_compiler_destroy(compiler);
    assert_int_equal(children(NULL), 0);
}

TEST(limits_are_kept)
{
    volatile bool cancel = true;
    own_memory char *long_text =
        repeat("float f(float x, int n) { return x", " + sin(x)\n", 60000, "; }");
    const struct {
        whit_shader_limits limits;
        double clock_s;
        whit_result result;
        const char *reason;
    } cases[] = {
        {{.memory_bytes = 8 << 20}, 0.0, WHIT_ERROR_INPUT, "memory"},
        {{.cpu_s = 0.01}, 0.0, WHIT_ERROR_INPUT, "not compiled within 0.01 s"},
        {{.cancel = NULL}, 0.01, WHIT_ERROR_INPUT, "0.01 s by the clock"},
        {{.cancel = &cancel}, 0.0, WHIT_ERROR_CANCELLED, "cancelled"},
    };
    for (size_t i = HAS_ASAN; i < sizeof cases / sizeof *cases; ++i) {
        struct shader_code code;
        compiler_open(&cases[i].limits, cases[i].clock_s);
        assert_int_equal(compile_file(long_text, false, &code), cases[i].result);
        if (!strstr(messages.text, cases[i].reason))
            fail_msg("\"%s\" is not in \"%s\"", cases[i].reason, messages.text);
        shader_compiler_destroy(compiler);
        assert_int_equal(children(NULL), 0);
    }
}

/* The process that is kept ends with its parent. */
TEST(no_process_outlives_its_parent)
{
    int ends[2];
    pid_t kept = 0;
    assert_int_equal(pipe(ends), 0);
    pid_t parent = fork();
    if (parent == 0) {
        struct shader_compiler *own = shader_compiler_create(NULL, NULL, 0.0);
        kept = own && children(&kept) == 1 ? kept : 0;
        ssize_t written = write(ends[1], &kept, sizeof kept);
        _exit(written == sizeof kept ? 0 : 1);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], &kept, sizeof kept), sizeof kept);
    /* Reading gives the pipe's end as soon as neither of the two processes has it open any more. */
    char byte;
    assert_int_equal(read(ends[0], &byte, 1), 0);
    close(ends[0]);
    assert_int_equal(waitpid(parent, NULL, 0), parent);
    assert_true(kept > 0);
    for (int i = 0; i < 1000 && kill(kept, 0) == 0; ++i) {
        char path[64], how = 0;
        snprintf(path, sizeof path, "/proc/%d/stat", kept);
        FILE *file = fopen(path, "r");
        if (file && fscanf(file, "%*d %*s %c", &how) != 1)
            how = 0;
        if (file)
            fclose(file);
        if (how == 'Z' || how == 0)
            return; /* the process that adopts orphans has not reaped it yet */
        usleep(10000);
    }
    assert_int_not_equal(kill(kept, 0), 0);
}
