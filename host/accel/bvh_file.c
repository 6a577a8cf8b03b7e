#include "accel/bvh_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/accel_inside.h"
#include "base/array.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"

/* The file: a header, then of each mesh a header, its nodes with indices from 0, and its order;
   then the checksum of all that. Words are in the order of the machine that wrote it. */
struct file_header {
    char magic[8];
    uint32_t version, byte_order;
    uint64_t size_bytes; /* of the whole file */
    uint64_t geometry;
    char builder[16];
    uint32_t mesh_count, bins, leaf_limit, optimize;
    float traversal_cost, spatial_alpha, spatial_budget;
    uint32_t clipped;
};
_Static_assert(sizeof(struct file_header) == 80, "no padding in files");

struct mesh_header {
    uint32_t node_count, primitive_count, reference_count, leaf_count, depth, leaf_largest;
};
_Static_assert(sizeof(struct mesh_header) == 24, "no padding in files");

static const char magic[8] = "whitbvh";
enum { VERSION = 1, BYTE_ORDER_MARK = 0x01020304, CHECKSUM_BYTES = 8 };

static const char *const builder_names[] = {
    [BVH_BINNED] = "binned",   [BVH_MEDIAN] = "median",           [BVH_SWEEP] = "sweep",
    [BVH_SPATIAL] = "spatial", [BVH_SWEEP_NAIVE] = "sweep-naive",
};
enum { BUILDER_COUNT = sizeof builder_names / sizeof builder_names[0] };

static uint64_t geometry_hash(const struct scene *scene)
{
    uint64_t value = HASH_START;
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[i];
        value = hash_bytes(value, mesh->positions, 3 * sizeof(float) * mesh->vertex_count);
        value = hash_bytes(value, mesh->indices, 3 * sizeof(uint32_t) * mesh->triangle_count);
        value = hash_bytes(value, mesh->spheres, 4 * sizeof(float) * mesh->sphere_count);
    }
    return value;
}

/* ---- Writing ---- */

struct writer {
    const struct accel *accel;
    uint8_t *data;
    size_t size_bytes, offset;
};

static void put(struct writer *writer, const void *data, size_t size_bytes)
{
    memcpy(writer->data + writer->offset, data, size_bytes);
    writer->offset += size_bytes;
}

static uint64_t file_size(const struct accel *accel)
{
    uint64_t size_bytes = sizeof(struct file_header) + CHECKSUM_BYTES;
    for (uint32_t i = 0; i < accel->mesh_count; ++i)
        size_bytes += sizeof(struct mesh_header) +
                      (uint64_t)accel->meshes[i].node_count * sizeof(struct gpu_bvh_node) +
                      (uint64_t)accel->meshes[i].record_count * sizeof(uint32_t);
    return size_bytes;
}

static void put_header(struct writer *writer)
{
    const struct accel *accel = writer->accel;
    const struct bvh_params *params = &accel->params.mesh;
    struct file_header header = {
        .version = VERSION,
        .byte_order = BYTE_ORDER_MARK,
        .size_bytes = writer->size_bytes,
        .geometry = geometry_hash(accel->scene),
        .mesh_count = accel->mesh_count,
        .bins = params->bins,
        .leaf_limit = params->leaf_limit,
        .optimize = params->optimize,
        .traversal_cost = params->traversal_cost,
        .spatial_alpha = params->spatial_alpha,
        .spatial_budget = params->spatial_budget,
        .clipped = accel->clipped,
    };
    const char *name = builder_names[params->builder];
    memcpy(header.magic, magic, sizeof magic);
    memcpy(header.builder, name, strlen(name));
    put(writer, &header, sizeof header);
}

static void put_mesh(struct writer *writer, const struct accel_mesh *mesh)
{
    const struct accel *accel = writer->accel;
    struct mesh_header header = {
        .node_count = mesh->node_count,
        .primitive_count = mesh->triangle_count,
        .reference_count = mesh->record_count,
        .depth = mesh->depth,
    };
    size_t header_offset = writer->offset;
    put(writer, &header, sizeof header);
    for (uint32_t i = 0; i < mesh->node_count; ++i) {
        struct gpu_bvh_node node = accel->nodes[mesh->first_node + i];
        uint32_t count = bvh_count(&node);
        if (i != 1)
            node.first -= count ? mesh->first_triangle : mesh->first_node;
        put(writer, &node, sizeof node);
        header.leaf_count += count > 0;
        header.leaf_largest = count > header.leaf_largest ? count : header.leaf_largest;
    }
    for (uint32_t i = 0; i < mesh->record_count; ++i)
        put(writer, &accel->triangles[mesh->first_triangle + i].primitive, sizeof(uint32_t));
    memcpy(writer->data + header_offset, &header, sizeof header);
}

