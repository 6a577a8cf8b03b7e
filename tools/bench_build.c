/* Building trees, side by side with Embree (LOW, MEDIUM, HIGH) on the same triangles.

       bench_build SCENE|soup:N|terrain:N [--runs N] [--threads A,B,..] [--builders A,B,..]
                   [--leaf N] [--traversal-cost C]

   All instances of a scene are one list of triangles in world space. Builders are named as in `whit
   --build`: median, binned:K, sweep, spatial, each with +opt. Runs are interleaved;
   printed are medians, and the spread as the half-width of the middle half. whit's time is for the
   boxes and the tree over them, Embree's for rtcCommitScene. `peak` is the most memory in use
   during the build, the boxes and what is returned included, by triangle; for Embree as its memory
   monitor tells it. */
#include <float.h>
#include <malloc.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel.h"
#include "base/affine.h"
#include "base/array.h"
#include "base/clock.h"
#include "base/threads.h"
#include "load/load.h"

#ifdef BENCH_EMBREE
#include <embree3/rtcore.h>
#endif

enum { RUNS_MAX = 99, ROWS_MAX = 32, BOX_CHUNK = 16384 };

static void print_message(void *user, whit_log_level level, const char *message)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == WHIT_LOG_ERROR ? "error: " : "", message);
}

static const struct log bench_log = {.fn = print_message, .level = WHIT_LOG_WARNING};

static void fail(const char *what)
{
    fprintf(stderr, "bench_build: %s\n", what);
    exit(2);
}

/* ---- Memory: the linker sends the calls of whit's own code here ---- */

static _Atomic int64_t bytes_now, bytes_peak;

static void bytes_add(int64_t bytes)
{
    int64_t now = atomic_fetch_add(&bytes_now, bytes) + bytes, peak = atomic_load(&bytes_peak);
    while (now > peak && !atomic_compare_exchange_weak(&bytes_peak, &peak, now)) {
    }
}

static void *counted(void *memory)
{
    bytes_add((int64_t)malloc_usable_size(memory));
    return memory;
}

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *memory, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *memory, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *memory);

void *__wrap_malloc(size_t size)
{
    return counted(__real_malloc(size));
}
void *__wrap_calloc(size_t count, size_t size)
{
    return counted(__real_calloc(count, size));
}
void *__wrap_realloc(void *memory, size_t size)
{
    bytes_add(-(int64_t)malloc_usable_size(memory));
    return counted(__real_realloc(memory, size));
}
void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    return counted(__real_aligned_alloc(alignment, size));
}
void __wrap_free(void *memory)
{
    bytes_add(-(int64_t)malloc_usable_size(memory));
    __real_free(memory);
}

/* ---- Triangles ---- */

struct mesh {
    float *positions;  /* 3 a vertex */
    uint32_t *indices; /* 3 a triangle */
    uint32_t vertex_count, triangle_count;
};

static void mesh_alloc(struct mesh *mesh, uint64_t vertices, uint64_t triangles)
{
    if (vertices > UINT32_MAX || triangles > UINT32_MAX / 3)
        fail("too many triangles");
    *mesh = (struct mesh){array_alloc(3 * vertices, sizeof *mesh->positions),
                          array_alloc(3 * triangles, sizeof *mesh->indices), (uint32_t)vertices,
                          (uint32_t)triangles};
    if (!mesh->positions || !mesh->indices)
        fail("out of memory");
}

static float random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (float)(*state >> 40) * 0x1p-24f;
}

/* Small triangles anywhere in a cube. */
static void mesh_soup(struct mesh *mesh, uint32_t count)
{
    mesh_alloc(mesh, 3 * (uint64_t)count, count);
    uint64_t state = 1;
    float size = 1.0f / cbrtf((float)count);
    for (uint32_t i = 0; i < 9 * count; i += 9) {
        float centre[3] = {random_unit(&state), random_unit(&state), random_unit(&state)};
        for (uint32_t k = 0; k < 9; ++k)
            mesh->positions[i + k] = centre[k % 3] + size * (random_unit(&state) - 0.5f);
    }
    for (uint32_t i = 0; i < 3 * count; ++i)
        mesh->indices[i] = i;
}

