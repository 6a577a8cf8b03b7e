/* Small pictures of many cameras, drawn together: `whit render --cameras FILE`. */
#ifndef APP_RENDER_CAMERAS_H
#define APP_RENDER_CAMERAS_H

#include "app/arguments.h"
#include "app/job.h"

struct frames_progress;
struct render_request;
struct sequence;

struct cameras {
    const char *file;      /* NULL: the option was not given */
    const char *distances; /* a pattern, or NULL */
    whit_camera *all;      /* released by cameras_finish */
    uint32_t count;
};

/* Checks that the other options go with --cameras, reads its file, and sets request->frames to one
   frame per camera. */
bool cameras_check(struct cli_reader *reader, const struct job *job,
                   struct render_request *request);
/* Draws and saves all views, as many at a time as should fit into memory. Files written before a
   failure stay. */
WHIT_CHECK whit_result cameras_render(const struct job *job, const struct render_request *request,
                                      whit_renderer *renderer, struct frames_progress *progress,
                                      struct sequence *sequence);
void cameras_finish(struct cameras *cameras);

#endif
