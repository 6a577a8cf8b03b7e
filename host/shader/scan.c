#include "shader/scan.h"

#include <stdio.h>
#include <string.h>

static bool is_newline(char c)
{
    return c == '\n' || c == '\r';
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

bool scan_is_of_word(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* Skips one end of a line: LF, CR or CR LF. */
static const char *behind_newline(const char *at, const char *end)
{
    return at[0] == '\r' && at + 1 < end && at[1] == '\n' ? at + 2 : at + 1;
}

/* Skips backslashes at ends of lines, with these ends. */
static void join_lines(struct scan *scan)
{
    while (scan->at + 1 < scan->end && scan->at[0] == '\\' && is_newline(scan->at[1])) {
        scan->at = behind_newline(scan->at + 1, scan->end);
        scan->line++;
    }
}

/* The current character, 0 at the end. */
static char look(struct scan *scan)
{
    join_lines(scan);
    return scan->at < scan->end ? *scan->at : 0;
}

static void step(struct scan *scan)
{
    if (is_newline(*scan->at)) {
        scan->at = behind_newline(scan->at, scan->end);
        scan->line++;
    } else {
        scan->at++;
    }
}

static bool bad(struct scan *scan, const char *reason)
{
    scan->kind = SCAN_BAD;
    scan->reason = reason;
    scan->at = scan->end;
    return false;
}

void scan_begin(struct scan *scan, const char *text, size_t bytes)
{
    memset(scan, 0, sizeof *scan);
    scan->begin = scan->at = text;
    scan->end = text + bytes;
    scan->line = 1;
    scan->at_line_start = true;
}

/* Skips a comment; `scan` is behind its first slash. */
static bool skip_comment(struct scan *scan)
{
    bool line = look(scan) == '/';
    step(scan);
    for (char last = 0, c; (c = look(scan)) != 0 || scan->at < scan->end; last = c) {
        if (line && is_newline(c))
            return true;
        step(scan);
        if (!line && last == '*' && c == '/')
            return true;
    }
    return line || bad(scan, "a comment that does not end");
}

/* Whether a line begins here, but for blanks, and is an annotation. */
static bool is_annotation(const struct scan *scan)
{
    const char *first = scan->at;
    while (first > scan->begin && is_blank(first[-1]))
        --first;
    return scan->annotations && scan->at_line_start && !scan->in_directive &&
           (first == scan->begin || is_newline(first[-1])) && scan->end - scan->at >= 3 &&
           memcmp(scan->at, "//@", 3) == 0;
}

/* Skips blanks, comments and, outside of directives, ends of lines. */
static bool skip_blanks(struct scan *scan)
{
    for (;;) {
        char c = look(scan);
        if (is_newline(c) && !scan->in_directive) {
            scan->at_line_start = true;
            step(scan);
        } else if (is_blank(c)) {
            step(scan);
        } else if (is_annotation(scan)) {
            return true;
        } else if (c == '/') {
            struct scan before = *scan;
            step(scan);
            char next = look(scan);
            if (next != '/' && next != '*') {
                *scan = before;
                return true;
            }
            scan->token_line = before.line;
            if (!skip_comment(scan))
                return false;
        } else {
            return true;
        }
    }
}

static void take_word(struct scan *scan)
{
    size_t used = 0;
    for (char c; scan_is_of_word(c = look(scan)); step(scan)) {
        if (used + 1 < sizeof scan->text)
            scan->text[used++] = c;
    }
    scan->text[used] = 0;
}

/* Reads a string; refuses what the compiler might read differently from this scanner. */
static bool take_string(struct scan *scan)
{
    size_t used = 0;
    step(scan);
    for (;; step(scan)) {
        if (scan->at >= scan->end || is_newline(*scan->at))
            return bad(scan, "a string that does not end on its line");
        char c = *scan->at;
        if (c == '"')
            break;
        if (c == '\\')
            return bad(scan, "a backslash in a string");
        if (used + 1 < sizeof scan->text)
            scan->text[used++] = c;
    }
    step(scan);
    scan->text[used] = 0;
    scan->kind = SCAN_STRING;
    return true;
}

static bool take_directive(struct scan *scan)
{
    step(scan);
    scan->in_directive = true;
    if (!skip_blanks(scan))
        return false;
    take_word(scan);
    scan->kind = SCAN_DIRECTIVE;
    return true;
}

bool scan_next(struct scan *scan)
{
    if (scan->kind == SCAN_BAD || !skip_blanks(scan))
        return false;
    bool first = scan->at_line_start, annotation = is_annotation(scan);
    char c = look(scan);
    scan->token_line = scan->line;
    scan->start = scan->at;
    scan->at_line_start = false;
    scan->text[0] = 0;
    if (scan->in_directive && (scan->at >= scan->end || is_newline(c))) {
        scan->in_directive = false;
        scan->kind = SCAN_NEWLINE;
        return true;
    }
    if (scan->at >= scan->end) {
        scan->kind = SCAN_END;
        return false;
    }
    if (annotation) {
        scan->kind = SCAN_ANNOTATION;
        scan->annotation = scan->at + 3;
        step(scan);
        return skip_comment(scan);
    }
    if (first && c == '#')
        return take_directive(scan);
    if (c == '"')
        return take_string(scan);
    if (scan_is_of_word(c)) {
        scan->kind = SCAN_WORD;
        take_word(scan);
        return true;
    }
    scan->kind = SCAN_SIGN;
    scan->text[0] = c;
    scan->text[1] = 0;
    step(scan);
    return true;
}

bool scan_is(const struct scan *scan, enum scan_kind kind, const char *text)
{
    return scan->kind == kind && strcmp(scan->text, text) == 0;
}

/* Restores the depth of braces at #else, as both branches may open the same block. */
static void follow_directive(const struct scan *scan, struct scan_functions *f)
{
    const uint32_t max = sizeof f->depths / sizeof *f->depths;
    bool opens = strncmp(scan->text, "if", 2) == 0;
    if (opens && f->depth_count < max)
        f->depths[f->depth_count] = f->braces;
    f->depth_count += opens;
    if (strncmp(scan->text, "el", 2) == 0 && f->depth_count && f->depth_count <= max)
        f->braces = f->depths[f->depth_count - 1];
    f->depth_count -= f->depth_count && strcmp(scan->text, "endif") == 0;
}

/* Whether the current sign opens the body of a function. */
static bool follow_sign(char sign, struct scan_functions *f)
{
    bool body = sign == '{' && f->braces == 0 && f->closed;
    if (sign == '{') {
        f->braces++;
        f->brackets = 0;
    } else if (sign == '}') {
        f->braces -= f->braces > 0;
        f->brackets = 0;
    } else if (sign == '(') {
        f->brackets++;
    } else if (sign == ')' && f->brackets) {
        f->brackets--;
        f->closed = f->brackets == 0 && f->name[0];
        return false;
    }
    if (f->brackets == 0)
        f->closed = false;
    if (f->brackets == 0 && !body)
        f->name[0] = 0;
    return body;
}

bool scan_follow(const struct scan *scan, struct scan_functions *f)
{
    if (scan->kind == SCAN_DIRECTIVE) {
        follow_directive(scan, f);
    } else if (scan->in_directive) {
        return false;
    } else if (scan->kind == SCAN_WORD && f->braces == 0 && f->brackets == 0) {
        memcpy(f->name, scan->text, sizeof f->name);
        f->line = scan->token_line;
        f->closed = false;
    } else if (scan->kind == SCAN_SIGN) {
        return follow_sign(scan->text[0], f);
    }
    return false;
}

bool scan_next_function(struct scan *scan, struct scan_functions *f)
{
    while (scan_next(scan)) {
        if (scan_follow(scan, f))
            return true;
    }
    return false;
}

bool scan_finds(const char *text, size_t bytes, const char *name, uint32_t *line)
{
    struct scan scan;
    struct scan_functions functions = {.braces = 0};
    scan_begin(&scan, text, bytes);
    while (scan_next_function(&scan, &functions)) {
        if (strcmp(functions.name, name) != 0)
            continue;
        if (line)
            *line = functions.line;
        return true;
    }
    return false;
}

void scan_copy_brackets(const char *at, char *out, size_t bytes)
{
    uint32_t open = 1;
    size_t used = 0;
    for (; *at; ++at) {
        bool comment = at[0] == '/' && (at[1] == '/' || at[1] == '*');
        if (comment) {
            const char *end = at[1] == '/' ? strchr(at, '\n') : strstr(at + 2, "*/");
            if (!end)
                break;
            at = end + (*end == '*');
        }
        open += *at == '(';
        open -= *at == ')';
        bool blank = comment || is_blank(*at) || is_newline(*at);
        if (open == 0 || used + 4 >= bytes)
            break;
        if (!blank)
            out[used++] = *at;
        else if (used && out[used - 1] != ' ')
            out[used++] = ' ';
    }
    while (used && out[used - 1] == ' ')
        used--;
    strcpy(out + used, open ? "..." : "");
}

/* The OpenGL Shading Language 4.60, 3.6 Keywords. */
bool scan_is_keyword(const char *name)
{
    static const char words[] =
        " active asm atomic_uint attribute bool break buffer case cast centroid class coherent "
        "common const continue default demote discard do double else enum extern external false "
        "filter fixed flat float for fvec2 fvec3 fvec4 goto half highp hvec2 hvec3 hvec4 if in "
        "inline inout input int interface invariant layout long lowp mediump namespace noinline "
        "noperspective out output packed partition patch precise precision public readonly "
        "resource restrict return sample shared short sizeof smooth static struct subroutine "
        "superp switch template this true typedef uint uniform union unsigned using varying void "
        "volatile while writeonly ";
    static const char *const types[] = {"vec", "bvec", "ivec",    "uvec",  "dvec",
                                        "mat", "dmat", "sampler", "image", "texture"};
    enum { VECTORS = 5, MATRICES = 2 };
    char word[96];
    snprintf(word, sizeof word, " %s ", name);
    for (size_t i = 0; i < sizeof types / sizeof *types; ++i) {
        size_t length = strlen(types[i]);
        if (strncmp(name, types[i], length) != 0)
            continue;
        const char *rest = name + length; /* as in vec3, mat2x4, image2D */
        bool sized = rest[0] >= '2' && rest[0] <= '4';
        bool by = rest[0] && rest[1] == 'x' && rest[2] >= '2' && rest[2] <= '4' && !rest[3];
        bool of_dimension = rest[0] >= '1' && rest[0] <= '3' && rest[1] == 'D' && !rest[2];
        if (i < VECTORS              ? sized && !rest[1]
            : i < VECTORS + MATRICES ? sized && (!rest[1] || by)
                                     : of_dimension)
            return true;
    }
    return strstr(words, word);
}
