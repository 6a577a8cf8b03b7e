#include "app/check/trial.h"

#include "app/render/render_command.h"

whit_result trial_draw(struct drawing *drawing, const struct job *input)
{
    struct job *job = &drawing->job;
    *drawing = (struct drawing){.job = *input};
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
    return result == WHIT_OK ? job_still_wanted() : result;
}

void trial_finish(struct drawing *drawing)
{
    whit_accel *accel = drawing->job.accel;
    whit_renderer_destroy(drawing->renderer);
    drawing_finish(drawing);
    whit_accel_destroy(accel);
}

bool trial_ends_all(whit_result result)
{
    return result == WHIT_ERROR_NO_DEVICE || result == WHIT_ERROR_DEVICE ||
           result == WHIT_ERROR_MEMORY || result == WHIT_ERROR_TIME_LIMIT ||
           result == WHIT_ERROR_CANCELLED;
}
