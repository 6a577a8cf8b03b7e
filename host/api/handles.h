/* The structs behind the public handles, for api/ alone. */
#ifndef API_HANDLES_H
#define API_HANDLES_H

#include "accel/accel.h"
#include "device/device.h"
#include "image/image.h"
#include "load/load.h"
#include "render/render.h"
#include "scene/scene.h"
#include "whit/whit.h"
#include <stdatomic.h>

struct whit_scene {
    struct scene *scene;
    struct scene_pose pose; /* at time 0, for whit_scene_get_* */
    struct scene_effects effects;
    bool one_tree; /* WHIT_INSTANCES_AUTO makes a single-level tree */
    whit_log log;
};

static inline bool api_one_tree(const struct whit_scene *scene, whit_instances instances)
{
    return instances == WHIT_INSTANCES_OFF || (instances == WHIT_INSTANCES_AUTO && scene->one_tree);
}

/* Hands out `made` behind a handle with pose and effects, and *out = NULL on errors. `result`: of
   making it; after a failure there is no `made`. */
WHIT_CHECK whit_result api_hand_out_scene(const whit_log *log, struct scene *made,
                                          whit_result result, whit_scene **out);

struct whit_accel {
    whit_accel_params params; /* as given to whit_accel_create */
    struct accel *accel;
    whit_log log;
};

struct log_relay; /* device_api.c */

struct whit_device {
    struct device *device;
    whit_log log;
    struct log_relay *relay; /* receiver of `log`, if a thread opened the device; else NULL */
};

struct whit_renderer {
    struct renderer *renderer;   /* NULL: made without a device, traces on the CPU */
    struct accel *accel;         /* borrowed */
    whit_renderer_params params; /* strings in it may be gone, and are not read */
    whit_log log;
};

/* Logs an error and gives `result`, so that it can be returned. It is a macro so that compilers see
   what it gives. */
#define API_FAIL(log, result, ...) (log_error((log), __VA_ARGS__), (result))

/* Gives *params, or the defaults where `params` is NULL. */
whit_renderer_params api_params(const whit_renderer_params *params);

/* WHIT_ERROR_USAGE, logged, for a value that the enumeration does not have. */
WHIT_CHECK whit_result api_check_instances(const whit_log *log, whit_instances instances);
WHIT_CHECK whit_result api_check_numerics(const whit_log *log, whit_numerics numerics);

/* WHIT_ERROR_USAGE, logged, for a renderer that was made without a device. */
WHIT_CHECK whit_result api_need_device(const whit_renderer *renderer);

/* Sets mrays_per_s from the numbers of rays and render_ms. */
void api_set_rate(whit_stats *stats);

struct whit_image {
    struct image image;
    atomic_uint sharers; /* owners besides the first one, see whit_image_share */
};

/* Hands out `made` behind a handle, and *out = NULL on errors. `result`: of making it. On failure
   finishes `made`. WHIT_ERROR_MEMORY, logged, where there is no memory for the handle; `log` may be
   NULL. */
WHIT_CHECK whit_result api_hand_out(const whit_log *log, struct image *made, whit_result result,
                                    whit_image **out);

#endif
