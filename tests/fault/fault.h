/* What fault_sweep and the library it preloads tell each other, in shared memory. */
#ifndef FAULT_H
#define FAULT_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* The environment variable with the number of the descriptor of the shared memory. */
#define FAULT_VARIABLE "WHIT_FAULT_SWEEP"

enum { FAULT_CALLERS = 6 };

enum fault_kind {
    FAULT_ALLOC,  /* memory and threads: NULL, ENOMEM, EAGAIN */
    FAULT_WRITE,  /* files that are written: ENOSPC */
    FAULT_VULKAN, /* calls that return a VkResult: `code` */
};

struct fault_shared {
    uint32_t kind, at; /* the call that fails, from 1; 0: none */
    int32_t code;
    char from[128]; /* parts of names of libraries whose calls count besides the program's own */
    _Atomic uint32_t seen, fired;
    int64_t live;  /* blocks that the program itself took and nobody gave back, at its end; -1: it
                      did not get so far */
    char what[48]; /* the call that failed */
    uint64_t callers[FAULT_CALLERS]; /* within the program, innermost first, for addr2line */
};

#endif
