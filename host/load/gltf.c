#include "load/gltf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/path.h"
#include "base/text.h"
#include "load/format.h"
#include "load/gltf_buffer.h"
#include "load/gltf_geometry.h"
#include "load/gltf_json.h"
#include "load/gltf_nodes.h"
#include "load/texture_ahead.h"
#include "scene/afford.h"

enum {
    GLB_MAGIC = 0x46546c67,
    GLB_JSON = 0x4e4f534a,
    GLB_BIN = 0x004e4942,
    GLB_HEADER_BYTES = 12,
    GLB_CHUNK_BYTES = 8,
};

/* --- file to JSON --------------------------------------------------------------------------- */

static bool fail_file(const struct gltf *gltf, const char *reason)
{
    log_error(&gltf->scene->log, "%s: %s", gltf->request->path, reason);
    return false;
}

/* Finds the JSON in the file and, in a GLB, the binary chunk. */
static bool split(struct gltf *gltf, const uint8_t **json, size_t *json_bytes)
{
    const uint8_t *file = gltf->file;
    size_t size = gltf->file_bytes;
    *json = file;
    *json_bytes = size;
    if (size < 4 || load_u32(file) != GLB_MAGIC) {
        size_t mark_bytes = size >= 3 ? text_mark_bytes((const char *)file) : 0;
        *json += mark_bytes;
        *json_bytes -= mark_bytes;
        return true;
    }
    if (size < GLB_HEADER_BYTES + GLB_CHUNK_BYTES)
        return fail_file(gltf, "the GLB ends within its header");
    if (load_u32(file + 4) != 2)
        return fail_file(gltf, "the GLB is not of version 2");
    size_t length = load_u32(file + 8);
    if (length > size)
        return fail_file(gltf, "the GLB is cut short");
    if (length < GLB_HEADER_BYTES + GLB_CHUNK_BYTES)
        return fail_file(gltf, "the GLB says that it ends within its header");
    size_t at = GLB_HEADER_BYTES;
    for (uint32_t chunk = 0; length - at >= GLB_CHUNK_BYTES; chunk++) {
        size_t bytes = load_u32(file + at);
        uint32_t type = load_u32(file + at + 4);
        at += GLB_CHUNK_BYTES;
        if (bytes > length - at)
            return fail_file(gltf, "a chunk of the GLB runs past its end");
        if (chunk == 0 && type != GLB_JSON)
            return fail_file(gltf, "the first chunk of the GLB is not JSON");
        if (chunk == 0) {
            *json = file + at;
            *json_bytes = bytes;
        } else if (chunk == 1 && type == GLB_BIN && bytes) {
            gltf->chunk = (struct gltf_bytes){.data = file + at, .size_bytes = bytes};
        }
        size_t padded = (bytes + 3) & ~(size_t)3;
        at = padded > length - at ? length : at + padded;
    }
    return true;
}

static whit_result read_json(struct gltf *gltf)
{
    const uint8_t *json;
    size_t size;
    json_error_t error;
    const char *path = gltf->request->path;
    if (!split(gltf, &json, &size))
        return WHIT_ERROR_INPUT;
    gltf->root = json_loadb((const char *)json, size, 0, &error);
    if (!gltf->root)
        return log_failure(&gltf->scene->log, WHIT_ERROR_INPUT, "%s:%d:%d: %s", path, error.line,
                           error.column, error.text);
    if (json_is_object(gltf->root))
        return WHIT_OK;
    fail_file(gltf, "the JSON is not an object");
    return WHIT_ERROR_INPUT;
}

/* --- what the file asks for ----------------------------------------------------------------- */

static bool check_version(const struct gltf *gltf)
{
    struct gltf_place at = gltf_place("asset");
    json_t *asset;
    const char *version, *min;
    if (!gltf_object(gltf, gltf->root, &at, "asset", &asset))
        return false;
    if (!asset)
        return fail_file(gltf, "there is no `asset` in it: this is not glTF 2.0");
    if (!gltf_string(gltf, asset, &at, "version", &version) ||
        !gltf_string(gltf, asset, &at, "minVersion", &min))
        return false;
    if (!version || strncmp(version, "2.", 2) != 0)
        return gltf_fail(gltf, &at, "version `%s` is not 2.x", text_token(version).text);
    return !min || strcmp(min, "2.0") == 0 ||
           gltf_fail(gltf, &at, "minVersion `%s` is more than 2.0", text_token(min).text);
}

static bool is_known(const char *extension)
{
    static const char *const known[] = {
        "EXT_mesh_gpu_instancing",
        "FB_ngon_encoding", /* which triangles were a polygon; assimp writes it */
        "KHR_draco_mesh_compression",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_iridescence",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_unlit",
        "KHR_materials_variants",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_texture_transform",
    };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(extension, known[i]) == 0)
            return true;
    return false;
}

