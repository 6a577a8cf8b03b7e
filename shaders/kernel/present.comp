#version 450
/* A picture of 8-bit sRGB pixels onto a window: pixel for pixel where their sizes are equal, else
   stretched, between the four nearest pixels. The window's format takes the bytes as they are. */

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) readonly buffer Picture { uint pixels[]; } picture; /* RGBA, red lowest */
layout(set = 0, binding = 1) uniform writeonly image2D window;

layout(push_constant) uniform Push {
    uvec2 picture_size, window_size;
} push;

vec4 pixel(uvec2 at)
{
    return unpackUnorm4x8(picture.pixels[at.y * push.picture_size.x + at.x]);
}

vec4 between(uvec2 at)
{
    vec2 scale = vec2(push.picture_size) / vec2(push.window_size);
    vec2 place = max((vec2(at) + 0.5) * scale - 0.5, vec2(0.0));
    uvec2 lo = min(uvec2(place), push.picture_size - 1u);
    uvec2 hi = min(lo + 1u, push.picture_size - 1u);
    vec2 part = place - vec2(lo);
    vec4 top = mix(pixel(lo), pixel(uvec2(hi.x, lo.y)), part.x);
    vec4 bottom = mix(pixel(uvec2(lo.x, hi.y)), pixel(hi), part.x);
    return mix(top, bottom, part.y);
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(at, push.window_size)))
        return;
    bool same = push.picture_size == push.window_size;
    imageStore(window, ivec2(at), same ? pixel(at) : between(at));
}
