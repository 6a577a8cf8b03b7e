/* Foreign importers in a child process. The parent uses what the child replies only after
   importer_parse has checked every count, string and index. */
#ifndef LOAD_IMPORTER_H
#define LOAD_IMPORTER_H

#include "load/load.h"
#include "load/part.h"

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
    struct part *parts; /* their arrays and names are in `reply` */
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

/* The checks of importer_run, on any bytes, 8-byte aligned: fills parts, GLB and counts of *block.
   WHIT_ERROR_INPUT: the data are damaged; or _MEMORY. */
WHIT_CHECK whit_result importer_parse(uint8_t *data, size_t size_bytes, struct import_block *block);

/* A reply begins with this. Parts follow, or without any a GLB up to the end. A model that is
   refused for a face of too many corners has neither. */
struct import_header {
    struct import_counts counts;
    uint32_t part_count;
};

/* A part in the reply: this, its name, its material and its arrays, in this order and each padded
   to 4 bytes. Strings end with a zero byte, which is not counted. */
struct import_record {
    uint32_t name_bytes, material_bytes, vertex_count, triangle_count;
    uint32_t arrays; /* bit i: array i is there */
};

/* Runs in the child: imports and writes the reply, or gives the reason why not. `user`:
   import_request. */
whit_result importer_assimp_run(void *user, void *to, child_write write,
                                struct foreign_answer *answer);

#endif
