#include "shader/glslang.h"

#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shader/bounds.h"
#include "shader/exact.h"
#include "shader/expand.h"
#include "shader/fuel.h"
#include "shader/inlining.h"
#include "shader/link.h"
#include "shader/messages.h"
#include "shader/module.h"
#include "shader/portable.h"
#include "shader/reach.h"
#include "shader/refuse.h"
#include "shader/repairs.h"
#include "shader/returns.h"
#include "shader/zeros.h"

struct compilation {
    const struct glslang_question *question;
    struct glslang_answer answer;
    struct fuel fuel;
    struct refuse_variables variables;
    struct reach reach;
    /* Type and id of each variable of the user's current function that must be set to 0 at its
       start. */
    struct spv_words unset;
    struct zeros zeros;
};

static void report(struct compilation *c, struct spv_place place, const char *why)
{
    messages_add(&c->answer, place.file == UINT32_MAX ? 2 : 0, place.file, place.line, why);
}

/* --- GLSL ----------------------------------------------------------------------------------- */

static glslang_input_t input_of(const char *text)
{
    return (glslang_input_t){
        .language = GLSLANG_SOURCE_GLSL,
        .stage = GLSLANG_STAGE_COMPUTE,
        .client = GLSLANG_CLIENT_VULKAN,
        .client_version = GLSLANG_TARGET_VULKAN_1_2,
        .target_language = GLSLANG_TARGET_SPV,
        .target_language_version = GLSLANG_TARGET_SPV_1_5,
        .code = text,
        .default_version = 460,
        .default_profile = GLSLANG_NO_PROFILE,
        /* Report all errors; messages.c keeps the first of each line, since others often follow
           from it. */
        .messages = (glslang_messages_t)(GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT |
                                         GLSLANG_MSG_CASCADING_ERRORS_BIT),
        .resource = glslang_default_resource(),
    };
}

static glslang_program_t *link_program(struct compilation *c, glslang_shader_t *shader)
{
    glslang_program_t *program = glslang_program_create();
    glslang_program_add_shader(program, shader);
    /* Functions that will be linked into a kernel have no caller here yet. */
    int messages = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT |
                   (c->question->base || c->question->names ? GLSLANG_MSG_KEEP_UNCALLED_BIT : 0);
    if (glslang_program_link(program, messages)) {
        glslang_spv_options_t options = {.generate_debug_info = true, .disable_optimizer = true};
        glslang_program_SPIRV_generate_with_options(program, GLSLANG_STAGE_COMPUTE, &options);
        return program;
    }
    messages_take(&c->answer, c->question, glslang_shader_get_preprocessed_code(shader),
                  glslang_program_get_info_log(program));
    glslang_program_delete(program);
    return NULL;
}

/* NULL: there are errors. */
static glslang_program_t *compile_glsl(struct compilation *c)
{
    glslang_input_t input = input_of(c->question->text);
    glslang_shader_t *shader = glslang_shader_create(&input);
    if (shader && glslang_shader_preprocess(shader, &input) && glslang_shader_parse(shader, &input))
        return link_program(c, shader);
    messages_take(&c->answer, c->question, "", shader ? glslang_shader_get_info_log(shader) : "");
    return NULL;
}

void glslang_warm(void)
{
    static const char text[] = "#version 460\n"
                               "layout(local_size_x_id = 0) in;\n"
                               "void main() {}\n";
    const struct glslang_question question = {.text = text, .bytes = sizeof text - 1};
    struct compilation *c = calloc(1, sizeof *c);
    glslang_initialize_process();
    if (!c)
        return;
    c->question = &question;
    glslang_program_t *program = compile_glsl(c);
    if (program)
        glslang_program_delete(program);
    free(c);
}

/* --- SPIR-V --------------------------------------------------------------------------------- */

static bool is_counted(uint32_t op)
{
    return op != OP_LINE && op != OP_NO_LINE && op != OP_LABEL;
}

/* The user's variables begin as 0, so that the same text gives the same bytes. They are set by
   stores in the function, not by initializers: a function in a loop has to set them in each call,
   inlined or not. */
static void begin_variables(struct compilation *c, struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words);
    if (op == OP_VARIABLE && m->user_function && spv_length(words) == 4)
        spv_put(m, &c->unset, words + 1, 2);
    if (op == OP_VARIABLE || op == OP_LINE || op == OP_NO_LINE)
        return;
    for (uint32_t i = 0; i < c->unset.count; i += 2)
        zeros_put(&c->zeros, m, c->unset.words[i], c->unset.words[i + 1]);
    if (c->unset.count)
        zeros_end(&c->zeros, m);
    c->unset.count = 0;
}

