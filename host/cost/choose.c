/* Conclusions from a report's figures: which rows are in the Pareto set, what each setting is good
   for, and which combination of settings best meets a limit of error or of time. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cost/within.h"

const char *cost_metric_name(enum cost_metric metric)
{
    static const char *const names[] = {"rmse", "flip"};
    return names[metric];
}

double cost_error_of(const whit_difference *difference, enum cost_metric metric)
{
    return metric == COST_FLIP ? difference->flip_mean : difference->rmse;
}

double choose_to_sum(double error, enum cost_metric metric)
{
    return metric == COST_RMSE ? error * error : error;
}

double choose_from_sum(double sum, enum cost_metric metric)
{
    sum = fmax(sum, 0.0);
    return metric == COST_RMSE ? sqrt(sum) : sum;
}

/* ---- Rows ---- */

/* The setting's bias: its error without the sampling error, which is measured against the reference
   of one sample; the whole error where `alone` was not measured. */
static double bias_of(const struct cost_row *row, enum cost_metric metric)
{
    return cost_error_of(row->alone.pixel_count ? &row->alone : &row->error, metric);
}

double choose_quadruple(const struct cost_report *report, enum cost_metric metric, double sum)
{
    double bias = fmin(choose_to_sum(bias_of(&report->rows[0], metric), metric), sum);
    return bias + (sum - bias) / (metric == COST_RMSE ? 4.0 : 2.0);
}

double cost_error_left(const struct cost_report *report, const struct cost_row *row,
                       enum cost_metric metric)
{
    double sum = choose_to_sum(cost_error_of(&row->error, metric), metric);
    for (uint32_t i = 0; !cost_is_judged(report, row) && i < report->row_count; ++i) {
        const struct cost_row *other = &report->rows[i];
        bool counts = i == 0 || (other->measured && strcmp(other->knob, "aa") == 0);
        if (counts && 4 * cost_samples(other) == report->reference_samples)
            sum = fmax(
                sum, choose_quadruple(report, metric,
                                      choose_to_sum(cost_error_of(&other->error, metric), metric)));
    }
    return choose_from_sum(sum, metric);
}

/* Without rays nothing is known of how right settings are that change hits: hardly any picture
   shows it. */
static bool lacks_rays(const struct cost_report *report, const struct cost_row *row)
{
    return row->change == SETTING_HITS && !report->rows[0].hits[COST_AIMED].traced;
}

static bool is_ranked(const struct cost_report *report, const struct cost_row *row)
{
    return row->measured && !row->broken && !row->hits[COST_CAMERA].unanswered &&
           !lacks_rays(report, row);
}

/* The row's time; the usual picture's time where the two cannot be distinguished. */
static double rank_ms(const struct cost_report *report, const struct cost_row *row)
{
    const struct cost_row *usual = &report->rows[0];
    return row == usual || row->price.verdict ? row->ms[report->clock] : usual->ms[report->clock];
}

/* Whether row a dominates row b: it is at least as fast and as right (within 1 %), and better in
   one of these. Of two equal rows the one above in the table dominates. */
static bool beats(const struct cost_report *report, enum cost_metric metric,
                  const struct cost_row *a, const struct cost_row *b)
{
    double a_ms = rank_ms(report, a), b_ms = rank_ms(report, b);
    double a_error = cost_error_left(report, a, metric),
           b_error = cost_error_left(report, b, metric);
    if (!is_ranked(report, a) || a_ms > b_ms || a_error > b_error * (1.0 + CHOOSE_AS_RIGHT))
        return false;
    return a_ms < b_ms || a_error < b_error * (1.0 - CHOOSE_AS_RIGHT) || a < b;
}

void cost_mark_best(struct cost_report *report, enum cost_metric metric)
{
    for (uint32_t i = 0; i < report->row_count; ++i) {
        report->rows[i].best = is_ranked(report, &report->rows[i]);
        for (uint32_t j = 0; report->rows[i].best && j < report->row_count; ++j)
            if (j != i && beats(report, metric, &report->rows[j], &report->rows[i]))
                report->rows[i].best = false;
    }
}

/* Number of rays in both sets whose hit is not the exact one. */
static uint64_t inexact_hits(const struct cost_row *row)
{
    uint64_t sum = 0;
    for (uint32_t set = 0; set < COST_SETS; ++set) {
        const whit_judgement *judged = &row->hits[set].judged;
        sum += judged->tally.misses + judged->tally.false_hits + judged->tally.other_ids;
    }
    return sum;
}

/* The reference draws the row's picture; no option of `whit render` does. */
static bool draws_in_double(const struct cost_row *row)
{
    return row->knob_index != WHIT_NONE && knob_level(&knob_table[row->knob_index]) == KNOB_DOUBLE;
}

