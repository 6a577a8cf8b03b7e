/* Annotations of a user's file, and the values of its sliders. */
#include "base/color.h"
#include "messages_fixture.h"
#include "shader/annotations.h"
#include "shader/sliders.h"
#include "unit.h"

/* What was read last; the next reading frees it. */
static whit_shader shader;
static struct shader_errors errors;

static whit_result read_text(const char *content, struct shader_text *text)
{
    const struct shader_text_source source = {"a.glsl", content, strlen(content)};
    shader_text_free(text);
    errors = (struct shader_errors){0};
    return shader_text_from(NULL, &source, 1, text, &errors);
}

static whit_result read_shader(const char *content)
{
    struct shader_text last = shader.text;
    shader = (whit_shader){.text = last, .fuel = SHADER_FUEL_USUAL};
    whit_result result = read_text(content, &shader.text);
    return result == WHIT_OK ? shader_annotations_read(NULL, &shader, &errors) : result;
}

/* Asserts that the file has one error, in this line and for this reason. */
static void refuse_shader(const char *content, uint32_t line, const char *reason)
{
    assert_int_equal(read_shader(content), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 1);
    if (errors.items[0].line != line || !strstr(errors.items[0].reason, reason))
        fail_msg("%s: line %u: %s", content, errors.items[0].line, errors.items[0].reason);
}

#define MISS "vec3 miss(vec3 dir) { return dir; }\n"

/* A byte order mark, an end of a line that is a CR alone, and lines in comments. */
static const char whole[] = "\xef\xbb\xbf//@ slider bands 1 8 3 \"steps of light\"\r"
                            "//@ whit 1\n"
                            "/*\n//@ none\n*/ //@ none\n// \\\n//@ none\n"
                            "  //@ color rim #ff8000\n"
                            "//@ toggle on on\n"
                            "//@ toggle off \"begins without\"\n"
                            "//@ choice mode plain,warm,cold \"which\"\n"
                            "//@ fuel 1234\n" MISS;

TEST(lines_are_read)
{
    assert_int_equal(read_shader(whole), WHIT_OK);
    assert_int_equal(shader.fuel, 1234);
    assert_int_equal(shader.slider_count, 5);
    assert_int_equal(shader.value_count, 7);
    const whit_slider *s = shader.sliders;
    assert_string_equal(s[0].name, "bands");
    assert_string_equal(s[0].help, "steps of light");
    assert_true(s[0].min == 1.0f && s[0].max == 8.0f && s[0].value[0] == 3.0f);
    assert_int_equal(s[1].kind, WHIT_SLIDER_COLOR);
    assert_int_equal(s[1].first, 1);
    assert_true(s[1].value[0] == 1.0f && s[1].value[1] == 128.0f / 255.0f);
    assert_true(s[2].value[0] == 1.0f && s[3].value[0] == 0.0f);
    assert_string_equal(s[3].help, "begins without");
    assert_int_equal(s[4].word_count, 3);
    assert_string_equal(s[4].words[2], "cold");
    assert_int_equal(s[4].first, 6);
}

/* Reading ends at the first error that is not kept, so that a text of many takes no time. */
TEST(errors_are_limited_in_number)
{
    char text[64 * 16] = "";
    for (int i = 0; i < 64; ++i)
        strcat(text, "//@ fuel 0\n");
    strcat(text, MISS);
    assert_int_equal(read_shader(text), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, SHADER_ERROR_MAX);
    assert_int_equal(errors.more, 1);
    errors = (struct shader_errors){0};
    const whit_log counted = messages_log(&messages);
    assert_int_equal(shader_annotations_read(&counted, &shader, &errors), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, SHADER_ERROR_MAX + 1);
    assert_string_equal(messages.last_error, "a.glsl: there are more errors");
}

TEST(the_most_fuel_is_taken)
{
    assert_int_equal(read_shader("//@ fuel 30000\n" MISS), WHIT_OK);
    assert_int_equal(shader.fuel, 30000);
}

