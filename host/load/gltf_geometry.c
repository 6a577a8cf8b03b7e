/* Triangles of a glTF, read from its accessors; Draco data are decoded by gltf_draco.c. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "load/gltf_draco.h"
#include "load/gltf_geometry.h"
#include "load/gltf_nodes.h"
#include "load/gltf_skin.h"
#include "load/model_mesh.h"
#include "scene/afford.h"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

static const char no_memory[] = "out of memory";

const struct gltf_attribute gltf_attributes[PART_INDICES] = {
    [PART_POSITIONS] = {"POSITION", "VEC3", 3}, [PART_NORMALS] = {"NORMAL", "VEC3", 3},
    [PART_UV0] = {"TEXCOORD_0", "VEC2", 2},     [PART_UV1] = {"TEXCOORD_1", "VEC2", 2},
    [PART_COLORS] = {"COLOR_0", "VEC4", 3},     [PART_TANGENTS] = {"TANGENT", "VEC4", 4},
};

/* --- what the file says --------------------------------------------------------------------- */

static bool plan_attributes(const struct gltf *gltf, const json_t *object,
                            struct gltf_primitive *out)
{
    struct gltf_place at = gltf_place("%.60s.attributes", out->at.text);
    json_t *named;
    if (!gltf_object(gltf, object, &out->at, "attributes", &named))
        return false;
    out->attributes = named;
    for (int i = 0; i < PART_INDICES; i++) {
        struct gltf_accessor *accessor = &out->accessors[i];
        const char *name = gltf_attributes[i].name;
        uint32_t index, most = part_words((enum part_array)i);
        if (!gltf_index(gltf, named, &at, name, gltf_count(gltf, "accessors"), &index))
            return false;
        if (index == SCENE_NONE)
            continue;
        if (!gltf_accessor(gltf, index, accessor))
            return false;
        if (accessor->components < gltf_attributes[i].least || accessor->components > most)
            return gltf_fail(gltf, &at, "%s is not a %s", name, gltf_attributes[i].type);
        if (out->vertex_count == 0)
            out->vertex_count = accessor->count;
        if (accessor->count != out->vertex_count)
            return gltf_fail(gltf, &at, "%s has %u elements where there are %u vertices", name,
                             accessor->count, out->vertex_count);
    }
    return out->accessors[PART_POSITIONS].count || gltf_fail(gltf, &at, "there is no POSITION");
}

static bool plan_indices(const struct gltf *gltf, const json_t *object, struct gltf_primitive *out)
{
    struct gltf_accessor *accessor = &out->accessors[PART_INDICES];
    uint32_t index;
    out->corner_count = out->vertex_count;
    if (!gltf_index(gltf, object, &out->at, "indices", gltf_count(gltf, "accessors"), &index))
        return false;
    if (index == SCENE_NONE)
        return true;
    if (!gltf_accessor(gltf, index, accessor))
        return false;
    out->corner_count = accessor->count;
    return (gltf_is_whole(accessor) && accessor->components == 1) ||
           gltf_fail(gltf, &out->at, "its indices are not unsigned integers");
}

static uint32_t triangles_of(const struct gltf_primitive *primitive)
{
    uint32_t corners = primitive->corner_count;
    if (primitive->mode == MODE_TRIANGLES)
        return corners / 3;
    return corners > 2 ? corners - 2 : 0;
}

/* --- arrays --------------------------------------------------------------------------------- */

/* Converts values from glTF's conventions to those of struct part: v upwards, and the sign of the
   bitangent as 1 or -1. */
static void turn(enum part_array array, float *values, size_t count)
{
    bool uv = array == PART_UV0 || array == PART_UV1;
    for (size_t i = 0; uv && i < count; i++)
        values[2 * i + 1] = 1.0f - values[2 * i + 1];
    for (size_t i = 0; array == PART_TANGENTS && i < count; i++)
        values[4 * i + 3] = values[4 * i + 3] < 0 ? -1.0f : 1.0f;
}

static bool read_vertices(const struct gltf *gltf, const struct gltf_primitive *primitive,
                          struct part *part)
{
    for (int i = 0; i < PART_INDICES; i++) {
        const struct gltf_accessor *accessor = &primitive->accessors[i];
        enum part_array array = (enum part_array)i;
        bool alone = array == PART_TANGENTS && !part->arrays[PART_NORMALS];
        if (accessor->count == 0 || part->arrays[i] || alone)
            continue;
        float *out = part_add(part, array);
        if (!out)
            return gltf_fail(gltf, &primitive->at, no_memory);
        if (!gltf_read_rows(gltf, accessor, part_words(array), out))
            return false;
        turn(array, out, accessor->count);
    }
    return true;
}

