/* --accept-from: reads results of cases from JSON reports of other runs, such as those of CI, to
   accept them into the golden. */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/check/check.h"
#include "app/document.h"
#include "base/array.h"
#include "base/file.h"

enum { REPORT_BYTES_MAX = 256 << 20 };

/* A text of a report as it was before document_text; free() it. NULL: it is none, or out of
   memory. */
static char *original(const json_t *value)
{
    char *text = string_copy(json_string_value(value));
    if (text)
        document_restore(text);
    return text;
}

/* Reads the golden lines of the case `name` in a report. */
static bool read_lines(struct golden *found, const char *name, const char *where, const char *lines)
{
    char *text =
        string_format("whit check golden %d, whit %s\n\n%s", GOLDEN_FORMAT, WHIT_VERSION, lines);
    if (!text)
        return CLI_FAIL(false, "out of memory");
    document_restore(text);
    bool read = golden_read_text(found, where, text, GOLDEN_OF_DEVICE);
    free(text);
    if (!read || (found->count == 1 && strcmp(found->cases[0].name, name) == 0))
        return read;
    return CLI_FAIL(false, "%s: its lines of a golden are not those of this one case", where);
}

/* Whether two reports have the same golden lines of a case. */
static bool agrees(const struct check_result *result, const struct golden *found)
{
    char *one = golden_text(&result->found), *other = golden_text(found);
    bool same = one && other && strcmp(one, other) == 0;
    free(one);
    free(other);
    return same;
}

/* Whether the run of a report checked all that the suite expects of the case now. `texts`: what was
   expected then; NULL: nothing. */
static bool checked_all(const struct check_case *item, const json_t *texts)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < item->expectation_count; ++i) {
        bool has = false;
        for (size_t k = 0; k < json_array_size(texts) && !has; ++k) {
            char *text = original(json_array_get(texts, k));
            has = text && strcmp(text, item->expectations[i].text) == 0;
            free(text);
        }
        found += has;
    }
    return found == item->expectation_count;
}

/* NULL, or why the result in a report is not taken. */
static const char *why_not(const struct check_result *result, const struct golden *found)
{
    if (strcmp(result->item->made_by, found->cases[0].made_by) != 0)
        return "it was drawn with other options than the suite has now";
    if (result->found.count && !agrees(result, found))
        return "another report says something else of it";
    return NULL;
}

static bool take_lines(struct check *check, struct check_result *result, const char *lines,
                       const char *where)
{
    struct golden found = {.exists = false};
    bool read = read_lines(&found, result->item->name, where, lines);
    const char *why = read ? why_not(result, &found) : NULL;
    if (why)
        cli_error("%s: %s", where, why);
    if (!read || why || result->found.count) {
        golden_finish(&found);
        return read && !why;
    }
    result->found = found;
    return verdict_find(result, &check->old);
}

/* Takes a case from a report. A verdict that was refused (CHECK_UNMET and above) in one report
   stays; for a case that one run did not draw, another report may have a result. */
static bool take_case(struct check *check, const char *path, const json_t *item)
{
    const char *name = json_string_value(json_object_get(item, "name"));
    const char *verdict = json_string_value(json_object_get(item, "verdict"));
    const char *text = json_string_value(json_object_get(item, "text"));
    const char *lines = json_string_value(json_object_get(item, "golden"));
    char where[1024];
    if (!name || !verdict || !text)
        return CLI_FAIL(false, "%s: a case of it has no name, verdict or text", path);
    const struct check_case *of = suite_find(&check->suite, name);
    struct check_result *result = of ? &check->results[of - check->suite.cases] : NULL;
    snprintf(where, sizeof where, "%.800s: %.100s", path, name);
    if (!result || !check->wanted[of - check->suite.cases])
        return true;
    enum check_verdict bad = CHECK_UNMET;
    while (bad < CHECK_VERDICTS && strcmp(verdict, verdict_word(bad)) != 0)
        ++bad;
    if (bad < CHECK_UNDRAWN || (bad == CHECK_UNDRAWN && result->verdict == CHECK_NOT_RUN))
        verdict_set(result, bad, string_copy(text));
    if (bad < CHECK_VERDICTS || (result->verdict >= CHECK_UNMET && result->verdict < CHECK_UNDRAWN))
        return true;
    if (lines && checked_all(of, json_object_get(item, "expects")))
        return take_lines(check, result, lines, where);
    return CLI_FAIL(false, "%s: %s", where,
                    lines ? "the report was made before the suite expected of it what it does now"
                          : "the report has no lines of a golden");
}

/* ---- Files ---- */

