#include "shader/bounds.h"

#include <string.h>

enum { CHAIN_MAX = 64 };

/* The length of the array, vector or matrix that is indexed. */
struct extent {
    bool fixed;        /* the length is the constant `count` */
    uint32_t count;    /* 0: no elements, or not known */
    uint32_t count_id; /* if not `fixed`: id of the length; 0: there is none */
    bool is_uint;      /* `count_id` is a uint, not only an int */
};

static struct extent extent_of(const struct spv_module *m, uint32_t type)
{
    const uint32_t *def = spv_def(m, type);
    struct extent extent = {0};
    if (!def || spv_length(def) < 4)
        return extent;
    if (spv_op(def) == OP_TYPE_VECTOR || spv_op(def) == OP_TYPE_MATRIX)
        return (struct extent){.fixed = true, .count = def[3]};
    if (spv_op(def) != OP_TYPE_ARRAY)
        return extent;
    extent.fixed = spv_constant_value(m, def[3], &extent.count);
    extent.count_id = def[3];
    return extent;
}

/* The value `id` as a uint; 0: it is not an integer of 32 bits. */
static uint32_t as_uint(struct spv_module *m, uint32_t id)
{
    uint32_t u = spv_uint(m), type = spv_type_of(m, id);
    if (type == u)
        return id;
    const uint32_t *def = spv_def(m, type);
    if (!def || spv_op(def) != OP_TYPE_INT || def[2] != 32)
        return 0;
    uint32_t cast = m->next_id++;
    SPV_EMIT(m, OP_BITCAST, u, cast, id);
    return cast;
}

static uint32_t last_of(struct spv_module *m, struct extent extent)
{
    uint32_t u = spv_uint(m);
    if (extent.fixed)
        return spv_constant(m, u, extent.count - 1);
    uint32_t count = extent.is_uint ? extent.count_id : as_uint(m, extent.count_id),
             some = m->next_id++, last = m->next_id++;
    SPV_EMIT(m, OP_EXT_INST, u, some, m->glsl, GLSL_UMAX, count, spv_constant(m, u, 1));
    SPV_EMIT(m, OP_I_SUB, u, last, some, spv_constant(m, u, 1));
    return last;
}

/* The id of `index` clamped to `extent`; 0 and *why if it cannot be. */
static uint32_t clamp(struct spv_module *m, uint32_t index, struct extent extent, const char **why)
{
    uint32_t value, u = spv_uint(m);
    if (extent.fixed && spv_constant_value(m, index, &value) && value < extent.count)
        return index;
    uint32_t from = as_uint(m, index);
    if (!from || !m->glsl || (extent.fixed ? extent.count == 0 : extent.count_id == 0)) {
        *why = from ? "an index into what has no known length"
                    : "an index that is no integer of 32 bits";
        return 0;
    }
    uint32_t last = last_of(m, extent), id = m->next_id++;
    SPV_EMIT(m, OP_EXT_INST, u, id, m->glsl, GLSL_UMIN, from, last);
    return id;
}

/* The length of the array at the end of a buffer. `chain`: an access chain from the buffer's
   variable; `depth`: indices before the one into the array. */
static struct extent extent_of_buffer(struct spv_module *m, const uint32_t *chain, uint32_t depth)
{
    uint32_t member, u = spv_uint(m);
    struct extent extent = {0};
    const uint32_t *pointer = spv_def(m, spv_type_of(m, chain[3]));
    const uint32_t *block = pointer ? spv_def(m, pointer[3]) : NULL;
    if (depth != 1 || !block || spv_op(block) != OP_TYPE_STRUCT ||
        !spv_constant_value(m, chain[4], &member))
        return extent;
    extent.count_id = m->next_id++;
    extent.is_uint = true;
    SPV_EMIT(m, OP_ARRAY_LENGTH, u, extent.count_id, chain[3], member);
    return extent;
}

static uint32_t element_of(const struct spv_module *m, uint32_t type, uint32_t index)
{
    const uint32_t *def = spv_def(m, type);
    uint32_t member;
    if (!def || spv_length(def) < 3)
        return 0;
    if (spv_op(def) != OP_TYPE_STRUCT)
        return def[2];
    return spv_constant_value(m, index, &member) && member < spv_length(def) - 2 ? def[2 + member]
                                                                                 : 0;
}

static bool take_chain(struct spv_module *m, const uint32_t *words, const char **why)
{
    uint32_t length = spv_length(words), out[CHAIN_MAX];
    const uint32_t *pointer = spv_def(m, spv_type_of(m, words[3]));
    if (length > CHAIN_MAX || !pointer || spv_op(pointer) != OP_TYPE_POINTER) {
        *why = "an index of a kind that is not known here";
        return false;
    }
    memcpy(out, words, length * sizeof *out);
    uint32_t type = pointer[3];
    for (uint32_t i = 4; i < length && !*why; ++i) {
        const uint32_t *def = spv_def(m, type);
        uint32_t op = def ? spv_op(def) : 0;
        if (op == OP_TYPE_RUNTIME_ARRAY)
            out[i] = clamp(m, words[i], extent_of_buffer(m, words, i - 4), why);
        else if (op != OP_TYPE_STRUCT)
            out[i] = clamp(m, words[i], extent_of(m, type), why);
        type = element_of(m, type, words[i]);
    }
    if (*why)
        return false;
    spv_put(m, &m->body, out, length);
    return true;
}

static bool take_vector(struct spv_module *m, const uint32_t *words, const char **why)
{
    uint32_t length = spv_length(words), out[6];
    bool extracts = spv_op(words) == OP_VECTOR_EXTRACT_DYNAMIC;
    if (length != (extracts ? 5u : 6u)) {
        *why = "an index of a kind that is not known here";
        return false;
    }
    memcpy(out, words, length * sizeof *out);
    uint32_t type = extracts ? spv_type_of(m, words[3]) : words[1];
    out[length - 1] = clamp(m, words[length - 1], extent_of(m, type), why);
    if (*why)
        return false;
    spv_put(m, &m->body, out, length);
    return true;
}

bool bounds_take(struct spv_module *m, const uint32_t *words, const char **why)
{
    switch (spv_op(words)) {
    case OP_ACCESS_CHAIN:
    case OP_IN_BOUNDS_ACCESS_CHAIN:
        return take_chain(m, words, why);
    case OP_VECTOR_EXTRACT_DYNAMIC:
    case OP_VECTOR_INSERT_DYNAMIC:
        return take_vector(m, words, why);
    default:
        return false;
    }
}
