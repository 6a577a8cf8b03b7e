// Lit hits: what the shadow kernel needs of a hit's surface to add the light that reaches it.
#ifndef BIND_LIT_GLSL
#define BIND_LIT_GLSL

#include "light.glsl"
#include "queues.glsl"

layout(set = 0, binding = BIND_LIT_ROWS, std430) buffer LitRowBuffer { uvec4 lit_rows[]; };
layout(set = 0, binding = BIND_LIT_ROWS, std430) buffer WideLitBuffer { u64vec4 wide_lits[]; };
layout(set = 0, binding = BIND_LIT_LIST, std430) buffer LitListBuffer { uint lit_list[]; };
layout(set = 0, binding = BIND_LIT_LIST_TEXELS) uniform usamplerBuffer lit_list_texels;
layout(set = 0, binding = BIND_LIT_TEXELS) uniform usamplerBuffer lit_texels;

const uint LIT_LIFTED = 1u, LIT_METAL_ROUGH = 2u, LIT_CATCHER = 4u;
const uint LIT_FLAGS_SHIFT = 29u, LIT_ID_MASK = (1u << 29) - 1u;

struct Lit {
    vec3 p, origin; // point on the surface; where shadow rays start
    float error;    // bound of the error of p on each axis; with flat emitters
    vec3 ns, ng;    // on the side that receives light
    vec3 view;      // to where the ray came from
    vec3 diffuse, highlight; // weighted by the ray's weight
    float gloss;    // alpha of GGX, or shininess
    vec3 absorption; // of the media around
    uint flags;     // LIT_*
    uint id, skip_instance, skip_primitive;
    uint record; // of the primitive, see RECORD_SKIPS_ALL; set only for store_lit: fetch_lit gives
                 // skip_instance and skip_primitive
};

uvec4 fetch_lit_row(uint row)
{
    if (SPEC_LOAD_PATH == LOAD_TEXEL)
        return texelFetch(lit_texels, int(row));
    return lit_rows[row];
}

// Whether each light takes its hits from a list of its own; else all take them from the first one.
bool lights_have_lists()
{
    return SPEC_LIGHTS_EACH == 1u && frame.light_count <= LIGHT_LISTS;
}

uint fetch_listed_lit(uint item)
{
    uint at = (chunk.list - LIST_LIGHTS) * chunk.lit_capacity + item;
    return SPEC_LOAD_PATH == LOAD_TEXEL ? word_of_row(texelFetch(lit_list_texels, int(at >> 2)), at)
                                        : lit_list[at];
}

bool lit_has(uint part)
{
    return (SPEC_LIT_PARTS & part) != 0u;
}

// Places of the optional rows of a lit hit, behind the four that each has: the triangle's normal,
// the highlight, the absorption.
uint lit_highlight_row()
{
    return 4u + uint(lit_has(LIT_HAS_NG));
}

uint lit_absorption_row()
{
    return lit_highlight_row() + uint(lit_has(LIT_HAS_HIGHLIGHT));
}

// The number of rows of a lit hit, rounded up to an even number.
uint lit_rows_each()
{
    return (lit_absorption_row() + uint(lit_has(LIT_HAS_ABSORPTION)) + 1u) & ~1u;
}

Lit fetch_lit(uint index)
{
    uint row = index * lit_rows_each();
    uvec4 r0 = fetch_lit_row(row), r1 = fetch_lit_row(row + 1u);
    uvec4 r2 = fetch_lit_row(row + 2u), r3 = fetch_lit_row(row + 3u);
    Lit lit;
    lit.p = row_vec3(r0);
    lit.id = r0.w & LIT_ID_MASK;
    lit.flags = r0.w >> LIT_FLAGS_SHIFT;
    lit.origin = row_vec3(r1);
    lit.gloss = uintBitsToFloat(r1.w);
    lit.ns = row_vec3(r2);
    lit.error = uintBitsToFloat(r2.w);
    lit.diffuse = row_vec3(r3);
    lit.ng = lit_has(LIT_HAS_NG) ? row_vec3(fetch_lit_row(row + 4u)) : lit.ns;
    lit.highlight = vec3(0.0);
    lit.view = vec3(0.0);
    if (lit_has(LIT_HAS_HIGHLIGHT)) {
        uint slot;
        lit.highlight = row_vec3(fetch_lit_row(row + lit_highlight_row()));
        lit.view = -fetch_ray(lit.id, slot).dir;
    }
    lit.absorption = vec3(0.0);
    if (lit_has(LIT_HAS_ABSORPTION))
        lit.absorption = row_vec3(fetch_lit_row(row + lit_absorption_row()));
    uvec2 own = fetch_hit_ids(lit.id, r3.w);
    lit.skip_instance = own.x;
    lit.skip_primitive = own.y;
    return lit;
}

