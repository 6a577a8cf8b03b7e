#include "shader/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/path.h"
#include "base/roots.h"
#include "base/text.h"
#include "shader/scan.h"

struct reading {
    const whit_log *log;
    struct shader_errors *errors;
    struct shader_text *text;
    struct roots roots;                       /* the folder that files must be in */
    const char *folder;                       /* folder of the first file, as the user wrote it */
    const struct shader_text_source *sources; /* read in place of files; NULL: files are read */
    uint32_t source_count;
    uint32_t open[SHADER_TEXT_DEPTH_MAX], open_count; /* the current file and its includers */
    uint32_t below[SHADER_TEXT_FILES_MAX];            /* by file: depth of its includes; 1: none */
};

/* The place to name in errors: an #include that is being followed, or the file itself. */
struct place {
    const char *file;
    uint32_t line;
    const char *what; /* the included name; NULL: the file itself */
};

static whit_result refuse(struct reading *r, const struct place *place, const char *why)
{
    if (place->what)
        shader_error_add(r->log, r->errors, place->file, place->line, 0, "#include \"%s\": %s",
                         text_token(place->what).text, why);
    else
        shader_error_add(r->log, r->errors, place->file, place->line, 0, "%s", why);
    return WHIT_ERROR_INPUT;
}

static whit_result no_memory(struct reading *r)
{
    return log_failure(r->log, WHIT_ERROR_MEMORY, "no memory for the text of a shader");
}

/* --- bytes ---------------------------------------------------------------------------------- */

static const char too_large[] = "it is larger than 1 MiB";

static whit_result read_open(struct reading *r, const struct place *place, int fd,
                             struct shader_file *file)
{
    file->text = malloc(SHADER_TEXT_FILE_BYTES + 2);
    if (!file->text)
        return no_memory(r);
    while (file->bytes <= SHADER_TEXT_FILE_BYTES) {
        ssize_t got = read(fd, file->text + file->bytes, SHADER_TEXT_FILE_BYTES + 1 - file->bytes);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return refuse(r, place, strerror(errno));
        if (got == 0)
            break;
        file->bytes += (size_t)got;
    }
    if (file->bytes > SHADER_TEXT_FILE_BYTES)
        return refuse(r, place, too_large);
    char *less = realloc(file->text, file->bytes + 1);
    file->text = less ? less : file->text;
    return WHIT_OK;
}

static whit_result read_file(struct reading *r, const struct place *place, struct shader_file *file)
{
    enum reach reach;
    int fd = roots_open(&r->roots, file->name, &reach);
    if (fd < 0)
        return refuse(r, place, reach_words(reach));
    whit_result result = read_open(r, place, fd, file);
    close(fd);
    return result;
}

static whit_result copy_source(struct reading *r, const struct place *place,
                               struct shader_file *file)
{
    const struct shader_text_source *from = NULL;
    for (uint32_t i = 0; i < r->source_count && !from; ++i) {
        if (strcmp(r->sources[i].relative, file->relative) == 0)
            from = &r->sources[i];
    }
    if (!from)
        return refuse(r, place, "there is no such file");
    if (from->bytes > SHADER_TEXT_FILE_BYTES)
        return refuse(r, place, too_large);
    file->text = malloc(from->bytes + 1);
    if (!file->text)
        return no_memory(r);
    memcpy(file->text, from->text, from->bytes);
    file->bytes = from->bytes;
    return WHIT_OK;
}

/* Blanks the byte order mark of UTF-8, vertical tabs and form feeds, as glslang refuses them, and
   makes each CR without LF the end of a line, so that all readers of the text agree. */
static void even_out(struct shader_file *file)
{
    if (strncmp(file->text, "\xef\xbb\xbf", 3) == 0)
        memset(file->text, ' ', 3);
    for (size_t i = 0; i < file->bytes; ++i) {
        if (file->text[i] == '\r' && file->text[i + 1] != '\n')
            file->text[i] = '\n';
        if (file->text[i] == '\v' || file->text[i] == '\f')
            file->text[i] = ' ';
    }
}

