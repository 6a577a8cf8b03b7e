/* What `whit render` is told, and its pieces that stand alone. */
#ifndef APP_RENDER_RENDER_COMMAND_H
#define APP_RENDER_RENDER_COMMAND_H

#include "app/arguments.h"
#include "app/job.h"
#include "app/render/cameras.h"
#include "app/render/frames.h"
#include "app/render/layers.h"
#include "app/render/part.h"
#include "app/render/refine.h"
#include "app/render/repeat.h"

/* The options of `whit render` itself; those of the picture are in the job's settings. */
struct render_request {
    const char *output, *ids; /* ids: NULL when not given */
    bool counters;            /* costs in --stats */
    bool fresh;               /* for a choice what is kept with the scene is measured anew */
    struct refine_goal refine;
    struct repeat repeat;
    struct frames frames; /* with them `output` and `ids` are patterns */
    struct cameras cameras;
    struct part part;
    bool resume;        /* what is finished is kept */
    bool many;          /* one of many pictures by one device */
    bool keep_unread;   /* what no function of the shader reads is to be seen */
    bool scene_stays;   /* whole, for another renderer */
    bool leaves;        /* with `resume`: a picture that another process draws is not waited for */
    uint32_t thumbnail; /* pixels on a side, of a PNG whatever its name; 0: none */
};

/* From the scene to a renderer on a device; what the job has already is taken as it is, and a
   renderer that is there, of the same kernels, becomes one of this picture. Failures were said. */
WHIT_CHECK whit_result render_prepare(struct job *job, const struct render_request *request,
                                      struct frames_progress *progress, whit_renderer **renderer);

/* Reads what `whit render` is told: reader->status is < 0 where there is work to do. */
bool render_read(struct job *job, struct cli_reader *reader, struct render_request *request,
                 int argc, char **argv);
/* Draws and saves what `request` says, and tells of it; gives the exit code. `sequence`: zeroed,
   for sequence_finish. */
int render_draw(struct job *job, const struct render_request *request, whit_renderer *renderer,
                struct frames_progress *progress, struct sequence *sequence);

/* Whether the job's scene has its camera, before trees are built; else says what there is. */
WHIT_CHECK whit_result render_check_camera(const struct job *job);

/* A renderer of what `request` says. */
WHIT_CHECK whit_result render_create(const struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

/* Saves what `request` names of the picture just rendered. `color`: its colours
   where they are not the renderer's, else NULL; what is drawn over is drawn into it. `layers`: the
   shader's functions beside them, those of the renderer where `color` is NULL. */
whit_result render_save(const struct job *job, const struct render_request *request,
                        whit_renderer *renderer, whit_image *color, struct layers *layers,
                        const whit_stats *stats);

#endif
