/* Functions that POSIX has and C does not. A port to another system would change platform.c,
   child.c, sandbox.c, file.c, clock.c, cores.c and threads.c. */
#ifndef BASE_PLATFORM_H
#define BASE_PLATFORM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "whit/whit_base.h"

/* Makes threads share a few heaps from here on, so that memory that one has freed serves the next:
   for programs that run long and start many threads. Call it before any thread starts. */
void platform_share_heaps(void);
/* Gives free memory inside the heaps back to the system. Takes milliseconds, in which threads that
   allocate may wait. */
void platform_trim_heaps(void);

enum { LARGE_PAGE_BYTES = 2 << 20 };
/* Asks for large pages for memory that will all be written: small pages take longer to get than to
   fill. */
void platform_expect_much(void *data, size_t size_bytes);
/* Zeroes memory. Pages that are the process's own go back to the system, so that only those written
   later take memory and time. */
void platform_zero(void *data, size_t size_bytes);

/* Whether the processor takes long to read an element of a vector of 64 bytes that was just
   written: on Intel's with AVX-512 3.5 ns, where two vectors of 32 bytes take 1.5. */
bool platform_reads_back_slowly(void);

/* Whether there is address space for so many bytes more. */
bool platform_has_room(size_t bytes);

/* Reads up to the end of the file, at most `bytes`, whatever signals come; gives how many, or -1
   with errno. */
ssize_t platform_read(int fd, void *data, size_t bytes);
/* Writes all of it, whatever signals come. False, with errno: it could not. */
bool platform_write(int fd, const void *data, size_t bytes);

/* The largest resident memory that this process, or any one of its finished children, has had. */
uint64_t platform_peak_memory_bytes(void);
/* Resident memory of this process at this moment: all of it, and the anonymous part. Both are 0
   where the system does not say. */
void platform_memory_bytes(uint64_t *all, uint64_t *anonymous);

#endif
