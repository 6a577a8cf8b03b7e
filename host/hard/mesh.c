/* The meshes of the hard cases. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/pose.h"
#include "base/array.h"
#include "hard/mesh.h"
#include "scene/pose.h"

static const struct hard_case cases[] = {
    {"sphere from inside", HARD_SPHERE, HARD_AIMED, 0, 1, false, false},
    {"sphere from inside", HARD_SPHERE, HARD_AIMED, 1e3, 1, false, false},
    {"sphere from inside", HARD_SPHERE, HARD_AIMED, 1e5, 2, false, false},
    {"sphere from inside", HARD_SPHERE, HARD_AIMED, 1e7, 128, false, false},
    {"spikes from inside", HARD_SPIKES, HARD_AIMED, 0, 1, false, false},
    {"spikes from inside", HARD_SPIKES, HARD_AIMED, 1e3, 1, false, false},
    {"spikes from inside", HARD_SPIKES, HARD_AIMED, 1e5, 2, false, false},
    {"slivers from inside", HARD_SLIVERS, HARD_AIMED, 0, 1, false, false},
    {"unwelded sphere", HARD_UNWELDED, HARD_AIMED, 0, 1, false, false},
    {"unwelded sphere", HARD_UNWELDED, HARD_AIMED, 1e3, 1, false, false},
    {"turned instance", HARD_SPHERE, HARD_AIMED, 1e3, 1, true, false},
    {"turned instance", HARD_SPHERE, HARD_AIMED, 1e5, 2, true, false},
    {"grid, rays upright", HARD_GRID, HARD_LATTICE, 0, 1, false, false},
    {"grid, rays upright", HARD_GRID, HARD_LATTICE, 1e3, 1, false, false},
    {"grid, rays upright", HARD_GRID, HARD_LATTICE, 1e5, 1, false, false},
    {"flat boxes, axial rays", HARD_CUBE, HARD_CROSS, 0, 1, false, false},
    {"flat boxes, axial rays", HARD_CUBE, HARD_CROSS, 1e3, 1, false, false},
    {"flat boxes, axial rays", HARD_CUBE, HARD_CROSS, 1e5, 1, false, false},
    {"flat boxes, axial rays", HARD_CUBE, HARD_CROSS, 1e7, 8, false, false},
    {"rays in planes of faces", HARD_CUBE, HARD_FLAT, 0, 1, false, false},
    {"rays in planes of faces", HARD_CUBE, HARD_FLAT, 1e5, 1, false, false},
    {"grazing rays", HARD_SPHERE, HARD_GRAZING, 0, 1, false, false},
    {"grazing rays", HARD_SPHERE, HARD_GRAZING, 1e3, 1, false, false},
    {"rays from far away", HARD_SPHERE, HARD_FAR, 0, 1, false, false},
    {"sphere from around", HARD_SPHERE, HARD_AROUND, 0, 1, false, false},
    {"sphere from around", HARD_SPHERE, HARD_AROUND, 1e5, 2, false, false},
    {"needles", HARD_NEEDLES, HARD_AROUND, 0, 1, false, false},
    {"triangles of all sizes", HARD_SIZES, HARD_AROUND, 0, 1, false, false},
    {"25 equal triangles", HARD_DUPLICATES, HARD_AROUND, 0, 1, false, false},
    {"T-junction", HARD_JUNCTION, HARD_AROUND, 0, 1, false, true},
    {"known reports", HARD_ANCHORS, HARD_LISTED, 0, 1, false, false},
    {"leaving the surface", HARD_OCTAHEDRON, HARD_LEAVING, 0, 1, false, false},
    {"leaving the surface", HARD_OCTAHEDRON, HARD_LEAVING, 1e3, 1, false, false},
    {"leaving the surface", HARD_OCTAHEDRON, HARD_LEAVING, 1e5, 1, false, false},
    {"leaving the surface", HARD_OCTAHEDRON, HARD_LEAVING, 1e7, 8, false, false},
};

const struct hard_case *hard_cases(uint32_t *count)
{
    *count = sizeof cases / sizeof *cases;
    return cases;
}

/* ---- Triangles one by one ---- */

