// What stages and functions of users tell each other. Lengths are in world units, directions of world space,
// light is radiance in linear RGB.
#ifndef LIB_RECORDS_GLSL
#define LIB_RECORDS_GLSL

// Where a ray has met something.
struct Surface {
    vec3 p, error; // world; bound of the error of p
    vec3 ng;       // unit geometric normal: of fetch_surface to the outside of closed meshes, then on the ray's side
    vec3 ns;       // unit shading normal, on the side of ng
    // Edges from the first vertex, world units; of a sphere the derivatives of p by u and v. Filled where the scene
    // calls for normal maps, media, --minification or the shift of smooth shadows.
    vec3 e1, e2;
    // The part of the surface that the ray stands for, without unit: its mean square size is the sum of these times
    // a.a, a.b and b.b, where a and b are what changes along e1 and e2, such as texels. Zero: a point.
    vec3 footprint;
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
    float shininess; // exponent of Blinn's highlight (n.h)^shininess, 0 and above, without unit
    float alpha;     // of GGX: roughness squared, 0.02 to 1, without unit
    float eta;       // index of refraction of the side the ray comes from over that of the other
    bool thin;       // a sheet without inside: what passes goes straight on
    bool unlit;      // lights do not count: it sends diffuse and emission
    bool metal_rough; // the highlight is GGX by alpha, else Blinn's by shininess
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
