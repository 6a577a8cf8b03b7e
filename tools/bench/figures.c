#include "figures.h"

#include <math.h>
#include <string.h>

json_t *figures_times(const struct sample_runs *times)
{
    json_t *object = document_object();
    document_ms(object, "median", sample_of(times).median);
    document_ms(object, "spread", sample_of(times).spread);
    document_count(object, "runs", times->count);
    return object;
}

void figures_begin(struct figures *figures, struct bench *bench, const char *name,
                   const char *const *heads, uint32_t steps)
{
    static const char *const last[] = {"figure", "must", "aim", "verdict"};
    const char *all[TABLE_COLUMNS_MAX + 1] = {0};
    uint32_t count = 0;
    while (heads[count] && count + 4 < TABLE_COLUMNS_MAX) {
        all[count] = heads[count];
        ++count;
    }
    memcpy(all + count, last, sizeof last);
    figures->count = 0;
    figures->left_out = document_array();
    section_begin(&figures->section, bench, name, steps);
    table_begin(&figures->section.table, all);
    figures->section.table.is_open = true;
}

static bool is_reached(const struct figure *figure)
{
    const struct goal *goal = &figure->goal;
    return goal->more ? figure->value >= goal->must : figure->value <= goal->must;
}

void figures_row(struct figures *figures, const struct figure *figure, json_t *row)
{
    struct table *table = &figures->section.table;
    const struct goal *goal = &figure->goal;
    const char *space = figure->unit[0] ? " " : "";
    const char *verdict = goal->must == 0.0 ? "" : is_reached(figure) ? "held" : "short";
    if (isnan(figure->value)) /* there is nothing to compare with */
        table_cell(table, "-");
    else if (figure->spread > 0.0)
        table_cell(table, "%.3g ± %.1g%s%s", figure->value, figure->spread, space, figure->unit);
    else
        table_cell(table, "%.3g%s%s", figure->value, space, figure->unit);
    if (goal->must > 0.0) {
        table_cell(table, "%.3g", goal->must);
        table_cell(table, "%.3g", goal->aim);
        table_cell(table, "%s", verdict);
    } else {
        table_cell(table, "-");
        table_cell(table, "-");
        table_cell(table, "-");
    }
    document_number(row, "figure", figure->value);
    document_number(row, "spread", figure->spread);
    document_text(row, "unit", figure->unit);
    document_number(row, "must", goal->must > 0.0 ? goal->must : NAN);
    document_number(row, "aim", goal->must > 0.0 ? goal->aim : NAN);
    document_flag(row, "more_is_better", goal->more);
    document_text(row, "verdict", goal->must > 0.0 ? verdict : NULL);
    document_append(figures->section.rows, row);
    if (figures->count < TABLE_ROWS_MAX)
        figures->list[figures->count++] = *figure;
}

void figures_leave_out(struct figures *figures, const char *name, const char *why)
{
    json_t *object = document_object();
    document_text(object, "name", name);
    document_text(object, "why", why);
    document_append(figures->left_out, object);
    section_say(&figures->section, "Left out: %s: %s.", cli_shown(name), cli_shown(why));
}

whit_result figures_end(struct figures *figures, const char *title, whit_result result)
{
    const struct bench *bench = figures->section.bench;
    document_put(figures->section.object, "left_out", figures->left_out);
    result = section_end(&figures->section, title, result);
    if (result == WHIT_OK && bench->plot)
        result = figures_plot(figures, title, bench->plot);
    return result;
}
