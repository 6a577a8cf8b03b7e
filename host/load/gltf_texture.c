#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/same.h"
#include "base/text.h"
#include "load/gltf_buffer.h"
#include "load/gltf_json.h"
#include "load/texture_ahead.h"

/* --- images --------------------------------------------------------------------------------- */

static bool is_file_uri(const char *uri)
{
    return uri && strncmp(uri, "data:", 5) != 0;
}

static whit_result load_file_image(struct gltf *gltf, const char *uri, bool visible,
                                   uint32_t *texture)
{
    char *name = gltf_uri_name(uri);
    char *path = name ? picture_find_named(&gltf->scene->roots, gltf->request->path, name) : NULL;
    free(name);
    if (!path)
        return WHIT_ERROR_MEMORY;
    if (gltf->only_names) {
        load_texture_soon(gltf->scene, path, NULL, 0, gltf->request->params);
        free(path);
        return WHIT_OK;
    }
    whit_result result = WHIT_OK;
    /* A missing image becomes magenta where it is the visible colour; for other slots the material
       goes without a texture. */
    const char *why_not = visible ? NULL : roots_why_not(&gltf->scene->roots, path);
    if (why_not)
        scene_note(gltf->scene, SCENE_NOTE_WARNING, "%s: texture `%s`: %s",
                   path_name(gltf->request->path), text_token(uri).text, why_not);
    else
        result = load_texture(gltf->scene, path, NULL, 0, gltf->request->params, texture, NULL);
    free(path);
    return result;
}

static whit_result load_held_image(struct gltf *gltf, uint32_t index, const uint8_t *data,
                                   size_t size_bytes, uint32_t *texture)
{
    char *name = string_format("%s#images[%u]", gltf->request->path, index);
    if (!name)
        return WHIT_ERROR_MEMORY;
    whit_result result = WHIT_OK;
    if (gltf->only_names)
        load_texture_soon(gltf->scene, name, data, size_bytes, gltf->request->params);
    else
        result =
            load_texture(gltf->scene, name, data, size_bytes, gltf->request->params, texture, NULL);
    free(name);
    return result;
}

static whit_result load_data_image(struct gltf *gltf, uint32_t index, const char *uri, bool visible,
                                   uint32_t *texture)
{
    static const uint8_t no_picture[1];
    uint8_t *owned = NULL;
    size_t size = 0;
    whit_result result = gltf_decode_uri(uri, &owned, &size);
    if (result == WHIT_ERROR_INPUT) {
        scene_note(gltf->scene, SCENE_NOTE_WARNING, "%s: images[%u]: its data: URI is not base64",
                   path_name(gltf->request->path), index);
        if (!visible)
            return WHIT_OK;
        result = WHIT_OK;
    }
    if (result == WHIT_OK)
        result = load_held_image(gltf, index, owned ? owned : no_picture, size, texture);
    free(owned);
    return result;
}

static whit_result load_image(struct gltf *gltf, uint32_t index, bool visible, uint32_t *texture)
{
    struct gltf_place at;
    json_t *image;
    const char *uri;
    uint32_t view;
    const uint8_t *data;
    size_t size;
    if (!gltf_item(gltf, "images", index, &at, &image) ||
        !gltf_string(gltf, image, &at, "uri", &uri) ||
        !gltf_index(gltf, image, &at, "bufferView", gltf_count(gltf, "bufferViews"), &view))
        return WHIT_ERROR_INPUT;
    if (is_file_uri(uri))
        return load_file_image(gltf, uri, visible, texture);
    if (uri)
        return gltf->only_names ? WHIT_OK : load_data_image(gltf, index, uri, visible, texture);
    if (view == SCENE_NONE) {
        gltf_fail(gltf, &at, "has neither uri nor bufferView");
        return WHIT_ERROR_INPUT;
    }
    if (!gltf_view(gltf, view, &data, &size, NULL))
        return WHIT_ERROR_INPUT;
    return load_held_image(gltf, index, data, size, texture);
}

/* --- uses ----------------------------------------------------------------------------------- */

static enum scene_wrap wrap_of(uint64_t code)
{
    enum { CLAMP_TO_EDGE = 33071, MIRRORED_REPEAT = 33648 };
    return code == CLAMP_TO_EDGE     ? SCENE_WRAP_CLAMP
           : code == MIRRORED_REPEAT ? SCENE_WRAP_MIRROR
                                     : SCENE_WRAP_REPEAT;
}

