/* Writes the output module, and leaves out what nothing uses. */
#include "device/evaluate.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

/* Marks as live all ids that an instruction names. True: one of them was not live before. */
static bool use(struct evaluation *e, const uint32_t *at)
{
    struct spirv_shape shape = spirv_shape(spv_op(at));
    uint32_t head = shape.result ? HEAD_WORDS_RESULT : HEAD_WORDS;
    bool changed = false;
    if (shape.result)
        e->results[at[1]].live = true;
    for (uint32_t i = head; i < spv_length(at); ++i) {
        if (!spirv_operand_is_id(shape, i - head) || e->results[at[i]].live)
            continue;
        e->results[at[i]].live = true;
        changed = true;
    }
    return changed;
}

static bool is_wanted(const struct evaluation *e, const uint32_t *at)
{
    uint32_t op = spv_op(at);
    struct spirv_shape shape = spirv_shape(op);
    if (op == OP_NOP)
        return false;
    if (op == OP_STORE && e->results[at[1]].base)
        return e->results[e->results[at[1]].base].live;
    return shape.effects || op == OP_LABEL || e->results[at[2]].live;
}

/* Marks what the body uses. It goes backwards over the body until a pass finds nothing new: loops
   may read a variable above the place where they write it. False: no memory. */
static bool mark_body(struct evaluation *e)
{
    uint32_t *at = NULL, count = 0, capacity = 0;
    bool fine = true, changed = true;
    for (uint32_t word = 0; fine && word < e->body.count; word += spv_length(e->body.words + word))
        fine = ARRAY_PUSH(at, count, capacity, word);
    while (fine && changed) {
        changed = false;
        for (uint32_t i = count; i-- > 0;) {
            const uint32_t *instruction = e->body.words + at[i];
            if (spv_op(instruction) != OP_LABEL && is_wanted(e, instruction))
                changed = use(e, instruction) || changed;
        }
    }
    free(at);
    return fine;
}

/* Words from `first` to below `last` are the ids that a type, a constant or a global variable is
   made of, besides its own and its type's. */
static void find_parts(const uint32_t *at, uint32_t *first, uint32_t *last)
{
    uint32_t op = spv_op(at);
    *first = 2;
    *last = spv_length(at);
    if (op < OP_TYPE_VOID || op > OP_TYPE_FUNCTION)
        *first = op == OP_VARIABLE ? 4 : op == OP_CONSTANT_COMPOSITE ? 3 : *last;
    else if (op == OP_TYPE_BOOL || op == OP_TYPE_INT || op == OP_TYPE_FLOAT)
        *first = *last;
    else if (op == OP_TYPE_VECTOR || op == OP_TYPE_MATRIX || op == OP_TYPE_IMAGE)
        *last = 3;
    else if (op == OP_TYPE_POINTER)
        *first = 3;
}

/* Marks as live what live types, constants and global variables are made of. Constants decorated
   with BuiltIn are always live: mark_roots marks them. */
static void mark_globals(struct evaluation *e)
{
    uint32_t *at = NULL, count = 0, capacity = 0;
    for (uint32_t word = 0; word < e->globals.count; word += spv_length(e->globals.words + word))
        e->failed = !ARRAY_PUSH(at, count, capacity, word) || e->failed;
    for (uint32_t i = count; !e->failed && i-- > 0;) {
        const uint32_t *instruction = e->globals.words + at[i];
        uint32_t op = spv_op(instruction), first, last;
        bool is_type = op >= OP_TYPE_VOID && op <= OP_TYPE_FUNCTION;
        if (!e->results[instruction[is_type ? 1 : 2]].live)
            continue;
        if (!is_type)
            e->results[instruction[1]].live = true;
        find_parts(instruction, &first, &last);
        for (uint32_t k = first; k < last; ++k) {
            if (instruction[k] < e->source_count)
                e->results[instruction[k]].live = true;
        }
    }
    free(at);
}

