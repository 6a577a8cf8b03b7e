#include "app/check/cause.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

enum { WORDS_BYTES = 1024 };

/* ---- What is other ---- */

static bool add_change(struct cause *cause, struct cause_change change)
{
    return ARRAY_PUSH(cause->changes, cause->count, cause->capacity, change);
}

/* Adds the settings that differ as possible causes, except those that act through parts of the
   scene and those that do not change the picture. */
static bool add_settings(struct cause *cause)
{
    bool good = true;
    for (const struct setting *row = settings_table; good && row->name; ++row) {
        if (row->change > SETTING_COST && row->need < SETTING_NEEDS_SCENE &&
            strcmp(row->name, "shader") != 0 &&
            !setting_same(row, &cause->before.settings, &cause->after.settings))
            good = add_change(cause, (struct cause_change){CAUSE_SETTING, 0, row});
    }
    return good;
}

static const whit_part *find_part(const whit_part *parts, uint32_t count, const whit_part *like)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (parts[i].kind == like->kind && strcmp(parts[i].name, like->name) == 0)
            return &parts[i];
    }
    return NULL;
}

/* Adds the parts of the scene that differ. Parts that only one of the scenes has are not added:
   they come and go with WHIT_PART_OBJECTS. */
static whit_result add_parts(struct cause *cause)
{
    whit_part *now;
    uint32_t count;
    whit_result result = whit_scene_parts(cause->before.scene, &cause->parts, &cause->part_count);
    if (result == WHIT_OK)
        result = whit_scene_parts(cause->after.scene, &now, &count);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; result == WHIT_OK && i < cause->part_count; ++i) {
        const whit_part *is = find_part(now, count, &cause->parts[i]);
        if (is && is->hash != cause->parts[i].hash &&
            !add_change(cause, (struct cause_change){CAUSE_PART, i, NULL}))
            result = cli_no_memory();
    }
    whit_memory_destroy(now);
    return result;
}

static whit_result find_changes(struct cause *cause)
{
    whit_result result = add_parts(cause);
    if (result != WHIT_OK)
        return result;
    bool functions =
        job_shader_info(cause->before.shader).hash != job_shader_info(cause->after.shader).hash;
    if (!add_settings(cause) ||
        (functions && !add_change(cause, (struct cause_change){CAUSE_FUNCTIONS, 0, NULL})))
        return cli_no_memory();
    return WHIT_OK;
}

/* ---- Pictures without it ---- */

/* Fills `input` with the new input in which the settings and functions marked in `back` have their
   old values, and marks in `parts` the parts of the scene to take back. Gives whether there are any
   such parts. */
static bool take_back(const struct cause *cause, const bool *back, struct job *input, bool *parts)
{
    const struct settings *old = &cause->before.settings;
    bool any = false;
    *input = cause->after;
    for (uint32_t i = 0; i < cause->count; ++i) {
        const struct cause_change *change = &cause->changes[i];
        if (!back[i])
            continue;
        if (change->kind == CAUSE_PART) {
            any = parts[change->part] = true;
        } else if (change->kind == CAUSE_SETTING) {
            setting_copy(change->row, old, &input->settings);
        } else {
            input->shader = cause->before.shader;
            setting_copy(settings_row("shader"), old, &input->settings);
        }
    }
    return any;
}

/* Draws with some changes taken back. A mixture of old and new that cannot be made or drawn counts
   as different from the old picture, without a message. */
static whit_result draw(void *user, const bool *back, bool *same)
{
    const struct cause *cause = user;
    struct job input;
    struct drawing trial = {.renderer = NULL};
    whit_scene *mixed = NULL;
    bool *parts = array_alloc_zeroed(cause->part_count, sizeof *parts);
    if (!parts)
        return cli_no_memory();
    whit_result result = WHIT_OK;
    cli_hush(true);
    if (take_back(cause, back, &input, parts)) {
        result = whit_scene_mix(cause->before.scene, cause->after.scene, parts, &mixed);
        input.scene = mixed;
    }
    if (result == WHIT_OK)
        result = trial_draw(&trial, &input);
    cli_hush(false);
    *same = result == WHIT_OK && drawing_same(&trial, cause->was);
    trial_finish(&trial);
    whit_scene_destroy(mixed);
    free(parts);
    return trial_ends_all(result) ? result : WHIT_OK;
}

whit_result cause_find(struct cause *cause, const struct job *before, const struct drawing *was,
                       const struct job *after)
{
    *cause = (struct cause){.before = *before, .after = *after, .was = was};
    whit_result result = find_changes(cause);
    cause->search = (struct search){
        .count = cause->count, .pictures_max = CAUSE_PICTURES_MAX, .draw = draw, .user = cause};
    if (result == WHIT_OK && cause->count)
        result = search_run(&cause->search);
    return result;
}

void cause_finish(struct cause *cause)
{
    whit_memory_destroy(cause->parts);
    free(cause->changes);
    free(cause->search.cause);
    *cause = (struct cause){.count = 0};
}

/* ---- Words ---- */

static const char *value_of(const struct setting *row, const struct settings *settings,
                            char text[SETTING_VALUE_BYTES])
{
    return setting_write(row, settings, 0, text) && text[0] ? text : "none";
}

/* Writes a change, as `mesh "ball"`; `how`: also how it differs. */
static void write_change(const struct cause *cause, const struct cause_change *change, bool how,
                         FILE *to)
{
    char words[WORDS_BYTES] = "", was[SETTING_VALUE_BYTES], is[SETTING_VALUE_BYTES];
    if (change->kind == CAUSE_FUNCTIONS) {
        fprintf(to, "functions of %s",
                cause->after.shader ? cause->after.settings.shader : cause->before.settings.shader);
    } else if (change->kind == CAUSE_SETTING) {
        fprintf(to, "--%s", change->row->name);
        if (how)
            fprintf(to, " from %s to %s", value_of(change->row, &cause->before.settings, was),
                    value_of(change->row, &cause->after.settings, is));
    } else {
        const whit_part *part = &cause->parts[change->part];
        fprintf(to, part->name[0] ? "%s \"%s\"" : "%s%s", whit_part_kind_name(part->kind),
                part->name);
        if (how &&
            whit_scene_part_change(cause->before.scene, cause->after.scene, part->kind, part->name,
                                   words, sizeof words) == WHIT_OK &&
            words[0])
            fprintf(to, ", %s", words);
    }
}

static void write_set(const struct cause *cause, bool needed, FILE *to)
{
    bool first = true;
    for (uint32_t i = 0; i < cause->count; ++i) {
        if (cause->search.cause[i] != needed)
            continue;
        fputs(first ? "" : "; and ", to);
        write_change(cause, &cause->changes[i], needed, to);
        first = false;
    }
}

void cause_write(const struct cause *cause, FILE *to)
{
    const struct search *search = &cause->search;
    if (!cause->count) {
        fputs("cause: nothing of its input is other", to);
        return;
    }
    if (search->end == SEARCH_ELSEWHERE) {
        fputs("cause: none of what is other of its input", to);
        return;
    }
    fputs("cause: ", to);
    write_set(cause, true, to);
    if (search->end == SEARCH_CUT)
        fprintf(to, ", not all of which may be needed: %u pictures were drawn", search->pictures);
    if (search->cause_count == cause->count)
        return;
    fputs("; input changed, picture same: ", to);
    write_set(cause, false, to);
}
