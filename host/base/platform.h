/* What POSIX gives and C does not. Everything that a port would change is in platform.c, file.c,
   clock.c and threads.c. */
#ifndef BASE_PLATFORM_H
#define BASE_PLATFORM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/whit_base.h"

/* Exit code of a child whose memory ran out. */
enum { CHILD_EXIT_MEMORY = 120 };

/* How a child process ended. */
enum child_end {
    CHILD_DONE,    /* returned; its whole reply was received */
    CHILD_CRASHED, /* died of a signal */
    CHILD_TIME,    /* ran past its time limit and was killed */
    CHILD_MEMORY,  /* asked for more memory than allowed */
    CHILD_REPLY,   /* replied with more than the limit, or not at all */
    CHILD_NOT_STARTED,
    CHILD_CANCELLED, /* *cancel became true while it ran */
};

struct child_limits {
    double time_s;               /* wall clock; 0: no limit */
    uint64_t memory_bytes;       /* address space, beyond what is mapped at the fork; 0: no limit */
    uint64_t reply_bytes;        /* largest reply */
    const volatile bool *cancel; /* polled, may be NULL */
};

struct child_reply {
    uint8_t *data; /* mapped by the call; give back with child_reply_free */
    size_t size_bytes;
    int signal; /* with CHILD_CRASHED */
    int exit_code;
};

/* Writes bytes of the child's reply; false when the parent is gone. */
typedef bool (*child_write)(void *to, const void *data, size_t size_bytes);

/* Forks and runs fn(user, to, write) in the child, which must not touch Vulkan, threads or
   terminals; its standard output and error go nowhere. fn's return value is the exit code, 0 to
   119, or CHILD_EXIT_MEMORY when its memory ran out. A child that wrote nothing ends as
   CHILD_REPLY, with its exit code. */
enum child_end child_run(const struct child_limits *limits,
                         int (*fn)(void *user, void *to, child_write write), void *user,
                         struct child_reply *reply);
void child_reply_free(struct child_reply *reply);

/* Between these two, child_run of other threads waits with its fork: around foreign code that holds
   locks, such as loading a library, which a child would find held for ever. */
void platform_hold_forks(void);
void platform_release_forks(void);

/* From here on threads share a few heaps, so that what one gave back is there for the next: for
   programs that go on long, and start many threads. Before any thread. */
void platform_share_heaps(void);
/* Gives the system back what is free between blocks that are not: milliseconds, in which threads
   that allocate may wait. */
void platform_trim_heaps(void);

bool platform_is_terminal(int fd);
/* The most that this process, or any one of its finished children, had resident. */
uint64_t platform_peak_memory_bytes(void);
/* Resident memory of this process at this moment: all of it, and the anonymous part. Both are 0
   where the system does not say. */
void platform_memory_bytes(uint64_t *all, uint64_t *own);
/* Sets *flag at SIGINT and SIGTERM; a second signal removes unfinished files and ends at once. */
void platform_catch_interrupts(volatile bool *flag);

#endif
