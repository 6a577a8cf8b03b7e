#include "shader/expand.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "shader/scan.h"
#include "sources.h"

enum { DEPTH_MAX = 32, NAME_BYTES = EXPAND_NAME_BYTES };
#define EXPANDED_BYTES ((size_t)16 << 20)

struct expansion {
    const struct shader_text *text;
    const struct shader_request *request;
    const char *own;
    char *out;
    size_t used, room;
    size_t user_at, user_end;
    const struct shader_source *sources; /* whit's own, or the request's stages */
    uint32_t source_count;
    bool *pasted; /* by source: whether it is in `out` under no condition */
    uint32_t depth;
    bool failed; /* no memory */
    bool large;
    const char *missing; /* name of an include that does not exist; NULL: none */
    char name[NAME_BYTES];
};

static void put(struct expansion *e, const char *text, size_t bytes)
{
    if (e->used + bytes > EXPANDED_BYTES) {
        e->large = true;
        return;
    }
    if (e->used + bytes + 1 > e->room) {
        size_t room = 2 * (e->used + bytes + 1);
        char *out = realloc(e->out, room);
        e->failed = e->failed || !out;
        if (!out)
            return;
        e->out = out;
        e->room = room;
    }
    memcpy(e->out + e->used, text, bytes);
    e->used += bytes;
    e->out[e->used] = 0;
}

static void put_string(struct expansion *e, const char *text)
{
    put(e, text, strlen(text));
}

static void put_line(struct expansion *e, uint32_t line, const char *tag, uint32_t file)
{
    char text[NAME_BYTES];
    snprintf(text, sizeof text, "#line %u \"%s%u\"\n", line, tag, file);
    put_string(e, text);
}

static bool has_user(const struct expansion *e)
{
    return e->text && e->text->file_count;
}

static bool goes_on(const struct expansion *e)
{
    return !e->failed && !e->large && !e->missing;
}

/* --- the user's text ------------------------------------------------------------------------ */

/* Recursive; ends since no file includes itself, directly or not. */
static void put_user_file(struct expansion *e, uint32_t index)
{
    const struct shader_file *file = &e->text->files[index];
    uint32_t line = 1, include = 0;
    put_line(e, 1, EXPAND_USER_TAG, index);
    for (const char *at = file->text, *end; *at && goes_on(e); at = *end ? end + 1 : end, ++line) {
        end = at + strcspn(at, "\n");
        if (include < file->include_count && file->includes[include].line == line) {
            put_user_file(e, file->includes[include++].file);
            put_line(e, line + 1, EXPAND_USER_TAG, index);
        } else {
            put(e, at, strcspn(at, "\r\n"));
            put(e, "\n", 1);
        }
    }
    put_string(e, "\n\n"); /* two, since the last line may end with a backslash */
}

static bool may_be_undefined(const char *name)
{
    return strncmp(name, "GL_", 3) != 0 && strcmp(name, "defined") != 0 &&
           strcmp(name, "__LINE__") != 0 && strcmp(name, "__FILE__") != 0 &&
           strcmp(name, "__VERSION__") != 0;
}

/* Undefines the user's macros, so that they do not reach whit's own text. */
static void put_undefs(struct expansion *e, const struct shader_file *file)
{
    struct scan scan;
    scan_begin(&scan, file->text, file->bytes);
    while (scan_next(&scan)) {
        if (!scan_is(&scan, SCAN_DIRECTIVE, "define") || !scan_next(&scan) ||
            scan.kind != SCAN_WORD || strlen(scan.text) + 1 == sizeof scan.text ||
            !may_be_undefined(scan.text))
            continue;
        put_string(e, "#undef ");
        put_string(e, scan.text);
        put_string(e, "\n");
    }
}

static void put_user(struct expansion *e)
{
    if (e->request->declared)
        put_string(e, e->request->declared);
    e->user_at = e->used;
    put_user_file(e, 0);
    e->user_end = e->used;
    for (uint32_t i = 0; i < e->text->file_count && goes_on(e); ++i)
        put_undefs(e, &e->text->files[i]);
}

/* --- whit's own ----------------------------------------------------------------------------- */

void expand_join(const char *from, const char *name, size_t length, char out[NAME_BYTES])
{
    const char *slash = strrchr(from, '/');
    if (length > 3 && memcmp(name, "../", 3) == 0)
        snprintf(out, NAME_BYTES, "%.*s", (int)(length - 3), name + 3);
    else
        snprintf(out, NAME_BYTES, "%.*s%.*s", slash ? (int)(slash + 1 - from) : 0, from,
                 (int)length, name);
}

/* If the line is the directive `name`, returns the text behind that name, else NULL. */
static const char *is_directive(const char *line, const char *name)
{
    line += strspn(line, " \t");
    if (*line++ != '#')
        return NULL;
    line += strspn(line, " \t");
    size_t length = strlen(name);
    return strncmp(line, name, length) == 0 ? line + length : NULL;
}

size_t expand_included(const char *line, const char **name)
{
    const char *at = is_directive(line, "include");
    if (!at)
        return 0;
    *name = at + strspn(at, " \t") + 1;
    return (*name)[-1] == '"' ? strcspn(*name, "\"\n") : 0;
}

struct own_file {
    const char *path, *text;
    uint32_t index;
    bool whole; /* the file is included under no condition */
};

static void put_own(struct expansion *e, const struct own_file *file);

