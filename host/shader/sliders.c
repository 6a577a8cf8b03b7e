/* Sliders: values that a user's file names, and that can change without a new kernel. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/color.h"
#include "base/text.h"
#include "shader/annotations.h"
#include "shader/sliders.h"

enum { DECLARATION_BYTES = 256 };

/* Declares a slider's variable; for a choice also a constant for each word, as in `mode ==
   mode_b`. */
static size_t declare_one(const whit_slider *slider, char *text, size_t bytes)
{
    static const char *const forms[] = {
        [WHIT_SLIDER_NUMBER] = "float %s = slider(%uu);\n",
        [WHIT_SLIDER_COLOR] = "vec3 %s = vec3(slider(%uu), slider(%uu), slider(%uu));\n",
        [WHIT_SLIDER_TOGGLE] = "bool %s = slider(%uu) != 0.0;\n",
        [WHIT_SLIDER_CHOICE] = "int %s = int(slider(%uu));\n",
    };
    uint32_t first = slider->first;
    int used =
        snprintf(text, bytes, forms[slider->kind], slider->name, first, first + 1, first + 2);
    for (uint32_t i = 0; i < slider->word_count; ++i)
        used += snprintf(text + used, bytes - (size_t)used, "const int %s_%s = %u;\n", slider->name,
                         slider->words[i], i);
    return (size_t)used;
}

char *shader_sliders_declare(const whit_shader *shader)
{
    const size_t each = DECLARATION_BYTES + (size_t)SHADER_WORDS_MAX * DECLARATION_BYTES;
    char *text = calloc(shader->slider_count + 1, each);
    for (uint32_t i = 0, used = 0; text && i < shader->slider_count; ++i)
        used += (uint32_t)declare_one(&shader->sliders[i], text + used, each);
    return text;
}

static bool refuse(const whit_slider *slider, const char *value, char *why, size_t why_bytes)
{
    switch (slider->kind) {
    case WHIT_SLIDER_NUMBER:
        snprintf(why, why_bytes, "%s is a number from %g to %g, not `%.60s`", slider->name,
                 (double)slider->min, (double)slider->max, value);
        break;
    case WHIT_SLIDER_COLOR:
        snprintf(why, why_bytes, "%s is a colour such as #ffcc88, not `%.60s`", slider->name,
                 value);
        break;
    case WHIT_SLIDER_TOGGLE:
        snprintf(why, why_bytes, "%s is on or off, not `%.60s`", slider->name, value);
        break;
    case WHIT_SLIDER_CHOICE:
        snprintf(why, why_bytes, "%s has no word `%.60s`; there is", slider->name, value);
        for (uint32_t i = 0; i < slider->word_count; ++i)
            text_add(why, why_bytes, "%s %s", i ? "," : "", slider->words[i]);
    }
    return false;
}

static bool read_choice(const whit_slider *slider, const char *value, float *number)
{
    for (uint32_t i = 0; i < slider->word_count; ++i) {
        if (strcmp(slider->words[i], value) == 0) {
            *number = (float)i;
            return true;
        }
    }
    return false;
}

/* Reads a value as in options; colours stay sRGB. */
static bool read_value(const whit_slider *slider, const char *value, float out[3])
{
    char *end;
    switch (slider->kind) {
    case WHIT_SLIDER_NUMBER:
        out[0] = (float)text_real(value, &end);
        return end != value && !*end && out[0] >= slider->min && out[0] <= slider->max;
    case WHIT_SLIDER_COLOR:
        return shader_color_read(value, out);
    case WHIT_SLIDER_TOGGLE:
        out[0] = strcmp(value, "on") == 0;
        return out[0] != 0.0f || strcmp(value, "off") == 0;
    case WHIT_SLIDER_CHOICE:
        break;
    }
    return read_choice(slider, value, out);
}

static void store(const whit_slider *slider, const float value[3], float *values)
{
    bool color = slider->kind == WHIT_SLIDER_COLOR;
    for (uint32_t i = 0; i < (color ? 3u : 1u); ++i)
        values[slider->first + i] = color ? (float)linear_from_srgb(value[i]) : value[i];
}

static bool refuse_name(const whit_shader *shader, const char *name, char *why, size_t why_bytes)
{
    const char *names[SHADER_SLIDERS_MAX];
    for (uint32_t i = 0; i < shader->slider_count; ++i)
        names[i] = shader->sliders[i].name;
    const char *nearest = text_nearest(name, names, shader->slider_count);
    snprintf(why, why_bytes, "%s has no slider `%.60s`%s%s%s", shader->text.files[0].name, name,
             nearest ? "; did you mean `" : "", nearest ? nearest : "", nearest ? "`?" : "");
    return false;
}

/* Reads a pair NAME=VALUE of `length` bytes. */
static bool read_pair(const whit_shader *shader, const char *text, size_t length, float *values,
                      char *why, size_t why_bytes)
{
    char pair[SHADER_NAME_BYTES + SHADER_HELP_BYTES];
    snprintf(pair, sizeof pair, "%.*s", (int)length, text);
    char *equals = strchr(pair, '=');
    float value[3] = {0};
    if (length >= sizeof pair || !equals || equals == pair) {
        snprintf(why, why_bytes, "NAME=VALUE is needed, not `%.60s`", pair);
        return false;
    }
    *equals = 0;
    for (uint32_t i = 0; i < shader->slider_count; ++i) {
        const whit_slider *slider = &shader->sliders[i];
        if (strcmp(slider->name, pair) != 0)
            continue;
        if (!read_value(slider, equals + 1, value))
            return refuse(slider, equals + 1, why, why_bytes);
        store(slider, value, values);
        return true;
    }
    return refuse_name(shader, pair, why, why_bytes);
}

bool shader_sliders_keep(const whit_shader *shader, char *text)
{
    char *to = text, *from = text;
    float values[SHADER_SLIDERS_MAX];
    while (*from) {
        char why[SHADER_REASON_BYTES];
        size_t length = strcspn(from, ",");
        if (read_pair(shader, from, length, values, why, sizeof why)) {
            if (to > text)
                *to++ = ',';
            memmove(to, from, length);
            to += length;
        }
        from += length + (from[length] == ',');
    }
    bool dropped = to < from;
    *to = '\0';
    return dropped;
}

bool shader_sliders_read(const whit_shader *shader, const char *text, bool skip,
                         float values[SHADER_SLIDERS_MAX], char *why, size_t why_bytes)
{
    memset(values, 0, SHADER_SLIDERS_MAX * sizeof *values);
    for (uint32_t i = 0; i < shader->slider_count; ++i)
        store(&shader->sliders[i], shader->sliders[i].value, values);
    while (text && *text) {
        size_t length = strcspn(text, ",");
        if (!read_pair(shader, text, length, values, why, why_bytes) && !skip)
            return false;
        text += length + (text[length] == ',');
    }
    return true;
}
