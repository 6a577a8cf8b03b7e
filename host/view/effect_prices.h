/* What each effect of the kernel costs in a view: the picture with it and without it in turns,
   small, one effect after the other. Of the thread of prices.h. */
#ifndef VIEW_EFFECT_PRICES_H
#define VIEW_EFFECT_PRICES_H

#include "cost/cost.h"
#include "settings/settings.h"

enum { EFFECTS_MAX = 64 };

/* What switching one effect changes: the pictures before and after it. */
struct effect_price {
    bool known, added;
    double before_ms, after_ms;
    int verdict; /* 1 dearer, -1 cheaper, 0 not distinguishable */
    uint64_t other_colors, pixels;
};

struct effect_work {
    const struct settings *settings;
    const whit_scene *scene;
    whit_device *device;
    whit_accel *accel;
    const volatile bool *cancel;
    const whit_log *log;
    /* Called for each effect that can be left out, once it is priced. */
    void (*found)(void *user, uint32_t effect, const struct effect_price *price);
    void (*say)(void *user, double done, const char *what); /* 0..1 */
    void *user;
};
WHIT_CHECK whit_result effect_prices_measure(const struct effect_work *work);

/* `effects` (as --effects takes it) with one switched on or off, where the scene calls for it or
   not; false where that is too long. "": auto. */
bool effect_switch_text(const char *effects, uint32_t index, bool called, bool on,
                        char out[SETTING_TEXT_BYTES]);

#endif
