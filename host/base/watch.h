/* Tells when files are written or replaced. Where the system has no such service, files never seem
   to change. */
#ifndef BASE_WATCH_H
#define BASE_WATCH_H

#include <stdbool.h>
#include <stdint.h>

struct watch;

/* NULL where watching is not possible. `wake` is called, with NULL, from another thread when
   watch_changed may have something to tell. */
struct watch *watch_create(void (*wake)(void *user));
void watch_destroy(struct watch *watch); /* NULL is fine */
/* Adds a file. Since editors replace files, its folder is watched for its name; that folder may be
   missing, come, go and be replaced. Standard input, which never changes, is not watched. A change
   between `since_ns` and this call counts, too. */
void watch_add(struct watch *watch, const char *path, int64_t since_ns);
/* The time, to be taken before a file is read. Systems may date files by a clock that is some 10 ms
   behind: a change in the first 10 ms after that is told only if the file is watched already. */
int64_t watch_now_ns(void);
/* Stops watching all files. Changes that nobody was told of are told if watch_add adds their files
   again before watch_changed is called. */
void watch_clear(struct watch *watch);
/* Whether a watched file was written and closed, or replaced by another file, or its folder came or
   went, or a link on the way to it was replaced (the new way is not watched), since the last call.
   Does not wait. */
bool watch_changed(struct watch *watch);

#endif