enum cost_use cost_use_of(const struct cost_report *report, const struct cost_row *row)
{
    const struct cost_row *usual = &report->rows[0];
    bool samples = row->alone.pixel_count == 0;
    double before = samples ? usual->error.rmse : usual->alone.rmse;
    double after = bias_of(row, COST_RMSE);
    bool more_right = after < before * (1.0 - CHOOSE_AS_RIGHT);
    bool less_right = after > before * (1.0 + CHOOSE_AS_RIGHT);
    if (row->change == SETTING_HITS && row->hits[COST_AIMED].traced) {
        more_right = more_right || inexact_hits(row) < inexact_hits(usual);
        less_right = less_right || inexact_hits(row) > inexact_hits(usual);
    }
    if (lacks_rays(report, row))
        return COST_USE_TRADE;
    if (row->price.verdict < 0)
        return less_right || draws_in_double(row) ? COST_USE_TRADE : COST_USE_FREE;
    return more_right || row->best ? COST_USE_TRADE : COST_USE_NONE;
}

/* ---- Choices ---- */

static struct effect effect_of(const struct search *search, const struct cost_row *row)
{
    const struct cost_row *usual = &search->report->rows[0];
    enum cost_metric metric = search->goal->metric;
    struct effect out = {.known = is_ranked(search->report, row)};
    out.ratio = row->price.verdict ? row->price.ratio[search->report->clock].median : 1.0;
    out.error = row->knob_index == search->aa
                    ? choose_to_sum(cost_error_left(search->report, row, metric), metric)
                    : choose_to_sum(bias_of(row, metric), metric) -
                          choose_to_sum(bias_of(usual, metric), metric);
    return out;
}

static void collect(struct search *search)
{
    const struct cost_report *report = search->report;
    enum cost_metric metric = search->goal->metric;
    search->usual_bias = choose_to_sum(bias_of(&report->rows[0], metric), metric);
    for (uint32_t k = 0; k < KNOBS; ++k)
        search->effects[k][knob_table[k].usual] = (struct effect){.ratio = 1.0, .known = true};
    search->effects[search->aa][knob_table[search->aa].usual].error =
        choose_to_sum(cost_error_of(&report->rows[0].error, metric), metric);
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (row->knob_index != WHIT_NONE && row->measured)
            search->effects[row->knob_index][row->setting_index] = effect_of(search, row);
    }
}

/* Takes the fastest setting of each knob that does not change the picture. Another tree must save
   in one picture the time of its build. */
static void take_free(struct search *search)
{
    const struct cost_report *report = search->report;
    double ratios[KNOBS];
    for (uint32_t k = 0; k < KNOBS; ++k) {
        search->settings[k] = (uint8_t)knob_table[k].usual;
        ratios[k] = 1.0;
    }
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        uint32_t k = row->knob_index;
        if (k == WHIT_NONE || !is_ranked(report, row) || row->change != SETTING_COST)
            continue;
        double ratio = row->price.ratio[report->clock].median;
        double saved_ms = report->rows[0].ms[COST_WALL] * (1.0 - ratio);
        double built_ms = row->build_ms >= 0.0 ? row->build_ms - report->rows[0].build_ms : 0.0;
        if (row->price.verdict < 0 && ratio < ratios[k] && built_ms < saved_ms) {
            ratios[k] = ratio;
            search->settings[k] = (uint8_t)row->setting_index;
        }
    }
}

/* Tries all combinations of shading settings, knob by knob, and keeps the cheapest one below the
   limit of error; samples per pixel also beyond those that were measured. */
static void walk(struct search *search, uint32_t knob, double ratio, double sum)
{
    if (knob == KNOBS) {
        double ms = search->report->usual_ms_max * ratio;
        double error = choose_from_sum(sum, search->goal->metric);
        if (error > search->goal->limit || (search->best.found && ms >= search->best.ms))
            return;
        search->best = (struct cost_choice){
            .samples = search->samples, .ms = ms, .error = error, .found = true};
        memcpy(search->best.settings, search->settings, sizeof search->settings);
        return;
    }
    if (knob_change(&knob_table[knob]) != SETTING_LIGHT) {
        const struct effect *effect = &search->effects[knob][search->settings[knob]];
        walk(search, knob + 1, ratio * effect->ratio, sum);
        return;
    }
    for (uint32_t s = 0; s < knob_table[knob].count; ++s) {
        const struct effect *effect = &search->effects[knob][s];
        search->settings[knob] = (uint8_t)s;
        if (effect->known)
            walk(search, knob + 1, ratio * effect->ratio, sum + effect->error);
    }
    if (knob != search->aa)
        return;
    for (search->samples = 4; search->samples <= COST_SAMPLES_MAX; search->samples *= 4) {
        const struct effect effect = choose_samples(search, search->samples);
        search->settings[knob] = (uint8_t)knob_table[knob].usual;
        if (effect.known)
            walk(search, knob + 1, ratio * effect.ratio, sum + effect.error);
    }
    search->samples = 0;
}