/* Corners of a triangle. Every second one of a strip is reversed, so that all have the same
   winding. */
static void corners_of(uint32_t mode, uint32_t triangle, uint32_t out[3])
{
    uint32_t turned = mode == MODE_STRIP && triangle % 2;
    uint32_t first = mode == MODE_TRIANGLES ? 3 * triangle : triangle;
    out[0] = mode == MODE_FAN ? 0 : first + turned;
    out[1] = first + 1 - turned;
    out[2] = first + 2;
}

/* Adds the part's triangles. `corners`: vertex index of each corner; NULL: corner i is vertex i. */
static bool read_triangles(const struct gltf_primitive *primitive, const uint32_t *corners,
                           struct part *part)
{
    part->triangle_count = triangles_of(primitive);
    uint32_t *out = part_add(part, PART_INDICES), used = 0;
    for (uint32_t i = 0; out && i < part->triangle_count; i++) {
        uint32_t *triangle = out + (size_t)used * 3;
        bool good = true;
        corners_of(primitive->mode, i, triangle);
        for (int k = 0; corners && k < 3; k++) {
            triangle[k] = corners[triangle[k]];
            good &= triangle[k] < part->vertex_count;
        }
        used += good;
    }
    part->triangle_count = used;
    return out;
}

static bool read_indices(const struct gltf *gltf, const struct gltf_primitive *primitive,
                         struct part *part)
{
    const struct gltf_accessor *accessor = &primitive->accessors[PART_INDICES];
    uint32_t *corners = accessor->count ? array_alloc(accessor->count, sizeof *corners) : NULL;
    bool read = !corners || gltf_read_whole(gltf, accessor, corners);
    bool made = read && (corners || !accessor->count) && read_triangles(primitive, corners, part);
    free(corners);
    if (!made)
        return read && gltf_fail(gltf, &primitive->at, no_memory);
    return part->triangle_count ||
           gltf_fail(gltf, &primitive->at, "no triangle has all indices below its %u vertices",
                     primitive->vertex_count);
}

/* --- primitives ----------------------------------------------------------------------------- */

struct geometry {
    struct gltf *gltf;
    struct gltf_skin *skins;      /* of the file; read when a node first has them */
    const struct gltf_skin *skin; /* of the mesh that is read, or NULL */
    uint64_t lines_and_points, morphed, tangents;
    bool drawn;
};

/* The primitives of a mesh that are drawn, each as a part. */
struct mesh {
    struct part *parts;
    uint32_t *materials; /* of the scene, by part */
    uint32_t count;
    uint64_t counted_bytes; /* of the arrays of all parts */
};

static void note_lost(const struct gltf *gltf, const struct gltf_primitive *primitive,
                      const struct part *part)
{
    uint32_t promised = triangles_of(primitive);
    if (primitive->mode == MODE_TRIANGLES && primitive->corner_count % 3)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: %s: its last %u corners are no triangle and were dropped",
                   path_name(gltf->request->path), primitive->at.text, primitive->corner_count % 3);
    if (part->triangle_count < promised)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: %s: %u of %u triangles are damaged and were dropped",
                   path_name(gltf->request->path), primitive->at.text,
                   promised - part->triangle_count, promised);
}

/* Checks the memory limit before arrays are allocated and filled, also for what the scene makes of
   them: many primitives may share one accessor, and an accessor may have no data, so the file's
   size does not bound them. */
static bool afford(const struct gltf *gltf, const struct gltf_primitive *primitive,
                   struct mesh *mesh)
{
    uint64_t words = 3 * (uint64_t)triangles_of(primitive);
    for (int i = 0; i < PART_ARRAY_COUNT; i++) {
        const struct gltf_accessor *accessor = &primitive->accessors[i];
        if (accessor->count && !gltf_is_packed(primitive, (enum part_array)i) &&
            !gltf_check_elements(gltf, accessor))
            return false;
        words +=
            (uint64_t)accessor->count * (i == PART_INDICES ? 1 : part_words((enum part_array)i));
    }
    uint64_t later =
        scene_triangle_cost(triangles_of(primitive), primitive->vertex_count, 3 * sizeof(float));
    bool good = scene_could_afford(gltf->scene, &gltf->scene->log, later, primitive->at.text) &&
                scene_afford(gltf->scene, words * 4, "%s of %u vertices", primitive->at.text,
                             primitive->vertex_count);
    mesh->counted_bytes += good ? words * 4 : 0;
    return good;
}

