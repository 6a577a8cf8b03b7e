#include "view/choices.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_DEFAULT = 8, DEPTH_COUNT = 256, LIGHT_SAMPLES_DEFAULT = 16 };
static const double ADAPTIVE = 0.05;

struct choice {
    const char *name;
    const char *const *values; /* NULL: numbers */
    uint32_t count;
    int (*get)(const struct view_settings *settings);
    void (*set)(struct view_settings *settings, uint32_t value);
    void (*say)(const struct view_settings *settings, char *text, size_t bytes); /* NULL: the value
                                                                                    by name */
    bool told; /* by another choice, where settings differ */
};
#define VALUES(names) names, sizeof(names) / sizeof *(names)

static int find(const uint32_t *list, uint32_t count, uint32_t value)
{
    for (uint32_t i = 0; i < count; ++i) {
        if (list[i] == value)
            return (int)i;
    }
    return -1;
}

/* ---- What rays do ---- */

static const char *const traversals[] = {"distance", "sign", "basic"};
static const uint32_t traversal_values[] = {WHIT_TRAVERSAL_DISTANCE, WHIT_TRAVERSAL_SIGN,
                                            WHIT_TRAVERSAL_BASIC};

static int get_traversal(const struct view_settings *settings)
{
    return find(traversal_values, 3, settings->picture.traversal);
}

static void set_traversal(struct view_settings *settings, uint32_t value)
{
    settings->picture.traversal = (whit_traversal)traversal_values[value];
}

static const char *const numerics[] = {"fast", "watertight", "exact"};
static const uint32_t numerics_values[] = {WHIT_NUMERICS_FAST, WHIT_NUMERICS_WATERTIGHT,
                                           WHIT_NUMERICS_EXACT};

static int get_numerics(const struct view_settings *settings)
{
    return find(numerics_values, 3, settings->picture.numerics);
}

static void set_numerics(struct view_settings *settings, uint32_t value)
{
    settings->picture.numerics = (whit_numerics)numerics_values[value];
}

/* ---- Trees ---- */

static void set_build(struct view_settings *settings, whit_build build, const char *name)
{
    settings->trees.build = build;
    settings->trees.bins = 0;
    settings->trees.optimize = false;
    snprintf(settings->build, sizeof settings->build, "%s", name);
}

static const char *const builders[] = {"binned", "sweep", "spatial", "median"};
static const uint32_t builder_values[] = {WHIT_BUILD_BINNED, WHIT_BUILD_SWEEP, WHIT_BUILD_SPATIAL,
                                          WHIT_BUILD_MEDIAN};

static int get_builder(const struct view_settings *settings)
{
    return find(builder_values, 4, settings->trees.build);
}

static void set_builder(struct view_settings *settings, uint32_t value)
{
    set_build(settings, (whit_build)builder_values[value], value == 0 ? "" : builders[value]);
}

