#include "bench/table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"

static void print_head(const struct bench *bench)
{
    const struct bench_request *ask = &bench->ask;
    const struct bench_kind *kind = &bench_kinds[ask->which];
    printf(
        "## whit bench %s\n\n%s, %s.\n%u x %u pixels%s; %u runs of each case, in turns: medians, "
        "± half the width of the middle half.\n",
        kind->name, cli_shown(bench->device_info.name), cli_shown(bench->device_info.driver),
        ask->width, ask->height, kind->is_single ? ", one sample, no bounces, with shadows" : "",
        ask->runs);
    if (ask->quick)
        printf("\n**Quick run: small pictures and few runs, not for figures to be quoted.**\n");
    fflush(stdout);
}

void table_begin(struct table *table, struct bench *bench, const char *name,
                 const char *const *heads, bool has_goals, uint32_t steps)
{
    static const char *const last[] = {"figure", "must", "aim", "verdict", NULL};
    *table = (struct table){.bench = bench,
                            .object = document_object(),
                            .has_goals = has_goals,
                            .column_count = TABLE_COLUMNS_MAX};
    if (!bench->has_head)
        print_head(bench);
    bench->has_head = true;
    document_text(table->object, "table", name);
    table->rows = document_list(table->object, "rows");
    table->sentences = document_list(table->object, "sentences");
    table->left_out = document_list(table->object, "left_out");
    table_row(table);
    for (; *heads; ++heads)
        table_cell(table, "%s", *heads);
    for (heads = last; has_goals && *heads; ++heads)
        table_cell(table, "%s", *heads);
    table->column_count = table->cell;
    cli_progress_init(&bench->progress, bench->ask.settings.quiet);
    bench->step = 0;
    bench->step_count = steps;
}

void table_row(struct table *table)
{
    table->is_short |= !ARRAY_PUSH(table->lines, table->line_count, table->line_capacity,
                                   (struct table_line){{{0}}});
    table->cell = 0;
}

void table_cell(struct table *table, const char *format, ...)
{
    char text[TABLE_CELL];
    if (table->cell >= table->column_count || table->is_short)
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    whit_text_show(text, table->lines[table->line_count - 1].cells[table->cell++], TABLE_CELL);
}

void table_ms(struct table *table, const struct sample_runs *times)
{
    const struct sample_summary ms = sample_of(times);
    int decimals = ms.median < 10.0 ? 2 : ms.median < 100.0 ? 1 : 0;
    if (times->count)
        table_cell(table, "%.*f ± %.*f", decimals, ms.median, decimals, ms.spread);
    else
        table_cell(table, "-");
}

json_t *table_times(const struct sample_runs *times)
{
    const struct sample_summary ms = sample_of(times);
    json_t *object = document_object();
    document_ms(object, "median", ms.median);
    document_ms(object, "spread", ms.spread);
    document_count(object, "runs", times->count);
    return object;
}

struct figure table_ratio(const struct sample_runs *a, const struct sample_runs *b,
                          struct goal goal)
{
    const struct sample_runs ratio = sample_ratio(a, b);
    const struct sample_summary sum = sample_of(&ratio);
    if (ratio.count == 0)
        return (struct figure){.unit = "", .value = NAN};
    return (struct figure){.unit = "", .value = sum.median, .spread = sum.spread, .goal = goal};
}

void table_keep(struct table *table, json_t *row)
{
    document_append(table->rows, row);
}

void table_figure(struct table *table, const struct figure *figure, json_t *row)
{
    const struct goal *goal = &figure->goal;
    const char *space = figure->unit[0] ? " " : "";
    bool is_asked = goal->must > 0.0;
    bool held = goal->more ? figure->value >= goal->must : figure->value <= goal->must;
    const char *verdict = held ? "held" : "short";
    if (isnan(figure->value))
        table_cell(table, "-");
    else if (figure->spread > 0.0)
        table_cell(table, "%.3g ± %.1g%s%s", figure->value, figure->spread, space, figure->unit);
    else
        table_cell(table, "%.3g%s%s", figure->value, space, figure->unit);
    table_cell(table, is_asked ? "%.3g" : "-", goal->must);
    table_cell(table, is_asked ? "%.3g" : "-", goal->aim);
    table_cell(table, "%s", is_asked ? verdict : "-");
    document_number(row, "figure", figure->value);
    document_number(row, "spread", figure->spread);
    document_text(row, "unit", figure->unit);
    document_number(row, "must", is_asked ? goal->must : NAN);
    document_number(row, "aim", is_asked ? goal->aim : NAN);
    document_flag(row, "more_is_better", goal->more);
    document_text(row, "verdict", is_asked ? verdict : NULL);
    table_keep(table, row);
    if (is_asked && figure->value > 0.0)
        table->is_short |=
            !ARRAY_PUSH(table->figures, table->figure_count, table->figure_capacity, *figure);
}

