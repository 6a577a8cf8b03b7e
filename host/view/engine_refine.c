/* Adds samples to pictures at rest: 4, 16, 64 ... times the samples of the settings. whit_refine
   doubles the samples by drawing only the missing ones, so that no ray is traced twice, and
   estimates the error. If the settings ask for a power of 2, the result has the same bits as
   `--aa`. */
#include <stdlib.h>
#include <string.h>

#include "view/engine_draw.h"
#include "view/engine_private.h"
#include "view/engine_refine.h"
#include "view/engine_sessions.h"

/* More samples change nothing visible if at most one pixel in PIXELS_A_CHANGE changes by more than
   CODE_SAME of 255 codes in some channel. A round multiplies samples by ROUND. */
enum { CODE_SAME = 4, PIXELS_A_CHANGE = 1000, ROUND = 4 };

static size_t bytes_of(const struct engine_refine *refine)
{
    return (size_t)refine->base.width * refine->base.height * 4;
}

void engine_refine_stop(struct engine_refine *refine)
{
    whit_refine_destroy(refine->refine);
    free(refine->rgba);
    *refine = (struct engine_refine){0};
}

static void set_base(struct engine_refine *refine, const struct engine_frame *frame)
{
    refine->base = *frame;
    refine->base.color = refine->base.plain = refine->base.ids = refine->base.cuts = NULL;
    refine->base.boxes = NULL;
    refine->base.rgba = NULL;
    refine->base.scene = NULL;
    refine->base.shader = NULL;
}

bool engine_refines(const struct settings *settings)
{
    return settings->paint == PAINT_COLOR && !settings->aov[0] &&
           settings->picture.sampling.kind == WHIT_SAMPLING_FIXED;
}

bool engine_doubles(const struct settings *settings)
{
    uint32_t count = settings->picture.sampling.count;
    return engine_refines(settings) && count > 1 && (count & (count - 1)) == 0;
}

/* Begins with a new picture. One of costs or adaptive samples cannot be refined. */
static void begin(struct engine_refine *refine, const struct engine_frame *frame)
{
    engine_refine_stop(refine);
    if (!engine_refines(&frame->settings))
        return;
    set_base(refine, frame);
    refine->samples = frame->samples;
    refine->begun = frame->stats;
    refine->ended = frame->samples * ROUND > WHIT_SAMPLES_MAX;
}

/* Creates the whit_refine, whose first part is the picture that engine_keep kept. */
static whit_result begin_parts(struct engine_refine *refine, whit_renderer *renderer,
                               const whit_renderer_params *params, const struct engine_frame *kept)
{
    whit_image *image = NULL;
    if (refine->refine)
        return WHIT_OK;
    if (!kept->color || !kept->cuts || kept->width != refine->base.width ||
        kept->height != refine->base.height)
        return WHIT_ERROR_MEMORY; /* engine_keep ran out of memory */
    refine->rgba = malloc(bytes_of(refine));
    if (!refine->rgba)
        return WHIT_ERROR_MEMORY;
    whit_result result = whit_refine_create(renderer, params, &refine->refine);
    if (result == WHIT_OK)
        result = whit_refine_begin(refine->refine, refine->samples,
                                   whit_image_floats(kept->plain ? kept->plain : kept->color),
                                   whit_image_floats(kept->cuts));
    if (result == WHIT_OK)
        result = whit_refine_image(refine->refine, &image);
    if (result == WHIT_OK)
        whit_image_display_bytes(image, refine->rgba);
    whit_image_destroy(image);
    if (result != WHIT_OK) {
        whit_refine_destroy(refine->refine);
        refine->refine = NULL;
    }
    return result;
}

static void note_estimate(struct engine_refine *refine, const whit_refine_info *info)
{
    uint32_t count = refine->estimate_count;
    whit_stats stats;
    bool known = count > 0 && refine->estimates[count - 1].samples == info->samples;
    if (info->error < 0.0 || known || count == ENGINE_ESTIMATES_MAX)
        return;
    whit_refine_get_stats(refine->refine, &stats);
    refine->estimates[refine->estimate_count++] =
        (struct engine_estimate){.samples = info->samples,
                                 .error = info->error,
                                 .ms = refine->begun.render_ms + stats.render_ms};
}

