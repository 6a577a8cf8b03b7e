// What functions of a user's file may use besides each other and what GLSL has: declared here, with bodies that
// nothing runs; in the compiled kernel those of hook/prelude.glsl stand in their place (host/shader/link.c).
// Lengths are in world units, angles in radians, directions unit vectors of world space, light is radiance in
// linear RGB.
#ifndef HOOK_INTERFACE_GLSL
#define HOOK_INTERFACE_GLSL

#include "../lib/optics.glsl"
#include "../lib/records.glsl" // Surface, Optics, Rays, Light

#define ELSEWHERE(type)                                                                                      \
    {                                                                                                        \
        type none;                                                                                           \
        return none;                                                                                         \
    }

uint whit_fuel = 0u;
uint whit_fuel_loop = 0u;

// ---- The ray ----

// The way it goes.
vec3 ray_dir() ELSEWHERE(vec3)
// Where it starts.
vec3 ray_origin() ELSEWHERE(vec3)
// How far the surface is from there.
float ray_distance() ELSEWHERE(float)
// Surfaces between the camera and this one that have called for rays; 0: the camera sees it.
uint bounces() ELSEWHERE(uint)

// ---- The picture ----

// From 0, 0 at the top left.
uvec2 pixel() ELSEWHERE(uvec2)
uvec2 picture_size() ELSEWHERE(uvec2)
// Which of the pixel's samples.
uint sample_number() ELSEWHERE(uint)
// Where the camera is.
vec3 eye() ELSEWHERE(vec3)
// A number from 0 to just below 1: another one for each k, pixel, sample and ray, the same in every run.
float random(uint k) ELSEWHERE(float)
// Gives a hash of all bits of x.
uint hash(uint x) ELSEWHERE(uint)
// Value of slider `index` of the file.
float slider(uint index) ELSEWHERE(float)

// ---- Light ----

// Light that comes from everywhere.
vec3 ambient() ELSEWHERE(vec3)
// What the scene's sky sends from there.
vec3 environment(vec3 dir) ELSEWHERE(vec3)
uint light_count() ELSEWHERE(uint)
// Points of the light that are tested: --light-samples of an area light, 1 of all others.
uint light_points(uint index) ELSEWHERE(uint)
// Point `point` of a light, as a surface has it; behind the last light that.
Light light(uint index, uint point, Surface s) ELSEWHERE(Light)

// ---- Rays ----

#ifdef HAS_INTERSECT
bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal);
// What traces calls it, so that the compiler finds where it would come to call itself.
#define TRACES(type)                                                                                         \
    {                                                                                                        \
        type none;                                                                                           \
        float t;                                                                                             \
        vec3 normal;                                                                                         \
        intersect(vec3(0.0), vec3(0.0), 0.0, t, normal);                                                     \
        return none;                                                                                         \
    }
#else
#define TRACES ELSEWHERE
#endif

// Just off the surface, on the side that `dir` goes to: where a ray from it starts.
vec3 off_surface(Surface s, vec3 dir) ELSEWHERE(vec3)
// How much light comes along a way of length `distance` from a surface, which is not in its own way: 1 where
// nothing is in it, 0 behind something opaque.
vec3 visible(Surface s, vec3 dir, float distance) TRACES(vec3)
// What a ray meets, and after which distance. False: nothing; `met` then means nothing.
bool trace(vec3 origin, vec3 dir, out Surface met, out float distance) TRACES(bool)
// What a light, with its shadows, lets a surface send to `to_eye`.
vec3 lit_by(uint index, Surface s, Optics o, vec3 to_eye) TRACES(vec3)

// ---- Tests ----

#ifdef HAS_TESTS
void check(uint word, uint bit, bool holds) {}
void run_test(uint test, uint seed);
#endif

// ---- Values that are looked at ----

// dbg(x) is x, a number, a bool or a vector of these, and for a pixel that is looked at it is shown, with the
// file, the line and what stands in its brackets. It may stand wherever x may, but for macros and tests.
#ifdef HAS_DBG
void whit_record(uint call, uint type, uvec4 bits) {}
#include "dbg.glsl"
#endif

// ---- Whit's own functions in the place of which those of the file stand ----

void whit_camera(vec2 at, inout vec3 origin, inout vec3 dir) {}
void whit_surface(inout Surface s) {}
vec3 whit_shade(Surface s, Optics o, vec3 to_eye) TRACES(vec3)
void whit_scatter(Surface s, Optics o, inout Rays rays) {}
vec3 whit_miss(vec3 dir) ELSEWHERE(vec3)
vec3 whit_post(ivec2 at, vec3 color) ELSEWHERE(vec3)

// What the file has not is whit's own by either name.
#ifdef HAS_CAMERA
void camera(vec2 at, inout vec3 origin, inout vec3 dir);
#else
#define camera whit_camera
#endif
#ifdef HAS_SURFACE
void surface(inout Surface s);
#else
#define surface whit_surface
#endif
#ifdef HAS_SHADE
vec3 shade(Surface s, Optics o, vec3 to_eye);
#else
#define shade whit_shade
#endif
#ifdef HAS_SCATTER
void scatter(Surface s, Optics o, inout Rays rays);
#else
#define scatter whit_scatter
#endif
#ifdef HAS_MISS
vec3 miss(vec3 dir);
#else
#define miss whit_miss
#endif
#ifdef HAS_POST
vec3 post(ivec2 at, vec3 color);
#else
#define post whit_post
#endif

#endif
