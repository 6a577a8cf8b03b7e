/* Checks and steps that several functions of the library share. */
#include "api/handles.h"

#include <stdlib.h>

#include "accel/flat_choice.h"
#include "scene/effects.h"
#include "scene/pose.h"

whit_result api_complete_scene(whit_scene *scene, whit_result result, whit_scene **out)
{
    if (result == WHIT_OK)
        result = scene_pose_init(scene->scene, 0.0, &scene->pose);
    if (result == WHIT_OK)
        result = accel_flat_suits(scene->scene, &scene->pose, &scene->one_tree);
    if (result != WHIT_OK) {
        whit_scene_destroy(scene);
        return result;
    }
    scene_effects_scan(scene->scene, false, &scene->effects);
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
    log_error(log, "out of memory");
    return WHIT_ERROR_MEMORY;
}

whit_result api_check_instances(const whit_log *log, whit_instances instances)
{
    if ((unsigned)instances <= WHIT_INSTANCES_OFF)
        return WHIT_OK;
    log_error(log, "instances %d: auto, on and off are what there is", (int)instances);
    return WHIT_ERROR_USAGE;
}

whit_result api_check_numerics(const whit_log *log, whit_numerics numerics)
{
    if ((unsigned)numerics <= WHIT_NUMERICS_EXACT)
        return WHIT_OK;
    log_error(log, "there is no level of numerics %d", (int)numerics);
    return WHIT_ERROR_USAGE;
}

whit_result api_need_device(const whit_renderer *renderer)
{
    if (renderer->renderer)
        return WHIT_OK;
    log_error(&renderer->log, "this renderer was made without a device");
    return WHIT_ERROR_USAGE;
}
