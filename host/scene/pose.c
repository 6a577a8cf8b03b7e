#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/same.h"
#include "base/text.h"
#include "base/vec.h"
#include "scene/pose.h"

/* An animated scale of zero (things that pop up or vanish) is raised to this, so that the matrix
   has an inverse; nothing that small is seen. */
#define SMALLEST_ANIMATED_SCALE 1e-6
/* The scale of an instance that nested scales of about zero have made too small for floats. */
#define HIDDEN_SCALE            1e-12

/* Numbers of a value, between tangents or not. */
static uint32_t width_of(const struct scene_channel *channel)
{
    return channel->path == SCENE_PATH_ROTATION ? 4 : 3;
}

/* Index of the last key at or before `time_s`; the channel has keys on both sides of it. */
static uint32_t key_before(const struct scene_channel *channel, float time_s)
{
    uint32_t low = 0, high = channel->key_count - 1;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (channel->times_s[middle] <= time_s)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void normalize(double q[4])
{
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0.0) || !isfinite(length)) {
        q[0] = q[1] = q[2] = 0.0, q[3] = 1.0;
        return;
    }
    for (int i = 0; i < 4; ++i)
        q[i] /= length;
}

/* Spherical interpolation along the shorter arc; linear where the angle's sine is too small to
   divide by. */
static void slerp(const double from[4], const double to[4], double s, double out[4])
{
    double a[4], b[4];
    memcpy(a, from, sizeof a);
    memcpy(b, to, sizeof b);
    normalize(a);
    normalize(b);
    double cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    double sign = cosine < 0.0 ? -1.0 : 1.0;
    cosine = fmin(fabs(cosine), 1.0);
    double weight_a = 1.0 - s, weight_b = s;
    if (cosine < 1.0 - 1e-9) {
        double angle = same_acos(cosine), sine = same_sin(angle);
        weight_a = same_sin((1.0 - s) * angle) / sine;
        weight_b = same_sin(s * angle) / sine;
    }
    for (int i = 0; i < 4; ++i)
        out[i] = weight_a * a[i] + sign * weight_b * b[i];
}

/* Hermite spline of glTF 2.0, appendix C.5: tangents are per second. */
static void hermite(const float *key_a, const float *key_b, uint32_t width, double dt, double s,
                    double out[4])
{
    double s2 = s * s, s3 = s2 * s;
    for (uint32_t i = 0; i < width; ++i) {
        double value_a = (double)key_a[width + i], out_tangent = (double)key_a[2 * width + i];
        double in_tangent = (double)key_b[i], value_b = (double)key_b[width + i];
        out[i] = (2 * s3 - 3 * s2 + 1) * value_a + dt * (s3 - 2 * s2 + s) * out_tangent +
                 (-2 * s3 + 3 * s2) * value_b + dt * (s3 - s2) * in_tangent;
    }
}

static void copy_key(const struct scene_channel *channel, uint32_t key, double out[4])
{
    uint32_t width = width_of(channel);
    bool cubic = channel->interpolation == SCENE_CUBIC;
    const float *value = channel->values + (size_t)key * width * (cubic ? 3 : 1);
    for (uint32_t i = 0; i < width; ++i)
        out[i] = (double)value[(cubic ? width : 0) + i];
}

static void interpolate(const struct scene_channel *channel, uint32_t key, double time_s,
                        double out[4])
{
    uint32_t width = width_of(channel);
    double start = (double)channel->times_s[key];
    double dt = (double)channel->times_s[key + 1] - start;
    double s = dt > 0.0 ? fmin(fmax((time_s - start) / dt, 0.0), 1.0) : 0.0;
    double a[4], b[4];
    copy_key(channel, key, a);
    copy_key(channel, key + 1, b);
    if (channel->interpolation == SCENE_STEP) {
        memcpy(out, a, sizeof a);
    } else if (channel->interpolation == SCENE_CUBIC) {
        const float *values = channel->values + (size_t)key * width * 3;
        hermite(values, values + (size_t)width * 3, width, dt, s, out);
    } else if (channel->path == SCENE_PATH_ROTATION) {
        slerp(a, b, s, out);
    } else {
        for (uint32_t i = 0; i < width; ++i)
            out[i] = (1.0 - s) * a[i] + s * b[i];
    }
}

