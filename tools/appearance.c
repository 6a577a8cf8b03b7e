#define _GNU_SOURCE
#include "appearance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double COVERED_MIN = 0.05, SHARE_MAX = 0.1, RELIEF_MIN = 2.0;
/* A model counts as a flat board, which shows no relief, if it stays this close to a plane, as a
   share of the longest side of its box. */
static const double FLAT = 0.1;
/* Bound of the rounding error of a mean of samples of 1. */
static const double ROUNDING = 1e-4;

enum { PATH_BYTES = 4096 };

/* Makes a file in the folder for temporary files; the caller closes and removes it. NULL, and
   `path` empty, where it could not be made. */
static FILE *open_temporary(const char *ending, char path[PATH_BYTES])
{
    const char *folder = getenv("TMPDIR");
    int length = snprintf(path, PATH_BYTES, "%s/whit_XXXXXX%s", folder ? folder : "/tmp", ending);
    int file = length < PATH_BYTES ? mkstemps(path, (int)strlen(ending)) : -1;
    FILE *stream = file < 0 ? NULL : fdopen(file, "w");
    if (!stream)
        path[0] = '\0';
    return stream;
}

/* ---- What the file wants ---- */

static const char wish[] =
    "//@ whit 1\n"
    "//@ toggle furnace off \"light of 1 from everywhere; else none but the surface's own\"\n"
    "vec3 shade(Surface s, Optics o, vec3 to_eye)\n"
    "{\n"
    "    vec3 own = o.unlit ? o.emission + o.diffuse : o.emission;\n"
    "    return furnace ? own + o.diffuse + o.highlight : own;\n"
    "}\n"
    "vec3 miss(vec3 dir)\n"
    "{\n"
    "    return vec3(furnace ? 1.0 : 0.0);\n"
    "}\n";

whit_result appearance_shader_init(const whit_log *log, struct appearance_shader *out)
{
    char path[PATH_BYTES];
    FILE *stream = open_temporary(".glsl", path);
    bool written = stream && fputs(wish, stream) >= 0;
    written = stream && fclose(stream) == 0 && written;
    *out = (struct appearance_shader){0};
    whit_result result = written ? WHIT_OK : WHIT_ERROR_OUTPUT;
    if (result == WHIT_OK)
        result = whit_shader_compiler_create(NULL, log, &out->compiler);
    if (result == WHIT_OK)
        result = whit_shader_load(out->compiler, path, false, &out->shader);
    if (path[0])
        unlink(path);
    if (result != WHIT_OK)
        appearance_shader_finish(out);
    return result;
}

void appearance_shader_finish(struct appearance_shader *shader)
{
    whit_shader_destroy(shader->shader);
    whit_shader_compiler_destroy(shader->compiler);
    *shader = (struct appearance_shader){0};
}

/* A picture by the shader, and its displayed bytes. */
struct wished {
    whit_image *color;
    uint8_t *rgba;
};

static void wished_finish(struct wished *wished)
{
    whit_image_destroy(wished->color);
    free(wished->rgba);
}

whit_result appearance_display(const whit_image *color, uint8_t **rgba)
{
    whit_image_info info;
    whit_image_get_info(color, &info);
    *rgba = malloc(4 * (size_t)info.width * info.height);
    if (!*rgba)
        return WHIT_ERROR_MEMORY;
    whit_image_display_bytes(color, *rgba);
    return WHIT_OK;
}

static whit_result draw_wished(whit_renderer *renderer, struct wished *out)
{
    whit_result result = whit_renderer_render(renderer);
    if (result == WHIT_OK)
        result = whit_renderer_image(renderer, WHIT_AOV_COLOR, &out->color);
    return result == WHIT_OK ? appearance_display(out->color, &out->rgba) : result;
}

