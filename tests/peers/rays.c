/* Sets of rays, the same on every machine for a seed. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/vec.h"
#include "peers.h"
#include "picture/camera.h"

static void print_log(void *user, whit_log_level level, const char *message)
{
    (void)user;
    fprintf(stderr, "%s%s\n", level == WHIT_LOG_ERROR ? "error: " : "", message);
}

const whit_log peers_log = {.fn = print_log, .level = WHIT_LOG_ERROR};

struct gpu_ray ray_to(const double origin[3], const double target[3])
{
    struct gpu_ray ray = {.t_max = INFINITY};
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = (float)origin[k];
        ray.dir[k] = (float)(target[k] - (double)ray.origin[k]);
    }
    return ray;
}

/* On its surface, or at its centre. */
static void sphere_target(const float *sphere, uint64_t *state, double out[3])
{
    double arm[3], length = 0.0;
    bool center = random_bits64(state) % 8 == 0;
    for (int k = 0; k < 3; ++k) {
        arm[k] = random_signed(state);
        length += arm[k] * arm[k];
    }
    for (int k = 0; k < 3; ++k)
        out[k] = (double)sphere[k] +
                 (center ? 0.0 : (double)sphere[3] * arm[k] / sqrt(fmax(length, 1e-30)));
}

void random_target(const struct scene *scene, const struct scene_pose *pose, uint64_t *state,
                   double out[3])
{
    uint32_t i, primitives;
    do {
        i = (uint32_t)(random_bits64(state) % scene->instance_count);
        primitives = scene_mesh_primitives(&scene->meshes[scene->instances[i].mesh]);
    } while (primitives == 0);
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[i].mesh];
    if (mesh->sphere_count) {
        sphere_target(&mesh->spheres[4 * (size_t)(random_bits64(state) % primitives)], state, out);
        affine_point(&pose->instances[i], (const double[]){out[0], out[1], out[2]}, out);
        return;
    }
    const uint32_t *corners = &mesh->indices[3 * (size_t)(random_bits64(state) % primitives)];
    uint32_t first = (uint32_t)(random_bits64(state) % 3);
    const float *a = &mesh->positions[3 * (size_t)corners[first]];
    const float *b = &mesh->positions[3 * (size_t)corners[(first + 1) % 3]];
    double s = random_bits64(state) & 1 ? 0.0 : random_unit(state), at[3];
    for (int k = 0; k < 3; ++k)
        at[k] = (double)a[k] + s * ((double)b[k] - (double)a[k]);
    affine_point(&pose->instances[i], at, out);
}

/* The camera ray of a random pixel of a 16:9 picture. */
static struct gpu_ray primary_ray(const struct gpu_frame *frame, uint32_t kind, uint64_t *state)
{
    const struct gpu_chunk middle = {0};
    uint32_t x = (uint32_t)(random_bits64(state) % frame->width);
    uint32_t y = (uint32_t)(random_bits64(state) % frame->height);
    struct gpu_ray ray;
    camera_ray(frame, kind, x, y, &middle, &ray);
    return ray;
}

/* In the bounds, stretched about their middle. */
static void random_point(const struct scene_pose *pose, double stretch, uint64_t *state,
                         double out[3])
{
    for (int k = 0; k < 3; ++k)
        out[k] = 0.5 * (pose->lo[k] + pose->hi[k]) +
                 0.5 * stretch * random_signed(state) * (pose->hi[k] - pose->lo[k]);
}

void rays_fill(enum ray_kind kind, const struct scene *scene, const struct scene_pose *pose,
               uint64_t seed, struct gpu_ray *rays, uint64_t count)
{
    const whit_camera first = {0};
    struct gpu_frame frame = {0};
    uint32_t camera = CAMERA_PERSPECTIVE;
    if (camera_frame(&peers_log, pose, &first, 4096, 2304, &frame, &camera) != WHIT_OK)
        exit(2);
    uint64_t state = seed * RAYS_KINDS + (uint64_t)kind;
    for (uint64_t i = 0; i < count; ++i) {
        double from[3], to[3];
        if (kind == RAYS_PRIMARY) {
            rays[i] = primary_ray(&frame, camera, &state);
            continue;
        }
        random_point(pose, 1.5, &state, from);
        if (kind == RAYS_RANDOM)
            random_point(pose, 1.0, &state, to);
        else
            random_target(scene, pose, &state, to);
        rays[i] = ray_to(from, to);
    }
}
