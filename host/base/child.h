/* Child processes that run one function on foreign files and send back a reply. */
#ifndef BASE_CHILD_H
#define BASE_CHILD_H

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

/* Exit code of a child whose memory ran out. */
enum { CHILD_EXIT_MEMORY = 120 };

/* The way in which a child process ended. */
enum child_end {
    CHILD_DONE,      /* returned; its whole reply was received */
    CHILD_CRASHED,   /* died of a signal */
    CHILD_FORBIDDEN, /* killed at a system call that the sandbox does not allow */
    CHILD_TIME,      /* ran past its time limit and was killed */
    CHILD_MEMORY,    /* asked for more memory than allowed */
    CHILD_REPLY,     /* replied with more than the limit, or not at all */
    CHILD_NOT_STARTED,
    CHILD_OPEN,      /* the sandbox was required and could not be set up: nothing ran */
    CHILD_CANCELLED, /* *cancel became true while it ran */
};

struct child_limits {
    const char *who;       /* "importer": what runs, for messages */
    double cpu_s;          /* processor time, so that the load of the machine does not matter */
    double clock_s;        /* elapsed time; 0: ten times cpu_s */
    uint64_t memory_bytes; /* address space, beyond what is mapped at the fork; 0: no limit */
    uint64_t reply_bytes;  /* largest reply */
    bool require_sandbox;  /* nothing runs where it cannot be set up */
    const volatile bool *cancel; /* polled, may be NULL */
};

struct child_reply {
    uint8_t *data; /* mapped by the call; give back with child_reply_free */
    size_t size_bytes;
    int signal; /* with CHILD_CRASHED */
    int exit_code;
    int open_because; /* errno of setting up the sandbox: it ran without; 0: it ran in it */
};

/* Writes bytes of the child's reply; false when there is no room for them. */
typedef bool (*child_write)(void *to, const void *data, size_t size_bytes);

typedef int (*child_fn)(void *user, void *to, child_write write);

/* Forks and runs fn(user, to, write) in the child, in the sandbox (sandbox.h): fn must not touch
   Vulkan, threads or files; its standard output and error go nowhere. Its return value is the
   child's exit code, 0 to 119, or CHILD_EXIT_MEMORY when its memory ran out. A child that wrote
   nothing ends as CHILD_REPLY, with its exit code. */
enum child_end child_run(const struct child_limits *limits, child_fn fn, void *user,
                         struct child_reply *reply);
void child_reply_free(struct child_reply *reply);
/* The elapsed time that these limits allow, in seconds; 0: no limit. */
double child_clock_limit_s(const struct child_limits *limits);
/* Between these two calls, child_run in other threads waits before it forks. For foreign code that
   takes locks, such as loading a library: a child forked meanwhile would find them held. */
void child_hold_forks(void);
void child_release_forks(void);
/* fork() as child_run does it: it waits while forks are held, and the child starts with all signals
   blocked. The child sets its handlers, and then the signal mask *before. child_run works in such a
   child too. */
pid_t child_fork(sigset_t *before);
/* A forked child calls this first. It moves the descriptor `fd` to the number `at`, puts /dev/null
   at all numbers below, and lets signals do what they do by default, but for SIGINT and SIGPIPE,
   which it ignores. False: there is no descriptor `at`. */
bool child_settle(int fd, int at);

#endif
