/* Triangles of a glTF by assimp. It is given a smaller file made from the JSON: each primitive that
   is drawn as a mesh of its own, whose name tells which it is, and nothing else; so the way back
   does not depend on the order in which assimp loads things, and its readers of materials, images,
   skins and nodes never run. What assimp 5.2 reads wrongly (attributes that are not floats) is
   converted here before. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "load/gltf.h"
#include "scene/afford.h"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5, MODE_FAN = 6 };

struct drawn {
    uint32_t mesh, primitive, material; /* of the file; material SCENE_NONE: the default */
    uint32_t triangles;                 /* that the file promises */
    uint32_t part;                      /* of the block, or SCENE_NONE */
};

struct geometry {
    struct gltf *gltf;
    json_t *meshes, *accessors, *views, *buffers; /* of the smaller file */
    struct gltf_bytes *floats;                    /* attributes converted, a buffer each */
    uint32_t *converted;    /* of each accessor of the file that of its floats, or SCENE_NONE */
    uint64_t counted_bytes; /* of these */
    struct drawn *drawn;
    uint32_t float_count, float_capacity, drawn_count, drawn_capacity;
    uint64_t lines_and_points, morphed;
    bool draco;
};

static const char no_memory[] = "out of memory";

static bool set_new(json_t *object, const char *key, json_t *value)
{
    return json_object_set_new(object, key, value) == 0;
}

/* --- attributes ----------------------------------------------------------------------------- */

/* Appends the accessor's values as floats: a new buffer, view and accessor of the smaller file. */
static bool convert(struct geometry *geometry, const struct gltf_place *at, uint32_t accessor,
                    const char *type, uint32_t components, uint32_t *index)
{
    float *values;
    uint32_t count;
    if (!gltf_read_floats(geometry->gltf, accessor, components, &values, &count))
        return false;
    size_t bytes = (size_t)count * components * sizeof *values;
    if (!scene_afford(geometry->gltf->scene, bytes, "accessors[%u] as floats", accessor)) {
        free(values);
        return false;
    }
    geometry->counted_bytes += bytes;
    struct gltf_bytes floats = {(const uint8_t *)values, bytes, (uint8_t *)values};
    if (!ARRAY_PUSH(geometry->floats, geometry->float_count, geometry->float_capacity, floats)) {
        free(values);
        return gltf_fail(geometry->gltf, at, no_memory);
    }
    uint32_t buffer = geometry->gltf->buffer_count + geometry->float_count - 1;
    char name[24];
    snprintf(name, sizeof name, "%u.bin", buffer);
    *index = (uint32_t)json_array_size(geometry->accessors);
    size_t view = json_array_size(geometry->views);
    json_t *b = json_pack("{s:s,s:I}", "uri", name, "byteLength", (json_int_t)bytes);
    json_t *v =
        json_pack("{s:I,s:I}", "buffer", (json_int_t)buffer, "byteLength", (json_int_t)bytes);
    json_t *a = json_pack("{s:I,s:i,s:I,s:s}", "bufferView", (json_int_t)view, "componentType",
                          GLTF_FLOAT, "count", (json_int_t)count, "type", type);
    bool appended = json_array_append_new(geometry->buffers, b) == 0;
    appended = json_array_append_new(geometry->views, v) == 0 && appended;
    appended = json_array_append_new(geometry->accessors, a) == 0 && appended;
    return appended || gltf_fail(geometry->gltf, at, no_memory);
}

/* Once, however many primitives use it. *index becomes that of the floats. */
static bool convert_once(struct geometry *geometry, const struct gltf_place *at,
                         const struct gltf_accessor *accessor, const char *type, uint32_t *index)
{
    uint32_t count = gltf_count(geometry->gltf, "accessors"), *converted = geometry->converted;
    if (!converted) {
        converted = geometry->converted = array_alloc(count, sizeof *converted);
        for (uint32_t i = 0; converted && i < count; i++)
            converted[i] = SCENE_NONE;
    }
    if (!converted)
        return gltf_fail(geometry->gltf, at, no_memory);
    uint32_t *known = &converted[*index];
    if (*known == SCENE_NONE && !convert(geometry, at, *index, type, accessor->components, known))
        return false;
    *index = *known;
    return true;
}

