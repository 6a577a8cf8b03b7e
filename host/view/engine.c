/* The engine's threads. Their shared state is in engine_private.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/platform.h"
#include "view/engine_draw.h"
#include "view/engine_private.h"
#include "view/engine_sessions.h"
#include "whit/whit_program.h"

/* The longest time that drawing waits until the first picture of a new shader version is on
   screen. */
static const double YIELD_MS = 40.0;
/* Time for which a picture is at rest before a session is made for the next version of its
   shader. */
static const double SPARE_MS = 1e3;

/* Waits for a condition, at most `ms`. */
static void wait_for(pthread_cond_t *condition, struct engine *engine, double ms)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    int64_t ns = until.tv_nsec + (int64_t)(ms * 1e6);
    until.tv_sec += (time_t)(ns / 1000000000);
    until.tv_nsec = (long)(ns % 1000000000);
    (void)pthread_cond_timedwait(condition, &engine->lock, &until);
}

/* ---- The drawing thread ---- */

void engine_wake(struct engine *engine)
{
    pthread_cond_broadcast(&engine->news);
    if (engine->params.wake)
        engine->params.wake(NULL);
}

bool engine_is_done(const struct engine_lane *lane)
{
    bool best = lane->quality == ENGINE_WHOLE || lane->moving;
    return !lane->wanted || lane->failed || (lane->drawn == lane->asked && best && !lane->stale);
}

/* Starts making the session that a lane lacks, unless one is being made. */
static void make_session_for(struct engine *engine, struct engine_lane *lane)
{
    if (engine->job)
        return;
    lane->failed = !engine_start_job(engine, &lane->settings, false);
    engine_wake(engine);
}

/* Gives side B the camera of the window's last picture, also while that moves: with two cameras a
   difference would be meaningless. False: B's picture already has that camera. */
static bool follow_place(const struct engine *engine, const struct engine_lane *lane,
                         struct engine_task *task)
{
    if (!engine->places || engine->lanes[0].failed ||
        settings_same_camera(&engine->place, &lane->settings))
        return true;
    settings_set_camera(&task->settings, &engine->place);
    return lane->place != engine->places;
}

/* While the window's picture moves it is drawn smaller: gives side B the same size and quality. */
static void follow_size(const struct engine *engine, const struct engine_lane *lane,
                        struct engine_task *task)
{
    if (lane == engine->lanes || !engine->lanes[0].moving || engine->places == 0)
        return;
    task->divisor = engine->place_divisor;
    if (task->divisor > 1)
        task->quality = ENGINE_QUICK;
}

/* Whether the window's settings are those of the last picture again, so that nothing has to be
   drawn: a switch failed and was undone. */
static bool shows_it(const struct engine *engine, const struct engine_lane *lane)
{
    return lane == engine->lanes && lane->drawn != lane->asked && lane->quality == ENGINE_WHOLE &&
           !lane->stale && lane->frames > 0 && settings_same(&lane->last, &lane->settings) &&
           (lane->timed || !engine->params.time_stages);
}

/* Chooses the picture to draw for a lane now; false: none. Called with engine->lock held. */
static bool plan_lane(struct engine *engine, struct engine_lane *lane, struct engine_task *task)
{
    if (engine_is_done(lane))
        return false;
    if (shows_it(engine, lane)) {
        lane->drawn = lane->asked;
        engine_forget_error(engine);
        engine_wake(engine);
        return false;
    }
    *task = (struct engine_task){.settings = lane->settings};
    if (lane != engine->lanes && !follow_place(engine, lane, task))
        return false;
    task->session = engine_find_session(engine, &lane->settings);
    if (task->session) {
        /* While the picture moves, a new version of the shader is expected to take as long. */
        if (task->session != lane->session &&
            !(lane->moving && engine_same_but_version(&lane->last, &lane->settings)))
            lane->pace = (struct pace){0};
        engine_plan(engine, lane, task);
        follow_size(engine, lane, task);
        return true;
    }
    make_session_for(engine, lane);
    /* The old kernel goes on drawing from another camera, but not in another scene. */
    if (lane->failed || !lane->session || lane->drawn == lane->asked ||
        !settings_same_scene(&lane->session->settings, &lane->settings) ||
        settings_same_place(&lane->last, &task->settings))
        return false;
    task->session = lane->session;
    struct settings place = task->settings;
    task->settings = lane->session->settings;
    settings_set_camera(&task->settings, &place);
    engine_plan(engine, lane, task);
    return true;
}