/* Draws the next part, and then sets the renderer back to the picture of the settings. */
static whit_result draw_part(struct session *session, struct engine_refine *refine,
                             const struct engine_frame *kept, whit_refine_info *info)
{
    session->settings = refine->base.settings; /* the renderer borrows the camera's name */
    const whit_renderer_params usual = session_picture(session);
    whit_result result = begin_parts(refine, session->renderer, &usual, kept);
    if (result != WHIT_OK)
        return result;
    whit_refine_move(refine->refine, session->renderer, &usual);
    result = whit_refine_step(refine->refine);
    whit_refine_get_info(refine->refine, info);
    if (result == WHIT_OK)
        note_estimate(refine, info);
    whit_result back = whit_renderer_set_view(session->renderer, &usual);
    return result == WHIT_OK ? back : result;
}

static bool looks_same(const uint8_t *a, const uint8_t *b, size_t pixels)
{
    size_t changed = 0;
    for (size_t i = 0; i < pixels; ++i, a += 4, b += 4)
        changed += abs(a[0] - b[0]) > CODE_SAME || abs(a[1] - b[1]) > CODE_SAME ||
                   abs(a[2] - b[2]) > CODE_SAME;
    return changed * PIXELS_A_CHANGE <= pixels;
}

/* Reads the mean of all samples, with edges and grid as the settings say. */
static whit_result read_sum(const struct engine_refine *refine, const struct engine_frame *kept,
                            struct session *session, whit_image **color)
{
    const whit_renderer_params params = settings_picture(&refine->base.settings);
    whit_overlay overlay = settings_overlay(&refine->base.settings);
    overlay.ids = whit_image_words(kept->ids);
    whit_result result = whit_refine_image(refine->refine, color);
    if (result == WHIT_OK)
        result = whit_renderer_draw_over(session->renderer, &overlay, *color);
    if (result == WHIT_OK)
        whit_image_display_as(*color, &params);
    return result;
}

/* The statistics of all samples: of the picture that refining began with, and of what it drew.
   Figures that are no sums are taken from refining, which has them for all samples. */
static void sum_stats(const struct engine_refine *refine, whit_stats *stats)
{
    whit_stats sum;
    *stats = refine->begun;
    whit_refine_get_stats(refine->refine, &sum);
    whit_stats_add(&sum, stats);
    stats->bailout_bound = sum.bailout_bound;
    stats->weight_cut_bailout = sum.weight_cut_bailout;
    stats->weight_cut_depth = sum.weight_cut_depth;
    memcpy(stats->pixels_by_samples, sum.pixels_by_samples, sizeof stats->pixels_by_samples);
}

/* Puts the mean of all samples into *frame, also as displayed. `kept`: the picture that refining
   began with; the session's renderer is set to its view. */
static whit_result show_sum(const struct engine_refine *refine, const struct engine_frame *kept,
                            struct session *session, struct engine_frame *frame)
{
    whit_refine_info info;
    whit_image *color = NULL;
    uint8_t *rgba = malloc(bytes_of(refine));
    whit_result result = rgba ? read_sum(refine, kept, session, &color) : WHIT_ERROR_MEMORY;
    if (result != WHIT_OK) {
        whit_image_destroy(color);
        free(rgba);
        return result;
    }
    whit_image_display_bytes(color, rgba);
    whit_image_destroy(frame->color);
    free(frame->rgba);
    whit_refine_get_info(refine->refine, &info);
    frame->color = color;
    frame->rgba = rgba;
    frame->samples = info.samples;
    frame->refined = true;
    sum_stats(refine, &frame->all);
    frame->estimate_count = refine->estimate_count;
    memcpy(frame->estimates, refine->estimates, sizeof frame->estimates);
    return WHIT_OK;
}

/* Makes *frame the picture of four times as many samples. */
static whit_result finish_round(struct session *session, struct engine_refine *refine,
                                const struct engine_frame *kept, struct engine_frame *frame)
{
    size_t bytes = bytes_of(refine);
    *frame = refine->base;
    frame->scene = scene_ref_take(session->scene);
    frame->shader = shader_ref_take(session->shader);
    whit_result result = show_sum(refine, kept, session, frame);
    if (result != WHIT_OK)
        return result;
    refine->samples *= ROUND;
    refine->ended = refine->samples * ROUND > WHIT_SAMPLES_MAX;
    refine->settled = looks_same(refine->rgba, frame->rgba, bytes / 4);
    memcpy(refine->rgba, frame->rgba, bytes);
    return WHIT_OK;
}

/* Keeps the samples that were added: a new whole picture has the same pixels as the one that
   refining began with. *frame then shows as many samples as the picture before. False: they
   cannot be kept. Called with engine->lock held, which is released meanwhile: errors are logged
   under it. */
