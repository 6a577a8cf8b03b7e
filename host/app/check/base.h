/* Draws a suite as another revision of its repository has it, to find why its pictures differ. */
#ifndef APP_CHECK_BASE_H
#define APP_CHECK_BASE_H

#include "app/check/draw.h"
#include "app/check/worktree.h"

struct base {
    struct worktree tree;
    char *folder, *root, *path; /* of the suite in the worktree; root: NULL as in base_open */
    struct suite suite;
    struct golden golden; /* empty where the revision has none that can be read */
};

/* Reads the suite and its golden as `revision` has them; `root`: as of suite_read. Errors were
   printed; call base_close() in any case. Call it before the device is opened. */
WHIT_CHECK whit_result base_open(struct base *base, const char *suite, const char *root,
                                 const char *revision, enum golden_kind kind);
/* Draws the case as it was at the revision. *text says how and why `drawing` differs: "214 pixels
   other, 96 hit something else; cause: ..."; free() it. *before: the colours of the old picture,
   for the caller to destroy, or NULL. `accepted`: the case of the golden, or NULL. Errors were
   printed, and *text is NULL then. It is also NULL where the old picture cannot be drawn, which is
   no error of this run. */
WHIT_CHECK whit_result base_explain(const struct base *base, struct studio *studio,
                                    const struct check_case *item,
                                    const struct golden_case *accepted,
                                    const struct drawing *drawing, char **text,
                                    whit_image **before);
void base_close(struct base *base);

#endif
