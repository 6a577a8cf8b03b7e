/* Uploads the flat arrays of the scene and its trees to device memory. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accel/bvh8.h"
#include "accel/pose.h"
#include "accel/quantized.h"
#include "base/array.h"
#include "base/same.h"
#include "device/buffer.h"
#include "render/lights.h"
#include "render/renderer.h"
#include "render/textures.h"
#include "render/upload.h"
#include "render/variants.h"
#include "render/views.h"
#include "scene/afford.h"

enum { ROW_BYTES = 16 };

/* The memory that the scene is estimated to take (scene/afford.h) includes these records on host
   and device, with two nodes for each instance and one node for two primitives. */
_Static_assert(SCENE_TREE_INSTANCE_BYTES >=
                   2 * (sizeof(struct gpu_instance) + 2 * sizeof(struct gpu_bvh_node)),
               "instances cost more than estimated");
_Static_assert(SCENE_TREE_TRIANGLE_BYTES >=
                   2 * (sizeof(struct gpu_triangle) + sizeof(struct gpu_bvh_node) / 2 +
                        sizeof(struct gpu_quantized_node) / 2),
               "triangles cost more than estimated");

static bool fits_storage(const struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    uint64_t limit = device_get_info(renderer->device)->max_storage_range_bytes;
    return (uint64_t)accel->node_count * sizeof(struct gpu_bvh_node) <= limit &&
           (uint64_t)accel->record_count * sizeof(struct gpu_triangle) <= limit &&
           (uint64_t)accel->instance_count * sizeof(struct gpu_instance) <= limit;
}

/* Texel buffers are twice as fast as storage buffers on lavapipe, and may be larger. */
static bool choose_texel_loads(const struct renderer *renderer)
{
    if (renderer->params.load_path != WHIT_LOAD_AUTO)
        return renderer->params.load_path == WHIT_LOAD_TEXEL;
    return device_get_info(renderer->device)->kind == WHIT_DEVICE_CPU || !fits_storage(renderer);
}

whit_result upload_words(struct renderer *renderer, const void *data, uint64_t size_bytes,
                         uint32_t uses, const char *name, struct buffer **buffer)
{
    uint64_t held_bytes = *buffer ? buffer_size(*buffer) : 0;
    if (size_bytes == 0)
        return WHIT_OK;
    if (held_bytes < size_bytes) {
        if (*buffer)
            passes_unbind(renderer);
        buffer_destroy(*buffer);
        *buffer = NULL;
        renderer->scene_buffers.bytes -= held_bytes;
        uint64_t spare_bytes = held_bytes ? size_bytes / 8 : 0;
        whit_result result =
            buffer_create(renderer->device, size_bytes + spare_bytes, uses, name, buffer);
        if (result != WHIT_OK)
            return result;
        renderer->scene_buffers.bytes += buffer_size(*buffer);
    }
    return buffer_write(*buffer, 0, data, size_bytes);
}

/* Writes an array of the trees. */
static whit_result store_words(struct renderer *renderer, const void *data, uint64_t size_bytes,
                               const char *name, struct buffer **buffer)
{
    uint32_t uses = renderer->scene_buffers.texel_loads ? BUFFER_TEXELS : BUFFER_STORAGE;
    return upload_words(renderer, data, size_bytes, uses, name, buffer);
}

static bool reads_instances(const struct accel *accel)
{
    return accel->flat || accel->clipped || !accel->single_identity;
}

static whit_result upload_instances(struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    if (!reads_instances(accel))
        return WHIT_OK;
    return store_words(renderer, accel->instances,
                       (uint64_t)accel->instance_count * sizeof *accel->instances, "instances",
                       &renderer->scene_buffers.instances);
}

whit_result upload_widen(struct renderer *renderer)
{
    if (!renderer->wide)
        return WHIT_OK;
    whit_result result = accel_pose_again(renderer->accel, &renderer->pose);
    if (result == WHIT_OK)
        result = accel_widen(renderer->accel);
    uint32_t stack_size = accel_packet_stack_size(renderer->accel);
    if (stack_size > renderer->packet_stack_size)
        renderer->packet_stack_size = stack_size;
    return result;
}

