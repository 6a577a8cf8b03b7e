/* How bright emissive surfaces light the rest. Files state emission in whatever unit their
   program's camera was set to (a lamp of 1 that should fill a hall, or one of 17 in a box), so
   lights made of them are scaled until what they light best comes out bright, and not burnt out. */
#include <math.h>
#include <string.h>

#include "base/color.h"
#include "base/file.h"
#include "base/same.h"
#include "base/sample.h"
#include "base/vec.h"
#include "scene/exposure.h"
#include "scene/lit.h"
#include "scene/pose.h"

#define PROBES     1024
/* Lights are scaled so that SHARE of the probed surface area would be at most BRIGHTNESS bright if
   it were white. */
#define SHARE      0.9
#define BRIGHTNESS 0.8
/* Stated lights are scaled only where that brightness is below MIN or above MAX. */
#define MIN        0.02
#define MAX        2.0
/* A model's exposure changes only where less than SHARE of what is seen is at most 1, or where
   SHARE of it would be below BLACK if it were white. Lowering it keeps half of what is seen above
   LOW. */
#define BLACK      0.02
#define LOW        0.03
#define EV_MAX     32.0

struct probe_list {
    double values[PROBES];
    uint32_t count;
};

/* Gives a triangle's area in world space, with its corner, edges and unit normal; 0 for an emissive
   one, which counts as a lamp and not as a receiver. */
static double receiver(const struct scene *scene, const struct scene_pose *pose, uint32_t instance,
                       uint32_t triangle, double corner[3], double edges[2][3], double normal[3])
{
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    if (color_luminance(scene->materials[mesh->materials[triangle]].emission) > 0.0)
        return 0.0;
    double p[3][3];
    scene_mesh_placed_corners(mesh, triangle, &pose->instances[instance], p);
    memcpy(corner, p[0], sizeof p[0]);
    double3_sub(p[1], p[0], edges[0]);
    double3_sub(p[2], p[0], edges[1]);
    double3_cross(edges[0], edges[1], normal);
    double length = double3_length(normal);
    double3_unit(normal);
    return isfinite(length) ? 0.5 * length : 0.0;
}

/* Irradiance from a light that is not flat, before the surface's cosine and without shadows, as the
   shader computes it. `way`: unit direction in which the light travels. */
static double arriving(const struct scene_light *light, const double way[3], double distance)
{
    double value = color_luminance(light->color), along = double3_dot(way, light->direction);
    if (light->kind == WHIT_LIGHT_DIRECTIONAL)
        return value;
    if (light->falloff)
        value /= distance * distance;
    if (light->kind == WHIT_LIGHT_AREA_SAMPLE)
        value *= light->two_sided ? fabs(along) : fmax(along, 0.0);
    if (light->kind == WHIT_LIGHT_SPOT && 1.0 - along > (double)light->versine_outer)
        value = 0.0;
    return value * scene_light_fade(light, distance);
}

/* Brightness by a flat emitter, with the surface's cosine and without shadows: the sum over cells
   of a grid on its parallelogram, of which a triangle covers half. */
static double brightness_of_emitter(const struct scene_light *light, const double point[3],
                                    const double normal[3])
{
    enum { GRID = 4 };
    bool triangle = light->kind == WHIT_LIGHT_TRIANGLE;
    double sum = 0.0;
    const double *u = light->edge_u, *v = light->edge_v;
    double area = double3_area(u, v) / (GRID * GRID);
    for (int cell = 0; cell < GRID * GRID; ++cell) {
        double s = (cell % GRID + 0.5) / GRID, t = (cell / GRID + 0.5) / GRID, way[3];
        double share = !triangle || s + t < 1.0 ? 1.0 : s + t > 1.0 ? 0.0 : 0.5;
        for (int i = 0; i < 3; ++i)
            way[i] = point[i] - light->position[i] - s * u[i] - t * v[i];
        double square = double3_dot(way, way), distance = sqrt(square);
        double away = distance > 0.0 ? double3_dot(way, light->direction) / distance : 0.0;
        away = light->two_sided ? fabs(away) : fmax(away, 0.0);
        if (distance > 0.0)
            sum += share * away * fabs(double3_dot(way, normal)) / (distance * square);
    }
    return color_luminance(light->color) * area / PI * sum;
}

