#include "shader/link.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "shader/refuse.h"

struct function {
    uint32_t id; /* in the kernel that is made */
    const uint32_t *words;
    uint32_t count;
    bool reached;
};

struct link {
    struct spv_module base, user; /* what is added stands in base.globals, with ids of base */
    uint32_t *ids;                /* by id of the user's module: of the kernel; 0: none as yet */
    bool *dropped;                /* by id of the base's: of a function that is left out */
    const char **base_names, **user_names; /* by id; NULL: none */
    struct function *functions;
    uint32_t function_count, function_capacity;
    uint32_t *variables; /* that are added */
    uint32_t variable_count, variable_capacity;
    struct spv_words mapped; /* the user's functions */
    const char *why;
};

/* --- what stands where in an instruction ------------------------------------------------------ */

/* The number of words, from the first, that may be ids. */
static uint32_t id_words(uint32_t op, uint32_t length)
{
    static const struct {
        uint16_t op, words;
    } few[] = {{SPV_TYPE_INT, 2},
               {SPV_TYPE_FLOAT, 2},
               {SPV_TYPE_VECTOR, 3},
               {SPV_TYPE_MATRIX, 3},
               {SPV_CONSTANT, 3},
               {SPV_SPEC_CONSTANT, 3},
               {SPV_COMPOSITE_EXTRACT, 4},
               {SPV_COMPOSITE_INSERT, 5},
               {SPV_VECTOR_SHUFFLE, 5},
               {SPV_LOAD, 4},
               {SPV_STORE, 3},
               {SPV_COPY_MEMORY, 3},
               {SPV_ARRAY_LENGTH, 4},
               {SPV_LOOP_MERGE, 3},
               {SPV_SELECTION_MERGE, 2},
               {SPV_BRANCH_CONDITIONAL, 4}};
    for (size_t i = 0; i < sizeof few / sizeof *few; ++i) {
        if (few[i].op == op && few[i].words < length)
            return few[i].words;
    }
    return length;
}

static bool is_id(const uint32_t *words, uint32_t i)
{
    switch (spv_op(words)) {
    case SPV_TYPE_POINTER:
        return i != 2;
    case SPV_VARIABLE:
    case SPV_FUNCTION:
        return i != 3;
    case SPV_EXT_INST:
        return i != 4;
    case SPV_SWITCH: /* numbers of 32 bits before labels */
        return i < 3 || i % 2 == 0;
    default:
        return i < id_words(spv_op(words), spv_length(words));
    }
}

/* --- ids -------------------------------------------------------------------------------------- */

static uint32_t map_id(struct link *l, uint32_t id)
{
    if (id >= l->user.bound) {
        l->why = "the compiler names what there is not";
        return 0;
    }
    if (!l->ids[id])
        l->ids[id] = l->base.next_id++;
    return l->ids[id];
}

static void put_mapped(struct link *l, struct spv_words *to, const uint32_t *words)
{
    uint32_t at = to->count;
    spv_put(&l->base, to, words, spv_length(words));
    for (uint32_t i = 1; !l->base.failed && i < spv_length(words); ++i) {
        if (is_id(words, i))
            to->words[at + i] = map_id(l, words[i]);
    }
}

static const char **read_names(const struct spv_module *m)
{
    const char **names = array_alloc_zeroed(m->bound + (size_t)1, sizeof *names);
    for (size_t at = SPV_HEADER_WORDS; names && at < m->functions_at;
         at += spv_length(m->words + at)) {
        const uint32_t *words = m->words + at;
        if (spv_op(words) == SPV_NAME && spv_length(words) > 2 && words[1] < m->bound &&
            memchr(words + 2, 0, 4 * (size_t)(spv_length(words) - 2)))
            names[words[1]] = (const char *)(words + 2);
    }
    return names;
}

static bool same_name(const char *a, const char *b)
{
    return a && b && strcmp(a, b) == 0;
}

/* --- types, constants, variables -------------------------------------------------------------- */

static bool has_decoration(const struct spv_module *m, uint32_t id)
{
    for (size_t at = SPV_HEADER_WORDS; at < m->functions_at; at += spv_length(m->words + at)) {
        uint32_t op = spv_op(m->words + at);
        if ((op == SPV_DECORATE || op == SPV_MEMBER_DECORATE) && m->words[at + 1] == id)
            return true;
    }
    return false;
}

/* Whether `words` says the same as `asked`, but for the result in word `result`. */
static bool is_same(const uint32_t *words, const uint32_t *asked, uint32_t result)
{
    uint32_t length = spv_length(asked);
    return words[0] == asked[0] && (result == 1 || words[1] == asked[1]) &&
           memcmp(words + result + 1, asked + result + 1, (length - result - 1) * sizeof *words) ==
               0;
}