/* Call it before upload_instances, since instances hold their roots among these nodes. */
static whit_result upload_nodes8(struct renderer *renderer)
{
    const struct accel_bvh8 *bvh8 = &renderer->accel->bvh8;
    whit_result result = upload_widen(renderer);
    if (result == WHIT_OK && renderer->wide)
        result =
            store_words(renderer, bvh8->nodes, (uint64_t)bvh8->node_count * 8 * sizeof *bvh8->nodes,
                        "nodes of eight", &renderer->scene_buffers.nodes8);
    return result;
}

/* The tree that rays enter where they need no tree over instances. */
static const struct accel_mesh *only_tree(const struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    if (accel->flat)
        return &accel->meshes[0];
    return accel->single_identity ? &accel->meshes[renderer->scene->instances[0].mesh] : NULL;
}

/* Nodes of 16 bytes are for lavapipe, where a node costs what its loads cost, and for trees that
   are larger than a core's caches: in smaller ones the few steps of a ray do not save what it takes
   to prepare. Boxes must not grow much on the grid either, unless these nodes are asked for. */
bool upload_chooses_quantized(struct renderer *renderer)
{
    enum { NODES_MIN = 1 << 13 };
    const struct accel_mesh *tree = only_tree(renderer);
    uint32_t asked_bytes = renderer->params.node_bytes;
    if (!tree || !renderer->scene_buffers.texel_loads || renderer->accel->no_trees ||
        device_get_info(renderer->device)->kind != WHIT_DEVICE_CPU || !accel_can_quantize(tree))
        return false;
    if (asked_bytes)
        return asked_bytes == 16;
    if (tree->node_count < NODES_MIN)
        return false;
    if (tree != renderer->graded || renderer->accel->flat) /* others stay while instances move */
        renderer->grades_well = accel_quantizes_well(renderer->accel, tree);
    renderer->graded = tree;
    return renderer->grades_well;
}

static whit_result upload_quantized(struct renderer *renderer)
{
    if (!renderer->quantized)
        return WHIT_OK;
    const struct accel_mesh *tree = only_tree(renderer);
    struct gpu_quantized_node *nodes = accel_quantize(renderer->accel, tree);
    if (!nodes)
        return render_no_memory(renderer, "nodes of 16 bytes");
    uint64_t bytes = (uint64_t)(tree->first_node + tree->node_count) * sizeof *nodes;
    whit_result result = store_words(renderer, nodes, bytes, "nodes of 16 bytes",
                                     &renderer->scene_buffers.quantized);
    free(nodes);
    return result;
}

static whit_result upload_trees(struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    struct scene_buffers *buffers = &renderer->scene_buffers;
    whit_result result =
        store_words(renderer, accel->nodes, (uint64_t)accel->node_count * sizeof *accel->nodes,
                    "nodes", &buffers->nodes);
    if (result == WHIT_OK)
        result = upload_quantized(renderer);
    if (result == WHIT_OK)
        result = upload_nodes8(renderer);
    if (result == WHIT_OK)
        result = store_words(renderer, accel->triangles,
                             (uint64_t)accel->record_count * sizeof *accel->triangles, "triangles",
                             &buffers->triangles);
    return result == WHIT_OK ? upload_instances(renderer) : result;
}

/* Writes what a triangle has in one part of the shading rows to `out`, which is zeroed. */
typedef void (*fill_triangle)(const struct scene *scene, const struct scene_mesh *mesh,
                              uint32_t triangle, uint32_t *out);

/* Writes the records that `fill` makes of every triangle of every mesh, each mesh once, to the
   shading rows from `row` on. */