/* Keeps the first place of an operation without a portable form; `number`: of portable_lacks. */
static void note_open(struct compilation *c, struct spv_place place, uint32_t number)
{
    uint32_t i = 0;
    while (i < SHADER_OPENS_MAX && c->answer.opens[i].number && c->answer.opens[i].number != number)
        ++i;
    if (number && i < SHADER_OPENS_MAX && !c->answer.opens[i].number)
        c->answer.opens[i] = (struct shader_open){number, place.file, place.line};
}

/* Copies an instruction of a function; in the user's code it is checked first, and gets fuel and
   bounds. */
static void take_instruction(struct compilation *c, struct spv_module *m, const uint32_t *words)
{
    bool user = spv_follow(m, words), taken = false;
    uint32_t op = spv_op(words);
    const char *why = user ? refuse_instruction(m, words) : NULL;
    char called[SHADER_REASON_BYTES];
    if (!why && user && op == OP_VARIABLE)
        why = refuse_variable(&c->variables, m, words);
    if (!why && m->user_function && op == OP_FUNCTION_CALL && refuse_call(m, words, called))
        why = called;
    if (why)
        report(c, m->place, why);
    if (user)
        note_open(c, m->place, portable_lacks(words));
    if (m->user_function)
        c->answer.reaches |= reach_of(&c->reach, m, words);
    begin_variables(c, m, words);
    c->answer.instructions += is_counted(op);
    if (user && !c->question->trust) {
        taken = m->fuel && m->user_function && fuel_take(&c->fuel, m, words);
        if (!taken)
            taken = bounds_take(m, words, &why);
        if (why && !taken)
            report(c, m->place, why);
    }
    taken = taken || zeros_begin(&c->zeros, m, words);
    if (!taken && !repairs_take(m, words))
        spv_put(m, &m->body, words, spv_length(words));
}

/* Checks a global variable. It is taken to be the user's if the user's text has its name. */
static void check_global(struct compilation *c, struct spv_module *m, const uint32_t *name)
{
    const uint32_t *variable = spv_def(m, name[1]);
    if (!variable || spv_op(variable) != OP_VARIABLE || variable[3] != STORAGE_PRIVATE)
        return;
    struct spv_place place = {UINT32_MAX, 0};
    if (!messages_find_word(c->question, (const char *)(name + 2), &place.file, &place.line))
        return;
    const char *why = refuse_variable(&c->variables, m, variable);
    if (why)
        report(c, place, why);
    spv_put(m, &m->zeroed, name + 1, 1);
}

static void check_module(struct compilation *c, struct spv_module *m)
{
    const char *name;
    char why[SHADER_REASON_BYTES];
    if (c->question->user_at == c->question->user_end)
        return;
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        if (spv_op(words) == OP_NAME && spv_length(words) > 2)
            check_global(c, m, words);
    }
    uint32_t capability = refuse_capability(m, &name);
    if (!capability || c->answer.error_count)
        return;
    snprintf(why, sizeof why, "it asks the device for %s (capability %u), which whit does not have",
             name[0] ? name : "something", capability);
    report(c, (struct spv_place){0, 0}, why);
}

static void report_lacking(struct compilation *c, const struct spv_module *m,
                           const uint32_t *function)
{
    const char *name = spv_name(m, function[2]);
    char why[SHADER_REASON_BYTES];
    snprintf(why, sizeof why, "function '%.*s' does not return a value on every path",
             (int)strcspn(name, "("), name);
    report(c, m->place, why);
}

/* Reports a function that is too large. The error names the function if it is the user's; one of
   whit's own, such as the one that calls all tests, stands for the whole file. */
static void report_large(struct compilation *c, const struct spv_module *m,
                         const uint32_t *function)
{
    const char *name = spv_name(m, function[2]);
    struct spv_place place = m->user_function ? m->place : (struct spv_place){0, 0};
    char whose[SHADER_REASON_BYTES / 2] = "all functions together have", why[SHADER_REASON_BYTES];
    if (m->user_function)
        snprintf(whose, sizeof whose, "function '%.*s' has", (int)strcspn(name, "("), name);
    snprintf(why, sizeof why,
             "%s more than %d instructions, if a copy of what it calls stands in the place of each "
             "call",
             whose, INLINING_MAX);
    report(c, place, why);
}