double freeze_brightness(const struct scene_light *light, const double point[3],
                         const double normal[3])
{
    double way[3];
    if (scene_light_is_flat(light))
        return brightness_of_emitter(light, point, normal);
    for (int k = 0; k < 3; ++k)
        way[k] = light->kind == WHIT_LIGHT_DIRECTIONAL ? light->direction[k]
                                                       : point[k] - light->position[k];
    double distance = double3_length(way);
    double3_unit(way);
    return distance > 0.0 ? arriving(light, way, distance) * fabs(double3_dot(way, normal)) : 0.0;
}

static double brightness_at(const struct scene_pose *pose, const double point[3],
                            const double normal[3])
{
    double sum = 0.0;
    for (uint32_t i = 0; i < pose->light_count; ++i)
        sum += freeze_brightness(&pose->lights[i], point, normal);
    return sum;
}

/* Probes an instance's surface at even steps of area, in the order of its triangles. `before`: area
   of all triangles so far. */
static void probe_instance(const struct scene *scene, const struct scene_pose *pose,
                           uint32_t instance, double step, double *before, struct probe_list *list)
{
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        double corner[3], edges[2][3], normal[3];
        double area = receiver(scene, pose, instance, t, corner, edges, normal);
        while (list->count < PROBES && (list->count + 0.5) * step < *before + area) {
            double s = ((list->count + 0.5) * step - *before) / area;
            double v = fmod(list->count * 0.6180339887498949, 1.0), root = sqrt(s), point[3];
            for (int i = 0; i < 3; ++i)
                point[i] = corner[i] + root * ((1.0 - v) * edges[0][i] + v * edges[1][i]);
            list->values[list->count++] = brightness_at(pose, point, normal);
        }
        *before += area;
    }
}

static double total_area(const struct scene *scene, const struct scene_pose *pose)
{
    double total = 0.0, corner[3], edges[2][3], normal[3];
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        for (uint32_t t = 0; t < mesh->triangle_count; ++t)
            total += receiver(scene, pose, i, t, corner, edges, normal);
    }
    return total;
}

/* Whether light or emission comes from a foreign model. Numbers in whit's own scene files (.json)
   are meant as they stand. */
static bool is_from_model(const struct scene_origin *origin)
{
    return origin->file && !path_is(origin->file, "json");
}

static bool all_from_models(const struct scene *scene, bool emitters)
{
    bool all = true;
    for (uint32_t i = 0; emitters && i < scene->material_count; ++i) {
        if (color_luminance(scene->materials[i].emission) > 0.0)
            all = all && is_from_model(&scene->materials[i].origin);
    }
    for (uint32_t i = 0; !emitters && i < scene->light_count; ++i)
        all = all && is_from_model(&scene->lights[i].origin);
    return all;
}

static double at_share(const double *sorted, uint32_t count, double share)
{
    return sorted[(uint32_t)(share * (count - 1))];
}

static whit_result measure(const struct scene *scene, double *bright)
{
    struct scene_pose pose;
    struct probe_list list = {.count = 0};
    whit_result result = scene_pose_init(scene, 0.0, &pose);
    if (result != WHIT_OK)
        return result;
    double area = total_area(scene, &pose), before = 0.0;
    for (uint32_t i = 0; area > 0.0 && isfinite(area) && i < scene->instance_count; ++i)
        probe_instance(scene, &pose, i, area / PROBES, &before, &list);
    scene_pose_finish(&pose);
    sample_sort(list.values, list.count);
    *bright = list.count ? at_share(list.values, list.count, SHARE) : 0.0;
    return WHIT_OK;
}

