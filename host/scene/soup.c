#include "scene/soup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/vec.h"
#include "scene/pose.h"

#define TRIANGLES_MAX 400000u
#define EVEN          17  /* even steps of an animation at which the view is to show everything */
#define KEYS_MAX      240 /* times of keys at which it is to, too */
#define KEYS_SORTED   (1u << 18)
#define MOVING_MAX    10000 /* animations of more instances are fitted at time 0 alone */

static void put_corner(const struct soup *soup, const struct affine *matrix, const double p[3],
                       float out[3])
{
    double world[3];
    affine_point(matrix, p, world);
    for (int i = 0; i < 3; ++i)
        out[i] = (float)((world[i] - soup->centre[i]) / soup->radius);
}

static void add_triangles(struct soup *soup, const struct scene *scene,
                          const struct scene_mesh *mesh, const struct affine *matrix)
{
    bool mirrored = affine_determinant(matrix) < 0.0;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        const struct scene_material *material = &scene->materials[mesh->materials[t]];
        soup->pictured[soup->count] = material->textures[SCENE_SLOT_DIFFUSE].texture != SCENE_NONE;
        float *out = soup->corners + 9 * (size_t)soup->count++;
        double corners[3][3];
        scene_mesh_corners(mesh, t, corners);
        for (int i = 0; i < 3; ++i) {
            int at = mirrored ? 2 - i : i;
            put_corner(soup, matrix, corners[i], out + 3 * at);
        }
    }
}

/* Three triangles that touch all eight corners of a mesh's box: only good for fitting a picture
   around them. */
static void add_box(struct soup *soup, const struct scene_mesh *mesh, const struct affine *matrix)
{
    for (uint32_t i = 0; i < 9; ++i) {
        double p[3];
        for (uint32_t k = 0; k < 3; ++k)
            p[k] = (double)((i >> k & 1) ? mesh->hi[k] : mesh->lo[k]);
        put_corner(soup, matrix, p, soup->corners + 9 * (size_t)soup->fit_count + 3 * i);
    }
    soup->fit_count += 3;
}

static void add_instances(const struct scene *scene, const struct scene_pose *pose,
                          struct soup *soup)
{
    for (uint32_t i = 0; i < scene->instance_count; ++i)
        add_triangles(soup, scene, &scene->meshes[scene->instances[i].mesh], &pose->instances[i]);
}

static void add_boxes(const struct scene *scene, const struct scene_pose *pose, struct soup *soup)
{
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        if (scene_mesh_primitives(mesh))
            add_box(soup, mesh, &pose->instances[i]);
    }
}

void soup_measure(const double lo[3], const double hi[3], struct soup *soup)
{
    double radius2 = 0.0;
    bool empty = lo[0] > hi[0];
    for (int i = 0; i < 3; ++i) {
        soup->half[i] = empty ? 0.0 : 0.5 * (hi[i] - lo[i]);
        soup->centre[i] = empty ? 0.0 : lo[i] + soup->half[i];
        radius2 += soup->half[i] * soup->half[i];
    }
    soup->radius = radius2 > 0.0 && isfinite(radius2) ? sqrt(radius2) : 1.0;
    for (int i = 0; i < 3; ++i)
        soup->half[i] /= soup->radius;
}

/* Poses of the scene at even steps of its animation, the first borrowed from the caller, then at
   times of keys; lo, hi: bounds over all of them. */
struct moments {
    struct scene_pose poses[EVEN + KEYS_MAX];
    uint32_t count, even; /* even: of these are at even steps */
    double lo[3], hi[3];
};

static void moments_finish(struct moments *moments)
{
    for (uint32_t i = 1; i < moments->count; ++i)
        scene_pose_finish(&moments->poses[i]);
}

/* Adds the scene at a time; with `growing` only if its bounds reach out of those so far. A time at
   which an instance cannot be placed is left out, as it cannot be drawn. */
