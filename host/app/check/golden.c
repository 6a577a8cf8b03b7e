#include "app/check/golden.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/cli.h"
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/key_table.h"
#include "base/text.h"

enum { GOLDEN_BYTES_MAX = 64 << 20 };

/* The first line of a golden begins with these words. */
static const char *const heads[] = {[GOLDEN_OF_DEVICE] = "whit check golden",
                                    [GOLDEN_OF_REFERENCE] = "whit check reference golden"};

const char *golden_kind_word(enum golden_kind kind)
{
    return kind == GOLDEN_OF_REFERENCE ? "reference" : "device";
}

/* ---- Cases and parts ---- */

void golden_case_finish(struct golden_case *item)
{
    free(item->name);
    free(item->made_by);
    free(item->parts);
    free(item->reason);
    *item = (struct golden_case){0};
}

void golden_finish(struct golden *golden)
{
    for (uint32_t i = 0; i < golden->count; ++i)
        golden_case_finish(&golden->cases[i]);
    for (uint32_t i = 0; i < golden->part_count; ++i)
        free(golden->parts[i].key);
    free(golden->cases);
    free(golden->parts);
    *golden = (struct golden){0};
}

uint32_t golden_part_hash(const char *key, uint64_t content)
{
    uint64_t hash = hash_bytes(hash_bytes(HASH_START, key, strlen(key)), &content, sizeof content);
    return (uint32_t)(hash ^ hash >> 32);
}

static int compare_hashes(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static int compare_cases(const void *a, const void *b)
{
    return strcmp(((const struct golden_case *)a)->name, ((const struct golden_case *)b)->name);
}

static int compare_golden_parts(const void *a, const void *b)
{
    const struct golden_part *x = a, *y = b;
    int order = strcmp(x->key, y->key);
    return order ? order : compare_hashes(&x->hash, &y->hash);
}

static void sort_hashes(struct golden_case *item)
{
    uint32_t kept = 0;
    if (item->part_count)
        qsort(item->parts, item->part_count, sizeof *item->parts, compare_hashes);
    for (uint32_t i = 0; i < item->part_count; ++i) {
        if (!kept || item->parts[kept - 1] != item->parts[i])
            item->parts[kept++] = item->parts[i];
    }
    item->part_count = kept;
}

void golden_sort(struct golden *golden)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < golden->count; ++i)
        sort_hashes(&golden->cases[i]);
    if (golden->count)
        qsort(golden->cases, golden->count, sizeof *golden->cases, compare_cases);
    if (golden->part_count)
        qsort(golden->parts, golden->part_count, sizeof *golden->parts, compare_golden_parts);
    for (uint32_t i = 0; i < golden->part_count; ++i) {
        if (kept && compare_golden_parts(&golden->parts[kept - 1], &golden->parts[i]) == 0)
            free(golden->parts[i].key);
        else
            golden->parts[kept++] = golden->parts[i];
    }
    golden->part_count = kept;
}

bool golden_case_has_part(const struct golden_case *item, uint32_t hash)
{
    return item->part_count &&
           bsearch(&hash, item->parts, item->part_count, sizeof hash, compare_hashes);
}

bool golden_case_add_part(struct golden_case *item, uint32_t hash)
{
    return ARRAY_PUSH(item->parts, item->part_count, item->capacity, hash);
}

struct golden_case *golden_find(const struct golden *golden, const char *name)
{
    const struct golden_case key = {.name = (char *)name};
    return golden->count ? bsearch(&key, golden->cases, golden->count, sizeof key, compare_cases)
                         : NULL;
}

const char *golden_part_key(const struct golden *golden, uint32_t hash)
{
    for (uint32_t i = 0; i < golden->part_count; ++i) {
        if (golden->parts[i].hash == hash)
            return golden->parts[i].key;
    }
    return NULL;
}

void golden_remove(struct golden *golden, uint32_t index)
{
    golden_case_finish(&golden->cases[index]);
    memmove(golden->cases + index, golden->cases + index + 1,
            (--golden->count - index) * sizeof *golden->cases);
}

static bool copy_case(const struct golden_case *from, struct golden_case *to)
{
    *to = *from;
    to->parts = NULL;
    to->part_count = to->capacity = 0;
    to->name = string_copy(from->name);
    to->made_by = string_copy(from->made_by);
    to->reason = string_copy(from->reason);
    bool whole = to->name && to->made_by && (to->reason || !from->reason);
    for (uint32_t i = 0; whole && i < from->part_count; ++i)
        whole = golden_case_add_part(to, from->parts[i]);
    if (!whole)
        golden_case_finish(to);
    return whole;
}

