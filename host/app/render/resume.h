/* Work that goes on: `whit render --resume` keeps what is finished and draws the rest, and several
   processes share it. */
#ifndef APP_RENDER_RESUME_H
#define APP_RENDER_RESUME_H

#include "app/job.h"
#include "base/lock.h"

struct render_request;

enum resume_state {
    RESUME_DRAW,   /* it is this process's to draw, then resume_end */
    RESUME_KEPT,   /* it is finished */
    RESUME_OTHERS, /* another process draws it */
};

/* What is to become of the files that `single` names, as the job's settings say what is drawn. A
   file is finished that decodes, and whose recipe is the one that it would get. Errors were said,
   and nothing is locked. */
WHIT_CHECK whit_result resume_begin(const struct job *job, const struct render_request *single,
                                    enum resume_state *state, struct lock *lock);
/* Whether the other options go with --resume. */
bool resume_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request);
/* Waits a moment for other processes. */
whit_result resume_wait(void);
/* Keeps the line that goes on with this work, for the message of interrupted work, where there is
   one: of the words of `whit render`. */
void resume_keep_line(const struct render_request *request, const struct job *job, int argc,
                      char **argv);

#endif
