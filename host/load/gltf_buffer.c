#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/file.h"
#include "base/text.h"
#include "load/gltf_buffer.h"
#include "load/gltf_json.h"
#include "scene/afford.h"

#define BUFFER_LIMIT (UINT64_C(4) << 30)

/* --- URIs ----------------------------------------------------------------------------------- */

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9')
        return c - '0';
    c |= 0x20;
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

char *gltf_uri_name(const char *uri)
{
    char *decoded = string_copy(uri), *to = decoded;
    for (const char *at = uri; decoded && *at; at++) {
        int high = at[0] == '%' ? hex_digit(at[1]) : -1;
        int low = high >= 0 ? hex_digit(at[2]) : -1;
        int byte = low >= 0 ? high * 16 + low : 0;
        bool escape = byte >= ' ' && byte != 0x7f && !strchr("./\\", byte);
        *to++ = escape ? (char)byte : *at;
        at += escape ? 2 : 0;
    }
    if (decoded)
        *to = 0;
    return decoded;
}

static int base64_digit(char c)
{
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

whit_result gltf_decode_uri(const char *uri, uint8_t **data, size_t *size_bytes)
{
    const char *text = strstr(uri, ";base64,");
    if (strncmp(uri, "data:", 5) != 0 || !text)
        return WHIT_ERROR_INPUT;
    text += 8;
    size_t length = strlen(text), used = 0;
    uint8_t *out = array_alloc(length / 4 * 3 + 3, 1);
    uint32_t bits = 0, count = 0;
    for (; out && *text && *text != '='; text++) {
        int high = *text == '%' ? hex_digit(text[1]) : -1;
        int low = high >= 0 ? hex_digit(text[2]) : -1;
        char letter = low >= 0 ? (char)(high * 16 + low) : *text;
        text += low >= 0 ? 2 : 0;
        if (letter == '=')
            break;
        int digit = base64_digit(letter);
        if (digit < 0) {
            free(out);
            return WHIT_ERROR_INPUT;
        }
        bits = bits << 6 | (uint32_t)digit;
        if (++count % 4 == 0) {
            out[used++] = (uint8_t)(bits >> 16);
            out[used++] = (uint8_t)(bits >> 8);
            out[used++] = (uint8_t)bits;
        }
    }
    if (out && count % 4 >= 2)
        out[used++] = (uint8_t)(count % 4 == 2 ? bits >> 4 : bits >> 10);
    if (out && count % 4 == 3)
        out[used++] = (uint8_t)(bits >> 2);
    *data = out;
    *size_bytes = used;
    return out ? WHIT_OK : WHIT_ERROR_MEMORY;
}

/* --- buffers -------------------------------------------------------------------------------- */

static whit_result read_external(struct gltf *gltf, const struct gltf_place *at, const char *uri,
                                 struct gltf_bytes *out)
{
    char *name = gltf_uri_name(uri);
    char *path = name ? roots_join(gltf->request->path, name) : NULL;
    free(name);
    if (!path)
        return WHIT_ERROR_MEMORY;
    const char *why_not = roots_why_not(&gltf->scene->roots, path);
    if (why_not) {
        gltf_fail(gltf, at, "its file `%s`: %s", text_token(uri).text, why_not);
        free(path);
        return WHIT_ERROR_INPUT;
    }
    whit_result result = file_read(&gltf->scene->log, &gltf->scene->roots, path, BUFFER_LIMIT,
                                   &out->owned, &out->size_bytes);
    out->data = out->owned;
    /* Counted each time that a file is named, since each time it is read anew. */
    if (result == WHIT_OK && !scene_afford(gltf->scene, out->size_bytes, "%s: buffer `%s`",
                                           gltf->request->path, text_token(uri).text))
        result = WHIT_ERROR_INPUT;
    if (result == WHIT_OK) {
        gltf->scene->file_bytes += out->size_bytes;
        gltf->counted_bytes += out->size_bytes;
    }
    free(path);
    return result;
}

static whit_result load_buffer(struct gltf *gltf, uint32_t index, struct gltf_bytes *out)
{
    struct gltf_place at;
    json_t *buffer;
    const char *uri;
    uint64_t size = 0;
    if (!gltf_item(gltf, "buffers", index, &at, &buffer) ||
        !gltf_string(gltf, buffer, &at, "uri", &uri) ||
        !gltf_whole(gltf, buffer, &at, "byteLength", BUFFER_LIMIT, &size))
        return WHIT_ERROR_INPUT;
    whit_result result = WHIT_OK;
    if (!uri && index == 0)
        *out = gltf->chunk;
    else if (uri && strncmp(uri, "data:", 5) == 0) {
        result = gltf_decode_uri(uri, &out->owned, &out->size_bytes);
        if (result == WHIT_ERROR_INPUT)
            gltf_fail(gltf, &at, "its data: URI cannot be read");
        out->data = out->owned;
    } else if (uri) {
        result = read_external(gltf, &at, uri, out);
    }
    if (result == WHIT_OK && out->data && out->size_bytes < size) {
        gltf_fail(gltf, &at, "has %zu bytes, its byteLength says %llu", out->size_bytes,
                  (unsigned long long)size);
        return WHIT_ERROR_INPUT;
    }
    if (out->data)
        out->size_bytes = (size_t)size;
    return result;
}

whit_result gltf_load_buffers(struct gltf *gltf)
{
    uint32_t count = gltf_count(gltf, "buffers");
    gltf->buffers = array_alloc_zeroed(count, sizeof *gltf->buffers);
    if (!gltf->buffers)
        return WHIT_ERROR_MEMORY;
    gltf->buffer_count = count;
    for (uint32_t i = 0; i < count; i++) {
        whit_result result = load_buffer(gltf, i, &gltf->buffers[i]);
        if (result != WHIT_OK)
            return result;
    }
    return WHIT_OK;
}

bool gltf_view(const struct gltf *gltf, uint32_t view, const uint8_t **data, size_t *size_bytes,
               uint32_t *stride)
{
    struct gltf_place at;
    json_t *object;
    uint32_t index;
    uint64_t offset = 0, size = 0, step = 0;
    if (!gltf_item(gltf, "bufferViews", view, &at, &object) ||
        !gltf_index(gltf, object, &at, "buffer", gltf->buffer_count, &index) ||
        !gltf_whole(gltf, object, &at, "byteOffset", BUFFER_LIMIT, &offset) ||
        !gltf_whole(gltf, object, &at, "byteLength", BUFFER_LIMIT, &size) ||
        !gltf_whole(gltf, object, &at, "byteStride", 252, &step))
        return false;
    if (index == SCENE_NONE || !gltf->buffers[index].data)
        return gltf_fail(gltf, &at, "its buffer has no data");
    const struct gltf_bytes *buffer = &gltf->buffers[index];
    if (offset > buffer->size_bytes || size > buffer->size_bytes - offset)
        return gltf_fail(gltf, &at, "runs past the end of buffers[%u]", index);
    *data = buffer->data + offset;
    *size_bytes = (size_t)size;
    if (stride)
        *stride = (uint32_t)step;
    return true;
}