struct maker {
    const struct hard_case *hard;
    float *positions; /* 9 per triangle */
    uint32_t count, capacity;
    bool failed;
};

static void put(struct maker *maker, const double a[3], const double b[3], const double c[3])
{
    const double *corners[3] = {a, b, c};
    const struct hard_case *hard = maker->hard;
    if (maker->failed || maker->count == maker->capacity) {
        maker->failed = true;
        return;
    }
    float *p = &maker->positions[9 * (size_t)maker->count++];
    for (int i = 0; i < 9; ++i) {
        double offset = i % 3 == 1 ? -hard->offset : hard->offset;
        p[i] = (float)(corners[i / 3][i % 3] * hard->scale + (hard->instanced ? 0.0 : offset));
    }
}

/* A pseudo-random number of 8 bits that depends only on the lattice point. */
static uint32_t lattice_bits(const int p[3])
{
    uint32_t mixed = 0;
    for (int k = 0; k < 3; ++k)
        mixed = (mixed ^ (uint32_t)(p[k] + 64)) * 0x9e3779b9u;
    return (mixed ^ mixed >> 15) >> 8 & 255u;
}

enum { STEPS = 16 };

/* Maps a point of the octahedron |x| + |y| + |z| = STEPS to the mesh's space. */
static void place_lattice(const struct maker *maker, const int p[3], double out[3])
{
    double length = 1.0, factor[3] = {1.0, 1.0, 1.0};
    enum hard_mesh mesh = maker->hard->mesh;
    if (mesh != HARD_OCTAHEDRON)
        length = sqrt((double)(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
    if (mesh == HARD_SPIKES)
        factor[0] = factor[1] = factor[2] = 1.0 + (double)lattice_bits(p) / 128.0;
    if (mesh == HARD_SLIVERS) {
        factor[1] = 0x1p-10;
        factor[2] = 0x1p10;
    }
    for (int k = 0; k < 3; ++k)
        out[k] = (double)p[k] / length * factor[k];
}

static void put_lattice(struct maker *maker, int corner[3][3], bool turned)
{
    double p[3][3];
    for (int i = 0; i < 3; ++i)
        place_lattice(maker, corner[i], p[i]);
    put(maker, p[0], p[turned ? 2 : 1], p[turned ? 1 : 2]);
}

/* Adds one of the eight faces, subdivided. */
static void put_face(struct maker *maker, const int sign[3])
{
    bool turned = sign[0] * sign[1] * sign[2] < 0;
    for (int i = 0; i < STEPS; ++i) {
        for (int j = 0; i + j < STEPS; ++j) {
            int k = STEPS - i - j;
            const int a[3] = {sign[0] * i, sign[1] * j, sign[2] * k};
            const int b[3] = {sign[0] * (i + 1), sign[1] * j, sign[2] * (k - 1)};
            const int c[3] = {sign[0] * i, sign[1] * (j + 1), sign[2] * (k - 1)};
            int up[3][3] = {{a[0], a[1], a[2]}, {b[0], b[1], b[2]}, {c[0], c[1], c[2]}};
            put_lattice(maker, up, turned);
            if (k < 2)
                continue;
            int down[3][3] = {{b[0], b[1], b[2]},
                              {sign[0] * (i + 1), sign[1] * (j + 1), sign[2] * (k - 2)},
                              {c[0], c[1], c[2]}};
            put_lattice(maker, down, turned);
        }
    }
}

static void make_ball(struct maker *maker)
{
    for (int face = 0; face < 8; ++face) {
        const int sign[3] = {face & 1 ? -1 : 1, face & 2 ? -1 : 1, face & 4 ? -1 : 1};
        put_face(maker, sign);
    }
}

static void put_quad(struct maker *maker, double p[4][3])
{
    put(maker, p[0], p[1], p[2]);
    put(maker, p[0], p[2], p[3]);
}

/* STEPS x STEPS squares around the middle, heights from 0 to 15. */
static void make_grid(struct maker *maker)
{
    static const int corner[4][2] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    for (int x = 0; x < STEPS; ++x) {
        for (int z = 0; z < STEPS; ++z) {
            double p[4][3];
            for (int i = 0; i < 4; ++i) {
                const int at[3] = {x + corner[i][0] - STEPS / 2, 0, z + corner[i][1] - STEPS / 2};
                p[i][0] = (double)at[0];
                p[i][1] = (double)(lattice_bits(at) / 16u);
                p[i][2] = (double)at[2];
            }
            put_quad(maker, p);
        }
    }
}

enum { CUBE_HALF = 4 };

/* Each face in 8 x 8 squares of side 1. */
static void make_cube(struct maker *maker)
{
    for (int face = 0; face < 6; ++face) {
        int axis = face / 2, side = face % 2 ? CUBE_HALF : -CUBE_HALF;
        for (int cell = 0; cell < 4 * CUBE_HALF * CUBE_HALF; ++cell) {
            double p[4][3];
            for (int i = 0; i < 4; ++i) {
                int s = cell % (2 * CUBE_HALF) - CUBE_HALF + (i == 1 || i == 2);
                int t = cell / (2 * CUBE_HALF) - CUBE_HALF + (i >= 2);
                p[i][axis] = (double)side;
                p[i][(axis + 1) % 3] = (double)(face % 2 ? s : t);
                p[i][(axis + 2) % 3] = (double)(face % 2 ? t : s);
            }
            put_quad(maker, p);
        }
    }
}

/* A fan of needles around one point. Their widths halve from needle to needle, over and over from
   2^-20 to 2^-40. */
static void make_needles(struct maker *maker)
{
    for (int i = 0; i < 63; ++i) {
        double width = 0x1p-20, z = (double)(i - 31) / 64.0;
        for (int k = 0; k < i % 21; ++k)
            width *= 0.5;
        const double a[3] = {0.0, 0.0, 0.0}, b[3] = {1.0, 0.0, z}, c[3] = {0.5, width, 0.5 * z};
        put(maker, a, b, c);
    }
}

static void make_sizes(struct maker *maker)
{
    double size = 0x1p-60;
    for (int i = 0; i <= 118; ++i, size *= 2.0) {
        double p[3][3];
        for (int k = 0; k < 9; ++k) {
            const int at[3] = {i, k, 7 * k};
            p[k / 3][k % 3] = size * (1.0 + (double)lattice_bits(at) / 256.0);
        }
        put(maker, p[0], p[1], p[2]);
    }
}

static void make_duplicates(struct maker *maker)
{
    double p[4][3] = {{-1, -1, 0.25}, {1, -1, 0.5}, {1, 1, 0.75}, {-1, 1, 0.5}};
    for (int i = 0; i < 25; ++i)
        put_quad(maker, p);
}

/* Five junctions side by side, because some devices have special kernels for trees of one node. */
static void make_junctions(struct maker *maker)
{
    for (int i = 0; i < 5; ++i) {
        double x = 4.0 * i;
        const double a[3] = {x - 1, -1, 0.125}, b[3] = {x + 1, -1, 0.375},
                     c[3] = {x + 1, 1.125, 0.75}, d[3] = {x - 1, 1, 0.25};
        double middle[3];
        for (int k = 0; k < 3; ++k)
            middle[k] = a[k] + 0.3 * (c[k] - a[k]) + (k == 1 ? 0x1p-20 : 0.0);
        put(maker, a, b, c);
        put(maker, a, middle, d);
        put(maker, middle, c, d);
    }
}

/* github.com/Oblikovati/Oblikovati, issue 2146: a ray at the diagonal of a square; below it more
   squares. And the triangle of pbrt-v4's Triangle.BadCases, drawn apart until it has an area. */
static void make_anchors(struct maker *maker)
{
    static const double line[3][3] = {{-1113.45459, -79.049614, -56.2431908},
                                      {-1113.45459, -87.0922699, -56.2431908},
                                      {-1113.4547, -79.2090149, -56.2431908}};
    for (int i = 0; i < 7; ++i) {
        double z = -20.0 * i, square[4][3] = {{-5, -5, z}, {5, -5, z}, {5, 5, z}, {-5, 5, z}};
        put_quad(maker, square);
    }
    put(maker, line[0], line[1], line[2]);
}

static void (*const makers[HARD_MESHES])(struct maker *maker) = {
    [HARD_SPHERE] = make_ball,        [HARD_SPIKES] = make_ball,
    [HARD_SLIVERS] = make_ball,       [HARD_UNWELDED] = make_ball,
    [HARD_OCTAHEDRON] = make_ball,    [HARD_GRID] = make_grid,
    [HARD_CUBE] = make_cube,          [HARD_NEEDLES] = make_needles,
    [HARD_SIZES] = make_sizes,        [HARD_DUPLICATES] = make_duplicates,
    [HARD_JUNCTION] = make_junctions, [HARD_ANCHORS] = make_anchors,
};

/* ---- Scenes ---- */

enum { TRIANGLES_MAX = 8 * STEPS * STEPS };

/* A map that scales the axes, may turn them, and moves by +offset on x and z, by -offset on y. The
   rotation's entries are thirds, which no float represents. */
static struct affine place_by(const double scale[3], bool turned, double offset)
{
    static const double turn[3][3] = {{2, -1, 2}, {2, 2, -1}, {-1, 2, 2}};
    struct affine place;
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c)
            place.m[4 * r + c] = (turned ? turn[r][c] / 3.0 : r == c) * scale[c];
        place.m[4 * r + 3] = r == 1 ? -offset : offset;
    }
    return place;
}

