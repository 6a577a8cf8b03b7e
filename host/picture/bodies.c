/* Lists bodies of media and bounds the distance between their surfaces. Where it exceeds the
   distance within which kernels treat surfaces as being at one place (shaders/bind/crossing.glsl),
   kernels need not search for such surfaces. */
#include "picture/bodies.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/color.h"
#include "base/hash.h"
#include "base/vec.h"

/* After comparing this many pairs of boxes, some 50 ms, bodies are assumed to touch. */
enum { PAIRS_MAX = 1 << 23 };

bool bodies_bounded_by(const struct scene_material *m)
{
    return !m->thin_walled && m->model != WHIT_MODEL_UNLIT && !color_is_black(m->transmission);
}

/* ---- What there is ---- */

static void grow(struct body *body, const float at[3], float radius)
{
    for (int k = 0; k < 3; ++k) {
        body->lo[k] = fmin(body->lo[k], (double)at[k] - (double)radius);
        body->hi[k] = fmax(body->hi[k], (double)at[k] + (double)radius);
    }
}

static struct body empty_body(uint32_t material)
{
    struct body body = {.material = material, .sphere = SCENE_NONE};
    double3_no_box(body.lo, body.hi);
    return body;
}

static struct body *body_of(struct bodies *bodies, uint32_t first, uint32_t material)
{
    for (uint32_t i = bodies->count; i > first; --i) {
        if (bodies->all[i - 1].material == material)
            return &bodies->all[i - 1];
    }
    if (!ARRAY_PUSH(bodies->all, bodies->count, bodies->capacity, empty_body(material)))
        return NULL;
    return &bodies->all[bodies->count - 1];
}

/* Appends the bodies of a mesh, in object space. False: memory ran out. */
static bool list_mesh(const struct scene *scene, const struct scene_mesh *mesh,
                      struct bodies *bodies)
{
    uint32_t first = bodies->count;
    struct body *body = NULL;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        uint32_t material = mesh->materials[t];
        if (!bodies_bounded_by(&scene->materials[material]))
            continue;
        if (!body || body->material != material)
            body = body_of(bodies, first, material);
        if (!body)
            return false;
        for (size_t k = 0; k < 3; ++k)
            grow(body, &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)t + k]], 0.0f);
    }
    for (uint32_t i = 0; i < mesh->sphere_count; ++i) {
        if (!bodies_bounded_by(&scene->materials[mesh->materials[i]]))
            continue;
        struct body sphere = empty_body(mesh->materials[i]);
        sphere.sphere = i;
        grow(&sphere, &mesh->spheres[4 * (size_t)i], mesh->spheres[4 * (size_t)i + 3]);
        if (!ARRAY_PUSH(bodies->all, bodies->count, bodies->capacity, sphere))
            return false;
    }
    return true;
}

/* The body's box in world space, widened by more than the rounding of its transform and the error
   of hits. */
static struct body place_body(const struct body *body, const struct affine *placed)
{
    struct body out = empty_body(body->material);
    double size = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double at[3], to[3];
        for (int k = 0; k < 3; ++k)
            at[k] = corner >> k & 1 ? body->hi[k] : body->lo[k];
        affine_point(placed, at, to);
        double3_grow_box(out.lo, out.hi, to);
        for (int k = 0; k < 3; ++k)
            size = fmax(size, fabs(to[k]));
    }
    out.sphere = body->sphere;
    out.rounding = size * 64.0 * FLT_EPSILON;
    for (int k = 0; k < 3; ++k) {
        out.lo[k] -= out.rounding;
        out.hi[k] += out.rounding;
    }
    return out;
}

static bool list_all(const struct scene *scene, const struct scene_pose *pose, struct bodies *out)
{
    struct bodies meshes = {0};
    uint32_t *first = array_alloc((size_t)scene->mesh_count + 1, sizeof *first);
    bool fine = first != NULL;
    for (uint32_t m = 0; fine && m < scene->mesh_count; ++m) {
        first[m] = meshes.count;
        fine = list_mesh(scene, &scene->meshes[m], &meshes);
        first[m + 1] = meshes.count;
    }
    for (uint32_t i = 0; fine && i < pose->instance_count; ++i) {
        uint32_t mesh = scene->instances[i].mesh;
        for (uint32_t b = first[mesh]; fine && b < first[mesh + 1]; ++b) {
            struct body body = place_body(&meshes.all[b], &pose->instances[i]);
            body.instance = i;
            fine = ARRAY_PUSH(out->all, out->count, out->capacity, body);
        }
    }
    free(first);
    free(meshes.all);
    return fine;
}

