/* Objects of a scene file that are models of other files. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/scene_objects.h"

static bool load_new_model(struct reader *reader, const char *path, uint32_t node,
                           uint32_t material, bool lights, bool cameras)
{
    struct scene *scene = reader->scene;
    uint32_t first_mesh = scene->mesh_count;
    whit_result result = load_model(scene, path, node, lights, cameras, reader->params);
    if (result != WHIT_OK) {
        reader->result = result;
        return false;
    }
    for (uint32_t i = first_mesh; material != SCENE_NONE && i < scene->mesh_count; ++i) {
        struct scene_mesh *mesh = &scene->meshes[i];
        for (uint32_t t = 0; t < mesh->triangle_count; ++t)
            mesh->materials[t] = material;
    }
    return true;
}

/* A model that was placed before is not read again: its meshes get more instances. */
static bool place_model(struct reader *reader, const struct place *place, const char *path,
                        uint32_t node, uint32_t material, bool lights, bool cameras)
{
    char *key = string_format("%u %d %d %s", material, lights, cameras, path);
    if (!key)
        return reader_no_memory(reader);
    uint32_t index = reader->model_count;
    size_t key_bytes = strlen(key);
    bool before = !lights && !cameras && table_find(&reader->model_keys, key, key_bytes, &index);
    bool good = before || lights || cameras ||
                table_add(&reader->model_keys, key, key_bytes, index) || reader_no_memory(reader);
    free(key);
    if (before)
        return range_afford(reader, place, &reader->models[index], 1) &&
               range_copy(reader, place, &reader->models[index], node);
    struct scene_range range = range_begin(reader->scene, node);
    if (!good || !load_new_model(reader, path, node, material, lights, cameras))
        return false;
    range_end(reader->scene, &range);
    return ARRAY_PUSH(reader->models, reader->model_count, reader->model_capacity, range) ||
           reader_no_memory(reader);
}

static bool has_extension_of_model(const char *path)
{
    static const char *const known[] = {"obj", "gltf", "glb", "ply", "stl"};
    char extension[16];
    path_extension(path, extension, sizeof extension);
    for (size_t i = 0; i < sizeof known / sizeof known[0]; ++i) {
        if (strcmp(extension, known[i]) == 0)
            return true;
    }
    return false;
}

bool reader_model(struct reader *reader, const struct place *place, const json_t *object,
                  uint32_t node)
{
    const char *name = NULL;
    bool lights = false, cameras = false;
    uint32_t material;
    struct place here = {place, "model", 0};
    if (!reader_string(reader, place, object, "model", &name) ||
        !reader_bool(reader, place, object, "lights", &lights) ||
        !reader_bool(reader, place, object, "cameras", &cameras) ||
        !reader_object_material(reader, place, object, &material))
        return false;
    if (!has_extension_of_model(name))
        return reader_fail(reader, &here, "`%s` is no model; whit reads .obj .gltf .glb .ply .stl",
                           text_token(name).text);
    char *path = roots_join(reader->path, name);
    if (!path)
        return reader_no_memory(reader);
    const char *why_not = roots_why_not(&reader->scene->roots, path);
    bool placed = why_not ? reader_fail(reader, &here, "`%s`: %s", text_token(name).text, why_not)
                          : place_model(reader, place, path, node, material, lights, cameras);
    free(path);
    return placed;
}
