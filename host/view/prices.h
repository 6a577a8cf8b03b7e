/* The price list of the picture in the window: what each switch would cost here, and what it would
   get wrong. Measured in a thread of its own, on a device of its own, beside the window. */
#ifndef VIEW_PRICES_H
#define VIEW_PRICES_H

#include "cost/cost.h"
#include "view/price_strip.h"
#include "view/session.h"

struct prices;

enum { EFFECTS_MAX = 64 };
/* What switching one effect changes: the pictures before and after it. */
struct effect_price {
    bool known, added;
    double before_ms, after_ms;
    uint64_t other_colors, pixels;
};

struct prices_params {
    const struct settings *settings;
    struct scene_ref *scene;
    double seconds;           /* that it may take, roughly */
    uint64_t knobs;           /* bits of knob_table; 0: all */
    bool strip;               /* with the pictures of cost_strip */
    bool effects;             /* those of effects, in place of knobs; `seconds` says nothing */
    void (*wake)(void *user); /* from the thread, when there is more to see */
    void *wake_user;
};
/* NULL where memory or threads run out. */
struct prices *prices_start(const struct prices_params *params);
/* Stops it, waits, frees; NULL is fine. */
void prices_stop(struct prices *prices);
/* Stops it without waiting: prices_stop does not wait any more once it is still. */
void prices_cancel(struct prices *prices);

enum { PRICES_TEXT = 160 };
struct prices_state {
    bool finished;
    double done, seconds_left;        /* 0..1 */
    char what[PRICES_TEXT];           /* that is measured; where it failed: why */
    const struct cost_report *report; /* borrowed until prices_stop; NULL until finished */
    const struct price_strip *strip;  /* likewise */
    struct settings settings;         /* that it is of */
};
/* Whether there is more to see than at the last call. */
bool prices_have_news(struct prices *prices);
bool prices_are_still(struct prices *prices); /* finished; NULL is fine */
/* Gives the price of an effect; its `known` is false until it is measured. */
void prices_get_effect(struct prices *prices, uint32_t effect, struct effect_price *price);
void prices_get_state(struct prices *prices, struct prices_state *state);

#endif
