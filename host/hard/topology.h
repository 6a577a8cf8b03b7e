/* Topology of meshes: open edges, duplicates and the like. */
#ifndef HARD_TOPOLOGY_H
#define HARD_TOPOLOGY_H

#include "scene/scene.h"

/* Edges and triangles of all meshes together. Vertices with equal coordinates count as one, and so
   do the edges of triangles with equal corners. */
struct hard_topology {
    uint64_t triangles, edges;
    uint64_t open_edges;    /* edges with one triangle */
    uint64_t crowded_edges; /* edges with more than two triangles */
    uint64_t flipped_edges; /* edges with two triangles of inconsistent winding */
    uint64_t duplicates;    /* triangles with the corners of another one */
    uint8_t *open;          /* a flag per triangle, mesh by mesh: it touches an open or crowded
                               edge */
    uint64_t *first;        /* index of each mesh's first triangle in `open` */
};
WHIT_CHECK whit_result hard_topology_init(const struct scene *scene, struct hard_topology *out);
void hard_topology_finish(struct hard_topology *topology);

#endif
