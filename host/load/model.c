#include "load/gltf.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/key_table.h"
#include "base/text.h"
#include "load/cut.h"
#include "load/model.h"
#include "load/model_mesh.h"
#include "load/mtl_material.h"
#include "load/obj.h"
#include "load/ply.h"
#include "load/texture_ahead.h"

/* A model larger than this is refused before it is read. */
#define MODEL_LIMIT (UINT64_C(4) << 30)

/* `line`: of the face in an OBJ, whose text whit reads too; 0: not known. */
static void log_long_face(const whit_log *log, const char *path, uint32_t line,
                          const struct import_counts *counts)
{
    char place[32];
    if (line)
        snprintf(place, sizeof place, ":%u: a face", line);
    else
        snprintf(place, sizeof place, ": face %llu", (unsigned long long)counts->face);
    log_error(log, "%s%s has %llu corners, at most %u are possible: cut it into triangles", path,
              place, (unsigned long long)counts->corners, IMPORT_CORNERS_MAX);
}

/* The bytes of a model, and what whit itself reads of them. */
struct model_file {
    enum import_kind kind;
    uint8_t *data;
    size_t size_bytes;
    struct mtl_library library; /* that an OBJ names */
    bool has_smooth_groups;
    struct ply_paint paint; /* of a PLY; of an OBJ: no texture, and colours as assimp has them */
};

static void note_counts(struct scene *scene, const char *path, const struct import_counts *counts)
{
    const char *name = path_name(path);
    if (counts->points)
        scene_note(scene, SCENE_NOTE_INFO, "%s: %llu points are not drawn", name,
                   (unsigned long long)counts->points);
    if (counts->lines)
        scene_note(scene, SCENE_NOTE_INFO, "%s: %llu lines are not drawn", name,
                   (unsigned long long)counts->lines);
    if (counts->bad_faces)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "%s: %llu faces without area or with bad indices were dropped", name,
                   (unsigned long long)counts->bad_faces);
}

static whit_result import(struct scene *scene, const struct model_request *request,
                          const struct model_file *of, struct import_block *block)
{
    static const char *const names[] = {"model.obj", "model.gltf", "model.ply", "model.stl",
                                        "model.fbx", "model.dae",  "model.3mf", "model.off"};
    const struct import_file file = {names[of->kind], of->data, of->size_bytes};
    const struct import_request import = {of->kind, &file, 1, of->has_smooth_groups};
    whit_result result = importer_run(&scene->log, request->path, &import, request->params, block);
    if (result != WHIT_OK)
        return result;
    const struct import_counts *counts = &block->counts;
    note_counts(scene, request->path, counts);
    bool whole = of->kind >= IMPORT_FBX;
    if (whole ? block->glb != NULL : block->part_count > 0)
        return WHIT_OK;
    if (counts->corners)
        log_long_face(&scene->log, request->path,
                      of->kind == IMPORT_OBJ ? obj_longest_face((const char *)of->data) : 0,
                      counts);
    else
        log_error(&scene->log,
                  "%s: there are no triangles in it (%llu points, %llu lines, %llu damaged faces)",
                  request->path, (unsigned long long)counts->points,
                  (unsigned long long)counts->lines, (unsigned long long)counts->bad_faces);
    importer_finish(block);
    return WHIT_ERROR_INPUT;
}

