/* A part: triangles of one material, under construction. Used in the importer's child, and for glTF
   in whit's own process. */
#ifndef LOAD_PART_H
#define LOAD_PART_H

#include "load/importer.h"

struct part {
    uint32_t vertex_count, triangle_count;
    void *arrays[IMPORT_ARRAY_COUNT]; /* malloc'ed, or NULL */
    char *name, *material;            /* malloc'ed, or NULL */
};

void part_finish(struct part *part);
/* Number of elements of an array: triangles for indices, else vertices. */
size_t part_count(const struct part *part, enum import_array array);
/* Allocates an array, which the part owns; NULL when memory runs out. */
void *part_add(struct part *part, enum import_array array);
/* A read-only view of the part, without its names. */
struct import_part part_view(const struct part *part);
/* Replaces normals with x > 0, each of which stands for a smoothing group (obj_mark_smooth_groups),
   by the normals of the surface of that group: in each point the sum of the normals of its
   triangles, weighted by their angles there (Thuermer and Wuethrich 1998, Computing vertex normals
   from polygonal facets). Points are joined by their positions, across parts. False when memory
   runs out. */
bool parts_smooth(struct part *parts, uint32_t count);
/* Completes the normals of all parts of one mesh: zero normals are replaced by those of the faces,
   and parts without normals get flat ones where another part has normals. `corners`: parts have a
   vertex for every corner, and equal vertices are merged. False when memory runs out. */
bool parts_complete(struct part *parts, uint32_t count, bool corners);

#endif
