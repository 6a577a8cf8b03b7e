/* --budget-ms and --max-error in the window: settings are chosen by their costs in this view, which
   are measured in the background once its picture is drawn. */
#ifndef VIEW_WISH_H
#define VIEW_WISH_H

#include "cost/cost.h"
#include "view/prices.h"

enum wish_stage {
    WISH_NONE,      /* neither option is given */
    WISH_WAITS,     /* waits for the first whole picture */
    WISH_MEASURES,  /* costs are being measured */
    WISH_TRIES,     /* the chosen settings are drawn for the first time */
    WISH_CHOSEN,    /* the chosen settings were drawn */
    WISH_NO_CHOICE, /* no settings meet the wish */
    WISH_FAILED,    /* measuring failed */
};
const char *wish_stage_name(enum wish_stage stage); /* "measures" */

enum { WISH_TEXT = 256 };
struct wish {
    enum wish_stage stage;
    struct scene_ref *scene;           /* the scene that was measured; only compared by address */
    struct prices *prices;             /* NULL: nothing was measured */
    struct cost_kept_figures *figures; /* costs to choose by; owned; NULL: none yet */
    struct settings place;             /* settings of the picture that `figures` belong to */
    bool fresh;                        /* figures of earlier runs are not used */
    bool known;                        /* the choice is that of an earlier run */
    struct settings settings;          /* chosen settings, with the measured view */
    char text[WISH_TEXT];              /* the chosen options, or why there are none */
    double predicted_ms, predicted_error;
    double took_ms; /* time of the first picture with them; 0: not drawn yet */
    double slower;  /* factor by which pictures take longer now than measured */
    int tries;
};

struct view;

void wish_begin(struct view *view);
/* Call it in each iteration of the viewer's loop. */
void wish_step(struct view *view);
/* Measures and chooses again, for the picture in the window; `fresh`: without figures of earlier
   runs. */
void wish_again(struct view *view, bool fresh);
/* Whether there is nothing to wait for. */
bool wish_is_still(const struct view *view);
void wish_draw(const struct view *view); /* draws the wish's lines of the HUD */
void wish_finish(struct view *view);

#endif
