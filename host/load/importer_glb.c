/* The child's side of the importer, for formats with node trees and materials: turns assimp's scene
   into a GLB in metres with y upwards, which whit then reads as any other GLB. */
#include <assimp/cexport.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/metadata.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "image/image.h"
#include "load/importer_glb.h"
#include "load/unread.h"

/* --- units and axes ------------------------------------------------------------------------- */

static const struct aiMetadataEntry *find_meta(const struct aiScene *scene, const char *key)
{
    const struct aiMetadata *all = scene->mMetaData;
    for (unsigned i = 0; all && i < all->mNumProperties; i++)
        if (strcmp(all->mKeys[i].data, key) == 0)
            return &all->mValues[i];
    return NULL;
}

static int meta_int(const struct aiScene *scene, const char *key, int without)
{
    const struct aiMetadataEntry *entry = find_meta(scene, key);
    return entry && entry->mType == AI_INT32 ? *(const int32_t *)entry->mData : without;
}

static double meta_double(const struct aiScene *scene, const char *key, double without)
{
    const struct aiMetadataEntry *entry = find_meta(scene, key);
    bool is_float = entry && entry->mType == AI_FLOAT;
    if (entry && entry->mType == AI_DOUBLE)
        return *(const double *)entry->mData;
    return is_float ? (double)*(const float *)entry->mData : without;
}

/* Sets a row of *out: coordinate `row` becomes `length` times the file's coordinate `axis`. */
static void set_row(struct aiMatrix4x4 *out, int row, int axis, double length)
{
    ai_real *rows[3] = {&out->a1, &out->b1, &out->c1};
    for (int i = 0; i < 3; i++)
        rows[row][i] = i == axis ? (ai_real)length : 0;
}

/* FBX states its unit (UnitScaleFactor, in centimetres) and which axes are side, up and front. */
static void place_fbx(const struct aiScene *scene, struct aiMatrix4x4 *out)
{
    static const char *const axes[3][2] = {
        {"CoordAxis", "CoordAxisSign"}, {"UpAxis", "UpAxisSign"}, {"FrontAxis", "FrontAxisSign"}};
    double metres = meta_double(scene, "UnitScaleFactor", 1) / 100;
    int axis[3], sign[3], seen = 0;
    for (int i = 0; i < 3; i++) {
        axis[i] = meta_int(scene, axes[i][0], i);
        sign[i] = meta_int(scene, axes[i][1], 1) < 0 ? -1 : 1;
        seen |= axis[i] >= 0 && axis[i] < 3 ? 1 << axis[i] : 0;
    }
    for (int i = 0; i < 3; i++)
        set_row(out, i, seen == 7 ? axis[i] : i, metres * (seen == 7 ? sign[i] : 1));
}

/* 3MF has z upwards. */
static void place_3mf(double metres, struct aiMatrix4x4 *out)
{
    set_row(out, 0, 0, metres);
    set_row(out, 1, 2, metres);
    set_row(out, 2, 1, -metres);
}

/* Applies the file's units and axes to the root node. For COLLADA assimp has done so already; OFF
   has neither. */
static void place(struct aiScene *scene, enum import_kind kind, double metres)
{
    struct aiMatrix4x4 placed;
    aiIdentityMatrix4(&placed);
    if (kind == IMPORT_FBX)
        place_fbx(scene, &placed);
    else if (kind == IMPORT_3MF)
        place_3mf(metres, &placed);
    aiMultiplyMatrix4(&placed, &scene->mRootNode->mTransformation);
    scene->mRootNode->mTransformation = placed;
}

/* --- textures ------------------------------------------------------------------------------- */

/* Cuts absolute paths with letters beyond ASCII down to the file's name: they are of the exporter's
   machine, often in a code page of its own, and JSON has to be UTF-8. */
static void shorten_paths(struct aiMaterial *material)
{
    for (unsigned i = 0; i < material->mNumProperties; i++) {
        struct aiMaterialProperty *property = material->mProperties[i];
        struct aiString path = {0};
        if (strcmp(property->mKey.data, "$tex.file") != 0 ||
            aiGetMaterialString(material, property->mKey.data, property->mSemantic,
                                property->mIndex, &path) != aiReturn_SUCCESS)
            continue;
        bool ascii = true;
        for (char *c = path.data; *c; c++) {
            ascii = ascii && (unsigned char)*c < 0x80;
            *c = *c == '\\' ? '/' : *c;
        }
        if (ascii || (path.data[0] != '/' && path.data[1] != ':'))
            continue;
        /* The property has room: the new path is no longer than the old one. Its layout is a
           length, the text and a zero byte. */
        const char *name = path_name(path.data);
        ai_uint32 length = (ai_uint32)strlen(name);
        memcpy(property->mData, &length, sizeof length);
        memcpy(property->mData + sizeof length, name, length + 1);
        property->mDataLength = (unsigned)(sizeof length + length + 1);
    }
}