static whit_result write_triangles(struct renderer *renderer, uint32_t row, uint32_t rows_each,
                                   fill_triangle fill)
{
    enum { SLICE_WORDS = 1 << 16 };
    const struct scene *scene = renderer->scene;
    uint32_t *slice = array_alloc(SLICE_WORDS, sizeof *slice);
    if (!slice)
        return render_no_memory(renderer, "triangles");
    uint32_t words = rows_each * 4, used = 0;
    uint64_t at_bytes = (uint64_t)row * ROW_BYTES;
    whit_result result = WHIT_OK;
    for (uint32_t m = 0; result == WHIT_OK && m < scene->mesh_count; ++m) {
        const struct scene_mesh *mesh = &scene->meshes[m];
        for (uint32_t t = 0; result == WHIT_OK && t < scene_mesh_primitives(mesh); ++t) {
            memset(&slice[used], 0, words * sizeof *slice);
            fill(scene, mesh, t, &slice[used]);
            used += words;
            if (used + words <= SLICE_WORDS)
                continue;
            result = buffer_write(renderer->scene_buffers.shading, at_bytes, slice, used * 4);
            at_bytes += used * 4;
            used = 0;
        }
    }
    if (result == WHIT_OK && used)
        result = buffer_write(renderer->scene_buffers.shading, at_bytes, slice, used * 4);
    free(slice);
    return result;
}

static void fill_material(const struct scene *scene, const struct scene_mesh *mesh,
                          uint32_t triangle, uint32_t *out)
{
    (void)scene;
    out[3] = mesh->materials[triangle];
}

/* Flat meshes and spheres get zeros: shading then takes the geometric normal. */
static void fill_normals(const struct scene *scene, const struct scene_mesh *mesh,
                         uint32_t triangle, uint32_t *out)
{
    (void)scene;
    for (size_t k = 0; k < 3; ++k) {
        if (mesh->normals)
            memcpy(&out[4 * k], &mesh->normals[3 * (size_t)mesh->indices[3 * (size_t)triangle + k]],
                   3 * sizeof(float));
        out[4 * k + 3] = mesh->materials[triangle];
    }
}

/* Whether a material has textures of a UV set that show the same where whole pairs of periods are
   taken off its coordinates. Without textures only a user's functions read them. */
static bool repeats(const struct scene_material *m, int set)
{
    bool used = false;
    for (int slot = 0; slot < SCENE_SLOT_COUNT; ++slot) {
        const struct scene_texture_use *use = &m->textures[slot];
        const float *t = use->transform;
        if (use->texture == SCENE_NONE || (use->uv_set != 0) != set)
            continue;
        if (use->wrap_u == SCENE_WRAP_CLAMP || use->wrap_v == SCENE_WRAP_CLAMP ||
            t[0] != floorf(t[0]) || t[1] != floorf(t[1]) || t[3] != floorf(t[3]) ||
            t[4] != floorf(t[4]))
            return false;
        used = true;
    }
    return used;
}

/* Brings a triangle whose coordinates are far from 0 near it: kernels interpolate in floats. */
static void take_off_periods(float uvs[6])
{
    for (int axis = 0; axis < 2; ++axis) {
        float least = fminf(uvs[axis], fminf(uvs[2 + axis], uvs[4 + axis]));
        float periods =
            fabsf(least) >= 64.0f && isfinite(least) ? 2.0f * floorf(0.5f * least) : 0.0f;
        for (int k = 0; k < 3; ++k)
            uvs[2 * k + axis] -= periods;
    }
}

static void fill_uvs(const struct scene *scene, const struct scene_mesh *mesh, uint32_t triangle,
                     uint32_t *out, int set)
{
    /* Hits on spheres have u and v in place of barycentric weights (shaders/bind/surface.glsl). */
    static const float unit[6] = {0, 0, 1, 0, 0, 1};
    const float *uvs = mesh->uvs[set] ? mesh->uvs[set] : mesh->uvs[0];
    float corners[6];
    memcpy(corners, unit, sizeof corners);
    for (size_t k = 0; uvs && k < 3; ++k)
        memcpy(&corners[2 * k], &uvs[2 * (size_t)mesh->indices[3 * (size_t)triangle + k]],
               2 * sizeof(float));
    if (uvs && repeats(&scene->materials[mesh->materials[triangle]], set))
        take_off_periods(corners);
    if (uvs || mesh->sphere_count)
        memcpy(out, corners, sizeof corners);
}

