/* --budget-ms and --max-error: choose settings by the figures that `whit cost` measures for this
   scene, size and device. They are measured once and kept in the cache. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/cost/cost_choice.h"
#include "app/cost/cost_kept.h"
#include "base/array.h"
#include "base/sample.h"

enum { SAMPLES = 16, TRIALS = 5, TRIES = 6 };
/* Limits of the search for samples at edges. */
enum { EDGE_TRIES = 4, EDGE_SAMPLES_MAX = 64, WHOLE_TIMES = 3 };
/* Pictures that take less are timed WHOLE_TIMES times. */
static const double THRICE_MS = 1e3;
static const double EDGE_BUDGET_MAX_MS = 10e3;
/* A sample at an edge takes about so many times as long as another one. */
static const double EDGES_DEARER = 2.0;
/* Smaller differences of neighbours are not visible. */
static const double CONTRAST_MIN = 1.0 / 256.0;
/* Shorter trials mostly measure what else the processor was doing. */
static const double TRIAL_MS_MIN = 50.0;
/* No further choice is tried once one takes this share of the budget. */
static const double ENOUGH = 0.8;

static whit_result measure(struct job *job, struct cost_report **report)
{
    struct cli_progress progress;
    const struct cost_request wanted = {
        .device = job->device,
        .scene = job->scene,
        .accel = job->accel,
        .settings = &job->settings,
        .cancel = &cli_cancel,
        .end_ms = cli_time_end_ms(),
        .knobs = knobs_of_light(),
        .seconds = COST_SECONDS_QUICK,
        .samples_max = SAMPLES,
        .progress = cli_progress_tell,
        .progress_user = &progress,
        .hush = cli_hush,
        .log = job->settings.quiet ? &cli_log : &cli_log_notes,
    };
    if (!job->settings.quiet)
        cli_note("measuring what settings cost in this scene, once");
    cli_progress_init(&progress, job->settings.quiet);
    whit_result result = cost_measure(&wanted, report);
    cli_progress_finish(&progress);
    return result;
}

/* Gives the kept figures, or measures and keeps them. */
static whit_result find_figures(struct job *job, bool fresh, const struct cost_place *place,
                                struct cost_kept *kept)
{
    struct cost_report *measured = NULL;
    if (cost_kept_load(place, kept) && !fresh) {
        if (!job->settings.quiet)
            cli_note("by figures of %s, kept with the scene; --fresh measures anew", kept->made);
        return WHIT_OK;
    }
    whit_result result = measure(job, &measured);
    if (result == WHIT_OK) {
        cost_kept_begin(kept, measured);
        cost_kept_save(kept);
    }
    cost_report_destroy(measured);
    return result;
}

/* Whether the number of samples is a power of 4, and edges get more in the time that is left. That
   is a better use of the time than numbers between powers of 4, which are not spread evenly: at
   1280x720 34k has with 3 samples in 546 ms an RMSE of 0.0030, with 1 to 4 (contrast 0.05) in 227
   ms 0.0017; whitted 0.0094 in 1388 ms, and (0.1) 0.0049 in 1042; sphereflake 0.0142 in 2099 ms,
   and (0.1) 0.0095 in 1916. Whole pictures are tried, so a long one has to do without. */
static bool takes_edges(double budget_ms)
{
    return budget_ms <= EDGE_BUDGET_MAX_MS;
}

static struct cost_choice choose(const struct cost_report *report, const struct settings *settings,
                                 double limit_ms)
{
    bool within = settings->budget_ms > 0.0;
    const struct cost_goal goal = {
        .kind = within ? COST_WITHIN : COST_UNDER,
        .metric = COST_RMSE,
        .limit = within ? limit_ms : COST_ROOM * settings->max_error,
        .edges = within && takes_edges(settings->budget_ms),
    };
    return cost_choose(report, &goal);
}

static struct cost_choice choose_first(const struct cost_report *report,
                                       const struct settings *settings)
{
    struct cost_choice choice =
        settings->budget_ms > 0.0
            ? cost_choose_budget(report, settings->budget_ms, takes_edges(settings->budget_ms))
            : choose(report, settings, 0.0);
    if (!choice.found && settings->budget_ms > 0.0)
        cli_error("no setting takes at most %.6g ms here", settings->budget_ms);
    else if (!choice.found)
        cli_error("no setting is predicted to have an error of at most %.6g here, with up to %d "
                  "samples a pixel",
                  settings->max_error, COST_SAMPLES_MAX);
    return choice;
}

