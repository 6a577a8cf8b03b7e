/* Environment maps in place of the scene's sky: those that were named or dropped. */
#ifndef VIEW_SKIES_H
#define VIEW_SKIES_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/settings.h"

enum { SKIES_MAX = 8 };
struct skies {
    char paths[SKIES_MAX][SETTING_TEXT_BYTES]; /* the last ones, oldest first */
    uint32_t count;
};

struct view;

/* Takes a file of radiance (.hdr, .exr, .pfm) as the sky; false: it is no such file. */
bool skies_drop(struct view *view, const char *path);
/* Draws a row of the panel of settings. */
void skies_draw(struct view *view);

#endif
