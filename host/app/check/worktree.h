/* Checks out another revision of a git repository into a temporary folder, which is removed in the
   end, however the program ends. */
#ifndef APP_CHECK_WORKTREE_H
#define APP_CHECK_WORKTREE_H

#include <sys/types.h>

#include "whit/whit_base.h"

struct worktree {
    const char *revision; /* borrowed */
    char *holder;         /* a temporary folder */
    pid_t keeper;         /* process that removes `holder` when the pipe `line` is closed, also by
                             the end of this process */
    int line;
};

/* Checks out `revision` of the repository that contains `folder`. Errors were printed; call
   worktree_remove() in any case. WHIT_ERROR_INPUT: there is no repository, no such revision or no
   git; WHIT_ERROR_OUTPUT: it cannot be written; WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result worktree_add(struct worktree *tree, const char *folder,
                                    const char *revision);
/* The path in the worktree of a folder of the repository; free() it. NULL, with a message, for a
   folder outside of the repository or in none. */
char *worktree_folder(const struct worktree *tree, const char *folder);
/* The path in the repository of a file of the worktree; text may follow it. Other text is returned
   as it is. */
const char *worktree_name(const struct worktree *tree, const char *path);
void worktree_remove(struct worktree *tree);

#endif
