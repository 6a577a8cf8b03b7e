// Makes camera rays.
#ifndef BIND_CAMERA_GLSL
#define BIND_CAMERA_GLSL

#include "../lib/angles.glsl"
#include "ray.glsl"

// The kind of the camera, CAMERA_*.
uint camera_kind()
{
    return SPEC_CAMERA == CAMERA_EACH ? view.camera : SPEC_CAMERA;
}

// Origin and direction, not of unit length, of the camera ray through `at`: -1..1 from left to
// right and from top to bottom. `lens`: as in chunk.lens_xy.
void camera_line(vec2 at, vec2 lens, out vec3 origin, out vec3 dir)
{
    origin = frame.eye;
    dir = frame.forward;
    if (camera_kind() == CAMERA_PANORAMA) {
        float turn = at.y * -0.5; // exact
        vec2 longitude = sine_cosine_pi(at.x), latitude = sine_cosine_pi(turn);
        precise vec3 level = frame.forward * longitude.y + frame.right * longitude.x;
        precise vec3 turned = level * latitude.y + frame.up * latitude.x;
        dir = turned;
        return;
    }
    precise vec3 in_plane = frame.right * at.x - frame.up * at.y;
    precise vec3 moved = frame.eye + in_plane, aimed = frame.forward + in_plane;
    if (camera_kind() == CAMERA_ORTHOGRAPHIC)
        origin = moved;
    else
        dir = aimed;
    if (camera_kind() == CAMERA_LENS) {
        // All rays of a pixel's sample meet in the focus plane, at eye + focus_distance * aimed.
        precise vec3 aside = frame.right * lens.x + frame.up * lens.y;
        precise vec3 on_lens = frame.eye + aside * frame.focus_distance;
        precise vec3 focused = aimed - aside;
        origin = on_lens;
        dir = focused;
    }
}

// Mirrors the sample's position differently in neighbouring pixels, so that the errors of
// neighbours compensate.
vec2 mirror_sample(vec2 xy, uvec2 pixel)
{
    return uintBitsToFloat(floatBitsToUint(xy) ^ (uvec2(pixel.x ^ pixel.y, pixel.x) << 31));
}

#ifdef HOOKS
// Scales a direction whose square would be 0 or overflow by a power of 2.
vec3 moderate(vec3 dir)
{
    float size = max(abs(dir.x), max(abs(dir.y), abs(dir.z)));
    int exponent = int(floatBitsToUint(size) >> 23); // 127 above the power of 2
    bool extreme = exponent < 127 - 32 || exponent > 127 + 32;
    return extreme ? dir * uintBitsToFloat(uint(max(254 - exponent, 1)) << 23) : dir;
}

// Calls the user's camera().
void aim_camera(uvec2 pixel, vec2 at, inout vec3 origin, inout vec3 dir);
#endif

// camera_ray of picture/camera.c is this in C, bit for bit. It uses sums, differences and products
// alone, which all devices round alike.
Ray camera_ray(uvec2 pixel)
{
    vec2 lens_xy = SPEC_VIEWS != 0u ? view.lens_xy : chunk.lens_xy;
    vec2 place = mirror_sample(chunk.sample_xy, pixel), lens = mirror_sample(lens_xy, pixel);
    precise vec2 middle = vec2(pixel) * 2.0 + 1.0 - vec2(frame.width, frame.height); // exact
    precise vec2 at = (middle + place) * vec2(frame.inv_width, frame.inv_height);
    vec3 origin, dir;
    camera_line(at, lens, origin, dir);
#ifdef HOOKS
    if ((SPEC_HOOKS & HOOK_CAMERA) != 0u)
        aim_camera(pixel, at, origin, dir);
    if ((SPEC_HOOKS & HOOK_CAMERA) != 0u)
        dir = moderate(dir);
#endif
    precise float squared = (dir.x * dir.x + dir.y * dir.y) + dir.z * dir.z;
    precise vec3 unit = dir * inverse_square_root(squared);
    Ray ray;
    ray.origin = origin;
    ray.dir = unit;
    ray.weight = vec3(1.0);
#ifdef HOOKS
    if ((SPEC_HOOKS & HOOK_CAMERA) != 0u && !is_usable(origin, unit))
        ray.weight = vec3(uintBitsToFloat(0x7fc00000u)); // NaN, which makes the picture an error
#endif
    ray.steps = 0u;
    ray.media = SPEC_MEDIA != 0u ? uvec4(frame.eye_media0, frame.eye_media1, frame.eye_media2,
                                         frame.eye_media3)
                                 : uvec4(0u);
    ray.skip_primitive = HIT_NONE;
    ray.skip_instance = ray.skip_record = HIT_NONE;
    ray.kind = RAY_PRIMARY;
    ray.way = 0.0;
    return ray;
}

// The share of the pixel's area that the sample stands for: mipmap_sample_share of
// host/picture/mipmap.c.
float sample_share()
{
    uint halvings = chunk.sample_index == 0u ? 0u : uint(findMSB(chunk.sample_index)) / 2u + 1u;
    return uintBitsToFloat((127u - 2u * halvings) << 23);
}

// The area that a texel should have for a sample of the pixel, across its camera ray at distance
// `way` from the eye. Pixels of a pinhole camera are equally large in the picture plane, which its
// rays cross at a flatter angle far from the middle; those of a panorama narrow towards its poles.
float texel_area(uvec2 pixel, float way)
{
    float area = frame.texel_area * sample_share();
    if (camera_kind() == CAMERA_ORTHOGRAPHIC)
        return area;
    vec2 middle = vec2(pixel) * 2.0 + 1.0 - vec2(frame.width, frame.height);
    vec2 at = middle * vec2(frame.inv_width, frame.inv_height);
    area *= way * way;
    if (camera_kind() == CAMERA_PANORAMA)
        return area * sine_cosine_pi(at.y * 0.5).y;
    float x2 = at.x * at.x * dot(frame.right, frame.right);
    float y2 = at.y * at.y * dot(frame.up, frame.up);
    float cosine = inverse_square_root(1.0 + (x2 + y2));
    return area * (cosine * cosine * cosine);
}

#endif
