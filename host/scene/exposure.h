/* Chooses how strong lights are, and the exposure of the picture. */
#ifndef SCENE_EXPOSURE_H
#define SCENE_EXPOSURE_H

#include "scene/freeze.h"

/* Scales all lights by *factor so that what they light is bright, unless a scene file of whit's own
   states them. `emitters`: the lights were made from emissive surfaces; other lights are scaled
   only where they would burn the picture out or leave it black. */
WHIT_CHECK whit_result freeze_expose(struct scene *scene, bool emitters, double *factor);

/* Brightness of a white surface at `point` by one light without shadows; `normal` is unit, and
   light from either side counts. */
double freeze_brightness(const struct scene_light *light, const double point[3],
                         const double normal[3]);

/* Sets scene->exposure_ev, and adds a note where it is not 0. */
WHIT_CHECK whit_result freeze_choose_exposure(struct scene *scene);

#endif
