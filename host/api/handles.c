/* Checks and steps that several functions of the library share. */
#include "api/handles.h"

#include <stdlib.h>

#include "accel/flat_choice.h"
#include "scene/effects.h"
#include "scene/pose.h"

whit_result api_hand_out_scene(const whit_log *log, struct scene *made, whit_result result,
                               whit_scene **out)
{
    *out = NULL;
    if (result != WHIT_OK)
        return result;
    whit_scene *scene = calloc(1, sizeof *scene);
    if (!scene) {
        scene_destroy(made);
        return API_FAIL(log, WHIT_ERROR_MEMORY, "out of memory for a scene");
    }
    scene->log = log_or_silence(log);
    scene->scene = made;
    result = scene_pose_init(made, 0.0, &scene->pose);
    if (result == WHIT_OK)
        result = accel_flat_suits(made, &scene->pose, &scene->one_tree);
    if (result != WHIT_OK) {
        whit_scene_destroy(scene);
        return result;
    }
    scene_effects_scan(made, false, &scene->effects);
    *out = scene;
    return WHIT_OK;
}

whit_result api_hand_out(const whit_log *log, struct image *made, whit_result result,
                         whit_image **out)
{
    *out = result == WHIT_OK ? calloc(1, sizeof **out) : NULL;
    if (*out) {
        (*out)->image = *made;
        return WHIT_OK;
    }
    image_finish(made);
    if (result != WHIT_OK)
        return result;
    return API_FAIL(log, WHIT_ERROR_MEMORY, "out of memory");
}

whit_result api_check_instances(const whit_log *log, whit_instances instances)
{
    if ((unsigned)instances <= WHIT_INSTANCES_OFF)
        return WHIT_OK;
    return API_FAIL(log, WHIT_ERROR_USAGE, "instances %d: auto, on and off are what there is",
                    (int)instances);
}

whit_result api_check_numerics(const whit_log *log, whit_numerics numerics)
{
    if ((unsigned)numerics <= WHIT_NUMERICS_EXACT)
        return WHIT_OK;
    return API_FAIL(log, WHIT_ERROR_USAGE, "there is no level of numerics %d", (int)numerics);
}

whit_result api_need_device(const whit_renderer *renderer)
{
    if (renderer->renderer)
        return WHIT_OK;
    return API_FAIL(&renderer->log, WHIT_ERROR_USAGE, "this renderer was made without a device");
}
