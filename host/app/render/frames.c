#include "app/render/frames.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "app/arguments.h"
#include "app/render/render_command.h"
#include "app/render/resume.h"
#include "base/array.h"
#include "base/sample.h"
#include "base/text.h"

enum { FRAME_MAX = 1000000000 };

/* ---- Options ---- */

bool frames_read(const struct setting *setting, const char *value, void *request,
                 char why[SETTING_WHY_BYTES])
{
    struct frames *frames = &((struct render_request *)request)->frames;
    const char *text = text_number(value, FRAME_MAX, &frames->first);
    (void)setting;
    if (text && *text == '-')
        text = text_number(text + 1, FRAME_MAX, &frames->last);
    else
        text = NULL;
    if (!text || *text)
        return setting_refuse(why, " `%s`: A-B is needed, whole numbers such as 0-99", value);
    if (frames->last < frames->first)
        return setting_refuse(why, " `%s`: the last frame is before the first", value);
    frames->given = true;
    return true;
}

char *frames_path(const char *pattern, uint32_t frame)
{
    size_t length, at = cli_find_marks(pattern, &length), size = strlen(pattern) + 16;
    char *path = length ? malloc(size) : NULL;
    if (path)
        snprintf(path, size, "%.*s%0*u%s", (int)at, pattern, (int)length, frame,
                 pattern + at + length);
    return path;
}

/* Checks that the file name of an option has # for the number; `file` NULL: the option was not
   given. */
static bool check_marks(struct cli_reader *reader, const struct render_request *request,
                        const char *option, const char *file, const char *ending)
{
    bool views = request->cameras.file != NULL;
    size_t length = 0;
    if (file)
        cli_find_marks(file, &length);
    return !file || length > 0 ||
           cli_misuse(reader,
                      "%s %s: with %s its name needs # for the number of the %s, such as "
                      "name.####.%s",
                      option, file, views ? "--cameras" : "--frames", views ? "view" : "frame",
                      ending);
}

bool frames_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request)
{
    if ((!request->frames.given || request->cameras.file) &&
        settings_given(&job->settings, "fps") && !settings_given(&job->settings, "frame"))
        return cli_misuse(reader, "--fps is for --frame and --frames");
    if (!request->frames.given)
        return true;
    bool time = settings_given(&job->settings, "time");
    if (!request->cameras.file && (time || settings_given(&job->settings, "frame")))
        return cli_misuse(reader, "--frames and --%s: either all of these frames or one",
                          time ? "time" : "frame");
    return check_marks(reader, request, "-o", request->output, "png") &&
           check_marks(reader, request, "--ids", request->ids, "exr") &&
           check_marks(reader, request, "--distances", request->cameras.distances, "exr");
}

/* ---- Progress ---- */

/* Warns when a picture will take longer than its budget. Until a quarter is done the estimate
   assumes a quarter, because the first parts may be the most expensive ones. */
static void watch_budget(struct frames_progress *progress, double done)
{
    whit_stats stats;
    if (progress->said || progress->budget_ms <= 0.0)
        return;
    whit_renderer_get_stats(progress->renderer, &stats);
    double will_ms = stats.render_ms / fmax(done, 0.25);
    if (will_ms <= progress->budget_ms)
        return;
    progress->said = true;
    cli_note("it will take about %.0f ms, not %.6g: the device is slower now than just before",
             will_ms, progress->budget_ms);
}

void frames_progress_update(void *user, double done)
{
    struct frames_progress *progress = user;
    double parts = progress->parts ? progress->parts : 1;
    watch_budget(progress, done);
    double share = ((double)progress->done + parts * done) / (double)progress->count;
    cli_progress_update(&progress->bar,
                        progress->lines ? (progress->line + share) / progress->lines : share);
}

/* ---- Times ---- */

static whit_result keep_times(struct sequence *sequence, const struct frame_times *times)
{
    if (ARRAY_PUSH(sequence->each, sequence->count, sequence->capacity, *times))
        return WHIT_OK;
    return cli_no_memory();
}

static whit_result find_medians(struct sequence *sequence)
{
    static const size_t fields[] = {
        offsetof(struct frame_times, instances_ms), offsetof(struct frame_times, upload_ms),
        offsetof(struct frame_times, render_ms), offsetof(struct frame_times, save_ms)};
    uint32_t count = sequence->count;
    if (count == 0)
        return WHIT_OK;
    double *values = malloc((size_t)count * sizeof *values);
    if (!values)
        return cli_no_memory();
    for (size_t f = 0; f < sizeof fields / sizeof *fields; ++f) {
        for (uint32_t i = 0; i < count; ++i)
            values[i] = *(const double *)((const char *)&sequence->each[i] + fields[f]);
        *(double *)((char *)&sequence->median + fields[f]) = sample_sum_up(values, count).median;
    }
    free(values);
    return WHIT_OK;
}

void sequence_finish(struct sequence *sequence)
{
    free(sequence->each);
    *sequence = (struct sequence){0};
}

