/* What the user waits for: how long pictures take, and how far apart they are. */
#ifndef VIEW_MEASURE_H
#define VIEW_MEASURE_H

#include <stdint.h>

struct view;

/* Some figures, the first of many. */
enum { FIGURES_MAX = 4096 };
struct view_figures {
    uint32_t count;
    double values[FIGURES_MAX];
};

/* What the user waited for since the last `state`. */
struct view_measure {
    double first_ms;             /* when the first picture was shown, by the clock; 0: none yet */
    double last_ms;              /* the last new picture while something moved; 0: it stood */
    double shown_ms;             /* when the window was drawn last; 0: not yet */
    double cpu_ms;               /* of the process, when this began */
    double start_ms;             /* when this began */
    uint32_t drawn;              /* how often the window was drawn */
    uint64_t number;             /* of the last picture that was counted */
    struct view_figures whole;   /* ms of render of whole pictures */
    struct view_figures quick;   /* of those while something moves */
    struct view_figures size;    /* their divisors */
    struct view_figures gap;     /* ms from one new picture to the next, while something moves */
    struct view_figures between; /* ms from one drawing of the window to the next */
    struct view_figures latency; /* ms from the input to the picture that shows it */
    struct view_figures present; /* ms in the call that presents */
};

void measure_begin(struct view *view);
/* The window was drawn just now, with `view->frame`. */
void measure_shown(struct view *view);
double figures_quantile(struct view_figures *figures, double share); /* sorts; 0: of none */

#endif
