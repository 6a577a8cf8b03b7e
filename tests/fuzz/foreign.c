/* A stand-in for the foreign importer, linked in with --wrap. assimp is not fuzzed: it runs in a
   child process because it crashes on bad files. What matters here is that whit survives any
   answer, so the bytes of the model, read from its end, say what assimp's scene looks like: indices
   out of range, arrays that are missing, floats of any bits, and words of the child's reply written
   over. The child's side runs in this process. */
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "fuzz.h"

#include "../child_in_place.h"
#include "../wrapped.h"

/* --- the bytes of the fuzzer, which decide what is imported --------------------------------- */

static struct {
    uint8_t *data;
    size_t left;
} stream;

static uint8_t take(void)
{
    return stream.left ? stream.data[--stream.left] : 0;
}

static float take_float(bool raw)
{
    if (!raw)
        return (float)(int8_t)take() / 8.0f;
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++)
        bits = bits << 8 | take();
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* All of the file, through the callbacks. Of a glTF what Draco has packed: its JSON is made by
 * whit. */
static bool open_stream(const char *name, struct aiFileIO *io)
{
    struct aiFile *file = NULL;
    if (strcmp(name, "model.gltf") == 0)
        file = io->OpenProc(io, "0.bin", "rb");
    if (!file)
        file = io->OpenProc(io, name, "rb");
    if (!file)
        return false;
    size_t size = file->FileSizeProc(file);
    stream.data = array_alloc(size, 1);
    fuzz_check(stream.data, "out of memory");
    stream.left = file->ReadProc(file, (char *)stream.data, 1, size);
    fuzz_check(stream.left == size && file->TellProc(file) == size, "a file that cannot be read");
    fuzz_check(file->SeekProc(file, size + 1, aiOrigin_SET) == aiReturn_FAILURE, "seeks too far");
    io->CloseProc(io, file);
    return true;
}

/* --- assimp's scene ------------------------------------------------------------------------- */

static void *zeroed(size_t count, size_t bytes)
{
    void *memory = array_alloc_zeroed(count, bytes);
    fuzz_check(memory, "out of memory");
    return memory;
}

static struct aiVector3D *make_vectors(uint32_t count, bool raw)
{
    struct aiVector3D *out = zeroed(count, sizeof *out);
    for (uint32_t i = 0; i < count; i++)
        out[i] = (struct aiVector3D){take_float(raw), take_float(raw), take_float(raw)};
    return out;
}

static void make_faces(struct aiMesh *mesh, bool raw)
{
    mesh->mNumFaces = take();
    mesh->mFaces = zeroed(mesh->mNumFaces, sizeof *mesh->mFaces);
    for (uint32_t i = 0; i < mesh->mNumFaces && stream.left; i++) {
        struct aiFace *face = &mesh->mFaces[i];
        face->mNumIndices = raw ? take() % 6 : 3;
        face->mIndices = zeroed(face->mNumIndices, sizeof *face->mIndices);
        for (uint32_t k = 0; k < face->mNumIndices; k++) {
            uint32_t index = take();
            face->mIndices[k] = raw || !mesh->mNumVertices ? index : index % mesh->mNumVertices;
            if (raw && index == 255)
                face->mIndices[k] = UINT32_MAX;
        }
    }
}

static struct aiMesh *make_mesh(uint32_t number)
{
    struct aiMesh *mesh = zeroed(1, sizeof *mesh);
    uint8_t has = take(), odd = take();
    bool raw_floats = odd & 1, raw_faces = odd & 2;
    mesh->mNumVertices = take();
    mesh->mMaterialIndex = odd >> 4;
    mesh->mName.length =
        (ai_uint32)snprintf(mesh->mName.data, sizeof mesh->mName.data, "m%u", number);
    uint32_t count = mesh->mNumVertices;
    make_faces(mesh, raw_faces);
    if (!(odd & 8))
        mesh->mVertices = make_vectors(count, raw_floats);
    if (has & 1)
        mesh->mNormals = make_vectors(count, raw_floats);
    for (int i = 0; i < 2; i++)
        if (has & 2 << i)
            mesh->mTextureCoords[i] = make_vectors(count, raw_floats);
    if (has & 8)
        mesh->mTangents = make_vectors(count, raw_floats);
    if (has & 16)
        mesh->mBitangents = make_vectors(count, raw_floats);
    if (has & 32) {
        mesh->mColors[0] = zeroed(count, sizeof *mesh->mColors[0]);
        for (uint32_t i = 0; i < count; i++)
            mesh->mColors[0][i].r = mesh->mColors[0][i].a = take_float(raw_floats);
    }
    return mesh;
}

