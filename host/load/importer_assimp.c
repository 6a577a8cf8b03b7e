/* The child's side of the importer: assimp's scene, flattened into the block of importer.h. */
#include "load/importer.h"

#include <assimp/cexport.h>
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/key_table.h"
#include "load/importer_glb.h"
#include "load/part.h"
#include "load/threemf.h"
#include "load/unread.h"

/* --- the only files that assimp sees ------------------------------------------------------- */

struct open_file {
    struct aiFile io;
    const struct import_file *file;
    size_t at;
};

static size_t read_file(struct aiFile *io, char *out, size_t size, size_t count)
{
    struct open_file *open = (struct open_file *)(void *)io->UserData;
    size_t left = open->file->size_bytes - open->at;
    if (size == 0 || count > left / size)
        count = size ? left / size : 0;
    if (count)
        memcpy(out, open->file->data + open->at, size * count);
    open->at += size * count;
    return count;
}

static size_t write_file(struct aiFile *io, const char *data, size_t size, size_t count)
{
    (void)io, (void)data, (void)size, (void)count;
    return 0;
}

static size_t tell_file(struct aiFile *io)
{
    return ((struct open_file *)(void *)io->UserData)->at;
}

static size_t size_file(struct aiFile *io)
{
    return ((struct open_file *)(void *)io->UserData)->file->size_bytes;
}

static void flush_file(struct aiFile *io)
{
    (void)io;
}

static enum aiReturn seek_file(struct aiFile *io, size_t offset, enum aiOrigin origin)
{
    struct open_file *open = (struct open_file *)(void *)io->UserData;
    size_t from = origin == aiOrigin_SET   ? 0
                  : origin == aiOrigin_CUR ? open->at
                                           : open->file->size_bytes;
    size_t to = from + offset; /* negative offsets are passed as size_t and wrap around */
    if (to > open->file->size_bytes)
        return aiReturn_FAILURE;
    open->at = to;
    return aiReturn_SUCCESS;
}

/* The files that assimp can open. */
struct library {
    const struct import_request *request;
    struct key_table names; /* of the files */
    bool lacks_memory;      /* in open_file; assimp only reports that a file did not open */
};

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    (void)mode;
    struct library *library = (struct library *)(void *)io->UserData;
    const char *name = path_name(path);
    uint32_t index;
    if (!key_table_find(&library->names, name, strlen(name), &index))
        return NULL;
    struct open_file *open = calloc(1, sizeof *open);
    library->lacks_memory |= !open;
    if (!open)
        return NULL;
    open->file = &library->request->files[index];
    open->io = (struct aiFile){.ReadProc = read_file,
                               .WriteProc = write_file,
                               .TellProc = tell_file,
                               .FileSizeProc = size_file,
                               .SeekProc = seek_file,
                               .FlushProc = flush_file,
                               .UserData = (aiUserData)open};
    return &open->io;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    if (file)
        free(file->UserData);
}

/* --- one part ------------------------------------------------------------------------------ */

static bool copy_vec3(struct part *part, enum import_array array, const struct aiVector3D *from)
{
    float *out = part_add(part, array);
    if (out)
        memcpy(out, from, (size_t)part->vertex_count * sizeof *from);
    return out;
}

static bool copy_uvs(struct part *part, enum import_array array, const struct aiVector3D *from)
{
    float *out = part_add(part, array);
    for (uint32_t i = 0; out && i < part->vertex_count; i++) {
        out[2 * i] = from[i].x;
        out[2 * i + 1] = from[i].y;
    }
    return out;
}

static bool copy_tangents(struct part *part, const struct aiMesh *mesh)
{
    float *out = part_add(part, IMPORT_TANGENTS);
    for (uint32_t i = 0; out && i < part->vertex_count; i++) {
        struct aiVector3D n = mesh->mNormals[i], t = mesh->mTangents[i], b = mesh->mBitangents[i];
        float side = (n.y * t.z - n.z * t.y) * b.x + (n.z * t.x - n.x * t.z) * b.y +
                     (n.x * t.y - n.y * t.x) * b.z;
        out[4 * i] = t.x;
        out[4 * i + 1] = t.y;
        out[4 * i + 2] = t.z;
        out[4 * i + 3] = side < 0 ? -1.0f : 1.0f;
    }
    return out;
}