static whit_result add_instance(struct scene *scene, const char *name, uint32_t mesh, uint32_t node)
{
    struct scene_instance instance = {
        .name = string_copy(name), .mesh = mesh, .node = node, .local = affine_identity()};
    if (!instance.name)
        return WHIT_ERROR_MEMORY;
    return scene_add_instance(scene, instance) == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

/* --- materials ------------------------------------------------------------------------------ */

/* The materials of one model. Each is added to the scene when the first part uses it. */
struct palette {
    const struct mtl_library *library;
    const char *texture;      /* file name of the picture on all parts, or NULL */
    struct key_table indices; /* scene's material index by name */
};

static void make_default(const char *name, bool colored, struct scene_material *out)
{
    scene_material_init(out, name);
    for (int i = 0; colored && i < 3; i++)
        out->diffuse[i] = out->ambient[i] = 1.0f;
}

static whit_result make_material(struct scene *scene, const struct model_request *request,
                                 struct palette *palette, const struct part *part,
                                 struct scene_material *out)
{
    const struct mtl_entry *entry = mtl_find(palette->library, part->material);
    if (entry)
        return mtl_material(scene, entry, request->params, out);
    bool named = part->material[0] && strcmp(part->material, "DefaultMaterial") != 0;
    bool textured = palette->texture && part->arrays[PART_UV0];
    make_default(named ? part->material : "default", part->arrays[PART_COLORS] || textured, out);
    if (textured) {
        char *path = picture_find_named(&scene->roots, request->path, palette->texture);
        whit_result result = path ? load_texture(scene, path, NULL, 0, request->params,
                                                 &out->textures[SCENE_SLOT_DIFFUSE].texture, NULL)
                                  : WHIT_ERROR_MEMORY;
        free(path);
        if (result != WHIT_OK)
            return result;
    }
    if (named && palette->library->count)
        scene_note(scene, SCENE_NOTE_WARNING, "%s: material `%s` is not defined, it is drawn grey",
                   path_name(request->path), text_token(part->material).text);
    return out->name ? WHIT_OK : WHIT_ERROR_MEMORY;
}

static whit_result find_material(struct scene *scene, const struct model_request *request,
                                 struct palette *palette, const struct part *part, uint32_t *index)
{
    size_t name_bytes = strlen(part->material);
    if (key_table_find(&palette->indices, part->material, name_bytes, index))
        return WHIT_OK;
    struct scene_material material = {0};
    whit_result result = make_material(scene, request, palette, part, &material);
    if (result != WHIT_OK) {
        scene_material_finish(&material);
        return result;
    }
    *index = scene_add_material(scene, material);
    bool ok = *index != SCENE_NONE &&
              key_table_add(&palette->indices, part->material, name_bytes, *index);
    return ok ? WHIT_OK : WHIT_ERROR_MEMORY;
}

/* --- OBJ, PLY, STL -------------------------------------------------------------------------- */

/* Multiplies a channel of all vertex colours and adds to it; gives the largest result. */
static float paint_channel(const struct import_block *block, size_t channel, float scale,
                           float offset, bool write)
{
    float largest = 0;
    for (uint32_t i = 0; i < block->part_count; i++) {
        float *colors = block->parts[i].arrays[PART_COLORS];
        size_t end = colors ? (size_t)block->parts[i].vertex_count * 4 : 0;
        for (size_t k = channel; k < end; k += 4) {
            float value = fmaxf(colors[k] * scale + offset, 0);
            largest = fmaxf(largest, value);
            if (write)
                colors[k] = value;
        }
    }
    return largest;
}

/* Turns assimp's vertex colours back into the file's numbers. These are bytes if one is 2 or
   larger, or words if one is larger than 255: the formats do not state the range of all types. */
static void paint_colors(const struct import_block *block, const struct ply_paint *paint)
{
    for (size_t alpha = 0; alpha < 2; alpha++) {
        size_t first = alpha * 3, end = first + (alpha ? 1 : 3);
        float scale = paint->scale[alpha], offset = paint->offset[alpha], largest = 0;
        for (size_t c = first; c < end; c++)
            largest = fmaxf(largest, paint_channel(block, c, scale, offset, false));
        float divisor = largest < 2 ? 1.0f : largest > 255 ? 65535.0f : 255.0f;
        for (size_t c = first; c < end && (scale != divisor || offset != 0); c++)
            paint_channel(block, c, scale / divisor, offset / divisor, true);
    }
}

/* Decodes the pictures of all materials that the block uses at once. */
static void decode_pictures(struct scene *scene, const struct model_request *request,
                            const struct import_block *block, const struct mtl_library *library)
{
    bool *named = array_alloc_zeroed(library->count, sizeof *named);
    for (uint32_t i = 0; named && i < block->part_count; i++) {
        const struct mtl_entry *entry = mtl_find(library, block->parts[i].material);
        if (!entry || named[entry - library->entries])
            continue;
        named[entry - library->entries] = true;
        mtl_name_pictures(scene, entry, request->params);
    }
    free(named);
    load_textures_ahead(scene, request->params);
}

/* Adds the whole block as one mesh with one instance, so that the file has a single tree. */
static whit_result add_block(struct scene *scene, const struct model_request *request,
                             const struct import_block *block, const struct model_file *file)
{
    paint_colors(block, &file->paint);
    struct palette palette = {.library = &file->library, .texture = file->paint.texture};
    uint32_t *materials = array_alloc(block->part_count, sizeof *materials);
    whit_result result = materials ? WHIT_OK : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK)
        decode_pictures(scene, request, block, &file->library);
    for (uint32_t i = 0; result == WHIT_OK && i < block->part_count; i++)
        result = find_material(scene, request, &palette, &block->parts[i], &materials[i]);
    uint32_t mesh = SCENE_NONE;
    const char *name = path_name(request->path);
    if (result == WHIT_OK)
        result = model_add_mesh(scene, name, block->parts, materials, block->part_count,
                                file->kind != IMPORT_OBJ, &mesh);
    if (result == WHIT_OK)
        result = add_instance(scene, name, mesh, request->parent);
    load_textures_end(scene);
    key_table_finish(&palette.indices);
    free(materials);
    return result;
}

