#include "shader/portable.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "kernels.h"
#include "shader/exact.h"
#include "shader/graft.h"

enum { NAME_BYTES = 96 };

struct portable {
    const struct portable_params *params;
    struct graft g;   /* base: the kernel; user: the module of portable functions */
    bool *replaced;   /* by id of the kernel: whether its instruction has become a call */
    uint32_t *wanted; /* ids of functions to copy, in g.user */
    uint32_t wanted_count, wanted_capacity;
    char *why;
};

/* --- what is left to the driver ----------------------------------------------------------------
 */

/* On which devices an operation stays in the kernel: on none; where division is rounded correctly;
   where comparisons distinguish denormals from 0. */
enum stays { NOWHERE, RIGHT_DIVISION, RIGHT_COMPARISON };

struct stand_in {
    uint16_t number;
    enum stays stays;
    const char *function; /* name without "portable_"; NULL: there is none */
    const char *name;     /* name in messages; NULL: `function` */
};

/* By opcode (SPIR-V 1.5, 3.32): operations whose results are open by "Precision and Operation of
   SPIR-V Instructions" of Vulkan 1.2. All others that kernels may have are exact, or rounded
   correctly. */
static const struct stand_in operations[] = {
    {109, NOWHERE, "uint", NULL},
    {110, NOWHERE, "int", NULL},
    {115, NOWHERE, NULL, "OpFConvert"},
    {116, NOWHERE, NULL, "OpQuantizeToF16"},
    {136, RIGHT_DIVISION, "divide", NULL},
    {140, NOWHERE, NULL, "OpFRem"},
    {141, NOWHERE, "mod", NULL},
    {144, NOWHERE, "times", NULL},
    {145, NOWHERE, "times", NULL},
    {146, NOWHERE, "times", NULL},
    {148, NOWHERE, "dot", NULL},
    {156, NOWHERE, "isnan", NULL},
    {157, NOWHERE, "isinf", NULL},
    {180, RIGHT_COMPARISON, "equal", NULL},
    {183, RIGHT_COMPARISON, "unequal", NULL},
    {184, RIGHT_COMPARISON, "less", NULL},
    {186, RIGHT_COMPARISON, "more", NULL},
    {188, RIGHT_COMPARISON, "at_most", NULL},
    {190, RIGHT_COMPARISON, "at_least", NULL},
};

/* Likewise, by instruction number of GLSL.std.450. Those that are not listed are exact: RoundEven,
   Trunc, SAbs, SSign, Floor, Ceil, UMin, SMin, UMax, SMax, UClamp, SClamp, FindILsb, FindSMsb,
   FindUMsb. */