struct cost_choice cost_choose(const struct cost_report *report, const struct cost_goal *goal)
{
    struct search search = {.report = report, .goal = goal, .aa = knob_find("aa")};
    collect(&search);
    take_free(&search);
    if (goal->kind == COST_WITHIN)
        choose_within(&search);
    else
        walk(&search, 0, 1.0, 0.0);
    return search.best;
}

struct cost_choice cost_choose_budget(const struct cost_report *report, double budget_ms,
                                      bool edges)
{
    struct cost_goal goal = {
        .kind = COST_WITHIN, .metric = COST_RMSE, .limit = COST_ROOM * budget_ms, .edges = edges};
    struct cost_choice choice = cost_choose(report, &goal);
    if (choice.found)
        return choice;
    goal.limit = budget_ms * report->usual_ms_max / fmax(report->rows[0].ms[COST_WALL], 1e-6);
    return cost_choose(report, &goal);
}

void cost_choice_apply(const struct cost_choice *choice, struct settings *settings)
{
    for (uint32_t k = 0; k < KNOBS; ++k) {
        if (choice->settings[k] != knob_table[k].usual)
            knob_apply(&knob_table[k], choice->settings[k], settings);
    }
    if (choice->samples > 0)
        settings->picture.sampling = (whit_sampling){.count = choice->samples};
    if (choice->contrast > 0.0)
        settings->picture.sampling = (whit_sampling){.kind = WHIT_SAMPLING_ADAPTIVE,
                                                     .count = choice->samples,
                                                     .count_max = choice->samples_max,
                                                     .contrast = choice->contrast};
}

void cost_choice_text(const struct cost_choice *choice, char *text, size_t text_bytes)
{
    struct settings settings = settings_usual();
    cost_choice_apply(choice, &settings);
    settings_write(&settings, SETTINGS_LINE, " ", text, text_bytes);
}

/* ---- Measured rows in place of a choice ---- */

bool choose_keeps(const struct cost_goal *goal, const struct cost_row *row, double error)
{
    return (goal->kind == COST_WITHIN ? row->ms[COST_WALL] : error) <= goal->limit;
}

/* The position of the row's setting in the order of within.c, from 1; 0: it gives up nothing.
   Combinations come last, since the row does not tell what they give up. */
static uint32_t given_up(const struct cost_report *report, const struct cost_row *row)
{
    bool combined = row != report->rows && row->knob_index == WHIT_NONE;
    /* WHIT_NONE + 1 is 0. */
    return 1 + (combined ? cost_steps() : cost_step_of(row->knob, row->setting));
}

/* The row that keeps the limit: for a limit of error the cheapest one; for a limit of time the one
   that gives up what is missed least, and among equal ones the one with the least error. NULL: none
   keeps it. */
static const struct cost_row *keeping_row(const struct cost_report *report,
                                          const struct cost_goal *goal)
{
    const struct cost_row *best_row = NULL;
    double best = INFINITY;
    uint32_t best_step = WHIT_NONE;
    for (uint32_t i = 0; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        double error = cost_error_left(report, row, goal->metric);
        double rank = goal->kind == COST_WITHIN ? error : row->ms[COST_WALL];
        uint32_t step = goal->kind == COST_WITHIN ? given_up(report, row) : 0;
        /* Settings that change hits are never taken: one picture does not show which rays miss. */
        if (!row->measured || row->broken || row->change == SETTING_HITS ||
            !choose_keeps(goal, row, error) || step > best_step ||
            (step == best_step && !(rank < best)))
            continue;
        best = rank;
        best_step = step;
        best_row = row;
    }
    return best_row;
}

void choose_measured(const struct cost_report *report, struct cost_answer *answer)
{
    const struct cost_goal *goal = &answer->goal;
    const struct cost_row *row = keeping_row(report, goal);
    if (!row)
        return;
    double error = cost_error_left(report, row, goal->metric);
    /* More samples may make a worse picture if they are no power of 4. */
    if (answer->kept &&
        (goal->kind != COST_WITHIN || given_up(report, row) > 0 ||
         !(error < cost_error_left(report, &report->rows[answer->row], goal->metric))))
        return;
    *answer = (struct cost_answer){.goal = answer->goal,
                                   .found = true,
                                   .kept = true,
                                   .row = (uint32_t)(row - report->rows),
                                   .ms = row->ms[COST_WALL],
                                   .error = error};
}