static bool add_attributes(struct geometry *geometry, const json_t *primitive,
                           const struct gltf_place *at, const json_t *draco, json_t *out,
                           uint32_t *vertex_count)
{
    static const struct {
        const char *name, *type;
        uint32_t components;
    } wanted[] = {{"POSITION", "VEC3", 3},   {"NORMAL", "VEC3", 3},     {"TANGENT", "VEC4", 4},
                  {"TEXCOORD_0", "VEC2", 2}, {"TEXCOORD_1", "VEC2", 2}, {"COLOR_0", "VEC4", 0}};
    struct gltf_place place = gltf_place("%.60s.attributes", at->text);
    const struct gltf *gltf = geometry->gltf;
    json_t *attributes, *packed = json_object_get(draco, "attributes");
    if (!gltf_object(gltf, primitive, at, "attributes", &attributes))
        return false;
    for (size_t i = 0; attributes && i < sizeof wanted / sizeof *wanted; i++) {
        uint32_t index;
        struct gltf_accessor accessor;
        if (!gltf_index(gltf, attributes, &place, wanted[i].name, gltf_count(gltf, "accessors"),
                        &index))
            return false;
        if (index == SCENE_NONE)
            continue;
        if (!gltf_accessor(gltf, index, &accessor))
            return false;
        bool color = wanted[i].components == 0;
        if (color ? accessor.components < 3 || accessor.components > 4
                  : accessor.components != wanted[i].components)
            return gltf_fail(gltf, &place, "%s is not a %s", wanted[i].name, wanted[i].type);
        if (*vertex_count == 0)
            *vertex_count = accessor.count;
        if (accessor.count != *vertex_count)
            return gltf_fail(gltf, &place, "%s has %u elements where there are %u vertices",
                             wanted[i].name, accessor.count, *vertex_count);
        bool is_packed = json_object_get(packed, wanted[i].name) != NULL;
        if (accessor.component != GLTF_FLOAT && !is_packed &&
            !convert_once(geometry, &place, &accessor,
                          accessor.components == 3 ? "VEC3" : wanted[i].type, &index))
            return false;
        if (!set_new(out, wanted[i].name, json_integer(index)))
            return gltf_fail(gltf, &place, no_memory);
    }
    return json_object_get(out, "POSITION") || gltf_fail(gltf, &place, "there is no POSITION");
}

/* --- primitives ----------------------------------------------------------------------------- */

static uint32_t triangles_of(uint64_t mode, uint32_t corners)
{
    if (mode == MODE_TRIANGLES)
        return corners / 3;
    return corners > 2 ? corners - 2 : 0;
}

/* Indices of the primitive: their accessor's index (or SCENE_NONE) and the number of corners. */
static bool check_indices(const struct gltf *gltf, const json_t *primitive,
                          const struct gltf_place *at, uint32_t vertex_count, uint32_t *index,
                          uint32_t *corners)
{
    struct gltf_accessor accessor;
    *corners = vertex_count;
    if (!gltf_index(gltf, primitive, at, "indices", gltf_count(gltf, "accessors"), index))
        return false;
    if (*index == SCENE_NONE)
        return true;
    if (!gltf_accessor(gltf, *index, &accessor))
        return false;
    *corners = accessor.count;
    bool whole =
        accessor.component == 5121 || accessor.component == 5123 || accessor.component == 5125;
    return (whole && accessor.components == 1) ||
           gltf_fail(gltf, at, "its indices are not unsigned integers");
}

