#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "image/image.h"
#include "load/model_mesh.h"
#include "scene/afford.h"

struct totals {
    uint64_t vertices, triangles;
    bool normals, uvs[2], colors, all_tangents;
};

static struct totals sum(const struct model_part *parts, uint32_t count)
{
    struct totals totals = {.all_tangents = count > 0};
    for (uint32_t i = 0; i < count; i++) {
        const struct import_part *part = parts[i].part;
        totals.vertices += part->vertex_count;
        totals.triangles += part->triangle_count;
        totals.normals |= part->normals != NULL;
        totals.uvs[0] |= part->uvs[0] != NULL;
        totals.uvs[1] |= part->uvs[1] != NULL;
        totals.colors |= part->colors != NULL;
        totals.all_tangents &= part->tangents != NULL;
    }
    return totals;
}

static uint64_t cost(const struct totals *totals)
{
    uint32_t floats = 3;
    floats += totals->normals ? 3 : 0;
    floats += (totals->uvs[0] ? 2u : 0) + (totals->uvs[1] ? 2u : 0);
    floats += (totals->colors ? 4u : 0) + (totals->all_tangents ? 4u : 0);
    return scene_triangle_cost(totals->triangles, totals->vertices, floats * sizeof(float));
}

static bool allocate(const struct totals *totals, uint32_t part_count, struct scene_mesh *mesh)
{
    size_t vertices = (size_t)totals->vertices, triangles = (size_t)totals->triangles;
    bool ok = (mesh->positions = array_alloc(vertices, 3 * sizeof(float))) != NULL;
    if (totals->normals)
        ok = ok && (mesh->normals = array_alloc(vertices, 3 * sizeof(float)));
    for (int i = 0; i < 2; i++)
        if (totals->uvs[i])
            ok = ok && (mesh->uvs[i] = array_alloc(vertices, 2 * sizeof(float)));
    if (totals->colors)
        ok = ok && (mesh->colors = array_alloc(vertices, 4 * sizeof(float)));
    if (totals->all_tangents)
        ok = ok && (mesh->tangents = array_alloc(vertices, 4 * sizeof(float)));
    ok = ok && (mesh->indices = array_alloc(triangles, 3 * sizeof(uint32_t)));
    ok = ok && (mesh->materials = array_alloc(triangles, sizeof(uint32_t)));
    return ok && (mesh->groups = array_alloc_zeroed(part_count, sizeof *mesh->groups));
}

static void copy_uvs(float *to, const float *from, size_t count)
{
    if (!from)
        memset(to, 0, count * 2 * sizeof *to);
    for (size_t i = 0; from && i < count; i++) {
        to[2 * i] = from[2 * i];
        to[2 * i + 1] = 1.0f - from[2 * i + 1];
    }
}

static void copy_colors(float *to, const float *from, size_t count, bool srgb)
{
    for (size_t i = 0; i < count * 4; i++) {
        float value = from ? from[i] : 1.0f;
        to[i] = srgb && i % 4 != 3 ? image_linear_from_srgb(value) : value;
    }
}

static void copy_vertices(const struct import_part *part, size_t first, bool srgb,
                          struct scene_mesh *mesh)
{
    size_t count = part->vertex_count;
    memcpy(mesh->positions + 3 * first, part->positions, count * 3 * sizeof(float));
    if (mesh->normals && part->normals)
        memcpy(mesh->normals + 3 * first, part->normals, count * 3 * sizeof(float));
    else if (mesh->normals)
        memset(mesh->normals + 3 * first, 0, count * 3 * sizeof(float));
    for (int i = 0; i < 2; i++)
        if (mesh->uvs[i])
            copy_uvs(mesh->uvs[i] + 2 * first, part->uvs[i], count);
    if (mesh->colors)
        copy_colors(mesh->colors + 4 * first, part->colors, count, srgb && part->colors);
    if (mesh->tangents)
        memcpy(mesh->tangents + 4 * first, part->tangents, count * 4 * sizeof(float));
}

static bool copy_part(const struct model_part *from, bool srgb, struct scene_mesh *mesh)
{
    const struct import_part *part = from->part;
    copy_vertices(part, mesh->vertex_count, srgb, mesh);
    uint32_t *indices = mesh->indices + (size_t)mesh->triangle_count * 3;
    for (size_t i = 0; i < (size_t)part->triangle_count * 3; i++)
        indices[i] = part->indices[i] + mesh->vertex_count;
    for (size_t i = 0; i < part->triangle_count; i++)
        mesh->materials[mesh->triangle_count + i] = from->material;
    struct scene_group *group = &mesh->groups[mesh->group_count++];
    group->name = string_copy(from->name);
    group->first_triangle = mesh->triangle_count;
    group->triangle_count = part->triangle_count;
    mesh->vertex_count += part->vertex_count;
    mesh->triangle_count += part->triangle_count;
    return group->name;
}

whit_result model_add_mesh(struct scene *scene, const char *name, const struct model_part *parts,
                           uint32_t part_count, bool colors_are_srgb, uint32_t *index)
{
    struct totals totals = sum(parts, part_count);
    struct scene_mesh mesh = {.name = string_copy(name)};
    if (totals.vertices >= UINT32_MAX || totals.triangles >= UINT32_MAX / 3) {
        log_error(&scene->log, "%s: mesh `%s` is too large: %llu triangles",
                  scene->name ? scene->name : "", text_token(name).text,
                  (unsigned long long)totals.triangles);
        scene_mesh_finish(&mesh);
        return WHIT_ERROR_INPUT;
    }
    if (!scene_afford(scene, cost(&totals), "mesh `%s` of %llu triangles", text_token(name).text,
                      (unsigned long long)totals.triangles)) {
        scene_mesh_finish(&mesh);
        return WHIT_ERROR_INPUT;
    }
    bool ok = mesh.name && allocate(&totals, part_count, &mesh);
    for (uint32_t i = 0; ok && i < part_count; i++)
        ok = copy_part(&parts[i], colors_are_srgb, &mesh);
    if (!ok) {
        scene_mesh_finish(&mesh);
        return WHIT_ERROR_MEMORY;
    }
    *index = scene_add_mesh(scene, mesh);
    return *index == SCENE_NONE ? WHIT_ERROR_MEMORY : WHIT_OK;
}

void model_note_counts(struct scene *scene, const char *path, const struct import_counts *counts)
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
