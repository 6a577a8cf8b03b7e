/* Single SPIR-V instructions, for partial evaluation (evaluate.h): tells which words of an
   instruction are ids, and computes its result where the operands are known. */
#ifndef DEVICE_SPIRV_OPS_H
#define DEVICE_SPIRV_OPS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/spirv.h"

/* Words of an instruction's head: the word of length and opcode, and with a result also its type
   and id. */
enum { HEAD_WORDS = 1, HEAD_WORDS_RESULT = 3 };

/* The operands of an instruction within a function. `ids`: bit i is set if word i behind the head
   is an id; bit 30 stands for all even words from word 30 on, bit 31 for all odd ones. */
struct spirv_shape {
    bool known;
    bool result;  /* has a type and an id */
    bool effects; /* does more than give a result */
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
