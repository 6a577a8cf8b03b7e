#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/engine_draw.h"
#include "view/engine_private.h"
#include "view/engine_sessions.h"
#include "whit/whit_program.h"

enum { SESSIONS_LARGE = 2, LOST_MAX = 2 };
static const uint64_t LARGE_SCENE = 1000000; /* triangles */

/* ---- Sessions in the making ---- */

static void keep_error(char error[ENGINE_MESSAGE], whit_log_level level, const char *message)
{
    if (level == WHIT_LOG_ERROR && !error[0])
        snprintf(error, ENGINE_MESSAGE, "%s", message);
}

/* Log of a session. The first error is kept as the reason, later ones follow from it. A session
   that nobody wants any more keeps its errors to itself. Messages of the validation layers go to
   engine->params.log. */
static void session_message(void *user, whit_log_level level, const char *message)
{
    struct session *session = user;
    struct engine *engine = session->owner;
    const whit_log *log = &engine->params.log;
    if (strncmp(message, "validation: ", 12) == 0) {
        if (log->fn)
            log->fn(log->user, level, message);
        return;
    }
    pthread_mutex_lock(&engine->lock);
    keep_error(session->ready ? engine->status.error : session->error, level, message);
    pthread_mutex_unlock(&engine->lock);
}

/* The log of a scene. A scene outlives the session that it was loaded for, so trees of other
   sessions log here as well while they are built. */
static void scene_message(void *user, whit_log_level level, const char *message)
{
    struct engine *engine = user;
    pthread_mutex_lock(&engine->lock);
    keep_error(engine->job ? engine->job->session->error : engine->status.error, level, message);
    pthread_mutex_unlock(&engine->lock);
}

/* Called on the job's thread. Keeps the first step and ends the picture there: the drawing thread
   draws the rest. */
static void keep_preview(void *user, const whit_step *step)
{
    struct engine_job *job = user;
    struct engine_task task = {
        .session = job->session, .settings = job->session->settings, .asked_ms = job->start_ms};
    settings_expose(&task.settings, &job->session->scene->info);
    if (engine_draw_step(&task, step, &job->preview) != WHIT_OK)
        engine_frame_finish(&job->preview);
    job->session->cancel = true;
}

static whit_result reload(struct engine_job *job, const struct session_parts *parts)
{
    struct session *session = job->session;
    session->step = keep_preview;
    session->step_user = job;
    whit_result result = session_reload(session, &job->settings, parts);
    session->step = NULL;
    return result;
}

static void run_job(void *context)
{
    struct engine_job *job = context;
    struct engine *engine = job->engine;
    const struct session_parts parts = {job->scene, job->shader, engine->params.compiler,
                                        job->is_spare, job->moves};
    const whit_log log = {session_message, job->session, WHIT_LOG_WARNING};
    const whit_log scene_log = {scene_message, engine, WHIT_LOG_WARNING};
    whit_result result = job->reloads
                             ? reload(job, &parts)
                             : session_open(job->session, &job->settings, &parts, &log, &scene_log);
    pthread_mutex_lock(&engine->lock);
    job->result = result;
    job->done = true;
    pthread_cond_signal(&engine->work);
    pthread_mutex_unlock(&engine->lock);
}

/* Called without engine->lock. */
void engine_drop_session(struct engine *engine, struct session *session)
{
    uint32_t messages = session_close(session);
    free(session);
    pthread_mutex_lock(&engine->lock);
    engine->validation += messages;
    engine->littered = true;
    pthread_mutex_unlock(&engine->lock);
}

void engine_job_destroy(struct engine_job *job)
{
    if (!job)
        return;
    thread_join(job->thread);
    engine_frame_finish(&job->preview);
    if (job->session)
        engine_drop_session(job->engine, job->session);
    scene_ref_drop(job->scene);
    shader_ref_drop(job->shader);
    free(job);
}

