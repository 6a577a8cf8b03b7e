#include "view/settings.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "cost/words.h"

/* What a renderer cannot change once it is made: another one is needed. */
static bool same_trees(const whit_accel_params *a, const whit_accel_params *b)
{
    return a->build == b->build && a->optimize == b->optimize && a->bins == b->bins &&
           a->leaf_limit == b->leaf_limit && a->spatial_alpha == b->spatial_alpha &&
           a->spatial_budget == b->spatial_budget && a->instance_build == b->instance_build &&
           a->instance_refit == b->instance_refit && a->instances == b->instances;
}

static bool same_allowed(const struct view_settings *a, const struct view_settings *b)
{
    for (uint32_t i = 0; i < VIEW_ALLOWED; ++i) {
        if (strcmp(a->allowed[i], b->allowed[i]) != 0)
            return false;
    }
    return true;
}

bool settings_same_scene(const struct view_settings *a, const struct view_settings *b)
{
    return strcmp(a->scene, b->scene) == 0 && a->reload == b->reload &&
           a->texture_limit == b->texture_limit && same_allowed(a, b);
}

bool settings_same_kernel(const struct view_settings *a, const struct view_settings *b)
{
    const whit_renderer_params *p = &a->picture, *q = &b->picture;
    bool counts = a->paint != VIEW_PAINT_COLOR, other_counts = b->paint != VIEW_PAINT_COLOR;
    return settings_same_scene(a, b) && strcmp(a->device, b->device) == 0 &&
           same_trees(&a->trees, &b->trees) && strcmp(a->effects, b->effects) == 0 &&
           p->shadows == q->shadows && p->schlick == q->schlick && p->traversal == q->traversal &&
           p->numerics == q->numerics && (p->depth == 0) == (q->depth == 0) &&
           (counts || (p->adaptive > 0.0) == (q->adaptive > 0.0)) && counts == other_counts;
}

bool settings_same_camera(const struct view_settings *a, const struct view_settings *b)
{
    const whit_renderer_params *p = &a->picture, *q = &b->picture;
    return strcmp(a->camera, b->camera) == 0 && p->time_s == q->time_s && p->width == q->width &&
           p->height == q->height;
}

bool settings_same_place(const struct view_settings *a, const struct view_settings *b)
{
    return settings_same_scene(a, b) && settings_same_camera(a, b);
}

void settings_set_camera(struct view_settings *settings, const struct view_settings *from)
{
    memcpy(settings->camera, from->camera, sizeof settings->camera);
    settings->picture.time_s = from->picture.time_s;
    settings->picture.width = from->picture.width;
    settings->picture.height = from->picture.height;
}

bool settings_same(const struct view_settings *a, const struct view_settings *b)
{
    const whit_renderer_params *p = &a->picture, *q = &b->picture;
    return settings_same_kernel(a, b) && settings_same_place(a, b) && p->samples == q->samples &&
           p->adaptive == q->adaptive && p->depth == q->depth && p->bailout == q->bailout &&
           p->light_samples == q->light_samples && a->paint == b->paint &&
           a->paint_rays == b->paint_rays && a->paint_scale == b->paint_scale &&
           a->boxes == b->boxes && a->boxes_level == b->boxes_level;
}

whit_renderer_params settings_picture(const struct view_settings *settings)
{
    whit_renderer_params params = settings->picture;
    params.camera = settings->camera[0] ? settings->camera : NULL;
    params.effects = settings->effects[0] ? settings->effects : NULL;
    params.count = settings->paint != VIEW_PAINT_COLOR;
    if (params.count) /* costs are those of a fixed pattern */
        params.adaptive = 0.0;
    return params;
}

/* ---- Words ---- */

struct words {
    char *text;
    size_t bytes, used;
    const char *separator;
};

static void put(struct words *words, const char *text)
{
    size_t length = strlen(text);
    for (size_t i = 0; i < length; ++i, ++words->used) {
        if (words->used + 1 < words->bytes)
            words->text[words->used] = text[i];
    }
}

static void put_part(void *user, const char *part)
{
    put(user, part);
}

static void put_quoted(struct words *words, const char *text)
{
    words_quote(text, put_part, words);
}

WHIT_PRINTF(3, 4)
static void option(struct words *words, const char *name, const char *format, ...)
{
    char value[VIEW_PATH];
    va_list args;
    va_start(args, format);
    vsnprintf(value, sizeof value, format, args);
    va_end(args);
    if (words->used > 0)
        put(words, words->separator);
    put(words, name);
    if (value[0]) {
        put(words, " ");
        put_quoted(words, value);
    }
}

