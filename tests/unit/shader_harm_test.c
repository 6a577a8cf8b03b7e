/* Harmful files, loaded as by the program. Each is reported, or drawn if that is promised, and the
   next good file is compiled and drawn as before. The time of each is printed, but not tested. What
   the reader refuses before anything is compiled is in shader_text. */
#include "base/clock.h"
#include "folder_fixture.h"
#include "hooks_fixture.h"

enum { WIDTH = 16, HEIGHT = 12, PIXELS = WIDTH * HEIGHT };

static float good_pixels[PIXELS * 4];
static uint32_t reported, tried;
static double slowest_ms;

/* The picture of a file with values of its sliders. `pixels` is set where there is one. */
static whit_result draw(const whit_shader *shader, const char *sliders, float *pixels)
{
    whit_renderer_params params = params_sized(WIDTH, HEIGHT, shader);
    own_whit_renderer *renderer = NULL;
    own_whit_image *color = NULL;
    params.sliders = sliders;
    whit_result result = whit_renderer_create(device, accel, &params, &renderer);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &color);
    if (result == WHIT_OK)
        memcpy(pixels, whit_image_floats(color), sizeof good_pixels);
    return result;
}

static void draw_good(float *pixels)
{
    own_whit_shader *shader = NULL;
    assert_int_equal(whit_shader_load(compiler, NULL, false, &shader), WHIT_ERROR_USAGE);
    assert_null(shader);
    assert_int_equal(whit_shader_load(compiler, in_folder("good.glsl"), false, &shader), WHIT_OK);
    assert_int_equal(draw(shader, NULL, pixels), WHIT_OK);
}

static int begin(void **state)
{
    if (folder_begin(state) != 0)
        return -1;
    hooks_begin(state);
    scene_open(WHIT_SCENES_DIR "/cube.json");
    put_text("good.glsl", "vec3 post(ivec2 at, vec3 color) { return color.bgr; }\n");
    draw_good(good_pixels);
    reported = tried = 0;
    slowest_ms = 0.0;
    return 0;
}

static int end(void **state)
{
    hooks_end(state);
    return folder_end(state);
}

/* Whether a line of the log names the place, "a.glsl:2:", where it is not NULL, and behind it the
 * reason. */
static bool is_told(const char *place, const char *reason)
{
    char begins[512];
    snprintf(begins, sizeof begins, "%s/%s", folder, place ? place : "");
    const char *line = place ? strstr(messages.text, begins) : messages.text;
    const char *why = line ? strstr(line, reason) : NULL;
    return why && why < strchr(line, '\n');
}

/* Counts and prints a case that began at `start_ms`, and checks that the good file is then drawn as
   before. */
static void count(const char *name, double start_ms, bool as_wanted)
{
    double ms = clock_ms() - start_ms;
    float pixels[PIXELS * 4];
    const char *place = strstr(messages.text, folder);
    const char *told = place              ? place + strlen(folder) + 1
                       : messages.text[0] ? messages.text
                                          : "a picture\n";
    tried++;
    reported += as_wanted;
    slowest_ms = ms > slowest_ms ? ms : slowest_ms;
    print_message("%s %-40s %5.0f ms  %.*s\n", as_wanted ? "ok    " : "FAILED", name, ms,
                  (int)strcspn(told, "\n"), told);
    draw_good(pixels);
    assert_memory_equal(pixels, good_pixels, sizeof pixels);
}

static void all_are_reported(void)
{
    print_message("%u of %u, the slowest after %.0f ms\n", reported, tried, slowest_ms);
    assert_int_equal(reported, tried);
}

/* ---- Files that are refused before drawing ---- */

/* Asserts that the folder's a.glsl is refused, at this place and for this reason. */
static void refuse(const char *name, const char *place, const char *reason)
{
    own_whit_shader *shader = NULL;
    messages = (struct messages){0};
    double start_ms = clock_ms();
    whit_result result = whit_shader_load(compiler, in_folder("a.glsl"), false, &shader);
    count(name, start_ms, result == WHIT_ERROR_INPUT && !shader && is_told(place, reason));
}

static void refuse_repeated(const char *name, const char *before, const char *what, size_t times,
                            const char *behind, const char *place, const char *reason)
{
    FILE *file = fopen(in_folder("a.glsl"), "wb");
    assert_non_null(file);
    fputs(before, file);
    for (size_t i = 0; i < times; ++i)
        fputs(what, file);
    fputs(behind, file);
    assert_int_equal(fclose(file), 0);
    refuse(name, place, reason);
}