static whit_result write_whole(const struct log *log, const char *path, const struct writer *writer)
{
    struct file_write file;
    whit_result result = file_write_begin(log, path, &file);
    if (result != WHIT_OK)
        return result;
    fwrite(writer->data, 1, writer->size_bytes, file.stream); /* a failure is the commit's */
    return file_write_commit(log, &file);
}

whit_result bvh_file_write(const struct accel *accel, const char *path)
{
    if (accel->flat || accel->params.mesh.builder == BVH_NONE) {
        log_error(&accel->log, "%s: there are no trees of single meshes to save", path);
        return WHIT_ERROR_USAGE;
    }
    struct writer writer = {.accel = accel, .size_bytes = (size_t)file_size(accel)};
    writer.data = array_alloc(writer.size_bytes, 1);
    if (!writer.data) {
        log_error(&accel->log, "%s: out of memory", path);
        return WHIT_ERROR_MEMORY;
    }
    put_header(&writer);
    for (uint32_t i = 0; i < accel->mesh_count; ++i)
        put_mesh(&writer, &accel->meshes[i]);
    uint64_t checksum = hash_bytes(HASH_START, writer.data, writer.offset);
    put(&writer, &checksum, sizeof checksum);
    whit_result result = write_whole(&accel->log, path, &writer);
    free(writer.data);
    return result;
}

/* ---- Reading ---- */

struct reader {
    const struct log *log;
    const char *path;
    const struct scene *scene;
    const uint8_t *data;
    size_t size_bytes, offset; /* without the checksum */
    struct file_header header;
    struct bvh_params *params;
    char mesh[sizeof(struct text_token)]; /* name of the current one */
    char violation[256];
};

#define REFUSE(reader, ...)                                                                        \
    do {                                                                                           \
        log_error((reader)->log, __VA_ARGS__);                                                     \
        return WHIT_ERROR_INPUT;                                                                   \
    } while (0)

/* Copies what is next; false at the end of the file. */
static bool take(struct reader *reader, void *out, uint64_t size_bytes)
{
    if (size_bytes > reader->size_bytes - reader->offset)
        return false;
    memcpy(out, reader->data + reader->offset, (size_t)size_bytes);
    reader->offset += (size_t)size_bytes;
    return true;
}

static whit_result check_format(struct reader *reader, size_t file_bytes)
{
    const struct file_header *header = &reader->header;
    const char *path = reader->path;
    size_t known = file_bytes < sizeof magic ? file_bytes : sizeof magic;
    if (memcmp(reader->data, magic, known) != 0)
        REFUSE(reader, "%s: this is no file of trees that whit saved", path);
    if (file_bytes < sizeof *header + CHECKSUM_BYTES)
        REFUSE(reader, "%s: cut short: %zu bytes are not even its header", path, file_bytes);
    reader->size_bytes = file_bytes - CHECKSUM_BYTES;
    (void)take(reader, &reader->header, sizeof *header);
    if (header->byte_order != BYTE_ORDER_MARK)
        REFUSE(reader, "%s: saved on a machine with another order of bytes", path);
    if (header->version != VERSION)
        REFUSE(reader, "%s: version %u of the format; this is version %d", path, header->version,
               VERSION);
    if (header->size_bytes != file_bytes)
        REFUSE(reader, "%s: %zu bytes, but its header says %llu: %s", path, file_bytes,
               (unsigned long long)header->size_bytes,
               file_bytes < header->size_bytes ? "cut short" : "too long");
    uint64_t stated;
    memcpy(&stated, reader->data + reader->size_bytes, sizeof stated);
    if (stated != hash_bytes(HASH_START, reader->data, reader->size_bytes))
        REFUSE(reader, "%s: damaged: its checksum is another", path);
    return WHIT_OK;
}

