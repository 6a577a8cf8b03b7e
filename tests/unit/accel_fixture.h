/* Meshes that builders get wrong, rays that hit them where it is hardest, and the answers to hold
   against each other. */
#ifndef ACCEL_FIXTURE_H
#define ACCEL_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../cases.h"
#include "../scenes.h"
#include "accel/accel.h"
#include "accel/extent.h"
#include "random_fixture.h"
#include "scene/shapes.h"
#include "twin/ray.h"
#include "twin/traverse.h"

static const struct log silent;

/* ---- Triangles with their boxes ---- */

struct soup {
    const char *name;
    float *positions;  /* 9 a triangle: vertices are not shared, but may be equal */
    uint32_t *indices; /* 3 a triangle */
    struct bvh_box *boxes;
    struct bvh_triangles triangles; /* of the above */
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

static inline struct soup soup_of_mesh(const char *name, struct scene_mesh *mesh)
{
    struct soup soup = soup_make(name, mesh->triangle_count);
    for (uint32_t i = 0; i < soup.count; ++i)
        soup_set(&soup, i, &mesh->positions[3 * (size_t)mesh->indices[3 * i]],
                 &mesh->positions[3 * (size_t)mesh->indices[3 * i + 1]],
                 &mesh->positions[3 * (size_t)mesh->indices[3 * i + 2]]);
    scene_mesh_finish(mesh);
    soup_box(&soup);
    return soup;
}

static inline struct soup soup_sphere(uint32_t segments, uint32_t rings)
{
    struct scene_mesh mesh = mesh_sphere(1.0, segments, rings);
    return soup_of_mesh("sphere", &mesh);
}

static inline struct soup soup_terrain(uint32_t steps)
{
    struct scene_mesh mesh = mesh_terrain(10.0, 2.0, steps, 5);
    return soup_of_mesh("terrain", &mesh);
}

/* Long thin diagonals through each other. */
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

/* Each `ratio` times as large as the one before, in the middle of the exponents. */
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

/* Finite bits of any kind up to `limit`. */
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

/* ---- Scenes and rays ---- */

/* One material, one instance at the origin. */
static inline struct scene *soup_scene(const struct soup *soup)
{
    struct scene *scene = scene_begin(&silent, soup->name);
    scene_put(scene, mesh_triangles(soup->positions, soup->count), NULL);
    return scene_ready(scene);
}

static inline struct accel *soup_accel(const struct scene *scene, const struct bvh_params *params)
{
    struct accel_params all = {.mesh = *params, .validate = true};
    struct accel *accel = NULL;
    assert_int_equal(accel_create(&silent, scene, &all, &accel), WHIT_OK);
    return accel;
}

/* From around the bounds: half of them to points inside, half to vertices and points of edges. */
static inline struct gpu_ray soup_ray(const struct soup *soup, const struct bvh_box *bounds,
                                      uint32_t index)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    uint32_t triangle = random_below(&random_state, soup->count),
             corner = random_below(&random_state, 3);
    const float *a = soup_vertex(soup, triangle, corner);
    const float *b = soup_vertex(soup, triangle, (corner + 1) % 3);
    float s = random_below(&random_state, 2) ? 0.0f : random_float(&random_state);
    bool level = index % 8 == 3; /* in the plane of many boxes */
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

/* The closest hits of `ray_count` rays, the same ones for equal seeds. `cost` may be NULL. */
static inline void soup_trace(const struct soup *soup, const struct accel *accel, uint64_t seed,
                              uint32_t ray_count, struct gpu_hit *hits, struct gpu_cost *cost)
{
    random_state = seed;
    for (uint32_t i = 0; i < ray_count; ++i) {
        struct gpu_ray ray = soup_ray(soup, &accel->meshes[0].box, i);
        uint32_t status = 0;
        traverse_float(accel, ORDER_DISTANCE, &ray, false, HIT_NONE, HIT_NONE, &hits[i], cost,
                       &status);
        assert_int_equal(status, 0);
    }
}

static inline uint32_t hits_count(const struct gpu_hit *hits, uint32_t count)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < count; ++i)
        found += hits[i].primitive != HIT_NONE;
    return found;
}

/* A point of an instance. */
static inline struct vec3 in_world(const struct accel *accel, uint32_t instance, struct vec3 p)
{
    if (accel->flat || accel->single_identity)
        return p;
    const struct gpu_instance *i = &accel->instances[instance];
    return vec3_add(accel_rotate_rows(i->forward0, i->forward1, i->forward2, p),
                    vec3_make(i->origin_x, i->origin_y, i->origin_z));
}

#endif
