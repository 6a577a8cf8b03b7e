/* Wavefront material libraries. whit reads them itself, since assimp drops options and refuses the
   whole OBJ over one odd line. */
#ifndef LOAD_MTL_H
#define LOAD_MTL_H

#include "load/load.h"

enum mtl_color { MTL_KA, MTL_KD, MTL_KS, MTL_KE, MTL_TF, MTL_COLOR_COUNT };
enum mtl_number { MTL_NS, MTL_NI, MTL_D, MTL_PR, MTL_PM, MTL_ILLUM, MTL_NUMBER_COUNT };
enum mtl_map {
    MTL_MAP_KA, /* ignored, with a note */
    MTL_MAP_KD,
    MTL_MAP_KS,
    MTL_MAP_KE,
    MTL_MAP_NS,
    MTL_MAP_D,
    MTL_MAP_BUMP,
    MTL_MAP_NORMAL,
    MTL_MAP_COUNT
};

struct mtl_texture {
    char *file; /* as written; NULL: no such map */
    uint32_t line;
    float scale[2], offset[2]; /* -s and -o, v upwards */
    float bump;                /* -bm */
    float base, gain;          /* -mm: base + gain * texel */
    char channel;              /* -imfchan: r g b m l, or 0 */
    bool clamp;
};

/* One material (newmtl) as written in the file. */
struct mtl_entry {
    char *name, *file;
    uint32_t line;
    float colors[MTL_COLOR_COUNT][3];
    float numbers[MTL_NUMBER_COUNT];
    bool has_color[MTL_COLOR_COUNT], has_number[MTL_NUMBER_COUNT];
    bool d_by_tr;  /* numbers[MTL_D] is 1 - Tr */
    bool d_of_all; /* every material of the model's libraries has `d 0` */
    struct mtl_texture maps[MTL_MAP_COUNT];
};

struct mtl_library {
    struct mtl_entry *entries;
    struct key_table names; /* index by name, of the first entry with that name */
    uint32_t count, capacity;
};

/* Offset of the comment in a line of an OBJ or MTL, or `bytes`. In a line that `has_names`, a `#`
   within words is none: 3ds Max names materials `Material #25`. */
size_t mtl_find_comment(const char *line, size_t bytes, bool has_names);
/* Adds the entries of `text` (zero-terminated) to the library. Each keyword that is not understood
   is noted once in the scene. False when memory runs out. */
WHIT_CHECK bool mtl_parse(struct scene *scene, const char *path, const char *text,
                          struct mtl_library *library);
void mtl_finish(struct mtl_library *library);
/* The first entry of that name, or NULL. */
const struct mtl_entry *mtl_find(const struct mtl_library *library, const char *name);

#endif
