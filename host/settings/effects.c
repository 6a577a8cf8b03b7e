/* Reads and writes the values of --effects: "auto", "all", "+NAME,-NAME" or "all,-NAME". */
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "settings/settings.h"

enum { NAMES_MAX = 64 };

/* Adds effect `index` to the kernels, or removes it; false, with the reason, where that is not
   possible. */
static bool switch_effect(uint32_t index, bool adds, whit_renderer_params *picture, char *why)
{
    uint64_t bit = UINT64_C(1) << index;
    const char *name = whit_effect_name(index);
    if (!(adds ? whit_effect_can_add(index) : whit_effect_can_remove(index)))
        return setting_refuse(
            why, ": `%s` cannot be %s: the geometry or the camera of the scene decides", name,
            adds ? "added" : "left out");
    if ((adds ? picture->effects_removed : picture->effects_added) & bit)
        return setting_refuse(why, ": `%s` is both added and left out", name);
    *(adds ? &picture->effects_added : &picture->effects_removed) |= bit;
    return true;
}

static bool read_name(const char *name, bool adds, whit_renderer_params *picture, char *why)
{
    const char *names[NAMES_MAX];
    uint32_t count = 0;
    for (; count < NAMES_MAX && (names[count] = whit_effect_name(count)); ++count) {
        if (strcmp(name, names[count]) == 0)
            return switch_effect(count, adds, picture, why);
    }
    const char *nearest = text_nearest(name, names, count);
    if (nearest)
        return setting_refuse(why, ": there is no effect `%s`; did you mean `%s`?", name, nearest);
    return setting_refuse(why, ": there is no effect `%s`; `whit scene` lists them", name);
}

static void take_over(const whit_renderer_params *from, whit_renderer_params *picture)
{
    picture->all_effects = from->all_effects;
    picture->effects_added = from->effects_added;
    picture->effects_removed = from->effects_removed;
}

bool effects_read(const char *text, whit_renderer_params *picture, char why[SETTING_WHY_BYTES])
{
    whit_renderer_params read = {.all_effects = false};
    char word[64];
    bool first = true;
    for (const char *at = text; at; first = false) {
        size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        bool all = first && strcmp(word, "all") == 0;
        bool base = all || (first && strcmp(word, "auto") == 0);
        read.all_effects |= all;
        if (!base && word[0] != '+' && word[0] != '-')
            return setting_refuse(why,
                                  " `%s`: auto, all, or names with + or - in front, such as "
                                  "+textures,-shadows",
                                  text);
        if (!base && !read_name(word + 1, word[0] == '+', &read, why))
            return false;
        at = at[length] ? at + length + 1 : NULL;
    }
    take_over(&read, picture);
    return true;
}

void effects_write(const whit_renderer_params *picture, char text[SETTING_VALUE_BYTES])
{
    size_t used =
        (size_t)snprintf(text, SETTING_VALUE_BYTES, "%s", picture->all_effects ? "all" : "");
    for (uint32_t i = 0; whit_effect_name(i); ++i) {
        bool adds = picture->effects_added >> i & 1, removes = picture->effects_removed >> i & 1;
        if ((adds || removes) && used < SETTING_VALUE_BYTES)
            used += (size_t)snprintf(text + used, SETTING_VALUE_BYTES - used, "%s%c%s",
                                     used ? "," : "", adds ? '+' : '-', whit_effect_name(i));
    }
    if (used == 0)
        snprintf(text, SETTING_VALUE_BYTES, "auto");
}

void effects_set(whit_renderer_params *picture, uint32_t index, bool called, bool on)
{
    uint64_t bit = UINT64_C(1) << index;
    bool base = picture->all_effects || called;
    picture->effects_added &= ~bit;
    picture->effects_removed &= ~bit;
    if (base != on) /* only a difference from what `base` gives is written */
        *(on ? &picture->effects_added : &picture->effects_removed) |= bit;
}
