/* The shared memory of fault_sweep and the library that it preloads. */
#ifndef FAULT_H
#define FAULT_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

/* The environment variable with the number of the descriptor of the shared memory. */
#define FAULT_VARIABLE "WHIT_FAULT_SWEEP"

enum { FAULT_CALLERS = 6 };

/* Kinds of calls, as bits. */
enum fault_calls {
    FAULT_CALLS_MEMORY = 1, /* memory and threads; these fail with NULL, ENOMEM, EAGAIN */
    FAULT_CALLS_WRITE = 2,  /* files that are written; these fail with ENOSPC */
    FAULT_CALLS_VULKAN = 4, /* functions that return a VkResult; these fail with `code` */
    FAULT_CALLS_CLOCK = 8,  /* readings of the monotonic clock */
    FAULT_CALLS_ALL = 15,
    FAULT_CALLS_READ = 16, /* files that are read or looked at, and child processes; these fail with
                              the errno `code` */
};

enum fault_event {
    FAULT_FAILS,  /* The call fails. */
    FAULT_SIGNAL, /* The signal `code` is raised before the call. */
    FAULT_CLOCK,  /* The clock jumps ahead by an hour. */
};

struct fault_shared {
    uint32_t counted; /* kinds of calls */
    uint32_t event;   /* what happens; but for FAULT_FAILS the program's clock stands still */
    uint32_t at;      /* the call at which it happens, from 1; 0: never */
    int32_t code;
    int32_t then;    /* the signal at the call after that; SIGALRM only if a timer runs; 0: none */
    int64_t step_ns; /* by which each reading turns a clock that stands still */
    char from[128];  /* parts of names of libraries whose calls count besides the program's own */
    _Atomic uint32_t seen, fired;
    uint32_t timer_ms;              /* that the program last set its timer to */
    _Atomic uint32_t submits_later; /* submissions to a queue since then, that call included; none
                                       where the clock jumped before a time limit had begun */
    int64_t live;  /* blocks that the program itself took and nobody gave back, at its end; -1: it
                      did not get so far */
    char what[48]; /* the call at which it happened */
    uint64_t callers[FAULT_CALLERS]; /* within the program, innermost first, for addr2line */
};

#endif
