#include "load/obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/picture.h"

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

static bool is_blank(uint8_t c)
{
    return c == ' ' || c == '\t';
}

static uint32_t count_words(const uint8_t *at, const uint8_t *end)
{
    uint32_t words = 0;
    for (bool blank = true; at < end; at++) {
        words += blank && !is_blank(*at);
        blank = is_blank(*at);
    }
    return words;
}

/* Copies [from, end) with a zero before each decimal point that begins a number. */
static uint8_t *copy_numbers(uint8_t *to, const uint8_t *from, const uint8_t *end)
{
    for (const uint8_t *at = from; at < end; at++) {
        bool begins = *at == '.' && (at == from || is_blank(at[-1]));
        if (begins && at + 1 < end && at[1] >= '0' && at[1] <= '9')
            *to++ = '0';
        *to++ = *at;
    }
    return to;
}

static uint8_t *put_text(uint8_t *to, const char *text)
{
    memcpy(to, text, strlen(text));
    return to + strlen(text);
}

/* Copies the line at *from without its comment and the blanks around it, joined with the lines that
   a backslash at its end continues it by. As many line ends follow as it had. A vertex with a
   colour sets *has_colors; then one without becomes white, as assimp 5.2 gives colours to vertices
   in the order of the colours alone. */
static uint8_t *clean_line(const uint8_t **from, const uint8_t *end, uint8_t *to, bool *has_colors)
{
    const uint8_t *at = *from;
    uint8_t *start = to;
    uint32_t lines = 0;
    bool joined = true, has_numbers = false;
    for (; joined && at < end; lines++) {
        const uint8_t *stop = at;
        while (stop < end && *stop != '\n' && *stop != '\r')
            stop++;
        bool pair = stop + 1 < end && stop[0] == '\r' && stop[1] == '\n';
        const uint8_t *next = stop + (pair ? 2 : stop < end);
        while (at < stop && is_blank(*at))
            at++;
        if (lines == 0)
            has_numbers = at < stop && memchr("vflp", *at, 4);
        else
            *to++ = ' ';
        stop = at + mtl_find_comment((const char *)at, (size_t)(stop - at), !has_numbers);
        while (stop > at && is_blank(stop[-1]))
            stop--;
        joined = stop > at && stop[-1] == '\\';
        to = copy_numbers(to, at, stop - joined);
        at = next;
    }
    bool is_uv = to - start > 2 && start[0] == 'v' && start[1] == 't' && is_blank(start[2]);
    bool is_vertex = to - start > 1 && start[0] == 'v' && is_blank(start[1]);
    uint32_t words = is_uv || is_vertex ? count_words(start, to) : 0;
    *has_colors |= is_vertex && words == 7;
    if (is_uv && words == 2)
        to = put_text(to, " 0");
    if (is_vertex && words == 4 && *has_colors)
        to = put_text(to, " 1 1 1");
    memset(to, '\n', lines);
    *from = at;
    return to + lines;
}

bool obj_repair_text(uint8_t **data, size_t *size_bytes)
{
    const uint8_t *text = *data;
    bool wide = *size_bytes >= 2 &&
                ((text[0] == 0xfe && text[1] == 0xff) || (text[0] == 0xff && text[1] == 0xfe));
    if (wide && !from_utf16(data, size_bytes))
        return false;
    const uint8_t *begin = *data + text_mark_bytes((const char *)*data), *end = *data + *size_bytes;
    /* Less than twice as much: `v .5 .5 .5` and its line end become `v 0.5 0.5 0.5 1 1 1`. The last
       line may lack its line end. */
    uint8_t *out = array_alloc(*size_bytes + 2, 2), *to = out;
    if (!out)
        return false;
    bool has_colors = false;
    for (int pass = 0; pass < (has_colors ? 2 : 1); pass++) {
        to = out;
        for (const uint8_t *at = begin; at < end;)
            to = clean_line(&at, end, to, &has_colors);
    }
    *to = 0;
    free(*data);
    *size_bytes = (size_t)(to - out);
    uint8_t *fitted = realloc(out, *size_bytes + 1);
    *data = fitted ? fitted : out;
    return true;
}

/* --- faces ---------------------------------------------------------------------------------- */

