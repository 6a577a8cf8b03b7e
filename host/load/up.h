/* Which way a model is up. */
#ifndef LOAD_UP_H
#define LOAD_UP_H

#include "load/load.h"

/* Adds a node that turns `up` to +y; SCENE_NONE: memory ran out. */
uint32_t up_add_node(struct scene *scene, whit_up up);

/* The axis that most likely points up in a model of OBJ, PLY or STL, whose files do not say: the
   one on whose lower end it stands, if y is not. `z_usual`: z is, unless it stands on y, as in STL,
   which machines that print write. */
whit_up up_guess(const struct scene *scene, bool z_usual);
/* Turns all that has been read by the guess, and notes it. */
WHIT_CHECK whit_result up_turn_by_shape(struct scene *scene, const char *path);

#endif
