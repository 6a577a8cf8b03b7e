/* What moves in a scene file. */
#ifndef LOAD_SCENE_ANIMATION_H
#define LOAD_SCENE_ANIMATION_H

#include "load/scene_reader.h"

/* Degrees about x, then y, then z, to a quaternion x, y, z, w. */
void reader_quaternion(const double degrees[3], double out[4]);
/* Channels of `object`'s "animation" for `node`. */
bool reader_animation(struct reader *reader, const struct place *place, const json_t *object,
                      uint32_t node);
/* What moves hangs on a node of its own; what stands still needs none: SCENE_NONE. */
bool reader_moving_node(struct reader *reader, const struct place *place, const json_t *object,
                        const char *name, uint32_t *index);

#endif
