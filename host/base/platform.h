/* What POSIX gives and C does not. Everything that a port would change is in platform.c, child.c,
   sandbox.c, file.c, clock.c and threads.c. */
#ifndef BASE_PLATFORM_H
#define BASE_PLATFORM_H

#include <stddef.h>
#include <stdint.h>

#include "whit/whit_base.h"

/* From here on threads share a few heaps, so that what one gave back is there for the next: for
   programs that go on long, and start many threads. Before any thread. */
void platform_share_heaps(void);
/* Gives the system back what is free between blocks that are not: milliseconds, in which threads
   that allocate may wait. */
void platform_trim_heaps(void);

/* These will all be written: in large pages, as small ones take longer to come by than to fill. */
void platform_expect_much(void *data, size_t size_bytes);
/* Makes all of it zero. Where its pages are the process's own they go back to the system, so that
   only what is written later takes memory and time. */
void platform_zero(void *data, size_t size_bytes);

/* The most that this process, or any one of its finished children, had resident. */
uint64_t platform_peak_memory_bytes(void);
/* Resident memory of this process at this moment: all of it, and the anonymous part. Both are 0
   where the system does not say. */
void platform_memory_bytes(uint64_t *all, uint64_t *anonymous);

#endif
