/* --budget-ms and --max-error: settings by what `whit cost` measures of this scene, size and
   device, once; figures are kept. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost.h"

enum { KEPT_VERSION = 3, KEPT_NAME = 32, SAMPLES = 16, TRIALS = 5, TRIES = 5 };
/* What takes less tells more of who else had the processor. */
static const double TRIAL_MS_MIN = 20.0;

/* The name under which the figures of this scene, size, time, camera and device are kept. */
static void kept_name(const struct job *job, char name[KEPT_NAME])
{
    char key[1024 + SETTING_TEXT_BYTES];
    const whit_renderer_params *picture = &job->settings.picture;
    whit_device_info device;
    whit_scene_info scene;
    whit_device_get_info(job->device, &device);
    whit_scene_get_info(job->scene, &scene);
    snprintf(key, sizeof key, "%d %s %016" PRIx64 " %ux%u %.17g %s|%s|%s", KEPT_VERSION,
             WHIT_VERSION, scene.hash, picture->width, picture->height, picture->time_s,
             job->settings.camera, device.name, device.driver);
    snprintf(name, KEPT_NAME, "cost-%016" PRIx64, cost_hash(key));
}

static whit_result measure(struct job *job, struct cost_report **report)
{
    struct cli_progress progress;
    const struct cost_request wanted = {
        .device = job->device,
        .scene = job->scene,
        .accel = job->accel,
        .settings = &job->settings,
        .cancel = &cli_cancel,
        .time_limit_s = cli_time_left_s(),
        .knobs = knobs_of_light(),
        .seconds = COST_SECONDS_QUICK,
        .samples_max = SAMPLES,
        .progress = cost_on_progress,
        .progress_user = &progress,
        .hush = cli_hush,
        .log = &cli_log,
    };
    if (!job->settings.quiet)
        cli_note("measuring what settings cost in this scene, once");
    cli_progress_init(&progress, job->settings.quiet);
    whit_result result = cost_measure(&wanted, report);
    cli_progress_finish(&progress);
    return result;
}

/* As they are kept, or measured and then kept. The same figures give the same picture. */
static whit_result find_figures(struct job *job, struct cost_report *out)
{
    char name[KEPT_NAME];
    struct cost_report *measured = NULL;
    kept_name(job, name);
    if (cost_load_kept(name, out))
        return WHIT_OK;
    whit_result result = measure(job, &measured);
    if (result == WHIT_OK) {
        *out = *measured;
        cost_keep(measured, name);
    }
    cost_report_destroy(measured);
    return result;
}

/* `slower`: than the figures say, at this moment. */
static struct cost_choice choose(const struct cost_report *report, const struct job *job,
                                 double slower)
{
    const struct settings *settings = &job->settings;
    bool within = settings->budget_ms > 0.0;
    const struct cost_goal goal = {
        .kind = within ? COST_WITHIN : COST_UNDER,
        .metric = COST_RMSE,
        .limit =
            within ? COST_ROOM * settings->budget_ms / slower : COST_ROOM * settings->max_error,
    };
    struct cost_choice choice = cost_choose(report, &goal);
    if (!choice.found && within)
        cli_error("no setting takes at most %.6g ms here", settings->budget_ms);
    else if (!choice.found)
        cli_error("no setting has an error of at most %.6g here", settings->max_error);
    if (within && choice.found && slower > 1.5 && !job->settings.quiet)
        cli_note("at this moment the device takes %.1f times as long as when it was measured",
                 slower);
    return choice;
}

static void say_choice(const struct cost_choice *choice, double ms)
{
    char options[COST_NAME * 4];
    cost_choice_text(choice, options, sizeof options);
    cli_note("chosen: %s; predicted: %.1f ms, RMSE %.3g", options[0] ? options : "what is usual",
             ms, choice->error);
}

/* The choice at this moment, in small where that takes long enough: what the full picture takes,
   the most of TRIALS. From a small picture to the full one it is as far as for the usual settings.
 */
static whit_result try_now(const struct cost_report *report, const struct job *job,
                           double expected_ms, whit_renderer *renderer, double *full_ms)
{
    const whit_renderer_params full = job_picture(job);
    whit_renderer_params tried = full;
    struct cost_times times;
    double larger = report->rows[0].ms[report->clock] / fmax(report->small_ms, 1e-6);
    if (expected_ms / larger >= TRIAL_MS_MIN)
        cost_small_size(report, &tried.width, &tried.height);
    else
        larger = 1.0;
    whit_result result = cost_time(renderer, &tried, TRIALS, &times);
    if (result == WHIT_OK)
        result = whit_renderer_set_view(renderer, &full);
    /* As far beyond the most as half of what is between the trials. */
    *full_ms = larger * (1.5 * times.ms[COST_WALL].high - 0.5 * times.ms[COST_WALL].low);
    return result;
}

/* Chooses until the choice keeps the time when it is tried, and does not leave much of it. */
static whit_result choose_within(const struct cost_report *report, struct job *job,
                                 const struct render_request *request,
                                 struct frames_progress *progress, whit_renderer **renderer)
{
    const struct settings before = job->settings;
    double slower = 1.0, ms = 0.0;
    whit_result result = WHIT_OK;
    for (int i = 0; i < TRIES; ++i) {
        const struct cost_choice choice = choose(report, job, slower);
        if (!choice.found)
            return WHIT_ERROR_FAILED;
        job->settings = before;
        cost_choice_apply(&choice, &job->settings);
        whit_renderer_destroy(*renderer);
        *renderer = NULL;
        result = render_create(job, request, progress, renderer);
        if (result == WHIT_OK)
            result = try_now(report, job, choice.ms, *renderer, &ms);
        if (result != WHIT_OK)
            return result;
        bool fits = ms <= COST_ROOM * before.budget_ms;
        slower = ms / choice.ms;
        if ((fits && (i > 0 || ms >= COST_TOO_LITTLE * choice.ms)) || i == TRIES - 1) {
            say_choice(&choice, ms);
            break;
        }
    }
    if (ms > before.budget_ms)
        cli_note("it is likely to take more than %.6g ms", before.budget_ms);
    return result;
}

whit_result render_choose(struct job *job, const struct render_request *request,
                          struct frames_progress *progress, whit_renderer **renderer)
{
    struct cost_report *report = calloc(1, sizeof *report);
    if (!report) {
        cli_error("out of memory");
        return WHIT_ERROR_MEMORY;
    }
    whit_result result = find_figures(job, report);
    if (result == WHIT_OK && job->settings.budget_ms > 0.0) {
        result = choose_within(report, job, request, progress, renderer);
    } else if (result == WHIT_OK) {
        const struct cost_choice choice = choose(report, job, 1.0);
        result = choice.found ? WHIT_OK : WHIT_ERROR_FAILED;
        if (choice.found) {
            say_choice(&choice, choice.ms);
            cost_choice_apply(&choice, &job->settings);
            result = render_create(job, request, progress, renderer);
        }
    }
    free(report);
    return result;
}