static bool read_sampler(const struct gltf *gltf, uint32_t index, struct scene_texture_use *out)
{
    enum { NEAREST = 9728, REPEAT = 10497 };
    struct gltf_place at;
    json_t *sampler;
    uint64_t wrap_u = REPEAT, wrap_v = REPEAT, filter = 0;
    if (index == SCENE_NONE)
        return true;
    if (!gltf_item(gltf, "samplers", index, &at, &sampler) ||
        !gltf_whole(gltf, sampler, &at, "wrapS", UINT32_MAX, &wrap_u) ||
        !gltf_whole(gltf, sampler, &at, "wrapT", UINT32_MAX, &wrap_v) ||
        !gltf_whole(gltf, sampler, &at, "magFilter", UINT32_MAX, &filter))
        return false;
    out->wrap_u = wrap_of(wrap_u);
    out->wrap_v = wrap_of(wrap_v);
    out->nearest = filter == NEAREST;
    return true;
}

/* Scales, then rotates counter-clockwise in the picture (v grows downwards), then translates. The
   extension's text and its sample viewer do so; the GLSL in that text has its sines swapped. */
static bool read_transform(const struct gltf *gltf, const json_t *info, const struct gltf_place *at,
                           uint64_t *uv_set, struct scene_texture_use *out)
{
    json_t *transform;
    double offset[2] = {0, 0}, scale[2] = {1, 1}, angle = 0;
    if (!gltf_extension(gltf, info, at, "KHR_texture_transform", &transform))
        return false;
    if (!transform)
        return true;
    if (!gltf_numbers(gltf, transform, at, "offset", 2, offset) ||
        !gltf_numbers(gltf, transform, at, "scale", 2, scale) ||
        !gltf_number(gltf, transform, at, "rotation", &angle) ||
        !gltf_whole(gltf, transform, at, "texCoord", UINT32_MAX, uv_set))
        return false;
    double c = same_cos(angle), s = same_sin(angle);
    const double matrix[6] = {c * scale[0],  s * scale[1], offset[0],
                              -s * scale[0], c * scale[1], offset[1]};
    for (int i = 0; i < 6; i++)
        out->transform[i] = (float)matrix[i];
    return true;
}

whit_result gltf_texture_use(struct gltf *gltf, const json_t *in, const struct gltf_place *at,
                             const char *key, bool visible, struct scene_texture_use *out)
{
    struct gltf_place place = gltf_place("%.60s.%.30s", at->text, key), texture_at;
    json_t *info, *texture;
    uint32_t index, image, sampler;
    uint64_t uv_set = 0;
    if (!gltf_object(gltf, in, at, key, &info) ||
        !gltf_index(gltf, info, &place, "index", gltf_count(gltf, "textures"), &index))
        return WHIT_ERROR_INPUT;
    if (index == SCENE_NONE)
        return WHIT_OK;
    if (!gltf_whole(gltf, info, &place, "texCoord", UINT32_MAX, &uv_set) ||
        !read_transform(gltf, info, &place, &uv_set, out) ||
        !gltf_item(gltf, "textures", index, &texture_at, &texture) ||
        !gltf_index(gltf, texture, &texture_at, "source", gltf->image_count, &image) ||
        !gltf_index(gltf, texture, &texture_at, "sampler", gltf_count(gltf, "samplers"),
                    &sampler) ||
        !read_sampler(gltf, sampler, out))
        return WHIT_ERROR_INPUT;
    if (image == SCENE_NONE || uv_set > 1) {
        if (gltf->only_names)
            return WHIT_OK;
        scene_note(gltf->scene, SCENE_NOTE_WARNING, "%s: %s: %s, it is left out",
                   path_name(gltf->request->path), place.text,
                   image == SCENE_NONE ? "the texture has no picture that whit can read"
                                       : "only two sets of texture coordinates are read");
        return WHIT_OK;
    }
    out->uv_set = (uint32_t)uv_set;
    if (gltf->textures[image] == SCENE_NONE) {
        whit_result result = load_image(gltf, image, visible, &gltf->textures[image]);
        if (result != WHIT_OK)
            return result;
        if (gltf->only_names)
            gltf->textures[image] = 0;
    }
    out->texture = gltf->textures[image];
    return WHIT_OK;
}
