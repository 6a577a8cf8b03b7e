#include "device/evaluate_constants.h"
#include "device/evaluate_loops.h"
#include "device/evaluate_memory.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "device/specialize.h"

void evaluate_push(struct evaluation *e, struct word_list *list, uint32_t word)
{
    if (!e->failed && !ARRAY_PUSH(list->words, list->count, list->capacity, word))
        e->failed = e->starved = true;
}

uint32_t evaluate_new_id(struct evaluation *e)
{
    const struct result_id fresh = {0};
    e->failed = e->failed || e->result_count >= SPIRV_BOUND_MAX;
    if (!e->failed && !ARRAY_PUSH(e->results, e->result_count, e->result_capacity, fresh))
        e->failed = e->starved = true;
    if (e->failed)
        return 0;
    return e->result_count - 1;
}

uint32_t evaluate_id(struct evaluation *e, uint32_t id)
{
    if (!e->source[id].to)
        e->source[id].to = evaluate_new_id(e);
    return e->source[id].to;
}

uint32_t evaluate_result(struct evaluation *e, const uint32_t *instruction)
{
    uint32_t id = evaluate_id(e, instruction[2]);
    e->results[id].exact = e->source[instruction[2]].exact;
    return id;
}

void evaluate_push_words(struct evaluation *e, struct word_list *list, uint32_t count,
                         const uint32_t *words)
{
    for (uint32_t i = 0; i < count; ++i)
        evaluate_push(e, list, words[i]);
}

void evaluate_copy(struct evaluation *e, const uint32_t *instruction)
{
    uint32_t length = spv_length(instruction);
    struct spirv_shape shape = spirv_shape(spv_op(instruction));
    uint32_t head = shape.result ? HEAD_WORDS_RESULT : HEAD_WORDS;
    evaluate_push(e, &e->body, instruction[0]);
    if (shape.result) {
        evaluate_push(e, &e->body, instruction[1]);
        evaluate_push(e, &e->body, evaluate_result(e, instruction));
    }
    for (uint32_t i = head; i < length; ++i)
        evaluate_push(e, &e->body,
                      spirv_operand_is_id(shape, i - head) ? evaluate_id(e, instruction[i])
                                                           : instruction[i]);
}

static uint32_t add_variable(struct evaluation *e, uint32_t pointer_type)
{
    uint32_t id = evaluate_new_id(e);
    EVALUATE_EMIT(e, &e->variables, OP_VARIABLE, pointer_type, id, STORAGE_FUNCTION);
    e->results[id].base = id;
    return id;
}

/* ---- Blocks ---- */

/* Writes the branch to the delayed block, if there is one. */
static void end_delayed(struct evaluation *e)
{
    if (e->delayed)
        EVALUATE_EMIT(e, &e->body, OP_BRANCH, evaluate_id(e, e->delayed));
    e->delayed = 0;
}

/* Ends a waiting return by a branch, its value in a variable: other returns or blocks follow. */
static void end_return(struct evaluation *e, struct instance *in)
{
    if (!in->return_waits)
        return;
    in->return_waits = false;
    if (in->result_type) {
        if (!in->variable)
            in->variable = add_variable(e, evaluate_pointer_type(e, in->result_type));
        EVALUATE_EMIT(e, &e->body, OP_STORE, in->variable, in->value);
    }
    EVALUATE_EMIT(e, &e->body, OP_BRANCH, in->after);
}

static void put_label(struct evaluation *e, uint32_t id, bool follows)
{
    EVALUATE_EMIT(e, &e->body, OP_LABEL, id);
    e->label = id;
    e->goes_to = 0;
    evaluate_enter_block(e, id, follows);
}

static void begin_block(struct evaluation *e, struct instance *in, uint32_t label)
{
    struct source_id *block = &e->source[label];
    in->label = label;
    while (in->loop_depth > 0 && in->loops[in->loop_depth - 1] == label)
        --in->loop_depth;
    in->skips = !block->reached;
    if (in->skips && !block->is_merge && !block->is_continue)
        return;
    if (block->reached && e->delayed == label && block->incoming == 1 && !block->begins_loop &&
        !block->is_merge && !block->is_continue) {
        e->delayed = 0; /* continues the current output block */
        block->visited = true;
        return;
    }
    bool follows = e->goes_to == label && block->incoming == 1;
    end_delayed(e);
    end_return(e, in);
    if (block->begins_loop && block->reached) {
        evaluate_begin_loop(e, label);
        follows = false;
    }
    put_label(e, evaluate_id(e, label), follows);
    block->visited = true;
    if (in->skips && block->is_continue)
        EVALUATE_EMIT(e, &e->body, OP_BRANCH, evaluate_id(e, block->header));
    else if (in->skips)
        EVALUATE_EMIT(e, &e->body, OP_UNREACHABLE, );
}

