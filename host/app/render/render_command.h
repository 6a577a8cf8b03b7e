/* The options of `whit render`, and its steps, for other commands too. */
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

/* The options of `whit render` itself; the settings of the picture are in the job. */
struct render_request {
    const char *output, *ids; /* ids: NULL when not given */
    bool counters;            /* count costs for --stats */
    bool fresh;               /* --fresh: measure costs anew for --budget-ms and --max-error, in
                                 place of those kept for the scene */
    struct refine_goal refine;
    struct repeat repeat;
    struct frames frames; /* with --frames `output` and `ids` are patterns */
    struct cameras cameras;
    struct part part;
    bool resume;        /* --resume: finished files are kept */
    bool many;          /* it is one of many pictures that one device draws */
    bool keep_unread;   /* compile also what no function of the shader reads:
                           whit_renderer_params.keep_unread */
    bool scene_stays;   /* keep the scene's texels, for another renderer */
    bool leaves;        /* with `resume`: a picture that another process draws is not waited for */
    uint32_t thumbnail; /* pixels on a side, of a PNG whatever its name; 0: none */
};

/* The first option that was given of those from `first` to `last` in the list of what a request may
   ask for beside one whole picture of colours; NULL: none. */
const char *render_asks(const struct settings *settings, const struct render_request *request,
                        const char *first, const char *last);

/* Makes all that drawing needs: shader, scene, trees, device, renderer. Things that the job has
   already are reused; an existing *renderer, which must have the same kernels, is set to this
   picture. Errors were printed. */
WHIT_CHECK whit_result render_prepare(struct job *job, const struct render_request *request,
                                      struct frames_progress *progress, whit_renderer **renderer);

/* Reads the command line of `whit render`. reader->status is < 0 afterwards where there is work to
   do. */
bool render_read(struct job *job, struct cli_reader *reader, struct render_request *request,
                 int argc, char **argv);
/* Draws and saves what `request` asks for, and prints notes and --stats; gives the exit code.
   `sequence`: zeroed, for sequence_finish. */
int render_draw(struct job *job, const struct render_request *request, whit_renderer *renderer,
                struct frames_progress *progress, struct sequence *sequence);

/* Checks, before trees are built, that the scene has the job's camera; else prints which cameras
   there are. */
WHIT_CHECK whit_result render_check_camera(const struct job *job);

/* Makes a renderer for `request`. */
WHIT_CHECK whit_result render_create(const struct job *job, const struct render_request *request,
                                     struct frames_progress *progress, whit_renderer **renderer);

/* Saves the files that `request` names for the picture just rendered. `images` has all of its
   images, or none of them, and then those of the shader's aovs are read into it. */
whit_result render_save(const struct job *job, const struct render_request *request,
                        whit_renderer *renderer, struct drawn_images *images,
                        const whit_stats *stats);

#endif