/* Writes the entry point with only those interface variables that are live. */
static void put_entry_point(struct evaluation *e, struct word_list *out, const uint32_t *at)
{
    uint32_t begin = out->count, i = 3, length = spv_length(at);
    while (i < length && at[i] >> 24 != 0) /* the name ends at the word whose last byte is 0 */
        ++i;
    evaluate_push_words(e, out, i < length ? i + 1 : length, at);
    for (++i; i < length; ++i) {
        if (at[i] < e->source_count && e->results[at[i]].live)
            evaluate_push(e, out, at[i]);
    }
    if (!e->failed)
        out->words[begin] = spv_head(OP_ENTRY_POINT, out->count - begin);
}

/* Whether integers of 64 bits are left. */
static bool has_wide_integers(const struct evaluation *e)
{
    bool found = false;
    for (uint32_t word = 0; word < e->globals.count; word += spv_length(e->globals.words + word)) {
        const uint32_t *at = e->globals.words + word;
        found = found || (spv_op(at) == OP_TYPE_INT && at[2] == 64 && e->results[at[1]].live);
    }
    return found;
}

/* Writes the instructions in front of the types. Names and remarks are left out, and so is the
   capability for integers of 64 bits where there are none: a device may lack it. */
static void put_head(struct evaluation *e, struct word_list *out)
{
    bool wide = has_wide_integers(e);
    evaluate_push_words(e, out, SPV_HEADER_WORDS, e->words);
    for (uint32_t word = SPV_HEADER_WORDS; word < e->functions_at;
         word += spv_length(e->words + word)) {
        const uint32_t *at = e->words + word;
        uint32_t op = spv_op(at);
        bool decorates = op == OP_DECORATE || op == OP_MEMBER_DECORATE;
        bool of_live = decorates && e->source[at[1]].at < e->functions_at && e->results[at[1]].live;
        if (op == OP_ENTRY_POINT)
            put_entry_point(e, out, at);
        else if ((op == OP_CAPABILITY &&
                  (wide || spv_length(at) != 2 || at[1] != CAPABILITY_INT64)) ||
                 op == OP_EXTENSION || op == OP_EXT_INST_IMPORT || op == OP_MEMORY_MODEL ||
                 op == OP_EXECUTION_MODE ||
                 (of_live && !(op == OP_DECORATE && at[2] == DECORATION_SPEC_ID)))
            evaluate_push_words(e, out, spv_length(at), at);
    }
    for (uint32_t id = e->source_count; id < e->result_count; ++id) {
        const uint32_t exact[] = {spv_head(OP_DECORATE, 3), id, DECORATION_NO_CONTRACTION};
        if (e->results[id].live && e->results[id].exact)
            evaluate_push_words(e, out, 3, exact);
    }
}

static void put_live(struct evaluation *e, struct word_list *out, const struct word_list *list)
{
    for (uint32_t word = 0; word < list->count; word += spv_length(list->words + word)) {
        const uint32_t *at = list->words + word;
        uint32_t op = spv_op(at);
        bool is_type = op >= OP_TYPE_VOID && op <= OP_TYPE_FUNCTION;
        if (e->results[at[is_type ? 1 : 2]].live)
            evaluate_push_words(e, out, spv_length(at), at);
    }
}

static void put_body(struct evaluation *e, struct word_list *out)
{
    for (uint32_t word = 0; word < e->body.count; word += spv_length(e->body.words + word)) {
        uint32_t *at = e->body.words + word;
        if (!is_wanted(e, at))
            continue;
        for (uint32_t i = 4; spv_op(at) == OP_PHI && i < spv_length(at); i += 2) {
            while (e->results[at[i]].same_as)
                at[i] = e->results[at[i]].same_as;
        }
        evaluate_push_words(e, out, spv_length(at), at);
    }
}

/* Marks the ids that stay although the function's body does not name them. */
static void mark_roots(struct evaluation *e, const uint32_t *function)
{
    e->results[function[1]].live = true;
    e->results[function[4]].live = true;
    for (uint32_t word = SPV_HEADER_WORDS; word < e->functions_at;
         word += spv_length(e->words + word)) {
        const uint32_t *at = e->words + word;
        uint32_t id = spv_op(at) == OP_DECORATE ? at[1] : 0;
        if (id && at[2] == DECORATION_BUILTIN && e->source[id].at &&
            spv_op(e->words + e->source[id].at) != OP_VARIABLE)
            e->results[id].live = true;
    }
}

