/* What is added to a scene between begin and end, and copies of it. */
#ifndef LOAD_SCENE_RANGE_H
#define LOAD_SCENE_RANGE_H

#include "load/scene_reader.h"

/* What is added below `parent` between begin and end. */
struct scene_range range_begin(const struct scene *scene, uint32_t parent);
void range_end(const struct scene *scene, struct scene_range *range);
/* Whether the range may be copied `times` times, below a node of its own each. */
bool range_afford(struct reader *reader, const struct place *place, const struct scene_range *range,
                  uint64_t times);
/* All of the range once more, below `parent`. */
bool range_copy(struct reader *reader, const struct place *place, const struct scene_range *range,
                uint32_t parent);

#endif