static void fill_first_uvs(const struct scene *scene, const struct scene_mesh *mesh,
                           uint32_t triangle, uint32_t *out)
{
    fill_uvs(scene, mesh, triangle, out, 0);
}

static void fill_second_uvs(const struct scene *scene, const struct scene_mesh *mesh,
                            uint32_t triangle, uint32_t *out)
{
    fill_uvs(scene, mesh, triangle, out, 1);
}

static uint32_t pack_unorm2x16(float x, float y)
{
    float cx = x < 0.0f ? 0.0f : x > 1.0f ? 1.0f : x, cy = y < 0.0f ? 0.0f : y > 1.0f ? 1.0f : y;
    return (uint32_t)(cx * 65535.0f + 0.5f) | (uint32_t)(cy * 65535.0f + 0.5f) << 16;
}

static void fill_colors(const struct scene *scene, const struct scene_mesh *mesh, uint32_t triangle,
                        uint32_t *out)
{
    (void)scene;
    static const float white[4] = {1, 1, 1, 1};
    for (size_t k = 0; k < 3; ++k) {
        const float *color =
            mesh->colors ? &mesh->colors[4 * (size_t)mesh->indices[3 * (size_t)triangle + k]]
                         : white;
        out[2 * k] = pack_unorm2x16(color[0], color[1]);
        out[2 * k + 1] = pack_unorm2x16(color[2], color[3]);
    }
}

static bool any_mesh(const struct scene *scene, bool (*has)(const struct scene_mesh *mesh))
{
    for (uint32_t i = 0; i < scene->mesh_count; ++i) {
        if (has(&scene->meshes[i]))
            return true;
    }
    return false;
}

static bool has_second_uvs(const struct scene_mesh *mesh)
{
    return mesh->uvs[1] != NULL;
}

/* Sets the first row of each kind of record in renderer->frame. Returns the number of rows. */
static uint64_t lay_out_rows(struct renderer *renderer, uint32_t use_count)
{
    const struct scene *scene = renderer->scene;
    struct scene_buffers *buffers = &renderer->scene_buffers;
    struct gpu_frame *frame = &renderer->frame;
    const bool *called = renderer->effects.called;
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < scene->mesh_count; ++i)
        triangles += scene_mesh_primitives(&scene->meshes[i]);
    buffers->smooth_normals = called[SCENE_EFFECT_SMOOTH_NORMALS];
    buffers->uv_sets = use_count == 0 ? 0 : any_mesh(scene, has_second_uvs) ? 2 : 1;
    buffers->colors = called[SCENE_EFFECT_VERTEX_COLORS];
    uint64_t rows = (uint64_t)scene->material_count * MATERIAL_ROWS;
    frame->use_row = (uint32_t)rows;
    rows += (uint64_t)use_count * TEXTURE_ROWS;
    frame->light_row = (uint32_t)rows;
    rows += (uint64_t)renderer->pose.light_count * LIGHT_ROWS;
    frame->triangle_row = (uint32_t)rows;
    rows += triangles * (buffers->smooth_normals ? TRIANGLE_SHADE_ROWS : TRIANGLE_FLAT_ROWS);
    frame->uv0_row = (uint32_t)rows;
    rows += buffers->uv_sets > 0 ? triangles * TRIANGLE_UV_ROWS : 0;
    frame->uv1_row = buffers->uv_sets > 1 ? (uint32_t)rows : frame->uv0_row;
    rows += buffers->uv_sets > 1 ? triangles * TRIANGLE_UV_ROWS : 0;
    frame->color_row = (uint32_t)rows;
    rows += buffers->colors ? triangles * TRIANGLE_COLOR_ROWS : 0;
    return rows;
}