TEST(sliders_are_declared_by_plain_names)
{
    assert_int_equal(read_shader(whole), WHIT_OK);
    own_memory char *text = shader_sliders_declare(&shader);
    assert_string_equal(text, "float bands = slider(0u);\n"
                              "vec3 rim = vec3(slider(1u), slider(2u), slider(3u));\n"
                              "bool on = slider(4u) != 0.0;\n"
                              "bool off = slider(5u) != 0.0;\n"
                              "int mode = int(slider(6u));\n"
                              "const int mode_plain = 0;\n"
                              "const int mode_warm = 1;\n"
                              "const int mode_cold = 2;\n");
}

TEST(values_come_from_the_file_and_from_text)
{
    float values[SHADER_SLIDERS_MAX];
    char why[256];
    assert_int_equal(read_shader(whole), WHIT_OK);
    assert_true(shader_sliders_read(&shader, NULL, false, values, why, sizeof why));
    assert_true(values[0] == 3.0f && values[1] == 1.0f && values[3] == 0.0f && values[4] == 1.0f);
    assert_true(values[2] == (float)linear_from_srgb((double)(128.0f / 255.0f)));
    assert_true(shader_sliders_read(&shader, "mode=cold,bands=4.5,on=off,rim=#00ff00", false,
                                    values, why, sizeof why));
    assert_true(values[0] == 4.5f && values[1] == 0.0f && values[2] == 1.0f && values[4] == 0.0f);
    assert_true(values[6] == 2.0f);
}

TEST(values_that_are_none_are_refused_or_skipped)
{
    static const struct {
        const char *text, *why;
    } cases[] = {{"bands=9", "bands is a number from 1 to 8"},
                 {"bands=", "bands is a number"},
                 {"bands=3x", "not `3x`"},
                 {"rim=red", "such as #ffcc88"},
                 {"on=1", "on is on or off"},
                 {"mode=hot", "mode has no word `hot`; there is plain, warm, cold"},
                 {"band=3", "did you mean `bands`"},
                 {"bands", "NAME=VALUE"},
                 {"=3", "NAME=VALUE"}};
    float values[SHADER_SLIDERS_MAX], usual[SHADER_SLIDERS_MAX];
    char why[256];
    assert_int_equal(read_shader(whole), WHIT_OK);
    assert_true(shader_sliders_read(&shader, "", false, usual, why, sizeof why));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        why[0] = 0;
        assert_false(shader_sliders_read(&shader, cases[i].text, false, values, why, sizeof why));
        if (!strstr(why, cases[i].why))
            fail_msg("%s: %s", cases[i].text, why);
        assert_true(shader_sliders_read(&shader, cases[i].text, true, values, why, sizeof why));
        assert_memory_equal(values, usual, sizeof values);
    }
}

TEST(values_of_another_version_are_dropped)
{
    char text[] = "gone=1,bands=4.5,mode=hot,on=off,rim=red,bands=9", none[] = "on=off";
    assert_int_equal(read_shader(whole), WHIT_OK);
    assert_true(shader_sliders_keep(&shader, text));
    assert_string_equal(text, "bands=4.5,on=off");
    assert_false(shader_sliders_keep(&shader, text));
    assert_false(shader_sliders_keep(&shader, none));
}

/* What `#if 0` leaves out is nothing for whit either. Names that are nearly types are no words of
 * GLSL. */
TEST(code_that_is_left_out_counts_for_nothing)
{
    assert_int_equal(read_shader("#if 0\n//@ fuel 0\n#/* # */endif\n" MISS), WHIT_OK);
    assert_int_equal(read_shader("#if 0\n//@ slider a 0 1 0\n#include \"nowhere.glsl\"\n#if 1\n"
                                 "//@ toggle b\n#endif\nvec3 post(int at) { return at; }\n#else\n"
                                 "//@ toggle images2D\n//@ toggle texture1\n//@ toggle "
                                 "vec2x\n#endif\n#if 1\n//@ toggle c\n#endif\n" MISS),
                     WHIT_OK);
    assert_int_equal(shader.slider_count, 4);
    assert_string_equal(shader.sliders[0].name, "images2D");
    assert_int_equal(shader.slider_texts[0].line, 9);
    assert_string_equal(shader.sliders[3].name, "c");
    assert_false(shader_text_defines(&shader.text, "post", NULL, NULL));
}

