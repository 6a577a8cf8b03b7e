/* Panels for the mouse: settings, effects with their prices, files of settings. */
#ifndef VIEW_PANELS_H
#define VIEW_PANELS_H

#include <stdbool.h>
#include <stdint.h>

#include "view/prices.h"
#include "view/skies.h"

enum { VIEW_FREE_NAME = 32, STATES_MAX = 32 };

struct panels {
    bool settings, effects;
    uint64_t change;   /* number of the last engine_change that was handled */
    int pending;       /* 1 + the effect that was just switched; 0: none; -1: several */
    const void *scene; /* the scene that `prices` belong to */
    struct effect_price prices[EFFECTS_MAX]; /* measured when the user switched an effect */
    struct prices *measured; /* measures all prices while the panel is open; or NULL */
    char states[STATES_MAX][VIEW_FREE_NAME]; /* names of files of settings, newest first */
    uint32_t state_count;
    bool states_known;
    struct skies skies;
};

struct view;

void panels_draw(struct view *view); /* between ui_begin and ui_end */
/* Opens or closes the panel of effects. While it is open, prices are measured in the background. */
void panels_switch_effects(struct view *view);
/* Notes the price of an effect that was switched, once it is known. */
void panels_step(struct view *view);
/* Ctrl+S: saves the settings as options, one a line, as whit-0001.view or the next free number. */
void panels_save(struct view *view);
/* Loads a file of panels_save; the scene stays. Shows a message if it cannot be read. */
void panels_load(struct view *view, const char *path);
/* Makes the first name like "whit-0001.png" that no file has, in the folder where whit was started.
   False: files have all of them, up to whit-9999. */
bool view_free_name(const char *extension, char name[VIEW_FREE_NAME]);

#endif
