/* Follows what variables hold while a kernel is evaluated.

   What a variable holds is known in the blocks that come after the instruction that wrote or read
   it on every way. SPIR-V nests blocks in constructs: selections and loops. A region is the blocks
   at the same level of a branch of a selection, or of a loop. A region stays open until its
   construct ends. What became known in a region holds in that region and in those nested in it, up
   to the next write. */
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