static bool pack_primitive(struct geometry *geometry, const struct drawn *drawn, uint64_t mode,
                           uint32_t indices, json_t *attributes, json_t *draco)
{
    char name[32];
    snprintf(name, sizeof name, "m%up%u", drawn->mesh, drawn->primitive);
    json_t *packed = json_pack("{s:O,s:I}", "attributes", attributes, "mode", (json_int_t)mode);
    json_t *mesh = json_pack("{s:s,s:[o]}", "name", name, "primitives", packed);
    if (!mesh)
        return false;
    bool ok = indices == SCENE_NONE || set_new(packed, "indices", json_integer(indices));
    if (draco)
        ok = ok &&
             set_new(packed, "extensions", json_pack("{s:O}", "KHR_draco_mesh_compression", draco));
    return json_array_append_new(geometry->meshes, mesh) == 0 && ok;
}

static bool plan_primitive(struct geometry *geometry, uint32_t mesh, uint32_t index,
                           const json_t *primitive)
{
    const struct gltf *gltf = geometry->gltf;
    struct gltf_place at = gltf_place("meshes[%u].primitives[%u]", mesh, index);
    struct drawn drawn = {.mesh = mesh, .primitive = index, .part = SCENE_NONE};
    json_t *draco, *targets;
    uint64_t mode = MODE_TRIANGLES;
    uint32_t indices, vertex_count = 0, corners;
    if (!json_is_object(primitive))
        return gltf_fail(gltf, &at, "should be an object");
    if (!gltf_whole(gltf, primitive, &at, "mode", MODE_FAN, &mode) ||
        !gltf_index(gltf, primitive, &at, "material", gltf->material_count, &drawn.material) ||
        !gltf_array(gltf, primitive, &at, "targets", &targets) ||
        !gltf_extension(gltf, primitive, &at, "KHR_draco_mesh_compression", &draco))
        return false;
    if (mode < MODE_TRIANGLES) {
        geometry->lines_and_points++;
        return true;
    }
    geometry->morphed += json_array_size(targets) > 0;
    geometry->draco |= draco != NULL;
    json_t *attributes = json_object();
    bool ok = (attributes || gltf_fail(gltf, &at, no_memory)) &&
              add_attributes(geometry, primitive, &at, draco, attributes, &vertex_count) &&
              check_indices(gltf, primitive, &at, vertex_count, &indices, &corners);
    if (ok) {
        drawn.triangles = triangles_of(mode, corners);
        ok =
            drawn.triangles == 0 ||
            (pack_primitive(geometry, &drawn, mode, indices, attributes, draco) &&
             ARRAY_PUSH(geometry->drawn, geometry->drawn_count, geometry->drawn_capacity, drawn)) ||
            gltf_fail(gltf, &at, no_memory);
    }
    json_decref(attributes);
    return ok;
}

static bool plan_mesh(struct geometry *geometry, uint32_t index)
{
    const struct gltf *gltf = geometry->gltf;
    struct gltf_place at;
    json_t *mesh, *primitives, *primitive;
    size_t i;
    if (!gltf_item(gltf, "meshes", index, &at, &mesh) ||
        !gltf_array(gltf, mesh, &at, "primitives", &primitives))
        return false;
    json_array_foreach(primitives, i, primitive)
    {
        if (!plan_primitive(geometry, index, (uint32_t)i, primitive))
            return false;
    }
    return true;
}

/* --- the smaller file ----------------------------------------------------------------------- */

static bool begin(struct geometry *geometry)
{
    const struct gltf *gltf = geometry->gltf;
    json_t *accessors = json_object_get(gltf->root, "accessors");
    json_t *views = json_object_get(gltf->root, "bufferViews");
    geometry->meshes = json_array();
    geometry->accessors = accessors ? json_copy(accessors) : json_array();
    geometry->views = views ? json_copy(views) : json_array();
    geometry->buffers = json_array();
    for (uint32_t i = 0; geometry->buffers && i < gltf->buffer_count; i++) {
        char name[24];
        snprintf(name, sizeof name, "%u.bin", i);
        json_t *buffer = json_pack("{s:s,s:I}", "uri", name, "byteLength",
                                   (json_int_t)gltf->buffers[i].size_bytes);
        if (json_array_append_new(geometry->buffers, buffer) != 0)
            return false;
    }
    return geometry->meshes && geometry->accessors && geometry->views && geometry->buffers;
}

