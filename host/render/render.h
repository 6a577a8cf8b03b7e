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

/* Whether effects_added and effects_removed may name an effect. What geometry or the camera is made
   of cannot be taken out (spheres, instances, kinds of cameras); a lens can: a pinhole is left. */
bool render_effect_can_add(enum scene_effect effect);
bool render_effect_can_remove(enum scene_effect effect);

/* Rows of whit_stats.stages. */
enum {
    RENDER_STAGE_CAMERA,
    RENDER_STAGE_CLOSEST,
    RENDER_STAGE_SHADE, /* of CLASS_PLAIN, or of all */
    RENDER_STAGE_SHADE_GLASS,
    RENDER_STAGE_RESOLVE,
    RENDER_STAGE_DEFERRED, /* NUMERICS_EXACT: what floats left open, of all stages */
    RENDER_STAGE_SHADOW,   /* of light 0, and so on; where more than LIGHT_LISTS: of all */
    RENDER_STAGE_COUNT = RENDER_STAGE_SHADOW + LIGHT_LISTS
};
_Static_assert(RENDER_STAGE_COUNT == WHIT_STAGES, "whit_stats has a row for each");

struct renderer;

/* `device` and `accel` (with its scene) are borrowed until renderer_destroy. Poses `accel` at
   params->time_s. WHIT_ERROR_USAGE for a camera that does not exist, sizes out of range, or a
   scene whose pictures were dropped. */
WHIT_CHECK whit_result renderer_create(const whit_log *log, struct device *device,
                                       struct accel *accel, const whit_renderer_params *params,
                                       struct renderer **out);
void renderer_destroy(struct renderer *renderer);
WHIT_CHECK whit_result renderer_render(struct renderer *renderer);
/* whit_renderer_render_views */
WHIT_CHECK whit_result renderer_render_views(struct renderer *renderer, const whit_camera *cameras,
                                             uint32_t count);
/* Gives the number of views in the last picture; 0: it was not drawn by renderer_render_views. */
uint32_t renderer_view_count(const struct renderer *renderer);
/* Linear RGBA floats, or instance and primitive of the first sample (HIT_NONE: miss). */
WHIT_CHECK whit_result renderer_read_color(struct renderer *renderer, struct image *out);
WHIT_CHECK whit_result renderer_read_ids(struct renderer *renderer, struct image *out);
/* Function `index` of the shader's that are kept beside the colour: 4 floats. */
WHIT_CHECK whit_result renderer_read_aov(struct renderer *renderer, uint32_t index,
                                         struct image *out);
/* As WHIT_AOV_CUTS has it. WHIT_ERROR_USAGE too for adaptive samples. */
WHIT_CHECK whit_result renderer_read_cuts(struct renderer *renderer, struct image *out);
/* As WHIT_AOV_DISTANCES has it. */
WHIT_CHECK whit_result renderer_read_distances(struct renderer *renderer, struct image *out);
void renderer_get_stats(const struct renderer *renderer, whit_stats *stats);

/* The same of the picture that was set last, or of a smaller one of at most `max` pixels whose
   sides are that of it over a whole number. *rays: free(). */
WHIT_CHECK whit_result renderer_camera_rays(const struct renderer *renderer, uint32_t max,
                                            struct gpu_ray **rays, uint64_t *count);
/* Those of the whole picture, up to the ground, and how much of each pixel a grid there covers (see
   picture/grid.h); free() both. */
WHIT_CHECK whit_result renderer_grid_rays(const struct renderer *renderer, struct gpu_ray **rays,
                                          float **cover, uint64_t *count);

/* Whether a renderer that is made with these params has one kernel where others have several: what
   WHIT_CLASSES_AUTO comes to. */
bool render_few_kernels(const whit_renderer_params *params);

/* Whether kernels are made with an effect. */
bool renderer_compiles(const struct renderer *renderer, enum scene_effect effect);
/* WHIT_ERROR_DEVICE when the kernel cannot be specialized. */
WHIT_CHECK whit_result renderer_get_kernel(const struct renderer *renderer, whit_kernel_info *info);

/* Makes the kernels of a picture one after the other, and nothing else: no memory of the device is
   taken. `kernels`: WHIT_KERNELS_MAX. Without `make` their instructions are counted alone; 0: the
   kernel cannot be specialized. */
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
   camera. The picture is then that of a renderer made at that time, byte for byte. */
WHIT_CHECK whit_result renderer_set_time(struct renderer *renderer, double time_s);

/* Takes over width, height, camera, time_s, samples, adaptive, light_samples, bailout and depth of
   `params`, and nothing else; buffers that fit stay, and so do kernels but for a camera of another
   kind, adaptive on or off, depth to or from 0, and without trees. The name of its camera
   is borrowed until the next call. The picture is that of a renderer made with these, byte for
   byte. After an error there is nothing to render before a call that succeeds. */
WHIT_CHECK whit_result renderer_set_view(struct renderer *renderer,
                                         const whit_renderer_params *params);
/* Whether another version of the renderer's shader needs no more than other kernels. */
bool renderer_takes_shader(const struct renderer *renderer, const whit_shader *shader);
/* Such a version, params->shader, in the place of the renderer's, which may go afterwards; else as
   renderer_set_view. */
WHIT_CHECK whit_result renderer_set_shader(struct renderer *renderer,
                                           const whit_renderer_params *params);

/* A batch of rays in chunks that fit the device. `costs`: one a ray, or NULL. */
WHIT_CHECK whit_result renderer_trace(struct renderer *renderer, const struct gpu_ray *rays,
                                      uint64_t count, bool any, struct gpu_hit *hits,
                                      struct gpu_cost *costs);
/* Device time of the traversal of the last renderer_trace, without transfers; < 0: not measured. */
double renderer_trace_device_ms(const struct renderer *renderer);
/* Rays of the last batch that walked in packets. */
uint64_t renderer_trace_together(const struct renderer *renderer);

#endif
