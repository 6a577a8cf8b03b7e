/* The sessions that the engine has, and the one in the making. Of the drawing thread, with the lock
   but for drop and destroy. */
#ifndef VIEW_ENGINE_SESSIONS_H
#define VIEW_ENGINE_SESSIONS_H

#include "view/engine.h"

struct thread;

/* A session in the making. */
struct engine_job {
    struct session *session;
    struct settings settings;
    struct scene_ref *scene;
    struct shader_ref *shader;
    bool reloads;  /* the session has drawn before, with another version of the shader */
    bool is_spare; /* nobody waits for it */
    struct engine_frame preview; /* the first step by the new version; without pixels: none */
    struct session_progress progress;
    struct thread *thread;
    struct engine *engine;
    double start_ms;
    whit_result result;
    bool done; /* under the lock */
};

/* Whether both differ in the version of their shader alone, or in nothing that kernels know. */
bool engine_same_but_version(const struct settings *a, const struct settings *b);
/* Starts a session for the next version of the window's shader, once its picture has been there for
   a while, so that the first save does not wait for one. */
void engine_make_spare(struct engine *engine);
/* Makes a session in a thread. False: engine->error says why not. */
bool engine_start_job(struct engine *engine, const struct settings *settings, bool is_spare);
/* Takes what a finished job made. */
void engine_reap_job(struct engine *engine);
void engine_job_destroy(struct engine_job *job);
struct session *engine_find_session(const struct engine *engine, const struct settings *settings);
void engine_drop_session(struct engine *engine, struct session *session);
/* The device is gone: everything on it is made again, unless that happens again and again. */
void engine_lose_device(struct engine *engine, struct session *session);
/* Clears the error of the window, unless the other side of a comparison has failed as well. */
void engine_forget_error(struct engine *engine);

#endif
