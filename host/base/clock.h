#ifndef BASE_CLOCK_H
#define BASE_CLOCK_H

/* Milliseconds of a clock that never jumps; only differences mean anything. */
double clock_ms(void);
/* CPU milliseconds used by all threads of this process. */
double clock_cpu_ms(void);

#endif
