/* Reports of `whit cost` as JSON, and back. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost_json.h"
#include "app/settings_json.h"
#include "base/file.h"
#include "whit/whit_program.h"

/* ---- Writing ---- */

static void put_median(json_t *out, const struct sample_median *median)
{
    document_number(out, "median", median->median);
    document_number(out, "low", median->low);
    document_number(out, "high", median->high);
    document_number(out, "coverage", median->coverage);
}

static void put_price(json_t *out, const struct cost_price *price)
{
    document_count(out, "rounds", price->rounds);
    document_count(out, "width", price->width);
    document_count(out, "height", price->height);
    document_number(out, "verdict", price->verdict);
    for (uint32_t c = 0; c < COST_CLOCKS; ++c) {
        const char *name = cost_clock_name((enum cost_clock)c);
        if (price->ratio[c].count == 0) {
            document_put(out, name, json_null());
            continue;
        }
        json_t *clock = document_child(out, name);
        put_median(document_child(clock, "usual_ms"), &price->usual_ms[c]);
        put_median(document_child(clock, "setting_ms"), &price->setting_ms[c]);
        put_median(document_child(clock, "difference_ms"), &price->difference[c]);
        put_median(document_child(clock, "ratio"), &price->ratio[c]);
    }
}

static json_t *difference_document(const whit_difference *difference)
{
    if (difference->pixel_count == 0)
        return json_null();
    json_t *out = document_object();
    document_count(out, "pixels", difference->pixel_count);
    document_number(out, "rmse", difference->rmse);
    document_number(out, "relative_mse", difference->relative_mse);
    document_number(out, "largest", difference->largest);
    document_count(out, "over_1_255", difference->over_1_255);
    document_number(out, "flip", difference->flip_mean);
    document_count(out, "non_finite", difference->nonfinite_b);
    return out;
}

static json_t *hits_document(const struct cost_hits *hits)
{
    const whit_judgement *judged = &hits->judged;
    if (!hits->traced)
        return json_null();
    json_t *out = document_object();
    document_flag(out, "unanswered", hits->unanswered);
    document_count(out, "rays", judged->tally.rays);
    document_count(out, "wrong", judged->tally.wrong);
    document_count(out, "leaks", judged->tally.leaks);
    document_count(out, "misses", judged->tally.misses);
    document_count(out, "false_hits", judged->tally.false_hits);
    document_count(out, "other_ids", judged->tally.other_ids);
    document_count(out, "non_finite", judged->non_finite);
    document_count(out, "ulp_rays", judged->ulp_rays);
    document_number(out, "ulp_median", judged->ulp_median);
    document_number(out, "ulp_999", judged->ulp_999);
    document_number(out, "ulp_max", judged->ulp_max);
    document_number(out, "ms", hits->ms);
    return out;
}

static void put_row(json_t *out, const struct cost_row *row)
{
    document_text(out, "knob", row->knob);
    document_text(out, "setting", row->setting);
    document_text(out, "option", row->option);
    document_text(out, "may_change", knob_change_name(row->change));
    document_text(out, "note", row->note);
    document_flag(out, "measured", row->measured);
    document_flag(out, "broken", row->broken);
    document_flag(out, "best", row->best);
    for (uint32_t c = 0; c < COST_CLOCKS; ++c) {
        char key[32];
        snprintf(key, sizeof key, "%s_ms", cost_clock_name((enum cost_clock)c));
        document_number(out, key, document_known(row->ms[c]));
    }
    document_number(out, "ms_low", row->ms_low);
    document_number(out, "ms_high", row->ms_high);
    document_number(out, "build_ms", document_known(row->build_ms));
    put_price(document_child(out, "price"), &row->price);
    document_put(out, "error", difference_document(&row->error));
    document_put(out, "alone", difference_document(&row->alone));
    document_count(out, "pixels_changed", row->pixels_changed);
    document_count(out, "ids_changed", row->ids_changed);
    for (uint32_t set = 0; set < COST_SETS; ++set)
        document_put(out, set == COST_AIMED ? "aimed_rays" : "picture_rays",
                     hits_document(&row->hits[set]));
}

static void put_answer(json_t *out, const struct cost_report *report,
                       const struct cost_answer *answer)
{
    document_text(out, "goal", answer->goal.kind == COST_WITHIN ? "within_ms" : "under");
    document_text(out, "metric", cost_metric_name(answer->goal.metric));
    document_number(out, "limit", answer->goal.limit);
    document_number(out, "of_usual",
                    answer->goal.of_usual > 0.0 ? answer->goal.of_usual : (double)NAN);
    if (answer->found && answer->row != WHIT_NONE)
        document_count(out, "row", answer->row);
    else
        document_put(out, "row", json_null());
    document_flag(out, "found", answer->found);
    document_flag(out, "kept", answer->kept);
    document_number(out, "predicted_ms", answer->ms);
    document_number(out, "predicted_error", answer->error);
    document_text(out, "options",
                  answer->found && answer->row != WHIT_NONE ? report->rows[answer->row].option
                                                            : NULL);
}

