// The ray that stages tell hooks, the functions that a user may put in the place of whit's (hook/).
#ifndef BIND_HOOK_GLSL
#define BIND_HOOK_GLSL

#include "ray.glsl"

// The ray that a hook is called for.
Ray hook_ray;

// The ray's direction: unit, world space.
vec3 ray_dir()
{
    return hook_ray.dir;
}

#endif
