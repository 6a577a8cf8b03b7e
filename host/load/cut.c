#include "load/cut.h"

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
