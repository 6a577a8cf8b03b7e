/* How bright lights are, and pictures. */
#ifndef SCENE_EXPOSURE_H
#define SCENE_EXPOSURE_H

#include "scene/freeze.h"

/* Scales all lights so that what they light is bright, unless a scene file of whit's
   own states them. `emitters`: they were made of emissive surfaces; else they are left alone where
   they neither burn the picture out nor leave it black. *factor is what by. */
WHIT_CHECK whit_result freeze_expose(struct scene *scene, bool emitters, double *factor);

/* What a white surface shows of one light at `point`, if nothing is between; `normal` is unit, and
   both its sides count. */
double freeze_brightness(const struct scene_light *light, const double point[3],
                         const double normal[3]);

/* scene->exposure_ev, and a note where it is not 0. */
WHIT_CHECK whit_result freeze_choose_exposure(struct scene *scene);

#endif