/* Whether the report's pictures were drawn by the same kind (device or reference). A report without
   "on" is of a device. */
static bool is_of_kind(const struct check *check, const char *path, const json_t *root)
{
    const char *on = json_string_value(json_object_get(root, "on"));
    const char *wanted = golden_kind_word(check->golden.kind);
    on = on ? on : golden_kind_word(GOLDEN_OF_DEVICE);
    if (strcmp(on, wanted) == 0)
        return true;
    return CLI_FAIL(false, "%s: its pictures are by the %s, not by the %s", path, cli_shown(on),
                    wanted);
}

/* Whether a path tells nothing of the folders it leads through: an absolute one, which may be that
   of another machine, and one with a part `.` or `..`. */
static bool is_from_elsewhere(const char *path)
{
    return path[0] == '/' || strncmp(path, "./", 2) == 0 || strncmp(path, "../", 3) == 0 ||
           strstr(path, "/./") || strstr(path, "/../");
}

/* Whether two paths may be of the same suite. They may be named from different folders, so that one
   is the end of the other. */
static bool may_be_same(const char *a, const char *b)
{
    const char *a_at = a + strlen(a), *b_at = b + strlen(b);
    if (is_from_elsewhere(a) || is_from_elsewhere(b))
        return strcmp(path_name(a), path_name(b)) == 0;
    while (a_at > a && b_at > b && a_at[-1] == b_at[-1]) {
        --a_at;
        --b_at;
    }
    return (a_at == a && (b_at == b || b_at[-1] == '/')) || (b_at == b && a_at[-1] == '/');
}

static bool is_of_suite(const struct check *check, const char *path, const json_t *root)
{
    char *suite = original(json_object_get(root, "suite"));
    bool same = !suite || may_be_same(suite, check->suite.path);
    if (!same)
        cli_error("%s: a report of the suite %s, not of %s", path, suite, check->suite.path);
    free(suite);
    return same;
}

static bool read_report(struct check *check, const char *path)
{
    uint8_t *data = NULL;
    size_t size_bytes = 0, index;
    json_error_t error;
    json_t *item;
    if (file_read(&cli_log, NULL, path, REPORT_BYTES_MAX, &data, &size_bytes) != WHIT_OK)
        return false;
    json_t *root = json_loadb((const char *)data, size_bytes, 0, &error);
    const json_t *cases = json_object_get(root, "cases");
    bool read = json_is_array(cases);
    free(data);
    if (!root)
        cli_error("%s:%d: %s", path, error.line, error.text);
    else if (!read)
        cli_error("%s: no report of `whit check --json`", path);
    read = read && is_of_kind(check, path, root) && is_of_suite(check, path, root);
    json_array_foreach(cases, index, item)
    {
        if (!read)
            break;
        read = take_case(check, path, item);
    }
    json_decref(root);
    return read;
}

static int is_report(const struct dirent *entry)
{
    return entry->d_name[0] != '.' && path_is(entry->d_name, "json");
}

/* Reads all .json files in a folder, in the order of their names. */
static bool read_folder(struct check *check, const char *folder)
{
    struct dirent **entries = NULL;
    int count = scandir(folder, &entries, is_report, alphasort);
    bool read = count > 0;
    if (!read)
        cli_error("%s: there is no .json in it", folder);
    for (int i = 0; i < count; ++i) {
        char *path = read ? string_format("%s/%s", folder, entries[i]->d_name) : NULL;
        read = path && read_report(check, path);
        free(path);
        free(entries[i]);
    }
    free(entries);
    return read;
}

/* Checks that the reports have a case for each name of --accept. */
static bool have_names(const struct check *check)
{
    for (uint32_t p = 0; p < check->accept.count; ++p) {
        const char *pattern = check->accept.patterns[p];
        const struct check_names one = {{pattern}, 1};
        uint32_t wanted = 0, found = 0;
        for (uint32_t i = 0; i < check->suite.count; ++i) {
            bool is_one = check->wanted[i] && check_names_match(&one, check->suite.cases[i].name);
            wanted += is_one;
            found += is_one && check->results[i].verdict != CHECK_NOT_RUN;
        }
        if (!wanted || found)
            continue;
        return CLI_FAIL(false, "%s: it has no result of `%s` of %s", check->accept_from, pattern,
                        check->suite.path);
    }
    return true;
}

bool check_read_reports(struct check *check)
{
    struct stat info;
    bool folder = stat(check->accept_from, &info) == 0 && S_ISDIR(info.st_mode);
    bool read =
        folder ? read_folder(check, check->accept_from) : read_report(check, check->accept_from);
    return read && have_names(check);
}
