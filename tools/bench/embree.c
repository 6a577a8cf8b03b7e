/* whit-embree TRIANGLES: Embree's side of `whit bench` (peer_side.h), a program of its own, so that
   whit needs no Embree. Ways to trace: single, packets or stream. Scenes are ROBUST, of medium
   quality. */
#include <embree3/rtcore.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench/peer_side.h"

enum { CHUNK = 4096, STREAM = 256, THREADS_MAX = 64 };
enum way { WAY_SINGLE, WAY_PACKETS, WAY_STREAM, WAYS };
static const char *const ways[WAYS] = {"single", "packets", "stream"};

struct peer {
    struct peer_side side;
    RTCDevice device;
    RTCScene scene;
    whit_ray *turned; /* the rays from their ends back */
    bool wide;        /* packets have 16 rays */
    int threads;
    /* The trace that is running: */
    const whit_ray *traced;
    enum way way;
    bool coherent;
    _Atomic uint64_t next;
};

/* ---- The scene ---- */

static RTCDevice open_device(int threads)
{
    char config[32];
    snprintf(config, sizeof config, "threads=%d", threads);
    return rtcNewDevice(config);
}

/* Makes a scene of all triangles, not committed yet. */
static RTCScene make_scene(const struct peer *peer, RTCDevice device, enum RTCBuildQuality quality)
{
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    size_t count = (size_t)peer->side.triangle_count;
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                               RTC_FORMAT_FLOAT3, 12, 3 * count);
    uint32_t *indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count);
    if (!positions || !indices)
        peer_fail(&peer->side, "out of memory");
    for (size_t i = 0; i < count; ++i) {
        memcpy(&positions[9 * i], peer->side.triangles[i].vertices, 9 * sizeof *positions);
        for (size_t k = 0; k < 3; ++k)
            indices[3 * i + k] = (uint32_t)(3 * i + k);
    }
    rtcSetSceneBuildQuality(scene, quality);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    return scene;
}

