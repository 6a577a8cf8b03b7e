#include "view/choices.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/path.h"

const struct setting *choice_next(const struct setting *row)
{
    for (row = row ? row + 1 : settings_table; row->name; ++row) {
        if (row->title)
            return row;
    }
    return NULL;
}

enum choice_group choice_group(const struct setting *row)
{
    if (row->need == SETTING_NEEDS_SCENE)
        return CHOICE_SCENE;
    bool is_for_experts =
        row->change == SETTING_COST || row->change == SETTING_HITS || row->change == SETTING_PAINT;
    return is_for_experts ? CHOICE_EXPERTS : CHOICE_PICTURE;
}

static uint32_t count_of(const struct setting_value *steps)
{
    return steps ? value_count(steps) : 0;
}

static const struct setting_value *steps_of(const struct setting *row)
{
    return row->steps ? row->steps : row->values;
}

static uint32_t step_count(const struct setting *row)
{
    return count_of(steps_of(row)) + count_of(row->more_steps);
}

static const struct setting_value *step_at(const struct setting *row, uint32_t i)
{
    uint32_t first = count_of(steps_of(row));
    return i < first ? &steps_of(row)[i] : &row->more_steps[i - first];
}

/* The text of a step: the word of the option, or, if the row has steps of its own, their title. */
static const char *title_of(const struct setting *row, uint32_t i)
{
    const struct setting_value *step = step_at(row, i);
    return row->steps && step->title ? step->title : step->word;
}

uint32_t choice_words(const struct setting *row, const char *words[CHOICE_WORDS_MAX])
{
    uint32_t count = step_count(row) < CHOICE_WORDS_MAX ? step_count(row) : CHOICE_WORDS_MAX;
    for (uint32_t i = 0; i < count; ++i)
        words[i] = title_of(row, i);
    return count;
}

int choice_get(const struct settings *settings, const struct setting *row)
{
    char text[SETTING_VALUE_BYTES];
    setting_write(row, settings, 0, text);
    for (uint32_t i = 0; i < step_count(row); ++i) {
        if (strcmp(step_at(row, i)->word, text) == 0)
            return (int)i;
    }
    return -1;
}

static void set_text(struct settings *settings, const struct setting *row, const char *text)
{
    char why[SETTING_WHY_BYTES];
    setting_read(row, text, settings, why);
}

void choice_set(struct settings *settings, const struct setting *row, uint32_t step)
{
    if (step < step_count(row))
        set_text(settings, row, step_at(row, step)->word);
}

double choice_number(const struct settings *settings, const struct setting *row)
{
    char text[SETTING_VALUE_BYTES];
    if (row->kind == SETTING_OWN) /* `auto` has a number too */
        return *(const double *)((const char *)settings + row->offset);
    setting_write(row, settings, 0, text);
    return strtod(text, NULL);
}

void choice_set_number(struct settings *settings, const struct setting *row, double number)
{
    char text[40];
    number = number < row->min ? row->min : number > row->max ? row->max : number;
    setting_write_number(number, text, sizeof text);
    bool is_auto = row->kind == SETTING_OWN && number == settings->scene_exposure_ev;
    set_text(settings, row, is_auto ? "auto" : text);
    if (is_auto) /* the next key may come before settings_expose does this */
        settings->picture.exposure_ev = number;
}

void choice_turn(struct settings *settings, const struct setting *row, int by)
{
    if (step_count(row) == 0) {
        choice_set_number(settings, row, choice_number(settings, row) + by * row->step);
        return;
    }
    int count = (int)count_of(steps_of(row)), at = choice_get(settings, row);
    do
        at = at < 0 || at >= count ? 0 : (at + by + count) % count;
    while (row->key_skips && strcmp(step_at(row, (uint32_t)at)->word, row->key_skips) == 0);
    choice_set(settings, row, (uint32_t)at);
}

void choice_say(const struct settings *settings, const struct setting *row, char *text,
                size_t bytes)
{
    char value[SETTING_VALUE_BYTES];
    int at = choice_get(settings, row);
    setting_write(row, settings, 0, value);
    const char *said = at >= 0 ? title_of(row, (uint32_t)at) : value;
    if (strcmp(row->name, "environment") == 0)
        said = settings->environment[0] ? path_name(settings->environment) : "the file's";
    snprintf(text, bytes, "%s", said);
}

/* ---- Changes ---- */

static void say_scene(const struct settings *settings, char text[CHOICE_WORDS])
{
    snprintf(text, CHOICE_WORDS, "%.70s%s", path_name(settings->scene),
             settings->reload ? ", read again" : "");
}

static void say_shader(const struct settings *settings, char text[CHOICE_WORDS])
{
    snprintf(text, CHOICE_WORDS, "%.60s%s",
             settings->shader[0] ? path_name(settings->shader) : "none",
             settings->shader[0] && settings->shader_reload ? ", read again"
             : settings->stages[0]                          ? ", other stages"
                                                            : "");
}

/* Whether choice_changes lists the setting: rows with a title, and these without. */
static bool is_told(const struct setting *row)
{
    return row->title || strcmp(row->name, "effects") == 0 ||
           strcmp(row->name, "environment") == 0 || strcmp(row->name, "set") == 0;
}

uint32_t choice_changes(const struct settings *a, const struct settings *b,
                        struct choice_change changes[CHOICE_CHANGES_MAX])
{
    uint32_t count = 0;
    if (strcmp(a->scene, b->scene) != 0 || a->reload != b->reload) {
        changes[count] = (struct choice_change){.name = "scene"};
        say_scene(a, changes[count].a);
        say_scene(b, changes[count++].b);
    }
    if (!settings_same_shader(a, b)) {
        changes[count] = (struct choice_change){.name = "shader"};
        say_shader(a, changes[count].a);
        say_shader(b, changes[count++].b);
    }
    for (const struct setting *row = settings_table; row->name; ++row) {
        struct choice_change *change = &changes[count];
        if (!is_told(row) || setting_same(row, a, b) || count == CHOICE_CHANGES_MAX)
            continue;
        change->name = row->title ? row->title : row->name;
        change->painted = row->change == SETTING_PAINT;
        choice_say(a, row, change->a, CHOICE_WORDS);
        choice_say(b, row, change->b, CHOICE_WORDS);
        ++count;
    }
    return count;
}
