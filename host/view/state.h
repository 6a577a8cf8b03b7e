/* What the viewer is at, as one line of JSON. */
#ifndef VIEW_STATE_H
#define VIEW_STATE_H

#include <stdbool.h>
#include <stdio.h>

struct view;

/* The line of JSON that tests read, with its name; the measure begins anew. */
void state_print(struct view *view, const char *name, FILE *to);
/* Whether the line would have FIELD = VALUE, or a FIELD that is neither empty, false nor 0. */
bool state_has(struct view *view, const char *condition);

#endif
