/* Part of whit.h: the same picture in double. */
#ifndef WHIT_REFERENCE_H
#define WHIT_REFERENCE_H

#include "whit_probe.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The same picture in double, on the CPU, written a second time: what kernels get wrong is the
   difference to it. See host/reference/reference.h. */
typedef struct whit_reference whit_reference;

/* `accel` is borrowed until whit_reference_destroy and goes to params->time_s: no renderer may be
   at work on it. Of `params` size, camera, time, samples, depth, bailout, shadows, Fresnel, area
   lights, cancel, progress and time_limit_s (of one whit_reference_render) are obeyed; adaptive
   samples, effects left out, a shader and what a renderer refuses are WHIT_ERROR_USAGE;
   WHIT_ERROR_INPUT and WHIT_ERROR_STATUS as of whit_renderer_create. `threads`: 0: one a core; the
   same bytes for any number, and whatever the machine and its libm. */
WHIT_CHECK whit_result whit_reference_create(whit_accel *accel, const whit_renderer_params *params,
                                             uint32_t threads, whit_reference **out);
void whit_reference_destroy(whit_reference *reference);
/* `ids`, as WHIT_AOV_IDS, may be NULL. WHIT_ERROR_CANCELLED and WHIT_ERROR_TIME_LIMIT leave no
   picture. WHIT_ERROR_STATUS: a ray was in too many media. */
WHIT_CHECK whit_result whit_reference_render(whit_reference *reference, whit_image **color,
                                             whit_image **ids);
/* Gives the statistics of the picture rendered last: rays by kind, rays cut, render_ms and
   mrays_per_s. Figures that only a device has are 0; weights and bounds are not known: below 0. */
void whit_reference_get_stats(const whit_reference *reference, whit_stats *stats);

/* The rays of one sample (0: the first) of a pixel from the upper left, each after its parent, as
   whit_probe has those of the device: `device` is what the reference met, and nothing is known of
   `twin` and `exact`. The sum of `added` over all but shadow rays is the sample's colour, but for
   their rounding to floats. *rays is for whit_memory_destroy. WHIT_ERROR_USAGE outside of the
   picture, WHIT_ERROR_MEMORY; WHIT_ERROR_STATUS as whit_reference_render. */
WHIT_CHECK whit_result whit_reference_rays(whit_reference *reference, uint32_t x, uint32_t y,
                                           uint32_t sample, whit_probe_ray **rays, uint32_t *count);

#ifdef __cplusplus
}
#endif

#endif
