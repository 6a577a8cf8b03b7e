/* whit-embree TRIANGLES: Embree's side of `whit bench`, a program of its own, so that whit needs no
   Embree. TRIANGLES, rays and hits are records of `whit scene --triangles` and `whit trace`. It
   answers each line of standard input by one line:

       rays FILE closest|any     `rays COUNT`: loads the rays that the next lines trace
       trace WAY forth|back coherent|scattered
                                 `time CPU_MS WALL_MS`, of all threads; WAY: single, packets or
                                 stream; `none`: this build of Embree lacks it. back: traces from
                                 the end of each ray, which must have one, to its origin. coherent:
                                 tells Embree that neighbouring rays are coherent
       build QUALITY THREADS     `built WALL_MS BYTES`: builds a tree of medium or high quality;
                                 BYTES: peak memory by Embree's own monitor
       hits FILE                 `hits COUNT`: writes the hits of the last trace. Only t, primitive
                                 and instance have a meaning; for any-hit rays only whether there is
                                 a hit

   The first line that it prints is `embree VERSION THREADS`. Errors are printed on standard error,
   and end it with exit code 2. Scenes are ROBUST, of medium quality. */
#include <embree3/rtcore.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "whit/whit.h"

enum { CHUNK = 4096, STREAM = 256, THREADS_MAX = 64, LINE = 4200 };
enum way { WAY_SINGLE, WAY_PACKETS, WAY_STREAM, WAYS };
static const char *const ways[WAYS] = {"single", "packets", "stream"};

struct peer {
    RTCDevice device;
    RTCScene scene;
    whit_triangle *triangles;
    uint64_t triangle_count;
    whit_ray *rays, *turned; /* as in the file; turned: from their ends back */
    whit_hit *hits;
    uint64_t count;
    bool any, wide; /* wide: packets have 16 rays */
    int threads;
    /* The trace that is running: */
    const whit_ray *traced;
    enum way way;
    bool coherent;
    _Atomic uint64_t next;
};

_Noreturn static void WHIT_PRINTF(1, 2) fail(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fputs("whit-embree: ", stderr);
    vfprintf(stderr, format, args);
    fputc('\n', stderr);
    va_end(args);
    exit(2);
}

