/* Replays events from a file, and records them to one. */
#ifndef VIEW_REPLAY_H
#define VIEW_REPLAY_H

#include "view/events.h"

struct view;

WHIT_CHECK whit_result replay_open(struct view *view);
/* Feeds the events that are due, and moves the replay's clock. */
void replay_step(struct view *view);
/* Clicks on the item that a `choose` names; false: it is not due, or there is no such item yet. To
   be called between two drawings of the window without anything that may move the item. */
bool replay_choose(struct view *view);
/* Seconds until the next event is due; HUGE_VAL: there is none. */
double replay_wait_s(struct view *view);
bool replay_is_over(const struct view *view);
/* WHIT_ERROR_OUTPUT, logged: not all events could be recorded. */
WHIT_CHECK whit_result replay_close(struct view *view);
void record_event(struct view *view, const struct view_event *event);

#endif
