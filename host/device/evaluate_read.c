/* Finds where everything is in a module, and checks that it is whole: the rest of the evaluation
   relies on both. */
#include "device/evaluate.h"

/* The least number of words of an instruction: as many as are read at fixed positions. */
static uint32_t min_words(uint32_t op)
{
    return op == OP_SELECT                                                 ? 6
           : op == OP_LOGICAL_AND || op == OP_LOGICAL_OR                   ? 5
           : op == OP_VARIABLE || op == OP_LOAD || op == OP_ACCESS_CHAIN   ? 4
           : op == OP_FUNCTION_CALL || op == OP_BRANCH_CONDITIONAL         ? 4
           : op >= OP_ATOMIC_LOAD && op <= OP_ATOMIC_XOR                   ? 4
           : op == OP_STORE || op == OP_LOOP_MERGE || op == OP_SWITCH      ? 3
           : op == OP_FUNCTION || op == OP_FUNCTION_PARAMETER              ? 3
           : op == OP_SELECTION_MERGE || op == OP_BRANCH || op == OP_LABEL ? 2
           : op == OP_RETURN_VALUE                                         ? 2
                                                                           : 1;
}

/* Notes where an instruction of a function is. False: it is too short, unknown, or names an id that
   is out of bounds. */
static bool read_instruction(struct evaluation *e, uint32_t at, uint32_t *function, uint32_t *label)
{
    const uint32_t *words = e->words + at;
    uint32_t op = spv_op(words), length = spv_length(words);
    struct spirv_shape shape = spirv_shape(op);
    uint32_t head = shape.result ? HEAD_WORDS_RESULT : HEAD_WORDS, id = 0;
    if (length < min_words(op))
        return false;
    if (op == OP_FUNCTION || op == OP_FUNCTION_PARAMETER || op == OP_FUNCTION_CALL) {
        head = HEAD_WORDS_RESULT;
        id = words[2];
        shape.ids = op == OP_FUNCTION_CALL ? UINT32_MAX : 0;
        *function = op == OP_FUNCTION ? id : *function;
    } else if (op == OP_LABEL && length == 2) {
        id = *label = words[1];
    } else if (op != OP_FUNCTION_END) {
        if (!shape.known || length < head)
            return false;
        id = shape.result ? words[2] : 0;
    }
    for (uint32_t i = head; op != OP_LABEL && i < length; ++i) {
        if (spirv_operand_is_id(shape, i - head) && words[i] >= e->source_count)
            return false;
    }
    if (id >= e->source_count || *function >= e->source_count)
        return false;
    e->source[id].at = at;
    e->source[*function].returns += op == OP_RETURN || op == OP_RETURN_VALUE;
    e->source[*label].begins_loop = e->source[*label].begins_loop || op == OP_LOOP_MERGE;
    return true;
}

/* Instructions in front of the types that are kept as they are, or are debug information, which is
   left out. */
static bool is_head(uint32_t op)
{
    return op == OP_CAPABILITY || op == OP_EXTENSION || op == OP_MEMORY_MODEL ||
           op == OP_EXECUTION_MODE || (op >= OP_SOURCE_CONTINUED && op <= OP_LINE) ||
           op == OP_NO_LINE || op == OP_MODULE_PROCESSED;
}

/* Notes where a type, constant or global variable is, and what decorations say of an id. False: the
   instruction is broken or unknown. */
static bool read_global(struct evaluation *e, uint32_t at, uint32_t *spec_of)
{
    const uint32_t *words = e->words + at;
    uint32_t op = spv_op(words), length = spv_length(words), id = 0;
    if (op == OP_DECORATE || op == OP_MEMBER_DECORATE) {
        if (length < 3 || words[1] >= e->source_count)
            return false;
        if (op == OP_MEMBER_DECORATE)
            return true;
        e->source[words[1]].exact =
            e->source[words[1]].exact || words[2] == DECORATION_NO_CONTRACTION;
        if (words[2] == DECORATION_SPEC_ID && length == 4)
            spec_of[words[1]] = words[3];
    } else if (op == OP_ENTRY_POINT && length >= 4) {
        if (e->entry || words[2] >= e->source_count)
            return false;
        e->entry = words[2];
    } else if (op == OP_EXT_INST_IMPORT || (op >= OP_TYPE_VOID && op <= OP_TYPE_FUNCTION)) {
        if (length < 2 || (op == OP_TYPE_INT && length != 4) ||
            (op == OP_TYPE_POINTER && length != 4))
            return false;
        id = words[1];
    } else if (op == OP_UNDEF || op == OP_VARIABLE ||
               (op >= OP_CONSTANT_TRUE && op <= OP_SPEC_CONSTANT_OP)) {
        bool numbers = op == OP_CONSTANT || op == OP_SPEC_CONSTANT || op == OP_SPEC_CONSTANT_OP;
        if (length < (numbers ? 4u : 3u) || words[1] >= e->source_count)
            return false;
        for (uint32_t i = 4; op == OP_SPEC_CONSTANT_OP && i < length; ++i) {
            if (words[i] >= e->source_count)
                return false;
        }
        id = words[2];
    } else if (!is_head(op)) {
        return false;
    }
    if (id >= e->source_count)
        return false;
    e->source[id].at = at;
    return true;
}

bool evaluate_read(struct evaluation *e, uint32_t *spec_of)
{
    uint32_t function = 0, label = 0, last = OP_NOP;
    for (uint32_t at = SPV_HEADER_WORDS; at < e->count; at += spv_length(e->words + at)) {
        uint32_t length = spv_length(e->words + at);
        if (length == 0 || length > e->count - at)
            return false;
        last = spv_op(e->words + at);
        if (!e->functions_at && spv_op(e->words + at) == OP_FUNCTION)
            e->functions_at = at;
        if (!(e->functions_at ? read_instruction(e, at, &function, &label)
                              : read_global(e, at, spec_of)))
            return false;
    }
    return last == OP_FUNCTION_END && e->entry &&
           spv_op(e->words + e->source[e->entry].at) == OP_FUNCTION;
}
