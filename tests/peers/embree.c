/* Embree's answers, one ray at a time. */
#include <stdlib.h>
#include <string.h>

#include "peers.h"

#ifndef PEERS_EMBREE

struct embree *embree_create(const struct scene *scene, const struct scene_pose *pose, bool robust)
{
    (void)scene;
    (void)pose;
    (void)robust;
    return NULL;
}

void embree_destroy(struct embree *embree)
{
    (void)embree;
}

void embree_trace(const struct embree *embree, const struct gpu_ray *ray, struct gpu_hit *hit)
{
    (void)embree;
    (void)ray;
    (void)hit;
}

#else

#include <embree3/rtcore.h>

struct embree {
    RTCDevice device;
    RTCScene scene;
};

static bool add_instance(const struct embree *embree, const struct scene_mesh *mesh,
                         const struct affine *matrix, uint32_t id)
{
    if (mesh->triangle_count == 0)
        return true;
    RTCGeometry geometry = rtcNewGeometry(embree->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                               RTC_FORMAT_FLOAT3, 12, mesh->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 12, mesh->triangle_count);
    bool made = positions && indices;
    for (uint32_t v = 0; made && v < mesh->vertex_count; ++v) {
        const float *p = &mesh->positions[3 * (size_t)v];
        double at[3] = {(double)p[0], (double)p[1], (double)p[2]};
        affine_point(matrix, at, at);
        for (size_t k = 0; k < 3; ++k)
            positions[3 * (size_t)v + k] = (float)at[k];
    }
    if (made)
        memcpy(indices, mesh->indices, 12 * (size_t)mesh->triangle_count);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(embree->scene, geometry, id);
    rtcReleaseGeometry(geometry);
    return made;
}

struct embree *embree_create(const struct scene *scene, const struct scene_pose *pose, bool robust)
{
    struct embree *embree = calloc(1, sizeof *embree);
    if (!embree)
        return NULL;
    embree->device = rtcNewDevice("threads=2");
    embree->scene = rtcNewScene(embree->device);
    if (robust)
        rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST);
    bool made = true;
    for (uint32_t i = 0; made && i < scene->instance_count; ++i)
        made =
            add_instance(embree, &scene->meshes[scene->instances[i].mesh], &pose->instances[i], i);
    rtcCommitScene(embree->scene);
    if (!made || rtcGetDeviceError(embree->device) != RTC_ERROR_NONE) {
        embree_destroy(embree);
        return NULL;
    }
    return embree;
}

void embree_destroy(struct embree *embree)
{
    if (!embree)
        return;
    rtcReleaseScene(embree->scene);
    rtcReleaseDevice(embree->device);
    free(embree);
}

void embree_trace(const struct embree *embree, const struct gpu_ray *ray, struct gpu_hit *hit)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit query = {
        .ray = {.org_x = ray->origin[0],
                .org_y = ray->origin[1],
                .org_z = ray->origin[2],
                .tnear = ray->t_min,
                .dir_x = ray->dir[0],
                .dir_y = ray->dir[1],
                .dir_z = ray->dir[2],
                .tfar = ray->t_max,
                .mask = 0xffffffffu},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .primID = RTC_INVALID_GEOMETRY_ID}};
    rtcIntersect1(embree->scene, &context, &query);
    hit->t = query.ray.tfar;
    hit->primitive = query.hit.primID;
    hit->instance = query.hit.geomID;
}

#endif