static whit_result check_scene(const struct reader *reader)
{
    const struct file_header *header = &reader->header;
    if (header->mesh_count != reader->scene->mesh_count)
        REFUSE(reader, "%s: trees of another scene: %u meshes, but %s has %u", reader->path,
               header->mesh_count, reader->scene->name, reader->scene->mesh_count);
    if (header->geometry != geometry_hash(reader->scene))
        REFUSE(reader, "%s: trees of another scene: the triangles of %s are others", reader->path,
               reader->scene->name);
    return WHIT_OK;
}

static whit_result read_params(struct reader *reader)
{
    const struct file_header *header = &reader->header;
    uint32_t builder = 0;
    while (builder < BUILDER_COUNT &&
           strncmp(header->builder, builder_names[builder], sizeof header->builder) != 0)
        ++builder;
    bool known = builder < BUILDER_COUNT && header->bins <= 256 && header->optimize <= 1 &&
                 header->leaf_limit <= BVH_LEAF_MAX && header->traversal_cost >= 0.0f &&
                 header->traversal_cost <= 1e6f && isfinite(header->spatial_alpha) &&
                 isfinite(header->spatial_budget) && header->clipped <= 1;
    if (!known)
        REFUSE(reader, "%s: its builder is not known", reader->path);
    struct bvh_params *params = reader->params;
    params->builder = (enum bvh_builder)builder;
    params->bins = header->bins;
    params->leaf_limit = header->leaf_limit;
    params->optimize = header->optimize != 0;
    params->traversal_cost = header->traversal_cost;
    params->spatial_alpha = header->spatial_alpha;
    params->spatial_budget = header->spatial_budget;
    return WHIT_OK;
}

static whit_result read_arrays(struct reader *reader, const struct scene_mesh *mesh,
                               struct bvh *tree)
{
    struct mesh_header header;
    uint64_t node_bytes = 0, order_bytes = 0;
    bool fits = take(reader, &header, sizeof header);
    if (fits) {
        node_bytes = (uint64_t)header.node_count * sizeof *tree->nodes;
        order_bytes = (uint64_t)header.reference_count * sizeof *tree->order;
        fits = node_bytes + order_bytes <= reader->size_bytes - reader->offset;
    }
    if (!fits || header.primitive_count != scene_mesh_primitives(mesh) ||
        header.reference_count < header.primitive_count ||
        (header.primitive_count == 0 && header.reference_count != 0))
        REFUSE(reader, "%s: mesh %s: its counts do not fit the file", reader->path, reader->mesh);
    *tree = (struct bvh){
        .node_count = header.node_count,
        .primitive_count = header.primitive_count,
        .reference_count = header.reference_count,
        .leaf_count = header.leaf_count,
        .depth = header.depth,
        .leaf_largest = header.leaf_largest,
        .clipped = reader->header.clipped != 0,
    };
    if (header.depth > BVH_DEPTH_MAX)
        REFUSE(reader, "%s: mesh %s: a depth of %u; at most %d is possible", reader->path,
               reader->mesh, header.depth, BVH_DEPTH_MAX);
    tree->nodes = array_alloc_aligned(header.node_count, sizeof *tree->nodes);
    tree->order = array_alloc(header.reference_count, sizeof *tree->order);
    if (!tree->nodes || !tree->order) {
        log_error(reader->log, "%s: out of memory", reader->path);
        return WHIT_ERROR_MEMORY;
    }
    (void)take(reader, tree->nodes, node_bytes);
    (void)take(reader, tree->order, order_bytes);
    return WHIT_OK;
}

/* What the validator finds is kept, to be said of the file: a log takes one message at a time. */
static void on_violation(void *user, whit_log_level level, const char *message)
{
    struct reader *reader = user;
    (void)level;
    snprintf(reader->violation, sizeof reader->violation, "%s", message);
}

static void make_boxes(const struct scene_mesh *mesh, struct bvh_box *boxes)
{
    for (uint32_t i = 0; i < scene_mesh_primitives(mesh); ++i)
        boxes[i] = accel_primitive_box(mesh, i);
}

static uint32_t primitive_at(const void *user, uint32_t slot)
{
    return ((const struct bvh *)user)->order[slot];
}