/* Draws both pictures: `glow` is displayed with the exposure of the params, `furnace` without. */
static whit_result draw_wishes(const struct appearance_shader *shader,
                               const struct appearance_of *of, struct wished *glow,
                               struct wished *furnace)
{
    whit_renderer_params params = *of->params;
    whit_renderer *renderer = NULL;
    params.shader = shader->shader;
    whit_result result = whit_renderer_create(of->device, of->accel, &params, &renderer);
    if (result == WHIT_OK)
        result = draw_wished(renderer, glow);
    params.sliders = "furnace=on";
    params.exposure_ev = 0.0;
    params.soft_highlights = false;
    if (result == WHIT_OK)
        result = whit_renderer_set_view(renderer, &params);
    if (result == WHIT_OK)
        result = draw_wished(renderer, furnace);
    whit_renderer_destroy(renderer);
    return result;
}

/* ---- Framing ---- */

/* Whether whit itself chose to see the model from outside. From within a room, and by a camera of
   the file, a picture may well be full. */
static bool is_framed_by_whit(const whit_scene *scene)
{
    whit_camera_info camera;
    whit_scene_info info;
    bool inside = true;
    whit_scene_get_camera(scene, 0, &camera);
    whit_scene_get_info(scene, &info);
    for (int i = 0; i < 3; ++i)
        inside &= info.objects_lo[i] < camera.eye[i] && camera.eye[i] < info.objects_hi[i];
    return camera.made_by_whit && !inside;
}

static void measure_framing(const whit_scene *scene, const whit_image *ids, struct appearance *out)
{
    whit_image_info info;
    size_t seen = 0;
    bool left = false, right = false, top = false, bottom = false;
    whit_image_get_info(ids, &info);
    size_t count = (size_t)info.width * info.height;
    for (size_t i = 0; i < count; ++i) {
        if (whit_image_words(ids)[2 * i + 1] == WHIT_NONE)
            continue;
        ++seen;
        left |= i % info.width == 0;
        right |= i % info.width == info.width - 1;
        top |= i < info.width;
        bottom |= i >= count - info.width;
    }
    out->covered = (double)seen / (double)count;
    out->cropped = left && right && top && bottom && is_framed_by_whit(scene);
}

/* ---- Burnt and black ---- */

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

static bool is_burnt(const uint8_t *shown, const uint8_t *glowing, const float *glow,
                     double exposed)
{
    bool burnt = false;
    for (int c = 0; c < 3; ++c)
        burnt |=
            shown[c] == 255 && !(glowing[c] == 255 && (double)glow[c] * exposed <= 1.0 + ROUNDING);
    return burnt;
}

static bool is_black(const uint8_t *shown)
{
    return !shown[0] && !shown[1] && !shown[2];
}

static void count_lost(const struct appearance_of *of, const whit_image *ids, const uint8_t *shown,
                       const struct wished *glow, const struct wished *furnace,
                       struct appearance *out)
{
    whit_image_info info;
    whit_image_get_info(of->color, &info);
    size_t count = (size_t)info.width * info.height, seen = 0, burnt = 0, black = 0;
    double exposed = exp2(of->params->exposure_ev);
    for (size_t i = 0; i < count; ++i) {
        if (whit_image_words(ids)[2 * i + 1] == WHIT_NONE)
            continue;
        ++seen;
        burnt += is_burnt(shown + 4 * i, glow->rgba + 4 * i,
                          whit_image_floats(glow->color) + info.channels * i, exposed);
        black += is_black(shown + 4 * i) && !is_black(furnace->rgba + 4 * i);
    }
    out->is_flat = seen == 0;
    out->burnt = seen ? (double)burnt / (double)seen : 0.0;
    out->black = seen ? (double)black / (double)seen : 0.0;
}

static whit_result measure_lost(const struct appearance_shader *shader,
                                const struct appearance_of *of, struct appearance *out)
{
    struct wished glow = {0}, furnace = {0};
    whit_image *ids = NULL;
    uint8_t *shown = NULL;
    whit_result result = read_ids(of->renderer, of->color, &ids);
    if (result == WHIT_OK)
        result = appearance_display(of->color, &shown);
    if (result == WHIT_OK)
        result = draw_wishes(shader, of, &glow, &furnace);
    if (result == WHIT_OK)
        count_lost(of, ids, shown, &glow, &furnace, out);
    if (result == WHIT_OK)
        measure_framing(of->scene, ids, out);
    wished_finish(&glow);
    wished_finish(&furnace);
    free(shown);
    whit_image_destroy(ids);
    return result;
}

