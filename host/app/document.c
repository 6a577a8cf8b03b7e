#include "app/document.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/cli.h"
#include "base/file.h"
#include "whit/whit_program.h"

static void out_of_memory(void)
{
    file_abandon_all();
    cli_error("out of memory");
    exit(EXIT_USAGE);
}

static json_t *must(json_t *value)
{
    if (!value)
        out_of_memory();
    return value;
}

json_t *document_object(void)
{
    return must(json_object());
}

json_t *document_root(void)
{
    json_t *root = document_object();
    document_text(root, "whit", WHIT_VERSION);
    document_count(root, "format", DOCUMENT_FORMAT);
    return root;
}

json_t *document_array(void)
{
    return must(json_array());
}

void document_append(json_t *array, json_t *value)
{
    if (json_array_append_new(array, must(value)) != 0)
        out_of_memory();
}

void document_put(json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, must(value)) != 0)
        out_of_memory();
}

json_t *document_child(json_t *object, const char *key)
{
    json_t *child = document_object();
    document_put(object, key, child);
    return child;
}

json_t *document_list(json_t *object, const char *key)
{
    json_t *list = document_array();
    document_put(object, key, list);
    return list;
}

json_t *document_entry(json_t *array)
{
    json_t *entry = document_object();
    document_append(array, entry);
    return entry;
}

static json_t *from_text(const char *text)
{
    if (!text)
        return json_null();
    json_t *value = strstr(text, "\\x") ? NULL : json_string(text);
    if (value)
        return value;
    char *kept = malloc(4 * strlen(text) + 1), *to = kept;
    if (!kept)
        out_of_memory();
    char shown[WHIT_SHOWN_BYTES];
    for (size_t length; (length = whit_text_next(text, shown)) != 0; text += length) {
        bool is_byte = shown[0] == '\\' && shown[1] == 'x';
        bool is_escape = text[0] == '\\' && text[1] == 'x';
        if (is_byte || is_escape)
            to += sprintf(to, "%s", is_byte ? shown : "\\x5c");
        else
            to += sprintf(to, "%.*s", (int)length, text);
    }
    value = json_stringn(kept, (size_t)(to - kept));
    free(kept);
    return value;
}

static json_t *from_number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *from_float(float value)
{
    char text[32];
    if (!isfinite(value))
        return json_null();
    for (int digits = 6; digits <= 9; ++digits) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value)
            break;
    }
    return json_real(strtod(text, NULL));
}

void document_text(json_t *object, const char *key, const char *text)
{
    document_put(object, key, from_text(text));
}

void document_restore(char *text)
{
    char *to = text;
    for (const char *from = text; *from;) {
        unsigned byte = 0;
        bool escaped = from[0] == '\\' && from[1] == 'x' && isxdigit((unsigned char)from[2]) &&
                       sscanf(from + 2, "%2x", &byte) == 1 && isxdigit((unsigned char)from[3]);
        *to++ = escaped && byte ? (char)byte : *from;
        from += escaped ? 4 : 1;
    }
    *to = '\0';
}

void document_append_text(json_t *array, const char *text)
{
    document_append(array, from_text(text));
}

void document_number(json_t *object, const char *key, double value)
{
    document_put(object, key, from_number(value));
}

double document_known(double value)
{
    return value >= 0.0 ? value : (double)NAN;
}

void document_ms(json_t *object, const char *key, double time_ms)
{
    document_number(object, key, floor(time_ms * 1e3 + 0.5) * 1e-3);
}

void document_float(json_t *object, const char *key, float value)
{
    document_put(object, key, from_float(value));
}

void document_count(json_t *object, const char *key, uint64_t value)
{
    document_put(object, key, json_integer((json_int_t)value));
}

void document_flag(json_t *object, const char *key, bool value)
{
    document_put(object, key, json_boolean(value));
}

void document_hash(json_t *object, const char *key, uint64_t value)
{
    char text[17];
    snprintf(text, sizeof text, "%016" PRIx64, value);
    document_text(object, key, text);
}

void document_floats(json_t *object, const char *key, const float *values, uint32_t count)
{
    json_t *array = document_array();
    for (uint32_t i = 0; i < count; ++i)
        document_append(array, from_float(values[i]));
    document_put(object, key, array);
}

void document_numbers(json_t *object, const char *key, const double *values, uint32_t count)
{
    json_t *array = document_array();
    for (uint32_t i = 0; i < count; ++i)
        document_append(array, from_number(values[i]));
    document_put(object, key, array);
}

json_t *document_device(const whit_device_info *info)
{
    json_t *device = document_object();
    document_text(device, "name", info->name);
    document_text(device, "driver", info->driver);
    document_text(device, "kind", whit_device_kind_name(info->kind));
    return device;
}

double document_read_number(const json_t *object, const char *key, double otherwise)
{
    const json_t *value = json_object_get(object, key);
    return json_is_number(value) ? json_number_value(value) : otherwise;
}

uint64_t document_read_count(const json_t *object, const char *key)
{
    double value = document_read_number(object, key, 0.0);
    return value > 0.0 && value < 0x1p53 ? (uint64_t)value : 0;
}

/* Does not use json_dumps: jansson 2.14 silently drops a key that it has no memory for, while a
   stream remembers the failure. */
static char *dump_all(const json_t *value, size_t flags)
{
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    bool whole = to && json_dumpf(value, to, flags) == 0 && !ferror(to);
    if (!to || fclose(to) != 0 || !whole)
        out_of_memory();
    return text;
}

/* Escapes characters that control a terminal. In JSON they occur only inside strings, where an
   escape means the same. */
static char *dump(json_t *value, size_t flags)
{
    char *text = dump_all(value, flags | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(15));
    char *shown = NULL;
    size_t size;
    FILE *to = open_memstream(&shown, &size);
    json_decref(value);
    for (const char *from = text; to && *from;) {
        char part[WHIT_SHOWN_BYTES] = "\n";
        from += *from == '\n' ? 1 : whit_text_next(from, part);
        fputs(part, to);
    }
    if (!to || ferror(to) || fclose(to) != 0)
        out_of_memory();
    free(text);
    return shown;
}

char *document_lines(json_t *value)
{
    return dump(value, JSON_INDENT(2));
}

whit_result document_save_text(char *text, const char *path)
{
    if (!text)
        return cli_no_memory();
    cli_set_saving();
    whit_result result = file_write_whole(&cli_log, path, text, strlen(text));
    free(text);
    return result;
}

whit_result document_save_written(const char *path, void (*write)(FILE *to, const void *user),
                                  const void *user)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *to = open_memstream(&text, &bytes);
    if (to)
        write(to, user);
    whit_result result =
        to && fclose(to) == 0 ? file_write_whole(&cli_log, path, text, bytes) : cli_no_memory();
    free(text);
    return result;
}

whit_result document_save(json_t *value, const char *path)
{
    return document_save_text(document_lines(value), path);
}

char *document_line(json_t *value)
{
    return dump(value, JSON_COMPACT);
}
