/* Functions of users on the device: loops end, indices stay within bounds, and kernels with them
   are evaluated as whit's own are. */
#include "device_fixture.h"
#include "shader_fixture.h"

struct answer {
    uint32_t value, loop;
};

/* Runs f(x, n) for each case. The first case fills the rest of the buffer, because an invocation
   with other data there would let those that share its loop wait. */
static void run(const struct shader_code *code, uint32_t count, const int32_t cases[][2],
                struct answer *answers)
{
    enum { ALL = 64 };
    int32_t filled[ALL][2];
    struct answer all[ALL];
    struct messages told;
    struct device *device = device_open(&told, false);
    for (uint32_t i = 0; i < ALL; ++i)
        memcpy(filled[i], cases[i < count ? i : 0], sizeof filled[i]);
    kernel_answer(device, code->words, code->bytes, ALL, filled, sizeof *filled, all, sizeof *all);
    memcpy(answers, all, count * sizeof *all);
    device_close(device, &told);
}

static void assert_evaluated(const struct shader_code *code, const char *content)
{
    struct pipeline_params params = storage_params(code->words, code->bytes, 2, "user");
    struct pipeline_info info;
    if (!pipeline_count(&params, &info))
        fail_msg("not evaluated: %s", content);
}

/* The kernel has fuel for 1000 iterations. */
TEST_IN(loops_end, compiler_begin, compiler_end)
{
    static const struct {
        const char *content;
        uint32_t value, line; /* with x = 0, n = 0; line 0: fuel was enough */
    } cases[] = {
        {"float f(float x, int n) { for (int i = 0; i < 999; i++) x++; return x; }\n", 999, 0},
        {"float f(float x, int n) {\n for (int i = 0; i >= 0; i = 0) x++; return x; }\n", 1000, 2},
        {"float f(float x, int n) {\n while (n == 0) x++;\n return x; }\n", 1000, 2},
        {"float f(float x, int n) {\n do x++;\n while (n == 0); return x; }\n", 1000, 3},
        {"float f(float x, int n) {\n for (;;) { x++; if (n == 1) return 5.0; } }\n", 0, 2},
        {"float f(float x, int n) {\n for (;;) { if (n == 1) return 5.0;\n"
         "  for (int i = 0; i < 99; i++) x++;\n  if (x > 880.0 && n == 0) return x; }}\n",
         891, 0},
        {"float f(float x, int n) {\n while (n == 0) {\n  switch (n) { case 0: x++; continue;\n"
         "  default: break; } }\n while (x < 2000.0) x++;\n return x; }\n",
         1000, 2},
        {"float g(float x, int n) {\n while (n == 0 || x < 0.0) x += 2.0;\n return x; }\n"
         "float f(float x, int n) { for (int i = 0; i < 500; i++) x++;\n return g(x, n); }\n",
         1498, 2},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        struct answer answer;
        own_shader_code code = must_compile(cases[i].content);
        run(&code, 1, (const int32_t[][2]){{0, 0}}, &answer);
        if (answer.value != cases[i].value)
            fail_msg("%u: %s", answer.value, cases[i].content);
        assert_true(answer.loop <= code.loop_count);
        assert_int_equal(answer.loop ? code.loops[answer.loop - 1].line : 0, cases[i].line);
    }
}

TEST_IN(indices_mean_the_last_element, compiler_begin, compiler_end)
{
    static const int32_t cases[][2] = {{0, 0},  {0, 3},         {0, 4},
                                       {0, -1}, {0, INT32_MIN}, {0, INT32_MAX}};
    static const char *const contents[] = {
        "float f(float x, int n) { float a[4] = float[4](1.0, 2.0, 3.0, 4.0); return a[n]; }\n",
        "float a[4];\nfloat f(float x, int n) { a[0] = 1.0; a[3] = 4.0; a[n] += 0.0; return a[n]; "
        "}\n",
        "float f(float x, int n) { vec4 a = vec4(1.0, 2.0, 3.0, 4.0); return a[n]; }\n",
        "float f(float x, int n) { return vec4(1.0, 2.0, 3.0, 4.0)[uint(n)]; }\n",
        "float f(float x, int n) { vec4 v = vec4(1.0); v.w = 4.0; mat4 m = mat4(v, v, v, v * "
        "1.0);\n"
        " m[0] = vec4(1.0); return m[n][n]; }\n",
        "const float t[4] = float[4](1.0, 2.0, 3.0, 4.0);\n"
        "float f(float x, int n) { return t[n]; }\n",
    };
    for (size_t i = 0; i < sizeof contents / sizeof *contents; ++i) {
        struct answer answers[6];
        own_shader_code code = must_compile(contents[i]);
        run(&code, 6, cases, answers);
        assert_int_equal(answers[0].value, 1);
        for (int j = 1; j < 6; ++j)
            assert_int_equal(answers[j].value, 4);
    }
}

