#include "scene/shaper.h"

#include "base/array.h"
#include "base/same.h"
#include "base/vec.h"

bool shape_positive(double value)
{
    return value > 0.0 && value <= 1e17;
}

whit_result shaper_init(struct shaper *shaper, struct scene_mesh *mesh, uint64_t vertices,
                        uint64_t triangles)
{
    *shaper = (struct shaper){.mesh = mesh};
    *mesh = (struct scene_mesh){0};
    if (vertices > UINT32_MAX / 4 || triangles > UINT32_MAX / 4)
        return WHIT_ERROR_USAGE;
    mesh->vertex_count = (uint32_t)vertices;
    mesh->triangle_count = (uint32_t)triangles;
    mesh->positions = array_alloc_zeroed((size_t)vertices, 3 * sizeof(float));
    mesh->normals = array_alloc_zeroed((size_t)vertices, 3 * sizeof(float));
    mesh->uvs[0] = array_alloc_zeroed((size_t)vertices, 2 * sizeof(float));
    mesh->indices = array_alloc_zeroed((size_t)triangles, 3 * sizeof(uint32_t));
    mesh->materials = array_alloc_zeroed((size_t)triangles, sizeof(uint32_t));
    if (mesh->positions && mesh->normals && mesh->uvs[0] && mesh->indices && mesh->materials)
        return WHIT_OK;
    scene_mesh_finish(mesh);
    return WHIT_ERROR_MEMORY;
}

whit_result shaper_add_colors(struct shaper *shaper)
{
    struct scene_mesh *mesh = shaper->mesh;
    mesh->colors = array_alloc_zeroed(mesh->vertex_count, 4 * sizeof(float));
    if (mesh->colors)
        return WHIT_OK;
    scene_mesh_finish(mesh);
    return WHIT_ERROR_MEMORY;
}

uint32_t shaper_vertex(struct shaper *shaper, const double position[3], const double normal[3],
                       double u, double v)
{
    struct scene_mesh *mesh = shaper->mesh;
    uint32_t vertex = shaper->vertex++;
    if (shaper->measuring)
        return vertex;
    double length = double3_length(normal);
    for (size_t i = 0; i < 3; ++i) {
        mesh->positions[3 * (size_t)vertex + i] = (float)position[i] + 0.0f; /* turns -0 into 0 */
        mesh->normals[3 * (size_t)vertex + i] = (float)(normal[i] / length);
    }
    mesh->uvs[0][2 * (size_t)vertex] = (float)u;
    mesh->uvs[0][2 * (size_t)vertex + 1] = (float)v;
    for (size_t i = 0; mesh->colors && i < 4; ++i)
        mesh->colors[4 * (size_t)vertex + i] = i < 3 ? shaper->color[i] : 1.0f;
    return vertex;
}

void shaper_triangle(struct shaper *shaper, uint32_t a, uint32_t b, uint32_t c)
{
    if (!shaper->measuring) {
        uint32_t *index = shaper->mesh->indices + shaper->corner;
        index[0] = a, index[1] = b, index[2] = c;
    }
    shaper->corner += 3;
}

void shaper_quad(struct shaper *shaper, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    shaper_triangle(shaper, a, b, c);
    shaper_triangle(shaper, a, c, d);
}

void shaper_grid(struct shaper *shaper, uint32_t first, uint32_t rows, uint32_t columns)
{
    for (uint32_t j = 0; j < rows; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            uint32_t a = first + j * (columns + 1) + i, b = a + columns + 1;
            shaper_quad(shaper, a, b, b + 1, a + 1);
        }
    }
}

void shape_circle_point(uint32_t step, uint32_t steps, double *cosine, double *sine)
{
    double angle = 2.0 * PI * (step % steps) / steps;
    *cosine = same_cos(angle);
    *sine = same_sin(angle);
}
