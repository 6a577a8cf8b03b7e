/* Makes loops of users end: each time that the header of a loop is reached, 1 is subtracted from
   whit_fuel. If that is 0 the loop is left, and the number of the first such loop is kept in
   whit_fuel_loop. */
#ifndef SHADER_FUEL_H
#define SHADER_FUEL_H

#include "shader/module.h"

/* Labels of the blocks of a rewritten loop. */
struct fuel_loop {
    uint32_t header, merge, out, in; /* `out`: leaves the loop without fuel; `in`: goes on */
};

struct fuel {
    struct shader_loop *loops; /* whit_fuel_loop has 1 + an index in this */
    uint32_t count, capacity;
    struct fuel_loop *blocks; /* loops of the current function */
    uint32_t block_count, block_capacity;
    uint32_t label; /* the current block */
    bool waits;     /* the guard follows after the current OpLoopMerge */
};

/* Rewrites an instruction of a user's function, before it would be copied. True: it, or its
   replacement, is in m->body. False: copy it as it is. */
bool fuel_take(struct fuel *fuel, struct spv_module *m, const uint32_t *words);

#endif