static int compare_points(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(float));
}

/* Merges equal vertices. `positions` keeps the distinct ones, sorted. */
static whit_result weld(const struct maker *maker, struct scene_mesh *mesh)
{
    uint32_t corners = 3 * maker->count, kept = 0;
    mesh->triangle_count = maker->count;
    mesh->positions = array_alloc(corners, 3 * sizeof(float));
    mesh->indices = array_alloc(corners, sizeof *mesh->indices);
    if (!mesh->positions || !mesh->indices)
        return WHIT_ERROR_MEMORY;
    for (size_t i = 0; i < 3 * (size_t)corners; ++i)
        mesh->positions[i] = maker->positions[i] + 0.0f; /* makes -0 a +0, so that equal vertices
                                                            have equal bits */
    mesh->vertex_count = corners;
    for (uint32_t i = 0; i < corners; ++i)
        mesh->indices[i] = i;
    if (maker->hard->mesh == HARD_UNWELDED)
        return WHIT_OK;
    qsort(mesh->positions, corners, 3 * sizeof(float), compare_points);
    for (uint32_t i = 0; i < corners; ++i) {
        float *p = mesh->positions;
        if (kept == 0 || compare_points(&p[3 * (size_t)i], &p[3 * (size_t)(kept - 1)]) != 0)
            memmove(&p[3 * (size_t)kept++], &p[3 * (size_t)i], 3 * sizeof(float));
    }
    for (uint32_t i = 0; i < corners; ++i) {
        float p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = maker->positions[3 * (size_t)i + (size_t)k] + 0.0f;
        const float *found = bsearch(p, mesh->positions, kept, 3 * sizeof(float), compare_points);
        mesh->indices[i] = (uint32_t)((found - mesh->positions) / 3);
    }
    mesh->vertex_count = kept;
    return WHIT_OK;
}