static void put_head(json_t *out, const struct cost_report *report, const struct cost *cost)
{
    document_text(out, "command", cost ? cost->command : NULL);
    document_text(out, "scene", cost ? cost->job.settings.scene : NULL);
    json_t *picture = document_child(out, "picture");
    if (cost)
        settings_describe(&cost->job.settings, IN_COST, picture);
    document_hash(out, "scene_hash", report->scene_hash);
    document_text(out, "device", report->device);
    document_text(out, "driver", report->driver);
    document_text(out, "kind", whit_device_kind_name(report->kind));
    document_text(out, "load_path", value_word(values_load_path, (int)report->load_path));
    document_flag(out, "complete", report->complete);
    document_number(out, "seconds", report->spent_ms * 1e-3);
    document_text(out, "clock", cost_clock_name(report->clock));
    document_count(out, "width", report->width);
    document_count(out, "height", report->height);
    document_count(out, "judged_width", report->judged_width);
    document_count(out, "judged_height", report->judged_height);
    document_number(out, "usual_ms_max", report->usual_ms_max);
    document_number(out, "small_ms", report->small_ms);
}

static void put_reference(json_t *out, const struct cost_report *report)
{
    document_count(out, "samples", report->reference_samples);
    document_count(out, "depth", report->reference_depth);
    document_count(out, "light_samples", report->reference_light_samples);
    document_flag(out, "cached", report->reference_cached[0] && report->reference_cached[1]);
    document_number(out, "one_sample_ms",
                    report->reference_cached[0] ? (double)NAN : report->reference_ms[0]);
    document_number(out, "all_samples_ms",
                    report->reference_cached[1] ? (double)NAN : report->reference_ms[1]);
}

/* Adds the sentence that sums up the report, and the findings that it is made of. */
static void put_findings(json_t *out, const struct cost_report *report)
{
    struct cost_finding findings[COST_FINDINGS_MAX];
    char sentence[COST_SENTENCE_BYTES];
    uint32_t count = cost_findings(report, findings);
    cost_sentence(report, sentence);
    document_text(out, "sentence", sentence);
    json_t *list = document_list(out, "findings");
    for (uint32_t i = 0; i < count; ++i) {
        json_t *entry = document_entry(list);
        document_text(entry, "text", findings[i].text);
        document_numbers(entry, "values", findings[i].values, findings[i].value_count);
    }
}

json_t *cost_document(const struct cost_report *report, const struct cost *cost)
{
    json_t *out = document_root();
    put_head(out, report, cost);
    put_findings(out, report);
    put_reference(document_child(out, "reference"), report);
    json_t *rows = document_list(out, "rows");
    for (uint32_t i = 0; i < report->row_count; ++i)
        put_row(document_entry(rows), &report->rows[i]);
    json_t *answers = document_list(out, "answers");
    for (uint32_t i = 0; i < report->answer_count; ++i)
        put_answer(document_entry(answers), report, &report->answers[i]);
    json_t *absent = document_list(out, "not_here");
    for (uint32_t i = 0; i < report->absent_count; ++i) {
        json_t *entry = document_entry(absent);
        document_text(entry, "name", report->absent[i].name);
        document_text(entry, "why", report->absent[i].why);
    }
    return out;
}

/* ---- Reading: what comparisons, choices and the viewer need of a report ---- */

static void text(const json_t *object, const char *key, char *out, size_t out_bytes)
{
    const char *value = json_string_value(json_object_get(object, key));
    snprintf(out, out_bytes, "%s", value ? value : "");
}

static struct sample_median read_median(const json_t *object, uint32_t count)
{
    return (struct sample_median){.median = document_read_number(object, "median", 0.0),
                                  .low = document_read_number(object, "low", 0.0),
                                  .high = document_read_number(object, "high", 0.0),
                                  .coverage = document_read_number(object, "coverage", 0.0),
                                  .count = count};
}

static void read_price(const json_t *object, struct cost_price *price)
{
    price->rounds = (uint32_t)document_read_count(object, "rounds");
    price->width = (uint32_t)document_read_count(object, "width");
    price->height = (uint32_t)document_read_count(object, "height");
    double verdict = document_read_number(object, "verdict", 0.0);
    price->verdict = (verdict > 0.0) - (verdict < 0.0);
    for (uint32_t c = 0; c < COST_CLOCKS; ++c) {
        const json_t *clock = json_object_get(object, cost_clock_name((enum cost_clock)c));
        if (!json_is_object(clock))
            continue;
        price->ratio[c] = read_median(json_object_get(clock, "ratio"), price->rounds);
    }
}

static void read_difference(const json_t *object, whit_difference *difference)
{
    difference->pixel_count = document_read_count(object, "pixels");
    difference->rmse = document_read_number(object, "rmse", 0.0);
    difference->flip_mean = document_read_number(object, "flip", 0.0);
}

