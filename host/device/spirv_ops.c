#include "device/spirv_ops.h"

static const struct spirv_shape unknown;

/* Whether an instruction has a result, only ids as operands, and no other effect. */
static bool is_plain(uint32_t op)
{
    return op == OP_UNDEF || op == OP_ACCESS_CHAIN || op == OP_COMPOSITE_CONSTRUCT ||
           op == OP_COPY_OBJECT || op == OP_IMAGE || op == OP_COPY_LOGICAL ||
           op == OP_VECTOR_EXTRACT_DYNAMIC || op == OP_VECTOR_INSERT_DYNAMIC ||
           op == OP_TRANSPOSE || (op >= OP_CONVERT_FIRST && op <= OP_BITCAST) ||
           (op >= OP_S_NEGATE && op <= OP_S_MUL_EXTENDED) ||
           (op >= OP_ANY && op <= OP_F_UNORD_GREATER_EQUAL) ||
           (op >= OP_SHIFT_RIGHT && op <= OP_BIT_COUNT) || op == OP_PHI;
}

struct spirv_shape spirv_shape(uint32_t op)
{
    const uint32_t all = UINT32_MAX;
    if (is_plain(op))
        return (struct spirv_shape){true, true, false, all};
    if (op >= OP_ATOMIC_LOAD && op <= OP_ATOMIC_XOR && op != OP_ATOMIC_STORE)
        return (struct spirv_shape){true, true, true, all};
    if (op >= OP_GROUP_ELECT && op <= OP_GROUP_SHUFFLE_XOR && op != OP_GROUP_BALLOT_BIT_COUNT)
        return (struct spirv_shape){true, true, true, all};
    switch (op) {
    case OP_GROUP_BALLOT_BIT_COUNT: /* operands: scope, kind of count, value */
    case OP_GROUP_I_ADD:
    case OP_GROUP_U_MAX:
        return (struct spirv_shape){true, true, true, all & ~2u};
    case OP_EXT_INST: /* the first operands are a set and a number */
        return (struct spirv_shape){true, true, false, all & ~2u};
    case OP_VARIABLE: /* the first operand is a storage class */
        return (struct spirv_shape){true, true, false, all & ~1u};
    case OP_LOAD:
    case OP_ARRAY_LENGTH: /* operands: a buffer, and the number of its member */
    case OP_COMPOSITE_EXTRACT:
        return (struct spirv_shape){true, true, false, 1};
    case OP_VECTOR_SHUFFLE:
    case OP_COMPOSITE_INSERT:
        return (struct spirv_shape){true, true, false, 3};
    case OP_IMAGE_FETCH: /* operands: image, coordinate, kinds of further operands */
        return (struct spirv_shape){true, true, false, all & ~4u};
    case OP_IMAGE_WRITE: /* operands: image, coordinate, texel, kinds of further operands */
        return (struct spirv_shape){true, false, true, all & ~8u};
    case OP_STORE:
    case OP_LOOP_MERGE:
        return (struct spirv_shape){true, false, true, 3};
    case OP_SELECTION_MERGE:
    case OP_BRANCH:
    case OP_RETURN_VALUE:
        return (struct spirv_shape){true, false, true, 1};
    case OP_BRANCH_CONDITIONAL:
        return (struct spirv_shape){true, false, true, 7};
    case OP_SWITCH: /* operands: selector, default, then numbers and labels */
        return (struct spirv_shape){true, false, true, 0xaaaaaaab};
    case OP_ATOMIC_STORE:
        return (struct spirv_shape){true, false, true, all};
    case OP_RETURN:
    case OP_UNREACHABLE:
    case OP_NOP:
        return (struct spirv_shape){true, false, true, 0};
    default:
        return unknown;
    }
}

static bool fold_two(uint32_t op, uint32_t a, uint32_t b, uint32_t *out)
{
    switch (op) {
    case OP_I_ADD:
        *out = a + b;
        return true;
    case OP_I_SUB:
        *out = a - b;
        return true;
    case OP_I_MUL:
        *out = a * b;
        return true;
    case OP_LOGICAL_EQUAL:
    case OP_I_EQUAL:
        *out = a == b;
        return true;
    case OP_LOGICAL_NOT_EQUAL:
    case OP_I_NOT_EQUAL:
        *out = a != b;
        return true;
    case OP_U_GREATER:
        *out = a > b;
        return true;
    case OP_U_GREATER_EQUAL:
        *out = a >= b;
        return true;
    case OP_U_LESS:
        *out = a < b;
        return true;
    case OP_U_LESS_EQUAL:
        *out = a <= b;
        return true;
    case OP_LOGICAL_OR:
    case OP_BITWISE_OR:
        *out = a | b;
        return true;
    case OP_LOGICAL_AND:
    case OP_BITWISE_AND:
        *out = a & b;
        return true;
    case OP_BITWISE_XOR:
        *out = a ^ b;
        return true;
    case OP_SHIFT_RIGHT:
        *out = b < 32 ? a >> b : 0;
        return b < 32; /* larger shifts are undefined */
    case OP_SHIFT_LEFT:
        *out = b < 32 ? a << b : 0;
        return b < 32;
    default:
        return false;
    }
}

bool spirv_fold(uint32_t op, const uint32_t *values, uint32_t count, uint32_t *out)
{
    if (count == 1 && op == OP_LOGICAL_NOT) {
        *out = !values[0];
        return true;
    }
    if (count == 1 && op == OP_NOT) {
        *out = ~values[0];
        return true;
    }
    if (count == 3 && op == OP_SELECT) {
        *out = values[0] ? values[1] : values[2];
        return true;
    }
    return count == 2 && fold_two(op, values[0], values[1], out);
}