whit_result hard_scene_of_mesh(const whit_log *log, const char *name, struct scene_mesh *mesh,
                               const struct affine *place, struct scene **out)
{
    struct scene_instance instance = {.node = SCENE_NONE, .has_local = place != NULL};
    struct scene *scene = scene_create(log, name);
    if (place)
        instance.local = *place;
    if (!scene) {
        scene_mesh_finish(mesh);
        return log_failure(log, WHIT_ERROR_MEMORY, "out of memory");
    }
    whit_result result = WHIT_OK;
    instance.mesh = scene_add_mesh(scene, *mesh);
    *mesh = (struct scene_mesh){0};
    if (instance.mesh == SCENE_NONE || scene_add_instance(scene, instance) == SCENE_NONE) {
        log_error(log, "out of memory");
        result = WHIT_ERROR_MEMORY;
    }
    if (result == WHIT_OK)
        result = scene_freeze(scene);
    if (result == WHIT_OK)
        *out = scene;
    else
        scene_destroy(scene);
    return result;
}

static whit_result make_scene(const whit_log *log, const struct hard_case *hard, struct scene **out)
{
    struct maker maker = {.hard = hard, .capacity = TRIANGLES_MAX};
    struct scene_mesh mesh = {0};
    maker.positions = array_alloc(TRIANGLES_MAX, 9 * sizeof(float));
    whit_result result = maker.positions ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK) {
        makers[hard->mesh](&maker);
        result = maker.failed ? WHIT_ERROR_FAILED : weld(&maker, &mesh);
    }
    free(maker.positions);
    if (result != WHIT_OK) {
        scene_mesh_finish(&mesh);
        log_error(log, "%s: %s", hard->name, whit_result_name(result));
        return result;
    }
    const struct affine place = place_by((const double[3]){1.0, 1.25, -0.75}, true, hard->offset);
    return hard_scene_of_mesh(log, hard->name, &mesh, hard->instanced ? &place : NULL, out);
}