TEST(lines_that_are_none_are_refused_with_their_line)
{
    static const struct {
        const char *line, *why;
    } cases[] = {{"slider", "has a name"},
                 {"slider 1x 0 1 0", "has a name"},
                 {"slider gl_x 0 1 0", "has a name"},
                 {"slider whit_x 0 1 0", "has a name"},
                 {"slider light 0 1 0", "is a name of whit's"},
                 {"slider Surface 0 1 0", "`Surface` is a name of whit's"},
                 {"color Optics #ffffff", "is a name of whit's"},
                 {"toggle Rays on", "is a name of whit's"},
                 {"choice Light a,b", "is a name of whit's"},
                 {"slider TRACES 0 1 0", "is a name of whit's"},
                 {"slider ELSEWHERE 0 1 0", "is a name of whit's"},
                 {"slider LIB_OPTICS_GLSL 0 1 0", "is a name of whit's"},
                 {"slider HAS_SHADE 0 1 0", "is a name of whit's"},
                 {"slider HOOK_DBG_GLSL 0 1 0", "is a name of whit's"},
                 {"slider dbg 0 1 0", "`dbg` is a name of whit's"},
                 {"slider x 0 1", "value of a slider"},
                 {"slider x 1 0 0", "largest value"},
                 {"slider x 0 1 2", "from 0 to 1"},
                 {"slider x 0 1 0 help and more", "in quotes"},
                 {"color x #12345", "#ffcc88"},
                 {"choice x", "names its words"},
                 {"choice x a,,b", "up to 16 words"},
                 {"choice x a,b,a", "the word `a` twice"},
                 {"slider float 0 1 0", "is a word of GLSL"},
                 {"toggle mat2x3", "is a word of GLSL"},
                 {"color sample #ffffff", "is a word of GLSL"},
                 {"toggle x true", "on or off, not `true`"},
                 {"toggle x maybe", "on or off, not `maybe`"},
                 {"toggle x on help", "in quotes"},
                 {"slider x 0 1 0 unquoted", "in quotes"},
                 {"slider x 0 1 0 \"open", "in quotes"},
                 {"slider x 0 1 0 \"", "in quotes"},
                 {"color x #ffffff \"of\"it", "in quotes"},
                 {"toggle x \"open", "in quotes"},
                 {"choice x a,b red", "in quotes"},
                 {"box 0 0 0 1 1 1 0.01 \"open", "name of a material"},
                 {"fuel 1.5", "a whole number, not 1.5"},
                 {"fuel 0", "from 1 to 30000"},
                 {"fuel 30001", "from 1 to 30000"},
                 {"fuel many", "from 1 to 30000"},
                 {"fuel 1111111111111111111111111111111111111111111111111111111111111111",
                  "not `111111111111111111111111111111111111111111111111111111111111`"},
                 {"fuel 10 20", "nothing more"},
                 {"fuel 10 \"\" 20", "nothing more"},
                 {"test \"\"", "nothing more"},
                 {"whit 2", "this whit has 1"},
                 {"whit 1 x", "nothing more"},
                 {"whit", "the version, which is 1"},
                 {"box 0.15 0 0 0.14 1 1 0.01", "from 0.15"},
                 {"aov", "has a name"},
                 {"aov x y", "has a name"},
                 {"aov shade", "is a name of whit's"},
                 {"aov other", "stands before `vec4 other(Surface s)`"},
                 {"sliders x", "none of whit"},
                 {"test x", "nothing more"},
                 {"expect ids", "WHAT == base"},
                 {"expect id == base", "WHAT == base"},
                 {"expect ids != base", "WHAT == base"},
                 {"expect rays.sun == base", "WHAT == base"},
                 {"expect ids == base 1", "WHAT == base"},
                 {"", "none of whit"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[256];
        snprintf(text, sizeof text, "\n//@ %s\n" MISS, cases[i].line);
        refuse_shader(text, 2, cases[i].why);
    }
}

TEST(what_is_there_already_is_refused)
{
    static const char *const cases[][2] = {
        {"fuel 10\n//@ fuel 20", "a fuel already, in line 1"},
        {"choice mode a,b\n//@ slider mode_a 0 1 0", "`mode_a` already, in line 1"},
        {"slider mode_b 0 1 0\n//@ choice mode a,b", "`mode_b` already, in line 1"},
        {"choice a b_c,d\n//@ choice a_b c", "`a_b_c` already, in line 1"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[256];
        snprintf(text, sizeof text, "//@ %s\n" MISS, cases[i][0]);
        refuse_shader(text, 2, cases[i][1]);
    }
    assert_int_equal(read_shader("//@ choice a b,c\n//@ choice d b,c\n" MISS), WHIT_OK);
}

TEST(a_side_of_the_box_may_have_no_length)
{
    assert_int_equal(read_shader("//@ box 0.15 0 0  0.15 1 1  0.01\nvoid f() {}\n"), WHIT_OK);
    assert_true(shader.box.lo[0] == 0.15f && shader.box.hi[0] == 0.15f);
}

TEST(aovs_stand_before_their_functions)
{
    char text[8192] = "//@ slider x 0 1 0\n";
    for (int i = 0; i < WHIT_LAYERS_MAX; ++i)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "//@ aov a%d\n// what it is\nvec4 a%d(in Surface s) { return vec4(x); }\n", i, i);
    size_t full = strlen(text);
    assert_int_equal(read_shader(text), WHIT_OK);
    assert_int_equal(shader.aov_count, WHIT_LAYERS_MAX);
    assert_string_equal(shader.aov_names[63], "a63");
    static const char *const more[][2] = {
        {"//@ aov b\nvec4 b(Surface s) { return vec4(0); }\n", "at most 64 aovs"},
        {"//@ aov a3\n", "an aov `a3` already, in line 11"},
        {"//@ slider a3 0 1 0\n", "an aov `a3` already"},
        {"//@ aov x\n", "a choice `x` already"}};
    for (size_t i = 0; i < sizeof more / sizeof *more; ++i) {
        strcpy(text + full, more[i][0]);
        refuse_shader(text, 2 + 3 * WHIT_LAYERS_MAX, more[i][1]);
    }
}

TEST(there_are_as_many_values_as_fit)
{
    char text[8192] = "";
    for (int i = 0; i < SHADER_SLIDERS_MAX / 3 + 1; ++i)
        sprintf(text + strlen(text), "//@ color c%d #ffffff\n", i);
    strcat(text, MISS);
    refuse_shader(text, SHADER_SLIDERS_MAX / 3 + 1, "");
}

TEST(expectations_are_read)
{
    assert_int_equal(read_shader("//@ expect ids == base\n//@ expect rays.shadow == base\n" MISS),
                     WHIT_OK);
    assert_int_equal(shader.expectation_count, 2);
    assert_int_equal(shader.expectations[0].what, WHIT_EXPECT_IDS);
    assert_int_equal(shader.expectations[1].what, WHIT_EXPECT_SHADOW);
    assert_string_equal(shader.expectations[1].word, "rays.shadow");
    assert_int_equal(shader.expectations[1].line, 2);
}

/* ---- Tests in a file ---- */

static struct shader_text text;
static struct shader_tests tests;

static whit_result read_tests(const char *content)
{
    assert_int_equal(read_text(content, &text), WHIT_OK);
    shader_tests_free(&tests);
    return shader_tests_read(NULL, &text, &tests, &errors);
}

struct refused {
    const char *content, *why;
    uint32_t line;
};

/* Asserts that each text has one error, in its line and for its reason. */
static void refuse_all(whit_result (*read)(const char *content), const struct refused *cases,
                       size_t count)
{
    for (size_t i = 0; i < count; ++i) {
        if (read(cases[i].content) != WHIT_ERROR_INPUT || errors.count != 1 ||
            errors.items[0].line != cases[i].line || !strstr(errors.items[0].reason, cases[i].why))
            fail_msg("%s: %u errors, %u: %s", cases[i].content, errors.count, errors.items[0].line,
                     errors.items[0].reason);
    }
}

static const char tested[] = "float f(float x) { return x; } // check(\n"
                             "//@ test\n"
                             "void one(uint seed) { /* check(0) */\n"
                             "    if (seed > 1u) { check( f(1.0)/*)*/<=\n"
                             "        2.0); check(true); }\n"
                             "}\n"
                             "  //@  test \n"
                             "void two(uint n)\n"
                             "{ check((n)==n); } float g() { return 1.0; }\n"
                             "/*\n//@ test\n*/\n";

TEST(tests_and_their_checks_are_found)
{
    assert_int_equal(read_tests(tested), WHIT_OK);
    assert_int_equal(tests.test_count, 2);
    assert_string_equal(tests.tests[0].name, "one");
    assert_int_equal(tests.tests[0].line, 3);
    assert_int_equal(tests.tests[0].check_count, 2);
    assert_int_equal(tests.tests[1].first_check, 2);
    assert_int_equal(tests.check_count, 3);
    assert_string_equal(tests.checks[0].text, "f(1.0) <= 2.0");
    assert_int_equal(tests.checks[0].line, 4);
    assert_int_equal(tests.checks[1].line, 5);
    assert_string_equal(tests.checks[2].text, "(n)==n");
    assert_int_equal(tests.checks[2].number, 0);
    assert_int_equal(shader_tests_words(&tests), 1);
}

TEST(kernels_have_tests_numbered_or_blank_in_the_same_lines)
{
    struct shader_text out;
    char blank[sizeof tested];
    assert_int_equal(read_tests(tested), WHIT_OK);
    strcpy(blank, tested);
    for (uint32_t i = 0; i < tests.test_count; ++i) {
        assert_memory_equal(blank + tests.tests[i].begin, "void ", 5);
        assert_true(blank[tests.tests[i].end - 1] == '}');
        for (size_t at = tests.tests[i].begin; at < tests.tests[i].end; ++at)
            blank[at] = blank[at] == '\n' ? '\n' : ' ';
    }
    assert_true(shader_tests_text(&tests, &text, false, &out));
    assert_string_equal(out.files[0].text, blank);
    shader_text_end_copy(&out);
    assert_true(shader_tests_text(&tests, &text, true, &out));
    assert_int_equal(out.files[0].bytes, strlen(out.files[0].text));
    assert_non_null(strstr(out.files[0].text, "check(0u, 1u,  f(1.0)/*)*/<=\n        2.0);"));
    assert_non_null(strstr(out.files[0].text, "check(0u, 2u, true);"));
    assert_non_null(strstr(out.files[0].text, "{ check(0u, 1u, (n)==n); } float g()"));
    shader_text_end_copy(&out);
}

/* ---- dbg(x) ---- */

static const char looked_at[] = "#if 0\n"
                                "float f(float x) {\n"
                                "#else\n"
                                "float f(float dbg) {\n"
                                "#endif\n"
                                "    dbg += 1.0; /* dbg(0) */\n"
                                "    return dbg( dbg  +\n"
                                "        1.0) * dbg(g(dbg (vec2(2.0, dbg)))); }\n";

static struct shader_dbg dbg;

static whit_result read_dbg(const char *content)
{
    assert_int_equal(read_tests(content), WHIT_OK);
    return shader_dbg_read(NULL, &text, &tests, &dbg, &errors);
}

TEST(values_that_are_looked_at_are_found_in_any_expression)
{
    assert_int_equal(read_dbg(looked_at), WHIT_OK);
    assert_int_equal(dbg.count, 3);
    assert_string_equal(dbg.sites[0].text, "dbg + 1.0");
    assert_int_equal(dbg.sites[0].line, 7);
    assert_string_equal(dbg.sites[1].text, "g(dbg (vec2(2.0, dbg)))");
    assert_string_equal(dbg.sites[2].text, "vec2(2.0, dbg)");
    assert_int_equal(dbg.sites[2].line, 8);
}

TEST(kernels_have_them_numbered_or_blank_in_the_same_lines)
{
    struct shader_text out;
    assert_int_equal(read_dbg(looked_at), WHIT_OK);
    assert_true(shader_dbg_text(&dbg, &text, false, &out));
    assert_int_equal(strlen(out.files[0].text), strlen(looked_at));
    assert_non_null(strstr(out.files[0].text, "return    ( dbg  +\n        1.0) *    "
                                              "(g(    (vec2(2.0, dbg)))); }\n"));
    assert_non_null(strstr(out.files[0].text, "float f(float dbg) {\n"));
    shader_text_end_copy(&out);
    assert_true(shader_dbg_text(&dbg, &text, true, &out));
    assert_int_equal(out.files[0].bytes, strlen(out.files[0].text));
    assert_non_null(strstr(out.files[0].text, "return dbg(0u,  dbg  +\n        1.0) * "
                                              "dbg(1u, g(dbg (2u, vec2(2.0, dbg)))); }\n"));
    shader_text_end_copy(&out);
}

TEST(a_function_of_that_name_is_the_users)
{
    assert_int_equal(read_dbg("float dbg(float a, float b) { return a; } float c = dbg(1.0, 2.0);"),
                     WHIT_OK);
    assert_int_equal(dbg.count, 0);
}

TEST(values_that_cannot_be_looked_at_are_refused_with_their_line)
{
    static const char one[] = "takes one value";
    const struct refused cases[] = {
        {"void f() {\n dbg(); }\n", one, 2},
        {"void f() {\n dbg(1.0, 2.0); }\n", one, 2},
        {"void f() {\n dbg(1.0; }\n", one, 2},
        {"void f() {}\nfloat a =\ndbg(1.0);\n", "in the body of a function", 3},
        {"void f() {}\n\n#define D dbg(1.0)\n", "in no macro", 3},
        {"void f() {\n#if dbg(1)\n#endif\n}\n", "in no macro", 2},
        {"#if 0\nvoid f() {\n#else\nvoid g() {\n#endif\n}\nfloat a = dbg(1.0);\n",
         "in the body of a function", 7},
        {"//@ test\nvoid a(uint s) {\ncheck(dbg(true)); }\n", "a test has none", 3},
    };
    refuse_all(read_dbg, cases, sizeof cases / sizeof *cases);
}

TEST(a_file_has_a_number_of_them_at_most)
{
    char content[16 + 8 * (SHADER_DBG_MAX + 1) + 4] = "void f() {";
    for (uint32_t i = 0; i < SHADER_DBG_MAX; ++i)
        strcat(content, "dbg(1);\n");
    assert_int_equal(read_dbg(strcat(content, "}")), WHIT_OK);
    assert_int_equal(dbg.count, SHADER_DBG_MAX);
    strcpy(content + strlen(content) - 1, "dbg(1);}");
    assert_int_equal(read_dbg(content), WHIT_ERROR_INPUT);
    assert_int_equal(errors.items[0].line, SHADER_DBG_MAX + 1);
}

TEST(tests_that_are_none_are_refused_with_their_line)
{
    static const char form[] = "void NAME(uint seed)", outside[] = "nowhere else";
    const struct refused cases[] = {
        {"void f() {}\n//@ test\n", form, 2},
        {"void f() {}\n//@ test\nvoid a(int seed) { check(true); }\n", form, 2},
        {"void f() {}\n//@ test\nbool a(uint seed) { check(true); }\n", form, 2},
        {"void f() {}\n//@ test\nvoid a(uint seed, int b) { check(true); }\n", form, 2},
        {"void f() {}\n//@ test\nvoid a(uint seed);\n", form, 2},
        {"//@ test\n//@ test\nvoid a(uint seed) { check(true); }\n", form, 2},
        {"//@ test\nvoid a(uint seed) {\n//@ test\ncheck(true); }\n", form, 3},
        {"//@ test\nvoid a(uint seed) { }\n", "without a check", 2},
        {"//@ test\nvoid a(uint seed) { bool check; }\n", "is called", 2},
        {"//@ test\nvoid a(uint seed) { check(true);\n", "does not end", 2},
        {"//@ test\nvoid a(uint seed) { check(true); }\nvoid b() { check(true); }\n", outside, 3},
        {"#define C check\n//@ test\nvoid a(uint seed) { check(true); }\n", outside, 1},
        {"//@ test\nvoid a(uint seed) {\n#define C check\ncheck(true); }\n", outside, 3},
        {"void check(bool b) {}\n//@ test\nvoid a(uint s) { check(true); }\n", outside, 1},
        {"void f() {\n check(true); }\n", outside, 2},
    };
    refuse_all(read_tests, cases, sizeof cases / sizeof *cases);
}

TEST(words_may_go_on_in_the_next_line)
{
    struct shader_text out;
    assert_int_equal(read_tests("//@ test\nvo\\\nid a(uint s) { check(true); }\n"), WHIT_OK);
    assert_true(shader_tests_text(&tests, &text, false, &out));
    assert_null(strstr(out.files[0].text, "vo"));
    shader_text_end_copy(&out);
}

TEST(a_file_without_tests_may_have_a_function_check)
{
    assert_int_equal(read_tests("void check(bool b) {}\nvoid f() { check(true); }\n"), WHIT_OK);
    assert_int_equal(tests.test_count, 0);
}
