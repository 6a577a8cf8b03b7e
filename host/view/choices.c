#include "view/choices.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_COUNT = 256, LIGHT_SAMPLES_DEFAULT = 16 };
static const double ADAPTIVE = 0.05;

struct choice {
    const char *name;
    const struct setting_value *list; /* NULL: `words`, or numbers */
    const char *const *words;
    uint32_t count; /* of words or numbers */
    size_t
        field; /* of an enumeration in struct view_settings, where there is a list and no `get` */
    int (*get)(const struct view_settings *settings);
    void (*set)(struct view_settings *settings, uint32_t value);
    /* NULL: the value in a word. */
    void (*say)(const struct view_settings *settings, char *text, size_t bytes);
    bool told; /* by another choice, where settings differ */
};
#define WORDS(names)  .words = (names), .count = sizeof(names) / sizeof *(names)
#define FIELD(member) .field = offsetof(struct view_settings, member)
_Static_assert(sizeof(whit_numerics) == sizeof(uint32_t), "enumerations are copied as words");

static int find(const uint32_t *list, uint32_t count, uint32_t value)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (list[i] == value)
            return (int)i;
    }
    return -1;
}

/* ---- Trees ---- */

static void set_build(struct view_settings *settings, whit_build build, const char *name)
{
    settings->trees.build = build;
    settings->trees.bins = 0;
    settings->trees.optimize = false;
    snprintf(settings->build, sizeof settings->build, "%s", name);
}

static int get_builder(const struct view_settings *settings)
{
    return settings->trees.build == WHIT_BUILD_NONE
               ? -1
               : (int)value_place(values_build, (int)settings->trees.build);
}

static void set_builder(struct view_settings *settings, uint32_t value)
{
    set_build(settings, (whit_build)values_build[value].value,
              value == 0 ? "" : values_build[value].word);
}

static void say_builder(const struct view_settings *settings, char *text, size_t bytes)
{
    if (settings->trees.build == WHIT_BUILD_NONE)
        snprintf(text, bytes, "no trees");
    else
        snprintf(text, bytes, "%s%s", settings->build[0] ? settings->build : values_build[0].word,
                 settings->trees.optimize ? "+opt" : "");
}

static const char *const bins[] = {"by itself", "4", "7", "8", "16", "32", "64", "128", "256"};
static const uint32_t bins_values[] = {0, 4, 7, 8, 16, 32, 64, 128, 256};

static int get_bins(const struct view_settings *settings)
{
    if (settings->trees.build != WHIT_BUILD_BINNED)
        return -1;
    return find(bins_values, sizeof bins_values / sizeof *bins_values, settings->trees.bins);
}

static void set_bins(struct view_settings *settings, uint32_t value)
{
    char name[32] = "";
    if (value > 0)
        snprintf(name, sizeof name, "binned:%u", bins_values[value]);
    set_build(settings, WHIT_BUILD_BINNED, name);
    settings->trees.bins = bins_values[value];
}

static void say_bins(const struct view_settings *settings, char *text, size_t bytes)
{
    if (settings->trees.build != WHIT_BUILD_BINNED)
        snprintf(text, bytes, "not binned");
    else if (settings->trees.bins)
        snprintf(text, bytes, "%u", settings->trees.bins);
    else
        snprintf(text, bytes, "%s", bins[0]);
}

static const char *const trees[] = {"on", "off"};

static int get_trees(const struct view_settings *settings)
{
    return settings->trees.build == WHIT_BUILD_NONE;
}

static void set_trees(struct view_settings *settings, uint32_t value)
{
    set_build(settings, value ? WHIT_BUILD_NONE : WHIT_BUILD_BINNED, "");
}

/* ---- Shading ---- */

static int get_depth(const struct view_settings *settings)
{
    return (int)settings->picture.depth;
}

static void set_depth(struct view_settings *settings, uint32_t value)
{
    settings->picture.depth = value;
}

static const char *const bailouts[] = {"0: every ray", "1/4096", "1/1024", "1/256", "1/64", "1/16"};
static const double bailout_values[] = {0.0,         1.0 / 4096.0, WHIT_BAILOUT_DEFAULT,
                                        1.0 / 256.0, 1.0 / 64.0,   1.0 / 16.0};

