/* Computes what shading needs of a hit: point, normals, texture coordinates, material. */
#include "reference/surface.h"
#include "base/same.h"
#include "base/vec.h"

/* Distance by which rays start off a surface, relative to the coordinates that the point is
   computed from: more than the point's rounding error. */
#define ROOM 0x1p-45

static struct dvec3 to_world(const struct reference *reference, uint32_t instance, struct dvec3 p,
                             bool is_point)
{
    const struct affine *forward = &reference->placings[instance].forward;
    const double in[3] = {p.x, p.y, p.z};
    double out[3];
    if (reference->accel->flat)
        return p;
    if (is_point)
        affine_point(forward, in, out);
    else
        affine_vector(forward, in, out);
    return d3(out[0], out[1], out[2]);
}

/* Takes a normal from an instance's object space to the world, by the inverse transpose; the result
   is not unit. */
static struct dvec3 place_normal(const struct reference *reference, uint32_t instance,
                                 struct dvec3 n)
{
    const double *m = reference->placings[instance].inverse.m;
    return d3(m[0] * n.x + m[4] * n.y + m[8] * n.z, m[1] * n.x + m[5] * n.y + m[9] * n.z,
              m[2] * n.x + m[6] * n.y + m[10] * n.z);
}

static struct dvec3 mesh_normal(const struct surface *s, uint32_t corner)
{
    if (!s->mesh->normals)
        return d3_all(0.0);
    return d3_load(
        &s->mesh->normals[3 * (size_t)s->mesh->indices[3 * (size_t)s->primitive + corner]]);
}

struct dvec3 surface_vertex_normal(const struct reference *reference, const struct surface *s,
                                   uint32_t corner)
{
    if (s->sphere)
        return d3_all(0.0);
    struct dvec3 n = place_normal(reference, s->instance, mesh_normal(s, corner));
    return d3_unit_or(n, d3_all(0.0));
}

static struct dvec3 blend(struct dvec3 a, struct dvec3 b, struct dvec3 c, double u, double v)
{
    return dvec3_along(dvec3_along(d3_scale(a, 1.0 - u - v), b, u), c, v);
}

/* Interpolates vertex colours, which are clamped to 0..1, as in the kernels' records. */
static void take_colors(struct surface *s)
{
    s->color = d3_all(1.0);
    s->alpha = 1.0;
    if (s->sphere || !s->mesh->colors)
        return;
    const uint32_t *corners = &s->mesh->indices[3 * (size_t)s->primitive];
    double rgba[4];
    for (size_t c = 0; c < 4; ++c) {
        double first = clamp_unit((double)s->mesh->colors[4 * (size_t)corners[0] + c]);
        double second = clamp_unit((double)s->mesh->colors[4 * (size_t)corners[1] + c]);
        double third = clamp_unit((double)s->mesh->colors[4 * (size_t)corners[2] + c]);
        /* In differences, so that three equal colours give exactly that colour. */
        rgba[c] = first + (second - first) * s->u + (third - first) * s->v;
    }
    s->color = d3(rgba[0], rgba[1], rgba[2]);
    s->alpha = rgba[3];
}

/* Texture coordinates of a sphere: u goes once around y from +x towards -z, v from the top down. */
static void take_sphere_uv(struct surface *s, struct dvec3 n)
{
    double around = same_atan2(-n.z, n.x) / (2.0 * PI);
    s->u = around < 0.0 ? around + 1.0 : around;
    s->v = same_atan2(sqrt(n.x * n.x + n.z * n.z), n.y) / PI;
}

static struct surface begin_surface(const struct reference *reference, uint32_t instance,
                                    uint32_t primitive)
{
    const struct scene *scene = reference->scene;
    struct surface s = {.mesh = &scene->meshes[scene->instances[instance].mesh],
                        .instance = instance,
                        .primitive = primitive};
    s.material_index = s.mesh->materials[primitive];
    s.material = &scene->materials[s.material_index];
    s.sphere = s.mesh->sphere_count > 0;
    return s;
}

struct surface surface_texture_place(const struct reference *reference, uint32_t instance,
                                     const struct candidate *m, const struct gpu_triangle *record)
{
    struct surface s = begin_surface(reference, instance, record->primitive);
    s.u = m->u;
    s.v = m->v;
    if (s.sphere)
        take_sphere_uv(&s, m->normal);
    take_colors(&s);
    return s;
}

/* Fills in point, edges and normals of a triangle, in the space of the record; normals are not
   unit. */
static void take_triangle(const struct gpu_triangle *record, const struct hit *hit,
                          struct surface *s)
{
    struct dvec3 v0 = d3_load(record->v0), v1 = d3_load(record->v1), v2 = d3_load(record->v2);
    s->u = hit->u;
    s->v = hit->v;
    s->e1 = dvec3_sub(v1, v0);
    s->e2 = dvec3_sub(v2, v0);
    s->p = blend(v0, v1, v2, s->u, s->v);
    s->ng = d3_unit_or(dvec3_cross(s->e1, s->e2), d3(0, 1, 0));
    s->ns = blend(mesh_normal(s, 0), mesh_normal(s, 1), mesh_normal(s, 2), s->u, s->v);
}

static void take_sphere(const struct gpu_triangle *record, const struct hit *hit, struct surface *s)
{
    struct dvec3 n = hit->normal;
    double radius = (double)record->v1[0], ring = sqrt(n.x * n.x + n.z * n.z);
    struct dvec3 around = ring > 0.0 ? d3(n.z / ring, 0.0, -n.x / ring) : d3_all(0.0);
    s->p = dvec3_along(d3_load(record->v0), n, radius);
    s->ng = n;
    s->ns = n;
    s->e1 = d3_scale(around, 2.0 * PI * radius * ring);
    s->e2 = d3_scale(dvec3_cross(around, n), PI * radius);
    take_sphere_uv(s, n);
}

struct surface surface_at(const struct reference *reference, const struct hit *hit)
{
    const struct gpu_triangle *record = &reference->accel->triangles[hit->record];
    struct surface s = begin_surface(reference, hit->instance, hit->primitive);
    if (s.sphere)
        take_sphere(record, hit, &s);
    else
        take_triangle(record, hit, &s);
    struct dvec3 ng = s.ng, ns = s.ns;
    if (reference->accel->flat) /* vertex normals alone are in object space */
        ng = record->flags & TRIANGLE_MIRRORED ? d3_scale(ng, -1.0) : ng;
    else
        ng = place_normal(reference, hit->instance, ng);
    if (!s.sphere || !reference->accel->flat)
        ns = place_normal(reference, hit->instance, ns);
    s.p = to_world(reference, hit->instance, s.p, true);
    s.e1 = to_world(reference, hit->instance, s.e1, false);
    s.e2 = to_world(reference, hit->instance, s.e2, false);
    s.ng = d3_unit_or(ng, d3(0, 1, 0));
    s.ns = d3_unit_or(ns, s.ng);
    s.room = ROOM * (d3_size(s.p) + d3_size(s.e1) + d3_size(s.e2));
    take_colors(&s);
    return s;
}

bool surface_face(struct surface *s, struct dvec3 dir)
{
    bool inside = dvec3_dot(dir, s->ng) > 0.0;
    if (inside) {
        s->ng = d3_scale(s->ng, -1.0);
        s->ns = d3_scale(s->ns, -1.0);
    }
    s->turned = inside;
    if (dvec3_dot(s->ns, s->ng) < 0.0) {
        s->ns = d3_scale(s->ns, -1.0);
        s->turned = !inside;
    }
    if (dvec3_dot(s->ns, dir) > 0.0)
        s->ns = s->ng;
    return inside;
}
