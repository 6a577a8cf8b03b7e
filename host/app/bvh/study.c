#include "app/bvh/study.h"

#include <stdlib.h>
#include <string.h>

const char *const study_kind_names[STUDY_KINDS] = {"primary", "shadow", "diffuse"};

whit_result study_step(struct study *study)
{
    ++study->steps_done;
    cli_progress_update(&study->progress, (double)study->steps_done / study->steps);
    return job_still_wanted();
}

/* Checks that the tree is the same for every number of threads. */
static whit_result check_same(const struct study_row *row, const whit_accel_info *info)
{
    bool same = row->info.node_count == info->node_count &&
                row->info.reference_count == info->reference_count &&
                row->info.depth == info->depth && row->info.sah_cost == info->sah_cost;
    if (same)
        return WHIT_OK;
    return CLI_FAIL(WHIT_ERROR_STATUS, "%s: two builds gave two trees: SAH costs %.9g and %.9g",
                    row->name, row->info.sah_cost, info->sah_cost);
}

/* Builds a row once; the first tree is kept. */
static whit_result build_once(struct study *study, struct study_row *row, uint32_t threads,
                              double *build_ms)
{
    whit_accel_params params = study->job.settings.trees;
    whit_accel *accel = NULL;
    char why[SETTING_WHY_BYTES];
    if (!builder_read(row->name, &params, why))
        return CLI_FAIL(WHIT_ERROR_USAGE, "%s%s", row->name, why);
    params.threads = threads;
    whit_result result = whit_accel_create(study->job.scene, &params, &accel);
    if (result != WHIT_OK)
        return result;
    whit_accel_info info;
    whit_accel_get_info(accel, &info);
    *build_ms = info.build_ms;
    if (!row->accel) {
        row->accel = accel;
        row->info = info;
        return WHIT_OK;
    }
    whit_accel_destroy(accel);
    return check_same(row, &info);
}

static whit_result build_list(void *user, uint32_t list, uint32_t run)
{
    struct study *study = user;
    whit_result result = build_once(study, &study->rows[list % study->row_count],
                                    study->threads[list / study->row_count],
                                    &study->times_ms[(size_t)list * study->run_count + run]);
    return result == WHIT_OK ? study_step(study) : result;
}

whit_result study_build(struct study *study)
{
    uint32_t runs = study->run_count, lists = study->row_count * study->thread_count;
    study->times_ms = calloc((size_t)lists * runs, sizeof *study->times_ms);
    if (!study->times_ms)
        return cli_no_memory();
    whit_result result = sample_in_turns(lists, runs, build_list, study);
    for (uint32_t list = 0; result == WHIT_OK && list < lists; ++list)
        study->rows[list % study->row_count].build_ms[list / study->row_count] =
            sample_sum_up(&study->times_ms[(size_t)list * runs], runs);
    return result;
}

whit_result study_report(struct study *study)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < study->row_count; ++i) {
        struct study_row *row = &study->rows[i];
        if (study->validate)
            result = whit_accel_validate(row->accel);
        if (result == WHIT_OK)
            result = whit_accel_get_report(row->accel, &row->report);
        if (result == WHIT_OK)
            result = study_step(study);
    }
    return result;
}

void study_finish(struct study *study)
{
    for (uint32_t i = 0; i < study->row_count; ++i) {
        whit_renderer_destroy(study->rows[i].renderer);
        whit_accel_destroy(study->rows[i].accel);
    }
    for (uint32_t k = 0; k < STUDY_KINDS; ++k)
        free(study->rays[k].rays);
    free(study->times_ms);
    cli_progress_finish(&study->progress);
    job_finish(&study->job);
}
