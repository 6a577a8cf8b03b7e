/* Loops that glslang marks with Unroll, and whose number of iterations is known. */
#ifndef DEVICE_EVALUATE_LOOPS_H
#define DEVICE_EVALUATE_LOOPS_H

#include "device/evaluate.h"

/* The driver unrolls such loops too, but only after it has optimized the kernel with them, and then
   optimizes it again. With 1 or 2 iterations kernels are made in 0.7 to 0.8 of the time if they are
   unrolled before; with 4 in the same time. */
enum { UNROLL_TRIPS_MAX = 2 };

/* A loop `for (i = first; i < end; i += step)`, with words of the input module. */
struct counted_loop {
    uint32_t header;                       /* id of the block that begins the loop */
    uint32_t first, end;                   /* words of the loop's blocks: [first, end) */
    uint32_t variable, type;               /* ids of i, and of its type */
    uint32_t trips;                        /* number of iterations */
    uint32_t values[UNROLL_TRIPS_MAX + 1]; /* of i: [trips] ends the loop */
};

/* Whether the block `header` begins a loop that can be written as its iterations one after the
   other: only its test leaves it, nothing else writes its variable, and it has 1 to
   UNROLL_TRIPS_MAX iterations. */
bool evaluate_counted_loop(const struct evaluation *e, uint32_t header, struct counted_loop *loop);

#endif
