#include "shader/returns.h"

#include <stdlib.h>

#include "base/array.h"

/* A loop or switch whose merge block has not come yet. */
struct construct {
    uint32_t merge;
    bool is_left; /* a return leaves it */
};

/* A block that was split: it now ends as block `to`. */
struct moved {
    uint32_t from, to;
};

struct returns {
    struct construct *open;
    uint32_t open_count, open_capacity;
    struct moved *moved; /* blocks of the current function */
    uint32_t moved_count, moved_capacity;
    uint32_t label, flag, value; /* `flag`, `value`: variables of the current function; 0: none */
    /* needed: the function is rewritten; begins: its variables go behind its first label. */
    bool is_void, needed, begins;
    bool waits;         /* the test of the flag follows after the OpPhis of the current block */
    uint32_t selection; /* the merge block of an OpSelectionMerge just seen */
};

static bool is_return(uint32_t op)
{
    return op == OP_RETURN || op == OP_RETURN_VALUE;
}

/* Whether a function returns from within a loop or a switch, or has an OpUnreachable there. */
static bool is_needed(const uint32_t *at)
{
    uint32_t open[64], count = 0, selection = 0;
    for (; spv_op(at) != OP_FUNCTION_END; at += spv_length(at)) {
        uint32_t op = spv_op(at);
        while (op == OP_LABEL && count && open[count - 1] == at[1])
            count--;
        if ((op == OP_LOOP_MERGE || op == OP_SWITCH) && count < sizeof open / sizeof *open)
            open[count++] = op == OP_SWITCH ? selection : at[1];
        selection = op == OP_SELECTION_MERGE ? at[1] : selection;
        if ((is_return(op) || op == OP_UNREACHABLE) && count)
            return true;
    }
    return false;
}

static void push(struct returns *r, struct spv_module *m, uint32_t merge)
{
    const struct construct construct = {merge, false};
    if (!ARRAY_PUSH(r->open, r->open_count, r->open_capacity, construct))
        m->failed = true;
}

static void begin_function(struct returns *r, struct spv_module *m, const uint32_t *words)
{
    const uint32_t *type = spv_def(m, words[1]);
    r->is_void = type && spv_op(type) == OP_TYPE_VOID;
    r->needed = is_needed(words);
    r->begins = r->needed;
    r->open_count = r->moved_count = 0;
    r->flag = r->value = 0;
    r->waits = false;
}

static void put_variables(struct returns *r, struct spv_module *m)
{
    uint32_t b = spv_bool(m);
    r->begins = false;
    r->flag = m->next_id++;
    SPV_EMIT(m, OP_VARIABLE, spv_pointer(m, b), r->flag, STORAGE_FUNCTION, spv_null(m, b));
    if (r->is_void)
        return;
    r->value = m->next_id++;
    SPV_EMIT(m, OP_VARIABLE, spv_pointer(m, m->return_type), r->value, STORAGE_FUNCTION);
}

/* Leaves the innermost construct, or the function if none is open. */
static void put_way_out(struct returns *r, struct spv_module *m)
{
    if (r->open_count) {
        struct construct *around = &r->open[r->open_count - 1];
        around->is_left = true;
        SPV_EMIT(m, OP_BRANCH, around->merge);
    } else if (r->is_void) {
        spv_emit(m, OP_RETURN, NULL, 0);
    } else {
        uint32_t value = m->next_id++;
        SPV_EMIT(m, OP_LOAD, m->return_type, value, r->value);
        SPV_EMIT(m, OP_RETURN_VALUE, value);
    }
}

/* Tests the flag behind a loop or switch that a return may have left. */
static void put_question(struct returns *r, struct spv_module *m)
{
    uint32_t left = m->next_id++, out = m->next_id++, on = m->next_id++;
    const struct moved moved = {r->label, on};
    if (!ARRAY_PUSH(r->moved, r->moved_count, r->moved_capacity, moved))
        m->failed = true;
    r->waits = false;
    SPV_EMIT(m, OP_LOAD, spv_bool(m), left, r->flag);
    SPV_EMIT(m, OP_SELECTION_MERGE, on, 0);
    SPV_EMIT(m, OP_BRANCH_CONDITIONAL, left, out, on);
    SPV_EMIT(m, OP_LABEL, out);
    put_way_out(r, m);
    SPV_EMIT(m, OP_LABEL, on);
}

static void begin_block(struct returns *r, struct spv_module *m, const uint32_t *words)
{
    spv_put(m, &m->body, words, spv_length(words));
    r->label = words[1];
    while (r->open_count && r->open[r->open_count - 1].merge == words[1])
        r->waits = r->open[--r->open_count].is_left || r->waits;
    if (r->begins)
        put_variables(r, m);
}