static char *write_smaller(const struct geometry *geometry)
{
    json_t *roots = json_array(), *nodes = json_array();
    bool ok = roots && nodes;
    for (uint32_t i = 0; ok && i < geometry->drawn_count; i++)
        ok = json_array_append_new(roots, json_integer(i)) == 0 &&
             json_array_append_new(nodes, json_pack("{s:I}", "mesh", (json_int_t)i)) == 0;
    json_t *root = json_pack("{s:{s:s},s:i,s:[{s:o}],s:o,s:O,s:O,s:O,s:O}", "asset", "version",
                             "2.0", "scene", 0, "scenes", "nodes", roots, "nodes", nodes, "meshes",
                             geometry->meshes, "accessors", geometry->accessors, "bufferViews",
                             geometry->views, "buffers", geometry->buffers);
    const char *draco = "KHR_draco_mesh_compression";
    if (root && geometry->draco)
        ok = ok && set_new(root, "extensionsUsed", json_pack("[s]", draco)) &&
             set_new(root, "extensionsRequired", json_pack("[s]", draco));
    char *text = root && ok ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);
    return text;
}

static whit_result import(const struct geometry *geometry, struct import_block *block)
{
    const struct gltf *gltf = geometry->gltf;
    uint32_t buffers = gltf->buffer_count, count = 1 + buffers + geometry->float_count;
    char(*names)[24] = array_alloc_zeroed(count, sizeof *names);
    struct import_file *files = array_alloc_zeroed(count, sizeof *files);
    char *text = write_smaller(geometry);
    whit_result result = WHIT_ERROR_MEMORY;
    if (names && files && text) {
        files[0] = (struct import_file){"model.gltf", (const uint8_t *)text, strlen(text)};
        for (uint32_t i = 0; i + 1 < count; i++) {
            const struct gltf_bytes *bytes =
                i < buffers ? &gltf->buffers[i] : &geometry->floats[i - buffers];
            snprintf(names[i], sizeof names[i], "%u.bin", i);
            files[i + 1] = (struct import_file){names[i], bytes->data, bytes->size_bytes};
        }
        const struct import_request request = {IMPORT_GLTF, files, count};
        result = importer_run(&gltf->scene->log, gltf->request->path, &request,
                              gltf->request->params, block);
    }
    free(text);
    free(files);
    free(names);
    return result;
}

/* --- meshes of the scene -------------------------------------------------------------------- */

static whit_result material_of(struct gltf *gltf, uint32_t index, uint32_t *material)
{
    if (index != SCENE_NONE) {
        *material = gltf->materials[index];
        return WHIT_OK;
    }
    if (gltf->default_material == SCENE_NONE) {
        struct scene_material plain;
        scene_material_init(&plain, "default");
        plain.model = SCENE_MODEL_METAL_ROUGH;
        for (int i = 0; i < 3; i++)
            plain.diffuse[i] = plain.specular[i] = 1.0f;
        plain.metallic = 0.0f; /* the format's own default, a rough metal, reflects nothing here */
        gltf->default_material = scene_add_material(gltf->scene, plain);
    }
    *material = gltf->default_material;
    return *material == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

static void match_parts(struct geometry *geometry, const struct import_block *block)
{
    for (uint32_t i = 0, next = 0; i < block->part_count; i++) {
        unsigned mesh, primitive;
        if (sscanf(block->parts[i].name, "m%up%u", &mesh, &primitive) != 2)
            continue;
        /* assimp keeps the order, so the search is short. */
        for (uint32_t k = 0; k < geometry->drawn_count; k++) {
            struct drawn *drawn = &geometry->drawn[(next + k) % geometry->drawn_count];
            if (drawn->mesh != mesh || drawn->primitive != primitive)
                continue;
            drawn->part = i;
            next = (next + k + 1) % geometry->drawn_count;
            break;
        }
    }
}

static void note_lost(const struct gltf *gltf, const struct drawn *drawn, uint32_t got)
{
    if (got < drawn->triangles)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: meshes[%u].primitives[%u]: %u of %u triangles are damaged and were dropped",
                   path_name(gltf->request->path), drawn->mesh, drawn->primitive,
                   drawn->triangles - got, drawn->triangles);
}