/* Notes what a whole picture changed. Returns whether it is the same bytes as the one before.
   Called without engine->lock. */
static bool note_change(struct engine *engine, const struct engine_frame *frame)
{
    struct engine_change change = engine->status.change; /* which no other thread writes */
    struct engine_frame *whole = &engine->lanes[0].whole, before = *whole;
    bool same = engine_is_same(&before, frame);
    engine_compare(&before, frame, &change);
    *whole = (struct engine_frame){0};
    engine_keep(whole, frame);
    pthread_mutex_lock(&engine->lock);
    bool compared = change.number != engine->status.change.number;
    engine->status.change = change;
    if (compared) {
        engine->changing.settings[0] = before.settings;
        engine->changing.settings[1] = frame->settings;
        engine->change_left = false;
    }
    uint64_t reloads = engine->status.reload.number;
    engine_reload_note(engine, &before, &frame->settings, compared ? &change.difference : NULL);
    engine->change_left |=
        engine->status.reload.number != reloads; /* reload measures the time instead */
    pthread_mutex_unlock(&engine->lock);
    engine_frame_finish(&before);
    return same;
}

/* Keeps the last two versions of the shader: the file may be saved again as it was before. */
static void keep_version(struct engine *engine, struct shader_ref *shader)
{
    if (shader == engine->versions[0])
        return;
    shader_ref_drop(engine->versions[1]);
    engine->versions[1] = engine->versions[0];
    engine->versions[0] = shader_ref_take(shader);
}

/* Makes *frame, a picture or a step of one, with `quality`, the newest picture of the lane. */
static void take_picture(const struct engine_task *task, enum engine_quality quality,
                         struct engine_frame *frame)
{
    struct engine *engine = task->engine;
    struct engine_lane *lane = task->lane;
    bool own = settings_same_kernel(&task->settings, &lane->settings);
    lane->session = task->session;
    bool there = settings_same_camera(&task->settings, &lane->settings);
    lane->drawn = there || lane == engine->lanes ? task->asked : 0; /* 0: draw it again */
    if (lane == engine->lanes) {
        keep_version(engine, task->session->shader);
        engine->place = task->settings;
        engine->place_divisor = task->divisor;
        ++engine->places;
    }
    lane->place = engine->places;
    lane->quality = quality;
    lane->stale = !own;
    lane->previewed = false;
    lane->timed = task->session->time_stages;
    lane->last = task->settings;
    lane->shown = frame->divisor;
    task->session->last_use = ++engine->uses;
    frame->number = ++lane->frames;
    if (task->brief)
        lane->first = frame->number;
    frame->first = lane->first;
    engine_frame_finish(&lane->frame);
    lane->frame = *frame;
    if (!lane->wanted) /* the lane was closed meanwhile: nobody would take the picture */
        engine_frame_finish(&lane->frame);
    engine_forget_error(engine);
    engine->lost = 0;
    if (frame->whole && lane == engine->lanes && task->settings.shader[0])
        engine->spare_ms = whit_clock_ms() + SPARE_MS;
}

