// Records that stages and functions of users pass to each other. Lengths are in world units,
// directions in world space; light is radiance in linear RGB.
#ifndef LIB_RECORDS_GLSL
#define LIB_RECORDS_GLSL

// The surface where a ray hit something.
struct Surface {
    vec3 p, error; // world; bound of the error of p, world units
    vec3 ng;       // unit geometric normal, on the ray's side (fetch_surface: to the outside of
                   // closed meshes)
    vec3 ns;       // unit shading normal, on the side of ng
    // Edges from the first vertex, world units; on a sphere the derivatives of p by u and v. Filled
    // in where the scene has normal maps, media, --minification or the shift of smooth shadows.
    vec3 e1, e2;
    // The part of the surface that the ray covers, without unit: its mean square size is the sum of
    // these times a.a, a.b and b.b, where a and b are the changes along e1 and e2 of what is
    // measured, such as texels. Zero: a point.
    vec3 footprint;
    vec3 color;        // interpolated vertex colour, linear RGB, without unit
    float color_alpha; // 0 to 1
    uint shade_index;  // index among the triangles of all meshes
    uint instance;     // index, as in --ids
    bool on_sphere;
    bool turned;   // ns is the reverse of the normal that the mesh states
    uint material; // index among the scene's materials
    float u, v;    // weights of the triangle's second and third vertex; on a sphere texture
                   // coordinates
};

// The material's interaction with light at the hit, after textures.
struct Optics {
    // Shares of arriving light that are sent on, linear RGB, without unit: from lights (times
    // Light.arriving and a cosine), from everywhere (times ambient()), and in the highlight.
    vec3 diffuse, ambient, highlight;
    vec3 emission;             // radiance, linear RGB
    vec3 reflected, refracted; // weights of the two rays, linear RGB, without unit
    float straight;            // share that passes straight through, 0 to 1: 1 - opacity
    float shininess;  // exponent of Blinn's highlight (n.h)^shininess, 0 and above, without unit
    float alpha;      // of GGX: roughness squared, 0.02 to 1, without unit
    float eta;        // index of refraction of the side the ray comes from over that of the other
    bool thin;        // a sheet without an inside: light that passes goes straight on
    bool unlit;       // lights do not matter: the surface sends diffuse + emission
    bool metal_rough; // the highlight is GGX with alpha, else Blinn's with shininess
};

// The rays that go on from a surface.
struct Rays {
    vec3 reflected, refracted, straight; // share of their light that is seen, linear RGB; 0: no ray
    vec3 reflected_dir, refracted_dir;   // directions, world space, unit within rounding
};

// A point of a light, as seen from a surface.
struct Light {
    vec3 dir;       // from the surface to the point of the light
    float distance; // to that point; the largest float for a light without a place
    vec3 arriving;  // irradiance / pi on a surface that faces the point, without shadows; for an
                    // area light the point's share
};

#endif