static void evaluate(const struct scene_channel *channel, double time_s, double out[4])
{
    uint32_t last = channel->key_count - 1;
    /* Times of keys are floats: a time that is one of them in double, such as 0.1, has to be the
       same float, or 0.1f comes later. */
    float key_time_s = (float)time_s;
    if (key_time_s >= channel->times_s[last])
        copy_key(channel, last, out);
    else if (!(key_time_s > channel->times_s[0]))
        copy_key(channel, 0, out);
    else
        interpolate(channel, key_before(channel, key_time_s), time_s, out);
    if (channel->path == SCENE_PATH_ROTATION)
        normalize(out);
}

static void apply_channel(const struct scene_channel *channel, double time_s,
                          struct scene_node *node)
{
    double value[4] = {0, 0, 0, 1};
    evaluate(channel, time_s, value);
    switch (channel->path) {
    case SCENE_PATH_TRANSLATION:
        memcpy(node->translation, value, sizeof node->translation);
        break;
    case SCENE_PATH_ROTATION:
        memcpy(node->rotation, value, sizeof node->rotation);
        break;
    case SCENE_PATH_SCALE:
        for (int i = 0; i < 3; ++i) {
            bool small = fabs(value[i]) < SMALLEST_ANIMATED_SCALE;
            node->scale[i] = small ? copysign(SMALLEST_ANIMATED_SCALE, value[i]) : value[i];
        }
        break;
    }
    node->has_matrix = false;
}

/* World matrix of every node; parents come before their children. */
static struct affine *pose_nodes(const struct scene *scene, double time_s)
{
    struct scene_node *moved = array_alloc(scene->node_count, sizeof *moved);
    struct affine *world = array_alloc(scene->node_count, sizeof *world);
    if (!moved || !world) {
        free(moved);
        free(world);
        return NULL;
    }
    if (scene->node_count)
        memcpy(moved, scene->nodes, scene->node_count * sizeof *moved);
    for (uint32_t i = 0; i < scene->channel_count; ++i)
        apply_channel(&scene->channels[i], time_s, &moved[scene->channels[i].node]);
    for (uint32_t i = 0; i < scene->node_count; ++i) {
        world[i] = scene_node_matrix(&moved[i]);
        if (moved[i].parent != SCENE_NONE)
            world[i] = affine_multiply(&world[moved[i].parent], &world[i]);
    }
    free(moved);
    return world;
}

/* Transforms a normal by the inverse transpose, to any length. The determinant's sign is left out:
   in a mirrored node the front of a surface stays its front, as in glTF. */
static void move_normal(const struct affine *world, const double in[3], double out[3])
{
    struct affine inverse;
    if (!affine_invert(world, &inverse)) {
        affine_vector(world, in, out);
        return;
    }
    double moved[3];
    for (int i = 0; i < 3; ++i)
        moved[i] = inverse.m[i] * in[0] + inverse.m[4 + i] * in[1] + inverse.m[8 + i] * in[2];
    memcpy(out, moved, sizeof moved);
}

/* Transforms a flat emitter's edges. They are swapped in a mirrored node, so that edge_u x edge_v
   still points along its direction. */
static void move_edges(const struct affine *world, struct scene_light *light)
{
    double u[3], v[3], normal[3];
    affine_vector(world, light->edge_u, u);
    affine_vector(world, light->edge_v, v);
    double3_cross(u, v, normal);
    bool swapped = double3_dot(normal, light->direction) < 0.0;
    memcpy(light->edge_u, swapped ? v : u, sizeof u);
    memcpy(light->edge_v, swapped ? u : v, sizeof v);
}