/* Called on the drawing thread, within engine_draw. A new request waits for the first step only. */
void engine_show_step(void *user, const whit_step *step)
{
    struct engine_task *task = user;
    struct engine *engine = task->engine;
    struct engine_frame frame;
    whit_result result = engine_draw_step(task, step, &frame);
    pthread_mutex_lock(&engine->lock);
    if (result == WHIT_OK)
        take_picture(task, ENGINE_QUICK, &frame);
    else
        engine_frame_finish(&frame);
    task->brief = engine->brief = false;
    if (task->lane->asked != task->asked)
        task->session->cancel = true;
    engine_wake(engine);
    pthread_mutex_unlock(&engine->lock);
}

void engine_show_preview(struct engine *engine, struct engine_job *job)
{
    struct engine_lane *lane = engine->lanes;
    const struct engine_task task = {.engine = engine,
                                     .lane = lane,
                                     .session = job->session,
                                     .settings = job->preview.settings,
                                     .divisor = 1,
                                     .brief = true,
                                     .asked = lane->asked};
    if (!job->preview.rgba || !lane->wanted || lane->asked == lane->drawn || lane->moving ||
        lane->settings.paint != PAINT_COLOR || !settings_same(&lane->settings, &job->settings))
        return;
    take_picture(&task, ENGINE_QUICK, &job->preview);
    lane->previewed = true;
    engine->yields = lane->frames;
    engine->yields_ms = whit_clock_ms() + YIELD_MS;
    job->preview = (struct engine_frame){0};
}

/* Called with engine->lock held. Out of memory is often not logged, so a text is made up here. */
static void say_failure(struct engine *engine, whit_result result)
{
    engine->status.result = result;
    if (!engine->status.error[0])
        snprintf(engine->status.error, sizeof engine->status.error, "%s",
                 result == WHIT_ERROR_MEMORY ? "out of memory" : whit_result_name(result));
}

void engine_show_samples(const struct engine_task *task, struct engine_frame *frame)
{
    struct engine *engine = task->engine;
    pthread_mutex_lock(&engine->lock);
    if (task->lane->asked == task->asked)
        take_picture(task, ENGINE_FULL, frame);
    else
        engine_frame_finish(frame);
    engine_wake(engine);
    pthread_mutex_unlock(&engine->lock);
}

/* Whether the task continues the picture of one sample that is shown. */
static bool follows_one(const struct engine_lane *lane, const struct engine_task *task)
{
    return task->quality == ENGINE_WHOLE && lane->quality == ENGINE_FULL &&
           lane->drawn == lane->asked && !lane->stale && lane->session == task->session;
}

static void draw_one(struct engine *engine, struct engine_lane *lane, struct engine_task *task)
{
    struct engine_frame frame = {0};
    struct session *session = task->session;
    task->engine = engine;
    task->lane = lane;
    task->asked = lane->asked;
    session->cancel = false;
    session->time_stages = engine->params.time_stages;
    engine->busy = true;
    engine->drawing = session;
    engine->drawing_since_ms = whit_clock_ms();
    atomic_store(&session->part, 0.0f);
    engine->brief = task->finishes;
    bool follows = follows_one(lane, task);
    pthread_mutex_unlock(&engine->lock);
    settings_expose(&task->settings, &session->scene->info);
    whit_result result = settings_choose_camera(&task->settings, session->scene->scene);
    if (result == WHIT_OK && follows)
        engine_refine_join(task);
    if (result == WHIT_OK)
        result = engine_draw(task, &frame);
    bool whole = result == WHIT_OK && frame.whole, window = lane == &engine->lanes[0];
    bool same = whole && window && note_change(engine, &frame);
    if (whole && !window)
        engine_keep(&lane->whole, &frame);
    pthread_mutex_lock(&engine->lock);
    if (result == WHIT_OK)
        engine_note_time(lane, &frame);
    if (result == WHIT_OK)
        engine_refine_take(engine, task, same, &frame);
    engine->busy = false;
    engine->drawing = NULL;
    if (result == WHIT_OK) {
        take_picture(task, task->quality, &frame);
    } else {
        engine_frame_finish(&frame);
        if (result == WHIT_ERROR_DEVICE)
            engine_lose_device(engine, session);
        if (result != WHIT_ERROR_CANCELLED &&
            (result != WHIT_ERROR_DEVICE || engine->status.device_lost)) {
            lane->failed = lane->asked == task->asked;
            say_failure(engine, result);
        }
    }
    engine_wake(engine);
}

