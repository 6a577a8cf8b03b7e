#include "shader/repairs.h"

enum { GLSL_TRUNC = 3, GLSL_MODF = 35, GLSL_UNPACK_HALF = 62 };

static uint32_t put_function(struct spv_module *m, const uint32_t *like, uint32_t function,
                             uint32_t argument)
{
    uint32_t id = m->next_id++;
    SPV_EMIT(m, OP_EXT_INST, like[1], id, like[3], function, argument);
    return id;
}

/* The whole part is x without its fraction, which is exact. */
static void put_modf(struct spv_module *m, const uint32_t *words)
{
    uint32_t whole = put_function(m, words, GLSL_TRUNC, words[5]);
    SPV_EMIT(m, OP_F_SUB, words[1], words[2], words[5], whole);
    SPV_EMIT(m, OP_STORE, words[6], whole);
}

/* Each half is unpacked as the lower one. */
static void put_unpack_half(struct spv_module *m, const uint32_t *words)
{
    uint32_t u = spv_uint(m), upper = m->next_id++;
    SPV_EMIT(m, OP_SHIFT_RIGHT, u, upper, words[5], spv_constant(m, u, 16));
    uint32_t x = put_function(m, words, GLSL_UNPACK_HALF, words[5]);
    uint32_t y = put_function(m, words, GLSL_UNPACK_HALF, upper);
    SPV_EMIT(m, OP_VECTOR_SHUFFLE, words[1], words[2], x, y, 0, 2);
}

bool repairs_take(struct spv_module *m, const uint32_t *words)
{
    if (spv_op(words) != OP_EXT_INST || words[3] != m->glsl)
        return false;
    if (words[4] == GLSL_MODF && spv_length(words) == 7)
        put_modf(m, words);
    else if (words[4] == GLSL_UNPACK_HALF && spv_length(words) == 6)
        put_unpack_half(m, words);
    else
        return false;
    return true;
}
