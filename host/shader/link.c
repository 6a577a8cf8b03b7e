#include "shader/link.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "shader/graft.h"
#include "shader/refuse.h"
#include "whit/whit_shader.h"

struct function {
    uint32_t id; /* id in the linked kernel */
    const uint32_t *words;
    uint32_t count;
    bool reached;
};

struct link {
    struct graft g;
    bool *dropped; /* by id of the kernel: whether it belongs to a function that is left out */
    struct function *functions;
    uint32_t function_count, function_capacity;
    uint32_t *variables; /* ids of added variables */
    uint32_t variable_count, variable_capacity;
    struct spv_words mapped; /* the user's functions, with ids of the kernel */
};

/* --- types, constants, variables -------------------------------------------------------------- */

static void take_variable(struct link *l, const uint32_t *words)
{
    uint32_t own = words[2] == l->g.user.fuel        ? l->g.base.fuel
                   : words[2] == l->g.user.fuel_loop ? l->g.base.fuel_loop
                                                     : 0;
    if (words[3] != STORAGE_PRIVATE) {
        l->g.why = "buffers and shared variables are whit's own";
    } else if (own) {
        l->g.ids[words[2]] = own;
    } else {
        graft_put(&l->g, &l->g.base.globals, words);
        if (!ARRAY_PUSH(l->variables, l->variable_count, l->variable_capacity, l->g.ids[words[2]]))
            l->g.base.failed = true;
    }
}

static void take_globals(struct link *l)
{
    const struct spv_module *user = &l->g.user;
    for (const uint32_t *words = spv_step(user, NULL); words && !l->g.why && !l->g.base.failed;
         words = spv_step(user, words)) {
        uint32_t op = spv_op(words), id = spv_result(user, words);
        if (op == OP_VARIABLE)
            take_variable(l, words);
        else if (op == OP_EXT_INST_IMPORT)
            l->g.ids[id] = l->g.base.glsl;
        else if (op >= OP_SPEC_CONSTANT_TRUE && op <= OP_SPEC_CONSTANT_OP)
            l->g.why = "specialization constants are whit's own";
        else if (id && !spv_is_remark(op))
            graft_value(&l->g, words, id == words[1] && op <= OP_TYPE_FUNCTION ? 1 : 2);
    }
}

/* --- functions -------------------------------------------------------------------------------- */

static void add_function(struct link *l, uint32_t id, const uint32_t *words, uint32_t count)
{
    const struct function function = {id, words, count, false};
    if (!ARRAY_PUSH(l->functions, l->function_count, l->function_capacity, function))
        l->g.base.failed = true;
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
    const struct spv_module *base = &l->g.base;
    for (const uint32_t *words = spv_next_function(base, NULL); words;
         words = spv_next_function(base, words)) {
        if (graft_same_name(l->g.base_names[words[2]], name))
            return words[2];
    }
    return 0;
}

bool link_is_hook(const char *name)
{
    size_t length = strcspn(name, "(");
    for (int hook = 0; hook < WHIT_HOOKS; ++hook) {
        const char *own = whit_hook_name((whit_hook)hook);
        if (strlen(own) == length && strncmp(own, name, length) == 0)
            return true;
    }
    return false;
}

/* Whether a function of the user's module takes the place of one in the kernel: hooks do, and what
   whit generates from the user's file. */
static bool takes_place(const char *name)
{
    return name && (link_is_hook(name) || strncmp(name, "run_test(", 9) == 0 ||
                    strncmp(name, "shape_box(", 10) == 0);
}

/* main() of the user's module initializes the user's global variables. */
static bool is_main(const char *name)
{
    return graft_same_name(name, "main") || graft_same_name(name, "main(");
}

/* Maps the user's functions to ids of the kernel: hooks, functions of whit's own, and main(), which
   becomes begin_user(). */
