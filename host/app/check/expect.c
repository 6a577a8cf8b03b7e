/* Reading of expectations. */
#include "app/check/expect.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"

enum { FIELDS_MAX = 64 };

void expectation_finish(struct check_expectation *one)
{
    free(one->text);
    free(one->word);
}

bool expectation_counts(const struct check_expectation *one)
{
    return expect_fields[one->field].counts;
}

static const char *skip(const char *at)
{
    return at + strspn(at, " \t");
}

/* ---- The field ---- */

/* Reads the (X,Y) of pixel(X,Y) and advances `at`. */
static bool read_place(const char **at, struct check_expectation *one, char *why)
{
    char x[10], y[10];
    int length = -1;
    (void)sscanf(*at, "( %9[0-9] , %9[0-9] )%n", x, y, &length);
    if (length < 0)
        return setting_refuse(why, "pixel(X,Y) with two whole numbers from 0 on is needed");
    one->x = (uint32_t)strtoul(x, NULL, 10);
    one->y = (uint32_t)strtoul(y, NULL, 10);
    *at += length;
    return true;
}

static bool find_field(const char *name, bool of_pixel, uint32_t *out, char *why)
{
    const char *names[FIELDS_MAX];
    uint32_t count = 0;
    for (; expect_fields[count].name && count < FIELDS_MAX; ++count) {
        names[count] = expect_fields[count].name;
        if (strcmp(names[count], name) == 0 && expect_fields[count].of_pixel == of_pixel) {
            *out = count;
            return true;
        }
    }
    const char *nearest = text_nearest(name, names, count);
    return setting_refuse(why, "`%.40s`: there is no such field%s%s%s; docs/check.md lists them",
                          name, nearest ? "; did you mean `" : "", nearest ? nearest : "",
                          nearest ? "`" : "");
}

/* Reads the name of a field, of letters, digits, _ and ., and for `pixel` its (X,Y). */
static bool read_field(const char **at, struct check_expectation *one, char *why)
{
    char name[64] = "";
    size_t used = 0;
    bool of_pixel = false;
    for (; (isalnum((unsigned char)**at) || **at == '_' || **at == '.') && used + 1 < sizeof name;
         ++*at)
        name[used++] = **at;
    name[used] = '\0';
    if (strcmp(name, "pixel") == 0) {
        of_pixel = true;
        if (!read_place(at, one, why))
            return false;
        for (; (isalpha((unsigned char)**at) || **at == '.') && used + 1 < sizeof name; ++*at)
            name[used++] = **at;
        name[used] = '\0';
    }
    return find_field(name, of_pixel, &one->field, why);
}

/* ---- The comparison ---- */

static bool read_op(const char **at, struct check_expectation *one, char *why)
{
    static const struct {
        const char *text;
        enum expect_op op;
    } ops[] = {{"==", EXPECT_EQUAL},    {"!=", EXPECT_OTHER}, {"<=", EXPECT_AT_MOST},
               {">=", EXPECT_AT_LEAST}, {"<", EXPECT_BELOW},  {">", EXPECT_ABOVE}};
    int length = -1;
    *at = skip(*at);
    for (size_t i = 0; i < sizeof ops / sizeof *ops; ++i) {
        size_t bytes = strlen(ops[i].text);
        if (strncmp(*at, ops[i].text, bytes) != 0)
            continue;
        one->op = ops[i].op;
        *at += bytes;
        return true;
    }
    one->op = EXPECT_WITHIN;
    (void)sscanf(*at, "within %lf of%n", &one->tolerance, &length);
    if (length < 0 || !(one->tolerance >= 0.0) || !isfinite(one->tolerance))
        return setting_refuse(why, "`%.40s`: == != <= >= < > or `within X of` is needed", *at);
    *at += length;
    return true;
}

static bool read_numbers(const char *at, struct check_expectation *one, bool color, char *why)
{
    for (at = skip(at); *at && one->count < 3; at = skip(at)) {
        char *end;
        double number = strtod(at, &end);
        if (end == at || (*end && !isspace((unsigned char)*end)) || !isfinite(number))
            return setting_refuse(why, "`%.40s`: a number is needed", at);
        one->numbers[one->count++] = number;
        at = end;
    }
    if (*at)
        return setting_refuse(why, "`%.40s` is too much", at);
    if (one->count == 1 || (color && one->count == 3))
        return true;
    return setting_refuse(why, color ? "one number, or three of red, green and blue, is needed"
                                     : "one number is needed");
}

/* Reads a name in double quotes, or the word none. */
static bool read_word(const char *at, struct check_expectation *one, char *why)
{
    at = skip(at);
    size_t length = strlen(at);
    if (one->op != EXPECT_EQUAL && one->op != EXPECT_OTHER)
        return setting_refuse(why, "names are compared by == and !=");
    if (strcmp(at, "none") == 0)
        return true;
    if (length < 2 || at[0] != '"' || strchr(at + 1, '"') != at + length - 1)
        return setting_refuse(why, "`%.40s`: a name in \"quotes\" or none is needed", at);
    one->word = string_format("%.*s", (int)(length - 2), at + 1);
    return one->word || setting_refuse(why, "out of memory");
}

bool expectation_read(struct check_expectation *one, const char *text, size_t length,
                      const struct settings *settings, char why[SETTING_WHY_BYTES])
{
    one->text = string_format("%.*s", (int)length, text);
    if (!one->text)
        return setting_refuse(why, "out of memory");
    const char *at = one->text;
    if (!read_field(&at, one, why) || !read_op(&at, one, why))
        return false;
    const struct expect_field *field = &expect_fields[one->field];
    const whit_renderer_params *picture = settings ? &settings->picture : NULL;
    if (picture && field->of_pixel && (one->x >= picture->width || one->y >= picture->height))
        return setting_refuse(why, "pixel(%u,%u) lies outside of %u x %u pixels", one->x, one->y,
                              picture->width, picture->height);
    return field->kind == EXPECT_NAME ? read_word(at, one, why)
                                      : read_numbers(at, one, field->kind == EXPECT_COLOR, why);
}
