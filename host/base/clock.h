#ifndef BASE_CLOCK_H
#define BASE_CLOCK_H

#include <sys/types.h>

/* Milliseconds of a clock that never jumps; only differences mean anything. */
double clock_ms(void);
/* CPU milliseconds used by all threads of this process. */
double clock_cpu_ms(void);
/* CPU milliseconds that another process has used since its start; 0 where the system cannot say. */
double clock_of_process_ms(pid_t pid);

#endif
