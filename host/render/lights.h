/* Lights as the kernel reads them. */
#ifndef RENDER_LIGHTS_H
#define RENDER_LIGHTS_H

#include "render/renderer.h"

/* Writes the rows of all lights of the pose. */
WHIT_CHECK whit_result lights_write(struct renderer *renderer);
/* Bits 1 << LIGHT_* of the kinds in `pose`. */
uint32_t lights_kinds(const struct scene_pose *pose);
/* Whether one list of lit hits serves several lights well: they are more than LIGHT_LISTS, or none
   has a range or a cone, so that each reaches most hits. */
bool lights_share_hits(const struct scene_pose *pose);
/* The number of points sampled on each flat emitter; 1 where the pose has none. */
uint32_t lights_samples(const struct renderer *renderer);
/* The number of points of the first LIGHT_LISTS lights, where a flat emitter has `each`. */
uint32_t lights_points(const struct renderer *renderer, uint32_t each);

#endif