static void tree_words(struct words *words, const struct view_settings *settings)
{
    const whit_accel_params *trees = &settings->trees;
    if (trees->build == WHIT_BUILD_NONE)
        option(words, "--no-bvh", "%s", "");
    else if (settings->build[0])
        option(words, "--build", "%s%s", settings->build, trees->optimize ? "+opt" : "");
    if (trees->leaf_limit)
        option(words, "--leaf", "%u", trees->leaf_limit);
    if (trees->instances)
        option(words, "--instances", "%s", value_word(values_instances, (int)trees->instances));
    if (trees->instance_build == WHIT_BUILD_MEDIAN)
        option(words, "--instance-build", "%s",
               value_word(values_instance_build, (int)trees->instance_build));
    if (trees->instance_refit)
        option(words, "--instance-update", "%s",
               value_word(values_instance_update, trees->instance_refit));
    if (settings->texture_limit)
        option(words, "--texture-limit", "%u", settings->texture_limit);
}

static void shading_words(struct words *words, const struct view_settings *settings)
{
    const whit_renderer_params usual = whit_renderer_defaults();
    const whit_renderer_params *p = &settings->picture;
    bool costs = settings->paint != VIEW_PAINT_COLOR; /* which are not for adaptive samples */
    if (p->adaptive > 0.0 && !costs)
        option(words, "--aa", "adaptive:%.9g", p->adaptive);
    else if (p->adaptive <= 0.0 && p->samples > 1)
        option(words, "--aa", "%u", p->samples);
    if (p->depth != usual.depth)
        option(words, "--depth", "%u", p->depth);
    if (p->bailout != usual.bailout)
        option(words, "--bailout", "%.9g", p->bailout);
    if (p->light_samples)
        option(words, "--light-samples", "%u", p->light_samples);
    if (p->schlick)
        option(words, "--fresnel", "%s", value_word(values_fresnel, p->schlick));
    if (p->shadows == WHIT_SHADOWS_OPAQUE)
        option(words, "--opaque-shadows", "%s", "");
    if (p->shadows == WHIT_SHADOWS_NONE)
        option(words, "--no-shadows", "%s", "");
    if (settings->effects[0])
        option(words, "--effects", "%s", settings->effects);
}

static void paint_words(struct words *words, const struct view_settings *settings)
{
    if (settings->paint == VIEW_PAINT_COLOR)
        return;
    option(words, "--view", "%s", value_word(values_view, (int)settings->paint));
    if (settings->paint_rays > 0 && settings->paint_rays <= WHIT_RAY_KINDS)
        option(words, "--view-rays", "%s", value_word(values_rays, (int)settings->paint_rays));
    if (settings->paint_scale > 0.0)
        option(words, "--view-scale", "%.9g", settings->paint_scale);
}

static void all_words(struct words *words, const struct view_settings *settings)
{
    const whit_renderer_params *p = &settings->picture;
    if (p->width > 0)
        option(words, "--size", "%ux%u", p->width, p->height);
    if (settings->camera[0])
        option(words, "--camera", "%s", settings->camera);
    if (p->time_s != 0.0)
        option(words, "--time", "%.17g", p->time_s);
    if (settings->device[0])
        option(words, "--device", "%s", settings->device);
    if (p->traversal != WHIT_TRAVERSAL_DISTANCE)
        option(words, "--traversal", "%s", value_word(values_traversal, (int)p->traversal));
    if (p->numerics != WHIT_NUMERICS_WATERTIGHT)
        option(words, "--numerics", "%s", value_word(values_numerics, (int)p->numerics));
    tree_words(words, settings);
    shading_words(words, settings);
    paint_words(words, settings);
}

static size_t finish(struct words *words)
{
    size_t end = words->used < words->bytes ? words->used : words->bytes - 1;
    words->text[end] = '\0';
    return words->used;
}

size_t settings_words(const struct view_settings *settings, const char *separator, char *text,
                      size_t text_bytes)
{
    struct words words = {.text = text, .bytes = text_bytes, .separator = separator};
    all_words(&words, settings);
    return finish(&words);
}

size_t settings_render_line(const struct view_settings *settings, char *text, size_t text_bytes)
{
    struct words words = {.text = text, .bytes = text_bytes, .separator = " "};
    put(&words, "whit render ");
    put_quoted(&words, settings->scene);
    for (uint32_t i = 0; i < VIEW_ALLOWED && settings->allowed[i][0]; ++i)
        option(&words, "--allow-path", "%s", settings->allowed[i]);
    all_words(&words, settings);
    put(&words, " -o picture.png");
    return finish(&words);
}