bool bodies_list(const struct scene *scene, const struct scene_pose *pose, struct bodies *bodies)
{
    uint64_t hash =
        hash_bytes(HASH_START, pose->instances, pose->instance_count * sizeof *pose->instances);
    if (bodies->all && bodies->pose_hash == hash)
        return true;
    bodies_finish(bodies);
    bodies->pose_hash = hash;
    bool fine = list_all(scene, pose, bodies);
    if (!fine)
        bodies_finish(bodies); /* half a list must not be taken for a whole one */
    return fine;
}

void bodies_finish(struct bodies *bodies)
{
    free(bodies->all);
    *bodies = (struct bodies){0};
}

/* ---- Surfaces, and how far they are apart ---- */

/* A sphere or a triangle in world space. */
struct surface {
    uint32_t body;
    bool round; /* a sphere: corners[0] is its centre */
    bool vague; /* only its box is known, as for a stretched sphere */
    double corners[3][3], radius;
    double lo[3], hi[3]; /* box, widened by the rounding of its body */
};

struct surfaces {
    struct surface *all;
    uint32_t count, capacity;
};

/* The distance from p to the segment from a to b. */
static double segment_distance(const double a[3], const double b[3], const double p[3])
{
    double ab[3], ap[3];
    double3_sub(b, a, ab);
    double3_sub(p, a, ap);
    double length2 = double3_dot(ab, ab);
    double t = length2 > 0.0 ? fmin(fmax(double3_dot(ap, ab) / length2, 0.0), 1.0) : 0.0;
    const double at[3] = {a[0] + t * ab[0], a[1] + t * ab[1], a[2] + t * ab[2]};
    return double3_distance(at, p);
}

/* The distance from p to the triangle: to its edges, or to its plane where p lies above its
   inside. */
static double triangle_distance(const double corners[3][3], const double p[3])
{
    double e1[3], e2[3], n[3], nearest = INFINITY;
    bool above = true;
    double3_sub(corners[1], corners[0], e1);
    double3_sub(corners[2], corners[0], e2);
    double3_cross(e1, e2, n);
    for (int i = 0; i < 3; ++i) {
        const double *a = corners[i], *b = corners[(i + 1) % 3];
        double ab[3], ap[3], inwards[3];
        double3_sub(b, a, ab);
        double3_sub(p, a, ap);
        double3_cross(n, ab, inwards);
        above &= double3_dot(inwards, ap) > 0.0;
        nearest = fmin(nearest, segment_distance(a, b, p));
    }
    double ap[3];
    double3_sub(p, corners[0], ap);
    return above ? fabs(double3_dot(n, ap)) / sqrt(double3_dot(n, n)) : nearest;
}

/* The distance between a triangle and a sphere's surface; the triangle may be outside or inside of
   the sphere. */
static double sphere_to_triangle(const struct surface *sphere, const struct surface *triangle)
{
    const double *c = sphere->corners[0];
    double farthest = 0.0;
    for (int i = 0; i < 3; ++i)
        farthest = fmax(farthest, double3_distance(triangle->corners[i], c));
    return fmax(triangle_distance(triangle->corners, c) - sphere->radius,
                sphere->radius - farthest);
}

static double sphere_to_sphere(const struct surface *a, const struct surface *b)
{
    double d = double3_distance(a->corners[0], b->corners[0]);
    return fmax(d - a->radius - b->radius, fabs(a->radius - b->radius) - d);
}

static double box_to_box(const struct surface *a, const struct surface *b)
{
    double d2 = 0.0;
    for (int k = 0; k < 3; ++k) {
        double apart = fmax(fmax(a->lo[k] - b->hi[k], b->lo[k] - a->hi[k]), 0.0);
        d2 += apart * apart;
    }
    return sqrt(d2);
}

/* A lower bound of the distance between two surfaces; for two triangles, the distance of their
   boxes. */
static double surface_distance(const struct bodies *bodies, const struct surface *a,
                               const struct surface *b)
{
    double rounding = bodies->all[a->body].rounding + bodies->all[b->body].rounding;
    double boxes = box_to_box(a, b);
    if (a->vague || b->vague || (!a->round && !b->round))
        return boxes;
    double exact = a->round && b->round ? sphere_to_sphere(a, b)
                   : a->round           ? sphere_to_triangle(a, b)
                                        : sphere_to_triangle(b, a);
    return fmax(boxes, exact - rounding);
}

/* ---- Surfaces of bodies ---- */

