/* A record in whit's cache for --budget-ms and --max-error: the measured figures of a scene, and
   the choices made by them, so that the next run makes the same choice. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/cost/cost_json.h"
#include "app/cost/cost_kept.h"
#include "base/hash.h"
#include "base/store.h"

enum { KEPT_VERSION = 9 };

/* The record's name is a hash of everything that decides pixels or time (scene, device, driver,
   version of whit, settings), except the settings that are chosen. */
static void find_name(const struct cost_place *place, char name[COST_KEPT_NAME])
{
    char key[2048 + SETTING_TEXT_BYTES], line[1024 + SETTING_TEXT_BYTES];
    struct settings settings = *place->settings;
    const whit_renderer_params *picture = &settings.picture;
    settings.budget_ms = settings.max_error = 0.0;
    settings_write(&settings, SETTINGS_LINE, " ", line, sizeof line);
    snprintf(key, sizeof key, "%d %s %016" PRIx64 " %ux%u %.17g %u %d %d %u %u %s|%s|%s",
             KEPT_VERSION, WHIT_VERSION, place->scene.hash, picture->width, picture->height,
             picture->time_s, picture->tile_size, (int)picture->packets, (int)picture->classes,
             picture->segments, picture->node_bytes, line, place->device.name,
             place->device.driver);
    snprintf(name, COST_KEPT_NAME, "cost-%016" PRIx64, hash_bytes(HASH_START, key, strlen(key)));
}

void cost_kept_begin(struct cost_kept *kept, const struct cost_report *report)
{
    time_t now = time(NULL);
    struct tm utc;
    kept->report = *report;
    kept->choice_count = 0;
    kept->made[0] = '\0';
    if (gmtime_r(&now, &utc))
        strftime(kept->made, sizeof kept->made, "%Y-%m-%d %H:%M UTC", &utc);
}

/* Budgets come back from JSON with 15 digits, of which fractions have more. */
static bool same_budget(double a, double b)
{
    return fabs(a - b) <= 1e-14 * a;
}

const struct cost_kept_choice *cost_kept_find(const struct cost_kept *kept, double budget_ms)
{
    for (uint32_t i = 0; i < kept->choice_count; ++i) {
        const struct cost_kept_choice *choice = &kept->choices[i];
        if (same_budget(choice->budget_ms, budget_ms) && choice->tried_ms <= budget_ms)
            return choice;
    }
    return NULL;
}

static void add(struct cost_kept *kept, const struct cost_kept_choice *choice)
{
    uint32_t drop = 0; /* the one for the same budget, or the oldest */
    while (drop < kept->choice_count &&
           !same_budget(kept->choices[drop].budget_ms, choice->budget_ms))
        ++drop;
    if (drop == COST_KEPT_CHOICES)
        drop = 0;
    if (drop < kept->choice_count)
        memmove(kept->choices + drop, kept->choices + drop + 1,
                (--kept->choice_count - drop) * sizeof *kept->choices);
    kept->choices[kept->choice_count++] = *choice;
}

/* ---- Writing ---- */

static void put_choice(json_t *out, const struct cost_kept_choice *kept)
{
    document_number(out, "budget_ms", kept->budget_ms);
    document_number(out, "tried_ms", kept->tried_ms);
    document_number(out, "predicted_ms", kept->choice.ms);
    document_number(out, "predicted_error", kept->choice.error);
    document_count(out, "samples", kept->choice.samples);
    document_number(out, "contrast", kept->choice.contrast);
    document_count(out, "samples_max", kept->choice.samples_max);
    json_t *settings = document_child(out, "settings");
    for (uint32_t k = 0; k < KNOBS; ++k)
        document_text(settings, knob_table[k].name,
                      knob_setting_name(&knob_table[k], kept->choice.settings[k]));
}

void cost_kept_save(const struct cost_kept *kept)
{
    if (!kept->report.complete)
        return;
    json_t *root = document_root();
    document_text(root, "made", kept->made);
    document_put(root, "figures", cost_document(&kept->report, NULL));
    json_t *choices = document_list(root, "choices");
    for (uint32_t i = 0; i < kept->choice_count; ++i)
        put_choice(document_entry(choices), &kept->choices[i]);
    char *text = document_line(root);
    store_write(&cli_log, kept->name, text, strlen(text));
    free(text);
}

/* ---- Reading ---- */

