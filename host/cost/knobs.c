#include "cost/knobs.h"

#include <stdio.h>
#include <string.h>

const char *knob_change_name(enum knob_change change)
{
    static const char *const names[] = {"nothing", "shading", "hits"};
    return names[change];
}

/* ---- How settings are put into parameters ---- */

static void apply_aa(const struct knob_setting *setting, struct knob_target *target)
{
    /* Below 1: the contrast of adaptive samples. */
    target->picture.adaptive = setting->value < 1.0 ? setting->value : 0.0;
    target->picture.samples = setting->value < 1.0 ? 1 : (uint32_t)setting->value;
}

static void apply_depth(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.depth = (uint32_t)setting->value;
}

static void apply_bailout(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.bailout = setting->value;
}

static void apply_light_samples(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.light_samples = (uint32_t)setting->value;
}

static void apply_fresnel(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.schlick = setting->value == 1.0;
}

static void apply_opaque_shadows(const struct knob_setting *setting, struct knob_target *target)
{
    if (target->picture.shadows != WHIT_SHADOWS_NONE)
        target->picture.shadows = setting->value == 1.0 ? WHIT_SHADOWS_OPAQUE : WHIT_SHADOWS_TINTED;
}

static void apply_shadows(const struct knob_setting *setting, struct knob_target *target)
{
    if (setting->value == 1.0)
        target->picture.shadows = WHIT_SHADOWS_NONE;
    else if (target->picture.shadows == WHIT_SHADOWS_NONE)
        target->picture.shadows = WHIT_SHADOWS_TINTED;
}

/* Leaves the setting's effect out. */
static void apply_effect(const struct knob_setting *setting, struct knob_target *target)
{
    size_t used = strlen(target->effects);
    if (setting->value != 1.0)
        return;
    snprintf(target->effects + used, sizeof target->effects - used, "%s-%s", used ? "," : "",
             setting->effect);
    target->picture.effects = target->effects;
}

static void apply_numerics(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.numerics = (whit_numerics)setting->value;
}

static void apply_traversal(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.traversal = (whit_traversal)setting->value;
}

/* The builder, and a half more for reinsertion. */
static void apply_build(const struct knob_setting *setting, struct knob_target *target)
{
    target->accel.build = (whit_build)setting->value;
    target->accel.optimize = setting->value > (double)target->accel.build;
}

static void apply_instances(const struct knob_setting *setting, struct knob_target *target)
{
    target->accel.instances = (whit_instances)setting->value;
}

static void apply_load_path(const struct knob_setting *setting, struct knob_target *target)
{
    target->picture.load_path = value_word(values_load_path, (int)setting->value);
}

/* The reference takes the usual settings as they are. */
static void apply_arithmetic(const struct knob_setting *setting, struct knob_target *target)
{
    (void)setting;
    (void)target;
}

/* ---- The table ---- */

