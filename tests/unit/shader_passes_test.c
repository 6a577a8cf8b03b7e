/* The passes over functions of users: fuel for loops, bounds of indices, and refusals. All other
   code stays, and every module is valid SPIR-V. */
#include "shader_fixture.h"

/* ---- Fuel ---- */

static uint32_t count(const char *text, const char *what)
{
    uint32_t found = 0;
    for (const char *at = text; (at = strstr(at, what)); at += strlen(what))
        found++;
    return found;
}

/* Loops of f(), each with the line that it begins on. */
static const struct {
    const char *content;
    uint32_t count, lines[4];
} looping[] = {
    {"float f(float x, int n) {\n for (int i = 0; i < n; i++)\n  x += 1.0;\n return x; }\n",
     1,
     {2}},
    {"float f(float x, int n) {\n while (x < 9.0)\n  x += 1.0;\n return x; }\n", 1, {2}},
    {"float f(float x, int n) {\n do {\n  x += 1.0;\n } while (x < 9.0);\n return x; }\n", 1, {4}},
    {"float f(float x, int n) {\n do\n  if (x > 1.0) continue;\n while (x++ < 9.0);\n return x; "
     "}\n",
     1,
     {4}},
    {"float f(float x, int n) {\n for (;;) {\n  if (x > 9.0) return x; x++; }\n}\n", 1, {2}},
    {"float f(float x, int n) { for (int i = 0; i < n; i++)\n for (int j = 0; j < n; j++)\n"
     "  while (x < 5.0) x += 1.0;\n return x; }\n",
     3,
     {1, 2, 3}},
    {"float f(float x, int n) {\n while (true) {\n  if (x > 3.0) break;\n  if (x > 2.0) continue;\n"
     "  x += 1.0; }\n return x; }\n",
     1,
     {2}},
    {"float f(float x, int n) {\n for (;;) {\n  switch (n) { case 1: x++; break; case 2: "
     "continue;\n"
     "  default: return x; }\n  if (x > 9.0 && n > 3 || x < 1.0) break; }\n return x; }\n",
     1,
     {2}},
    {"float f(float x, int n) {\n switch (n) { case 1:\n  for (;;) { x++; break; }\n  break;\n"
     " default: while (x < 1.0 || n > 2 && x > 2.0) x++; }\n return x; }\n",
     2,
     {3, 5}},
    {"#define TIMES(n) for (int i_ = 0; i_ < n; ++i_)\nfloat f(float x, int n) {\n TIMES(3)\n"
     " TIMES(4) x += 1.0;\n return x; }\n",
     2,
     {3, 4}},
    {"bool g(float x) { while (x > 1.0) x *= 0.5; return x > 0.5; }\nfloat f(float x, int n) {\n"
     " for (bool on = g(x); on && g(x); on = g(x)) x += g(x) ? 1.0 : 2.0;\n return x; }\n",
     2,
     {1, 3}},
    {"void g(inout float x) { for (;;) ; }\nfloat f(float x, int n) { g(x); return x; }\n", 1, {1}},
    {"struct S { float a; mat3 m; vec4 v[3]; };\nS g(int n) { for (;;) { if (n > 9) return S(1.0, "
     "mat3(1.0), vec4[3](vec4(1), vec4(1), vec4(1))); n++; } }\n"
     "float f(float x, int n) { return g(n).a; }\n",
     1,
     {2}},
    {"float g(float x) { while (x > 1.0) x -= 1.0; return x; } float f(float x, int n) { while (x "
     "> "
     "2.0) x = g(x); return x; }\n",
     2,
     {1, 1}},
    {"float f(float x, int n) { return x; }\n", 0, {0}},
};