bool golden_put(struct golden *golden, const struct golden_case *item)
{
    struct golden_case copy;
    uint32_t at = 0;
    while (at < golden->count && strcmp(golden->cases[at].name, item->name) != 0)
        ++at;
    if (!copy_case(item, &copy))
        return false;
    if (at < golden->count) {
        golden_case_finish(&golden->cases[at]);
        golden->cases[at] = copy;
        return true;
    }
    if (ARRAY_PUSH(golden->cases, golden->count, golden->capacity, copy))
        return true;
    golden_case_finish(&copy);
    return false;
}

bool golden_put_part(struct golden *golden, const char *key, uint32_t hash)
{
    const struct golden_part part = {string_copy(key), hash};
    if (part.key && ARRAY_PUSH(golden->parts, golden->part_count, golden->part_capacity, part))
        return true;
    free(part.key);
    return false;
}

/* ---- Reading ---- */

/* While a file is read, cases and parts are in its order, and parts may be there twice. */
struct reading {
    struct golden *golden;
    struct key_table names; /* index in golden->cases by name */
    const char *where;
    uint32_t line;
    char *key;        /* key of the part being read; NULL: none */
    size_t key_bytes; /* of the keys of all parts */
};

static bool refuse(const struct reading *reading, const char *format, ...) WHIT_PRINTF(2, 3);
static bool refuse(const struct reading *reading, const char *format, ...)
{
    char why[512];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    return CLI_FAIL(false, "%s:%u: %s", reading->where, reading->line, why);
}

/* The rest of a line that starts with `word`; NULL: it starts with something else. */
static char *behind(char *line, const char *word)
{
    size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && line[length] == ' ' ? line + length + 1 : NULL;
}

/* Refuses a second line of a case that contradicts the first: two people have accepted the case
   differently. Equal lines count as one. */
static bool refuse_other(const struct reading *reading, const struct golden_case *item)
{
    return refuse(
        reading,
        "a line above, from line %u on, says something else of the case `%.64s`, which two "
        "have accepted: one of the lines has to go",
        item->line, item->name);
}

static bool same_picture(const struct golden_case *a, const struct golden_case *b)
{
    return a->ids == b->ids && a->colors == b->colors && a->width == b->width &&
           a->height == b->height && memcmp(a->rays, b->rays, sizeof a->rays) == 0 &&
           memcmp(a->mean, b->mean, sizeof a->mean) == 0;
}

static bool read_picture(struct reading *reading, struct golden_case *item, const char *text)
{
    struct golden_case is = *item;
    int length = -1;
    (void)sscanf(text,
                 "%16" SCNx64 " colors %16" SCNx64 " %9ux%9u rays %19" SCNu64 " %19" SCNu64
                 " %19" SCNu64 " %19" SCNu64 " mean %lf %lf %lf%n",
                 &is.ids, &is.colors, &is.width, &is.height, &is.rays[0], &is.rays[1], &is.rays[2],
                 &is.rays[3], &is.mean[0], &is.mean[1], &is.mean[2], &length);
    if (length < 0 || text[length] || !is.width)
        return refuse(reading, "`ids HASH colors HASH WxH rays A B C D mean R G B` is needed");
    if (item->width && !same_picture(&is, item))
        return refuse_other(reading, item);
    *item = is;
    return true;
}

static bool same_parts(const struct golden_case *a, const struct golden_case *b)
{
    return a->part_count == b->part_count &&
           memcmp(a->parts, b->parts, a->part_count * sizeof *a->parts) == 0;
}

/* Reads a hash of up to eight digits, and moves *text behind it. */
static bool read_hash(const char **text, uint32_t *hash)
{
    const char *digits = *text + strspn(*text, " ");
    size_t length = strspn(digits, "0123456789abcdefABCDEF");
    if (length == 0 || length > 8)
        return false;
    *hash = (uint32_t)strtoul(digits, NULL, 16);
    *text = digits + length;
    return true;
}

static bool read_parts(struct reading *reading, struct golden_case *item, const char *text)
{
    struct golden_case is = {.name = NULL};
    uint32_t hash;
    bool whole = true;
    while (whole && read_hash(&text, &hash))
        whole = ARRAY_PUSH(is.parts, is.part_count, is.capacity, hash) ||
                refuse(reading, "out of memory");
    sort_hashes(&is);
    if (whole && text[strspn(text, " ")])
        whole = refuse(reading, "`%.40s` is no hash of a part", text);
    if (whole && item->part_count)
        whole = same_parts(item, &is) || refuse_other(reading, item);
    if (!whole || item->part_count) {
        golden_case_finish(&is);
        return whole;
    }
    item->parts = is.parts;
    item->part_count = is.part_count;
    item->capacity = is.capacity;
    return true;
}

