/* The tables of `whit cost`, as text, Markdown and CSV. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost_table.h"
#include "base/text.h"
#include "whit/whit_program.h"

/* `is_number`: the column is right-aligned. */
struct cost_column {
    const char *head;
    bool is_number;
};
enum { COST_COLUMNS = 11, COST_HIT_COLUMNS = 13, COST_CELL = 64, COST_COLUMNS_MAX = 13 };
struct cost_cells {
    char text[COST_COLUMNS_MAX][COST_CELL];
};
static const struct cost_column cost_columns[COST_COLUMNS] = {
    {"knob", false},    {"setting", false}, {"ms", true},   {"95 %", true},
    {"of usual", true}, {"RMSE", true},     {"FLIP", true}, {"over 1/255", true},
    {"largest", true},  {"alone", true},    {"", false},
};
static const struct cost_column cost_hit_columns[COST_HIT_COLUMNS] = {
    {"knob", false},  {"setting", false}, {"rays", false}, {"N", true},     {"wrong", true},
    {"leaks", true},  {"misses", true},   {"false", true}, {"other", true}, {"ulp, half", true},
    {"99.9 %", true}, {"most", true},     {"ms", true},
};

/* ---- Cells ---- */

static void put(char cell[COST_CELL], const char *format, ...) WHIT_PRINTF(2, 3);
static void put(char cell[COST_CELL], const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(cell, COST_CELL, format, args);
    va_end(args);
}

static void put_ms(char cell[COST_CELL], double ms)
{
    if (!(ms >= 0.0))
        put(cell, "-");
    else
        put(cell, "%.*f", ms < 10.0 ? 3 : ms < 100.0 ? 2 : ms < 1e4 ? 1 : 0, ms);
}

/* The last column: remarks on the row. */
static void put_remark(const struct cost_report *report, const struct cost_row *row,
                       char cell[COST_CELL])
{
    if (row->note[0])
        put(cell, "%.60s", row->note);
    else if (row->broken)
        put(cell, "NOT THE SAME: %llu pixels, %llu ids", (unsigned long long)row->pixels_changed,
            (unsigned long long)row->ids_changed);
    else if (row == &report->rows[0])
        put(cell, "%s", row->best ? "best" : "");
    else
        put(cell, "%s%s%s", row->best ? "best" : "",
            row->best && row->price.verdict == 0 ? ", " : "",
            row->price.verdict == 0 ? "not distinguishable" : "");
    if (row->change == SETTING_HITS && row->ids_changed && !row->note[0])
        text_add(cell, COST_CELL, "%s%llu ids are other", cell[0] ? ", " : "",
                 (unsigned long long)row->ids_changed);
}

static void fill_row(const struct cost_report *report, const struct cost_row *row,
                     struct cost_cells *cells)
{
    const struct sample_median *ratio = &row->price.ratio[report->clock];
    const whit_difference *error = &row->error;
    char low[COST_CELL], high[COST_CELL];
    memset(cells, 0, sizeof *cells);
    put(cells->text[0], "%s", row->knob);
    put(cells->text[1], "%s", row->setting);
    put_remark(report, row, cells->text[10]);
    if (!row->measured)
        return;
    put_ms(cells->text[2], row->ms[report->clock]);
    put_ms(low, row->ms_low);
    put_ms(high, row->ms_high);
    put(cells->text[3], "%.28s to %.28s", low, high);
    put(cells->text[4], "x %.3f", row == &report->rows[0] ? 1.0 : ratio->median);
    put(cells->text[5], "%.3g", error->rmse);
    put(cells->text[6], "%.4f", error->flip_mean);
    put(cells->text[7], "%.2f %%",
        100.0 * (double)error->over_1_255 / (double)(error->pixel_count ? error->pixel_count : 1));
    put(cells->text[8], "%.3g", error->largest);
    if (row->alone.pixel_count)
        put(cells->text[9], "%.3g", row->alone.rmse);
    else
        put(cells->text[9], "-");
}

