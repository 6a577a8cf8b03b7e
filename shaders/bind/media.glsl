// The media that a ray has entered and not left, by priority (after Schmidt and Budge 2002, "Simple
// Nested Dielectrics in Ray Traced Images"). Where several overlap, the one with the highest
// priority counts, of equal ones the one entered last. So the list is kept in this order, and its
// last entry is the medium that the ray is in.
#ifndef BIND_MEDIA_GLSL
#define BIND_MEDIA_GLSL

#include "shading.glsl"

// Numbers of the entries in the low and in the high halves of the four words.
const uvec4 MEDIA_EVEN = uvec4(0u, 2u, 4u, 6u);
const uvec4 MEDIA_ODD = uvec4(1u, 3u, 5u, 7u);

// Entry `at`; 0 behind the last entry.
uint media_entry(uvec4 media, uint at)
{
    uvec2 pair = at < 4u ? media.xy : media.zw;
    uint word = (at & 2u) == 0u ? pair.x : pair.y;
    return (at & 1u) == 0u ? word & 0xffffu : word >> 16;
}

uint media_count(uvec4 media)
{
    uvec4 even = min(media & 0xffffu, uvec4(1u)), odd = min(media >> 16, uvec4(1u));
    uvec4 both = even + odd;
    return both.x + both.y + both.z + both.w;
}

// The medium that the ray is in: material + 1; 0: air.
uint media_top(uvec4 media)
{
    uint count = media_count(media);
    return count == 0u ? 0u : media_entry(media, count - 1u);
}

uint medium_priority(uint entry)
{
    uint flags = fetch_shading_row((entry - 1u) * MATERIAL_ROWS + 3u).w;
    return (flags >> MATERIAL_PRIORITY_SHIFT) & 255u;
}

// Index of refraction of a medium; 1 for air.
float medium_ior(uint entry)
{
    if (entry == 0u)
        return 1.0;
    return uintBitsToFloat(fetch_shading_row((entry - 1u) * MATERIAL_ROWS + 2u).w);
}

uvec4 pack_media(uvec4 even, uvec4 odd)
{
    return even | odd << 16;
}

// Adds `entry` behind all entries of the same or a lower priority.
uvec4 media_with(uvec4 media, uint entry, inout uint status)
{
    uint count = media_count(media);
    if (count == MEDIA_MAX)
        status |= STATUS_MEDIUM_STACK_OVERFLOW;
    uint priority = medium_priority(entry);
    uint at = count;
    bool higher = false;
    do {
        higher = false;
        if (at > 0u && SPEC_PRIORITIES != 0u)
            higher = medium_priority(media_entry(media, at - 1u)) > priority;
        at -= uint(higher);
    } while (SPEC_PRIORITIES != 0u && higher);
    uvec4 even = media & 0xffffu, odd = media >> 16;
    uvec4 even_moved = uvec4(0u, odd.xyz), odd_moved = even;
    even_moved = mix(even_moved, uvec4(entry), equal(MEDIA_EVEN, uvec4(at)));
    odd_moved = mix(odd_moved, uvec4(entry), equal(MEDIA_ODD, uvec4(at)));
    return pack_media(mix(even_moved, even, lessThan(MEDIA_EVEN, uvec4(at))),
                      mix(odd_moved, odd, lessThan(MEDIA_ODD, uvec4(at))));
}

bool media_have(uvec4 media, uint entry)
{
    return any(equal(media & 0xffffu, uvec4(entry))) || any(equal(media >> 16, uvec4(entry)));
}

// Removes the last occurrence of `entry`, which must be there.
uvec4 media_without(uvec4 media, uint entry)
{
    uvec4 even = media & 0xffffu, odd = media >> 16;
    uvec4 places = max(mix(uvec4(0u), MEDIA_EVEN, equal(even, uvec4(entry))),
                       mix(uvec4(0u), MEDIA_ODD, equal(odd, uvec4(entry))));
    uint at = max(max(places.x, places.y), max(places.z, places.w));
    uvec4 even_moved = odd, odd_moved = uvec4(even.yzw, 0u);
    return pack_media(mix(even_moved, even, lessThan(MEDIA_EVEN, uvec4(at))),
                      mix(odd_moved, odd, lessThan(MEDIA_ODD, uvec4(at))));
}

// Whether the surface of a material bounds a medium. A texture may still let no light through.
bool bounds_medium(gpu_material m)
{
    return SPEC_MEDIA != 0u && (m.flags & MATERIAL_THIN) == 0u && m.model != MATERIAL_MODEL_UNLIT &&
           max(m.transmission.r, max(m.transmission.g, m.transmission.b)) > 0.0;
}

// Beer's law along `t` world units of the medium that a ray is in.
vec3 medium_transmittance(uvec4 media, float t)
{
    if (SPEC_ABSORPTION == 0u || SPEC_MEDIA == 0u)
        return vec3(1.0);
    uint medium = media_top(media);
    if (medium == 0u)
        return vec3(1.0);
    vec3 depth = fetch_material(medium - 1u).absorption * t;
    return exp(-clamp(depth, vec3(0.0), vec3(100.0)));
}

#endif