/* Refuses bytes that are no text, and very long lines. */
static whit_result check_bytes(struct reading *r, const struct shader_file *file)
{
    uint32_t line = 1;
    size_t begin = 0;
    for (size_t i = 0; i < file->bytes; ++i) {
        unsigned char c = (unsigned char)file->text[i];
        if (i - begin > SHADER_TEXT_LINE_BYTES) {
            shader_error_add(r->log, r->errors, file->name, line, 0, "a line of more than %d bytes",
                             SHADER_TEXT_LINE_BYTES);
            return WHIT_ERROR_INPUT;
        }
        line += c == '\n';
        begin = c == '\n' ? i + 1 : begin;
        if ((c < ' ' && !strchr("\t\n\v\f\r", c)) || c == 0 || c == 127) {
            shader_error_add(r->log, r->errors, file->name, line, 0,
                             "a byte %u, which is no text: this is no GLSL", c);
            return WHIT_ERROR_INPUT;
        }
    }
    return WHIT_OK;
}

/* --- names ---------------------------------------------------------------------------------- */

/* The path of `included`, a name in file `from`. Paths are relative to the first file's folder,
   without "." and "..". "": it leads out of that folder; NULL: no memory. */
static char *resolve(const char *from, const char *included)
{
    char *joined = path_beside(from, included);
    if (!joined)
        return NULL;
    char *out = joined;
    size_t used = 0;
    for (const char *part = joined, *next; part; part = next) {
        size_t length = strcspn(part, "/");
        next = part[length] ? part + length + 1 : NULL;
        if (length == 2 && part[0] == '.' && part[1] == '.') {
            if (used == 0)
                break; /* out becomes "" below */
            used--;
            while (used && out[used - 1] != '/')
                used--;
        } else if (length > 1 || (length == 1 && part[0] != '.')) {
            memmove(out + used, part, length);
            used += length;
            if (next)
                out[used++] = '/';
        }
    }
    out[used] = 0;
    return out;
}

static uint32_t find_file(const struct shader_text *text, const char *relative)
{
    for (uint32_t i = 0; i < text->file_count; ++i) {
        if (strcmp(text->files[i].relative, relative) == 0)
            return i;
    }
    return UINT32_MAX;
}

/* --- what stands in a file ------------------------------------------------------------------ */

static whit_result read_one(struct reading *r, const struct place *place, char *relative,
                            uint32_t *index);

/* Includes a file that was read already, or is being read. */
static whit_result include_again(struct reading *r, const struct place *place, uint32_t index)
{
    for (uint32_t i = 0; i < r->open_count; ++i) {
        if (r->open[i] == index)
            return refuse(r, place,
                          i + 1 == r->open_count ? "a file that includes itself"
                                                 : "files that include each other");
    }
    if (r->open_count + r->below[index] > SHADER_TEXT_DEPTH_MAX)
        return refuse(r, place, "files that include files, more than 16 deep");
    return WHIT_OK;
}

static whit_result follow_include(struct reading *r, uint32_t parent, uint32_t line,
                                  const char *name)
{
    struct shader_file *files = r->text->files;
    const struct place place = {files[parent].name, line, name};
    if (name[0] == '/' || !name[0])
        return refuse(r, &place,
                      name[0] ? "only names from this file's folder are followed"
                              : "there is no name");
    char *relative = resolve(files[parent].relative, name);
    if (!relative)
        return no_memory(r);
    uint32_t index = find_file(r->text, relative);
    whit_result result;
    if (!relative[0] || relative[strlen(relative) - 1] == '/') {
        result = refuse(r, &place,
                        relative[0] ? reach_words(REACH_NOT_A_FILE)
                                    : "it leads out of the folder of the first file");
    } else if (index != UINT32_MAX) {
        result = include_again(r, &place, index);
    } else {
        result = read_one(r, &place, relative, &index);
        relative = NULL;
    }
    free(relative);
    if (result != WHIT_OK)
        return result;
    if (r->below[index] >= r->below[parent])
        r->below[parent] = r->below[index] + 1;
    struct shader_file *file = &r->text->files[parent];
    const struct shader_include include = {line, index};
    return ARRAY_PUSH(file->includes, file->include_count, file->include_capacity, include)
               ? WHIT_OK
               : no_memory(r);
}

static whit_result at(struct reading *r, uint32_t file, uint32_t line, const char *why)
{
    shader_error_add(r->log, r->errors, r->text->files[file].name, line, 0, "%s", why);
    return WHIT_ERROR_INPUT;
}

/* Why a directive or a word is refused that only kernels may use; NULL: it is not refused. Words
   cannot be made by ## either, which is refused. */