static void fill_hits(const struct cost_row *row, enum cost_set set, struct cost_cells *cells)
{
    const struct cost_hits *hits = &row->hits[set];
    const whit_judgement *judged = &hits->judged;
    const uint64_t counts[] = {judged->tally.rays,       judged->tally.wrong,
                               judged->tally.leaks,      judged->tally.misses,
                               judged->tally.false_hits, judged->tally.other_ids};
    const double ulps[] = {judged->ulp_median, judged->ulp_999, judged->ulp_max};
    memset(cells, 0, sizeof *cells);
    put(cells->text[0], "%s", row->knob);
    put(cells->text[1], "%s", row->setting);
    put(cells->text[2], "%s", cost_set_name(set));
    if (hits->unanswered) {
        put(cells->text[3], "no answer");
        return;
    }
    for (uint32_t i = 0; i < 6; ++i)
        put(cells->text[3 + i], "%llu", (unsigned long long)counts[i]);
    for (uint32_t i = 0; i < 3; ++i)
        put(cells->text[9 + i], "%.6g", ulps[i]);
    put_ms(cells->text[12], hits->ms);
}

/* ---- Sentences ---- */

static void say_it(cost_say *say, void *user, const char *format, ...) WHIT_PRINTF(3, 4);
static void say_it(cost_say *say, void *user, const char *format, ...)
{
    char text[COST_ABSENT_MAX * sizeof(struct cost_absent)];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    say(user, text);
}

void cost_say_method(const struct cost_report *report, cost_say *say, void *user)
{
    static const char *const clocks[] = {"wall clock", "CPU time of all threads", "device time"};
    const struct cost_price *price = &report->rows[0].price;
    const struct sample_median *ratio = &price->ratio[report->clock];
    say_it(
        say, user,
        "Times: %s of a %u x %u picture; each setting and the usual ones in turns; medians, with "
        "intervals of 95 %% of their ratios. Pictures that take long are timed smaller.",
        clocks[report->clock], report->width, report->height);
    say_it(
        say, user,
        "Errors: of a %u x %u picture, linear RGB, against the reference in double with %u "
        "samples a pixel, %u bounces and a bail-out of 1/65536; `alone`: RMSE against the "
        "reference with "
        "the same single sample, which leaves out what samples do. %u samples are those of the "
        "reference: their rows, adaptive ones too, say nothing of what more would change, and "
        "count with at least half the sampling error of a quarter of them. `best`: nothing is both "
        "cheaper and more right.",
        report->judged_width, report->judged_height, report->reference_samples,
        report->reference_depth, report->reference_samples);
    say_it(
        say, user,
        "Measured beside itself the usual picture takes %.3f of itself (%.3f to %.3f, %u pairs).",
        ratio->median, ratio->low, ratio->high, price->rounds);
    if (!report->complete)
        say_it(say, user, "This report is not complete: it was stopped.");
}

static void say_list(const struct cost_report *report, enum cost_use use, const char *what,
                     cost_say *say, void *user)
{
    char list[800] = "";
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (row->measured && row->knob_index != WHIT_NONE && !row->broken &&
            cost_use_of(report, row) == use)
            text_add(list, sizeof list, "%s%s %s", list[0] ? ", " : "", row->knob, row->setting);
    }
    if (list[0])
        say_it(say, user, "%s: %s.", what, list);
}

/* Says after how many pictures the faster rendering by a tree outweighs its longer build. All by
   the wall clock, by which builds are timed. */
