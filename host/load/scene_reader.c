#include "load/scene_reader.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "image/image.h"
#include "scene/afford.h"

/* The scanners below walk text that jansson has accepted: it is valid JSON. */
static const char *skip_space(const char *at)
{
    return at + strspn(at, " \t\r\n");
}

static const char *skip_string(const char *at)
{
    for (++at; *at && *at != '"'; ++at) {
        if (*at == '\\' && at[1])
            ++at;
    }
    return *at ? at + 1 : at;
}

static const char *skip_value(const char *at)
{
    int depth = 0;
    do {
        at = skip_space(at);
        if (*at == '"') {
            at = skip_string(at);
        } else if (*at == '{' || *at == '[') {
            ++depth, ++at;
        } else if (*at == '}' || *at == ']') {
            --depth, ++at;
        } else if (*at == ',' || *at == ':') {
            ++at;
        } else {
            at += strcspn(at, " \t\r\n,:]}");
        }
    } while (depth > 0 && *at);
    return at;
}

/* Finds a member in the text of an object: its value, and *key, its key. NULL if it is not found,
   as when the key is written with escapes. */
static const char *find_member(const char *object, const char *name, const char **key)
{
    size_t length = strlen(name);
    const char *at = skip_space(object + 1);
    while (*at == '"') {
        const char *start = at, *end = skip_string(at);
        const char *value = skip_space(skip_space(end) + 1);
        if ((size_t)(end - start) == length + 2 && memcmp(start + 1, name, length) == 0) {
            *key = start;
            return value;
        }
        at = skip_space(skip_value(value));
        if (*at == ',')
            at = skip_space(at + 1);
    }
    return NULL;
}

static const char *find_element(const char *array, size_t index)
{
    const char *at = skip_space(array + 1);
    for (; index; --index) {
        at = skip_space(skip_value(at));
        if (*at == ',')
            at = skip_space(at + 1);
    }
    return at;
}

/* Where the value starts in the text. *marked: what an error points at, its key if it has one. */
static const char *locate(const struct reader *reader, const struct place *place,
                          const char **marked)
{
    const char *at = skip_space(reader->text);
    if (marked)
        *marked = at;
    if (!place || !place->parent)
        return at;
    const char *parent = locate(reader, place->parent, NULL), *key = parent;
    const char *value = parent;
    if (place->key && *parent == '{')
        value = find_member(parent, place->key, &key);
    else if (!place->key && *parent == '[')
        value = key = find_element(parent, place->index);
    if (!value)
        value = key = parent;
    if (marked)
        *marked = key;
    return value;
}

static void line_and_column(const struct reader *reader, const char *at, uint32_t *line,
                            uint32_t *column)
{
    *line = reader->lines_before + 1;
    *column = 1;
    for (const char *text = reader->text; text < at; ++text) {
        if (*text == '\n') {
            ++*line;
            *column = 1;
        } else if (((unsigned char)*text & 0xc0) != 0x80) { /* not a UTF-8 continuation byte */
            ++*column;
        }
    }
}

uint32_t reader_line(const struct reader *reader, const struct place *place)
{
    const char *marked;
    uint32_t line, column;
    uint64_t looks = (uint64_t)reader->scene->material_count + reader->scene->light_count;
    if (looks * reader->text_bytes > UINT64_C(300000000))
        return 0;
    (void)locate(reader, place, &marked);
    line_and_column(reader, marked, &line, &column);
    return line;
}

static size_t place_text(const struct place *place, char *out, size_t out_bytes)
{
    if (!place || !place->parent)
        return 0;
    size_t used = place_text(place->parent, out, out_bytes);
    if (used >= out_bytes)
        return used;
    int more = place->key ? snprintf(out + used, out_bytes - used, "%s%s", used ? "." : "",
                                     text_token(place->key).text)
                          : snprintf(out + used, out_bytes - used, "[%zu]", place->index);
    return more < 0 ? used : used + (size_t)more;
}

/* Guesses the cause of a syntax error from jansson's message, which names what was expected and
   what was found. */
static const char *syntax_hint(const char *error)
{
    if (strstr(error, "near '/"))
        return "; JSON has no comments, but any object may have a \"comment\"";
    if (strstr(error, "or '}' expected near '}'") || strstr(error, "unexpected token near ']'"))
        return "; is the comma before it one too many?";
    if (strncmp(error, "'}' expected near", 17) == 0 ||
        strncmp(error, "']' expected near", 17) == 0)
        return strstr(error, "end of file") ? "; it has to be closed"
                                            : "; is a comma missing before it?";
    return "";
}

json_t *reader_parse(struct reader *reader)
{
    json_error_t error;
    size_t mark_bytes = text_mark_bytes(reader->text);
    reader->text += mark_bytes;
    reader->text_bytes -= mark_bytes;
    json_t *root = json_loadb(reader->text, reader->text_bytes, JSON_REJECT_DUPLICATES, &error);
    if (!root) {
        log_error(&reader->scene->log, "%s:%d:%d: %s%s", reader->path,
                  (int)reader->lines_before + (error.line > 0 ? error.line : 1),
                  error.column > 0 ? error.column : 1, error.text, syntax_hint(error.text));
        reader->result = WHIT_ERROR_INPUT;
    }
    return root;
}

