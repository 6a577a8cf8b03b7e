#include "app/check/suite.h"

#include <fnmatch.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "base/array.h"
#include "base/file.h"
#include "base/text.h"

enum {
    SUITE_BYTES_MAX = 1 << 20,
    EXPECTATION_BYTES_MAX = 64 << 20,
    WORDS_MAX = 256,
    SAID_BYTES = 2048,
    WHERE_BYTES = 600
};

/* The line being read. */
struct line {
    struct suite *suite;
    uint32_t number;
    char where[WHERE_BYTES];
};

/* Tells what is wrong with a line, once: the cases of its {a,b} mostly have the same fault. */
static void tell(const struct line *line, const char *text)
{
    struct suite *suite = line->suite;
    if (!line->number || suite->told != line->number)
        suite->say(suite->user, text);
    suite->told = line->number;
}

static bool refuse(const struct line *line, const char *format, ...) WHIT_PRINTF(2, 3);
static bool refuse(const struct line *line, const char *format, ...)
{
    char why[SAID_BYTES], text[SAID_BYTES + WHERE_BYTES + 8];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    snprintf(text, sizeof text, "%s: %s", line->where, why);
    tell(line, text);
    return false;
}

/* ---- Names ---- */

static const char name_letters[] =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-+:=@";

struct check_case *suite_find(const struct suite *suite, const char *name)
{
    for (uint32_t i = 0; i < suite->count; ++i) {
        if (strcmp(suite->cases[i].name, name) == 0)
            return &suite->cases[i];
    }
    return NULL;
}

void suite_errors_of(const struct suite *suite, const struct check_case *item)
{
    static char where[WHERE_BYTES + CHECK_NAME_MAX];
    snprintf(where, sizeof where, "%.500s:%u: %s", suite->path, item->line, item->name);
    cli_errors_of(where);
}

bool suite_matches(const char *pattern, const char *name)
{
    return fnmatch(pattern, name, 0) == 0;
}

static bool check_name(const struct line *line, const char *name)
{
    size_t plain = strspn(name, name_letters);
    if (name[plain])
        return refuse(line,
                      "the name `%.40s`: letters, digits and . _ - + : = @ are names, and one "
                      "{a,b} makes several",
                      name);
    if (!name[0] || strlen(name) > CHECK_NAME_MAX)
        return refuse(line, "the name `%.40s`: 1 to %d letters are needed", name, CHECK_NAME_MAX);
    if (name[0] == '-' || name[0] == '.' || strcmp(name, "all") == 0)
        return refuse(line, "the name `%s`: all, and what starts with - or ., cannot be names",
                      name);
    const struct check_case *other = suite_find(line->suite, name);
    return !other || refuse(line,
                            "the name `%s` is that of line %u; expectations of it begin with "
                            "`expect`",
                            name, other->line);
}

/* ---- Cases ---- */

static bool split(const struct line *line, char *text, char *argv[WORDS_MAX + 1], int *argc)
{
    bool whole = true;
    char *word;
    for (;;) {
        text += strspn(text, " \t");
        if (*text == '#' || (word = cli_next_word(&text, &whole)) == NULL)
            break;
        if (!whole)
            return refuse(line, "a quote has no end");
        if (*argc == WORDS_MAX)
            return refuse(line, "more than %d words", WORDS_MAX);
        argv[(*argc)++] = word;
    }
    argv[*argc] = NULL;
    return true;
}

static void case_finish(struct check_case *item)
{
    for (uint32_t i = 0; i < item->expectation_count; ++i)
        expectation_finish(&item->expectations[i]);
    free(item->expectations);
    free(item->name);
    free(item->settings);
    free(item->made_by);
    free(item->loaded);
}

/* Reads what stands behind a case's name. */
static bool read_case(const struct line *line, struct check_case *item, char *text)
{
    static char program[] = "whit";
    char *argv[WORDS_MAX + 1] = {program}, said[SAID_BYTES];
    int argc = 1;
    if (!split(line, text, argv, &argc))
        return false;
    if (case_options_read(item, line->suite, line->where, argc, argv, said, sizeof said))
        return true;
    tell(line, said);
    free(item->settings);
    item->settings = NULL;
    return false;
}

/* Adds a case even if its options are wrong, so that later lines that name it are judged for
   themselves. */