#define POST "vec3 post(ivec2 at, vec3 color) {\n"

TEST_IN(texts_that_mean_harm_are_refused, begin, end)
{
    static const struct {
        const char *name, *content, *place, *reason;
    } cases[] = {
        {"recursion", "float f(float x) {\n return f(x); }\n" POST " return color * f(1.0); }\n",
         "a.glsl:1:", "f calls itself"},
        {"an array of 10 GB", POST " float a[2684354560];\n return color * a[at.x]; }\n",
         "a.glsl:2:", "array size"},
        {"an array of 8 GB", POST " float a[2000000000]; a[1] = 1.0;\n return color * a[at.x]; }\n",
         "a.glsl:1:", "variables of more than 16 KiB"},
        {"a global array of 4 MB",
         "\nfloat a[1000000];\n" POST " a[1] = 1.0; return color * a[at.x]; }\n",
         "a.glsl:2:", "variables of more than 16 KiB"},
        {"the index 2^31", POST " float a[4];\n return color * a[2147483648u]; }\n",
         "a.glsl:3:", "out of range"},
        {"discard in a loop of another function",
         "void f() {\n for (int i = 0; i < 2; ++i)\n  if (i == 1) discard;\n}\n" POST
         " f(); return color; }\n",
         "a.glsl:3:", "discard"},
        {"return outside of functions", "return 1;\n" POST " return color; }\n",
         "a.glsl:1:", "'return'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        put_text("a.glsl", cases[i].content);
        refuse(cases[i].name, cases[i].place, cases[i].reason);
    }
    refuse_repeated("10^5 nested brackets", POST " return color * ", "((((((((((\n", 10000,
                    "1.0; }\n", "a.glsl:", "too deep");
    refuse_repeated("10^5 nested blocks", POST, "{{{{{{{{{{\n", 10000, " return color; }\n",
                    "a.glsl:", "too deep");
    refuse_repeated("10^5 nested calls", POST " return color * ", "-(-(-(-(-(\n", 20000, "1.0; }\n",
                    "a.glsl:", "too deep");
    refuse_repeated("10^5 brackets of a condition", "#if ", "((((((((((\\\n", 10000,
                    "\n#endif\n" POST " return color; }\n", "a.glsl", "");
    refuse_repeated("a sum of 10^5 terms", POST " return color", " + color\n", 100000, "; }\n",
                    "a.glsl", "");
    refuse_repeated("a line of 1 MB", POST " return color", " + color", 125000, "; }\n",
                    "a.glsl:2:", "a line of more than 65536 bytes");
    refuse_repeated("a name of 1 MB", "float ", "x", 1000000, ";\n" POST " return color; }\n",
                    "a.glsl:1:", "a line of more than 65536 bytes");
    all_are_reported();
}

/* 2^40 words of macros that double. */
TEST_IN(a_macro_bomb_is_refused, begin, end)
{
    FILE *file = fopen(in_folder("a.glsl"), "wb");
    assert_non_null(file);
    fprintf(file, "#define B0 color + color\n");
    for (int i = 1; i < 40; ++i)
        fprintf(file, "#define B%d B%d + B%d\n", i, i - 1, i - 1);
    fprintf(file, POST " return B39; }\n");
    assert_int_equal(fclose(file), 0);
    refuse("a macro bomb", "a.glsl", "");
    all_are_reported();
}

/* Functions that call the one before twice: 2^40 calls, or for two hooks half of what each may
   have, and a bit. */
TEST_IN(calls_that_double_are_refused, begin, end)
{
    static const struct {
        const char *name, *hooks, *place, *reason;
    } cases[] = {
        {"2^40 calls", POST " return f40(color); }\n", "a.glsl:17:", "'f16' has more than 1048576"},
        {"2^20 calls in one hook", POST " return f14(f14(f14(color))); }\n",
         "a.glsl:42:", "'post' has more than 1048576"},
        {"2^20 calls in two hooks",
         POST " return f14(color); }\nvec3 miss(vec3 dir) { return f14(f14(dir)); }\n", "a.glsl",
         ": all functions together have more than 1048576"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        FILE *file = fopen(in_folder("a.glsl"), "wb");
        assert_non_null(file);
        fprintf(file, "vec3 f0(vec3 c) { return c * c; }\n");
        for (int k = 1; k <= 40; ++k)
            fprintf(file, "vec3 f%d(vec3 c) { return f%d(c) + f%d(c + 1.0); }\n", k, k - 1, k - 1);
        fputs(cases[i].hooks, file);
        assert_int_equal(fclose(file), 0);
        refuse(cases[i].name, cases[i].place, cases[i].reason);
    }
    all_are_reported();
}

/* ---- Files that are drawn ---- */

/* Loads a file whose slider chooses the case, so that its kernels are made only once. */
static whit_shader *load(const char *content)
{
    whit_shader *shader = NULL;
    put_text("a.glsl", content);
    assert_int_equal(whit_shader_load(compiler, in_folder("a.glsl"), false, &shader), WHIT_OK);
    return shader;
}

static void fail_to_draw(const whit_shader *shader, const char *sliders, const char *place,
                         const char *reason)
{
    float pixels[PIXELS * 4];
    messages = (struct messages){0};
    double start_ms = clock_ms();
    whit_result result = draw(shader, sliders, pixels);
    count(sliders, start_ms, result == WHIT_ERROR_STATUS && is_told(place, reason));
}

TEST_IN(loops_without_end_have_no_picture, begin, end)
{
    own_whit_shader *shader =
        load("//@ choice loop none,for,while,do,nested,camera,shade,miss,surface,scatter,aov\n"
             "void camera(vec2 at, inout vec3 origin, inout vec3 dir) {\n"
             " for (; loop == loop_camera;) dir.x += 1.0; }\n"
             "vec3 shade(Surface s, Optics o, vec3 to_eye) {\n"
             " float sum = 0.0; while (loop == loop_shade && sum >= 0.0) sum += 1.0;\n"
             " return vec3(sum); }\n"
             "vec3 miss(vec3 dir) {\n"
             " while (loop == loop_miss) dir += 1e-9; return dir * dir; }\n"
             "vec3 post(ivec2 at, vec3 color) {\n"
             " for (; loop == loop_for;) color.r += 1.0;\n"
             " while (loop == loop_while) color.r += 1.0;\n"
             " do color.r += 1.0; while (loop == loop_do);\n"
             " if (loop == loop_nested) for (int i = 0; i < 1000; ++i)\n"
             "  for (int k = 0; k < 1000; ++k) color.r += 1e-9;\n"
             " return color; }\n"
             "void surface(inout Surface s) {\n"
             " while (loop == loop_surface) s.ns.x += 1e-9; }\n"
             "void scatter(Surface s, Optics o, inout Rays rays) {\n"
             " while (loop == loop_scatter) rays.reflected += 1e-9; }\n"
             "//@ aov high\n"
             "vec4 high(Surface s) {\n"
             " while (loop == loop_aov) s.p.y += 1e-9; return vec4(s.p.y); }\n");
    float pixels[PIXELS * 4];
    assert_int_equal(draw(shader, "loop=none", pixels), WHIT_OK);
    static const struct {
        const char *name, *place;
    } cases[] = {{"for", "a.glsl:10:"},    {"while", "a.glsl:11:"},   {"do", "a.glsl:12:"},
                 {"nested", "a.glsl:14:"}, {"camera", "a.glsl:3:"},   {"shade", "a.glsl:5:"},
                 {"miss", "a.glsl:8:"},    {"surface", "a.glsl:17:"}, {"scatter", "a.glsl:19:"},
                 {"aov", "a.glsl:22:"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        char sliders[32];
        snprintf(sliders, sizeof sliders, "loop=%s", cases[i].name);
        fail_to_draw(shader, sliders, cases[i].place,
                     "`//@ fuel N` gives it more than 10000, up to 30000");
    }
    all_are_reported();
}

/* The driver may end such a loop, with those of the traversals, before its fuel does. */
TEST_IN(loops_that_trace_are_named_too, begin, end)
{
    own_whit_shader *shader = load("//@ fuel 30000\n"
                                   "vec3 shade(Surface s, Optics o, vec3 to_eye) {\n"
                                   " float sum = 1.0;\n"
                                   " while (sum > 0.0)\n"
                                   "  sum += visible(s, s.ns, 1.0).g + visible(s, to_eye, 0.5).g;\n"
                                   " return vec3(sum); }\n");
    fail_to_draw(shader, "", "a.glsl:4", "");
    all_are_reported();
}

TEST_IN(all_of_the_most_fuel_may_be_used, begin, end)
{
    own_whit_shader *shader = load("//@ fuel 30000\n//@ toggle more off\n" POST
                                   " for (int i = 0; i < (more ? 30001 : 29999); ++i)\n"
                                   "  color.r += 1e-9;\n return color; }\n");
    float pixels[PIXELS * 4];
    assert_int_equal(draw(shader, NULL, pixels), WHIT_OK);
    fail_to_draw(shader, "more=on", "a.glsl:4:", "it has the most fuel, 30000; --trust");
    assert_non_null(strstr(messages.text, "all loops in one call of the shader took more"));
    all_are_reported();
}

/* A value that is no finite number ends the picture, unless it is only in an aov. */
TEST_IN(what_is_no_number_has_no_picture, begin, end)
{
    static const char *const hooks[] = {"camera", "surface", "shade", "scatter", "miss", "post"};
    own_whit_shader *shader =
        load("//@ choice where none,camera,surface,shade,scatter,miss,aov,post,division\n"
             "//@ choice what nan,inf\n"
             "//@ slider zero 0 1 0\n"
             "float bad(float x, bool here) {\n"
             " return !here ? x : what == what_nan ? sqrt(-1.0 - x * x) : (1.0 + x * x) * 1e30 * "
             "1e30; }\n"
             "void camera(vec2 at, inout vec3 origin, inout vec3 dir) {\n"
             " dir.x = bad(dir.x, where == where_camera); }\n"
             "void surface(inout Surface s) { s.ns.x = bad(s.ns.x, where == where_surface); }\n"
             "vec3 shade(Surface s, Optics o, vec3 to_eye) {\n"
             " return vec3(bad(s.u, where == where_shade)); }\n"
             "void scatter(Surface s, Optics o, inout Rays r) { if (where == where_scatter) {\n"
             " r.reflected = vec3(1.0); r.reflected_dir = vec3(bad(s.u, true)); } }\n"
             "vec3 miss(vec3 dir) { return vec3(bad(dir.x * dir.x, where == where_miss)); }\n"
             "//@ aov facing\n"
             "vec4 facing(Surface s) { return vec4(bad(s.u, where == where_aov)); }\n"
             "vec3 post(ivec2 at, vec3 color) {\n"
             " if (where == where_division) color = (1.0 + color) / zero;\n"
             " return vec3(bad(color.r, where == where_post)); }\n");
    float usual[PIXELS * 4], pixels[PIXELS * 4];
    assert_int_equal(draw(shader, "where=none", usual), WHIT_OK);
    for (size_t i = 0; i < sizeof hooks / sizeof *hooks; ++i) {
        for (int k = 0; k < 2; ++k) {
            char sliders[64];
            snprintf(sliders, sizeof sliders, "where=%s,what=%s", hooks[i], k ? "inf" : "nan");
            fail_to_draw(shader, sliders, NULL, "a.glsl has functions of this picture");
        }
    }
    fail_to_draw(shader, "where=division", NULL, "not finite: in ");
    messages = (struct messages){0};
    double start_ms = clock_ms();
    bool same =
        draw(shader, "where=aov", pixels) == WHIT_OK && memcmp(usual, pixels, sizeof usual) == 0;
    count("where=aov", start_ms, same && !messages.text[0]);
    all_are_reported();
}

/* Indices out of range and divisions by 0 have defined results, and the picture is drawn. */
TEST_IN(indices_and_divisions_of_integers_have_a_picture, begin, end)
{
    static const struct {
        const char *name;
        float value; /* of all pixels; -1: any that is finite */
    } cases[] = {
        {"first", 1.0f}, {"minus", 4.0f}, {"large", 4.0f}, {"division", -1.0f}, {"early", 5.0f}};
    own_whit_shader *shader = load(
        "//@ choice how first,minus,large,division,early\n"
        "const float table[4] = float[4](1.0, 2.0, 3.0, 4.0);\n" POST
        " if (how == how_early) { for (int i = 0; i < 9; ++i) { if (i == 5) return vec3(i); } }\n"
        " int zero = at.x - at.x;\n"
        " if (how == how_minus) return vec3(table[zero - 1]);\n"
        " if (how == how_large) return vec3(table[uint(zero) + 2147483648u]);\n"
        " if (how == how_division) return vec3(table[7 / zero & 3], table[7 % zero & 3], 0.0);\n"
        " return vec3(table[zero]); }\n");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        float pixels[PIXELS * 4];
        char sliders[32];
        messages = (struct messages){0};
        snprintf(sliders, sizeof sliders, "how=%s", cases[i].name);
        double start_ms = clock_ms();
        bool fine = draw(shader, sliders, pixels) == WHIT_OK;
        for (uint32_t k = 0; fine && k < PIXELS; ++k)
            fine = cases[i].value < 0.0f ? pixels[4 * k] >= 1.0f && pixels[4 * k] <= 4.0f
                                         : pixels[4 * k] == cases[i].value;
        count(sliders, start_ms, fine && !messages.text[0]);
    }
    all_are_reported();
}