static void build(struct peer *peer)
{
    peer->device = open_device(peer->threads);
    peer->wide =
        rtcGetDeviceProperty(peer->device, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
    peer->scene = make_scene(peer, peer->device, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(peer->scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(peer->scene);
    if (rtcGetDeviceError(peer->device) != RTC_ERROR_NONE)
        peer_fail(&peer->side, "Embree cannot build the scene");
}

/* Memory of a build, counted by Embree's monitor, which is called from its threads. */
struct memory {
    _Atomic int64_t now, peak;
};

static bool on_memory(void *user, ssize_t bytes, bool post)
{
    struct memory *memory = user;
    int64_t now = atomic_fetch_add(&memory->now, bytes) + bytes, peak = memory->peak;
    (void)post;
    while (now > peak && !atomic_compare_exchange_weak(&memory->peak, &peak, now))
        ;
    return true;
}

static void build_anew(void *user, const char *quality, int threads, double *ms, double *bytes)
{
    static struct memory memory;
    const struct peer *peer = user;
    bool is_high = strcmp(quality, "high") == 0;
    RTCDevice device = open_device(threads);
    rtcSetDeviceMemoryMonitorFunction(device, on_memory, &memory);
    RTCScene scene =
        make_scene(peer, device, is_high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    int64_t before = memory.now;
    memory.peak = before;
    double wall = peer_wall_ms();
    rtcCommitScene(scene);
    *ms = peer_wall_ms() - wall;
    *bytes = (double)(memory.peak - before);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

/* ---- Rays ---- */

static void turn_rays(void *user)
{
    struct peer *peer = user;
    free(peer->turned);
    peer->turned = peer_alloc(&peer->side, peer->side.count, sizeof *peer->turned);
    for (uint64_t i = 0; i < peer->side.count; ++i) {
        const whit_ray *ray = &peer->side.rays[i];
        whit_ray *to = &peer->turned[i];
        *to = (whit_ray){.t_min = 1.0f - ray->t_max, .t_max = 1.0f - ray->t_min};
        for (int k = 0; k < 3; ++k) {
            to->origin[k] = ray->origin[k] + ray->dir[k];
            to->dir[k] = -ray->dir[k];
        }
    }
}

static struct RTCRayHit query_of(const whit_ray *ray)
{
    return (struct RTCRayHit){
        .ray = {.org_x = ray->origin[0],
                .org_y = ray->origin[1],
                .org_z = ray->origin[2],
                .tnear = ray->t_min,
                .dir_x = ray->dir[0],
                .dir_y = ray->dir[1],
                .dir_z = ray->dir[2],
                .tfar = ray->t_max,
                .mask = UINT32_MAX},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .primID = RTC_INVALID_GEOMETRY_ID}};
}

/* For any-hit queries Embree marks a hit by a negative tfar. */
static void keep_hit(const struct peer *peer, uint64_t i, float t, uint32_t triangle)
{
    _Static_assert((uint32_t)RTC_INVALID_GEOMETRY_ID == WHIT_NONE, "both are the largest number");
    peer_keep_hit(&peer->side, i, t, !peer->side.any ? triangle : t < 0.0f ? 0 : WHIT_NONE);
}

static void trace_single(const struct peer *peer, struct RTCIntersectContext *context,
                         uint64_t begin, uint64_t end)
{
    for (uint64_t i = begin; i < end; ++i) {
        struct RTCRayHit query = query_of(&peer->traced[i]);
        if (peer->side.any)
            rtcOccluded1(peer->scene, context, &query.ray);
        else
            rtcIntersect1(peer->scene, context, &query);
        keep_hit(peer, i, query.ray.tfar, query.hit.primID);
    }
}

/* In packets of N rays, as wide as the processor's registers. */
#define TRACE_PACKETS(N)                                                                           \
    static void trace_packets_##N(const struct peer *peer, struct RTCIntersectContext *context,    \
                                  uint64_t begin, uint64_t end)                                    \
    {                                                                                              \
        for (uint64_t first = begin; first < end; first += N) {                                    \
            struct RTCRayHit##N query;                                                             \
            _Alignas(64) int valid[N];                                                             \
            for (uint32_t k = 0; k < N; ++k) {                                                     \
                valid[k] = first + k < end ? -1 : 0;                                               \
                const whit_ray *ray = &peer->traced[first + k < end ? first + k : first];          \
                query.ray.org_x[k] = ray->origin[0], query.ray.org_y[k] = ray->origin[1];          \
                query.ray.org_z[k] = ray->origin[2], query.ray.tnear[k] = ray->t_min;              \
                query.ray.dir_x[k] = ray->dir[0], query.ray.dir_y[k] = ray->dir[1];                \
                query.ray.dir_z[k] = ray->dir[2], query.ray.tfar[k] = ray->t_max;                  \
                query.ray.time[k] = 0.0f, query.ray.mask[k] = UINT32_MAX;                          \
                query.ray.id[k] = query.ray.flags[k] = 0;                                          \
                query.hit.geomID[k] = query.hit.primID[k] = RTC_INVALID_GEOMETRY_ID;               \
                query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;                                  \
            }                                                                                      \
            if (peer->side.any)                                                                    \
                rtcOccluded##N(valid, peer->scene, context, &query.ray);                           \
            else                                                                                   \
                rtcIntersect##N(valid, peer->scene, context, &query);                              \
            for (uint32_t k = 0; k < N && first + k < end; ++k)                                    \
                keep_hit(peer, first + k, query.ray.tfar[k], query.hit.primID[k]);                 \
        }                                                                                          \
    }
TRACE_PACKETS(8)
TRACE_PACKETS(16)

static void trace_stream(const struct peer *peer, struct RTCIntersectContext *context,
                         uint64_t begin, uint64_t end)
{
    struct RTCRayHit queries[STREAM];
    for (uint64_t first = begin; first < end; first += STREAM) {
        uint32_t count = (uint32_t)(end - first < STREAM ? end - first : STREAM);
        for (uint32_t k = 0; k < count; ++k)
            queries[k] = query_of(&peer->traced[first + k]);
        if (peer->side.any)
            rtcOccluded1M(peer->scene, context, &queries[0].ray, count, sizeof queries[0]);
        else
            rtcIntersect1M(peer->scene, context, queries, count, sizeof queries[0]);
        for (uint32_t k = 0; k < count; ++k)
            keep_hit(peer, first + k, queries[k].ray.tfar, queries[k].hit.primID);
    }
}

static void *work(void *user)
{
    struct peer *peer = user;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (peer->coherent)
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    for (;;) {
        uint64_t begin = atomic_fetch_add(&peer->next, CHUNK);
        if (begin >= peer->side.count)
            return NULL;
        uint64_t end = begin + CHUNK < peer->side.count ? begin + CHUNK : peer->side.count;
        if (peer->way == WAY_SINGLE)
            trace_single(peer, &context, begin, end);
        else if (peer->way == WAY_PACKETS && peer->wide)
            trace_packets_16(peer, &context, begin, end);
        else if (peer->way == WAY_PACKETS)
            trace_packets_8(peer, &context, begin, end);
        else
            trace_stream(peer, &context, begin, end);
    }
}

static bool trace(void *user, const char *name, bool back, bool coherent, double ms[2])
{
    static const enum RTCDeviceProperty needs[WAYS] = {
        [WAY_PACKETS] = RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED,
        [WAY_STREAM] = RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED};
    struct peer *peer = user;
    pthread_t threads[THREADS_MAX];
    int way = 0, started = 0;
    while (way < WAYS && strcmp(name, ways[way]) != 0)
        ++way;
    if (way == WAYS)
        peer_fail(&peer->side, "no such way to trace: %s", name);
    if (way != WAY_SINGLE && !rtcGetDeviceProperty(peer->device, needs[way]))
        return false;
    double wall = peer_wall_ms(), cpu = peer_cpu_ms();
    peer->way = (enum way)way;
    peer->coherent = coherent;
    peer->traced = back ? peer->turned : peer->side.rays;
    atomic_store(&peer->next, 0);
    while (started + 1 < peer->threads && pthread_create(&threads[started], NULL, work, peer) == 0)
        ++started;
    work(peer);
    for (int i = 0; i < started; ++i)
        pthread_join(threads[i], NULL);
    ms[0] = peer_cpu_ms() - cpu;
    ms[1] = peer_wall_ms() - wall;
    return true;
}

int main(int argc, char **argv)
{
    static struct peer peer = {
        .side = {.name = "whit-embree", .load = turn_rays, .trace = trace, .build = build_anew}};
    peer.side.user = &peer;
    if (argc != 2)
        peer_fail(&peer.side, "usage: whit-embree TRIANGLES, see `whit bench rays --help`");
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    peer.threads = cores < 1 ? 1 : cores > THREADS_MAX ? THREADS_MAX : (int)cores;
    peer_read_triangles(&peer.side, argv[1]);
    build(&peer);
    peer_serve(&peer.side, RTC_VERSION_STRING);
    rtcReleaseScene(peer.scene);
    rtcReleaseDevice(peer.device);
    free(peer.turned);
    return 0;
}
