/* What partial evaluation (evaluate.h) knows of single SPIR-V instructions: numbers of the
   specification (SPIR-V 1.5, 3.32), which of their words are ids, and what they give for known
   operands. */
#ifndef DEVICE_SPIRV_OPS_H
#define DEVICE_SPIRV_OPS_H

#include <stdbool.h>
#include <stdint.h>

enum spirv_op {
    OP_NOP = 0,
    OP_UNDEF = 1,
    OP_SOURCE_CONTINUED = 2,
    OP_LINE = 8,
    OP_EXTENSION = 10,
    OP_EXT_INST_IMPORT = 11,
    OP_EXT_INST = 12,
    OP_MEMORY_MODEL = 14,
    OP_ENTRY_POINT = 15,
    OP_EXECUTION_MODE = 16,
    OP_CAPABILITY = 17,
    OP_TYPE_VOID = 19,
    OP_TYPE_BOOL = 20,
    OP_TYPE_INT = 21,
    OP_TYPE_FLOAT = 22,
    OP_TYPE_VECTOR = 23,
    OP_TYPE_MATRIX = 24,
    OP_TYPE_IMAGE = 25,
    OP_TYPE_POINTER = 32,
    OP_TYPE_FUNCTION = 33,
    OP_CONSTANT_TRUE = 41,
    OP_CONSTANT_FALSE = 42,
    OP_CONSTANT = 43,
    OP_CONSTANT_COMPOSITE = 44,
    OP_SPEC_CONSTANT_TRUE = 48,
    OP_SPEC_CONSTANT_FALSE = 49,
    OP_SPEC_CONSTANT = 50,
    OP_SPEC_CONSTANT_COMPOSITE = 51,
    OP_SPEC_CONSTANT_OP = 52,
    OP_FUNCTION = 54,
    OP_FUNCTION_PARAMETER = 55,
    OP_FUNCTION_END = 56,
    OP_FUNCTION_CALL = 57,
    OP_VARIABLE = 59,
    OP_LOAD = 61,
    OP_STORE = 62,
    OP_ACCESS_CHAIN = 65,
    OP_ARRAY_LENGTH = 68,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    OP_VECTOR_EXTRACT_DYNAMIC = 77,
    OP_VECTOR_INSERT_DYNAMIC = 78,
    OP_VECTOR_SHUFFLE = 79,
    OP_COMPOSITE_CONSTRUCT = 80,
    OP_COMPOSITE_EXTRACT = 81,
    OP_COMPOSITE_INSERT = 82,
    OP_COPY_OBJECT = 83,
    OP_TRANSPOSE = 84,
    OP_IMAGE_FETCH = 95,
    OP_IMAGE_WRITE = 99,
    OP_IMAGE = 100,
    OP_CONVERT_FIRST = 109,
    OP_BITCAST = 124,
    OP_S_NEGATE = 126,
    OP_I_ADD = 128,
    OP_I_SUB = 130,
    OP_I_MUL = 132,
    OP_S_MUL_EXTENDED = 152,
    OP_ANY = 154,
    OP_LOGICAL_EQUAL = 164,
    OP_LOGICAL_NOT_EQUAL = 165,
    OP_LOGICAL_OR = 166,
    OP_LOGICAL_AND = 167,
    OP_LOGICAL_NOT = 168,
    OP_SELECT = 169,
    OP_I_EQUAL = 170,
    OP_I_NOT_EQUAL = 171,
    OP_U_GREATER = 172,
    OP_U_GREATER_EQUAL = 174,
    OP_U_LESS = 176,
    OP_U_LESS_EQUAL = 178,
    OP_F_UNORD_GREATER_EQUAL = 191,
    OP_SHIFT_RIGHT = 194,
    OP_SHIFT_LEFT = 196,
    OP_BITWISE_OR = 197,
    OP_BITWISE_XOR = 198,
    OP_BITWISE_AND = 199,
    OP_NOT = 200,
    OP_BIT_COUNT = 205,
    OP_ATOMIC_LOAD = 227,
    OP_ATOMIC_STORE = 228,
    OP_ATOMIC_XOR = 242,
    OP_PHI = 245,
    OP_LOOP_MERGE = 246,
    OP_SELECTION_MERGE = 247,
    OP_LABEL = 248,
    OP_BRANCH = 249,
    OP_BRANCH_CONDITIONAL = 250,
    OP_SWITCH = 251,
    OP_RETURN = 253,
    OP_RETURN_VALUE = 254,
    OP_UNREACHABLE = 255,
    OP_NO_LINE = 317,
    OP_MODULE_PROCESSED = 330,
    OP_GROUP_ELECT = 333,
    OP_GROUP_BALLOT_BIT_COUNT = 342,
    OP_GROUP_SHUFFLE_XOR = 346,
    OP_GROUP_I_ADD = 349,
    OP_GROUP_U_MAX = 357,
    OP_COPY_LOGICAL = 400,
};

enum { STORAGE_FUNCTION = 7 };
enum { CAPABILITY_INT64 = 11 };
enum {
    DECORATION_SPEC_ID = 1,
    DECORATION_BUILTIN = 11,
    DECORATION_BINDING = 33,
    DECORATION_NO_CONTRACTION = 42,
};

/* Words of an instruction's head: the length and number, and with a result its type and id. */
enum { HEAD_WORDS = 1, HEAD_WORDS_RESULT = 3 };

/* An instruction in front of others, `words` of its own. */
static inline uint32_t spirv_head(enum spirv_op op, uint32_t words)
{
    return words << 16 | (uint32_t)op;
}

/* The operands of an instruction within a function. `ids`: bit i is set if word i behind the head
   is an id; from word 30 on, even words use bit 30 and odd ones bit 31. */
struct spirv_shape {
    bool known;
    bool result;  /* has a type and an id */
    bool effects; /* of more than its result */
    uint32_t ids;
};

struct spirv_shape spirv_shape(uint32_t op);

static inline bool spirv_operand_is_id(struct spirv_shape shape, uint32_t i)
{
    return shape.ids >> (i < 30 ? i : 30 + i % 2) & 1;
}

/* Computes an operation on bools (0 or 1) or 32-bit integers. False: it is not handled here. */
bool spirv_fold(uint32_t op, const uint32_t *values, uint32_t count, uint32_t *out);

#endif
