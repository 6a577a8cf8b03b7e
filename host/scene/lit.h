/* Measures the light on what the first camera sees. */
#ifndef SCENE_LIT_H
#define SCENE_LIT_H

#include "scene/freeze.h"

/* The share, 0..1, of what the first camera sees that lights reach, measured with a few hundred
   rays against all triangles. 1 where it cannot be measured: with a panorama, or where nothing is
   seen. */
WHIT_CHECK whit_result freeze_lit_share(const struct scene *scene, double *share);

/* Brightness at the hits of the same rays, without metal and mirrors: `shown` is the brightest
   channel of the surface, `white` that of a white surface in its place. `shadows`: tests whether
   lights reach the hit; without, the values are upper bounds. */
enum { FREEZE_SEEN_MAX = 256 };
struct freeze_seen {
    double shown[FREEZE_SEEN_MAX], white[FREEZE_SEEN_MAX];
    uint32_t count;
};
WHIT_CHECK whit_result freeze_see(const struct scene *scene, bool shadows,
                                  struct freeze_seen *seen);

#endif
