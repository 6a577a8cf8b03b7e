/* `whit render --resume`: continues interrupted work. It keeps finished files and draws the rest,
   and several processes may share the work. */
#ifndef APP_RENDER_RESUME_H
#define APP_RENDER_RESUME_H

#include "app/arguments.h"
#include "app/job.h"
#include "base/lock.h"

struct render_request;

enum resume_state {
    RESUME_DRAW,   /* this process draws it, then releases the lock */
    RESUME_KEPT,   /* it is finished and kept */
    RESUME_OTHERS, /* another process draws it */
};

/* Decides what to do with the files that `single` names, and locks them for RESUME_DRAW. A file is
   finished where it decodes and its recipe equals the one that the job's settings would write.
   After an error, which was printed, nothing is locked. */
WHIT_CHECK whit_result resume_begin(const struct job *job, const struct render_request *single,
                                    enum resume_state *state, struct lock *lock);
/* Checks that the other options go with --resume. */
bool resume_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request);
/* Waits a moment for other processes. */
whit_result resume_wait(void);
/* Whether --resume can keep the files of a line of `whit batch`, whose other options are checked.
 */
bool resume_keeps(const struct render_request *request);
/* Whether interrupted work leaves finished files, which --resume would keep. */
bool resume_leaves_files(const struct render_request *request);
/* Prepares the command that continues interrupted work, for its message: the words of this command,
   plus --resume unless `resumed`. */
void resume_keep_line(bool resumed, int argc, char **argv);

#endif
