/* Decodes the Draco data of a primitive with assimp, in its child process. assimp gets a small glTF
   of this one primitive and its compressed bytes, and nothing else of the file. */
#include <stdlib.h>
#include <string.h>

#include "load/gltf_accessor.h"
#include "load/gltf_buffer.h"
#include "load/gltf_draco.h"
#include "load/gltf_json.h"

/* assimp 5.2 loses decoded indices of 32 bits, so it is asked for 16 bits. */
enum { ASSIMP_VERTICES_MAX = 65536 };

bool gltf_is_packed(const struct gltf_primitive *primitive, enum part_array array)
{
    const json_t *packed = json_object_get(primitive->draco, "attributes");
    return array == PART_INDICES ? primitive->draco != NULL
                                 : json_object_get(packed, gltf_attributes[array].name) != NULL;
}

/* JSON of the glTF that assimp is given, while it is built. */
struct small {
    json_t *accessors, *attributes, *packed, *primitive;
};

static bool add_accessor(struct small *small, const struct gltf_accessor *accessor,
                         uint32_t component)
{
    static const char *const types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    json_t *made = json_pack("{s:I,s:I,s:s}", "componentType", (json_int_t)component, "count",
                             (json_int_t)accessor->count, "type", types[accessor->components - 1]);
    return json_array_append_new(small->accessors, made) == 0;
}

/* Whether assimp 5.2 can decode the array: colours may be integers, all others must be floats. */
static bool check_component(const struct gltf *gltf, const struct gltf_primitive *primitive,
                            enum part_array array)
{
    uint32_t component = primitive->accessors[array].component;
    bool color = array == PART_COLORS && (component == 5121 || component == 5123);
    return component == GLTF_FLOAT || color ||
           gltf_fail(gltf, &primitive->at, "its %s is packed by Draco and is not of floats",
                     gltf_attributes[array].name);
}

static bool add_attributes(const struct gltf *gltf, const struct gltf_primitive *primitive,
                           struct small *small)
{
    const struct gltf_accessor *indices = &primitive->accessors[PART_INDICES];
    struct gltf_place at = gltf_place("%.60s.draco", primitive->at.text);
    json_t *ids;
    bool made = true;
    if (!gltf_object(gltf, primitive->draco, &at, "attributes", &ids))
        return false;
    if (!gltf_is_packed(primitive, PART_POSITIONS))
        return gltf_fail(gltf, &at, "there is no POSITION");
    if (indices->count && primitive->vertex_count > ASSIMP_VERTICES_MAX)
        return gltf_fail(gltf, &at, "of %u vertices: at most %u can be unpacked",
                         primitive->vertex_count, ASSIMP_VERTICES_MAX);
    for (int i = 0; i < PART_INDICES && made; i++) {
        const struct gltf_accessor *accessor = &primitive->accessors[i];
        const char *name = gltf_attributes[i].name;
        uint64_t id = 0;
        if (accessor->count == 0 || !gltf_is_packed(primitive, (enum part_array)i))
            continue;
        if (!check_component(gltf, primitive, (enum part_array)i) ||
            !gltf_whole(gltf, ids, &at, name, UINT32_MAX, &id))
            return false;
        json_int_t index = (json_int_t)json_array_size(small->accessors);
        made = json_object_set_new(small->attributes, name, json_integer(index)) == 0 &&
               json_object_set_new(small->packed, name, json_integer((json_int_t)id)) == 0 &&
               add_accessor(small, accessor, accessor->component);
    }
    json_int_t index = (json_int_t)json_array_size(small->accessors);
    if (indices->count)
        made = made && json_object_set_new(small->primitive, "indices", json_integer(index)) == 0 &&
               add_accessor(small, indices, GLTF_UNSIGNED_SHORT);
    return made || gltf_fail(gltf, &at, "out of memory");
}

/* The JSON of a glTF for assimp, with one buffer of `size_bytes` compressed bytes; NULL after an
   error. */