/* Whether the first three corners are vertices. */
static bool good_corners(const struct aiFace *face, uint32_t vertex_count)
{
    return face->mIndices[0] < vertex_count && face->mIndices[1] < vertex_count &&
           face->mIndices[2] < vertex_count;
}

static bool good_face(const struct aiFace *face, uint32_t vertex_count)
{
    return face->mNumIndices == 3 && good_corners(face, vertex_count);
}

static void count_faces(const struct aiMesh *mesh, struct part *part, struct import_counts *counts)
{
    for (uint32_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (good_face(face, mesh->mNumVertices))
            part->triangle_count++;
        else if (face->mNumIndices == 1)
            counts->points++;
        else if (face->mNumIndices == 2)
            counts->lines++;
        else
            counts->bad_faces++;
    }
    if (mesh->mNumFaces == 0)
        counts->points += mesh->mNumVertices;
}

static bool copy_indices(struct part *part, const struct aiMesh *mesh)
{
    uint32_t *out = part_add(part, IMPORT_INDICES);
    size_t used = 0;
    for (uint32_t i = 0; out && i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (!good_face(face, mesh->mNumVertices))
            continue;
        memcpy(out + used, face->mIndices, 3 * sizeof *out);
        used += 3;
    }
    return out;
}

static bool copy_arrays(struct part *part, const struct aiMesh *mesh, enum import_kind kind)
{
    bool ok = copy_indices(part, mesh) && copy_vec3(part, IMPORT_POSITIONS, mesh->mVertices);
    /* Normals of an STL are left out: they are the facets' normals, or wrong. */
    if (ok && mesh->mNormals && kind != IMPORT_STL)
        ok = copy_vec3(part, IMPORT_NORMALS, mesh->mNormals);
    for (int i = 0; i < 2; i++)
        if (ok && mesh->mTextureCoords[i])
            ok = copy_uvs(part, i ? IMPORT_UV1 : IMPORT_UV0, mesh->mTextureCoords[i]);
    if (ok && mesh->mColors[0]) {
        float *out = part_add(part, IMPORT_COLORS);
        ok = out;
        if (ok)
            memcpy(out, mesh->mColors[0], (size_t)mesh->mNumVertices * 4 * sizeof *out);
    }
    if (ok && mesh->mTangents && mesh->mBitangents && mesh->mNormals)
        ok = copy_tangents(part, mesh);
    return ok;
}

/* --- all parts ----------------------------------------------------------------------------- */

struct flat {
    struct part *parts;
    struct import_record *records; /* what the block holds of each part */
    uint32_t count;
    struct import_counts counts;
};

static char *material_name(const struct aiScene *scene, const struct aiMesh *mesh)
{
    struct aiString name = {0};
    if (mesh->mMaterialIndex < scene->mNumMaterials)
        aiGetMaterialString(scene->mMaterials[mesh->mMaterialIndex], AI_MATKEY_NAME, &name);
    return string_copy(name.data);
}

static bool flatten_mesh(struct flat *flat, const struct aiScene *scene, const struct aiMesh *mesh,
                         enum import_kind kind)
{
    struct part part = {.vertex_count = mesh->mNumVertices};
    count_faces(mesh, &part, &flat->counts);
    if (part.triangle_count == 0 || !mesh->mVertices)
        return true;
    part.name = string_copy(mesh->mName.data);
    part.material = material_name(scene, mesh);
    bool ok = part.name && part.material && copy_arrays(&part, mesh, kind);
    flat->parts[flat->count++] = part;
    return ok;
}

static bool flatten(struct flat *flat, const struct aiScene *scene,
                    const struct import_request *request)
{
    enum import_kind kind = request->kind;
    flat->parts = array_alloc_zeroed(scene->mNumMeshes, sizeof *flat->parts);
    flat->records = array_alloc_zeroed(scene->mNumMeshes, sizeof *flat->records);
    if (!flat->parts || !flat->records)
        return false;
    for (uint32_t i = 0; i < scene->mNumMeshes; i++)
        if (!flatten_mesh(flat, scene, scene->mMeshes[i], kind))
            return false;
    if (request->has_smooth_groups && !parts_smooth(flat->parts, flat->count))
        return false;
    return parts_complete(flat->parts, flat->count, kind == IMPORT_OBJ || kind == IMPORT_STL);
}

static void flat_finish(struct flat *flat)
{
    for (uint32_t i = 0; i < flat->count; i++)
        part_finish(&flat->parts[i]);
    free(flat->parts);
    free(flat->records);
}

/* --- writing ------------------------------------------------------------------------------- */

