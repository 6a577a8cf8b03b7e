/* Settings that have a few values: one table that the keys turn through, the panel of settings
   shows and differences are told by. */
#ifndef VIEW_CHOICES_H
#define VIEW_CHOICES_H

#include "view/settings.h"

enum choice_id {
    CHOICE_TRAVERSAL,
    CHOICE_NUMERICS,
    CHOICE_BUILDER,
    CHOICE_BINS,
    CHOICE_TREES,
    CHOICE_INSTANCES,
    CHOICE_DEPTH,
    CHOICE_BAILOUT,
    CHOICE_SAMPLES,
    CHOICE_LIGHT_SAMPLES,
    CHOICE_FRESNEL,
    CHOICE_SHADOWS,
    CHOICE_VIEW, /* from here on what is painted, not how it is found or shaded */
    CHOICE_VIEW_RAYS,
    CHOICE_COUNT,
};

const char *choice_name(enum choice_id id); /* "anti-aliasing" */
/* The values in words, at most CHOICE_WORDS_MOST; 0: they are whole numbers below choice_count. */
enum { CHOICE_WORDS_MOST = 16 };
uint32_t choice_words(enum choice_id id, const char *words[CHOICE_WORDS_MOST]);
uint32_t choice_count(enum choice_id id);
/* -1: something that the command line said, and that is not among the values. */
int choice_get(const struct view_settings *settings, enum choice_id id);
void choice_set(struct view_settings *settings, enum choice_id id, uint32_t value);
/* The next one or the one before; names go round, numbers end. */
void choice_turn(struct view_settings *settings, enum choice_id id, int by);
/* The value in words, whatever it is. */
void choice_say(const struct view_settings *settings, enum choice_id id, char *text, size_t bytes);

/* In what two settings differ, beside place and scene. */
enum { CHOICE_WORDS = 96, CHOICE_CHANGES_MOST = CHOICE_COUNT + 2 };
struct choice_change {
    enum choice_id id; /* CHOICE_COUNT: of what is no choice */
    const char *name;
    char a[CHOICE_WORDS], b[CHOICE_WORDS];
};
/* Their number. */
uint32_t choice_changes(const struct view_settings *a, const struct view_settings *b,
                        struct choice_change changes[CHOICE_CHANGES_MOST]);

#endif