/* The scene that some session has loaded already, with a reference taken; NULL: none. */
static struct scene_ref *find_scene(const struct engine *engine, const struct settings *settings)
{
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        const struct session *session = engine->sessions[i];
        if (session && settings_same_scene(&session->scene->settings, settings))
            return scene_ref_take(session->scene);
    }
    return NULL;
}

/* The same for a shader. */
static struct shader_ref *find_shader(const struct engine *engine, const struct settings *settings)
{
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        const struct session *session = engine->sessions[i];
        if (session && session->shader &&
            settings_same_shader(&session->shader->settings, settings))
            return shader_ref_take(session->shader);
    }
    for (int i = 0; i < 2; ++i) {
        if (engine->versions[i] && settings_same_shader(&engine->versions[i]->settings, settings))
            return shader_ref_take(engine->versions[i]);
    }
    return NULL;
}

static bool is_shown(const struct engine *engine, const struct session *session)
{
    const struct engine_lane *other = &engine->lanes[1];
    return engine->lanes[0].session == session || (other->wanted && other->session == session);
}

bool engine_same_but_version(const struct settings *a, const struct settings *b)
{
    struct settings same = *a;
    same.shader_reload = b->shader_reload;
    return settings_same_kernel(&same, b);
}

/* The least recently used session that is not shown; `like` not NULL: among those that differ from
   it only by the version of their shader. NULL: none. */
static struct session *find_oldest(const struct engine *engine, const struct settings *like)
{
    struct session *oldest = NULL;
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        struct session *session = engine->sessions[i];
        if (!session || is_shown(engine, session) ||
            (like && !engine_same_but_version(like, &session->settings)))
            continue;
        if (!oldest || session->last_use < oldest->last_use)
            oldest = session;
    }
    return oldest;
}

/* A session whose device, trees and buffers serve another version of its shader. NULL: none. */
static struct session *find_version(const struct engine *engine, const struct settings *settings)
{
    return settings->shader[0] ? find_oldest(engine, settings) : NULL;
}

/* Takes a session off the engine's lists: the caller owns it from then on. */
static void take_out(struct engine *engine, struct session *session)
{
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        if (engine->sessions[i] == session)
            engine->sessions[i] = NULL;
    }
    for (int i = 0; i < ENGINE_LANES; ++i) {
        if (engine->lanes[i].session == session)
            engine->lanes[i].session = NULL;
    }
}

bool engine_start_job(struct engine *engine, const struct settings *settings, bool is_spare)
{
    struct session *version = find_version(engine, settings);
    struct engine_job *job = calloc(1, sizeof *job);
    struct session *session = version ? version : calloc(1, sizeof *session);
    if (job && session) {
        session->ready = session->cancel = false;
        session->error[0] = session->errors[0] = '\0';
        session->owner = engine;
        atomic_store(&session->stage, SESSION_SHADER);
        session->made = ++engine->jobs;
        job->session = session;
        job->reloads = version != NULL;
        job->is_spare = is_spare;
        job->moves = engine->lanes[0].moving;
        job->settings = *settings;
        job->engine = engine;
        job->start_ms = whit_clock_ms();
        job->scene = find_scene(engine, settings);
        job->shader = find_shader(engine, settings);
        job->thread = thread_start(run_job, job);
        if (job->thread) {
            take_out(engine, session);
            engine->job = job;
            return true;
        }
        scene_ref_drop(job->scene);
        shader_ref_drop(job->shader);
    }
    free(job);
    if (version)
        version->ready = true;
    else
        free(session);
    snprintf(engine->status.error, sizeof engine->status.error, "out of memory");
    engine->status.result = WHIT_ERROR_MEMORY;
    return false;
}

void engine_make_spare(struct engine *engine)
{
    const struct engine_lane *lane = &engine->lanes[0];
    if (engine->spare_ms <= 0.0 || whit_clock_ms() < engine->spare_ms || engine->job)
        return;
    engine->spare_ms = 0.0;
    if (lane->session && engine_is_done(lane) && !find_version(engine, &lane->settings) &&
        lane->session->scene->info.triangle_count <= LARGE_SCENE)
        engine_start_job(engine, &lane->settings, true); /* true: as a spare session */
}

