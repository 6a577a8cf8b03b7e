/* Foreign importers in a child process. The child replies with one flat block of triangles, which
   the parent uses only after importer_parse has checked every offset, count, string and index. */
#ifndef LOAD_IMPORTER_H
#define LOAD_IMPORTER_H

#include "base/child.h"
#include "base/log.h"
#include "load/load.h"

/* For formats from IMPORT_FBX on, the reply is the whole scene as a GLB; else triangles alone. */
enum import_kind {
    IMPORT_OBJ,
    IMPORT_GLTF,
    IMPORT_PLY,
    IMPORT_STL,
    IMPORT_FBX, /* this and those below come back as a whole GLB, the others as parts */
    IMPORT_DAE,
    IMPORT_3MF,
    IMPORT_OFF
};

/* A file that the importer may open; it has no access to the file system. */
struct import_file {
    const char *name;
    const uint8_t *data;
    size_t size_bytes;
};

/* files[0] is the model; Assimp chooses its importer by the extension of that name. */
struct import_request {
    enum import_kind kind;
    const struct import_file *files;
    uint32_t file_count;
    bool has_smooth_groups; /* normals mark them, see obj_mark_smooth_groups */
};

/* Triangles of one group and material. Pointers are into the block; optional arrays are NULL. */
struct import_part {
    const char *name;
    const char *material; /* name, "" when there is none */
    uint32_t vertex_count, triangle_count;
    const float *positions, *normals; /* 3 per vertex */
    const float *uvs[2];              /* 2 per vertex, v upwards as assimp has it */
    const float *colors, *tangents;   /* 4 per vertex */
    const uint32_t *indices;
};

/* The most corners of a face. In the worst case assimp triangulates a face in cubic time: 1.2 s for
   this many corners, 9 s for twice as many (AMD EPYC). */
#define IMPORT_CORNERS_MAX 1024u

/* Numbers of things that the importer left out. `corners`: number of corners of the first face with
   too many, or 0; a model with such a face has no parts. `face`: index of that face in its mesh. */
struct import_counts {
    uint64_t points, lines, bad_faces, face, corners;
    /* of a GLB */
    uint32_t skins, animations, lights, cameras, pictures, color_groups;
    uint32_t wraps, uv_sets, parameters, bind_shapes, hidden; /* unread_count */
    uint32_t composites, mixed;                               /* threemf_read */
};

struct import_block {
    struct child_reply reply;
    struct import_part *parts;
    uint32_t part_count;
    const uint8_t *glb; /* in `reply`; NULL: there are parts instead */
    size_t glb_bytes;
    struct import_counts counts;
};

/* Runs the importer on `request`, with the limits of base/foreign.h. Errors are logged as
   `path: reason`. */
WHIT_CHECK whit_result importer_run(const whit_log *log, const char *path,
                                    const struct import_request *request,
                                    const whit_load_params *params, struct import_block *block);
void importer_finish(struct import_block *block);

/* The checks of importer_run, on any bytes: fills parts and counts of *block, or gives a reason.
   `data` is 8-byte aligned and outlives the block. */
WHIT_CHECK bool importer_parse(const uint8_t *data, size_t size_bytes, struct import_block *block,
                               char *reason, size_t reason_bytes);

/* Layout of the block: header, part records, then strings and arrays anywhere behind them.
   Offsets count from the start of the block; 0: absent. Arrays are 4-byte aligned. */
#define IMPORT_MAGIC       0x4b4c4257u /* "WBLK" */
#define IMPORT_ERROR_MAGIC 0x52524557u /* "WERR": text up to the end follows the magic */

/* With no parts and `corners` 0, a GLB follows the header up to the end. */
struct import_header {
    uint32_t magic, part_count;
    uint64_t size_bytes;
    struct import_counts counts;
};

enum import_array {
    IMPORT_POSITIONS,
    IMPORT_NORMALS,
    IMPORT_UV0,
    IMPORT_UV1,
    IMPORT_COLORS,
    IMPORT_TANGENTS,
    IMPORT_INDICES,
    IMPORT_ARRAY_COUNT
};

struct import_record {
    uint64_t name, material; /* offsets of zero-terminated strings */
    uint32_t name_bytes, material_bytes;
    uint32_t vertex_count, triangle_count;
    uint64_t arrays[IMPORT_ARRAY_COUNT];
};

/* 4-byte words per vertex (per triangle: indices). */
uint32_t importer_array_words(enum import_array array);

/* Runs in the child: imports and writes the block; gives the exit code. `user`: import_request. */
int importer_assimp_run(void *user, void *to, child_write write);

#endif