static void say_break_even(const struct cost_report *report, cost_say *say, void *user)
{
    const struct cost_row *usual = &report->rows[0];
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        const struct sample_median *difference = &row->price.difference[COST_WALL];
        bool told_apart = difference->low > 0.0 || difference->high < 0.0;
        double saved_ms = usual->ms[COST_WALL] - row->ms[COST_WALL];
        double built_ms = row->build_ms - usual->build_ms;
        if (!row->measured || row->build_ms < 0.0)
            continue;
        if (!told_apart || saved_ms * built_ms <= 0.0)
            say_it(say, user,
                   "%s %s: %.1f ms to build beside %.1f; a picture is %s, by the wall clock.",
                   row->knob, row->setting, row->build_ms, usual->build_ms,
                   !told_apart      ? "not distinguishable"
                   : saved_ms > 0.0 ? "cheaper"
                                    : "dearer");
        else
            say_it(say, user,
                   "%s %s: %.1f ms to build beside %.1f; %s from %.0f picture%s on, by the wall "
                   "clock.",
                   row->knob, row->setting, row->build_ms, usual->build_ms,
                   saved_ms > 0.0 ? "cheaper" : "dearer", ceil(built_ms / saved_ms),
                   built_ms / saved_ms <= 1.0 ? "" : "s");
    }
}

/* Lists the settings that were not measured, and behind those of one reason the reason. */
static void say_absent(const struct cost_report *report, cost_say *say, void *user)
{
    char list[sizeof report->absent] = "";
    for (uint32_t i = 0; i < report->absent_count; ++i) {
        const struct cost_absent *absent = &report->absent[i];
        bool last = i + 1 == report->absent_count || strcmp(absent[1].why, absent->why) != 0;
        text_add(list, sizeof list, "%s%s", i ? ", " : "", absent->name);
        if (last)
            text_add(list, sizeof list, " (%s)", absent->why);
    }
    if (list[0])
        say_it(say, user, "Not here: %s.", list);
}

static void say_answer(const struct cost_report *report, const struct cost_answer *answer,
                       cost_say *say, void *user)
{
    bool within = answer->goal.kind == COST_WITHIN;
    const char *metric = cost_metric_name(answer->goal.metric);
    char wish[96];
    if (within)
        snprintf(wish, sizeof wish, "Best picture within %.6g ms", answer->goal.limit);
    else
        snprintf(wish, sizeof wish, "Cheapest with %s up to %.6g", metric, answer->goal.limit);
    if (!answer->found) {
        say_it(say, user, "%s: no setting does it.", wish);
        return;
    }
    const struct cost_row *row = answer->row == WHIT_NONE ? NULL : &report->rows[answer->row];
    if (!row || !row->measured) {
        say_it(say, user, "%s: predicted %.1f ms (wall clock) and %s %.3g, not measured.", wish,
               answer->ms, metric, answer->error);
        return;
    }
    char error[64] = "an error that a reference of no more samples cannot tell";
    if (cost_is_judged(report, row))
        snprintf(error, sizeof error, "%.3g", cost_error_of(&row->error, answer->goal.metric));
    say_it(say, user,
           "%s: %s. Predicted %.1f ms and %s %.3g; measured %.1f ms and %s (ms: wall clock): %s.",
           wish, row->option[0] ? row->option : "the usual settings", answer->ms, metric,
           answer->error, row->ms[COST_WALL], error, answer->kept ? "kept" : "NOT KEPT");
}

void cost_say_answers(const struct cost_report *report, cost_say *say, void *user)
{
    for (uint32_t i = 0; i < report->answer_count; ++i)
        if (!(report->answers[i].goal.of_usual > 0.0) || report->answers[i].kept)
            say_answer(report, &report->answers[i], say, user);
    say_list(report, COST_USE_FREE, "Cheaper than the usual settings, and as right", say, user);
    say_list(report, COST_USE_NONE, "Buy nothing here (neither cheaper nor more right)", say, user);
    say_break_even(report, say, user);
    say_absent(report, say, user);
}

/* ---- Text and Markdown ---- */

struct cost_table {
    FILE *to;
    bool markdown;
    const struct cost_column *columns;
    uint32_t count, widths[COST_COLUMNS_MAX], row_count;
    struct cost_cells rows[2 * COST_ROWS_MAX + 1];
};

static void put_row(const struct cost_table *table, const struct cost_cells *cells)
{
    fputs(table->markdown ? "|" : "", table->to);
    for (uint32_t i = 0; i < table->count; ++i) {
        if (table->markdown)
            fprintf(table->to, " %s |", cells->text[i]);
        else
            fprintf(table->to, table->columns[i].is_number ? "%*s  " : "%-*s  ",
                    (int)table->widths[i], cells->text[i]);
    }
    fputc('\n', table->to);
}