static bool read_choice(const json_t *object, struct cost_kept_choice *kept)
{
    const json_t *settings = json_object_get(object, "settings");
    kept->budget_ms = document_read_number(object, "budget_ms", 0.0);
    kept->tried_ms = document_read_number(object, "tried_ms", 0.0);
    kept->choice.ms = document_read_number(object, "predicted_ms", 0.0);
    kept->choice.error = document_read_number(object, "predicted_error", 0.0);
    json_int_t samples = json_integer_value(json_object_get(object, "samples")),
               most = json_integer_value(json_object_get(object, "samples_max"));
    for (uint32_t k = 0; k < KNOBS; ++k) {
        const char *text = json_string_value(json_object_get(settings, knob_table[k].name));
        uint32_t s = text ? knob_find_setting(&knob_table[k], text) : WHIT_NONE;
        if (s == WHIT_NONE)
            return false;
        kept->choice.settings[k] = (uint8_t)s;
    }
    kept->choice.samples = (uint32_t)samples;
    kept->choice.samples_max = (uint32_t)most;
    kept->choice.contrast = document_read_number(object, "contrast", 0.0);
    kept->choice.found = true;
    return kept->budget_ms > 0.0 && kept->choice.contrast >= 0.0 && kept->choice.contrast <= 1.0 &&
           samples >= 1 && samples <= WHIT_SAMPLES_MAX &&
           (kept->choice.contrast == 0.0 || most == 4 * samples || most == 16 * samples);
}

/* Takes over `root`. */
static bool read_kept(json_t *root, struct cost_kept *kept)
{
    json_t *figures = json_incref(json_object_get(root, "figures"));
    const json_t *choices = json_object_get(root, "choices"), *choice;
    const char *made = json_string_value(json_object_get(root, "made"));
    size_t i;
    bool good = cost_read(figures, &kept->report, NULL) && kept->report.complete && made;
    snprintf(kept->made, sizeof kept->made, "%s", made ? made : "");
    json_array_foreach(choices, i, choice)
    {
        good = good && i < COST_KEPT_CHOICES && read_choice(choice, &kept->choices[i]);
        kept->choice_count += good;
    }
    json_decref(root);
    return good;
}

bool cost_kept_load(const struct cost_place *place, struct cost_kept *kept)
{
    uint8_t *data;
    size_t bytes;
    *kept = (struct cost_kept){0};
    find_name(place, kept->name);
    bool good = store_read(&cli_log, kept->name, &data, &bytes) &&
                read_kept(json_loadb((const char *)data, bytes, 0, NULL), kept);
    free(data);
    return good && kept->report.scene_hash == place->scene.hash &&
           kept->report.width == place->settings->picture.width &&
           kept->report.height == place->settings->picture.height &&
           strcmp(kept->report.device, place->device.name) == 0 &&
           strcmp(kept->report.driver, place->device.driver) == 0;
}

void cost_kept_add(const struct cost_place *place, const struct cost_kept *kept,
                   const struct cost_kept_choice *choice)
{
    struct cost_kept *now = malloc(sizeof *now);
    if (!now)
        return;
    if (!cost_kept_load(place, now))
        *now = *kept;
    add(now, choice);
    cost_kept_save(now);
    free(now);
}

/* ---- For the viewer ---- */

bool cost_kept_load_figures(const struct cost_place *place, struct cost_kept_figures *figures)
{
    struct cost_kept *kept = malloc(sizeof *kept);
    bool found = kept && cost_kept_load(place, kept);
    if (found) {
        const struct cost_kept_choice *choice = cost_kept_find(kept, place->settings->budget_ms);
        *figures = (struct cost_kept_figures){.report = kept->report};
        memcpy(figures->made, kept->made, sizeof figures->made);
        if (choice) {
            figures->choice = choice->choice;
            figures->choice.contrast = 0.0; /* the window refines pictures of fixed samples alone */
            figures->choice_ms = choice->tried_ms;
        }
    }
    free(kept);
    return found;
}

/* Choices kept for other budgets by the same figures stay. */
void cost_kept_save_figures(const struct cost_place *place, const struct cost_kept_figures *figures)
{
    struct cost_kept *kept = malloc(sizeof *kept);
    if (!kept)
        return;
    if (!cost_kept_load(place, kept) || !figures->made[0])
        cost_kept_begin(kept, &figures->report);
    if (figures->choice.found)
        add(kept, &(struct cost_kept_choice){.budget_ms = place->settings->budget_ms,
                                             .tried_ms = figures->choice_ms,
                                             .choice = figures->choice});
    cost_kept_save(kept);
    free(kept);
}