bool reader_fail(struct reader *reader, const struct place *place, const char *format, ...)
{
    char message[400], where[200] = "";
    const char *marked;
    uint32_t line, column;
    va_list args;
    va_start(args, format);
    text_print(message, sizeof message, format, args);
    va_end(args);
    (void)place_text(place, where, sizeof where);
    (void)locate(reader, place, &marked);
    line_and_column(reader, marked, &line, &column);
    log_error(&reader->scene->log, "%s:%u:%u: %s%s%s", reader->path, line, column, where,
              where[0] ? ": " : "", message);
    reader->result = WHIT_ERROR_INPUT;
    return false;
}

bool reader_afford(struct reader *reader, const struct place *place, uint64_t bytes,
                   const char *format, ...)
{
    char what[100], where[200] = "";
    va_list args;
    va_start(args, format);
    text_print(what, sizeof what, format, args);
    va_end(args);
    place_text(place, where, sizeof where);
    if (scene_afford(reader->scene, bytes, "%.150s: %s", where, what))
        return true;
    reader->result = WHIT_ERROR_INPUT;
    return false;
}

bool reader_no_memory(struct reader *reader)
{
    log_error(&reader->scene->log, "%s: out of memory", reader->path);
    reader->result = WHIT_ERROR_MEMORY;
    return false;
}

/* The key in `known` for what other programs call `word`; NULL: there is none. */
static const char *same_meaning(const char *word, const char *const *known)
{
    static const char *const meanings[][4] = {
        {"reflection", "mirror", "reflectivity", "reflective"},
        {"ior", "refraction"},
        {"diffuse", "color", "albedo", "base_color"},
        {"transmission", "transparency", "glass"},
        {"emission", "emissive", "emit"},
        {"opacity", "alpha"},
        {"shininess", "glossiness"},
        {"translation", "position", "translate"},
        {"rotation", "rotate"},
        {"eye", "position", "from"},
        {"target", "lookat", "look_at", "at"},
        {"shape", "type"},
        {"kind", "type"},
        {"outer", "angle"},
    };
    for (size_t i = 0; i < sizeof meanings / sizeof *meanings; ++i)
        for (size_t j = 1; j < 4 && meanings[i][j]; ++j)
            for (size_t k = 0; strcmp(word, meanings[i][j]) == 0 && known[k]; ++k)
                if (strcmp(known[k], meanings[i][0]) == 0)
                    return known[k];
    return NULL;
}

const char *reader_nearest(const char *word, const char *const *known)
{
    uint32_t count = 0;
    while (known[count])
        ++count;
    const char *same = same_meaning(word, known);
    return same ? same : text_nearest(word, known, count);
}

static bool listed(const char *key, const char *const *known)
{
    for (; *known; ++known) {
        if (strcmp(key, *known) == 0)
            return true;
    }
    return false;
}

static bool listed_in(const char *key, const char *const *const *lists, size_t list_count)
{
    for (size_t i = 0; i < list_count; ++i) {
        if (listed(key, lists[i]))
            return true;
    }
    return false;
}

const char *reader_foreign_key(const json_t *value, const char *const *const *lists,
                               size_t list_count, const char *const *const *others,
                               size_t other_count)
{
    const char *key;
    json_t *member;
    json_object_foreach((json_t *)(uintptr_t)value, key, member)
    {
        if (!listed_in(key, lists, list_count) && listed_in(key, others, other_count))
            return key;
    }
    return NULL;
}

bool reader_object_lists(struct reader *reader, const struct place *place, const json_t *value,
                         const char *const *const *lists, size_t list_count)
{
    const char *key;
    json_t *member;
    if (!json_is_object(value))
        return reader_fail(reader, place, "an object { } is expected here");
    /* The cast drops const: jansson iterates over non-const objects only. Nothing is changed. */
    json_object_foreach((json_t *)(uintptr_t)value, key, member)
    {
        bool known = strcmp(key, "comment") == 0 || listed_in(key, lists, list_count);
        const char *nearest = NULL;
        for (size_t i = 0; !known && !nearest && i < list_count; ++i)
            nearest = reader_nearest(key, lists[i]);
        struct place here = {place, key, 0};
        if (!known && nearest)
            return reader_fail(reader, &here, "unknown key; did you mean `%s`?", nearest);
        if (!known)
            return reader_fail(reader, &here, "unknown key");
    }
    return true;
}

bool reader_object(struct reader *reader, const struct place *place, const json_t *value,
                   const char *const *known)
{
    return reader_object_lists(reader, place, value, &known, 1);
}

static bool check_number(struct reader *reader, const struct place *place, const json_t *value,
                         double min, double max, double *out)
{
    if (!json_is_number(value))
        return reader_fail(reader, place, "a number is expected");
    double number = json_number_value(value);
    if (!(number >= min && number <= max))
        return reader_fail(reader, place, "%g is out of range (%g to %g)", number, min, max);
    *out = number;
    return true;
}

