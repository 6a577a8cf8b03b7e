/* Whether what is seen gets light. Files have lights that light nothing of it: headlights that are
   emissive surfaces, a sun over a closed box. Rays of a coarse picture, and rays from what they hit
   to the lights, are held against every triangle: there are no trees yet, and few rays are enough.
 */
#include <math.h>
#include <stdlib.h>

#include "base/vec.h"
#include "scene/freeze.h"

/* Rays of the picture; fewer where these tests of triangles are used up, but some. */
enum { RAYS_MAX = 256, RAYS_MIN = 32 };
static const double TESTS_MAX = 2e7;
/* What a white surface has to show, where a picture's white is 1. */
static const double LIT = 0.02;
/* Points are this share of their distance away from the surface, towards the eye. */
static const double OFFSET = 1e-3;

struct ray {
    double origin[3], dir[3]; /* t counts in lengths of `dir` */
    double t_max;
};
struct hit {
    double t, normal[3]; /* world */
    bool emits;
};

static bool is_black(const float rgb[3])
{
    return !(rgb[0] > 0.0f || rgb[1] > 0.0f || rgb[2] > 0.0f);
}

/* Glass and leaves let light through: they are left out, as if they were not there. */
static bool is_solid(const struct scene_material *m)
{
    return m->alpha == SCENE_ALPHA_OPAQUE && is_black(m->transmission);
}

/* Moeller and Trumbore (1997), in the space of the mesh, both sides. */
static double meet(const struct scene_mesh *mesh, uint32_t triangle, const struct ray *ray,
                   double normal[3])
{
    const uint32_t *index = mesh->indices + 3 * (size_t)triangle;
    double p[3][3], edges[2][3], from[3], across[3], turned[3];
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            p[i][k] = (double)mesh->positions[3 * (size_t)index[i] + (size_t)k];
    for (int k = 0; k < 3; ++k) {
        edges[0][k] = p[1][k] - p[0][k];
        edges[1][k] = p[2][k] - p[0][k];
        from[k] = ray->origin[k] - p[0][k];
    }
    double3_cross(ray->dir, edges[1], across);
    double3_cross(from, edges[0], turned);
    double3_cross(edges[0], edges[1], normal);
    double scale = double3_dot(edges[0], across);
    double u = double3_dot(from, across) / scale, v = double3_dot(ray->dir, turned) / scale;
    double t = double3_dot(edges[1], turned) / scale;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < ray->t_max ? t : INFINITY;
}

static bool meets_box(const struct scene_mesh *mesh, const struct ray *ray)
{
    double from = 0.0, to = ray->t_max;
    for (int k = 0; k < 3; ++k) {
        double a = ((double)mesh->lo[k] - ray->origin[k]) / ray->dir[k];
        double b = ((double)mesh->hi[k] - ray->origin[k]) / ray->dir[k];
        from = fmax(from, fmin(a, b));
        to = fmin(to, fmax(a, b));
    }
    return from <= to;
}

/* The nearest solid surface, or with `any` some; false: there is none. */
static bool trace(const struct scene *scene, const struct scene_pose *pose,
                  const struct affine *inverses, const struct ray *world, bool any, struct hit *hit)
{
    struct ray ray = *world;
    bool found = false;
    for (uint32_t i = 0; i < pose->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        affine_point(&inverses[i], world->origin, ray.origin);
        affine_vector(&inverses[i], world->dir, ray.dir);
        if (!meets_box(mesh, &ray))
            continue;
        for (uint32_t k = 0; k < mesh->triangle_count; ++k) {
            const struct scene_material *m = &scene->materials[mesh->materials[k]];
            double normal[3], t = is_solid(m) ? meet(mesh, k, &ray, normal) : INFINITY;
            if (!(t < ray.t_max))
                continue;
            found = true;
            if (any)
                return true;
            ray.t_max = hit->t = t;
            hit->emits = !is_black(m->emission);
            /* The transpose of the inverse turns normals. */
            for (int c = 0; c < 3; ++c)
                hit->normal[c] = inverses[i].m[c] * normal[0] + inverses[i].m[4 + c] * normal[1] +
                                 inverses[i].m[8 + c] * normal[2];
            double3_unit(hit->normal);
        }
    }
    return found;
}

