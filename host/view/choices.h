/* Settings as keys step through them and the panel of settings shows them: the rows of
   settings_table that have a title. */
#ifndef VIEW_CHOICES_H
#define VIEW_CHOICES_H

#include "settings/settings.h"

/* The next row after `row`, or the first for NULL. NULL: there is none. */
const struct setting *choice_next(const struct setting *row);
/* Panels show settings in these groups, in this order: how a model is read (which way is up, what
   lights it), what the picture shows, and how rays find hits or what that costs. */
enum choice_group { CHOICE_SCENE, CHOICE_PICTURE, CHOICE_EXPERTS };
enum choice_group choice_group(const struct setting *row);
/* The steps of a setting in words, and their number; 0: the setting is a number. */
enum { CHOICE_WORDS_MAX = 16 };
uint32_t choice_words(const struct setting *row, const char *words[CHOICE_WORDS_MAX]);
/* The index of the setting's current step; -1: it is at none. */
int choice_get(const struct settings *settings, const struct setting *row);
void choice_set(struct settings *settings, const struct setting *row, uint32_t step);
/* Gets or sets a setting that is a number; choice_set_number clamps it to the range of its
   option. */
double choice_number(const struct settings *settings, const struct setting *row);
void choice_set_number(struct settings *settings, const struct setting *row, double number);
/* Moves a setting `by` steps. Words wrap around, and those in `more_steps` are skipped; numbers
   stop at their limits. */
void choice_turn(struct settings *settings, const struct setting *row, int by);
/* Writes the value of any setting in words. */
void choice_say(const struct settings *settings, const struct setting *row, char *text,
                size_t bytes);

/* A setting that differs between two records of settings, other than camera, time and size. */
enum { CHOICE_WORDS = 96, CHOICE_CHANGES_MAX = 32 };
struct choice_change {
    const char *name;
    bool painted; /* the setting chooses what is painted, not how that is computed */
    char a[CHOICE_WORDS], b[CHOICE_WORDS];
};
/* Lists the differences of `a` and `b`, and returns their number. */
uint32_t choice_changes(const struct settings *a, const struct settings *b,
                        struct choice_change changes[CHOICE_CHANGES_MAX]);

#endif
