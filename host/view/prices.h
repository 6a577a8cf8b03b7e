/* The price list of the picture in the window: what each setting would cost here, and how wrong the
   picture would be. A thread measures it, on a device of its own, while the window goes on. */
#ifndef VIEW_PRICES_H
#define VIEW_PRICES_H

#include "cost/cost.h"
#include "view/price_strip.h"
#include "view/session.h"

struct prices;

enum { EFFECTS_MAX = 64 };
/* The price of switching one effect, by the pictures before and after it. */
struct effect_price {
    bool known, added;
    double before_ms, after_ms;
    uint64_t other_colors, pixels;
};

struct prices_params {
    struct settings settings;
    struct scene_ref *scene;
    double seconds; /* time to spend, roughly */
    uint64_t knobs; /* bits 1 << index in knob_table; 0: all knobs */
    bool strip;     /* also draws the pictures of cost_strip */
    bool effects;   /* measures effects in place of knobs; `seconds` is ignored */
};
/* Starts measuring; the thread wakes the window when there is something new. NULL: no memory, or no
   thread. */
struct prices *prices_start(const struct prices_params *params);
/* Stops measuring, waits, frees; NULL is fine. */
void prices_stop(struct prices *prices);
/* Stops measuring without waiting. Once prices_are_still, prices_stop does not wait either. */
void prices_cancel(struct prices *prices);

enum { PRICES_TEXT = 160 };
struct prices_state {
    bool finished;
    double done, seconds_left;       /* `done`: 0..1 */
    char what[PRICES_TEXT];          /* what is being measured; after a failure: the reason */
    struct cost_report *report;      /* borrowed until prices_stop; NULL until finished */
    const struct price_strip *strip; /* likewise */
    const struct settings *settings; /* likewise: of the picture whose prices these are */
};
/* Whether there is something new since the last call; NULL is fine. */
bool prices_have_news(struct prices *prices);
bool prices_are_still(struct prices *prices); /* finished; NULL is fine */
/* Gives the price of an effect; its `known` is false until it was measured. */
void prices_get_effect(struct prices *prices, uint32_t effect, struct effect_price *price);
void prices_get_state(struct prices *prices, struct prices_state *state);

#endif
