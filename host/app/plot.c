#include "app/plot.h"

#include <math.h>
#include <stdio.h>

/* In units of the drawing, which scales with the page. */
static const double WIDTH = 720.0, HEIGHT = 400.0, LEFT = 84.0, RIGHT = 16.0, TOP = 14.0,
                    BOTTOM = 56.0, LANE = 34.0;

/* ---- Ticks ---- */

/* 1, 2 or 5 times a power of ten, at least `least`. */
static double nice_step(double min)
{
    double power = pow(10.0, floor(log10(min)));
    double digit = min / power * (1.0 - 1e-12);
    return power * (digit <= 1.0 ? 1.0 : digit <= 2.0 ? 2.0 : digit <= 5.0 ? 5.0 : 10.0);
}

static uint32_t linear_ticks(double low, double high, uint32_t wanted, double *ticks)
{
    uint32_t count = 0;
    double step = nice_step((high - low) / wanted), slack = 1e-9 * step;
    double first = ceil((low - slack) / step);
    for (double i = first; i * step <= high + slack && count < PLOT_TICKS_MAX; ++i)
        ticks[count++] = i * step + 0.0; /* no -0 */
    return count;
}

static uint32_t log_ticks(double low, double high, uint32_t wanted, double *ticks)
{
    static const double digits[] = {1.0, 2.0, 5.0};
    uint32_t count = 0;
    double decades = log10(high / low);
    int stride = (int)ceil(decades / wanted), used = 3.0 * decades <= 2.0 * wanted ? 3 : 1;
    stride = stride < 1 ? 1 : stride;
    int first = (int)floor(log10(low) - 1e-9), last = (int)ceil(log10(high));
    for (int power = first; power <= last; ++power) {
        if (power % stride != 0)
            continue;
        for (int d = 0; d < used && count < PLOT_TICKS_MAX; ++d) {
            double value = digits[d] * pow(10.0, power);
            if (value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9))
                ticks[count++] = value;
        }
    }
    return count;
}

uint32_t plot_ticks(double low, double high, bool is_log, uint32_t wanted,
                    double ticks[PLOT_TICKS_MAX])
{
    uint32_t count = is_log ? log_ticks(low, high, wanted, ticks) : 0;
    return count >= 2 ? count : linear_ticks(low, high, wanted, ticks);
}

void plot_widen(double *low, double *high, bool is_log)
{
    if (*low > *high) {
        *low = is_log ? 1.0 : 0.0;
        *high = is_log ? 10.0 : 1.0;
    } else if (is_log) {
        double factor = fmax(pow(*high / *low, 0.05), 1.1);
        *low /= factor;
        *high *= factor;
    } else {
        double min = *low, more = 0.05 * (*high - *low);
        more = more > 0.0 ? more : *high != 0.0 ? 0.05 * fabs(*high) : 1.0;
        if (min >= 0.0 && min <= 0.4 * *high)
            *low = 0.0;
        else
            *low -= more;
        *high += more;
    }
}

/* ---- Axes ---- */

struct scale {
    bool is_log, has_lane;
    double low, high;  /* of the numbers */
    double start, end; /* of the drawing; the lane lies before `start` */
    double lane;
};

static bool in_lane(const struct scale *scale, double value)
{
    return scale->is_log && !(value > 0.0);
}

static double place(const struct scale *scale, double value)
{
    if (in_lane(scale, value))
        return scale->lane;
    double share = scale->is_log ? log(value / scale->low) / log(scale->high / scale->low)
                                 : (value - scale->low) / (scale->high - scale->low);
    return scale->start + share * (scale->end - scale->start);
}

static void include(struct scale *scale, double value)
{
    if (in_lane(scale, value)) {
        scale->has_lane = true;
        return;
    }
    scale->low = fmin(scale->low, value);
    scale->high = fmax(scale->high, value);
}

static bool is_shown(const struct plot_point *point)
{
    return isfinite(point->x) && isfinite(point->y);
}

static bool has_bar(double low, double high)
{
    return isfinite(low) && isfinite(high) && low != high;
}

