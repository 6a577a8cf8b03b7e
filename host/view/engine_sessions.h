/* The sessions of the engine, and the one being made. Called on the drawing thread with
   engine->lock held, but engine_job_destroy and engine_drop_session without it. */
#ifndef VIEW_ENGINE_SESSIONS_H
#define VIEW_ENGINE_SESSIONS_H

#include "view/engine.h"

struct thread;

/* A session that is being made. */
struct engine_job {
    struct session *session;
    struct settings settings;
    struct scene_ref *scene;
    struct shader_ref *shader;
    bool reloads;  /* the session has drawn before, with another version of the shader */
    bool is_spare; /* a session for the next version of the shader, made in advance */
    bool moves;    /* the window's picture moved when it began: no preview is drawn */
    struct engine_frame preview; /* the first step of its picture; without pixels: none */
    struct thread *thread;
    struct engine *engine;
    double start_ms;
    whit_result result;
    bool done; /* under the lock */
};

/* Whether both differ only in the version of their shader, or in nothing that needs another
   session. */
bool engine_same_but_version(const struct settings *a, const struct settings *b);
/* Starts making a spare session once the present picture has been shown for a while, unless the
   scene is large. When the user saves the shader's file, the new version is drawn in that session
   without waiting for one to be made. */
void engine_make_spare(struct engine *engine);
/* Starts making a session in a thread. False: the reason is in engine->error. */
bool engine_start_job(struct engine *engine, const struct settings *settings, bool is_spare);
/* Takes the session of a finished job. */
void engine_reap_job(struct engine *engine);
void engine_job_destroy(struct engine_job *job);
struct session *engine_find_session(const struct engine *engine, const struct settings *settings);
void engine_drop_session(struct engine *engine, struct session *session);
/* Drops a session whose device is lost. It is made again, unless devices are lost again and
   again. */
void engine_lose_device(struct engine *engine, struct session *session);
/* Clears the error, unless a side of the window has failed. */
void engine_forget_error(struct engine *engine);

#endif