/* `ms`: predicted time; 0: nothing is said of it. */
static void say_choice(const struct job *job, const struct cost_choice *choice, double ms)
{
    char options[COST_NAME * 4], time[32] = "";
    cost_choice_text(choice, options, sizeof options);
    if (ms > 0.0)
        snprintf(time, sizeof time, "%.1f ms, ", ms);
    if (!job->settings.quiet)
        cli_note("chosen: %s; predicted: %sRMSE %.3g", options[0] ? options : "what is usual", time,
                 choice->error);
}

/* ---- Within a time ---- */

struct choosing {
    struct job *job;
    const struct cost_report *report;
    const struct cost_place *place;
    const struct render_request *request;
    struct frames_progress *progress;
    struct settings before;
    whit_renderer **renderer; /* the renderer of the current choice */
};

static whit_result set_choice(const struct choosing *choosing, const struct cost_choice *choice)
{
    choosing->job->settings = choosing->before;
    cost_choice_apply(choice, &choosing->job->settings);
    whit_renderer_destroy(*choosing->renderer);
    *choosing->renderer = NULL;
    return render_create(choosing->job, choosing->request, choosing->progress, choosing->renderer);
}

/* Makes a trial picture cheaper: fewer samples, or a small size where it has few. Returns the
   factor from its time to that of the full picture; 1: it was quick enough already. The factor for
   a small size is that of the usual settings. */
static double cut_down(const struct cost_report *report, const struct cost_choice *choice,
                       whit_renderer_params *picture)
{
    enum { PART = 16, FEW = 4 };
    double least = choice->samples * TRIAL_MS_MIN / choice->ms;
    double smaller = report->rows[0].ms[COST_WALL] / fmax(report->small_ms, 1e-6);
    if (choice->samples >= FEW) {
        uint32_t count = (uint32_t)fmin(fmax(choice->samples / PART, least), choice->samples);
        picture->sampling.count = count > 0 ? count : 1;
        return (double)choice->samples / picture->sampling.count;
    }
    if (choice->ms / smaller < TRIAL_MS_MIN)
        return 1.0;
    cost_small_size(report, &picture->width, &picture->height);
    return smaller;
}

/* Estimates from TRIALS trials how long the full picture takes with this choice at this moment, at
   most. */
static whit_result try_now(const struct choosing *choosing, const struct cost_choice *choice,
                           double *full_ms)
{
    const whit_renderer_params full = job_picture(choosing->job);
    whit_renderer_params tried = full;
    struct cost_times times;
    double larger = cut_down(choosing->report, choice, &tried);
    whit_result result = cost_time(*choosing->renderer, &tried, TRIALS, &times);
    if (result == WHIT_OK)
        result = whit_renderer_set_view(*choosing->renderer, &full);
    /* The estimate is the slowest trial. Where the full picture is `larger` trials long their
       variations average out, so the margin grows only by the square root. */
    const struct sample_median *ms = &times.ms[COST_WALL];
    double beyond_ms = ms->high - ms->median;
    *full_ms = larger * ms->median + sqrt(fmax(larger, 1.0)) * beyond_ms;
    return result;
}

static bool is_same(const struct cost_choice *a, const struct cost_choice *b)
{
    return a->samples == b->samples && a->contrast == b->contrast &&
           a->samples_max == b->samples_max &&
           memcmp(a->settings, b->settings, sizeof a->settings) == 0;
}

/* Tries choices, each made for the speed of the device that the last trials showed, until one takes
   ENOUGH of the budget or the next would be the same. *best gets the slowest one that keeps the
   budget, or the last one tried where none does. */