/* ---- Clay ---- */

static bool write_triangle(void *user, const whit_triangle *triangle)
{
    const float *v = triangle->vertices;
    for (int k = 0; k < 9; k += 3)
        fprintf(user, "v %.9g %.9g %.9g\n", (double)v[k], (double)v[k + 1], (double)v[k + 2]);
    return fputs("f -3 -2 -1\n", user) >= 0;
}

/* Writes the scene's triangles to a temporary OBJ without materials; the caller removes it. */
static whit_result write_clay(const whit_scene *scene, char path[PATH_BYTES])
{
    FILE *stream = open_temporary(".obj", path);
    if (!stream)
        return WHIT_ERROR_OUTPUT;
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

/* The mean of levels[i] for `from` <= i < `to`. */
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

/* ---- Boards ---- */

struct plane {
    double normal[3]; /* its length is twice the area of the largest triangle */
    double area, lo, hi;
};

static bool find_largest(void *user, const whit_triangle *triangle)
{
    struct plane *plane = user;
    const float *v = triangle->vertices;
    double normal[3], area = 0.0;
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = (double)(v[3 + j] - v[j]) * (double)(v[6 + k] - v[k]) -
                    (double)(v[3 + k] - v[k]) * (double)(v[6 + j] - v[j]);
        area += normal[i] * normal[i];
    }
    area = sqrt(area);
    if (area > plane->area) {
        plane->area = area;
        memcpy(plane->normal, normal, sizeof normal);
    }
    return true;
}

static bool find_sides(void *user, const whit_triangle *triangle)
{
    struct plane *plane = user;
    for (int at = 0; at < 9; at += 3) {
        double along = 0.0;
        for (int k = 0; k < 3; ++k)
            along += plane->normal[k] / plane->area * (double)triangle->vertices[at + k];
        plane->lo = fmin(plane->lo, along);
        plane->hi = fmax(plane->hi, along);
    }
    return true;
}

/* Whether the whole model is close to the plane of its largest triangle. */
static whit_result find_board(const whit_scene *scene, bool *board)
{
    struct plane plane = {.lo = INFINITY, .hi = -INFINITY};
    whit_scene_info info;
    double longest = 0.0;
    whit_scene_get_info(scene, &info);
    for (int i = 0; i < 3; ++i)
        longest = fmax(longest, info.hi[i] - info.lo[i]);
    whit_result result = whit_scene_triangles(scene, 0.0, find_largest, &plane);
    if (result == WHIT_OK)
        result = whit_scene_triangles(scene, 0.0, find_sides, &plane);
    *board = !(plane.hi - plane.lo > FLAT * longest);
    return result;
}

/* ---- All of it ---- */

static whit_result measure_clay(const struct appearance_of *of, struct appearance *out)
{
    char path[PATH_BYTES];
    whit_renderer_params view = *of->params;
    keep_camera(of->scene, &view);
    whit_result result = write_clay(of->scene, path);
    if (result == WHIT_OK)
        result = draw_clay(of->device, path, &view, out);
    if (path[0])
        unlink(path);
    return result;
}

whit_result appearance_measure(const struct appearance_shader *shader,
                               const struct appearance_of *of, struct appearance *out)
{
    bool board = false;
    *out = (struct appearance){0};
    whit_result result = measure_lost(shader, of, out);
    if (result == WHIT_OK)
        result = find_board(of->scene, &board);
    out->is_flat = out->is_flat || board;
    return result == WHIT_OK && !out->is_flat ? measure_clay(of, out) : result;
}

bool appearance_is_right(const struct appearance *a)
{
    return a->covered >= COVERED_MIN && !a->cropped && a->burnt <= SHARE_MAX &&
           a->black <= SHARE_MAX && (a->is_flat || a->relief >= RELIEF_MIN);
}
