/* A scene of the parts of two: what would be drawn if some of what changed had not. */
#ifndef SCENE_MIX_H
#define SCENE_MIX_H

#include "scene/parts.h"

/* A frozen scene and its parts. */
struct scene_side {
    const struct scene *scene;
    const struct scene_parts *parts;
};

/* Makes a frozen scene of copies: `back`, by the parts of `before`, says of which parts it has
   those of `before`, the rest are those of `after`. Parts are the same by kind and name. The lists
   of all parts are of that side whose objects it has, and a part that one side alone has comes and
   goes with these. What scene_freeze derives is derived anew; with all or none of `back` the scene
   has the hash of `before` or `after`. WHIT_ERROR_MEMORY; WHIT_ERROR_INPUT, logged, where the two
   do not go together. */
WHIT_CHECK whit_result scene_mix(const whit_log *log, const struct scene_side *before,
                                 const struct scene_side *after, const bool *back,
                                 struct scene **out);
/* The same without what scene_freeze derives, which freeze_complete adds. */
WHIT_CHECK whit_result scene_mix_begin(const whit_log *log, const struct scene_side *before,
                                       const struct scene_side *after, const bool *back,
                                       struct scene **out);

#endif
