// Where the ray tree of a pixel starts.
#ifndef BIND_CAMERA_GLSL
#define BIND_CAMERA_GLSL

#include "ray_stack.glsl"

// camera_ray of render/camera.c is this in C, bit for bit: so no normalize(), whose bits are the
// driver's choice.
Ray camera_ray(uvec2 pixel)
{
    precise vec2 at =
        (vec2(pixel) + chunk.sample_xy) / vec2(frame.width, frame.height) * 2.0 - 1.0;
    precise vec3 in_plane = frame.right * at.x - frame.up * at.y;
    precise vec3 origin = frame.eye + in_plane;
    precise vec3 dir = frame.forward + in_plane;
    if (SPEC_CAMERA == CAMERA_ORTHOGRAPHIC)
        dir = frame.forward;
    else
        origin = frame.eye;
    precise float size = sqrt((dir.x * dir.x + dir.y * dir.y) + dir.z * dir.z);
    precise vec3 unit = dir / size;
    Ray ray;
    ray.origin = origin;
    ray.dir = unit;
    ray.weight = vec3(1.0);
    ray.bounces = 0u;
    ray.media = SPEC_MEDIA != 0u ? uvec4(frame.eye_media0, frame.eye_media1, frame.eye_media2,
                                         frame.eye_media3)
                                 : uvec4(0u);
    ray.skip_primitive = HIT_NONE;
    ray.skip_instance = HIT_NONE;
    ray.kind = RAY_PRIMARY;
    return ray;
}

#endif