static void name_functions(struct link *l)
{
    const struct spv_module *user = &l->g.user;
    for (const uint32_t *words = spv_next_function(user, NULL); words;
         words = spv_next_function(user, words)) {
        const char *name = l->g.user_names[words[2]];
        const char *file = refuse_file(user, words);
        if (is_main(name))
            l->g.ids[words[2]] = find_named(l, "begin_user(");
        else if (name && (file || takes_place(name)))
            l->g.ids[words[2]] = find_named(l, name);
        if (!l->g.ids[words[2]] && (is_main(name) || graft_same_name(file, "hook/interface.glsl")))
            l->g.why = "what hook/interface.glsl declares is not in the kernel";
    }
}

/* Whether the function is copied from the user's module. */
static bool is_taken(const struct link *l, const uint32_t *words)
{
    bool own = refuse_file(&l->g.user, words) != NULL;
    const char *name = l->g.user_names[words[2]];
    return !own || l->g.ids[words[2]] == 0 || is_main(name) || takes_place(name);
}

static bool is_long_switch(const struct spv_module *m, const uint32_t *words)
{
    const uint32_t *type = spv_def(m, spv_type_of(m, words[1]));
    return !type || spv_op(type) != OP_TYPE_INT || type[2] != 32;
}

/* Whether this calls whit_call_all() of kernel/hook.comp, which calls all functions only so that
   the compiler checks them. */
static bool is_call_of_all(const struct link *l, const uint32_t *words)
{
    return spv_op(words) == OP_FUNCTION_CALL && words[3] < l->g.user.bound &&
           graft_same_name(l->g.user_names[words[3]], "whit_call_all(");
}

/* Copies the functions that the kernel gets from the user's module. */
static void map_functions(struct link *l)
{
    const struct spv_module *user = &l->g.user;
    for (const uint32_t *function = spv_next_function(user, NULL); function;
         function = spv_next_function(user, function)) {
        const uint32_t *words = function, *end = words + spv_function_words(user, words);
        bool taken = is_taken(l, function);
        for (; words < end && !l->g.why && !l->g.base.failed; words += spv_length(words)) {
            if (spv_op(words) == OP_SWITCH && is_long_switch(user, words))
                l->g.why = "a switch is over integers of 32 bits";
            else if (taken && !spv_is_remark(spv_op(words)) && !is_call_of_all(l, words))
                graft_put(&l->g, &l->mapped, words);
        }
    }
}

/* Lists the user's functions, and those functions of the kernel that they do not replace. */
static void list_functions(struct link *l)
{
    const struct spv_module *base = &l->g.base;
    for (uint32_t at = 0, end; at < l->mapped.count; at = end) {
        end = at;
        while (spv_op(l->mapped.words + end) != OP_FUNCTION_END)
            end += spv_length(l->mapped.words + end);
        end++;
        add_function(l, l->mapped.words[at + 2], l->mapped.words + at, end - at);
    }
    for (const uint32_t *words = spv_next_function(base, NULL); words;
         words = spv_next_function(base, words)) {
        if (!find_function(l, words[2]))
            add_function(l, words[2], words, spv_function_words(base, words));
    }
}

/* Marks the functions that are called from `id`. The recursion is at most as deep as there are
   functions. */
static void reach(struct link *l, uint32_t id)
{
    struct function *function = find_function(l, id);
    if (!function || function->reached)
        return;
    function->reached = true;
    for (uint32_t at = 0; at < function->count; at += spv_length(function->words + at)) {
        if (spv_op(function->words + at) == OP_FUNCTION_CALL)
            reach(l, function->words[at + 3]);
    }
}