static whit_result add_moment(const struct scene *scene, double time_s, bool growing,
                              struct moments *out)
{
    struct scene silent = *scene;
    struct scene_pose *pose = &out->poses[out->count];
    bool grows = false;
    silent.log = (whit_log){0};
    whit_result result = scene_pose_init(&silent, time_s, pose);
    if (result != WHIT_OK)
        return result == WHIT_ERROR_INPUT ? WHIT_OK : result;
    for (int k = 0; k < 3; ++k)
        grows |= pose->lo[k] < out->lo[k] || pose->hi[k] > out->hi[k];
    if (growing && !grows) {
        scene_pose_finish(pose);
        return WHIT_OK;
    }
    for (int k = 0; k < 3; ++k) {
        out->lo[k] = fmin(out->lo[k], pose->lo[k]);
        out->hi[k] = fmax(out->hi[k], pose->hi[k]);
    }
    ++out->count;
    return WHIT_OK;
}

static int compare_times(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The times of keys of all channels, each once, in order: of more than KEYS_SORTED keys every
   second, third, ... of each channel and its last. *count: how many. NULL: memory ran out. */
static float *key_times(const struct scene *scene, uint32_t *count)
{
    uint64_t all = 0, room = 0, sorted = 0;
    for (uint32_t i = 0; i < scene->channel_count; ++i)
        all += scene->channels[i].key_count;
    uint64_t step = all / KEYS_SORTED + 1;
    room = all / step + 2 * (uint64_t)scene->channel_count;
    float *times = array_alloc((size_t)room, sizeof *times);
    *count = 0;
    if (!times)
        return NULL;
    for (uint32_t i = 0; i < scene->channel_count; ++i) {
        const struct scene_channel *channel = &scene->channels[i];
        for (uint64_t key = 0; key + 1 < channel->key_count; key += step)
            times[sorted++] = channel->times_s[key];
        times[sorted++] = channel->times_s[channel->key_count - 1];
    }
    qsort(times, (size_t)sorted, sizeof *times, compare_times);
    for (uint64_t i = 0; i < sorted; ++i) {
        if (i == 0 || times[i] != times[*count - 1])
            times[(*count)++] = times[i];
    }
    return times;
}

/* Adds moments at times of keys, evenly thinned to KEYS_MAX and to MOVING_MAX. */
static whit_result add_keys(const struct scene *scene, uint64_t triangles, struct moments *out)
{
    uint32_t count, most = MOVING_MAX * EVEN / scene->instance_count - out->count;
    float *times = key_times(scene, &count);
    whit_result result = times ? WHIT_OK : WHIT_ERROR_MEMORY;
    most = most < KEYS_MAX ? most : KEYS_MAX;
    most = most < count ? most : count;
    bool growing = triangles * (out->count + most) > TRIANGLES_MAX;
    for (uint32_t i = 0; result == WHIT_OK && i < most; ++i) {
        uint64_t at = most > 1 ? (uint64_t)i * (count - 1) / (most - 1) : 0;
        result = add_moment(scene, (double)times[at], growing, out);
    }
    free(times);
    return result;
}

/* `triangles`: how many all instances have. Where triangles at all moments would be too many, boxes
   stand for those at keys, which would widen the view: then only keys that widen the bounds
   count. */
static whit_result moments_init(const struct scene *scene, const struct scene_pose *now,
                                uint64_t triangles, struct moments *out)
{
    double begin_s = fmin((double)scene->time_begin_s, 0.0);
    double length_s = fmax((double)scene->time_end_s, 0.0) - begin_s;
    bool moves = length_s > 0.0 && scene->instance_count > 0 && scene->instance_count <= MOVING_MAX;
    whit_result result = WHIT_OK;
    out->poses[0] = *now;
    out->count = 1;
    memcpy(out->lo, now->lo, sizeof out->lo);
    memcpy(out->hi, now->hi, sizeof out->hi);
    for (uint32_t i = 1; moves && result == WHIT_OK && i < EVEN; ++i)
        result = add_moment(scene, begin_s + length_s * i / (EVEN - 1), false, out);
    out->even = out->count;
    if (moves && result == WHIT_OK)
        result = add_keys(scene, triangles, out);
    if (result != WHIT_OK)
        moments_finish(out);
    return result;
}

/* The cell, from 0, of a coordinate in -SOUP_CELLS/2 .. SOUP_CELLS/2; NaN is in cell 0. */
static uint32_t cell_of(float place)
{
    return (uint32_t)fminf(fmaxf(place + 0.5f * SOUP_CELLS, 0.0f), SOUP_CELLS - 1);
}

/* The cell of a cube map that direction `p` points to. */
static uint32_t direction_cell(const float p[3])
{
    float size[3] = {fabsf(p[0]), fabsf(p[1]), fabsf(p[2])};
    uint32_t axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (!(size[axis] > 0.0f))
        return 0;
    float scale = 0.5f * SOUP_CELLS / size[axis]; /* infinite where size[axis] is denormal */
    uint32_t x = cell_of(p[u] * scale), y = cell_of(p[v] * scale);
    return ((2 * axis + (p[axis] < 0.0f)) * SOUP_CELLS + y) * SOUP_CELLS + x;
}

void soup_find_outline(struct soup *soup)
{
    float farthest[6 * SOUP_CELLS * SOUP_CELLS];
    for (uint32_t i = 0; i < 6 * SOUP_CELLS * SOUP_CELLS; ++i)
        farthest[i] = -1.0f;
    for (size_t i = 0; i < 3 * (size_t)soup->fit_count; ++i) {
        const float *p = soup->corners + 3 * i;
        uint32_t cell = direction_cell(p);
        float length2 = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
        if (length2 > farthest[cell]) {
            farthest[cell] = length2;
            memcpy(soup->outline[cell], p, 3 * sizeof *p);
        }
    }
    for (uint32_t i = 0; i < 6 * SOUP_CELLS * SOUP_CELLS; ++i) {
        if (farthest[i] >= 0.0f)
            memmove(soup->outline[soup->outline_count++], soup->outline[i],
                    sizeof soup->outline[i]);
    }
}

void soup_finish(struct soup *soup)
{
    free(soup->corners);
    free(soup->pictured);
}

whit_result soup_init(const struct scene *scene, const struct scene_pose *pose, struct soup *soup)
{
    struct moments moments;
    uint64_t total = 0;
    bool spheres = false;
    *soup = (struct soup){0};
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        total += scene->meshes[scene->instances[i].mesh].triangle_count;
        spheres |= scene->meshes[scene->instances[i].mesh].sphere_count > 0;
    }
    whit_result result = moments_init(scene, pose, total, &moments);
    if (result != WHIT_OK)
        return result;
    soup_measure(moments.lo, moments.hi, soup);
    soup->whole = total <= TRIANGLES_MAX && !spheres;
    uint32_t exact = !soup->whole                             ? 0
                     : total * moments.count <= TRIANGLES_MAX ? moments.count
                     : total * moments.even <= TRIANGLES_MAX  ? moments.even
                                                              : 1;
    uint64_t room = total * exact + 3ull * moments.count * scene->instance_count;
    soup->corners = array_alloc((size_t)room, 9 * sizeof *soup->corners);
    soup->pictured = array_alloc((size_t)room, sizeof *soup->pictured);
    if (!soup->corners || !soup->pictured) {
        soup_finish(soup);
        moments_finish(&moments);
        return WHIT_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < exact; ++i)
        add_instances(scene, &moments.poses[i], soup);
    soup->fit_count = soup->count;
    soup->count = soup->whole ? (uint32_t)total : 0;
    for (uint32_t i = exact; i < moments.count; ++i)
        add_boxes(scene, &moments.poses[i], soup);
    moments_finish(&moments);
    soup_find_outline(soup);
    return WHIT_OK;
}
