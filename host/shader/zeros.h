/* The user's variables begin as 0: stores in front of a function's other instructions. */
#ifndef SHADER_ZEROS_H
#define SHADER_ZEROS_H

#include "shader/module.h"

struct zeros {
    bool enters;    /* the label of a function's first block is to come */
    uint32_t label; /* of the block behind all stores, if they are in blocks of their own */
    uint32_t index; /* the variable that loops over elements count in */
};

/* Whether this begins the first block of a function with large arrays: a block for the stores is
   put in its place. Call it for each instruction. */
bool zeros_begin(struct zeros *z, struct spv_module *m, const uint32_t *words);
/* Sets a variable to 0. `pointer`: its type. */
void zeros_put(const struct zeros *z, struct spv_module *m, uint32_t pointer, uint32_t id);
/* Goes on in the function's first block. */
void zeros_end(struct zeros *z, struct spv_module *m);

#endif
