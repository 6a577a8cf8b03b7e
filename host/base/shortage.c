#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <unistd.h>

#include "base/platform.h"
#include "whit/whit_program.h"

enum { ROOM_FILES = 16 }; /* file descriptors that a driver may need at once */

static bool has_files(void)
{
    int fds[ROOM_FILES], count = 0;
    errno = 0;
    while (count < ROOM_FILES && (fds[count] = open("/dev/null", O_RDONLY | O_CLOEXEC)) >= 0)
        ++count;
    bool has = errno != EMFILE && errno != ENFILE;
    while (count > 0)
        close(fds[--count]);
    return has;
}

const char *whit_shortage(uint64_t room_bytes)
{
    int reason = errno;
    const char *lacks = !platform_has_room((size_t)room_bytes) ? "out of memory"
                        : !has_files()                         ? "too many open files"
                                                               : NULL;
    errno = reason;
    return lacks;
}