/* Returns from within loops and switches. */
static const struct {
    const char *content;
    uint32_t values[5]; /* with x = 10, n = 0 to 4 */
} leaving[] = {
    {"float f(float x, int n) { for (int i = 0; i < 4; i++) { if (i == n) return x + float(i); "
     "x++; }\n"
     " return x; }\n",
     {10, 12, 14, 16, 14}},
    {"float f(float x, int n) { for (int i = 0; i < 3; i++)\n"
     " for (int j = 0; j < 3; j++) { if (i * j == n) return x; x++; }\n return x + 100.0; }\n",
     {10, 14, 15, 119, 18}},
    {"float f(float x, int n) { switch (n) { case 0: return 1.0; case 1: x++; case 2: x++; break;\n"
     " case 3: if (x > 5.0) break; return 2.0; default: return 3.0; }\n return x; }\n",
     {1, 12, 11, 10, 3}},
    {"float f(float x, int n) { while (true) { switch (n) { case 0: return 5.0; case 1: n = 0; "
     "continue;\n"
     " case 2: n = 7; break; default: return x; }\n x += 2.0; } }\n",
     {5, 5, 12, 10, 10}},
    {"void g(inout float x, int n) { for (;;) { if (n == 2) return; x++; if (x > 20.0) return; } "
     "}\n"
     "float f(float x, int n) { g(x, n); if (n == 3) return 7.0; g(x, n + 1); return x; }\n",
     {22, 21, 21, 7, 22}},
    {"float f(float x, int n) { do { if (n > 2) { if (n == 4) return 1.0; else return 2.0; } x++; "
     "}\n"
     " while (x < 15.0); return n > 1 ? x : -x + 30.0; }\n",
     {15, 15, 15, 2, 1}},
    {"bool h(float x) { return x > 11.0; }\n"
     "float f(float x, int n) { for (int i = 0; i < 4; i++) { if (i == n) return x; x++; }\n"
     " return n > 1 && h(x) ? 1.0 : 2.0; }\n",
     {10, 11, 12, 13, 1}},
    {"mat2 g(int n) { for (int i = 0; ; i++) { if (i == n) return mat2(float(i)); } }\n"
     "float f(float x, int n) { return g(n)[1][1] + (n > 1 && x > 1.0 || n == 0 ? 1.0 : 0.0); }\n",
     {1, 1, 3, 4, 5}},
    {"float f(float x, int n) { switch (n) { case 0: for (;;) { if (x > 12.0) return x; x++; }\n"
     " default: return x + 20.0; } }\n",
     {13, 30, 30, 30, 30}},
    {"float f(float x, int n) { switch (n) { case 0: { switch (int(x)) { case 10: return 1.0;\n"
     " default: return 3.0; } } default: return 2.0; } }\n",
     {1, 2, 2, 2, 2}},
};

TEST_IN(loops_are_left_by_returns, compiler_begin, compiler_end)
{
    static const int32_t cases[5][2] = {{10, 0}, {10, 1}, {10, 2}, {10, 3}, {10, 4}};
    for (size_t i = 0; i < sizeof leaving / sizeof *leaving; ++i) {
        for (int trust = 0; trust < 2; ++trust) {
            own_shader_code code = {0};
            struct answer answers[5];
            assert_int_equal(compile_file(leaving[i].content, trust, &code), WHIT_OK);
            assert_valid(&code);
            for (int plain = 0; plain < 2; ++plain) {
                assert_int_equal(plain ? setenv("WHIT_NO_SPECIALIZE", "1", 1)
                                       : unsetenv("WHIT_NO_SPECIALIZE"),
                                 0);
                run(&code, 5, cases, answers);
                for (int j = 0; j < 5; ++j) {
                    if (answers[j].value != leaving[i].values[j])
                        fail_msg("f(10, %d) is %u, trust %d plain %d: %s", j, answers[j].value,
                                 trust, plain, leaving[i].content);
                }
            }
            unsetenv("WHIT_NO_SPECIALIZE");
            assert_evaluated(&code, leaving[i].content);
        }
    }
}

/* Each call sets variables to zero, also each call in a loop. */
TEST_IN(variables_begin_as_zero, compiler_begin, compiler_end)
{
    static const char *const contents[] = {
        "float f(float x, int n) { float a; return x + a; }\n",
        "struct S { vec3 v; int a[3]; };\nfloat f(float x, int n) { S s; return x + s.v.y + "
        "float(s.a[n]); }\n",
        "float g(int n) { float a; a += float(n); return a; }\nfloat f(float x, int n) {\n"
        " float sum; for (int i = 0; i < 5; i++) sum = g(n); return x + sum - float(n); }\n",
        "float a[4]; mat3 m; bool b;\nfloat f(float x, int n) { a[0] += x; m[1][1] += b ? 7.0 : "
        "0.0;\n"
        " return a[n] + a[0] + m[1][1]; }\n",
    };
    for (size_t i = 0; i < sizeof contents / sizeof *contents; ++i) {
        struct answer answers[2];
        own_shader_code code = must_compile(contents[i]);
        assert_valid(&code);
        run(&code, 2, (const int32_t[][2]){{1, 1}, {30, 2}}, answers);
        if (answers[0].value != 1 || answers[1].value != 30)
            fail_msg("%u %u: %s", answers[0].value, answers[1].value, contents[i]);
        assert_evaluated(&code, contents[i]);
    }
}

TEST_IN(kernels_are_evaluated, compiler_begin, compiler_end)
{
    static const char *const contents[] = {
        "float f(float x, int n) { for (int i = 0; i < n; i++) { if (x > 9.0) return x; x++; }\n"
        " float a[4]; a[n] = x; mat3 m = transpose(mat3(x)); return a[n] + m[n][n] + vec3(x)[n]; "
        "}\n",
        "float f(float x, int n) { return float(cases[n].x); }\n",
    };
    for (size_t i = 0; i < sizeof contents / sizeof *contents; ++i) {
        own_shader_code code = must_compile(contents[i]);
        assert_evaluated(&code, contents[i]);
    }
}
