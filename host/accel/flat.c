/* One tree over the primitives of all instances, in world space: the scene without instancing. Each
   vertex is transformed in double and rounded once. So are a sphere's centre and radius, where the
   transform moves the sphere and scales it alike along all axes, without turning it. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accel/extent.h"
#include "accel/flat.h"
#include "accel/flat_choice.h"
#include "accel/material_bits.h"
#include "base/array.h"
#include "base/clock.h"
#include "base/text.h"
#include "base/threads.h"
#include "scene/afford.h"

enum { SPAN = 4096 }; /* triangles or vertices handled by one call */

/* Data that is kept from pose to pose. */
struct accel_flat {
    struct accel_mesh *meshes; /* of the scene; triangle_count and shade_base only */
    struct material_bits *materials;
    uint32_t *first_triangle, *first_vertex; /* [instance]; at the end the total */
    struct affine *placed;                   /* transforms of the instances in the present tree */
    bool has_tree;
    struct flat_span *spans;
    uint32_t span_count, span_capacity;
};

/* Vertices and triangles [begin, end) of one instance. */
struct flat_span {
    uint32_t instance, begin, end;
    bool bad;
};

/* The data of one build of the world tree. */
struct flattening {
    struct accel *accel;
    const struct scene_pose *pose;
    float *positions;
    uint32_t *indices, *owners; /* indices: 3 vertices of each triangle; owners: its instance */
    struct bvh_box *boxes;
    uint8_t *whole;
    struct bvh tree;
    struct gpu_triangle *triangles;
};

void accel_flat_destroy(struct accel_flat *flat)
{
    if (!flat)
        return;
    free(flat->meshes);
    free(flat->materials);
    free(flat->first_triangle);
    free(flat->first_vertex);
    free(flat->placed);
    free(flat->spans);
    free(flat);
}

const struct accel_mesh *accel_flat_meshes(const struct accel_flat *flat)
{
    return flat->meshes;
}

uint32_t accel_flat_first(const struct accel_flat *flat, uint32_t instance)
{
    return flat->first_triangle[instance];
}

static whit_result check_size(const struct accel *accel, uint64_t triangles, uint64_t vertices)
{
    const struct scene *scene = accel->scene;
    bool wide = vertices > FLAT_VERTICES_MAX;
    char what[64];
    snprintf(what, sizeof what, "its %llu %s without instances",
             (unsigned long long)(wide ? vertices : triangles), wide ? "vertices" : "triangles");
    if (wide || triangles > FLAT_TRIANGLES_MAX)
        log_error(&accel->log, "%s: %s are more than %u", scene->name, what,
                  wide ? FLAT_VERTICES_MAX : FLAT_TRIANGLES_MAX);
    else if (scene_could_afford(scene, &accel->log, triangles * FLAT_TRIANGLE_BYTES, what))
        return WHIT_OK;
    return WHIT_ERROR_INPUT;
}

static whit_result place_instances(const struct accel *accel, struct accel_flat *flat)
{
    const struct scene *scene = accel->scene;
    uint64_t triangles = 0, vertices = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        flat->first_triangle[i] = (uint32_t)triangles;
        flat->first_vertex[i] = (uint32_t)vertices;
        triangles += scene_mesh_primitives(mesh);
        vertices += accel_flat_vertices(mesh);
    }
    flat->first_triangle[scene->instance_count] = (uint32_t)triangles;
    flat->first_vertex[scene->instance_count] = (uint32_t)vertices;
    whit_result result = check_size(accel, triangles, vertices);
    if (result != WHIT_OK)
        return result;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        uint32_t primitives = scene_mesh_primitives(mesh), placed = accel_flat_vertices(mesh);
        uint32_t larger = primitives > placed ? primitives : placed;
        for (uint32_t begin = 0; begin < larger; begin += SPAN) {
            uint32_t end = larger - begin < SPAN ? larger : begin + SPAN;
            if (!ARRAY_PUSH(flat->spans, flat->span_count, flat->span_capacity,
                            (struct flat_span){i, begin, end, false}))
                return WHIT_ERROR_MEMORY;
        }
    }
    return WHIT_OK;
}

static void describe_meshes(const struct scene *scene, struct accel_flat *flat)
{
    uint32_t shade_base = 0;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        flat->meshes[i] = (struct accel_mesh){
            .root = BVH_EMPTY_REF,
            .triangle_count = scene_mesh_primitives(&scene->meshes[i]),
            .shade_base = shade_base,
        };
        shade_base += scene_mesh_primitives(&scene->meshes[i]);
    }
}

