/* The parts of scene_freeze; no one else's business. */
#ifndef SCENE_FREEZE_H
#define SCENE_FREEZE_H

#include "scene/scene.h"

/* freeze.c: what scene_freeze does once all that is stated was checked: adds what is derived from
   it, and ends the writing. */
WHIT_CHECK whit_result freeze_complete(struct scene *scene);

/* clean.c: drops triangles that cannot be traced, mends attributes, sets bounds. */
WHIT_CHECK whit_result freeze_clean_mesh(struct scene *scene, uint32_t mesh);

/* emitters.c: adds lights that stand for emissive surfaces. *added is how many; 0 when the scene
   has none that would light it. */
WHIT_CHECK whit_result freeze_sample_emitters(struct scene *scene, const struct scene_pose *pose,
                                              uint32_t *added);

/* exposure.c: scales all lights so that what they light is bright, unless a scene file of whit's
   own states them. `emitters`: they were made of emissive surfaces; else they are left alone where
   they neither burn the picture out nor leave it black. *factor is what by. */
WHIT_CHECK whit_result freeze_expose(struct scene *scene, bool emitters, double *factor);

/* What a white surface shows of one light at `point`, if nothing is between; `normal` is unit, and
   both its sides count. */
double freeze_brightness(const struct scene_light *light, const double point[3],
                         const double normal[3]);

/* lit.c: which share of what the first camera sees is reached by light, 0..1, by a few hundred rays
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

/* exposure.c: scene->exposure_ev, and a note where it is not 0. */
WHIT_CHECK whit_result freeze_choose_exposure(struct scene *scene);

/* defaults.c: camera, lights, ambient light and environment where the file has none. */
WHIT_CHECK whit_result freeze_add_defaults(struct scene *scene);

/* hash.c: over all that pictures depend on. */
uint64_t freeze_hash(const struct scene *scene);
/* The same of one record: a struct scene_mesh, scene_material and so on, by its kind;
   WHIT_PART_OBJECTS has none. */
uint64_t freeze_hash_record(enum whit_part_kind kind, const void *record);
/* Of nodes and instances. */
uint64_t freeze_hash_objects(const struct scene *scene);

#endif