static int get_bailout(const struct view_settings *settings)
{
    for (int i = 0; i < 6; ++i) {
        if (settings->picture.bailout == bailout_values[i])
            return i;
    }
    return -1;
}

static void set_bailout(struct view_settings *settings, uint32_t value)
{
    settings->picture.bailout = bailout_values[value];
}

static void say_bailout(const struct view_settings *settings, char *text, size_t bytes)
{
    int at = get_bailout(settings);
    if (at >= 0)
        snprintf(text, bytes, "%s", bailouts[at]);
    else
        snprintf(text, bytes, "%g", settings->picture.bailout);
}

static const char *const samples[] = {"1 a pixel", "4 a pixel", "16 a pixel", "64 a pixel",
                                      "adaptive"};
static const uint32_t sample_values[] = {1, 4, 16, 64};

static int get_samples(const struct view_settings *settings)
{
    const whit_renderer_params *p = &settings->picture;
    return p->adaptive > 0.0 ? 4 : find(sample_values, 4, p->samples ? p->samples : 1);
}

static void set_samples(struct view_settings *settings, uint32_t value)
{
    whit_renderer_params *p = &settings->picture;
    p->adaptive = value == 4 ? ADAPTIVE : 0.0;
    p->samples = sample_values[value % 4];
}

static void say_samples(const struct view_settings *settings, char *text, size_t bytes)
{
    const whit_renderer_params *p = &settings->picture;
    if (p->adaptive > 0.0)
        snprintf(text, bytes, "adaptive:%g", p->adaptive);
    else
        snprintf(text, bytes, "%u a pixel", p->samples ? p->samples : 1);
}

static int get_light_samples(const struct view_settings *settings)
{
    uint32_t count = settings->picture.light_samples;
    return find(sample_values, 4, count ? count : LIGHT_SAMPLES_DEFAULT);
}

static void set_light_samples(struct view_settings *settings, uint32_t value)
{
    uint32_t count = sample_values[value];
    settings->picture.light_samples = count == LIGHT_SAMPLES_DEFAULT ? 0 : count;
}

static int get_fresnel(const struct view_settings *settings)
{
    return settings->picture.schlick;
}

static void set_fresnel(struct view_settings *settings, uint32_t value)
{
    settings->picture.schlick = value != 0;
}

static const char *const shadows[] = {"through glass", "opaque", "none"};

static int get_shadows(const struct view_settings *settings)
{
    return (int)settings->picture.shadows;
}

static void set_shadows(struct view_settings *settings, uint32_t value)
{
    settings->picture.shadows = (whit_shadows)value;
}

/* ---- All of them ---- */

static const struct choice choices[CHOICE_COUNT] = {
    [CHOICE_TRAVERSAL] = {"traversal", .list = values_traversal, FIELD(picture.traversal)},
    [CHOICE_NUMERICS] = {"numerics", .list = values_numerics, FIELD(picture.numerics)},
    [CHOICE_BUILDER] = {"builder", .list = values_build, .get = get_builder, .set = set_builder,
                        .say = say_builder},
    [CHOICE_BINS] = {"bins", WORDS(bins), .get = get_bins, .set = set_bins, .say = say_bins,
                     .told = true},
    [CHOICE_TREES] = {"trees", WORDS(trees), .get = get_trees, .set = set_trees, .told = true},
    [CHOICE_INSTANCES] = {"instance tree", .list = values_instances, FIELD(trees.instances)},
    [CHOICE_DEPTH] = {"depth", .count = DEPTH_COUNT, .get = get_depth, .set = set_depth},
    [CHOICE_BAILOUT] = {"bail-out", WORDS(bailouts), .get = get_bailout, .set = set_bailout,
                        .say = say_bailout},
    [CHOICE_SAMPLES] = {"anti-aliasing", WORDS(samples), .get = get_samples, .set = set_samples,
                        .say = say_samples},
    [CHOICE_LIGHT_SAMPLES] = {"light samples", .list = values_light_samples,
                              .get = get_light_samples, .set = set_light_samples},
    [CHOICE_FRESNEL] = {"Fresnel", .list = values_fresnel, .get = get_fresnel, .set = set_fresnel},
    [CHOICE_SHADOWS] = {"shadows", WORDS(shadows), .get = get_shadows, .set = set_shadows},
    [CHOICE_VIEW] = {"view", .list = values_view, FIELD(paint)},
    [CHOICE_VIEW_RAYS] = {"rays of costs", .list = values_rays, FIELD(paint_rays)},
};