/* --- FBX, COLLADA, 3MF, OFF ----------------------------------------------------------------- */

static void note_dropped(struct scene *scene, const char *path, const struct import_counts *counts)
{
    const char *name = path_name(path);
    if (counts->skins)
        scene_note(scene, SCENE_NOTE_WARNING,
                   "%s: skins are not animated: %u drawn in the bind pose", name, counts->skins);
    const struct {
        const char *one, *several;
        uint32_t count;
    } unread[] = {{"animation is not played", "animations are not played", counts->animations},
                  {"light is not read", "lights are not read", counts->lights},
                  {"camera is not read", "cameras are not read", counts->cameras},
                  {"picture is not read", "pictures are not read", counts->pictures},
                  {"colour group is not read", "colour groups are not read", counts->color_groups},
                  {"list of composite materials is not read",
                   "lists of composite materials are not read", counts->composites},
                  {"object is drawn in one of its materials",
                   "objects are drawn in one of their materials each", counts->mixed},
                  {"wrap mode is not read, its texture repeats",
                   "wrap modes are not read, their textures repeat", counts->wraps},
                  {"binding is not read, its texture has the first set of coordinates",
                   "bindings are not read, their textures have the first set of coordinates",
                   counts->uv_sets},
                  {"parameter of an effect is not read", "parameters of effects are not read",
                   counts->parameters},
                  {"bind_shape_matrix is not applied", "bind_shape_matrix are not applied",
                   counts->bind_shapes},
                  {"hidden node is drawn", "hidden nodes are drawn", counts->hidden}};
    for (size_t i = 0; i < sizeof unread / sizeof *unread; i++)
        if (unread[i].count)
            scene_note(scene, SCENE_NOTE_WARNING, "%s: %u %s", name, unread[i].count,
                       unread[i].count == 1 ? unread[i].one : unread[i].several);
}

static whit_result add_whole(struct scene *scene, const struct model_request *request,
                             enum import_kind kind, const struct import_block *block)
{
    uint32_t first = scene->material_count;
    note_dropped(scene, request->path, &block->counts);
    whit_result result = gltf_load_bytes(scene, request, block->glb, block->glb_bytes);
    /* assimp does not pass on the culling of an FBX. */
    for (uint32_t i = first; kind == IMPORT_FBX && i < scene->material_count; i++) {
        scene->materials[i].one_sided = false;
        scene->materials[i].two_sided = true;
    }
    return result;
}

/* --- all kinds ------------------------------------------------------------------------------ */