uint32_t obj_longest_face(const char *text)
{
    uint32_t longest = 0, max = 0;
    for (uint32_t line = 1; *text; line++) {
        const char *end = text + strcspn(text, "\n");
        uint32_t words =
            *text == 'f' ? count_words((const uint8_t *)text, (const uint8_t *)end) : 0;
        if (words > max) {
            max = words;
            longest = line;
        }
        text = end + (*end != 0);
    }
    return longest;
}

/* The kinds of lines that the corners of a face name by numbers, in the order in which a corner has
   them: `v`, `vt` and `vn`. */
enum { NAMED_KINDS = 3 };

/* The kind of a line that adds something that faces may name; NAMED_KINDS: a face; else -1. */
static int kind_of_line(const char *line)
{
    if (line[0] == 'f')
        return NAMED_KINDS;
    int kind = line[0] != 'v' ? -1 : line[1] == 't' ? 1 : line[1] == 'n' ? 2 : 0;
    return kind < 0 || is_blank((uint8_t)line[kind ? 2 : 1]) ? kind : -1;
}

struct face_check {
    struct scene *scene;
    const char *path;
    uint32_t line;
    long long total[NAMED_KINDS], above[NAMED_KINDS]; /* in the file, and above the face */
    bool noted[NAMED_KINDS];
};

static bool check_index(struct face_check *check, int kind, long long index)
{
    static const char *const names[] = {"vertex", "texture coordinate", "normal"};
    long long from_first = index < 0 ? check->above[kind] + index + 1 : index;
    if (from_first >= 1 && from_first <= check->total[kind])
        return true;
    if (kind == 0) {
        log_error(&check->scene->log, "%s:%u: a face names vertex %lld, and there are %lld",
                  check->path, check->line, index, check->total[kind]);
        return false;
    }
    /* Some programs number normals that they leave out; these are made as without numbers. */
    if (!check->noted[kind] && (kind == 1 || check->total[kind]))
        scene_note(check->scene, SCENE_NOTE_WARNING,
                   "%s:%u: a face names %s %lld, and there are %lld: its group is drawn without",
                   path_name(check->path), check->line, names[kind], index, check->total[kind]);
    check->noted[kind] = true;
    return true;
}

/* Checks the corners, such as 1, 1/2 or 1//3, of the face at `at`. */
static bool check_face(struct face_check *check, const char *at)
{
    for (;;) {
        at += strcspn(at, " \t\n");
        at += strspn(at, " \t");
        if (*at == 0 || *at == '\n')
            return true;
        for (int kind = 0; kind < NAMED_KINDS; kind++) {
            bool starts = strchr("+-0123456789", *at) && *at;
            char *end = (char *)(uintptr_t)at;
            long long index = starts ? strtoll(at, &end, 10) : 0;
            if (end == at && kind == 0) {
                char word[32];
                snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " \t\n"), at);
                log_error(&check->scene->log, "%s:%u: a face names `%s`, which is no number",
                          check->path, check->line, text_token(word).text);
                return false;
            }
            if (end > at && !check_index(check, kind, index))
                return false;
            at = end;
            if (*at != '/')
                break;
            at++;
        }
    }
}

whit_result obj_check_faces(struct scene *scene, const char *path, const char *text)
{
    struct face_check check = {.scene = scene, .path = path, .line = 1};
    uint32_t curves = 0;
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at != 0) {
        int kind = kind_of_line(at);
        if (kind >= 0 && kind < NAMED_KINDS)
            check.total[kind]++;
    }
    for (const char *at = text; *at; at += strcspn(at, "\n"), at += *at != 0, check.line++) {
        int kind = kind_of_line(at);
        if (kind == NAMED_KINDS && !check_face(&check, at))
            return WHIT_ERROR_INPUT;
        uint32_t words =
            kind ? 0 : count_words((const uint8_t *)at, (const uint8_t *)at + strcspn(at, "\n"));
        if (words > 7)
            return log_failure(&scene->log, WHIT_ERROR_INPUT,
                               "%s:%u: a vertex has %u numbers, at most 6 are possible", path,
                               check.line, words - 1);
        curves += strncmp(at, "curv", 4) == 0 || strncmp(at, "surf", 4) == 0;
        if (kind >= 0 && kind < NAMED_KINDS)
            check.above[kind]++;
    }
    if (curves)
        scene_note(scene, SCENE_NOTE_INFO, "%s: %u curves and surfaces are not drawn",
                   path_name(path), curves);
    return WHIT_OK;
}

/* --- smoothing groups ----------------------------------------------------------------------- */