static bool keep(struct engine *engine, struct engine_lane *lane, struct session *session,
                 struct engine_frame *frame)
{
    struct engine_refine *refine = &lane->refine;
    const whit_sampling *sampling = &frame->settings.picture.sampling;
    bool goes_on = refine->refine && refine->samples > refine->base.samples &&
                   sampling->kind == WHIT_SAMPLING_FIXED &&
                   frame->samples == refine->base.samples &&
                   settings_same_pixels(&refine->base.settings, &frame->settings);
    if (!goes_on)
        return false;
    set_base(refine, frame);
    pthread_mutex_unlock(&engine->lock);
    whit_result result = show_sum(refine, &lane->whole, session, frame);
    pthread_mutex_lock(&engine->lock);
    return result == WHIT_OK;
}

/* Draws one part. After the last part of a round *frame is a picture of four times the samples,
   without hit identities; otherwise it is zeroed. `kept`: the picture that refining began with.
   Called without engine->lock. */
static whit_result draw_next(struct session *session, struct engine_refine *refine,
                             const struct engine_frame *kept, struct engine_frame *frame)
{
    whit_refine_info info = {0};
    whit_result result = WHIT_OK;
    *frame = (struct engine_frame){0};
    if (refine->refine)
        whit_refine_get_info(refine->refine, &info);
    if (info.samples < ROUND * refine->samples) /* else the round only has to be shown */
        result = draw_part(session, refine, kept, &info);
    if (result == WHIT_OK && info.samples == ROUND * refine->samples)
        result = finish_round(session, refine, kept, frame);
    return result;
}

/* ---- Up to the samples of the settings ---- */

/* Shows a picture of fewer samples than the settings say. */
static void show_some(const struct engine_task *task)
{
    struct engine_frame frame;
    whit_result result = finish_round(task->session, task->refine, task->single, &frame);
    if (result == WHIT_OK)
        engine_show_samples(task, &frame);
    else
        engine_frame_finish(&frame);
}

static whit_result draw_missing(const struct engine_task *task)
{
    struct engine_refine *refine = task->refine;
    struct session *session = task->session;
    uint32_t samples = task->settings.picture.sampling.count;
    whit_refine_info info = {.samples = refine->samples};
    whit_result result = WHIT_OK;
    if (refine->refine)
        whit_refine_get_info(refine->refine, &info);
    while (result == WHIT_OK && info.samples < samples) {
        session->part_done = session->part_share = (float)info.samples / (float)samples;
        result = draw_part(session, refine, task->single, &info);
        if (result == WHIT_OK && info.samples < samples && info.samples >= ROUND * refine->samples)
            show_some(task);
    }
    session->part_done = session->part_share = 0.0f;
    return result;
}

whit_result engine_refine_whole(const struct engine_task *task, struct engine_frame *frame)
{
    const struct engine_frame *single = task->single;
    whit_result result = draw_missing(task);
    if (result == WHIT_OK)
        result = show_sum(task->refine, single, task->session, frame);
    frame->ids = result == WHIT_OK ? whit_image_share(single->ids) : NULL;
    frame->refined = false;
    if (result == WHIT_OK)
        frame->stats = frame->all;
    return result;
}

/* Makes *frame, which refining has completed, the picture that further samples are added to. */
static void finish_whole(struct engine_refine *refine, const struct engine_frame *frame)
{
    set_base(refine, frame);
    refine->base.estimate_count = 0;
    refine->samples = frame->samples;
    refine->settled = false;
    refine->ended = frame->samples * ROUND > WHIT_SAMPLES_MAX;
    memcpy(refine->rgba, frame->rgba, bytes_of(refine));
}

/* ---- When ---- */

/* Whether the shader has a post(). post() of the mean of samples is not the mean of post() of the
   samples, so such pictures are not refined. */
static bool has_post(const struct session *session)
{
    return session->shader && (session->shader->info.hooks >> WHIT_HOOK_POST & 1);
}

void engine_refine_take(struct engine *engine, const struct engine_task *task, bool same,
                        struct engine_frame *frame)
{
    struct engine_lane *lane = task->lane;
    struct engine_refine *refine = &lane->refine;
    if (task->quality == ENGINE_FULL && engine_doubles(&task->settings)) {
        engine_keep(&lane->single, frame);
        begin(refine, frame);
    }
    if (!frame->whole)
        return;
    if (task->refine)
        finish_whole(refine, frame);
    else if (!(same && !engine->lanes[1].wanted && keep(engine, lane, task->session, frame)))
        begin(refine, frame);
    engine_frame_finish(&lane->single);
}

