/* The report of `whit cost` as one page. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost.h"
#include "app/plot.h"

enum { POINTS_MAX = COST_ROWS_MAX };

/* ---- Plots ---- */

struct points {
    struct plot_point list[POINTS_MAX];
    char titles[POINTS_MAX][256];
    uint32_t count;
};

static void add_point(struct points *points, const struct cost_report *report,
                      const struct cost_row *row, double x, double y, bool has_bar)
{
    if (points->count == POINTS_MAX)
        return;
    char *title = points->titles[points->count];
    snprintf(title, sizeof points->titles[0], "%s %s: %.4g ms, RMSE %.3g, FLIP %.4f%s", row->knob,
             row->setting, row->ms[report->clock], row->error.rmse, row->error.flip_mean,
             row->best ? ", best" : "");
    points->list[points->count++] = (struct plot_point){
        .x = x,
        .y = y,
        .x_low = has_bar ? row->ms_low : x,
        .x_high = has_bar ? row->ms_high : x,
        .y_low = y,
        .y_high = y,
        .title = title,
        .marked = row->best,
    };
}

static uint32_t group_of(const struct cost_row *row)
{
    if (strcmp(row->knob, "aa") == 0)
        return 1;
    if (strcmp(row->knob, "depth") == 0 || strcmp(row->knob, "bailout") == 0)
        return 2;
    if (strcmp(row->knob, "usual") == 0 || strcmp(row->knob, "chosen") == 0)
        return 0;
    return row->change == SETTING_LIGHT ? 3 : row->change == SETTING_HITS ? 4 : 5;
}

static void put_pareto(struct page *page, const struct cost_report *report, enum cost_metric metric)
{
    enum { GROUPS = 6 };
    static const char *const names[GROUPS] = {"usual and chosen", "samples", "depth and bail-out",
                                              "shading",          "hits",    "nothing may change"};
    static const char *const titles[] = {"RMSE against the reference",
                                         "FLIP against the reference"};
    struct points *points = calloc(GROUPS, sizeof *points);
    struct plot_series series[GROUPS] = {{0}};
    if (!points) {
        page->failed = true;
        return;
    }
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (row->measured)
            add_point(&points[group_of(row)], report, row, row->ms[report->clock],
                      cost_error_of(&row->error, metric), true);
    }
    for (uint32_t g = 0; g < GROUPS; ++g)
        series[g] = (struct plot_series){
            .name = names[g], .points = points[g].list, .count = points[g].count};
    const struct plot plot = {
        .title = metric == COST_RMSE ? "Time and RMSE of every setting; rimmed: nothing is both "
                                       "cheaper and more right"
                                     : "Time and FLIP of every setting",
        .x = {.title = "ms of the full picture", .is_log = true},
        .y = {.title = titles[metric], .is_log = true},
        .series = series,
        .series_count = GROUPS,
    };
    plot_write(page, &plot);
    free(points);
}

static int compare_points(const void *a, const void *b)
{
    double x = ((const struct plot_point *)a)->x, y = ((const struct plot_point *)b)->x;
    return (x > y) - (x < y);
}

/* Error over a knob whose settings are numbers. */
static void put_convergence(struct page *page, const struct cost_report *report, const char *knob,
                            const char *title, const char *axis, bool is_log, bool alone)
{
    uint32_t count, index = knob_find(knob);
    const struct knob *table = &knob_table(&count)[index];
    struct points *points = calloc(1, sizeof *points);
    if (!points) {
        page->failed = true;
        return;
    }
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        bool is_usual = i == 0;
        if (!row->measured || (!is_usual && row->knob_index != index))
            continue;
        const char *name = knob_setting_name(table, is_usual ? table->usual : row->setting_index);
        double value = strtod(name, NULL);
        if (name[strspn(name, "0123456789")])
            continue;
        /* The same samples as the reference's say nothing of how error falls. */
        if (!alone && value >= report->reference_samples)
            continue;
        add_point(points, report, row, value, alone ? row->alone.rmse : row->error.rmse, false);
    }
    qsort(points->list, points->count, sizeof points->list[0], compare_points);
    const struct plot_series series = {
        .name = "RMSE", .points = points->list, .count = points->count, .has_line = true};
    const struct plot plot = {.title = title,
                              .x = {.title = axis, .is_log = is_log},
                              .y = {.title = "RMSE", .is_log = true},
                              .series = &series,
                              .series_count = 1};
    if (points->count > 1)
        plot_write(page, &plot);
    free(points);
}

