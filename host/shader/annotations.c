/* Annotations: lines of a user's file that begin with //@. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "shader/annotations.h"
#include "shader/scan.h"
#include "sources.h"

/* An annotation, which is parsed from left to right; `at` is where parsing goes on. */
struct line {
    const whit_log *log;
    whit_shader *shader;
    struct shader_errors *errors;
    const char *at, *end;
    uint32_t file, number;
};

/* Gives false, so that what failed can return it. */
static bool complain(const struct line *line, const char *format, ...) WHIT_PRINTF(2, 3);
static bool complain(const struct line *line, const char *format, ...)
{
    char text[SHADER_REASON_BYTES];
    va_list arguments;
    va_start(arguments, format);
    text_print(text, sizeof text, format, arguments);
    va_end(arguments);
    shader_error_add(line->log, line->errors, line->shader->text.files[line->file].name,
                     line->number, 0, "%s", text);
    return false;
}

/* Skips blanks. Whether a word without quotes follows. */
static bool has_bare_word(struct line *line)
{
    while (line->at < line->end && isspace((unsigned char)*line->at))
        line->at++;
    return line->at < line->end && *line->at != '"';
}

/* The next word, up to a blank; "" at the end. A word in quotes may have blanks. False: it is
   longer than `text`, or its quotes do not close. */
static bool next_word(struct line *line, char *text, size_t text_bytes)
{
    has_bare_word(line);
    bool quoted = line->at < line->end && *line->at == '"';
    line->at += quoted;
    size_t used = 0;
    while (line->at < line->end &&
           (quoted ? *line->at != '"' : !isspace((unsigned char)*line->at))) {
        if (used + 1 >= text_bytes) {
            text[used] = 0;
            return false;
        }
        text[used++] = *line->at++;
    }
    text[used] = 0;
    bool open = quoted && line->at == line->end;
    line->at += quoted && !open;
    return !open;
}

static bool ends(struct line *line)
{
    has_bare_word(line);
    return line->at == line->end;
}

static bool is_name(const char *text)
{
    bool fine = isalpha((unsigned char)text[0]) || text[0] == '_';
    for (const char *c = text; *c; ++c)
        fine = fine && (isalnum((unsigned char)*c) || *c == '_');
    return fine && !strstr(text, "__") && strncmp(text, "gl_", 3) != 0 &&
           strncmp(text, "whit_", 5) != 0;
}

static bool read_number(struct line *line, const char *what, double min, double max, double *number)
{
    char word[SHADER_NAME_BYTES], *end;
    bool fits = next_word(line, word, sizeof word);
    *number = text_real(word, &end);
    if (fits && end != word && !*end && *number >= min && *number <= max)
        return true;
    return complain(line, "%s is a number from %g to %g, not `%.60s`", what, min, max, word);
}

static bool read_slider_number(struct line *line, whit_slider *slider)
{
    double min, max, value;
    if (!read_number(line, "the least value of a slider", -1e30, 1e30, &min) ||
        !read_number(line, "the largest value of a slider", min, 1e30, &max) ||
        !read_number(line, "the value of a slider", min, max, &value))
        return false;
    slider->min = (float)min;
    slider->max = (float)max;
    slider->value[0] = (float)value;
    return true;
}

