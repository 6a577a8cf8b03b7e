/* The knobs of a picture that trade accuracy for time: one table for `whit cost`, the viewer and
   docs/accuracy.md. */
#ifndef COST_KNOBS_H
#define COST_KNOBS_H

#include "api/whit.h"
#include "settings/values.h"

/* What a setting may change of a picture. */
enum knob_change {
    KNOB_NOTHING, /* ids and pixels are the same bytes: anything else is a defect */
    KNOB_SHADING, /* colours, and not what camera rays meet */
    KNOB_HITS,    /* what rays meet */
};
const char *knob_change_name(enum knob_change change);

/* What has to be made anew for another setting. */
enum knob_level {
    KNOB_VIEW,   /* whit_renderer_set_view */
    KNOB_KERNEL, /* a renderer */
    KNOB_TREE,   /* trees, and a renderer over them */
    KNOB_DOUBLE, /* nothing of a device: the reference draws */
};

enum { KNOB_EFFECTS_MOST = 256 };
/* Parameters that settings are put into. `picture.effects` is NULL or points to `effects`: copies
   need knob_target_copy. */
struct knob_target {
    whit_accel_params accel;
    whit_renderer_params picture;
    char effects[KNOB_EFFECTS_MOST];
};

struct knob_setting {
    const char *name;   /* as its option takes it: "64"; "": the word of `value` */
    double value;       /* what `apply` reads */
    const char *effect; /* that the scene must call for, or NULL */
};
enum { KNOB_SETTINGS_MOST = 8 };
struct knob {
    const char *name;
    const struct setting_value *values; /* of a setting that has words, or NULL */
    const char *option; /* of `whit render` for one of its settings: "--aa %s"; "": none */
    const char *about;  /* what it is, in a few words */
    enum knob_change change;
    enum knob_level level;
    uint32_t usual;                                   /* the setting that whit takes by itself */
    struct knob_setting settings[KNOB_SETTINGS_MOST]; /* ended by one without a name */
    void (*apply)(const struct knob_setting *setting, struct knob_target *target);
};

/* The table, always the same. */
const struct knob *knob_table(uint32_t *count);
/* Its index, or WHIT_NONE. */
uint32_t knob_find(const char *name);
uint32_t knob_setting_count(const struct knob *knob);
const char *knob_setting_name(const struct knob *knob, uint32_t setting);

/* Why a setting means nothing here, in few words, or NULL where it does. `setting` is not the usual
   one. `usual_path`: how the renderer at hand reads trees (whit_stats.load_path). */
const char *knob_absence(const struct knob *knob, uint32_t setting, const whit_scene *scene,
                         const char *usual_path);

void knob_target_copy(struct knob_target *to, const struct knob_target *from);
void knob_apply(const struct knob *knob, uint32_t setting, struct knob_target *target);
/* What `whit render` would be given: "--aa 64"; "" for what it takes by itself. */
void knob_option(const struct knob *knob, uint32_t setting, char *text, size_t text_bytes);

#endif