TEST_IN(loops_have_fuel_and_lines, compiler_begin, compiler_end)
{
    for (size_t i = 0; i < sizeof looping / sizeof *looping; ++i) {
        own_shader_code code = must_compile(looping[i].content), trusted = {0};
        assert_valid(&code);
        if (code.loop_count != looping[i].count)
            fail_msg("%u loops: %s", code.loop_count, looping[i].content);
        for (uint32_t j = 0; j < code.loop_count; ++j) {
            assert_int_equal(code.loops[j].file, 0);
            bool found = false;
            for (uint32_t k = 0; k < looping[i].count; ++k)
                found = found || looping[i].lines[k] == code.loops[j].line;
            if (!found)
                fail_msg("line %u: %s", code.loops[j].line, looping[i].content);
        }
        assert_int_equal(compile_file(looping[i].content, true, &trusted), WHIT_OK);
        assert_valid(&trusted);
        assert_int_equal(trusted.loop_count, 0);
        own_memory char *with = disassemble(code.words, code.bytes);
        own_memory char *without = disassemble(trusted.words, trusted.bytes);
        assert_int_equal(count(with, "OpLoopMerge"), looping[i].count);
        assert_int_equal(count(with, "OpISub"), count(without, "OpISub") + looping[i].count);
        assert_int_equal(count(with, "OpUnreachable"), 0);
    }
}

TEST_IN(loops_of_whit_have_no_fuel, compiler_begin, compiler_end)
{
    char kernel[4096];
    snprintf(kernel, sizeof kernel, "%s", test_kernel);
    char *end = strrchr(kernel, '}');
    strcpy(end, "    for (uint j = 0u; j < i; j++) answers[i].y += j;\n}\n");
    const char *const files[] = {"a.glsl", "float f(float x, int n) { return x; }", NULL};
    own_shader_code code = {0};
    assert_int_equal(compile_in(kernel, files, false, &code), WHIT_OK);
    assert_int_equal(code.loop_count, 0);
}

TEST_IN(loops_in_included_files_have_their_place, compiler_begin, compiler_end)
{
    static const char *const files[] = {
        "a.glsl",
        "// one\n#include \"b.glsl\"\nfloat f(float x, int n) {\n"
        " while (x > 1.0) x = g(x);\n return x; }\n",
        "b.glsl", "\n\nfloat g(float x) {\n\n while (x > 2.0) x -= 1.0;\n return x; }", NULL};
    own_shader_code code = {0};
    assert_int_equal(compile_in(test_kernel, files, false, &code), WHIT_OK);
    assert_int_equal(code.loop_count, 2);
    bool first = code.loops[0].file == 1;
    const struct shader_loop *a = &code.loops[first ? 1 : 0], *b = &code.loops[first ? 0 : 1];
    assert_true(a->file == 0 && a->line == 4 && b->file == 1 && b->line == 5);
    assert_valid(&code);
}

/* ---- Bounds ---- */

static const struct {
    const char *content;
    uint32_t clamps; /* number of indices that need a limit */
} indexing[] = {
    {"float f(float x, int n) {\n float a[8]; a[2] = x; return a[n]; }\n", 1},
    {"float f(float x, int n) {\n float a[8]; a[n] = x; a[7] = x; return a[7]; }\n", 1},
    {"float f(float x, int n) {\n float a[3][5]; a[n][n + 1] = x; return a[1][2]; }\n", 2},
    {"float f(float x, int n) {\n vec3 v = vec3(x); v[n] = 1.0; return v[n]; }\n", 2},
    {"float f(float x, int n) {\n mat4x3 m = mat4x3(x); m[n][n] = 1.0; return m[n].x; }\n", 3},
    {"float f(float x, int n) {\n return vec3(1, 2, 3)[n]; }\n", 1},
    {"vec3 g(float x) { return vec3(x); }\nfloat f(float x, int n) {\n return g(x)[n]; }\n", 1},
    {"const float t[4] = float[4](1.0, 2.0, 3.0, 4.0);\nfloat f(float x, int n) {\n return t[n]; "
     "}\n",
     1},
    {"float t[4];\nfloat f(float x, int n) {\n t[uint(n)] = x; return t[0]; }\n", 1},
    {"struct S { float a[4]; mat3 m; };\nfloat f(float x, int n) {\n S s[3]; s[n].a[n] = x;\n"
     " return s[n].m[n][n]; }\n",
     5},
    {"float g(float a[4], int n) { return a[n]; }\nfloat f(float x, int n) {\n float a[4];\n"
     " return g(a, n); }\n",
     1},
    {"void g(inout float a[4], int n) { a[n] = 1.0; }\nfloat f(float x, int n) {\n float a[4][2 + "
     "2];\n"
     " g(a[n], n); return a[1][1]; }\n",
     3},
    {"float f(float x, int n) {\n return float(cases[n].x); }\n", 1},
    {"int k = 1; float g = vec3(1.0)[k];\nfloat f(float x, int n) {\n return g; }\n", 1},
    {"float h(float x) { return x; } int k = 1; float g = vec3(1.0)[k]; float f(float x, "
     "int n) "
     "{ return g + h(x); }\n",
     1},
};

