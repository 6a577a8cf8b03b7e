/* How much light reaches what the camera sees. Some files have lights that light nothing of it
   (headlights that are emissive surfaces, a sun over a closed box), or lights that burn it out. A
   few camera rays, and shadow rays from their hits, are tested against every triangle, since there
   are no trees yet. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/color.h"
#include "base/same.h"
#include "base/vec.h"
#include "scene/exposure.h"
#include "scene/lit.h"
#include "scene/pose.h"

/* Number of camera rays: as many as TESTS_MAX tests of triangles allow, within these bounds. */
enum { RAYS_MAX = FREEZE_SEEN_MAX, RAYS_MIN = 32 };
static const double TESTS_MAX = 2e7;
/* A point counts as lit if a white surface there is at least this bright (1: white). */
static const double LIT = 0.02;
/* Shadow rays start off the surface by this share of the distance to the eye, towards the eye. */
static const double OFFSET = 1e-3;
/* At most this many lights are traced from a point; their visible share stands for all lights. */
enum { LIGHTS_ASKED = 4 };

/* The scene at time 0; inverses: world to object for each instance. */
struct posed {
    const struct scene *scene;
    struct scene_pose pose;
    struct affine *inverses;
};

struct ray {
    double origin[3], dir[3]; /* t counts in lengths of `dir` */
    double t_max;
};
struct hit {
    double t, u, v, normal[3]; /* u, v: barycentric weights of corners 1 and 2; normal: in world */
    double at[3];              /* point hit by a camera ray, in world space */
    const struct scene_mesh *mesh;
    uint32_t triangle;
    const struct scene_material *material;
};

/* Intersects a triangle in object space, on both sides: Moeller and Trumbore (1997). */
static bool meet(const struct scene_mesh *mesh, uint32_t triangle, const struct ray *ray,
                 struct hit *hit)
{
    double p[3][3], edges[2][3], from[3], across[3], turned[3];
    scene_mesh_corners(mesh, triangle, p);
    double3_sub(p[1], p[0], edges[0]);
    double3_sub(p[2], p[0], edges[1]);
    double3_sub(ray->origin, p[0], from);
    double3_cross(ray->dir, edges[1], across);
    double3_cross(from, edges[0], turned);
    double scale = double3_dot(edges[0], across);
    double u = double3_dot(from, across) / scale, v = double3_dot(ray->dir, turned) / scale;
    double t = double3_dot(edges[1], turned) / scale;
    if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < ray->t_max))
        return false;
    *hit = (struct hit){.t = t, .u = u, .v = v, .mesh = mesh, .triangle = triangle};
    double3_cross(edges[0], edges[1], hit->normal);
    return true;
}

/* The nearest texel of the texture in `slot` at the hit, white without one. Textures repeat here,
   whatever their wrap mode. */
static void pick_texel(const struct scene *scene, const struct hit *hit, enum scene_slot slot,
                       uint8_t rgba[4])
{
    const struct scene_texture_use *use = &hit->material->textures[slot];
    const float *uvs =
        hit->mesh->uvs[use->uv_set] ? hit->mesh->uvs[use->uv_set] : hit->mesh->uvs[0];
    const uint32_t *index = hit->mesh->indices + 3 * (size_t)hit->triangle;
    const double weights[3] = {1.0 - hit->u - hit->v, hit->u, hit->v};
    double uv[2] = {0.0, 0.0};
    uint32_t at[2];
    memset(rgba, 255, 4);
    if (use->texture == SCENE_NONE || !uvs || !scene->textures[use->texture].rgba)
        return;
    const struct scene_texture *texture = &scene->textures[use->texture];
    for (int k = 0; k < 3; ++k) {
        for (int i = 0; i < 2; ++i)
            uv[i] += weights[k] * (double)uvs[2 * (size_t)index[k] + (size_t)i];
    }
    for (int i = 0; i < 2; ++i) {
        const float *m = use->transform + 3 * i;
        double place = (double)m[0] * uv[0] + (double)m[1] * uv[1] + (double)m[2];
        double part = isfinite(place) ? place - floor(place) : 0.0;
        uint32_t size = i ? texture->height : texture->width, texel = (uint32_t)(part * size);
        at[i] = texel < size ? texel : size - 1;
    }
    memcpy(rgba, texture->rgba + 4 * ((size_t)at[1] * texture->width + at[0]), 4);
}