/* ---- Pixels ---- */

void engine_probe_finish(struct engine_probe *probe)
{
    whit_probe_report_destroy(probe->report);
    whit_memory_destroy(probe->rows);
    scene_ref_drop(probe->scene);
    *probe = (struct engine_probe){0};
}

/* Whether the window's picture is whole, and drawn by the session that would be probed. */
static bool can_probe(const struct engine *engine)
{
    const struct engine_lane *lane = &engine->lanes[0];
    return engine->probe_wanted && lane->session && !lane->stale && lane->drawn == lane->asked &&
           lane->quality == ENGINE_WHOLE;
}

static void probe_one(struct engine *engine)
{
    struct session *session = engine->lanes[0].session;
    uint32_t x = engine->probe_x, y = engine->probe_y;
    struct engine_probe probe = {.settings = session->settings,
                                 .scene = scene_ref_take(session->scene)};
    engine->probe_wanted = false;
    engine->busy = true;
    session->cancel = false;
    engine->drawing = session;
    pthread_mutex_unlock(&engine->lock);
    double start_ms = whit_clock_ms();
    whit_result result = whit_probe(session->renderer, x, y, 0, &probe.report);
    if (result == WHIT_OK)
        result = whit_probe_rows(probe.report, &probe.rows, &probe.row_count);
    probe.ms = whit_clock_ms() - start_ms;
    pthread_mutex_lock(&engine->lock);
    engine->busy = false;
    engine->drawing = NULL;
    if (result == WHIT_ERROR_CANCELLED) { /* again, with the next picture */
        engine->probe_wanted = true;
        engine_probe_finish(&probe);
        return;
    }
    probe.number = ++engine->probes;
    engine_probe_finish(&engine->probe);
    engine->probe = probe;
    if (result == WHIT_ERROR_DEVICE)
        engine_lose_device(engine, session);
    else if (result != WHIT_OK)
        say_failure(engine, result);
    engine_wake(engine);
}

/* Gives free memory back. Drivers make kernels in millions of small blocks; the gaps that these
   leave fit nothing else, and add up from session to session. */
static void tidy_up(struct engine *engine)
{
    engine->littered = false;
    engine->busy = true;
    pthread_mutex_unlock(&engine->lock);
    platform_trim_heaps();
    pthread_mutex_lock(&engine->lock);
    engine->busy = false;
    engine_wake(engine);
}

static void wait_for_work(struct engine *engine)
{
    if (engine->spare_ms > 0.0 && !engine->job)
        wait_for(&engine->work, engine, engine->spare_ms - whit_clock_ms());
    else
        pthread_cond_wait(&engine->work, &engine->lock);
}

/* Waits for the screen if a new picture should be shown first. True: it has waited. */
static bool yield(struct engine *engine)
{
    double left_ms = engine->yields_ms - whit_clock_ms();
    if (engine->shown >= engine->yields || left_ms <= 0.0)
        return false;
    wait_for(&engine->work, engine, left_ms);
    return true;
}

