/* Replaces child_run, with --wrap at link time: the child's side runs in this process, so that
   sanitizers see it, and thousands of files are tried quickly. */
#ifndef TESTS_CHILD_IN_PLACE_H
#define TESTS_CHILD_IN_PLACE_H

#include <stdlib.h>
#include <string.h>

#include "base/child.h"

enum child_end __wrap_child_run(const struct child_limits *limits,
                                int (*fn)(void *user, void *to, child_write write), void *user,
                                struct child_reply *reply);
void __wrap_child_reply_free(struct child_reply *reply);

static inline bool in_place_write(void *to, const void *data, size_t size_bytes)
{
    struct child_reply *written = to;
    uint8_t *moved = realloc(written->data, written->size_bytes + size_bytes + 1);
    if (!moved)
        abort();
    written->data = moved;
    memcpy(written->data + written->size_bytes, data, size_bytes);
    written->size_bytes += size_bytes;
    return true;
}

/* Runs `fn` in this process. `then`, which may be NULL, changes its reply. */
static inline enum child_end child_in_place(int (*fn)(void *user, void *to, child_write write),
                                            void *user, struct child_reply *reply,
                                            void (*then)(struct child_reply *reply))
{
    struct child_reply written = {0};
    written.exit_code = fn(user, &written, in_place_write);
    if (then)
        then(&written);
    *reply = written;
    /* A block of exactly the reply's length, so that sanitizers see reads beyond it; aligned like a
       mapping. */
    reply->data = written.size_bytes ? malloc(written.size_bytes) : NULL;
    if (reply->data)
        memcpy(reply->data, written.data, written.size_bytes);
    free(written.data);
    if (written.exit_code == CHILD_EXIT_MEMORY)
        return CHILD_MEMORY;
    return reply->data ? CHILD_DONE : CHILD_REPLY;
}

void __wrap_child_reply_free(struct child_reply *reply)
{
    free(reply->data);
    *reply = (struct child_reply){0};
}

#endif