whit_result accel_flat_create(struct accel *accel)
{
    const struct scene *scene = accel->scene;
    struct accel_flat *flat = array_alloc_zeroed(1, sizeof *flat);
    accel->world = flat;
    accel->flat = true;
    accel->mesh_count = 1;
    accel->instance_count = scene->instance_count;
    accel->instance_root = BVH_EMPTY_REF;
    accel->meshes = array_alloc_zeroed(1, sizeof *accel->meshes);
    accel->instances = array_alloc_aligned(scene->instance_count, sizeof *accel->instances);
    if (!flat || !accel->meshes || !accel->instances)
        return WHIT_ERROR_MEMORY;
    if (scene->instance_count >= FLAT_INSTANCES_MAX)
        return log_failure(&accel->log, WHIT_ERROR_INPUT, "%s: %u instances are too many",
                           scene->name, scene->instance_count);
    size_t ends = (size_t)scene->instance_count + 1;
    flat->meshes = array_alloc(scene->mesh_count, sizeof *flat->meshes);
    flat->materials = array_alloc_zeroed(scene->material_count, sizeof *flat->materials);
    flat->first_triangle = array_alloc(ends, sizeof *flat->first_triangle);
    flat->first_vertex = array_alloc(ends, sizeof *flat->first_vertex);
    flat->placed = array_alloc(scene->instance_count, sizeof *flat->placed);
    if (!flat->meshes || !flat->materials || !flat->first_triangle || !flat->first_vertex ||
        !flat->placed)
        return WHIT_ERROR_MEMORY;
    describe_meshes(scene, flat);
    material_bits_scan(scene, flat->materials);
    return place_instances(accel, flat);
}

/* ---- One build ---- */

static const struct scene_mesh *mesh_of(const struct flattening *f, uint32_t instance)
{
    const struct scene *scene = f->accel->scene;
    return &scene->meshes[scene->instances[instance].mesh];
}

static void place_vertices(void *user, uint32_t index)
{
    struct flattening *f = user;
    struct flat_span *span = &f->accel->world->spans[index];
    const struct scene_mesh *mesh = mesh_of(f, span->instance);
    const struct affine *forward = &f->pose->instances[span->instance];
    uint32_t placed = accel_flat_vertices(mesh);
    uint32_t end = span->end < placed ? span->end : placed;
    float *out = f->positions + 3 * (size_t)f->accel->world->first_vertex[span->instance];
    span->bad = false;
    for (uint32_t v = span->begin; v < end; ++v) {
        const float *p =
            mesh->sphere_count ? mesh->spheres + 4 * (size_t)v : mesh->positions + 3 * (size_t)v;
        double world[3];
        affine_point(forward, (const double[3]){(double)p[0], (double)p[1], (double)p[2]}, world);
        for (int i = 0; i < 3; ++i) {
            span->bad |= !(fabs(world[i]) <= FLAT_COORDINATE_MAX);
            out[3 * (size_t)v + (size_t)i] = (float)world[i];
        }
    }
}

/* The sphere's radius in world space. */
static float placed_radius(const struct flattening *f, uint32_t instance, uint32_t sphere)
{
    double radius = (double)mesh_of(f, instance)->spheres[4 * (size_t)sphere + 3];
    return (float)(radius * f->pose->instances[instance].m[0]);
}

/* The corners of a sphere are three times its centre. */
static void place_primitives(void *user, uint32_t index)
{
    struct flattening *f = user;
    const struct accel_flat *flat = f->accel->world;
    const struct flat_span *span = &flat->spans[index];
    const struct scene_mesh *mesh = mesh_of(f, span->instance);
    bool spheres = mesh->sphere_count > 0;
    uint32_t count = scene_mesh_primitives(mesh), end = span->end < count ? span->end : count;
    uint32_t first = flat->first_triangle[span->instance];
    for (uint32_t i = span->begin; i < end; ++i) {
        uint32_t *corner = &f->indices[3 * ((size_t)first + i)];
        const float *p[3];
        for (size_t k = 0; k < 3; ++k) {
            corner[k] = flat->first_vertex[span->instance] +
                        (spheres ? i : mesh->indices[3 * (size_t)i + k]);
            p[k] = &f->positions[3 * (size_t)corner[k]];
        }
        f->boxes[first + i] = spheres ? accel_sphere_box(p[0], placed_radius(f, span->instance, i))
                                      : accel_triangle_box(p[0], p[1], p[2]);
        f->owners[first + i] = span->instance;
    }
    if (f->whole && span->begin == 0)
        material_bits_whole(flat->materials, mesh, f->whole + first);
}

static whit_result refuse_range(const struct flattening *f)
{
    const struct accel *accel = f->accel;
    for (uint32_t i = 0; i < accel->world->span_count; ++i) {
        if (!accel->world->spans[i].bad)
            continue;
        uint32_t instance = accel->world->spans[i].instance;
        const char *name = accel->scene->instances[instance].name;
        return log_failure(&accel->log, WHIT_ERROR_INPUT,
                           "%s: instance %u `%s`: its triangles are out of range at %g s",
                           accel->scene->name, instance, text_token(name).text, f->pose->time_s);
    }
    return WHIT_OK;
}

static whit_result refuse_spheres(const struct flattening *f)
{
    const struct accel *accel = f->accel;
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        if (!mesh_of(f, i)->sphere_count || accel_flat_keeps_spheres(&f->pose->instances[i]))
            continue;
        const char *name = accel->scene->instances[i].name;
        return log_failure(
            &accel->log, WHIT_ERROR_INPUT,
            "%s: instance %u `%s`: spheres that are turned, mirrored or stretched need "
            "instances",
            accel->scene->name, i, text_token(name).text);
    }
    return WHIT_OK;
}

