#include "app/batch/outputs.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/hash.h"
#include "base/path.h"

enum { DIGITS_MAX = 10 }; /* of a uint32_t */

/* Adds the names that are `name` with numbers of `digits` digits in place of `length` bytes. */
static bool add(struct outputs *outputs, struct output output, const char *name, const char *at,
                size_t length, size_t digits)
{
    output.key = hash_bytes(HASH_START, name, (size_t)(at - name));
    output.key = hash_bytes(output.key, &digits, sizeof digits);
    output.key = hash_bytes(output.key, at + length, strlen(at + length));
    return ARRAY_PUSH(outputs->items, outputs->count, outputs->capacity, output);
}

/* Adds a pattern. Numbers that need more digits than it has # have names as of a longer pattern. */
static bool add_frames(struct outputs *outputs, const struct output *output, const char *name,
                       const struct frames *frames)
{
    size_t length;
    const char *at = name + cli_find_marks(name, &length);
    uint64_t above = 1;
    for (size_t i = 0; i < length && i < DIGITS_MAX; ++i)
        above *= 10;
    bool added = true;
    uint64_t below = 0;
    for (size_t digits = length; added && below <= frames->last; ++digits) {
        struct output some = *output;
        some.first = frames->first > below ? frames->first : (uint32_t)below;
        some.last = frames->last < above ? frames->last : (uint32_t)(above - 1);
        added = some.first > some.last || add(outputs, some, name, at, length, digits);
        below = above;
        above *= 10;
    }
    return added;
}

/* Adds a name, also as one of the names of each pattern that it may be of. */
static bool add_name(struct outputs *outputs, const struct output *output, const char *name)
{
    bool added = add(outputs, *output, name, name + strlen(name), 0, 0);
    for (const char *at = path_name(name); added && *at;) {
        size_t length = strspn(at, "0123456789");
        uint64_t number = length ? strtoull(at, NULL, 10) : UINT64_MAX;
        struct output one = *output;
        one.first = one.last = (uint32_t)number;
        added = number > UINT32_MAX || add(outputs, one, name, at, length, length);
        at += length ? length : 1;
    }
    return added;
}

/* The name with its folder as the disk has it, so that all names of a file are the same; free() it.
   NULL: out of memory. */
static char *resolve(const char *name)
{
    char *folder = path_folder(name);
    char *real = folder ? realpath(folder[0] ? folder : ".", NULL) : NULL;
    char *whole = folder ? string_format("%s/%s", real ? real : folder, path_name(name)) : NULL;
    free(folder);
    free(real);
    return whole;
}

bool outputs_add(struct outputs *outputs, const struct render_request *request, uint32_t line)
{
    const char *const names[][2] = {{"-o", request->output},
                                    {"--ids", request->ids},
                                    {"--distances", request->cameras.distances}};
    bool added = true;
    for (size_t i = 0; added && i < sizeof names / sizeof *names; ++i) {
        const struct output output = {.line = line, .option = names[i][0]};
        char *name = names[i][1] ? resolve(names[i][1]) : NULL;
        if (!name)
            added = !names[i][1];
        else
            added = request->frames.given ? add_frames(outputs, &output, name, &request->frames)
                                          : add_name(outputs, &output, name);
        free(name);
    }
    return added;
}

static int compare(const void *a, const void *b)
{
    const struct output *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    if (x->first != y->first)
        return x->first < y->first ? -1 : 1;
    return x->line < y->line ? -1 : x->line > y->line;
}

bool outputs_check(struct outputs *outputs, const char *path)
{
    const struct output *last = NULL;
    if (outputs->count)
        qsort(outputs->items, outputs->count, sizeof *outputs->items, compare);
    for (uint32_t i = 0; i < outputs->count; ++i) {
        const struct output *one = &outputs->items[i];
        bool same_key = last && last->key == one->key;
        if (same_key && one->first <= last->last) {
            const struct output *later = last->line > one->line ? last : one;
            const struct output *earlier = later == last ? one : last;
            return CLI_FAIL(false, "%s:%u: its %s is the %s of line %u", path, later->line,
                            later->option, earlier->option, earlier->line);
        }
        last = same_key && one->last <= last->last ? last : one;
    }
    return true;
}

void outputs_finish(struct outputs *outputs)
{
    free(outputs->items);
    *outputs = (struct outputs){0};
}