static const char *refused(const struct scan *scan)
{
    static const struct {
        enum scan_kind kind;
        const char *name, *why;
    } rows[] = {
        {SCAN_DIRECTIVE, "version", "#version is whit's own: leave it out (whit's is 460)"},
        {SCAN_DIRECTIVE, "extension", "#extension is whit's own: leave it out"},
        {SCAN_DIRECTIVE, "line", "#line is whit's own: leave it out"},
        {SCAN_DIRECTIVE, "pragma",
         "#pragma means nothing here: leave it out; what is included twice goes between #ifndef "
         "and "
         "#endif"},
        {SCAN_WORD, "layout", "layout is whit's own: functions of users have no bindings"},
        {SCAN_WORD, "uniform", "uniform is whit's own: functions of users have no bindings"},
        {SCAN_WORD, "buffer", "buffer is whit's own: functions of users have no bindings"},
        {SCAN_WORD, "shared", "shared is whit's own: functions of users share no memory"},
        {SCAN_WORD, "main",
         "main is whit's own: see docs/shaders.md for the functions that can be written"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        if (scan_is(scan, rows[i].kind, rows[i].name))
            return rows[i].why;
    }
    return NULL;
}

struct conditions {
    uint32_t lines[64], count; /* lines of the open #if */
};

static whit_result check_directive(struct reading *r, uint32_t file, const struct scan *scan,
                                   struct conditions *open)
{
    const uint32_t max = sizeof open->lines / sizeof *open->lines;
    if (strncmp(scan->text, "if", 2) == 0) {
        if (open->count == max)
            return at(r, file, scan->token_line, "more than 64 #if in each other");
        open->lines[open->count++] = scan->token_line;
    } else if (strcmp(scan->text, "endif") == 0) {
        if (open->count == 0)
            return at(r, file, scan->token_line, "#endif without #if in this file");
        open->count--;
    } else if (strncmp(scan->text, "el", 2) == 0 && open->count == 0) {
        return at(r, file, scan->token_line, "#else or #elif without #if in this file");
    }
    return WHIT_OK;
}

/* Whether an #include is alone on its line, as expand.c replaces the whole line. */
static bool stands_alone(const char *text, const char *directive)
{
    while (directive > text && (directive[-1] == ' ' || directive[-1] == '\t'))
        directive--;
    return directive == text || directive[-1] == '\n' || directive[-1] == '\r';
}

static whit_result read_include(struct reading *r, uint32_t file, struct scan *scan)
{
    uint32_t line = scan->token_line;
    bool alone = stands_alone(r->text->files[file].text, scan->start);
    if (!scan_next(scan) || scan->kind != SCAN_STRING)
        return at(r, file, line, "#include wants a name in quotes: #include \"file.glsl\"");
    char name[SCAN_TEXT_BYTES];
    memcpy(name, scan->text, sizeof name);
    if (!alone || !scan_next(scan) || scan->kind != SCAN_NEWLINE || scan->line != line)
        return at(r, file, line, "#include wants a line of its own");
    return follow_include(r, file, line, name);
}

/* Whether the sign is of no use in GLSL, outside of comments, strings and the words of #error; the
   compiler's message about it would name another one. */
static bool is_no_sign(const struct scan *scan)
{
    char c = scan->text[0];
    return (unsigned char)c > 127 || (!scan->in_directive && (c == '@' || c == '$' || c == '`'));
}

/* Refuses the character of a sign. */
static whit_result refuse_character(struct reading *r, uint32_t file, const struct scan *scan)
{
    const char *first = scan->at - 1, *line = first;
    const unsigned char *byte = (const unsigned char *)first;
    char shown[WHIT_SHOWN_BYTES];
    size_t length = whit_text_next(first, shown);
    uint32_t number = byte[0] & 0xffu >> (length + 1);
    for (size_t i = 1; i < length; ++i)
        number = number << 6 | (byte[i] & 63u);
    while (line > r->text->files[file].text && line[-1] != '\n')
        --line;
    uint32_t column = (uint32_t)(first - line) + 1;
    const char *name = r->text->files[file].name;
    if (length > 1)
        shader_error_add(r->log, r->errors, name, scan->token_line, column,
                         "the character '%.*s' (U+%04X) is not GLSL", (int)length, first, number);
    else
        shader_error_add(r->log, r->errors, name, scan->token_line, column,
                         byte[0] > 127 ? "the byte 0x%02X is not GLSL"
                                       : "the character '%c' is not GLSL",
                         byte[0]);
    return WHIT_ERROR_INPUT;
}

/* Strings other than names in #include occur in #error alone. Comment marks in them are refused, as
   glslang and scan.c might disagree about them. */
static whit_result check_token(struct reading *r, uint32_t file, struct scan *scan,
                               struct conditions *open)
{
    const char *why = refused(scan);
    if (why)
        return at(r, file, scan->token_line, why);
    if (scan->kind == SCAN_DIRECTIVE) {
        whit_result result = check_directive(r, file, scan, open);
        return result == WHIT_OK && strcmp(scan->text, "include") == 0 ? read_include(r, file, scan)
                                                                       : result;
    }
    if (scan->kind == SCAN_STRING && (strstr(scan->text, "//") || strstr(scan->text, "/*")))
        return at(r, file, scan->token_line, "a comment in a string");
    if (scan->kind == SCAN_SIGN && is_no_sign(scan))
        return refuse_character(r, file, scan);
    if (scan_is(scan, SCAN_SIGN, "#"))
        return at(r, file, scan->token_line,
                  "# stands at the start of a line alone, and ## nowhere");
    return WHIT_OK;
}

static void blank(char *from, const char *to)
{
    for (; from < to; ++from) {
        if (*from != '\n' && *from != '\r')
            *from = ' ';
    }
}

/* Whether the directive `#if` is followed by 0 alone. Reads up to the end of its line. */
static bool is_if_zero(struct scan *scan)
{
    return scan_is(scan, SCAN_DIRECTIVE, "if") && scan_next(scan) &&
           scan_is(scan, SCAN_WORD, "0") && scan_next(scan) && scan->kind == SCAN_NEWLINE;
}

/* Blanks what stands between `#if 0` and its #elif, #else or #endif, so that functions, includes
   and annotations there mean as little to whit as to the compiler. Other conditions are known to
   the compiler alone. */
static void blank_if_zero(struct shader_file *file)
{
    struct scan scan;
    char *from = NULL; /* what is to be blanked */
    uint32_t depth = 0;
    scan_begin(&scan, file->text, file->bytes);
    while (scan_next(&scan)) {
        if (scan.kind != SCAN_DIRECTIVE)
            continue;
        bool opens = strncmp(scan.text, "if", 2) == 0, ends = strcmp(scan.text, "endif") == 0;
        if (!from) {
            from = is_if_zero(&scan) ? file->text + (scan.at - file->text) : NULL;
            depth = 0;
        } else if (depth == 0 && (ends || strncmp(scan.text, "el", 2) == 0)) {
            blank(from, scan.start);
            from = NULL;
        } else {
            depth += opens;
            depth -= ends;
        }
    }
}

static whit_result check_file(struct reading *r, uint32_t index)
{
    struct conditions open = {.count = 0};
    struct scan scan;
    scan_begin(&scan, r->text->files[index].text, r->text->files[index].bytes);
    while (scan_next(&scan)) {
        whit_result result = check_token(r, index, &scan, &open);
        if (result != WHIT_OK)
            return result;
    }
    if (scan.kind == SCAN_BAD)
        return at(r, index, scan.token_line, scan.reason);
    if (open.count)
        return at(r, index, open.lines[open.count - 1], "#if without #endif in this file");
    return WHIT_OK;
}

/* --- files ---------------------------------------------------------------------------------- */

/* Reads a file and what it includes; owns `relative`. `place`: its #include; NULL: the first
   file. */
static whit_result read_one(struct reading *r, const struct place *place, char *relative,
                            uint32_t *index)
{
    struct shader_text *text = r->text;
    struct shader_file file = {.relative = relative};
    const char *many = text->file_count == SHADER_TEXT_FILES_MAX ? "more than 64 files"
                       : r->open_count == SHADER_TEXT_DEPTH_MAX
                           ? "files that include files, more than 16 deep"
                           : NULL;
    if (many) {
        free(relative);
        return refuse(r, place, many);
    }
    file.name = string_format("%s%s", r->folder, relative);
    if (!file.name || !ARRAY_PUSH(text->files, text->file_count, text->file_capacity, file)) {
        free(file.name);
        free(relative);
        return no_memory(r);
    }
    *index = text->file_count - 1;
    struct place itself = {text->files[*index].name, 0, NULL};
    const struct place *whose = place ? place : &itself;
    whit_result result = r->sources ? copy_source(r, whose, &text->files[*index])
                                    : read_file(r, whose, &text->files[*index]);
    if (result != WHIT_OK)
        return result;
    struct shader_file *kept = &text->files[*index];
    kept->text[kept->bytes] = 0;
    kept->raw = malloc(kept->bytes + 1);
    if (!kept->raw)
        return no_memory(r);
    memcpy(kept->raw, kept->text, kept->bytes + 1);
    r->below[*index] = 1;
    r->open[r->open_count++] = *index;
    even_out(kept);
    result = check_bytes(r, kept);
    if (result == WHIT_OK)
        blank_if_zero(kept);
    if (result == WHIT_OK)
        result = check_file(r, *index);
    r->open_count--;
    return result;
}

static whit_result read_all(struct reading *r, const char *first)
{
    uint32_t index;
    char *relative = string_copy(first);
    whit_result result = relative ? read_one(r, NULL, relative, &index) : no_memory(r);
    if (result != WHIT_OK)
        shader_text_free(r->text);
    return result;
}

whit_result shader_text_read(const whit_log *log, const char *path, struct shader_text *text,
                             struct shader_errors *errors)
{
    *text = (struct shader_text){0};
    struct reading r = {.log = log, .errors = errors, .text = text};
    char *folder = path_folder(path);
    whit_result result = folder ? roots_init(&r.roots, path) : WHIT_ERROR_MEMORY;
    r.folder = folder;
    result = result == WHIT_OK ? read_all(&r, path_name(path)) : no_memory(&r);
    roots_finish(&r.roots);
    free(folder);
    return result;
}

whit_result shader_text_from(const whit_log *log, const struct shader_text_source *sources,
                             uint32_t count, struct shader_text *text, struct shader_errors *errors)
{
    *text = (struct shader_text){0};
    struct reading r = {.log = log,
                        .errors = errors,
                        .text = text,
                        .folder = "",
                        .sources = sources,
                        .source_count = count};
    if (!count)
        return log_failure(log, WHIT_ERROR_INPUT, "a shader without text");
    return read_all(&r, sources[0].relative);
}

void shader_text_free(struct shader_text *text)
{
    for (uint32_t i = 0; i < text->file_count; ++i) {
        free(text->files[i].name);
        free(text->files[i].relative);
        free(text->files[i].text);
        free(text->files[i].raw);
        free(text->files[i].includes);
    }
    free(text->files);
    *text = (struct shader_text){0};
}

bool shader_text_copy(const struct shader_text *text, size_t more, struct shader_text *out)
{
    *out = (struct shader_text){.file_capacity = text->file_count};
    out->files = array_alloc_zeroed(text->file_count, sizeof *out->files);
    bool fine = out->files != NULL;
    for (uint32_t i = 0; fine && i < text->file_count; ++i) {
        const struct shader_file *source = &text->files[i];
        struct shader_file *file = &out->files[i];
        *file = *source;
        file->text = malloc(source->bytes + 1 + more);
        fine = file->text != NULL;
        out->file_count += fine;
        if (fine)
            memcpy(file->text, source->text, source->bytes + 1);
    }
    if (!fine)
        shader_text_end_copy(out);
    return fine;
}

void shader_text_end_copy(struct shader_text *copy)
{
    for (uint32_t i = 0; i < copy->file_count; ++i)
        free(copy->files[i].text);
    free(copy->files);
    *copy = (struct shader_text){0};
}

bool shader_text_defines(const struct shader_text *text, const char *name, uint32_t *file,
                         uint32_t *line)
{
    for (uint32_t i = 0; i < text->file_count; ++i) {
        if (!scan_finds(text->files[i].text, text->files[i].bytes, name, line))
            continue;
        if (file)
            *file = i;
        return true;
    }
    return false;
}

uint64_t shader_text_hash(const struct shader_text *text)
{
    uint64_t hash = HASH_START;
    for (uint32_t i = 0; i < text->file_count; ++i) {
        const struct shader_file *file = &text->files[i];
        hash = hash_bytes(hash, file->relative, strlen(file->relative));
        hash = hash_bytes(hash, file->raw, file->bytes);
    }
    return hash;
}