/* Reports functions of the user's whose end can be reached without a result, and one that becomes
   too large by what it calls. */
static void check_functions(struct compilation *c, struct spv_module *m)
{
    const uint32_t *large = inlining_find_large(m);
    for (size_t at = m->functions_at; at < m->count; at += spv_length(m->words + at)) {
        const uint32_t *words = m->words + at;
        spv_follow(m, words);
        if (spv_op(words) == OP_FUNCTION && m->user_function && returns_lacks(m, words))
            report_lacking(c, m, words);
        if (words == large)
            report_large(c, m, words);
    }
}

/* Rewrites returns in the user's functions (returns.h). No words in the result: no memory. */
static struct spv_words rewrite_returns(struct compilation *c, const uint32_t *words, size_t count)
{
    struct spv_module m;
    struct spv_words out = {0};
    if (spv_read(&m, words, count, c->question->own)) {
        check_functions(c, &m);
        out = returns_rewrite(&m);
    }
    if (m.failed)
        out.count = 0;
    spv_finish(&m);
    return out;
}

/* Runs all passes over the module that glslang made. No words in the result: there are errors, or
   no memory. */
static struct spv_words make_module(struct compilation *c, const uint32_t *words, size_t count)
{
    struct spv_module m;
    struct spv_words out = {0}, returned = {0};
    bool has_user = c->question->user_at != c->question->user_end;
    if (has_user) {
        returned = rewrite_returns(c, words, count);
        words = returned.words;
        count = returned.count;
    }
    bool whole = spv_read(&m, words, count, c->question->own);
    if (whole && has_user)
        reach_begin(&c->reach, &m);
    for (size_t at = m.functions_at; whole && at < count; at += spv_length(words + at))
        take_instruction(c, &m, words + at);
    if (whole)
        check_module(c, &m);
    else
        report(c, (struct spv_place){UINT32_MAX, 0}, "glslang wrote a module that cannot be read");
    if (whole && !c->answer.error_count)
        out = spv_write(&m, c->question->base || c->question->names);
    if (m.failed)
        out.count = 0;
    spv_finish(&m);
    free(returned.words);
    return out;
}

static int write_answer(struct compilation *c, const uint32_t *words, size_t count, void *to,
                        child_write write)
{
    c->answer.word_count = count;
    c->answer.loop_count = count ? c->fuel.count : 0;
    bool written = write(to, &c->answer, sizeof c->answer) &&
                   write(to, words, count * sizeof *words) &&
                   write(to, c->fuel.loops, c->answer.loop_count * sizeof *c->fuel.loops);
    return written ? 0 : 1;
}

/* Links the user's functions into the base kernel. No words in the result: there are errors, or no
   memory. */
static struct spv_words link_module(struct compilation *c, const struct spv_words *user)
{
    const char *why = NULL;
    struct spv_words out = link_kernel(c->question->base, c->question->base_words, user->words,
                                       user->count, c->question->own, &why);
    if (why)
        report(c, (struct spv_place){UINT32_MAX, 0}, why);
    c->answer.instructions = 0;
    bool functions = false;
    for (uint32_t at = SPV_HEADER_WORDS; at < out.count; at += spv_length(out.words + at)) {
        functions = functions || spv_op(out.words + at) == OP_FUNCTION;
        c->answer.instructions += functions && is_counted(spv_op(out.words + at));
    }
    return out;
}

static int finish_module(struct compilation *c, glslang_program_t *program, void *to,
                         child_write write)
{
    size_t count = 0;
    uint32_t *exact = NULL;
    struct spv_words made = make_module(c, glslang_program_SPIRV_get_ptr(program),
                                        glslang_program_SPIRV_get_size(program));
    if (made.count && c->question->base)
        made = link_module(c, &made);
    enum shader_exact end = EXACT_NO_MEMORY;
    if (made.count)
        end = shader_exact(made.words, made.count, &exact, &count);
    if (end != EXACT_DONE && !c->answer.error_count)
        return CHILD_EXIT_MEMORY;
    return write_answer(c, exact, count, to, write);
}

int glslang_answer_question(void *user, void *to, child_write write)
{
    struct compilation *c = calloc(1, sizeof *c);
    if (!c)
        return CHILD_EXIT_MEMORY;
    c->question = user;
    glslang_initialize_process();
    glslang_program_t *program = compile_glsl(c);
    /* Nothing is given back: the process ends. */
    return program ? finish_module(c, program, to, write) : write_answer(c, NULL, 0, to, write);
}