static void set_box(struct surface *s, double rounding)
{
    double3_no_box(s->lo, s->hi);
    for (int i = 0; i < 3; ++i)
        double3_grow_box(s->lo, s->hi, s->corners[i]);
    for (int k = 0; k < 3; ++k) {
        s->lo[k] -= rounding;
        s->hi[k] += rounding;
    }
}

/* The factor by which the transform scales all lengths; 0: it does not scale uniformly. */
static double scale_of(const struct affine *placed)
{
    const double *m = placed->m;
    double dots[3][3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            dots[i][k] = m[i] * m[k] + m[4 + i] * m[4 + k] + m[8 + i] * m[8 + k];
    double first = dots[0][0];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            if (!(fabs(dots[i][k] - (i == k ? first : 0.0)) <= 1e-6 * first))
                return 0.0;
    return sqrt(first);
}

static struct surface sphere_of(const struct scene *scene, const struct scene_pose *pose,
                                const struct bodies *bodies, uint32_t index)
{
    const struct body *body = &bodies->all[index];
    const float *sphere =
        scene->meshes[scene->instances[body->instance].mesh].spheres + 4 * (size_t)body->sphere;
    const struct affine *placed = &pose->instances[body->instance];
    double scale = scale_of(placed);
    struct surface out = {.body = index, .round = true, .vague = !(scale > 0.0)};
    affine_point(placed, (const double[3]){sphere[0], sphere[1], sphere[2]}, out.corners[0]);
    out.radius = (double)sphere[3] * scale;
    memcpy(out.lo, body->lo, sizeof out.lo);
    memcpy(out.hi, body->hi, sizeof out.hi);
    return out;
}

static bool boxes_meet(const double *alo, const double *ahi, const double *blo, const double *bhi,
                       double within)
{
    for (int k = 0; k < 3; ++k) {
        if (alo[k] > bhi[k] + within || blo[k] > ahi[k] + within)
            return false;
    }
    return true;
}

/* For a body: the box around all other bodies that come near it. */
struct near {
    double lo[3], hi[3];
};

static void near_add(struct near *near, const struct body *other)
{
    double3_grow_box(near->lo, near->hi, other->lo);
    double3_grow_box(near->lo, near->hi, other->hi);
}

/* Adds the triangles of one instance that lie within `within` of the `near` box of their body. */
static bool add_triangles(const struct scene *scene, const struct scene_pose *pose,
                          const struct bodies *bodies, const struct near *nears, uint32_t first,
                          uint32_t end, double within, struct surfaces *out)
{
    uint32_t instance = bodies->all[first].instance, body = first;
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        uint32_t material = mesh->materials[t];
        if (bodies->all[body].material != material)
            for (body = first; body < end && bodies->all[body].material != material;)
                ++body;
        if (body == end) {
            body = first;
            continue;
        }
        struct surface s = {.body = body};
        for (size_t k = 0; k < 3; ++k) {
            const float *p = &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)t + k]];
            affine_point(&pose->instances[instance], (const double[3]){p[0], p[1], p[2]},
                         s.corners[k]);
        }
        set_box(&s, bodies->all[body].rounding);
        if (boxes_meet(s.lo, s.hi, nears[body].lo, nears[body].hi, within) &&
            !ARRAY_PUSH(out->all, out->count, out->capacity, s))
            return false;
    }
    return true;
}

static bool add_surfaces(const struct scene *scene, const struct scene_pose *pose,
                         const struct bodies *bodies, const struct near *nears, double within,
                         struct surfaces *out)
{
    for (uint32_t first = 0, end; first < bodies->count; first = end) {
        bool any = false;
        const struct body *body = &bodies->all[first];
        for (end = first; end < bodies->count && bodies->all[end].instance == body->instance &&
                          bodies->all[end].sphere == SCENE_NONE;
             ++end)
            any |= nears[end].lo[0] <= nears[end].hi[0];
        if (any && !add_triangles(scene, pose, bodies, nears, first, end, within, out))
            return false;
        if (end > first)
            continue;
        end = first + 1; /* a sphere */
        if (nears[first].lo[0] <= nears[first].hi[0] &&
            !ARRAY_PUSH(out->all, out->count, out->capacity, sphere_of(scene, pose, bodies, first)))
            return false;
    }
    return true;
}

/* ---- Which come near ---- */

static int by_low_x(const void *a, const void *b)
{
    double x = ((const struct surface *)a)->lo[0], y = ((const struct surface *)b)->lo[0];
    return (x > y) - (x < y);
}

