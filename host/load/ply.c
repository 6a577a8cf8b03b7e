#define _GNU_SOURCE /* memmem */
#include "load/ply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"

/* --- the header ----------------------------------------------------------------------------- */

enum { WORDS_MAX = 5, WORD_BYTES = 32 };

/* A scalar type in binary files; 0 bytes: not a type of PLY. */
struct type {
    uint32_t bytes;
    bool is_signed, is_float;
};

struct property {
    bool list, is_corners; /* is_corners: the vertices of a face */
    bool is_red, is_alpha;
    uint32_t line;
    struct type count, value;
};

struct element {
    char name[WORD_BYTES];
    unsigned long long count;
    bool counted;      /* the header gives `count` as a whole number */
    size_t begin, end; /* offsets of its lines in the header */
    size_t data_end;   /* offset behind its data; filled by check_elements, as is empty_count */
    unsigned long long empty_count; /* faces without corners */
    uint32_t line, first_property, property_count;
};

enum format { FORMAT_ASCII, FORMAT_LITTLE, FORMAT_BIG };

struct header {
    struct element *elements;
    struct property *properties;
    uint32_t element_count, element_capacity, property_count, property_capacity;
    uint32_t line_count;
    enum format format;
    bool has_end;
    size_t end;
};

static void header_finish(struct header *header)
{
    free(header->elements);
    free(header->properties);
}

static struct type type_of(const char *name)
{
    static const struct {
        const char *names[2];
        uint32_t bytes;
    } types[] = {{{"char", "int8"}, 1},
                 {{"short", "int16"}, 2},
                 {{"int", "int32"}, 4},
                 {{"float", "float32"}, 4},
                 {{"double", "float64"}, 8}};
    bool is_unsigned = name[0] == 'u';
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
        for (int k = 0; k < 2; k++)
            if (strcmp(types[i].names[k], name + is_unsigned) == 0)
                return (struct type){types[i].bytes, !is_unsigned, i >= 3};
    return (struct type){0};
}

/* Splits the line at `at` into its first words, of which longer ones are cut; gives the offset of
   the next line. */
static size_t read_line(const uint8_t *data, size_t size_bytes, size_t at,
                        char words[WORDS_MAX][WORD_BYTES])
{
    size_t word = 0, used = 0;
    memset(words, 0, WORDS_MAX * sizeof *words);
    for (; at < size_bytes && data[at] != '\n' && data[at] != '\r'; at++) {
        if (data[at] <= ' ') {
            word += used > 0;
            used = 0;
        } else if (word < WORDS_MAX && used + 1 < WORD_BYTES) {
            words[word][used++] = (char)data[at];
        }
    }
    bool wide = at + 1 < size_bytes && data[at] == '\r' && data[at + 1] == '\n';
    return at + (wide ? 2 : 1);
}

static bool add_property(struct header *header, char words[WORDS_MAX][WORD_BYTES])
{
    bool list = strcmp(words[1], "list") == 0;
    const char *channel = strncmp(words[2], "diffuse_", 8) == 0 ? words[2] + 8 : words[2];
    const struct property property = {.list = list,
                                      .is_corners = strncmp(words[4], "vertex_ind", 10) == 0,
                                      .is_red = strcmp(channel, "red") == 0,
                                      .is_alpha = strcmp(channel, "alpha") == 0,
                                      .line = header->line_count,
                                      .count = type_of(words[2]),
                                      .value = type_of(words[list ? 3 : 1])};
    header->elements[header->element_count - 1].property_count++;
    return ARRAY_PUSH(header->properties, header->property_count, header->property_capacity,
                      property);
}

static bool add_element(struct header *header, size_t begin, char words[WORDS_MAX][WORD_BYTES])
{
    struct element element = {
        .begin = begin, .line = header->line_count, .first_property = header->property_count};
    memcpy(element.name, words[1], sizeof element.name);
    element.count = strtoull(words[2], NULL, 10);
    element.counted = words[2][0] && words[2][strspn(words[2], "0123456789")] == 0;
    return ARRAY_PUSH(header->elements, header->element_count, header->element_capacity, element);
}

