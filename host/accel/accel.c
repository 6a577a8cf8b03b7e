/* The trees of a scene: one for each mesh, all in one array, behind room for the tree over
   instances. */
#include <stdlib.h>

#include "accel/bvh8.h"
#include "accel/extent.h"
#include "accel/flat.h"
#include "accel/hull.h"
#include "accel/material_bits.h"
#include "accel/pose.h"
#include "accel/validate.h"
#include "base/array.h"
#include "base/clock.h"
#include "base/text.h"
#include "base/threads.h"
#include "scene/pose.h"

enum {
    MESH_LARGE = 8192,   /* triangles from which a mesh is built by all threads */
    SPAN_RECORDS = 8192, /* triangles or nodes handled by one call */
};

/* Records [begin, end) of one mesh. */
struct span {
    uint32_t mesh, begin, end;
};

struct creation {
    struct accel *accel;
    struct bvh *trees; /* one for each mesh */
    struct material_bits *materials;
    struct span *spans;
    uint32_t span_count, span_capacity;
    whit_result *results; /* one for each mesh */
};

/* ---- Mesh trees ---- */

struct box_context {
    const struct scene_mesh *mesh;
    struct bvh_box *boxes;
};

static void make_boxes(void *user, uint32_t index)
{
    const struct box_context *context = user;
    const struct scene_mesh *mesh = context->mesh;
    uint32_t begin = index * SPAN_RECORDS;
    uint32_t left = scene_mesh_primitives(mesh) - begin;
    uint32_t end = begin + (left < SPAN_RECORDS ? left : SPAN_RECORDS);
    for (uint32_t i = begin; i < end; ++i)
        context->boxes[i] = accel_primitive_box(mesh, i);
}

static whit_result mesh_build(struct creation *creation, uint32_t index, uint32_t thread_count)
{
    struct accel *accel = creation->accel;
    const struct scene_mesh *mesh = &accel->scene->meshes[index];
    whit_accel_params params = accel->params;
    params.threads = thread_count;
    uint32_t count = scene_mesh_primitives(mesh);
    whit_result result = WHIT_ERROR_MEMORY;
    struct bvh_box *boxes = array_alloc(count, sizeof *boxes);
    bool split = params.build == WHIT_BUILD_SPATIAL;
    uint8_t *whole = split ? array_alloc(count, 1) : NULL;
    if (!boxes || (split && !whole)) {
        log_error(&accel->log, "%s: mesh %s: out of memory for its tree", accel->scene->name,
                  text_token(mesh->name).text);
        goto done;
    }
    struct box_context context = {mesh, boxes};
    threads_for(thread_count, (count + SPAN_RECORDS - 1) / SPAN_RECORDS, make_boxes, &context);
    if (split)
        material_bits_whole(creation->materials, mesh, whole);
    const struct bvh_triangles triangles = {mesh->positions, mesh->indices, whole};
    result = bvh_build(&accel->log, boxes, count, &triangles, &params, &creation->trees[index]);
done:
    free(whole);
    free(boxes);
    return result;
}

static bool is_large(const struct creation *creation, uint32_t mesh)
{
    return scene_mesh_primitives(&creation->accel->scene->meshes[mesh]) >= MESH_LARGE;
}

static void build_small(void *context, uint32_t mesh)
{
    struct creation *creation = context;
    if (!is_large(creation, mesh))
        creation->results[mesh] = mesh_build(creation, mesh, 1);
}

/* Builds large meshes one after the other, each by all threads, and small ones side by side. */
static whit_result meshes_build(struct creation *creation)
{
    uint32_t threads = creation->accel->params.threads, count = creation->accel->mesh_count;
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        if (is_large(creation, i))
            result = mesh_build(creation, i, threads);
    if (result == WHIT_OK)
        threads_for(threads, count, build_small, creation);
    for (uint32_t i = 0; result == WHIT_OK && i < count; ++i)
        result = creation->results[i];
    return result;
}

/* ---- One array for all ---- */

static bool spans_add(struct creation *creation, uint32_t mesh, uint32_t count)
{
    for (uint32_t begin = 0; begin < count; begin += SPAN_RECORDS) {
        uint32_t end = count - begin < SPAN_RECORDS ? count : begin + SPAN_RECORDS;
        if (!ARRAY_PUSH(creation->spans, creation->span_count, creation->span_capacity,
                        (struct span){mesh, begin, end}))
            return false;
    }
    return true;
}