/* ---- Tables ---- */

static void put_row(struct page *page, const struct page_column *columns, uint32_t count,
                    const struct cost_cells *cells, bool marked)
{
    const char *texts[COST_COLUMNS_MAX];
    for (uint32_t i = 0; i < count; ++i)
        texts[i] = cells->text[i];
    page_table_row(page, columns, count, texts, marked);
}

static void put_tables(struct page *page, const struct cost_report *report)
{
    struct cost_cells cells;
    page_table_begin(page, "Bold: nothing is both cheaper and more right.", cost_columns,
                     COST_COLUMNS);
    for (uint32_t i = 0; i < report->row_count; ++i) {
        cost_row_cells(report, &report->rows[i], &cells);
        if (report->rows[i].measured || report->rows[i].note[0])
            put_row(page, cost_columns, COST_COLUMNS, &cells, report->rows[i].best);
    }
    page_table_end(page);
    page_heading(page, "Hits, held against exact arithmetic");
    page_table_begin(page, "Rays of the picture, and rays aimed at the scene's edges and vertices.",
                     cost_hit_columns, COST_HIT_COLUMNS);
    for (uint32_t i = 0; i < report->row_count; ++i) {
        for (uint32_t set = 0; set < COST_SETS; ++set) {
            cost_hit_cells(&report->rows[i], (enum cost_set)set, &cells);
            if (report->rows[i].hits[set].traced)
                put_row(page, cost_hit_columns, COST_HIT_COLUMNS, &cells, false);
        }
    }
    page_table_end(page);
}

/* ---- Pictures ---- */

static void put_pictures(struct page *page, const struct cost_report *report)
{
    const whit_heat_params heat = {.scale = 1.0, .title = "FLIP", .unit = "0: looks the same"};
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        char name[128], caption[192];
        whit_image *map = NULL;
        if (!row->picture || !row->flip || !report->reference)
            continue;
        /* What changes nothing has no picture of its own. */
        if (i > 0 && row->pixels_changed == 0)
            continue;
        snprintf(name, sizeof name, "%s %s", row->knob, row->setting);
        snprintf(caption, sizeof caption, "%s: FLIP %.4f, RMSE %.3g", name, row->error.flip_mean,
                 row->error.rmse);
        page_markup(page, "<details><summary>");
        page_text(page, caption);
        page_markup(page, "</summary>\n");
        page_flip(page, row->picture, name, report->reference, "reference");
        if (whit_image_heat(row->flip, &heat, &map) == WHIT_OK)
            page_picture(page, map, "where it differs", "FLIP of each pixel");
        page_markup(page, "</details>\n");
        whit_image_destroy(map);
    }
}

/* ---- The page ---- */

static void say_paragraph(void *user, const char *sentence)
{
    page_paragraph(user, "%s", sentence);
}

static void put_title(struct page *page, const struct cost *cost)
{
    char title[512];
    snprintf(title, sizeof title, "What accuracy costs in %.400s", cost->job.settings.scene);
    page_begin(page, title);
}

whit_result cost_save_page(const struct cost *cost)
{
    const struct cost_report *report = cost->report;
    struct page page = {0};
    put_title(&page, cost);
    page_code(&page, cost->command);
    page_paragraph(&page, "On %s (%s), in %.0f s.", report->device, report->driver,
                   report->spent_ms * 1e-3);
    cost_say_answers(report, say_paragraph, &page);
    page_heading(&page, "Price and error");
    put_pareto(&page, report, COST_RMSE);
    put_pareto(&page, report, COST_FLIP);
    put_convergence(&page, report, "aa",
                    "Error by samples of a pixel, fewer than the reference has", "samples", true,
                    false);
    put_convergence(&page, report, "depth",
                    "Error by bounces, beside the reference with the same single sample",
                    "most bounces", false, true);
    page_heading(&page, "Every setting");
    put_tables(&page, report);
    page_heading(&page, "Pictures");
    page_paragraph(&page, "Of %u x %u pixels; open one to flip between it and the reference.",
                   report->judged_width, report->judged_height);
    put_pictures(&page, report);
    page_heading(&page, "How it was measured");
    cost_say_method(report, say_paragraph, &page);
    page_end(&page);
    whit_result result = page_save(&page, cost->html, &cli_log);
    page_finish(&page);
    return result;
}
