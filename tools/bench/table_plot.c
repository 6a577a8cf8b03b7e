/* Plots how far each figure is from its limit, one below the other on a logarithmic axis. */
#include <math.h>
#include <stdio.h>

#include "bench/table.h"

static const double WIDTH = 760.0, LEFT = 230.0, RIGHT = 150.0, TOP = 34.0, ROW = 22.0,
                    BOTTOM = 44.0;

struct axis {
    double low, high;
};

/* The figure relative to its limit: 1 is just reached, 2 twice as good. */
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

/* Escapes text for XML, as names of models and scenes come from files. */
static void put_text(FILE *to, double x, double y, const char *anchor, const char *text)
{
    fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
    for (text = cli_shown(text); *text; ++text) {
        if (*text == '<' || *text == '&')
            fprintf(to, "&#%d;", *text);
        else
            fputc(*text, to);
    }
    fputs("</text>\n", to);
}

static void put_axis(FILE *to, const struct axis *axis, double bottom)
{
    for (double tick = exp2(ceil(log2(axis->low))); tick <= axis->high; tick *= 2.0) {
        char text[32];
        snprintf(text, sizeof text, "%.3g", tick);
        fprintf(to, "<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", place(axis, tick), TOP,
                bottom);
        put_text(to, place(axis, tick), bottom + 16.0, "middle", text);
    }
    fprintf(to, "<path class=\"must\" d=\"M%.1f %.1fV%.1f\"/>\n", place(axis, 1.0), TOP, bottom);
    put_text(to, place(axis, 1.0), bottom + 34.0, "middle",
             "1: what it must reach; to the right is better; ring: the aim");
}

static void put_figure(FILE *to, const struct axis *axis, const struct figure *figure, double y)
{
    char text[TABLE_CELL];
    double x = place(axis, share_of(&figure->goal, figure->value)), from = place(axis, 1.0);
    put_text(to, LEFT - 8.0, y + 4.5, "end", figure->name);
    fprintf(to, "<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"10\"/>\n",
            x < from ? "far" : "good", fmin(x, from), y - 5.0, fmax(fabs(x - from), 1.0));
    fprintf(to, "<circle class=\"aim\" cx=\"%.1f\" cy=\"%.1f\" r=\"4\"/>\n",
            place(axis, share_of(&figure->goal, figure->goal.aim)), y);
    snprintf(text, sizeof text, "%.3g of %.3g%s%s", figure->value, figure->goal.must,
             figure->unit[0] ? " " : "", figure->unit);
    put_text(to, WIDTH - RIGHT + 10.0, y + 4.5, "start", text);
}

static void put_drawing(FILE *to, const void *user)
{
    const struct table *table = user;
    struct axis axis = {0.5, 2.0};
    for (uint32_t i = 0; i < table->figure_count; ++i) {
        const struct figure *figure = &table->figures[i];
        include(&axis, share_of(&figure->goal, figure->value));
        include(&axis, share_of(&figure->goal, figure->goal.aim));
    }
    include(&axis, axis.low / 1.1);
    include(&axis, axis.high * 1.1);
    double bottom = TOP + ROW * (table->figure_count + 1);
    fprintf(to,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\">\n<style>"
            "text{font:13px sans-serif;fill:#222}.grid{stroke:#ddd}.must{stroke:#222}"
            ".far{fill:#d55e00}.good{fill:#0072b2}.aim{fill:none;stroke:#222}</style>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            WIDTH, bottom + BOTTOM);
    put_text(to, 8.0, 20.0, "start", table->title);
    put_axis(to, &axis, bottom);
    for (uint32_t i = 0; i < table->figure_count; ++i)
        put_figure(to, &axis, &table->figures[i], TOP + ROW * (i + 1));
    fprintf(to, "</svg>\n");
}

whit_result table_plot(const struct table *table, const char *path)
{
    cli_set_saving();
    return document_save_written(path, put_drawing, table);
}
