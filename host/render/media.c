/* Media of a scene: which of them may meet, and which of them the camera is in. */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "render/renderer.h"

enum { MATERIALS_MOST = 65534, PAIRS_MOST = 1 << 20, DIRECTIONS = 3, HITS_MOST = 4096 };

/* ---- Bodies: what is of one medium, in one instance; each sphere is one of its own ---- */

struct body {
    uint32_t material;
    double lo[3], hi[3];
};

struct bodies {
    struct body *all;
    uint32_t count, capacity;
};

static bool bounds_medium(const struct scene_material *m)
{
    return !m->thin_walled && m->model != SCENE_MODEL_UNLIT &&
           (m->transmission[0] > 0 || m->transmission[1] > 0 || m->transmission[2] > 0);
}

static bool any_medium(const struct scene *scene)
{
    for (uint32_t i = 0; i < scene->material_count; ++i) {
        if (bounds_medium(&scene->materials[i]))
            return true;
    }
    return false;
}

static void grow(struct body *body, const float at[3], float radius)
{
    for (int k = 0; k < 3; ++k) {
        body->lo[k] = fmin(body->lo[k], (double)at[k] - (double)radius);
        body->hi[k] = fmax(body->hi[k], (double)at[k] + (double)radius);
    }
}

static struct body empty_body(uint32_t material)
{
    return (struct body){.material = material,
                         .lo = {DBL_MAX, DBL_MAX, DBL_MAX},
                         .hi = {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
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

/* Of a mesh, in object space, behind those that are listed. */
static bool list_mesh(const struct scene *scene, const struct scene_mesh *mesh,
                      struct bodies *bodies)
{
    uint32_t first = bodies->count;
    struct body *body = NULL;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        uint32_t material = mesh->materials[t];
        if (!bounds_medium(&scene->materials[material]))
            continue;
        if (!body || body->material != material)
            body = body_of(bodies, first, material);
        if (!body)
            return false;
        for (size_t k = 0; k < 3; ++k)
            grow(body, &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)t + k]], 0.0f);
    }
    for (uint32_t i = 0; i < mesh->sphere_count; ++i) {
        if (!bounds_medium(&scene->materials[mesh->materials[i]]))
            continue;
        struct body sphere = empty_body(mesh->materials[i]);
        grow(&sphere, &mesh->spheres[4 * (size_t)i], mesh->spheres[4 * (size_t)i + 3]);
        if (!ARRAY_PUSH(bodies->all, bodies->count, bodies->capacity, sphere))
            return false;
    }
    return true;
}

/* To world space, wider by `margin` and by what placing a box rounds. */
static struct body place_body(const struct body *body, const struct affine *placed, double margin)
{
    struct body out = empty_body(body->material);
    double size = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double at[3], to[3];
        for (int k = 0; k < 3; ++k)
            at[k] = corner >> k & 1 ? body->hi[k] : body->lo[k];
        affine_point(placed, at, to);
        for (int k = 0; k < 3; ++k) {
            out.lo[k] = fmin(out.lo[k], to[k]);
            out.hi[k] = fmax(out.hi[k], to[k]);
            size = fmax(size, fabs(to[k]));
        }
    }
    margin += size * 64.0 * FLT_EPSILON; /* more than hits are off by: see crossing_reach */
    for (int k = 0; k < 3; ++k) {
        out.lo[k] -= margin;
        out.hi[k] += margin;
    }
    return out;
}

/* Every body of the scene, in world space. */
static bool list_bodies(const struct renderer *renderer, struct bodies *out)
{
    const struct scene *scene = renderer->scene;
    struct bodies meshes = {0};
    uint32_t *first = array_alloc((size_t)scene->mesh_count + 1, sizeof *first);
    bool fine = first != NULL;
    for (uint32_t m = 0; fine && m < scene->mesh_count; ++m) {
        first[m] = meshes.count;
        fine = list_mesh(scene, &scene->meshes[m], &meshes);
        first[m + 1] = meshes.count;
    }
    for (uint32_t i = 0; fine && i < renderer->pose.instance_count; ++i) {
        uint32_t mesh = scene->instances[i].mesh;
        for (uint32_t b = first[mesh]; fine && b < first[mesh + 1]; ++b) {
            struct body body =
                place_body(&meshes.all[b], &renderer->pose.instances[i], (double)scene->contact);
            fine = ARRAY_PUSH(out->all, out->count, out->capacity, body);
        }
    }
    free(first);
    free(meshes.all);
    return fine;
}

bool media_may_touch(const struct renderer *renderer)
{
    struct bodies bodies = {0};
    bool may = !list_bodies(renderer, &bodies) || bodies.count > 1;
    free(bodies.all);
    return may;
}

static int by_low_x(const void *a, const void *b)
{
    double x = ((const struct body *)a)->lo[0], y = ((const struct body *)b)->lo[0];
    return (x > y) - (x < y);
}

static bool meet(const struct body *a, const struct body *b)
{
    for (int k = 0; k < 3; ++k) {
        if (a->lo[k] > b->hi[k] || b->lo[k] > a->hi[k])
            return false;
    }
    return true;
}

/* Whether boxes of two bodies meet; also where it takes too long to tell. Sorts the bodies. */
static bool any_meet(struct bodies *bodies)
{
    uint32_t pairs = 0;
    if (bodies->count > 1)
        qsort(bodies->all, bodies->count, sizeof *bodies->all, by_low_x);
    for (uint32_t i = 0; i < bodies->count; ++i) {
        for (uint32_t j = i + 1; j < bodies->count; ++j) {
            if (bodies->all[j].lo[0] > bodies->all[i].hi[0])
                break;
            if (meet(&bodies->all[i], &bodies->all[j]) || ++pairs > PAIRS_MOST)
                return true;
        }
    }
    return false;
}