static uint32_t count_of(const struct choice *choice)
{
    return choice->list ? value_count(choice->list) : choice->count;
}

const char *choice_name(enum choice_id id)
{
    return choices[id].name;
}

uint32_t choice_words(enum choice_id id, const char *words[CHOICE_WORDS_MOST])
{
    const struct choice *choice = &choices[id];
    uint32_t count = choice->list || choice->words ? count_of(choice) : 0;
    for (uint32_t i = 0; i < count; ++i)
        words[i] = choice->list ? choice->list[i].word : choice->words[i];
    return count;
}

uint32_t choice_count(enum choice_id id)
{
    return count_of(&choices[id]);
}

int choice_get(const struct view_settings *settings, enum choice_id id)
{
    const struct choice *choice = &choices[id];
    uint32_t value;
    if (choice->get)
        return choice->get(settings);
    memcpy(&value, (const char *)settings + choice->field, sizeof value);
    return (int)value_place(choice->list, (int)value);
}

void choice_set(struct view_settings *settings, enum choice_id id, uint32_t value)
{
    const struct choice *choice = &choices[id];
    if (value >= count_of(choice))
        return;
    if (choice->set)
        choice->set(settings, value);
    else
        memcpy((char *)settings + choice->field, &choice->list[value].value, sizeof value);
}

void choice_turn(struct view_settings *settings, enum choice_id id, int by)
{
    const struct choice *choice = &choices[id];
    int count = (int)count_of(choice), at = choice_get(settings, id);
    int next = at < 0 ? 0 : at + by;
    if (choice->list || choice->words)
        next = (next + count) % count;
    if (next >= 0)
        choice_set(settings, id, (uint32_t)next);
}

void choice_say(const struct view_settings *settings, enum choice_id id, char *text, size_t bytes)
{
    const struct choice *choice = &choices[id];
    int at = choice_get(settings, id);
    if (choice->say)
        choice->say(settings, text, bytes);
    else if (choice->list && at >= 0)
        snprintf(text, bytes, "%s", choice->list[at].word);
    else if (choice->words && at >= 0)
        snprintf(text, bytes, "%s", choice->words[at]);
    else
        snprintf(text, bytes, "%d", at);
}

static void add_change(struct choice_change *changes, uint32_t *count, enum choice_id id,
                       const char *name)
{
    if (strcmp(changes[*count].a, changes[*count].b) == 0)
        return;
    changes[*count].id = id;
    changes[*count].name = name;
    ++*count;
}

static void say_effects(const struct view_settings *settings, char text[CHOICE_WORDS])
{
    snprintf(text, CHOICE_WORDS, "%.90s", settings->effects[0] ? settings->effects : "auto");
}

static void say_scene(const struct view_settings *settings, char text[CHOICE_WORDS])
{
    const char *slash = strrchr(settings->scene, '/');
    snprintf(text, CHOICE_WORDS, "%.70s%s", slash ? slash + 1 : settings->scene,
             settings->reload ? ", read again" : "");
}

uint32_t choice_changes(const struct view_settings *a, const struct view_settings *b,
                        struct choice_change changes[CHOICE_CHANGES_MOST])
{
    uint32_t count = 0;
    if (!settings_same_scene(a, b)) {
        say_scene(a, changes[count].a);
        say_scene(b, changes[count].b);
        add_change(changes, &count, CHOICE_COUNT, "scene");
    }
    for (enum choice_id id = 0; id < CHOICE_COUNT; ++id) {
        if (choices[id].told)
            continue;
        choice_say(a, id, changes[count].a, CHOICE_WORDS);
        choice_say(b, id, changes[count].b, CHOICE_WORDS);
        add_change(changes, &count, id, choices[id].name);
    }
    say_effects(a, changes[count].a);
    say_effects(b, changes[count].b);
    add_change(changes, &count, CHOICE_COUNT, "effects");
    return count;
}
