/* Follows what variables hold. GLSL compilers pass every argument in a variable of its own, so that
   most loads read what was stored a few instructions before. */
#include "device/evaluate_memory.h"

static uint32_t op_at(const struct evaluation *e, uint32_t id)
{
    uint32_t at = e->source[id].at;
    return at ? spv_op(e->words + at) : OP_NOP;
}

/* The variable or parameter that a pointer points into. */
static uint32_t root_of(const struct evaluation *e, uint32_t pointer)
{
    while (op_at(e, pointer) == OP_ACCESS_CHAIN)
        pointer = e->words[e->source[pointer].at + 3];
    return pointer;
}

/* The count saturates at 2, so that the passes over calls come to an end. True: it grew. */
static bool add_writes(struct evaluation *e, uint32_t pointer, uint32_t writes)
{
    struct source_id *root = &e->source[root_of(e, pointer)];
    uint32_t before = root->writes;
    root->writes = before + writes < 2 ? before + writes : 2;
    return root->writes != before;
}

/* Counts what the called function writes through its parameters. True: a count grew. */
static bool count_call(struct evaluation *e, const uint32_t *call)
{
    const uint32_t *at = e->words + e->source[call[3]].at;
    bool changed = false;
    at += spv_length(at);
    for (uint32_t i = 4; i < spv_length(call) && spv_op(at) == OP_FUNCTION_PARAMETER; ++i) {
        if (e->source[at[2]].writes > 0)
            changed = add_writes(e, call[i], 2) || changed;
        at += spv_length(at);
    }
    return changed;
}

void evaluate_count_writes(struct evaluation *e)
{
    bool changed = true;
    for (bool first = true; changed; first = false) {
        changed = false;
        for (uint32_t at = e->functions_at; at < e->count; at += spv_length(e->words + at)) {
            const uint32_t *instruction = e->words + at;
            uint32_t op = spv_op(instruction);
            if (op == OP_FUNCTION_CALL)
                changed = count_call(e, instruction) || changed;
            else if (first && op == OP_STORE)
                add_writes(e, instruction[1], op_at(e, instruction[1]) == OP_ACCESS_CHAIN ? 2 : 1);
            else if (first && op >= OP_ATOMIC_LOAD && op <= OP_ATOMIC_XOR)
                add_writes(e, instruction[op == OP_ATOMIC_STORE ? 1 : 3], 2);
            else if (first && op == OP_VARIABLE && spv_length(instruction) > 4)
                add_writes(e, instruction[2], 1);
        }
    }
}

void evaluate_repeat_writes(struct evaluation *e, uint32_t first, uint32_t end)
{
    for (uint32_t at = first; at < end; at += spv_length(e->words + at)) {
        if (spv_op(e->words + at) == OP_STORE)
            e->source[root_of(e, e->words[at + 1])].writes = 2;
    }
}

/* ---- Regions ---- */

void evaluate_begin_construct(struct evaluation *e, uint32_t merge)
{
    evaluate_push(e, &e->constructs, merge);
    evaluate_push(e, &e->constructs, e->open.count);
}

void evaluate_enter_block(struct evaluation *e, uint32_t label, bool follows)
{
    struct word_list *constructs = &e->constructs;
    for (uint32_t i = constructs->count; i > 0; i -= 2) {
        if (constructs->words[i - 2] == label) {
            e->open.count = constructs->words[i - 1];
            constructs->count = i - 2;
            return;
        }
    }
    if (follows)
        return;
    e->open.count = constructs->count ? constructs->words[constructs->count - 1] : 0;
    evaluate_push(e, &e->open, ++e->regions);
}

static void forget_value(struct evaluation *e, uint32_t pointer)
{
    uint32_t to = e->source[root_of(e, pointer)].to;
    if (to)
        e->results[e->results[to].base].stored = 0;
}

/* Forgets the variables that the called function writes through its parameters. */
static void forget_arguments(struct evaluation *e, const uint32_t *call)
{
    const uint32_t *at = e->words + e->source[call[3]].at;
    at += spv_length(at);
    for (uint32_t i = 4; i < spv_length(call) && spv_op(at) == OP_FUNCTION_PARAMETER; ++i) {
        if (e->source[at[2]].writes > 0)
            forget_value(e, call[i]);
        at += spv_length(at);
    }
}