/* Writes a face whose corners have the last normal above it, or (`smooth` is false) none. */
static void write_face(FILE *file, const char *at, const char *end, bool smooth)
{
    fputc('f', file);
    for (at += strcspn(at, " \t\n"); at < end;) {
        at += strspn(at, " \t");
        size_t bytes = strcspn(at, " \t\n");
        const char *slash = memchr(at, '/', bytes), *last = at + bytes;
        const char *second = slash ? memchr(slash + 1, '/', (size_t)(last - slash - 1)) : NULL;
        const char *stop = second ? second : last;
        if (!smooth && second == slash + 1)
            stop = slash; /* `1//3` becomes `1` */
        fprintf(file, " %.*s", (int)(stop - at), at);
        if (smooth)
            fputs(slash ? "/-1" : "//-1", file);
        at = last;
    }
}

/* Writes the text with normals for smoothing groups; gives whether there was one. */
static bool write_groups(FILE *file, const char *text)
{
    bool found = false, smooth = false;
    for (const char *at = text; *at;) {
        const char *end = at + strcspn(at, "\n");
        if (at[0] == 's' && is_blank((uint8_t)at[1])) {
            const char *name = at + 1 + strspn(at + 1, " \t");
            bool off = *name == '0' || strncmp(name, "off", 3) == 0;
            unsigned long number = strtoul(name, NULL, 10); /* 0: `on` */
            smooth = !off;
            found |= smooth;
            number = number ? number : 1;
            if (smooth) /* the number in two floats, which hold whole numbers up to 2^24 exactly */
                fprintf(file, "vn %lu %lu 0", 1 + (number & 0x3fffff), number >> 22);
        } else if (*at == 'f') {
            write_face(file, at, end, smooth);
        } else {
            fwrite(at, 1, (size_t)(end - at), file);
        }
        fputc('\n', file);
        at = end + (*end != 0);
    }
    return found;
}

static bool has_line(const char *text, const char *keyword)
{
    size_t bytes = strlen(keyword);
    while (*text && (strncmp(text, keyword, bytes) != 0 || !is_blank((uint8_t)text[bytes]))) {
        text += strcspn(text, "\n");
        text += *text != 0;
    }
    return *text;
}

bool obj_mark_smooth_groups(uint8_t **data, size_t *size_bytes, bool *has_groups)
{
    const char *text = (const char *)*data;
    char *marked = NULL;
    size_t bytes;
    *has_groups = false;
    if (has_line(text, "vn") || !has_line(text, "s"))
        return true;
    FILE *file = open_memstream(&marked, &bytes);
    if (!file)
        return false;
    *has_groups = write_groups(file, text);
    bool good = !ferror(file);
    good = fclose(file) == 0 && good;
    if (!good || !*has_groups) {
        free(marked);
        return good;
    }
    free(*data);
    *data = (uint8_t *)marked; /* a zero byte follows */
    *size_bytes = bytes;
    return true;
}

/* --- material libraries --------------------------------------------------------------------- */

/* Reads a library, unless it is in `read` already. *why_not: NULL, or why it cannot be read. */
static whit_result read_library(struct scene *scene, const char *obj_path, const char *name,
                                struct mtl_library *library, struct key_table *read,
                                const char **why_not)
{
    uint8_t *data = NULL;
    size_t size = 0;
    char *written = picture_find_named(&scene->roots, obj_path, name);
    char *path = written ? picture_find(&scene->roots, written) : NULL;
    free(written);
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

/* A copy of what follows `mtllib` on the line [at, end); NULL for other lines, and when memory runs
   out. */
static char *names_on_line(const char *at, const char *end, bool *is_library)
{
    *is_library = end - at > 7 && memcmp(at, "mtllib", 6) == 0 && (at[6] == ' ' || at[6] == '\t');
    if (!*is_library)
        return NULL;
    for (at += 6; *at == ' ' || *at == '\t';)
        at++;
    return string_format("%.*s", (int)(end - at), at);
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

static void mark_invisible(struct mtl_library *library)
{
    bool all = true;
    for (uint32_t i = 0; i < library->count; i++)
        all =
            all && library->entries[i].has_number[MTL_D] && library->entries[i].numbers[MTL_D] <= 0;
    for (uint32_t i = 0; i < library->count; i++)
        library->entries[i].d_of_all = all;
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
    mark_invisible(library);
    key_table_finish(&read);
    return result;
}
