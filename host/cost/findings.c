/* The sentences at the top of a report of `whit cost`, made from its figures. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cost/cost.h"

enum {
    SENTENCE_FINDINGS = 3, /* what a reader takes in within ten seconds */
    JUDGED_WIDTH = 320,    /* findings from narrower pictures state their width */
};

/* FLIP_UNSEEN: nobody sees a smaller difference. ERROR_SHARE, TIME_SHARE: smaller changes of error
   or time are not worth a sentence. RATIO_MAX: settings that take longer, in usual times, are not
   recommended. TIME_UNSURE: an interval of the ratio that reaches further above 1 does not show
   that a setting is free. HALF_LOW..HALF_HIGH: percentages that are called half. */
static const double FLIP_UNSEEN = 0.002, ERROR_SHARE = 0.05, TIME_SHARE = 0.03, RATIO_MAX = 20.0,
                    TIME_UNSURE = 0.1, HALF_LOW = 45.0, HALF_HIGH = 55.0;

static void find(struct cost_finding *finding, const char *format, ...) WHIT_PRINTF(2, 3);
static void find(struct cost_finding *finding, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    vsnprintf(finding->text, sizeof finding->text, format, args);
    va_end(args);
}

static void add_value(struct cost_finding *finding, double value)
{
    finding->values[finding->value_count++] = value;
}

static bool is_told(const struct cost_row *row)
{
    return row->measured && !row->broken && row->knob_index != WHIT_NONE;
}

const char *cost_time_name(const struct cost_report *report)
{
    static const char *const names[COST_CLOCKS] = {"time", "processor time", "device time"};
    return names[report->clock];
}

static double ratio_of(const struct cost_report *report, const struct cost_row *row)
{
    return row->price.ratio[report->clock].median;
}

static const struct cost_row *row_of(const struct cost_report *report, const char *knob,
                                     const char *setting)
{
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (is_told(row) && strcmp(row->knob, knob) == 0 && strcmp(row->setting, setting) == 0)
            return row;
    }
    return NULL;
}

/* ---- More time ---- */

static bool comes_nearer(const struct cost_report *report, const struct cost_row *row)
{
    return is_told(row) && cost_is_judged(report, row) &&
           row->error.flip_mean <= (1.0 - ERROR_SHARE) * report->rows[0].error.flip_mean;
}

/* Whether settings that may change the shading were measured, all can be judged, and none comes
   nearer. */
static bool none_comes_nearer(const struct cost_report *report)
{
    bool tried = false;
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        if (is_told(row) && (!cost_is_judged(report, row) || comes_nearer(report, row)))
            return false;
        tried = tried || (is_told(row) && row->change == SETTING_LIGHT);
    }
    return tried;
}

/* The setting with the largest fall of error per doubling of the time. */
static const struct cost_row *best_buy(const struct cost_report *report)
{
    const struct cost_row *best = NULL;
    double usual = report->rows[0].error.flip_mean, most = 0.0;
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        double ratio = ratio_of(report, row);
        if (!comes_nearer(report, row) || row->price.verdict <= 0 || ratio <= 1.0 ||
            ratio > RATIO_MAX)
            continue;
        double gain = log(usual / fmax(row->error.flip_mean, 1e-9)) / log(ratio);
        if (gain > most) {
            most = gain;
            best = row;
        }
    }
    return best;
}

static bool find_more_time(const struct cost_report *report, struct cost_finding *finding)
{
    double usual = report->rows[0].error.flip_mean;
    const struct cost_row *row = best_buy(report);
    add_value(finding, usual);
    if (usual < FLIP_UNSEEN) {
        find(finding, "no eye tells the usual picture from the reference (FLIP %.4f)", usual);
        return true;
    }
    if (!row) {
        find(finding,
             none_comes_nearer(report)
                 ? "nothing that was measured comes much nearer to the reference (FLIP %.4f)"
                 : "the usual picture has a visible error of FLIP %.4f",
             usual);
        return true;
    }
    double left = 100.0 * row->error.flip_mean / usual;
    add_value(finding, ratio_of(report, row));
    add_value(finding, left);
    add_value(finding, row->error.flip_mean);
    if (left >= HALF_LOW && left <= HALF_HIGH)
        find(finding, "%.1f times the %s halves the visible error (%s %s: FLIP %.4f, was %.4f)",
             ratio_of(report, row), cost_time_name(report), row->knob, row->setting,
             row->error.flip_mean, usual);
    else
        find(finding,
             "%.1f times the %s leaves %.0f %% of the visible error (%s %s: FLIP %.4f, was %.4f)",
             ratio_of(report, row), cost_time_name(report), left, row->knob, row->setting,
             row->error.flip_mean, usual);
    return true;
}

/* ---- Bounces ---- */

/* How much larger the FLIP of a depth is than that of the deepest picture, both to the reference of
   one sample. */
static double flip_beyond(const struct cost_row *row, const struct cost_row *deepest)
{
    return row->alone.flip_mean - deepest->alone.flip_mean;
}

static bool find_bounces(const struct cost_report *report, struct cost_finding *finding)
{
    const struct knob *depth = &knob_table[knob_find("depth")];
    const char *enough = knob_setting_name(depth, depth->usual);
    const struct cost_row *deepest = row_of(report, "depth", "16"), *first = &report->rows[0];
    if (!deepest)
        return false;
    for (uint32_t s = 0; s < depth->usual; ++s) {
        const struct cost_row *row = row_of(report, "depth", knob_setting_name(depth, s));
        if (row && flip_beyond(row, deepest) < FLIP_UNSEEN) {
            enough = row->setting;
            first = row;
            break;
        }
    }
    double beyond = flip_beyond(first, deepest);
    add_value(finding, strtod(enough, NULL));
    add_value(finding, beyond);
    if (beyond < FLIP_UNSEEN)
        find(finding, "bounces above %s change nothing that is seen", enough);
    else
        find(finding, "bounces above %s are seen (FLIP %.4f)", enough, beyond);
    return true;
}

