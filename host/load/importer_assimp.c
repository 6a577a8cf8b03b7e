/* The child's side of the importer: assimp's scene, flattened into the block of importer.h. */
#include "load/importer.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/table.h"

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
    size_t to = from + offset; /* assimp passes negative offsets as large ones */
    if (to > open->file->size_bytes)
        return aiReturn_FAILURE;
    open->at = to;
    return aiReturn_SUCCESS;
}

/* All files that there are. */
struct library {
    const struct import_request *request;
    struct table names; /* of the files */
    bool lacks_memory;  /* to open one: assimp only says that it could not */
};

static struct aiFile *open_file(struct aiFileIO *io, const char *path, const char *mode)
{
    (void)mode;
    struct library *library = (struct library *)(void *)io->UserData;
    const char *name = path_name(path);
    uint32_t index;
    if (!table_find(&library->names, name, strlen(name), &index))
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

struct part {
    struct import_record record;
    void *arrays[IMPORT_ARRAY_COUNT]; /* malloc'ed, or NULL */
    char *name, *material;
};

static void part_finish(struct part *part)
{
    for (int i = 0; i < IMPORT_ARRAY_COUNT; i++)
        free(part->arrays[i]);
    free(part->name);
    free(part->material);
}

static size_t count_of(const struct part *part, int array)
{
    return array == IMPORT_INDICES ? part->record.triangle_count : part->record.vertex_count;
}

static float *add_array(struct part *part, enum import_array array)
{
    part->arrays[array] = array_alloc(count_of(part, (int)array), importer_array_words(array) * 4);
    return part->arrays[array];
}

static bool copy_vec3(struct part *part, enum import_array array, const struct aiVector3D *from)
{
    float *out = add_array(part, array);
    if (out)
        memcpy(out, from, (size_t)part->record.vertex_count * sizeof *from);
    return out;
}

static bool copy_uvs(struct part *part, enum import_array array, const struct aiVector3D *from)
{
    float *out = add_array(part, array);
    for (uint32_t i = 0; out && i < part->record.vertex_count; i++) {
        out[2 * i] = from[i].x;
        out[2 * i + 1] = from[i].y;
    }
    return out;
}

static bool copy_tangents(struct part *part, const struct aiMesh *mesh)
{
    float *out = add_array(part, IMPORT_TANGENTS);
    for (uint32_t i = 0; out && i < part->record.vertex_count; i++) {
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

static bool good_face(const struct aiFace *face, uint32_t vertex_count)
{
    return face->mNumIndices == 3 && face->mIndices[0] < vertex_count &&
           face->mIndices[1] < vertex_count && face->mIndices[2] < vertex_count;
}

static void count_faces(const struct aiMesh *mesh, struct part *part, struct import_counts *counts)
{
    for (uint32_t i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (good_face(face, mesh->mNumVertices))
            part->record.triangle_count++;
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
    uint32_t *out = (uint32_t *)add_array(part, IMPORT_INDICES);
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
    /* The normals of an STL are those of its facets, where they are not wrong. */
    if (ok && mesh->mNormals && kind != IMPORT_STL)
        ok = copy_vec3(part, IMPORT_NORMALS, mesh->mNormals);
    for (int i = 0; i < 2; i++)
        if (ok && mesh->mTextureCoords[i])
            ok = copy_uvs(part, i ? IMPORT_UV1 : IMPORT_UV0, mesh->mTextureCoords[i]);
    if (ok && mesh->mColors[0]) {
        float *out = add_array(part, IMPORT_COLORS);
        ok = out;
        if (ok)
            memcpy(out, mesh->mColors[0], (size_t)mesh->mNumVertices * 4 * sizeof *out);
    }
    if (ok && mesh->mTangents && mesh->mBitangents && mesh->mNormals)
        ok = copy_tangents(part, mesh);
    return ok;
}

/* --- normals ------------------------------------------------------------------------------- */

static void triangle_cross(const struct part *part, uint32_t triangle, double out[3])
{
    const float *positions = part->arrays[IMPORT_POSITIONS];
    const uint32_t *index = (const uint32_t *)part->arrays[IMPORT_INDICES] + (size_t)triangle * 3;
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
        double origin = positions[(size_t)index[0] * 3 + (size_t)i];
        a[i] = positions[(size_t)index[1] * 3 + (size_t)i] - origin;
        b[i] = positions[(size_t)index[2] * 3 + (size_t)i] - origin;
    }
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
    double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int i = 0; i < 3; i++)
        out[i] = length > 0 && isfinite(length) ? out[i] / length : 0;
}

static bool usable_normal(const float *n)
{
    double length = (double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2];
    return length > 1e-20 && isfinite(length);
}

/* Vertices whose file gives no direction (assimp leaves zeros) get that of their faces. */
static bool repair_normals(struct part *part)
{
    float *normals = part->arrays[IMPORT_NORMALS];
    uint32_t vertex_count = part->record.vertex_count, bad = 0;
    uint8_t *is_bad = normals ? array_alloc_zeroed(vertex_count, 1) : NULL;
    if (!is_bad)
        return !normals;
    for (uint32_t i = 0; i < vertex_count; i++) {
        if (usable_normal(normals + (size_t)i * 3))
            continue;
        memset(normals + (size_t)i * 3, 0, 3 * sizeof *normals);
        is_bad[i] = 1;
        bad++;
    }
    const uint32_t *indices = part->arrays[IMPORT_INDICES];
    for (uint32_t i = 0; bad && i < part->record.triangle_count; i++) {
        double cross[3];
        triangle_cross(part, i, cross);
        for (int corner = 0; corner < 3; corner++) {
            uint32_t vertex = indices[(size_t)i * 3 + (size_t)corner];
            for (int k = 0; is_bad[vertex] && k < 3; k++)
                normals[(size_t)vertex * 3 + (size_t)k] += (float)cross[k];
        }
    }
    for (uint32_t i = 0; bad && i < vertex_count; i++)
        if (!usable_normal(normals + (size_t)i * 3))
            memcpy(normals + (size_t)i * 3, (float[3]){0, 1, 0}, 3 * sizeof *normals);
    free(is_bad);
    return true;
}

/* One vertex for each corner. */
static bool expand(struct part *part)
{
    const uint32_t *old = part->arrays[IMPORT_INDICES];
    uint32_t corners = part->record.triangle_count * 3;
    if (part->record.triangle_count > UINT32_MAX / 3)
        return false;
    for (int array = 0; array < IMPORT_INDICES; array++) {
        const uint32_t *from = part->arrays[array];
        size_t words = importer_array_words((enum import_array)array);
        uint32_t *to = from ? array_alloc(corners, words * 4) : NULL;
        if (from && !to)
            return false;
        for (size_t i = 0; to && i < corners; i++)
            memcpy(to + i * words, from + old[i] * words, words * 4);
        free(part->arrays[array]);
        part->arrays[array] = to;
    }
    uint32_t *indices = part->arrays[IMPORT_INDICES];
    for (uint32_t i = 0; i < corners; i++)
        indices[i] = i;
    part->record.vertex_count = corners;
    return true;
}

/* Flat normals for a part whose siblings have smooth ones. */
static bool add_flat_normals(struct part *part)
{
    if (!expand(part))
        return false;
    float *normals = add_array(part, IMPORT_NORMALS);
    for (uint32_t i = 0; normals && i < part->record.triangle_count; i++) {
        double cross[3];
        triangle_cross(part, i, cross);
        for (size_t k = 0; k < 9; k++)
            normals[(size_t)i * 9 + k] = (float)cross[k % 3];
    }
    return normals;
}

/* --- welding ------------------------------------------------------------------------------- */

struct weld {
    uint32_t stride; /* words per record */
    uint32_t *records;
    uint32_t *table; /* index + 1 of a record; 0: free */
    size_t mask;
};

static size_t hash_words(const uint32_t *words, uint32_t count)
{
    uint64_t h = 0x9e3779b97f4a7c15u;
    for (uint32_t i = 0; i < count; i++) {
        h = (h ^ words[i]) * 0xff51afd7ed558ccdu;
        h ^= h >> 32;
    }
    return (size_t)h;
}

static bool weld_init(struct weld *weld, const struct part *part)
{
    uint32_t count = part->record.vertex_count;
    size_t slots = 16;
    *weld = (struct weld){0};
    for (int array = 0; array < IMPORT_INDICES; array++)
        if (part->arrays[array])
            weld->stride += importer_array_words((enum import_array)array);
    while (slots < (size_t)count * 2)
        slots *= 2;
    weld->mask = slots - 1;
    weld->records = array_alloc(count, weld->stride * sizeof *weld->records);
    weld->table = array_alloc_zeroed(slots, sizeof *weld->table);
    return weld->records && weld->table;
}

/* Copies between the part's arrays and the records, in which a vertex is one run of words. */
static void interleave(struct weld *weld, struct part *part, bool back)
{
    uint32_t at = 0;
    for (int array = 0; array < IMPORT_INDICES; array++) {
        uint32_t words = importer_array_words((enum import_array)array);
        uint32_t *plain = part->arrays[array];
        if (!plain)
            continue;
        for (size_t i = 0; i < part->record.vertex_count; i++) {
            uint32_t *record = weld->records + i * weld->stride + at;
            for (uint32_t k = 0; k < words; k++)
                *(back ? &plain[i * words + k] : &record[k]) =
                    back ? record[k] : plain[i * words + k];
        }
        at += words;
    }
}

static uint32_t weld_find(struct weld *weld, uint32_t vertex, uint32_t unique_count)
{
    const uint32_t *record = weld->records + (size_t)vertex * weld->stride;
    size_t slot = hash_words(record, weld->stride) & weld->mask;
    for (; weld->table[slot]; slot = (slot + 1) & weld->mask) {
        uint32_t other = weld->table[slot] - 1;
        if (!memcmp(weld->records + (size_t)other * weld->stride, record, weld->stride * 4))
            return other;
    }
    weld->table[slot] = unique_count + 1;
    memmove(weld->records + (size_t)unique_count * weld->stride, record, weld->stride * 4);
    return unique_count;
}

/* Makes bit-identical vertices one; the first use decides the order. */
static bool weld_part(struct part *part)
{
    struct weld weld;
    uint32_t *indices = part->arrays[IMPORT_INDICES], unique_count = 0;
    uint32_t *moved = array_alloc(part->record.vertex_count, sizeof *moved);
    bool ok = weld_init(&weld, part) && moved;
    if (ok) {
        interleave(&weld, part, false);
        for (uint32_t i = 0; i < part->record.vertex_count; i++) {
            moved[i] = weld_find(&weld, i, unique_count);
            unique_count += moved[i] == unique_count;
        }
        for (size_t i = 0; i < (size_t)part->record.triangle_count * 3; i++)
            indices[i] = moved[indices[i]];
        part->record.vertex_count = unique_count;
        interleave(&weld, part, true);
    }
    free(weld.records);
    free(weld.table);
    free(moved);
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
    struct part part = {.record.vertex_count = mesh->mNumVertices};
    count_faces(mesh, &part, &flat->counts);
    if (part.record.triangle_count == 0 || !mesh->mVertices)
        return true;
    unsigned group = 0;
    if (kind == IMPORT_GLTF)
        sscanf(mesh->mName.data, "m%u", &group);
    part.record.group = group;
    part.name = string_copy(mesh->mName.data);
    part.material = material_name(scene, mesh);
    bool ok = part.name && part.material && copy_arrays(&part, mesh, kind);
    flat->parts[flat->count++] = part;
    return ok;
}

/* Groups of which some part has normals. */
static bool find_shaded(const struct flat *flat, struct table *groups)
{
    uint32_t first;
    for (uint32_t i = 0; i < flat->count; i++) {
        const uint32_t *group = &flat->parts[i].record.group;
        if (flat->parts[i].arrays[IMPORT_NORMALS] &&
            !table_find(groups, group, sizeof *group, &first) &&
            !table_add(groups, group, sizeof *group, i))
            return false;
    }
    return true;
}

static bool finish_parts(struct flat *flat, const struct table *shaded, enum import_kind kind)
{
    for (uint32_t i = 0; i < flat->count; i++) {
        struct part *part = &flat->parts[i];
        uint32_t *group = &part->record.group, first;
        bool flat_normals =
            !part->arrays[IMPORT_NORMALS] && table_find(shaded, group, sizeof *group, &first);
        if (flat_normals ? !add_flat_normals(part) : !repair_normals(part))
            return false;
        bool corners = kind == IMPORT_OBJ || kind == IMPORT_STL || flat_normals;
        if (corners && !weld_part(part))
            return false;
    }
    return true;
}

static bool flatten(struct flat *flat, const struct aiScene *scene, enum import_kind kind)
{
    flat->parts = array_alloc_zeroed(scene->mNumMeshes, sizeof *flat->parts);
    if (!flat->parts)
        return false;
    for (uint32_t i = 0; i < scene->mNumMeshes; i++)
        if (!flatten_mesh(flat, scene, scene->mMeshes[i], kind))
            return false;
    struct table shaded = {0};
    bool ok = find_shaded(flat, &shaded) && finish_parts(flat, &shaded, kind);
    table_finish(&shaded);
    return ok;
}

static void flat_finish(struct flat *flat)
{
    for (uint32_t i = 0; i < flat->count; i++)
        part_finish(&flat->parts[i]);
    free(flat->parts);
}

/* --- writing ------------------------------------------------------------------------------- */

static uint64_t place(uint64_t *at, uint64_t bytes)
{
    uint64_t offset = *at;
    *at = (offset + bytes + 7) & ~UINT64_C(7);
    return offset;
}

/* Sets all offsets; the size of the block. */
static uint64_t layout(struct flat *flat)
{
    uint64_t at = sizeof(struct import_header) + flat->count * sizeof(struct import_record);
    for (uint32_t i = 0; i < flat->count; i++) {
        struct part *part = &flat->parts[i];
        struct import_record *record = &part->record;
        record->name_bytes = (uint32_t)strlen(part->name);
        record->material_bytes = (uint32_t)strlen(part->material);
        record->name = place(&at, (uint64_t)record->name_bytes + 1);
        record->material = place(&at, (uint64_t)record->material_bytes + 1);
        for (int a = 0; a < IMPORT_ARRAY_COUNT; a++)
            if (part->arrays[a])
                record->arrays[a] =
                    place(&at, count_of(part, a) * importer_array_words((enum import_array)a) * 4);
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
    bool ok = write_padded(to, write, part->name, (uint64_t)part->record.name_bytes + 1) &&
              write_padded(to, write, part->material, (uint64_t)part->record.material_bytes + 1);
    for (int a = 0; ok && a < IMPORT_ARRAY_COUNT; a++)
        if (part->arrays[a])
            ok = write_padded(to, write, part->arrays[a],
                              count_of(part, a) * importer_array_words((enum import_array)a) * 4);
    return ok;
}

static bool write_block(struct flat *flat, void *to, child_write write)
{
    struct import_header header = {
        .magic = IMPORT_MAGIC, .part_count = flat->count, .counts = flat->counts};
    header.size_bytes = layout(flat);
    bool ok = write(to, &header, sizeof header);
    for (uint32_t i = 0; ok && i < flat->count; i++)
        ok = write(to, &flat->parts[i].record, sizeof flat->parts[i].record);
    for (uint32_t i = 0; ok && i < flat->count; i++)
        ok = write_part(&flat->parts[i], to, write);
    return ok;
}

static int write_error(const char *text, void *to, child_write write)
{
    const uint32_t magic = IMPORT_ERROR_MAGIC;
    if (strstr(text, "bad_alloc"))
        return CHILD_EXIT_MEMORY;
    if (!text[0])
        text = "refused without a reason";
    bool ok = write(to, &magic, sizeof magic) && write(to, "assimp: ", 8) &&
              write(to, text, strlen(text));
    return ok ? 0 : 1;
}

_Static_assert(sizeof(struct import_header) % 8 == 0, "records follow the header");
_Static_assert(sizeof(struct import_record) % 8 == 0, "strings follow the records");

/* Looked for before assimp cuts faces into triangles. */
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

int importer_assimp_run(void *user, void *to, child_write write)
{
    const struct import_request *request = user;
    struct library library = {.request = request};
    struct aiFileIO io = {
        .OpenProc = open_file, .CloseProc = close_file, .UserData = (aiUserData)&library};
    for (uint32_t i = 0; i < request->file_count; i++) {
        const char *name = request->files[i].name;
        if (!table_add(&library.names, name, strlen(name), i))
            return CHILD_EXIT_MEMORY;
    }
    const struct aiScene *scene = aiImportFileEx(request->files[0].name, 0, &io);
    table_finish(&library.names);
    if (!scene)
        return library.lacks_memory ? CHILD_EXIT_MEMORY
                                    : write_error(aiGetErrorString(), to, write);
    struct flat flat = {0};
    bool refused = has_long_face(scene, &flat.counts);
    if (!refused)
        scene = aiApplyPostProcessing(scene, aiProcess_Triangulate);
    if (!scene) /* released, for want of memory: nothing else stops this step */
        return CHILD_EXIT_MEMORY;
    int code = 1;
    if (!refused && !flatten(&flat, scene, request->kind))
        code = CHILD_EXIT_MEMORY;
    else if (write_block(&flat, to, write))
        code = 0;
    flat_finish(&flat);
    aiReleaseImport(scene);
    return code;
}
