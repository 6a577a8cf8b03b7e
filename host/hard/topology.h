/* What surfaces are like. */
#ifndef HARD_TOPOLOGY_H
#define HARD_TOPOLOGY_H

#include "hard/hard.h"

/* Edges and triangles of all meshes together; vertices with equal coordinates count as one. */
struct hard_topology {
    uint64_t triangles, edges;
    uint64_t open_edges;    /* of one triangle */
    uint64_t crowded_edges; /* of more than two */
    uint64_t flipped_edges; /* of two triangles that go round it the same way */
    uint64_t duplicates;    /* triangles with the corners of another one */
    uint8_t *open;          /* 1 a triangle, mesh by mesh: it touches an open or crowded edge */
    uint64_t *first;        /* of each mesh in `open` */
};
WHIT_CHECK whit_result hard_topology_init(const struct scene *scene, struct hard_topology *out);
void hard_topology_finish(struct hard_topology *topology);

#endif