bool shader_color_read(const char *text, float srgb[3])
{
    unsigned rgb[3];
    int length = 0;
    if (sscanf(text, "#%2x%2x%2x%n", &rgb[0], &rgb[1], &rgb[2], &length) != 3 || length != 7 ||
        text[length] || strspn(text + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    for (int i = 0; i < 3; ++i)
        srgb[i] = (float)rgb[i] / 255.0f;
    return true;
}

static bool read_slider_color(struct line *line, whit_slider *slider)
{
    char word[SHADER_NAME_BYTES];
    if (next_word(line, word, sizeof word) && shader_color_read(word, slider->value))
        return true;
    return complain(line, "a colour is written as #ffcc88, not `%.60s`", word);
}

static bool read_slider_toggle(struct line *line, whit_slider *slider)
{
    char word[SHADER_NAME_BYTES];
    if (!has_bare_word(line))
        return true; /* no value: it begins switched off */
    bool fits = next_word(line, word, sizeof word), on = strcmp(word, "on") == 0;
    slider->value[0] = on;
    if (fits && (on || strcmp(word, "off") == 0))
        return true;
    return complain(line, "a toggle is on or off, not `%.60s`", word);
}

static bool read_slider_choice(struct line *line, whit_slider *slider,
                               struct shader_slider_text *texts)
{
    if (!next_word(line, texts->text, sizeof texts->text) || !texts->text[0]) {
        return complain(line, "a choice names its words, as in `choice mode a,b`");
    }
    slider->words = texts->words;
    for (char *word = texts->text; word;) {
        char *comma = strchr(word, ',');
        if (comma)
            *comma = 0;
        if (!is_name(word) || slider->word_count == SHADER_WORDS_MAX) {
            return complain(line,
                            "a choice has up to %d words of letters, digits and _, not `%.60s`",
                            SHADER_WORDS_MAX, word);
        }
        for (uint32_t i = 0; i < slider->word_count; ++i) {
            if (strcmp(texts->words[i], word) == 0) {
                return complain(line, "a choice has the word `%s` twice", word);
            }
        }
        texts->words[slider->word_count++] = word;
        word = comma ? comma + 1 : NULL;
    }
    return true;
}

static const struct {
    const char *word;
    whit_slider_kind kind;
    uint32_t values;
} kinds[] = {{"slider", WHIT_SLIDER_NUMBER, 1},
             {"color", WHIT_SLIDER_COLOR, 3},
             {"toggle", WHIT_SLIDER_TOGGLE, 1},
             {"choice", WHIT_SLIDER_CHOICE, 1}};

static bool read_slider_value(struct line *line, whit_slider *slider,
                              struct shader_slider_text *texts)
{
    switch (slider->kind) {
    case WHIT_SLIDER_NUMBER:
        return read_slider_number(line, slider);
    case WHIT_SLIDER_COLOR:
        return read_slider_color(line, slider);
    case WHIT_SLIDER_TOGGLE:
        return read_slider_toggle(line, slider);
    case WHIT_SLIDER_CHOICE:
        break;
    }
    return read_slider_choice(line, slider, texts);
}

/* Whether users' text is compiled behind this file of whit's, with its records and macros. */
static bool is_before_users(const char *path)
{
    return strcmp(path, "hook/interface.glsl") == 0 || strcmp(path, "hook/dbg.glsl") == 0 ||
           strcmp(path, "lib/records.glsl") == 0 || strcmp(path, "lib/optics.glsl") == 0;
}

/* Whether no global variable may have the name: some shader of whit's own has a function of that
   name, or a record or macro of that name stands before the user's text. */
static bool is_own(const char *name)
{
    size_t length = strlen(name);
    for (uint32_t i = 0; i < shader_source_count; ++i) {
        const char *text = shader_sources[i].text, *path = shader_sources[i].path;
        if (strcmp(path, "hook/aov.glsl") == 0 || /* not part of any kernel */
            strcmp(path, "hook/intersect.glsl") == 0 || strncmp(path, "examples/", 9) == 0)
            continue;
        for (const char *at = strstr(text, name); at; at = strstr(at + 1, name)) {
            const char *begin = at;
            if (at == text || at[-1] != ' ' || !strchr(" (\n", at[length]))
                continue;
            while (begin > text && begin[-1] != '\n')
                --begin;
            bool function = at[length] == '(' && isalpha((unsigned char)*begin);
            bool other = (at == begin + 7 && strncmp(begin, "struct ", 7) == 0) ||
                         (at == begin + 8 && strncmp(begin, "#define ", 8) == 0);
            if (function || (other && is_before_users(path)))
                return true;
        }
    }
    /* A kernel's defines; hook/dbg.glsl has its functions from a macro. */
    return strncmp(name, "HAS_", 4) == 0 || strcmp(name, "dbg") == 0;
}

static bool is_new_name(const struct line *line, const char *name)
{
    const whit_shader *shader = line->shader;
    if (scan_is_keyword(name)) {
        return complain(line, "`%s` is a word of GLSL: another name is needed", name);
    }
    if (is_own(name)) {
        return complain(line, "`%s` is a name of whit's: another name is needed", name);
    }
    for (uint32_t i = 0; i < shader->slider_count; ++i) {
        const whit_slider *slider = &shader->sliders[i];
        size_t length = strlen(slider->name);
        bool same = strcmp(slider->name, name) == 0;
        bool longer = strncmp(slider->name, name, length) == 0 && name[length] == '_';
        for (uint32_t k = 0; longer && k < slider->word_count; ++k)
            same = same || strcmp(slider->words[k], name + length + 1) == 0;
        if (same) {
            return complain(line, "there is a slider or a choice `%s` already, in line %u", name,
                            shader->slider_texts[i].line);
        }
    }
    for (uint32_t i = 0; i < shader->aov_count; ++i) {
        if (strcmp(shader->aovs[i].name, name) == 0) {
            return complain(line, "there is an aov `%s` already, in line %u", name,
                            shader->aovs[i].line);
        }
    }
    return true;
}

/* Words of a choice `mode` are constants `mode_WORD`. */
static bool are_new_words(const struct line *line, const whit_slider *slider)
{
    bool fine = true;
    for (uint32_t i = 0; fine && i < slider->word_count; ++i) {
        char name[SHADER_NAME_BYTES + SHADER_HELP_BYTES];
        snprintf(name, sizeof name, "%s_%s", slider->name, slider->words[i]);
        fine = is_new_name(line, name);
    }
    return fine;
}

/* Whether the line is followed by "vec4 NAME(Surface s)". */
static bool stands_before_function(const struct line *line, const char *name)
{
    const struct shader_file *file = &line->shader->text.files[line->file];
    const char *const words[] = {"vec4", name, "(", "Surface"};
    struct scan scan;
    scan_begin(&scan, line->end, (size_t)(file->text + file->bytes - line->end));
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i) {
        bool next = scan_next(&scan);
        if (i == 3 && next && scan_is(&scan, SCAN_WORD, "in"))
            next = scan_next(&scan);
        if (!next || strcmp(scan.text, words[i]) != 0)
            return false;
    }
    return true;
}

/* Each of these reads one annotation, from behind its first word. False: it is wrong, which was
   reported. */

static bool read_aov(struct line *line)
{
    whit_shader *shader = line->shader;
    char name[SHADER_NAME_BYTES];
    if (!next_word(line, name, sizeof name) || !is_name(name) || !ends(line))
        return complain(line, "an aov has a name of letters, digits and _, and nothing more");
    if (!is_new_name(line, name))
        return false;
    if (shader->aov_count == WHIT_LAYERS_MAX)
        return complain(line, "a file has at most %d aovs", WHIT_LAYERS_MAX);
    if (!stands_before_function(line, name))
        return complain(line, "`//@ aov %s` stands before `vec4 %s(Surface s)`, without const",
                        name, name);
    struct shader_aov *aov = &shader->aovs[shader->aov_count];
    *aov = (struct shader_aov){.file = line->file, .line = line->number};
    memcpy(aov->name, name, sizeof name);
    shader->aov_names[shader->aov_count++] = aov->name;
    return true;
}

static bool read_slider(struct line *line, size_t kind)
{
    whit_shader *shader = line->shader;
    if (shader->value_count + kinds[kind].values > SHADER_SLIDERS_MAX)
        return complain(line, "sliders have at most %d values together", SHADER_SLIDERS_MAX);
    struct shader_slider_text *texts = &shader->slider_texts[shader->slider_count];
    whit_slider *slider = &shader->sliders[shader->slider_count];
    *slider = (whit_slider){.name = texts->name, .help = texts->help, .kind = kinds[kind].kind};
    if (!next_word(line, texts->name, sizeof texts->name) || !is_name(texts->name))
        return complain(line, "a %s has a name of letters, digits and _, not `%.60s`",
                        kinds[kind].word, texts->name);
    if (!is_new_name(line, texts->name) || !read_slider_value(line, slider, texts) ||
        !are_new_words(line, slider))
        return false;
    if (has_bare_word(line) || !next_word(line, texts->help, sizeof texts->help) || !ends(line))
        return complain(line,
                        "behind the value of `%s` stands its help in quotes, up to %d bytes, and "
                        "nothing more",
                        texts->name, SHADER_HELP_BYTES - 1);
    slider->first = shader->value_count;
    texts->file = line->file;
    texts->line = line->number;
    shader->value_count += kinds[kind].values;
    shader->slider_count++;
    return true;
}

/* Parses "X0 Y0 Z0 X1 Y1 Z1 ERROR [MATERIAL]". */
static bool read_box(struct line *line)
{
    struct shader_box box = {.file = line->file, .line = line->number}, *own = &line->shader->box;
    double number, sides[6];
    for (int i = 0; i < 6; ++i) {
        if (!read_number(line, "a side of the box", i < 3 ? -1e18 : sides[i - 3], 1e18, &sides[i]))
            return false;
        *(i < 3 ? &box.lo[i] : &box.hi[i - 3]) = (float)sides[i];
    }
    if (!read_number(line, "how far answers may be from the shape", 1e-18, 1e18, &number))
        return false;
    box.error = (float)number;
    if (!next_word(line, box.material, sizeof box.material) || !ends(line))
        return complain(line, "behind the box stands the name of a material, and nothing more");
    if (own->line)
        return complain(line, "there is a box already, in line %u", own->line);
    *own = box;
    return true;
}

static bool read_fuel(struct line *line)
{
    double fuel;
    if (!read_number(line, "fuel", 1.0, SHADER_FUEL_MAX, &fuel))
        return false;
    if (floor(fuel) != fuel)
        return complain(line, "fuel is a whole number, not %g", fuel);
    if (!ends(line))
        return complain(line, "behind the fuel stands nothing more");
    if (line->shader->fuel_line)
        return complain(line, "there is a fuel already, in line %u", line->shader->fuel_line);
    line->shader->fuel = (uint32_t)fuel;
    line->shader->fuel_line = line->number;
    return true;
}

static bool read_version(struct line *line)
{
    char word[SHADER_NAME_BYTES], own[16];
    snprintf(own, sizeof own, "%d", WHIT_SHADER_VERSION);
    if (ends(line))
        return complain(line, "behind `//@ whit` stands the version, which is %s", own);
    if (!next_word(line, word, sizeof word) || strcmp(word, own) != 0)
        return complain(line,
                        "the file is for version `%.60s` of whit's functions; this whit has %s, "
                        "the first one: see docs/shaders.md",
                        word, own);
    return ends(line) || complain(line, "behind the version stands nothing more");
}

/* Checks a line `//@ test`; tests.c reads the function that follows. */
static bool read_test_mark(struct line *line)
{
    return ends(line) ||
           complain(line, "behind `//@ test` stands nothing more: the function follows in the next "
                          "line");
}

static const char *const expected_words[] = {
    [WHIT_EXPECT_IDS] = "ids",
    [WHIT_EXPECT_PIXELS] = "pixels",
    [WHIT_EXPECT_RAYS] = "rays",
    [WHIT_EXPECT_CAMERA] = "rays.camera",
    [WHIT_EXPECT_SHADOW] = "rays.shadow",
    [WHIT_EXPECT_REFLECTED] = "rays.reflected",
    [WHIT_EXPECT_REFRACTED] = "rays.refracted",
};
enum { EXPECTED_COUNT = sizeof expected_words / sizeof *expected_words };

static bool read_expected(struct line *line, uint32_t *what)
{
    char word[SHADER_NAME_BYTES], equals[4], base[8];
    bool fits = next_word(line, word, sizeof word);
    for (*what = 0; fits && *what < EXPECTED_COUNT; ++*what) {
        if (strcmp(word, expected_words[*what]) == 0)
            return next_word(line, equals, sizeof equals) && strcmp(equals, "==") == 0 &&
                   next_word(line, base, sizeof base) && strcmp(base, "base") == 0 && ends(line);
    }
    return false;
}

static bool read_expectation(struct line *line)
{
    whit_shader *shader = line->shader;
    uint32_t what;
    if (!read_expected(line, &what))
        return complain(line,
                        "an expectation is `//@ expect WHAT == base`, with ids, pixels, rays, "
                        "rays.camera, rays.shadow, rays.reflected or rays.refracted for WHAT");
    if (shader->expectation_count == SHADER_EXPECTATIONS_MAX)
        return complain(line, "a file expects at most %d things", SHADER_EXPECTATIONS_MAX);
    shader->expectations[shader->expectation_count++] =
        (whit_shader_expectation){(whit_expected)what, expected_words[what],
                                  shader->text.files[line->file].name, line->number};
    return true;
}

static bool read_line(struct line *line)
{
    static const struct {
        const char *word;
        bool (*read)(struct line *line);
    } annotations[] = {{"whit", read_version},   {"fuel", read_fuel},
                       {"aov", read_aov},        {"box", read_box},
                       {"test", read_test_mark}, {"expect", read_expectation}};
    char word[SHADER_NAME_BYTES];
    bool fits = next_word(line, word, sizeof word);
    for (size_t i = 0; fits && i < sizeof kinds / sizeof *kinds; ++i) {
        if (strcmp(word, kinds[i].word) == 0)
            return read_slider(line, i);
    }
    for (size_t i = 0; fits && i < sizeof annotations / sizeof *annotations; ++i) {
        if (strcmp(word, annotations[i].word) == 0)
            return annotations[i].read(line);
    }
    return complain(line,
                    "`//@ %.60s` is none of whit, slider, color, toggle, choice, fuel, aov, box, "
                    "test, expect",
                    word);
}

whit_result shader_annotations_read(const whit_log *log, whit_shader *shader,
                                    struct shader_errors *errors)
{
    struct shader_errors own = {0};
    bool fine = true;
    errors = errors ? errors : &own;
    for (uint32_t f = 0; f < shader->text.file_count; ++f) {
        struct scan scan;
        scan_begin(&scan, shader->text.files[f].text, shader->text.files[f].bytes);
        scan.annotations = true;
        while (!errors->more && scan_next(&scan)) {
            if (scan.kind != SCAN_ANNOTATION)
                continue;
            const char *at = scan.annotation, *end = at + strcspn(at, "\n");
            struct line line = {log, shader, errors, at, end, f, scan.token_line};
            fine = read_line(&line) && fine;
        }
    }
    return fine ? WHIT_OK : WHIT_ERROR_INPUT;
}
