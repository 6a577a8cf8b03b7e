/* Parallel loops over a fixed number of threads, and single threads. */
#ifndef BASE_THREADS_H
#define BASE_THREADS_H

#include <stdbool.h>
#include <stdint.h>

/* Usable cores of this machine, at least 1. */
uint32_t threads_available(void);

/* Whether there is address space for the stacks of `count` more threads. */
bool threads_have_room(uint32_t count);

/* Calls fn(context, i) once for every i in [0, count), from at most `thread_count` threads (0:
   threads_available()), including the caller's; returns when all calls are done. Items are handed
   out one by one, in order, so each should be large. If a thread cannot be started, the others do
   its work. */
void threads_for(uint32_t thread_count, uint32_t count, void (*fn)(void *context, uint32_t index),
                 void *context);

/* A thread that calls fn(context) once. NULL when it cannot be started. */
struct thread;
struct thread *thread_start(void (*fn)(void *context), void *context);
/* Waits for the thread's end and frees it; NULL is fine. */
void thread_join(struct thread *thread);

#endif