static bool meshes_have_set(const struct aiScene *scene, unsigned material, unsigned set)
{
    bool all = set < AI_MAX_NUMBER_OF_TEXTURECOORDS;
    for (unsigned i = 0; all && i < scene->mNumMeshes; i++)
        all =
            scene->mMeshes[i]->mMaterialIndex != material || scene->mMeshes[i]->mTextureCoords[set];
    return all;
}

/* Replaces sets of texture coordinates that a mesh lacks, or all, by the first. */
static void check_uv_sets(const struct aiScene *scene, unsigned index, bool trusted)
{
    const struct aiMaterial *material = scene->mMaterials[index];
    for (unsigned i = 0; i < material->mNumProperties; i++) {
        struct aiMaterialProperty *property = material->mProperties[i];
        unsigned set = 0;
        if (strcmp(property->mKey.data, "$tex.uvwsrc") != 0 || property->mDataLength != sizeof set)
            continue;
        memcpy(&set, property->mData, sizeof set);
        if (!trusted || !meshes_have_set(scene, index, set))
            memset(property->mData, 0, sizeof set);
    }
}

/* FBX scales textures about the origin and then moves them; assimp moves them first, and scales
   them about the middle of the picture. */
static void restate_moves(struct aiMaterial *material)
{
    for (unsigned i = 0; i < material->mNumProperties; i++) {
        const struct aiMaterialProperty *property = material->mProperties[i];
        struct aiUVTransform moved;
        if (strcmp(property->mKey.data, "$tex.uvtrafo") != 0 ||
            property->mDataLength < sizeof moved)
            continue;
        memcpy(&moved, property->mData, sizeof moved);
        if (moved.mScaling.x == 0 || moved.mScaling.y == 0)
            continue;
        moved.mTranslation.x = (moved.mTranslation.x - 0.5f) / moved.mScaling.x + 0.5f;
        moved.mTranslation.y = (moved.mTranslation.y - 0.5f) / moved.mScaling.y + 0.5f;
        memcpy(property->mData, &moved, sizeof moved);
    }
}

/* Makes the exporter see a whole number, which it looks for as plain bytes. */
static void show_whole(struct aiMaterial *material, const char *key)
{
    for (unsigned i = 0; i < material->mNumProperties; i++)
        if (strcmp(material->mProperties[i]->mKey.data, key) == 0)
            material->mProperties[i]->mType = aiPTI_Buffer;
}

/* --- highlights ----------------------------------------------------------------------------- */

/* Whether the file asks for no highlight. assimp gives a COLLADA material without one a specular
   colour of 0.4 and an exponent of 10. */
static bool is_matt(const struct aiMaterial *material, enum import_kind kind, const float color[3],
                    float exponent)
{
    int model = aiShadingMode_Phong;
    unsigned one = 1;
    aiGetMaterialIntegerArray(material, AI_MATKEY_SHADING_MODEL, &model, &one);
    bool filled_in = kind == IMPORT_DAE && color[0] == 0.4f && color[1] == 0.4f &&
                     color[2] == 0.4f && exponent == 10;
    return filled_in || !(exponent > 0) || model == aiShadingMode_Flat ||
           model == aiShadingMode_Gouraud || model == aiShadingMode_NoShading;
}

static float *find_floats(struct aiMaterial *material, const char *key, size_t count)
{
    for (unsigned i = 0; i < material->mNumProperties; i++) {
        struct aiMaterialProperty *property = material->mProperties[i];
        if (strcmp(property->mKey.data, key) == 0 && property->mType == aiPTI_Float &&
            property->mDataLength >= count * sizeof(float))
            return (float *)(void *)property->mData;
    }
    return NULL;
}

/* Restates Phong's specular colour and exponent as the F0 and glossiness that the exporter writes.
   The lobe of GGX gets the width of Blinn's, alpha^2 = 2 / (n + 2), and its energy: a lobe of
   exponent n sends 8 / (n + 8) as much light as one of exponent 0 (Akenine-Moeller et al.,
   "Real-Time Rendering"). assimp gives an FBX without a roughness that of 1 - sqrt(n) / 10. Other
   materials with a roughness or a glossiness are physically based, and stay as they are. */
static void restate_highlight(struct aiMaterial *material, enum import_kind kind)
{
    float *color = find_floats(material, "$clr.specular", 3);
    float *shininess = find_floats(material, "$mat.shininess", 1);
    float *roughness = find_floats(material, "$mat.roughnessFactor", 1);
    const float *strength = find_floats(material, "$mat.shinpercent", 1); /* FBX: SpecularFactor */
    float exponent = shininess ? fmaxf(*shininess, 0) : 0;
    if (!color || find_floats(material, "$mat.glossinessFactor", 1) ||
        (roughness && fabsf(1 - sqrtf(exponent) / 10 - *roughness) > 1e-4f))
        return;
    float share = is_matt(material, kind, color, exponent) ? 0 : 8 / (exponent + 8);
    share *= strength ? fmaxf(*strength, 0) : 1;
    float glossiness = 1 - sqrtf(sqrtf(2 / (exponent + 2)));
    for (int i = 0; i < 3; i++)
        color[i] *= share;
    if (roughness)
        *roughness = 1 - glossiness;
    else if (shininess) /* the exporter's scale of glossiness */
        *shininess = 1000 * glossiness;
}

