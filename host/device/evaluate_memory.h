/* Follows what variables hold while a kernel is evaluated. */
#ifndef DEVICE_EVALUATE_MEMORY_H
#define DEVICE_EVALUATE_MEMORY_H

#include "device/evaluate.h"

/* Counts the instructions that write to each variable and parameter, also through calls. */
void evaluate_count_writes(struct evaluation *e);
/* The output id of the value behind `pointer`, an input id; 0: not known. */
uint32_t evaluate_held(const struct evaluation *e, uint32_t pointer);
/* Tells that the instructions in words [first, end) are written several times: what they store may
   differ, so that no variable always holds what a single instruction stores in it. */
void evaluate_repeat_writes(struct evaluation *e, uint32_t first, uint32_t end);
void evaluate_load(struct evaluation *e, const uint32_t *instruction);
void evaluate_store(struct evaluation *e, const uint32_t *instruction);
/* Sets the function's parameters to the arguments of the OpFunctionCall at `call`. */
void evaluate_bind_parameters(struct evaluation *e, const uint32_t *call, uint32_t function_at);

#endif
