/* A part: triangles of one group and material. The importer's child makes them, and writes them
   into its reply (importer.h); for glTF whit's own process does. */
#ifndef LOAD_PART_H
#define LOAD_PART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum part_array {
    PART_POSITIONS,
    PART_NORMALS,
    PART_UV0,
    PART_UV1,
    PART_COLORS,
    PART_TANGENTS,
    PART_INDICES,
    PART_ARRAY_COUNT
};

struct part {
    uint32_t vertex_count, triangle_count;
    /* 4-byte words: floats, per vertex, of texture coordinates v upwards as assimp has it; indices
       per triangle. NULL: there are none. */
    void *arrays[PART_ARRAY_COUNT];
    char *name, *material; /* names; may be NULL */
};

/* Frees all that `part` refers to, which is malloc'ed; not for parts in a reply. */
void part_finish(struct part *part);
/* Number of words of an array per vertex, of indices per triangle. */
uint32_t part_words(enum part_array array);
/* Size of an array of the part in bytes. */
size_t part_bytes(const struct part *part, enum part_array array);
/* Allocates an array, which the part owns; NULL when memory runs out. */
void *part_add(struct part *part, enum part_array array);
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