/* In the kernel, or among what was added; 0: it has none. A record with a layout is another one. */
static uint32_t find_same(const struct link *l, const uint32_t *asked, uint32_t result,
                          const char *name)
{
    const struct spv_module *base = &l->base;
    bool record = spv_op(asked) == SPV_TYPE_STRUCT;
    for (size_t at = SPV_HEADER_WORDS; at < base->functions_at;
         at += spv_length(base->words + at)) {
        const uint32_t *words = base->words + at;
        if (is_same(words, asked, result) &&
            (!record ||
             (same_name(name, l->base_names[words[1]]) && !has_decoration(base, words[1]))))
            return words[result];
    }
    for (uint32_t at = 0; !record && at < base->globals.count;
         at += spv_length(base->globals.words + at)) {
        if (is_same(base->globals.words + at, asked, result))
            return base->globals.words[at + result];
    }
    return 0;
}

/* A type or constant of the user's. What a specialization constant is without one, it stays. */
static void take_value(struct link *l, const uint32_t *words, uint32_t result)
{
    struct spv_words *globals = &l->base.globals;
    uint32_t at = globals->count, id = words[result];
    l->ids[id] = UINT32_MAX;
    put_mapped(l, globals, words);
    if (l->base.failed)
        return;
    uint32_t same = find_same(l, globals->words + at, result, l->user_names[id]);
    /* The instruction that was put finds itself. */
    l->ids[id] = same && same != UINT32_MAX ? same : l->base.next_id++;
    globals->words[at + result] = l->ids[id];
    if (same && same != UINT32_MAX)
        globals->count = at;
}

static void take_variable(struct link *l, const uint32_t *words)
{
    uint32_t own = words[2] == l->user.fuel        ? l->base.fuel
                   : words[2] == l->user.fuel_loop ? l->base.fuel_loop
                                                   : 0;
    if (words[3] != SPV_STORAGE_PRIVATE) {
        l->why = "buffers and shared variables are whit's own";
    } else if (own) {
        l->ids[words[2]] = own;
    } else {
        put_mapped(l, &l->base.globals, words);
        if (!ARRAY_PUSH(l->variables, l->variable_count, l->variable_capacity, l->ids[words[2]]))
            l->base.failed = true;
    }
}

static void take_globals(struct link *l)
{
    const struct spv_module *user = &l->user;
    for (size_t at = SPV_HEADER_WORDS; !l->why && !l->base.failed && at < user->functions_at;
         at += spv_length(user->words + at)) {
        const uint32_t *words = user->words + at;
        uint32_t op = spv_op(words), id = spv_result(user, words);
        if (op == SPV_VARIABLE)
            take_variable(l, words);
        else if (op == SPV_EXT_INST_IMPORT)
            l->ids[id] = l->base.glsl;
        else if (op >= SPV_SPEC_CONSTANT_TRUE && op <= SPV_SPEC_CONSTANT_OP)
            l->why = "specialization constants are whit's own";
        else if (id && !spv_is_remark(op))
            take_value(l, words, id == words[1] && op <= SPV_TYPE_FUNCTION ? 1 : 2);
    }
}

/* --- functions -------------------------------------------------------------------------------- */

static uint32_t function_words(const struct spv_module *m, size_t at)
{
    size_t end = at;
    while (end < m->count && spv_op(m->words + end) != SPV_FUNCTION_END)
        end += spv_length(m->words + end);
    return (uint32_t)((end < m->count ? end + 1 : end) - at);
}

static size_t next_function(const struct spv_module *m, size_t at)
{
    while (at < m->count && spv_op(m->words + at) != SPV_FUNCTION)
        at += spv_length(m->words + at);
    return at;
}

static void add_function(struct link *l, uint32_t id, const uint32_t *words, uint32_t count)
{
    const struct function function = {id, words, count, false};
    if (!ARRAY_PUSH(l->functions, l->function_count, l->function_capacity, function))
        l->base.failed = true;
}

static struct function *find_function(const struct link *l, uint32_t id)
{
    for (uint32_t i = 0; i < l->function_count; ++i) {
        if (l->functions[i].id == id)
            return &l->functions[i];
    }
    return NULL;
}

static uint32_t find_named(const struct link *l, const char *name)
{
    const struct spv_module *base = &l->base;
    for (size_t at = next_function(base, base->functions_at); at < base->count;
         at = next_function(base, at + function_words(base, at))) {
        if (same_name(l->base_names[base->words[at + 2]], name))
            return base->words[at + 2];
    }
    return 0;
}