static uint64_t array_bytes(const struct part *part, enum import_array array)
{
    return (uint64_t)part_count(part, array) * importer_array_words(array) * 4;
}

static uint64_t place(uint64_t *at, uint64_t bytes)
{
    uint64_t offset = *at;
    *at = (offset + bytes + 7) & ~UINT64_C(7);
    return offset;
}

/* Fills all records with offsets into the block; gives the block's size in bytes. */
static uint64_t layout(struct flat *flat)
{
    uint64_t at = sizeof(struct import_header) + flat->count * sizeof(struct import_record);
    for (uint32_t i = 0; i < flat->count; i++) {
        const struct part *part = &flat->parts[i];
        struct import_record *record = &flat->records[i];
        record->vertex_count = part->vertex_count;
        record->triangle_count = part->triangle_count;
        record->name_bytes = (uint32_t)strlen(part->name);
        record->material_bytes = (uint32_t)strlen(part->material);
        record->name = place(&at, (uint64_t)record->name_bytes + 1);
        record->material = place(&at, (uint64_t)record->material_bytes + 1);
        for (int a = 0; a < IMPORT_ARRAY_COUNT; a++)
            if (part->arrays[a])
                record->arrays[a] = place(&at, array_bytes(part, (enum import_array)a));
    }
    return at;
}

static bool write_padded(void *to, child_write write, const void *data, uint64_t bytes)
{
    static const uint8_t zeros[8];
    uint64_t pad = (8 - bytes % 8) % 8;
    return (bytes == 0 || write(to, data, (size_t)bytes)) &&
           (pad == 0 || write(to, zeros, (size_t)pad));
}

static bool write_part(const struct part *part, void *to, child_write write)
{
    bool ok = write_padded(to, write, part->name, strlen(part->name) + 1) &&
              write_padded(to, write, part->material, strlen(part->material) + 1);
    for (int a = 0; ok && a < IMPORT_ARRAY_COUNT; a++)
        if (part->arrays[a])
            ok = write_padded(to, write, part->arrays[a], array_bytes(part, (enum import_array)a));
    return ok;
}

static bool write_block(struct flat *flat, void *to, child_write write)
{
    struct import_header header = {
        .magic = IMPORT_MAGIC, .part_count = flat->count, .counts = flat->counts};
    header.size_bytes = layout(flat);
    bool ok = write(to, &header, sizeof header);
    for (uint32_t i = 0; ok && i < flat->count; i++)
        ok = write(to, &flat->records[i], sizeof flat->records[i]);
    for (uint32_t i = 0; ok && i < flat->count; i++)
        ok = write_part(&flat->parts[i], to, write);
    return ok;
}

static int refuse(const char *who, const char *text, void *to, child_write write)
{
    const uint32_t magic = IMPORT_ERROR_MAGIC;
    bool ok = write(to, &magic, sizeof magic) && write(to, who, strlen(who)) &&
              write(to, text, strlen(text));
    return ok ? 0 : 1;
}

static int write_error(const char *text, void *to, child_write write)
{
    if (strstr(text, "bad_alloc"))
        return CHILD_EXIT_MEMORY;
    return refuse("assimp: ", text[0] ? text : "refused without a reason", to, write);
}

_Static_assert(sizeof(struct import_header) % 8 == 0, "records follow the header");
_Static_assert(sizeof(struct import_record) % 8 == 0, "strings follow the records");

/* Finds a face with more than IMPORT_CORNERS_MAX corners, before assimp triangulates. */
static bool has_long_face(const struct aiScene *scene, struct import_counts *counts)
{
    for (uint32_t i = 0; i < scene->mNumMeshes; i++) {
        const struct aiMesh *mesh = scene->mMeshes[i];
        for (uint32_t face = 0; face < mesh->mNumFaces; face++) {
            if (mesh->mFaces[face].mNumIndices <= IMPORT_CORNERS_MAX)
                continue;
            counts->face = face;
            counts->corners = mesh->mFaces[face].mNumIndices;
            return true;
        }
    }
    return false;
}

