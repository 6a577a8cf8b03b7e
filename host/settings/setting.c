#include "settings/setting.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

static const uint64_t PIXELS_MAX = UINT64_C(1) << 28;

typedef char folder[SETTING_PATH_BYTES];

bool setting_refuse(char why[SETTING_WHY_BYTES], const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(why, SETTING_WHY_BYTES, format, args);
    va_end(args);
    return false;
}

bool setting_has_argument(const struct setting *setting)
{
    return setting->kind != SETTING_FLAG && setting->kind != SETTING_GONE &&
           setting->kind != SETTING_HELP;
}

static uint64_t size_of(enum setting_kind kind)
{
    switch (kind) {
    case SETTING_FLAG:
    case SETTING_EITHER:
        return sizeof(bool);
    case SETTING_CHOICE:
    case SETTING_COUNT:
        return sizeof(uint32_t);
    case SETTING_SIZE:
        return 2 * sizeof(uint32_t);
    case SETTING_BYTES:
        return sizeof(uint64_t);
    case SETTING_NUMBER:
        return sizeof(double);
    case SETTING_NAME:
        return sizeof(const char *);
    case SETTING_TEXT:
    case SETTING_PAIRS:
        return SETTING_TEXT_BYTES;
    case SETTING_FOLDERS:
        return SETTING_FOLDERS_MAX * sizeof(folder);
    default:
        return 0;
    }
}

/* ---- Reading ---- */

static bool read_choice(const struct setting *setting, const char *text, void *at, char *why)
{
    char list[256];
    uint32_t found = value_find(setting->values, text);
    if (found == WHIT_NONE)
        return setting_refuse(why, " `%s`: one of %s is needed", text,
                              value_list(setting->values, ", ", list, sizeof list));
    if (setting->kind == SETTING_EITHER)
        *(bool *)at = setting->values[found].value != 0;
    else
        memcpy(at, &setting->values[found].value, sizeof(uint32_t));
    return true;
}

static bool read_count(const struct setting *setting, const char *text, uint32_t *out, char *why)
{
    uint32_t value;
    const char *rest = text_number(text, UINT32_MAX, &value);
    if (!rest || *rest || value < setting->min || value > setting->max)
        return setting_refuse(why, " `%s`: a whole number from %.0f to %.0f is needed", text,
                              setting->min, setting->max);
    *out = value;
    return true;
}

double setting_number(const char *text, char **end)
{
    double value = strtod(text, end);
    if (*end != text && **end == '/' && isdigit((unsigned char)(*end)[1]))
        value /= strtod(*end + 1, end);
    return value;
}

static bool read_number(const struct setting *setting, const char *text, double *out, char *why)
{
    char *end;
    double value = setting_number(text, &end);
    if (end == text || *end || !(value >= setting->min && value <= setting->max))
        return setting_refuse(why, " `%s`: a number from %g to %g is needed", text, setting->min,
                              setting->max);
    *out = value;
    return true;
}

static bool read_bytes(const char *text, uint64_t *out, char *why)
{
    static const char units[] = "KMG";
    char *end;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    const char *unit = *end ? strchr(units, *end) : NULL;
    int shift = unit ? 10 * (int)(unit - units + 1) : 0;
    if (!isdigit((unsigned char)text[0]) || end[unit != NULL] || errno || value == 0 ||
        value > UINT64_MAX >> shift)
        return setting_refuse(why, " `%s`: a number of bytes is needed, or one with K, M or G",
                              text);
    *out = (uint64_t)value << shift;
    return true;
}

static bool read_size(const char *text, uint32_t out[2], char *why)
{
    uint32_t width, height = 0;
    const char *rest = text_number(text, SETTING_SIDE_MAX, &width);
    rest = rest && (*rest == 'x' || *rest == 'X') ? text_number(rest + 1, SETTING_SIDE_MAX, &height)
                                                  : NULL;
    if (!rest || *rest || !width || !height)
        return setting_refuse(why, " `%s`: WxH is needed, each from 1 to %d, such as 1280x720",
                              text, SETTING_SIDE_MAX);
    uint64_t pixels = (uint64_t)width * height;
    if (pixels > PIXELS_MAX)
        return setting_refuse(why, " `%s`: %llu pixels are more than %llu, the most of a picture",
                              text, (unsigned long long)pixels, (unsigned long long)PIXELS_MAX);
    out[0] = width;
    out[1] = height;
    return true;
}

