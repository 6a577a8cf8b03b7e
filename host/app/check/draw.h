/* The pictures of a suite, drawn one after the other in one process: by one device, or the double
   reference in its place, each scene, tree and shader loaded once for all cases that share it. */
#ifndef APP_CHECK_DRAW_H
#define APP_CHECK_DRAW_H

#include "app/check/golden.h"
#include "app/check/suite.h"
#include "app/job.h"

/* A loaded scene, and the trees over it that were built for cases. */
struct studio_scene;

struct studio {
    const struct suite *suite;
    const bool *wanted; /* per case of the suite: it will be drawn */
    bool backwards;     /* cases are drawn from the last to the first */
    struct job job;     /* holds the settings of the command line, the compiler, and the device,
                           NULL where the reference draws */
    struct studio_scene *scenes;
    uint32_t scene_count, scene_capacity;
    whit_renderer *renderer; /* renderer of the case before; the next case may take it over.
                                drawn_as: its settings */
    struct settings drawn_as;
    bool counted;
};

/* The picture of one case, and what it was drawn with. */
struct drawing {
    struct job job;          /* its scene, accel and device belong to the studio */
    whit_renderer *renderer; /* the studio's, valid until the next case; NULL: the reference
                                draws */
    whit_reference *reference;
    whit_renderer_params params;
    whit_stats stats;
    whit_image *color, *ids;       /* color: linear floats; ids: instance and primitive */
    uint64_t color_hash, ids_hash; /* of these images as they are */
};

/* Opens the device, unless `kind` is the reference; it logs to `log`, which is borrowed. `common`:
   the settings of the command line, whose device and limits hold for all cases. Errors were
   printed. Call studio_close() in any case. */
WHIT_CHECK whit_result studio_open(struct studio *studio, enum golden_kind kind,
                                   const struct settings *common, const struct suite *suite,
                                   const bool *wanted, const whit_log *log);
/* Draws case `index`; `counts`: counts traversal costs. Errors were printed. Call drawing_finish()
   in any case, before the next one. */
WHIT_CHECK whit_result studio_draw(struct studio *studio, uint32_t index, bool counts,
                                   struct drawing *drawing);
void drawing_finish(struct drawing *drawing);
/* The case's own settings, with those of the command line that hold for all cases. */
struct settings studio_settings(const struct studio *studio, const struct check_case *item);
/* The job with which the studio drew `drawing`, a picture of the case: what trial_draw takes. */
struct job studio_input(const struct studio *studio, const struct check_case *item,
                        const struct drawing *drawing);
/* Whether hits and colours of two pictures are the same bytes. */
bool drawing_same(const struct drawing *a, const struct drawing *b);
/* Draws an extra picture that is no case of the suite, of `input`: settings, a loaded scene, a
   shader or NULL, and a device, NULL for the reference, all borrowed. The drawing owns the trees
   and the renderer that it needs. Call trial_finish() in any case. */
WHIT_CHECK whit_result trial_draw(struct drawing *drawing, const struct job *input);
void trial_finish(struct drawing *drawing);
/* Whether, after such an error, no other picture can be drawn either. */
bool trial_ends_all(whit_result result);
/* Drops scenes and functions, so that they are loaded again for the next case, with their
   messages. */
void studio_forget(struct studio *studio);
void studio_close(struct studio *studio);

/* vacuous.c: whether the picture would be the same whatever goes wrong: *why is the reason, else
   NULL. WHIT_ERROR_MEMORY, with a message. */
WHIT_CHECK whit_result drawing_refuse(const struct drawing *drawing, const char **why);

#endif
