#include "base/input.h"

#include <errno.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static bool was_read;
static uint8_t *kept;
static size_t kept_bytes;
static const char *why_not; /* NULL: it was read to its end */

/* Grows *data where it is full: a pipe does not tell its size beforehand. */
static bool make_room(uint8_t **data, size_t used_bytes, size_t *room_bytes)
{
    if (used_bytes + 1 < *room_bytes)
        return true;
    size_t more_bytes = *room_bytes ? 2 * *room_bytes : (size_t)1 << 16;
    uint8_t *larger = realloc(*data, more_bytes);
    if (!larger)
        return false;
    *data = larger;
    *room_bytes = more_bytes;
    return true;
}

/* Reads standard input to its end. Returns NULL, or why that failed. */
static const char *read_to_end(uint8_t **data, size_t *size_bytes)
{
    size_t used_bytes = 0, room_bytes = 0;
    ssize_t got = 1;
    if (isatty(STDIN_FILENO))
        return "it is a terminal: give it a scene or a model, as in `< model.glb`";
    while (got != 0) {
        if (!make_room(data, used_bytes, &room_bytes))
            return "out of memory";
        got = read(STDIN_FILENO, *data + used_bytes, room_bytes - used_bytes - 1);
        if (got < 0 && errno != EINTR)
            return strerror(errno);
        used_bytes += got > 0 ? (size_t)got : 0;
        if (used_bytes > INPUT_BYTES_MAX)
            return "more than 256 MiB: give whit a file";
    }
    (*data)[used_bytes] = 0;
    *size_bytes = used_bytes;
    return used_bytes ? NULL : "there is nothing in it";
}

whit_result input_read(const whit_log *log, const uint8_t **data, size_t *size_bytes)
{
    pthread_mutex_lock(&lock);
    if (!was_read)
        why_not = read_to_end(&kept, &kept_bytes);
    was_read = true;
    pthread_mutex_unlock(&lock);
    if (why_not)
        return log_failure(log, WHIT_ERROR_INPUT, "standard input: %s", why_not);
    *data = kept;
    *size_bytes = kept_bytes;
    return WHIT_OK;
}
