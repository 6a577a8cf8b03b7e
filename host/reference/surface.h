/* Where a ray meets something. */
#ifndef REFERENCE_SURFACE_H
#define REFERENCE_SURFACE_H

#include "reference/meet.h"

struct surface {
    struct dvec3 p, ng, ns; /* world; normals unit, ns on the side of ng */
    struct dvec3 e1, e2;    /* edges of the triangle; of spheres the derivatives of p by u and v */
    struct dvec3 color;     /* of the vertices */
    double alpha;
    double u, v; /* of spheres: texture coordinates */
    double room; /* by how much a ray starts off the surface */
    /* By how much the texture's place moves for unit steps to both sides of the ray, in e1 and e2,
       times the side of what the ray stands for; 0: a point. */
    double footprint[2][2];
    const struct scene_mesh *mesh;
    const struct scene_material *material;
    uint32_t material_index, instance, primitive;
    bool sphere;
};

struct surface surface_at(const struct reference *reference, const struct hit *hit);
/* Turns its normals to the ray's side. True: the ray comes from inside. */
bool surface_face(struct surface *s, struct dvec3 dir);
/* The vertex normal at corner 0..2 in world space, unit; 0 for spheres and where the mesh is
   flat. */
struct dvec3 surface_vertex_normal(const struct reference *reference, const struct surface *s,
                                   uint32_t corner);
/* A surface of which only those fields are filled in that textures are looked up by: mesh,
   material, u, v, colours. */
struct surface surface_texture_place(const struct reference *reference, uint32_t instance,
                                     const struct candidate *m, const struct gpu_triangle *record);

#endif
