/* Meshes that are difficult for builders, rays at their vertices and edges, scenes with their
   trees, and hits to compare. */
#ifndef ACCEL_FIXTURE_H
#define ACCEL_FIXTURE_H

#include <float.h>

#include "../cases.h"
#include "../scenes.h"
#include "accel/accel.h"
#include "accel/extent.h"
#include "accel/validate.h"
#include "messages_fixture.h"
#include "random_fixture.h"
#include "scene/pose.h"
#include "scene/shapes.h"
#include "twin/ray.h"
#include "twin/traverse.h"
#include "unit.h"

static const whit_log silent = {.fn = messages_collect, .user = &messages, .level = WHIT_LOG_ERROR};

/* ---- Random numbers ---- */

static inline float random_within(float max)
{
    return max * random_float_signed(&random_state);
}

/* A random point in a cube around the origin. */
static inline struct vec3 random_point(float max)
{
    float x = random_within(max), y = random_within(max), z = random_within(max);
    return vec3_make(x, y, z);
}

static inline float either(float a, float b)
{
    return random_below(&random_state, 2) ? a : b;
}

/* ---- Triangles with their boxes ---- */

struct soup {
    const char *name;
    float *positions;  /* 9 for each triangle: vertices are not shared, but may be equal */
    uint32_t *indices; /* 3 for each triangle */
    struct bvh_box *boxes;
    struct bvh_triangles triangles; /* points to the arrays above */
    uint32_t count;
};

static inline struct soup soup_make(const char *name, uint32_t count)
{
    struct soup soup = {.name = name, .count = count};
    soup.positions = calloc(count ? count : 1, 9 * sizeof(float));
    soup.indices = calloc(count ? count : 1, 3 * sizeof(uint32_t));
    soup.boxes = calloc(count ? count : 1, sizeof *soup.boxes);
    assert_true(soup.positions && soup.indices && soup.boxes);
    for (uint32_t i = 0; i < 3 * count; ++i)
        soup.indices[i] = i;
    soup.triangles = (struct bvh_triangles){soup.positions, soup.indices, NULL};
    return soup;
}

static inline void soup_finish(struct soup *soup)
{
    free(soup->positions);
    free(soup->indices);
    free(soup->boxes);
}

/* Freed at the end of its block. */
#define own_soup __attribute__((cleanup(soup_finish), unused)) struct soup

static inline const float *soup_vertex(const struct soup *soup, uint32_t triangle, uint32_t corner)
{
    return &soup->positions[9 * (size_t)triangle + 3 * (size_t)corner];
}

static inline void soup_set(struct soup *soup, uint32_t i, const float a[3], const float b[3],
                            const float c[3])
{
    memcpy(&soup->positions[9 * (size_t)i], a, 3 * sizeof(float));
    memcpy(&soup->positions[9 * (size_t)i + 3], b, 3 * sizeof(float));
    memcpy(&soup->positions[9 * (size_t)i + 6], c, 3 * sizeof(float));
}

static inline void soup_box(struct soup *soup)
{
    for (uint32_t i = 0; i < soup->count; ++i)
        soup->boxes[i] = accel_triangle_box(soup_vertex(soup, i, 0), soup_vertex(soup, i, 1),
                                            soup_vertex(soup, i, 2));
}

/* Takes ownership of the mesh. */
static inline struct soup soup_of_mesh(const char *name, struct scene_mesh mesh)
{
    struct soup soup = soup_make(name, mesh.triangle_count);
    for (uint32_t i = 0; i < soup.count; ++i)
        soup_set(&soup, i, &mesh.positions[3 * (size_t)mesh.indices[3 * i]],
                 &mesh.positions[3 * (size_t)mesh.indices[3 * i + 1]],
                 &mesh.positions[3 * (size_t)mesh.indices[3 * i + 2]]);
    scene_mesh_finish(&mesh);
    soup_box(&soup);
    return soup;
}

static inline struct soup soup_sphere(uint32_t segments, uint32_t rings)
{
    return soup_of_mesh("sphere", mesh_sphere(1.0, segments, rings));
}