static bool read_text(const char *text, char *out, char *why)
{
    size_t length = strlen(text);
    if (length == 0)
        return setting_refuse(why, ": the text is empty");
    if (length >= SETTING_TEXT_BYTES)
        return setting_refuse(why, ": %zu bytes are too long, %d are the most", length,
                              SETTING_TEXT_BYTES - 1);
    memcpy(out, text, length + 1);
    return true;
}

static bool read_folder(const char *text, folder *out, char *why)
{
    size_t length = strlen(text);
    uint32_t count = 0;
    while (count < SETTING_FOLDERS_MAX && out[count][0])
        ++count;
    if (!length || length >= sizeof(folder) || count == SETTING_FOLDERS_MAX)
        return setting_refuse(why, " takes a folder, %d times at most", SETTING_FOLDERS_MAX);
    memcpy(out[count], text, length + 1);
    return true;
}

/* The offset of the pair with the same name in `list`, and its length; the end of `list` where
   there is none. */
static size_t find_pair(const char *list, const char *pair, size_t *length)
{
    size_t name = strcspn(pair, "=") + 1, at = 0;
    while (list[at]) {
        *length = strcspn(list + at, ",");
        if (strncmp(list + at, pair, name) == 0)
            return at;
        at += *length + (list[at + *length] == ',');
    }
    *length = 0;
    return at;
}

/* Adds a pair to `list`, or replaces the one of the same name. False: `list` has no room for it. */
static bool put_pair(char list[SETTING_TEXT_BYTES], const char *pair)
{
    char joined[2 * SETTING_TEXT_BYTES + 2];
    size_t length, at = find_pair(list, pair, &length);
    int used = snprintf(joined, sizeof joined, "%.*s%s%s%s", (int)at, list,
                        at && !list[at] ? "," : "", pair, list + at + length);
    if (used < 0 || used >= SETTING_TEXT_BYTES)
        return false;
    strcpy(list, joined);
    return true;
}

static bool read_pairs(const char *text, char *out, char *why)
{
    char list[SETTING_TEXT_BYTES], pair[SETTING_TEXT_BYTES];
    strcpy(list, out);
    const char *at = text;
    do {
        size_t length = strcspn(at, ",");
        const char *equals = memchr(at, '=', length);
        if (!equals || equals == at || equals + 1 == at + length || length >= sizeof pair)
            return setting_refuse(why, " `%s`: NAME=VALUE is needed, several by commas", text);
        snprintf(pair, sizeof pair, "%.*s", (int)length, at);
        if (!put_pair(list, pair))
            return setting_refuse(why, " `%s`: all of them together are more than %d bytes", text,
                                  SETTING_TEXT_BYTES - 1);
        at += length;
    } while (*at++);
    strcpy(out, list);
    return true;
}

bool setting_read(const struct setting *setting, const char *text, void *record,
                  char why[SETTING_WHY_BYTES])
{
    void *at = (char *)record + setting->offset;
    switch (setting->kind) {
    case SETTING_FLAG:
        *(bool *)at = true;
        return true;
    case SETTING_CHOICE:
    case SETTING_EITHER:
        return read_choice(setting, text, at, why);
    case SETTING_COUNT:
        return read_count(setting, text, at, why);
    case SETTING_NUMBER:
        return read_number(setting, text, at, why);
    case SETTING_BYTES:
        return read_bytes(text, at, why);
    case SETTING_SIZE:
        return read_size(text, at, why);
    case SETTING_TEXT:
        return read_text(text, at, why);
    case SETTING_FOLDERS:
        return read_folder(text, at, why);
    case SETTING_PAIRS:
        return read_pairs(text, at, why);
    case SETTING_NAME:
        *(const char **)at = text;
        return true;
    case SETTING_OWN:
        return setting->read(setting, text, record, why);
    case SETTING_GONE:
        return setting_refuse(why, " %s", setting->help);
    case SETTING_HELP:
        break;
    }
    return false;
}