static const struct knob table[] = {
    {.name = "aa",
     .option = "--aa %s",
     .about = "samples of a pixel",
     .change = KNOB_SHADING,
     .level = KNOB_VIEW,
     .settings = {{"1", 1, NULL},
                  {"4", 4, NULL},
                  {"16", 16, NULL},
                  {"64", 64, NULL},
                  {"adaptive:0.05", 0.05, NULL}},
     .apply = apply_aa},
    {.name = "depth",
     .option = "--depth %s",
     .about = "most bounces of a ray",
     .change = KNOB_SHADING,
     .level = KNOB_VIEW,
     .usual = 4,
     .settings = {{"0", 0, "reflection"},
                  {"1", 1, "reflection"},
                  {"2", 2, "reflection"},
                  {"4", 4, "reflection"},
                  {"8", 8, NULL},
                  {"16", 16, "reflection"}},
     .apply = apply_depth},
    {.name = "bailout",
     .option = "--bailout %s",
     .about = "rays that can add less are not traced",
     .change = KNOB_SHADING,
     .level = KNOB_VIEW,
     .settings = {{"0.0009765625", 0x1p-10, NULL},
                  {"0", 0, "reflection"},
                  {"0.015625", 0x1p-6, "reflection"},
                  {"0.125", 0x1p-3, "reflection"}},
     .apply = apply_bailout},
    {.name = "light-samples",
     .option = "--light-samples %s",
     .about = "points of an area light that are tested",
     .change = KNOB_SHADING,
     .level = KNOB_VIEW,
     .settings = {{"16", 16, NULL},
                  {"1", 1, "area-lights"},
                  {"4", 4, "area-lights"},
                  {"64", 64, "area-lights"}},
     .apply = apply_light_samples},
    {.name = "fresnel",
     .values = values_fresnel,
     .option = "--fresnel %s",
     .about = "exact, or Schlick's approximation",
     .change = KNOB_SHADING,
     .level = KNOB_KERNEL,
     .settings = {{"", 0, NULL}, {"", 1, "fresnel"}},
     .apply = apply_fresnel},
    {.name = "tinted-shadows",
     .option = "--opaque-shadows",
     .about = "glass and blended surfaces let light through",
     .change = KNOB_SHADING,
     .level = KNOB_KERNEL,
     .settings = {{"on", 0, NULL}, {"off", 1, "tinted-shadows"}},
     .apply = apply_opaque_shadows},
    {.name = "shadows",
     .option = "--no-shadows",
     .about = "rays towards the lights",
     .change = KNOB_SHADING,
     .level = KNOB_KERNEL,
     .settings = {{"on", 0, NULL}, {"off", 1, "shadows"}},
     .apply = apply_shadows},
    {.name = "textures",
     .option = "--effects -textures",
     .about = "all maps of materials",
     .change = KNOB_SHADING,
     .level = KNOB_KERNEL,
     .settings = {{"on", 0, NULL}, {"off", 1, "textures"}},
     .apply = apply_effect},
    {.name = "normal-maps",
     .option = "--effects -normal-maps",
     .about = "normal and bump maps",
     .change = KNOB_SHADING,
     .level = KNOB_KERNEL,
     .settings = {{"on", 0, NULL}, {"off", 1, "normal-maps"}},
     .apply = apply_effect},
    {.name = "terminator",
     .option = "--effects -terminator",
     .about = "shadows start on the smooth surface",
     .change = KNOB_SHADING,
     .level = KNOB_KERNEL,
     .settings = {{"on", 0, NULL}, {"off", 1, "terminator"}},
     .apply = apply_effect},
    {.name = "numerics",
     .values = values_numerics,
     .option = "--numerics %s",
     .about = "what decides hits",
     .change = KNOB_HITS,
     .level = KNOB_KERNEL,
     .settings = {{"", WHIT_NUMERICS_WATERTIGHT, NULL},
                  {"", WHIT_NUMERICS_FAST, NULL},
                  {"", WHIT_NUMERICS_EXACT, NULL}},
     .apply = apply_numerics},
    {.name = "arithmetic",
     .option = "",
     .about = "floats of the device, or double on the CPU",
     .change = KNOB_HITS,
     .level = KNOB_DOUBLE,
     .settings = {{"float", 0, NULL}, {"double", 1, NULL}},
     .apply = apply_arithmetic},
    {.name = "instances",
     .values = values_instances,
     .option = "--instances %s",
     .about = "off: one tree over all triangles, placed and rounded",
     .change = KNOB_HITS,
     .level = KNOB_TREE,
     .settings = {{"", WHIT_INSTANCES_AUTO, NULL},
                  {"", WHIT_INSTANCES_ON, "instances"},
                  {"", WHIT_INSTANCES_OFF, "instances"}},
     .apply = apply_instances},
    {.name = "traversal",
     .values = values_traversal,
     .option = "--traversal %s",
     .about = "which of two nodes comes first",
     .change = KNOB_NOTHING,
     .level = KNOB_KERNEL,
     .settings = {{"", WHIT_TRAVERSAL_DISTANCE, NULL},
                  {"", WHIT_TRAVERSAL_SIGN, NULL},
                  {"", WHIT_TRAVERSAL_BASIC, NULL}},
     .apply = apply_traversal},
    {.name = "build",
     .values = values_build,
     .option = "--build %s",
     .about = "how trees are built",
     .change = KNOB_NOTHING,
     .level = KNOB_TREE,
     .settings = {{"", WHIT_BUILD_BINNED, NULL},
                  {"", WHIT_BUILD_MEDIAN, NULL},
                  {"", WHIT_BUILD_SWEEP, NULL},
                  {"", WHIT_BUILD_SPATIAL, NULL},
                  {"binned+opt", WHIT_BUILD_BINNED + 0.5, NULL}},
     .apply = apply_build},
    {.name = "load-path",
     .values = values_load_path,
     .option = "--load-path %s",
     .about = "how kernels read trees",
     .change = KNOB_NOTHING,
     .level = KNOB_KERNEL,
     .settings = {{"", 0, NULL}, {"", 1, NULL}, {"", 2, NULL}},
     .apply = apply_load_path},
};