static inline struct soup soup_terrain(uint32_t steps)
{
    return soup_of_mesh("terrain", mesh_terrain(10.0, 2.0, steps, 5));
}

/* A landscape whose vertices are integers. */
static inline struct soup soup_landscape(uint32_t steps)
{
    struct soup soup = soup_terrain(steps);
    for (uint32_t i = 0; i < 9 * soup.count; ++i)
        soup.positions[i] = i % 3 == 1 ? rintf(4.0f * soup.positions[i])
                                       : rintf((soup.positions[i] + 5.0f) * 0.1f * (float)steps);
    soup_box(&soup);
    return soup;
}

/* Triangles that each lie within a cube of side `size`, whose middle is in the unit cube. */
static inline struct soup soup_scattered(uint32_t count, float size)
{
    struct soup soup = soup_make("scattered", count);
    for (uint32_t i = 0; i < count; ++i) {
        struct vec3 middle = random_point(1.0f);
        for (uint32_t corner = 0; corner < 3; ++corner)
            vec3_store(&soup.positions[9 * (size_t)i + 3 * (size_t)corner],
                       vec3_add(middle, random_point(0.5f * size)));
    }
    soup_box(&soup);
    return soup;
}

/* Long thin triangles along diagonals, which cross each other. */
static inline struct soup soup_hair(uint32_t count, float thickness)
{
    struct soup soup = soup_make("hair", count);
    for (uint32_t i = 0; i < count; ++i) {
        float a[3], b[3], c[3];
        for (int k = 0; k < 3; ++k) {
            a[k] = random_float(&random_state);
            b[k] = random_float(&random_state);
            c[k] = a[k] + thickness * (random_float(&random_state) - 0.5f);
        }
        soup_set(&soup, i, a, b, c);
    }
    soup_box(&soup);
    return soup;
}

/* A wall from corner `o` along `u` and `v`: two triangles. */
static inline void soup_quad(struct soup *soup, uint32_t i, const float o[3], const float u[3],
                             const float v[3])
{
    float p[3][3];
    for (int k = 0; k < 3; ++k) {
        p[0][k] = o[k] + u[k];
        p[1][k] = o[k] + u[k] + v[k];
        p[2][k] = o[k] + v[k];
    }
    soup_set(soup, i, o, p[0], p[1]);
    soup_set(soup, i + 1, o, p[1], p[2]);
}

/* Rooms with long walls and floors, and small furniture turned at odd angles. */
static inline struct soup soup_rooms(uint32_t quads)
{
    struct soup soup = soup_make("rooms", 2 * quads);
    for (uint32_t i = 0; i < quads; ++i) {
        float o[3], u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
        bool wall = i % 4 == 0;
        for (int k = 0; k < 3; ++k)
            o[k] =
                wall ? (float)random_below(&random_state, 16) : 16.0f * random_float(&random_state);
        if (wall) {
            uint32_t axis = random_below(&random_state, 3);
            u[(axis + 1) % 3] = 1.0f + (float)random_below(&random_state, 16);
            v[(axis + 2) % 3] = 1.0f + (float)random_below(&random_state, 16);
        }
        for (int k = 0; !wall && k < 3; ++k) {
            u[k] = random_float(&random_state) - 0.5f;
            v[k] = random_float(&random_state) - 0.5f;
        }
        soup_quad(&soup, 2 * i, o, u, v);
    }
    soup_box(&soup);
    return soup;
}

/* Triangles that are each `ratio` times as large as the one before, with exponents around 0. */
static inline struct soup soup_exponential(uint32_t count, double ratio)
{
    struct soup soup = soup_make("exponential", count);
    for (uint32_t i = 0; i < count; ++i) {
        float x = (float)pow(ratio, (double)i - 0.5 * count), corner[3][3];
        for (int k = 0; k < 9; ++k)
            corner[k / 3][k % 3] = x * (1.0f + random_float(&random_state));
        soup_set(&soup, i, corner[0], corner[1], corner[2]);
    }
    soup_box(&soup);
    return soup;
}