/* Makes a `<constant>` of COLLADA unlit: what it emits becomes the base colour. */
static void restate_constant(struct aiMaterial *material)
{
    int model = 0;
    unsigned one = 1;
    float *diffuse = find_floats(material, "$clr.diffuse", 4);
    const float *emission = find_floats(material, "$clr.emissive", 4);
    aiGetMaterialIntegerArray(material, AI_MATKEY_SHADING_MODEL, &model, &one);
    if (model != aiShadingMode_NoShading || !diffuse || !emission)
        return;
    memcpy(diffuse, emission, 3 * sizeof *diffuse);
    for (unsigned i = 0; i < material->mNumProperties; i++)
        if (material->mProperties[i]->mSemantic == aiTextureType_EMISSIVE)
            material->mProperties[i]->mSemantic = aiTextureType_DIFFUSE;
}

/* --- the whole ------------------------------------------------------------------------------ */

/* Removes from assimp's scene what whit does not import, and counts it for notes. Texture
   coordinates keep two components: assimp writes three as they are, which glTF does not allow. */
static void drop(struct aiScene *scene, enum import_kind kind, struct import_counts *counts)
{
    for (unsigned i = 0; i < scene->mNumMeshes; i++) {
        struct aiMesh *mesh = scene->mMeshes[i];
        counts->skins += mesh->mNumBones > 0;
        mesh->mNumBones = 0;
        for (int set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; set++)
            mesh->mNumUVComponents[set] = 2;
    }
    counts->animations = scene->mNumAnimations;
    if (kind == IMPORT_3MF) { /* assimp 5.2.4 has freed its pictures, most often a thumbnail */
        counts->pictures = scene->mNumTextures;
        scene->mNumTextures = 0;
    }
    counts->lights = scene->mNumLights;
    counts->cameras = scene->mNumCameras;
    scene->mNumAnimations = 0;
    scene->mNumCameras = scene->mNumLights = 0;
}

/* Decodes a colour of 3MF, which is sRGB. Its opacity, of which assimp 5.2 makes 0 where the file
   states none, becomes 1, as assimp states such a material as opaque. */
static void decode_color(struct aiMaterial *material)
{
    float *color = find_floats(material, "$clr.diffuse", 4);
    for (int i = 0; color && i < 4; i++)
        color[i] = i < 3 ? image_linear_from_srgb(color[i]) : 1;
}

/* Divides the colours of an OFF by 255 if one is larger than 1: assimp passes bytes on as they are,
   and the format states no range. */
static void scale_colors(struct aiMesh *mesh)
{
    float *colors = (float *)mesh->mColors[0], largest = 0;
    size_t count = colors ? (size_t)mesh->mNumVertices * 4 : 0;
    for (size_t i = 0; i < count; i++)
        largest = fmaxf(largest, colors[i]);
    for (size_t i = 0; largest > 1 && i < count; i++)
        colors[i] /= 255;
}

const struct aiExportDataBlob *importer_glb(const struct aiScene **imported,
                                            const struct import_request *request, double metres,
                                            struct import_counts *counts)
{
    bool trusted = request->kind != IMPORT_DAE || unread_trusts_sets(&request->files[0]);
    for (unsigned i = 0; i < (*imported)->mNumMaterials; i++) {
        check_uv_sets(*imported, i, trusted);
        if (request->kind == IMPORT_FBX)
            restate_moves((*imported)->mMaterials[i]);
    }
    /* The exporter does not write scales and offsets of textures: they go into the coordinates. */
    *imported = aiApplyPostProcessing(*imported, aiProcess_TransformUVCoords);
    if (!*imported)
        return NULL;
    struct aiScene *scene = (struct aiScene *)(uintptr_t)*imported;
    drop(scene, request->kind, counts);
    for (unsigned i = 0; request->kind == IMPORT_OFF && i < scene->mNumMeshes; i++)
        scale_colors(scene->mMeshes[i]);
    place(scene, request->kind, metres);
    unread_count(request, counts);
    for (unsigned i = 0; i < scene->mNumMaterials; i++) {
        shorten_paths(scene->mMaterials[i]);
        show_whole(scene->mMaterials[i], "$tex.uvwsrc");
        restate_highlight(scene->mMaterials[i], request->kind);
        if (request->kind == IMPORT_DAE) {
            restate_constant(scene->mMaterials[i]);
            show_whole(scene->mMaterials[i], "$mat.shadingm");
        }
        if (request->kind == IMPORT_3MF)
            decode_color(scene->mMaterials[i]);
    }
    return aiExportSceneToBlob(scene, "glb2", 0);
}
