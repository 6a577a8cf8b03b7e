/* Pictures that are refined until they are good enough: `whit render --refine ERROR|MSms`. */
#ifndef APP_RENDER_REFINE_H
#define APP_RENDER_REFINE_H

#include "app/arguments.h"
#include "app/job.h"
#include "app/render/layers.h"

struct render_request;
struct frames_progress;
struct sequence;

/* The limits at which refining ends: with --refine one of the two is above 0, else both are 0. */
struct refine_goal {
    double error;    /* estimated RMSE, linear */
    double limit_ms; /* limit on the time of drawing; a step that would exceed it is not begun */
};

/* The state in which refining ended. now.samples is 0 where --refine was not given. */
struct refined {
    whit_refine_info now;
    bool reached; /* whether the goal was reached */
};

bool refine_is_wanted(const struct refine_goal *goal);
/* setting.read of --refine, into a render_request. */
bool refine_read(const struct setting *setting, const char *value, void *request,
                 char why[SETTING_WHY_BYTES]);
/* Checks that the other options go with --refine. */
bool refine_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request);

/* The number of samples that most refined pictures end with. It is so large that kernels are chosen
   that take longer to make and draw faster. */
enum { REFINE_SAMPLES_USUAL = 64 };

/* Draws until request->refine is met. Gives *images, with the ids of the first sample where
   `request` or edges need them, and in *sequence the stats of all steps and how it ended. Sets the
   job's number of samples to that of the picture, so that its recipe draws it again. After an error
   there are no images. */
WHIT_CHECK whit_result refine_render(struct job *job, const struct render_request *request,
                                     whit_renderer *renderer, struct frames_progress *progress,
                                     struct drawn_images *images, struct sequence *sequence);

/* Prints samples and error, as a note where the goal was reached, else as an error. */
void refine_say(const struct refine_goal *goal, const struct refined *refined);

#endif
