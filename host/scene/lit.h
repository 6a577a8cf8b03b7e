/* What the first camera sees of the light. */
#ifndef SCENE_LIT_H
#define SCENE_LIT_H

#include "scene/freeze.h"

/* Which share of what the first camera sees is reached by light, 0..1, by a few hundred rays
   through all triangles. 1 where that cannot be told: by a camera that sees all around, or where
   nothing is seen. */
WHIT_CHECK whit_result freeze_lit_share(const struct scene *scene, double *share);

/* What the same rays see but for metal and mirrors: the brightest channel of it, and of a white
   surface in its place. `shadows`: whether lights reach it; else there is more than there is. */
enum { FREEZE_SEEN_MAX = 256 };
struct freeze_seen {
    double shown[FREEZE_SEEN_MAX], white[FREEZE_SEEN_MAX];
    uint32_t count;
};
WHIT_CHECK whit_result freeze_see(const struct scene *scene, bool shadows,
                                  struct freeze_seen *seen);

#endif
