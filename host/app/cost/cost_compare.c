/* Compares two reports of `whit cost --json`, of different devices or versions. */
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost_json.h"

static const struct cost_row *find(const struct cost_report *report, const struct cost_row *row)
{
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *other = &report->rows[i];
        if (other->measured && strcmp(other->knob, row->knob) == 0 &&
            strcmp(other->setting, row->setting) == 0)
            return other;
    }
    return NULL;
}

/* The time of the usual picture in ms; of other rows their ratio to it. */
static struct sample_median time_of(const struct cost_report *report, const struct cost_row *row)
{
    if (row != &report->rows[0])
        return row->price.ratio[report->clock];
    return (struct sample_median){.median = row->ms[report->clock],
                                  .low = row->ms_low,
                                  .high = row->ms_high,
                                  .coverage = 0.95};
}

static const char *verdict_of(const struct cost_report *a, const struct cost_row *x,
                              const struct cost_report *b, const struct cost_row *y)
{
    bool same_size = x == &a->rows[0]
                         ? a->width == b->width && a->height == b->height
                         : x->price.width == y->price.width && x->price.height == y->price.height;
    if (!same_size)
        return "timed at other sizes";
    const struct sample_median before = time_of(a, x), after = time_of(b, y);
    int verdict = sample_compare_apart(&after, &before);
    return verdict > 0 ? "dearer in B" : verdict < 0 ? "cheaper in B" : "not distinguishable";
}

static void print_row(const struct cost_report *a, const struct cost_row *x,
                      const struct cost_report *b, const struct cost_row *y)
{
    bool is_usual = x == &a->rows[0];
    char wrong[32] = "";
    printf("%-15s %-14s", cli_shown(x->knob), cli_shown(x->setting));
    printf(" %10.4g %10.4g", x->ms[a->clock], y->ms[b->clock]);
    printf("   x %6.3f x %6.3f", is_usual ? 1.0 : x->price.ratio[a->clock].median,
           is_usual ? 1.0 : y->price.ratio[b->clock].median);
    printf("  %-20s %9.3g %9.3g", verdict_of(a, x, b, y), x->error.rmse, y->error.rmse);
    if (x->hits[COST_AIMED].traced && y->hits[COST_AIMED].traced)
        snprintf(wrong, sizeof wrong, "%llu %llu",
                 (unsigned long long)x->hits[COST_AIMED].judged.tally.wrong,
                 (unsigned long long)y->hits[COST_AIMED].judged.tally.wrong);
    printf("  %s\n", wrong);
}

static void print_head(char letter, const char *path, const struct cost_report *report,
                       const char *scene)
{
    printf("%c  %s: %s, %u x %u on ", letter, cli_shown(path), cli_shown(scene), report->width,
           report->height);
    printf("%s (%s), %s clock%s\n", cli_shown(report->device), cli_shown(report->driver),
           cost_clock_name(report->clock), report->complete ? "" : ", NOT COMPLETE");
}

static void print(const struct cost_report *a, const struct cost_report *b)
{
    printf("\n%-15s %-14s %10s %10s   %8s %8s  %-20s %9s %9s  %s\n", "knob", "setting", "A ms",
           "B ms", "A", "B", "of usual", "A RMSE", "B RMSE", "wrong of aimed rays");
    for (uint32_t i = 0; i < a->row_count; ++i) {
        const struct cost_row *row = &a->rows[i], *other = find(b, row);
        if (row->measured && other)
            print_row(a, row, b, other);
        else if (row->measured)
            printf("%-15s %-14s only in A\n", cli_shown(row->knob), cli_shown(row->setting));
    }
    for (uint32_t i = 0; i < b->row_count; ++i)
        if (b->rows[i].measured && !find(a, &b->rows[i]))
            printf("%-15s %-14s only in B\n", cli_shown(b->rows[i].knob),
                   cli_shown(b->rows[i].setting));
}

int cost_compare_files(const char *path_a, const char *path_b)
{
    struct cost_report *reports = calloc(2, sizeof *reports);
    char *scenes[2] = {NULL, NULL};
    int status = EXIT_USAGE;
    if (!reports) {
        cli_error("out of memory");
        return status;
    }
    if (cost_load_json(path_a, &reports[0], &scenes[0]) &&
        cost_load_json(path_b, &reports[1], &scenes[1])) {
        print_head('A', path_a, &reports[0], scenes[0]);
        print_head('B', path_b, &reports[1], scenes[1]);
        if (reports[0].scene_hash != reports[1].scene_hash)
            cli_warning("the scenes are not the same");
        print(&reports[0], &reports[1]);
        status = cli_finish_stdout(EXIT_FINE);
    }
    free(scenes[0]);
    free(scenes[1]);
    free(reports);
    return status;
}
