/* Measures what the user waits for: how long pictures take, and the time between them. */
#ifndef VIEW_MEASURE_H
#define VIEW_MEASURE_H

#include <stdint.h>

struct view;

/* Values of a figure; only the first FIGURES_MAX are kept, `count` counts all. */
enum { FIGURES_MAX = 4096 };
struct view_figures {
    uint32_t count;
    double values[FIGURES_MAX];
};

/* Times that the user has waited for pictures since the last `state` of a replay. */
struct view_measure {
    double first_ms; /* clock_ms() when the first picture was shown; 0: none yet */
    double last_ms;  /* when the last picture was shown, if something moved then; else 0 */
    double shown_ms; /* when the window was drawn last; 0: not yet */
    double input_ms; /* when the last input was taken */
    double cpu_ms;   /* processor time of the process at start_ms */
    double start_ms; /* when measuring began */
    uint32_t drawn;  /* how often the window was drawn */
    uint64_t number; /* number of the last picture that was counted */
    struct view_figures whole;   /* ms of drawing whole pictures */
    struct view_figures quick;   /* ms of drawing pictures while something moves */
    struct view_figures size;    /* divisors of the pictures in `quick` */
    struct view_figures gap;     /* ms from one new picture to the next, while something moves */
    struct view_figures between; /* ms from one drawing of the window to the next, with input */
    struct view_figures latency; /* ms from the input to the picture that shows it */
    struct view_figures present; /* ms in the call that presents */
};

void measure_begin(struct view *view);
/* Call it when the window was just drawn, with view->frame. */
void measure_shown(struct view *view);
/* Sorts the values. 0: there are none. */
double figures_quantile(struct view_figures *figures, double share);

#endif
