/* Shared by the files of accel/ that work on a whole scene. */
#ifndef ACCEL_ACCEL_INSIDE_H
#define ACCEL_ACCEL_INSIDE_H

#include <math.h>

#include "accel/accel.h"
#include "base/vec.h"

/* Exact: minima and maxima of floats, nothing rounded. */
static inline struct bvh_box accel_triangle_box(const float a[3], const float b[3],
                                                const float c[3])
{
    struct bvh_box box;
    for (int i = 0; i < 3; ++i) {
        float lo = a[i] < b[i] ? a[i] : b[i], hi = a[i] > b[i] ? a[i] : b[i];
        box.lo[i] = c[i] < lo ? c[i] : lo;
        box.hi[i] = c[i] > hi ? c[i] : hi;
    }
    return box;
}

/* sphere_box of shaders/lib/sphere.glsl, bit for bit: what the test of a sphere looks at, so boxes
   of nodes hold no less. */
static inline struct bvh_box accel_sphere_box(const float center[3], float radius)
{
    struct bvh_box box;
    for (int i = 0; i < 3; ++i) {
        float margin = (fabsf(center[i]) + radius) * (1.0f / 4194304.0f);
        box.lo[i] = (center[i] - radius) - margin;
        box.hi[i] = (center[i] + radius) + margin;
    }
    return box;
}

static inline struct bvh_box accel_record_box(const struct gpu_triangle *record)
{
    if (record->flags & TRIANGLE_SPHERE)
        return accel_sphere_box(record->v0, record->v1[0]);
    return accel_triangle_box(record->v0, record->v1, record->v2);
}

static inline struct bvh_box accel_primitive_box(const struct scene_mesh *mesh, uint32_t primitive)
{
    if (mesh->sphere_count) {
        const float *sphere = &mesh->spheres[4 * (size_t)primitive];
        return accel_sphere_box(sphere, sphere[3]);
    }
    const uint32_t *corner = &mesh->indices[3 * (size_t)primitive];
    return accel_triangle_box(&mesh->positions[3 * (size_t)corner[0]],
                              &mesh->positions[3 * (size_t)corner[1]],
                              &mesh->positions[3 * (size_t)corner[2]]);
}

static inline uint32_t accel_node_ref(const struct gpu_bvh_node *node)
{
    return bvh_count(node) << BVH_COUNT_SHIFT | node->first;
}

/* A box under an affine map, row-major 3x4 in double. `size` bounds the magnitudes that enter the
   sums, which is what rounding them is relative to. */
struct accel_extent {
    double lo[3], hi[3], size[3];
};

struct accel_extent accel_transformed_box(const double rows[12], const struct bvh_box *box);

/* ---- Rays of the float twin ---- */

/* Finite, and with a direction: all others hit nothing. */
static inline bool accel_ray_is_usable(const struct gpu_ray *ray)
{
    struct vec3 o = vec3_load(ray->origin), d = vec3_load(ray->dir);
    struct vec3 bounded = vec3_add(vec3_sub(o, o), vec3_sub(d, d)); /* 0, or NaN */
    return bounded.x + bounded.y + bounded.z == 0.0f && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f);
}

static inline struct vec3 accel_rotate_rows(const float *r0, const float *r1, const float *r2,
                                            struct vec3 p)
{
    return vec3_make((r0[0] * p.x + r0[1] * p.y) + r0[2] * p.z,
                     (r1[0] * p.x + r1[1] * p.y) + r1[2] * p.z,
                     (r2[0] * p.x + r2[1] * p.y) + r2[2] * p.z);
}

/* The ray in an instance's object space, in floats: their roundings are what the float twin and the
   shaders have, so they belong to the ray that every answer is about. */
static inline struct gpu_ray accel_local_ray(const struct gpu_instance *instance,
                                             const struct gpu_ray *ray)
{
    const float *r0 = instance->inverse0, *r1 = instance->inverse1, *r2 = instance->inverse2;
    struct vec3 origin = vec3_make(instance->origin_x, instance->origin_y, instance->origin_z);
    struct vec3 relative = vec3_sub(vec3_load(ray->origin), origin);
    struct gpu_ray local = {.t_min = ray->t_min, .t_max = ray->t_max};
    vec3_store(local.origin, accel_rotate_rows(r0, r1, r2, relative));
    vec3_store(local.dir, accel_rotate_rows(r0, r1, r2, vec3_load(ray->dir)));
    return local;
}

/* ---- material_bits.c ---- */

/* What a material means to traversal. */
struct material_bits {
    uint32_t flags, shadow;
    bool masked;    /* SCENE_ALPHA_MASK: colours of vertices may cut it out */
    bool patterned; /* a filter that textures or vertex colours have a say in */
};

/* One for each material of the scene. */
void material_bits_scan(const struct scene *scene, struct material_bits *out);
/* Filters add to a shadow ray's depth each time they are met: they are met once. 1 a triangle. */
void material_bits_whole(const struct scene *scene, const struct material_bits *materials,
                         const struct scene_mesh *mesh, uint8_t *whole);
struct gpu_triangle material_bits_record(const struct scene *scene,
                                         const struct material_bits *materials,
                                         const struct scene_mesh *mesh, uint32_t primitive);

/* ---- flat.c: accel->world ---- */

enum { FLAT_TRIANGLE_BYTES = 300 }; /* at the peak of a build: corners, boxes, builder, records */
#define FLAT_TRIANGLES_MAX  (BVH_FIRST_MASK / 2)
#define FLAT_VERTICES_MAX   (UINT32_MAX / 4)
#define FLAT_INSTANCES_MAX  (UINT32_MAX >> TRIANGLE_INSTANCE_SHIFT)
#define FLAT_COORDINATE_MAX 1e18 /* as scene_freeze has it in object space */

/* The centre stands for a sphere's vertices. */
static inline uint32_t accel_flat_vertices(const struct scene_mesh *mesh)
{
    return mesh->sphere_count ? mesh->sphere_count : mesh->vertex_count;
}

/* Whether spheres under it are spheres that are not turned (flat_choice.c). */
bool accel_flat_keeps_spheres(const struct affine *forward);

/* Prepares one tree over all triangles instead of mesh trees; it is built with the first pose. */
WHIT_CHECK whit_result accel_flat_create(struct accel *accel);
/* Builds that tree for `pose` as accel->meshes[0]; keeps the present one where no instance has
   moved. Changes nothing on failure. */
WHIT_CHECK whit_result accel_flat_build(struct accel *accel, const struct scene_pose *pose);
void accel_flat_destroy(struct accel_flat *flat);
/* The meshes of the scene; only triangle_count and shade_base are set. */
const struct accel_mesh *accel_flat_meshes(const struct accel_flat *flat);
/* Number of an instance's primitive 0 among all triangles. */
uint32_t accel_flat_first(const struct accel_flat *flat, uint32_t instance);

/* pose.c */
void accel_posing_destroy(struct accel_posing *posing);

/* Checks a tree of valid structure: sample points all over each primitive must lie in the leaves
   that hold it, and all its records must be equal (bvh_validate_parts.c). `primitive` gives the
   primitive of the record in a slot of `triangles`. */
WHIT_CHECK whit_result accel_validate_parts(const struct log *log, const char *name,
                                            const struct gpu_bvh_node *nodes, uint32_t node_count,
                                            const struct gpu_triangle *triangles,
                                            uint32_t primitive_count,
                                            uint32_t (*primitive)(const void *user, uint32_t slot),
                                            const void *user);

#endif
