/* The knobs of a picture that trade accuracy for time: the values of settings that `whit cost`, the
   viewer and docs/accuracy.md compare with the usual ones. */
#ifndef COST_KNOBS_H
#define COST_KNOBS_H

#include "settings/settings.h"

/* The objects that must be made anew to change a knob's setting. */
enum knob_level {
    KNOB_VIEW = SETTING_NEEDS_VIEW,
    KNOB_KERNEL = SETTING_NEEDS_KERNEL,
    KNOB_TREE = SETTING_NEEDS_TREES,
    KNOB_DOUBLE = SETTING_NEEDS_SCENE + 1, /* the reference draws, without a device */
};

struct knob_setting {
    const char *text; /* value as in the option: "64"; NULL: the word for `value` */
    int value;
    const char *effect; /* only for scenes that call for this effect; NULL: for all */
    const char *name;   /* in reports; NULL: `text` */
};
enum { KNOB_SETTINGS_MAX = 8 };
struct knob {
    const char *name;
    const char *setting; /* name of its row in the table of settings; NULL: KNOB_DOUBLE has none */
    uint32_t usual;      /* index in `settings` of whit's default */
    uint32_t count;
    struct knob_setting settings[KNOB_SETTINGS_MAX];
};

enum { KNOBS = 17 };
extern const struct knob knob_table[KNOBS];
/* The index of the knob of that name in the table, or WHIT_NONE. */
uint32_t knob_find(const char *name);
const char *knob_setting_name(const struct knob *knob, uint32_t setting);
/* The index of the setting of that name, or WHIT_NONE. */
uint32_t knob_find_setting(const struct knob *knob, const char *name);
/* The most that the knob may affect. SETTING_COST: neither ids nor pixels may change by a byte. */
enum setting_change knob_change(const struct knob *knob);
const char *knob_change_name(enum setting_change change);
enum knob_level knob_level(const struct knob *knob);
/* The knobs that change colours alone, as bits by index in knob_table. */
uint64_t knobs_of_light(void);

/* Why a setting has no effect in this scene, in a few words; NULL: it has. `setting` is not the
   usual one. `usual_path`: how the usual renderer reads trees (whit_stats.load_path);
   WHIT_LOAD_AUTO: not known. */
const char *knob_absence(const struct knob *knob, uint32_t setting, const whit_scene *scene,
                         whit_load_path usual_path);

/* Sets the knob's setting in `settings`. An effect that it removes adds to those removed
   already. */
void knob_apply(const struct knob *knob, uint32_t setting, struct settings *settings);
/* Writes the setting as an option of `whit render`, as "--aa 64"; "" for the usual setting. */
void knob_option(const struct knob *knob, uint32_t setting, char *text, size_t text_bytes);

#endif
