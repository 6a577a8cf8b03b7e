/* An engine that draws a scene, for tests of the engine. */
#ifndef ENGINE_FIXTURE_H
#define ENGINE_FIXTURE_H

#include "base/clock.h"
#include "unit.h"
#include "view/engine.h"

enum { WIDTH = 96, HEIGHT = 64 };
static const double PATIENCE_MS = 60e3;

static struct engine *engine;
static struct settings settings;
static struct engine_frame frame, other; /* the newest pictures of both sides */

static inline struct settings settings_of(const char *scene)
{
    struct settings of = {.picture = {.width = WIDTH, .height = HEIGHT}};
    snprintf(of.scene, sizeof of.scene, "%s/%s", WHIT_SCENES_DIR, scene);
    return of;
}

static inline struct engine_status status_now(void)
{
    struct engine_status status;
    engine_get_status(engine, &status);
    return status;
}

/* Waits for the engine a moment and takes its pictures. Gives whether there is a new one of the
   window. */
static inline bool take(double start_ms)
{
    engine_wait(engine, 20.0);
    assert_true(clock_ms() - start_ms < PATIENCE_MS); /* it hangs */
    (void)engine_take(engine, true, &other);
    return engine_take(engine, false, &frame);
}

/* Takes pictures until the engine has nothing left to do. */
static inline void take_all(void)
{
    double start_ms = clock_ms();
    while (!engine_is_still(engine))
        (void)take(start_ms);
    (void)engine_take(engine, false, &frame);
}

static inline void draw(void)
{
    engine_ask(engine, &settings, false);
    take_all();
}

/* Begins with an engine that has drawn `settings`. */
static inline void engine_begin(const struct engine_params *params)
{
    frame = other = (struct engine_frame){0};
    assert_int_equal(engine_create(params, &engine), WHIT_OK);
    draw();
    assert_true(frame.whole);
}

static inline void engine_end(void)
{
    engine_frame_finish(&frame);
    engine_frame_finish(&other);
    assert_int_equal(engine_destroy(engine), 0);
}

#endif
