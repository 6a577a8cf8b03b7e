#define _GNU_SOURCE
#include "appearance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double SHARE_MAX = 0.1, RELIEF_MIN = 2.0;
/* Of the longest side of its box: what is thinner is a board, which shows no relief. */
static const double FLAT = 0.1;

static whit_result read_ids(whit_renderer *renderer, const whit_image *color, whit_image **ids)
{
    whit_image_info a, b;
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_IDS, ids);
    if (result != WHIT_OK)
        return result;
    whit_image_get_info(color, &a);
    whit_image_get_info(*ids, &b);
    return a.width == b.width && a.height == b.height && b.channels == 2 ? WHIT_OK
                                                                         : WHIT_ERROR_USAGE;
}

static whit_result count_lost(const whit_image *color, const whit_image *ids,
                              struct appearance *out)
{
    whit_image_info info;
    whit_image_get_info(color, &info);
    size_t count = (size_t)info.width * info.height, seen = 0, burnt = 0, black = 0;
    uint8_t *rgba = malloc(4 * count);
    if (!rgba)
        return WHIT_ERROR_MEMORY;
    whit_image_display_bytes(color, rgba);
    for (size_t i = 0; i < count; ++i) {
        const uint8_t *p = rgba + 4 * i;
        if (whit_image_words(ids)[2 * i + 1] == WHIT_NONE)
            continue;
        ++seen;
        burnt += p[0] == 255 || p[1] == 255 || p[2] == 255;
        black += !p[0] && !p[1] && !p[2];
    }
    free(rgba);
    out->is_flat = seen == 0;
    out->burnt = seen ? (double)burnt / (double)seen : 0.0;
    out->black = seen ? (double)black / (double)seen : 0.0;
    return WHIT_OK;
}

/* ---- Clay ---- */

static bool write_triangle(void *user, const whit_triangle *triangle)
{
    const float *v = triangle->vertices;
    for (int k = 0; k < 9; k += 3)
        fprintf(user, "v %.9g %.9g %.9g\n", (double)v[k], (double)v[k + 1], (double)v[k + 2]);
    return fputs("f -3 -2 -1\n", user) >= 0;
}

enum { PATH_BYTES = 4096 };

/* An OBJ without materials, in the folder for temporary files; the caller removes it. `path` is
   empty where it could not be made. */
static whit_result write_clay(const whit_scene *scene, char path[PATH_BYTES])
{
    const char *folder = getenv("TMPDIR");
    int length = snprintf(path, PATH_BYTES, "%s/whit_clay_XXXXXX.obj", folder ? folder : "/tmp");
    int file = length < PATH_BYTES ? mkstemps(path, 4) : -1;
    FILE *stream = file < 0 ? NULL : fdopen(file, "w");
    if (!stream) {
        path[0] = '\0';
        return WHIT_ERROR_OUTPUT;
    }
    whit_result result = whit_scene_triangles(scene, 0.0, write_triangle, stream);
    return fclose(stream) == 0 ? result : WHIT_ERROR_OUTPUT;
}

static void keep_camera(const whit_scene *scene, whit_renderer_params *params)
{
    whit_camera_info info;
    whit_scene_get_camera(scene, 0, &info);
    params->exposure_ev = 0.0;
    params->soft_highlights = false;
    params->camera = (whit_camera){0};
    if (!(info.fov_y_degrees > 0.0))
        return;
    params->camera = (whit_camera){.own = true, .fov_y_degrees = info.fov_y_degrees};
    memcpy(params->camera.eye, info.eye, sizeof info.eye);
    memcpy(params->camera.target, info.target, sizeof info.target);
    memcpy(params->camera.up, info.up, sizeof info.up);
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of those from place `from` on, before place `to`. */
static double mean_of(const double *levels, double from, double to)
{
    double sum = 0.0;
    size_t first = (size_t)from, end = (size_t)ceil(to);
    for (size_t i = first; i < end; ++i)
        sum += levels[i];
    return sum / (double)(end - first);
}

static whit_result measure_relief(whit_renderer *renderer, struct appearance *out)
{
    whit_image *color = NULL, *ids = NULL;
    whit_image_info info;
    double *levels = NULL;
    size_t seen = 0;
    whit_result result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &color);
    if (result == WHIT_OK)
        result = read_ids(renderer, color, &ids);
    if (result == WHIT_OK) {
        whit_image_get_info(color, &info);
        levels = calloc((size_t)info.width * info.height, sizeof *levels);
        result = levels ? WHIT_OK : WHIT_ERROR_MEMORY;
    }
    for (size_t i = 0; result == WHIT_OK && i < (size_t)info.width * info.height; ++i) {
        const float *p = whit_image_floats(color) + info.channels * i;
        if (whit_image_words(ids)[2 * i + 1] != WHIT_NONE)
            levels[seen++] = 0.2126 * (double)p[0] + 0.7152 * (double)p[1] + 0.0722 * (double)p[2];
    }
    if (seen) {
        qsort(levels, seen, sizeof *levels, compare_numbers);
        out->relief = mean_of(levels, 0.9 * (double)seen, (double)seen) /
                      fmax(mean_of(levels, 0.0, 0.2 * (double)seen), 1e-6);
    }
    out->is_flat = out->is_flat || !seen;
    free(levels);
    whit_image_destroy(ids);
    whit_image_destroy(color);
    return result;
}

static whit_result draw_clay(whit_device *device, const char *path, whit_renderer_params *params,
                             struct appearance *out)
{
    whit_scene *clay = NULL;
    whit_accel *accel = NULL;
    whit_renderer *renderer = NULL;
    whit_result result = whit_scene_load(path, NULL, NULL, &clay);
    if (result == WHIT_OK)
        result = whit_accel_create(clay, NULL, &accel);
    if (result == WHIT_OK)
        result = whit_renderer_create(device, accel, params, &renderer);
    if (result == WHIT_OK)
        result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = measure_relief(renderer, out);
    whit_renderer_destroy(renderer);
    whit_accel_destroy(accel);
    whit_scene_destroy(clay);
    return result;
}

/* ---- All of it ---- */

static bool is_thin(const whit_scene *scene)
{
    whit_scene_info info;
    double longest = 0.0, shortest = INFINITY;
    whit_scene_get_info(scene, &info);
    for (int i = 0; i < 3; ++i) {
        longest = fmax(longest, info.hi[i] - info.lo[i]);
        shortest = fmin(shortest, info.hi[i] - info.lo[i]);
    }
    return info.triangle_count == 0 || !(shortest > FLAT * longest);
}

whit_result appearance_measure(whit_device *device, const whit_scene *scene,
                               whit_renderer *renderer, const whit_renderer_params *params,
                               const whit_image *color, struct appearance *out)
{
    whit_image *ids = NULL;
    char path[PATH_BYTES] = "";
    *out = (struct appearance){0};
    whit_result result = read_ids(renderer, color, &ids);
    if (result == WHIT_OK)
        result = count_lost(color, ids, out);
    whit_image_destroy(ids);
    out->is_flat = out->is_flat || is_thin(scene);
    if (result != WHIT_OK || out->is_flat)
        return result;
    whit_renderer_params view = *params;
    keep_camera(scene, &view);
    result = write_clay(scene, path);
    if (result == WHIT_OK)
        result = draw_clay(device, path, &view, out);
    if (path[0])
        unlink(path);
    return result;
}

bool appearance_is_right(const struct appearance *a)
{
    return a->burnt <= SHARE_MAX && a->black <= SHARE_MAX &&
           (a->is_flat || a->relief >= RELIEF_MIN);
}
