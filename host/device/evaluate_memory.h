/* Follows what variables hold while a kernel is evaluated.

   Once an instruction has written or read a variable, the value is known in all blocks that can be
   reached only through that instruction, up to the next write. SPIR-V nests blocks in constructs:
   selections and loops. A region is the part of a construct in which each block can be reached only
   through the blocks before it, such as one branch of a selection. A region stays open until its
   construct ends; what is known in it is also known in the regions nested in it. */
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
/* Begins an output block. `follows`: the block before it is the only way to it. */
void evaluate_enter_block(struct evaluation *e, uint32_t label, bool follows);
/* Begins a construct that ends at the block `merge`, an output id. */
void evaluate_begin_construct(struct evaluation *e, uint32_t merge);
/* Begins the loop of the input block `header`: what it writes anywhere is not known at its begin.
 */
void evaluate_begin_loop(struct evaluation *e, uint32_t header);
void evaluate_load(struct evaluation *e, const uint32_t *instruction);
void evaluate_store(struct evaluation *e, const uint32_t *instruction);
/* Sets the function's parameters to the arguments of the OpFunctionCall at `call`. */
void evaluate_bind_parameters(struct evaluation *e, const uint32_t *call, uint32_t function_at);

#endif
