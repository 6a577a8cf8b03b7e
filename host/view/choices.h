/* Settings as keys turn through them and the panel of settings shows them: the rows of the table of
   settings that have a title. */
#ifndef VIEW_CHOICES_H
#define VIEW_CHOICES_H

#include "settings/settings.h"

/* The row behind `row`, or with NULL the first; NULL: there is none. */
const struct setting *choice_next(const struct setting *row);
/* Panels show settings in these groups, in this order: how a model is read (which way is up, what
   lights it), what the picture shows, and how rays find what they hit or what that costs. */
enum choice_group { CHOICE_SCENE, CHOICE_PICTURE, CHOICE_EXPERTS };
enum choice_group choice_group(const struct setting *row);
/* The steps in words, CHOICE_WORDS_MAX at most; 0: it is a number. */
enum { CHOICE_WORDS_MAX = 16 };
uint32_t choice_words(const struct setting *row, const char *words[CHOICE_WORDS_MAX]);
/* Which of them it is at; -1: none of them. */
int choice_get(const struct settings *settings, const struct setting *row);
void choice_set(struct settings *settings, const struct setting *row, uint32_t step);
/* A number, cut to what its option takes. */
double choice_number(const struct settings *settings, const struct setting *row);
void choice_set_number(struct settings *settings, const struct setting *row, double number);
/* The next one or the one before; words go round, without `more_steps`, numbers end. */
void choice_turn(struct settings *settings, const struct setting *row, int by);
/* The value in words, whatever it is. */
void choice_say(const struct settings *settings, const struct setting *row, char *text,
                size_t bytes);

/* In what two settings differ, beside place. */
enum { CHOICE_WORDS = 96, CHOICE_CHANGES_MAX = 32 };
struct choice_change {
    const char *name;
    bool painted; /* it is what is painted, not how it is found or shaded */
    char a[CHOICE_WORDS], b[CHOICE_WORDS];
};
/* Their number. */
uint32_t choice_changes(const struct settings *a, const struct settings *b,
                        struct choice_change changes[CHOICE_CHANGES_MAX]);

#endif
