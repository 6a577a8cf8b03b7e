// What stages and functions of users tell each other. Lengths are in world units, directions of world space,
// light is radiance in linear RGB.
#ifndef LIB_RECORDS_GLSL
#define LIB_RECORDS_GLSL

// Where a ray has met something.
struct Surface {
    vec3 p, error; // world; bound of the error of p
    vec3 ng;       // unit geometric normal, to the outside of closed meshes
    vec3 ns;       // unit shading normal, on the side of ng
    vec3 e1, e2; // edges from the first vertex, world; of NORMAL_MAPS, MEDIA, TERMINATOR, MINIFICATION
    vec3 footprint; // of what the ray stands for, see take_footprint; zero: a point
    vec3 color;              // of the vertices
    float color_alpha;
    uint shade_index; // index among the triangles of all meshes
    uint instance;
    bool on_sphere;
    uint material;
    float u, v; // of the triangle's second and third vertex; of a sphere: texture coordinates
};

// What the material does with light there, after textures.
struct Optics {
    vec3 diffuse, ambient, highlight, emission;
    vec3 reflected, refracted; // weights of the two rays
    float straight;            // share that passes undisturbed (opacity)
    float shininess, alpha;    // of Blinn's highlight; of GGX
    float eta;
    bool thin, unlit, metal_rough;
};

// The rays that go on from a surface.
struct Rays {
    vec3 reflected, refracted, straight; // share of what they bring that is seen, linear RGB; 0: there is none
    vec3 reflected_dir, refracted_dir;   // the way they go, world space, unit but for rounding
};

// A point of a light, as a surface has it.
struct Light {
    vec3 dir;       // from the surface to the point of the light
    float distance; // along it; the largest float: a light without a place
    vec3 arriving;  // irradiance over pi on what faces the point, without shadows; of an area light, its share
};

#endif
