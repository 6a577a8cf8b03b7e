/* A process that stays alive and answers requests, each in a sandboxed child of its own. */
#ifndef BASE_KEEP_H
#define BASE_KEEP_H

#include "base/child.h"

struct keep;

/* `prepare` runs once in the process before its first request; NULL: nothing does. `answer` runs in
   a child of it for each request, with the bytes of the request, as fn of child_run does. */
struct keep_work {
    void (*prepare)(void);
    int (*answer)(const void *request, size_t bytes, void *to, child_write write);
};

/* Forks: the new process has the caller's memory as it is now, none of its descriptors, and ends
   when the caller does, or at keep_stop. NULL: it cannot be started. */
struct keep *keep_start(const struct keep_work *work);
/* Ends the process and waits for its end. NULL is fine. */
void keep_stop(struct keep *keep);

/* child_run of `answer` in that process; one thread at a time. CHILD_NOT_STARTED with *alive false:
   the process has ended, and must be started anew. When *limits->cancel becomes true, the process
   is ended. */
enum child_end keep_run(struct keep *keep, const struct child_limits *limits, const void *request,
                        size_t bytes, struct child_reply *reply, bool *alive);

#endif
