/* Part of whit.h: the same picture in double. */
#ifndef WHIT_REFERENCE_H
#define WHIT_REFERENCE_H

#include "whit_probe.h"

WHIT_C_BEGIN

/* Draws the same picture on the CPU in double, by an independent implementation: a picture of the
   device is judged by its difference from this one. See host/reference/reference.h. */
typedef struct whit_reference whit_reference;

/* `accel` is borrowed until whit_reference_destroy, and posed at params->time_s where it is not, as
   by renderers. Of `params` it obeys size, camera, time, samples, depth, bailout, shadows,
   Fresnel, area lights, cancel, progress and time_limit_s (per whit_reference_render).
   WHIT_ERROR_USAGE for adaptive samples, removed effects, a shader and params that a renderer
   refuses; WHIT_ERROR_INPUT and WHIT_ERROR_STATUS as of whit_renderer_create. `threads`: 0: one per
   core. The picture has the same bytes for any number of threads, on any machine and with any
   libm. */
WHIT_CHECK whit_result whit_reference_create(whit_accel *accel, const whit_renderer_params *params,
                                             uint32_t threads, whit_reference **out);
void whit_reference_destroy(whit_reference *reference);
/* `ids`, as WHIT_AOV_IDS, may be NULL. WHIT_ERROR_CANCELLED and WHIT_ERROR_TIME_LIMIT leave no
   picture. WHIT_ERROR_STATUS: a ray was in too many media. */
WHIT_CHECK whit_result whit_reference_render(whit_reference *reference, whit_image **color,
                                             whit_image **ids);
/* Gives the statistics of the picture rendered last: rays by kind, rays cut, render_ms and
   mrays_per_s. Counts that only a device has are 0; its times, weights and bounds are unknown and
   therefore below 0. */
void whit_reference_get_stats(const whit_reference *reference, whit_stats *stats);

/* The rays of one sample (0: the first) of pixel (x, y), counted from the upper left, each after
   its parent, in the form of whit_probe. The field `device` has the reference's hit; `twin` and
   `exact` are not known. The sum of `added` over all but shadow rays is the sample's colour, up to
   rounding to floats. *rays is for whit_memory_destroy. WHIT_ERROR_USAGE outside of the picture,
   WHIT_ERROR_MEMORY; WHIT_ERROR_STATUS as whit_reference_render. */
WHIT_CHECK whit_result whit_reference_rays(whit_reference *reference, uint32_t x, uint32_t y,
                                           uint32_t sample, whit_probe_ray **rays, uint32_t *count);

WHIT_C_END

#endif