static double clock_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Reads all records of a file into one block. */
static void *read_records(const char *path, size_t record, uint64_t *count)
{
    struct stat info;
    FILE *from = fopen(path, "rb");
    if (!from || fstat(fileno(from), &info) != 0 || (uint64_t)info.st_size % record != 0)
        fail("%s: cannot read, or no whole number of records", path);
    size_t bytes = (size_t)info.st_size;
    void *records = malloc(bytes ? bytes : 1);
    if (!records || fread(records, 1, bytes, from) != bytes)
        fail("%s: cannot read", path);
    fclose(from);
    *count = bytes / record;
    return records;
}

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
    size_t count = (size_t)peer->triangle_count;
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                               RTC_FORMAT_FLOAT3, 12, 3 * count);
    uint32_t *indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count);
    if (!positions || !indices)
        fail("out of memory");
    for (size_t i = 0; i < count; ++i) {
        memcpy(&positions[9 * i], peer->triangles[i].vertices, sizeof peer->triangles[i].vertices);
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
        fail("Embree cannot build the scene");
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

static void build_anew(const struct peer *peer, const char *quality, int threads)
{
    static struct memory memory;
    bool is_high = strcmp(quality, "high") == 0;
    RTCDevice device = open_device(threads);
    rtcSetDeviceMemoryMonitorFunction(device, on_memory, &memory);
    RTCScene scene =
        make_scene(peer, device, is_high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    int64_t before = memory.now;
    memory.peak = before;
    double wall = clock_of(CLOCK_MONOTONIC);
    rtcCommitScene(scene);
    printf("built %.6f %lld\n", clock_of(CLOCK_MONOTONIC) - wall,
           (long long)(memory.peak - before));
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

/* ---- Rays ---- */

static void load_rays(struct peer *peer, const char *path, bool any)
{
    free(peer->rays);
    free(peer->turned);
    free(peer->hits);
    peer->rays = read_records(path, sizeof *peer->rays, &peer->count);
    peer->turned = malloc((size_t)(peer->count ? peer->count : 1) * sizeof *peer->turned);
    peer->hits = calloc((size_t)(peer->count ? peer->count : 1), sizeof *peer->hits);
    peer->any = any;
    if (!peer->turned || !peer->hits)
        fail("out of memory");
    for (uint64_t i = 0; i < peer->count; ++i) {
        const whit_ray *ray = &peer->rays[i];
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
static void keep_hit(const struct peer *peer, uint64_t i, float t, uint32_t primitive)
{
    whit_hit *hit = &peer->hits[i];
    bool met = peer->any ? t < 0.0f : primitive != RTC_INVALID_GEOMETRY_ID;
    hit->t = met ? t : INFINITY;
    hit->primitive = hit->instance = met ? 0 : WHIT_NONE;
    if (met && !peer->any) {
        hit->primitive = peer->triangles[primitive].primitive;
        hit->instance = peer->triangles[primitive].instance;
    }
}

static void trace_single(const struct peer *peer, struct RTCIntersectContext *context,
                         uint64_t begin, uint64_t end)
{
    for (uint64_t i = begin; i < end; ++i) {
        struct RTCRayHit query = query_of(&peer->traced[i]);
        if (peer->any)
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
            if (peer->any)                                                                         \
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
        if (peer->any)
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
        if (begin >= peer->count)
            return NULL;
        uint64_t end = begin + CHUNK < peer->count ? begin + CHUNK : peer->count;
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

static void trace(struct peer *peer, enum way way, bool back, bool coherent)
{
    pthread_t threads[THREADS_MAX];
    static const enum RTCDeviceProperty needs[WAYS] = {
        [WAY_PACKETS] = RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED,
        [WAY_STREAM] = RTC_DEVICE_PROPERTY_RAY_STREAM_SUPPORTED};
    if (way != WAY_SINGLE && !rtcGetDeviceProperty(peer->device, needs[way])) {
        puts("none");
        return;
    }
    double wall = clock_of(CLOCK_MONOTONIC), cpu = clock_of(CLOCK_PROCESS_CPUTIME_ID);
    peer->way = way;
    peer->coherent = coherent;
    peer->traced = back ? peer->turned : peer->rays;
    atomic_store(&peer->next, 0);
    int started = 0;
    while (started + 1 < peer->threads && pthread_create(&threads[started], NULL, work, peer) == 0)
        ++started;
    work(peer);
    for (int i = 0; i < started; ++i)
        pthread_join(threads[i], NULL);
    printf("time %.6f %.6f\n", clock_of(CLOCK_PROCESS_CPUTIME_ID) - cpu,
           clock_of(CLOCK_MONOTONIC) - wall);
}

static void write_hits(const struct peer *peer, const char *path)
{
    FILE *to = fopen(path, "wb");
    size_t count = (size_t)peer->count;
    if (!to || fwrite(peer->hits, sizeof *peer->hits, count, to) != count || fclose(to) != 0)
        fail("%s: cannot write", path);
    printf("hits %llu\n", (unsigned long long)peer->count);
}

/* ---- Lines ---- */

static void obey(struct peer *peer, char *line)
{
    char *word = strtok(line, " \n"), *argument = strtok(NULL, " \n"), *last = strtok(NULL, " \n"),
         *order = strtok(NULL, " \n");
    if (word && strcmp(word, "rays") == 0 && last) {
        load_rays(peer, argument, strcmp(last, "any") == 0);
        printf("rays %llu\n", (unsigned long long)peer->count);
        return;
    }
    if (word && strcmp(word, "hits") == 0 && argument) {
        write_hits(peer, argument);
        return;
    }
    if (word && strcmp(word, "build") == 0 && last && atoi(last) > 0) {
        build_anew(peer, argument, atoi(last));
        return;
    }
    for (int way = 0; word && strcmp(word, "trace") == 0 && order && way < WAYS; ++way) {
        if (strcmp(argument, ways[way]) == 0) {
            trace(peer, (enum way)way, strcmp(last, "back") == 0, strcmp(order, "coherent") == 0);
            return;
        }
    }
    fail("no such line: %s", word ? word : "");
}

int main(int argc, char **argv)
{
    static struct peer peer;
    char line[LINE];
    if (argc != 2)
        fail("usage: whit-embree TRIANGLES, see `whit bench rays --help`");
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    peer.threads = cores < 1 ? 1 : cores > THREADS_MAX ? THREADS_MAX : (int)cores;
    peer.triangles = read_records(argv[1], sizeof *peer.triangles, &peer.triangle_count);
    if (peer.triangle_count == 0 || peer.triangle_count > UINT32_MAX / 3)
        fail("%s: no triangles, or too many", argv[1]);
    build(&peer);
    printf("embree %s %d\n", RTC_VERSION_STRING, peer.threads);
    while (fflush(stdout) == 0 && fgets(line, sizeof line, stdin))
        obey(&peer, line);
    rtcReleaseScene(peer.scene);
    rtcReleaseDevice(peer.device);
    free(peer.triangles);
    free(peer.rays);
    free(peer.turned);
    free(peer.hits);
    return 0;
}