/* Triangles with random finite bits as coordinates, up to `limit`. */
static inline struct soup soup_garbage(uint32_t count, float limit)
{
    struct soup soup = soup_make("garbage", count);
    for (uint32_t i = 0; i < 9 * count; ++i) {
        do {
            uint32_t bits = random_bits(&random_state);
            memcpy(&soup.positions[i], &bits, sizeof bits);
        } while (!(fabsf(soup.positions[i]) <= limit));
    }
    soup_box(&soup);
    return soup;
}

/* ---- Scenes with their trees ---- */

/* `scene`, its trees and its pose at time 0; `soup` is empty where the scene is made of none. */
struct world {
    struct soup soup;
    struct scene *scene;
    struct accel *accel;
    struct scene_pose pose;
};

static inline void drop_accel(struct accel **at)
{
    accel_destroy(*at);
}

/* Freed at the end of its block: own_accel *accel = accel_of(...); */
#define own_accel __attribute__((cleanup(drop_accel), unused)) struct accel

/* Builds the trees of a frozen scene, and validates them. */
static inline struct accel *accel_of(const struct scene *scene, whit_accel_params params)
{
    struct accel *accel = NULL;
    params.validate = true;
    assert_int_equal(accel_create(&silent, scene, &params, &accel), WHIT_OK);
    return accel;
}

/* Takes ownership of the scene and freezes it. */
static inline struct world world_of(struct scene *scene, whit_accel_params params)
{
    struct world world = {.scene = scene_ready(scene)};
    world.accel = accel_of(scene, params);
    assert_int_equal(scene_pose_init(scene, 0.0, &world.pose), WHIT_OK);
    return world;
}

static inline void world_finish(struct world *world)
{
    scene_pose_finish(&world->pose);
    accel_destroy(world->accel);
    scene_destroy(world->scene);
    soup_finish(&world->soup);
}

/* Freed at the end of its block. */
#define own_world __attribute__((cleanup(world_finish), unused)) struct world

/* A scene with one material and one instance at the origin. */
static inline struct scene *soup_scene(const struct soup *soup)
{
    struct scene *scene = scene_begin(&silent, soup->name);
    scene_put(scene, mesh_triangles(soup->positions, soup->count), NULL);
    return scene;
}

/* Takes ownership of the soup. */
static inline struct world world_of_soup(struct soup soup, whit_accel_params params)
{
    struct world world = world_of(soup_scene(&soup), params);
    world.soup = soup;
    return world;
}

/* A word of trees, and a value that makes them wrong. */
struct change {
    void *word;
    uint32_t value;
};

/* Checks that trees are sound, but not with any one of the changes. */
static inline void check_changes(const struct accel *accel, const struct change *changes,
                                 size_t count)
{
    assert_int_equal(accel_validate(accel), WHIT_OK);
    for (size_t i = 0; i < count; ++i) {
        uint32_t kept;
        memcpy(&kept, changes[i].word, sizeof kept);
        memcpy(changes[i].word, &changes[i].value, sizeof kept);
        if (accel_validate(accel) != WHIT_ERROR_FAILED)
            fail_msg("case %zu was misjudged", i);
        memcpy(changes[i].word, &kept, sizeof kept);
    }
    assert_int_equal(accel_validate(accel), WHIT_OK);
}

/* ---- Rays ---- */

static inline struct gpu_ray ray_along(struct vec3 origin, struct vec3 dir)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    vec3_store(ray.origin, origin);
    vec3_store(ray.dir, dir);
    return ray;
}

static inline struct gpu_ray ray_through(struct vec3 origin, struct vec3 target)
{
    return ray_along(origin, vec3_sub(target, origin));
}

/* A ray to `target` from a random origin in a cube around (0, 0, 0). */
static inline struct gpu_ray ray_from_cube(float max, struct vec3 target)
{
    return ray_through(random_point(max), target);
}

/* A ray from around the bounds; half of the rays go to points inside of triangles, half to vertices
   and points of edges. */