/* Keeps a text of a case; a second one must be equal. */
static bool keep_text(struct reading *reading, struct golden_case *item, char **place,
                      const char *text)
{
    if (*place)
        return strcmp(*place, text) == 0 || refuse_other(reading, item);
    *place = string_copy(text);
    return *place || refuse(reading, "out of memory");
}

/* Reads a line of a case, from its name on. */
static bool read_case(struct reading *reading, char *name)
{
    char *rest = name + strcspn(name, " "), *text;
    if (*rest)
        *rest++ = '\0';
    struct golden *golden = reading->golden;
    uint32_t index = golden->count;
    if (!key_table_find(&reading->names, name, strlen(name), &index)) {
        struct golden_case made = {.name = string_copy(name), .line = reading->line};
        if (!made.name || !key_table_add(&reading->names, name, strlen(name), index) ||
            !ARRAY_PUSH(golden->cases, golden->count, golden->capacity, made)) {
            free(made.name);
            return refuse(reading, "out of memory");
        }
    }
    struct golden_case *item = &golden->cases[index];
    if ((text = behind(rest, "of")))
        return keep_text(reading, item, &item->made_by, text);
    if ((text = behind(rest, "ids")))
        return read_picture(reading, item, text);
    if ((text = behind(rest, "parts")))
        return read_parts(reading, item, text);
    if ((text = behind(rest, "why")))
        return keep_text(reading, item, &item->reason, text);
    return refuse(reading, "`%.40s`: of, ids, parts or why of the case `%.64s` is needed", rest,
                  name);
}

static bool add_part(struct reading *reading, uint32_t hash)
{
    reading->key_bytes += strlen(reading->key) + 1;
    if (reading->key_bytes > GOLDEN_BYTES_MAX)
        return refuse(reading, "the names of its parts are too long");
    return golden_put_part(reading->golden, reading->key, hash) || refuse(reading, "out of memory");
}

/* Reads an indented line: a hash of the part being read, or a line that names its case. */
static bool read_inner(struct reading *reading, char *line)
{
    const char *end = line;
    uint32_t hash;
    if (!read_hash(&end, &hash) || *end)
        return read_case(reading, line);
    return reading->key ? add_part(reading, hash)
                        : refuse(reading, "`%s`: there is no part above, whose hash it is", line);
}

static bool begin_part(struct reading *reading, const char *key)
{
    free(reading->key);
    reading->key = string_copy(key);
    return reading->key || refuse(reading, "out of memory");
}

static bool read_line(struct reading *reading, char *line)
{
    char *text;
    if (!line[0])
        return true;
    if (line[0] == ' ')
        return read_inner(reading, line + 1);
    if ((text = behind(line, "case")))
        return read_case(reading, text);
    if ((text = behind(line, "part")))
        return begin_part(reading, text);
    if (strncmp(line, "<<<<<<<", 7) == 0 || strncmp(line, "=======", 7) == 0)
        return refuse(reading, "a conflict of a merge is left in it");
    return refuse(reading, "`%.40s`: `case NAME` or `part NAME` is needed", line);
}

static bool are_whole(struct reading *reading)
{
    for (uint32_t i = 0; i < reading->golden->count; ++i) {
        const struct golden_case *item = &reading->golden->cases[i];
        reading->line = item->line;
        if (!item->made_by || !item->width)
            return refuse(reading, "the case `%.64s` lacks a line: of, or ids", item->name);
    }
    return true;
}

static bool read_head(struct reading *reading, const char *line)
{
    unsigned format = 0;
    int length = -1;
    enum golden_kind kind = reading->golden->kind;
    const char *head = heads[kind], *other = heads[!kind];
    size_t prefix = strlen(head);
    if (strncmp(line, head, prefix) == 0)
        (void)sscanf(line + prefix, " %9u, whit %31s%n", &format, reading->golden->by, &length);
    if (length < 0 && strncmp(line, other, strlen(other)) == 0)
        return refuse(reading,
                      "a golden of pictures by the %s: those by the %s have one of their own",
                      golden_kind_word(!kind), golden_kind_word(kind));
    if (length < 0)
        return refuse(reading, "`%s %d, whit VERSION` is needed", head, GOLDEN_FORMAT);
    return format == GOLDEN_FORMAT ||
           refuse(reading, "a golden of format %u: this whit reads %d", format, GOLDEN_FORMAT);
}

bool golden_read_text(struct golden *golden, const char *where, char *text, enum golden_kind kind)
{
    struct reading reading = {.golden = golden, .where = where};
    bool whole = true;
    *golden = (struct golden){.exists = true, .kind = kind};
    for (char *line = text + text_mark_bytes(text), *end; whole && line; line = end) {
        end = strchr(line, '\n');
        if (end)
            *end++ = '\0';
        ++reading.line;
        if (!text_end_line(line))
            whole = refuse(&reading, "a carriage return that does not end a line");
        else
            whole = reading.line == 1 ? read_head(&reading, line) : read_line(&reading, line);
    }
    free(reading.key);
    key_table_finish(&reading.names);
    golden_sort(golden);
    return whole && are_whole(&reading);
}