static void enter(struct evaluation *e, uint32_t label)
{
    struct source_id *block = &e->source[label];
    block->reached = true;
    ++block->incoming;
    if (block->visited && !block->begins_loop)
        e->failed = true; /* a branch backwards, but not to a loop header */
}

/* Writes the waiting merge instruction. The blocks that it names are needed, reached or not. */
static void put_merge(struct evaluation *e, struct instance *in)
{
    if (!in->merge)
        return;
    const uint32_t *merge = e->words + in->merge;
    in->merge = 0;
    evaluate_copy(e, merge);
    e->source[merge[1]].is_merge = true;
    if (spv_op(merge) != OP_LOOP_MERGE) {
        evaluate_begin_construct(e, evaluate_id(e, merge[1]));
        return;
    }
    e->source[merge[2]].is_continue = true;
    e->source[merge[2]].header = in->label;
    if (in->loop_depth < sizeof in->loops / sizeof *in->loops)
        in->loops[in->loop_depth++] = merge[1];
    else
        e->failed = true;
}

static void walk_words(struct evaluation *e, struct instance *in, uint32_t first, uint32_t end);

/* Forgets what an earlier pass over the words [first, end) made of their ids. */
static void forget(struct evaluation *e, uint32_t first, uint32_t end)
{
    for (uint32_t at = first; at < end; at += spv_length(e->words + at)) {
        const uint32_t *words = e->words + at;
        uint32_t op = spv_op(words);
        bool has_result =
            op == OP_FUNCTION_PARAMETER || op == OP_FUNCTION_CALL || spirv_shape(op).result;
        struct source_id *source = &e->source[op == OP_LABEL ? words[1]
                                              : has_result   ? words[2]
                                                             : 0];
        source->to = source->holds = source->chosen = source->end_label = 0;
        source->incoming = source->header = 0;
        source->reached = source->visited = source->is_merge = source->is_continue = false;
    }
}

/* Writes the iterations of a loop one after the other. The last pass over its words only decides
   the test that leaves it. */
static void unroll(struct evaluation *e, struct instance *in, const struct counted_loop *loop)
{
    struct source_id *header = &e->source[loop->header];
    uint32_t outer = in->unrolled;
    in->unrolled = loop->header;
    header->begins_loop = false;
    evaluate_repeat_writes(e, loop->first, loop->end);
    for (uint32_t i = 0; !e->failed && i <= loop->trips; ++i) {
        forget(e, loop->first, loop->end);
        header->reached = true;
        header->incoming = 1;
        e->delayed = loop->header;
        e->source[loop->variable].holds = evaluate_constant(e, loop->type, loop->values[i]);
        walk_words(e, in, loop->first, loop->end);
    }
    e->source[loop->variable].holds = 0;
    header->begins_loop = true;
    in->unrolled = outer;
    in->resume_at = loop->end;
}

static void branch_to(struct evaluation *e, struct instance *in, uint32_t target)
{
    bool is_loop = in->merge && spv_op(e->words + in->merge) == OP_LOOP_MERGE;
    struct counted_loop loop;
    e->source[in->label].end_label = e->label;
    e->source[in->label].chosen = target;
    e->goes_to = target;
    if (target == in->unrolled)
        return; /* the next iteration continues the current output block */
    if (e->source[target].begins_loop && evaluate_counted_loop(e, target, &loop)) {
        unroll(e, in, &loop);
        return;
    }
    if (is_loop)
        put_merge(e, in);
    in->merge = 0;
    enter(e, target);
    e->delayed = target;
    if (is_loop || e->source[target].visited)
        end_delayed(e);
}

static void branch_either(struct evaluation *e, struct instance *in, const uint32_t *at)
{
    const struct result_id *condition = &e->results[evaluate_id(e, at[1])];
    /* A branch back to a loop's header stays, even where it is never taken. */
    bool back = e->source[at[2]].visited || e->source[at[3]].visited;
    if (condition->known && !back) {
        branch_to(e, in, condition->value ? at[2] : at[3]);
        return;
    }
    e->source[in->label].end_label = e->label;
    e->goes_to = 0;
    put_merge(e, in);
    evaluate_copy(e, at);
    enter(e, at[2]);
    enter(e, at[3]);
}