static void include_points(const struct plot *plot, struct scale *x, struct scale *y)
{
    for (uint32_t s = 0; s < plot->series_count; ++s) {
        for (uint32_t i = 0; i < plot->series[s].count; ++i) {
            const struct plot_point *point = &plot->series[s].points[i];
            if (!is_shown(point))
                continue;
            include(x, point->x);
            include(y, point->y);
            if (has_bar(point->x_low, point->x_high)) {
                include(x, point->x_low);
                include(x, point->x_high);
            }
            if (has_bar(point->y_low, point->y_high)) {
                include(y, point->y_low);
                include(y, point->y_high);
            }
        }
    }
}

static void scale_complete(struct scale *scale, double start, double end)
{
    double lane = end > start ? LANE : -LANE;
    scale->lane = start + 0.5 * lane;
    scale->start = scale->has_lane ? start + lane : start;
    scale->end = end;
    plot_widen(&scale->low, &scale->high, scale->is_log);
}

static void put_number(struct page *page, double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.6g", value);
    page_text(page, text);
}

static void put_x_tick(struct page *page, double x, double value, const char *kind)
{
    page_markup(page, "<path class=\"grid%s\" d=\"M%.1f %.1fV%.1f\"/>", kind, x, TOP,
                HEIGHT - BOTTOM);
    page_markup(page, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", x,
                HEIGHT - BOTTOM + 18.0);
    put_number(page, value);
    page_markup(page, "</text>\n");
}

static void put_y_tick(struct page *page, double y, double value, const char *kind)
{
    page_markup(page, "<path class=\"grid%s\" d=\"M%.1f %.1fH%.1f\"/>", kind, LEFT, y,
                WIDTH - RIGHT);
    page_markup(page, "<text class=\"tick\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">", LEFT - 8.0,
                y + 4.5);
    put_number(page, value);
    page_markup(page, "</text>\n");
}

static void put_ticks(struct page *page, const struct scale *scale, uint32_t wanted,
                      void (*put)(struct page *page, double at, double value, const char *kind))
{
    double ticks[PLOT_TICKS_MAX];
    uint32_t count = plot_ticks(scale->low, scale->high, scale->is_log, wanted, ticks);
    if (scale->has_lane)
        put(page, scale->lane, 0.0, " zero");
    for (uint32_t i = 0; i < count; ++i)
        put(page, place(scale, ticks[i]), ticks[i], "");
}

static void put_axes(struct page *page, const struct plot *plot, const struct scale *x,
                     const struct scale *y)
{
    double bottom = HEIGHT - BOTTOM, right = WIDTH - RIGHT;
    put_ticks(page, x, 7, put_x_tick);
    put_ticks(page, y, 6, put_y_tick);
    page_markup(page, "<path class=\"axis\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", LEFT, TOP, bottom,
                right);
    page_markup(page, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", 0.5 * (LEFT + right),
                HEIGHT - 12.0);
    page_text(page, plot->x.title);
    page_markup(page,
                "</text>\n<text transform=\"translate(16 %.1f) rotate(-90)\" "
                "text-anchor=\"middle\">",
                0.5 * (TOP + bottom));
    page_text(page, plot->y.title);
    page_markup(page, "</text>\n");
}

/* ---- Series ---- */

/* Around (0, 0). The last two are lines, drawn with a pen instead of filled. */
static const char *const markers[PLOT_STYLES] = {
    "M-5.2 0a5.2 5.2 0 1 0 10.4 0a5.2 5.2 0 1 0 -10.4 0z",
    "M-4.8 -4.8H4.8V4.8H-4.8z",
    "M0 -6.2L6 4.8H-6z",
    "M0 -6.6L6.6 0L0 6.6L-6.6 0z",
    "M0 6.2L6 -4.8H-6z",
    "M-5.2 -5.2L5.2 5.2M-5.2 5.2L5.2 -5.2",
    "M-6 0H6M0 -6V6",
};
static const char *const dashes[PLOT_STYLES] = {"none", "7 4",     "2 3", "9 3 2 3",
                                                "12 4", "4 2 1 2", "1 4"};

static void put_marker(struct page *page, uint32_t style, double x, double y)
{
    page_markup(page, "<path class=\"%s\" transform=\"translate(%.2f %.2f)\" d=\"%s\"/>",
                style >= 5 ? "open" : "p", x, y, markers[style]);
}