/* False: memory ran out. */
static bool read_header(const uint8_t *data, size_t size_bytes, struct header *header)
{
    char words[WORDS_MAX][WORD_BYTES];
    bool good = true;
    for (size_t at = 0, next; good && !header->has_end && at < size_bytes; at = next) {
        next = read_line(data, size_bytes, at, words);
        header->end = next;
        header->line_count++;
        header->has_end = strcmp(words[0], "end_header") == 0;
        if (strcmp(words[0], "format") == 0)
            header->format = strcmp(words[1], "binary_little_endian") == 0 ? FORMAT_LITTLE
                             : strcmp(words[1], "binary_big_endian") == 0  ? FORMAT_BIG
                                                                           : FORMAT_ASCII;
        else if (strcmp(words[0], "element") == 0)
            good = add_element(header, at, words);
        else if (strcmp(words[0], "property") == 0 && header->element_count)
            good = add_property(header, words);
        if (good && header->element_count && !header->has_end)
            header->elements[header->element_count - 1].end = next;
    }
    return good;
}

/* Whether a type of the property is none of PLY. */
static bool has_bad_type(const struct property *property)
{
    return property->value.bytes == 0 || (property->list && property->count.bytes == 0);
}

/* Logs an error if the header does not end, if it states more elements than there are bytes of
   data, both of which assimp believes, or if it names a type that is none. */
static whit_result check_header(const whit_log *log, const char *path, const struct header *header,
                                size_t size_bytes)
{
    size_t behind = header->end < size_bytes ? size_bytes - header->end : 0;
    if (!header->has_end)
        return log_failure(log, WHIT_ERROR_INPUT, "%s:%u: the file ends within its header", path,
                           header->line_count + 1);
    for (uint32_t i = 0; i < header->element_count; i++) {
        const struct element *element = &header->elements[i];
        if (!element->counted)
            return log_failure(log, WHIT_ERROR_INPUT, "%s:%u: it says no number of elements", path,
                               element->line);
        if (element->property_count == 0 || element->count <= behind) /* others have no data */
            continue;
        return log_failure(log, WHIT_ERROR_INPUT,
                           "%s:%u: %llu elements, but only %zu bytes behind the header", path,
                           element->line, element->count, behind);
    }
    for (uint32_t i = 0; i < header->property_count; i++) {
        if (!has_bad_type(&header->properties[i]))
            continue;
        return log_failure(log, WHIT_ERROR_INPUT,
                           "%s:%u: its header names a type of numbers that PLY does not have", path,
                           header->properties[i].line);
    }
    return WHIT_OK;
}

/* --- numbers -------------------------------------------------------------------------------- */

struct cursor {
    const uint8_t *at, *end;
    enum format format;
};

/* Reads the next integer; false where there is none. */
static bool read_whole(struct cursor *from, struct type type, int64_t *out)
{
    if (from->format == FORMAT_ASCII) {
        char *end;
        *out = strtoll((const char *)from->at, &end, 10); /* a zero byte follows the file */
        bool found = (const uint8_t *)end > from->at && (const uint8_t *)end <= from->end;
        from->at = (const uint8_t *)end;
        return found;
    }
    if (type.bytes == 0 || type.bytes > 4 || (size_t)(from->end - from->at) < type.bytes)
        return false;
    int64_t bits = 0, half = INT64_C(1) << (8 * type.bytes - 1);
    for (uint32_t i = 0; i < type.bytes; i++)
        bits |= (int64_t)from->at[from->format == FORMAT_BIG ? type.bytes - 1 - i : i] << 8 * i;
    from->at += type.bytes;
    *out = type.is_signed && bits >= half ? bits - 2 * half : bits;
    return true;
}

static bool skip_numbers(struct cursor *from, uint32_t bytes, uint64_t count)
{
    if (from->format != FORMAT_ASCII) {
        bool there = bytes && count <= (size_t)(from->end - from->at) / bytes;
        from->at += there ? count * bytes : 0;
        return there;
    }
    for (uint64_t i = 0; i < count; i++) {
        while (from->at < from->end && *from->at <= ' ')
            from->at++;
        const uint8_t *start = from->at;
        while (from->at<from->end && * from->at> ' ')
            from->at++;
        if (from->at == start)
            return false;
    }
    return true;
}