static whit_result prepare_obj(struct scene *scene, const char *path, struct model_file *file)
{
    if (!obj_repair_text(&file->data, &file->size_bytes))
        return WHIT_ERROR_MEMORY;
    whit_result result = obj_check_faces(scene, path, (const char *)file->data);
    if (result == WHIT_OK)
        result = obj_read_libraries(scene, path, (const char *)file->data, &file->library);
    bool marked = result != WHIT_OK ||
                  obj_mark_smooth_groups(&file->data, &file->size_bytes, &file->has_smooth_groups);
    return marked ? result : WHIT_ERROR_MEMORY;
}

/* Checks and repairs the bytes of a file before assimp gets them, and reads the materials that an
   OBJ names. */
static whit_result prepare(struct scene *scene, const char *path, struct model_file *file)
{
    if (file->kind == IMPORT_OBJ)
        return prepare_obj(scene, path, file);
    if (file->kind == IMPORT_PLY)
        return ply_prepare(scene, path, &file->data, &file->size_bytes, &file->paint);
    if (file->kind == IMPORT_STL)
        return cut_check_stl(scene, path, file->data, &file->size_bytes);
    return file->kind == IMPORT_OFF ? cut_check_off(scene, path, &file->data, &file->size_bytes)
                                    : WHIT_OK;
}

/* Frees `data` as soon as it is imported. Vertex colours of PLY and STL are taken as sRGB, since
   scanners take them from photos. */
static whit_result load_imported(struct scene *scene, const struct model_request *request,
                                 enum import_kind kind, uint8_t *data, size_t size_bytes)
{
    struct model_file file = {
        .kind = kind, .data = data, .size_bytes = size_bytes, .paint.scale = {1, 1}};
    struct import_block block = {0};
    whit_result result = prepare(scene, request->path, &file);
    if (result == WHIT_OK)
        result = import(scene, request, &file, &block);
    free(file.data);
    if (result == WHIT_OK && kind >= IMPORT_FBX)
        result = add_whole(scene, request, kind, &block);
    else if (result == WHIT_OK)
        result = add_block(scene, request, &block, &file);
    importer_finish(&block);
    mtl_finish(&file.library);
    free(file.paint.texture);
    return result;
}

static whit_result load_kind(struct scene *scene, const struct model_request *request,
                             enum import_kind kind)
{
    uint8_t *data = NULL;
    size_t size = 0;
    whit_result result =
        file_read(&scene->log, &scene->roots, request->path, MODEL_LIMIT, &data, &size);
    if (result != WHIT_OK)
        return result;
    scene->file_bytes += size;
    if (kind != IMPORT_GLTF)
        return load_imported(scene, request, kind, data, size);
    result = gltf_load_bytes(scene, request, data, size);
    free(data);
    return result;
}

static const struct {
    const char *extension;
    enum import_kind kind;
} kinds[] = {
    {"obj", IMPORT_OBJ}, {"gltf", IMPORT_GLTF}, {"glb", IMPORT_GLTF},
    {"ply", IMPORT_PLY}, {"stl", IMPORT_STL},   {"fbx", IMPORT_FBX},
    {"dae", IMPORT_DAE}, {"3mf", IMPORT_3MF},   {"off", IMPORT_OFF},
};

enum { KIND_COUNT = sizeof kinds / sizeof *kinds };

static size_t find_kind(const char *path)
{
    char extension[16];
    size_t i = 0;
    path_extension(path, extension, sizeof extension);
    while (i < KIND_COUNT && strcmp(kinds[i].extension, extension) != 0)
        i++;
    return i;
}

bool load_is_model(const char *path)
{
    return find_kind(path) < KIND_COUNT;
}

whit_result load_model(struct scene *scene, const char *path, uint32_t parent, bool with_lights,
                       bool with_cameras, const whit_load_params *params)
{
    const struct model_request request = {path, parent, with_lights, with_cameras, params};
    size_t kind = find_kind(path);
    if (kind < KIND_COUNT)
        return load_kind(scene, &request, kinds[kind].kind);
    char extension[16];
    path_extension(path, extension, sizeof extension);
    return log_failure(&scene->log, WHIT_ERROR_INPUT,
                       "%s: unknown kind of model `.%s` (known: " LOAD_MODELS ")", path,
                       text_token(extension).text);
}
