/* What --bailout may have changed. */
#ifndef RENDER_BAILOUT_BOUND_H
#define RENDER_BAILOUT_BOUND_H

#include "render/renderer.h"

/* By how much a pixel of the last picture may differ for the rays that --bailout
   cut; < 0: no bound is known (emissive surfaces as points, highlights of flat emitters, a light on
   a surface). */
double bailout_bound(const struct renderer *renderer);
/* Which materials of the scene some primitive has; free() it. NULL: memory ran out. */
bool *bailout_bound_materials(const struct scene *scene);

#endif
