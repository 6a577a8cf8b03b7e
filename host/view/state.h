/* The state of the viewer as one line of JSON. */
#ifndef VIEW_STATE_H
#define VIEW_STATE_H

#include <stdbool.h>
#include <stdio.h>

struct view;

/* Prints the line of JSON that tests read, with `name`; view->measure begins anew. */
void state_print(struct view *view, const char *name, FILE *to);
/* Whether the line would have FIELD = VALUE, or (condition FIELD) a FIELD that is not empty, null,
   false or 0. */
bool state_has(struct view *view, const char *condition);

#endif
