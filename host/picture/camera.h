/* Cameras, and the rays they send, bit for bit as shaders/bind/camera.glsl computes them. */
#ifndef PICTURE_CAMERA_H
#define PICTURE_CAMERA_H

#include "abi/bvh.h"
#include "abi/shade.h"
#include "abi/spec.h"
#include "base/log.h"
#include "scene/scene.h"
#include "whit/whit_types.h"

/* Fills in the camera `wanted` in `pose`; *kind is its CAMERA_*. WHIT_ERROR_USAGE, logged, where
   there is no such camera, or it is degenerate. */
WHIT_CHECK whit_result camera_frame(const whit_log *log, const struct scene_pose *pose,
                                    const whit_camera *wanted, uint32_t width, uint32_t height,
                                    struct gpu_frame *frame, uint32_t *kind);

/* The area, in world units, that the pixel in the middle of the picture covers perpendicular to its
   ray: at distance 1 from the eye, or anywhere if the camera is orthographic. texel_area of
   bind/camera.glsl starts from it. */
double camera_pixel_area(const struct gpu_frame *frame, uint32_t kind);

/* bind/camera.glsl's camera_ray in C, bit for bit: for pixel (x, y), counted from the upper left,
   and a camera of `kind` (CAMERA_*). Only sample_xy and lens_xy of `sample` are read. */
void camera_ray(const struct gpu_frame *frame, uint32_t kind, uint32_t x, uint32_t y,
                const struct gpu_chunk *sample, struct gpu_ray *ray);

/* lib/angles.glsl in C, bit for bit: sine and cosine of pi * a, for a in -1..1, with an error of at
   most 1.2e-7. */
void sine_cosine_pi(float a, float *sine, float *cosine);

/* The place of a sample in pixel (x, y), from sample_xy or lens_xy; neighbouring pixels use mirror
   images of the pattern. */
void camera_mirror_sample(const float xy[2], uint32_t x, uint32_t y, float out[2]);

/* Sets chunk->sample_index, sample_xy, lens_xy and light_index for sample `index`. */
void camera_sample(const struct gpu_frame *frame, uint32_t index, struct gpu_chunk *chunk);

/* Makes the first sample's camera ray of every pixel of a picture, row by row, bit for bit as
   kernels do. WHIT_ERROR_USAGE as camera_frame. */
WHIT_CHECK whit_result camera_all_rays(const whit_log *log, const struct scene_pose *pose,
                                       const whit_camera *camera, uint32_t width, uint32_t height,
                                       struct gpu_ray *rays);

#endif
