// Functions that a user's file may call besides its own and those of GLSL. The bodies
// here never run; in the compiled kernel those of hook/prelude.glsl stand in their place
// (host/shader/link.c). Lengths are in world units, angles in radians, directions unit vectors of
// world space; light is radiance in linear RGB.
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

// The ray's direction.
vec3 ray_dir() ELSEWHERE(vec3)
// Where the ray starts.
vec3 ray_origin() ELSEWHERE(vec3)
// The distance from there to the surface.
float ray_distance() ELSEWHERE(float)
// Number of surfaces between the camera and this one that sent the ray on; 0: the camera sees this
// one.
uint bounces() ELSEWHERE(uint)

// ---- The picture ----

// The pixel, counted from 0, 0 at the top left.
uvec2 pixel() ELSEWHERE(uvec2)
uvec2 picture_size() ELSEWHERE(uvec2)
// Number of the sample within the pixel, from 0.
uint sample_number() ELSEWHERE(uint)
// Position of the camera.
vec3 eye() ELSEWHERE(vec3)
// A random number from 0 to just below 1: it differs for each k, pixel, sample and ray, and is the
// same in every run.
float random(uint k) ELSEWHERE(float)
// A hash of all bits of x.
uint hash(uint x) ELSEWHERE(uint)
// Value of slider `index` of the file.
float slider(uint index) ELSEWHERE(float)

// ---- Light ----

// The scene's ambient light, which comes from everywhere.
vec3 ambient() ELSEWHERE(vec3)
// The light that the scene's sky sends from direction `dir`.
vec3 environment(vec3 dir) ELSEWHERE(vec3)
uint light_count() ELSEWHERE(uint)
// Number of points of the light that are tested: --light-samples for an area light, 1 for all
// others.
uint light_points(uint index) ELSEWHERE(uint)
// Point `point` of a light, as it is seen from a surface; an index beyond the last light means the
// last.
Light light(uint index, uint point, Surface s) ELSEWHERE(Light)

// ---- Rays ----

#ifdef HAS_INTERSECT
bool intersect(vec3 origin, vec3 dir, float far, out float t, out vec3 normal);
// Functions that trace rays call it here, so that the compiler finds an intersect() that would call
// itself.
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

// A point just off the surface, on the side that `dir` goes to, from which to start a ray.
vec3 off_surface(Surface s, vec3 dir) ELSEWHERE(vec3)
// The share of light that comes to a surface from the distance `distance` along `dir`: 1 where
// nothing is in between, 0 behind something opaque. The surface does not block itself.
vec3 visible(Surface s, vec3 dir, float distance) TRACES(vec3)
// Finds the surface that a ray hits first, without normal maps, and its distance. False: it hits
// nothing, and `met` is undefined.
bool trace(vec3 origin, vec3 dir, out Surface met, out float distance) TRACES(bool)
// The light that a surface sends to `to_eye` because of one light, with shadows.
vec3 lit_by(uint index, Surface s, Optics o, vec3 to_eye) TRACES(vec3)

// ---- Tests ----

#ifdef HAS_TESTS
void check(uint word, uint bit, bool holds) {}
void run_test(uint test, uint seed);
#endif

// ---- Values of a probed pixel ----

// dbg(x) returns x, a number, a bool or a vector of these. For a probed pixel its value is shown,
// with the file, the line and the text in its brackets. It may stand wherever x may, except in
// macros and tests.
#ifdef HAS_DBG
void whit_record(uint call, uint type, uvec4 bits) {}
#include "dbg.glsl"
#endif

// ---- Whit's own functions, which those of the file replace ----

void whit_camera(vec2 at, inout vec3 origin, inout vec3 dir) {}
void whit_surface(inout Surface s) {}
vec3 whit_shade(Surface s, Optics o, vec3 to_eye) TRACES(vec3)
void whit_scatter(Surface s, Optics o, inout Rays rays) {}
vec3 whit_miss(vec3 dir) ELSEWHERE(vec3)
vec3 whit_post(ivec2 at, vec3 color) ELSEWHERE(vec3)

// Where the file lacks a function, both names mean whit's own.
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