whit_result freeze_expose(struct scene *scene, bool emitters, double *factor)
{
    double bright = 0.0;
    *factor = 1.0;
    if (!all_from_models(scene, emitters))
        return WHIT_OK;
    whit_result result = measure(scene, &bright);
    if (result != WHIT_OK || !(bright > 0.0) || !isfinite(BRIGHTNESS / bright) ||
        (!emitters && bright >= MIN && bright <= MAX))
        return result;
    *factor = BRIGHTNESS / bright;
    for (uint32_t i = 0; i < scene->light_count; ++i) {
        float *color = scene->lights[i].color;
        for (int k = 0; k < 3; ++k)
            color[k] = (float)fmin(*factor * (double)color[k], 1e30);
    }
    return WHIT_OK;
}

/* ---- Exposure of a model ---- */

static double share_from(const double *sorted, uint32_t count, double value)
{
    uint32_t below = 0;
    while (below < count && sorted[below] < value)
        ++below;
    return (double)(count - below) / count;
}

/* Gives the exposure in EV, in half stops. Where too much is burnt out it is negative: as low as it
   takes for at most a tenth of what is seen to be above 1, but not so low that less than half is
   above LOW. Where nearly all would be black even if all surfaces were white it is positive. Else
   it is 0. */
static double exposure_of(struct freeze_seen *seen, double *burnt)
{
    sample_sort(seen->shown, seen->count);
    sample_sort(seen->white, seen->count);
    double bright = at_share(seen->shown, seen->count, SHARE), ev = 0.0;
    double middle = at_share(seen->shown, seen->count, 0.5);
    double white = at_share(seen->white, seen->count, SHARE);
    *burnt = share_from(seen->shown, seen->count, 1.0);
    if (bright > 1.0)
        ev = fmax(floor(-2.0 * same_log2(bright)) / 2.0,
                  fmin(ceil(2.0 * same_log2(LOW / middle)) / 2.0, 0.0));
    else if (white < BLACK && bright > 0.0)
        ev = floor(2.0 * same_log2(BRIGHTNESS / white)) / 2.0;
    return fmin(fmax(ev, -EV_MAX), EV_MAX);
}

/* Whether the scene has lights of its file, or lights made from its emissive surfaces. */
static bool has_own_light(const struct scene *scene)
{
    bool own = false;
    for (uint32_t i = 0; i < scene->light_count; ++i)
        own = own || !scene->lights[i].made_by_whit || scene_light_is_flat(&scene->lights[i]) ||
              scene->lights[i].kind == WHIT_LIGHT_AREA_SAMPLE;
    return own;
}

/* Without lights of the model's own there is nothing to choose, since those that whit adds suit the
   picture. Shadow rays are traced only where the picture would be too bright without shadows. */
whit_result freeze_choose_exposure(struct scene *scene)
{
    struct freeze_seen seen;
    double ev = 0.0, burnt;
    if (!scene->is_model || !has_own_light(scene))
        return WHIT_OK;
    whit_result result = freeze_see(scene, false, &seen);
    if (result == WHIT_OK && seen.count)
        ev = exposure_of(&seen, &burnt);
    if (ev < 0.0)
        result = freeze_see(scene, true, &seen);
    if (result != WHIT_OK || ev == 0.0)
        return result;
    scene->exposure_ev = exposure_of(&seen, &burnt);
    if (scene->exposure_ev < 0.0)
        scene_note(scene, SCENE_NOTE_INFO,
                   "%.0f %% of what is seen would be burnt out: `--exposure auto` is %g EV",
                   100.0 * burnt, scene->exposure_ev);
    else if (scene->exposure_ev > 0.0)
        scene_note(scene, SCENE_NOTE_INFO,
                   "what is seen would be black: `--exposure auto` is %g EV", scene->exposure_ev);
    return WHIT_OK;
}
