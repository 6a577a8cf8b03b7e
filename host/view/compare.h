/* Compares two settings of one view: A is what the window draws, B is frozen. Differences as a heat
   map and in figures take time, so other threads compute them. */
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
    COMPARE_DIFFERENCE, /* |A - B| of the largest channel, as a heat map */
};

/* The pictures of A and B. */
struct compare_pair {
    whit_image *color[2], *ids[2]; /* borrowed, but those of a job */
    uint64_t numbers[2];           /* numbers of the frames */
    bool whole;
    bool uneven; /* numbers of samples differ, as one was refined further */
};

/* A heat map of |A - B|. */
struct compare_heat {
    struct compare_pair pair;
    double asked_scale, scale; /* asked_scale 0: chosen by the picture; scale: the one used */
    uint32_t width, height;
    uint32_t *rgba; /* NULL: none */
};

/* Figures about the difference of two whole pictures. */
struct compare_figures {
    struct compare_pair pair;
    bool known;
    struct difference difference;
    bool has_flip; /* flip_* are known: both show colours */
    double flip_mean, flip_largest;
    double ms[2]; /* time of drawing A and B */
};

/* The two kinds of jobs: heat maps of all pictures, and figures of whole ones. */
enum compare_work { COMPARE_HEAT, COMPARE_FIGURES, COMPARE_WORKS };
struct compare_job {
    struct thread *thread; /* NULL: the job is not running */
    atomic_bool done;
    const struct palette *palette;
    struct compare_pair pair; /* owns its images while the job runs */
    struct compare_heat heat; /* the request, and then the result */
    struct compare_figures figures;
};

struct compare {
    enum compare_mode mode;
    struct settings frozen;
    struct engine_frame other; /* the newest picture of B */
    double divider;            /* A's share of the window's width */
    bool dragging;
    double scale; /* scale of the heat map; 0: chosen by the picture */
    bool stale;   /* the window has to be given a new picture */
    struct compare_heat heat;
    struct compare_figures figures;
    struct compare_job jobs[COMPARE_WORKS];
    uint8_t *mixed; /* pixels of A and B side by side */
    uint32_t mixed_width, mixed_height;
};

struct view;

/* Changes the mode. From OFF to another mode it freezes B. */
void compare_set(struct view *view, enum compare_mode mode);
/* Takes new pictures and finished jobs, and gives the window its picture; without comparison, that
   of A. */
WHIT_CHECK whit_result compare_step(struct view *view);
/* Whether nothing more will be shown, provided that the engine is still. */
bool compare_is_still(const struct view *view);
/* Whether the heat map is shown. It is not if one side shows costs and the other colours. */
bool compare_subtracts(const struct view *view);
/* Moves the divider; true: the event was for it. */
bool compare_event(struct view *view, const struct view_event *event);
/* Draws names, divider, figures and legend, between ui_begin and ui_end. */
void compare_draw(struct view *view);
/* Waits for jobs, and frees everything. */
void compare_finish(struct compare *compare);

#endif
