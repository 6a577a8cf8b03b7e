/* Finds loops of the form that glslang gives to `[[unroll]] for`:

       header: LoopMerge merge next Unroll; Branch test
       test:   c = i < n; BranchConditional c body merge
       body:   ...
       next:   i = i + step; Branch header
       merge:  */
#include "device/evaluate_loops.h"
#include "device/evaluate_memory.h"

enum { LOOP_UNROLL = 1 }; /* bit of the operand "loop control" of OpLoopMerge */

/* The instruction behind the one at word `at`. */
static uint32_t behind(const struct evaluation *e, uint32_t at)
{
    return at + spv_length(e->words + at);
}

static bool is_op(const struct evaluation *e, uint32_t at, uint32_t op, uint32_t length)
{
    return at < e->count && spv_op(e->words + at) == op && spv_length(e->words + at) == length;
}

static bool known_value(const struct evaluation *e, uint32_t id, uint32_t *value)
{
    const struct result_id *result = &e->results[e->source[id].to];
    *value = result->value;
    return e->source[id].to && result->known;
}

/* The instructions that change and test the variable. */
struct counting {
    uint32_t compare, limit; /* opcode, and the known operand on its right side */
    uint32_t change, step;
    uint32_t body, next, merge; /* ids of blocks */
};

static bool read_test(const struct evaluation *e, struct counted_loop *loop, struct counting *c)
{
    uint32_t at = loop->first;
    const uint32_t *merge = e->words + behind(e, at);
    if (!is_op(e, behind(e, at), OP_LOOP_MERGE, 4) || !(merge[3] & LOOP_UNROLL))
        return false;
    c->merge = merge[1];
    c->next = merge[2];
    at = behind(e, behind(e, at));
    uint32_t label = behind(e, at), load = behind(e, label), compare = behind(e, load),
             branch = behind(e, compare);
    if (!is_op(e, at, OP_BRANCH, 2) || !is_op(e, label, OP_LABEL, 2) ||
        e->words[at + 1] != e->words[label + 1] || !is_op(e, load, OP_LOAD, 4) ||
        spv_length(e->words + compare) != 5 || !is_op(e, branch, OP_BRANCH_CONDITIONAL, 4))
        return false;
    loop->type = e->words[load + 1];
    loop->variable = e->words[load + 3];
    c->compare = spv_op(e->words + compare);
    c->body = e->words[branch + 2];
    return e->words[compare + 3] == e->words[load + 2] &&
           known_value(e, e->words[compare + 4], &c->limit) &&
           e->words[branch + 1] == e->words[compare + 2] && e->words[branch + 3] == c->merge;
}

static bool read_change(const struct evaluation *e, struct counted_loop *loop, struct counting *c)
{
    uint32_t label = e->source[c->next].at, load = behind(e, label), change = behind(e, load),
             store = behind(e, change), branch = behind(e, store);
    loop->end = e->source[c->merge].at;
    if (!is_op(e, load, OP_LOAD, 4) || spv_length(e->words + change) != 5 ||
        !is_op(e, store, OP_STORE, 3) || !is_op(e, branch, OP_BRANCH, 2))
        return false;
    c->change = spv_op(e->words + change);
    return e->words[load + 3] == loop->variable && e->words[change + 3] == e->words[load + 2] &&
           known_value(e, e->words[change + 4], &c->step) &&
           e->words[store + 1] == loop->variable && e->words[store + 2] == e->words[change + 2] &&
           e->words[branch + 1] == loop->header && behind(e, branch) == loop->end;
}

/* Whether an instruction of the loop's body allows it to be unrolled. */
static bool allows(const struct evaluation *e, uint32_t at, const struct counted_loop *loop,
                   const struct counting *c, uint32_t *nexts)
{
    const uint32_t *words = e->words + at;
    uint32_t op = spv_op(words), length = spv_length(words);
    if (op == OP_RETURN || op == OP_RETURN_VALUE || op == OP_UNREACHABLE)
        return false;
    for (uint32_t i = 1; i < length; ++i) {
        bool branches =
            op == OP_BRANCH || op == OP_BRANCH_CONDITIONAL || op == OP_SWITCH || op == OP_PHI;
        if (words[i] == loop->variable && !(op == OP_LOAD && i == 3))
            return false;
        if (branches && (words[i] == c->merge || words[i] == loop->header))
            return false;
        *nexts += branches && words[i] == c->next;
    }
    return true;
}

static bool check_body(const struct evaluation *e, const struct counted_loop *loop,
                       const struct counting *c)
{
    uint32_t nexts = 0, end = e->source[c->next].at;
    for (uint32_t at = e->source[c->body].at; at < end; at = behind(e, at)) {
        if (!allows(e, at, loop, c, &nexts))
            return false;
    }
    return nexts == 1;
}

static bool count_trips(struct counted_loop *loop, const struct counting *c)
{
    for (loop->trips = 0; loop->trips <= UNROLL_TRIPS_MAX; ++loop->trips) {
        uint32_t value = loop->values[loop->trips], again = 0;
        if (!spirv_fold(c->compare, (uint32_t[]){value, c->limit}, 2, &again))
            return false;
        if (!again)
            return loop->trips > 0;
        if (loop->trips < UNROLL_TRIPS_MAX &&
            !spirv_fold(c->change, (uint32_t[]){value, c->step}, 2, &loop->values[loop->trips + 1]))
            return false;
    }
    return false;
}

bool evaluate_counted_loop(const struct evaluation *e, uint32_t header, struct counted_loop *loop)
{
    struct counting c = {0};
    *loop = (struct counted_loop){.header = header, .first = e->source[header].at};
    if (!read_test(e, loop, &c) || !read_change(e, loop, &c) || !check_body(e, loop, &c))
        return false;
    uint32_t first = evaluate_held(e, loop->variable);
    loop->values[0] = e->results[first].value;
    return first && e->results[first].known && count_trips(loop, &c);
}
