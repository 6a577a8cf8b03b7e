/* Objects of a scene file that are models in other files. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/model.h"
#include "load/scene_materials.h"
#include "load/scene_objects.h"
#include "load/scene_range.h"
#include "scene/afford.h"

static void set_material(struct scene_mesh *mesh, uint32_t material)
{
    for (uint32_t t = 0; t < scene_mesh_primitives(mesh); ++t)
        mesh->materials[t] = material;
}

/* A model as an object of the scene file places it. */
struct placement {
    const char *path;
    uint32_t material; /* SCENE_NONE: the model's own */
    bool lights, cameras;
};

static bool load_new_model(struct reader *reader, const struct placement *what, uint32_t node)
{
    struct scene *scene = reader->scene;
    uint32_t first_mesh = scene->mesh_count;
    whit_result result =
        load_model(scene, what->path, node, what->lights, what->cameras, reader->params);
    if (result != WHIT_OK) {
        reader->result = result;
        return false;
    }
    for (uint32_t i = first_mesh; what->material != SCENE_NONE && i < scene->mesh_count; ++i)
        set_material(&scene->meshes[i], what->material);
    return true;
}

/* Adds a copy of a mesh with another material. */
static bool add_copy(struct reader *reader, const struct place *place, uint32_t mesh,
                     uint32_t material, uint32_t *out)
{
    struct scene *scene = reader->scene;
    const struct scene_mesh *from = &scene->meshes[mesh];
    struct scene_mesh copy;
    uint64_t bytes =
        scene_triangle_cost(from->triangle_count, from->vertex_count, 16 * sizeof(float)) +
        scene_sphere_cost(from->sphere_count);
    if (!reader_afford(reader, place, bytes, "another copy of %u primitives",
                       scene_mesh_primitives(from)))
        return false;
    if (!scene_mesh_copy(from, &copy))
        return reader_no_memory(reader);
    set_material(&copy, material);
    *out = scene_add_mesh(scene, copy);
    return *out != SCENE_NONE || reader_no_memory(reader);
}

/* Gives all instances from index `first` on copies of their meshes, with `material`. */
static bool dress_instances(struct reader *reader, const struct place *place, uint32_t first,
                            uint32_t material)
{
    struct scene *scene = reader->scene;
    uint32_t known = scene->mesh_count;
    uint32_t *copies = array_alloc(known, sizeof *copies);
    bool good = copies != NULL || reader_no_memory(reader);
    for (uint32_t i = 0; good && i < known; ++i)
        copies[i] = SCENE_NONE;
    for (uint32_t i = first; good && i < scene->instance_count; ++i) {
        uint32_t *copy = &copies[scene->instances[i].mesh];
        good = *copy != SCENE_NONE ||
               add_copy(reader, place, scene->instances[i].mesh, material, copy);
        if (good)
            scene->instances[i].mesh = *copy;
    }
    free(copies);
    return good;
}

/* Stands for the material of the model's first placement, whatever it was. */
#define ANY_MATERIAL (SCENE_NONE - 1)

static char *key_of(const struct placement *what, uint32_t material)
{
    char *real = realpath(what->path, NULL);
    char *key = string_format("%u %d %d %s", material, what->lights, what->cameras,
                              real ? real : what->path);
    free(real);
    return key;
}

static bool find_model(const struct reader *reader, const struct placement *what, uint32_t material,
                       uint32_t *index)
{
    char *key = key_of(what, material);
    bool found = key && key_table_find(&reader->model_keys, key, strlen(key), index);
    free(key);
    return found;
}

/* Registers a key for the model that is added next, which has index model_count. */
static bool know_model(struct reader *reader, const struct placement *what, uint32_t material)
{
    char *key = key_of(what, material);
    bool good = key && key_table_add(&reader->model_keys, key, strlen(key), reader->model_count);
    free(key);
    return good || reader_no_memory(reader);
}

static bool add_model(struct reader *reader, const struct placement *what,
                      const struct scene_range *range)
{
    return know_model(reader, what, what->material) &&
           (ARRAY_PUSH(reader->models, reader->model_count, reader->model_capacity, *range) ||
            reader_no_memory(reader));
}

/* Places a model that was read before. `dressed`: its meshes have the right material and just get
   more instances; else they are copied with the new material. */
static bool place_again(struct reader *reader, const struct place *place,
                        const struct placement *what, uint32_t node, uint32_t index, bool dressed)
{
    struct scene *scene = reader->scene;
    struct scene_range from = reader->models[index], range = range_begin(scene, node);
    if (!range_afford(reader, place, &from, 1) || !range_copy(reader, place, &from, node))
        return false;
    if (dressed)
        return true;
    if (!dress_instances(reader, place, range.first_instance, what->material))
        return false;
    range_end(scene, &range);
    return add_model(reader, what, &range);
}

static bool place_model(struct reader *reader, const struct place *place,
                        const struct placement *what, uint32_t node)
{
    uint32_t index;
    bool same = find_model(reader, what, what->material, &index);
    bool other = !same && find_model(reader, what, ANY_MATERIAL, &index);
    if (same || (other && what->material != SCENE_NONE))
        return place_again(reader, place, what, node, index, same);
    struct scene_range range = range_begin(reader->scene, node);
    if (!load_new_model(reader, what, node))
        return false;
    range_end(reader->scene, &range);
    return (other || know_model(reader, what, ANY_MATERIAL)) && add_model(reader, what, &range);
}

bool reader_model(struct reader *reader, const struct place *place, const json_t *object,
                  uint32_t node)
{
    const char *name = NULL;
    struct placement what = {0};
    struct place here = {place, "model", 0};
    if (!reader_string(reader, place, object, "model", &name) ||
        !reader_bool(reader, place, object, "lights", &what.lights) ||
        !reader_bool(reader, place, object, "cameras", &what.cameras) ||
        !reader_object_material(reader, place, object, &what.material))
        return false;
    if (!load_is_model(name))
        return reader_fail(reader, &here, "`%s` is no model; whit reads " LOAD_MODELS,
                           text_token(name).text);
    char *path = roots_join(reader->path, name);
    if (!path)
        return reader_no_memory(reader);
    what.path = path;
    const char *why_not = roots_why_not(&reader->scene->roots, path);
    bool placed = why_not ? reader_fail(reader, &here, "`%s`: %s", text_token(name).text, why_not)
                          : place_model(reader, place, &what, node);
    free(path);
    return placed;
}