/* Adds the mesh of drawn[first ... end). */
static whit_result add_mesh(struct geometry *geometry, const struct import_block *block,
                            uint32_t first, uint32_t end)
{
    struct gltf *gltf = geometry->gltf;
    uint32_t index = geometry->drawn[first].mesh, used = 0;
    struct gltf_place at;
    json_t *object;
    const char *name;
    if (!gltf_item(gltf, "meshes", index, &at, &object) ||
        !gltf_string(gltf, object, &at, "name", &name))
        return WHIT_ERROR_INPUT;
    struct model_part *parts = array_alloc_zeroed(end - first, sizeof *parts);
    whit_result result = parts ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = first; i < end && result == WHIT_OK; i++) {
        const struct drawn *drawn = &geometry->drawn[i];
        const struct import_part *part =
            drawn->part == SCENE_NONE ? NULL : &block->parts[drawn->part];
        note_lost(gltf, drawn, part ? part->triangle_count : 0);
        if (!part)
            continue;
        parts[used].part = part;
        parts[used].name = name ? name : at.text;
        result = material_of(gltf, drawn->material, &parts[used].material);
        used++;
    }
    if (result == WHIT_OK && used)
        result = model_add_mesh(gltf->scene, name ? name : at.text, parts, used, false,
                                &gltf->meshes[index]);
    free(parts);
    return result;
}

static void note_dropped(const struct geometry *geometry)
{
    const char *name = path_name(geometry->gltf->request->path);
    struct scene *scene = geometry->gltf->scene;
    if (geometry->lines_and_points)
        scene_note(scene, SCENE_NOTE_INFO, "%s: %llu primitives of points or lines are not drawn",
                   name, (unsigned long long)geometry->lines_and_points);
    if (geometry->morphed)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: morph targets are not applied (%llu primitives)",
                   name, (unsigned long long)geometry->morphed);
}

static whit_result load(struct geometry *geometry, struct import_block *block)
{
    struct gltf *gltf = geometry->gltf;
    if (!begin(geometry))
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < gltf->mesh_count; i++)
        if (gltf->mesh_used[i] && !plan_mesh(geometry, i))
            return WHIT_ERROR_INPUT;
    note_dropped(geometry);
    if (geometry->drawn_count == 0) {
        scene_note(gltf->scene, SCENE_NOTE_WARNING, "%s: there are no triangles in it",
                   path_name(gltf->request->path));
        return WHIT_OK;
    }
    whit_result result = import(geometry, block);
    if (result == WHIT_OK)
        match_parts(geometry, block);
    for (uint32_t first = 0, end; result == WHIT_OK && first < geometry->drawn_count; first = end) {
        for (end = first + 1; end < geometry->drawn_count; end++)
            if (geometry->drawn[end].mesh != geometry->drawn[first].mesh)
                break;
        result = add_mesh(geometry, block, first, end);
    }
    return result;
}

whit_result gltf_load_meshes(struct gltf *gltf)
{
    struct geometry geometry = {.gltf = gltf};
    struct import_block block = {0};
    whit_result result = load(&geometry, &block);
    importer_finish(&block);
    for (uint32_t i = 0; i < geometry.float_count; i++)
        free(geometry.floats[i].owned);
    free(geometry.floats);
    free(geometry.converted);
    scene_give_back(gltf->scene, geometry.counted_bytes);
    free(geometry.drawn);
    json_decref(geometry.meshes);
    json_decref(geometry.accessors);
    json_decref(geometry.views);
    json_decref(geometry.buffers);
    return result;
}