static char *write_small(const struct gltf *gltf, const struct gltf_primitive *primitive,
                         size_t size_bytes)
{
    const char *draco = "KHR_draco_mesh_compression";
    struct small small = {json_array(), json_object(), json_object(), json_object()};
    bool planned = add_attributes(gltf, primitive, &small);
    json_int_t bytes = (json_int_t)size_bytes;
    json_t *extension =
        json_pack("{s:{s:i,s:O}}", draco, "bufferView", 0, "attributes", small.packed);
    bool made = planned && extension &&
                json_object_set(small.primitive, "attributes", small.attributes) == 0 &&
                json_object_set(small.primitive, "extensions", extension) == 0 &&
                json_object_set_new(small.primitive, "mode", json_integer(primitive->mode)) == 0;
    json_t *root =
        json_pack("{s:{s:s},s:[s],s:[s],s:i,s:[{s:[i]}],s:[{s:i}],s:[{s:[O]}],s:O,s:[{s:i,s:I}],s:["
                  "{s:s,s:I}]}",
                  "asset", "version", "2.0", "extensionsUsed", draco, "extensionsRequired", draco,
                  "scene", 0, "scenes", "nodes", 0, "nodes", "mesh", 0, "meshes", "primitives",
                  small.primitive, "accessors", small.accessors, "bufferViews", "buffer", 0,
                  "byteLength", bytes, "buffers", "uri", "0.bin", "byteLength", bytes);
    char *text = made && root ? json_dumps(root, JSON_COMPACT) : NULL;
    if (planned && !text)
        gltf_fail(gltf, &primitive->at, "out of memory");
    json_decref(root);
    json_decref(extension);
    json_decref(small.accessors);
    json_decref(small.attributes);
    json_decref(small.packed);
    json_decref(small.primitive);
    return text;
}

static whit_result take(const struct gltf *gltf, const struct gltf_primitive *primitive,
                        const struct import_block *block, struct part *part)
{
    const struct part *from = block->parts;
    if (block->part_count != 1 || from->vertex_count != primitive->vertex_count) {
        gltf_fail(gltf, &primitive->at, "Draco has other vertices than its accessors say");
        return WHIT_ERROR_INPUT;
    }
    part->triangle_count = from->triangle_count;
    for (int i = 0; i < PART_ARRAY_COUNT; i++) {
        enum part_array array = (enum part_array)i;
        if (from->arrays[i] && !part_add(part, array))
            return WHIT_ERROR_MEMORY;
        if (from->arrays[i])
            memcpy(part->arrays[i], from->arrays[i], part_bytes(part, array));
    }
    float *colors = part->arrays[PART_COLORS];
    bool opaque = primitive->accessors[PART_COLORS].components == 3;
    for (size_t i = 0; colors && opaque && i < part->vertex_count; i++)
        colors[4 * i + 3] = 1.0f; /* assimp sets alpha to 0 where the file has none */
    return WHIT_OK;
}

whit_result gltf_unpack(const struct gltf *gltf, const struct gltf_primitive *primitive,
                        struct part *part)
{
    struct import_file files[2] = {{.name = "model.gltf"}, {.name = "0.bin"}};
    struct import_block block = {0};
    uint32_t view;
    if (!gltf_index(gltf, primitive->draco, &primitive->at, "bufferView",
                    gltf_count(gltf, "bufferViews"), &view))
        return WHIT_ERROR_INPUT;
    if (view == SCENE_NONE) {
        gltf_fail(gltf, &primitive->at, "Draco has no bufferView");
        return WHIT_ERROR_INPUT;
    }
    if (!gltf_view(gltf, view, &files[1].data, &files[1].size_bytes, NULL))
        return WHIT_ERROR_INPUT;
    char *text = write_small(gltf, primitive, files[1].size_bytes);
    if (!text)
        return WHIT_ERROR_INPUT;
    files[0].data = (const uint8_t *)text;
    files[0].size_bytes = strlen(text);
    const struct import_request request = {IMPORT_GLTF, files, 2, false};
    whit_result result = importer_run(&gltf->scene->log, gltf->request->path, &request,
                                      gltf->request->params, &block);
    if (result == WHIT_OK)
        result = take(gltf, primitive, &block, part);
    importer_finish(&block);
    free(text);
    return result;
}
