/* The knobs of a picture that trade accuracy for time: which values of which settings `whit cost`,
   the viewer and docs/accuracy.md hold beside the usual ones. */
#ifndef COST_KNOBS_H
#define COST_KNOBS_H

#include "settings/settings.h"

/* What has to be made anew for another setting. */
enum knob_level {
    KNOB_VIEW = SETTING_NEEDS_VIEW,
    KNOB_KERNEL = SETTING_NEEDS_KERNEL,
    KNOB_TREE = SETTING_NEEDS_TREES,
    KNOB_DOUBLE = SETTING_NEEDS_SCENE + 1, /* nothing of a device: the reference draws */
};

struct knob_setting {
    const char *text; /* as the option takes it: "64"; NULL: the word of `value` */
    int value;
    const char *effect; /* that the scene must call for, or NULL */
    const char *name;   /* in reports; NULL: the text */
};
enum { KNOB_SETTINGS_MAX = 8 };
struct knob {
    const char *name;
    const char *setting; /* its row of the table of settings; NULL: none, it is of the reference */
    const char *about;   /* what it is, in a few words */
    uint32_t usual;      /* what whit takes by itself */
    uint32_t count;
    struct knob_setting settings[KNOB_SETTINGS_MAX];
};

/* The table, always the same. */
const struct knob *knob_table(uint32_t *count);
/* The index of the knob of that name in the table, or WHIT_NONE. */
uint32_t knob_find(const char *name);
const char *knob_setting_name(const struct knob *knob, uint32_t setting);
/* SETTING_COST: ids and pixels are the same bytes, and anything else is a defect. */
enum setting_change knob_change(const struct knob *knob);
const char *knob_change_name(enum setting_change change);
enum knob_level knob_level(const struct knob *knob);
/* Bits of the knobs that change colours alone. */
uint64_t knobs_of_light(void);

/* Why a setting means nothing here, in few words, or NULL where it does. `setting` is not the usual
   one. `usual_path`: how the renderer at hand reads trees (whit_stats.load_path); WHIT_LOAD_AUTO:
   not known. */
const char *knob_absence(const struct knob *knob, uint32_t setting, const whit_scene *scene,
                         whit_load_path usual_path);

/* Puts what the knob's setting says into `settings`; effects left out come behind those that are.
 */
void knob_apply(const struct knob *knob, uint32_t setting, struct settings *settings);
/* What `whit render` would be given: "--aa 64"; "" for what it takes by itself. */
void knob_option(const struct knob *knob, uint32_t setting, char *text, size_t text_bytes);

#endif