static enum hard_truth truth_of(const struct hard_case *hard)
{
    if (hard->rays == HARD_AIMED || hard->rays == HARD_LATTICE || hard->rays == HARD_CROSS)
        return HARD_MUST_HIT;
    return hard->rays == HARD_LEAVING ? HARD_MUST_MISS : HARD_ORACLE;
}

static void set_reach(const struct hard_case *hard, struct hard_scene *out)
{
    for (int k = 0; k < 3; ++k) {
        out->middle[k] = k == 1 ? -hard->offset : hard->offset;
        out->reach[k] = 0.25 * hard->scale;
    }
    if (hard->mesh == HARD_SLIVERS) {
        out->reach[1] *= 0x1p-10;
        out->reach[2] *= 0x1p10;
    }
}

static whit_result pose_and_build(const whit_log *log, double time_s, struct hard_scene *hard)
{
    const whit_accel_params params = {.instances =
                                          hard->flatten ? WHIT_INSTANCES_OFF : WHIT_INSTANCES_ON};
    whit_result result = scene_pose_init(hard->scene, time_s, &hard->pose);
    if (result == WHIT_OK)
        result = hard_topology_init(hard->scene, &hard->topology);
    if (result == WHIT_OK)
        result = accel_create(log, hard->scene, &params, &hard->accel);
    if (result == WHIT_OK && time_s != 0.0)
        result = accel_pose(hard->accel, &hard->pose);
    return result;
}

whit_result hard_scene_init(const whit_log *log, const struct hard_case *hard,
                            struct hard_scene *out)
{
    *out = (struct hard_scene){.rays = hard->rays, .truth = truth_of(hard)};
    set_reach(hard, out);
    whit_result result = make_scene(log, hard, &out->owned);
    out->scene = out->owned;
    if (result == WHIT_OK)
        result = pose_and_build(log, 0.0, out);
    if (result != WHIT_OK)
        hard_scene_finish(out);
    return result;
}

/* Finishes a hard_scene: pose, trees, and the ranges of ray origins. */
static whit_result take_scene(const whit_log *log, double time_s, struct hard_scene *out)
{
    whit_result result = pose_and_build(log, time_s, out);
    for (int k = 0; k < 3; ++k) {
        out->middle[k] = 0.5 * (out->pose.lo[k] + out->pose.hi[k]);
        out->reach[k] = 0.25 * (out->pose.hi[k] - out->pose.lo[k]);
    }
    if (result != WHIT_OK)
        hard_scene_finish(out);
    return result;
}