static void put_included(struct expansion *e, const struct own_file *file, const char *name,
                         size_t length, bool whole)
{
    char path[NAME_BYTES];
    expand_join(file->path, name, length, path);
    uint32_t index = shader_stages_find(e->request->stages, path);
    if (index == e->source_count || e->depth == DEPTH_MAX) {
        snprintf(e->name, sizeof e->name, "%s", path);
        e->missing = e->name;
        return;
    }
    if (e->pasted[index])
        return;
    e->pasted[index] = whole;
    if (has_user(e) && strcmp(path, "hook/user.glsl") == 0) {
        put_user(e);
        return;
    }
    const struct own_file other = {path, e->sources[index].text, index, whole};
    e->depth++;
    put_own(e, &other);
    e->depth--;
}

static void put_defines(struct expansion *e)
{
    for (uint32_t i = 0; i < e->request->define_count; ++i) {
        put_string(e, "#define ");
        put_string(e, e->request->defines[i]);
        put_string(e, "\n");
    }
}

/* The number of the line behind which defines go: the last #extension, or #version (with `version`
   only that). 0: there is none. */
static uint32_t head_lines(const char *text, bool version)
{
    uint32_t line = 1, last = 0;
    for (const char *at = text; at && *at; ++line) {
        if (is_directive(at, "version") || (!version && is_directive(at, "extension")))
            last = line;
        at = strchr(at, '\n');
        at = at ? at + 1 : NULL;
    }
    return last;
}

/* Depth of open #if conditions. `guarded`: the first is the file's include guard, and counts
   too. */
struct open_conditions {
    uint32_t count;
    bool guarded, seen;
};

static void follow_conditions(struct open_conditions *open, const char *line)
{
    bool opens = is_directive(line, "if") != NULL;
    if (!open->seen && is_directive(line, "")) {
        open->seen = true;
        open->guarded = is_directive(line, "ifndef") != NULL;
    }
    if (opens)
        open->count++;
    else if (is_directive(line, "endif") && open->count)
        open->count--;
}

static void put_own(struct expansion *e, const struct own_file *file)
{
    bool kernel = e->depth == 0;
    uint32_t line = 1, version = kernel ? head_lines(file->text, true) : 0;
    uint32_t head = kernel ? head_lines(file->text, false) : 0;
    struct open_conditions open = {0};
    if (!kernel)
        put_line(e, 1, e->own, file->index);
    for (const char *at = file->text, *next; *at && goes_on(e); at = next, ++line) {
        const char *name, *end = at + strcspn(at, "\n");
        size_t length = expand_included(at, &name);
        next = *end ? end + 1 : end;
        follow_conditions(&open, at);
        if (length) {
            put_included(e, file, name, length, file->whole && open.count == open.guarded);
        } else {
            put(e, at, (size_t)(end - at));
            put(e, "\n", 1);
        }
        if (line == version)
            put_string(e, "#extension GL_GOOGLE_cpp_style_line_directive : require\n");
        if (line == head)
            put_defines(e);
        /* An include under a false condition leaves no #line behind it, so one follows each #endif
           and #else. */
        bool ends = is_directive(at, "endif") || is_directive(at, "else");
        if (length || line == version || line == head || ends)
            put_line(e, line + 1, e->own, file->index);
    }
}

static const char *kernel_name(const struct expansion *e)
{
    const struct shader_stages *stages = e->request->stages;
    uint32_t index = shader_stages_find(stages, e->request->kernel);
    return stages && index < stages->count ? stages->names[index] : e->request->kernel;
}

static whit_result explain(const struct expansion *e, const whit_log *log,
                           struct shader_errors *errors)
{
    if (e->failed)
        return log_failure(log, WHIT_ERROR_MEMORY, "no memory for the text of a kernel");
    if (e->large)
        shader_error_add(log, errors, has_user(e) ? e->text->files[0].name : e->request->kernel, 0,
                         0, "larger than 16 MiB with all that it includes");
    else if (e->missing)
        shader_error_add(log, errors, "whit", 0, 0, "no shader %s is embedded", e->missing);
    else
        shader_error_add(log, errors, kernel_name(e), 0, 0, "%s",
                         e->out ? "it does not include hook/user.glsl" : "it is empty");
    return WHIT_ERROR_INPUT;
}

whit_result expand_kernel(const whit_log *log, const struct shader_text *text,
                          const struct shader_request *request, const char *own,
                          struct expanded *expanded, struct shader_errors *errors)
{
    struct expansion e = {.text = text, .request = request, .own = own};
    const struct shader_stages *stages = request->stages;
    e.sources = shader_stages_list(stages, &e.source_count);
    e.pasted = array_alloc_zeroed(e.source_count, sizeof *e.pasted);
    e.failed = !e.pasted;
    uint32_t index =
        request->kernel_text ? e.source_count : shader_stages_find(stages, request->kernel);
    struct own_file kernel = {request->kernel, request->kernel_text, index, true};
    if (!kernel.text && index == e.source_count)
        e.missing = request->kernel;
    else if (!kernel.text)
        kernel.text = e.sources[index].text;
    if (goes_on(&e))
        put_own(&e, &kernel);
    free(e.pasted);
    *expanded = (struct expanded){0};
    if (goes_on(&e) && e.out && (!has_user(&e) || e.user_end)) {
        *expanded = (struct expanded){e.out, e.used, e.user_at, e.user_end};
        return WHIT_OK;
    }
    whit_result result = explain(&e, log, errors);
    free(e.out);
    return result;
}
