/* Animation in scene files. */
#ifndef LOAD_SCENE_ANIMATION_H
#define LOAD_SCENE_ANIMATION_H

#include "load/scene_reader.h"

/* Converts angles in degrees about x, then y, then z, to a quaternion x, y, z, w. */
void reader_quaternion(const double degrees[3], double out[4]);
/* Reads `object`'s "animation" into channels of `node`. */
bool reader_animation(struct reader *reader, const struct place *place, const json_t *object,
                      uint32_t node);
/* Adds a node for a light or camera that has an "animation"; else *index is SCENE_NONE. */
bool reader_moving_node(struct reader *reader, const struct place *place, const json_t *object,
                        const char *name, uint32_t *index);

#endif
