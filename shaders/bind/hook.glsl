// What stages and hooks tell each other: functions that a user may put in the place of whit's (hook/).
#ifndef BIND_HOOK_GLSL
#define BIND_HOOK_GLSL

#include "ray.glsl"

// The ray that a hook is called for.
Ray hook_ray;

// The way that ray goes: unit, world space.
vec3 ray_dir()
{
    return hook_ray.dir;
}

#endif
