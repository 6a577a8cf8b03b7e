#include "cost/knobs.h"

#include <stdio.h>
#include <string.h>

/* ---- The table ---- */

/* clang-format off */
#define VALUES(...) .count = sizeof((struct knob_setting[]){__VA_ARGS__}) / sizeof(struct knob_setting), \
                    .settings = {__VA_ARGS__}
/* clang-format on */
#define EFFECT(name_)                                                                              \
    {                                                                                              \
        .name = name_, .setting = "effects",                                                       \
        VALUES({.text = "auto", .name = "on"},                                                     \
               {.text = "-" name_, .effect = name_, .name = "off"})                                \
    }

const struct knob knob_table[] = {
    {.name = "aa",
     .setting = "aa",
     VALUES({.text = "1"}, {.text = "4"}, {.text = "16"}, {.text = "64"},
            {.text = "adaptive:0.05"})},
    {.name = "depth",
     .setting = "depth",
     .usual = 4,
     VALUES({"0", .effect = "reflection"}, {"1", .effect = "reflection"},
            {"2", .effect = "reflection"}, {"4", .effect = "reflection"}, {.text = "8"},
            {"16", .effect = "reflection"})},
    {.name = "bailout",
     .setting = "bailout",
     VALUES({.text = "0.0009765625"}, {"0", .effect = "reflection"},
            {"0.015625", .effect = "reflection"}, {"0.125", .effect = "reflection"})},
    {.name = "light-samples",
     .setting = "light-samples",
     VALUES({.text = "16"}, {"1", .effect = "area-lights"}, {"4", .effect = "area-lights"},
            {"64", .effect = "area-lights"})},
    {.name = "fresnel",
     .setting = "fresnel",
     VALUES({.value = 0}, {.value = 1, .effect = "fresnel"})},
    {.name = "shadows",
     .setting = "shadows",
     VALUES({.value = WHIT_SHADOWS_TINTED},
            {.value = WHIT_SHADOWS_OPAQUE, .effect = "tinted-shadows"},
            {.value = WHIT_SHADOWS_NONE, .effect = "shadows"})},
    {.name = "minification",
     .setting = "minification",
     VALUES({.value = WHIT_MINIFICATION_MIPMAP},
            {.value = WHIT_MINIFICATION_NONE, .effect = "textures"})},
    {.name = "portable", .setting = "portable", VALUES({.value = 0}, {.value = 1})},
    EFFECT("textures"), /* all maps of materials */
    EFFECT("normal-maps"),
    EFFECT("terminator"),
    {.name = "numerics",
     .setting = "numerics",
     VALUES({.value = WHIT_NUMERICS_WATERTIGHT}, {.value = WHIT_NUMERICS_FAST},
            {.value = WHIT_NUMERICS_EXACT})},
    {.name = "arithmetic", VALUES({.text = "float"}, {.text = "double"})},
    {.name = "instances",
     .setting = "instances",
     VALUES({.value = WHIT_INSTANCES_AUTO}, {.value = WHIT_INSTANCES_ON, .effect = "instances"},
            {.value = WHIT_INSTANCES_OFF, .effect = "instances"})},
    {.name = "traversal",
     .setting = "traversal",
     VALUES({.value = WHIT_TRAVERSAL_DISTANCE}, {.value = WHIT_TRAVERSAL_SIGN},
            {.value = WHIT_TRAVERSAL_BASIC})},
    {.name = "build",
     .setting = "build",
     VALUES({.value = WHIT_BUILD_BINNED}, {.value = WHIT_BUILD_MEDIAN}, {.value = WHIT_BUILD_SWEEP},
            {.value = WHIT_BUILD_SPATIAL}, {.text = "binned+opt"})},
    {.name = "load-path",
     .setting = "load-path",
     VALUES({.value = WHIT_LOAD_AUTO}, {.value = WHIT_LOAD_STORAGE}, {.value = WHIT_LOAD_TEXEL})},
};

uint32_t knob_find(const char *name)
{
    for (uint32_t i = 0; i < KNOBS; ++i) {
        if (strcmp(knob_table[i].name, name) == 0)
            return i;
    }
    return WHIT_NONE;
}