/* A height field of n x n cells. */
static void mesh_terrain(struct mesh *mesh, uint32_t count)
{
    uint32_t n = (uint32_t)ceil(sqrt(count / 2.0)), side = n + 1;
    mesh_alloc(mesh, (uint64_t)side * side, 2 * (uint64_t)n * n);
    for (uint32_t v = 0; v < side * side; ++v) {
        float x = (float)(v % side) / (float)n, z = (float)(v / side) / (float)n;
        float y = 0.1f * sinf(9.0f * x) * cosf(7.0f * z) + 0.02f * sinf(61.0f * x + 47.0f * z);
        memcpy(&mesh->positions[3 * (size_t)v], (float[3]){x, y, z}, 3 * sizeof(float));
    }
    for (uint32_t c = 0; c < n * n; ++c) {
        uint32_t a = c / n * side + c % n, b = a + side;
        uint32_t *corner = &mesh->indices[6 * (size_t)c];
        memcpy(corner, (uint32_t[6]){a, b, a + 1, a + 1, b, b + 1}, 6 * sizeof *corner);
    }
}

static void mesh_append(struct mesh *mesh, const struct scene_mesh *part, const struct affine *pose)
{
    for (uint32_t v = 0; v < part->vertex_count; ++v) {
        const float *p = &part->positions[3 * (size_t)v];
        double at[3] = {(double)p[0], (double)p[1], (double)p[2]};
        affine_point(pose, at, at);
        for (size_t k = 0; k < 3; ++k)
            mesh->positions[3 * (size_t)(mesh->vertex_count + v) + k] = (float)at[k];
    }
    for (size_t i = 0; i < 3 * (size_t)part->triangle_count; ++i)
        mesh->indices[3 * (size_t)mesh->triangle_count + i] = mesh->vertex_count + part->indices[i];
    mesh->vertex_count += part->vertex_count;
    mesh->triangle_count += part->triangle_count;
}

static void mesh_load(struct mesh *mesh, const char *path)
{
    struct scene *scene;
    struct scene_pose pose;
    if (load_scene(&bench_log, path, NULL, &scene) != WHIT_OK ||
        scene_pose_init(scene, 0.0, &pose) != WHIT_OK)
        exit(2);
    uint64_t vertices = 0, triangles = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        vertices += scene->meshes[scene->instances[i].mesh].vertex_count;
        triangles += scene->meshes[scene->instances[i].mesh].triangle_count;
    }
    mesh_alloc(mesh, vertices, triangles);
    mesh->vertex_count = mesh->triangle_count = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        mesh_append(mesh, &scene->meshes[scene->instances[i].mesh], &pose.instances[i]);
    scene_pose_finish(&pose);
    scene_destroy(scene);
}

static void mesh_make(struct mesh *mesh, const char *what)
{
    if (strncmp(what, "soup:", 5) == 0)
        mesh_soup(mesh, (uint32_t)atoi(what + 5));
    else if (strncmp(what, "terrain:", 8) == 0)
        mesh_terrain(mesh, (uint32_t)atoi(what + 8));
    else
        mesh_load(mesh, what);
    if (mesh->triangle_count == 0)
        fail("no triangles");
}

/* ---- Rows ---- */

struct sample {
    double wall_ms, cpu_ms;
};

struct row {
    char name[32];
    struct bvh_params params;
    int embree_quality; /* -1: a row of whit */
    struct sample runs[RUNS_MAX];
    double bytes, sah_cost;
    uint32_t nodes, depth, references;
    bool failed;
};

struct bench {
    struct mesh mesh;
    struct bvh_triangles triangles;
    struct row rows[ROWS_MAX];
    uint32_t row_count;
    int runs;
    uint32_t threads;
#ifdef BENCH_EMBREE
    RTCDevice device;
#endif
};

static bool builder_parse(const char *text, struct bvh_params *params)
{
    char name[32];
    snprintf(name, sizeof name, "%s", text);
    char *plus = strchr(name, '+');
    if (plus) {
        params->optimize = strcmp(plus, "+opt") == 0;
        *plus = '\0';
    }
    char *colon = strchr(name, ':');
    if (colon) {
        params->bins = (uint32_t)atoi(colon + 1);
        *colon = '\0';
    }
    static const struct {
        const char *name;
        enum bvh_builder builder;
    } names[] = {{"binned", BVH_BINNED},
                 {"median", BVH_MEDIAN},
                 {"sweep", BVH_SWEEP},
                 {"spatial", BVH_SPATIAL}};
    for (size_t i = 0; i < sizeof names / sizeof *names; ++i) {
        if (strcmp(name, names[i].name) == 0) {
            params->builder = names[i].builder;
            return !plus || params->optimize;
        }
    }
    return false;
}

