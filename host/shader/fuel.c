#include "shader/fuel.h"

#include "base/array.h"

/* Stores the number of a loop that has run out of fuel, unless another loop's is there. */
static void put_number(struct spv_module *m, uint32_t number)
{
    uint32_t u = spv_uint(m), zero = spv_constant(m, u, 0);
    uint32_t before = m->next_id++, first = m->next_id++, after = m->next_id++;
    SPV_EMIT(m, OP_LOAD, u, before, m->fuel_loop);
    SPV_EMIT(m, OP_I_EQUAL, spv_bool(m), first, before, zero);
    SPV_EMIT(m, OP_SELECT, u, after, first, spv_constant(m, u, number), before);
    SPV_EMIT(m, OP_STORE, m->fuel_loop, after);
}

/* Adds a guard to the header of a loop: a block that leaves the loop without fuel, and a block
   where it goes on, which gets the header's former end. */
static void put_guard(struct fuel *fuel, struct spv_module *m)
{
    struct fuel_loop *loop = &fuel->blocks[fuel->block_count - 1];
    uint32_t u = spv_uint(m), guard = m->next_id++, left = m->next_id++, none = m->next_id++,
             less = m->next_id++;
    loop->out = m->next_id++;
    loop->in = m->next_id++;
    SPV_EMIT(m, OP_BRANCH, guard);
    SPV_EMIT(m, OP_LABEL, guard);
    SPV_EMIT(m, OP_LOAD, u, left, m->fuel);
    SPV_EMIT(m, OP_I_EQUAL, spv_bool(m), none, left, spv_constant(m, u, 0));
    SPV_EMIT(m, OP_SELECTION_MERGE, loop->in, 0);
    SPV_EMIT(m, OP_BRANCH_CONDITIONAL, none, loop->out, loop->in);
    SPV_EMIT(m, OP_LABEL, loop->out);
    if (m->fuel_loop)
        put_number(m, fuel->count);
    SPV_EMIT(m, OP_BRANCH, loop->merge);
    SPV_EMIT(m, OP_LABEL, loop->in);
    SPV_EMIT(m, OP_I_SUB, u, less, left, spv_constant(m, u, 1));
    SPV_EMIT(m, OP_STORE, m->fuel, less);
}

static void begin_loop(struct fuel *fuel, struct spv_module *m, const uint32_t *words)
{
    const struct shader_loop loop = {m->place.file, m->place.line};
    const struct fuel_loop blocks = {.header = fuel->label, .merge = words[1]};
    if (!ARRAY_PUSH(fuel->loops, fuel->count, fuel->capacity, loop) ||
        !ARRAY_PUSH(fuel->blocks, fuel->block_count, fuel->block_capacity, blocks))
        m->failed = true;
    fuel->waits = !m->failed;
    spv_put(m, &m->body, words, spv_length(words));
}

/* Updates the predecessors of an OpPhi: headers of loops now end in block `in`, and merge blocks
   have `out` as one more predecessor, with a value of zero. */
static void put_phi(const struct fuel *fuel, struct spv_module *m, const uint32_t *words)
{
    uint32_t length = spv_length(words), at = m->body.count;
    spv_put(m, &m->body, words, length);
    for (uint32_t i = 0; i < fuel->block_count && !m->failed; ++i) {
        const struct fuel_loop *loop = &fuel->blocks[i];
        for (uint32_t j = 4; j < length; j += 2) {
            if (words[j] == loop->header)
                m->body.words[at + j] = loop->in;
        }
        if (loop->merge == fuel->label) {
            const uint32_t more[] = {spv_null(m, words[1]), loop->out};
            spv_put(m, &m->body, more, 2);
            if (!m->failed)
                m->body.words[at] += 2u << 16;
        }
    }
}

bool fuel_take(struct fuel *fuel, struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words);
    if (fuel->waits && op != OP_LINE && op != OP_NO_LINE) {
        fuel->waits = false;
        put_guard(fuel, m);
    }
    switch (op) {
    case OP_FUNCTION:
        fuel->block_count = 0;
        return false;
    case OP_LABEL:
        fuel->label = words[1];
        return false;
    case OP_LOOP_MERGE:
        begin_loop(fuel, m, words);
        return true;
    case OP_PHI:
        put_phi(fuel, m, words);
        return true;
    default:
        return false;
    }
}
