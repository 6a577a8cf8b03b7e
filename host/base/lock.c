#include "base/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/file.h"

static enum lock_end fail(const whit_log *log, struct lock *lock, int reason)
{
    log_error(log, "%s: cannot be locked: %s", lock->path ? lock->path : "a lock",
              strerror(reason));
    free(lock->path);
    *lock = (struct lock){0};
    return LOCK_FAILED;
}

/* Whether the locked file still has that name: its holder may have removed it meanwhile, and
   another process made a new one. */
static bool is_current(const struct lock *lock)
{
    struct stat own, named;
    return fstat(lock->file, &own) == 0 && stat(lock->path, &named) == 0 &&
           own.st_ino == named.st_ino && own.st_dev == named.st_dev;
}

enum lock_end lock_take(const whit_log *log, const char *path, struct lock *lock)
{
    *lock = (struct lock){.path = string_format("%s.lock", path)};
    if (!lock->path)
        return fail(log, lock, ENOMEM);
    for (;;) {
        lock->file = open(lock->path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (lock->file < 0)
            return fail(log, lock, errno);
        int reason = flock(lock->file, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        if (!reason && is_current(lock)) {
            lock->slot = file_slot_take(lock->path);
            return LOCK_MINE;
        }
        close(lock->file);
        if (reason == EWOULDBLOCK)
            break;
        if (reason && reason != EINTR)
            return fail(log, lock, reason);
    }
    free(lock->path);
    *lock = (struct lock){0};
    return LOCK_OTHERS;
}

void lock_give_back(struct lock *lock)
{
    if (!lock->path)
        return;
    file_slot_give_back(lock->slot);
    unlink(lock->path); /* while it is still locked, so that it is not another process's file */
    close(lock->file);
    free(lock->path);
    *lock = (struct lock){0};
}