static void rows_add(struct bench *bench, char *list, const struct bvh_params *common)
{
    for (char *name = strtok(list, ","); name; name = strtok(NULL, ",")) {
        struct row row = {.params = *common, .embree_quality = -1};
        if (bench->row_count == ROWS_MAX || !builder_parse(name, &row.params))
            fail("unknown builder, or too many");
        snprintf(row.name, sizeof row.name, "%s", name);
        bench->rows[bench->row_count++] = row;
    }
}

/* ---- One build ---- */

struct box_context {
    const struct mesh *mesh;
    struct bvh_box *boxes;
};

static void make_boxes(void *user, uint32_t index)
{
    const struct box_context *context = user;
    const struct mesh *mesh = context->mesh;
    uint32_t end = (index + 1) * BOX_CHUNK;
    end = end < mesh->triangle_count ? end : mesh->triangle_count;
    for (uint32_t i = index * BOX_CHUNK; i < end; ++i) {
        const uint32_t *corner = &mesh->indices[3 * (size_t)i];
        const float *a = &mesh->positions[3 * (size_t)corner[0]];
        const float *b = &mesh->positions[3 * (size_t)corner[1]];
        const float *c = &mesh->positions[3 * (size_t)corner[2]];
        for (int k = 0; k < 3; ++k) {
            float lo = a[k] < b[k] ? a[k] : b[k], hi = a[k] > b[k] ? a[k] : b[k];
            context->boxes[i].lo[k] = c[k] < lo ? c[k] : lo;
            context->boxes[i].hi[k] = c[k] > hi ? c[k] : hi;
        }
    }
}

static void build_whit(const struct bench *bench, struct row *row)
{
    uint32_t count = bench->mesh.triangle_count;
    struct bvh_params params = row->params;
    params.thread_count = bench->threads;
    params.triangles = &bench->triangles;
    int64_t before = atomic_load(&bytes_now);
    atomic_store(&bytes_peak, before);
    struct bvh_box *boxes = array_alloc(count, sizeof *boxes);
    if (!boxes)
        fail("out of memory");
    struct box_context context = {&bench->mesh, boxes};
    threads_for(bench->threads, (count - 1) / BOX_CHUNK + 1, make_boxes, &context);
    struct bvh bvh;
    row->failed = bvh_build(&bench_log, boxes, count, &params, &bvh) != WHIT_OK;
    free(boxes);
    row->bytes = (double)(atomic_load(&bytes_peak) - before) / count;
    if (row->failed)
        return;
    row->sah_cost = bvh.sah_cost;
    row->nodes = bvh.node_count;
    row->depth = bvh.depth;
    row->references = bvh.reference_count;
    bvh_finish(&bvh);
}

#ifdef BENCH_EMBREE
static bool embree_memory(void *user, ssize_t bytes, bool post)
{
    (void)user, (void)post;
    bytes_add(bytes);
    return true;
}

static RTCScene embree_scene(const struct bench *bench, int quality)
{
    const struct mesh *mesh = &bench->mesh;
    RTCScene scene = rtcNewScene(bench->device);
    rtcSetSceneBuildQuality(scene, (enum RTCBuildQuality)quality);
    RTCGeometry geometry = rtcNewGeometry(bench->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                               RTC_FORMAT_FLOAT3, 12, mesh->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 12, mesh->triangle_count);
    if (!positions || !indices)
        fail("out of memory");
    memcpy(positions, mesh->positions, 12 * (size_t)mesh->vertex_count);
    memcpy(indices, mesh->indices, 12 * (size_t)mesh->triangle_count);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    return scene;
}
#endif

static struct sample row_run(struct bench *bench, struct row *row)
{
#ifdef BENCH_EMBREE
    if (row->embree_quality >= 0) {
        RTCScene scene = embree_scene(bench, row->embree_quality);
        int64_t before = atomic_load(&bytes_now);
        atomic_store(&bytes_peak, before);
        double wall = clock_ms(), cpu = clock_cpu_ms();
        rtcCommitScene(scene);
        struct sample sample = {clock_ms() - wall, clock_cpu_ms() - cpu};
        row->bytes = (double)(atomic_load(&bytes_peak) - before) / bench->mesh.triangle_count;
        rtcReleaseScene(scene);
        return sample;
    }
#endif
    double wall = clock_ms(), cpu = clock_cpu_ms();
    build_whit(bench, row);
    return (struct sample){clock_ms() - wall, clock_cpu_ms() - cpu};
}