static whit_result material_of(struct gltf *gltf, uint32_t index, uint32_t *material)
{
    if (index != SCENE_NONE) {
        *material = gltf->materials[index];
        return WHIT_OK;
    }
    if (gltf->default_material == SCENE_NONE) {
        struct scene_material plain;
        scene_material_init(&plain, "default");
        plain.model = WHIT_MODEL_METAL_ROUGH;
        for (int i = 0; i < 3; i++)
            plain.diffuse[i] = plain.specular[i] = 1.0f;
        plain.metallic = 0.0f; /* glTF's default, a fully rough metal, mirrors nothing here */
        gltf->default_material = scene_add_material(gltf->scene, plain);
    }
    *material = gltf->default_material;
    return *material == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

static whit_result read_primitive(struct gltf *gltf, const struct gltf_primitive *primitive,
                                  const struct gltf_skin *skin, struct mesh *mesh)
{
    uint32_t *material = &mesh->materials[mesh->count];
    struct part *part = &mesh->parts[mesh->count++];
    part->vertex_count = primitive->vertex_count;
    if (!afford(gltf, primitive, mesh))
        return WHIT_ERROR_INPUT;
    whit_result result = primitive->draco ? gltf_unpack(gltf, primitive, part) : WHIT_OK;
    if (result != WHIT_OK)
        return result;
    if (!read_vertices(gltf, primitive, part) ||
        (!part->arrays[PART_INDICES] && !read_indices(gltf, primitive, part)) ||
        (skin && !gltf_skin_apply(gltf, skin, primitive, part)))
        return WHIT_ERROR_INPUT;
    note_lost(gltf, primitive, part);
    return material_of(gltf, primitive->material, material);
}

static bool has_map_with_tangents(const struct gltf *gltf, const struct gltf_primitive *primitive)
{
    if (!primitive->accessors[PART_TANGENTS].count || primitive->material == SCENE_NONE)
        return false;
    const struct scene_material *m = &gltf->scene->materials[gltf->materials[primitive->material]];
    return m->textures[SCENE_SLOT_NORMAL].texture != SCENE_NONE;
}

static whit_result add_primitive(struct geometry *geometry, const struct gltf_place *at,
                                 const json_t *object, struct mesh *mesh)
{
    struct gltf *gltf = geometry->gltf;
    struct gltf_primitive primitive = {.at = *at};
    uint64_t mode = MODE_TRIANGLES;
    json_t *draco, *targets;
    if (!json_is_object(object)) {
        gltf_fail(gltf, at, "should be an object");
        return WHIT_ERROR_INPUT;
    }
    if (!gltf_whole(gltf, object, at, "mode", MODE_FAN, &mode) ||
        !gltf_index(gltf, object, at, "material", gltf->material_count, &primitive.material) ||
        !gltf_array(gltf, object, at, "targets", &targets) ||
        !gltf_extension(gltf, object, at, "KHR_draco_mesh_compression", &draco))
        return WHIT_ERROR_INPUT;
    if (mode < MODE_TRIANGLES) {
        geometry->lines_and_points++;
        return WHIT_OK;
    }
    primitive.mode = (uint32_t)mode;
    primitive.draco = draco;
    geometry->morphed += json_array_size(targets) > 0;
    if (!plan_attributes(gltf, object, &primitive) || !plan_indices(gltf, object, &primitive))
        return WHIT_ERROR_INPUT;
    if (triangles_of(&primitive) == 0)
        return WHIT_OK;
    geometry->drawn = true;
    geometry->tangents += has_map_with_tangents(gltf, &primitive);
    return read_primitive(gltf, &primitive, geometry->skin, mesh);
}

/* --- meshes --------------------------------------------------------------------------------- */

static whit_result read_mesh(struct geometry *geometry, uint32_t index, const json_t *primitives,
                             struct mesh *mesh)
{
    size_t count = json_array_size(primitives);
    mesh->parts = array_alloc_zeroed(count, sizeof *mesh->parts);
    mesh->materials = array_alloc(count, sizeof *mesh->materials);
    whit_result result = mesh->parts && mesh->materials ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (size_t i = 0; i < count && result == WHIT_OK; i++) {
        struct gltf_place at = gltf_place("meshes[%u].primitives[%zu]", index, i);
        result = add_primitive(geometry, &at, json_array_get(primitives, i), mesh);
    }
    bool complete = result != WHIT_OK || parts_complete(mesh->parts, mesh->count, false);
    return complete ? result : WHIT_ERROR_MEMORY;
}

static whit_result load_mesh(struct geometry *geometry, uint32_t index, uint32_t *out)
{
    struct gltf *gltf = geometry->gltf;
    struct mesh mesh = {0};
    struct gltf_place at;
    json_t *object, *primitives;
    const char *name;
    if (!gltf_item(gltf, "meshes", index, &at, &object) ||
        !gltf_array(gltf, object, &at, "primitives", &primitives) ||
        !gltf_string(gltf, object, &at, "name", &name))
        return WHIT_ERROR_INPUT;
    whit_result result = read_mesh(geometry, index, primitives, &mesh);
    scene_give_back(gltf->scene, mesh.counted_bytes); /* the scene's own copy is counted instead */
    if (result == WHIT_OK && mesh.count)
        result = model_add_mesh(gltf->scene, name ? name : at.text, mesh.parts, mesh.materials,
                                mesh.count, false, out);
    for (uint32_t i = 0; i < mesh.count; i++)
        part_finish(&mesh.parts[i]);
    free(mesh.parts);
    free(mesh.materials);
    return result;
}

/* Loads the mesh of a node with a skin, which has vertices of its own. */
static whit_result load_skinned(struct geometry *geometry, uint32_t node)
{
    struct gltf *gltf = geometry->gltf;
    uint32_t mesh, index;
    if (!gltf_node_mesh(gltf, node, &mesh, &index))
        return WHIT_ERROR_INPUT;
    if (mesh == SCENE_NONE || index == SCENE_NONE)
        return WHIT_OK;
    struct gltf_skin *skin = &geometry->skins[index];
    if (!skin->moves && !gltf_skin_read(gltf, index, skin))
        return WHIT_ERROR_INPUT;
    geometry->skin = skin;
    whit_result result = load_mesh(geometry, mesh, &gltf->skinned[node]);
    geometry->skin = NULL;
    return result;
}

static whit_result load_all_skinned(struct geometry *geometry)
{
    struct gltf *gltf = geometry->gltf;
    uint32_t skins = gltf_count(gltf, "skins");
    geometry->skins = array_alloc_zeroed(skins, sizeof *geometry->skins);
    whit_result result = geometry->skins ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < gltf->order_count && result == WHIT_OK; i++)
        result = load_skinned(geometry, gltf->order[i]);
    for (uint32_t i = 0; geometry->skins && i < skins; i++)
        gltf_skin_finish(gltf, &geometry->skins[i]);
    free(geometry->skins);
    return result;
}