static const char *text_of(const struct knob *knob, uint32_t setting)
{
    const struct knob_setting *s = &knob->settings[setting];
    return s->text ? s->text : value_word(settings_row(knob->setting)->values, s->value);
}

const char *knob_setting_name(const struct knob *knob, uint32_t setting)
{
    const char *name = knob->settings[setting].name;
    return name ? name : text_of(knob, setting);
}

uint32_t knob_find_setting(const struct knob *knob, const char *name)
{
    for (uint32_t s = 0; s < knob->count; ++s) {
        if (strcmp(knob_setting_name(knob, s), name) == 0)
            return s;
    }
    return WHIT_NONE;
}

const char *knob_change_name(enum setting_change change)
{
    return change == SETTING_HITS ? "hits" : change == SETTING_LIGHT ? "shading" : "nothing";
}

enum setting_change knob_change(const struct knob *knob)
{
    return knob->setting ? settings_row(knob->setting)->change : SETTING_HITS;
}

enum knob_level knob_level(const struct knob *knob)
{
    return knob->setting ? (enum knob_level)settings_row(knob->setting)->need : KNOB_DOUBLE;
}

uint64_t knobs_of_light(void)
{
    uint64_t bits = 0;
    for (uint32_t i = 0; i < KNOBS; ++i)
        bits |= (uint64_t)(knob_change(&knob_table[i]) == SETTING_LIGHT) << i;
    return bits;
}

/* ---- What a scene calls for ---- */

/* One tree over more copies of triangles takes longer to build, again and again, than a report may
   take, and nothing stops a build. */
enum { COPIES_MAX = 1000000 };

static bool calls_for(const whit_scene *scene, const char *wanted)
{
    const char *name;
    for (uint32_t i = 0; (name = whit_effect_name(i)); ++i) {
        whit_effect_info effect;
        whit_scene_get_effect(scene, i, &effect);
        if (strcmp(name, wanted) == 0)
            return effect.called;
    }
    return false;
}

const char *knob_absence(const struct knob *knob, uint32_t setting, const whit_scene *scene,
                         whit_load_path usual_path)
{
    const struct knob_setting *wanted = &knob->settings[setting];
    whit_scene_info info;
    whit_scene_get_info(scene, &info);
    if (wanted->effect && !calls_for(scene, wanted->effect)) {
        /* Refracted rays are bounces too, in scenes without reflection. */
        if (strcmp(wanted->effect, "reflection") != 0 || !calls_for(scene, "refraction"))
            return "the scene does not call for it";
    }
    if (strcmp(knob->name, "instances") == 0 &&
        info.one_tree == (wanted->value == WHIT_INSTANCES_OFF))
        return "it is what the scene takes by itself";
    if (strcmp(knob->name, "instances") == 0 && !info.one_tree && info.sphere_count > 0)
        return "the scene has spheres";
    if (strcmp(knob->name, "instances") == 0 && !info.one_tree &&
        info.triangle_count > info.mesh_triangle_count + COPIES_MAX)
        return "it would copy over a million triangles";
    if (knob_level(knob) == KNOB_TREE && info.triangle_count == 0)
        return "the scene has no triangles";
    if (strcmp(knob->name, "load-path") == 0 && wanted->value == (int)usual_path)
        return "it is what the device takes by itself";
    return NULL;
}

/* ---- Settings ---- */

void knob_apply(const struct knob *knob, uint32_t setting, struct settings *settings)
{
    const whit_renderer_params before = settings->picture;
    char why[SETTING_WHY_BYTES];
    if (!knob->setting)
        return;
    setting_read(settings_row(knob->setting), text_of(knob, setting), settings, why);
    if (strcmp(knob->setting, "effects") == 0) { /* adds to effects that were removed before */
        settings->picture.all_effects |= before.all_effects;
        settings->picture.effects_added |=
            before.effects_added & ~settings->picture.effects_removed;
        settings->picture.effects_removed |= before.effects_removed;
    }
}

void knob_option(const struct knob *knob, uint32_t setting, char *text, size_t text_bytes)
{
    struct settings settings = settings_usual();
    if (setting != knob->usual)
        knob_apply(knob, setting, &settings);
    settings_write(&settings, SETTINGS_LINE, " ", text, text_bytes);
}
