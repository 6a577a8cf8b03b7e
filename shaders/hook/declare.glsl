// Whit's own versions of the functions that a user's file may define. Those that the file has
// replace them in the compiled kernel (host/shader/link.c), and SPEC_HOOKS has their bits.
#ifndef HOOK_DECLARE_GLSL
#define HOOK_DECLARE_GLSL

#include "../bind/environment.glsl"
#include "prelude.glsl"

#define camera whit_camera
#include "camera.glsl"
#undef camera
#define surface whit_surface
#include "surface.glsl"
#undef surface
#define shade whit_shade
#include "shade.glsl"
#undef shade
#define scatter whit_scatter
#include "scatter.glsl"
#undef scatter
#define miss whit_miss
#include "miss.glsl"
#undef miss
#define post whit_post
#include "post.glsl"
#undef post

void camera(vec2 at, inout vec3 origin, inout vec3 dir)
{
    whit_camera(at, origin, dir);
}

void surface(inout Surface s)
{
    whit_surface(s);
}

vec3 shade(Surface s, Optics o, vec3 to_eye)
{
    return whit_shade(s, o, to_eye);
}

void scatter(Surface s, Optics o, inout Rays rays)
{
    whit_scatter(s, o, rays);
}

vec3 miss(vec3 dir)
{
    return whit_miss(dir);
}

vec3 post(ivec2 at, vec3 color)
{
    return whit_post(at, color);
}

// The value of the user's aov function number `index`; whit has none.
vec4 aov(uint index, Surface s)
{
    return vec4(0.0);
}

// Whether a ray meets the user's shape, at `t`; whit has none.
bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal)
{
    t = 0.0;
    normal = vec3(0.0);
    return false;
}

// The box of that shape, and how far from the shape answers may be, in world units.
void shape_box(out vec3 lo, out vec3 hi, out float error)
{
    lo = hi = vec3(0.0);
    error = 0.0;
}

#include "shape.glsl"

// Sets the user's global variables to their initial values.
void begin_user()
{
}

// Call it before any function of the user's. Initial values of global variables are computed here,
// before there is a ray: for them the pixel is 0, 0, and directions and distances are 0.
void begin_functions()
{
    hook_pixel = uvec2(0u);
    hook_ray.origin = hook_ray.dir = vec3(0.0);
    hook_ray.steps = 0u;
    hook_hit = make_hit(0.0);
    traced_hit = hook_hit;
    hook_shade = traced_shade = HIT_NONE;
    hook_media = uvec4(0u);
    begin_user();
}

void aim_camera(uvec2 pixel, vec2 at, inout vec3 origin, inout vec3 dir)
{
    if (!is_in_picture(pixel)) // beyond the picture's edge: the ray is not used
        return;
    hook_pixel = pixel;
    hook_ray.origin = origin;
    hook_ray.dir = dir;
    hook_ray.steps = 0u;
    begin_hook();
    camera(at, origin, dir);
    end_hook(true);
}

#endif
