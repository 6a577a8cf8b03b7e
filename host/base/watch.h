/* Tells when files are written or replaced. Where the system cannot tell, nothing ever changes. */
#ifndef BASE_WATCH_H
#define BASE_WATCH_H

#include <stdbool.h>

struct watch;

/* NULL where watching is not possible. `wake` is called, with NULL, from another thread when
   watch_changed may have something to tell. */
struct watch *watch_create(void (*wake)(void *user));
void watch_destroy(struct watch *watch); /* NULL is fine */
/* Also this file. Editors replace files: its folder is watched for its name. Standard input, which
   never changes, is none. */
void watch_add(struct watch *watch, const char *path);
void watch_clear(struct watch *watch); /* none of them any more */
/* Whether one of them was written to its end, or put in place of another, since the last call. Does
   not wait. */
bool watch_changed(struct watch *watch);

#endif