/* Whether all rays stop at a hit. They pass glass, and they pass points with an opacity below one
   half, or below the cutoff of a mask. A material that its file calls transparent may still be
   opaque at every point, since some exporters call all materials so. */
static bool is_solid(const struct scene *scene, const struct hit *hit)
{
    const struct scene_material *m = hit->material;
    uint8_t texel[4];
    if (m->alpha == SCENE_ALPHA_OPAQUE || !color_is_black(m->transmission))
        return color_is_black(m->transmission);
    double opacity = (double)m->opacity;
    if (m->textures[SCENE_SLOT_OPACITY].texture != SCENE_NONE) {
        pick_texel(scene, hit, SCENE_SLOT_OPACITY, texel);
        opacity *= (texel[3] < 255 ? texel[3] : texel[0]) / 255.0;
    } else {
        pick_texel(scene, hit, SCENE_SLOT_DIFFUSE, texel);
        opacity *= texel[3] / 255.0;
    }
    return opacity >= (m->alpha == SCENE_ALPHA_MASK ? (double)m->alpha_cutoff : 0.5);
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

/* Finds the nearest solid hit; with `any` only says whether there is one, and leaves *hit. */
static bool trace(const struct posed *posed, const struct ray *world, bool any, struct hit *hit)
{
    struct ray ray = *world;
    bool found = false;
    for (uint32_t i = 0; i < posed->pose.instance_count; ++i) {
        const struct scene_mesh *mesh = &posed->scene->meshes[posed->scene->instances[i].mesh];
        affine_point(&posed->inverses[i], world->origin, ray.origin);
        affine_vector(&posed->inverses[i], world->dir, ray.dir);
        if (!meets_box(mesh, &ray))
            continue;
        for (uint32_t k = 0; k < mesh->triangle_count; ++k) {
            struct hit own;
            if (!meet(mesh, k, &ray, &own))
                continue;
            own.material = &posed->scene->materials[mesh->materials[k]];
            if (!is_solid(posed->scene, &own))
                continue;
            found = true;
            if (any)
                return true;
            ray.t_max = own.t;
            *hit = own;
            /* Normals go to world space by the inverse transpose. */
            for (int c = 0; c < 3; ++c)
                hit->normal[c] = posed->inverses[i].m[c] * own.normal[0] +
                                 posed->inverses[i].m[4 + c] * own.normal[1] +
                                 posed->inverses[i].m[8 + c] * own.normal[2];
            double3_unit(hit->normal);
        }
    }
    return found;
}

/* Point `index` of a low-discrepancy sequence on a flat light; any other light's position. */
static void place_on(const struct scene_light *light, uint32_t index, double out[3])
{
    double u = fmod(0.5 + index * 0.7548776662466927, 1.0);
    double v = fmod(0.5 + index * 0.5698402909980532, 1.0);
    if (light->kind == WHIT_LIGHT_TRIANGLE && u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
    }
    for (int k = 0; k < 3; ++k)
        out[k] = light->position[k] +
                 (scene_light_is_flat(light) ? u * light->edge_u[k] + v * light->edge_v[k] : 0.0);
}

static bool reaches(const struct posed *posed, const struct scene_light *light,
                    const double point[3], uint32_t index)
{
    bool parallel = light->kind == WHIT_LIGHT_DIRECTIONAL;
    struct ray ray = {.t_max = parallel ? INFINITY : 1.0 - OFFSET};
    struct hit hit;
    double at[3];
    place_on(light, index, at);
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = point[k];
        ray.dir[k] = parallel ? -light->direction[k] : at[k] - point[k];
    }
    return !trace(posed, &ray, true, &hit);
}

