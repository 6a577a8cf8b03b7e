// Box tests with nodes of 16 bytes (struct gpu_quantized_node), for rays one by one in a tree without
// instances. A ray is turned into steps of the grid, and its t into a distance along the axis on
// which it goes farthest. Boxes are widened by more than all roundings, so that a ray meets all
// primitives that it meets by nodes of 32 bytes, and has the same hits (docs/numerics-method.md).
#ifndef BIND_QUANTIZED_GLSL
#define BIND_QUANTIZED_GLSL

#include "../lib/exact.glsl"
#include "trees.glsl"

// The margin of boxes, relative to the distance of the ray's origin and the size of the grid: twice
// what the roundings here, the test of a primitive's own box and its SLAB_FAR_SCALE add up to.
const float QUANTIZED_MARGIN = 1.0 / 524288.0;
// The largest reciprocal of a direction whose largest component is 1. In place of infinity it keeps
// NaN away: a ray that runs along a box's side is inside by the margin, and would leave it only
// behind the grid.
const float QUANTIZED_INVERSE_MAX = 16777216.0; // 2^24

const float QUANTIZED_MARGIN_MAX = 1.2676506002282294e+30; // 2^100
const float FLOAT_NORMAL_MIN = 1.1754943508222875e-38;     // 2^-126

// The ray in steps of the grid. `first`, `last`: its origin, moved away by the margin from the sides of
// boxes that it reaches first, and from those that it reaches last.
struct QuantizedRay {
    vec3 first, last, inverse;
    float unit, scale; // largest component of the direction; steps a unit of length
    float start;       // t that distances count from
    int from, end;     // bits of the distances between which boxes count
};
QuantizedRay quantized_ray;

float quantized_distance(float t)
{
    return (t - quantized_ray.start) * quantized_ray.unit * quantized_ray.scale;
}

// A ray that starts behind its origin is moved to there, so that no distance is below 0, and their
// bits are in their order. But it is moved no farther than behind the grid, as the margin grows with
// that.
void make_quantized_ray(RaySetup ray, float t_min)
{
    uvec4 head = texelFetch(quantized_texels, 0);
    quantized_ray.unit = largest_magnitude(ray.dir);
    quantized_ray.scale = uintBitsToFloat(head.w);
    vec3 origin = (ray.origin - row_vec3(head)) * quantized_ray.scale;
    float reach = largest_magnitude(origin) + float(QUANTIZED_STEPS);
    // Two quotients: a product of unit and scale may be infinite.
    float behind = max(-2.0 * reach / quantized_ray.scale / quantized_ray.unit, -FLOAT_LARGEST);
    quantized_ray.start = max(min(t_min, 0.0), behind);
    quantized_ray.from = floatBitsToInt(quantized_distance(t_min));
    vec3 moved = (ray.dir * quantized_ray.start) * quantized_ray.scale;
    float margin = (reach + largest_magnitude(moved)) * QUANTIZED_MARGIN;
    // A ray enters all boxes where t rounds by more than the margin: if it starts near the end of the
    // range of floats, if the grid lies beyond the least t, or if denormal t are enough to cross it.
    float denormal = FLOAT_NORMAL_MIN * quantized_ray.unit * quantized_ray.scale;
    bool fits = margin < QUANTIZED_MARGIN_MAX && quantized_ray.start > -FLOAT_LARGEST &&
                denormal < float(QUANTIZED_STEPS);
    vec3 at = fits ? origin + moved : vec3(0.0);
    vec3 margins = vec3(uintBitsToFloat(0x7f800000u));
    if (fits)
        margins = (ray.above - ray.origin) * quantized_ray.scale + margin;
    margins = mix(margins, -margins, ray.negative);
    quantized_ray.first = at + margins;
    quantized_ray.last = at - margins;
    vec3 inverse = min(quantized_ray.unit / abs(ray.dir), vec3(QUANTIZED_INVERSE_MAX));
    quantized_ray.inverse = mix(inverse, -inverse, ray.negative);
}

// The distances at which the ray enters and leaves the box of a node, as bits. It misses the box if
// the first is larger.
ivec2 enter_quantized_box(RaySetup ray, uvec3 sides)
{
    // The lower 16 bits are the side that the ray reaches first.
    uvec3 reached = mix(sides, sides >> 16 | sides << 16, ray.negative);
    ivec3 near = floatBitsToInt((vec3(reached & 0xffffu) - quantized_ray.first) * quantized_ray.inverse);
    ivec3 far = floatBitsToInt((vec3(reached >> 16) - quantized_ray.last) * quantized_ray.inverse);
    return ivec2(max(max(near.x, near.y), max(near.z, quantized_ray.from)),
                 min(min(far.x, far.y), min(far.z, quantized_ray.end)));
}

#endif