static bool skip_property(struct cursor *from, const struct property *property)
{
    int64_t count = 1;
    return (!property->list || (read_whole(from, property->count, &count) && count >= 0)) &&
           skip_numbers(from, property->value.bytes, (uint64_t)count);
}

/* --- strips --------------------------------------------------------------------------------- */

/* The triangles that strips become: assimp 5.2 reads only the last one of a strip. */
struct strips {
    const struct element *element; /* NULL: there are none */
    uint32_t *corners;             /* 3 vertex indices per triangle */
    uint32_t count, capacity;
    uint64_t vertex_count;
};

/* The last two vertices of a strip, and how many it has. */
struct strip {
    uint32_t last[2];
    uint32_t length;
};

/* Adds a vertex to the strip, and so a triangle, every second one reversed. Degenerate triangles,
   which only connect parts of a strip, are left out. */
static bool add_vertex(struct strips *strips, struct strip *strip, uint32_t vertex)
{
    const uint32_t *last = strip->last;
    bool odd = strip->length % 2, good = true;
    const uint32_t triangle[3] = {last[odd], last[!odd], vertex};
    bool flat = last[0] == last[1] || last[0] == vertex || last[1] == vertex;
    for (int i = 0; i < 3 && strip->length > 1 && !flat && good; i++)
        good = ARRAY_PUSH(strips->corners, strips->count, strips->capacity, triangle[i]);
    strip->last[0] = strip->last[1];
    strip->last[1] = vertex;
    strip->length++;
    return good;
}

/* Reads one list of vertices; -1 in it begins a new strip. */
static whit_result read_strip(struct cursor *from, const struct property *list,
                              struct strips *strips)
{
    struct strip strip = {0};
    int64_t count, vertex;
    if (!read_whole(from, list->count, &count) || count < 0)
        return WHIT_ERROR_INPUT;
    for (int64_t i = 0; i < count; i++) {
        if (!read_whole(from, list->value, &vertex))
            return WHIT_ERROR_INPUT;
        bool restart = vertex == -1 || vertex == UINT32_MAX;
        if (restart)
            strip.length = 0;
        else if (vertex < 0 || (uint64_t)vertex >= strips->vertex_count)
            return WHIT_ERROR_INPUT;
        else if (!add_vertex(strips, &strip, (uint32_t)vertex))
            return WHIT_ERROR_MEMORY;
    }
    return WHIT_OK;
}

/* Reads the first list of each instance. */
static whit_result read_strips(struct cursor *from, const struct header *header,
                               struct strips *strips)
{
    const struct element *element = strips->element;
    for (unsigned long long i = 0; element->property_count && i < element->count; i++) {
        bool found = false;
        for (uint32_t k = 0; k < element->property_count; k++) {
            const struct property *property = &header->properties[element->first_property + k];
            whit_result result = WHIT_OK;
            if (property->list && !found)
                result = read_strip(from, property, strips);
            else if (!skip_property(from, property))
                result = WHIT_ERROR_INPUT;
            found |= property->list;
            if (result != WHIT_OK)
                return result;
        }
    }
    return WHIT_OK;
}

static const struct element *find_element(const struct header *header, const char *name)
{
    for (uint32_t i = 0; i < header->element_count; i++)
        if (strcmp(header->elements[i].name, name) == 0)
            return &header->elements[i];
    return NULL;
}

/* --- faces that are cut short --------------------------------------------------------------- */

/* Moves a cursor on a line of an ASCII file to the next one with data. */
static void next_line(struct cursor *line, const uint8_t *end)
{
    line->at = line->end;
    while (line->at < end && *line->at <= ' ')
        line->at++;
    line->end = line->at;
    while (line->end < end && *line->end != '\n' && *line->end != '\r')
        line->end++;
}

