/* Events from a file, and into one. */
#ifndef VIEW_REPLAY_H
#define VIEW_REPLAY_H

#include "view/events.h"

struct view;

WHIT_CHECK whit_result replay_open(struct view *view);
/* Feeds what is due, and turns the clock. */
void replay_step(struct view *view);
/* Until its next event is due; HUGE_VAL without one. */
double replay_wait_s(struct view *view);
bool replay_is_over(const struct view *view);
void replay_close(struct view *view);
void record_event(struct view *view, const struct view_event *event);

#endif
