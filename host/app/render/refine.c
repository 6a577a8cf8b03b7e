#include "app/render/refine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/render/render_command.h"

static const double ERROR_MIN = 1e-9, ERROR_MAX = 1.0, LIMIT_MIN_MS = 1e-3, LIMIT_MAX_MS = 1e9;

/* ---- Options ---- */

bool refine_is_wanted(const struct refine_goal *goal)
{
    return goal->error > 0.0 || goal->limit_ms > 0.0;
}

bool refine_read(const struct setting *setting, const char *value, void *request,
                 char why[SETTING_WHY_BYTES])
{
    struct refine_goal *goal = &((struct render_request *)request)->refine;
    char *end;
    double number = setting_number(value, &end);
    bool is_time = end != value && strcmp(end, "ms") == 0;
    (void)setting;
    *goal = (struct refine_goal){0};
    if (end == value || (*end && !is_time))
        return setting_refuse(
            why, " `%s`: an error such as 0.01 is needed, or a time such as 500ms", value);
    double min = is_time ? LIMIT_MIN_MS : ERROR_MIN, max = is_time ? LIMIT_MAX_MS : ERROR_MAX;
    if (!(number >= min && number <= max))
        return setting_refuse(why, " `%s`: %s from %g to %g%s is needed", value,
                              is_time ? "a time" : "an error", min, max,
                              is_time ? " ms" : ", or a time such as 500ms,");
    *(is_time ? &goal->limit_ms : &goal->error) = number;
    return true;
}

bool refine_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request)
{
    const struct settings *settings = &job->settings;
    if (!refine_is_wanted(&request->refine))
        return true;
    const char *other = render_asks(settings, request, "--budget-ms", "--max-error");
    if (other)
        return cli_misuse(reader, "--refine and %s: one of them", other);
    if (settings_given(settings, "aa"))
        return cli_misuse(reader, "--refine chooses --aa by itself");
    if (request->frames.given || settings->paint != PAINT_COLOR)
        return cli_misuse(reader, "--refine is for one picture of colours");
    return true;
}

/* ---- Steps ---- */

/* A picture that is being refined: its samples, figures and time so far. */
struct refine_steps {
    whit_refine *refine;
    whit_refine_info now;
    whit_stats stats;      /* of all steps */
    double ms_of_a_sample; /* mean time of a sample in the last step */
};

/* Whether the next step fits into the time limit. It doubles the samples, each of which is expected
   to take as long as one of the last step. */
static bool has_time(const struct refine_goal *goal, const struct refine_steps *steps)
{
    double next_ms = steps->ms_of_a_sample * steps->now.samples;
    return goal->limit_ms <= 0.0 || steps->now.samples == 0 ||
           steps->stats.render_ms + next_ms <= goal->limit_ms;
}

/* Also true where the error of cut rays alone, which more samples do not reduce, is too large
   already. */
static bool is_done(const struct refine_goal *goal, const whit_refine_info *now)
{
    enum { SAMPLES_TO_TELL = 4 };
    bool told = goal->error > 0.0 && now->error >= 0.0;
    return now->last || (told && now->error <= goal->error) ||
           (told && now->samples >= SAMPLES_TO_TELL && now->error_of_cuts > goal->error);
}

/* Estimates the final number of samples, for the progress bar. */
static uint32_t foresee_samples(const struct refine_goal *goal, const struct refine_steps *steps)
{
    const double falls = 0.6; /* about the factor by which twice as many samples reduce the error */
    double doublings = 1.0;
    if (steps->now.samples == 0)
        return REFINE_SAMPLES_USUAL;
    if (goal->limit_ms > 0.0)
        doublings = log2(goal->limit_ms / steps->stats.render_ms);
    else if (steps->now.error > 0.0)
        doublings = log(goal->error / steps->now.error) / log(falls);
    else
        doublings = log2(REFINE_SAMPLES_USUAL);
    doublings = fmin(fmax(ceil(doublings), 1.0), log2(WHIT_SAMPLES_MAX / steps->now.samples));
    return steps->now.samples << (uint32_t)doublings;
}

static whit_result take_step(const struct refine_goal *goal, struct refine_steps *steps,
                             struct frames_progress *progress)
{
    uint32_t samples = steps->now.samples;
    double before_ms = samples ? steps->stats.render_ms : 0.0;
    progress->done = samples;
    progress->parts = samples ? samples : 1;
    progress->count = foresee_samples(goal, steps);
    whit_result result = whit_refine_step(steps->refine);
    if (result == WHIT_OK)
        result = job_still_wanted();
    if (result != WHIT_OK)
        return result;
    whit_refine_get_info(steps->refine, &steps->now);
    whit_refine_get_stats(steps->refine, &steps->stats);
    uint32_t drawn = steps->now.samples - samples;
    if (drawn > 0)
        steps->ms_of_a_sample = (steps->stats.render_ms - before_ms) / drawn;
    return WHIT_OK;
}

static whit_result finish(struct job *job, const struct refine_goal *goal,
                          const struct refine_steps *steps, struct refined *refined,
                          struct drawn_images *images)
{
    const whit_refine_info *now = &steps->now;
    refined->now = *now;
    refined->reached = goal->limit_ms > 0.0 || (now->error >= 0.0 && now->error <= goal->error);
    job->settings.picture.sampling = (whit_sampling){.count = now->samples};
    whit_result result = whit_refine_image(steps->refine, &images->color);
    return result == WHIT_OK ? layers_read(job->shader, NULL, steps->refine, &images->layers)
                             : result;
}

whit_result refine_render(struct job *job, const struct render_request *request,
                          whit_renderer *renderer, struct frames_progress *progress,
                          struct drawn_images *images, struct sequence *sequence)
{
    const whit_renderer_params params = job_picture(job);
    const struct refine_goal *goal = &request->refine;
    struct refine_steps steps = {.now.error = -1.0};
    bool needs_ids = request->ids || job->settings.edges != EDGES_OFF;
    *images = (struct drawn_images){0};
    whit_result result = whit_refine_create(renderer, &params, &steps.refine);
    while (result == WHIT_OK && !is_done(goal, &steps.now) && has_time(goal, &steps)) {
        bool first = steps.now.samples == 0;
        result = take_step(goal, &steps, progress);
        if (result == WHIT_OK && first && needs_ids)
            result = whit_renderer_image(renderer, WHIT_AOV_IDS, &images->ids);
    }
    if (result == WHIT_OK)
        result = finish(job, goal, &steps, &sequence->refined, images);
    whit_refine_destroy(steps.refine);
    sequence->stats = steps.stats;
    if (result != WHIT_OK)
        drawn_images_finish(images);
    return result;
}

void refine_say(const struct refine_goal *goal, const struct refined *refined)
{
    const char *plural = refined->now.samples == 1 ? "" : "s";
    if (refined->now.error < 0.0)
        cli_note("%u sample%s a pixel, which %s nothing of what is wrong", refined->now.samples,
                 plural, refined->now.samples == 1 ? "tells" : "tell");
    else if (refined->reached)
        cli_note("%u sample%s a pixel: an RMSE of %.3g may be left", refined->now.samples, plural,
                 refined->now.error);
    else if (refined->now.error_of_cuts > goal->error)
        cli_error("an RMSE of %.3g may be left, not %.6g: %.3g of it are rays that --depth and "
                  "--bailout cut, and more samples leave it",
                  refined->now.error, goal->error, refined->now.error_of_cuts);
    else
        cli_error("an RMSE of %.3g may be left, not %.6g: there are no more than %u samples",
                  refined->now.error, goal->error, refined->now.samples);
}
