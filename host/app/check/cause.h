/* Why a picture is other than it was: which parts of its input give the old bytes when they are
   taken back. */
#ifndef APP_CHECK_CAUSE_H
#define APP_CHECK_CAUSE_H

#include "app/check/search.h"
#include "app/check/trial.h"

/* So many pictures are drawn for one cause at most. */
enum { CAUSE_PICTURES_MAX = 64 };

enum cause_kind {
    CAUSE_PART,      /* of the scene */
    CAUSE_SETTING,   /* an option */
    CAUSE_FUNCTIONS, /* of a shader, or what they include */
};

/* Something that is other than it was. */
struct cause_change {
    enum cause_kind kind;
    uint32_t part;             /* of `parts` */
    const struct setting *row; /* of the table of settings */
};

struct cause {
    struct trial_input before, after; /* borrowed, as is the picture that was */
    const struct trial *was;
    whit_part *parts; /* of the scene before */
    uint32_t part_count;
    struct cause_change *changes;
    uint32_t count, capacity;
    struct search search; /* over `changes` */
};

/* Finds what changed, and what of that is the cause. What fails was said; cause_finish() it either
   way. */
WHIT_CHECK whit_result cause_find(struct cause *cause, const struct trial_input *before,
                                  const struct trial *was, const struct trial_input *after);
/* "cause: mesh "ball", vertices 2716 and 2717 moved by up to 0.0013", with what is other and not
   seen behind it. Names are as the files have them. */
void cause_write(const struct cause *cause, FILE *to);
void cause_finish(struct cause *cause);

#endif