void engine_refine_join(struct engine_task *task)
{
    struct engine_refine *refine = &task->lane->refine;
    const struct engine_frame *single = &task->lane->single;
    if (!engine_doubles(&task->settings) || has_post(task->session) || !single->ids ||
        refine->samples == 0 || refine->samples >= task->settings.picture.sampling.count ||
        !settings_same(&refine->base.settings, &task->settings))
        return;
    task->refine = refine;
    task->single = single;
}

/* Whether the lane's picture is drawn, was taken, and can be refined. */
static bool is_ready(const struct engine_lane *lane)
{
    return lane->refine.samples > 0 && lane->session && !has_post(lane->session) &&
           engine_is_done(lane) && !lane->failed && !lane->moving && lane->frame.number == 0;
}

/* Two pictures beside each other are refined in turns, the one with fewer samples first, so that
   both stay comparable. NULL: their settings ask for different numbers of samples, or nothing is
   left to do. */
static struct engine_lane *lane_of_two(struct engine *engine)
{
    const struct engine_refine *a = &engine->lanes[0].refine, *b = &engine->lanes[1].refine;
    if (!is_ready(&engine->lanes[1]) || a->base.samples != b->base.samples)
        return NULL;
    if (a->samples == b->samples && ((a->settled && b->settled) || a->ended || b->ended))
        return NULL;
    struct engine_lane *lane = &engine->lanes[b->samples < a->samples];
    return lane->refine.ended ? NULL : lane;
}

struct engine_lane *engine_refine_lane(struct engine *engine)
{
    struct engine_lane *lane = engine->lanes;
    if (!engine->params.refine || !is_ready(lane) || engine->job || engine->probe_wanted)
        return NULL;
    if (engine->lanes[1].wanted)
        return lane_of_two(engine);
    return lane->refine.settled || lane->refine.ended ? NULL : lane;
}

void engine_refine_restart(struct engine_lane *lane)
{
    if (lane->refine.samples > lane->refine.base.samples && engine_is_done(lane))
        lane->quality = ENGINE_FULL;
}

void engine_refine_one(struct engine *engine, struct engine_lane *lane)
{
    struct session *session = lane->session;
    struct engine_frame frame;
    uint64_t asked = lane->asked;
    session->cancel = false;
    session->time_stages = engine->params.time_stages;
    engine->drawing = session;
    engine->drawing_since_ms = whit_clock_ms();
    engine->refining = true;
    engine->brief = false;
    pthread_mutex_unlock(&engine->lock);
    whit_result result = draw_next(session, &lane->refine, &lane->whole, &frame);
    pthread_mutex_lock(&engine->lock);
    engine->drawing = NULL;
    engine->refining = false;
    if (result == WHIT_ERROR_DEVICE)
        engine_lose_device(engine, session);
    if (result != WHIT_OK && result != WHIT_ERROR_CANCELLED)
        lane->refine.ended = true; /* the last picture stays */
    if (frame.color && lane->asked == asked && lane->wanted) {
        frame.number = ++lane->frames;
        frame.first = lane->first;
        lane->frame = frame;
    } else {
        engine_frame_finish(&frame);
    }
    engine_wake(engine);
}

void engine_refine_pause(struct engine *engine)
{
    if (engine->refining)
        engine->drawing->cancel = true;
}

void engine_set_rest(struct engine *engine, bool refine, bool times)
{
    pthread_mutex_lock(&engine->lock);
    if (!refine)
        engine_refine_pause(engine);
    if (!times && engine->params.times)
        engine_change_stop(engine);
    if (refine != engine->params.refine || times != engine->params.times)
        pthread_cond_signal(&engine->work);
    engine->params.refine = refine;
    engine->params.times = times;
    pthread_mutex_unlock(&engine->lock);
}

bool engine_is_refined(struct engine *engine)
{
    pthread_mutex_lock(&engine->lock);
    const struct engine_lane *lanes = engine->lanes;
    bool taken = lanes[0].frame.number == 0 && (!lanes[1].wanted || lanes[1].frame.number == 0);
    bool refined =
        !engine->refining && taken && !engine_change_waits(engine) && !engine_refine_lane(engine);
    pthread_mutex_unlock(&engine->lock);
    return refined;
}