whit_result hard_scene_borrow(const whit_log *log, const struct scene *scene, double time_s,
                              bool flatten, struct hard_scene *out)
{
    *out = (struct hard_scene){
        .scene = scene, .flatten = flatten, .rays = HARD_AROUND, .truth = HARD_ORACLE};
    if (scene->triangle_total == 0)
        return log_failure(log, WHIT_ERROR_INPUT, "%s: no triangles to shoot at", scene->name);
    return take_scene(log, time_s, out);
}

/* ---- Variants of a scene ---- */

const struct hard_variant *hard_variants(uint32_t *count)
{
    static const struct hard_variant variants[] = {
        {"vertices x 1e-6", 1e-6, 0, false, false, false},
        {"vertices x 1e6", 1e6, 0, false, false, false},
        {"vertices + 1e3", 1, 1e3, false, false, false},
        {"vertices + 1e5", 1, 1e5, false, false, false},
        {"vertices + 1e7", 1, 1e7, false, false, false},
        {"vertices turned", 1, 0, true, false, false},
        {"vertices mirrored", 1, 0, false, true, false},
        {"instance x 1e-6", 1e-6, 0, false, false, true},
        {"instance x 1e6", 1e6, 0, false, false, true},
        {"instance + 1e5", 1, 1e5, false, false, true},
        {"instance + 1e7", 1, 1e7, false, false, true},
        {"instance turned", 1, 0, true, false, true},
        {"instance mirrored", 1, 0, true, true, true},
    };
    *count = sizeof variants / sizeof *variants;
    return variants;
}

/* Gathers all triangles in world space, transformed by `place` where it is not NULL. */
static whit_result gather(const whit_log *log, const struct hard_scene *given,
                          const struct affine *place, struct scene_mesh *mesh)
{
    const struct scene *scene = given->scene;
    uint64_t total = scene->triangle_total;
    *mesh = (struct scene_mesh){0};
    if (total <= UINT32_MAX / 3) {
        mesh->positions = array_alloc((size_t)total, 9 * sizeof(float));
        mesh->indices = array_alloc((size_t)total, 3 * sizeof *mesh->indices);
    }
    if (!mesh->positions || !mesh->indices) {
        scene_mesh_finish(mesh);
        return log_failure(log, WHIT_ERROR_MEMORY,
                           "%s: out of memory for all its triangles as one mesh", scene->name);
    }
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *from = &scene->meshes[scene->instances[i].mesh];
        for (uint32_t t = 0; t < from->triangle_count; ++t) {
            float *to = &mesh->positions[9 * (size_t)mesh->triangle_count++];
            double p[3][3];
            scene_mesh_placed_corners(from, t, &given->pose.instances[i], p);
            for (int k = 0; k < 3 && place; ++k)
                affine_point(place, p[k], p[k]);
            for (int k = 0; k < 9; ++k)
                to[k] = (float)p[k / 3][k % 3];
        }
    }
    mesh->vertex_count = 3 * mesh->triangle_count;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        mesh->indices[i] = i;
    return WHIT_OK;
}

whit_result hard_scene_vary(const whit_log *log, const struct hard_scene *given,
                            const struct hard_variant *variant, struct hard_scene *out)
{
    double size = variant->scale;
    const double scale[3] = {variant->mirrored ? -size : size, size, size};
    const struct affine place = place_by(scale, variant->turned, variant->offset);
    struct scene_mesh mesh;
    *out = (struct hard_scene){.rays = HARD_MIXED, .truth = HARD_ORACLE};
    whit_result result = gather(log, given, variant->instanced ? NULL : &place, &mesh);
    if (result == WHIT_OK)
        result = hard_scene_of_mesh(log, variant->name, &mesh, variant->instanced ? &place : NULL,
                                    &out->owned);
    if (result == WHIT_OK && out->owned->triangle_total == 0) {
        hard_scene_finish(out);
        return WHIT_OK;
    }
    out->scene = out->owned;
    return result == WHIT_OK ? take_scene(log, 0.0, out) : result;
}

void hard_scene_finish(struct hard_scene *hard)
{
    accel_destroy(hard->accel);
    hard_topology_finish(&hard->topology);
    scene_pose_finish(&hard->pose);
    scene_destroy(hard->owned);
    *hard = (struct hard_scene){0};
}
