#include "shader/zeros.h"

/* An array of so many bytes is set by a loop: drivers make stores of a constant's elements, and
   take time by the square of their number. An iteration sets LOOP_BYTES, since drivers limit
   iterations, too. */
enum { LOOP_BYTES = 256 };

/* The number of elements that an iteration sets. */
static uint32_t chunk_of(const struct spv_module *m, uint32_t element)
{
    uint64_t bytes = spv_size(m, element);
    return bytes > 0 && bytes < LOOP_BYTES ? (uint32_t)(LOOP_BYTES / bytes) : 1;
}

/* The number of elements of an array that a loop sets; 0: it is none. */
static uint32_t looped(const struct spv_module *m, uint32_t pointer)
{
    const uint32_t *def = spv_def(m, pointer), *type = NULL;
    uint32_t count = 0;
    if (def && spv_op(def) == OP_TYPE_POINTER && spv_length(def) == 4)
        type = spv_def(m, def[3]);
    if (!type || spv_op(type) != OP_TYPE_ARRAY || !spv_constant_value(m, type[3], &count))
        return 0;
    return spv_size(m, def[3]) >= LOOP_BYTES ? count : 0;
}

bool zeros_begin(struct zeros *z, struct spv_module *m, const uint32_t *words)
{
    uint32_t op = spv_op(words);
    bool first = op == OP_LABEL && z->enters;
    z->enters = op == OP_FUNCTION || (z->enters && op != OP_LABEL);
    if (!first || !m->user_function)
        return false;
    bool needed = false;
    for (const uint32_t *at = words + spv_length(words);
         spv_op(at) == OP_VARIABLE || spv_op(at) == OP_LINE || spv_op(at) == OP_NO_LINE;
         at += spv_length(at))
        needed = needed || (spv_op(at) == OP_VARIABLE && spv_length(at) == 4 && looped(m, at[1]));
    if (!needed)
        return false;
    z->label = words[1];
    z->index = m->next_id++;
    uint32_t label = m->next_id++;
    SPV_EMIT(m, OP_LABEL, label);
    SPV_EMIT(m, OP_VARIABLE, spv_pointer(m, spv_uint(m)), z->index, STORAGE_FUNCTION);
    return true;
}

static void put_element(struct spv_module *m, uint32_t array, uint32_t element, uint32_t at)
{
    uint32_t to = m->next_id++;
    SPV_EMIT(m, OP_ACCESS_CHAIN, spv_pointer(m, element), to, array, at);
    SPV_EMIT(m, OP_STORE, to, spv_null(m, element));
}

static void put_loop(const struct zeros *z, struct spv_module *m, uint32_t array, uint32_t element,
                     uint32_t count)
{
    uint32_t u = spv_uint(m), header = m->next_id++, test = m->next_id++, body = m->next_id++,
             next = m->next_id++, merge = m->next_id++, i = m->next_id++, goes_on = m->next_id++,
             more = m->next_id++;
    uint32_t chunk = chunk_of(m, element), whole = count - count % chunk;
    SPV_EMIT(m, OP_STORE, z->index, spv_constant(m, u, 0));
    SPV_EMIT(m, OP_BRANCH, header);
    SPV_EMIT(m, OP_LABEL, header);
    SPV_EMIT(m, OP_LOOP_MERGE, merge, next, 0);
    SPV_EMIT(m, OP_BRANCH, test);
    SPV_EMIT(m, OP_LABEL, test);
    SPV_EMIT(m, OP_LOAD, u, i, z->index);
    SPV_EMIT(m, OP_U_LESS_EQUAL, spv_bool(m), goes_on, i, spv_constant(m, u, whole - 1));
    SPV_EMIT(m, OP_BRANCH_CONDITIONAL, goes_on, body, merge);
    SPV_EMIT(m, OP_LABEL, body);
    for (uint32_t k = 0; k < chunk; ++k) {
        uint32_t at = m->next_id++;
        SPV_EMIT(m, OP_I_ADD, u, at, i, spv_constant(m, u, k));
        put_element(m, array, element, at);
    }
    SPV_EMIT(m, OP_BRANCH, next);
    SPV_EMIT(m, OP_LABEL, next);
    SPV_EMIT(m, OP_I_ADD, u, more, i, spv_constant(m, u, chunk));
    SPV_EMIT(m, OP_STORE, z->index, more);
    SPV_EMIT(m, OP_BRANCH, header);
    SPV_EMIT(m, OP_LABEL, merge);
    for (uint32_t k = whole; k < count; ++k)
        put_element(m, array, element, spv_constant(m, u, k));
}

void zeros_put(const struct zeros *z, struct spv_module *m, uint32_t pointer, uint32_t id)
{
    const uint32_t *def = spv_def(m, pointer);
    uint32_t count = looped(m, pointer);
    if (count)
        put_loop(z, m, id, spv_def(m, def[3])[2], count);
    else if (def && spv_length(def) == 4)
        SPV_EMIT(m, OP_STORE, id, spv_null(m, def[3]));
}

void zeros_end(struct zeros *z, struct spv_module *m)
{
    if (!z->label)
        return;
    SPV_EMIT(m, OP_BRANCH, z->label);
    SPV_EMIT(m, OP_LABEL, z->label);
    z->label = 0;
}