/* All cases stay, even where the selector is known: blocks nested in them may leave the switch. */
static void branch_among(struct evaluation *e, struct instance *in, const uint32_t *at)
{
    e->source[in->label].end_label = e->label;
    e->goes_to = 0;
    put_merge(e, in);
    evaluate_copy(e, at);
    enter(e, at[2]);
    for (uint32_t i = 4; i < spv_length(at); i += 2) {
        bool again = at[i] == at[2];
        for (uint32_t j = 4; j < i; j += 2)
            again = again || at[j] == at[i];
        if (!again)
            enter(e, at[i]);
    }
}

/* Whether control can come to the current block from `from`, a block that a phi names. */
static bool arrives(const struct evaluation *e, const struct instance *in, uint32_t from)
{
    const struct source_id *block = &e->source[from];
    return block->reached && block->visited && block->end_label &&
           (!block->chosen || block->chosen == in->label);
}

static bool is_same_value(const struct evaluation *e, uint32_t a, uint32_t b)
{
    const struct result_id *x = &e->results[a], *y = &e->results[b];
    return a == b || (x->known && y->known && x->type == y->type && x->value == y->value);
}

static void walk_phi(struct evaluation *e, struct instance *in, const uint32_t *at)
{
    uint32_t length = spv_length(at), ways = 0, first = 0;
    bool same = true;
    for (uint32_t i = 3; i + 1 < length; i += 2) {
        if (!arrives(e, in, at[i + 1]))
            continue;
        uint32_t value = evaluate_id(e, at[i]);
        first = ways++ == 0 ? value : first;
        same = same && is_same_value(e, first, value);
    }
    if (ways != e->source[in->label].incoming || ways == 0 || e->source[in->label].begins_loop) {
        e->failed = true; /* it takes values from blocks that come later */
        return;
    }
    if (same) {
        e->source[at[2]].to = first;
        return;
    }
    evaluate_push(e, &e->body, spv_head(OP_PHI, 3 + 2 * ways));
    evaluate_push(e, &e->body, at[1]);
    evaluate_push(e, &e->body, evaluate_result(e, at));
    for (uint32_t i = 3; i + 1 < length; i += 2) {
        if (!arrives(e, in, at[i + 1]))
            continue;
        evaluate_push(e, &e->body, evaluate_id(e, at[i]));
        evaluate_push(e, &e->body, e->source[at[i + 1]].end_label);
    }
}

/* ---- Calls ---- */

static void walk_function(struct evaluation *e, struct instance *in, uint32_t function_at);

enum { WRAP_WORDS = 8, CALLS_DEEP = 64 };

/* For functions with several returns: wraps the function into the only case of a switch, which the
   returns break out of. take_back_wrap undoes this where only one of them is reached. */
static void begin_wrap(struct evaluation *e, struct instance *in)
{
    uint32_t selector = e->uint_type ? evaluate_constant(e, e->uint_type, 0) : 0;
    e->failed = e->failed || !selector;
    in->wrap = e->body.count;
    in->label_before = e->label;
    in->wrap_label = evaluate_new_id(e);
    EVALUATE_EMIT(e, &e->body, OP_SELECTION_MERGE, in->after, 0);
    EVALUATE_EMIT(e, &e->body, OP_SWITCH, selector, in->wrap_label);
    evaluate_begin_construct(e, in->after);
    put_label(e, in->wrap_label, false);
}

static void take_back_wrap(struct evaluation *e, const struct instance *in)
{
    for (uint32_t i = 0; i < WRAP_WORDS; ++i)
        e->body.words[in->wrap + i] = spv_head(OP_NOP, 1);
    e->constructs.count -= 2;
    e->results[in->wrap_label].same_as = in->label_before;
}

/* Ends an inlined call behind its last block. Returns the id of the call's value, or 0. */
static uint32_t end_call(struct evaluation *e, struct instance *in)
{
    if (e->failed || in->returns == 0) {
        e->failed = true;
        return 0;
    }
    if (in->return_waits && in->returns == 1) {
        if (in->wrap_label)
            take_back_wrap(e, in);
        return in->value;
    }
    end_return(e, in);
    put_label(e, in->after, false);
    if (!in->result_type)
        return 0;
    uint32_t value = evaluate_new_id(e);
    EVALUATE_EMIT(e, &e->body, OP_LOAD, in->result_type, value, in->variable);
    return value;
}

/* The word of the OpFunctionEnd of a function. */
static uint32_t end_of(const struct evaluation *e, uint32_t function_at)
{
    uint32_t at = function_at;
    while (spv_op(e->words + at) != OP_FUNCTION_END)
        at += spv_length(e->words + at);
    return at;
}