static const struct stand_in instructions[] = {
    {1, NOWHERE, "round", NULL},
    {4, RIGHT_COMPARISON, "abs", NULL},
    {6, NOWHERE, "sign", NULL},
    {10, NOWHERE, "fract", NULL},
    {11, NOWHERE, "radians", NULL},
    {12, NOWHERE, "degrees", NULL},
    {13, NOWHERE, "sin", NULL},
    {14, NOWHERE, "cos", NULL},
    {15, NOWHERE, "tan", NULL},
    {16, NOWHERE, "asin", NULL},
    {17, NOWHERE, "acos", NULL},
    {18, NOWHERE, "atan", NULL},
    {19, NOWHERE, NULL, "sinh"},
    {20, NOWHERE, NULL, "cosh"},
    {21, NOWHERE, NULL, "tanh"},
    {22, NOWHERE, NULL, "asinh"},
    {23, NOWHERE, NULL, "acosh"},
    {24, NOWHERE, NULL, "atanh"},
    {25, NOWHERE, "atan", NULL},
    {26, NOWHERE, "pow", NULL},
    {27, NOWHERE, "exp", NULL},
    {28, NOWHERE, "log", NULL},
    {29, NOWHERE, "exp2", NULL},
    {30, NOWHERE, "log2", NULL},
    {31, RIGHT_DIVISION, "sqrt", NULL},
    {32, NOWHERE, "inversesqrt", NULL},
    {33, NOWHERE, NULL, "determinant"},
    {34, NOWHERE, NULL, "inverse"},
    {36, NOWHERE, NULL, "modf"},
    {37, NOWHERE, "min", NULL},
    {40, NOWHERE, "max", NULL},
    {43, NOWHERE, "clamp", NULL},
    {46, NOWHERE, "mix", NULL},
    {48, RIGHT_COMPARISON, "step", NULL},
    {49, NOWHERE, "smoothstep", NULL},
    {50, NOWHERE, "fma", NULL},
    {51, NOWHERE, NULL, "frexp"},
    {52, NOWHERE, NULL, "frexp"},
    {53, NOWHERE, NULL, "ldexp"},
    {54, NOWHERE, NULL, "packSnorm4x8"},
    {55, NOWHERE, NULL, "packUnorm4x8"},
    {56, NOWHERE, NULL, "packSnorm2x16"},
    {57, NOWHERE, NULL, "packUnorm2x16"},
    {58, NOWHERE, NULL, "packHalf2x16"},
    {59, NOWHERE, NULL, "packDouble2x32"},
    {60, NOWHERE, NULL, "unpackSnorm2x16"},
    {61, NOWHERE, "unpackUnorm2x16", NULL},
    {62, NOWHERE, NULL, "unpackHalf2x16"},
    {63, NOWHERE, NULL, "unpackSnorm4x8"},
    {64, NOWHERE, "unpackUnorm4x8", NULL},
    {65, NOWHERE, NULL, "unpackDouble2x32"},
    {66, NOWHERE, "length", NULL},
    {67, NOWHERE, "distance", NULL},
    {68, NOWHERE, "cross", NULL},
    {69, NOWHERE, "normalize", NULL},
    {70, NOWHERE, "faceforward", NULL},
    {71, NOWHERE, "reflect", NULL},
    {72, NOWHERE, "refract", NULL},
    {76, NOWHERE, NULL, "interpolateAtCentroid"},
    {77, NOWHERE, NULL, "interpolateAtSample"},
    {78, NOWHERE, NULL, "interpolateAtOffset"},
    {79, NOWHERE, NULL, "NMin"},
    {80, NOWHERE, NULL, "NMax"},
    {81, NOWHERE, NULL, "NClamp"},
};

static const struct stand_in *find_stand_in(const uint32_t *words)
{
    bool extended = spv_op(words) == OP_EXT_INST && spv_length(words) > 4;
    const struct stand_in *rows = extended ? instructions : operations;
    size_t count = extended ? sizeof instructions / sizeof *instructions
                            : sizeof operations / sizeof *operations;
    uint32_t number = extended ? words[4] : spv_op(words);
    for (size_t i = 0; i < count; ++i) {
        if (rows[i].number == number)
            return &rows[i];
    }
    return NULL;
}

uint32_t portable_lacks(const uint32_t *words)
{
    const struct stand_in *row = find_stand_in(words);
    return !row || row->function ? 0 : spv_op(words) << 16 | row->number;
}

/* Writes a reason such as "none.glsl:7: determinant has no portable form". */
static void refuse(struct portable *p, const struct stand_in *row, const uint32_t *words)
{
    const whit_shader *shader = p->params->shader;
    const char *file = shader && shader->file_count ? shader->files[0] : NULL;
    uint32_t line = 0;
    char number[16] = "";
    if (shader && shader_find_open(shader, portable_lacks(words), &file, &line))
        snprintf(number, sizeof number, ":%u", line);
    snprintf(p->why, PORTABLE_WHY_BYTES, "%.100s%s%s%s has no portable form", file ? file : "",
             number, file ? ": " : "", row->name ? row->name : row->function);
}

/* --- names -------------------------------------------------------------------------------------
 */

/* Appends a type as glslang writes types of arguments in names of functions: "vf3;" for vec3. */
static void append_type(const struct spv_module *m, uint32_t type, char *name)
{
    const uint32_t *def = spv_def(m, type), *row;
    size_t used = strlen(name);
    char letter = 'f', *at = name + used;
    size_t room = NAME_BYTES - used;
    if (!def)
        return;
    if (spv_op(def) == OP_TYPE_MATRIX) {
        row = spv_def(m, def[2]);
        snprintf(at, room, "mf%u%u;", def[3], row ? row[3] : 0);
        return;
    }
    row = spv_op(def) == OP_TYPE_VECTOR ? spv_def(m, def[2]) : def;
    if (row && spv_op(row) == OP_TYPE_INT)
        letter = row[3] ? 'i' : 'u';
    if (row != def)
        snprintf(at, room, "v%c%u;", letter, def[3]);
    else
        snprintf(at, room, "%c1;", letter);
}

