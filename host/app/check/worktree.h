/* The files of another revision of a git repository, in a folder that is gone when they are not
   needed any more, whatever the program ends by. */
#ifndef APP_CHECK_WORKTREE_H
#define APP_CHECK_WORKTREE_H

#include <sys/types.h>

#include "whit/whit_base.h"

struct worktree {
    const char *revision; /* borrowed */
    char *holder;         /* a temporary folder */
    pid_t keeper;         /* removes `holder` when `line` ends, which it does with this process */
    int line;
};

/* Checks `revision` of the repository that `folder` lies in out beside. What fails was said;
   worktree_remove() it either way. WHIT_ERROR_INPUT: there is no repository, no such revision or no
   git; WHIT_ERROR_OUTPUT: no room for it; WHIT_ERROR_CANCELLED. */
WHIT_CHECK whit_result worktree_add(struct worktree *tree, const char *folder,
                                    const char *revision);
/* What a folder of the repository is in that revision; free() it. NULL, with the reason said, for
   one that lies outside or in no repository. */
char *worktree_folder(const struct worktree *tree, const char *folder);
void worktree_remove(struct worktree *tree);

#endif