void evaluate_begin_loop(struct evaluation *e, uint32_t header)
{
    uint32_t at = e->source[header].at, end = e->count;
    for (; at < end; at += spv_length(e->words + at)) {
        const uint32_t *instruction = e->words + at;
        uint32_t op = spv_op(instruction);
        if (op == OP_LOOP_MERGE && end == e->count) {
            end = e->source[instruction[1]].at;
            evaluate_begin_construct(e, evaluate_id(e, instruction[1]));
        } else if (op == OP_STORE) {
            forget_value(e, instruction[1]);
        } else if (op == OP_FUNCTION_CALL) {
            forget_arguments(e, instruction);
        }
    }
}

/* ---- Loads and stores ---- */

uint32_t evaluate_held(const struct evaluation *e, uint32_t pointer)
{
    const struct source_id *source = &e->source[pointer];
    const struct result_id *variable = &e->results[source->to];
    if (source->holds)
        return source->holds;
    bool known = source->to && variable->base == source->to && variable->depth < e->open.count &&
                 e->open.words[variable->depth] == variable->region;
    return known ? variable->stored : 0;
}

/* Notes that a variable holds `value`, both output ids, from here on. */
static void hold(struct evaluation *e, uint32_t variable, uint32_t value)
{
    struct result_id *result = &e->results[variable];
    result->stored = value;
    result->depth = e->open.count - 1;
    result->region = e->open.words[result->depth];
}

/* Replaces the load of a part by an extract from the whole value, where that is known. */
static bool load_part(struct evaluation *e, const uint32_t *load, const uint32_t *chain)
{
    uint32_t whole = evaluate_held(e, chain[3]), length = spv_length(chain);
    if (!whole)
        return false;
    for (uint32_t i = 4; i < length; ++i) {
        if (!e->results[evaluate_id(e, chain[i])].known)
            return false;
    }
    uint32_t result = evaluate_result(e, load);
    evaluate_push(e, &e->body, spv_head(OP_COMPOSITE_EXTRACT, length));
    evaluate_push(e, &e->body, load[1]);
    evaluate_push(e, &e->body, result);
    evaluate_push(e, &e->body, whole);
    for (uint32_t i = 4; i < length; ++i)
        evaluate_push(e, &e->body, e->results[evaluate_id(e, chain[i])].value);
    return true;
}

void evaluate_load(struct evaluation *e, const uint32_t *load)
{
    uint32_t pointer = load[3], held = evaluate_held(e, pointer);
    if (held) {
        e->source[load[2]].to = held;
        return;
    }
    if (op_at(e, pointer) == OP_ACCESS_CHAIN &&
        load_part(e, load, e->words + e->source[pointer].at))
        return;
    evaluate_copy(e, load);
    uint32_t to = evaluate_id(e, pointer);
    if (!e->failed && e->results[to].base == to)
        hold(e, to, e->source[load[2]].to);
}

void evaluate_store(struct evaluation *e, const uint32_t *store)
{
    uint32_t to = evaluate_id(e, store[1]), value = evaluate_id(e, store[2]);
    evaluate_copy(e, store);
    if (e->failed || !e->results[to].base)
        return;
    uint32_t variable = e->results[to].base;
    hold(e, variable, variable == to ? value : 0);
    /* The variable is written nowhere else, so every load of it gives this value. */
    if (op_at(e, store[1]) == OP_VARIABLE && e->source[store[1]].writes == 1 &&
        e->results[value].known)
        e->source[store[1]].holds = value;
}

/* Whether another argument of the call points into the same variable. */
static bool is_shared(struct evaluation *e, const uint32_t *call, uint32_t argument)
{
    uint32_t base = e->results[evaluate_id(e, call[argument])].base;
    for (uint32_t i = 4; i < spv_length(call); ++i) {
        if (i != argument && e->results[evaluate_id(e, call[i])].base == base)
            return true;
    }
    return false;
}

void evaluate_bind_parameters(struct evaluation *e, const uint32_t *call, uint32_t function_at)
{
    const uint32_t *at = e->words + function_at;
    at += spv_length(at);
    for (uint32_t i = 4; i < spv_length(call); ++i) {
        if (spv_op(at) != OP_FUNCTION_PARAMETER) {
            e->failed = true;
            return;
        }
        struct source_id *parameter = &e->source[at[2]];
        uint32_t to = evaluate_id(e, call[i]), held = 0;
        if (e->results[to].base && parameter->writes == 0 && !is_shared(e, call, i))
            held = evaluate_held(e, call[i]);
        parameter->to = to;
        parameter->holds = held;
        at += spv_length(at);
    }
}