TEST_IN(indices_stay_within, compiler_begin, compiler_end)
{
    for (size_t i = 0; i < sizeof indexing / sizeof *indexing; ++i) {
        own_shader_code code = must_compile(indexing[i].content), trusted = {0};
        assert_int_equal(compile_file(indexing[i].content, true, &trusted), WHIT_OK);
        assert_valid(&code);
        assert_valid(&trusted);
        own_memory char *text = disassemble(code.words, code.bytes);
        own_memory char *without = disassemble(trusted.words, trusted.bytes);
        if (count(text, " UMin ") != indexing[i].clamps)
            fail_msg("%u: %s\n%s", count(text, " UMin "), indexing[i].content, text);
        assert_int_equal(count(without, " UMin "), 0);
    }
}

/* Whether a module has a constant of this value. */
static bool has_constant(const struct shader_code *code, uint32_t value)
{
    for (size_t at = SPV_HEADER_WORDS; at < code->bytes / 4; at += spv_length(code->words + at)) {
        if (code->words[at] == spv_head(OP_CONSTANT, 4) && code->words[at + 3] == value)
            return true;
    }
    return false;
}

TEST_IN(the_last_element_is_the_limit, compiler_begin, compiler_end)
{
    own_shader_code code = must_compile("float f(float x, int n) { float a[78]; return a[n]; }\n");
    assert_true(has_constant(&code, 77) && has_constant(&code, 78) && !has_constant(&code, 79));
}

/* ---- Refusals ---- */

static const struct {
    const char *content;
    uint32_t line;
    const char *reason;
} refused[] = {
    {"float f(float x, int n) {\n barrier();\n return x; }\n", 2, "barriers are whit's own"},
    {"float f(float x, int n) {\n memoryBarrier();\n return x; }\n", 2, "barriers are whit's own"},
    {"float f(float x, int n) {\n groupMemoryBarrier();\n return x; }\n", 2, "barriers"},
    {"float f(float x, int n) {\n answers[0].x = 1u;\n return x; }\n", 2, "writes into buffers"},
    {"float f(float x, int n) {\n return float(atomicAdd(answers[0].x, 1u)); }\n", 2, "atomic"},
    {"float f(float x, int n) {\n whit_fuel = 9u;\n return x; }\n", 2, "whit_fuel is"},
    {"float f(float x, int n) {\n return float(whit_fuel); }\n", 2, "whit_fuel is"},
    {"float f(float x, int n) {\n return float(gl_GlobalInvocationID.x); }\n", 2, "built-in"},
    {"float g = float(gl_LocalInvocationIndex);\nfloat f(float x, int n) { return g; }\n", 1,
     "built-in"},
    {"#define F whit_fuel_loop\nfloat f(float x, int n) {\n F++;\n return x; }\n", 3,
     "whit_fuel is"},
    {"float f(float x, int n) {\n float a[5000];\n a[n] = x;\n return a[0]; }\n", 1, "16 KiB"},
    {"float a[2000];\nfloat b[3000];\nfloat f(float x, int n) {\n a[n] = x; b[n] = x;\n return "
     "a[0] + "
     "b[0]; }\n",
     2, "16 KiB"},
    {"struct S { vec4 v[20][30]; };\nfloat f(float x, int n) {\n S s, t;\n s.v[1][1].x = x; t = "
     "s;\n"
     " return t.v[1][n].x; }\n",
     2, "16 KiB"},
    {"float f(float x, int n) {\n double d = double(x) * 2.0LF;\n return float(d); }\n", 2,
     "no double"},
    {"float f(float x, int n) {\n return subgroupAdd(x); }\n", 2, ""},
};

