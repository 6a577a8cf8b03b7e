/* What of a part is other, in words. */
#ifndef SCENE_CHANGE_H
#define SCENE_CHANGE_H

#include "scene/mix.h"

/* "vertices 2716 and 2717 moved by up to 1.3e-3": how a part of `after` differs from that of
   `before`, cut to `bytes`; "" where it does not or is on one side alone. Names are as the files
   have them. */
void scene_change_write(const struct scene_side *before, const struct scene_side *after,
                        whit_part_kind kind, const char *name, char *text, size_t bytes);

#endif