static whit_result upload_shading(struct renderer *renderer)
{
    struct scene_buffers *buffers = &renderer->scene_buffers;
    const struct gpu_frame *frame = &renderer->frame;
    struct material_records records;
    whit_result result = material_records_init(renderer, &records);
    if (result != WHIT_OK)
        return result;
    uint64_t rows = lay_out_rows(renderer, records.use_count);
    result = buffer_create(renderer->device, rows * ROW_BYTES,
                           buffers->texel_loads ? BUFFER_TEXELS : BUFFER_STORAGE, "shading",
                           &buffers->shading);
    if (result == WHIT_OK)
        result =
            buffer_write(buffers->shading, 0, records.materials,
                         (uint64_t)renderer->scene->material_count * sizeof *records.materials);
    if (result == WHIT_OK && records.use_count)
        result = buffer_write(buffers->shading, (uint64_t)frame->use_row * ROW_BYTES, records.uses,
                              (uint64_t)records.use_count * sizeof *records.uses);
    material_records_finish(&records);
    if (result == WHIT_OK)
        result = lights_write(renderer);
    if (result == WHIT_OK && buffers->smooth_normals)
        result = write_triangles(renderer, frame->triangle_row, TRIANGLE_SHADE_ROWS, fill_normals);
    else if (result == WHIT_OK)
        result = write_triangles(renderer, frame->triangle_row, TRIANGLE_FLAT_ROWS, fill_material);
    if (result == WHIT_OK && buffers->uv_sets > 0)
        result = write_triangles(renderer, frame->uv0_row, TRIANGLE_UV_ROWS, fill_first_uvs);
    if (result == WHIT_OK && buffers->uv_sets > 1)
        result = write_triangles(renderer, frame->uv1_row, TRIANGLE_UV_ROWS, fill_second_uvs);
    if (result == WHIT_OK && buffers->colors)
        result = write_triangles(renderer, frame->color_row, TRIANGLE_COLOR_ROWS, fill_colors);
    if (result == WHIT_OK)
        buffers->bytes += buffer_size(buffers->shading);
    return result;
}

/* Kernels for packets of 2 rays a lane take `kernels_ns` of processor time longer to make than
   those for single rays. Each ray then takes `saved_ns` less for every halving of the tree's
   records beyond PACKETS_HALVINGS. The row for 4 rays compares with 2 likewise, and counts the rays
   to half of the points of an area light, as a pixel traces about as many: by these, packets of 2
   would be chosen for small pictures, which lose by them. Measured, see docs/performance.md. */
static const struct {
    uint32_t rays;
    double kernels_ns, saved_ns;
} packet_choices[] = {{2, 60e6, 18.0}, {4, 90e6, 4.0}};
enum { PACKETS_HALVINGS = 8 };

/* Packets are for lavapipe, with subgroups of eight lanes and shuffles that are single
   instructions. */
bool upload_can_widen(const struct renderer *renderer)
{
    const whit_renderer_params *params = &renderer->params;
    return renderer->scene_buffers.texel_loads && !renderer->accel->no_trees &&
           device_get_info(renderer->device)->subgroup_size == 8 &&
           params->traversal == WHIT_TRAVERSAL_DISTANCE && params->numerics != WHIT_NUMERICS_FAST &&
           params->packets != WHIT_PACKETS_OFF;
}

whit_result upload_wide(struct renderer *renderer)
{
    if (renderer->wide)
        return WHIT_OK;
    renderer->wide = true;
    whit_result result = upload_nodes8(renderer);
    renderer->wide = result == WHIT_OK;
    return result;
}

/* Rays of a lane for packets whose kernels pay, by the camera rays and shadow rays of one picture.
   For many pictures kernels of 2 always pay, and with compile_async, where nobody waits, those of 4
   too. 1: no packets, as with instances, where packets lose inside of them what they gain
   outside. */
