/* A scene on a device: upload, pipelines, pass order, readback. */
#ifndef RENDER_RENDER_H
#define RENDER_RENDER_H

#include <stdbool.h>
#include <stdint.h>

#include "abi/queues.h"
#include "abi/shade.h"
#include "accel/accel.h"
#include "device/device.h"
#include "image/image.h"
#include "picture/params.h"
#include "scene/scene.h"
#include "twin/counters.h"
#include "whit/whit_program.h"

/* Whether effects_added and effects_removed may name an effect. Effects that say what geometry and
   cameras are (spheres, instances, kinds of cameras) cannot be removed; a lens can, which leaves a
   pinhole. */
bool render_effect_can_add(enum scene_effect effect);
bool render_effect_can_remove(enum scene_effect effect);

/* Rows of whit_stats.stages. */
enum {
    RENDER_STAGE_CAMERA,
    RENDER_STAGE_CLOSEST,
    RENDER_STAGE_SHADE, /* CLASS_PLAIN, or all materials */
    RENDER_STAGE_SHADE_GLASS,
    RENDER_STAGE_RESOLVE,
    RENDER_STAGE_DEFERRED, /* NUMERICS_EXACT: the second kernels of all stages */
    RENDER_STAGE_SHADOW,   /* light 0, then one row a light; with over LIGHT_LISTS lights: all */
    RENDER_STAGE_COUNT = RENDER_STAGE_SHADOW + LIGHT_LISTS
};
_Static_assert(RENDER_STAGE_COUNT == WHIT_STAGES, "whit_stats has a row for each");

struct renderer;

/* `device` and `accel` (with its scene) are borrowed until renderer_destroy. Poses `accel` at
   params->time_s. WHIT_ERROR_USAGE for a camera that does not exist, sizes out of range, or a scene
   whose textures were dropped. */
WHIT_CHECK whit_result renderer_create(const whit_log *log, struct device *device,
                                       struct accel *accel, const whit_renderer_params *params,
                                       struct renderer **out);
void renderer_destroy(struct renderer *renderer);
WHIT_CHECK whit_result renderer_render(struct renderer *renderer);
/* See whit_renderer_render_views. */
WHIT_CHECK whit_result renderer_render_views(struct renderer *renderer, const whit_camera *cameras,
                                             uint32_t count);
/* Gives the number of views in the last picture; 0: it was not drawn by renderer_render_views. */
uint32_t renderer_view_count(const struct renderer *renderer);
/* Linear RGBA floats. */
WHIT_CHECK whit_result renderer_read_color(struct renderer *renderer, struct image *out);
/* As renderer_read_color, but without a copy where the host reads the device's memory itself: the
   image then has the renderer's pixels, until it draws again. */
WHIT_CHECK whit_result renderer_borrow_color(struct renderer *renderer, struct image *out);
/* Instance and primitive of each pixel's first sample (HIT_NONE: nothing was hit). */
WHIT_CHECK whit_result renderer_read_ids(struct renderer *renderer, struct image *out);
/* The value of the shader's aov number `index`: 4 floats a pixel. */
WHIT_CHECK whit_result renderer_read_aov(struct renderer *renderer, uint32_t index,
                                         struct image *out);
/* The image that WHIT_AOV_CUTS describes. WHIT_ERROR_USAGE also for adaptive samples. */
WHIT_CHECK whit_result renderer_read_cuts(struct renderer *renderer, struct image *out);
/* The image that WHIT_AOV_DISTANCES describes. */
WHIT_CHECK whit_result renderer_read_distances(struct renderer *renderer, struct image *out);
void renderer_get_stats(const struct renderer *renderer, whit_stats *stats);

/* The camera rays of the picture that was set last, as camera_all_rays gives them, or of a smaller
   picture of at most `max` pixels, whose sides are those of the picture divided by one whole
   number. *rays: free(). */
WHIT_CHECK whit_result renderer_camera_rays(const struct renderer *renderer, uint32_t max,
                                            struct gpu_ray **rays, uint64_t *count);
/* The camera rays of the whole picture, with t_max at the ground, and the share of each pixel that
   the lines of a grid on the ground cover (picture/grid.h). free() both. */
