/* The surface at a hit. */
#ifndef REFERENCE_SURFACE_H
#define REFERENCE_SURFACE_H

#include "reference/meet.h"

struct surface {
    struct dvec3 p, ng, ns; /* world; normals unit, ns on the side of ng */
    struct dvec3 e1, e2;    /* edges of the triangle; spheres: derivatives of p by u and v */
    struct dvec3 color;     /* vertex colour */
    double alpha;
    double u, v; /* barycentric weights; spheres: texture coordinates */
    double room; /* distance by which rays start off the surface */
    /* The ray's footprint on the surface: its two sides, perpendicular to the ray, projected onto
       the surface, each as factors of e1 and e2; 0: a point. */
    double footprint[2][2];
    const struct scene_mesh *mesh;
    const struct scene_material *material;
    uint32_t material_index, instance, primitive;
    bool sphere;
    bool turned; /* ns is the reverse of the normal that the mesh states */
};

struct surface surface_at(const struct reference *reference, const struct hit *hit);
/* Turns the surface's normals to the ray's side. True: the ray comes from inside. */
bool surface_face(struct surface *s, struct dvec3 dir);
/* The vertex normal at corner 0..2 in world space, unit; 0 for spheres and for meshes without
   normals. */
struct dvec3 surface_vertex_normal(const struct reference *reference, const struct surface *s,
                                   uint32_t corner);
/* A surface with only those fields that texture lookups need: mesh, material, u, v, colours. */
struct surface surface_texture_place(const struct reference *reference, uint32_t instance,
                                     const struct candidate *m, const struct gpu_triangle *record);

#endif
