/* A lock between processes, for work that one of them is to do. It ends with the process that holds
   it, however that ends, so no lock is ever stale. */
#ifndef BASE_LOCK_H
#define BASE_LOCK_H

#include <stdbool.h>

#include "base/log.h"

/* A lock on the file PATH.lock. The file exists while a process holds the lock; file_abandon_all()
   removes it too, but it stays where that process was killed. A zeroed struct holds nothing. */
struct lock {
    char *path; /* of the lock file */
    int file;
    int slot; /* file_slot_take */
};

enum lock_end {
    LOCK_MINE,   /* give it back with lock_give_back */
    LOCK_OTHERS, /* another process or lock has it */
    LOCK_FAILED, /* no such file can be made or locked; logged */
};

/* Does not wait. */
enum lock_end lock_take(const whit_log *log, const char *path, struct lock *lock);
/* Removes the lock file. Does nothing for a zeroed lock. */
void lock_give_back(struct lock *lock);

#endif