/* Notes what is not drawn. Only lines and points are an error, as in other formats. */
static whit_result note_dropped(const struct geometry *geometry)
{
    const char *name = path_name(geometry->gltf->request->path);
    struct scene *scene = geometry->gltf->scene;
    if (geometry->lines_and_points && !geometry->drawn)
        return log_failure(&scene->log, WHIT_ERROR_INPUT,
                           "%s: there are no triangles in it (%llu primitives of points or lines)",
                           geometry->gltf->request->path,
                           (unsigned long long)geometry->lines_and_points);
    if (geometry->lines_and_points)
        scene_note(scene, SCENE_NOTE_INFO, "%s: %llu primitives of points or lines are not drawn",
                   name, (unsigned long long)geometry->lines_and_points);
    if (geometry->morphed)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: morph targets are not applied (%llu primitives)",
                   name, (unsigned long long)geometry->morphed);
    if (geometry->tangents)
        scene_note(
            scene, SCENE_NOTE_INFO,
            "%s: tangents are not read, normal maps lie as their texture coordinates do (%llu "
            "primitives)",
            name, (unsigned long long)geometry->tangents);
    if (!geometry->drawn)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: there are no triangles in it", name);
    return WHIT_OK;
}

whit_result gltf_load_meshes(struct gltf *gltf)
{
    struct geometry geometry = {.gltf = gltf};
    whit_result result = WHIT_OK;
    for (uint32_t i = 0; i < gltf->mesh_count && result == WHIT_OK; i++)
        if (gltf->mesh_used[i])
            result = load_mesh(&geometry, i, &gltf->meshes[i]);
    if (result == WHIT_OK)
        result = load_all_skinned(&geometry);
    return result == WHIT_OK ? note_dropped(&geometry) : result;
}
