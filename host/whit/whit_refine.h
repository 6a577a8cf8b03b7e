/* Part of whit.h: a picture that is refined step by step, with an estimate of its error. */
#ifndef WHIT_REFINE_H
#define WHIT_REFINE_H

#include "whit_renderer.h"

WHIT_C_BEGIN

/* A picture of 1, 2, 4, 8 ... samples a pixel. Each step draws as many samples as there are, so
   that no ray of the picture is traced twice; only the estimate of its error may need the camera
   rays of the first sample, and the shadow rays of what they hit, once more. After n samples it is,
   byte for byte, the picture that a renderer draws with `n` as its number of samples; but where
   whit_refine_begin gave a number that is no power of 2, sums are rounded in another order. */
typedef struct whit_refine whit_refine;

typedef struct whit_refine_info {
    uint32_t samples; /* of each pixel, so far; 0: there is no picture yet */
    /* Estimated RMSE of the picture: two thirds of the root mean square of whit_refine_error_image
       over all pixels. < 0: not known until samples were doubled once. */
    double error;
    /* The part of `error` that is due to rays that were not traced. More samples do not reduce
       it. */
    double error_of_cuts;
    /* The mean radiance of the rays spawned by the surfaces that the camera sees, largest channel;
       of camera rays where there are none. Each ray that was not traced is assumed to carry twice
       that. 0 where no ray was cut. */
    double cut_radiance;
    bool last; /* no further step: twice as many samples would exceed the limit */
} whit_refine_info;

/* `renderer` is borrowed until whit_refine_destroy, and draws nothing else meanwhile. `params` are
   as for whit_renderer_set_view and borrowed as there; their sampling and rows are not read, for
   whole pictures are refined. WHIT_ERROR_USAGE as there, without a device, for a shader with
   `post`, and for a renderer made with color_only. */
WHIT_CHECK whit_result whit_refine_create(whit_renderer *renderer,
                                          const whit_renderer_params *params, whit_refine **out);
void whit_refine_destroy(whit_refine *refine);

/* Begins with an existing picture of samples 0 to `samples` - 1: `color` as of WHIT_AOV_COLOR and
   `cuts` as of WHIT_AOV_CUTS, in the size of the params; both are copied. Steps then double
   `samples`, and statistics cover only the steps. WHIT_ERROR_USAGE after the first step, and for
   more than WHIT_SAMPLES_MAX samples. */
WHIT_CHECK whit_result whit_refine_begin(whit_refine *refine, uint32_t samples, const float *color,
                                         const float *cuts);
/* From this call on `renderer` draws the steps; its pictures must have the same pixels as those of
   the one before. `params` as for whit_refine_create. */
void whit_refine_move(whit_refine *refine, whit_renderer *renderer,
                      const whit_renderer_params *params);

/* Draws one more step: the first sample; or, once and only where rays were cut, what the estimate
   needs to know of them; or as many new samples as there are so far. WHIT_ERROR_USAGE after the
   last step; other errors as of whit_renderer_render, after which the picture is unchanged and the
   step can be repeated. */
WHIT_CHECK whit_result whit_refine_step(whit_refine *refine);
void whit_refine_get_info(const whit_refine *refine, whit_refine_info *info);

/* Linear RGBA. WHIT_ERROR_USAGE where there is no picture yet. */
WHIT_CHECK whit_result whit_refine_image(const whit_refine *refine, whit_image **out);
/* The mean over all samples of the shader's aov `index`, as WHIT_AOV_SHADER + index.
   WHIT_ERROR_USAGE also where the shader has no such aov, and after whit_refine_begin, whose
   samples have no aovs. */
WHIT_CHECK whit_result whit_refine_aov(const whit_refine *refine, uint32_t index, whit_image **out);
/* One channel: the estimated error of each pixel, linear, in its worst channel, by the changes that
   doublings of samples brought to it and to the 3 x 3 pixels around, plus the weights of cut rays
   times twice `cut_radiance`. It is no bound: it knows nothing of light that no sample has met.
   WHIT_ERROR_USAGE where no error is known yet. */
WHIT_CHECK whit_result whit_refine_error_image(const whit_refine *refine, whit_image **out);
/* Statistics of all steps together: rays are those of the picture, and `rays_of_estimate` those of
   the step that draws what the estimate needs. Times are the sums of all steps. */
void whit_refine_get_stats(const whit_refine *refine, whit_stats *stats);

WHIT_C_END

#endif