static bool is_hook(const char *name)
{
    static const char *const hooks[] = {"camera(",    "surface(",  "shade(", "scatter(",
                                        "miss(",      "post(",     "aov(",   "run_test(",
                                        "intersect(", "shape_box("};
    for (size_t i = 0; i < sizeof hooks / sizeof *hooks; ++i) {
        if (strncmp(name, hooks[i], strlen(hooks[i])) == 0)
            return true;
    }
    return false;
}

/* It holds what global variables of the user begin with. */
static bool is_main(const char *name)
{
    return same_name(name, "main") || same_name(name, "main(");
}

/* Where the user's functions go: what the kernel has of whit's is its own. */
static void name_functions(struct link *l)
{
    const struct spv_module *user = &l->user;
    for (size_t at = next_function(user, user->functions_at); at < user->count;
         at = next_function(user, at + function_words(user, at))) {
        const uint32_t *words = user->words + at;
        const char *name = l->user_names[words[2]];
        const char *file = refuse_file(user, words);
        if (is_main(name))
            l->ids[words[2]] = find_named(l, "begin_user(");
        else if (name && (file || is_hook(name)))
            l->ids[words[2]] = find_named(l, name);
        if (!l->ids[words[2]] && (is_main(name) || same_name(file, "hook/interface.glsl")))
            l->why = "what hook/interface.glsl declares is not in the kernel";
    }
}

/* aov(), shape_box() and run_test() are written for the user, in whit's own text. */
static bool is_taken(const struct link *l, const uint32_t *words)
{
    bool own = refuse_file(&l->user, words) != NULL;
    const char *name = l->user_names[words[2]];
    return !own || l->ids[words[2]] == 0 || is_main(name) || (name && is_hook(name));
}

static bool is_long_switch(const struct spv_module *m, const uint32_t *words)
{
    const uint32_t *type = spv_def(m, spv_type_of(m, words[1]));
    return !type || spv_op(type) != SPV_TYPE_INT || type[2] != 32;
}

/* kernel/hook.comp calls everything, so that the compiler looks at it. */
static bool is_call_of_all(const struct link *l, const uint32_t *words)
{
    return spv_op(words) == SPV_FUNCTION_CALL && words[3] < l->user.bound &&
           same_name(l->user_names[words[3]], "call_all(");
}

/* Copies the functions that the kernel is to have besides its own. */
static void map_functions(struct link *l)
{
    const struct spv_module *user = &l->user;
    for (size_t at = next_function(user, user->functions_at); at < user->count;
         at = next_function(user, at)) {
        size_t end = at + function_words(user, at);
        bool taken = is_taken(l, user->words + at);
        for (; at < end && !l->why && !l->base.failed; at += spv_length(user->words + at)) {
            const uint32_t *words = user->words + at;
            if (spv_op(words) == SPV_SWITCH && is_long_switch(user, words))
                l->why = "a switch is over integers of 32 bits";
            else if (taken && !spv_is_remark(spv_op(words)) && !is_call_of_all(l, words))
                put_mapped(l, &l->mapped, words);
        }
        at = end;
    }
}

/* The user's functions, and those of the kernel that have no other in their place. */
static void list_functions(struct link *l)
{
    const struct spv_module *base = &l->base;
    for (uint32_t at = 0, end; at < l->mapped.count; at = end) {
        end = at;
        while (spv_op(l->mapped.words + end) != SPV_FUNCTION_END)
            end += spv_length(l->mapped.words + end);
        end++;
        add_function(l, l->mapped.words[at + 2], l->mapped.words + at, end - at);
    }
    for (size_t at = next_function(base, base->functions_at); at < base->count;
         at = next_function(base, at + function_words(base, at))) {
        const uint32_t *words = base->words + at;
        if (!find_function(l, words[2]))
            add_function(l, words[2], words, function_words(base, at));
    }
}

/* A call goes no deeper than there are functions. */
static void reach(struct link *l, uint32_t id)
{
    struct function *function = find_function(l, id);
    if (!function || function->reached)
        return;
    function->reached = true;
    for (uint32_t at = 0; at < function->count; at += spv_length(function->words + at)) {
        if (spv_op(function->words + at) == SPV_FUNCTION_CALL)
            reach(l, function->words[at + 3]);
    }
}

static void reach_all(struct link *l)
{
    const struct spv_module *base = &l->base;
    for (size_t at = SPV_HEADER_WORDS; at < base->functions_at;
         at += spv_length(base->words + at)) {
        if (spv_op(base->words + at) == SPV_ENTRY_POINT)
            reach(l, base->words[at + 2]);
    }
    for (size_t at = next_function(base, base->functions_at); at < base->count;
         at = next_function(base, at + function_words(base, at))) {
        const struct function *function = find_function(l, base->words[at + 2]);
        uint32_t count = function_words(base, at);
        bool stays = function && function->words == base->words + at && function->reached;
        for (uint32_t i = 0; !stays && i < count; i += spv_length(base->words + at + i)) {
            uint32_t id = spv_result(base, base->words + at + i);
            l->dropped[id] = l->dropped[id] || (id && !(function && function->reached && i == 0));
        }
    }
}

