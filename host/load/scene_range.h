/* Records which nodes, instances, channels, lights and cameras are added to a scene between
   range_begin and range_end, to copy them. */
#ifndef LOAD_SCENE_RANGE_H
#define LOAD_SCENE_RANGE_H

#include "load/scene_reader.h"

/* `parent`: the node below which all of the range is added. */
struct scene_range range_begin(const struct scene *scene, uint32_t parent);
void range_end(const struct scene *scene, struct scene_range *range);
/* Checks the memory limit for `times` copies of the range, each below a node of its own. */
bool range_afford(struct reader *reader, const struct place *place, const struct scene_range *range,
                  uint64_t times);
/* Adds a copy of all of the range, below `parent`. */
bool range_copy(struct reader *reader, const struct place *place, const struct scene_range *range,
                uint32_t parent);

#endif
