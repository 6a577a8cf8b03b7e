/* Two settings of one view beside each other: A is what the window draws, B is what was frozen.
   What takes time, a difference as a heat map and its figures, is worked out in other threads. */
#ifndef VIEW_COMPARE_H
#define VIEW_COMPARE_H

#include <stdatomic.h>

#include "base/threads.h"
#include "view/difference.h"
#include "view/engine.h"
#include "view/events.h"
#include "view/palette.h"

enum compare_mode {
    COMPARE_OFF,
    COMPARE_SPLIT,      /* A left of the divider, B right of it */
    COMPARE_DIFFERENCE, /* |A - B|, of the channel with the largest, as a heat map */
};

/* Pictures that a job looks at: of two frames, and kept until it is done, see compare_leave. */
struct compare_pair {
    const whit_image *color[2], *ids[2];
    uint64_t numbers[2]; /* of the frames */
    bool whole;
    bool uneven; /* refined, and one is not as far as the other yet */
};

/* |A - B| of a pair. */
struct compare_heat {
    struct compare_pair pair;
    double asked_scale, scale; /* 0: by itself; then the one that came of it */
    uint32_t width, height;
    uint32_t *rgba; /* NULL: none */
};

/* What whole pictures differ by. */
struct compare_figures {
    struct compare_pair pair;
    bool known;
    struct difference difference;
    bool has_flip; /* of colours alone */
    double flip_mean, flip_largest;
    double ms[2]; /* of drawing A and B */
};

/* Two jobs: heat maps of pictures as they come, and figures of whole ones. */
enum compare_work { COMPARE_HEAT, COMPARE_FIGURES, COMPARE_WORKS };
struct compare_job {
    struct thread *thread; /* NULL: not at work */
    atomic_bool done;
    const struct palette *palette;
    struct compare_heat heat; /* what is asked for, and what came of it */
    struct compare_figures figures;
};

struct compare {
    enum compare_mode mode;
    struct settings frozen;
    struct engine_frame other; /* B's newest picture */
    double divider;            /* part of the window's width that is A's */
    bool dragging;
    double scale; /* of the heat map; 0: by itself */
    bool stale;   /* the window shows something else than it should */
    struct compare_heat heat;
    struct compare_figures figures;
    struct compare_job jobs[COMPARE_WORKS];
    whit_image *left[4 * COMPARE_WORKS]; /* of frames that are gone, but a job still reads them */
    uint8_t *mixed;                      /* what is shown of A and B */
    uint32_t mixed_width, mixed_height;
};

struct view;

/* From OFF to something else freezes B. */
void compare_set(struct view *view, enum compare_mode mode);
/* A newer picture will take this one's place: what jobs read of it stays with them. */
void compare_leave(struct compare *compare, struct engine_frame *frame);
/* Takes what is new, and gives the window its picture: A's alone where nothing is compared. */
WHIT_CHECK whit_result compare_step(struct view *view);
/* Nothing of it is still to come, once the engine is still. */
bool compare_is_still(const struct view *view);
/* Whether the heat map is shown: not where one side shows costs, the other colours. */
bool compare_subtracts(const struct view *view);
/* The divider; true where the event was its own. */
bool compare_event(struct view *view, const struct view_event *event);
/* Names, divider, figures and legend, between ui_begin and ui_end. */
void compare_draw(struct view *view);
/* Waits for jobs. */
void compare_finish(struct compare *compare);

#endif
