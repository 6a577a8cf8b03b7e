/* Finds pictures that would be the same whatever goes wrong; they are not accepted into a
   golden. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "app/check/describe.h"
#include "base/array.h"

/* Whether all pixels are equal: for colours as displayed, because people do not see differences
   that only floats have; for counts and aovs of a shader by their numbers. */
static bool has_one_color(const struct drawing *drawing, bool *one)
{
    whit_image_info info;
    whit_image_get_info(drawing->color, &info);
    size_t count = (size_t)info.width * info.height;
    const struct settings *settings = &drawing->job.settings;
    bool shown = info.channels == 4 && !settings->aov[0];
    uint8_t *bytes = shown ? array_alloc(count, 4) : NULL;
    if (shown && !bytes)
        return false;
    if (shown)
        whit_image_display_bytes(drawing->color, bytes);
    const uint8_t *first = shown ? bytes : (const uint8_t *)whit_image_floats(drawing->color);
    size_t pixel_bytes = shown ? 4 : info.channels * sizeof(float);
    *one = memcmp(first, first + pixel_bytes, (count - 1) * pixel_bytes) == 0;
    free(bytes);
    return true;
}

/* The camera of the picture at time 0. False: it is a panorama. */
static bool find_camera(const struct drawing *drawing, double eye[3], double target[3])
{
    const whit_camera *camera = &drawing->params.camera;
    whit_scene_info scene;
    whit_camera_info info;
    whit_scene_get_info(drawing->job.scene, &scene);
    if (camera->own) {
        memcpy(eye, camera->eye, sizeof info.eye);
        memcpy(target, camera->target, sizeof info.target);
        return true;
    }
    uint32_t index = 0;
    for (uint32_t i = 0; camera->name && i < scene.camera_count; ++i) {
        whit_scene_get_camera(drawing->job.scene, i, &info);
        if (strcmp(info.name, camera->name) == 0) {
            index = i;
            break;
        }
        if (isdigit((unsigned char)camera->name[0]))
            index = (uint32_t)strtoul(camera->name, NULL, 10);
    }
    whit_scene_get_camera(drawing->job.scene, index, &info);
    memcpy(eye, info.eye, sizeof info.eye);
    memcpy(target, info.target, sizeof info.target);
    return info.kind != WHIT_CAMERA_PANORAMA;
}

/* Whether the scene's objects, without a floor, all lie behind the camera's plane, where no mirror
   or glass shows them. False where this is not known: in an animated scene at another time than 0,
   and where a user's functions aim rays or add a shape. */
static bool is_behind(const struct drawing *drawing)
{
    const uint32_t aiming = 1u << WHIT_HOOK_CAMERA | 1u << WHIT_HOOK_INTERSECT;
    bool functions = (job_shader_info(drawing->job.shader).hooks & aiming) ||
                     drawing->stats.rays_by_functions > 0;
    double eye[3], target[3];
    whit_scene_info scene;
    whit_scene_get_info(drawing->job.scene, &scene);
    bool moves = scene.channel_count > 0 && drawing->params.time_s != 0.0;
    bool turned = drawing->stats.rays_reflected > 0 || drawing->stats.rays_refracted > 0;
    if (moves || turned || functions || scene.objects_lo[0] > scene.objects_hi[0] ||
        !find_camera(drawing, eye, target))
        return false;
    for (int corner = 0; corner < 8; ++corner) {
        double along = 0.0;
        for (int k = 0; k < 3; ++k) {
            double at = corner >> k & 1 ? scene.objects_hi[k] : scene.objects_lo[k];
            along += (at - eye[k]) * (target[k] - eye[k]);
        }
        if (along > 0.0)
            return false;
    }
    return true;
}

whit_result drawing_refuse(const struct drawing *drawing, const char **why)
{
    bool one_color;
    *why = NULL;
    if (!has_one_color(drawing, &one_color))
        return cli_no_memory();
    if (is_behind(drawing))
        *why = "the model is behind the camera";
    else if (drawing_count_hits(drawing) == 0)
        *why = "no pixel hits anything";
    else if (one_color)
        *why = "every pixel has the same colour";
    return WHIT_OK;
}
