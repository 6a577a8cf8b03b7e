#include "load/obj.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"

#define LIBRARY_LIMIT (UINT64_C(256) << 20)

/* --- repairs -------------------------------------------------------------------------------- */

static uint32_t utf16_unit(const uint8_t *data, size_t at, bool big)
{
    return big ? (uint32_t)data[at] << 8 | data[at + 1] : (uint32_t)data[at + 1] << 8 | data[at];
}

static size_t put_utf8(uint8_t *out, uint32_t c)
{
    if (c < 0x80) {
        out[0] = (uint8_t)c;
        return 1;
    }
    if (c < 0x800) {
        out[0] = (uint8_t)(0xc0 | c >> 6);
        out[1] = (uint8_t)(0x80 | (c & 63));
        return 2;
    }
    size_t length = c < 0x10000 ? 3 : 4;
    out[0] = (uint8_t)(length == 3 ? 0xe0 | c >> 12 : 0xf0 | c >> 18);
    for (size_t i = 1; i < length; i++)
        out[i] = (uint8_t)(0x80 | (c >> 6 * (length - 1 - i) & 63));
    return length;
}

static bool from_utf16(uint8_t **data, size_t *size_bytes)
{
    const uint8_t *in = *data;
    size_t size = *size_bytes;
    bool big = in[0] == 0xfe;
    uint8_t *out = array_alloc(size / 2 + 1, 3);
    size_t used = 0;
    if (!out)
        return false;
    for (size_t at = 2; at + 1 < size; at += 2) {
        uint32_t c = utf16_unit(in, at, big);
        if (c >= 0xd800 && c < 0xdc00 && at + 3 < size) {
            uint32_t low = utf16_unit(in, at + 2, big);
            if (low >= 0xdc00 && low < 0xe000) {
                c = 0x10000 + ((c - 0xd800) << 10) + (low - 0xdc00);
                at += 2;
            }
        }
        used += put_utf8(out + used, c ? c : ' ');
    }
    out[used] = 0;
    free(*data);
    *data = out;
    *size_bytes = used;
    return true;
}

/* Finds the next decimal point without a digit before it, from `at` on, in lines of vertices; NULL:
   there is none. */
static const uint8_t *next_bare_point(const uint8_t *at, const uint8_t *end)
{
    while (at < end) {
        const uint8_t *line_end = memchr(at, '\n', (size_t)(end - at));
        if (!line_end)
            line_end = end;
        const uint8_t *first = at;
        while (first < line_end && (*first == ' ' || *first == '\t'))
            first++;
        bool inside = first < line_end && *first == 'v';
        const uint8_t *point = inside ? memchr(first, '.', (size_t)(line_end - first)) : NULL;
        while (point) {
            bool starts = point[-1] == ' ' || point[-1] == '\t';
            if (starts && point + 1 < line_end && point[1] >= '0' && point[1] <= '9')
                return point;
            point = memchr(point + 1, '.', (size_t)(line_end - point - 1));
        }
        at = line_end + 1;
    }
    return NULL;
}

/* Like next_bare_point, but `at` may stand inside a line. */
static const uint8_t *next_point_in(const uint8_t *start, const uint8_t *at, const uint8_t *end)
{
    while (at > start && at[-1] != '\n' && at < end) {
        const uint8_t *point = memchr(at, '.', (size_t)(end - at));
        const uint8_t *line_end = memchr(at, '\n', (size_t)(end - at));
        if (!point || (line_end && point > line_end)) {
            if (!line_end)
                return NULL;
            at = line_end + 1;
            break;
        }
        bool starts = point[-1] == ' ' || point[-1] == '\t';
        if (starts && point + 1 < end && point[1] >= '0' && point[1] <= '9')
            return point;
        at = point + 1;
    }
    return next_bare_point(at, end);
}

static bool add_zeros(uint8_t **data, size_t *size_bytes)
{
    const uint8_t *start = *data, *end = start + *size_bytes;
    const uint8_t *first = next_bare_point(start, end);
    size_t count = 0;
    for (const uint8_t *at = first; at; at = next_point_in(start, at + 1, end))
        count++;
    if (count == 0)
        return true;
    uint8_t *out = array_alloc(*size_bytes + count + 1, 1), *to = out;
    if (!out)
        return false;
    const uint8_t *from = start;
    for (const uint8_t *at = first; at; at = next_point_in(start, at + 1, end)) {
        memcpy(to, from, (size_t)(at - from));
        to += at - from;
        *to++ = '0';
        from = at;
    }
    memcpy(to, from, (size_t)(end - from) + 1);
    free(*data);
    *data = out;
    *size_bytes += count;
    return true;
}

bool obj_repair_text(uint8_t **data, size_t *size_bytes)
{
    const uint8_t *text = *data;
    bool wide = *size_bytes >= 2 &&
                ((text[0] == 0xfe && text[1] == 0xff) || (text[0] == 0xff && text[1] == 0xfe));
    return (!wide || from_utf16(data, size_bytes)) && add_zeros(data, size_bytes);
}

/* --- faces ---------------------------------------------------------------------------------- */

static uint32_t count_words(const char *at, const char *end)
{
    uint32_t words = 0;
    for (bool blank = true; at < end; at++) {
        bool was_blank = blank;
        blank = *at == ' ' || *at == '\t' || *at == '\r' || *at == '\\';
        words += was_blank && !blank;
    }
    return words;
}

