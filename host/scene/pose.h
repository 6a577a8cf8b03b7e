/* A scene's instances, lights and cameras in world space at one time. */
#ifndef SCENE_POSE_H
#define SCENE_POSE_H

#include "scene/scene.h"

/* Whether an instance can have this matrix: it and its inverse exist and fit in floats. */
bool scene_can_place(const struct affine *matrix);
/* `scene` is frozen and outlives the pose. An instance whose scale is about zero along all axes
   at that time, without an inverse in range as scales of zero are nested, is a point too small to
   be seen. WHIT_ERROR_USAGE for a time that is not finite, WHIT_ERROR_INPUT when an instance is
   flat, too large or too far away at that time (named in the log), WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result scene_pose_init(const struct scene *scene, double time_s,
                                       struct scene_pose *pose);
/* World bounds of all instances but floors (flat ones wider than the rest); where the scene has
   floors alone, its bounds. */
void scene_pose_objects(const struct scene *scene, const struct scene_pose *pose, double lo[3],
                        double hi[3]);
void scene_pose_finish(struct scene_pose *pose);
/* A camera of the scene at a time. WHIT_ERROR_MEMORY. */
WHIT_CHECK whit_result scene_pose_camera(const struct scene *scene, uint32_t index, double time_s,
                                         struct scene_camera *camera);

#endif