/* ---- What is around the camera ---- */

/* A body as one ray from the camera meets it. */
struct around {
    uint32_t instance, material;
    int32_t left[DIRECTIONS]; /* how often it was left less how often entered */
    float exit_t;             /* where it was left last along the first direction that left it */
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

/* All bodies that a ray from `eye` crosses, until it is out of the scene. */
static bool look_around(const struct renderer *renderer, const float eye[3], int direction,
                        struct surroundings *s)
{
    /* Along no axis and no diagonal, where models have edges. */
    static const float directions[DIRECTIONS][3] = {
        {0.5377f, 0.8339f, 0.1249f}, {-0.7647f, 0.3189f, -0.5601f}, {0.2319f, -0.6343f, 0.7375f}};
    const struct scene *scene = renderer->scene;
    struct gpu_ray ray = {.t_min = 0.0f, .t_max = INFINITY};
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = eye[k];
        ray.dir[k] = directions[direction][k];
    }
    struct gpu_hit hit;
    uint32_t status = 0;
    /* At an edge both neighbours are met, as one. */
    uint32_t last_instance = SCENE_NONE, last_material = SCENE_NONE;
    float last_t = 0.0f;
    bool last_left = false;
    traverse_next_float(renderer->accel, &ray, NULL, &hit, &status);
    for (int hits = 0; hit.primitive != HIT_NONE && hits < HITS_MOST; ++hits) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[hit.instance].mesh];
        uint32_t material = mesh->materials[hit.primitive];
        if (bounds_medium(&scene->materials[material])) {
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
        traverse_next_float(renderer->accel, &ray, &hit, &hit, &status);
    }
    return true;
}

/* How often the camera is inside, as most directions say. An open mesh may say anything: then 0. */
static int32_t times_inside(const struct around *around)
{
    const int32_t *n = around->left;
    int32_t middle = n[0] > n[1] ? (n[1] > n[2]   ? n[1]
                                    : n[0] < n[2] ? n[0]
                                                  : n[2])
                                 : (n[0] > n[2]   ? n[0]
                                    : n[1] < n[2] ? n[1]
                                                  : n[2]);
    return middle > 0 ? middle : 0;
}

/* The body that ends farthest away was entered first. */
static int by_exit(const void *a, const void *b)
{
    float x = ((const struct around *)a)->exit_t, y = ((const struct around *)b)->exit_t;
    return (x < y) - (x > y);
}

/* Into the frame's list: by priority, of equal ones in the order of entering. */
static bool add_medium(const struct scene *scene, uint32_t material, uint32_t *list,
                       uint32_t *count)
{
    if (*count == MEDIA_MOST)
        return false;
    uint32_t at = (*count)++;
    for (; at > 0 && scene->materials[list[at - 1]].priority > scene->materials[material].priority;
         --at)
        list[at] = list[at - 1];
    list[at] = material;
    return true;
}

static whit_result fill_eye(struct renderer *renderer, struct surroundings *s)
{
    uint32_t list[MEDIA_MOST] = {0}, count = 0;
    if (s->count > 1)
        qsort(s->all, s->count, sizeof *s->all, by_exit);
    for (uint32_t i = 0; i < s->count; ++i) {
        for (int32_t n = times_inside(&s->all[i]); n > 0; --n) {
            if (!add_medium(renderer->scene, s->all[i].material, list, &count)) {
                log_error(&renderer->log, "the camera is in more than %u media at once",
                          MEDIA_MOST);
                return WHIT_ERROR_STATUS;
            }
        }
    }
    uint32_t *words[] = {&renderer->frame.eye_media0, &renderer->frame.eye_media1,
                         &renderer->frame.eye_media2, &renderer->frame.eye_media3};
    for (uint32_t i = 0; i < count; ++i)
        *words[i / 2] |= (list[i] + 1) << 16 * (i % 2);
    return WHIT_OK;
}

static bool in_a_box(const struct bodies *bodies, const float eye[3])
{
    for (uint32_t i = 0; i < bodies->count; ++i) {
        const struct body *body = &bodies->all[i];
        bool in = true;
        for (int k = 0; k < 3; ++k)
            in = in && (double)eye[k] >= body->lo[k] && (double)eye[k] <= body->hi[k];
        if (in)
            return true;
    }
    return false;
}

whit_result media_frame(struct renderer *renderer)
{
    struct gpu_frame *frame = &renderer->frame;
    frame->contact = renderer->scene->contact;
    frame->nested = 0;
    frame->eye_media0 = frame->eye_media1 = frame->eye_media2 = frame->eye_media3 = 0;
    if (!any_medium(renderer->scene))
        return WHIT_OK;
    if (renderer->scene->material_count > MATERIALS_MOST) {
        log_error(&renderer->log, "%s: %u materials; with refraction at most %d are told apart",
                  renderer->scene->name, renderer->scene->material_count, MATERIALS_MOST);
        return WHIT_ERROR_USAGE;
    }
    struct bodies bodies = {0};
    struct surroundings around = {0};
    bool fine = list_bodies(renderer, &bodies);
    frame->nested = fine && any_meet(&bodies);
    bool inside = fine && in_a_box(&bodies, frame->eye);
    for (int i = 0; fine && inside && i < DIRECTIONS; ++i)
        fine = look_around(renderer, frame->eye, i, &around);
    whit_result result = fine ? fill_eye(renderer, &around) : WHIT_ERROR_MEMORY;
    if (!fine)
        log_error(&renderer->log, "out of memory for the media of the scene");
    free(bodies.all);
    free(around.all);
    return result;
}