/* ---- Frames ---- */

/* `single`: the request with the file names of this frame. */
static whit_result render_frame(struct job *job, const struct render_request *single,
                                whit_renderer *renderer, uint32_t frame, struct sequence *sequence)
{
    whit_stats stats;
    struct drawn_images images = {0};
    whit_result result = whit_renderer_set_time(renderer, job->settings.picture.time_s);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    if (result != WHIT_OK)
        return result;
    double start_ms = whit_clock_ms();
    whit_renderer_get_stats(renderer, &stats);
    result = render_save(job, single, renderer, &images, &stats);
    drawn_images_finish(&images);
    if (result != WHIT_OK)
        return result;
    double save_ms = whit_clock_ms() - start_ms;
    ++sequence->written;
    sequence->save_ms += save_ms;
    sequence->stats.compile_ms += stats.compile_ms;
    whit_stats_add(&stats, &sequence->stats);
    if (job->settings.stats == STATS_NONE)
        return WHIT_OK;
    whit_accel_info tree;
    whit_accel_get_info(job->accel, &tree);
    return keep_times(sequence, &(struct frame_times){.frame = frame,
                                                      .time_s = job->settings.picture.time_s,
                                                      .instances_ms = tree.instance_build_ms,
                                                      .upload_ms = stats.upload_ms,
                                                      .render_ms = stats.render_ms,
                                                      .save_ms = save_ms});
}

/* Draws the frame. With --resume a finished frame is kept, and one that another process is drawing
   is left to it (*left). */
static whit_result take_frame(struct job *job, const struct render_request *request,
                              whit_renderer *renderer, uint32_t frame, struct sequence *sequence,
                              bool *left)
{
    struct render_request single = *request;
    struct lock lock = {0};
    enum resume_state state = RESUME_DRAW;
    char *output = frames_path(request->output, frame);
    char *ids = request->ids ? frames_path(request->ids, frame) : NULL;
    whit_result result = output && (ids || !request->ids) ? WHIT_OK : cli_no_memory();
    single.output = output;
    single.ids = ids;
    job->settings.picture.time_s = (double)frame / job->settings.fps;
    if (result == WHIT_OK && request->resume)
        result = resume_begin(job, &single, &state, &lock);
    if (result == WHIT_OK && state == RESUME_DRAW)
        result = render_frame(job, &single, renderer, frame, sequence);
    lock_give_back(&lock);
    *left = state == RESUME_OTHERS;
    sequence->kept += result == WHIT_OK && state == RESUME_KEPT;
    free(output);
    free(ids);
    return result;
}

/* Takes all frames, then goes again over those that other processes are drawing until they are
   finished, because such a process may have been stopped. `left`: room for a flag per frame. */
static whit_result take_frames(struct job *job, const struct render_request *request,
                               whit_renderer *renderer, struct frames_progress *progress,
                               struct sequence *sequence, bool *left)
{
    uint32_t count = progress->count, waiting = count;
    whit_result result = WHIT_OK;
    memset(left, true, count);
    while (result == WHIT_OK && waiting > 0) {
        waiting = 0;
        for (uint32_t i = 0; result == WHIT_OK && i < count; ++i) {
            if (!left[i])
                continue;
            progress->done = sequence->written;
            progress->count = count - sequence->kept; /* kept frames took no time, so the estimate
                                                         leaves them out */
            cli_set_written(sequence->written + sequence->kept, count);
            result = job_still_wanted();
            if (result == WHIT_OK)
                result = take_frame(job, request, renderer, request->frames.first + i, sequence,
                                    &left[i]);
            waiting += left[i];
        }
        if (result == WHIT_OK && waiting > 0)
            result = resume_wait();
    }
    progress->count = count;
    cli_set_written(sequence->written + sequence->kept, count);
    return result;
}

static void note_still(const struct job *job, const struct frames *frames)
{
    whit_scene_info scene;
    whit_scene_get_info(job->scene, &scene);
    double still = fmax(ceil(scene.time_end_s * job->settings.fps - 1e-6), frames->first);
    if (scene.channel_count > 0 && still < frames->last && !job->settings.quiet)
        cli_note("the animation ends at %.4g s: nothing moves in frames %.0f to %u",
                 scene.time_end_s, still, frames->last);
}

whit_result frames_render(struct job *job, const struct render_request *request,
                          whit_renderer *renderer, struct frames_progress *progress,
                          struct sequence *sequence)
{
    bool *left = malloc(progress->count * sizeof *left);
    *sequence = (struct sequence){0};
    if (!left)
        return cli_no_memory();
    note_still(job, &request->frames);
    whit_renderer_get_stats(renderer, &sequence->stats);
    sequence->stats.compile_ms = 0.0; /* kernels are made for the first frame */
    sequence->stats.render_device_ms = sequence->stats.bailout_bound = 0.0;
    whit_result result = take_frames(job, request, renderer, progress, sequence, left);
    free(left);
    return result == WHIT_OK ? find_medians(sequence) : result;
}
