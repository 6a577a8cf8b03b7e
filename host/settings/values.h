/* Lists of the words for the values of enumerations. Options, help, completion, recipes, JSON,
   keys, panels and prices take words and their order from here. */
#ifndef SETTINGS_VALUES_H
#define SETTINGS_VALUES_H

#include "whit/whit.h"

/* One value; a list ends with a word that is NULL. Lists of a bool have 0 and 1. */
struct setting_value {
    const char *word;  /* "watertight", as written in options */
    int value;         /* of the enumeration */
    const char *title; /* in messages and panels; NULL: the word */
};

extern const struct setting_value values_build[];           /* whit_build */
extern const struct setting_value values_instances[];       /* whit_instances */
extern const struct setting_value values_instance_build[];  /* whit_build */
extern const struct setting_value values_instance_update[]; /* whit_accel_params.instance_refit */
extern const struct setting_value values_traversal[];       /* whit_traversal */
extern const struct setting_value values_numerics[];        /* whit_numerics */
extern const struct setting_value values_load_path[];       /* whit_load_path */
extern const struct setting_value values_packets[];         /* whit_packets */
extern const struct setting_value values_classes[];         /* whit_classes */
extern const struct setting_value values_up[];              /* whit_up */
extern const struct setting_value values_lights[];          /* whit_lights */
extern const struct setting_value values_shadows[];         /* whit_shadows */
extern const struct setting_value values_fresnel[];         /* whit_renderer_params.schlick */
extern const struct setting_value values_minification[];    /* whit_minification */
extern const struct setting_value values_effects[];         /* the words that the value of --effects
                                                               begins with */
extern const struct setting_value values_samples[];         /* samples of a pixel: the numbers that
                                                               are spread evenly */
extern const struct setting_value values_light_samples[];   /* of an area light */
extern const struct setting_value values_view[];            /* 0: colours; 1 + whit_view */
extern const struct setting_value values_rays[];            /* whit_ray_kind; WHIT_RAY_KINDS: all */

/* The word of a value, and its title; "" where the list lacks it. */
const char *value_word(const struct setting_value *values, int value);
const char *value_title(const struct setting_value *values, int value);
/* The index of a word in the list; WHIT_NONE where the list lacks it. */
uint32_t value_find(const struct setting_value *values, const char *word);
uint32_t value_count(const struct setting_value *values);
/* Writes all words with `separator` between them, cut to `text_bytes`; gives `text`. */
const char *value_list(const struct setting_value *values, const char *separator, char *text,
                       size_t text_bytes);

#endif