/* ---- Exact hits ---- */

static bool find_exact(const struct cost_report *report, struct cost_finding *finding)
{
    const struct cost_row *exact = row_of(report, "numerics", "exact");
    const struct cost_hits *aimed = &report->rows[0].hits[COST_AIMED];
    if (!exact)
        return false;
    bool told_apart = exact->price.verdict > 0 && ratio_of(report, exact) > 1.0;
    double high = exact->price.ratio[report->clock].high;
    double more = 100.0 * ((told_apart ? ratio_of(report, exact) : high) - 1.0);
    add_value(finding, more);
    if (told_apart)
        find(finding, more < 99.5 ? "exact hits cost %.2g %%" : "exact hits cost %.0f %%", more);
    else if (high > 1.0 + TIME_UNSURE)
        find(finding, "exact hits cost at most %.0f %%, as closely as could be measured", more);
    else
        find(finding, "exact hits cost nothing that can be measured");
    if (aimed->traced && !aimed->unanswered && aimed->judged.tally.wrong) {
        add_value(finding, (double)aimed->judged.tally.wrong);
        add_value(finding, (double)aimed->judged.tally.rays);
        text_add(finding->text, sizeof finding->text,
                 " (without them %llu of %llu aimed rays are wrong)",
                 (unsigned long long)aimed->judged.tally.wrong,
                 (unsigned long long)aimed->judged.tally.rays);
    }
    return true;
}

/* ---- Less time ---- */

/* Among settings that are as right as the usual ones, the one that saves most time; or NULL. */
static const struct cost_row *free_saving(const struct cost_report *report)
{
    const struct cost_row *best = NULL;
    for (uint32_t i = 1; i < report->row_count; ++i) {
        const struct cost_row *row = &report->rows[i];
        /* Settings of trees are left out, since a picture must also save their time to build. */
        if (is_told(row) && row->build_ms < 0.0 && ratio_of(report, row) < 1.0 - TIME_SHARE &&
            cost_use_of(report, row) == COST_USE_FREE &&
            (!best || ratio_of(report, row) < ratio_of(report, best)))
            best = row;
    }
    return best;
}

static bool find_saving(const struct cost_report *report, struct cost_finding *finding)
{
    const struct cost_row *best = free_saving(report);
    if (!best)
        return false;
    double saved = 100.0 * (1.0 - ratio_of(report, best));
    add_value(finding, saved);
    find(finding, "%s %s is as right and takes %.0f %% less %s", best->knob, best->setting, saved,
         cost_time_name(report));
    return true;
}

static bool find_dearest(const struct cost_report *report, struct cost_finding *finding)
{
    static const char *const parts[][3] = {
        {"shadows", "none", "shadows"},
        {"depth", "0", "reflection and refraction"},
        {"textures", "off", "textures"},
        {"light-samples", "1", "soft shadows"},
    };
    const struct cost_row *free = free_saving(report);
    double least = 1.0 - TIME_SHARE;
    const char *what = NULL;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; ++i) {
        const struct cost_row *row = row_of(report, parts[i][0], parts[i][1]);
        if (row && row != free && row->price.verdict < 0 && ratio_of(report, row) < least) {
            least = ratio_of(report, row);
            what = parts[i][2];
        }
    }
    if (!what)
        return false;
    add_value(finding, 100.0 * (1.0 - least));
    find(finding, "without %s it would take %.0f %% less %s", what, 100.0 * (1.0 - least),
         cost_time_name(report));
    return true;
}

uint32_t cost_findings(const struct cost_report *report,
                       struct cost_finding findings[COST_FINDINGS_MAX])
{
    static bool (*const all[COST_FINDINGS_MAX])(const struct cost_report *,
                                                struct cost_finding *) = {
        find_more_time, find_bounces, find_exact, find_saving, find_dearest};
    uint32_t count = 0;
    for (uint32_t i = 0; i < COST_FINDINGS_MAX; ++i) {
        findings[count] = (struct cost_finding){.value_count = 0};
        count += all[i](report, &findings[count]);
    }
    return count;
}

void cost_sentence(const struct cost_report *report, char text[COST_SENTENCE_BYTES])
{
    struct cost_finding findings[COST_FINDINGS_MAX];
    _Static_assert(COST_SENTENCE_BYTES > SENTENCE_FINDINGS * (sizeof findings[0].text + 2) + 96,
                   "all of them fit");
    uint32_t count = cost_findings(report, findings);
    count = count < SENTENCE_FINDINGS ? count : SENTENCE_FINDINGS;
    char *end = text;
    text[0] = 0;
    for (uint32_t i = 0; i < count; ++i) {
        end = stpcpy(end, i ? "; " : "");
        end = stpcpy(end, findings[i].text);
    }
    if (report->judged_width < report->width && report->judged_width < JUDGED_WIDTH)
        end += sprintf(end, " (judged at %u x %u)", report->judged_width, report->judged_height);
    strcpy(end, report->complete ? "." : " (not complete: it was stopped).");
    text[0] = (char)toupper((unsigned char)text[0]);
}