TEST_IN(what_users_may_not_do_is_refused, compiler_begin, compiler_end)
{
    for (size_t i = 0; i < sizeof refused / sizeof *refused; ++i) {
        for (int trust = 0; trust < 2; ++trust) {
            struct shader_code code;
            if (compile_file(refused[i].content, trust, &code) != WHIT_ERROR_INPUT)
                fail_msg("it is not refused: %s", refused[i].content);
            if (errors.items[0].line != refused[i].line ||
                !strstr(errors.items[0].reason, refused[i].reason))
                fail_msg("%s\n%s", refused[i].content, messages.text);
        }
    }
    /* A constant table is in the module once, however often it is indexed. */
    own_shader_code code = must_compile(
        "const mat4 t[128] = mat4[128](\n"
#define ROW  "mat4(1),mat4(2),mat4(3),mat4(4)"
#define ROWS ROW "," ROW "," ROW "," ROW "," ROW "," ROW "," ROW "," ROW
        ROWS "," ROWS "," ROWS "," ROWS
        ");\nfloat f(float x, int n) { return t[n][0].x + t[n + 1][1].y + t[n + 2][2].z; }\n");
    assert_valid(&code);
}

TEST_IN(what_is_not_for_users_is_not_called, compiler_begin, compiler_end)
{
    static const struct {
        const char *content, *reason; /* NULL: it is fine */
    } cases[] = {
        {"float f(float x, int n) { return octahedron_from_dir(vec3(x)).x; }", NULL},
        {"float f(float x, int n) { return answer_of(n); }", "answer_of is whit's own"},
        {"float g(int n) {\n return answer_of(n); }\nfloat f(float x, int n) { return g(n); }",
         "a.glsl:2: answer_of"},
        {"#define h answer_of\nfloat f(float x, int n) { return h(n); }", "a.glsl:2: answer_of"},
    };
    char kernel[4096];
    const char *place = strstr(test_kernel, "#include \"../hook");
    snprintf(kernel, sizeof kernel,
             "%.*s#include \"../lib/octahedron.glsl\"\n"
             "float answer_of(int n) { return float(cases[n].x); }\n%s",
             (int)(place - test_kernel), test_kernel, place);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const char *const files[] = {"a.glsl", cases[i].content, NULL};
        own_shader_code code = {0};
        whit_result result = compile_in(kernel, files, false, &code);
        if (cases[i].reason ? result == WHIT_OK || !strstr(messages.text, cases[i].reason)
                            : result != WHIT_OK)
            fail_msg("%s: %s", cases[i].content, messages.text);
    }
}

TEST_IN(operations_stay_exact, compiler_begin, compiler_end)
{
    own_shader_code code = must_compile("float f(float x, int n) { return x * 3.0 + 1.0; }\n");
    own_memory char *text = disassemble(code.words, code.bytes);
    assert_int_equal(count(text, "NoContraction"), 2);
    for (size_t at = SPV_HEADER_WORDS; at < code.bytes / 4; at += spv_length(code.words + at))
        assert_false(spv_op(code.words + at) >= OP_SOURCE_CONTINUED &&
                     spv_op(code.words + at) <= OP_LINE);
}
