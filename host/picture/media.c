/* Media of a scene: whether bodies of media may touch, and which media the camera is in. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "picture/camera.h"
#include "picture/media.h"
#include "twin/traverse.h"

enum { MATERIALS_MAX = 65534, DIRECTIONS = 3, HITS_MAX = 4096 };

static bool any_medium(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        if (bodies_bounded_by(&scene->materials[i]))
            return true;
    }
    return false;
}

/* ---- Media that touch ---- */

/* An upper bound of the distance between surfaces that a ray crosses at one place, by
   crossing_slack and crossing_contact of shaders/bind/crossing.glsl. It assumes that rays start in
   the scene or at the camera and end on a body, that the edges e1, e2 of a triangle are no longer
   than its body, and that those of a sphere together are at most 3 pi times its radius. */
static double crossing_reach(const struct scene *scene, const struct scene_pose *pose,
                             const struct bodies *bodies, const struct gpu_frame *frame)
{
    const double rounding = 8.0 * 0x1p-24 / (1.0 - 8.0 * 0x1p-24), pi = 3.14159265358979;
    double origin = 0.0, place = 0.0, edges = 0.0, way2 = 0.0;
    for (int k = 0; k < 3; ++k) {
        double aside = (double)(fabsf(frame->right[k]) + fabsf(frame->up[k]) + frame->lens_radius);
        double from = fmin(pose->lo[k], (double)frame->eye[k] - aside);
        double to = fmax(pose->hi[k], (double)frame->eye[k] + aside), lo = INFINITY, hi = -INFINITY;
        for (uint32_t i = 0; i < bodies->count; ++i) {
            const struct body *body = &bodies->all[i];
            lo = fmin(lo, body->lo[k]);
            hi = fmax(hi, body->hi[k]);
            edges = fmax(edges, 1.5 * pi * (body->hi[k] - body->lo[k]));
        }
        double way = fmax(hi - from, to - lo);
        origin = fmax(origin, fmax(fabs(from), fabs(to)));
        place = fmax(place, fmax(fabs(lo), fabs(hi)));
        way2 += way * way;
    }
    double size = origin + place + edges + sqrt(way2);
    return 1.01 * (1024.0 * rounding * size + 16.0 * (double)scene->contact);
}

bool media_touch(const struct scene *scene, const struct bodies *bodies,
                 const struct gpu_frame *frame)
{
    bool moves = scene->channel_count > 0;
    return moves ? bodies->count > 1 : frame->nested != 0;
}

/* ---- What is around the camera ---- */

/* A body that rays from the camera cross, with the numbers of its crossings. */
struct around {
    uint32_t instance, material;
    int32_t left[DIRECTIONS]; /* number of exits minus number of entries */
    float exit_t;             /* t of the last exit along direction 0 */
};

struct surroundings {
    struct around *all;
    uint32_t count, capacity;
};

static struct around *find_around(struct surroundings *s, uint32_t instance, uint32_t material)
{
    for (uint32_t i = 0; i < s->count; ++i) {
        if (s->all[i].instance == instance && s->all[i].material == material)
            return &s->all[i];
    }
    const struct around empty = {.instance = instance, .material = material, .exit_t = -1.0f};
    return ARRAY_PUSH(s->all, s->count, s->capacity, empty) ? &s->all[s->count - 1] : NULL;
}

/* Adds all bodies that a ray from `eye` crosses until it leaves the scene. */
static bool look_around(const struct accel *accel, const float eye[3], int direction,
                        struct surroundings *s)
{
    /* Directions away from axes and diagonals, along which models have edges. */
    static const float directions[DIRECTIONS][3] = {
        {0.5377f, 0.8339f, 0.1249f}, {-0.7647f, 0.3189f, -0.5601f}, {0.2319f, -0.6343f, 0.7375f}};
    const struct scene *scene = accel->scene;
    struct gpu_ray ray = {.t_min = 0.0f, .t_max = INFINITY};
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = eye[k];
        ray.dir[k] = directions[direction][k];
    }
    struct gpu_hit hit;
    const struct traverse_params next = {.behind = &hit};
    uint32_t status = 0;
    /* At an edge both triangles are met; they count as one crossing. */
    uint32_t last_instance = SCENE_NONE, last_material = SCENE_NONE;
    float last_t = 0.0f;
    bool last_left = false;
    traverse_ray(accel, NULL, &ray, &hit, NULL, &status);
    for (int hits = 0; hit.primitive != HIT_NONE && hits < HITS_MAX; ++hits) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[hit.instance].mesh];
        uint32_t material = mesh->materials[hit.primitive];
        if (bodies_bounded_by(&scene->materials[material])) {
            struct around *around = find_around(s, hit.instance, material);
            if (!around)
                return false;
            bool left =
                ray.dir[0] * hit.ng_x + ray.dir[1] * hit.ng_y + ray.dir[2] * hit.ng_z > 0.0f;
            bool again = hit.instance == last_instance && material == last_material &&
                         left == last_left && hit.t - last_t <= 8.0f * FLT_EPSILON * hit.t;
            around->left[direction] += again ? 0 : left ? 1 : -1;
            if (direction == 0 && left)
                around->exit_t = hit.t;
            last_instance = hit.instance;
            last_material = material;
            last_t = hit.t;
            last_left = left;
        }
        traverse_ray(accel, &next, &ray, &hit, NULL, &status);
    }
    return true;
}

/* How many times the camera is inside the body: the median of the counts along three rays. For an
   open mesh it may be any number; one below 0 counts as 0. */
