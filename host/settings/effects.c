/* What --effects takes. */
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "settings/settings.h"

enum { NAMES_MAX = 64 };

static bool check_name(const char *name, bool adds, char *why)
{
    const char *names[NAMES_MAX];
    uint32_t count = 0;
    for (; count < NAMES_MAX && (names[count] = whit_effect_name(count)); ++count) {
        if (strcmp(name, names[count]) != 0)
            continue;
        if (adds ? whit_effect_can_add(count) : whit_effect_can_remove(count))
            return true;
        return setting_refuse(
            why, ": `%s` cannot be %s: the geometry or the camera of the scene decides", name,
            adds ? "added" : "left out");
    }
    const char *nearest = text_nearest(name, names, count);
    if (nearest)
        return setting_refuse(why, ": there is no effect `%s`; did you mean `%s`?", name, nearest);
    return setting_refuse(why, ": there is no effect `%s`; `whit scene` lists them", name);
}

bool effects_check(const char *text, char why[SETTING_WHY_BYTES])
{
    char word[64];
    bool first = true;
    for (const char *at = text; at; first = false) {
        size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        bool base = first && (strcmp(word, "auto") == 0 || strcmp(word, "all") == 0);
        bool adds = word[0] == '+';
        if (!base && !adds && word[0] != '-')
            return setting_refuse(why,
                                  " `%s`: auto, all, or names with + or - in front, such as "
                                  "+textures,-shadows",
                                  text);
        if (!base && !check_name(word + 1, adds, why))
            return false;
        at = at[length] ? at + length + 1 : NULL;
    }
    return true;
}