bool golden_read(struct golden *golden, const char *path, enum golden_kind kind)
{
    uint8_t *data = NULL;
    size_t size_bytes = 0;
    *golden = (struct golden){.kind = kind};
    if (!file_exists(path))
        return true;
    if (file_read(&cli_log, NULL, path, GOLDEN_BYTES_MAX, &data, &size_bytes) != WHIT_OK)
        return false;
    bool whole = strlen((const char *)data) == size_bytes;
    if (!whole)
        cli_error("%s: not a golden: it has bytes that are 0", path);
    whole = whole && golden_read_text(golden, path, (char *)data, kind);
    free(data);
    return whole;
}

/* ---- Writing ---- */

static const char *const endings[] = {".whit", ".suite"};
enum { ENDINGS = sizeof endings / sizeof *endings };

/* The index of the suite's ending; ENDINGS: it has none of them. */
static uint32_t find_ending(const char *suite)
{
    size_t name = strlen(path_name(suite));
    for (uint32_t i = 0; i < ENDINGS; ++i) {
        size_t bytes = strlen(endings[i]);
        if (name > bytes && strcmp(suite + strlen(suite) - bytes, endings[i]) == 0)
            return i;
    }
    return ENDINGS;
}

char *golden_path(const char *suite, enum golden_kind kind)
{
    uint32_t ending = find_ending(suite);
    size_t length = strlen(suite) - (ending < ENDINGS ? strlen(endings[ending]) : 0);
    return string_format("%.*s%s.golden", (int)length, suite,
                         kind == GOLDEN_OF_REFERENCE ? ".reference" : "");
}

char *golden_other_suite(const char *suite)
{
    uint32_t ending = find_ending(suite);
    return ending == ENDINGS
               ? NULL
               : string_format("%.*s%s", (int)(strlen(suite) - strlen(endings[ending])), suite,
                               endings[!ending]);
}

/* Each line names its case, so that it is understood wherever a merge puts it, and no two cases
   have equal lines. */
static void put_case(FILE *to, const struct golden_case *item)
{
    const char *name = item->name;
    fprintf(to, "case %s of %s\n %s ids %016" PRIx64 " colors %016" PRIx64 " %ux%u rays", name,
            item->made_by, name, item->ids, item->colors, item->width, item->height);
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        fprintf(to, " %" PRIu64, item->rays[kind]);
    fprintf(to, " mean %.5g %.5g %.5g\n", item->mean[0], item->mean[1], item->mean[2]);
    if (item->part_count)
        fprintf(to, " %s parts", name);
    for (uint32_t i = 0; i < item->part_count; ++i)
        fprintf(to, " %08" PRIx32, item->parts[i]);
    if (item->part_count)
        fputc('\n', to);
    if (item->reason)
        fprintf(to, " %s why %s\n", name, item->reason);
    fputc('\n', to);
}

/* Writes the parts that one of the `count` cases names. Each, also the last, is followed by an
   empty line, which never changes: git merges changes that have such a line between them. */
static void put_parts(FILE *to, const struct golden *golden, const struct golden_case *cases,
                      uint32_t count)
{
    const char *before = NULL;
    for (uint32_t i = 0; i < golden->part_count; ++i) {
        const struct golden_part *part = &golden->parts[i];
        uint32_t c = 0;
        while (c < count && !golden_case_has_part(&cases[c], part->hash))
            ++c;
        if (c == count)
            continue;
        bool same = before && strcmp(before, part->key) == 0;
        if (!same)
            fprintf(to, "%spart %s\n", before ? "\n" : "", part->key);
        fprintf(to, " %08" PRIx32 "\n", part->hash);
        before = part->key;
    }
    if (before)
        fputc('\n', to);
}

static char *text_of(const struct golden *golden, const struct golden_case *cases, uint32_t count,
                     bool whole)
{
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    if (!to)
        return NULL;
    if (whole)
        fprintf(to, "%s %d, whit %s\n\n", heads[golden->kind], GOLDEN_FORMAT, WHIT_VERSION);
    for (uint32_t i = 0; i < count; ++i)
        put_case(to, &cases[i]);
    put_parts(to, golden, cases, count);
    bool failed = ferror(to);
    if (fclose(to) == 0 && !failed)
        return text;
    free(text);
    return NULL;
}

char *golden_text(const struct golden *golden)
{
    return text_of(golden, golden->cases, golden->count, true);
}

char *golden_case_text(const struct golden *golden, const char *name)
{
    const struct golden_case *item = golden_find(golden, name);
    return text_of(golden, item, item ? 1 : 0, false);
}
