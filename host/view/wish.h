/* --budget-ms and --max-error in the window: settings are chosen by what they cost in the view,
   which is measured once its picture is there, beside it. */
#ifndef VIEW_WISH_H
#define VIEW_WISH_H

#include "cost/cost.h"
#include "view/prices.h"

enum wish_stage {
    WISH_NONE,      /* nothing is wished for */
    WISH_WAITS,     /* for the first whole picture */
    WISH_MEASURES,  /* beside it */
    WISH_TRIES,     /* the choice is being drawn for the first time */
    WISH_CHOSEN,    /* it was drawn */
    WISH_NO_CHOICE, /* no settings do it */
    WISH_FAILED,    /* it could not be measured */
};
const char *wish_stage_name(enum wish_stage stage); /* "measures" */

enum { WISH_TEXT = 256 };
struct wish {
    enum wish_stage stage;
    struct scene_ref *scene;           /* that it is of; only its address counts */
    struct prices *prices;             /* NULL unless it was measured */
    struct cost_kept_figures *figures; /* by which it is chosen; owned; NULL: none as yet */
    struct settings place;             /* that they are of */
    bool fresh;                        /* what is kept of earlier runs does not count */
    bool known;                        /* the choice was made by an earlier run */
    struct settings settings;          /* chosen; of the view that was measured */
    char text[WISH_TEXT];              /* the options chosen, or why there are none */
    double predicted_ms, predicted_error;
    double took_ms; /* of the first picture with them; 0: not drawn yet */
    double slower;  /* than measured, at this moment */
    int tries;
};

struct view;

void wish_begin(struct view *view);
/* Once in every turn of the loop. */
void wish_step(struct view *view);
/* Measures and chooses again, for what is in the window now. */
void wish_again(struct view *view);
/* Whether there is nothing to wait for. */
bool wish_is_still(const struct view *view);
void wish_draw(const struct view *view); /* lines of the figures */
void wish_finish(struct view *view);

#endif
