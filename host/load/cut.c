#include "load/cut.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/format.h"

/* Writes the keyword at `at`, if there is one, in upper case: assimp does not know it then. */
static void hide_keyword(char *at)
{
    static const char *const keywords[] = {"facet", "vertex", "solid", "loop"};
    for (size_t i = 0; i < sizeof keywords / sizeof *keywords; i++)
        if (strncmp(at, keywords[i], strlen(keywords[i])) == 0)
            for (size_t k = 0; keywords[i][k]; k++)
                at[k] = (char)toupper((unsigned char)at[k]);
}

/* Moves `solid` to the begin of the file, and writes all but the names of solids in lower case. */
static void repair_text(char *text, size_t *size_bytes)
{
    size_t blanks = text_mark_bytes(text);
    blanks += strspn(text + blanks, " \t\r\n");
    if (strncasecmp(text + blanks, "solid", 5) != 0)
        return;
    *size_bytes -= blanks;
    memmove(text, text + blanks, *size_bytes + 1);
    bool in_name = false;
    for (char *at = text; *at; at++) {
        in_name |= isblank((unsigned char)*at) && at - text >= 5 && memcmp(at - 5, "solid", 5) == 0;
        in_name &= *at != '\n' && *at != '\r';
        if (in_name)
            hide_keyword(at);
        else
            *at = (char)tolower((unsigned char)*at);
    }
}

whit_result cut_check_stl(struct scene *scene, const char *path, uint8_t *data, size_t *size_bytes)
{
    /* The header of a binary STL is any text, also `solid`. But no text has zero bytes, and every
       count of less than 2^24 has. */
    uint32_t count;
    bool whole = format_is_stl(data, *size_bytes, &count);
    if (*size_bytes < STL_HEADER_BYTES || (!whole && !memchr(data, 0, STL_HEADER_BYTES))) {
        repair_text((char *)data, size_bytes);
        return WHIT_OK;
    }
    uint64_t room = (*size_bytes - STL_HEADER_BYTES) / STL_TRIANGLE_BYTES;
    uint64_t used = STL_HEADER_BYTES + (uint64_t)count * STL_TRIANGLE_BYTES;
    if (count > room || (count == 0 && room))
        return log_failure(&scene->log, WHIT_ERROR_INPUT,
                           "%s: it says that it has %u triangles, and has room for %llu", path,
                           count, (unsigned long long)room);
    if (used < *size_bytes)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: %llu bytes behind its triangles are not read",
                   path_name(path), (unsigned long long)(*size_bytes - used));
    *size_bytes = (size_t)used;
    return WHIT_OK;
}

enum { OFF_CORNERS_MAX = 9 }; /* assimp 5.2 drops faces with more */

static const char *next_line(const char *at)
{
    at += strcspn(at, "\n");
    return at + (*at != 0);
}

/* Copies the text without comments and blank lines, behind the keyword. NULL: memory ran out. */
static char *clean_off(const char *text, size_t size_bytes)
{
    static const char keyword[] = "OFF\n";
    char *out = array_alloc(size_bytes + sizeof keyword + 1, 1), *to = out;
    for (const char *at = text + text_mark_bytes(text); out && *at;) {
        at += strspn(at, " \t\r\n");
        size_t bytes = strcspn(at, "#\r\n");
        if (bytes && to == out && !isalpha((unsigned char)at[strspn(at, "4")]))
            to = stpcpy(to, keyword);
        memcpy(to, at, bytes);
        to += bytes;
        if (bytes)
            *to++ = '\n';
        at += bytes + strcspn(at + bytes, "\r\n");
    }
    if (out)
        *to = 0;
    return out;
}

/* Reads the corners of the face in the line at `at`, of which *count is the number; gives what
   follows them, or NULL if they are not in this line. *bad: one is none of the vertices. */
static const char *skip_corners(const char *at, unsigned long long vertex_count, long long *count,
                                bool *bad)
{
    char *end;
    *count = strtoll(at, &end, 10);
    bool whole = end > at;
    at = end;
    for (long long i = 0; whole && i < *count; i++) {
        at += strspn(at, " \t");
        size_t length = strcspn(at, " \t\n");
        whole = length > 0;
        *bad |= whole && (*at == '-' || strtoull(at, NULL, 10) >= vertex_count);
        at += length;
    }
    return whole && *count >= 0 ? at + strspn(at, " \t") : NULL;
}

static whit_result check_off(struct scene *scene, const char *path, const char *text)
{
    if (strncmp(text, "OFF BINARY", 10) == 0)
        return log_failure(&scene->log, WHIT_ERROR_INPUT, "%s: a binary OFF is not read", path);
    static const char *const names[] = {"vertex", "face"};
    unsigned long long counts[2], wide = 0, coloured = 0;
    const char *at = text + strcspn(text, " \t\n");
    for (int i = 0; i < 2; i++) {
        char *end;
        counts[i] = strtoull(at, &end, 10);
        if (end == at)
            return WHIT_OK;
        if (at[strspn(at, " \t\n")] == '-')
            return log_failure(&scene->log, WHIT_ERROR_INPUT, "%s: its number of %s is below 0",
                               path, i ? "faces" : "vertices");
        at = end;
    }
    for (int what = 0; what < 2; what++) {
        for (unsigned long long i = 0; i < counts[what]; i++) {
            long long corners = 0;
            at = next_line(at);
            bool bad = false;
            const char *end = what == 1 ? skip_corners(at, counts[0], &corners, &bad) : at;
            if (!*at || !end || bad)
                return log_failure(&scene->log, WHIT_ERROR_INPUT, "%s: %s %llu of %llu %s", path,
                                   names[what], i + 1, counts[what],
                                   bad ? "names a vertex that is not there"
                                       : "is cut short or missing");
            wide += corners > OFF_CORNERS_MAX;
            coloured += what == 1 && *end != '\n';
        }
    }
    if (wide && wide == counts[1])
        return log_failure(&scene->log, WHIT_ERROR_INPUT,
                           "%s: all its faces have more than %d corners, which are not read", path,
                           OFF_CORNERS_MAX);
    if (wide)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: %llu faces of more than %d corners are not read",
                   path_name(path), wide, OFF_CORNERS_MAX);
    if (coloured)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: colours of %llu faces are not read",
                   path_name(path), coloured);
    return WHIT_OK;
}

whit_result cut_check_off(struct scene *scene, const char *path, uint8_t **data, size_t *size_bytes)
{
    char *text = clean_off((const char *)*data, *size_bytes);
    if (!text)
        return WHIT_ERROR_MEMORY;
    free(*data);
    *data = (uint8_t *)text;
    *size_bytes = strlen(text);
    return check_off(scene, path, text);
}
