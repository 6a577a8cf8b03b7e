/* Sequences of frames: `whit render --frames A-B`. */
#ifndef APP_RENDER_FRAMES_H
#define APP_RENDER_FRAMES_H

#include "app/job.h"
#include "app/render/refine.h"

struct render_request;

/* Frames first to last, both of them. */
struct frames {
    bool given;
    uint32_t first, last;
};

/* The times of one frame. */
struct frame_times {
    uint32_t frame;
    double time_s;
    double instances_ms; /* transforms, boxes and the tree over instances; flat: the whole tree */
    double upload_ms, render_ms, save_ms;
};

/* The times and statistics of a sequence, or of one picture. `each` has the times of each frame,
 * for --stats only. */
struct sequence {
    struct frame_times *each;
    struct frame_times median;
    uint32_t count, capacity;
    uint32_t written, kept; /* numbers of frames; kept: finished before this run */
    bool left;              /* another process draws the picture: render_request.leaves */
    double save_ms;
    whit_stats stats;       /* summed over frames; upload_ms is that before the first frame */
    struct refined refined; /* of one picture, with --refine */
};

/* setting.read of --frames, into a render_request. */
bool frames_read(const struct setting *setting, const char *value, void *request,
                 char why[SETTING_WHY_BYTES]);
/* Checks that the other options go with --frames. */
bool frames_check(struct cli_reader *reader, const struct job *job,
                  const struct render_request *request);
/* `pattern` with its last run of # replaced by the number, zero-padded to at least as many digits.
   free() it; NULL: out of memory, or no #. */
char *frames_path(const char *pattern, uint32_t frame);

/* whit_renderer_params.progress of one picture or of many. */
struct frames_progress {
    struct cli_progress bar;
    uint32_t done, count; /* numbers of pictures, or of samples of a picture that is refined, where
                             `count` is an estimate */
    uint32_t parts;       /* how many of these are drawn at once; 0: 1 */
    double budget_ms;     /* budget of a picture; 0: none, or nothing is to be said of it. A note
                             says, once, that a picture will take longer */
    double predicted_ms;  /* of a picture with a budget */
    const whit_renderer *renderer; /* which draws the picture with a budget */
    bool said;
    uint32_t line, lines; /* the number of this piece of work, and of how many; lines 0: it is the
                             only one */
};
void frames_progress_update(void *progress, double done);

/* Renders and saves all frames with one renderer. Files written before a failure stay. */
whit_result frames_render(struct job *job, const struct render_request *request,
                          whit_renderer *renderer, struct frames_progress *progress,
                          struct sequence *sequence);
void sequence_finish(struct sequence *sequence);

#endif