static void reach_all(struct link *l)
{
    const struct spv_module *base = &l->g.base;
    for (const uint32_t *words = spv_step(base, NULL); words; words = spv_step(base, words)) {
        if (spv_op(words) == OP_ENTRY_POINT)
            reach(l, words[2]);
    }
    for (const uint32_t *words = spv_next_function(base, NULL); words;
         words = spv_next_function(base, words)) {
        const struct function *function = find_function(l, words[2]);
        uint32_t count = spv_function_words(base, words);
        bool stays = function && function->words == words && function->reached;
        for (uint32_t i = 0; !stays && i < count; i += spv_length(words + i)) {
            uint32_t id = spv_result(base, words + i);
            l->dropped[id] = l->dropped[id] || (id && !(function && function->reached && i == 0));
        }
    }
}

/* --- the kernel ------------------------------------------------------------------------------- */

static bool has_capability(const struct spv_module *m, uint32_t capability)
{
    for (const uint32_t *words = spv_step(m, NULL); words; words = spv_step(m, words)) {
        if (spv_op(words) == OP_CAPABILITY && words[1] == capability)
            return true;
    }
    return false;
}

static void put_capabilities(struct link *l, struct spv_words *out)
{
    const struct spv_module *user = &l->g.user;
    for (const uint32_t *words = spv_step(user, NULL); words; words = spv_step(user, words)) {
        if (spv_op(words) == OP_CAPABILITY && !has_capability(&l->g.base, words[1]))
            spv_put(&l->g.base, out, words, 2);
    }
}

/* Writes everything but functions. Since SPIR-V 1.4 the entry point lists all variables. */
static void put_globals(struct link *l, struct spv_words *out)
{
    const struct spv_module *base = &l->g.base;
    for (const uint32_t *words = spv_step(base, NULL); words; words = spv_step(base, words)) {
        uint32_t op = spv_op(words), length = spv_length(words), first = out->count;
        bool decorates = op == OP_DECORATE || op == OP_MEMBER_DECORATE;
        if (spv_is_remark(op) || (decorates && words[1] < base->bound && l->dropped[words[1]]))
            continue;
        spv_put(&l->g.base, out, words, length);
        if (op != OP_ENTRY_POINT || l->g.base.failed)
            continue;
        spv_put(&l->g.base, out, l->variables, l->variable_count);
        if (!l->g.base.failed)
            out->words[first] = spv_head(op, length + l->variable_count);
    }
    spv_put(&l->g.base, out, base->globals.words, base->globals.count);
}

static void put_function(struct link *l, const struct function *function, struct spv_words *out)
{
    for (uint32_t at = 0; at < function->count; at += spv_length(function->words + at)) {
        if (!spv_is_remark(spv_op(function->words + at)))
            spv_put(&l->g.base, out, function->words + at, spv_length(function->words + at));
    }
}

static struct spv_words write_kernel(struct link *l)
{
    struct spv_words out = {0};
    spv_put(&l->g.base, &out, l->g.base.words, SPV_HEADER_WORDS);
    put_capabilities(l, &out);
    put_globals(l, &out);
    for (uint32_t i = 0; i < l->function_count; ++i) {
        if (l->functions[i].reached)
            put_function(l, &l->functions[i], &out);
    }
    if (!l->g.base.failed)
        out.words[SPV_BOUND_AT] = l->g.base.next_id;
    return out;
}

static bool begin(struct link *l, const uint32_t *kernel, size_t kernel_words, const uint32_t *user,
                  size_t count, const char *own)
{
    if (!graft_begin(&l->g, kernel, kernel_words, user, count, own))
        return false;
    l->dropped = array_alloc_zeroed(l->g.base.bound + (size_t)1, sizeof *l->dropped);
    return l->dropped;
}

static void finish(struct link *l)
{
    free(l->dropped);
    free(l->functions);
    free(l->variables);
    free(l->mapped.words);
    graft_finish(&l->g);
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
        if (!l.g.why && !l.g.base.failed) {
            list_functions(&l);
            reach_all(&l);
            out = write_kernel(&l);
        }
        if (l.g.base.failed)
            out.count = 0;
    }
    *why = l.g.why;
    finish(&l);
    return out;
}
