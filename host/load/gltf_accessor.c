#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "load/gltf.h"

static uint32_t component_bytes(uint32_t component)
{
    switch (component) {
    case 5120: /* byte */
    case 5121:
        return 1;
    case 5122: /* short */
    case 5123:
        return 2;
    case 5125: /* unsigned int */
    case GLTF_FLOAT:
        return 4;
    default:
        return 0;
    }
}

static uint32_t components_of(const char *type)
{
    static const struct {
        const char *name;
        uint32_t count;
    } types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                 {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    for (size_t i = 0; type && i < sizeof types / sizeof *types; i++)
        if (strcmp(types[i].name, type) == 0)
            return types[i].count;
    return 0;
}

bool gltf_accessor(const struct gltf *gltf, uint32_t index, struct gltf_accessor *out)
{
    struct gltf_place at;
    json_t *object;
    const char *type;
    uint64_t component = 0, count = 0;
    *out = (struct gltf_accessor){.view = SCENE_NONE};
    if (!gltf_item(gltf, "accessors", index, &at, &object) ||
        !gltf_string(gltf, object, &at, "type", &type) ||
        !gltf_whole(gltf, object, &at, "componentType", 65535, &component) ||
        !gltf_whole(gltf, object, &at, "count", UINT32_MAX - 1, &count) ||
        !gltf_whole(gltf, object, &at, "byteOffset", UINT64_C(1) << 40, &out->offset) ||
        !gltf_bool(gltf, object, &at, "normalized", &out->normalized) ||
        !gltf_index(gltf, object, &at, "bufferView", gltf_count(gltf, "bufferViews"), &out->view))
        return false;
    out->component = (uint32_t)component;
    out->components = components_of(type);
    out->count = (uint32_t)count;
    out->sparse = json_object_get(object, "sparse") != NULL;
    if (!component_bytes(out->component) || !out->components)
        return gltf_fail(gltf, &at, "its componentType or type is unknown");
    return count > 0 || gltf_fail(gltf, &at, "is empty");
}

static float component_value(const uint8_t *at, uint32_t component, bool normalized)
{
    union {
        float f;
        uint32_t u32;
        uint16_t u16;
        int16_t i16;
    } value = {0};
    float scaled;
    memcpy(&value, at, component_bytes(component));
    switch (component) {
    case 5120:
        scaled = (float)(int8_t)at[0] / 127.0f;
        return !normalized ? (float)(int8_t)at[0] : scaled < -1 ? -1.0f : scaled;
    case 5121:
        return normalized ? (float)at[0] / 255.0f : (float)at[0];
    case 5122:
        scaled = (float)value.i16 / 32767.0f;
        return !normalized ? (float)value.i16 : scaled < -1 ? -1.0f : scaled;
    case 5123:
        return normalized ? (float)value.u16 / 65535.0f : (float)value.u16;
    case 5125:
        return (float)value.u32;
    default:
        return value.f;
    }
}

/* Where the elements are, checked against the view; *stride in bytes. */
static bool elements(const struct gltf *gltf, uint32_t index, const struct gltf_accessor *accessor,
                     const uint8_t **data, size_t *stride)
{
    struct gltf_place at = gltf_place("accessors[%u]", index);
    size_t size, element = (size_t)component_bytes(accessor->component) * accessor->components;
    uint32_t step;
    if (accessor->sparse || accessor->view == SCENE_NONE)
        return gltf_fail(gltf, &at, "sparse values are not supported here");
    if (!gltf_view(gltf, accessor->view, data, &size, &step))
        return false;
    *stride = step ? step : element;
    uint64_t needed = (uint64_t)(accessor->count - 1) * *stride + element;
    if (*stride < element || accessor->offset > size || needed > size - accessor->offset)
        return gltf_fail(gltf, &at, "runs past the end of bufferViews[%u]", accessor->view);
    *data += accessor->offset;
    return true;
}

bool gltf_read_floats(const struct gltf *gltf, uint32_t index, uint32_t components, float **out,
                      uint32_t *count)
{
    struct gltf_accessor accessor;
    const uint8_t *data;
    size_t stride = 0;
    struct gltf_place at = gltf_place("accessors[%u]", index);
    *out = NULL;
    if (!gltf_accessor(gltf, index, &accessor))
        return false;
    if (components && accessor.components != components)
        return gltf_fail(gltf, &at, "has %u components where %u are needed", accessor.components,
                         components);
    if (!elements(gltf, index, &accessor, &data, &stride))
        return false;
    uint32_t bytes = component_bytes(accessor.component);
    *out = array_alloc(accessor.count, accessor.components * sizeof **out);
    if (!*out)
        return gltf_fail(gltf, &at, "out of memory");
    for (size_t i = 0; i < accessor.count; i++)
        for (size_t k = 0; k < accessor.components; k++)
            (*out)[i * accessor.components + k] = component_value(
                data + i * stride + k * bytes, accessor.component, accessor.normalized);
    *count = accessor.count;
    return true;
}