static void walk_call(struct evaluation *e, struct instance *caller, const uint32_t *call)
{
    uint32_t function_at = e->source[call[3]].at;
    const uint32_t *function = e->words + function_at;
    bool is_void = spv_op(e->words + e->source[call[1]].at) == OP_TYPE_VOID;
    struct instance in = {.caller = caller,
                          .depth = caller->depth + 1,
                          .result_type = is_void ? 0 : call[1],
                          .after = evaluate_new_id(e)};
    if (spv_op(function) != OP_FUNCTION || in.depth > CALLS_DEEP) {
        e->failed = true;
        return;
    }
    forget(e, function_at, end_of(e, function_at));
    evaluate_bind_parameters(e, call, function_at);
    if (e->source[call[3]].returns > 1)
        begin_wrap(e, &in);
    walk_function(e, &in, function_at);
    e->source[call[2]].to = end_call(e, &in);
}

static void walk_return(struct evaluation *e, struct instance *in, const uint32_t *at)
{
    if (!in->caller) {
        EVALUATE_EMIT(e, &e->body, OP_RETURN, );
        return;
    }
    if (in->loop_depth > 0) { /* SPIR-V lets control leave a loop by its merge block only */
        e->failed = true;
        return;
    }
    ++in->returns;
    in->return_waits = true;
    in->value = spv_op(at) == OP_RETURN_VALUE ? evaluate_id(e, at[1]) : 0;
}

/* ---- Instructions ---- */

/* Folds LogicalAnd, LogicalOr or Select where one known operand decides. True: it was folded. */
static bool decide(struct evaluation *e, const uint32_t *at)
{
    uint32_t op = spv_op(at);
    if (op != OP_LOGICAL_AND && op != OP_LOGICAL_OR && op != OP_SELECT)
        return false;
    uint32_t operands[2] = {evaluate_id(e, at[3]), evaluate_id(e, at[4])};
    const struct result_id first = e->results[operands[0]], second = e->results[operands[1]];
    if (op == OP_SELECT) {
        if (first.known)
            e->source[at[2]].to = evaluate_id(e, first.value ? at[4] : at[5]);
        return first.known;
    }
    uint32_t deciding = op == OP_LOGICAL_OR; /* the operand value that decides the result */
    if (!first.known && !second.known)
        return false;
    bool decided =
        (first.known && first.value == deciding) || (second.known && second.value == deciding);
    uint32_t other = first.known ? at[4] : at[3];
    e->source[at[2]].to = decided ? evaluate_constant(e, at[1], deciding) : evaluate_id(e, other);
    return true;
}

static void walk_plain(struct evaluation *e, const uint32_t *at)
{
    struct spirv_shape shape = spirv_shape(spv_op(at));
    uint32_t value;
    if (shape.result && evaluate_fold(e, spv_op(at), at[1], at + 3, spv_length(at) - 3, &value)) {
        e->source[at[2]].to = evaluate_constant(e, at[1], value);
        return;
    }
    if (decide(e, at))
        return;
    evaluate_copy(e, at);
    if (!e->failed && spv_op(at) == OP_ACCESS_CHAIN)
        e->results[evaluate_id(e, at[2])].base = e->results[evaluate_id(e, at[3])].base;
}

static void walk_variable(struct evaluation *e, const uint32_t *at)
{
    uint32_t id = add_variable(e, at[1]);
    e->source[at[2]].to = id;
    if (spv_length(at) > 4) /* an initializer counts at each call, not once in the kernel */
        EVALUATE_EMIT(e, &e->body, OP_STORE, id, evaluate_id(e, at[4]));
}

static void walk_instruction(struct evaluation *e, struct instance *in, const uint32_t *at)
{
    switch (spv_op(at)) {
    case OP_LABEL:
        begin_block(e, in, at[1]);
        return;
    case OP_VARIABLE:
        walk_variable(e, at);
        return;
    case OP_LOAD:
        evaluate_load(e, at);
        return;
    case OP_STORE:
        evaluate_store(e, at);
        return;
    case OP_PHI:
        walk_phi(e, in, at);
        return;
    case OP_FUNCTION_CALL:
        walk_call(e, in, at);
        return;
    case OP_LOOP_MERGE:
        if (in->label == in->unrolled)
            return;
        in->merge = (uint32_t)(at - e->words);
        return;
    case OP_SELECTION_MERGE:
        in->merge = (uint32_t)(at - e->words);
        return;
    case OP_BRANCH:
        branch_to(e, in, at[1]);
        return;
    case OP_BRANCH_CONDITIONAL:
        branch_either(e, in, at);
        return;
    case OP_RETURN:
    case OP_RETURN_VALUE:
        walk_return(e, in, at);
        return;
    case OP_SWITCH:
        branch_among(e, in, at);
        return;
    default:
        walk_plain(e, at);
    }
}

