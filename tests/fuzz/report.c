/* Reports of `whit cost --json`, which it reads back to compare with. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "app/cost/cost_json.h"

static void choose(const struct cost_report *report)
{
    static const struct cost_goal goals[] = {
        {.kind = COST_UNDER, .metric = COST_RMSE, .limit = 0.01},
        {.kind = COST_WITHIN, .metric = COST_FLIP, .limit = 20.0}};
    char text[COST_SENTENCE_BYTES];
    for (size_t i = 0; i < sizeof goals / sizeof *goals; i++) {
        struct cost_choice choice = cost_choose(report, &goals[i]);
        cost_choice_text(&choice, text, sizeof text);
    }
    cost_sentence(report, text);
}

static void run(const uint8_t *data, size_t size_bytes)
{
    struct cost_report report;
    char *scene = NULL;
    fuzz_log_clear();
    const char *path = fuzz_file("report.json", data, size_bytes);
    bool good = cost_load_json(path, &report, &scene);
    fuzz_check_errors(good ? WHIT_OK : WHIT_ERROR_INPUT, path);
    fuzz_check(!good || (report.row_count > 0 && report.row_count <= COST_ROWS_MAX), "%u rows",
               report.row_count);
    if (good)
        choose(&report);
    free(scene);
}

const struct fuzz_target fuzz_target = {.run = run, .memory_bytes = UINT64_C(1) << 20};