static void put_point(struct page *page, uint32_t style, const struct plot_point *point,
                      const struct scale *x, const struct scale *y)
{
    double px = place(x, point->x), py = place(y, point->y);
    page_markup(page, "<g class=\"point%s\">", point->marked ? " mark" : "");
    if (point->title) {
        page_markup(page, "<title>");
        page_text(page, point->title);
        page_markup(page, "</title>");
    }
    if (has_bar(point->x_low, point->x_high))
        page_markup(page, "<path class=\"e\" d=\"M%.2f %.2fH%.2f\"/>", place(x, point->x_low), py,
                    place(x, point->x_high));
    if (has_bar(point->y_low, point->y_high))
        page_markup(page, "<path class=\"e\" d=\"M%.2f %.2fV%.2f\"/>", px, place(y, point->y_low),
                    place(y, point->y_high));
    put_marker(page, style, px, py);
    page_markup(page, "</g>\n");
}

static void put_line(struct page *page, uint32_t style, const struct plot_series *series,
                     const struct scale *x, const struct scale *y)
{
    bool begun = false;
    page_markup(page, "<path class=\"l\" stroke-dasharray=\"%s\" d=\"", dashes[style]);
    for (uint32_t i = 0; i < series->count; ++i) {
        const struct plot_point *point = &series->points[i];
        if (!is_shown(point))
            continue;
        page_markup(page, "%c%.2f %.2f", begun ? 'L' : 'M', place(x, point->x), place(y, point->y));
        begun = true;
    }
    page_markup(page, "\"/>\n");
}

static void put_series(struct page *page, const struct plot *plot, uint32_t index,
                       const struct scale *x, const struct scale *y)
{
    const struct plot_series *series = &plot->series[index];
    uint32_t style = index % PLOT_STYLES;
    page_markup(page, "<g class=\"s%u\">\n", style);
    if (series->has_line)
        put_line(page, style, series, x, y);
    for (uint32_t i = 0; !series->no_markers && i < series->count; ++i) {
        if (is_shown(&series->points[i]))
            put_point(page, style, &series->points[i], x, y);
    }
    page_markup(page, "</g>\n");
}

static void put_legend(struct page *page, const struct plot *plot)
{
    page_markup(page, "<ul class=\"legend\">");
    for (uint32_t i = 0; i < plot->series_count; ++i) {
        const struct plot_series *series = &plot->series[i];
        uint32_t style = i % PLOT_STYLES;
        page_markup(page, "<li><svg viewBox=\"-16 -8 32 16\" class=\"s%u\" aria-hidden=\"true\">",
                    style);
        if (series->has_line)
            page_markup(page, "<path class=\"l\" stroke-dasharray=\"%s\" d=\"M-16 0H16\"/>",
                        dashes[style]);
        if (!series->no_markers)
            put_marker(page, style, 0.0, 0.0);
        page_markup(page, "</svg>");
        page_text(page, series->name);
        page_markup(page, "</li>");
    }
    page_markup(page, "</ul>\n");
}

void plot_write(struct page *page, const struct plot *plot)
{
    struct scale x = {.is_log = plot->x.is_log, .low = INFINITY, .high = -INFINITY};
    struct scale y = {.is_log = plot->y.is_log, .low = INFINITY, .high = -INFINITY};
    include_points(plot, &x, &y);
    scale_complete(&x, LEFT, WIDTH - RIGHT);
    scale_complete(&y, HEIGHT - BOTTOM, TOP);
    page_markup(page, "<figure>\n");
    put_legend(page, plot);
    page_markup(page,
                "<div class=\"scroll\"><svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" "
                "role=\"img\" "
                "viewBox=\"0 0 %.0f %.0f\" aria-label=\"",
                WIDTH, HEIGHT);
    page_text(page, plot->title);
    page_markup(page, "\">\n");
    put_axes(page, plot, &x, &y);
    for (uint32_t i = 0; i < plot->series_count; ++i)
        put_series(page, plot, i, &x, &y);
    page_markup(page, "</svg></div>\n<figcaption>");
    page_text(page, plot->title);
    page_markup(page, "</figcaption></figure>\n");
}