static void walk_words(struct evaluation *e, struct instance *in, uint32_t first, uint32_t end)
{
    for (uint32_t at = first; !e->failed && at < end;) {
        const uint32_t *instruction = e->words + at;
        in->resume_at = 0;
        if (!in->skips || spv_op(instruction) == OP_LABEL)
            walk_instruction(e, in, instruction);
        at = in->resume_at ? in->resume_at : at + spv_length(instruction);
    }
}

/* A call's first block continues the caller's current block. */
static void walk_function(struct evaluation *e, struct instance *in, uint32_t function_at)
{
    uint32_t at = function_at, end = end_of(e, function_at);
    while (spv_op(e->words + at) != OP_LABEL && at < end)
        at += spv_length(e->words + at);
    if (at == end) {
        e->failed = true;
        return;
    }
    in->label = e->words[at + 1];
    e->source[in->label].reached = e->source[in->label].visited = true;
    walk_words(e, in, at + 2, end);
}

/* ---- The module ---- */

static void walk_module(struct evaluation *e, uint32_t *spec_of, const uint32_t *spec,
                        uint32_t spec_count)
{
    struct instance in = {.caller = NULL};
    for (uint32_t id = 0; id < e->source_count; ++id) {
        bool set = spec_of[id] < spec_count;
        spec_of[id] = set ? spec[spec_of[id]] : 0;
        e->source[id].is_set = set;
        if (e->source[id].at && e->source[id].at < e->functions_at)
            e->source[id].to = id;
    }
    for (uint32_t at = SPV_HEADER_WORDS; at < e->functions_at; at += spv_length(e->words + at)) {
        uint32_t op = spv_op(e->words + at);
        if (op == OP_UNDEF || (op >= OP_TYPE_VOID && op <= OP_VARIABLE))
            evaluate_global(e, e->words + at, spec_of);
    }
    evaluate_count_writes(e);
    e->label = evaluate_new_id(e);
    e->first_label = e->label;
    evaluate_enter_block(e, e->label, false);
    if (!e->failed)
        walk_function(e, &in, e->source[e->entry].at);
}

/* False: the words are no SPIR-V module, or memory runs out. */
static bool begin(struct evaluation *e)
{
    if (e->count <= SPV_HEADER_WORDS || e->words[0] != SPV_MAGIC || e->words[3] == 0 ||
        e->words[3] > SPIRV_BOUND_MAX)
        return false;
    e->source_count = e->result_count = e->result_capacity = e->words[3];
    e->source = array_alloc(e->source_count, sizeof *e->source);
    e->results = array_alloc(e->source_count, sizeof *e->results);
    e->starved = !e->source || !e->results;
    if (e->starved)
        return false;
    /* These arrays take megabytes. A page that calloc() zeroed, that is first read and then
       written, faults twice; a page that is written faults once. */
    memset(e->source, 0, e->source_count * sizeof *e->source);
    memset(e->results, 0, e->source_count * sizeof *e->results);
    return true;
}

whit_result spirv_evaluate(const uint32_t *words, size_t word_count, const uint32_t *spec,
                           uint32_t spec_count, uint32_t **out, size_t *out_words)
{
    struct evaluation e = {.words = words, .count = (uint32_t)word_count};
    uint32_t *spec_of = NULL;
    *out = NULL;
    if (word_count < UINT32_MAX / 2 && begin(&e)) {
        spec_of = array_alloc(e.source_count, sizeof *spec_of);
        e.starved = !spec_of;
    }
    if (spec_of) {
        memset(spec_of, 0xff, e.source_count * sizeof *spec_of);
        if (evaluate_read(&e, spec_of)) {
            walk_module(&e, spec_of, spec, spec_count);
            bool refused = e.failed;
            *out = refused ? NULL : evaluate_write(&e, out_words);
            e.starved = e.starved || (!refused && !*out); /* only memory can be lacking */
        }
    }
    free(spec_of);
    free(e.source);
    free(e.results);
    free(e.globals.words);
    free(e.constants.words);
    free(e.variables.words);
    free(e.body.words);
    free(e.open.words);
    free(e.constructs.words);
    return *out ? WHIT_OK : e.starved ? WHIT_ERROR_MEMORY : WHIT_ERROR_INPUT;
}
