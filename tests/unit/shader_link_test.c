/* Linking functions of users into whit's kernels gives valid modules, in which the user's functions
   are in the place of whit's. */
#include "shader/program.h"
#include "shader_fixture.h"

/* Makes a shader; NULL: it is refused, with the reasons in `errors`. */
static whit_shader *make(const char *content)
{
    const struct shader_text_source source = {"a.glsl", content, strlen(content)};
    struct shader_text text;
    whit_shader *shader = NULL;
    errors = (struct shader_errors){0};
    whit_result result = shader_text_from(NULL, &source, 1, &text, &errors);
    if (result == WHIT_OK)
        result = shader_program_create(NULL, compiler, &text, NULL, false, &shader, &errors);
    assert_true((result == WHIT_OK) == (shader != NULL));
    return shader;
}

static uint32_t count_functions(const struct shader_code *code)
{
    uint32_t count = 0;
    for (size_t at = SPV_HEADER_WORDS; at < code->bytes / 4; at += spv_length(code->words + at))
        count += spv_op(code->words + at) == OP_FUNCTION;
    return count;
}

#define KERNEL(name) (1u << HOOK_KERNEL_##name)

TEST_IN(kernels_with_functions_of_users_are_valid, compiler_begin, compiler_end)
{
    static const struct {
        const char *content;
        uint32_t kernels;
    } cases[] = {
        {"void camera(vec2 at, inout vec3 origin, inout vec3 dir) { dir.x += at.y; }\n",
         KERNEL(CLOSEST) | KERNEL(SHADE) | KERNEL(SHADOW)},
        {"void surface(inout Surface s) { s.ns = normalize(s.ns + sin(s.p)); }\n", KERNEL(HIT)},
        {"vec3 shade(Surface s, Optics o, vec3 e) { return whit_shade(s, o, e) + shade(s, o, e, 1);"
         " }\nvec3 shade(Surface s, Optics o, vec3 e, int n) { return vec3(n); }\n",
         0}, /* used before it is declared */
        {"vec3 shade(Surface s, Optics o, vec3 e, int n) { return vec3(n); }\n"
         "vec3 shade(Surface s, Optics o, vec3 e) { return shade(s, o, e, 2); }\n",
         KERNEL(HIT)},
        {"void scatter(Surface s, Optics o, inout Rays r) { whit_scatter(s, o, r); r.reflected *= "
         "random(1u); }\n",
         KERNEL(SHADE)},
        {"float k = 3.0; float a[4] = float[4](1.0, 2.0, 3.0, 4.0); const vec2 c[2] = vec2[2]("
         "vec2(1.0), vec2(2.0));\n"
         "vec3 miss(vec3 d) { k += 1.0; return vec3(k, a[int(d.x * 4.0)], c[int(d.y)].x); }\n",
         KERNEL(MISS)},
        {"struct Hit { vec3 a; float b[3]; }; struct Own { Hit h; mat3 m; };\n"
         "Own traverse(vec3 v) { Own o; o.h.a = v; o.m = mat3(v, v, v); return o; }\n"
         "vec3 miss(vec3 d) { Own o = traverse(d); return o.m * o.h.a; }\n",
         KERNEL(MISS)},
        {"//@ aov value\nvec4 value(Surface s) { Surface m; float d;\n"
         "return vec4(visible(s, s.ns, 1.0), trace(s.p, s.ng, m, d) ? d : s.u); }\n"
         "//@ aov s\nvec4 s(Surface at) { return vec4(at.u); }\n",
         KERNEL(AOV)},
        {"//@ box 0 0 0 1 1 1 0.1\nbool intersect(vec3 o, vec3 d, float far, out float t, out vec3 "
         "n) "
         "{ t = 0.5; n = o; return far > t; }\n",
         KERNEL(SHAPE)},
        {"vec3 post(ivec2 at, vec3 c) { switch (at.x & 3) { case 0: c.r = 1.0; break; case 1: "
         "return c.bgr; default: c.g = 0.0; } return c; }\n",
         KERNEL(POST)},
        {"vec3 post(ivec2 at, vec3 c) { uint64_t n = uint64_t(at.x) << 33; return c * float(n >> "
         "33); }\n",
         KERNEL(POST)},
        {"//@ slider x 0 1 0.5\n//@ color y #ff0000\n//@ toggle z on\n"
         "bool whole(out float f, in bvec2 b) { f = x; return any(b); }\n"
         "vec3 post(ivec2 at, vec3 c) { float f; return whole(f, bvec2(z, false)) ? y * f : c; }\n",
         KERNEL(POST)},
        {"vec3 shade(Surface s, Optics o, vec3 e) { Surface m; float d; vec3 sum = vec3(0.0);\n"
         "for (uint i = 0u; i < light_count(); i++) { Light l = light(i, 0u, s); sum += l.arriving "
         "* visible(s, l.dir, l.distance); }\n"
         "if (trace(off_surface(s, s.ng), s.ng, m, d)) sum += m.color; return sum; }\n",
         KERNEL(HIT)},
        {"void call_all() {}\nvec3 miss(vec3 d) { call_all(); return d; }\n", KERNEL(MISS)},
        {"float begin_user(float x) { return x; }\nfloat main_(float x) { return x; }\n"
         "vec3 post(ivec2 at, vec3 c) { return c * begin_user(main_(1.0)); }\n",
         KERNEL(POST)},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        whit_shader *shader = make(cases[i].content);
        uint32_t made = 0;
        for (uint32_t k = 0; shader && k < HOOK_KERNEL_COUNT; ++k) {
            if (!shader->codes[k].words)
                continue;
            made |= 1u << k;
            assert_valid(&shader->codes[k]);
        }
        if (made != cases[i].kernels)
            fail_msg("kernels %u of %s: %s", made, cases[i].content,
                     errors.count ? errors.items[0].reason : "no error");
        shader_program_destroy(shader);
    }
}

