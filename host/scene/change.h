/* Describes in words how a part of a scene changed. */
#ifndef SCENE_CHANGE_H
#define SCENE_CHANGE_H

#include "scene/mix.h"

/* Writes how a part of `after` differs from the same part of `before`, for example "vertices 2716
   and 2717 moved by up to 1.3e-3", cut to `bytes`; "" where they are equal or one side has no such
   part. Names are quoted as the files have them. */
void scene_change_write(const struct scene_side *before, const struct scene_side *after,
                        whit_part_kind kind, const char *name, char *text, size_t bytes);

#endif