static whit_result find_within(const struct choosing *choosing, struct cost_kept_choice *best)
{
    const double budget_ms = choosing->before.budget_ms, aim_ms = COST_ROOM * budget_ms;
    struct cost_choice choice = choose_first(choosing->report, &choosing->before);
    struct cost_kept_choice tried = {.budget_ms = budget_ms};
    double slower[2] = {
        0}; /* measured / predicted time of the last try: too long; within the budget */
    whit_result result = choice.found ? WHIT_OK : WHIT_ERROR_FAILED;
    for (int i = 0; result == WHIT_OK && i < TRIES; ++i) {
        tried.choice = choice;
        result = set_choice(choosing, &choice);
        if (result == WHIT_OK)
            result = try_now(choosing, &choice, &tried.tried_ms);
        bool fits = tried.tried_ms <= aim_ms;
        if (slower[1] == 0.0 || (fits && choice.ms > best->choice.ms))
            *best = tried;
        slower[fits] = tried.tried_ms / choice.ms;
        double now =
            slower[0] > 0.0 && slower[1] > 0.0 ? sqrt(slower[0] * slower[1]) : slower[fits];
        choice = choose(choosing->report, &choosing->before, aim_ms / now);
        if (!choice.found || is_same(&choice, &tried.choice) ||
            (fits && tried.tried_ms >= ENOUGH * budget_ms))
            break;
    }
    if (result == WHIT_OK && !is_same(&best->choice, &tried.choice))
        result = set_choice(choosing, &best->choice);
    return result;
}

/* ---- Smooth edges for what is left of a time ---- */

static float displayed(float value)
{
    return fminf(fmaxf(value, 0.0f), 1.0f);
}

/* The largest difference of the pixel to a neighbour, in any channel, as sampling.contrast means
   it. */
static float contrast_of(const whit_image *image, const whit_image_info *info, uint32_t x,
                         uint32_t y)
{
    const float *pixels = whit_image_floats(image);
    float largest = 0.0f;
    uint32_t right = x + 1 < info->width ? x + 1 : x, below = y + 1 < info->height ? y + 1 : y;
    for (uint32_t v = y > 0 ? y - 1 : 0; v <= below; ++v) {
        for (uint32_t u = x > 0 ? x - 1 : 0; u <= right; ++u) {
            for (uint32_t c = 0; c < 3; ++c) {
                float own = pixels[((size_t)y * info->width + x) * info->channels + c],
                      other = pixels[((size_t)v * info->width + u) * info->channels + c];
                largest = fmaxf(largest, fabsf(displayed(own) - displayed(other)));
            }
        }
    }
    return largest;
}

/* Gives the contrasts of all pixels of the renderer's picture, in rising order. *out is the
   caller's. */
static whit_result sort_contrasts(whit_renderer *renderer, double **out, uint32_t *count)
{
    whit_image *image = NULL;
    whit_image_info info;
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &image);
    if (result != WHIT_OK)
        return result;
    whit_image_get_info(image, &info);
    *count = info.width * info.height;
    *out = array_alloc(*count, sizeof **out);
    for (uint32_t i = 0; *out && i < *count; ++i)
        (*out)[i] = (double)contrast_of(image, &info, i % info.width, i / info.width);
    whit_image_destroy(image);
    if (!*out)
        return cli_no_memory();
    sample_sort(*out, *count);
    return WHIT_OK;
}

/* Times the picture, after a small one that makes the kernels: the slowest of three where one is
   short enough to be drawn three times. */
static whit_result time_whole(const struct choosing *choosing, double *ms)
{
    const whit_renderer_params picture = job_picture(choosing->job);
    whit_renderer_params small = picture;
    cost_small_size(choosing->report, &small.width, &small.height);
    whit_renderer *renderer = *choosing->renderer;
    whit_result result = whit_renderer_set_view(renderer, &small);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = whit_renderer_set_view(renderer, &picture);
    *ms = 0.0;
    for (uint32_t i = 0; result == WHIT_OK && i < (*ms < THRICE_MS ? WHOLE_TIMES : 1); ++i) {
        double start_ms = whit_clock_ms();
        result = whit_renderer_render(renderer);
        *ms = fmax(*ms, whit_clock_ms() - start_ms);
    }
    return result;
}

/* The share of pixels that differ visibly from a neighbour. */
static double visible_share(const double *contrasts, uint32_t count)
{
    uint32_t below = 0;
    while (below < count && contrasts[below] <= CONTRAST_MIN)
        ++below;
    return 1.0 - (double)below / (double)count;
}

/* Spends what is left of the time on 4 times as many samples at the strongest edges, or on 16 times
   as many where all visible edges leave half of it. Whole pictures are tried, since the share of
   edges depends on the size. */