void table_goal(struct table *table, const char *key, const char *name, double value,
                const char *unit, struct goal goal)
{
    struct figure figure = {.unit = unit, .value = value, .goal = goal};
    json_t *row = document_object();
    snprintf(figure.name, sizeof figure.name, "%s", name);
    document_text(row, key, name);
    table_row(table);
    table_cell(table, "%s", name);
    table_figure(table, &figure, row);
}

void table_say(struct table *table, const char *format, ...)
{
    char text[400], shown[sizeof text];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    document_append(table->sentences, json_string(whit_text_show(text, shown, sizeof shown)));
}

void table_leave_out(struct table *table, const char *name, const char *why)
{
    json_t *object = document_entry(table->left_out);
    document_text(object, "name", name);
    document_text(object, "why", why);
    table_say(table, "Left out: %s: %s.", name, why);
}

/* The number of characters in a UTF-8 text. */
static size_t count_letters(const char *text)
{
    size_t count = 0;
    for (; *text; ++text)
        count += ((unsigned char)*text & 0xc0) != 0x80;
    return count;
}

static void print_padded(const char *text, size_t width, bool right, bool ends)
{
    int pad = (int)(width - count_letters(text));
    printf(" %*s%s%*s%s", right ? pad : 0, "", text, right ? 0 : pad, "", ends ? "" : " |");
}

static void print_rule(const struct table *table, const size_t *widths)
{
    putchar('|');
    for (uint32_t c = 0; c < table->column_count; ++c) {
        for (size_t i = 0; i < widths[c] + 1; ++i)
            putchar('-');
        putchar(c ? ':' : '-');
        fputs(table->has_goals && c + 1 == table->column_count ? "" : "|", stdout);
    }
    putchar('\n');
}

static void print_table(const struct table *table)
{
    size_t widths[TABLE_COLUMNS_MAX] = {0};
    for (uint32_t r = 0; r < table->line_count; ++r) {
        for (uint32_t c = 0; c < table->column_count; ++c) {
            size_t letters = count_letters(table->lines[r].cells[c]);
            widths[c] = letters > widths[c] ? letters : widths[c];
        }
    }
    for (uint32_t r = 0; r < table->line_count; ++r) {
        putchar('|');
        for (uint32_t c = 0; c < table->column_count; ++c)
            print_padded(table->lines[r].cells[c], widths[c], c > 0,
                         table->has_goals && c + 1 == table->column_count);
        putchar('\n');
        if (r == 0)
            print_rule(table, widths);
    }
}

/* Prints the table, and writes its plot. */
static whit_result publish(const struct table *table)
{
    const struct bench *bench = table->bench;
    size_t i;
    json_t *sentence;
    printf("\n### %s\n\n", table->title);
    print_table(table);
    putchar('\n');
    json_array_foreach(table->sentences, i, sentence) printf("- %s\n", json_string_value(sentence));
    fflush(stdout);
    document_append(bench->tables, json_incref(table->object));
    return table->has_goals && bench->ask.plot ? table_plot(table, bench->ask.plot) : WHIT_OK;
}

whit_result table_end(struct table *table, const char *title, whit_result result)
{
    cli_progress_finish(&table->bench->progress);
    table->title = title;
    if (table->is_short)
        result = result == WHIT_OK ? WHIT_ERROR_MEMORY : result;
    else if (result == WHIT_OK)
        result = publish(table);
    else if (cli_cancel && table->line_count > 1) {
        table_say(table, "Interrupted: rows are missing.");
        (void)publish(table);
    }
    json_decref(table->object);
    free(table->lines);
    free(table->figures);
    return result;
}