/* Skips an instance of an element; *empty: it is a face without corners. False: it is cut short. */
static bool skip_instance(struct cursor *from, const struct header *header,
                          const struct element *element, bool *empty)
{
    *empty = false;
    for (uint32_t k = 0; k < element->property_count; k++) {
        const struct property *property = &header->properties[element->first_property + k];
        struct cursor count_at = *from;
        int64_t count = 1;
        if (!skip_property(from, property))
            return false;
        *empty |= property->is_corners && read_whole(&count_at, property->count, &count) && !count;
    }
    return true;
}

/* Moves `from` behind an element's data, which it checks, or reads if they are strips. */
static whit_result check_element(const whit_log *log, const char *path, const uint8_t *end,
                                 const struct header *header, struct element *element,
                                 struct cursor *from, struct strips *strips)
{
    bool lines = header->format == FORMAT_ASCII, good = true, empty;
    unsigned long long done = 0;
    if (element == strips->element) {
        struct cursor all = {lines ? from->end : from->at, end, header->format};
        const struct element *faces = find_element(header, "face");
        bool beside = faces && faces->count;
        whit_result result = beside ? WHIT_ERROR_INPUT : read_strips(&all, header, strips);
        from->at = all.at;
        from->end = lines ? all.at : end;
        if (result == WHIT_ERROR_INPUT)
            log_error(log, "%s: its triangle strips %s", path,
                      beside ? "stand beside faces"
                             : "are cut short, are no whole numbers, or name vertices that are not "
                               "there");
        return result;
    }
    for (; element->property_count && done < element->count && good; done++) {
        if (lines)
            next_line(from, end);
        good = skip_instance(from, header, element, &empty);
        element->empty_count += empty;
    }
    if (!good)
        log_error(log, "%s: %s %llu of %llu is cut short, missing or not of numbers", path,
                  text_token(element->name).text, done, element->count);
    return good ? WHIT_OK : WHIT_ERROR_INPUT;
}

static whit_result check_elements(const whit_log *log, const char *path, const uint8_t *data,
                                  size_t size_bytes, const struct header *header,
                                  struct strips *strips)
{
    const uint8_t *end = data + size_bytes;
    bool lines = header->format == FORMAT_ASCII;
    struct cursor from = {data + header->end, lines ? data + header->end : end, header->format};
    for (uint32_t i = 0; i < header->element_count; i++) {
        struct element *element = &header->elements[i];
        whit_result result = check_element(log, path, end, header, element, &from, strips);
        if (result != WHIT_OK)
            return result;
        while (lines && from.end < end && *from.end <= ' ')
            from.end++;
        element->data_end = (size_t)((lines ? from.end : from.at) - data);
    }
    return WHIT_OK;
}

/* --- what assimp reads ---------------------------------------------------------------------- */

/* The file that assimp gets. */
struct output {
    uint8_t *bytes;
    size_t used;
};

static void put(struct output *to, const uint8_t *from, size_t count)
{
    memcpy(to->bytes + to->used, from, count);
    to->used += count;
}

/* Returns the place of a word that the line [at, next) contains. */
static const char *find_word(const uint8_t *data, size_t at, size_t next, const char *word)
{
    return memmem(data + at, next - at, word, strlen(word)); /* there may be zero bytes */
}

/* Copies lines of the header without comments, of which it keeps the name of the texture. False:
   memory ran out. */
static bool put_lines(struct output *to, const uint8_t *data, size_t begin, size_t end,
                      struct ply_paint *paint)
{
    static const char texture[] = "TextureFile", diffuse[] = "diffuse_";
    char words[WORDS_MAX][WORD_BYTES];
    for (size_t at = begin, next; at < end; at = next) {
        next = read_line(data, end, at, words);
        bool names = strcmp(words[0], "comment") == 0 && strcmp(words[1], texture) == 0;
        paint->more_textures |= names && paint->texture;
        if (names && !paint->texture) {
            const char *name = find_word(data, at, next, texture) + strlen(texture);
            name += strspn(name, " \t");
            paint->texture = string_format("%.*s", (int)strcspn(name, "\r\n"), name);
            if (!paint->texture)
                return false;
        }
        if (strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0)
            continue;
        const uint8_t *prefix = data + next;
        if (strncmp(words[2], diffuse, strlen(diffuse)) == 0)
            prefix = (const uint8_t *)find_word(data, at, next, diffuse);
        put(to, data + at, (size_t)(prefix - data) - at);
        if (prefix < data + next)
            put(to, prefix + strlen(diffuse), next - (size_t)(prefix - data) - strlen(diffuse));
    }
    return true;
}