static struct scene_light pose_light(const struct scene_light *light, const struct affine *nodes)
{
    struct scene_light out = *light;
    if (light->node != SCENE_NONE) {
        const struct affine *world = &nodes[light->node];
        affine_point(world, light->position, out.position);
        if (light->kind == WHIT_LIGHT_AREA_SAMPLE || scene_light_is_flat(light))
            move_normal(world, light->direction, out.direction);
        else
            affine_vector(world, light->direction, out.direction);
        if (scene_light_is_flat(light))
            move_edges(world, &out);
        out.node = SCENE_NONE;
    }
    if (!double3_normalize(out.direction))
        memcpy(out.direction, (const double[3]){0, -1, 0}, sizeof out.direction);
    return out;
}

static struct scene_camera pose_camera(const struct scene_camera *camera,
                                       const struct affine *nodes)
{
    struct scene_camera out = *camera;
    if (camera->node == SCENE_NONE)
        return out;
    const struct affine *world = &nodes[camera->node];
    affine_point(world, camera->eye, out.eye);
    affine_point(world, camera->target, out.target);
    affine_vector(world, camera->up, out.up);
    out.node = SCENE_NONE;
    return out;
}

whit_result scene_pose_camera(const struct scene *scene, uint32_t index, double time_s,
                              struct scene_camera *camera)
{
    struct affine *nodes = pose_nodes(scene, time_s);
    if (!nodes)
        return log_failure(&scene->log, WHIT_ERROR_MEMORY, "%s: out of memory for a camera",
                           scene->name);
    *camera = pose_camera(&scene->cameras[index], nodes);
    free(nodes);
    return WHIT_OK;
}

static struct affine instance_matrix(const struct scene_instance *instance,
                                     const struct affine *nodes)
{
    if (instance->node == SCENE_NONE)
        return instance->has_local ? instance->local : affine_identity();
    if (!instance->has_local)
        return nodes[instance->node];
    return affine_multiply(&nodes[instance->node], &instance->local);
}

static void grow_bounds(double lo[3], double hi[3], const struct affine *matrix,
                        const struct scene_mesh *mesh)
{
    if (mesh->lo[0] > mesh->hi[0])
        return;
    for (int corner = 0; corner < 8; ++corner) {
        double p[3];
        for (int i = 0; i < 3; ++i)
            p[i] = (double)(corner >> i & 1 ? mesh->hi[i] : mesh->lo[i]);
        affine_point(matrix, p, p);
        double3_grow_box(lo, hi, p);
    }
}

/* An instance is a floor where its box is thinner than FLAT times its longest side, and longer than
   WIDER times the longest side of all that is not flat. */
static const double FLAT = 0.02, WIDER = 1.5;

/* The longest side of a box; *thin: the shortest one. */
static double box_sides(const double lo[3], const double hi[3], double *thin)
{
    double longest = 0.0;
    *thin = INFINITY;
    for (int i = 0; i < 3; ++i) {
        longest = fmax(longest, hi[i] - lo[i]);
        *thin = fmin(*thin, hi[i] - lo[i]);
    }
    return longest;
}

/* Grows the box by those instances that are flat, or are not, and whose longest side is at most
   `max`. */
static void grow_objects(const struct scene *scene, const struct scene_pose *pose, bool flat,
                         double max, double lo[3], double hi[3])
{
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        double own_lo[3], own_hi[3], thin;
        const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
        double3_no_box(own_lo, own_hi);
        grow_bounds(own_lo, own_hi, &pose->instances[i], mesh);
        double longest = box_sides(own_lo, own_hi, &thin);
        if (flat == (thin < FLAT * longest) && longest <= max)
            grow_bounds(lo, hi, &pose->instances[i], mesh);
    }
}

void scene_pose_objects(const struct scene *scene, const struct scene_pose *pose, double lo[3],
                        double hi[3])
{
    double thin;
    double3_no_box(lo, hi);
    grow_objects(scene, pose, false, INFINITY, lo, hi);
    if (lo[0] <= hi[0]) {
        grow_objects(scene, pose, true, WIDER * box_sides(lo, hi, &thin), lo, hi);
        return;
    }
    memcpy(lo, pose->lo, 3 * sizeof *lo);
    memcpy(hi, pose->hi, 3 * sizeof *hi);
}

