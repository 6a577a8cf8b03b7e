#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/vec.h"
#include "load/gltf_accessor.h"
#include "load/gltf_buffer.h"
#include "load/gltf_json.h"
#include "scene/afford.h"

#define OFFSET_LIMIT (UINT64_C(1) << 40)

/* A type of components. */
struct component {
    uint32_t code, bytes;
    bool is_signed;
    float largest; /* that is 1 in normalized elements; 0: they are not normalized */
};

/* All zero for an unknown code. */
static struct component component_of(uint32_t code)
{
    static const struct component all[] = {
        {5120, 1, true, 127.0f},   {GLTF_UNSIGNED_BYTE, 1, false, 255.0f},
        {5122, 2, true, 32767.0f}, {GLTF_UNSIGNED_SHORT, 2, false, 65535.0f},
        {5125, 4, false, 0.0f},    {GLTF_FLOAT, 4, true, 0.0f}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        if (all[i].code == code)
            return all[i];
    return (struct component){0};
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
    json_t *object, *sparse;
    const char *type;
    uint64_t component = 0, count = 0;
    *out = (struct gltf_accessor){.view = SCENE_NONE, .index = index};
    if (!gltf_item(gltf, "accessors", index, &at, &object) ||
        !gltf_string(gltf, object, &at, "type", &type) ||
        !gltf_whole(gltf, object, &at, "componentType", 65535, &component) ||
        !gltf_whole(gltf, object, &at, "count", UINT32_MAX - 1, &count) ||
        !gltf_whole(gltf, object, &at, "byteOffset", OFFSET_LIMIT, &out->offset) ||
        !gltf_bool(gltf, object, &at, "normalized", &out->normalized) ||
        !gltf_object(gltf, object, &at, "sparse", &sparse) ||
        !gltf_index(gltf, object, &at, "bufferView", gltf_count(gltf, "bufferViews"), &out->view))
        return false;
    out->component = (uint32_t)component;
    out->components = components_of(type);
    out->count = (uint32_t)count;
    out->sparse = sparse;
    if (!component_of(out->component).bytes || !out->components)
        return gltf_fail(gltf, &at, "its componentType or type is unknown");
    return count > 0 || gltf_fail(gltf, &at, "is empty");
}

bool gltf_is_whole(const struct gltf_accessor *accessor)
{
    struct component component = component_of(accessor->component);
    return component.bytes && !component.is_signed;
}

/* --- elements ------------------------------------------------------------------------------- */

/* Elements in a buffer view, which lie `stride` bytes apart. */
struct elements {
    const uint8_t *data;
    size_t stride;
};

/* Finds `accessor`'s elements; fails where they do not all lie within its view. */
static bool find_elements(const struct gltf *gltf, const struct gltf_place *at,
                          const struct gltf_accessor *accessor, struct elements *out)
{
    size_t size, element = (size_t)component_of(accessor->component).bytes * accessor->components;
    uint32_t step;
    if (!gltf_view(gltf, accessor->view, &out->data, &size, &step))
        return false;
    out->stride = step ? step : element;
    uint64_t needed = (uint64_t)(accessor->count - 1) * out->stride + element;
    if (out->stride < element || accessor->offset > size || needed > size - accessor->offset)
        return gltf_fail(gltf, at, "runs past the end of bufferViews[%u]", accessor->view);
    out->data += accessor->offset;
    return true;
}

static uint32_t whole_value(const uint8_t *at, uint32_t bytes)
{
    uint32_t value = 0;
    memcpy(&value, at, bytes); /* little-endian, as the host is */
    return value;
}

static float component_value(const uint8_t *at, const struct component *type, bool normalized)
{
    uint32_t whole = whole_value(at, type->bytes), sign = 1u << (8 * type->bytes - 1);
    if (type->code == GLTF_FLOAT)
        return float_of_bits(whole);
    bool negative = type->is_signed && (whole & sign);
    float value = negative ? (float)((int64_t)whole - 2 * (int64_t)sign) : (float)whole;
    return normalized && type->largest > 0 ? fmaxf(value / type->largest, -1.0f) : value;
}

/* Output rows of `width` words. Where an element has fewer components, as a colour without alpha,
   the rest of its row is 1. */
struct rows {
    float *floats; /* NULL: store integers in `whole` instead */
    uint32_t *whole;
    uint32_t width;
};

static void store(const struct gltf_accessor *accessor, const struct component *type,
                  const uint8_t *from, size_t row, const struct rows *to)
{
    size_t first = row * to->width;
    for (uint32_t k = 0; to->whole && k < accessor->components; k++)
        to->whole[first + k] = whole_value(from + (size_t)k * type->bytes, type->bytes);
    for (uint32_t k = 0; to->floats && k < accessor->components; k++)
        to->floats[first + k] =
            component_value(from + (size_t)k * type->bytes, type, accessor->normalized);
}

/* Overwrites elements by those of the sparse accessor, which has indices and values. */
static bool store_sparse(const struct gltf *gltf, const struct gltf_accessor *accessor,
                         const struct rows *to)
{
    struct gltf_place at = gltf_place("accessors[%u].sparse", accessor->index);
    struct gltf_accessor numbers = {.components = 1}, values = *accessor;
    struct elements from_numbers, from_values;
    uint32_t views = gltf_count(gltf, "bufferViews");
    uint64_t count = 0, component = 0;
    json_t *indices, *replaced;
    values.offset = 0;
    if (!gltf_whole(gltf, accessor->sparse, &at, "count", accessor->count, &count) ||
        !gltf_object(gltf, accessor->sparse, &at, "indices", &indices) ||
        !gltf_object(gltf, accessor->sparse, &at, "values", &replaced) ||
        !gltf_whole(gltf, indices, &at, "componentType", 65535, &component) ||
        !gltf_whole(gltf, indices, &at, "byteOffset", OFFSET_LIMIT, &numbers.offset) ||
        !gltf_index(gltf, indices, &at, "bufferView", views, &numbers.view) ||
        !gltf_whole(gltf, replaced, &at, "byteOffset", OFFSET_LIMIT, &values.offset) ||
        !gltf_index(gltf, replaced, &at, "bufferView", views, &values.view))
        return false;
    numbers.component = (uint32_t)component;
    numbers.count = values.count = (uint32_t)count;
    if (count == 0 || numbers.view == SCENE_NONE || values.view == SCENE_NONE ||
        !gltf_is_whole(&numbers))
        return gltf_fail(gltf, &at, "has no indices that are unsigned integers, or no values");
    if (!find_elements(gltf, &at, &numbers, &from_numbers) ||
        !find_elements(gltf, &at, &values, &from_values))
        return false;
    const struct component type = component_of(accessor->component);
    uint32_t number_bytes = component_of(numbers.component).bytes;
    for (size_t i = 0; i < count; i++) {
        uint32_t row = whole_value(from_numbers.data + i * from_numbers.stride, number_bytes);
        if (row >= accessor->count)
            return gltf_fail(gltf, &at, "index %u is out of range, there are %u", row,
                             accessor->count);
        store(accessor, &type, from_values.data + i * from_values.stride, row, to);
    }
    return true;
}

static bool store_all(const struct gltf *gltf, const struct gltf_accessor *accessor,
                      const struct rows *to)
{
    struct gltf_place at = gltf_place("accessors[%u]", accessor->index);
    const struct component type = component_of(accessor->component);
    static const uint8_t zeros[16 * 4];
    struct elements from = {zeros, 0};
    if (accessor->view != SCENE_NONE && !find_elements(gltf, &at, accessor, &from))
        return false;
    for (size_t i = 0; i < accessor->count; i++) {
        for (uint32_t k = accessor->components; k < to->width; k++)
            to->floats[i * to->width + k] = 1.0f;
        store(accessor, &type, from.data + i * from.stride, i, to);
    }
    return !accessor->sparse || store_sparse(gltf, accessor, to);
}

bool gltf_read_rows(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t width,
                    float *out)
{
    return store_all(gltf, accessor, &(struct rows){.floats = out, .width = width});
}

bool gltf_read_whole(const struct gltf *gltf, const struct gltf_accessor *accessor, uint32_t *out)
{
    return store_all(gltf, accessor, &(struct rows){.whole = out, .width = 1});
}

bool gltf_check_elements(const struct gltf *gltf, const struct gltf_accessor *accessor)
{
    struct gltf_place at = gltf_place("accessors[%u]", accessor->index);
    struct elements elements;
    return accessor->view == SCENE_NONE || find_elements(gltf, &at, accessor, &elements);
}

bool gltf_read_floats(const struct gltf *gltf, uint32_t index, uint32_t components, float **out,
                      uint32_t *count)
{
    struct gltf_accessor accessor;
    struct gltf_place at = gltf_place("accessors[%u]", index);
    *out = NULL;
    if (!gltf_accessor(gltf, index, &accessor))
        return false;
    if (accessor.components != components)
        return gltf_fail(gltf, &at, "has %u components where %u are needed", accessor.components,
                         components);
    uint64_t bytes = (uint64_t)accessor.count * components * sizeof **out;
    if (!gltf_check_elements(gltf, &accessor) ||
        !scene_afford(gltf->scene, bytes, "accessors[%u] as floats", index))
        return false;
    scene_give_back(gltf->scene, bytes); /* temporary: what is made from them is counted instead */
    *out = array_alloc(accessor.count, components * sizeof **out);
    if (!*out)
        return gltf_fail(gltf, &at, "out of memory");
    *count = accessor.count;
    return gltf_read_rows(gltf, &accessor, components, *out);
}