/* Copies an element's data from `begin` on, without faces that have no corners. Lines are copied
   without blank ones, for each of which assimp loses an element. */
static void put_data(struct output *to, const uint8_t *data, size_t begin,
                     const struct header *header, const struct element *element)
{
    const uint8_t *end = data + element->data_end;
    bool lines = header->format == FORMAT_ASCII, empty = false;
    struct cursor from = {data + begin, lines ? data + begin : end, header->format};
    if (!lines && !element->empty_count) {
        put(to, data + begin, element->data_end - begin);
        return;
    }
    for (unsigned long long i = 0; element->property_count && i < element->count; i++) {
        if (lines)
            next_line(&from, end);
        const uint8_t *start = from.at;
        if (element->empty_count)
            (void)skip_instance(&from, header, element, &empty);
        if (!empty)
            put(to, start, (size_t)((lines ? from.end : from.at) - start));
        if (!empty && lines)
            to->bytes[to->used++] = '\n';
    }
}

enum { STRIPS_LINES_BYTES = 80, TRIANGLE_BYTES_MAX = 36 }; /* of put_triangles and its header */

static void put_triangles(struct output *to, enum format format, const struct strips *strips)
{
    for (uint32_t i = 0; i < strips->count; i += 3) {
        const uint32_t *corners = strips->corners + i;
        uint8_t *at = to->bytes + to->used;
        if (format == FORMAT_ASCII) {
            to->used +=
                (size_t)sprintf((char *)at, "3 %u %u %u\n", corners[0], corners[1], corners[2]);
            continue;
        }
        at[0] = 3;
        for (int k = 0; k < 12; k++)
            at[1 + k] = (uint8_t)(corners[k / 4] >> 8 * (format == FORMAT_BIG ? 3 - k % 4 : k % 4));
        to->used += 13;
    }
}

static bool put_element(struct output *to, const uint8_t *data, const struct element *element,
                        const struct strips *strips, struct ply_paint *paint)
{
    char words[WORDS_MAX][WORD_BYTES];
    size_t begin = element->begin;
    if (element == strips->element) {
        to->used += (size_t)sprintf((char *)to->bytes + to->used,
                                    "element face %u\nproperty list uchar int vertex_indices\n",
                                    strips->count / 3);
        return true;
    }
    if (element->empty_count) {
        begin += strcspn((const char *)data + begin, "\r\n");
        to->used += (size_t)sprintf((char *)to->bytes + to->used, "element %s %llu", element->name,
                                    element->count - element->empty_count);
        size_t next = read_line(data, element->end, begin, words);
        put(to, data + begin, next - begin);
        begin = next;
    }
    return put_lines(to, data, begin, element->end, paint);
}

static bool is_read(const struct element *element, const struct strips *strips, bool face)
{
    if (face && strips->element)
        return element == strips->element;
    return strcmp(element->name, face ? "face" : "vertex") == 0;
}

/* Copies what assimp reads, vertices first. False: memory ran out. */
static bool keep_read(struct output *to, const uint8_t *data, const struct header *header,
                      const struct strips *strips, struct ply_paint *paint)
{
    const struct element *elements = header->elements;
    uint32_t count = header->element_count;
    bool good = put_lines(to, data, 0, count ? elements[0].begin : 0, paint);
    for (uint32_t i = 0; good && i < 2 * count; i++)
        if (is_read(&elements[i % count], strips, i >= count))
            good = put_element(to, data, &elements[i % count], strips, paint);
    if (good)
        good = put_lines(to, data, count ? elements[count - 1].end : 0, header->end, paint);
    size_t head = to->used;
    for (uint32_t i = 0; good && i < 2 * count; i++) {
        const struct element *element = &elements[i % count];
        if (!is_read(element, strips, i >= count))
            continue;
        if (element == strips->element)
            put_triangles(to, header->format, strips);
        else
            put_data(to, data, i % count ? element[-1].data_end : header->end, header, element);
    }
    /* assimp 5.2 takes a first data byte of 10 for the end of the header's last line: there are two
       then. */
    uint8_t *begin = to->bytes + head;
    if (good && header->format != FORMAT_ASCII && to->used > head && begin[0] == '\n' &&
        begin[-1] == '\n' && begin[-2] != '\r')
        memmove(begin + 1, begin, to->used++ - head);
    to->bytes[to->used] = 0;
    return good;
}