static whit_result smooth_edges(const struct choosing *choosing, struct cost_kept_choice *best)
{
    const double budget_ms = best->budget_ms, aim_ms = COST_ROOM * budget_ms;
    struct cost_kept_choice tried = *best;
    double *contrasts = NULL, least_ms = 0.0, best_ms;
    uint32_t count = 0;
    whit_result result = time_whole(choosing, &least_ms);
    if (result == WHIT_OK)
        result = sort_contrasts(*choosing->renderer, &contrasts, &count);
    double share = (0.95 * aim_ms / least_ms - 1.0) / 3.0 / EDGES_DEARER;
    double visible = result == WHIT_OK ? visible_share(contrasts, count) : 0.0;
    uint32_t most = 4 * tried.choice.samples;
    best_ms = least_ms;
    best->tried_ms = fmax(best->tried_ms, least_ms);
    for (int i = 0;
         result == WHIT_OK && visible > 0.0 && best_ms < ENOUGH * budget_ms && i < EDGE_TRIES;
         ++i) {
        if (share > 2.0 * visible && 4 * most <= EDGE_SAMPLES_MAX) {
            share /= 5.0; /* 4 and then 16 samples more */
            most *= 4;
        }
        share = fmin(share, visible);
        double contrast = fmax(sample_quantile(contrasts, count, 1.0 - share), CONTRAST_MIN);
        contrast = ceil(contrast * 1e3) / 1e3;
        if (tried.choice.samples_max == most && tried.choice.contrast == contrast)
            break; /* that was tried */
        tried.choice.samples_max = most;
        tried.choice.contrast = contrast;
        result = set_choice(choosing, &tried.choice);
        if (result == WHIT_OK)
            result = time_whole(choosing, &tried.tried_ms);
        if (tried.tried_ms <= aim_ms && tried.tried_ms > best_ms) {
            *best = tried;
            best_ms = tried.tried_ms;
        }
        /* The strongest edges take the most time, so less of it is saved than of the edges. */
        double ratio = (0.95 * aim_ms - least_ms) / fmax(tried.tried_ms - least_ms, 1e-3);
        share *= ratio < 1.0 ? pow(ratio, 1.5) : fmin(ratio, 3.0);
    }
    free(contrasts);
    if (result == WHIT_OK && !is_same(&best->choice, &tried.choice))
        result = set_choice(choosing, &best->choice);
    return result;
}

static whit_result choose_within(const struct choosing *choosing, const struct cost_kept *kept)
{
    const struct cost_kept_choice *known = cost_kept_find(kept, choosing->before.budget_ms);
    struct cost_kept_choice found = {0};
    whit_result result;
    if (known) {
        found = *known;
        result = set_choice(choosing, &found.choice);
    } else {
        result = find_within(choosing, &found);
        if (result == WHIT_OK && takes_edges(found.budget_ms) &&
            4 * found.choice.samples <= EDGE_SAMPLES_MAX)
            result = smooth_edges(choosing, &found);
    }
    if (result != WHIT_OK)
        return result;
    if (!known)
        cost_kept_add(choosing->place, kept, &found);
    say_choice(choosing->job, &found.choice, found.tried_ms);
    choosing->progress->predicted_ms = found.tried_ms;
    if (found.tried_ms > found.budget_ms && !choosing->job->settings.quiet)
        cli_note("it is likely to take more than %.6g ms", found.budget_ms);
    return WHIT_OK;
}

/* ---- Below an error ---- */

static whit_result choose_under(const struct choosing *choosing)
{
    const struct cost_choice choice = choose_first(choosing->report, &choosing->before);
    if (!choice.found)
        return WHIT_ERROR_FAILED;
    /* Ratios of settings that save the same rays are multiplied, so the time may be several times
       as long as predicted. */
    say_choice(choosing->job, &choice, 0.0);
    return set_choice(choosing, &choice);
}

whit_result render_choose(struct job *job, const struct render_request *request,
                          struct frames_progress *progress, whit_renderer **renderer)
{
    struct cost_kept *kept = malloc(sizeof *kept);
    if (!kept)
        return cli_no_memory();
    struct cost_place place = {0};
    const struct choosing choosing = {.job = job,
                                      .report = &kept->report,
                                      .place = &place,
                                      .request = request,
                                      .progress = progress,
                                      .before = job->settings,
                                      .renderer = renderer};
    place.settings = &choosing.before;
    whit_scene_get_info(job->scene, &place.scene);
    whit_device_get_info(job->device, &place.device);
    whit_result result = find_figures(job, request->fresh, &place, kept);
    if (result == WHIT_OK)
        result = job->settings.budget_ms > 0.0 ? choose_within(&choosing, kept)
                                               : choose_under(&choosing);
    free(kept);
    return result;
}