static inline struct gpu_ray soup_ray(const struct soup *soup, const struct bvh_box *bounds,
                                      uint32_t index)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    uint32_t triangle = random_below(&random_state, soup->count),
             corner = random_below(&random_state, 3);
    const float *a = soup_vertex(soup, triangle, corner);
    const float *b = soup_vertex(soup, triangle, (corner + 1) % 3);
    float s = random_below(&random_state, 2) ? 0.0f : random_float(&random_state);
    bool level = index % 8 == 3; /* the ray is in the plane of many boxes */
    uint32_t axis = random_below(&random_state, 3);
    for (uint32_t k = 0; k < 3; ++k) {
        float size = bounds->hi[k] - bounds->lo[k];
        float target = index % 2 ? a[k] + s * (b[k] - a[k])
                                 : bounds->lo[k] + size * random_float(&random_state);
        ray.origin[k] = bounds->lo[k] + size * (1.5f * random_float(&random_state) - 0.25f);
        if (level && k == axis)
            ray.origin[k] = target;
        ray.dir[k] = target - ray.origin[k];
    }
    return ray;
}

/* Transforms a point of an instance to world space. */
static inline struct vec3 in_world(const struct accel *accel, uint32_t instance, struct vec3 p)
{
    if (accel->flat || accel->single_identity)
        return p;
    const struct gpu_instance *i = &accel->instances[instance];
    return vec3_add(accel_rotate_rows(i->forward0, i->forward1, i->forward2, p),
                    vec3_make(i->origin_x, i->origin_y, i->origin_z));
}

/* A point of a random record of a random instance: by turns a vertex, a point of an edge and one of
   the inside; of a sphere, one of the cube around it. */
static inline struct vec3 point_of_record(const struct accel *accel, uint32_t index)
{
    uint32_t instance;
    const struct accel_mesh *mesh;
    do {
        instance = random_below(&random_state, accel->instance_count);
        mesh = &accel->meshes[accel->flat ? 0 : accel->instances[instance].mesh];
    } while (mesh->record_count == 0);
    const struct gpu_triangle *record =
        &accel->triangles[mesh->first_triangle + random_below(&random_state, mesh->record_count)];
    struct vec3 a = vec3_load(record->v0), b = vec3_load(record->v1), c = vec3_load(record->v2);
    if (record->flags & TRIANGLE_SPHERE)
        return in_world(accel, instance, vec3_add(a, random_point(record->v1[0])));
    float s = index % 3 ? random_float(&random_state) : 0.0f,
          t = index % 3 == 2 ? (1.0f - s) * random_float(&random_state) : 0.0f;
    struct vec3 p = vec3_add(a, vec3_scale(vec3_sub(b, a), s));
    return in_world(accel, instance, vec3_add(p, vec3_scale(vec3_sub(c, a), t)));
}

/* ---- Hits ---- */

/* `cost` may be NULL. */
static inline struct gpu_hit trace_with(const struct accel *accel, struct traverse_params params,
                                        const struct gpu_ray *ray, struct gpu_cost *cost)
{
    struct gpu_hit hit;
    uint32_t status = 0;
    traverse_ray(accel, &params, ray, &hit, cost, &status);
    assert_int_equal(status, 0);
    return hit;
}

/* The closest hit at NUMERICS_WATERTIGHT. */
static inline struct gpu_hit trace(const struct accel *accel, const struct gpu_ray *ray)
{
    return trace_with(accel, (struct traverse_params){0}, ray, NULL);
}

/* The same without any tree, by testing every primitive of every instance. */
static inline struct gpu_hit trace_brute(const struct accel *accel, const struct gpu_ray *ray)
{
    return trace_with(accel, (struct traverse_params){.brute = true}, ray, NULL);
}

static inline bool hits_equal(const struct gpu_hit *a, const struct gpu_hit *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static inline bool same_ids(const struct gpu_hit *a, const struct gpu_hit *b)
{
    return a->primitive == b->primitive && a->instance == b->instance;
}

#endif