static uint32_t choose_packet_rays(const struct renderer *renderer)
{
    const whit_renderer_params *params = &renderer->params;
    const struct accel *accel = renderer->accel;
    double pixels = (double)params->width * views_picture_rows(renderer) * params->sampling.count;
    double halvings = same_log2((double)accel->record_count + 1.0) - PACKETS_HALVINGS;
    uint32_t chosen = 1, area = (lights_samples(renderer) + 1) / 2;
    for (size_t i = 0; i < sizeof packet_choices / sizeof *packet_choices; ++i) {
        double rays = pixels * (1.0 + lights_points(renderer, i ? area : 1));
        bool pays = rays * halvings * packet_choices[i].saved_ns >= packet_choices[i].kernels_ns;
        bool many = params->compile_async || (params->many_pictures && i == 0);
        if (halvings > 0.0 && ((pays && (i == 0 || chosen > 1)) || many))
            chosen = packet_choices[i].rays;
    }
    return accel->flat || accel->single_identity ? chosen : 1;
}

static bool choose_packets(struct renderer *renderer)
{
    renderer->packet_rays = choose_packet_rays(renderer);
    if (renderer->params.packets == WHIT_PACKETS_ON && renderer->packet_rays == 1)
        renderer->packet_rays = packet_choices[0].rays;
    return upload_can_widen(renderer) && renderer->packet_rays > 1 && !renderer->params.count;
}

whit_result upload_choose_packets(struct renderer *renderer)
{
    renderer->packets = choose_packets(renderer);
    whit_result result = renderer->packets ? upload_wide(renderer) : WHIT_OK;
    renderer->packets &= result == WHIT_OK;
    return result;
}

static whit_result upload_environment(struct renderer *renderer)
{
    struct scene_buffers *buffers = &renderer->scene_buffers;
    uint32_t size;
    float *texels;
    buffers->environment_size = 0;
    if (!renderer->effects.called[SCENE_EFFECT_ENVIRONMENT_MAP])
        return WHIT_OK;
    if (!environment_resample(&renderer->scene->environment, &size, &texels))
        return render_no_memory(renderer, "the environment");
    if (!texels)
        return WHIT_OK;
    buffers->environment_size = size;
    whit_result result = upload_words(renderer, texels, (uint64_t)size * size * 4 * sizeof(float),
                                      BUFFER_STORAGE, "environment", &buffers->environment);
    free(texels);
    return result;
}

void upload_choose(struct renderer *renderer)
{
    renderer->scene_buffers.texel_loads = choose_texel_loads(renderer);
    renderer->packets = renderer->wide = choose_packets(renderer);
    renderer->quantized = upload_chooses_quantized(renderer);
}

whit_result upload_scene(struct renderer *renderer)
{
    struct scene_buffers *buffers = &renderer->scene_buffers;
    upload_choose(renderer);
    whit_result result = buffer_create(renderer->device, 16, BUFFER_STORAGE | BUFFER_TEXELS,
                                       "nothing", &buffers->none);
    if (result == WHIT_OK)
        result = upload_trees(renderer);
    if (result == WHIT_OK)
        result = upload_shading(renderer);
    if (result == WHIT_OK)
        result = upload_environment(renderer);
    return result;
}

/* With a tree over instances only its nodes move, which are the first ones. Rays may need it no
   more where the only instance gets to where its file puts it. */
whit_result upload_pose(struct renderer *renderer)
{
    const struct accel *accel = renderer->accel;
    whit_result result = WHIT_OK;
    if (accel->flat) {
        result = upload_trees(renderer);
    } else {
        uint64_t bytes = (uint64_t)accel->instance_node_count * sizeof *accel->nodes;
        if (bytes > 0)
            result = buffer_write(renderer->scene_buffers.nodes, 0, accel->nodes, bytes);
        if (result == WHIT_OK && !renderer->scene_buffers.quantized)
            result = upload_quantized(renderer);
        if (result == WHIT_OK)
            result = upload_nodes8(renderer);
        if (result == WHIT_OK)
            result = upload_instances(renderer);
    }
    return result == WHIT_OK ? lights_write(renderer) : result;
}

void upload_finish(struct scene_buffers *buffers)
{
    struct buffer *all[] = {
        buffers->nodes,     buffers->nodes8,  buffers->quantized,   buffers->triangles,
        buffers->instances, buffers->shading, buffers->environment, buffers->texels,
        buffers->frame,     buffers->none,
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; ++i)
        buffer_destroy(all[i]);
    *buffers = (struct scene_buffers){0};
}
