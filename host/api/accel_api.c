#include <stdlib.h>

#include "accel/boxes.h"
#include "accel/validate.h"
#include "api/handles.h"
#include "base/array.h"
#include "scene/pose.h"
#include "twin/report.h"

#ifdef NDEBUG
#define ALWAYS_VALIDATE false
#else
#define ALWAYS_VALIDATE true
#endif

static whit_result check_params(const whit_log *log, const whit_accel_params *params)
{
    if (params->instance_build != WHIT_BUILD_BINNED && params->instance_build != WHIT_BUILD_MEDIAN)
        return API_FAIL(log, WHIT_ERROR_USAGE,
                        "instances: binned and median are the builders there are, not %d",
                        (int)params->instance_build);
    whit_result result = bvh_check(log, params);
    return result == WHIT_OK ? api_check_instances(log, params->instances) : result;
}

whit_result whit_accel_create(const whit_scene *scene, const whit_accel_params *params,
                              whit_accel **out)
{
    const whit_accel_params defaults = {0};
    if (!params)
        params = &defaults;
    *out = NULL;
    whit_result result = check_params(&scene->log, params);
    if (result != WHIT_OK)
        return result;
    whit_accel *accel = calloc(1, sizeof *accel);
    if (!accel)
        return API_FAIL(&scene->log, WHIT_ERROR_MEMORY, "out of memory");
    accel->params = *params;
    accel->log = scene->log;
    whit_accel_params inner = *params;
    inner.instances =
        api_one_tree(scene, params->instances) ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON;
    inner.validate |= ALWAYS_VALIDATE;
    result = accel_create(&scene->log, scene->scene, &inner, &accel->accel);
    if (result == WHIT_OK)
        *out = accel;
    else
        whit_accel_destroy(accel);
    return result;
}

void whit_accel_destroy(whit_accel *accel)
{
    if (!accel)
        return;
    accel_destroy(accel->accel);
    free(accel);
}

/* Number of spheres in the trees: each mesh counts once, or in a single-level tree once per
   instance. */
static uint32_t count_spheres(const struct accel *accel)
{
    const struct scene *scene = accel->scene;
    if (accel->flat)
        return (uint32_t)scene->sphere_total;
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        count += scene->meshes[i].sphere_count;
    return count;
}

void whit_accel_get_info(const whit_accel *handle, whit_accel_info *info)
{
    const struct accel *accel = handle->accel;
    uint32_t spheres = count_spheres(accel);
    *info = (whit_accel_info){
        .node_count = accel->node_count,
        .triangle_count = accel->triangle_count - spheres,
        .sphere_count = spheres,
        .reference_count = accel->record_count,
        .depth = accel->mesh_depth,
        .instance_depth = accel->instance_depth,
        .bytes = accel_bytes(accel),
        .build_ms = accel->build_ms,
        .one_tree = accel->flat,
        .instance_build_ms = accel->instance_build_ms,
        .params = handle->params,
    };
    uint32_t largest = 0;
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        const struct accel_mesh *mesh = &accel->meshes[i];
        for (uint32_t k = 0; k < mesh->node_count; ++k)
            info->leaf_count += bvh_count(&accel->nodes[mesh->first_node + k]) != 0;
        if (mesh->triangle_count > largest) {
            largest = mesh->triangle_count;
            info->sah_cost = mesh->sah_cost;
        }
    }
}

whit_result whit_accel_validate(const whit_accel *handle)
{
    whit_result result = accel_validate(handle->accel);
    return result == WHIT_ERROR_FAILED ? WHIT_ERROR_STATUS : result;
}

whit_result whit_accel_get_report(const whit_accel *handle, whit_accel_report *report)
{
    enum { RAYS = 1 << 15 };
    return accel_report(handle->accel, RAYS, report);
}

/* ---- Boxes ---- */

struct box_list {
    whit_box *boxes;
    uint32_t count, capacity;
    uint64_t max, total;
    bool failed;
};

static bool add_box(void *user, const whit_box *box)
{
    struct box_list *list = user;
    if (list->total++ >= list->max)
        return true;
    list->failed = !ARRAY_PUSH(list->boxes, list->count, list->capacity, *box);
    return !list->failed;
}

whit_result whit_accel_boxes(const whit_accel *accel, double time_s, bool over_instances,
                             uint32_t level, uint64_t max, whit_box **boxes, uint64_t *total)
{
    struct box_list list = {.max = max};
    struct scene_pose pose = {0};
    *boxes = NULL;
    *total = 0;
    whit_result result = scene_pose_init(accel->accel->scene, time_s, &pose);
    if (result == WHIT_OK && accel->accel->scene->channel_count > 0 &&
        accel->accel->posed_s != time_s)
        result =
            API_FAIL(&accel->log, WHIT_ERROR_USAGE, "boxes at %g s: the trees are posed at %g s",
                     time_s, accel->accel->posed_s);
    if (result == WHIT_OK)
        accel_boxes(accel->accel, &pose, over_instances, level, add_box, &list);
    scene_pose_finish(&pose);
    if (list.failed)
        result = API_FAIL(&accel->log, WHIT_ERROR_MEMORY, "out of memory for the boxes of trees");
    if (result != WHIT_OK) {
        free(list.boxes);
        return result;
    }
    *boxes = list.boxes;
    *total = list.total;
    return WHIT_OK;
}