static void add(struct cost_table *table, const struct cost_cells *cells)
{
    table->rows[table->row_count++] = *cells;
    for (uint32_t i = 0; i < table->count; ++i) {
        uint32_t length = (uint32_t)strlen(cells->text[i]);
        table->widths[i] = length > table->widths[i] ? length : table->widths[i];
    }
}

static void add_head(struct cost_table *table, const struct cost_column *columns, uint32_t count)
{
    struct cost_cells cells = {0};
    table->columns = columns;
    table->count = count;
    for (uint32_t i = 0; i < count; ++i)
        snprintf(cells.text[i], COST_CELL, "%s", columns[i].head);
    add(table, &cells);
}

static void put_table(struct cost_table *table)
{
    for (uint32_t i = 0; i < table->row_count; ++i) {
        put_row(table, &table->rows[i]);
        if (i > 0 || !table->markdown)
            continue;
        fputc('|', table->to);
        for (uint32_t k = 0; k < table->count; ++k)
            fputs(table->columns[k].is_number ? "---:|" : "---|", table->to);
        fputc('\n', table->to);
    }
    fputc('\n', table->to);
    table->row_count = 0;
    memset(table->widths, 0, sizeof table->widths);
}

static void put_tables(const struct cost_report *report, FILE *to, bool markdown)
{
    struct cost_table *table = calloc(1, sizeof *table);
    struct cost_cells cells;
    if (!table)
        return;
    table->to = to;
    table->markdown = markdown;
    add_head(table, cost_columns, COST_COLUMNS);
    for (uint32_t i = 0; i < report->row_count; ++i) {
        fill_row(report, &report->rows[i], &cells);
        if (report->rows[i].measured || report->rows[i].note[0])
            add(table, &cells);
    }
    put_table(table);
    add_head(table, cost_hit_columns, COST_HIT_COLUMNS);
    for (uint32_t i = 0; i < report->row_count; ++i) {
        for (uint32_t set = 0; set < COST_SETS; ++set) {
            fill_hits(&report->rows[i], (enum cost_set)set, &cells);
            if (report->rows[i].hits[set].traced)
                add(table, &cells);
        }
    }
    if (table->row_count > 1)
        put_table(table);
    free(table);
}

static void say_plain(void *user, const char *sentence)
{
    fprintf(user, "%s\n", sentence);
}

static void say_item(void *user, const char *sentence)
{
    fprintf(user, "- %s\n", sentence);
}

int cost_print_text(const struct cost *cost)
{
    const struct cost_report *report = cost->report;
    printf("scene      %s\n", cli_shown(cost->job.settings.scene));
    printf("device     %s (%s)\n\n", cli_shown(report->device), cli_shown(report->driver));
    char sentence[COST_SENTENCE_BYTES];
    cost_sentence(report, sentence);
    printf("%s\n\n", sentence);
    put_tables(report, stdout, false);
    cost_say_method(report, say_plain, stdout);
    putchar('\n');
    cost_say_answers(report, say_plain, stdout);
    return cli_finish_stdout(EXIT_FINE);
}

void cost_write_markdown(FILE *to, const void *user)
{
    const struct cost *cost = user;
    const struct cost_report *report = cost->report;
    fprintf(to, "    %s\n\nOn %s (%s), %.0f s.\n\n", cost->command, cli_shown(report->device),
            cli_shown(report->driver), report->spent_ms * 1e-3);
    put_tables(report, to, true);
    cost_say_method(report, say_item, to);
    cost_say_answers(report, say_item, to);
}

/* ---- CSV ---- */

/* Writes a quoted CSV field; quotes inside it are doubled (RFC 4180). */
static void put_quoted(FILE *to, const char *name)
{
    fputc('"', to);
    for (const char *text = cli_shown(name); *text; ++text) {
        if (*text == '"')
            fputc('"', to);
        fputc(*text, to);
    }
    fputc('"', to);
}