/* Of a tree that is valid but for this: is all of each split triangle in its leaves? */
static whit_result check_parts(const struct log *log, const struct scene_mesh *mesh,
                               const struct bvh *tree)
{
    struct gpu_triangle *triangles = array_alloc_zeroed(tree->reference_count, sizeof *triangles);
    if (!triangles) {
        log_error(log, "out of memory");
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < tree->reference_count; ++i) {
        const uint32_t *corner = &mesh->indices[3 * (size_t)tree->order[i]];
        memcpy(triangles[i].v0, &mesh->positions[3 * (size_t)corner[0]], sizeof triangles[i].v0);
        memcpy(triangles[i].v1, &mesh->positions[3 * (size_t)corner[1]], sizeof triangles[i].v1);
        memcpy(triangles[i].v2, &mesh->positions[3 * (size_t)corner[2]], sizeof triangles[i].v2);
    }
    whit_result result = accel_validate_parts(log, "tree", tree->nodes, tree->node_count, triangles,
                                              tree->primitive_count, primitive_at, tree);
    free(triangles);
    return result;
}

static whit_result check_tree(struct reader *reader, const struct scene_mesh *mesh,
                              struct bvh *tree)
{
    const struct log log = {.fn = on_violation, .user = reader, .level = WHIT_LOG_ERROR};
    uint32_t limit = reader->params->leaf_limit ? reader->params->leaf_limit : 4;
    struct bvh_box *boxes = array_alloc(scene_mesh_primitives(mesh), sizeof *boxes);
    if (!boxes) {
        log_error(reader->log, "%s: out of memory", reader->path);
        return WHIT_ERROR_MEMORY;
    }
    make_boxes(mesh, boxes);
    whit_result result = bvh_validate(&log, tree, boxes, limit);
    free(boxes);
    /* Spheres in parts are refused later on, by name. */
    if (result == WHIT_OK && tree->reference_count > tree->primitive_count && !mesh->sphere_count)
        result = check_parts(&log, mesh, tree);
    if (result != WHIT_OK) {
        log_error(reader->log, "%s: mesh %s: %s", reader->path, reader->mesh, reader->violation);
        return result == WHIT_ERROR_FAILED ? WHIT_ERROR_INPUT : result;
    }
    float cost = reader->params->traversal_cost;
    bvh_complete(tree, cost > 0.0f ? (double)cost : 1.0);
    return WHIT_OK;
}

static whit_result read_trees(struct reader *reader, struct bvh *trees)
{
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; result == WHIT_OK && i < reader->scene->mesh_count; ++i) {
        const struct scene_mesh *mesh = &reader->scene->meshes[i];
        double begin_ms = clock_ms();
        if (mesh->name)
            snprintf(reader->mesh, sizeof reader->mesh, "%s", text_token(mesh->name).text);
        else
            snprintf(reader->mesh, sizeof reader->mesh, "%u", i);
        result = read_arrays(reader, mesh, &trees[i]);
        if (result == WHIT_OK)
            result = check_tree(reader, mesh, &trees[i]);
        trees[i].build_ms = clock_ms() - begin_ms;
    }
    if (result == WHIT_OK && reader->offset != reader->size_bytes)
        REFUSE(reader, "%s: %zu bytes behind its last tree", reader->path,
               reader->size_bytes - reader->offset);
    return result;
}

whit_result bvh_file_parse(const struct log *log, const char *path, const uint8_t *data,
                           size_t size_bytes, const struct scene *scene, struct bvh_params *params,
                           struct bvh *trees)
{
    struct reader reader = {
        .log = log, .path = path, .scene = scene, .data = data, .params = params};
    whit_result result = check_format(&reader, size_bytes);
    if (result == WHIT_OK)
        result = check_scene(&reader);
    if (result == WHIT_OK)
        result = read_params(&reader);
    if (result == WHIT_OK)
        result = read_trees(&reader, trees);
    for (uint32_t i = 0; result != WHIT_OK && i < scene->mesh_count; ++i)
        bvh_finish(&trees[i]);
    return result;
}

whit_result bvh_file_read(const struct log *log, const char *path, const struct scene *scene,
                          struct bvh_params *params, struct bvh *trees)
{
    uint8_t *data;
    size_t size_bytes;
    whit_result result = file_read(log, NULL, path, 0, &data, &size_bytes);
    if (result != WHIT_OK)
        return result;
    result = bvh_file_parse(log, path, data, size_bytes, scene, params, trees);
    free(data);
    return result;
}