static bool add_case(const struct line *line, const char *name, char *text)
{
    struct suite *suite = line->suite;
    struct check_case item = {.line = line->number};
    if (!check_name(line, name))
        return false;
    if (suite->count == CHECK_CASES_MAX)
        return refuse(line, "more than %d cases", CHECK_CASES_MAX);
    item.name = string_copy(name);
    if (!item.name)
        return refuse(line, "out of memory");
    bool read = read_case(line, &item, text);
    if (ARRAY_PUSH(suite->cases, suite->count, suite->capacity, item))
        return read;
    case_finish(&item);
    return refuse(line, "out of memory");
}

/* ---- Expectations ---- */

static bool expect_one(const struct line *line, struct check_case *item, const char *text,
                       size_t length)
{
    char why[SETTING_WHY_BYTES];
    struct check_expectation one = {.line = line->number};
    line->suite->expectation_bytes += sizeof one + 2 * length; /* its text, and a name in it */
    if (line->suite->expectation_bytes > EXPECTATION_BYTES_MAX)
        return refuse(line, "expectations of more than %d MiB, each counted for each of its cases",
                      EXPECTATION_BYTES_MAX >> 20);
    bool read = expectation_read(&one, text, length, item->settings, why);
    if (read &&
        ARRAY_PUSH(item->expectations, item->expectation_count, item->expectation_capacity, one))
        return true;
    expectation_finish(&one);
    return refuse(line, "%s", read ? "out of memory" : why);
}

/* The length up to the next comma outside of quotes and brackets, a comment, or the end. */
static size_t find_end(const char *text)
{
    bool quoted = false;
    size_t length = 0;
    int depth = 0;
    for (; text[length]; ++length) {
        quoted ^= text[length] == '"';
        depth += quoted ? 0 : (text[length] == '(') - (text[length] == ')');
        if (!quoted && (text[length] == '#' || (text[length] == ',' && depth <= 0)))
            break;
    }
    return length;
}

static bool expect_all(const struct line *line, struct check_case *item, const char *text)
{
    for (;;) {
        text += strspn(text, " \t");
        size_t length = find_end(text), used = length;
        for (; used && strchr(" \t", text[used - 1]); --used)
            continue;
        if (!used)
            return refuse(line, "an expectation is missing: FIELD == VALUE");
        if (!expect_one(line, item, text, used))
            return false;
        if (text[length] != ',')
            return true;
        text += length + 1;
    }
}

/* Adds the expectations in `text` to each case that the name, which may be a pattern, matches. */
static bool add_expectations(const struct line *line, const char *name, const char *text)
{
    struct suite *suite = line->suite;
    bool any = false;
    for (uint32_t i = 0; i < suite->count; ++i) {
        if (!suite_matches(name, suite->cases[i].name))
            continue;
        any = true;
        if (!expect_all(line, &suite->cases[i], text))
            return false;
    }
    return any ||
           refuse(line, "there is no case `%.40s` above, of which something is expected", name);
}

/* ---- Lines ---- */

/* The text behind the word `expect`, if `text` starts with it; else NULL. */
static const char *behind_expect(const char *text)
{
    static const char word[] = "expect";
    size_t length = sizeof word - 1;
    bool is_it = strncmp(text, word, length) == 0 && (!text[length] || strchr(" \t", text[length]));
    return is_it ? text + length : NULL;
}

/* A copy of `text` with each {} replaced by `alternative`. NULL: it would be longer than a suite
   may be, or memory ran out. */
static char *fill_in(const char *text, const char *alternative, size_t length)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, "{}")) != NULL; at += 2)
        ++count;
    size_t bytes = strlen(text) + count * length + 1;
    char *out = bytes <= SUITE_BYTES_MAX ? array_alloc(bytes, 1) : NULL, *to = out;
    for (const char *at; out && (at = strstr(text, "{}")) != NULL; text = at + 2) {
        memcpy(to, text, (size_t)(at - text));
        to += at - text;
        memcpy(to, alternative, length);
        to += length;
    }
    if (out)
        strcpy(to, text);
    return out;
}

static bool read_one(const struct line *line, const char *name, char *rest)
{
    const char *expected = behind_expect(rest);
    return expected ? add_expectations(line, name, expected) : add_case(line, name, rest);
}