/* Makes a material with a name as its only property; other files of the run use the same names. */
static struct aiMaterial *make_material(uint32_t number)
{
    struct aiMaterial *material = zeroed(1, sizeof *material);
    struct aiMaterialProperty *name = zeroed(1, sizeof *name);
    char text[16] = "";
    uint32_t length = number ? (uint32_t)snprintf(text, sizeof text, "m%u", number) : 0;
    strcpy(name->mKey.data, "?mat.name");
    name->mKey.length = (ai_uint32)strlen(name->mKey.data);
    name->mType = aiPTI_String;
    name->mDataLength = 4 + length + 1;
    name->mData = zeroed(name->mDataLength, 1);
    memcpy(name->mData, &length, 4);
    memcpy(name->mData + 4, text, length);
    material->mProperties = zeroed(1, sizeof *material->mProperties);
    material->mProperties[0] = name;
    material->mNumProperties = material->mNumAllocated = 1;
    return material;
}

static void mesh_free(struct aiMesh *mesh)
{
    for (uint32_t i = 0; i < mesh->mNumFaces; i++)
        free(mesh->mFaces[i].mIndices);
    free(mesh->mFaces);
    free(mesh->mVertices);
    free(mesh->mNormals);
    free(mesh->mTextureCoords[0]);
    free(mesh->mTextureCoords[1]);
    free(mesh->mTangents);
    free(mesh->mBitangents);
    free(mesh->mColors[0]);
    free(mesh);
}

WRAPPED(void, aiReleaseImport, const struct aiScene *scene)
{
    for (uint32_t i = 0; i < scene->mNumMeshes; i++)
        mesh_free(scene->mMeshes[i]);
    for (uint32_t i = 0; i < scene->mNumMaterials; i++) {
        free(scene->mMaterials[i]->mProperties[0]->mData);
        free(scene->mMaterials[i]->mProperties[0]);
        free(scene->mMaterials[i]->mProperties);
        free(scene->mMaterials[i]);
    }
    free(scene->mMeshes);
    free(scene->mMaterials);
    free((void *)(uintptr_t)scene);
}

WRAPPED(const char *, aiGetErrorString, void)
{
    static const char *const texts[] = {"", "model.obj: line 3\n is no line", "std::bad_alloc"};
    return texts[take() % 2];
}

/* Each refusal by assimp is one byte in 16. */
WRAPPED(const struct aiScene *, aiImportFileExWithProperties, const char *name, unsigned flags,
        struct aiFileIO *io, const struct aiPropertyStore *wants)
{
    (void)flags, (void)wants;
    if (!open_stream(name, io) || take() % 16 == 15)
        return NULL;
    struct aiScene *scene = zeroed(1, sizeof *scene);
    scene->mNumMeshes = take() % 8;
    scene->mNumMaterials = take() % 4;
    scene->mMeshes = zeroed(scene->mNumMeshes, sizeof *scene->mMeshes);
    scene->mMaterials = zeroed(scene->mNumMaterials, sizeof *scene->mMaterials);
    for (uint32_t i = 0; i < scene->mNumMeshes; i++)
        scene->mMeshes[i] = make_mesh(i);
    for (uint32_t i = 0; i < scene->mNumMaterials; i++)
        scene->mMaterials[i] = make_material(i);
    return scene;
}

/* Faces of more than three corners are damaged ones here. */
WRAPPED(const struct aiScene *, aiApplyPostProcessing, const struct aiScene *scene, unsigned flags)
{
    (void)flags;
    return scene;
}

/* --- the child process ---------------------------------------------------------------------- */

/* Writes over some words of the reply, as a child that assimp has overrun might. */
static void damage(struct child_reply *written)
{
    for (int i = take() % 4; i > 0 && written->size_bytes >= 4; i--) {
        uint32_t at = take(), word = 0;
        at |= (uint32_t)take() << 8;
        for (int k = 0; k < 4; k++)
            word = word << 8 | take();
        memcpy(written->data + at * 4 % (written->size_bytes & ~(size_t)3), &word, 4);
    }
    if (take() == 77 && written->size_bytes)
        written->size_bytes -= 1 + take() % written->size_bytes;
}

void (*fuzz_reply)(struct child_reply *reply);

enum child_end __wrap_child_run(const struct child_limits *limits,
                                int (*fn)(void *user, void *to, child_write write), void *user,
                                struct child_reply *reply)
{
    (void)limits;
    enum child_end end = child_in_place(fn, user, reply, fuzz_reply ? fuzz_reply : damage);
    free(stream.data);
    stream.data = NULL;
    stream.left = 0;
    fuzz_check(end != CHILD_MEMORY, "the child's memory ran out");
    return end;
}
