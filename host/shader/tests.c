#include "shader/tests.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "shader/scan.h"

/* The state while one file is read. */
struct reading {
    const whit_log *log;
    const struct shader_text *text;
    struct shader_tests *tests;
    struct shader_errors *errors;
    uint32_t file;
    struct scan scan;
    bool failed; /* no memory */
    bool wrong;  /* an error was reported */
};

static const struct shader_file *file_of(const struct reading *r)
{
    return &r->text->files[r->file];
}

static void complain(struct reading *r, uint32_t line, const char *reason)
{
    r->wrong = true;
    shader_error_add(r->log, r->errors, file_of(r)->name, line, 0, "%s", reason);
}

/* ---- Marks ---- */

/* Whether the current token is `//@ test`. */
static bool is_mark(const struct scan *scan)
{
    if (scan->kind != SCAN_ANNOTATION)
        return false;
    const char *word = scan->annotation + strspn(scan->annotation, " \t");
    if (strncmp(word, "test", 4) != 0)
        return false;
    word += 4 + strspn(word + 4, " \t\r");
    return !*word || *word == '\n';
}

/* ---- Functions ---- */

static const char form[] = "behind `//@ test` stands `void NAME(uint seed) { ... }`, once";

static bool take(struct reading *r, enum scan_kind kind, const char *text)
{
    return scan_next(&r->scan) && (text ? scan_is(&r->scan, kind, text) : r->scan.kind == kind);
}

/* Reads from `void` to the brace that opens the body. */
static bool read_head(struct reading *r, struct shader_test *test)
{
    if (!take(r, SCAN_WORD, "void"))
        return false;
    test->begin = (size_t)(r->scan.start - file_of(r)->text);
    test->line = r->scan.token_line;
    if (!take(r, SCAN_WORD, NULL) || strlen(r->scan.text) >= sizeof test->name)
        return false;
    strcpy(test->name, r->scan.text);
    return take(r, SCAN_SIGN, "(") && take(r, SCAN_WORD, "uint") && take(r, SCAN_WORD, NULL) &&
           take(r, SCAN_SIGN, ")") && take(r, SCAN_SIGN, "{");
}

/* Reads a check; the current token is `check`. */
static void read_check(struct reading *r, const struct shader_test *test)
{
    struct shader_tests *tests = r->tests;
    struct shader_check check = {.file = r->file,
                                 .line = r->scan.token_line,
                                 .number = tests->check_count - test->first_check};
    if (!take(r, SCAN_SIGN, "(")) {
        complain(r, check.line, "check(...) is called, and nothing else is done with it");
        return;
    }
    check.at = (size_t)(r->scan.at - file_of(r)->text);
    scan_copy_brackets(r->scan.at, check.text, sizeof check.text);
    if (!ARRAY_PUSH(tests->checks, tests->check_count, tests->check_capacity, check))
        r->failed = true;
}

static bool goes_on(const struct reading *r)
{
    return !r->failed && !r->wrong;
}

static void read_body(struct reading *r, struct shader_test *test)
{
    bool directive = false;
    uint32_t open = 1;
    while (open && goes_on(r) && scan_next(&r->scan)) {
        directive = r->scan.kind == SCAN_DIRECTIVE || (directive && r->scan.kind != SCAN_NEWLINE);
        if (directive)
            continue;
        open += scan_is(&r->scan, SCAN_SIGN, "{");
        open -= scan_is(&r->scan, SCAN_SIGN, "}");
        if (scan_is(&r->scan, SCAN_WORD, "check"))
            read_check(r, test);
    }
    if (open && goes_on(r))
        complain(r, test->line, "a test whose body does not end");
    test->end = (size_t)(r->scan.at - file_of(r)->text);
}

/* Reads the test whose mark is the current token of `marks`. */
static void read_test(struct reading *r, const struct scan *marks)
{
    uint32_t line = marks->token_line;
    struct shader_tests *tests = r->tests;
    struct shader_test test = {.file = r->file, .first_check = tests->check_count};
    r->scan = *marks;
    r->scan.annotations = false;
    const struct shader_test *last =
        tests->test_count ? &tests->tests[tests->test_count - 1] : NULL;
    bool has_form = read_head(r, &test);
    if (!has_form || (last && last->file == test.file && test.begin < last->end)) {
        complain(r, line, form);
        return;
    }
    read_body(r, &test);
    test.check_count = tests->check_count - test.first_check;
    if (goes_on(r) && !test.check_count)
        complain(r, test.line, "a test without a check(...) in its body");
    else if (goes_on(r) && test.check_count > SHADER_CHECKS_MAX)
        complain(r, test.line, "a test has at most 1,024 checks");
    else if (goes_on(r) && tests->test_count == SHADER_TESTS_MAX)
        complain(r, test.line, "a file has at most 256 tests");
    else if (goes_on(r) && !ARRAY_PUSH(tests->tests, tests->test_count, tests->test_capacity, test))
        r->failed = true;
}

/* ---- Files ---- */