/* Functions of whit's or of the user that nothing calls are not part of a kernel. */
TEST_IN(kernels_have_what_is_called_alone, compiler_begin, compiler_end)
{
    whit_shader *plain = make("vec3 post(ivec2 at, vec3 c) { return c; }\n");
    whit_shader *more = make("float f(float x) { return x; }\nfloat g(float x) { return f(x); }\n"
                             "vec3 post(ivec2 at, vec3 c) { return c * g(c.x); }\n"
                             "float h(float x) { return f(x); }\n");
    const struct shader_code *a = &plain->codes[HOOK_KERNEL_POST];
    const struct shader_code *b = &more->codes[HOOK_KERNEL_POST];
    assert_int_equal(count_functions(b), count_functions(a) + 2);
    shader_program_destroy(plain);
    shader_program_destroy(more);
}

TEST_IN(what_is_whits_own_is_refused, compiler_begin, compiler_end)
{
    static const struct {
        const char *content, *why;
    } cases[] = {
        {"vec3 post(ivec2 at, vec3 c) { return c * frame.bailout; }\n", "frame"},
        {"vec3 post(ivec2 at, float c) { return vec3(c); }\n",
         "post has other parameters than whit's own: `whit shader new post` prints it"},
        {"vec3 miss(const vec3 dir) { return dir; }\n", "parameters of whit's functions are"},
        {"#ifdef NOPE\nvec3 shade(Surface s, Optics o, vec3 e) { return e; }\n#endif\n"
         "vec3 post(ivec2 at, vec3 c) { return c; }\n",
         "the preprocessor leaves no function shade"},
        {"#define post mine\nvec3 post(ivec2 at, vec3 c) { return c; }\n",
         "the preprocessor leaves no function post"},
        {"#define TRACES 1\nvec3 post(ivec2 at, vec3 c) { return c; }\n",
         "'TRACES' is a name of whit's"},
        {"#define HAS_POST 1\nvec3 post(ivec2 at, vec3 c) { return c; }\n",
         "'HAS_POST' is a name of whit's"},
        {"#define M 1\n#define M 2\nvec3 post(ivec2 at, vec3 c) { return c; }\n",
         "Macro redefined"},
        {"vec3 post(ivec2 at, vec3 c) { int64_t n = at.x; switch (n) { case 0: return c; } return "
         "c * 2.0; }\n",
         ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        whit_shader *shader = make(cases[i].content);
        if (shader || errors.count == 0 || !strstr(errors.items[0].reason, cases[i].why))
            fail_msg("%s: %s", cases[i].content, errors.count ? errors.items[0].reason : "taken");
    }
}

/* Braces and brackets without their other one hide functions from what looks for them. */
TEST_IN(hidden_functions_are_told_by_the_compiler, compiler_begin, compiler_end)
{
    static const char none[] = "has none of the functions camera";
    static const struct {
        const char *content;
        uint32_t line, column;
        const char *why;
    } cases[] = {
        {"float f(float x)\n{\n return x;\n\nvec3 post(ivec2 at, vec3 c)\n{\n return c;\n}\n", 2, 1,
         "a brace without its other one"},
        {"\nvec3 post(ivec2 at, vec3 c\n{\n return c;\n}\n", 3, 1, "unexpected '{'"},
        {"vec3 post(ivec2 at, vec3 c)\n return c;\n}\n", 2, 2, "unexpected 'return'"},
        {"\nconst float K = (2.0;\nvec3 post(ivec2 at, vec3 c) { return K * c; }\n", 2, 21,
         "unexpected ';'"},
        {"//@ box 0 0 0 1 1 1 0.01\nbool intersect(vec3 o, vec3 d, float far, out float t, out "
         "vec3 "
         "n\n{\n return false; }\n",
         3, 1, "unexpected '{'"},
        {"\nvec3 post(ivec2 at, vec3 c);\nfloat f() { return 1.0; }\n", 2, 0,
         "post is called and has no body"},
        {"", 0, 0, none},
        {"// nothing\n/* at all */\nconst float x = 1.0;\n", 0, 0, none},
        {"float f();\nstruct S { float x; };\n", 0, 0, none},
        {"float f() { return 1.0; }\n", 0, 0, none},
        {"#define M miss\nvec3 M(vec3 dir) { return dir; }\n", 0, 0, none},
        {"float f(float shade) { float post = (shade); return post; }\n", 0, 0, none},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        whit_shader *shader = make(cases[i].content);
        const struct shader_error *error = &errors.items[0];
        if (shader || errors.count == 0 || error->line != cases[i].line ||
            error->column != cases[i].column || !strstr(error->reason, cases[i].why))
            fail_msg("%s: %s:%u:%u: %s", cases[i].content, error->file, error->line, error->column,
                     errors.count ? error->reason : "taken");
    }
}
