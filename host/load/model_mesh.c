#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/text.h"
#include "image/image.h"
#include "load/model_mesh.h"
#include "scene/afford.h"

struct totals {
    uint64_t vertices, triangles;
    uint32_t vertex_floats;
    bool kept[PART_INDICES]; /* by array of vertices */
};

static struct totals sum(const struct part *parts, uint32_t count)
{
    struct totals totals = {0};
    for (uint32_t i = 0; i < count; i++) {
        totals.vertices += parts[i].vertex_count;
        totals.triangles += parts[i].triangle_count;
    }
    for (int array = 0; array < PART_INDICES; array++) {
        uint32_t have = 0;
        for (uint32_t i = 0; i < count; i++)
            have += parts[i].arrays[array] != NULL;
        totals.kept[array] = have && (array != PART_TANGENTS || have == count);
        totals.vertex_floats += totals.kept[array] ? part_words((enum part_array)array) : 0;
    }
    return totals;
}

/* The mesh's array of that kind, not of indices. */
static float **array_of(struct scene_mesh *mesh, enum part_array array)
{
    float **const arrays[PART_INDICES] = {&mesh->positions, &mesh->normals, &mesh->uvs[0],
                                          &mesh->uvs[1],    &mesh->colors,  &mesh->tangents};
    return arrays[array];
}

static bool allocate(const struct totals *totals, uint32_t part_count, struct scene_mesh *mesh)
{
    size_t vertices = (size_t)totals->vertices, triangles = (size_t)totals->triangles;
    bool ok = (mesh->indices = array_alloc(triangles, 3 * sizeof(uint32_t))) != NULL;
    for (int i = 0; ok && i < PART_INDICES; i++) {
        enum part_array array = (enum part_array)i;
        if (totals->kept[i])
            *array_of(mesh, array) = array_alloc(vertices, part_words(array) * sizeof(float));
        ok = !totals->kept[i] || *array_of(mesh, array);
    }
    ok = ok && (mesh->materials = array_alloc(triangles, sizeof(uint32_t)));
    return ok && (mesh->groups = array_alloc_zeroed(part_count, sizeof *mesh->groups));
}

/* `from`: NULL for default values. */
static void copy_array(enum part_array array, const float *from, size_t vertices, bool srgb,
                       float *to)
{
    size_t count = vertices * part_words(array);
    if (from)
        memcpy(to, from, count * sizeof *to);
    for (size_t i = 0; !from && i < count; i++)
        to[i] = array == PART_COLORS ? 1.0f : 0.0f;
    for (size_t i = 1; from && (array == PART_UV0 || array == PART_UV1) && i < count; i += 2)
        to[i] = 1.0f - to[i];
    for (size_t i = 0; from && array == PART_COLORS && srgb && i < count; i++)
        to[i] = i % 4 == 3 ? to[i] : image_linear_from_srgb(to[i]);
}

static bool copy_part(const struct part *part, uint32_t material, bool srgb,
                      struct scene_mesh *mesh)
{
    for (int i = 0; i < PART_INDICES; i++) {
        enum part_array array = (enum part_array)i;
        float *to = *array_of(mesh, array);
        if (to)
            copy_array(array, part->arrays[i], part->vertex_count, srgb,
                       to + (size_t)mesh->vertex_count * part_words(array));
    }
    const uint32_t *from = part->arrays[PART_INDICES];
    uint32_t *indices = mesh->indices + (size_t)mesh->triangle_count * 3;
    for (size_t i = 0; i < (size_t)part->triangle_count * 3; i++)
        indices[i] = from[i] + mesh->vertex_count;
    for (size_t i = 0; i < part->triangle_count; i++)
        mesh->materials[mesh->triangle_count + i] = material;
    struct scene_group *group = &mesh->groups[mesh->group_count++];
    group->name = string_copy(part->name ? part->name : mesh->name);
    group->first_triangle = mesh->triangle_count;
    group->triangle_count = part->triangle_count;
    mesh->vertex_count += part->vertex_count;
    mesh->triangle_count += part->triangle_count;
    return group->name;
}

whit_result model_add_mesh(struct scene *scene, const char *name, const struct part *parts,
                           const uint32_t *materials, uint32_t part_count, bool colors_are_srgb,
                           uint32_t *index)
{
    struct totals totals = sum(parts, part_count);
    struct scene_mesh mesh = {.name = string_copy(name)};
    uint64_t bytes = scene_triangle_cost(totals.triangles, totals.vertices,
                                         totals.vertex_floats * sizeof(float));
    if (totals.vertices >= UINT32_MAX || totals.triangles >= UINT32_MAX / 3) {
        log_error(&scene->log, "%s: mesh `%s` is too large: %llu triangles",
                  scene->name ? scene->name : "", text_token(name).text,
                  (unsigned long long)totals.triangles);
        scene_mesh_finish(&mesh);
        return WHIT_ERROR_INPUT;
    }
    if (!scene_afford(scene, bytes, "mesh `%s` of %llu triangles", text_token(name).text,
                      (unsigned long long)totals.triangles)) {
        scene_mesh_finish(&mesh);
        return WHIT_ERROR_INPUT;
    }
    bool ok = mesh.name && allocate(&totals, part_count, &mesh);
    for (uint32_t i = 0; ok && i < part_count; i++)
        ok = copy_part(&parts[i], materials[i], colors_are_srgb, &mesh);
    if (!ok) {
        scene_mesh_finish(&mesh);
        return WHIT_ERROR_MEMORY;
    }
    *index = scene_add_mesh(scene, mesh);
    return *index == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}