/* The id in g.user of the portable function for an instruction; 0: there is none. */
static uint32_t find_function(const struct portable *p, const struct stand_in *row,
                              const uint32_t *words)
{
    const struct spv_module *user = &p->g.user;
    char name[NAME_BYTES];
    snprintf(name, sizeof name, "portable_%s(", row->function);
    for (uint32_t i = spv_op(words) == OP_EXT_INST ? 5 : 3; i < spv_length(words); ++i)
        append_type(&p->g.base, spv_type_of(&p->g.base, words[i]), name);
    for (const uint32_t *function = spv_next_function(user, NULL); function;
         function = spv_next_function(user, function)) {
        if (graft_same_name(p->g.user_names[function[2]], name))
            return function[2];
    }
    return 0;
}

/* --- functions that are called for -------------------------------------------------------------
 */

static void want(struct portable *p, uint32_t function)
{
    for (uint32_t i = 0; i < p->wanted_count; ++i) {
        if (p->wanted[i] == function)
            return;
    }
    if (!ARRAY_PUSH(p->wanted, p->wanted_count, p->wanted_capacity, function))
        p->g.base.failed = true;
}

static uint32_t spec_id(const struct spv_module *m, uint32_t id)
{
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        if (spv_op(words) == OP_DECORATE && words[1] == id && words[2] == DECORATION_SPEC_ID)
            return words[3];
    }
    return UINT32_MAX;
}

/* Fixes the specialization constant OWN_DIVISION (id 0) or OWN_COMPARISON at its value for the
   device. */
static void take_switch(struct portable *p, const uint32_t *words)
{
    struct spv_module *base = &p->g.base;
    bool own =
        spec_id(&p->g.user, words[2]) == 0 ? p->params->own_division : p->params->own_comparison;
    uint32_t op = own ? OP_CONSTANT_TRUE : OP_CONSTANT_FALSE;
    const uint32_t constant[] = {spv_head(op, 3), p->g.ids[words[1]], graft_id(&p->g, words[2])};
    spv_put(base, &base->globals, constant, 3);
}

/* Copies a type or constant, after those that it refers to. */
static void take_global(struct portable *p, uint32_t id)
{
    const uint32_t *words = spv_def(&p->g.user, id);
    if (!words || p->g.ids[id])
        return;
    uint32_t op = spv_op(words);
    bool is_type = op >= OP_TYPE_VOID && op <= OP_TYPE_FUNCTION;
    if (op == OP_EXT_INST_IMPORT) {
        p->g.ids[id] = p->g.base.glsl;
        return;
    }
    for (uint32_t i = is_type ? 2 : 1; i < spv_length(words); ++i) {
        if (spv_is_id(words, i) && words[i] != id)
            take_global(p, words[i]);
    }
    if (op == OP_SPEC_CONSTANT_TRUE)
        take_switch(p, words);
    else
        graft_value(&p->g, words, is_type ? 1 : 2);
}

static void take_instruction(struct portable *p, const uint32_t *words)
{
    const struct spv_module *user = &p->g.user;
    for (uint32_t i = 1; i < spv_length(words); ++i) {
        const uint32_t *def = spv_is_id(words, i) ? spv_def(user, words[i]) : NULL;
        if (def && def < user->words + user->functions_at)
            take_global(p, words[i]);
    }
    if (spv_op(words) == OP_FUNCTION_CALL)
        want(p, words[3]);
    if (!spv_is_remark(spv_op(words)))
        graft_put(&p->g, &p->g.base.body, words);
}

/* Copies the functions that the kernel calls, and those that they call. */
static void take_functions(struct portable *p)
{
    const struct spv_module *user = &p->g.user;
    for (uint32_t i = 0; i < p->wanted_count && !p->g.base.failed; ++i) {
        const uint32_t *words = spv_def(user, p->wanted[i]);
        const uint32_t *end = words + spv_function_words(user, words);
        for (; words < end && !p->g.base.failed; words += spv_length(words))
            take_instruction(p, words);
    }
}

/* --- the kernel --------------------------------------------------------------------------------
 */

/* Replaces an instruction by a call of its portable function. */
static bool replace(struct portable *p, const struct stand_in *row, const uint32_t *words)
{
    struct spv_module *base = &p->g.base;
    uint32_t first = spv_op(words) == OP_EXT_INST ? 5 : 3, count = spv_length(words) - first;
    uint32_t function = row->function ? find_function(p, row, words) : 0;
    if (!function) {
        refuse(p, row, words);
        return false;
    }
    want(p, function);
    const uint32_t head[] = {spv_head(OP_FUNCTION_CALL, 4 + count), words[1], words[2],
                             graft_id(&p->g, function)};
    spv_put(base, &base->body, head, 4);
    spv_put(base, &base->body, words + first, count);
    p->replaced[words[2]] = true;
    return true;
}