/* Gives every mesh its place in the arrays; the totals must fit the bits of a ref. */
static whit_result meshes_place(struct creation *creation)
{
    struct accel *accel = creation->accel;
    uint64_t nodes = accel->instance_node_capacity, records = 0, triangles = 0;
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        const struct bvh *tree = &creation->trees[i];
        struct accel_mesh *mesh = &accel->meshes[i];
        *mesh = accel_mesh_over(tree);
        mesh->hull = accel_hull(&accel->scene->meshes[i]);
        mesh->first_node = (uint32_t)nodes;
        mesh->first_triangle = (uint32_t)records;
        mesh->shade_base = (uint32_t)triangles;
        nodes += tree->node_count;
        records += tree->reference_count;
        triangles += tree->primitive_count;
        accel->clipped |= tree->clipped;
        if (nodes > BVH_FIRST_MASK || records > BVH_FIRST_MASK)
            return log_failure(&accel->log, WHIT_ERROR_INPUT,
                               "%s: more than %u nodes or triangles: split the scene",
                               accel->scene->name, BVH_FIRST_MASK);
        if (tree->depth > accel->mesh_depth)
            accel->mesh_depth = tree->depth;
        uint32_t larger =
            tree->node_count > tree->reference_count ? tree->node_count : tree->reference_count;
        if (!spans_add(creation, i, larger))
            return WHIT_ERROR_MEMORY;
    }
    accel->node_count = (uint32_t)nodes;
    accel->record_count = (uint32_t)records;
    accel->triangle_count = (uint32_t)triangles;
    return WHIT_OK;
}

static void write_span(void *context, uint32_t index)
{
    const struct creation *creation = context;
    struct span span = creation->spans[index];
    const struct accel_mesh *mesh = &creation->accel->meshes[span.mesh];
    const struct bvh *tree = &creation->trees[span.mesh];
    for (uint32_t i = span.begin; i < span.end && i < tree->node_count; ++i) {
        struct gpu_bvh_node *node = &creation->accel->nodes[mesh->first_node + i];
        *node = tree->nodes[i];
        node->first += i == 1 ? 0 : bvh_count(node) ? mesh->first_triangle : mesh->first_node;
    }
    for (uint32_t i = span.begin; i < span.end && i < tree->reference_count; ++i)
        creation->accel->triangles[mesh->first_triangle + i] = material_bits_record(
            creation->materials, &creation->accel->scene->meshes[span.mesh], tree->order[i]);
}

static whit_result meshes_write(struct creation *creation)
{
    struct accel *accel = creation->accel;
    accel->nodes = array_alloc_aligned(accel->node_count, sizeof *accel->nodes);
    accel->triangles = array_alloc_aligned(accel->record_count, sizeof *accel->triangles);
    if (!accel->nodes || !accel->triangles)
        return WHIT_ERROR_MEMORY;
    threads_for(accel->params.threads, creation->span_count, write_span, creation);
    for (uint32_t i = 0; i < accel->mesh_count; ++i) {
        struct accel_mesh *mesh = &accel->meshes[i];
        if (mesh->node_count > 0)
            mesh->root = accel_node_ref(&accel->nodes[mesh->first_node]);
    }
    return WHIT_OK;
}

/* ---- Whole scenes ---- */

static whit_result no_memory(const struct accel *accel, whit_result result)
{
    if (result == WHIT_ERROR_MEMORY)
        log_error(&accel->log, "%s: out of memory for its trees", accel->scene->name);
    return result;
}

static whit_result creation_alloc(struct creation *creation)
{
    struct accel *accel = creation->accel;
    const struct scene *scene = accel->scene;
    accel->mesh_count = scene->mesh_count;
    accel->instance_count = scene->instance_count;
    uint64_t capacity = 2 * (uint64_t)(scene->instance_count ? scene->instance_count : 1) + 2;
    if (capacity > BVH_FIRST_MASK)
        return log_failure(&accel->log, WHIT_ERROR_INPUT, "%s: %u instances are too many",
                           scene->name, scene->instance_count);
    accel->instance_node_capacity = (uint32_t)capacity;
    accel->meshes = array_alloc_zeroed(scene->mesh_count, sizeof *accel->meshes);
    accel->instances = array_alloc_aligned(scene->instance_count, sizeof *accel->instances);
    creation->trees = array_alloc_zeroed(scene->mesh_count, sizeof *creation->trees);
    creation->results = array_alloc_zeroed(scene->mesh_count, sizeof *creation->results);
    creation->materials = array_alloc_zeroed(scene->material_count, sizeof *creation->materials);
    bool all = accel->meshes && accel->instances && creation->trees && creation->results &&
               creation->materials;
    return all ? WHIT_OK : WHIT_ERROR_MEMORY;
}

