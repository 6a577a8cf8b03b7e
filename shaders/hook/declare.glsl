// The functions that a user's file may have. What it has not is whit's own, by either name.
#ifndef HOOK_DECLARE_GLSL
#define HOOK_DECLARE_GLSL

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

#ifdef HOOK_CAMERA
void camera(vec2 at, inout vec3 origin, inout vec3 dir);

void aim_camera(uvec2 pixel, vec2 at, inout vec3 origin, inout vec3 dir)
{
    hook_pixel = pixel;
    hook_ray.dir = dir;
    hook_ray.steps = 0u;
    begin_hook();
    camera(at, origin, dir);
    end_hook(true);
}
#else
#define camera whit_camera
#endif
#ifdef HOOK_SURFACE
void surface(inout Surface s);
#else
#define surface whit_surface
#endif
#ifdef HOOK_SHADE
vec3 shade(Surface s, Optics o, vec3 to_eye);
#else
#define shade whit_shade
#endif
#ifdef HOOK_SCATTER
void scatter(Surface s, Optics o, inout Rays rays);
#else
#define scatter whit_scatter
#endif
#ifdef HOOK_MISS
vec3 miss(vec3 dir);
#else
#define miss whit_miss
#endif
#ifdef HOOK_POST
vec3 post(ivec2 at, vec3 color);
#else
#define post whit_post
#endif

#endif