/* Reports calls of check() outside of the tests that were found. */
static void look_outside(struct reading *r)
{
    const struct shader_tests *tests = r->tests;
    const struct shader_file *file = file_of(r);
    uint32_t next = 0;
    scan_begin(&r->scan, file->text, file->bytes);
    while (goes_on(r) && scan_next(&r->scan)) {
        size_t at = (size_t)(r->scan.at - file->text);
        bool directive = r->scan.in_directive;
        while (next < tests->test_count &&
               (tests->tests[next].file < r->file ||
                (tests->tests[next].file == r->file && tests->tests[next].end < at)))
            next++;
        const struct shader_test *test = next < tests->test_count ? &tests->tests[next] : NULL;
        bool inside = test && test->file == r->file && test->begin < at && !directive;
        if (!inside && scan_is(&r->scan, SCAN_WORD, "check"))
            complain(r, r->scan.token_line,
                     "check() stands in the body of a function behind `//@ test` and nowhere else");
    }
}

whit_result shader_tests_read(const whit_log *log, const struct shader_text *text,
                              struct shader_tests *tests, struct shader_errors *errors)
{
    *tests = (struct shader_tests){0};
    struct reading r = {.log = log, .text = text, .tests = tests, .errors = errors};
    for (r.file = 0; r.file < text->file_count && goes_on(&r); ++r.file) {
        struct scan marks;
        scan_begin(&marks, text->files[r.file].text, text->files[r.file].bytes);
        marks.annotations = true;
        while (goes_on(&r) && scan_next(&marks)) {
            if (is_mark(&marks))
                read_test(&r, &marks);
        }
    }
    /* A file without tests may have a function check() of its own. */
    bool own = !tests->test_count && shader_text_defines(text, "check", NULL, NULL);
    for (r.file = 0; !own && r.file < text->file_count && goes_on(&r); ++r.file)
        look_outside(&r);
    if (r.failed)
        log_error(log, "out of memory for tests");
    if (!goes_on(&r))
        shader_tests_free(tests);
    return r.failed ? WHIT_ERROR_MEMORY : r.wrong ? WHIT_ERROR_INPUT : WHIT_OK;
}

void shader_tests_free(struct shader_tests *tests)
{
    free(tests->tests);
    free(tests->checks);
    *tests = (struct shader_tests){0};
}

/* ---- Texts for kernels ---- */

enum { NUMBER_BYTES = 24 };

static void blank_tests(const struct shader_tests *tests, uint32_t index, struct shader_file *file)
{
    for (uint32_t i = 0; i < tests->test_count; ++i) {
        const struct shader_test *test = &tests->tests[i];
        for (size_t at = test->begin; test->file == index && at < test->end; ++at)
            file->text[at] = isspace((unsigned char)file->text[at]) ? file->text[at] : ' ';
    }
}

uint32_t shader_tests_words(const struct shader_tests *tests)
{
    uint32_t most = 0;
    for (uint32_t i = 0; i < tests->test_count; ++i)
        most = tests->tests[i].check_count > most ? tests->tests[i].check_count : most;
    return most > 0 ? (most + 31) / 32 : 1;
}

/* Writes the text of `source` into `file`, with the word and bit of each check. */
static void put_numbers(const struct shader_tests *tests, uint32_t index,
                        const struct shader_file *source, struct shader_file *file)
{
    size_t from = 0, to = 0;
    for (uint32_t i = 0; i < tests->check_count; ++i) {
        const struct shader_check *check = &tests->checks[i];
        if (check->file != index)
            continue;
        memcpy(file->text + to, source->text + from, check->at - from);
        to += check->at - from;
        from = check->at;
        to += (size_t)snprintf(file->text + to, NUMBER_BYTES, "%uu, %uu, ", check->number / 32,
                               1u << check->number % 32);
    }
    memcpy(file->text + to, source->text + from, source->bytes - from + 1);
    file->bytes = to + source->bytes - from;
}

bool shader_tests_text(const struct shader_tests *tests, const struct shader_text *text,
                       bool numbered, struct shader_text *out)
{
    if (!shader_text_copy(text, (size_t)tests->check_count * NUMBER_BYTES, out))
        return false;
    for (uint32_t i = 0; i < text->file_count; ++i) {
        if (numbered)
            put_numbers(tests, i, &text->files[i], &out->files[i]);
        else
            blank_tests(tests, i, &out->files[i]);
    }
    return true;
}

char *shader_tests_call(const struct shader_tests *tests)
{
    const size_t each = 2 * sizeof tests->tests->name + 64;
    char *text = calloc(tests->test_count + 2, each);
    if (!text)
        return NULL;
    char *at = text;
    for (uint32_t i = 0; i < tests->test_count; ++i)
        at += sprintf(at, "void %s(uint seed);\n", tests->tests[i].name);
    at += sprintf(at, "void run_test(uint test, uint seed)\n{\n    switch (test) {\n");
    for (uint32_t i = 0; i < tests->test_count; ++i)
        at += sprintf(at, "    case %uu: %s(seed); break;\n", i, tests->tests[i].name);
    sprintf(at, "    }\n}\n");
    return text;
}
