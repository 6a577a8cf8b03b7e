/* Pictures that are refined until they are good enough: `whit render --refine ERROR|MSms`. */
#ifndef APP_RENDER_REFINE_H
#define APP_RENDER_REFINE_H

#include "app/arguments.h"
#include "app/job.h"
#include "app/render/layers.h"

struct render_request;
struct frames_progress;

/* When it ends: one of the two is above 0 where it is asked for. */
struct refine_goal {
    double error;    /* estimated RMSE, linear */
    double limit_ms; /* of drawing; the step that would pass it is not begun */
};

/* The samples and the estimated error that refining ended with. `samples` 0: --refine was not
   given. */
struct refined {
    uint32_t samples;
    double error, error_of_cuts; /* < 0: not known, of one sample */
    double cut_radiance;
    bool reached; /* the goal */
};

bool refine_is_wanted(const struct refine_goal *goal);
/* setting.read of --refine, into a render_request. */
bool refine_read(const struct setting *setting, const char *value, void *request,
                 char why[SETTING_WHY_BYTES]);
/* Whether the other options go with --refine. */
bool refine_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request);

/* Samples that most pictures end with: kernels that take longer to make are right for them. */
enum { REFINE_SAMPLES_USUAL = 64 };

/* Draws until request->refine is met: *color and `layers`, with `stats` of all of it; the job's
   samples are then those of the picture, so that its recipe draws it again, and the renderer's
   identities are those of the first sample where `request` needs them. After an error *color is
   NULL and there are no layers. */
WHIT_CHECK whit_result refine_render(struct job *job, const struct render_request *request,
                                     whit_renderer *renderer, struct frames_progress *progress,
                                     struct refined *refined, whit_image **color,
                                     struct layers *layers, whit_stats *stats);

/* Prints samples and error, as a note, or as an error where the goal was not reached. */
void refine_say(const struct refine_goal *goal, const struct refined *refined);

#endif