/* ---- The table ---- */

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double middle(const struct row *row, int runs, bool cpu, double *spread)
{
    double values[RUNS_MAX];
    for (int i = 0; i < runs; ++i)
        values[i] = cpu ? row->runs[i].cpu_ms : row->runs[i].wall_ms;
    qsort(values, (size_t)runs, sizeof *values, compare_doubles);
    *spread = 0.5 * (values[3 * runs / 4] - values[runs / 4]);
    return values[runs / 2];
}

static void row_print(const struct bench *bench, const struct row *row)
{
    double spread;
    printf("%-18s %2u ", row->name, bench->threads);
    if (row->failed) {
        printf("no tree\n");
        return;
    }
    double wall = middle(row, bench->runs, false, &spread);
    printf("%9.2f +- %6.2f", wall, spread);
    double cpu = middle(row, bench->runs, true, &spread);
    printf(" %9.2f +- %6.2f %7.1f", cpu, spread, row->bytes);
    if (row->embree_quality < 0)
        printf(" %9.3f %9u %4u %9u", row->sah_cost, row->nodes, row->depth, row->references);
    printf("\n");
}

static void bench_run(struct bench *bench)
{
#ifdef BENCH_EMBREE
    char config[64];
    snprintf(config, sizeof config, "threads=%u", bench->threads);
    bench->device = rtcNewDevice(config);
    rtcSetDeviceMemoryMonitorFunction(bench->device, embree_memory, NULL);
#endif
    for (int run = -1; run < bench->runs; ++run) { /* -1: warm-up */
        for (uint32_t r = 0; r < bench->row_count; ++r) {
            struct row *row = &bench->rows[r];
            if (run < 0 || !row->failed)
                row->runs[run < 0 ? 0 : run] = row_run(bench, row);
        }
    }
    for (uint32_t r = 0; r < bench->row_count; ++r)
        row_print(bench, &bench->rows[r]);
#ifdef BENCH_EMBREE
    rtcReleaseDevice(bench->device);
#endif
}

int main(int argc, char **argv)
{
    static struct bench bench = {.runs = 7};
    struct bvh_params common = {0};
    const char *path = NULL;
    char threads[64] = "1,2";
    char builders[512] = "binned:7,binned:16,binned:32,median,sweep,spatial,binned:16+opt";
    bool peer = true;
    for (int i = 1; i < argc; ++i) {
        bool more = i + 1 < argc;
        if (strcmp(argv[i], "--runs") == 0 && more)
            bench.runs = atoi(argv[++i]);
        else if (strcmp(argv[i], "--threads") == 0 && more)
            snprintf(threads, sizeof threads, "%s", argv[++i]);
        else if (strcmp(argv[i], "--builders") == 0 && more)
            snprintf(builders, sizeof builders, "%s", argv[++i]);
        else if (strcmp(argv[i], "--leaf") == 0 && more)
            common.leaf_limit = (uint32_t)atoi(argv[++i]);
        else if (strcmp(argv[i], "--traversal-cost") == 0 && more)
            common.traversal_cost = (float)atof(argv[++i]);
        else if (strcmp(argv[i], "--no-embree") == 0)
            peer = false;
        else
            path = argv[i];
    }
    if (!path || bench.runs < 1 || bench.runs > RUNS_MAX)
        fail("usage: bench_build SCENE|soup:N|terrain:N [--runs N] [--threads A,B] "
             "[--builders A,B] [--leaf N] [--traversal-cost C] [--no-embree]");
    mesh_make(&bench.mesh, path);
    bench.triangles = (struct bvh_triangles){bench.mesh.positions, bench.mesh.indices, NULL};
    rows_add(&bench, builders, &common);
#ifdef BENCH_EMBREE
    static const char *const qualities[] = {"Embree LOW", "Embree MEDIUM", "Embree HIGH"};
    for (int q = 0; peer && q < 3 && bench.row_count < ROWS_MAX; ++q) {
        struct row *row = &bench.rows[bench.row_count++];
        row->embree_quality = q;
        snprintf(row->name, sizeof row->name, "%s", qualities[q]);
    }
#else
    if (peer)
        printf("Embree is not installed: skipped\n");
#endif
    printf("%s: %u triangles; %d runs\n", path, bench.mesh.triangle_count, bench.runs);
    printf("%-18s th   wall ms            CPU ms            peak B/tri   SAH      nodes depth "
           "references\n",
           "");
    for (char *one = strtok(threads, ","); one; one = strtok(NULL, ",")) {
        bench.threads = (uint32_t)atoi(one);
        if (bench.threads < 1)
            fail("threads are counted from 1");
        bench_run(&bench);
    }
    free(bench.mesh.positions);
    free(bench.mesh.indices);
    return 0;
}