/* Reads a case whose name has {a,b}: the name with one alternative in its place, and the rest of
   the line. */
static bool read_alternative(const struct line *line, const char *name, const char *open,
                             const char *alternative, size_t length, const char *rest)
{
    const char *close = strchr(open, '}');
    char *whole =
        string_format("%.*s%.*s%s", (int)(open - name), name, (int)length, alternative, close + 1);
    char *filled = fill_in(rest, alternative, length);
    bool read = whole && filled ? read_one(line, whole, filled)
                                : refuse(line, "too long with {} filled in, or out of memory");
    free(whole);
    free(filled);
    return read;
}

static bool read_alternatives(const struct line *line, const char *name, const char *open,
                              const char *rest)
{
    const char *close = strchr(open, '}');
    bool good = true;
    if (!close || strchr(close, '{'))
        return refuse(line, "the name `%.40s`: one {a,b} with a } is needed", name);
    for (const char *at = open + 1;; ++at) {
        size_t length = strcspn(at, ",}");
        uint32_t count = line->suite->count;
        good &= read_alternative(line, name, open, at, length, rest);
        at += length;
        if (*at == '}' || (!good && line->suite->count == count))
            return good;
    }
}

static bool read_line(const struct line *line, char *text)
{
    text += strspn(text, " \t");
    size_t length = strcspn(text, " \t");
    if (!text[0] || text[0] == '#')
        return true;
    char *rest = text + length + strspn(text + length, " \t");
    text[length] = '\0';
    if (!rest[0] || rest[0] == '#')
        return refuse(line, "`%.40s` alone: NAME SCENE OPTIONS or NAME expect A, B is needed",
                      text);
    const char *open = strchr(text, '{');
    if (open)
        return read_alternatives(line, text, open, rest);
    if (strstr(rest, "{}"))
        return refuse(line, "{} stands for what the name has in {a,b}, and it has none");
    return read_one(line, text, rest);
}

static bool begin_roots(struct suite *suite, const char *root)
{
    char *folder = root ? string_format("%s/", root) : NULL;
    bool known =
        (folder || !root) && roots_init(&suite->roots, root ? folder : suite->path) == WHIT_OK;
    free(folder);
    return known;
}

/* Whether cases or expectations were refused because there is no room for more: more need not be
   told. */
static bool is_too_long(const struct suite *suite)
{
    return (suite->count == CHECK_CASES_MAX && suite->wrong) ||
           suite->expectation_bytes > EXPECTATION_BYTES_MAX;
}

bool suite_read(struct suite *suite, const char *path, const char *root, suite_needs *needs,
                void (*say)(void *user, const char *text), void *user)
{
    uint8_t *data = NULL;
    size_t size_bytes = 0;
    *suite = (struct suite){.path = path, .needs = needs, .say = say, .user = user};
    struct line line = {.suite = suite};
    snprintf(line.where, sizeof line.where, "%.500s", path);
    if (file_read(&cli_log, NULL, path, SUITE_BYTES_MAX, &data, &size_bytes) != WHIT_OK)
        return false;
    bool whole = begin_roots(suite, root) || refuse(&line, "out of memory");
    if (whole && strlen((const char *)data) != size_bytes)
        whole = refuse(&line, "not a suite: it has bytes that are 0");
    char *first = (char *)data + text_mark_bytes((const char *)data);
    for (char *text = first, *end; whole && text && !is_too_long(suite); text = end) {
        end = strchr(text, '\n');
        if (end)
            *end++ = '\0';
        snprintf(line.where, sizeof line.where, "%.500s:%u", path, ++line.number);
        suite->wrong += text_end_line(text)
                            ? !read_line(&line, text)
                            : !refuse(&line, "a carriage return that does not end a line");
    }
    free(data);
    if (whole && !suite->wrong && !suite->count) {
        snprintf(line.where, sizeof line.where, "%.500s", path);
        whole = refuse(&line, "there is no case in it");
    }
    return whole && !suite->wrong;
}

void suite_finish(struct suite *suite)
{
    for (uint32_t i = 0; i < suite->count; ++i)
        case_finish(&suite->cases[i]);
    free(suite->cases);
    roots_finish(&suite->roots);
    *suite = (struct suite){0};
}
