/* Rays that are the same on every machine: made on the CPU in double, without a random seed. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/bvh/study_rays.h"
#include "base/random.h"
#include "base/vec.h"
#include "whit/whit_program.h"

static whit_ray make_ray(struct dvec3 origin, struct dvec3 dir, double t_min, double t_max)
{
    return (whit_ray){
        .origin = {(float)origin.x, (float)origin.y, (float)origin.z},
        .t_min = (float)t_min,
        .dir = {(float)dir.x, (float)dir.y, (float)dir.z},
        .t_max = (float)t_max,
    };
}

static whit_result alloc_rays(struct study_rays *rays, uint32_t count)
{
    rays->rays = malloc((count ? count : 1) * sizeof *rays->rays);
    rays->count = count;
    return rays->rays ? WHIT_OK : cli_no_memory();
}

/* ---- Primary ---- */

/* The pixel of ray `i`: row by row, or by tiles of 8x8 pixels, and within a tile by 4x2 pixels, as
   a subgroup of 8 takes them. */
static void pixel_of(uint32_t i, uint32_t width, bool tiles, uint32_t *x, uint32_t *y)
{
    uint32_t across = width / 8, tile = i / 64, k = i % 64;
    *x = tiles ? tile % across * 8 + ((k & 3) | (k >> 1 & 4)) : i % width;
    *y = tiles ? tile / across * 8 + ((k >> 2 & 1) | (k >> 3 & 6)) : i / width;
}

whit_result study_camera_rays(const whit_scene *scene, uint32_t width, uint32_t height, bool tiles,
                              struct study_rays *rays)
{
    const whit_camera first = {0};
    whit_ray *rows = malloc((size_t)width * height * sizeof *rows);
    if (!rows)
        return cli_no_memory();
    whit_result result = whit_camera_rays(scene, &first, width, height, &cli_log, rows);
    if (result == WHIT_OK)
        result = alloc_rays(rays, width * height);
    for (uint32_t i = 0; result == WHIT_OK && i < rays->count; ++i) {
        uint32_t x, y;
        pixel_of(i, width, tiles, &x, &y);
        rays->rays[i] = rows[(size_t)y * width + x];
    }
    free(rows);
    return result;
}

whit_result study_primary_rays(struct study *study)
{
    uint32_t width = (uint32_t)sqrt((double)study->ray_count * 4.0 / 3.0);
    width = width ? width : 1;
    uint32_t height = study->ray_count / width ? study->ray_count / width : 1;
    return study_camera_rays(study->job.scene, width, height, false, &study->rays[STUDY_PRIMARY]);
}

/* ---- From hits ---- */

/* Offset of secondary rays from their surface, as a share of the ray's length or of the scene's
   size, so that it clears the surface in any unit. */
static const double LEAVE = 1e-4;

struct surface {
    struct dvec3 point, normal; /* on the side the ray came from */
};

static struct surface surface_at(const whit_ray *ray, const whit_hit *hit)
{
    const double origin[3] = {(double)ray->origin[0], (double)ray->origin[1],
                              (double)ray->origin[2]};
    const double along[3] = {(double)ray->dir[0], (double)ray->dir[1], (double)ray->dir[2]};
    const double across[3] = {(double)hit->ng[0], (double)hit->ng[1], (double)hit->ng[2]};
    struct dvec3 dir = dvec3_load(along), normal = dvec3_unit(dvec3_load(across));
    struct surface surface = {.point = dvec3_along(dvec3_load(origin), dir, (double)hit->t)};
    surface.normal =
        dvec3_along((struct dvec3){0, 0, 0}, normal, dvec3_dot(dir, normal) > 0.0 ? -1.0 : 1.0);
    return surface;
}