uint32_t obj_longest_face(const char *text)
{
    uint32_t longest = 0, max = 0, first = 0, words = 0;
    bool joined = false;
    for (uint32_t line = 1; *text; line++) {
        const char *end = text + strcspn(text, "\n"), *last = end;
        if (!joined) {
            first = text[strspn(text, " \t")] == 'f' ? line : 0;
            words = 0;
        }
        words += count_words(text, end);
        if (first && words > max) {
            max = words;
            longest = first;
        }
        while (last > text && last[-1] == '\r')
            last--;
        joined = last > text && last[-1] == '\\';
        text = end + (*end != 0);
    }
    return longest;
}

/* --- material libraries --------------------------------------------------------------------- */

/* Reads a library, unless it is in `read` already. *why_not: NULL, or why it cannot be read. */
static whit_result read_library(struct scene *scene, const char *obj_path, const char *name,
                                struct mtl_library *library, struct key_table *read,
                                const char **why_not)
{
    uint8_t *data = NULL;
    size_t size = 0;
    char *path = roots_join(obj_path, name);
    if (!path)
        return WHIT_ERROR_MEMORY;
    *why_not = roots_why_not(&scene->roots, path);
    uint32_t before;
    if (*why_not || key_table_find(read, path, strlen(path), &before))
        goto done;
    if (file_read(&scene->log, &scene->roots, path, LIBRARY_LIMIT, &data, &size) != WHIT_OK) {
        free(path);
        return WHIT_ERROR_INPUT;
    }
    scene->file_bytes += size;
    bool ok = key_table_add(read, path, strlen(path), read->count) &&
              mtl_parse(scene, path, (const char *)data, library);
    free(path);
    free(data);
    return ok ? WHIT_OK : WHIT_ERROR_MEMORY;
done:
    free(path);
    return WHIT_OK;
}

/* The end of the word at `at`; a backslash keeps the blank behind it in the word. */
static const char *word_end(const char *at)
{
    while (*at && *at != ' ' && *at != '\t')
        at += at[0] == '\\' && at[1] == ' ' ? 2 : 1;
    return at;
}

/* A copy of [at, end) without the backslashes before blanks. */
static char *copy_word(const char *at, const char *end)
{
    char *out = array_alloc((size_t)(end - at) + 1, 1), *to = out;
    if (!out)
        return NULL;
    for (; at < end; at++)
        if (at[0] != '\\' || at[1] != ' ')
            *to++ = *at;
    *to = 0;
    return out;
}

/* Reads the libraries that a line names: it may be one name with blanks in it, or several names. */
static whit_result read_named(struct scene *scene, const char *obj_path, const char *line,
                              struct mtl_library *library, struct key_table *read)
{
    const char *why_not = NULL;
    whit_result result = read_library(scene, obj_path, line, library, read, &why_not);
    const char *at = line;
    bool found = !why_not;
    while (result == WHIT_OK && !found && *at) {
        const char *end = word_end(at);
        char *name = copy_word(at, end);
        if (!name)
            return WHIT_ERROR_MEMORY;
        result = read_library(scene, obj_path, name, library, read, &why_not);
        if (result == WHIT_OK && why_not)
            scene_note(scene, SCENE_NOTE_WARNING, "%s: material library `%s`: %s",
                       path_name(obj_path), text_token(name).text, why_not);
        free(name);
        for (at = end; *at == ' ' || *at == '\t'; at++)
            continue;
    }
    return result;
}

/* A copy of what follows `mtllib` on the line [at, end), trimmed; NULL for other lines, and when
   memory runs out. */
static char *names_on_line(const char *at, const char *end, bool *is_library)
{
    while (at < end && (*at == ' ' || *at == '\t'))
        at++;
    *is_library = end - at > 7 && memcmp(at, "mtllib", 6) == 0 && (at[6] == ' ' || at[6] == '\t');
    if (!*is_library)
        return NULL;
    for (at += 6; at < end && (*at == ' ' || *at == '\t');)
        at++;
    while (end > at && (end[-1] == ' ' || end[-1] == '\t' || end[-1] == '\r'))
        end--;
    char *names = array_alloc((size_t)(end - at) + 1, 1);
    if (names) {
        memcpy(names, at, (size_t)(end - at));
        names[end - at] = 0;
    }
    return names;
}

static whit_result read_sibling(struct scene *scene, const char *path, struct mtl_library *library,
                                struct key_table *read)
{
    const char *name = path_name(path), *dot = strrchr(name, '.');
    int length = dot ? (int)(dot - name) : (int)strlen(name);
    char *sibling = string_format("%.*s.mtl", length, name);
    const char *why_not;
    if (!sibling)
        return WHIT_ERROR_MEMORY;
    whit_result result = read_library(scene, path, sibling, library, read, &why_not);
    if (result == WHIT_OK && !why_not)
        scene_note(scene, SCENE_NOTE_INFO,
                   "%s: no material library was found by its name, `%s` is used", name, sibling);
    free(sibling);
    return result;
}

whit_result obj_read_libraries(struct scene *scene, const char *path, const char *text,
                               struct mtl_library *library)
{
    struct key_table read = {0};
    whit_result result = WHIT_OK;
    for (const char *at = text; at && *at && result == WHIT_OK;) {
        const char *end = strchr(at, '\n');
        bool is_library;
        char *names = names_on_line(at, end ? end : at + strlen(at), &is_library);
        if (is_library && !names)
            result = WHIT_ERROR_MEMORY;
        else if (is_library)
            result = read_named(scene, path, names, library, &read);
        free(names);
        at = end ? end + 1 : NULL;
    }
    if (result == WHIT_OK && read.count == 0 && !scene->roots.is_input)
        result = read_sibling(scene, path, library, &read);
    key_table_finish(&read);
    return result;
}
