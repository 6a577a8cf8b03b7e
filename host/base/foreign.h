/* Runs foreign code that reads foreign files in a child process, checks its answer, and gives one
   clear reason where there is none. */
#ifndef BASE_FOREIGN_H
#define BASE_FOREIGN_H

#include "base/child.h"
#include "base/log.h"

/* Limits that the user may change. A zeroed struct means the defaults. */
struct foreign_params {
    double cpu_s;          /* 0: 8, and 4 more for each 10 MB of the files, at most 60 */
    double clock_s;        /* 0: ten times cpu_s */
    uint64_t memory_bytes; /* 0: 4 GiB */
    bool require_sandbox;  /* if it cannot be set up: an error instead of a warning */
    const volatile bool *cancel;
};

/* Limits for files of `size_bytes` together; `params` may be NULL. */
struct child_limits foreign_limits(const struct foreign_params *params, const char *who,
                                   uint64_t size_bytes, uint64_t reply_bytes);

enum { FOREIGN_REASON_BYTES = 768 };

/* Calls child_run. If not WHIT_OK, `reason` says why there is no reply, and nothing is logged:
   WHIT_ERROR_INPUT, or _MEMORY (no child), _CANCELLED, _USAGE (a sandbox is required and cannot be
   set up). A run without the sandbox is logged as a warning, once in a process. */
WHIT_CHECK whit_result foreign_run(const whit_log *log, const struct child_limits *limits,
                                   child_fn fn, void *user, struct child_reply *reply,
                                   char reason[FOREIGN_REASON_BYTES]);

/* The end of a reply, behind its data. */
struct foreign_answer {
    uint32_t result; /* a whit_result */
    uint32_t numbers[4];
    char reason[FOREIGN_REASON_BYTES];
};

/* The function that foreign_ask runs in a child: it writes data, and fills in the answer's numbers
   or its reason. WHIT_ERROR_MEMORY without a reason means the limit on memory. */
typedef whit_result (*foreign_fn)(void *user, void *to, child_write write,
                                  struct foreign_answer *answer);

/* foreign_run for functions with answers. With WHIT_OK, *reply is the data and `answer` describes
   it; neither is trusted, but `result` is valid and `reason` is text. Otherwise `answer` has the
   reason, and there is no reply. */
WHIT_CHECK whit_result foreign_ask(const whit_log *log, const struct child_limits *limits,
                                   foreign_fn fn, void *user, struct child_reply *reply,
                                   struct foreign_answer *answer);

/* Makes one line of a child's text, without blanks at its end; of what the text quotes it keeps
   only as much as a message may quote. Show it through whit_text_show, as the log does. */
void foreign_text(const void *text, size_t bytes, char *out, size_t out_bytes);

#endif
