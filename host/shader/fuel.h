/* Loops of users that end: each time that the start of one is reached, one is taken from whit_fuel,
   and where that is 0 the loop is left, with the number of the first one in whit_fuel_loop. */
#ifndef SHADER_FUEL_H
#define SHADER_FUEL_H

#include "shader/module.h"

/* The loop whose header is in hand. */
struct fuel_loop {
    uint32_t header, merge, out, in; /* blocks: the loop's own, where it is left and goes on */
};

struct fuel {
    struct shader_loop *loops; /* numbered from 1 as whit_fuel_loop has them */
    uint32_t count, capacity;
    struct fuel_loop *blocks; /* of the function in hand */
    uint32_t block_count, block_capacity;
    uint32_t label; /* the block in hand */
    bool waits;     /* for the end of a header */
};

/* Takes an instruction of a user's function, before it is copied. True: it stands in m->body
   already, as itself or as what replaces it. */
bool fuel_take(struct fuel *fuel, struct spv_module *m, const uint32_t *words);

#endif