WHIT_CHECK whit_result renderer_grid_rays(const struct renderer *renderer, struct gpu_ray **rays,
                                          float **cover, uint64_t *count);

/* Whether a renderer made with these params has one kernel for several stages and all materials:
   what WHIT_CLASSES_AUTO amounts to. */
bool render_few_kernels(const whit_renderer_params *params);

/* By how much a pixel may differ because of --bailout, where the weights of its rays that were cut
   sum to `weight`, with the renderer's settings; < 0: no bound is known (emissive surfaces as
   points, highlights of flat emitters, a light on a surface). */
double bailout_bound(const struct renderer *renderer, double weight);

/* Whether kernels are made with an effect. */
bool renderer_compiles(const struct renderer *renderer, enum scene_effect effect);
/* WHIT_ERROR_DEVICE when the kernel cannot be specialized. */
WHIT_CHECK whit_result renderer_get_kernel(const struct renderer *renderer, whit_kernel_info *info);

/* Makes the kernels of a picture one after the other, without any device memory. `kernels` has room
   for WHIT_KERNELS_MAX. Without `make` their instructions are only counted; a count of 0 means that
   the kernel cannot be specialized. */
WHIT_CHECK whit_result render_list_kernels(const whit_log *log, struct device *device,
                                           struct accel *accel, const whit_renderer_params *params,
                                           bool make, whit_kernel *kernels, uint32_t *count);

/* hook_tests.c: whit_renderer_run_tests */
WHIT_CHECK whit_result renderer_run_tests(struct renderer *renderer, whit_check_result *results,
                                          double *compile_ms, double *run_ms);

/* hook_expect.c: whit_renderer_check_expectations */
WHIT_CHECK whit_result renderer_check_expectations(struct renderer *renderer, bool *held);

/* With params.count: the costs of rays of `kind` (RAY_*) of each pixel's first sample, as 8 integer
   channels in the order of struct gpu_cost. */
WHIT_CHECK whit_result renderer_read_costs(struct renderer *renderer, uint32_t kind,
                                           struct image *out);

/* Goes to another time: poses the accel, and uploads what moved: instances with their tree, lights,
   camera. Pictures are then those of a renderer made at that time, byte for byte. */
WHIT_CHECK whit_result renderer_set_time(struct renderer *renderer, double time_s);

/* Takes over width, height, camera, time_s, samples, adaptive, light_samples, bailout and depth of
   `params`, and nothing else. Buffers that fit are kept. Kernels are kept too, except for a camera
   of another kind, adaptive on or off, depth to or from 0, and without trees. The name of its
   camera is borrowed until the next call that succeeds. The picture is that of a renderer made with
   these, byte for byte. Params out of range, and a camera that is refused while time_s stays,
   change nothing; after other errors nothing can be rendered until a call succeeds. */
WHIT_CHECK whit_result renderer_set_view(struct renderer *renderer,
                                         const whit_renderer_params *params);
/* Whether the renderer can draw with `shader`, another version of its own, if it only makes some
   kernels anew. */
bool renderer_takes_shader(const struct renderer *renderer, const whit_shader *shader);
/* Replaces the renderer's shader by params->shader, for which renderer_takes_shader is true; the
   old one may be freed afterwards. Otherwise as renderer_set_view. After an error the renderer
   keeps the old one. */
WHIT_CHECK whit_result renderer_set_shader(struct renderer *renderer,
                                           const whit_renderer_params *params);

/* Traces a batch of rays in pieces that fit the device. `costs`: one a ray, or NULL. */
WHIT_CHECK whit_result renderer_trace(struct renderer *renderer, const struct gpu_ray *rays,
                                      uint64_t count, bool any, struct gpu_hit *hits,
                                      struct gpu_cost *costs);
/* Device time of the traversal in the last renderer_trace, without transfers; < 0: not measured. */
double renderer_trace_device_ms(const struct renderer *renderer);
/* Number of rays of the last batch that were traced in packets. */
uint64_t renderer_trace_together(const struct renderer *renderer);

#endif
