/* What is behind the public handles; only api/ sees it. */
#ifndef API_HANDLES_H
#define API_HANDLES_H

#include "accel/accel.h"
#include "base/file.h"
#include "device/device.h"
#include "image/image.h"
#include "load/load.h"
#include "render/render.h"
#include "scene/scene.h"
#include "whit/whit.h"

struct whit_scene {
    struct scene *scene;
    struct scene_pose pose; /* at time 0, for descriptions */
    struct scene_effects effects;
    bool one_tree; /* by WHIT_INSTANCES_AUTO */
    whit_log log;
};

static inline bool api_one_tree(const struct whit_scene *scene, whit_instances instances)
{
    return instances == WHIT_INSTANCES_OFF || (instances == WHIT_INSTANCES_AUTO && scene->one_tree);
}

/* Derives the pose and the choice of trees of a scene that was made. After a failure
   the scene is destroyed. */
WHIT_CHECK whit_result api_complete_scene(whit_scene *scene, whit_result result, whit_scene **out);

struct whit_accel {
    whit_accel_params params; /* that it was made with */
    struct accel *accel;
    whit_log log;
};

struct log_relay; /* device_api.c */

struct whit_device {
    struct device *device;
    whit_log log;
    struct log_relay *relay; /* behind `log` of a device that a thread opened; else NULL */
};

struct whit_renderer {
    struct renderer *renderer;   /* NULL: CPU only */
    struct accel *accel;         /* borrowed */
    whit_renderer_params params; /* of the picture; its strings are not read again */
    whit_log log;
};

/* WHIT_ERROR_USAGE, logged, for a renderer that was made without one. */
WHIT_CHECK whit_result api_need_device(const whit_renderer *renderer);

struct whit_image {
    struct image image;
};

struct whit_file {
    struct file_write write;
    whit_log log;
};

#endif
