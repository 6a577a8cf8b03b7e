/* How far each figure is from what it must reach, one below the other on a logarithmic axis. */
#include <math.h>

#include "app/plot.h"
#include "bench/table.h"

static const double WIDTH = 760.0, LEFT = 230.0, RIGHT = 150.0, TOP = 34.0, ROW = 22.0,
                    BOTTOM = 44.0;

struct axis {
    double low, high;
};

/* 1: as good as it must be, 2: twice as good. */
static double share_of(const struct goal *goal, double value)
{
    return goal->more ? value / goal->must : goal->must / value;
}

static double place(const struct axis *axis, double share)
{
    return LEFT + (WIDTH - LEFT - RIGHT) * log(share / axis->low) / log(axis->high / axis->low);
}

static void include(struct axis *axis, double share)
{
    axis->low = fmin(axis->low, share);
    axis->high = fmax(axis->high, share);
}

static void put_text(struct page *page, double x, double y, const char *anchor, const char *text)
{
    page_markup(page, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
    page_text(page, text);
    page_markup(page, "</text>\n");
}

static void put_axis(struct page *page, const struct axis *axis, double bottom)
{
    double ticks[PLOT_TICKS_MAX];
    uint32_t count = plot_ticks(axis->low, axis->high, true, 6, ticks);
    for (uint32_t i = 0; i < count; ++i) {
        char text[32];
        snprintf(text, sizeof text, "%.3g", ticks[i]);
        page_markup(page, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", place(axis, ticks[i]),
                    TOP, bottom);
        put_text(page, place(axis, ticks[i]), bottom + 16.0, "middle", text);
    }
    page_markup(page, "<path class=\"must\" d=\"M%.1f %.1fV%.1f\"/>\n", place(axis, 1.0), TOP,
                bottom);
    put_text(page, place(axis, 1.0), bottom + 34.0, "middle",
             "1: what it must reach; to the right is better; ring: the aim");
}

static void put_figure(struct page *page, const struct axis *axis, const struct figure *figure,
                       double y)
{
    char text[TABLE_CELL];
    double x = place(axis, share_of(&figure->goal, figure->value)), from = place(axis, 1.0);
    put_text(page, LEFT - 8.0, y + 4.5, "end", figure->name);
    page_markup(page, "<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"10\"/>\n",
                x < from ? "far" : "good", fmin(x, from), y - 5.0, fmax(fabs(x - from), 1.0));
    page_markup(page, "<circle class=\"aim\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\"/>\n",
                place(axis, share_of(&figure->goal, figure->goal.aim)), y);
    snprintf(text, sizeof text, "%.3g of %.3g%s%s", figure->value, figure->goal.must,
             figure->unit[0] ? " " : "", figure->unit);
    put_text(page, WIDTH - RIGHT + 10.0, y + 4.5, "start", text);
}

static void put_drawing(struct page *page, const struct table *table, const char *title)
{
    struct axis axis = {0.5, 2.0};
    for (uint32_t i = 0; i < table->figure_count; ++i) {
        const struct figure *figure = &table->figures[i];
        include(&axis, share_of(&figure->goal, figure->value));
        include(&axis, share_of(&figure->goal, figure->goal.aim));
    }
    plot_widen(&axis.low, &axis.high, true);
    double bottom = TOP + ROW * (table->figure_count + 1);
    page_markup(page,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\">\n<style>"
                "text{font:13px sans-serif;fill:#222}.grid{stroke:#ddd}.must{stroke:#222}"
                ".far{fill:#d55e00}.good{fill:#0072b2}.aim{fill:none;stroke:#222}</style>\n"
                "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
                WIDTH, bottom + BOTTOM);
    put_text(page, 8.0, 20.0, "start", title);
    put_axis(page, &axis, bottom);
    for (uint32_t i = 0; i < table->figure_count; ++i)
        put_figure(page, &axis, &table->figures[i], TOP + ROW * (i + 1));
    page_markup(page, "</svg>\n");
}

whit_result table_plot(const struct table *table, const char *title, const char *path)
{
    struct page page = {0};
    put_drawing(&page, table, title);
    cli_set_saving();
    whit_result result = page_save(&page, path, &cli_log);
    page_finish(&page);
    return result;
}
