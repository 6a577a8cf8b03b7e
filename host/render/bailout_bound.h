/* A bound on what --bailout has changed. */
#ifndef RENDER_BAILOUT_BOUND_H
#define RENDER_BAILOUT_BOUND_H

#include "render/renderer.h"

/* By how much a pixel may differ because of --bailout, where the weights of its rays that were cut
   sum to `weight`, with the renderer's settings; < 0: no bound is known (emissive surfaces as
   points, highlights of flat emitters, a light on a surface). */
double bailout_bound(const struct renderer *renderer, double weight);

#endif