static whit_result creation_run(struct creation *creation)
{
    whit_result result = creation_alloc(creation);
    if (result != WHIT_OK)
        return no_memory(creation->accel, result);
    material_bits_scan(creation->accel->scene, creation->materials);
    result = meshes_build(creation); /* logs why it fails */
    if (result != WHIT_OK)
        return result;
    result = meshes_place(creation);
    if (result == WHIT_OK)
        result = meshes_write(creation);
    return no_memory(creation->accel, result);
}

static void creation_finish(struct creation *creation)
{
    for (uint32_t i = 0; creation->trees && i < creation->accel->mesh_count; ++i)
        bvh_finish(&creation->trees[i]);
    free(creation->trees);
    free(creation->results);
    free(creation->materials);
    free(creation->spans);
}

/* Counts the most iterations that the traversal of one ray takes without trees: one for each
   record, two more for each leaf and three for each instance. */
static whit_result bare_check(struct accel *accel)
{
    const struct scene *scene = accel->scene;
    uint64_t primitives = scene->triangle_total + scene->sphere_total, iterations = 0;
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        uint32_t count = scene_mesh_primitives(&scene->meshes[scene->instances[i].mesh]);
        iterations += count + 2 * ((uint64_t)count / BVH_LEAF_MAX + 1) + 3;
    }
    if (accel->params.instances == WHIT_INSTANCES_OFF)
        iterations = primitives + 2 * (primitives / BVH_LEAF_MAX + 1);
    accel->iterations = (uint32_t)iterations;
    if (primitives <= ACCEL_BARE_MAX && iterations <= ACCEL_ITERATIONS_MAX)
        return WHIT_OK;
    return log_failure(
        &accel->log, WHIT_ERROR_USAGE,
        "%s: without trees every ray tests every primitive, and %llu over all instances are "
        "too many: %u are possible, fewer in thousands of instances",
        scene->name, (unsigned long long)primitives, ACCEL_BARE_MAX);
}

static whit_result pose_at_start(struct accel *accel)
{
    struct scene_pose pose;
    whit_result result = scene_pose_init(accel->scene, 0.0, &pose);
    if (result != WHIT_OK)
        return result;
    result = accel_pose(accel, &pose);
    scene_pose_finish(&pose);
    return result;
}

whit_result accel_create(const whit_log *log, const struct scene *scene,
                         const whit_accel_params *params, struct accel **out)
{
    double begin_ms = clock_ms();
    *out = NULL;
    struct accel *accel = array_alloc_zeroed(1, sizeof *accel);
    if (!accel)
        return log_failure(log, WHIT_ERROR_MEMORY, "%s: out of memory for its trees", scene->name);
    accel->scene = scene;
    accel->log = log_or_silence(log);
    accel->params = params ? *params : (whit_accel_params){0};
    accel->no_trees = accel->params.build == WHIT_BUILD_NONE;
    struct creation creation = {.accel = accel};
    whit_result result = WHIT_OK;
    if (accel->no_trees) {
        accel->params.leaf_limit = BVH_LEAF_MAX;
        accel->params.instance_build = WHIT_BUILD_NONE;
        result = bare_check(accel);
    }
    if (result == WHIT_OK)
        result = accel->params.instances == WHIT_INSTANCES_OFF
                     ? no_memory(accel, accel_flat_create(accel))
                     : creation_run(&creation);
    creation_finish(&creation);
    accel->build_ms = clock_ms() - begin_ms;
    if (result == WHIT_OK)
        result = pose_at_start(accel);
    if (accel->flat)
        accel->build_ms = clock_ms() - begin_ms;
    if (result == WHIT_OK && accel->params.validate)
        result = accel_validate(accel);
    if (result != WHIT_OK) {
        accel_destroy(accel);
        return result;
    }
    *out = accel;
    return WHIT_OK;
}

void accel_destroy(struct accel *accel)
{
    if (!accel)
        return;
    free(accel->nodes);
    free(accel->triangles);
    free(accel->instances);
    free(accel->meshes);
    accel_bvh8_finish(&accel->bvh8);
    accel_posing_destroy(accel->posing);
    accel_flat_destroy(accel->world);
    free(accel);
}

uint64_t accel_bytes(const struct accel *accel)
{
    return (uint64_t)accel->node_count * sizeof *accel->nodes +
           (uint64_t)accel->record_count * sizeof *accel->triangles +
           (uint64_t)accel->instance_count * sizeof *accel->instances;
}