bool reader_number(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, double min, double max, double *out)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    return !value || check_number(reader, &here, value, min, max, out);
}

bool reader_float(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, double min, double max, float *out)
{
    double number = (double)*out;
    if (!json_object_get(object, key))
        return true;
    if (!reader_number(reader, place, object, key, min, max, &number))
        return false;
    *out = (float)number;
    return true;
}

bool reader_count(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, uint32_t min, uint32_t max, uint32_t *out)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    double number = 0.0;
    if (!value)
        return true;
    if (!json_is_number(value) || json_number_value(value) != floor(json_number_value(value)))
        return reader_fail(reader, &here, "a whole number is expected");
    if (!check_number(reader, &here, value, min, max, &number))
        return false;
    *out = (uint32_t)number;
    return true;
}

bool reader_bool(struct reader *reader, const struct place *place, const json_t *object,
                 const char *key, bool *out)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    if (!value)
        return true;
    if (!json_is_boolean(value))
        return reader_fail(reader, &here, "true or false is expected");
    *out = json_is_true(value);
    return true;
}

bool reader_string(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, const char **out)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    if (!value)
        return true;
    if (!json_is_string(value))
        return reader_fail(reader, &here, "a string is expected");
    *out = json_string_value(value);
    return true;
}

bool reader_choice(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, const char *const *names, uint32_t *out)
{
    const char *word = NULL;
    struct place here = {place, key, 0};
    if (!reader_string(reader, place, object, key, &word))
        return false;
    if (!word)
        return true;
    char all[200] = "";
    size_t used = 0;
    for (uint32_t i = 0; names[i]; ++i) {
        if (strcmp(word, names[i]) == 0) {
            *out = i;
            return true;
        }
        int more = snprintf(all + used, sizeof all - used, "%s%s", i ? ", " : "", names[i]);
        if (more > 0 && used + (size_t)more < sizeof all)
            used += (size_t)more;
    }
    return reader_fail(reader, &here, "`%s` is not one of: %s", text_token(word).text, all);
}

bool reader_vector(struct reader *reader, const struct place *place, const json_t *value,
                   size_t count, double *out)
{
    if (!json_is_array(value) || json_array_size(value) != count)
        return reader_fail(reader, place, "%zu numbers in [ ] are expected", count);
    for (size_t i = 0; i < count; ++i) {
        struct place here = {place, NULL, i};
        if (!check_number(reader, &here, json_array_get(value, i), -1e18, 1e18, &out[i]))
            return false;
    }
    return true;
}

bool reader_numbers(struct reader *reader, const struct place *place, const json_t *object,
                    const char *key, size_t count, double *out)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    return !value || reader_vector(reader, &here, value, count, out);
}

bool reader_extent(struct reader *reader, const struct place *place, const json_t *object,
                   const char *key, double min, double max, size_t count, double *out)
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    if (json_array_size(value) == count)
        return reader_vector(reader, &here, value, count, out);
    if (value && !json_is_number(value))
        return reader_fail(reader, &here, "a number, or %zu numbers in [ ], are expected", count);
    if (!reader_number(reader, place, object, key, min, max, &out[0]))
        return false;
    for (size_t i = 1; value && i < count; ++i)
        out[i] = out[0];
    return true;
}

static bool hex_color(const char *text, float out[3])
{
    if (text[0] != '#' || strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    unsigned long bits = strtoul(text + 1, NULL, 16);
    for (int i = 0; i < 3; ++i)
        out[i] = image_linear_from_srgb((float)(bits >> (16 - 8 * i) & 255) / 255.0f);
    return true;
}

bool reader_color_value(struct reader *reader, const struct place *place, const json_t *value,
                        float out[3])
{
    double rgb[3] = {0};
    if (json_is_string(value)) {
        if (hex_color(json_string_value(value), out))
            return true;
        return reader_fail(reader, place,
                           "`%s` is no colour; write \"#rrggbb\", a grey level or "
                           "[r, g, b]",
                           text_token(json_string_value(value)).text);
    }
    if (json_is_number(value)) {
        if (!check_number(reader, place, value, 0.0, 1e12, &rgb[0]))
            return false;
        out[0] = out[1] = out[2] = (float)rgb[0];
        return true;
    }
    if (!json_is_array(value) || json_array_size(value) != 3)
        return reader_fail(reader, place,
                           "a colour is expected: \"#rrggbb\", a grey level or [r, g, b]");
    for (size_t i = 0; i < 3; ++i) {
        struct place here = {place, NULL, i};
        if (!check_number(reader, &here, json_array_get(value, i), 0.0, 1e12, &rgb[i]))
            return false;
    }
    for (int i = 0; i < 3; ++i)
        out[i] = (float)rgb[i];
    return true;
}

bool reader_color(struct reader *reader, const struct place *place, const json_t *object,
                  const char *key, float out[3])
{
    const json_t *value = json_object_get(object, key);
    struct place here = {place, key, 0};
    return !value || reader_color_value(reader, &here, value, out);
}