static void run_engine(void *context)
{
    struct engine *engine = context;
    pthread_mutex_lock(&engine->lock);
    while (!engine->quit) {
        struct engine_task task;
        bool drew = false;
        engine_reap_job(engine);
        engine_make_spare(engine);
        if (yield(engine))
            continue;
        for (int i = 0; i < ENGINE_LANES && !engine->quit; ++i) {
            if (plan_lane(engine, &engine->lanes[i], &task)) {
                draw_one(engine, &engine->lanes[i], &task);
                drew = true;
            }
        }
        if (!drew && !engine->quit && can_probe(engine)) {
            probe_one(engine);
            drew = true;
        }
        drew = drew || engine_reload_step(engine) || engine_change_step(engine, false);
        struct engine_lane *lane = drew || engine->quit ? NULL : engine_refine_lane(engine);
        if (lane) {
            engine_refine_one(engine, lane);
            drew = true;
        }
        drew = drew || engine_change_step(engine, true);
        if (!drew && !engine->quit && engine->littered)
            tidy_up(engine);
        else if (!drew && !engine->quit && !(engine->job && engine->job->done))
            wait_for_work(engine);
    }
    pthread_mutex_unlock(&engine->lock);
}

/* ---- The window's thread ---- */

whit_result engine_create(const struct engine_params *params, struct engine **out)
{
    *out = NULL;
    struct engine *engine = calloc(1, sizeof *engine);
    if (!engine)
        return WHIT_ERROR_MEMORY;
    pthread_condattr_t monotonic;
    engine->params = *params;
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_mutex_init(&engine->lock, NULL);
    pthread_cond_init(&engine->work, &monotonic);
    pthread_cond_init(&engine->news, &monotonic);
    pthread_condattr_destroy(&monotonic);
    engine->thread = thread_start(run_engine, engine);
    if (!engine->thread) {
        engine_destroy(engine);
        return WHIT_ERROR_MEMORY;
    }
    *out = engine;
    return WHIT_OK;
}

uint32_t engine_destroy(struct engine *engine)
{
    if (!engine)
        return 0;
    pthread_mutex_lock(&engine->lock);
    engine->quit = true;
    if (engine->job)
        engine->job->session->cancel = true;
    if (engine->drawing)
        engine->drawing->cancel = true;
    pthread_cond_broadcast(&engine->work);
    pthread_mutex_unlock(&engine->lock);
    thread_join(engine->thread);
    engine_job_destroy(engine->job);
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        if (engine->sessions[i])
            engine_drop_session(engine, engine->sessions[i]);
    }
    uint32_t validation = engine->validation;
    for (int i = 0; i < ENGINE_LANES; ++i) {
        struct engine_lane *lane = &engine->lanes[i];
        engine_frame_finish(&lane->frame);
        engine_refine_stop(&lane->refine);
        engine_frame_finish(&lane->whole);
        engine_frame_finish(&lane->single);
    }
    engine_frame_finish(&engine->reloading.before);
    engine_flip_destroy(engine->flip);
    for (int i = 0; i < 2; ++i)
        shader_ref_drop(engine->versions[i]);
    engine_probe_finish(&engine->probe);
    file_list_finish(&engine->unread);
    pthread_cond_destroy(&engine->work);
    pthread_cond_destroy(&engine->news);
    pthread_mutex_destroy(&engine->lock);
    free(engine);
    return validation;
}

static bool is_still(const struct engine_lane *lane)
{
    bool waits = lane->wanted && lane->moving && !lane->failed;
    return engine_is_done(lane) && !waits && lane->frame.number == 0;
}

bool engine_is_still(struct engine *engine)
{
    pthread_mutex_lock(&engine->lock);
    bool still = !engine->busy && !(engine->job && !engine->job->is_spare) && !engine->littered &&
                 engine->probe.number == 0 && (!engine->probe_wanted || engine->lanes[0].failed);
    for (int i = 0; i < ENGINE_LANES; ++i)
        still = still && is_still(&engine->lanes[i]);
    pthread_mutex_unlock(&engine->lock);
    return still;
}

void engine_wait(struct engine *engine, double ms)
{
    pthread_mutex_lock(&engine->lock);
    if (engine->lanes[0].frame.number == 0 && engine->lanes[1].frame.number == 0)
        wait_for(&engine->news, engine, ms);
    pthread_mutex_unlock(&engine->lock);
}