/* ---- Numbers of ids ---- */

/* numbers[id]: the new number of an id, 0 where it was not met yet. `next`: the next new number. */
struct renumbering {
    uint32_t *numbers, next;
};

static void renumber(struct renumbering *r, uint32_t *at, uint32_t first, uint32_t last)
{
    for (uint32_t i = first; i < last; ++i) {
        uint32_t *number = &r->numbers[at[i]];
        *number = *number ? *number : r->next++;
        at[i] = *number;
    }
}

/* Renumbers the ids of an instruction in front of the function; false: the instruction belongs to
   the function. */
static bool renumber_front(struct renumbering *r, uint32_t *at)
{
    uint32_t op = spv_op(at), first, last;
    bool is_type = op >= OP_TYPE_VOID && op <= OP_TYPE_FUNCTION;
    if (op == OP_ENTRY_POINT) {
        for (first = 3; at[first] >> 24 != 0;)
            ++first; /* its name */
        renumber(r, at, 2, 3);
        renumber(r, at, first + 1, spv_length(at));
    } else if (op == OP_EXT_INST_IMPORT || op == OP_EXECUTION_MODE || op == OP_DECORATE ||
               op == OP_MEMBER_DECORATE) {
        renumber(r, at, 1, 2);
    } else if (is_type || (op >= OP_CONSTANT_TRUE && op <= OP_SPEC_CONSTANT_OP)) {
        find_parts(at, &first, &last);
        renumber(r, at, 1, is_type ? 2 : 3);
        renumber(r, at, first, last);
    } else {
        return op == OP_CAPABILITY || op == OP_EXTENSION || op == OP_MEMORY_MODEL;
    }
    return true;
}

static void renumber_function(struct renumbering *r, uint32_t *at)
{
    uint32_t op = spv_op(at);
    struct spirv_shape shape = spirv_shape(op);
    uint32_t head = shape.result ? HEAD_WORDS_RESULT : HEAD_WORDS;
    if (op == OP_FUNCTION)
        renumber(r, at, 4, 5);
    if (shape.result || op == OP_FUNCTION)
        renumber(r, at, 1, 3);
    if (op == OP_LABEL)
        renumber(r, at, 1, 2);
    for (uint32_t i = head; i < spv_length(at); ++i) {
        if (spirv_operand_is_id(shape, i - head))
            renumber(r, at, i, i + 1);
    }
}

/* Numbers the ids in their order in the module, so that a kernel has the same words whatever was
   taken out of it. */
static void renumber_ids(struct evaluation *e, struct word_list *out)
{
    struct renumbering r = {array_alloc_zeroed(e->result_count, sizeof *r.numbers), 1};
    if (!r.numbers) {
        e->failed = true;
        return;
    }
    for (uint32_t word = SPV_HEADER_WORDS; word < out->count;
         word += spv_length(out->words + word)) {
        if (!renumber_front(&r, out->words + word))
            renumber_function(&r, out->words + word);
    }
    out->words[3] = r.next;
    free(r.numbers);
}

uint32_t *evaluate_write(struct evaluation *e, size_t *word_count)
{
    const uint32_t *function = e->words + e->source[e->entry].at;
    const uint32_t label[] = {spv_head(OP_LABEL, 2), e->first_label};
    const uint32_t end = spv_head(OP_FUNCTION_END, 1);
    struct word_list out = {0};
    mark_roots(e, function);
    if (!mark_body(e))
        return NULL;
    for (uint32_t word = 0; word < e->variables.count;
         word += spv_length(e->variables.words + word)) {
        const uint32_t *at = e->variables.words + word;
        if (e->results[at[2]].live)
            e->results[at[1]].live = true;
    }
    mark_globals(e);
    put_head(e, &out);
    put_live(e, &out, &e->globals);
    evaluate_push_words(e, &out, spv_length(function), function);
    evaluate_push_words(e, &out, 2, label);
    put_live(e, &out, &e->variables);
    put_body(e, &out);
    evaluate_push_words(e, &out, 1, &end);
    if (!e->failed)
        renumber_ids(e, &out);
    if (e->failed) {
        free(out.words);
        return NULL;
    }
    *word_count = out.count;
    return out.words;
}