static int32_t times_inside(const struct around *around)
{
    const int32_t *n = around->left;
    int32_t low = n[0] < n[1] ? n[0] : n[1], high = n[0] < n[1] ? n[1] : n[0];
    int32_t middle = n[2] < low ? low : n[2] > high ? high : n[2];
    return middle > 0 ? middle : 0;
}

/* Sorts by distance of the exit: the body that ends farthest away was entered first. */
static int by_exit(const void *a, const void *b)
{
    float x = ((const struct around *)a)->exit_t, y = ((const struct around *)b)->exit_t;
    return (x < y) - (x > y);
}

/* Inserts a medium into the frame's list, which is sorted by priority, then by order of entry. */
static bool add_medium(const struct scene *scene, uint32_t material, uint32_t *list,
                       uint32_t *count)
{
    if (*count == MEDIA_MAX)
        return false;
    uint32_t at = (*count)++;
    for (; at > 0 && scene->materials[list[at - 1]].priority > scene->materials[material].priority;
         --at)
        list[at] = list[at - 1];
    list[at] = material;
    return true;
}

static whit_result fill_eye(const whit_log *log, const struct scene *scene, struct surroundings *s,
                            struct gpu_frame *frame)
{
    uint32_t list[MEDIA_MAX] = {0}, count = 0;
    if (s->count > 1)
        qsort(s->all, s->count, sizeof *s->all, by_exit);
    for (uint32_t i = 0; i < s->count; ++i) {
        for (int32_t n = times_inside(&s->all[i]); n > 0; --n) {
            if (!add_medium(scene, s->all[i].material, list, &count))
                return log_failure(log, WHIT_ERROR_STATUS,
                                   "the camera is in more than %u media at once", MEDIA_MAX);
        }
    }
    uint32_t *words[] = {&frame->eye_media0, &frame->eye_media1, &frame->eye_media2,
                         &frame->eye_media3};
    for (uint32_t i = 0; i < count; ++i)
        *words[i / 2] |= (list[i] + 1) << 16 * (i % 2);
    return WHIT_OK;
}

static bool in_a_box(const struct bodies *bodies, const float eye[3], double margin)
{
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const struct body *body = &bodies->all[i];
        bool in = true;
        for (int k = 0; k < 3; ++k)
            in = in && (double)eye[k] >= body->lo[k] - margin &&
                 (double)eye[k] <= body->hi[k] + margin;
        if (in)
            return true;
    }
    return false;
}

/* Bounds of boxes are off by roundings of instances' transforms to floats. */
static void fill_sphere(const struct scene_pose *pose, struct gpu_frame *frame)
{
    double square = 0.0, size = 0.0;
    for (int k = 0; k < 3; ++k) {
        bool some = pose->lo[k] <= pose->hi[k];
        double half = some ? 0.5 * (pose->hi[k] - pose->lo[k]) : 0.0;
        frame->scene_center[k] = some ? (float)(pose->lo[k] + half) : 0.0f;
        square += half * half;
        size = fmax(size, fabs((double)frame->scene_center[k]) + half);
    }
    frame->scene_radius = (float)(sqrt(square) + size * 0x1p-16);
}

double media_shadow_end(const struct gpu_frame *frame, const double origin[3], double distance)
{
    double square = 0.0;
    for (int k = 0; k < 3; ++k) {
        double away = origin[k] - (double)frame->scene_center[k];
        square += away * away;
    }
    return isfinite(distance) ? fmin(distance, sqrt(square) + (double)frame->scene_radius) : 0.0;
}

whit_result media_frame(const whit_log *log, const struct accel *accel,
                        const struct scene_pose *pose, struct bodies *bodies,
                        struct gpu_frame *frame)
{
    const struct scene *scene = accel->scene;
    frame->contact = scene->contact;
    frame->nested = 0;
    frame->eye_media0 = frame->eye_media1 = frame->eye_media2 = frame->eye_media3 = 0;
    fill_sphere(pose, frame);
    if (!any_medium(scene))
        return WHIT_OK;
    if (scene->material_count > MATERIALS_MAX)
        return log_usage(log, "%s: %u materials; with refraction at most %d are told apart",
                         scene->name, scene->material_count, MATERIALS_MAX);
    struct surroundings around = {0};
    bool fine = bodies_list(scene, pose, bodies);
    frame->nested =
        fine && bodies_come_within(scene, pose, bodies, crossing_reach(scene, pose, bodies, frame));
    bool inside = fine && in_a_box(bodies, frame->eye, (double)frame->contact);
    for (int i = 0; fine && inside && i < DIRECTIONS; ++i)
        fine = look_around(accel, frame->eye, i, &around);
    whit_result result = fine ? fill_eye(log, scene, &around, frame) : WHIT_ERROR_MEMORY;
    if (!fine)
        log_error(log, "out of memory for the media of the scene");
    free(around.all);
    return result;
}

whit_result media_view(const whit_log *log, struct accel *accel, const struct scene_pose *pose,
                       const whit_camera *camera, uint32_t width, uint32_t height,
                       struct gpu_frame *frame, uint32_t *kind)
{
    struct bodies bodies = {0};
    *frame = (struct gpu_frame){0};
    whit_result result = camera_frame(log, pose, camera, width, height, frame, kind);
    if (result == WHIT_OK)
        result = media_frame(log, accel, pose, &bodies, frame);
    bodies_finish(&bodies);
    return result;
}
