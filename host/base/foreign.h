/* Foreign code that reads foreign files: it runs in a child, its answer is checked, and of a child
   that gave none there is one clear reason. */
#ifndef BASE_FOREIGN_H
#define BASE_FOREIGN_H

#include "base/child.h"
#include "base/log.h"

/* What the user may change. A zeroed one means the defaults. */
struct foreign_params {
    double cpu_s;          /* 0: 8, and 4 more for each 10 MB of the files, at most 60 */
    double clock_s;        /* 0: ten times cpu_s */
    uint64_t memory_bytes; /* 0: 4 GiB */
    bool require_sandbox;  /* where it cannot be set: an error in place of a warning */
    const volatile bool *cancel;
};

/* Limits for files of `size_bytes` together; `params` may be NULL. */
struct child_limits foreign_limits(const struct foreign_params *params, const char *who,
                                   uint64_t size_bytes, uint64_t reply_bytes);

enum { FOREIGN_REASON_BYTES = 768 };

/* child_run. Not WHIT_OK: `reason` says why there is no reply, and nothing is logged:
   WHIT_ERROR_INPUT, or _MEMORY (no child), _CANCELLED, _USAGE (a sandbox is required and not to be
   had). That it ran without one is a warning, once in the life of this process. */
WHIT_CHECK whit_result foreign_run(const whit_log *log, const struct child_limits *limits,
                                   int (*fn)(void *user, void *to, child_write write), void *user,
                                   struct child_reply *reply, char reason[FOREIGN_REASON_BYTES]);

/* Stands at the end of a reply, behind its data. */
struct foreign_answer {
    uint32_t result; /* a whit_result */
    uint32_t numbers[4];
    char reason[FOREIGN_REASON_BYTES];
};

/* What a child does for foreign_ask: writes data, fills in the answer's numbers, or its reason. */
typedef whit_result (*foreign_fn)(void *user, void *to, child_write write,
                                  struct foreign_answer *answer);

/* foreign_run for functions with answers. WHIT_OK: *reply is the data, `answer` what it says of
   them, neither to be believed but for the result and that the reason is text; else `answer` has
   the reason, and there is no reply. */
WHIT_CHECK whit_result foreign_ask(const whit_log *log, const struct child_limits *limits,
                                   foreign_fn fn, void *user, struct child_reply *reply,
                                   struct foreign_answer *answer);

/* Text of a child as one line, without blanks at its end; of what it quotes, only as much as a
   message may. Whoever shows it has to do so by whit_text_show, as the log does. */
void foreign_text(const void *text, size_t bytes, char *out, size_t out_bytes);

#endif
