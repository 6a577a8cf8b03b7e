#include "app/check/golden.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "app/cli.h"
#include "app/document.h"
#include "base/array.h"
#include "base/file.h"
#include "base/hash.h"

enum { GOLDEN_BYTES_MAX = 64 << 20, FORMAT = 1 };

/* What the first line begins with. */
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

bool golden_case_add_part(struct golden_case *item, uint32_t hash)
{
    uint32_t at = 0;
    while (at < item->part_count && item->parts[at] < hash)
        ++at;
    if (at < item->part_count && item->parts[at] == hash)
        return true;
    if (!ARRAY_PUSH(item->parts, item->part_count, item->capacity, hash))
        return false;
    memmove(item->parts + at + 1, item->parts + at,
            (item->part_count - 1 - at) * sizeof *item->parts);
    item->parts[at] = hash;
    return true;
}

/* Where the name stands, or would. */
static uint32_t place_of(const struct golden *golden, const char *name)
{
    uint32_t at = 0;
    while (at < golden->count && strcmp(golden->cases[at].name, name) < 0)
        ++at;
    return at;
}

struct golden_case *golden_find(const struct golden *golden, const char *name)
{
    uint32_t at = place_of(golden, name);
    bool there = at < golden->count && strcmp(golden->cases[at].name, name) == 0;
    return there ? &golden->cases[at] : NULL;
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

/* Takes over what is in `item`. */
static bool insert(struct golden *golden, struct golden_case *item)
{
    uint32_t at = place_of(golden, item->name);
    if (!ARRAY_PUSH(golden->cases, golden->count, golden->capacity, *item))
        return false;
    struct golden_case *place = golden->cases + at;
    memmove(place + 1, place, (golden->count - 1 - at) * sizeof *place);
    *place = *item;
    return true;
}

bool golden_put(struct golden *golden, const struct golden_case *item)
{
    struct golden_case copy, *old = golden_find(golden, item->name);
    if (!copy_case(item, &copy))
        return false;
    if (old) {
        golden_case_finish(old);
        *old = copy;
        return true;
    }
    if (insert(golden, &copy))
        return true;
    golden_case_finish(&copy);
    return false;
}

bool golden_put_part(struct golden *golden, const char *key, uint32_t hash)
{
    uint32_t at = 0;
    for (; at < golden->part_count; ++at) {
        int order = strcmp(golden->parts[at].key, key);
        if (order == 0 && golden->parts[at].hash == hash)
            return true;
        if (order > 0 || (order == 0 && golden->parts[at].hash > hash))
            break;
    }
    struct golden_part part = {string_copy(key), hash};
    if (!part.key || !ARRAY_PUSH(golden->parts, golden->part_count, golden->part_capacity, part)) {
        free(part.key);
        return false;
    }
    struct golden_part *place = golden->parts + at;
    memmove(place + 1, place, (golden->part_count - 1 - at) * sizeof *place);
    *place = part;
    return true;
}

/* ---- Reading ---- */

struct reading {
    struct golden *golden;
    const char *where;
    uint32_t line;
    struct golden_case item; /* at hand; without a name there is none */
    bool has_picture;
    char *key; /* of the part at hand; NULL: there is none */
};

static bool refuse(const struct reading *reading, const char *format, ...) WHIT_PRINTF(2, 3);
static bool refuse(const struct reading *reading, const char *format, ...)
{
    char why[512];
    va_list args;
    va_start(args, format);
    vsnprintf(why, sizeof why, format, args);
    va_end(args);
    cli_error("%s:%u: %s", reading->where, reading->line, why);
    return false;
}

/* What stands behind the word at the start of a line; NULL: another word does. */
static char *behind(char *line, const char *word)
{
    size_t length = strlen(word);
    return strncmp(line, word, length) == 0 && line[length] == ' ' ? line + length + 1 : NULL;
}

static bool read_picture(struct reading *reading, const char *text)
{
    struct golden_case *item = &reading->item;
    int length = -1;
    (void)sscanf(text,
                 "%16" SCNx64 " colors %16" SCNx64 " size %9ux%9u rays %19" SCNu64 " %19" SCNu64
                 " %19" SCNu64 " %19" SCNu64 " mean %lf %lf %lf%n",
                 &item->ids, &item->colors, &item->width, &item->height, &item->rays[0],
                 &item->rays[1], &item->rays[2], &item->rays[3], &item->mean[0], &item->mean[1],
                 &item->mean[2], &length);
    if (length < 0 || text[length] || reading->has_picture)
        return refuse(reading, "`ids HASH colors HASH size WxH rays A B C D mean R G B` is needed");
    reading->has_picture = true;
    return true;
}

static bool read_parts(struct reading *reading, const char *text)
{
    uint32_t hash;
    int length;
    for (; sscanf(text, "%8" SCNx32 "%n", &hash, &length) == 1; text += length) {
        if (!golden_case_add_part(&reading->item, hash))
            return refuse(reading, "out of memory");
    }
    return !text[strspn(text, " ")] || refuse(reading, "`%.40s` is no hash of a part", text);
}

static bool keep_text(struct reading *reading, char **place, const char *text)
{
    if (*place)
        return refuse(reading, "this stands there twice");
    *place = string_copy(text);
    return *place || refuse(reading, "out of memory");
}

static bool read_inner(struct reading *reading, char *line)
{
    char *text;
    uint32_t hash;
    int length = -1;
    if (reading->key) {
        bool read = sscanf(line, "%8" SCNx32 "%n", &hash, &length) == 1 && !line[length];
        if (!read)
            return refuse(reading, "the hash of a part is needed");
        return golden_put_part(reading->golden, reading->key, hash) ||
               refuse(reading, "out of memory");
    }
    if (reading->item.name && (text = behind(line, "ids")))
        return read_picture(reading, text);
    if (reading->item.name && (text = behind(line, "of")))
        return keep_text(reading, &reading->item.made_by, text);
    if (reading->item.name && (text = behind(line, "parts")))
        return read_parts(reading, text);
    if (reading->item.name && (text = behind(line, "why")))
        return keep_text(reading, &reading->item.reason, text);
    return refuse(reading, "`%.40s` belongs to no case and no part", line);
}

/* The case or part above is done. */
static bool end_block(struct reading *reading)
{
    struct golden_case *item = &reading->item;
    free(reading->key);
    reading->key = NULL;
    if (!item->name)
        return true;
    if (!reading->has_picture || !item->made_by)
        return refuse(reading, "the case `%.64s` above lacks a line", item->name);
    if (golden_find(reading->golden, item->name))
        return refuse(reading, "the case `%.64s` above is there twice", item->name);
    if (!insert(reading->golden, item))
        return refuse(reading, "out of memory");
    *item = (struct golden_case){0};
    reading->has_picture = false;
    return true;
}

static bool read_line(struct reading *reading, char *line)
{
    char *text;
    if (!line[0])
        return true;
    if (line[0] == ' ')
        return read_inner(reading, line + 1);
    if (!end_block(reading))
        return false;
    if ((text = behind(line, "case")))
        return keep_text(reading, &reading->item.name, text);
    if ((text = behind(line, "part")))
        return keep_text(reading, &reading->key, text);
    if (strncmp(line, "<<<<<<<", 7) == 0 || strncmp(line, "=======", 7) == 0)
        return refuse(reading, "a conflict of a merge is left in it");
    return refuse(reading, "`%.40s`: `case NAME` or `part NAME` is needed", line);
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
        return refuse(reading, "`%s %d, whit VERSION` is needed", head, FORMAT);
    return format == FORMAT ||
           refuse(reading, "a golden of format %u: this whit reads %d", format, FORMAT);
}

bool golden_read_text(struct golden *golden, const char *where, char *text, enum golden_kind kind)
{
    struct reading reading = {.golden = golden, .where = where};
    bool whole = true;
    *golden = (struct golden){.exists = true, .kind = kind};
    for (char *line = text, *end; whole && line; line = end) {
        end = strchr(line, '\n');
        if (end)
            *end++ = '\0';
        line[strcspn(line, "\r")] = '\0';
        whole = ++reading.line == 1 ? read_head(&reading, line) : read_line(&reading, line);
    }
    whole = whole && end_block(&reading);
    golden_case_finish(&reading.item);
    free(reading.key);
    return whole;
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

char *golden_path(const char *suite, enum golden_kind kind)
{
    static const char *const endings[] = {".whit", ".suite"};
    size_t length = strlen(suite), name = strlen(path_name(suite));
    for (size_t i = 0; i < sizeof endings / sizeof *endings; ++i) {
        size_t bytes = strlen(endings[i]);
        if (name > bytes && strcmp(suite + strlen(suite) - bytes, endings[i]) == 0)
            length -= bytes;
    }
    return string_format("%.*s%s.golden", (int)length, suite,
                         kind == GOLDEN_OF_REFERENCE ? ".reference" : "");
}

static void put_case(FILE *to, const struct golden_case *item)
{
    fprintf(to, "case %s\n ids %016" PRIx64 " colors %016" PRIx64 " size %ux%u rays", item->name,
            item->ids, item->colors, item->width, item->height);
    for (int kind = 0; kind < WHIT_RAY_KINDS; ++kind)
        fprintf(to, " %" PRIu64, item->rays[kind]);
    fprintf(to, " mean %.6g %.6g %.6g\n of %s\n", item->mean[0], item->mean[1], item->mean[2],
            item->made_by);
    if (item->part_count)
        fputs(" parts", to);
    for (uint32_t i = 0; i < item->part_count; ++i)
        fprintf(to, " %08" PRIx32, item->parts[i]);
    if (item->part_count)
        fputc('\n', to);
    if (item->reason)
        fprintf(to, " why %s\n", item->reason);
    fputc('\n', to);
}

static bool names_part(const struct golden_case *item, uint32_t hash)
{
    uint32_t i = 0;
    while (i < item->part_count && item->parts[i] != hash)
        ++i;
    return i < item->part_count;
}

/* Those that one of the `count` cases names. Behind each stands a line that never changes, behind
   the last one too: git merges changes that have such a line between them. */
static void put_parts(FILE *to, const struct golden *golden, const struct golden_case *cases,
                      uint32_t count)
{
    const char *before = NULL;
    for (uint32_t i = 0; i < golden->part_count; ++i) {
        const struct golden_part *part = &golden->parts[i];
        uint32_t c = 0;
        while (c < count && !names_part(&cases[c], part->hash))
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
        fprintf(to, "%s %d, whit %s\n\n", heads[golden->kind], FORMAT, WHIT_VERSION);
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

whit_result golden_save(const struct golden *golden, const char *path)
{
    return document_save_text(golden_text(golden), path);
}