static void put_number(FILE *to, bool known, double value)
{
    fputc(',', to);
    if (known && isfinite(value))
        fprintf(to, "%.9g", value);
}

static void put_count(FILE *to, bool known, uint64_t value)
{
    fputc(',', to);
    if (known)
        fprintf(to, "%llu", (unsigned long long)value);
}

static void put_csv_hits(FILE *to, const struct cost_hits *hits)
{
    const whit_judgement *judged = &hits->judged;
    bool known = hits->traced && !hits->unanswered;
    put_count(to, known, judged->tally.rays);
    put_count(to, known, judged->tally.wrong);
    put_count(to, known, judged->tally.leaks);
    put_count(to, known, judged->tally.misses);
    put_count(to, known, judged->tally.false_hits);
    put_count(to, known, judged->tally.other_ids);
    put_count(to, known, judged->non_finite);
    put_number(to, known, judged->ulp_median);
    put_number(to, known, judged->ulp_999);
    put_number(to, known, judged->ulp_max);
    put_number(to, known, hits->ms);
}

static void put_csv_row(const struct cost *cost, const struct cost_row *row, FILE *to)
{
    const struct cost_report *report = cost->report;
    const struct sample_median *ratio = &row->price.ratio[report->clock];
    const whit_difference *error = &row->error;
    const char *const texts[] = {cost->job.settings.scene,
                                 report->device,
                                 report->driver,
                                 row->knob,
                                 row->setting,
                                 row->option,
                                 knob_change_name(row->change),
                                 cost_clock_name(report->clock)};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
        if (i)
            fputc(',', to);
        put_quoted(to, texts[i]);
    }
    for (uint32_t c = 0; c < COST_CLOCKS; ++c)
        put_number(to, row->ms[c] >= 0.0, row->ms[c]);
    put_number(to, true, ratio->median);
    put_number(to, true, ratio->low);
    put_number(to, true, ratio->high);
    put_count(to, true, row->price.rounds);
    put_count(to, true, row->price.width);
    put_count(to, true, row->price.height);
    fprintf(to, ",%d", row->price.verdict);
    put_number(to, row->build_ms >= 0.0, row->build_ms);
    put_number(to, true, error->rmse);
    put_number(to, true, error->relative_mse);
    put_number(to, true, error->largest);
    put_number(to, true, (double)error->over_1_255 / (double)error->pixel_count);
    put_number(to, true, error->flip_mean);
    put_count(to, true, row->non_finite);
    put_number(to, row->alone.pixel_count > 0, row->alone.rmse);
    put_count(to, true, row->pixels_changed);
    put_count(to, true, row->ids_changed);
    fprintf(to, ",%d", row->best);
    for (uint32_t set = 0; set < COST_SETS; ++set)
        put_csv_hits(to, &row->hits[set]);
    fputc('\n', to);
}

void cost_write_csv(FILE *to, const void *user)
{
    const struct cost *cost = user;
    static const char *const hits[] = {"rays",       "wrong",     "leaks",      "misses",
                                       "false_hits", "other_ids", "non_finite", "ulp_median",
                                       "ulp_999",    "ulp_max",   "ms"};
    fputs("scene,device,driver,knob,setting,option,may_change,clock,wall_ms,cpu_ms,device_ms,ratio,"
          "ratio_low,ratio_high,rounds,width,height,verdict,build_ms,rmse,relative_mse,largest,"
          "over_1_255,flip,"
          "non_finite,alone_rmse,pixels_changed,ids_changed,best",
          to);
    for (uint32_t set = 0; set < COST_SETS; ++set)
        for (size_t i = 0; i < sizeof hits / sizeof *hits; ++i)
            fprintf(to, ",%s_%s", cost_set_name((enum cost_set)set), hits[i]);
    fputc('\n', to);
    for (uint32_t i = 0; i < cost->report->row_count; ++i)
        if (cost->report->rows[i].measured)
            put_csv_row(cost, &cost->report->rows[i], to);
}
