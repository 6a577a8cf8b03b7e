#include "view/skies.h"

#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/path.h"
#include "view/choices.h"
#include "view/view_private.h"

static bool is_radiance(const char *path)
{
    return path_is(path, "hdr") || path_is(path, "exr") || path_is(path, "pfm");
}

bool skies_drop(struct view *view, const char *path)
{
    char why[SETTING_WHY_BYTES];
    struct settings *settings = &view->settings;
    if (!is_radiance(path))
        return false;
    if (!file_exists(path)) {
        view_say(view, "%s: there is no such file", path_name(path));
        return true;
    }
    if (!setting_read(settings_row("environment"), path, settings, why)) {
        view_say(view, "environment%s", why);
        return true;
    }
    settings->load.has_background = false; /* a background colour would hide the environment */
    view_say(view, "environment: %s", path_name(path));
    view->dirty = true;
    return true;
}

/* Adds a file to the list, unless it is there; a full list loses its oldest entry. */
static void note(struct skies *skies, const char *path)
{
    for (uint32_t i = 0; i < skies->count; ++i)
        if (strcmp(skies->paths[i], path) == 0)
            return;
    if (skies->count == SKIES_MAX)
        memmove(skies->paths[0], skies->paths[1], --skies->count * sizeof *skies->paths);
    snprintf(skies->paths[skies->count++], sizeof *skies->paths, "%s", path);
}

void skies_draw(struct view *view)
{
    struct skies *skies = &view->panels.skies;
    char *now = view->settings.environment, shown[CHOICE_WORDS];
    const char *names[SKIES_MAX + 1] = {"the file's"};
    int value = 0;
    if (now[0])
        note(skies, now);
    for (uint32_t i = 0; i < skies->count; ++i) {
        names[i + 1] = path_name(skies->paths[i]);
        if (strcmp(skies->paths[i], now) == 0)
            value = (int)i + 1;
    }
    choice_say(&view->settings, settings_row("environment"), shown, sizeof shown);
    if (ui_choice("environment", shown, names, (int)skies->count + 1, &value))
        snprintf(now, SETTING_TEXT_BYTES, "%s", value ? skies->paths[value - 1] : "");
}