static const struct aiScene *import(struct library *library)
{
    const struct import_request *request = library->request;
    struct aiFileIO io = {
        .OpenProc = open_file, .CloseProc = close_file, .UserData = (aiUserData)library};
    for (uint32_t i = 0; i < request->file_count; i++) {
        const char *name = request->files[i].name;
        if (!key_table_add(&library->names, name, strlen(name), i)) {
            library->lacks_memory = true;
            return NULL;
        }
    }
    /* assimp would draw the skeleton or the nodes of a file without meshes. */
    struct aiPropertyStore *wants = aiCreatePropertyStore();
    aiSetImportPropertyInteger(wants, AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);
    const struct aiScene *scene =
        aiImportFileExWithProperties(request->files[0].name, 0, &io, wants);
    aiReleasePropertyStore(wants);
    key_table_finish(&library->names);
    return scene;
}

/* Cuts polygons with an index out of range down to a triangle that has it, which is then counted as
   bad: assimp's triangulation would read out of bounds. It aborts where no polygon is left. */
static void cut_bad_polygons(const struct aiScene *scene)
{
    for (uint32_t i = 0; i < scene->mNumMeshes; i++) {
        struct aiMesh *mesh = scene->mMeshes[i];
        bool polygons = false;
        for (uint32_t f = 0; f < mesh->mNumFaces; f++) {
            struct aiFace *face = &mesh->mFaces[f];
            for (uint32_t k = 3; k < face->mNumIndices; k++)
                if (face->mIndices[k] >= mesh->mNumVertices)
                    face->mIndices[0] = face->mIndices[k];
            if (face->mNumIndices > 3 && !good_corners(face, mesh->mNumVertices))
                face->mNumIndices = 3;
            polygons |= face->mNumIndices > 3;
        }
        if (!polygons)
            mesh->mPrimitiveTypes &= ~(unsigned)aiPrimitiveType_POLYGON;
    }
}

/* Triangulates and writes the block of parts; gives the exit code. *scene is NULL where assimp has
   released it. */
static int write_triangles(const struct aiScene **scene, const struct import_request *request,
                           struct import_counts *counts, void *to, child_write write)
{
    struct flat flat = {.counts = *counts};
    int code = 1;
    cut_bad_polygons(*scene);
    *scene = aiApplyPostProcessing(*scene, aiProcess_Triangulate);
    if (!*scene || !flatten(&flat, *scene, request))
        code = CHILD_EXIT_MEMORY; /* nothing else stops either step */
    else if (write_block(&flat, to, write))
        code = 0;
    flat_finish(&flat);
    return code;
}

/* Writes a header without parts: alone, to refuse the model, or in front of a GLB. */
static bool write_header(const struct import_counts *counts, size_t glb_bytes, void *to,
                         child_write write)
{
    const struct import_header header = {
        .magic = IMPORT_MAGIC, .size_bytes = sizeof header + glb_bytes, .counts = *counts};
    return write(to, &header, sizeof header);
}

/* *scene is NULL where assimp has released it. */
static int write_glb(const struct aiScene **scene, const struct import_request *request,
                     struct import_counts *counts, void *to, child_write write)
{
    if (!(*scene)->mRootNode) /* assimp 5.2.4 reports no error where it cannot read a 3MF's XML */
        return write_error("the file has no model that it can read", to, write);
    const struct aiExportDataBlob *blob = importer_glb(scene, request, counts);
    if (!blob)
        return write_error(aiGetErrorString(), to, write);
    bool ok = write_header(counts, blob->size, to, write) && write(to, blob->data, blob->size);
    aiReleaseExportBlob(blob);
    return ok ? 0 : 1;
}

int importer_assimp_run(void *user, void *to, child_write write)
{
    const struct import_request *request = user;
    struct library library = {.request = request};
    struct import_counts counts = {0};
    int code;
    if (request->kind == IMPORT_3MF) {
        const struct import_file *file = &request->files[0];
        const struct threemf_head head = threemf_read(file->data, file->size_bytes);
        if (head.refused[0])
            return refuse("", head.refused, to, write);
    }
    const char *refusal = request->kind == IMPORT_DAE ? unread_refusal(request->files) : NULL;
    if (refusal)
        return refuse("", refusal, to, write);
    const struct aiScene *scene = import(&library);
    if (!scene)
        return library.lacks_memory ? CHILD_EXIT_MEMORY
                                    : write_error(aiGetErrorString(), to, write);
    if (has_long_face(scene, &counts))
        code = write_header(&counts, 0, to, write) ? 0 : 1;
    else if (request->kind >= IMPORT_FBX)
        code = write_glb(&scene, request, &counts, to, write);
    else
        code = write_triangles(&scene, request, &counts, to, write);
    if (scene)
        aiReleaseImport(scene);
    return code;
}