static void put_phi(const struct returns *r, struct spv_module *m, const uint32_t *words)
{
    uint32_t at = m->body.count, length = spv_length(words);
    spv_put(m, &m->body, words, length);
    for (uint32_t i = 4; i < length && !m->failed; i += 2) {
        for (uint32_t j = 0; j < r->moved_count; ++j) {
            if (words[i] == r->moved[j].from)
                m->body.words[at + i] = r->moved[j].to;
        }
    }
}

/* Returns `value`, which a function without a result ignores. */
static void put_return(struct returns *r, struct spv_module *m, uint32_t value)
{
    if (r->open_count) {
        if (!r->is_void)
            SPV_EMIT(m, OP_STORE, r->value, value);
        SPV_EMIT(m, OP_STORE, r->flag, spv_true(m, spv_bool(m)));
        put_way_out(r, m);
    } else if (r->is_void) {
        spv_emit(m, OP_RETURN, NULL, 0);
    } else {
        SPV_EMIT(m, OP_RETURN_VALUE, value);
    }
}

static void take(struct returns *r, struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words);
    if (op == OP_FUNCTION)
        begin_function(r, m, words);
    if (r->waits && op != OP_PHI && op != OP_LINE && op != OP_NO_LINE)
        put_question(r, m);
    if (r->needed && op == OP_LABEL) {
        begin_block(r, m, words);
    } else if (r->needed && op == OP_PHI) {
        put_phi(r, m, words);
    } else if (r->needed && is_return(op) && r->open_count) {
        put_return(r, m, r->is_void ? 0 : words[1]);
    } else if (op == OP_UNREACHABLE) { /* a loop that runs out of fuel may reach it */
        put_return(r, m, r->is_void ? 0 : spv_null(m, m->return_type));
    } else {
        if (r->needed && (op == OP_LOOP_MERGE || op == OP_SWITCH))
            push(r, m, op == OP_SWITCH ? r->selection : words[1]);
        r->selection = op == OP_SELECTION_MERGE ? words[1] : r->selection;
        spv_put(m, &m->body, words, spv_length(words));
    }
}

/* Marks the blocks that the end of a block leads to. A constant condition leads one way. */
static void mark(const struct spv_module *m, const uint32_t *words, bool *reached)
{
    uint32_t op = spv_op(words);
    if (op == OP_BRANCH) {
        reached[words[1]] = true;
    } else if (op == OP_BRANCH_CONDITIONAL) {
        const uint32_t *condition = spv_def(m, words[1]);
        uint32_t known = condition ? spv_op(condition) : OP_NOP;
        reached[words[2]] = reached[words[2]] || known != OP_CONSTANT_FALSE;
        reached[words[3]] = reached[words[3]] || known != OP_CONSTANT_TRUE;
    } else if (op == OP_SWITCH) {
        for (uint32_t i = 2; i < spv_length(words); i += 2) {
            if (words[i] < m->bound) /* else a literal of 64 bits, which link.c refuses */
                reached[words[i]] = true;
        }
    }
}

/* A block stands behind all blocks that lead to it, but for those that lead back to a loop that has
   begun. So one pass finds the blocks that can be reached. */
bool returns_lacks(struct spv_module *m, const uint32_t *function)
{
    const uint32_t *at = function;
    bool *reached = array_alloc_zeroed(m->bound, sizeof *reached), alive = true, lacks = false;
    m->failed = m->failed || !reached;
    for (bool first = true; reached && spv_op(at) != OP_FUNCTION_END; at += spv_length(at)) {
        uint32_t op = spv_op(at);
        const uint32_t *value = op == OP_RETURN_VALUE ? spv_def(m, at[1]) : NULL;
        if (op == OP_LABEL) {
            alive = first || reached[at[1]];
            first = false;
        } else if (alive) {
            mark(m, at, reached);
            lacks = lacks || (value && spv_op(value) == OP_UNDEF);
        }
    }
    free(reached);
    return lacks;
}

struct spv_words returns_rewrite(struct spv_module *m)
{
    struct returns r = {.open = NULL};
    for (size_t at = m->functions_at; at < m->count; at += spv_length(m->words + at)) {
        const uint32_t *words = m->words + at;
        spv_follow(m, words);
        if (m->user_function && !m->failed)
            take(&r, m, words);
        else
            spv_put(m, &m->body, words, spv_length(words));
    }
    free(r.open);
    free(r.moved);
    return spv_write(m, true);
}
