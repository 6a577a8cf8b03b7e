#include "device/evaluate_constants.h"

static void know(struct evaluation *e, uint32_t id, uint32_t type, uint32_t value)
{
    e->results[id].known = true;
    e->results[id].type = type;
    e->results[id].value = value;
    evaluate_push(e, &e->constants, id);
}

static void put_constant(struct evaluation *e, uint32_t type, uint32_t id, uint32_t value)
{
    bool is_bool = spv_op(e->words + e->source[type].at) == OP_TYPE_BOOL;
    if (is_bool)
        EVALUATE_EMIT(e, &e->globals, value ? OP_CONSTANT_TRUE : OP_CONSTANT_FALSE, type, id);
    else
        EVALUATE_EMIT(e, &e->globals, OP_CONSTANT, type, id, value);
    know(e, id, type, value);
}

uint32_t evaluate_constant(struct evaluation *e, uint32_t type, uint32_t value)
{
    for (uint32_t i = 0; i < e->constants.count; ++i) {
        const struct result_id *constant = &e->results[e->constants.words[i]];
        if (constant->type == type && constant->value == value)
            return e->constants.words[i];
    }
    uint32_t id = evaluate_new_id(e);
    put_constant(e, type, id, value);
    return id;
}

static bool is_word(const struct evaluation *e, uint32_t type)
{
    const uint32_t *at = e->words + e->source[type].at;
    return spv_op(at) == OP_TYPE_BOOL || (spv_op(at) == OP_TYPE_INT && at[2] == 32);
}

bool evaluate_fold(const struct evaluation *e, uint32_t op, uint32_t type, const uint32_t *operands,
                   uint32_t count, uint32_t *value)
{
    uint32_t values[3];
    if (count > 3 || !is_word(e, type))
        return false;
    for (uint32_t i = 0; i < count; ++i) {
        const struct result_id *operand = &e->results[e->source[operands[i]].to];
        if (!operand->known)
            return false;
        values[i] = operand->value;
    }
    return spirv_fold(op, values, count, value);
}

/* The value of a bool or 32-bit specialization constant: what the caller set, else its default. */
static uint32_t spec_value(const struct evaluation *e, const uint32_t *instruction,
                           const uint32_t *values)
{
    uint32_t op = spv_op(instruction), value = values[instruction[2]];
    if (e->source[instruction[2]].is_set)
        return op == OP_SPEC_CONSTANT ? value : value != 0;
    return op == OP_SPEC_CONSTANT ? instruction[3] : op == OP_SPEC_CONSTANT_TRUE;
}

void evaluate_global(struct evaluation *e, const uint32_t *at, const uint32_t *values)
{
    uint32_t op = spv_op(at), value;
    switch (op) {
    case OP_SPEC_CONSTANT_TRUE:
    case OP_SPEC_CONSTANT_FALSE:
    case OP_SPEC_CONSTANT:
        if (is_word(e, at[1]))
            put_constant(e, at[1], at[2], spec_value(e, at, values));
        else
            e->failed = true;
        return;
    case OP_SPEC_CONSTANT_OP:
        if (evaluate_fold(e, at[3], at[1], at + 4, spv_length(at) - 4, &value))
            put_constant(e, at[1], at[2], value);
        else
            e->failed = true;
        return;
    case OP_SPEC_CONSTANT_COMPOSITE:
        evaluate_push(e, &e->globals, spv_head(OP_CONSTANT_COMPOSITE, spv_length(at)));
        evaluate_push_words(e, &e->globals, spv_length(at) - 1, at + 1);
        return;
    default:
        evaluate_push_words(e, &e->globals, spv_length(at), at);
        if (op == OP_TYPE_INT && is_word(e, at[1]))
            e->uint_type = at[1]; /* or int: either will do */
        if (op >= OP_CONSTANT_TRUE && op <= OP_CONSTANT && is_word(e, at[1]))
            know(e, at[2], at[1], op == OP_CONSTANT ? at[3] : op == OP_CONSTANT_TRUE);
    }
}

uint32_t evaluate_pointer_type(struct evaluation *e, uint32_t type)
{
    for (uint32_t at = 0; at < e->globals.count; at += spv_length(e->globals.words + at)) {
        const uint32_t *instruction = e->globals.words + at;
        if (spv_op(instruction) == OP_TYPE_POINTER && instruction[2] == STORAGE_FUNCTION &&
            instruction[3] == type)
            return instruction[1];
    }
    uint32_t id = evaluate_new_id(e);
    EVALUATE_EMIT(e, &e->globals, OP_TYPE_POINTER, id, STORAGE_FUNCTION, type);
    return id;
}
