#include "base/foreign.h"

#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

#define DEFAULT_TIME_S       60.0
#define DEFAULT_MEMORY_BYTES (UINT64_C(4) << 30)

struct child_limits foreign_limits(const struct foreign_params *params, const char *who,
                                   uint64_t size_bytes, uint64_t reply_bytes)
{
    const struct foreign_params none = {0}, *p = params ? params : &none;
    /* Less time for small files, so that damaged ones fail soon. */
    double cpu_s = fmin(8.0 + 4.0 * (double)size_bytes / 10e6, DEFAULT_TIME_S);
    return (struct child_limits){
        .who = who,
        .cpu_s = p->cpu_s > 0.0 ? p->cpu_s : cpu_s,
        .clock_s = p->clock_s,
        .memory_bytes = p->memory_bytes ? p->memory_bytes : DEFAULT_MEMORY_BYTES,
        .reply_bytes = reply_bytes,
        .require_sandbox = p->require_sandbox,
        .cancel = p->cancel,
    };
}

void foreign_text(const void *text, size_t bytes, char *out, size_t out_bytes)
{
    const char *from = text;
    size_t used = 0, quoted = 0;
    for (size_t i = 0; i < bytes && used + 1 < out_bytes && from[i]; ++i) {
        quoted = from[i] == '"' ? !quoted : quoted + (quoted > 0);
        if (quoted <= TEXT_TOKEN_CHARACTERS + 1)
            out[used++] = (char)(from[i] == '\n' || from[i] == '\r' ? ' ' : from[i]);
    }
    while (used && out[used - 1] == ' ')
        used--;
    out[used] = 0;
}

static whit_result explain(enum child_end end, const struct child_limits *limits,
                           const struct child_reply *reply, char reason[FOREIGN_REASON_BYTES])
{
    const size_t max = FOREIGN_REASON_BYTES;
    const char *who = limits->who;
    switch (end) {
    case CHILD_DONE:
        return WHIT_OK;
    case CHILD_CRASHED:
        snprintf(reason, max, "the %s crashed on this file (signal %d)", who, reply->signal);
        return WHIT_ERROR_INPUT;
    case CHILD_FORBIDDEN:
        snprintf(reason, max, "the %s tried on this file what it may not, and was stopped", who);
        return WHIT_ERROR_INPUT;
    case CHILD_TIME:
        snprintf(reason, max,
                 "the %s did not finish within %.3g s of the processor's time, or %.3g s by the "
                 "clock (--import-limit S gives it more)",
                 who, limits->cpu_s, child_clock_limit_s(limits));
        return WHIT_ERROR_INPUT;
    case CHILD_MEMORY:
        snprintf(reason, max,
                 "the %s asked for more than %.4g MiB of memory, half of --memory-limit", who,
                 (double)limits->memory_bytes / 1048576.0);
        return WHIT_ERROR_INPUT;
    case CHILD_CANCELLED:
        snprintf(reason, max, "loading was cancelled");
        return WHIT_ERROR_CANCELLED;
    case CHILD_NOT_STARTED:
        snprintf(reason, max, "the %s's process could not be started: %s", who, strerror(errno));
        return WHIT_ERROR_MEMORY;
    case CHILD_OPEN:
        snprintf(reason, max, "the %s cannot be locked in here (%s), and that is required", who,
                 strerror(reply->open_because));
        return WHIT_ERROR_USAGE;
    case CHILD_REPLY:
        break;
    }
    snprintf(reason, max, "the %s gave no usable reply", who);
    return WHIT_ERROR_INPUT;
}

whit_result foreign_run(const whit_log *log, const struct child_limits *limits, child_fn fn,
                        void *user, struct child_reply *reply, char reason[FOREIGN_REASON_BYTES])
{
    static atomic_flag warned = ATOMIC_FLAG_INIT;
    enum child_end end = child_run(limits, fn, user, reply);
    if (reply->open_because && end != CHILD_OPEN && !atomic_flag_test_and_set(&warned))
        log_warning(log,
                    "foreign files are read without a sandbox: its filter cannot be set here (%s); "
                    "--require-sandbox makes that an error",
                    strerror(reply->open_because));
    return explain(end, limits, reply, reason);
}

/* --- answers -------------------------------------------------------------------------------- */

struct question {
    foreign_fn fn;
    void *user;
};

static int answer_question(void *user, void *to, child_write write)
{
    const struct question *question = user;
    struct foreign_answer answer = {0};
    answer.result = (uint32_t)question->fn(question->user, to, write, &answer);
    if (answer.result == WHIT_ERROR_MEMORY && !answer.reason[0])
        return CHILD_EXIT_MEMORY;
    return write(to, &answer, sizeof answer) ? 0 : 1;
}

whit_result foreign_ask(const whit_log *log, const struct child_limits *limits, foreign_fn fn,
                        void *user, struct child_reply *reply, struct foreign_answer *answer)
{
    struct question question = {fn, user};
    struct child_limits wide = *limits;
    wide.reply_bytes += sizeof *answer;
    *answer = (struct foreign_answer){0};
    whit_result result = foreign_run(log, &wide, answer_question, &question, reply, answer->reason);
    if (result != WHIT_OK)
        return result;
    struct foreign_answer got = {.result = WHIT_ERROR_INPUT, .reason = "a damaged reply"};
    if (reply->size_bytes >= sizeof got)
        memcpy(&got, reply->data + reply->size_bytes - sizeof got, sizeof got);
    *answer = got;
    foreign_text(got.reason, sizeof got.reason, answer->reason, sizeof answer->reason);
    if (got.result == WHIT_OK)
        return WHIT_OK;
    if (!answer->reason[0])
        snprintf(answer->reason, sizeof answer->reason, "the %s gave no reason", limits->who);
    child_reply_free(reply);
    return got.result == WHIT_ERROR_MEMORY ? WHIT_ERROR_MEMORY : WHIT_ERROR_INPUT;
}
