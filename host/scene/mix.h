/* A scene made of parts of two others: the new version of a scene with some of its changes
   undone. */
#ifndef SCENE_MIX_H
#define SCENE_MIX_H

#include "scene/parts.h"

/* A frozen scene and its parts. */
struct scene_side {
    const struct scene *scene;
    const struct scene_parts *parts;
};

/* Makes a frozen scene of copied parts. back[i] tells whether part i of `before` is taken from
   `before`; all other parts are taken from `after`. Parts correspond by kind and name. Which parts
   there are is decided by the side that WHIT_PART_OBJECTS is taken from. What scene_freeze derives
   is derived anew. With all of `back` true, or none, the scene has the hash of `before` or `after`.
   WHIT_ERROR_MEMORY; WHIT_ERROR_INPUT, logged, where the parts do not fit together. */
WHIT_CHECK whit_result scene_mix(const whit_log *log, const struct scene_side *before,
                                 const struct scene_side *after, const bool *back,
                                 struct scene **out);
/* The same, but not frozen; then scene_mix_end freezes it, or destroys it where `result`, or what
   it does, is an error. */
WHIT_CHECK whit_result scene_mix_begin(const whit_log *log, const struct scene_side *before,
                                       const struct scene_side *after, const bool *back,
                                       struct scene **out);
WHIT_CHECK whit_result scene_mix_end(whit_result result, struct scene **out);

#endif
