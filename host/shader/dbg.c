#include "shader/dbg.h"

#include <stdio.h>
#include <string.h>

#include "shader/scan.h"

/* The state while one file is read. */
struct reading {
    const whit_log *log;
    const struct shader_text *text;
    const struct shader_tests *tests;
    struct shader_dbg *dbg;
    struct shader_errors *errors;
    uint32_t file;
    bool wrong; /* an error was reported */
};

static void complain(struct reading *r, uint32_t line, const char *reason)
{
    r->wrong = true;
    shader_error_add(r->log, r->errors, r->text->files[r->file].name, line, 0, "%s", reason);
}

static bool is_in_test(const struct reading *r, size_t at)
{
    for (uint32_t i = 0; i < r->tests->test_count; ++i) {
        const struct shader_test *test = &r->tests->tests[i];
        if (test->file == r->file && test->begin < at && at < test->end)
            return true;
    }
    return false;
}

/* Number of values between brackets; `scan` is behind the opening one. 0: no value, or no closing
   bracket. */
static uint32_t count_values(struct scan scan)
{
    uint32_t open = 1, commas = 0, tokens = 0;
    while (open && scan_next(&scan)) {
        char sign = scan.kind == SCAN_SIGN ? scan.text[0] : 0;
        open += sign == '(' || sign == '[';
        open -= sign == ')' || sign == ']';
        commas += sign == ',' && open == 1;
        tokens += open > 0;
    }
    return open || !tokens ? 0 : commas + 1;
}

/* Why a dbg(x) is wrong, whose bracket `scan` has just read; NULL: it is right. */
static const char *refuse_call(const struct reading *r, const struct scan *scan,
                               const struct scan_functions *functions, size_t word)
{
    if (scan->in_directive)
        return "dbg(x) stands in a function and in no macro or other directive";
    if (is_in_test(r, word))
        return "dbg(x) is of a pixel, and a test has none: check() tells what fails";
    if (functions->braces == 0)
        return "dbg(x) stands in the body of a function";
    if (count_values(*scan) != 1)
        return "dbg(x) takes one value";
    if (r->dbg->count == SHADER_DBG_MAX)
        return "a file has at most 64 dbg(x)";
    return NULL;
}

static void add_site(struct reading *r, const struct scan *scan, size_t word, uint32_t line)
{
    const char *text = r->text->files[r->file].text;
    struct shader_dbg_site *site = &r->dbg->sites[r->dbg->count++];
    site->file = r->file;
    site->line = line;
    site->word = word;
    site->at = (size_t)(scan->at - text);
    scan_copy_brackets(scan->at, site->text, sizeof site->text);
}

static void read_file(struct reading *r)
{
    const struct shader_file *file = &r->text->files[r->file];
    struct scan_functions functions = {.braces = 0};
    struct scan scan;
    size_t word = 0;
    uint32_t line = 0;
    bool named = false; /* the last token was dbg */
    scan_begin(&scan, file->text, file->bytes);
    while (!r->wrong && scan_next(&scan)) {
        scan_follow(&scan, &functions);
        if (named && scan_is(&scan, SCAN_SIGN, "(")) {
            const char *why = refuse_call(r, &scan, &functions, word);
            if (why)
                complain(r, line, why);
            else
                add_site(r, &scan, word, line);
        }
        word = (size_t)(scan.start - file->text);
        named = scan_is(&scan, SCAN_WORD, "dbg") && memcmp(scan.start, "dbg", 3) == 0;
        line = scan.token_line;
    }
}

whit_result shader_dbg_read(const whit_log *log, const struct shader_text *text,
                            const struct shader_tests *tests, struct shader_dbg *dbg,
                            struct shader_errors *errors)
{
    struct reading r = {.log = log, .text = text, .tests = tests, .dbg = dbg, .errors = errors};
    dbg->count = 0;
    if (shader_text_defines(text, "dbg", NULL, NULL))
        return WHIT_OK;
    for (; r.file < text->file_count && !r.wrong; ++r.file)
        read_file(&r);
    return r.wrong ? WHIT_ERROR_INPUT : WHIT_OK;
}

/* ---- Texts for kernels ---- */

enum { NUMBER_BYTES = 8 };

/* Writes the text of `source` into `file`, with the numbers of calls. */
static void put_numbers(const struct shader_dbg *dbg, uint32_t index,
                        const struct shader_file *source, struct shader_file *file)
{
    size_t from = 0, to = 0;
    for (uint32_t i = 0; i < dbg->count; ++i) {
        const struct shader_dbg_site *site = &dbg->sites[i];
        if (site->file != index)
            continue;
        memcpy(file->text + to, source->text + from, site->at - from);
        to += site->at - from;
        from = site->at;
        to += (size_t)snprintf(file->text + to, NUMBER_BYTES, "%uu, ", i);
    }
    memcpy(file->text + to, source->text + from, source->bytes - from + 1);
    file->bytes = to + source->bytes - from;
}

bool shader_dbg_text(const struct shader_dbg *dbg, const struct shader_text *text, bool numbered,
                     struct shader_text *out)
{
    if (!shader_text_copy(text, (size_t)dbg->count * NUMBER_BYTES, out))
        return false;
    for (uint32_t i = 0; numbered && i < text->file_count; ++i)
        put_numbers(dbg, i, &text->files[i], &out->files[i]);
    for (uint32_t i = 0; !numbered && i < dbg->count; ++i)
        memset(out->files[dbg->sites[i].file].text + dbg->sites[i].word, ' ', strlen("dbg"));
    return true;
}
