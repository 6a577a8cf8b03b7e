/* Work that goes on: `whit render --resume` keeps what is finished and draws the rest, and several
   processes share it. */
#ifndef APP_RENDER_RESUME_H
#define APP_RENDER_RESUME_H

#include "app/arguments.h"
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
/* Whether what is interrupted leaves finished files, which --resume keeps. */
bool resume_leaves_files(const struct render_request *request);
/* Keeps the line that goes on, for the message of interrupted work: the words of the command, which
   has --resume already where `resumed`. */
void resume_keep_line(bool resumed, int argc, char **argv);

#endif