/* Matrices and their inverses become floats on the device. */
#define LARGEST_ENTRY 1e30

static bool is_in_range(const struct affine *matrix)
{
    bool in_range = affine_is_finite(matrix);
    for (int i = 0; i < 12; ++i)
        in_range = in_range && fabs(matrix->m[i]) <= LARGEST_ENTRY;
    return in_range;
}

bool scene_can_place(const struct affine *matrix)
{
    struct affine inverse;
    return is_in_range(matrix) && affine_invert(matrix, &inverse) && is_in_range(&inverse);
}

/* Places an instance whose scale is about zero along all axes, so that it may have no inverse in
   range, as a point that is too small to be seen. One that is flat is left as it is: it is seen. */
static void hide_point(struct affine *matrix)
{
    struct affine point = *matrix;
    for (int i = 0; i < 12; ++i) {
        if (i % 4 != 3 && !(fabs(matrix->m[i]) <= 2 * SMALLEST_ANIMATED_SCALE))
            return;
        if (i % 4 != 3)
            point.m[i] = i % 5 == 0 ? HIDDEN_SCALE : 0.0;
    }
    *matrix = point;
}

static whit_result pose_instances(const struct scene *scene, const struct affine *nodes,
                                  struct scene_pose *pose)
{
    for (uint32_t i = 0; i < scene->instance_count; ++i) {
        const struct scene_instance *instance = &scene->instances[i];
        struct affine matrix = instance_matrix(instance, nodes);
        if (!scene_can_place(&matrix))
            hide_point(&matrix);
        if (!scene_can_place(&matrix))
            return log_failure(&scene->log, WHIT_ERROR_INPUT,
                               "%s: instance %u `%s` is flat, too large or too far away at %g s",
                               scene->name, i, text_token(instance->name).text, pose->time_s);
        pose->instances[i] = matrix;
        grow_bounds(pose->lo, pose->hi, &matrix, &scene->meshes[instance->mesh]);
    }
    return WHIT_OK;
}

whit_result scene_pose_init(const struct scene *scene, double time_s, struct scene_pose *pose)
{
    *pose = (struct scene_pose){
        .time_s = time_s,
        .instance_count = scene->instance_count,
        .light_count = scene->light_count,
        .camera_count = scene->camera_count,
        .lo = {INFINITY, INFINITY, INFINITY},
        .hi = {-INFINITY, -INFINITY, -INFINITY},
    };
    if (!isfinite(time_s))
        return log_usage(&scene->log, "a time of %g s: it must be finite", time_s);
    whit_result result = WHIT_ERROR_MEMORY;
    struct affine *nodes = pose_nodes(scene, time_s);
    pose->instances = array_alloc(scene->instance_count, sizeof *pose->instances);
    pose->lights = array_alloc(scene->light_count, sizeof *pose->lights);
    pose->cameras = array_alloc(scene->camera_count, sizeof *pose->cameras);
    if (!nodes || !pose->instances || !pose->lights || !pose->cameras) {
        if (scene->frozen) /* else scene_freeze logs it */
            log_error(&scene->log, "%s: out of memory for the scene's pose", scene->name);
        goto fail;
    }
    result = pose_instances(scene, nodes, pose);
    if (result != WHIT_OK)
        goto fail;
    for (uint32_t i = 0; i < scene->light_count; ++i)
        pose->lights[i] = pose_light(&scene->lights[i], nodes);
    for (uint32_t i = 0; i < scene->camera_count; ++i)
        pose->cameras[i] = pose_camera(&scene->cameras[i], nodes);
    free(nodes);
    return WHIT_OK;
fail:
    free(nodes);
    scene_pose_finish(pose);
    return result;
}

void scene_pose_finish(struct scene_pose *pose)
{
    if (!pose)
        return;
    free(pose->instances);
    free(pose->lights);
    free(pose->cameras);
    *pose = (struct scene_pose){0};
}
