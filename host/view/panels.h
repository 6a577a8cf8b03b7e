/* Panels that take the mouse: settings, effects with their prices, files of settings. */
#ifndef VIEW_PANELS_H
#define VIEW_PANELS_H

#include <stdbool.h>
#include <stdint.h>

#include "view/prices.h"
#include "view/skies.h"

enum { VIEW_FREE_NAME = 32, STATES_MAX = 32 };

struct panels {
    bool settings, effects;
    uint64_t change;   /* the last one that was looked at */
    int pending;       /* 1 + the effect that was switched; 0: none, -1: several */
    const void *scene; /* that the prices are of */
    struct effect_price prices[EFFECTS_MAX]; /* of switches that were made */
    struct prices *measured;                 /* of all, while their panel is open; or NULL */
    char states[STATES_MAX][VIEW_FREE_NAME]; /* files of settings, the newest first */
    uint32_t state_count;
    bool states_known;
    struct skies skies;
};

struct view;

void panels_draw(struct view *view); /* between ui_begin and ui_end */
/* Opens or closes the panel of effects: while it is open their prices are measured beside. */
void panels_switch_effects(struct view *view);
/* Notes the price of a switch once it is known. */
void panels_step(struct view *view);
/* Ctrl+S: the settings as options, one a line, in whit-0001.view and on. */
void panels_save(struct view *view);
/* What panels_save wrote: the scene stays. Says why, where it cannot be read. */
void panels_load(struct view *view, const char *path);
/* "whit-0001.png": the first that no file has, in the folder where whit was started. */
void view_free_name(const char *extension, char name[VIEW_FREE_NAME]);

#endif
