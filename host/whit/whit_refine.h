/* Part of whit.h: a picture that gets better, and an estimate of what is still wrong with it. */
#ifndef WHIT_REFINE_H
#define WHIT_REFINE_H

#include "whit_renderer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A picture of 1, 2, 4, 8 ... samples a pixel. No ray is traced twice: each step draws as many
   samples as there are. After n samples it is, byte for byte, the picture that a renderer draws
   with `n` as its number of samples. */
typedef struct whit_refine whit_refine;

typedef struct whit_refine_info {
    uint32_t samples; /* of each pixel, so far; 0: there is no picture yet */
    /* By how much the picture may be off: the root of the mean square, over all pixels, of
       whit_refine_error_image. < 0: not known before samples were doubled. */
    double error;
    /* The same of rays that were not traced alone, which more samples leave as it is. */
    double error_of_cuts;
    /* What the error of rays that were not traced is reckoned with: the mean radiance of the rays
       that what the camera sees calls for, largest channel; of camera rays where there are none. 0
       where no ray was cut. */
    double cut_radiance;
    bool last; /* there are not twice as many samples */
} whit_refine_info;

/* `renderer` is borrowed until whit_refine_destroy, and draws nothing else meanwhile. `params` as
   for whit_renderer_set_view, but for their sampling, and borrowed as there. WHIT_ERROR_USAGE as of
   it, without a device, and for a shader with `post`. */
WHIT_CHECK whit_result whit_refine_create(whit_renderer *renderer,
                                          const whit_renderer_params *params, whit_refine **out);
void whit_refine_destroy(whit_refine *refine);

/* Begins with a picture that there is already, of any number of samples from the first on: `color`
   as of WHIT_AOV_COLOR and `cuts` as of WHIT_AOV_CUTS, in the size of the params, which are copied.
   Its steps double this number, and statistics are of the steps alone. WHIT_ERROR_USAGE after the
   first step. */
WHIT_CHECK whit_result whit_refine_begin(whit_refine *refine, uint32_t samples, const float *color,
                                         const float *cuts);
/* From here on this renderer draws, whose pictures have the same pixels. `params` as for
   whit_refine_create. */
void whit_refine_move(whit_refine *refine, whit_renderer *renderer,
                      const whit_renderer_params *params);

/* One more step: the first sample; or what the estimate needs to know of rays that were cut, where
   some were, once; or as many samples as there are. WHIT_ERROR_USAGE after the last one; else as of
   whit_renderer_render, and then the picture stays as it was and the step can be taken again. */
WHIT_CHECK whit_result whit_refine_step(whit_refine *refine);
void whit_refine_get_info(const whit_refine *refine, whit_refine_info *info);

/* Linear RGBA. WHIT_ERROR_USAGE where there is no picture yet. */
WHIT_CHECK whit_result whit_refine_image(const whit_refine *refine, whit_image **out);
/* A function of the shader, as WHIT_AOV_SHADER + index, of all samples. WHIT_ERROR_USAGE too for
   those that the shader has not, and where the samples were begun with by others. */
WHIT_CHECK whit_result whit_refine_aov(const whit_refine *refine, uint32_t index, whit_image **out);
/* One channel: by how much each pixel may be off, in its worst channel, linear. It is what the last
   doubling of samples changed in the 3 x 3 pixels around, and the weights of rays that were cut
   times `cut_radiance`. An estimate and no bound: light that no sample has met is in none.
   WHIT_ERROR_USAGE where nothing is known yet. */
WHIT_CHECK whit_result whit_refine_error_image(const whit_refine *refine, whit_image **out);
/* All steps together. Rays are those of the picture; times are of all steps. */
void whit_refine_get_stats(const whit_refine *refine, whit_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
