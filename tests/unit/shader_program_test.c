/* What a file of hooks says of itself, and the values of its sliders. */
#include "base/color.h"
#include "shader/program.h"
#include "unit.h"

static struct shader_errors errors;

static whit_result read_text(const char *text, whit_shader *shader)
{
    const struct shader_text_source source = {"a.glsl", text, strlen(text)};
    *shader = (whit_shader){.fuel = SHADER_FUEL_USUAL};
    errors = (struct shader_errors){0};
    whit_result result = shader_text_from(NULL, &source, 1, &shader->text, &errors);
    return result == WHIT_OK ? shader_annotations_read(NULL, shader, &errors) : result;
}

static const char whole[] = "//@ whit 1\n"
                            "//@ slider bands 1 8 3 \"steps of light\"\n"
                            "  //@ color rim #ff8000\n"
                            "//@ toggle on on\n"
                            "//@ toggle off \"begins without\"\n"
                            "//@ choice mode plain,warm,cold \"which\"\n"
                            "//@ fuel 1234\n"
                            "vec3 miss(vec3 dir) { return dir; }\n";

TEST(lines_are_read)
{
    whit_shader shader;
    assert_int_equal(read_text(whole, &shader), WHIT_OK);
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
    shader_text_free(&shader.text);
}

TEST(sliders_are_declared_by_plain_names)
{
    whit_shader shader;
    assert_int_equal(read_text(whole, &shader), WHIT_OK);
    char *text = shader_sliders_declare(&shader);
    assert_string_equal(text, "float bands = slider(0u);\n"
                              "vec3 rim = vec3(slider(1u), slider(2u), slider(3u));\n"
                              "bool on = slider(4u) != 0.0;\n"
                              "bool off = slider(5u) != 0.0;\n"
                              "int mode = int(slider(6u));\n"
                              "const int mode_plain = 0;\n"
                              "const int mode_warm = 1;\n"
                              "const int mode_cold = 2;\n");
    free(text);
    shader_text_free(&shader.text);
}

TEST(values_come_from_the_file_and_from_text)
{
    whit_shader shader;
    float values[SHADER_SLIDERS_MAX];
    char why[256];
    assert_int_equal(read_text(whole, &shader), WHIT_OK);
    assert_true(shader_sliders_read(&shader, NULL, false, values, why, sizeof why));
    assert_true(values[0] == 3.0f && values[1] == 1.0f && values[3] == 0.0f && values[4] == 1.0f);
    assert_true(values[2] == (float)linear_from_srgb((double)(128.0f / 255.0f)));
    assert_true(shader_sliders_read(&shader, "mode=cold,bands=4.5,on=off,rim=#00ff00", false,
                                    values, why, sizeof why));
    assert_true(values[0] == 4.5f && values[1] == 0.0f && values[2] == 1.0f && values[4] == 0.0f);
    assert_true(values[6] == 2.0f);
    shader_text_free(&shader.text);
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
                 {"mode=hot", "no word `hot`"},
                 {"band=3", "did you mean `bands`"},
                 {"bands", "NAME=VALUE"},
                 {"=3", "NAME=VALUE"}};
    whit_shader shader;
    float values[SHADER_SLIDERS_MAX], usual[SHADER_SLIDERS_MAX];
    char why[256];
    assert_int_equal(read_text(whole, &shader), WHIT_OK);
    assert_true(shader_sliders_read(&shader, "", false, usual, why, sizeof why));
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        why[0] = 0;
        assert_false(shader_sliders_read(&shader, cases[i].text, false, values, why, sizeof why));
        if (!strstr(why, cases[i].why))
            fail_msg("%s: %s", cases[i].text, why);
        assert_true(shader_sliders_read(&shader, cases[i].text, true, values, why, sizeof why));
        assert_memory_equal(values, usual, sizeof values);
    }
    shader_text_free(&shader.text);
}

TEST(lines_that_are_none_are_refused_with_their_line)
{
    static const struct {
        const char *line, *why;
    } cases[] = {{"slider", "has a name"},
                 {"slider 1x 0 1 0", "has a name"},
                 {"slider gl_x 0 1 0", "has a name"},
                 {"slider whit_x 0 1 0", "has a name"},
                 {"slider light 0 1 0", "is a function"},
                 {"slider x 0 1", "value of a slider"},
                 {"slider x 1 0 0", "largest value"},
                 {"slider x 0 1 2", "from 0 to 1"},
                 {"slider x 0 1 0 help and more", "in quotes"},
                 {"color x #12345", "#ffcc88"},
                 {"choice x", "names its words"},
                 {"choice x a,,b", "up to 16 words"},
                 {"fuel 0", "from 1 to 30000"},
                 {"fuel many", "from 1 to 30000"},
                 {"whit 2", "this whit has 1"},
                 {"sliders x", "none of whit"},
                 {"", "none of whit"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char text[256];
        whit_shader shader;
        snprintf(text, sizeof text, "\n//@ %s\nvec3 miss(vec3 dir) { return dir; }\n",
                 cases[i].line);
        assert_int_equal(read_text(text, &shader), WHIT_ERROR_INPUT);
        assert_int_equal(errors.count, 1);
        assert_int_equal(errors.items[0].line, 2);
        if (!strstr(errors.items[0].reason, cases[i].why))
            fail_msg("%s: %s", cases[i].line, errors.items[0].reason);
        shader_text_free(&shader.text);
    }
}

TEST(there_are_as_many_values_as_fit)
{
    char text[8192] = "";
    whit_shader shader;
    for (int i = 0; i < SHADER_SLIDERS_MAX / 3 + 1; ++i)
        sprintf(text + strlen(text), "//@ color c%d #ffffff\n", i);
    strcat(text, "vec3 miss(vec3 dir) { return dir; }\n");
    assert_int_equal(read_text(text, &shader), WHIT_ERROR_INPUT);
    assert_int_equal(errors.count, 1);
    assert_int_equal(errors.items[0].line, SHADER_SLIDERS_MAX / 3 + 1);
    shader_text_free(&shader.text);
}
