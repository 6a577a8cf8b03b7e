#include "shader/reach.h"

#include <string.h>

#define HAS(name) SHADER_REACHES_##name

/* Kernels compute from these values how much light a material lets through, for shadow rays too. */
#define FILTERS   (HAS(TEXTURES) | HAS(VERTEX_COLORS) | HAS(METAL_ROUGH))

/* Functions of hook/interface.glsl, by the start of their names as glslang writes them, and what
   they need in the kernel. */
static const struct {
    const char *name;
    uint32_t bits;
} needs[] = {
    {"light(", HAS(LIGHTS) | HAS(NORMALS)},
    {"light_points(", HAS(LIGHTS)},
    {"lit_by(", HAS(ALL)},
    {"whit_shade(", HAS(ALL)},
    {"whit_scatter(", FILTERS | HAS(SHARES) | HAS(NORMALS)},
    {"visible(", HAS(SHADOWS) | HAS(RAYS) | FILTERS},
    {"trace(", HAS(RAYS)},
};

static const char *const records[REACH_RECORDS] = {"Surface", "Optics"};

/* Members, and what surface_optics() of bind/optics.glsl and fetch_surface() of bind/surface.glsl
   compute them from. */
static const struct {
    uint32_t record; /* index in `records` */
    const char *name;
    uint32_t bits;
} members[] = {
    {0, "ns", HAS(NORMALS)},
    {0, "e1", HAS(NORMALS) | HAS(TEXTURES)},
    {0, "e2", HAS(NORMALS) | HAS(TEXTURES)},
    {0, "footprint", HAS(NORMALS) | HAS(TEXTURES)},
    {0, "color", HAS(VERTEX_COLORS)},
    {0, "color_alpha", HAS(VERTEX_COLORS)},
    {1, "diffuse", HAS(TEXTURES) | HAS(VERTEX_COLORS) | HAS(METAL_ROUGH)},
    {1, "ambient", HAS(TEXTURES) | HAS(VERTEX_COLORS) | HAS(METAL_ROUGH)},
    {1, "highlight", HAS(TEXTURES) | HAS(VERTEX_COLORS) | HAS(METAL_ROUGH)},
    {1, "emission", HAS(TEXTURES) | HAS(EMISSION)},
    {1, "reflected",
     HAS(SHARES) | HAS(TEXTURES) | HAS(VERTEX_COLORS) | HAS(METAL_ROUGH) | HAS(NORMALS)},
    {1, "refracted",
     HAS(SHARES) | HAS(TEXTURES) | HAS(VERTEX_COLORS) | HAS(METAL_ROUGH) | HAS(NORMALS)},
    {1, "straight", HAS(TEXTURES) | HAS(VERTEX_COLORS)},
    {1, "shininess", HAS(TEXTURES) | HAS(METAL_ROUGH) | HAS(HIGHLIGHTS)},
    {1, "alpha", HAS(TEXTURES) | HAS(METAL_ROUGH) | HAS(HIGHLIGHTS)},
    {1, "metal_rough", HAS(METAL_ROUGH)},
};

static uint32_t bits_of_call(const char *name)
{
    uint32_t bits = 0;
    for (size_t i = 0; i < sizeof needs / sizeof *needs; ++i)
        bits |= strncmp(name, needs[i].name, strlen(needs[i].name)) == 0 ? needs[i].bits : 0;
    return bits;
}

bool reach_traces(const char *name)
{
    return bits_of_call(name) & HAS(RAYS);
}

static void name_member(struct reach *reach, const uint32_t *words)
{
    for (uint32_t i = 0; i < REACH_RECORDS; ++i) {
        for (size_t k = 0; k < sizeof members / sizeof *members; ++k) {
            if (reach->records[i].type == words[1] && members[k].record == i &&
                words[2] < REACH_MEMBERS_MAX &&
                strcmp((const char *)(words + 3), members[k].name) == 0)
                reach->records[i].members[words[2]] = members[k].bits;
        }
    }
}

void reach_begin(struct reach *reach, const struct spv_module *m)
{
    memset(reach, 0, sizeof *reach);
    for (const uint32_t *words = spv_step(m, NULL), *def; words; words = spv_step(m, words)) {
        if (spv_op(words) == OP_MEMBER_NAME && spv_length(words) > 3)
            name_member(reach, words);
        if (spv_op(words) != OP_NAME || spv_length(words) < 3)
            continue;
        def = spv_def(m, words[1]);
        for (uint32_t i = 0; def && spv_op(def) == OP_TYPE_STRUCT && i < REACH_RECORDS; ++i) {
            if (strcmp((const char *)(words + 2), records[i]) == 0)
                reach->records[i].type = words[1];
        }
    }
}

/* Gives the bits of member `index` of the struct or array *type, and sets *type to the type of the
   member, 0 if there is none. */
static uint32_t bits_of_part(const struct reach *reach, const struct spv_module *m, uint32_t *type,
                             uint32_t index)
{
    uint32_t bits = 0, op;
    const uint32_t *def = spv_def(m, *type);
    for (uint32_t i = 0; i < REACH_RECORDS; ++i) {
        if (reach->records[i].type == *type && index < REACH_MEMBERS_MAX)
            bits = reach->records[i].members[index];
    }
    op = def ? spv_op(def) : OP_TYPE_VOID;
    *type = 0;
    if (op == OP_TYPE_STRUCT && index < spv_length(def) - 2)
        *type = def[2 + index];
    else if (op == OP_TYPE_ARRAY || op == OP_TYPE_RUNTIME_ARRAY)
        *type = def[2];
    return bits;
}

static uint32_t pointed_type(const struct spv_module *m, uint32_t pointer)
{
    const uint32_t *def = spv_def(m, spv_type_of(m, pointer));
    return def && spv_op(def) == OP_TYPE_POINTER ? def[3] : 0;
}

uint32_t reach_of(const struct reach *reach, const struct spv_module *m, const uint32_t *words)
{
    uint32_t bits = 0, op = spv_op(words), length = spv_length(words), type, index;
    if (op == OP_FUNCTION_CALL)
        return bits_of_call(spv_name(m, words[3]));
    if (op == OP_ACCESS_CHAIN || op == OP_IN_BOUNDS_ACCESS_CHAIN) {
        type = pointed_type(m, words[3]);
        for (uint32_t i = 4; type && i < length; ++i) {
            index = UINT32_MAX;
            spv_constant_value(m, words[i], &index);
            bits |= bits_of_part(reach, m, &type, index);
        }
    } else if (op == OP_COMPOSITE_EXTRACT) {
        type = spv_type_of(m, words[3]);
        for (uint32_t i = 4; type && i < length; ++i)
            bits |= bits_of_part(reach, m, &type, words[i]);
    }
    return bits;
}