void store_lit_rows(uint row, uvec4 a, uvec4 b)
{
    if (SPEC_WIDE_ROWS != 0u) {
        wide_lits[row / 2u] = wide_rows(a, b);
    } else {
        lit_rows[row] = a;
        lit_rows[row + 1u] = b;
    }
}

void store_lit(uint index, Lit lit)
{
    uint row = index * lit_rows_each();
    uvec4 ng = uvec4(floatBitsToUint(lit.ng), 0u), highlight = uvec4(floatBitsToUint(lit.highlight), 0u);
    uvec4 absorption = uvec4(floatBitsToUint(lit.absorption), 0u);
    store_lit_rows(row, uvec4(floatBitsToUint(lit.p), lit.id | lit.flags << LIT_FLAGS_SHIFT),
                   floatBitsToUint(vec4(lit.origin, lit.gloss)));
    store_lit_rows(row + 2u, floatBitsToUint(vec4(lit.ns, lit.error)),
                   uvec4(floatBitsToUint(lit.diffuse), lit.record));
    // The optional rows that this kernel uses, without gaps.
    uvec4 fourth = lit_has(LIT_HAS_NG) ? ng : lit_has(LIT_HAS_HIGHLIGHT) ? highlight : absorption;
    uvec4 fifth = lit_has(LIT_HAS_NG) && lit_has(LIT_HAS_HIGHLIGHT) ? highlight : absorption;
    if (SPEC_LIT_PARTS != 0u)
        store_lit_rows(row + 4u, fourth, fifth);
    if (lit_absorption_row() == 6u && lit_has(LIT_HAS_ABSORPTION))
        store_lit_rows(row + 6u, absorption, uvec4(0u));
}

// Which lights with lists of their own may reach the lit hit: bit i for light i.
uint reaching_lights(Lit lit)
{
    uint reaching = 0u, i = 0u;
    do {
        gpu_light light = fetch_light(i);
        LightSample at;
        bool arrives = light_at(light, 0u, lit.p, at) && dot(at.to_light, lit.ns) > 0.0 &&
                       (dot(at.to_light, lit.ng) > 0.0 || (lit.flags & LIT_LIFTED) != 0u);
        reaching |= uint(arrives || is_flat(light)) << i;
        i++;
    } while (i < min(frame.light_count, LIGHT_LISTS));
    return reaching;
}

// Stores a lit hit, and appends it to the list of each of `lights` (bit i: light i) that may reach it.
void list_lit(bool wanted, uint lights, Lit lit, inout uint status)
{
    uint g = chunk.generation, lists = lights_have_lists() ? frame.light_count : 1u, i = 0u;
    uint reaching = lights_have_lists() ? reaching_lights(lit) & lights : 1u;
    wanted = wanted && reaching != 0u;
    uint index = append_items(g, LIST_LIT, uint(wanted), SPEC_LIST_GROUP);
    uint room = SPEC_SEGMENTS == 2u ? chunk.lit_capacity / 2u : chunk.lit_capacity;
    if (wanted && index >= room)
        status |= STATUS_QUEUE_FULL;
    wanted = wanted && index < room;
    index = item_place(index, chunk.lit_capacity);
    if (wanted)
        store_lit(index, lit);
    uint each = SPEC_LIST_GROUP * (is_primary() ? SPEC_LIT_RAYS : 1u);
    do {
        bool own = wanted && (reaching >> i & 1u) != 0u;
        uint at = append_items(g, LIST_LIGHTS + i, uint(own), each);
        if (own)
            lit_list[i * chunk.lit_capacity + item_place(at, chunk.lit_capacity)] = index;
        i++;
    } while (i < lists);
}

#endif