const struct knob *knob_table(uint32_t *count)
{
    *count = sizeof table / sizeof table[0];
    return table;
}

uint32_t knob_find(const char *name)
{
    for (uint32_t i = 0; i < sizeof table / sizeof table[0]; ++i) {
        if (strcmp(table[i].name, name) == 0)
            return i;
    }
    return WHIT_NONE;
}

uint32_t knob_setting_count(const struct knob *knob)
{
    uint32_t count = 0;
    while (count < KNOB_SETTINGS_MOST && knob->settings[count].name)
        ++count;
    return count;
}

const char *knob_setting_name(const struct knob *knob, uint32_t setting)
{
    const struct knob_setting *s = &knob->settings[setting];
    return s->name[0] ? s->name : value_word(knob->values, (int)s->value);
}

/* ---- What a scene calls for ---- */

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
                         const char *usual_path)
{
    const struct knob_setting *wanted = &knob->settings[setting];
    whit_scene_info info;
    whit_scene_get_info(scene, &info);
    if (wanted->effect && !calls_for(scene, wanted->effect)) {
        /* Light that goes through and not back bounces too. */
        if (strcmp(wanted->effect, "reflection") != 0 || !calls_for(scene, "refraction"))
            return "the scene does not call for it";
    }
    if (knob->apply == apply_instances &&
        info.one_tree == (wanted->value == (double)WHIT_INSTANCES_OFF))
        return "it is what the scene takes by itself";
    if (knob->apply == apply_instances && !info.one_tree && info.sphere_count > 0)
        return "the scene has spheres";
    if (knob->level == KNOB_TREE && info.triangle_count == 0)
        return "the scene has no triangles";
    if (knob->apply == apply_load_path && usual_path &&
        strcmp(knob_setting_name(knob, setting), usual_path) == 0)
        return "it is what the device takes by itself";
    return NULL;
}

/* ---- Settings ---- */

void knob_target_copy(struct knob_target *to, const struct knob_target *from)
{
    *to = *from;
    if (from->picture.effects == from->effects)
        to->picture.effects = to->effects;
}

void knob_apply(const struct knob *knob, uint32_t setting, struct knob_target *target)
{
    knob->apply(&knob->settings[setting], target);
}

void knob_option(const struct knob *knob, uint32_t setting, char *text, size_t text_bytes)
{
    text[0] = 0;
    if (setting == knob->usual)
        return;
    const char *hole = strstr(knob->option, "%s");
    if (!hole)
        snprintf(text, text_bytes, "%s", knob->option);
    else
        snprintf(text, text_bytes, "%.*s%s", (int)(hole - knob->option), knob->option,
                 knob_setting_name(knob, setting));
}