/* ---- Writing ---- */

void setting_write_number(double number, char *text, size_t text_bytes)
{
    for (int digits = 6; digits <= 17; ++digits) {
        snprintf(text, text_bytes, "%.*g", digits, number);
        if (strtod(text, NULL) == number)
            break;
    }
}

void setting_write_float(float number, char *text, size_t text_bytes)
{
    for (int digits = 6; digits <= 9; ++digits) {
        snprintf(text, text_bytes, "%.*g", digits, (double)number);
        if ((float)strtod(text, NULL) == number)
            break;
    }
}

static bool put(char text[SETTING_VALUE_BYTES], const char *value)
{
    snprintf(text, SETTING_VALUE_BYTES, "%s", value);
    return value[0] != '\0';
}

static bool write_count(uint64_t count, char text[SETTING_VALUE_BYTES])
{
    snprintf(text, SETTING_VALUE_BYTES, "%llu", (unsigned long long)count);
    return true;
}

static bool write_size(const uint32_t size[2], char text[SETTING_VALUE_BYTES])
{
    snprintf(text, SETTING_VALUE_BYTES, "%ux%u", size[0], size[1]);
    return size[0] > 0;
}

bool setting_write(const struct setting *setting, const void *record, uint32_t index,
                   char text[SETTING_VALUE_BYTES])
{
    const void *at = (const char *)record + setting->offset;
    int choice = 0;
    text[0] = '\0';
    switch (setting->kind) {
    case SETTING_FLAG:
        return *(const bool *)at;
    case SETTING_EITHER:
        return put(text, value_word(setting->values, *(const bool *)at));
    case SETTING_CHOICE:
        memcpy(&choice, at, sizeof choice);
        return put(text, value_word(setting->values, choice));
    case SETTING_COUNT:
        return write_count(*(const uint32_t *)at, text);
    case SETTING_NUMBER:
        setting_write_number(*(const double *)at, text, SETTING_VALUE_BYTES);
        return true;
    case SETTING_BYTES:
        return write_count(*(const uint64_t *)at, text);
    case SETTING_SIZE:
        return write_size(at, text);
    case SETTING_TEXT:
    case SETTING_PAIRS:
        return put(text, at);
    case SETTING_FOLDERS:
        return index < SETTING_FOLDERS_MAX && put(text, ((const folder *)at)[index]);
    case SETTING_NAME:
        return put(text, *(const char *const *)at ? *(const char *const *)at : "");
    case SETTING_OWN:
        return setting->write && setting->write(record, text);
    case SETTING_GONE:
    case SETTING_HELP:
        break;
    }
    return false;
}

bool setting_same(const struct setting *setting, const void *a, const void *b)
{
    char text_a[SETTING_VALUE_BYTES], text_b[SETTING_VALUE_BYTES];
    const char *at_a = (const char *)a + setting->offset, *at_b = (const char *)b + setting->offset;
    if (setting->kind == SETTING_OWN)
        return setting_write(setting, a, 0, text_a) == setting_write(setting, b, 0, text_b) &&
               strcmp(text_a, text_b) == 0;
    if (setting->kind == SETTING_TEXT || setting->kind == SETTING_PAIRS)
        return strcmp(at_a, at_b) == 0;
    for (uint32_t i = 0; setting->kind == SETTING_FOLDERS && i < SETTING_FOLDERS_MAX; ++i) {
        if (strcmp(((const folder *)at_a)[i], ((const folder *)at_b)[i]) != 0)
            return false;
    }
    return setting->kind == SETTING_FOLDERS || memcmp(at_a, at_b, size_of(setting->kind)) == 0;
}

void setting_copy(const struct setting *setting, const void *from, void *to)
{
    char text[SETTING_VALUE_BYTES], why[SETTING_WHY_BYTES];
    if (setting->kind != SETTING_OWN)
        memcpy((char *)to + setting->offset, (const char *)from + setting->offset,
               size_of(setting->kind));
    else if (setting_write(setting, from, 0, text))
        setting->read(setting, text, to, why);
}