static void say_builder(const struct view_settings *settings, char *text, size_t bytes)
{
    if (settings->trees.build == WHIT_BUILD_NONE)
        snprintf(text, bytes, "no trees");
    else
        snprintf(text, bytes, "%s%s", settings->build[0] ? settings->build : "binned",
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

static const char *const instances[] = {"auto", "on", "off: one tree"};

static int get_instances(const struct view_settings *settings)
{
    return (int)settings->trees.instances;
}

static void set_instances(struct view_settings *settings, uint32_t value)
{
    settings->trees.instances = (whit_instances)value;
}

/* ---- Shading ---- */

static int get_depth(const struct view_settings *settings)
{
    const whit_renderer_params *p = &settings->picture;
    return p->no_bounces ? 0 : p->depth ? (int)p->depth : DEPTH_DEFAULT;
}

static void set_depth(struct view_settings *settings, uint32_t value)
{
    settings->picture.no_bounces = value == 0;
    settings->picture.depth = value == DEPTH_DEFAULT ? 0 : value;
}

static const char *const bailouts[] = {"0: every ray", "1/4096", "1/1024", "1/256", "1/64", "1/16"};
static const double bailout_values[] = {-1.0,        1.0 / 4096.0, 0.0 /* the default */,
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
    p->samples = value == 0 || value == 4 ? 0 : sample_values[value];
}

static void say_samples(const struct view_settings *settings, char *text, size_t bytes)
{
    const whit_renderer_params *p = &settings->picture;
    if (p->adaptive > 0.0)
        snprintf(text, bytes, "adaptive:%g", p->adaptive);
    else
        snprintf(text, bytes, "%u a pixel", p->samples ? p->samples : 1);
}

static const char *const light_samples[] = {"1", "4", "16", "64"};

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

static const char *const fresnels[] = {"exact", "schlick"};

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
    return settings->picture.no_shadows ? 2 : settings->picture.opaque_shadows ? 1 : 0;
}

static void set_shadows(struct view_settings *settings, uint32_t value)
{
    settings->picture.no_shadows = value == 2;
    settings->picture.opaque_shadows = value == 1;
}

/* ---- What is painted ---- */

static const char *const paints[] = {"color", "depth", "visits", "boxes", "tris", "stack"};

static int get_paint(const struct view_settings *settings)
{
    return (int)settings->paint;
}

static void set_paint(struct view_settings *settings, uint32_t value)
{
    settings->paint = value;
}

static const char *const rays[] = {"primary", "shadow", "reflected", "refracted", "all"};

static int get_rays(const struct view_settings *settings)
{
    return (int)settings->paint_rays;
}

static void set_rays(struct view_settings *settings, uint32_t value)
{
    settings->paint_rays = value;
}

/* ---- All of them ---- */

static const struct choice choices[CHOICE_COUNT] = {
    [CHOICE_TRAVERSAL] = {"traversal", VALUES(traversals), get_traversal, set_traversal, NULL,
                          false},
    [CHOICE_NUMERICS] = {"numerics", VALUES(numerics), get_numerics, set_numerics, NULL, false},
    [CHOICE_BUILDER] = {"builder", VALUES(builders), get_builder, set_builder, say_builder, false},
    [CHOICE_BINS] = {"bins", VALUES(bins), get_bins, set_bins, say_bins, true},
    [CHOICE_TREES] = {"trees", VALUES(trees), get_trees, set_trees, NULL, true},
    [CHOICE_INSTANCES] = {"instance tree", VALUES(instances), get_instances, set_instances, NULL,
                          false},
    [CHOICE_DEPTH] = {"depth", NULL, DEPTH_COUNT, get_depth, set_depth, NULL, false},
    [CHOICE_BAILOUT] = {"bail-out", VALUES(bailouts), get_bailout, set_bailout, say_bailout, false},
    [CHOICE_SAMPLES] = {"anti-aliasing", VALUES(samples), get_samples, set_samples, say_samples,
                        false},
    [CHOICE_LIGHT_SAMPLES] = {"light samples", VALUES(light_samples), get_light_samples,
                              set_light_samples, NULL, false},
    [CHOICE_FRESNEL] = {"Fresnel", VALUES(fresnels), get_fresnel, set_fresnel, NULL, false},
    [CHOICE_SHADOWS] = {"shadows", VALUES(shadows), get_shadows, set_shadows, NULL, false},
    [CHOICE_VIEW] = {"view", VALUES(paints), get_paint, set_paint, NULL, false},
    [CHOICE_VIEW_RAYS] = {"rays of costs", VALUES(rays), get_rays, set_rays, NULL, false},
};

const char *choice_name(enum choice_id id)
{
    return choices[id].name;
}

const char *const *choice_values(enum choice_id id, uint32_t *count)
{
    *count = choices[id].count;
    return choices[id].values;
}

int choice_get(const struct view_settings *settings, enum choice_id id)
{
    return choices[id].get(settings);
}

void choice_set(struct view_settings *settings, enum choice_id id, uint32_t value)
{
    if (value < choices[id].count)
        choices[id].set(settings, value);
}

void choice_turn(struct view_settings *settings, enum choice_id id, int by)
{
    int count = (int)choices[id].count, at = choices[id].get(settings);
    int next = at < 0 ? 0 : at + by;
    if (choices[id].values)
        next = (next + count) % count;
    if (next >= 0 && next < count)
        choices[id].set(settings, (uint32_t)next);
}

void choice_say(const struct view_settings *settings, enum choice_id id, char *text, size_t bytes)
{
    const struct choice *choice = &choices[id];
    int at = choice->get(settings);
    if (choice->say)
        choice->say(settings, text, bytes);
    else if (choice->values && at >= 0)
        snprintf(text, bytes, "%s", choice->values[at]);
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
