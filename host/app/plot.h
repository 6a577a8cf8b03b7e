/* Points and lines over two axes, as SVG inside a page. */
#ifndef APP_PLOT_H
#define APP_PLOT_H

#include "app/page.h"

/* Where 1, 2 or 5 times a power of ten lie from `low` to `high` (low < high), about `wanted` of
   them, at most PLOT_TICKS_MAX; on a logarithmic axis (low > 0) powers of ten, with 2 and 5 times
   them where it has few. Gives their number. */
enum { PLOT_TICKS_MAX = 24 };
uint32_t plot_ticks(double low, double high, bool is_log, uint32_t wanted,
                    double ticks[PLOT_TICKS_MAX]);
/* The axis from the least to the most of what it shows, widened a little; on one that is not
   logarithmic to 0 where that is near. Also of one value, or none (`low` > `high`). */
void plot_widen(double *low, double *high, bool is_log);

struct plot_axis {
    const char *title;
    /* Values of 0 and below get a lane of their own at its start, marked 0. */
    bool is_log;
};
struct plot_point {
    double x, y;
    double x_low, x_high, y_low, y_high; /* a bar from low to high where these differ */
    const char *title;                   /* what hovering shows; NULL: nothing */
    bool marked;                         /* drawn with a rim */
};
/* Each series has its own colour, shape of marker and pattern of line, of PLOT_STYLES. */
enum { PLOT_STYLES = 7 };
struct plot_series {
    const char *name; /* for the legend */
    const struct plot_point *points;
    uint32_t count;
    bool has_line, no_markers;
};
struct plot {
    const char *title; /* below it, and for those who do not see it */
    struct plot_axis x, y;
    const struct plot_series *series;
    uint32_t series_count;
};
/* Points whose x or y is not finite are left out. */
void plot_write(struct page *page, const struct plot *plot);

#endif