/* --- colours -------------------------------------------------------------------------------- */

/* assimp divides by 255 or 65535, after an addition for types with a sign. */
static void read_paint(const struct header *header, const struct element *vertices,
                       struct ply_paint *paint)
{
    for (uint32_t k = 0; vertices && k < vertices->property_count; k++) {
        const struct property *property = &header->properties[vertices->first_property + k];
        struct type type = property->value;
        bool is_int = type.bytes == 4 && type.is_signed, is_byte = type.bytes == 1;
        if ((!property->is_red && !property->is_alpha) || type.is_float ||
            (is_byte && !type.is_signed))
            continue;
        paint->scale[property->is_alpha] = is_int || is_byte ? 255.0f : 65535.0f;
        paint->offset[property->is_alpha] = is_int            ? -127.5f
                                            : !type.is_signed ? 0.0f
                                            : is_byte         ? -127.0f
                                                              : -32767.0f;
    }
}

static void note_unread(struct scene *scene, const char *path, const struct header *header,
                        const struct ply_paint *paint)
{
    const struct element *faces = find_element(header, "face");
    const char *name = path_name(path);
    bool coloured = false;
    for (uint32_t k = 0; faces && k < faces->property_count; k++)
        coloured |= header->properties[faces->first_property + k].is_red;
    if (coloured)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: colours of %llu faces are not read", name,
                   faces->count);
    if (faces && faces->empty_count)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: %llu faces without corners were dropped", name,
                   faces->empty_count);
    if (find_element(header, "material"))
        scene_note(scene, SCENE_NOTE_WARNING, "%s: its materials are not read", name);
    if (paint->more_textures)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: of its textures only the first is drawn", name);
}

/* Replaces the bytes by those that assimp gets, and notes what is not among them. */
static whit_result rewrite(struct scene *scene, const char *path, const struct header *header,
                           const struct strips *strips, uint8_t **data, size_t *size_bytes,
                           struct ply_paint *paint)
{
    size_t more = STRIPS_LINES_BYTES + (size_t)strips->count / 3 * TRIANGLE_BYTES_MAX;
    struct output kept = {.bytes = array_alloc(*size_bytes + more, 1)};
    if (!kept.bytes || !keep_read(&kept, *data, header, strips, paint)) {
        free(kept.bytes);
        return WHIT_ERROR_MEMORY;
    }
    read_paint(header, find_element(header, "vertex"), paint);
    note_unread(scene, path, header, paint);
    free(*data);
    *data = kept.bytes;
    *size_bytes = kept.used;
    return WHIT_OK;
}

whit_result ply_prepare(struct scene *scene, const char *path, uint8_t **data, size_t *size_bytes,
                        struct ply_paint *paint)
{
    struct header header = {0};
    const whit_log *log = &scene->log;
    *paint = (struct ply_paint){.scale = {1, 1}};
    whit_result result = read_header(*data, *size_bytes, &header) ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        result = check_header(log, path, &header, *size_bytes);
    const struct element *vertices = find_element(&header, "vertex");
    struct strips strips = {.element = find_element(&header, "tristrips"),
                            .vertex_count = vertices ? vertices->count : 0};
    bool has_data = header.end <= *size_bytes;
    if (result == WHIT_OK && has_data)
        result = check_elements(log, path, *data, *size_bytes, &header, &strips);
    if (result == WHIT_OK && has_data)
        result = rewrite(scene, path, &header, &strips, data, size_bytes, paint);
    free(strips.corners);
    header_finish(&header);
    return result;
}