static void read_hits(const json_t *object, struct cost_hits *hits)
{
    hits->traced = json_is_object(object);
    hits->unanswered = json_is_true(json_object_get(object, "unanswered"));
    hits->judged.tally.rays = document_read_count(object, "rays");
    hits->judged.tally.wrong = document_read_count(object, "wrong");
    hits->judged.tally.misses = document_read_count(object, "misses");
    hits->judged.tally.false_hits = document_read_count(object, "false_hits");
    hits->judged.tally.other_ids = document_read_count(object, "other_ids");
}

/* Finds the knob and setting by the names in `row`, or neither of the two. */
static void find_setting(struct cost_row *row)
{
    uint32_t knob = knob_find(row->knob);
    uint32_t setting =
        knob == WHIT_NONE ? WHIT_NONE : knob_find_setting(&knob_table[knob], row->setting);
    row->knob_index = setting == WHIT_NONE ? WHIT_NONE : knob;
    row->setting_index = setting;
    if (setting != WHIT_NONE)
        row->change = knob_change(&knob_table[knob]);
}

static void read_row(const json_t *object, struct cost_row *row)
{
    static const char *const keys[] = {"wall_ms", "cpu_ms", "device_ms"};
    text(object, "knob", row->knob, sizeof row->knob);
    text(object, "setting", row->setting, sizeof row->setting);
    text(object, "option", row->option, sizeof row->option);
    text(object, "note", row->note, sizeof row->note);
    row->measured = json_is_true(json_object_get(object, "measured"));
    row->broken = json_is_true(json_object_get(object, "broken"));
    row->best = json_is_true(json_object_get(object, "best"));
    for (uint32_t c = 0; c < COST_CLOCKS; ++c)
        row->ms[c] = document_read_number(object, keys[c], -1.0);
    row->ms_low = document_read_number(object, "ms_low", 0.0);
    row->ms_high = document_read_number(object, "ms_high", 0.0);
    row->build_ms = document_read_number(object, "build_ms", -1.0);
    row->pixels_changed = document_read_count(object, "pixels_changed");
    read_price(json_object_get(object, "price"), &row->price);
    read_difference(json_object_get(object, "error"), &row->error);
    read_difference(json_object_get(object, "alone"), &row->alone);
    read_hits(json_object_get(object, "picture_rays"), &row->hits[COST_CAMERA]);
    read_hits(json_object_get(object, "aimed_rays"), &row->hits[COST_AIMED]);
    find_setting(row);
}

static void read_report(const json_t *root, struct cost_report *report, char **scene)
{
    char clock[16], hash[24];
    const char *name = json_string_value(json_object_get(root, "scene"));
    const json_t *rows = json_object_get(root, "rows"), *row;
    size_t i;
    text(root, "device", report->device, sizeof report->device);
    text(root, "driver", report->driver, sizeof report->driver);
    text(root, "scene_hash", hash, sizeof hash);
    text(root, "clock", clock, sizeof clock);
    report->scene_hash = strtoull(hash, NULL, 16);
    report->complete = json_is_true(json_object_get(root, "complete"));
    report->width = (uint32_t)document_read_count(root, "width");
    report->height = (uint32_t)document_read_count(root, "height");
    report->judged_width = (uint32_t)document_read_count(root, "judged_width");
    report->judged_height = (uint32_t)document_read_count(root, "judged_height");
    report->usual_ms_max = document_read_number(root, "usual_ms_max", 0.0);
    report->small_ms = document_read_number(root, "small_ms", 0.0);
    report->reference_samples =
        (uint32_t)document_read_count(json_object_get(root, "reference"), "samples");
    for (uint32_t c = 0; c < COST_CLOCKS; ++c)
        if (strcmp(clock, cost_clock_name((enum cost_clock)c)) == 0)
            report->clock = (enum cost_clock)c;
    json_array_foreach(rows, i, row)
    {
        if (report->row_count < COST_ROWS_MAX)
            read_row(row, &report->rows[report->row_count++]);
    }
    if (scene)
        *scene = name ? strdup(name) : NULL;
}

bool cost_read(json_t *root, struct cost_report *report, char **scene)
{
    bool known = root && document_read_number(root, "format", 0.0) == DOCUMENT_FORMAT &&
                 json_is_array(json_object_get(root, "rows")) &&
                 json_array_size(json_object_get(root, "rows")) > 0;
    *report = (struct cost_report){0};
    if (known)
        read_report(root, report, scene);
    json_decref(root);
    return known;
}

bool cost_load_json(const char *path, struct cost_report *report, char **scene)
{
    const char *why;
    bool read = false;
    json_error_t error;
    FILE *from = file_open(path, &why);
    json_t *root = from ? json_loadf(from, 0, &error) : NULL;
    if (!from)
        cli_error("%s: cannot read: %s", path, why);
    else if (!root)
        cli_error("%s:%d: %s", path, error.line, error.text);
    else if (!cost_read(root, report, scene))
        cli_error("%s: this is no report of `whit cost --json`", path);
    else
        read = true;
    if (from)
        fclose(from);
    return read;
}