static bool check_extensions(const struct gltf *gltf)
{
    struct gltf_place at = gltf_place("glTF");
    json_t *required, *entry;
    size_t i;
    if (!gltf_array(gltf, gltf->root, &at, "extensionsRequired", &required))
        return false;
    json_array_foreach(required, i, entry)
    {
        const char *name = json_string_value(entry);
        if (!name)
            return gltf_fail(gltf, &at, "extensionsRequired[%zu] is not a string", i);
        if (!is_known(name))
            return gltf_fail(gltf, &at, "requires the extension `%s`, which whit does not know",
                             text_token(name).text);
    }
    return true;
}

static bool check_arrays(const struct gltf *gltf)
{
    static const char *const keys[] = {
        "accessors", "animations", "bufferViews", "buffers", "cameras", "images",  "materials",
        "meshes",    "nodes",      "samplers",    "scenes",  "skins",   "textures"};
    struct gltf_place at = gltf_place("glTF");
    json_t *array;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (!gltf_array(gltf, gltf->root, &at, keys[i], &array))
            return false;
    return true;
}

static void note_unused(const struct gltf *gltf)
{
    uint32_t skins = gltf_count(gltf, "skins");
    if (skins)
        scene_note(gltf->scene, SCENE_NOTE_WARNING,
                   "%s: skins are not animated: %u drawn as their joints stand at rest",
                   path_name(gltf->request->path), skins);
    const json_t *entry;
    size_t i;
    uint32_t at;
    json_array_foreach(json_object_get(gltf->root, "extensionsUsed"), i, entry)
    {
        const char *name = json_string_value(entry);
        if (name && !is_known(name) &&
            !key_table_find(&gltf->ignored_names, name, strlen(name), &at))
            scene_note(gltf->scene, SCENE_NOTE_INFO, "%s: the extension %s is not read",
                       path_name(gltf->request->path), text_token(name).text);
    }
}

/* --- the whole ------------------------------------------------------------------------------ */

static uint32_t *none_indices(uint32_t count)
{
    uint32_t *indices = array_alloc(count, sizeof *indices);
    for (uint32_t i = 0; indices && i < count; i++)
        indices[i] = SCENE_NONE;
    return indices;
}

static whit_result allocate(struct gltf *gltf)
{
    gltf->image_count = gltf_count(gltf, "images");
    gltf->material_count = gltf_count(gltf, "materials");
    gltf->mesh_count = gltf_count(gltf, "meshes");
    gltf->node_count = gltf_count(gltf, "nodes");
    gltf->textures = none_indices(gltf->image_count);
    gltf->materials = none_indices(gltf->material_count);
    gltf->meshes = none_indices(gltf->mesh_count);
    gltf->skinned = none_indices(gltf->node_count);
    gltf->nodes = none_indices(gltf->node_count);
    gltf->parents = none_indices(gltf->node_count);
    gltf->order = none_indices(gltf->node_count);
    gltf->worlds = array_alloc(gltf->node_count, sizeof *gltf->worlds);
    gltf->mesh_used = array_alloc_zeroed(gltf->mesh_count, sizeof *gltf->mesh_used);
    gltf->default_material = SCENE_NONE;
    bool ok = gltf->textures && gltf->materials && gltf->meshes && gltf->skinned && gltf->worlds &&
              gltf->nodes && gltf->parents && gltf->order && gltf->mesh_used;
    return ok ? WHIT_OK : WHIT_ERROR_MEMORY;
}

static void finish(struct gltf *gltf)
{
    load_textures_end(gltf->scene);
    scene_give_back(gltf->scene, gltf->counted_bytes);
    for (uint32_t i = 0; i < gltf->buffer_count; i++)
        free(gltf->buffers[i].owned);
    free(gltf->buffers);
    free(gltf->textures);
    free(gltf->materials);
    free(gltf->meshes);
    free(gltf->skinned);
    free(gltf->worlds);
    free(gltf->nodes);
    free(gltf->parents);
    free(gltf->order);
    free(gltf->mesh_used);
    free(gltf->ignored);
    key_table_finish(&gltf->ignored_names);
    json_decref(gltf->root);
}

whit_result gltf_load_bytes(struct scene *scene, const struct model_request *request,
                            const uint8_t *data, size_t size_bytes)
{
    static whit_result (*const steps[])(struct gltf *) = {
        gltf_plan_nodes,  gltf_load_buffers, gltf_load_materials, gltf_place_nodes,
        gltf_load_meshes, gltf_fill_nodes,   gltf_add_animations,
    };
    struct gltf gltf = {.scene = scene, .request = request, .file = data, .file_bytes = size_bytes};
    whit_result result = read_json(&gltf);
    if (result == WHIT_OK &&
        (!check_version(&gltf) || !check_extensions(&gltf) || !check_arrays(&gltf)))
        result = WHIT_ERROR_INPUT;
    if (result == WHIT_OK)
        result = allocate(&gltf);
    for (size_t i = 0; result == WHIT_OK && i < sizeof steps / sizeof *steps; i++)
        result = steps[i](&gltf);
    if (result == WHIT_OK)
        note_unused(&gltf);
    finish(&gltf);
    return result;
}