static whit_ray shadow_ray(const whit_scene *scene, const struct surface *surface, uint32_t light,
                           double size)
{
    whit_light_info info;
    whit_scene_get_light(scene, light, &info);
    if (info.kind == WHIT_LIGHT_DIRECTIONAL) {
        struct dvec3 dir = dvec3_unit(dvec3_load(info.direction));
        return make_ray(surface->point, dvec3_along((struct dvec3){0, 0, 0}, dir, -size), LEAVE,
                        INFINITY);
    }
    struct dvec3 dir = dvec3_along(dvec3_load(info.position), surface->point, -1.0);
    return make_ray(surface->point, dir, LEAVE, 1.0 - LEAVE);
}

double study_random(uint64_t index)
{
    uint64_t state = index * SPLITMIX64_STEP;
    return splitmix64_unit(&state);
}

static whit_ray diffuse_ray(const struct surface *surface, uint64_t index, double size)
{
    struct dvec3 n = surface->normal;
    struct dvec3 other = fabs(n.x) < 0.5 ? (struct dvec3){1, 0, 0} : (struct dvec3){0, 1, 0};
    struct dvec3 a = dvec3_unit(dvec3_cross(n, other)), b = dvec3_cross(n, a);
    double square = study_random(2 * index), angle = 2.0 * PI * study_random(2 * index + 1);
    struct dvec3 dir = dvec3_along((struct dvec3){0, 0, 0}, n, sqrt(1.0 - square) * size);
    dir = dvec3_along(dir, a, sqrt(square) * cos(angle) * size);
    dir = dvec3_along(dir, b, sqrt(square) * sin(angle) * size);
    return make_ray(surface->point, dir, LEAVE, INFINITY);
}

double study_scene_size(const whit_scene *scene)
{
    whit_scene_info info;
    whit_scene_get_info(scene, &info);
    struct dvec3 across = dvec3_along(dvec3_load(info.hi), dvec3_load(info.lo), -1.0);
    double size = sqrt(dvec3_dot(across, across));
    return info.hi[0] >= info.lo[0] && size > 0.0 ? size : 1.0;
}

whit_ray study_bounce_ray(const whit_ray *ray, const whit_hit *hit, uint64_t index, double size)
{
    struct surface surface = surface_at(ray, hit);
    return diffuse_ray(&surface, index, size);
}

whit_ray study_light_ray(const double light[3], const whit_ray *ray, const whit_hit *hit)
{
    struct surface surface = surface_at(ray, hit);
    struct dvec3 from = dvec3_load(light);
    return make_ray(from, dvec3_along(surface.point, from, -1.0), 0.0, 1.0 - LEAVE);
}

whit_result study_secondary_rays(struct study *study, const whit_hit *hits)
{
    const struct study_rays *primary = &study->rays[STUDY_PRIMARY];
    uint32_t hit_count = 0, done = 0;
    double size = study_scene_size(study->job.scene);
    whit_scene_info info;
    whit_scene_get_info(study->job.scene, &info);
    uint32_t light_count = info.light_count;
    for (uint32_t i = 0; i < primary->count; ++i)
        hit_count += hits[i].primitive != WHIT_NONE;
    if (hit_count == 0)
        return WHIT_OK;
    struct study_rays *shadow = &study->rays[STUDY_SHADOW], *diffuse = &study->rays[STUDY_DIFFUSE];
    whit_result result = alloc_rays(shadow, light_count ? primary->count : 0);
    if (result == WHIT_OK)
        result = alloc_rays(diffuse, primary->count);
    /* Makes as many secondary rays as there are primary ones, by going over the hits repeatedly. */
    for (uint32_t i = 0; result == WHIT_OK && done < primary->count; i = (i + 1) % primary->count) {
        if (hits[i].primitive == WHIT_NONE)
            continue;
        struct surface surface = surface_at(&primary->rays[i], &hits[i]);
        if (done < shadow->count)
            shadow->rays[done] = shadow_ray(study->job.scene, &surface, done % light_count, size);
        diffuse->rays[done] = diffuse_ray(&surface, done, size);
        ++done;
    }
    return result;
}