static bool stays(const struct portable_params *params, const struct stand_in *row)
{
    return (row->stays == RIGHT_DIVISION && params->own_division) ||
           (row->stays == RIGHT_COMPARISON && params->own_comparison);
}

static bool replace_all(struct portable *p)
{
    struct spv_module *base = &p->g.base;
    for (size_t at = base->functions_at; at < base->count; at += spv_length(base->words + at)) {
        const uint32_t *words = base->words + at;
        const struct stand_in *row = find_stand_in(words);
        if (row && !stays(p->params, row)) {
            if (!replace(p, row, words))
                return false;
        } else if (!spv_is_remark(spv_op(words))) {
            spv_put(base, &base->body, words, spv_length(words));
        }
    }
    return true;
}

/* Puts the float controls for 32-bit floats that are asked for (SPIR-V 1.4): their capabilities,
   or, with an entry point, its execution modes. */
static void put_controls(struct portable *p, struct spv_words *out, uint32_t entry)
{
    const struct portable_params *params = p->params;
    const struct {
        bool asked;
        uint32_t capability, mode;
    } controls[] = {{params->asks_denormals, 4464, 4459},
                    {params->asks_special, 4466, 4461},
                    {params->asks_nearest, 4467, 4462}};
    for (size_t i = 0; i < sizeof controls / sizeof *controls; ++i) {
        const uint32_t capability[] = {spv_head(OP_CAPABILITY, 2), controls[i].capability};
        const uint32_t mode[] = {spv_head(OP_EXECUTION_MODE, 4), entry, controls[i].mode, 32};
        if (controls[i].asked)
            spv_put(&p->g.base, out, entry ? mode : capability, entry ? 4 : 2);
    }
}

static struct spv_words write_module(struct portable *p)
{
    struct spv_module *base = &p->g.base;
    struct spv_words out = {0};
    spv_put(base, &out, base->words, SPV_HEADER_WORDS);
    put_controls(p, &out, 0);
    for (const uint32_t *words = spv_step(base, NULL); words; words = spv_step(base, words)) {
        bool decorates = spv_op(words) == OP_DECORATE && words[1] < base->bound;
        if (spv_is_remark(spv_op(words)) || (decorates && p->replaced[words[1]]))
            continue;
        spv_put(base, &out, words, spv_length(words));
        if (spv_op(words) == OP_ENTRY_POINT)
            put_controls(p, &out, words[2]);
    }
    spv_put(base, &out, base->globals.words, base->globals.count);
    spv_put(base, &out, base->body.words, base->body.count);
    if (!base->failed)
        out.words[SPV_BOUND_AT] = base->next_id;
    return out;
}

/* Result without words: no memory, or the reason is in p->why. */
static struct spv_words make(struct portable *p, const uint32_t *words, size_t word_count)
{
    struct spv_words out = {0};
    if (!graft_begin(&p->g, words, word_count, portable_kernel.words,
                     portable_kernel.bytes / sizeof *words, "")) {
        snprintf(p->why, PORTABLE_WHY_BYTES, "it is no kernel, or there is no memory for it");
        return out;
    }
    p->replaced = array_alloc_zeroed(p->g.base.bound + (size_t)1, sizeof *p->replaced);
    if (p->replaced && replace_all(p)) {
        take_functions(p);
        out = write_module(p);
    }
    if (p->g.base.failed) {
        free(out.words);
        out = (struct spv_words){0};
    }
    return out;
}

whit_result shader_make_portable(const struct portable_params *params, const uint32_t *words,
                                 size_t word_count, uint32_t **out, size_t *out_words,
                                 char why[PORTABLE_WHY_BYTES])
{
    struct portable p = {.params = params, .why = why};
    why[0] = '\0';
    *out = NULL;
    struct spv_words made = make(&p, words, word_count);
    enum shader_exact end =
        made.words ? shader_exact(made.words, made.count, out, out_words) : EXACT_NO_MEMORY;
    free(made.words);
    free(p.replaced);
    free(p.wanted);
    graft_finish(&p.g);
    return end == EXACT_DONE ? WHIT_OK : why[0] ? WHIT_ERROR_INPUT : WHIT_ERROR_MEMORY;
}
