#include "load/cut.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

whit_result cut_check_stl(struct scene *scene, const char *path, const uint8_t *data,
                          size_t *size_bytes)
{
    enum { HEAD_BYTES = 84, TRIANGLE_BYTES = 50 };
    /* The header of a binary STL is any text, also `solid`. But no text has zero bytes, and every
       count of less than 2^24 has. */
    if (*size_bytes < HEAD_BYTES || !memchr(data, 0, HEAD_BYTES))
        return WHIT_OK;
    const uint8_t *at = data + HEAD_BYTES - 4;
    uint64_t count = at[0] | (uint64_t)at[1] << 8 | (uint64_t)at[2] << 16 | (uint64_t)at[3] << 24;
    uint64_t room = (*size_bytes - HEAD_BYTES) / TRIANGLE_BYTES;
    uint64_t used = HEAD_BYTES + count * TRIANGLE_BYTES;
    if (count > room || (count == 0 && room)) {
        log_error(&scene->log, "%s: it says that it has %llu triangles, and has room for %llu",
                  path, (unsigned long long)count, (unsigned long long)room);
        return WHIT_ERROR_INPUT;
    }
    if (used < *size_bytes)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: %llu bytes behind its triangles are not read",
                   path_name(path), (unsigned long long)(*size_bytes - used));
    *size_bytes = (size_t)used;
    return WHIT_OK;
}

enum { OFF_CORNERS_MAX = 9 }; /* assimp 5.2 drops faces with more */

/* The next line with data from `at` on, or the end of the text. */
static const char *next_line(const char *at)
{
    at += strspn(at, " \t\r\n");
    while (*at == '#') {
        at += strcspn(at, "\r\n");
        at += strspn(at, " \t\r\n");
    }
    return at;
}

/* The number at `at`, of the corners of a face; -1 unless as many more numbers are in its line. */
static long long count_corners(const char *at)
{
    char *end;
    long long corners = strtoll(at, &end, 10);
    bool whole = end > at;
    at = end;
    for (long long i = 0; whole && i < corners; i++) {
        at += strspn(at, " \t");
        size_t length = strcspn(at, " \t\r\n");
        whole = length > 0;
        at += length;
    }
    return whole ? corners : -1;
}

whit_result cut_check_off(struct scene *scene, const char *path, const char *text)
{
    static const char *const names[] = {"vertex", "face"};
    unsigned long long counts[2], wide = 0;
    const char *at = next_line(text);
    if (isalpha((unsigned char)at[strspn(at, "4")])) /* the keyword may be left out */
        at = next_line(at + strcspn(at, " \t\r\n"));
    for (int i = 0; i < 2; i++) {
        char *end;
        counts[i] = strtoull(at, &end, 10);
        if (end == at)
            return WHIT_OK;
        at = end;
    }
    for (int what = 0; what < 2; what++) {
        for (unsigned long long i = 0; i < counts[what]; i++) {
            at = next_line(at + strcspn(at, "\r\n"));
            long long corners = what == 1 ? count_corners(at) : 0;
            if (!*at || corners < 0) {
                log_error(&scene->log, "%s: %s %llu of %llu is cut short or missing", path,
                          names[what], i + 1, counts[what]);
                return WHIT_ERROR_INPUT;
            }
            wide += corners > OFF_CORNERS_MAX;
        }
    }
    if (wide)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: %llu faces of more than %d corners are not read",
                   path_name(path), wide, OFF_CORNERS_MAX);
    return WHIT_OK;
}
