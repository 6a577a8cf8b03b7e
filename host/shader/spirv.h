/* Single SPIR-V instructions (SPIR-V 1.5): what is read and written of modules that glslang made.
 */
#ifndef SHADER_SPIRV_H
#define SHADER_SPIRV_H

#include <stdint.h>

enum {
    SPV_MAGIC = 0x07230203,
    SPV_HEADER_WORDS = 5,
    SPV_BOUND_AT = 3, /* the word of the header that all ids are below */
    SPV_BOUND_MAX = 1 << 24,
};

/* Numbers of section 3.32. */
enum {
    SPV_UNDEF = 1,
    SPV_SOURCE_CONTINUED = 2,
    SPV_SOURCE = 3,
    SPV_SOURCE_EXTENSION = 4,
    SPV_NAME = 5,
    SPV_MEMBER_NAME = 6,
    SPV_STRING = 7,
    SPV_LINE = 8,
    SPV_EXTENSION = 10,
    SPV_EXT_INST_IMPORT = 11,
    SPV_EXT_INST = 12,
    SPV_ENTRY_POINT = 15,
    SPV_CAPABILITY = 17,
    SPV_TYPE_VOID = 19,
    SPV_TYPE_BOOL = 20,
    SPV_TYPE_INT = 21,
    SPV_TYPE_FLOAT = 22,
    SPV_TYPE_VECTOR = 23,
    SPV_TYPE_MATRIX = 24,
    SPV_TYPE_ARRAY = 28,
    SPV_TYPE_RUNTIME_ARRAY = 29,
    SPV_TYPE_STRUCT = 30,
    SPV_TYPE_POINTER = 32,
    SPV_TYPE_FUNCTION = 33,
    SPV_CONSTANT_TRUE = 41,
    SPV_CONSTANT = 43,
    SPV_CONSTANT_NULL = 46,
    SPV_SPEC_CONSTANT_TRUE = 48,
    SPV_SPEC_CONSTANT = 50,
    SPV_SPEC_CONSTANT_OP = 52,
    SPV_FUNCTION = 54,
    SPV_FUNCTION_PARAMETER = 55,
    SPV_FUNCTION_END = 56,
    SPV_FUNCTION_CALL = 57,
    SPV_VARIABLE = 59,
    SPV_IMAGE_TEXEL_POINTER = 60,
    SPV_LOAD = 61,
    SPV_STORE = 62,
    SPV_COPY_MEMORY = 63,
    SPV_ACCESS_CHAIN = 65,
    SPV_IN_BOUNDS_ACCESS_CHAIN = 66,
    SPV_ARRAY_LENGTH = 68,
    SPV_DECORATE = 71,
    SPV_MEMBER_DECORATE = 72,
    SPV_VECTOR_EXTRACT_DYNAMIC = 77,
    SPV_VECTOR_INSERT_DYNAMIC = 78,
    SPV_VECTOR_SHUFFLE = 79,
    SPV_COMPOSITE_EXTRACT = 81,
    SPV_COMPOSITE_INSERT = 82,
    SPV_IMAGE_FIRST = 86, /* OpSampledImage to OpImageQuerySamples */
    SPV_IMAGE_LAST = 107,
    SPV_BITCAST = 124,
    SPV_F_NEGATE = 127,
    SPV_F_ADD = 129,
    SPV_I_SUB = 130,
    SPV_F_SUB = 131,
    SPV_F_MUL = 133,
    SPV_F_DIV = 136,
    SPV_F_REM = 140,
    SPV_F_MOD = 141,
    SPV_VECTOR_TIMES_SCALAR = 142,
    SPV_DOT = 148,
    SPV_SELECT = 169,
    SPV_I_EQUAL = 170,
    SPV_DPDX_FIRST = 207,
    SPV_FWIDTH_LAST = 215,
    SPV_CONTROL_BARRIER = 224,
    SPV_MEMORY_BARRIER = 225,
    SPV_ATOMIC_FIRST = 227,
    SPV_ATOMIC_LAST = 242,
    SPV_PHI = 245,
    SPV_LOOP_MERGE = 246,
    SPV_SELECTION_MERGE = 247,
    SPV_LABEL = 248,
    SPV_BRANCH = 249,
    SPV_BRANCH_CONDITIONAL = 250,
    SPV_SWITCH = 251,
    SPV_KILL = 252,
    SPV_RETURN = 253,
    SPV_RETURN_VALUE = 254,
    SPV_UNREACHABLE = 255,
    SPV_NO_LINE = 317,
    SPV_MODULE_PROCESSED = 330,
    SPV_GROUP_FIRST = 333, /* subgroups */
    SPV_GROUP_LAST = 366,
};

enum {
    SPV_STORAGE_UNIFORM = 2,
    SPV_STORAGE_WORKGROUP = 4,
    SPV_STORAGE_PRIVATE = 6,
    SPV_STORAGE_FUNCTION = 7,
    SPV_STORAGE_BUFFER = 12,
};

enum { SPV_DECORATION_SPEC_ID = 1, SPV_DECORATION_NO_CONTRACTION = 42 };
enum { SPV_GLSL_UMIN = 38, SPV_GLSL_UMAX = 41 }; /* of GLSL.std.450 */

static inline uint32_t spv_op(const uint32_t *words)
{
    return words[0] & 0xffff;
}

static inline uint32_t spv_length(const uint32_t *words)
{
    return words[0] >> 16;
}

static inline uint32_t spv_head(uint32_t op, uint32_t length)
{
    return length << 16 | op;
}

#endif