/* --- the kernel ------------------------------------------------------------------------------- */

static bool has_capability(const struct spv_module *m, uint32_t capability)
{
    for (size_t at = SPV_HEADER_WORDS; at < m->functions_at; at += spv_length(m->words + at)) {
        if (spv_op(m->words + at) == SPV_CAPABILITY && m->words[at + 1] == capability)
            return true;
    }
    return false;
}

static void put_capabilities(struct link *l, struct spv_words *out)
{
    const struct spv_module *user = &l->user;
    for (size_t at = SPV_HEADER_WORDS; at < user->functions_at;
         at += spv_length(user->words + at)) {
        const uint32_t *words = user->words + at;
        if (spv_op(words) == SPV_CAPABILITY && !has_capability(&l->base, words[1]))
            spv_put(&l->base, out, words, 2);
    }
}

/* All but functions. Since SPIR-V 1.4 the entry point names all variables. */
static void put_globals(struct link *l, struct spv_words *out)
{
    const struct spv_module *base = &l->base;
    for (size_t at = SPV_HEADER_WORDS; at < base->functions_at;
         at += spv_length(base->words + at)) {
        const uint32_t *words = base->words + at;
        uint32_t op = spv_op(words), length = spv_length(words), first = out->count;
        bool decorates = op == SPV_DECORATE || op == SPV_MEMBER_DECORATE;
        if (spv_is_remark(op) || (decorates && words[1] < base->bound && l->dropped[words[1]]))
            continue;
        spv_put(&l->base, out, words, length);
        if (op != SPV_ENTRY_POINT || l->base.failed)
            continue;
        spv_put(&l->base, out, l->variables, l->variable_count);
        if (!l->base.failed)
            out->words[first] = spv_head(op, length + l->variable_count);
    }
    spv_put(&l->base, out, base->globals.words, base->globals.count);
}

static void put_function(struct link *l, const struct function *function, struct spv_words *out)
{
    for (uint32_t at = 0; at < function->count; at += spv_length(function->words + at)) {
        if (!spv_is_remark(spv_op(function->words + at)))
            spv_put(&l->base, out, function->words + at, spv_length(function->words + at));
    }
}

static struct spv_words write_kernel(struct link *l)
{
    struct spv_words out = {0};
    spv_put(&l->base, &out, l->base.words, SPV_HEADER_WORDS);
    put_capabilities(l, &out);
    put_globals(l, &out);
    for (uint32_t i = 0; i < l->function_count; ++i) {
        if (l->functions[i].reached)
            put_function(l, &l->functions[i], &out);
    }
    if (!l->base.failed)
        out.words[SPV_BOUND_AT] = l->base.next_id;
    return out;
}

static bool begin(struct link *l, const uint32_t *kernel, size_t kernel_words, const uint32_t *user,
                  size_t count, const char *own)
{
    if (!spv_read(&l->base, kernel, kernel_words, own) || !spv_read(&l->user, user, count, own))
        return false;
    l->ids = array_alloc_zeroed(l->user.bound + (size_t)1, sizeof *l->ids);
    l->dropped = array_alloc_zeroed(l->base.bound + (size_t)1, sizeof *l->dropped);
    l->base_names = read_names(&l->base);
    l->user_names = read_names(&l->user);
    return l->ids && l->dropped && l->base_names && l->user_names;
}

static void finish(struct link *l)
{
    free(l->ids);
    free(l->dropped);
    free((void *)l->base_names);
    free((void *)l->user_names);
    free(l->functions);
    free(l->variables);
    free(l->mapped.words);
    spv_finish(&l->base);
    spv_finish(&l->user);
}

struct spv_words link_kernel(const uint32_t *kernel, size_t kernel_words, const uint32_t *user,
                             size_t count, const char *own, const char **why)
{
    struct link l = {0};
    struct spv_words out = {0};
    if (begin(&l, kernel, kernel_words, user, count, own)) {
        take_globals(&l);
        name_functions(&l);
        map_functions(&l);
        if (!l.why && !l.base.failed) {
            list_functions(&l);
            reach_all(&l);
            out = write_kernel(&l);
        }
        if (l.base.failed)
            out.count = 0;
    }
    *why = l.why;
    finish(&l);
    return out;
}
