#include "load/mtl.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/same.h"
#include "base/text.h"

/* --- words and numbers, in any locale ------------------------------------------------------- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

static char *skip_blanks(char *at)
{
    while (is_blank(*at))
        at++;
    return at;
}

/* Cuts the next word off the line; "" at its end. */
static char *next_word(char **at)
{
    char *word = skip_blanks(*at), *end = word;
    while (*end && !is_blank(*end))
        end++;
    *at = *end ? end + 1 : end;
    *end = 0;
    return word;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Parses a word that is as a whole a finite decimal number, in any locale. */
static bool parse_number(const char *word, float *out)
{
    double value = 0;
    int exponent = 0, digits = 0;
    const char *at = word;
    bool negative = *at == '-';
    at += *at == '-' || *at == '+';
    for (; is_digit(*at); at++, digits++)
        value = value * 10 + (*at - '0');
    if (*at == '.')
        for (at++; is_digit(*at); at++, digits++, exponent--)
            value = value * 10 + (*at - '0');
    if (digits && (*at == 'e' || *at == 'E')) {
        int power = 0;
        bool down = at[1] == '-';
        at += at[1] == '-' || at[1] == '+' ? 2 : 1;
        for (; is_digit(*at); at++)
            power = power < 1000 ? power * 10 + (*at - '0') : power;
        exponent += down ? -power : power;
    }
    value *= same_pow(10.0, exponent);
    *out = (float)(negative ? -value : value);
    return digits > 0 && *at == 0 && isfinite(*out);
}

/* Reads up to `max` numbers; `at` is then behind the last one. */
static uint32_t parse_numbers(char **at, float *out, uint32_t max)
{
    uint32_t count = 0;
    while (count < max) {
        char *start = skip_blanks(*at), *end = start;
        while (*end && !is_blank(*end))
            end++;
        char after = *end;
        *end = 0;
        bool good = parse_number(start, &out[count]);
        *end = after;
        if (!good)
            break;
        count++;
        *at = end;
    }
    return count;
}

size_t mtl_find_comment(const char *line, size_t bytes, bool has_names)
{
    for (size_t at = 0; at < bytes; at++) {
        bool alone =
            at == 0 || (is_blank(line[at - 1]) && (at + 1 == bytes || is_blank(line[at + 1])));
        if (line[at] == '#' && (alone || !has_names))
            return at;
    }
    return bytes;
}

/* --- notes ---------------------------------------------------------------------------------- */

struct reader {
    struct scene *scene;
    const char *path;
    uint32_t line;
    struct mtl_library *library;
    struct key_table noted; /* keywords that a note was made about */
    bool failed;            /* no memory for a note */
};

static bool note_keyword(struct reader *reader, const char *keyword, const char *what)
{
    uint32_t line;
    if (key_table_find(&reader->noted, keyword, strlen(keyword), &line))
        return true;
    if (!key_table_add(&reader->noted, keyword, strlen(keyword), reader->line))
        return false;
    scene_note(reader->scene, SCENE_NOTE_WARNING, "%s:%u: `%s` %s", path_name(reader->path),
               reader->line, text_token(keyword).text, what);
    return true;
}

/* --- keywords ------------------------------------------------------------------------------- */

static bool read_color(struct reader *reader, struct mtl_entry *entry, enum mtl_color color,
                       const char *keyword, char *rest)
{
    float rgb[3];
    uint32_t count = parse_numbers(&rest, rgb, 3);
    if (count == 0)
        return note_keyword(reader, keyword, "without numbers is ignored");
    for (uint32_t i = 0; i < 3; i++)
        entry->colors[color][i] = fmaxf(rgb[count == 3 ? i : 0], 0.0f);
    entry->has_color[color] = true;
    return true;
}

static bool read_number(struct reader *reader, struct mtl_entry *entry, enum mtl_number number,
                        const char *keyword, char *rest)
{
    char *at = skip_blanks(rest);
    if (number == MTL_D && strncmp(at, "-halo", 5) == 0) {
        at += 5;
        if (!note_keyword(reader, "d -halo", "is read as plain `d`"))
            return false;
    }
    float value;
    if (parse_numbers(&at, &value, 1) != 1)
        return note_keyword(reader, keyword, "without a number is ignored");
    bool transparency = strcmp(keyword, "Tr") == 0;
    /* d wins over Tr, which some programs write as transparency and others as opacity. */
    if (transparency && entry->has_number[MTL_D])
        return true;
    entry->numbers[number] = transparency ? 1.0f - value : value;
    entry->has_number[number] = true;
    if (number == MTL_D)
        entry->d_by_tr = transparency;
    return true;
}

/* How many numbers or words follow an option of a map; -1: it is no such option. */
static int option_arguments(const char *option)
{
    static const struct {
        const char *name;
        int arguments;
    } options[] = {
        {"-blendu", 1}, {"-blendv", 1},  {"-bm", 1},   {"-boost", 1},      {"-cc", 1},
        {"-clamp", 1},  {"-imfchan", 1}, {"-mm", 2},   {"-o", 3},          {"-s", 3},
        {"-t", 3},      {"-texres", 1},  {"-type", 1}, {"-colorspace", 1},
    };
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (strcmp(option, options[i].name) == 0)
            return options[i].arguments;
    return -1;
}

/* Reads the numbers behind an option. */
static void read_option_numbers(struct reader *reader, const char *option, char **at,
                                struct mtl_texture *map)
{
    float v[3] = {0, 0, 0};
    uint32_t count = parse_numbers(at, v, 3);
    for (uint32_t i = 0; i < 2 && i < count; i++) {
        if (option[1] == 's')
            map->scale[i] = v[i];
        else if (option[1] == 'o')
            map->offset[i] = v[i];
    }
    if (option[1] == 't' && (v[0] != 0 || v[1] != 0) && reader)
        reader->failed |= !note_keyword(reader, "-t", "(turbulence) was ignored");
}

static void read_option_word(struct reader *reader, const char *option, const char *word,
                             struct mtl_texture *map)
{
    if (strcmp(option, "-clamp") == 0) {
        map->clamp = strcmp(word, "on") == 0;
    } else if (strcmp(option, "-imfchan") == 0) {
        bool known = *word && strchr("rgbml", *word) && word[1] == 0;
        map->channel = known ? *word : 0;
        if (!known && reader)
            reader->failed |= !note_keyword(reader, "-imfchan", "of that channel was ignored");
    } else if (strcmp(option, "-cc") == 0 && strcmp(word, "on") == 0 && reader) {
        reader->failed |= !note_keyword(reader, "-cc", "(colour correction) was ignored");
    }
}

/* Reads the option at *at and its arguments; false when there is none. `reader`: notes what is
   ignored; may be NULL. The options -blendu, -boost, -texres and -type choose filters and sizes of
   textures; they are skipped, since whit has one way for these. */
static bool read_option(struct reader *reader, char **at, struct mtl_texture *map)
{
    char *start = skip_blanks(*at), *end = start;
    char option[16] = "";
    while (*end && !is_blank(*end))
        end++;
    if (*start != '-' || (size_t)(end - start) >= sizeof option)
        return false;
    memcpy(option, start, (size_t)(end - start));
    int arguments = option_arguments(option);
    if (arguments < 0)
        return false;
    *at = end;
    float range[2] = {map->base, map->gain};
    if (arguments == 3) {
        read_option_numbers(reader, option, at, map);
    } else if (strcmp(option, "-bm") == 0) {
        (void)parse_numbers(at, &map->bump, 1);
    } else if (strcmp(option, "-mm") == 0) {
        (void)parse_numbers(at, range, 2);
        map->base = range[0];
        map->gain = range[1];
    } else {
        for (int i = 0; i < arguments; i++)
            read_option_word(reader, option, next_word(at), map);
    }
    return true;
}

/* Offset of the blank in `name` from which on there are only options; its length: there is none.
   Words are parsed from right to left, so that each is parsed once. */
static size_t find_trailing_options(const char *name)
{
    size_t length = strlen(name), found = length;
    char *copy = array_alloc_zeroed(length + 1, 2);
    char *only = copy + length + 1; /* by offset: an option, and behind it there are only options */
    if (!copy)
        return length;
    memcpy(copy, name, length);
    for (size_t i = length; i-- > 0;) {
        struct mtl_texture trial = {0};
        char *at = copy + i + 1;
        if (!is_blank(copy[i]) || copy[i + 1] != '-' || !read_option(NULL, &at, &trial))
            continue;
        memcpy(copy + i, name + i, (size_t)(at - copy) - i); /* read_option cuts words off */
        at = skip_blanks(at);
        only[i + 1] = !*at || only[at - copy];
        found = only[i + 1] && copy[i] == ' ' ? i : found;
    }
    free(copy);
    return found;
}

/* Reads options that some writers put behind the file's name, and cuts them off `name`. */
static void cut_trailing_options(struct reader *reader, char *name, struct mtl_texture *map)
{
    char *end = name + find_trailing_options(name), *options = *end ? end + 1 : end;
    while (read_option(reader, &options, map))
        continue;
    *end = 0;
}

static void trim_end(char *text)
{
    size_t length = strlen(text);
    while (length && is_blank(text[length - 1]))
        text[--length] = 0;
}

static bool read_map(struct reader *reader, struct mtl_entry *entry, enum mtl_map kind,
                     const char *keyword, char *rest)
{
    struct mtl_texture map = {.scale = {1, 1}, .bump = 1, .gain = 1, .line = reader->line};
    while (read_option(reader, &rest, &map))
        continue;
    char *name = skip_blanks(rest);
    trim_end(name);
    cut_trailing_options(reader, name, &map);
    trim_end(name);
    size_t length = strlen(name);
    if (length > 2 && name[0] == '"' && name[length - 1] == '"') {
        name[length - 1] = 0;
        name++;
    }
    if (reader->failed)
        return false;
    if (!*name)
        return note_keyword(reader, keyword, "without a file is ignored");
    free(entry->maps[kind].file);
    entry->maps[kind] = map;
    entry->maps[kind].file = string_copy(name);
    return entry->maps[kind].file;
}

static bool read_property(struct reader *reader, struct mtl_entry *entry, const char *keyword,
                          char *rest)
{
    static const struct {
        const char *keyword;
        char type; /* c: colour, n: number, m: map, i: known and ignored */
        int which;
    } table[] = {
        {"Ka", 'c', MTL_KA},
        {"Kd", 'c', MTL_KD},
        {"Ks", 'c', MTL_KS},
        {"Ke", 'c', MTL_KE},
        {"Tf", 'c', MTL_TF},
        {"Ns", 'n', MTL_NS},
        {"Ni", 'n', MTL_NI},
        {"d", 'n', MTL_D},
        {"Tr", 'n', MTL_D},
        {"Pr", 'n', MTL_PR},
        {"Pm", 'n', MTL_PM},
        {"illum", 'n', MTL_ILLUM},
        {"map_Ka", 'm', MTL_MAP_KA},
        {"map_Kd", 'm', MTL_MAP_KD},
        {"map_Ks", 'm', MTL_MAP_KS},
        {"map_Ke", 'm', MTL_MAP_KE},
        {"map_Ns", 'm', MTL_MAP_NS},
        {"map_d", 'm', MTL_MAP_D},
        {"map_Tr", 'm', MTL_MAP_D},
        {"map_Bump", 'm', MTL_MAP_BUMP},
        {"map_bump", 'm', MTL_MAP_BUMP},
        {"bump", 'm', MTL_MAP_BUMP},
        {"map_kS", 'm', MTL_MAP_KS},
        {"norm", 'm', MTL_MAP_NORMAL},
        {"map_Kn", 'm', MTL_MAP_NORMAL},
        {"sharpness", 'i', 0},
        {"map_aat", 'i', 0},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        if (strcmp(keyword, table[i].keyword) != 0)
            continue;
        if (table[i].type == 'c')
            return read_color(reader, entry, (enum mtl_color)table[i].which, keyword, rest);
        if (table[i].type == 'n')
            return read_number(reader, entry, (enum mtl_number)table[i].which, keyword, rest);
        if (table[i].type == 'm')
            return read_map(reader, entry, (enum mtl_map)table[i].which, keyword, rest);
        return true;
    }
    return note_keyword(reader, keyword, "is not used by whit and was ignored");
}

static bool begin_entry(struct reader *reader, char *rest)
{
    char *name = skip_blanks(rest);
    trim_end(name);
    struct mtl_entry entry = {
        .name = string_copy(name), .file = string_copy(reader->path), .line = reader->line};
    struct mtl_library *library = reader->library;
    uint32_t index = library->count;
    bool named = entry.name && entry.file;
    if (named && !key_table_find(&library->names, name, strlen(name), &index))
        named = key_table_add(&library->names, name, strlen(name), index);
    if (named && ARRAY_PUSH(library->entries, library->count, library->capacity, entry))
        return true;
    free(entry.name);
    free(entry.file);
    return false;
}

static bool read_line(struct reader *reader, char *line, bool *in_entry)
{
    line[mtl_find_comment(line, strlen(line), true)] = 0;
    char *rest = line;
    char *keyword = next_word(&rest);
    if (!*keyword || *keyword == '#')
        return true;
    if (strcmp(keyword, "newmtl") == 0) {
        *in_entry = true;
        return begin_entry(reader, rest);
    }
    if (!*in_entry)
        return note_keyword(reader, keyword, "before the first newmtl was ignored");
    struct mtl_library *library = reader->library;
    return read_property(reader, &library->entries[library->count - 1], keyword, rest);
}

/* Ends the logical line at `at`: a backslash before the line's end joins the next one to it.
   Returns the start of the next line, or NULL. */
static char *cut_line(char *at, uint32_t *lines)
{
    *lines = 0;
    for (;; at++) {
        if (*at == 0)
            return NULL;
        if (*at == '\\' && (at[1] == '\n' || (at[1] == '\r' && at[2] == '\n'))) {
            *lines += 1;
            at[0] = ' ';
            at += at[1] == '\r';
            at[0] = ' ';
            at[1] = ' ';
        } else if (*at == '\n' || *at == '\r') {
            *lines += 1;
            bool pair = at[0] == '\r' && at[1] == '\n';
            *at = 0;
            return at + (pair ? 2 : 1);
        }
    }
}

bool mtl_parse(struct scene *scene, const char *path, const char *text, struct mtl_library *library)
{
    struct reader reader = {.scene = scene, .path = path, .line = 1, .library = library};
    bool in_entry = false;
    char *copy = string_copy(text + text_mark_bytes(text));
    bool ok = copy;
    char *line = copy;
    while (ok && line) {
        uint32_t lines;
        char *next = cut_line(line, &lines);
        ok = read_line(&reader, line, &in_entry);
        reader.line += lines;
        line = next;
    }
    key_table_finish(&reader.noted);
    free(copy);
    return ok;
}

void mtl_finish(struct mtl_library *library)
{
    for (uint32_t i = 0; i < library->count; i++) {
        struct mtl_entry *entry = &library->entries[i];
        free(entry->name);
        free(entry->file);
        for (int map = 0; map < MTL_MAP_COUNT; map++)
            free(entry->maps[map].file);
    }
    free(library->entries);
    key_table_finish(&library->names);
    *library = (struct mtl_library){0};
}

const struct mtl_entry *mtl_find(const struct mtl_library *library, const char *name)
{
    uint32_t index;
    bool found = key_table_find(&library->names, name, strlen(name), &index);
    return found ? &library->entries[index] : NULL;
}
