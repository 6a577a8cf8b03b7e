/* Media of a scene: whether bodies of media may touch, and which media the camera is in. */
#ifndef PICTURE_MEDIA_H
#define PICTURE_MEDIA_H

#include "abi/shade.h"
#include "accel/accel.h"
#include "picture/bodies.h"
#include "whit/whit_types.h"

/* Fills in the media that the camera of *frame is in, whether bodies of media may touch (`nested`),
   `contact`, and a sphere around the scene, for the pose that `accel` has. `bodies` keeps the
   results for the next call. WHIT_ERROR_USAGE for more materials than can be told apart,
   WHIT_ERROR_STATUS where the camera is in too many media; logged. */
WHIT_CHECK whit_result media_frame(const whit_log *log, const struct accel *accel,
                                   const struct scene_pose *pose, struct bodies *bodies,
                                   struct gpu_frame *frame);
/* The t of a shadow ray, `distance` long (infinite: to a sun), from which absorption is measured:
   see filter_end of shaders/bind/filter.glsl. */
double media_shadow_end(const struct gpu_frame *frame, const double origin[3], double distance);
/* Whether surfaces of two bodies may be at one place, for a filled-in frame; in an animated scene,
   at any time. */
bool media_touch(const struct scene *scene, const struct bodies *bodies,
                 const struct gpu_frame *frame);

/* Fills in the camera of *frame and the fields of media_frame; the rest is 0. *kind is its
   CAMERA_*. `accel` must have the pose. */
WHIT_CHECK whit_result media_view(const whit_log *log, struct accel *accel,
                                  const struct scene_pose *pose, const whit_camera *camera,
                                  uint32_t width, uint32_t height, struct gpu_frame *frame,
                                  uint32_t *kind);

#endif
