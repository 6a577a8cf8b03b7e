/* The direction that is up in a model. */
#ifndef LOAD_UP_H
#define LOAD_UP_H

#include "load/load.h"

/* Adds a node that rotates `up` to +y; gives its index, SCENE_NONE: memory ran out. */
uint32_t up_add_node(struct scene *scene, whit_up up);

/* Guesses the axis that points up in an OBJ, PLY or STL, whose files do not state it: y, unless the
   model stands on the lower end of z and not on that of y. `z_usual`: z, unless the model stands on
   the lower end of y; so for STL, the format of 3D printing. */
whit_up up_guess(const struct scene *scene, bool z_usual);
/* Rotates the whole scene so that the axis of up_guess becomes +y, and notes it. */
WHIT_CHECK whit_result up_turn_by_shape(struct scene *scene, const char *path);

#endif