static whit_result no_memory(const struct accel *accel)
{
    return log_failure(&accel->log, WHIT_ERROR_MEMORY,
                       "%s: out of memory for one tree over all its triangles", accel->scene->name);
}

static whit_result world_build(struct flattening *f)
{
    struct accel *accel = f->accel;
    struct accel_flat *flat = accel->world;
    uint32_t threads = accel->params.threads;
    uint32_t count = flat->first_triangle[accel->instance_count];
    uint32_t vertices = flat->first_vertex[accel->instance_count];
    bool split = accel->params.build == WHIT_BUILD_SPATIAL;
    whit_result result = refuse_spheres(f);
    if (result != WHIT_OK)
        return result;
    f->positions = array_alloc(vertices, 3 * sizeof *f->positions);
    f->indices = array_alloc(count, 3 * sizeof *f->indices);
    f->owners = array_alloc(count, sizeof *f->owners);
    f->boxes = array_alloc(count, sizeof *f->boxes);
    f->whole = split ? array_alloc(count, 1) : NULL;
    if (!f->positions || !f->indices || !f->owners || !f->boxes || (split && !f->whole))
        return no_memory(accel);
    threads_for(threads, flat->span_count, place_vertices, f);
    result = refuse_range(f);
    if (result != WHIT_OK)
        return result;
    threads_for(threads, flat->span_count, place_primitives, f);
    const struct bvh_triangles triangles = {f->positions, f->indices, f->whole};
    return bvh_build(&accel->log, f->boxes, count, &triangles, &accel->params, &f->tree);
}

static void write_records(void *user, uint32_t index)
{
    const struct flattening *f = user;
    const struct accel *accel = f->accel;
    uint32_t begin = index * SPAN, left = f->tree.reference_count - begin;
    uint32_t end = begin + (left < SPAN ? left : SPAN);
    for (uint32_t i = begin; i < end; ++i) {
        uint32_t triangle = f->tree.order[i], instance = f->owners[triangle];
        const uint32_t *corner = &f->indices[3 * (size_t)triangle];
        struct gpu_triangle record =
            material_bits_record(accel->world->materials, mesh_of(f, instance),
                                 triangle - accel->world->first_triangle[instance]);
        memcpy(record.v0, &f->positions[3 * (size_t)corner[0]], sizeof record.v0);
        if (record.flags & TRIANGLE_SPHERE) {
            record.v1[0] = record.v2[0] = placed_radius(f, instance, record.primitive);
        } else {
            memcpy(record.v1, &f->positions[3 * (size_t)corner[1]], sizeof record.v1);
            memcpy(record.v2, &f->positions[3 * (size_t)corner[2]], sizeof record.v2);
        }
        record.flags |= instance << TRIANGLE_INSTANCE_SHIFT;
        if (affine_determinant(&f->pose->instances[instance]) < 0.0)
            record.flags |= TRIANGLE_MIRRORED;
        f->triangles[i] = record;
    }
}

static whit_result world_write(struct flattening *f)
{
    uint32_t count = f->tree.reference_count;
    f->triangles = array_alloc_aligned(count, sizeof *f->triangles);
    if (!f->triangles)
        return no_memory(f->accel);
    threads_for(f->accel->params.threads, (count + SPAN - 1) / SPAN, write_records, f);
    return WHIT_OK;
}

/* Hands the tree's nodes and the records over to `accel`. Nothing fails from here on. */
static void world_commit(struct flattening *f)
{
    struct accel *accel = f->accel;
    struct bvh *tree = &f->tree;
    struct accel_mesh *mesh = &accel->meshes[0];
    free(accel->nodes);
    free(accel->triangles);
    *mesh = accel_mesh_over(tree);
    accel->nodes = tree->nodes;
    accel->triangles = f->triangles;
    tree->nodes = NULL;
    f->triangles = NULL;
    accel->node_count = tree->node_count;
    accel->record_count = tree->reference_count;
    accel->triangle_count = tree->primitive_count;
    accel->mesh_depth = tree->depth;
    accel->clipped = tree->clipped;
}

whit_result accel_flat_build(struct accel *accel, const struct scene_pose *pose)
{
    struct flattening f = {.accel = accel, .pose = pose};
    struct accel_flat *flat = accel->world;
    size_t bytes = accel->instance_count * sizeof *flat->placed;
    if (flat->has_tree && memcmp(flat->placed, pose->instances, bytes) == 0)
        return WHIT_OK;
    whit_result result = world_build(&f);
    if (result == WHIT_OK)
        result = world_write(&f);
    if (result == WHIT_OK) {
        world_commit(&f);
        memcpy(flat->placed, pose->instances, bytes);
        flat->has_tree = true;
    }
    bvh_finish(&f.tree);
    free(f.triangles);
    free(f.positions);
    free(f.indices);
    free(f.owners);
    free(f.boxes);
    free(f.whole);
    return result;
}
