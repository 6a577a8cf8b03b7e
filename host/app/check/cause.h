/* Finds why a picture changed: which changes of its input, when they are taken back, give the old
   bytes. */
#ifndef APP_CHECK_CAUSE_H
#define APP_CHECK_CAUSE_H

#include "app/check/draw.h"
#include "app/check/search.h"

/* The most pictures that are drawn to find one cause. */
enum { CAUSE_PICTURES_MAX = 64 };

enum cause_kind {
    CAUSE_PART,      /* a part of the scene */
    CAUSE_SETTING,   /* an option */
    CAUSE_FUNCTIONS, /* functions of a shader, with the files that they include */
};

/* A difference between the old and the new input. */
struct cause_change {
    enum cause_kind kind;
    uint32_t part;             /* CAUSE_PART: index into cause.parts */
    const struct setting *row; /* CAUSE_SETTING: its row in the table of settings */
};

struct cause {
    struct job before, after; /* inputs of trial_draw, borrowed like `was`, the old picture */
    const struct drawing *was;
    whit_part *parts; /* parts of the old scene */
    uint32_t part_count;
    struct cause_change *changes;
    uint32_t count, capacity;
    struct search search; /* over `changes` */
};

/* Finds the changes, and which of them are the cause. Errors were printed; call cause_finish() in
   any case. */
WHIT_CHECK whit_result cause_find(struct cause *cause, const struct job *before,
                                  const struct drawing *was, const struct job *after);
/* "cause: mesh "ball", vertices 2716 and 2717 moved by up to 0.0013", followed by changes that do
   not show in the picture. Names are as the files have them. */
void cause_write(const struct cause *cause, FILE *to);
void cause_finish(struct cause *cause);

#endif
