/* Triangles of one material while their arrays are made: in the importer's child, and of a glTF in
   whit itself. */
#ifndef LOAD_PART_H
#define LOAD_PART_H

#include "load/importer.h"

struct part {
    uint32_t vertex_count, triangle_count;
    void *arrays[IMPORT_ARRAY_COUNT]; /* malloc'ed, or NULL */
    char *name, *material;            /* the same */
};

void part_finish(struct part *part);
/* Elements of an array: vertices, or triangles. */
size_t part_count(const struct part *part, enum import_array array);
/* Room for an array, which the part owns; NULL when memory runs out. */
void *part_add(struct part *part, enum import_array array);
/* The part as its readers see it, without its names. */
struct import_part part_view(const struct part *part);
/* The parts of one mesh: vertices whose file gives no direction get that of their faces, and parts
   without normals get flat ones where another has some. `corners`: each has a vertex for every
   corner, and gets one for all that are alike. False when memory runs out. */
bool parts_complete(struct part *parts, uint32_t count, bool corners);

#endif