/* Somewhere on the light; the more points there are, the more of it is looked at. */
static void place_on(const struct scene_light *light, uint32_t index, double out[3])
{
    double u = fmod(0.5 + index * 0.7548776662466927, 1.0);
    double v = fmod(0.5 + index * 0.5698402909980532, 1.0);
    if (light->kind == SCENE_LIGHT_TRIANGLE && u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    for (int k = 0; k < 3; ++k)
        out[k] = light->position[k] +
                 (scene_light_is_flat(light) ? u * light->edge_u[k] + v * light->edge_v[k] : 0.0);
}

static bool is_lit(const struct scene *scene, const struct scene_pose *pose,
                   const struct affine *inverses, const double point[3], const double normal[3],
                   uint32_t index)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < pose->light_count && sum < LIT; ++i) {
        const struct scene_light *light = &pose->lights[i];
        struct ray ray = {.t_max = 1.0 - OFFSET};
        struct hit hit;
        double brightness = freeze_brightness(light, point, normal), at[3];
        if (!(brightness > 0.1 * LIT))
            continue;
        place_on(light, index, at);
        for (int k = 0; k < 3; ++k) {
            ray.origin[k] = point[k];
            ray.dir[k] =
                light->kind == SCENE_LIGHT_DIRECTIONAL ? -light->direction[k] : at[k] - point[k];
        }
        if (light->kind == SCENE_LIGHT_DIRECTIONAL)
            ray.t_max = INFINITY;
        if (!trace(scene, pose, inverses, &ray, true, &hit))
            sum += brightness;
    }
    return sum >= LIT;
}

/* Through a pixel of a picture as wide as 4:3. */
static struct ray look(const struct scene_camera *camera, uint32_t index, uint32_t count)
{
    double x = 2.0 * fmod((index + 0.5) * 0.6180339887498949, 1.0) - 1.0;
    double y = 1.0 - 2.0 * (index + 0.5) / count;
    double forward[3], right[3], up[3], tall;
    bool parallel = camera->kind == SCENE_CAMERA_ORTHOGRAPHIC;
    struct ray ray = {.t_max = INFINITY};
    for (int k = 0; k < 3; ++k)
        forward[k] = camera->target[k] - camera->eye[k];
    double3_unit(forward);
    double3_cross(forward, camera->up, right);
    double3_unit(right);
    double3_cross(right, forward, up);
    tall = parallel ? 0.5 * (double)camera->height : tan(0.5 * (double)camera->fov_y);
    for (int k = 0; k < 3; ++k) {
        double aside = tall * (4.0 / 3.0 * x * right[k] + y * up[k]);
        ray.origin[k] = camera->eye[k] + (parallel ? aside : 0.0);
        ray.dir[k] = forward[k] + (parallel ? 0.0 : aside);
    }
    return ray;
}

static uint32_t ray_count(const struct scene *scene)
{
    double triangles = 1.0;
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        triangles += scene->meshes[scene->instances[i].mesh].triangle_count;
    return (uint32_t)fmin(fmax(TESTS_MAX / triangles, RAYS_MIN), RAYS_MAX);
}

static double measure(const struct scene *scene, const struct scene_pose *pose,
                      const struct affine *inverses)
{
    uint32_t count = ray_count(scene), seen = 0, lit = 0;
    for (uint32_t i = 0; i < count; ++i) {
        struct ray ray = look(&pose->cameras[0], i, count);
        struct hit hit;
        double point[3];
        if (!trace(scene, pose, inverses, &ray, false, &hit) || hit.emits)
            continue;
        for (int k = 0; k < 3; ++k)
            point[k] = ray.origin[k] + (1.0 - OFFSET) * hit.t * ray.dir[k];
        ++seen;
        lit += is_lit(scene, pose, inverses, point, hit.normal, i);
    }
    return seen ? (double)lit / seen : 1.0;
}

whit_result freeze_lit_share(const struct scene *scene, double *share)
{
    struct scene_pose pose;
    *share = 1.0;
    whit_result result = scene_pose_init(scene, 0.0, &pose);
    if (result != WHIT_OK)
        return result;
    struct affine *inverses = calloc(pose.instance_count + 1, sizeof *inverses);
    bool all = inverses && pose.camera_count && pose.cameras[0].kind != SCENE_CAMERA_PANORAMA;
    for (uint32_t i = 0; all && i < pose.instance_count; ++i)
        all = affine_invert(&pose.instances[i], &inverses[i]);
    if (all)
        *share = measure(scene, &pose, inverses);
    result = inverses ? WHIT_OK : WHIT_ERROR_MEMORY;
    free(inverses);
    scene_pose_finish(&pose);
    return result;
}