/* The smallest distance between surfaces of two different bodies, not both spheres, or `gap` if
   that is less; 0 where more than PAIRS_MAX pairs would have to be compared. */
static double sweep_surfaces(const struct bodies *bodies, const struct surfaces *surfaces,
                             double gap)
{
    uint32_t pairs = 0;
    if (surfaces->count > 1)
        qsort(surfaces->all, surfaces->count, sizeof *surfaces->all, by_low_x);
    for (uint32_t i = 0; i < surfaces->count && gap > 0.0; ++i) {
        const struct surface *a = &surfaces->all[i];
        for (uint32_t j = i + 1; j < surfaces->count && gap > 0.0; ++j) {
            const struct surface *b = &surfaces->all[j];
            if (b->lo[0] > a->hi[0] + gap)
                break;
            if (++pairs > PAIRS_MAX)
                return 0.0;
            if (a->body != b->body && !(a->round && b->round) &&
                boxes_meet(a->lo, a->hi, b->lo, b->hi, gap))
                gap = fmin(gap, fmax(surface_distance(bodies, a, b), 0.0));
        }
    }
    return gap;
}

struct ranked {
    double lo;
    uint32_t body;
};

static int by_lo(const void *a, const void *b)
{
    double x = ((const struct ranked *)a)->lo, y = ((const struct ranked *)b)->lo;
    return (x > y) - (x < y);
}

/* As sweep_surfaces, but only for pairs of spheres. Other pairs of bodies that come near to each
   other are noted in `nears`. */
static double sweep_bodies(const struct scene *scene, const struct scene_pose *pose,
                           const struct bodies *bodies, struct ranked *ranked, double gap,
                           struct near *nears, bool *any)
{
    uint32_t pairs = 0;
    double within = gap;
    for (uint32_t i = 0; i < bodies->count; ++i)
        ranked[i] = (struct ranked){bodies->all[i].lo[0], i};
    qsort(ranked, bodies->count, sizeof *ranked, by_lo);
    for (uint32_t i = 0; i < bodies->count && gap > 0.0; ++i) {
        const struct body *a = &bodies->all[ranked[i].body];
        for (uint32_t j = i + 1; j < bodies->count && gap > 0.0; ++j) {
            const struct body *b = &bodies->all[ranked[j].body];
            if (b->lo[0] > a->hi[0] + within)
                break;
            if (++pairs > PAIRS_MAX)
                return 0.0;
            if (!boxes_meet(a->lo, a->hi, b->lo, b->hi, within))
                continue;
            if (a->sphere != SCENE_NONE && b->sphere != SCENE_NONE) {
                struct surface sa = sphere_of(scene, pose, bodies, ranked[i].body);
                struct surface sb = sphere_of(scene, pose, bodies, ranked[j].body);
                gap = fmin(gap, fmax(surface_distance(bodies, &sa, &sb), 0.0));
            } else {
                near_add(&nears[ranked[i].body], b);
                near_add(&nears[ranked[j].body], a);
                *any = true;
            }
        }
    }
    return gap;
}

static double search(const struct scene *scene, const struct scene_pose *pose,
                     const struct bodies *bodies, double within)
{
    struct near *nears = array_alloc(bodies->count, sizeof *nears);
    struct ranked *ranked = array_alloc(bodies->count, sizeof *ranked);
    struct surfaces surfaces = {0};
    bool fine = nears && ranked, any = false;
    double gap = 0.0;
    for (uint32_t i = 0; fine && i < bodies->count; ++i)
        double3_no_box(nears[i].lo, nears[i].hi);
    if (fine)
        gap = sweep_bodies(scene, pose, bodies, ranked, within, nears, &any);
    if (fine && any && gap > 0.0)
        gap = add_surfaces(scene, pose, bodies, nears, within, &surfaces)
                  ? sweep_surfaces(bodies, &surfaces, gap)
                  : 0.0;
    free(surfaces.all);
    free(ranked);
    free(nears);
    return gap;
}

bool bodies_come_within(const struct scene *scene, const struct scene_pose *pose,
                        struct bodies *bodies, double distance_max)
{
    /* Searches farther than needed, so that a camera that moves away needs no new search for each
       picture. */
    const double room = 4.0;
    if (bodies->count < 2)
        return false;
    if (bodies->gap > 0.0 || bodies->searched == 0.0) {
        if (!(distance_max < bodies->searched)) {
            bodies->searched = room * distance_max;
            bodies->gap = search(scene, pose, bodies, bodies->searched);
        }
    }
    return !(bodies->gap > distance_max);
}
