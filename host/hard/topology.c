/* Finds edges that are open, crowded or flipped, and triangles that are there twice. */
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "hard/topology.h"

struct corner {
    float at[3];
    uint32_t index; /* into the mesh's indices */
};

struct edge {
    uint32_t ends[2]; /* the smaller one first */
    bool turned;      /* the triangle's winding goes from the larger to the smaller one */
};

struct face {
    uint32_t corners[3]; /* sorted */
    uint32_t triangle;
};

static int compare_corners(const void *a, const void *b)
{
    const struct corner *x = a, *y = b;
    for (int k = 0; k < 3; ++k)
        if (x->at[k] != y->at[k])
            return x->at[k] < y->at[k] ? -1 : 1;
    return 0;
}

static int compare_words(const uint32_t *x, const uint32_t *y, int count)
{
    for (int k = 0; k < count; ++k)
        if (x[k] != y[k])
            return x[k] < y[k] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    return compare_words(((const struct edge *)a)->ends, ((const struct edge *)b)->ends, 2);
}

static int compare_faces(const void *a, const void *b)
{
    const struct face *x = a, *y = b;
    int order = compare_words(x->corners, y->corners, 3);
    return order ? order : compare_words(&x->triangle, &y->triangle, 1);
}

/* Numbers vertices in `welded`, 3 per triangle; equal vertices get the same number. */
static whit_result weld(const struct scene_mesh *mesh, uint32_t *welded)
{
    uint32_t count = 3 * mesh->triangle_count, number = 0;
    struct corner *corners = array_alloc(count, sizeof *corners);
    if (!corners)
        return WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; i < count; ++i) {
        memcpy(corners[i].at, &mesh->positions[3 * (size_t)mesh->indices[i]], sizeof corners[i].at);
        corners[i].index = i;
    }
    qsort(corners, count, sizeof *corners, compare_corners);
    for (uint32_t i = 0; i < count; ++i) {
        number += i > 0 && compare_corners(&corners[i], &corners[i - 1]) != 0;
        welded[corners[i].index] = number;
    }
    free(corners);
    return WHIT_OK;
}

/* Counts one edge of the mesh, which is entries [first, end) of `edges`, one for each triangle on
   it. */
static void count_edge(struct hard_topology *topology, const struct edge *edges, uint32_t first,
                       uint32_t end, uint8_t *vertex_open)
{
    uint32_t turned = 0;
    for (uint32_t i = first; i < end; ++i)
        turned += edges[i].turned;
    ++topology->edges;
    topology->open_edges += end - first == 1;
    topology->crowded_edges += end - first > 2;
    topology->flipped_edges += end - first == 2 && turned != 1;
    if (end - first != 2) {
        vertex_open[edges[first].ends[0]] = 1;
        vertex_open[edges[first].ends[1]] = 1;
    }
}

static void count_edges(struct hard_topology *topology, const uint32_t *welded,
                        const struct face *faces, uint32_t face_count, struct edge *edges,
                        uint8_t *vertex_open)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < face_count; ++i) {
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t *corners = &welded[3 * (size_t)faces[i].triangle];
            uint32_t a = corners[k], b = corners[(k + 1) % 3];
            if (a == b)
                continue;
            edges[count++] = (struct edge){{a < b ? a : b, a < b ? b : a}, a > b};
        }
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (uint32_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && compare_edges(&edges[first], &edges[end]) == 0;)
            ++end;
        count_edge(topology, edges, first, end, vertex_open);
    }
}

static void sort_three(uint32_t v[3])
{
    for (int pass = 0; pass < 2; ++pass)
        for (int k = 0; k < 2; ++k)
            if (v[k] > v[k + 1]) {
                uint32_t kept = v[k];
                v[k] = v[k + 1];
                v[k + 1] = kept;
            }
}

/* Finds one triangle of each set of corners; returns their number. A triangle and its copies have
   the edges of one triangle, so that an outline is open also where the surface is there twice. */
static uint32_t find_faces(const uint32_t *welded, uint32_t triangles, struct face *faces)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < triangles; ++t) {
        memcpy(faces[t].corners, &welded[3 * (size_t)t], sizeof faces[t].corners);
        sort_three(faces[t].corners);
        faces[t].triangle = t;
    }
    qsort(faces, triangles, sizeof *faces, compare_faces);
    for (uint32_t t = 0; t < triangles; ++t)
        if (count == 0 || compare_words(faces[t].corners, faces[count - 1].corners, 3) != 0)
            faces[count++] = faces[t];
    return count;
}

static whit_result add_mesh(struct hard_topology *topology, const struct scene_mesh *mesh,
                            uint8_t *open)
{
    uint32_t triangles = mesh->triangle_count;
    uint32_t *welded = array_alloc(3 * (size_t)triangles, sizeof *welded);
    struct edge *edges = array_alloc(3 * (size_t)triangles, sizeof *edges);
    struct face *faces = array_alloc(triangles, sizeof *faces);
    uint8_t *vertex_open = array_alloc_zeroed(3 * (size_t)triangles, 1);
    whit_result result =
        welded && edges && faces && vertex_open ? weld(mesh, welded) : WHIT_ERROR_MEMORY;
    if (result == WHIT_OK) {
        uint32_t face_count = find_faces(welded, triangles, faces);
        count_edges(topology, welded, faces, face_count, edges, vertex_open);
        topology->duplicates += triangles - face_count;
        for (uint32_t t = 0; t < triangles; ++t)
            open[t] = vertex_open[welded[3 * t]] | vertex_open[welded[3 * t + 1]] |
                      vertex_open[welded[3 * t + 2]];
        topology->triangles += triangles;
    }
    free(welded);
    free(edges);
    free(faces);
    free(vertex_open);
    return result;
}

whit_result hard_topology_init(const struct scene *scene, struct hard_topology *out)
{
    uint64_t triangles = 0;
    *out = (struct hard_topology){0};
    out->first = array_alloc(scene->mesh_count, sizeof *out->first);
    for (uint32_t i = 0; out->first && i < scene->mesh_count; ++i) {
        out->first[i] = triangles;
        triangles += scene->meshes[i].triangle_count;
    }
    out->open = array_alloc_zeroed((size_t)triangles, 1);
    whit_result result = out->first && out->open ? WHIT_OK : WHIT_ERROR_MEMORY;
    for (uint32_t i = 0; result == WHIT_OK && i < scene->mesh_count; ++i)
        if (scene->meshes[i].triangle_count)
            result = add_mesh(out, &scene->meshes[i], &out->open[out->first[i]]);
    if (result != WHIT_OK) {
        log_error(&scene->log, "%s: out of memory", scene->name);
        hard_topology_finish(out);
    }
    return result;
}

void hard_topology_finish(struct hard_topology *topology)
{
    free(topology->open);
    free(topology->first);
    *topology = (struct hard_topology){0};
}
