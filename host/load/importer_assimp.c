/* The child's side of the importer: assimp's scene, flattened into the parts of importer.h. */
#include "load/importer.h"

#include <assimp/cexport.h>
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/key_table.h"
#include "load/importer_glb.h"
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

/* Copies an array whose elements assimp has as whit has them. */
static bool copy_plain(struct part *part, enum part_array array, const void *from)
{
    float *out = part_add(part, array);
    if (out)
        memcpy(out, from, part_bytes(part, array));
    return out;
}

static bool copy_uvs(struct part *part, enum part_array array, const struct aiVector3D *from)
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
    float *out = part_add(part, PART_TANGENTS);
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
    uint32_t *out = part_add(part, PART_INDICES);
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
    bool ok = copy_indices(part, mesh) && copy_plain(part, PART_POSITIONS, mesh->mVertices);
    /* Normals of an STL are left out: they are the facets' normals, or wrong. */
    if (ok && mesh->mNormals && kind != IMPORT_STL)
        ok = copy_plain(part, PART_NORMALS, mesh->mNormals);
    for (int i = 0; i < 2; i++)
        if (ok && mesh->mTextureCoords[i])
            ok = copy_uvs(part, i ? PART_UV1 : PART_UV0, mesh->mTextureCoords[i]);
    if (ok && mesh->mColors[0])
        ok = copy_plain(part, PART_COLORS, mesh->mColors[0]);
    if (ok && mesh->mTangents && mesh->mBitangents && mesh->mNormals)
        ok = copy_tangents(part, mesh);
    return ok;
}

/* --- all parts ----------------------------------------------------------------------------- */

struct flat {
    struct part *parts;
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
    if (!flat->parts)
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
}

/* --- writing ------------------------------------------------------------------------------- */

/* Writes end in no reply where one of them fails: their results need no check. */
static void write_header(const struct import_counts *counts, uint32_t part_count, void *to,
                         child_write write)
{
    const struct import_header header = {*counts, part_count};
    (void)write(to, &header, sizeof header);
}

static void write_padded(void *to, child_write write, const void *data, size_t bytes)
{
    static const uint8_t zeros[4];
    (void)write(to, data, bytes);
    (void)write(to, zeros, (4 - bytes % 4) % 4);
}

static void write_part(const struct part *part, void *to, child_write write)
{
    struct import_record record = {(uint32_t)strlen(part->name), (uint32_t)strlen(part->material),
                                   part->vertex_count, part->triangle_count, 0};
    for (int a = 0; a < PART_ARRAY_COUNT; a++)
        record.arrays |= part->arrays[a] ? 1u << a : 0;
    (void)write(to, &record, sizeof record);
    write_padded(to, write, part->name, record.name_bytes + (size_t)1);
    write_padded(to, write, part->material, record.material_bytes + (size_t)1);
    for (int a = 0; a < PART_ARRAY_COUNT; a++)
        if (part->arrays[a])
            (void)write(to, part->arrays[a], part_bytes(part, (enum part_array)a));
}

static whit_result refuse(struct foreign_answer *answer, const char *who, const char *text)
{
    snprintf(answer->reason, sizeof answer->reason, "%s%s", who, text);
    return WHIT_ERROR_INPUT;
}

static whit_result pass_on_error(struct foreign_answer *answer)
{
    const char *text = aiGetErrorString();
    if (strstr(text, "bad_alloc"))
        return WHIT_ERROR_MEMORY;
    return refuse(answer, "assimp: ", text[0] ? text : "refused without a reason");
}

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

/* Triangulates and writes all parts. *scene is NULL where assimp has released it. */
static whit_result write_triangles(const struct aiScene **scene,
                                   const struct import_request *request,
                                   const struct import_counts *counts, void *to, child_write write)
{
    struct flat flat = {.counts = *counts};
    cut_bad_polygons(*scene);
    *scene = aiApplyPostProcessing(*scene, aiProcess_Triangulate);
    bool made = *scene && flatten(&flat, *scene, request); /* memory alone stops either step */
    if (made)
        write_header(&flat.counts, flat.count, to, write);
    for (uint32_t i = 0; made && i < flat.count; i++)
        write_part(&flat.parts[i], to, write);
    flat_finish(&flat);
    return made ? WHIT_OK : WHIT_ERROR_MEMORY;
}

/* *scene is NULL where assimp has released it. */
static whit_result write_glb(const struct aiScene **scene, const struct import_request *request,
                             double metres, struct import_counts *counts, void *to,
                             child_write write, struct foreign_answer *answer)
{
    if (!(*scene)->mRootNode) /* assimp 5.2.4 reports no error where it cannot read a 3MF's XML */
        return refuse(answer, "assimp: ", "the file has no model that it can read");
    const struct aiExportDataBlob *blob = importer_glb(scene, request, metres, counts);
    if (!blob)
        return pass_on_error(answer);
    write_header(counts, 0, to, write);
    (void)write(to, blob->data, blob->size);
    aiReleaseExportBlob(blob);
    return WHIT_OK;
}

whit_result importer_assimp_run(void *user, void *to, child_write write,
                                struct foreign_answer *answer)
{
    const struct import_request *request = user;
    struct library library = {.request = request};
    struct import_counts counts = {0};
    whit_result result = WHIT_OK;
    struct threemf_head head = {0};
    if (request->kind == IMPORT_3MF)
        head = threemf_read(request->files->data, request->files->size_bytes);
    counts.color_groups = head.color_groups;
    counts.composites = head.composites;
    counts.mixed = head.mixed;
    const char *refusal =
        request->kind == IMPORT_DAE ? unread_refusal(request->files) : head.refused;
    if (refusal && refusal[0])
        return refuse(answer, "", refusal);
    const struct aiScene *scene = import(&library);
    if (!scene)
        return library.lacks_memory ? WHIT_ERROR_MEMORY : pass_on_error(answer);
    if (has_long_face(scene, &counts))
        write_header(&counts, 0, to, write);
    else if (request->kind >= IMPORT_FBX)
        result = write_glb(&scene, request, head.unit_m, &counts, to, write, answer);
    else
        result = write_triangles(&scene, request, &counts, to, write);
    if (scene)
        aiReleaseImport(scene);
    return result;
}
