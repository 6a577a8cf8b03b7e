/* The types, constants and global variables of a kernel. Its specialization constants are filled
   in. */
#ifndef DEVICE_EVALUATE_CONSTANTS_H
#define DEVICE_EVALUATE_CONSTANTS_H

#include "device/evaluate.h"

/* Writes the type, constant or global variable at `at`, which keeps its id. values[id]: the
   caller's value of a specialization constant, where is_set. */
void evaluate_global(struct evaluation *e, const uint32_t *at, const uint32_t *values);
/* The output id of a constant: a bool or 32-bit integer. Added where it is missing. */
uint32_t evaluate_constant(struct evaluation *e, uint32_t type, uint32_t value);
/* The type of pointers to `type` in storage class Function; added where it is missing. */
uint32_t evaluate_pointer_type(struct evaluation *e, uint32_t type);
/* Computes an operation on `count` input ids. False: an operand is not known, or spirv_fold does
   not handle it. */
bool evaluate_fold(const struct evaluation *e, uint32_t op, uint32_t type, const uint32_t *operands,
                   uint32_t count, uint32_t *value);

#endif
