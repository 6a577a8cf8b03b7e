#include "settings/values.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"

const struct setting_value values_build[] = {
    {"binned", WHIT_BUILD_BINNED, NULL},   {"sweep", WHIT_BUILD_SWEEP, NULL},
    {"spatial", WHIT_BUILD_SPATIAL, NULL}, {"median", WHIT_BUILD_MEDIAN, NULL},
    {"none", WHIT_BUILD_NONE, NULL},       {0}};
const struct setting_value values_instances[] = {{"auto", WHIT_INSTANCES_AUTO, NULL},
                                                 {"on", WHIT_INSTANCES_ON, NULL},
                                                 {"off", WHIT_INSTANCES_OFF, NULL},
                                                 {0}};
const struct setting_value values_instance_build[] = {
    {"sah", WHIT_BUILD_BINNED, NULL}, {"median", WHIT_BUILD_MEDIAN, NULL}, {0}};
const struct setting_value values_instance_update[] = {
    {"rebuild", 0, NULL}, {"refit", 1, NULL}, {0}};
const struct setting_value values_traversal[] = {{"distance", WHIT_TRAVERSAL_DISTANCE, NULL},
                                                 {"sign", WHIT_TRAVERSAL_SIGN, NULL},
                                                 {"basic", WHIT_TRAVERSAL_BASIC, NULL},
                                                 {0}};
const struct setting_value values_numerics[] = {{"fast", WHIT_NUMERICS_FAST, NULL},
                                                {"watertight", WHIT_NUMERICS_WATERTIGHT, NULL},
                                                {"exact", WHIT_NUMERICS_EXACT, NULL},
                                                {0}};
const struct setting_value values_load_path[] = {{"auto", WHIT_LOAD_AUTO, NULL},
                                                 {"storage", WHIT_LOAD_STORAGE, NULL},
                                                 {"texel", WHIT_LOAD_TEXEL, NULL},
                                                 {0}};
const struct setting_value values_packets[] = {{"auto", WHIT_PACKETS_AUTO, NULL},
                                               {"on", WHIT_PACKETS_ON, NULL},
                                               {"off", WHIT_PACKETS_OFF, NULL},
                                               {0}};
const struct setting_value values_classes[] = {{"auto", WHIT_CLASSES_AUTO, NULL},
                                               {"one", WHIT_CLASSES_ONE, NULL},
                                               {"many", WHIT_CLASSES_MANY, NULL},
                                               {0}};
const struct setting_value values_up[] = {
    {"auto", WHIT_UP_AUTO, NULL},  {"x", WHIT_UP_X, NULL},
    {"y", WHIT_UP_Y, NULL},        {"z", WHIT_UP_Z, NULL},
    {"-x", WHIT_UP_MINUS_X, NULL}, {"-y", WHIT_UP_MINUS_Y, NULL},
    {"-z", WHIT_UP_MINUS_Z, NULL}, {0}};
const struct setting_value values_lights[] = {{"auto", WHIT_LIGHTS_AUTO, "as needed"},
                                              {"file", WHIT_LIGHTS_FILE, "the file's"},
                                              {"none", WHIT_LIGHTS_NONE, NULL},
                                              {"key", WHIT_LIGHTS_KEY, "whit's"},
                                              {0}};
const struct setting_value values_shadows[] = {{"tinted", WHIT_SHADOWS_TINTED, NULL},
                                               {"opaque", WHIT_SHADOWS_OPAQUE, NULL},
                                               {"none", WHIT_SHADOWS_NONE, NULL},
                                               {0}};
const struct setting_value values_fresnel[] = {{"exact", 0, NULL}, {"schlick", 1, NULL}, {0}};
const struct setting_value values_minification[] = {
    {"mipmap", WHIT_MINIFICATION_MIPMAP, NULL}, {"none", WHIT_MINIFICATION_NONE, NULL}, {0}};
const struct setting_value values_effects[] = {{"auto", 0, NULL}, {"all", 1, NULL}, {0}};
const struct setting_value values_samples[] = {
    {"1", 1, NULL},     {"4", 4, NULL},       {"16", 16, NULL},     {"64", 64, NULL},
    {"256", 256, NULL}, {"1024", 1024, NULL}, {"4096", 4096, NULL}, {0}};
const struct setting_value values_light_samples[] = {
    {"1", 1, NULL}, {"4", 4, NULL}, {"16", 16, NULL}, {"64", 64, NULL}, {0}};
const struct setting_value values_view[] = {{"color", 0, "colours"},
                                            {"depth", 1 + WHIT_VIEW_DEPTH, "tree depth reached"},
                                            {"visits", 1 + WHIT_VIEW_VISITS, "nodes visited"},
                                            {"boxes", 1 + WHIT_VIEW_BOXES, "box tests"},
                                            {"tris", 1 + WHIT_VIEW_TRIS, "triangle tests"},
                                            {"stack", 1 + WHIT_VIEW_STACK, "node stack"},
                                            {0}};
const struct setting_value values_rays[] = {
    {"primary", WHIT_RAY_PRIMARY, NULL},     {"shadow", WHIT_RAY_SHADOW, NULL},
    {"reflected", WHIT_RAY_REFLECTED, NULL}, {"refracted", WHIT_RAY_REFRACTED, NULL},
    {"all", WHIT_RAY_KINDS, NULL},           {0}};

uint32_t value_find(const struct setting_value *values, const char *word)
{
    for (uint32_t i = 0; values[i].word; ++i) {
        if (strcmp(values[i].word, word) == 0)
            return i;
    }
    return WHIT_NONE;
}

static const struct setting_value *find_value(const struct setting_value *values, int value)
{
    while (values->word && values->value != value)
        ++values;
    return values;
}

const char *value_word(const struct setting_value *values, int value)
{
    const struct setting_value *found = find_value(values, value);
    return found->word ? found->word : "";
}

const char *value_title(const struct setting_value *values, int value)
{
    const struct setting_value *found = find_value(values, value);
    return found->title ? found->title : value_word(values, value);
}

uint32_t value_count(const struct setting_value *values)
{
    uint32_t count = 0;
    while (values[count].word)
        ++count;
    return count;
}

const char *value_list(const struct setting_value *values, const char *separator, char *text,
                       size_t text_bytes)
{
    text[0] = '\0';
    for (uint32_t i = 0; values[i].word; ++i)
        text_add(text, text_bytes, "%s%s", i ? separator : "", values[i].word);
    return text;
}