/* ---- The sessions that there are ---- */

static void forget_session(struct engine *engine, struct session *session)
{
    take_out(engine, session);
    pthread_mutex_unlock(&engine->lock);
    engine_drop_session(engine, session);
    pthread_mutex_lock(&engine->lock);
}

/* Makes room for one more session: drops those that are not shown, least recently used first. */
static void make_room(struct engine *engine, const struct session *newest)
{
    bool large = newest->scene->info.triangle_count > LARGE_SCENE;
    for (;;) {
        struct session *oldest = find_oldest(engine, NULL);
        uint32_t count = 0;
        for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i)
            count += engine->sessions[i] != NULL;
        if (count < (large ? SESSIONS_LARGE : ENGINE_SESSIONS_MAX) || !oldest)
            return;
        forget_session(engine, oldest);
    }
}

struct session *engine_find_session(const struct engine *engine, const struct settings *settings)
{
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        struct session *session = engine->sessions[i];
        if (session && settings_same_kernel(&session->settings, settings))
            return session;
    }
    return NULL;
}

static void keep_session(struct engine *engine, struct session *session)
{
    make_room(engine, session);
    for (uint32_t i = 0; i < ENGINE_SESSIONS_MAX; ++i) {
        if (!engine->sessions[i]) {
            engine->sessions[i] = session;
            return;
        }
    }
}

void engine_forget_error(struct engine *engine)
{
    for (int i = 0; i < ENGINE_LANES; ++i) {
        if (engine->lanes[i].wanted && engine->lanes[i].failed)
            return;
    }
    engine->status.error[0] = engine->status.errors[0] = '\0';
}

/* Keeps the files of the scene that this job could not load. No other session has them. */
static void keep_unread(struct engine *engine, const struct engine_job *job)
{
    struct scene_ref *ref = job->session->scene;
    if (job->reloads || job->scene || !ref)
        return;
    engine->unread = ref->files;
    ref->files = (struct file_list){0};
}

void engine_reap_job(struct engine *engine)
{
    struct engine_job *job = engine->job;
    if (!job || !job->done)
        return;
    engine->job = NULL;
    file_list_finish(&engine->unread);
    if (!job->scene)
        memcpy(engine->status.refused, job->session->refused, sizeof engine->status.refused);
    if (job->result == WHIT_OK) {
        engine_forget_error(engine);
    } else if (job->result != WHIT_ERROR_CANCELLED && !job->is_spare) {
        memcpy(engine->status.error, job->session->error, sizeof engine->status.error);
        memcpy(engine->status.errors, job->session->errors, sizeof engine->status.errors);
        engine->status.result = job->result;
        keep_unread(engine, job);
        if (!engine->status.error[0])
            snprintf(engine->status.error, sizeof engine->status.error, "out of memory");
        for (int i = 0; i < ENGINE_LANES; ++i) {
            struct engine_lane *lane = &engine->lanes[i];
            if (lane->wanted && settings_same_kernel(&lane->settings, &job->settings))
                lane->failed = true;
        }
    }
    /* If a shader could not be compiled, the session stays one of the version before. */
    if (job->result == WHIT_OK || (job->reloads && job->session->renderer)) {
        job->session->ready = true;
        keep_session(engine, job->session);
        engine_show_preview(engine, job);
        job->session = NULL;
    }
    engine_wake(engine);
    engine->littered = true; /* compilers leave much free memory */
    pthread_mutex_unlock(&engine->lock);
    engine_job_destroy(job);
    pthread_mutex_lock(&engine->lock);
}

void engine_lose_device(struct engine *engine, struct session *session)
{
    engine->status.device_lost = ++engine->lost > LOST_MAX;
    forget_session(engine, session);
}
