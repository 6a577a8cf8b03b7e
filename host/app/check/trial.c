#include "app/check/trial.h"

#include "app/check/describe.h"
#include "app/render/render_command.h"

whit_result trial_draw(struct trial *trial, const struct trial_input *input)
{
    struct drawing *drawing = &trial->drawing;
    struct job *job = &drawing->job;
    *trial = (struct trial){.colors = 0};
    *job = (struct job){.settings = input->settings,
                        .scene = input->scene,
                        .device = input->device,
                        .shader = input->shader};
    whit_result result = reference_check(job);
    if (result == WHIT_OK)
        result = job_take_scene(job);
    if (result == WHIT_OK)
        result = render_check_camera(job);
    if (result == WHIT_OK)
        result = job_build(job);
    if (result == WHIT_OK) {
        drawing->params = job_picture(job);
        result = drawing_make(drawing, &drawing->renderer);
    }
    if (result == WHIT_OK)
        result = drawing_render(drawing);
    if (result != WHIT_OK)
        return result;
    trial_hash(drawing, trial);
    return job_still_wanted();
}

void trial_finish(struct trial *trial)
{
    whit_accel *accel = trial->drawing.job.accel;
    whit_renderer_destroy(trial->drawing.renderer);
    drawing_finish(&trial->drawing);
    whit_accel_destroy(accel);
}

void trial_hash(const struct drawing *drawing, struct trial *out)
{
    out->colors = drawing_hash_floats(drawing->color);
    out->ids = drawing_hash_ids(drawing->ids);
}

bool trial_same(const struct trial *a, const struct trial *b)
{
    return a->colors == b->colors && a->ids == b->ids;
}

bool trial_ends_all(whit_result result)
{
    return result == WHIT_ERROR_NO_DEVICE || result == WHIT_ERROR_DEVICE ||
           result == WHIT_ERROR_MEMORY || result == WHIT_ERROR_TIME_LIMIT ||
           result == WHIT_ERROR_CANCELLED;
}
