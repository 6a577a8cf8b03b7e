/* The pictures of a suite, drawn one after the other in one process: by one device, or the double
   reference in its place, each scene, tree and shader loaded once for all cases that share it. */
#ifndef APP_CHECK_DRAW_H
#define APP_CHECK_DRAW_H

#include "app/check/golden.h"
#include "app/check/suite.h"
#include "app/job.h"

/* A scene and the trees over it that cases have asked for. */
struct studio_scene;

struct studio {
    const struct suite *suite;
    const bool *wanted; /* of each case of the suite: it will be drawn */
    bool backwards;     /* the last one first */
    struct job job;     /* with the settings of the command line; its device, NULL where the
                           reference draws, and compiler */
    struct studio_scene *scenes;
    uint32_t scene_count, scene_capacity;
    whit_renderer *renderer; /* of the case before, with its settings: the next may take it over */
    struct settings drawn_as;
    bool counted;
};

/* What one case came to. */
struct drawing {
    struct job job;          /* with scene, accel and device, which are the studio's */
    whit_renderer *renderer; /* likewise, up to the next case; NULL: the reference draws */
    whit_reference *reference;
    whit_renderer_params params;
    whit_stats stats;
    whit_image *color, *ids; /* linear floats, as they are hashed; instance and primitive */
};

/* Opens the device, which has `log`, borrowed; none where `kind` is of the reference. `common`: the
   settings of the command line, whose device and limits stand for all cases. What fails was said.
   studio_close() it either way. */
WHIT_CHECK whit_result studio_open(struct studio *studio, enum golden_kind kind,
                                   const struct settings *common, const struct suite *suite,
                                   const bool *wanted, const whit_log *log);
/* Draws case `index`; `counts`: with what traversals cost. What fails was said.
   drawing_finish() it either way, before the next. */
WHIT_CHECK whit_result studio_draw(struct studio *studio, uint32_t index, bool counts,
                                   struct drawing *drawing);
void drawing_finish(struct drawing *drawing);
/* The case's own settings, with what the command line says for all cases. */
struct settings studio_settings(const struct studio *studio, const struct check_case *item);
/* Makes of the drawing's job and parameters a renderer, the caller's, or the drawing's reference
   where the job has no device. */
WHIT_CHECK whit_result drawing_make(struct drawing *drawing, whit_renderer **renderer);
/* Renders, and reads what the drawing's settings ask for. */
WHIT_CHECK whit_result drawing_render(struct drawing *drawing);
/* probe.c: the camera ray of a pixel's first sample, its hit in ray->device; a miss where a
   shader's camera() sends none. */
WHIT_CHECK whit_result drawing_probe(const struct drawing *drawing, uint32_t x, uint32_t y,
                                     whit_probe_ray *ray);
/* on_reference.c: WHIT_ERROR_USAGE, said, where the job has no device and its settings ask for what
   the reference cannot draw. */
WHIT_CHECK whit_result reference_check(const struct job *job);
/* Drops scenes and functions, which are loaded again for the next case, and say again what they
   have to say. */
void studio_forget(struct studio *studio);
void studio_close(struct studio *studio);

/* Whether the picture is one that could not fail (vacuous.c): *why says it, else it is NULL.
   WHIT_ERROR_MEMORY, said. */
WHIT_CHECK whit_result drawing_refuse(const struct drawing *drawing, const char **why);

#endif