/* Brightness is taken at the point that was hit, and not at `point`, which lies off the surface: an
   emissive surface that was hit must not light itself. */
static bool is_lit(const struct posed *posed, const double point[3], const struct hit *hit,
                   uint32_t index)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < posed->pose.light_count && sum < LIT; ++i) {
        double brightness = freeze_brightness(&posed->pose.lights[i], hit->at, hit->normal);
        if (brightness > 0.1 * LIT && reaches(posed, &posed->pose.lights[i], point, index))
            sum += brightness;
    }
    return sum >= LIT;
}

/* Camera ray `index` of `count`, spread evenly over a picture with aspect 4:3. */
static struct ray look(const struct scene_camera *camera, uint32_t index, uint32_t count)
{
    double x = 2.0 * fmod((index + 0.5) * 0.6180339887498949, 1.0) - 1.0;
    double y = 1.0 - 2.0 * (index + 0.5) / count;
    double forward[3], right[3], up[3], tall;
    bool parallel = camera->kind == WHIT_CAMERA_ORTHOGRAPHIC;
    struct ray ray = {.t_max = INFINITY};
    scene_camera_axes(camera, forward, right, up);
    tall = parallel ? 0.5 * (double)camera->height : same_tan(0.5 * (double)camera->fov_y);
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

/* Traces camera ray `index`: its hit, and the `point` a little before it. False: it hits
   nothing. */
static bool see(const struct posed *posed, uint32_t index, uint32_t count, struct hit *hit,
                double point[3])
{
    struct ray ray = look(&posed->pose.cameras[0], index, count);
    if (!trace(posed, &ray, false, hit))
        return false;
    for (int k = 0; k < 3; ++k) {
        hit->at[k] = ray.origin[k] + hit->t * ray.dir[k];
        point[k] = ray.origin[k] + (1.0 - OFFSET) * hit->t * ray.dir[k];
    }
    return true;
}

/* ---- How bright what is seen is ---- */

/* The brightest channel of `rgb` times the texture in `slot`. */
static double shine(const struct scene *scene, const struct hit *hit, const float rgb[3],
                    enum scene_slot slot)
{
    uint8_t texel[4];
    double most = 0.0;
    pick_texel(scene, hit, slot, texel);
    for (int c = 0; c < 3; ++c)
        most = fmax(most, (double)rgb[c] * linear_from_srgb(texel[c] / 255.0));
    return most;
}

/* Whether a surface is a lamp: what it emits is at least as bright as its own colour in white
   light. A surface that emits less shows its shape only where light reaches it. */
static bool glows(const struct scene *scene, const struct hit *hit)
{
    double own = shine(scene, hit, hit->material->emission, SCENE_SLOT_EMISSION);
    return own > 0.0 && own >= shine(scene, hit, hit->material->diffuse, SCENE_SLOT_DIFFUSE);
}

static double measure_share(const struct posed *posed)
{
    uint32_t count = ray_count(posed->scene), seen = 0, lit = 0;
    for (uint32_t i = 0; i < count; ++i) {
        struct hit hit;
        double point[3];
        if (!see(posed, i, count, &hit, point) || glows(posed->scene, &hit))
            continue;
        ++seen;
        lit += is_lit(posed, point, &hit, i);
    }
    return seen ? (double)lit / seen : 1.0;
}

/* Whether a surface shows mostly its surroundings instead of its own colour. */
static bool is_mirror(const struct scene *scene, const struct hit *hit)
{
    const struct scene_material *m = hit->material;
    uint8_t texel[4];
    pick_texel(scene, hit, SCENE_SLOT_METAL_ROUGH, texel);
    return (m->model == WHIT_MODEL_METAL_ROUGH && (double)m->metallic * texel[2] > 127.0) ||
           m->reflection[0] > 0.5f || m->reflection[1] > 0.5f || m->reflection[2] > 0.5f;
}

/* Brightness of a white surface at `point`. With `shadows` every step-th light, starting with
   another one at each point, is tested for visibility, and the sum is scaled by the visible
   share. */
static double light_at(const struct posed *posed, const double point[3], const struct hit *hit,
                       uint32_t index, bool shadows)
{
    uint32_t step = (posed->pose.light_count + LIGHTS_ASKED - 1) / LIGHTS_ASKED;
    double sum = 0.0, asked = 0.0, reached = 0.0;
    for (uint32_t i = 0; i < posed->pose.light_count; ++i) {
        double brightness = freeze_brightness(&posed->pose.lights[i], hit->at, hit->normal);
        sum += brightness;
        if (!shadows || !(brightness > 0.0) || (i + index) % step != 0)
            continue;
        asked += brightness;
        if (reaches(posed, &posed->pose.lights[i], point, index))
            reached += brightness;
    }
    return asked > 0.0 ? sum * (reached / asked) : sum;
}

static void measure_seen(const struct posed *posed, bool shadows, struct freeze_seen *seen)
{
    uint32_t count = ray_count(posed->scene);
    double ambient = fmax(fmax((double)posed->scene->ambient[0], (double)posed->scene->ambient[1]),
                          (double)posed->scene->ambient[2]);
    for (uint32_t i = 0; i < count; ++i) {
        struct hit hit;
        double point[3];
        if (!see(posed, i, count, &hit, point) || is_mirror(posed->scene, &hit))
            continue;
        double own = shine(posed->scene, &hit, hit.material->emission, SCENE_SLOT_EMISSION);
        double light = hit.material->model == WHIT_MODEL_UNLIT
                           ? 1.0
                           : light_at(posed, point, &hit, i, shadows) + ambient;
        double color = shine(posed->scene, &hit, hit.material->diffuse, SCENE_SLOT_DIFFUSE);
        seen->shown[seen->count] = own + light * color;
        seen->white[seen->count++] = own + light;
    }
}

/* ---- The first camera ---- */

/* Poses the scene at time 0. *usable: light can be measured; false: no camera, a panorama, or a
   matrix without an inverse. Release with finish(), also where it failed. */
static whit_result begin(const struct scene *scene, struct posed *posed, bool *usable)
{
    *posed = (struct posed){.scene = scene};
    *usable = false;
    whit_result result = scene_pose_init(scene, 0.0, &posed->pose);
    if (result != WHIT_OK)
        return result;
    const struct scene_pose *pose = &posed->pose;
    posed->inverses = array_alloc(pose->instance_count, sizeof *posed->inverses);
    if (!posed->inverses)
        return WHIT_ERROR_MEMORY;
    *usable = pose->camera_count && pose->cameras[0].kind != WHIT_CAMERA_PANORAMA;
    for (uint32_t i = 0; *usable && i < pose->instance_count; ++i)
        *usable = affine_invert(&pose->instances[i], &posed->inverses[i]);
    return WHIT_OK;
}

static void finish(struct posed *posed)
{
    free(posed->inverses);
    scene_pose_finish(&posed->pose);
}

whit_result freeze_lit_share(const struct scene *scene, double *share)
{
    struct posed posed;
    bool usable;
    whit_result result = begin(scene, &posed, &usable);
    *share = usable ? measure_share(&posed) : 1.0;
    finish(&posed);
    return result;
}

whit_result freeze_see(const struct scene *scene, bool shadows, struct freeze_seen *seen)
{
    struct posed posed;
    bool usable;
    whit_result result = begin(scene, &posed, &usable);
    seen->count = 0;
    if (usable)
        measure_seen(&posed, shadows, seen);
    finish(&posed);
    return result;
}
