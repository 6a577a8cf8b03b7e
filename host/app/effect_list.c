/* --effects of `whit render`: names are checked before anything is loaded. */
#include <string.h>

#include "app/commands.h"

enum { NAMES_MOST = 64 };

static bool check_name(struct cli_reader *reader, const char *name, bool adds)
{
    const char *names[NAMES_MOST];
    uint32_t count = 0;
    for (; count < NAMES_MOST && (names[count] = whit_effect_name(count)); ++count) {
        if (strcmp(name, names[count]) != 0)
            continue;
        if (adds ? whit_effect_can_add(count) : whit_effect_can_remove(count))
            return true;
        return cli_misuse(reader,
                          "--effects: `%s` cannot be %s: the geometry or the camera of the "
                          "scene decides",
                          name, adds ? "added" : "left out");
    }
    const char *nearest = cli_nearest(name, names, count);
    if (nearest)
        return cli_misuse(reader, "--effects: there is no effect `%s`; did you mean `%s`?", name,
                          nearest);
    return cli_misuse(reader, "--effects: there is no effect `%s`; `whit scene` lists them", name);
}

bool effects_check(struct cli_reader *reader, const char *text)
{
    char word[64];
    bool first = true;
    for (const char *at = text; at; first = false) {
        size_t length = strcspn(at, ",");
        snprintf(word, sizeof word, "%.*s", (int)length, at);
        bool base = first && (strcmp(word, "auto") == 0 || strcmp(word, "all") == 0);
        bool adds = word[0] == '+';
        if (!base && !adds && word[0] != '-')
            return cli_misuse(reader,
                              "--effects `%s`: auto, all, or names with + or - in front, such as "
                              "+textures,-shadows",
                              text);
        if (!base && !check_name(reader, word + 1, adds))
            return false;
        at = at[length] ? at + length + 1 : NULL;
    }
    return true;
}
