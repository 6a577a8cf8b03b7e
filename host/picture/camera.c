/* Converts a camera of the scene, or the caller's own, to the vectors of gpu_frame that camera rays
   are made of. */
#include "picture/camera.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/same.h"
#include "base/vec.h"
#include "picture/sequence.h"

static bool fits_floats(const double v[3])
{
    return fabs(v[0]) <= (double)FLT_MAX && fabs(v[1]) <= (double)FLT_MAX &&
           fabs(v[2]) <= (double)FLT_MAX;
}

static bool is_index(const char *text, uint32_t count, uint32_t *index)
{
    char *end;
    unsigned long number = strtoul(text, &end, 10);
    *index = (uint32_t)number;
    return end != text && *end == '\0' && number < count;
}

static whit_result find_camera(const whit_log *log, const struct scene_pose *pose,
                               const whit_camera *wanted, struct scene_camera *out)
{
    uint32_t index = 0;
    if (wanted->own) {
        *out = (struct scene_camera){.kind = wanted->kind,
                                     .node = SCENE_NONE,
                                     .fov_y = (float)(wanted->fov_y_degrees * PI / 180.0),
                                     .height = (float)wanted->height,
                                     .lens_radius = (float)wanted->lens_radius,
                                     .focus_distance = (float)wanted->focus_distance};
        memcpy(out->eye, wanted->eye, sizeof out->eye);
        memcpy(out->target, wanted->target, sizeof out->target);
        memcpy(out->up, wanted->up, sizeof out->up);
        return WHIT_OK;
    }
    for (uint32_t i = 0; wanted->name && i < pose->camera_count; ++i) {
        if (pose->cameras[i].name && strcmp(pose->cameras[i].name, wanted->name) == 0) {
            *out = pose->cameras[i];
            return WHIT_OK;
        }
    }
    if (wanted->name ? !is_index(wanted->name, pose->camera_count, &index)
                     : pose->camera_count == 0) {
        log_error(log, "camera \"%s\": the scene has %u cameras, and none of that name",
                  wanted->name ? wanted->name : "", pose->camera_count);
        return WHIT_ERROR_USAGE;
    }
    *out = pose->cameras[index];
    return WHIT_OK;
}

static void scale_to_float(const double v[3], double scale, float out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = (float)(v[i] * scale);
}

/* Makes the camera's axes. The file's up is used unless it lies along the view direction; then
   another one. */
static bool make_basis(const struct scene_camera *camera, double forward[3], double right[3],
                       double up[3])
{
    double3_sub(camera->target, camera->eye, forward);
    if (!double3_normalize(forward))
        return false;
    double wanted[3] = {camera->up[0], camera->up[1], camera->up[2]};
    if (!double3_normalize(wanted))
        wanted[0] = 0.0, wanted[1] = 1.0, wanted[2] = 0.0;
    double3_cross(forward, wanted, right);
    if (double3_dot(right, right) < 1e-24) {
        int axis = fabs(forward[2]) < 0.5 ? 2 : 0;
        double other[3] = {axis == 0, 0.0, axis == 2};
        double3_cross(forward, other, right);
    }
    if (!double3_normalize(right))
        return false;
    double3_cross(right, forward, up);
    return double3_normalize(up);
}

static double length3(const float v[3])
{
    double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    return sqrt(x * x + y * y + z * z);
}

static whit_result refuse(const whit_log *log, const struct scene_camera *camera,
                          const char *reason)
{
    const char *name = camera->name ? camera->name : "by numbers";
    log_error(log, "camera \"%s\": %s", name, reason);
    return WHIT_ERROR_USAGE;
}

/* Half the height of the picture: at distance 1 from the eye, or (orthographic) in world units. */
static double half_height(const struct scene_camera *camera)
{
    switch (camera->kind) {
    case WHIT_CAMERA_PERSPECTIVE:
        return (double)camera->fov_y < PI ? same_tan(0.5 * (double)camera->fov_y) : 0.0;
    case WHIT_CAMERA_ORTHOGRAPHIC:
        return 0.5 * (double)camera->height;
    case WHIT_CAMERA_PANORAMA:
        break;
    }
    return 1.0;
}

static uint32_t kind_code(const struct scene_camera *camera)
{
    switch (camera->kind) {
    case WHIT_CAMERA_PERSPECTIVE:
        return camera->lens_radius > 0.0f ? CAMERA_LENS : CAMERA_PERSPECTIVE;
    case WHIT_CAMERA_ORTHOGRAPHIC:
        return CAMERA_ORTHOGRAPHIC;
    case WHIT_CAMERA_PANORAMA:
        break;
    }
    return CAMERA_PANORAMA;
}

static double focus_distance(const struct scene_camera *camera)
{
    return camera->focus_distance > 0.0f ? (double)camera->focus_distance
                                         : double3_distance(camera->target, camera->eye);
}

/* Rays' directions have components up to the lens over its focus, whose squares must be floats; in
   units of the picture's sides the lens must be a float too. */
static bool lens_fits_floats(const struct scene_camera *camera, double focus, double side)
{
    double size = (double)camera->lens_radius / focus;
    return size <= 0x1p60 && size / side <= 0x1p100;
}

whit_result camera_frame(const whit_log *log, const struct scene_pose *pose,
                         const whit_camera *wanted, uint32_t width, uint32_t height,
                         struct gpu_frame *frame, uint32_t *kind)
{
    struct scene_camera camera;
    whit_result result = find_camera(log, pose, wanted, &camera);
    if (result != WHIT_OK)
        return result;
    if ((unsigned)camera.kind > WHIT_CAMERA_PANORAMA)
        return refuse(log, &camera, "there is no such kind of camera");
    if (!fits_floats(camera.eye) || !fits_floats(camera.target) || !fits_floats(camera.up))
        return refuse(log, &camera, "eye, target or up is not finite, or too large for a float");
    double forward[3], right[3], up[3], half = half_height(&camera);
    if (!make_basis(&camera, forward, right, up))
        return refuse(log, &camera, "eye and target are the same point");
    if (!(half > 0.0) || !isfinite(half))
        return refuse(log, &camera,
                      camera.kind == WHIT_CAMERA_ORTHOGRAPHIC
                          ? "the height of the picture is not above 0"
                          : "the field of view is not between 0 and 180 degrees");
    *kind = kind_code(&camera);
    double focus = focus_distance(&camera);
    bool has_lens = isfinite(focus) && isfinite(camera.lens_radius) && camera.lens_radius >= 0.0f &&
                    camera.focus_distance >= 0.0f;
    if (camera.kind == WHIT_CAMERA_PERSPECTIVE && !has_lens)
        return refuse(log, &camera, "the lens or its focus is below 0 or not finite");
    double aspect = *kind == CAMERA_PANORAMA ? 1.0 : (double)width / (double)height;
    if (*kind == CAMERA_LENS && !lens_fits_floats(&camera, focus, half * fmin(aspect, 1.0)))
        return refuse(log, &camera, "the lens is too wide for its focus or its field of view");
    scale_to_float(camera.eye, 1.0, frame->eye);
    scale_to_float(forward, 1.0, frame->forward);
    scale_to_float(right, half * aspect, frame->right);
    scale_to_float(up, half, frame->up);
    frame->width = width;
    frame->inv_width = 1.0f / (float)width;
    frame->inv_height = 1.0f / (float)height;
    frame->height = height;
    frame->lens_radius = *kind == CAMERA_LENS ? camera.lens_radius : 0.0f;
    frame->focus_distance = (float)focus;
    return WHIT_OK;
}

double camera_pixel_area(const struct gpu_frame *frame, uint32_t kind)
{
    double sides =
        kind == CAMERA_PANORAMA ? 2.0 * PI * PI : 4.0 * length3(frame->right) * length3(frame->up);
    return sides / ((double)frame->width * (double)frame->height);
}

/* Maps the square to the disk, preserving areas and neighbourhoods (Shirley and Chiu 1997, A Low
   Distortion Map Between Disk and Square). Both have coordinates -1..1. */
static void square_to_disk(const double square[2], double disk[2])
{
    double a = square[0], b = square[1], radius, angle;
    if (a == 0.0 && b == 0.0) {
        radius = angle = 0.0;
    } else if (fabs(a) > fabs(b)) {
        radius = a;
        angle = PI / 4.0 * (b / a);
    } else {
        radius = b;
        angle = PI / 2.0 - PI / 4.0 * (a / b);
    }
    disk[0] = radius * same_cos(angle);
    disk[1] = radius * same_sin(angle);
}

void camera_sample(const struct gpu_frame *frame, uint32_t index, struct gpu_chunk *chunk)
{
    uint32_t pixel[2], lens[2];
    double square[2], disk[2];
    sequence_point(index, pixel);
    sequence_point(sequence_lens(index), lens);
    for (int i = 0; i < 2; ++i) {
        chunk->sample_xy[i] = (float)(pixel[i] * 0x1p-31 - 1.0);
        square[i] = lens[i] * 0x1p-31 - 1.0;
    }
    square_to_disk(square, disk);
    chunk->sample_index = index;
    chunk->light_index = sequence_light(index) * frame->light_samples;
    chunk->lens_xy[0] = chunk->lens_xy[1] = 0.0f;
    if (!(frame->lens_radius > 0.0f))
        return;
    double scale = (double)frame->lens_radius / (double)frame->focus_distance;
    chunk->lens_xy[0] = (float)(disk[0] * scale / length3(frame->right));
    chunk->lens_xy[1] = (float)(disk[1] * scale / length3(frame->up));
}

void sine_cosine_pi(float a, float *sine, float *cosine)
{
    float size = fabsf(a);
    uint32_t quarters = size > 0.75f ? 2 : size > 0.25f ? 1 : 0;
    float rest = size - 0.5f * (float)quarters, r2 = rest * rest;
    float s = ((((0.0821458866f * r2 - 0.599264529f) * r2 + 2.55016404f) * r2 - 5.16771278f) * r2 +
               3.14159265f) *
              rest;
    float c = ((((-0.0258068913f * r2 + 0.235330630f) * r2 - 1.33526277f) * r2 + 4.05871213f) * r2 -
               4.93480220f) *
                  r2 +
              1.0f;
    float turned = quarters == 0 ? s : quarters == 1 ? c : -s;
    *sine = a < 0.0f ? -turned : turned;
    *cosine = quarters == 0 ? c : quarters == 1 ? -s : -c;
}

/* The twin of camera_line in shaders/bind/camera.glsl. */
static void camera_line(const struct gpu_frame *frame, uint32_t kind, const float lens_xy[2],
                        const float at[2], float origin[3], float dir[3])
{
    float turn_sine, turn_cosine, rise_sine, rise_cosine;
    sine_cosine_pi(at[0], &turn_sine, &turn_cosine);
    sine_cosine_pi(at[1] * -0.5f, &rise_sine, &rise_cosine);
    for (int i = 0; i < 3; ++i) {
        float in_plane = frame->right[i] * at[0] - frame->up[i] * at[1];
        float aimed = frame->forward[i] + in_plane;
        float aside = frame->right[i] * lens_xy[0] + frame->up[i] * lens_xy[1];
        float level = frame->forward[i] * turn_cosine + frame->right[i] * turn_sine;
        origin[i] = frame->eye[i];
        dir[i] = aimed;
        switch (kind) {
        case CAMERA_ORTHOGRAPHIC:
            origin[i] = frame->eye[i] + in_plane;
            dir[i] = frame->forward[i];
            break;
        case CAMERA_LENS:
            origin[i] = frame->eye[i] + aside * frame->focus_distance;
            dir[i] = aimed - aside;
            break;
        case CAMERA_PANORAMA:
            dir[i] = level * rise_cosine + frame->up[i] * rise_sine;
            break;
        default:
            break;
        }
    }
}

/* The twin of inverse_square_root in shaders/lib/angles.glsl. */
static float inverse_square_root(float x)
{
    float y = float_of_bits(0x5f375a86u - (float_bits(x) >> 1)), half_x = 0.5f * x;
    for (int i = 0; i < 4; ++i)
        y = y * (1.5f - (half_x * y) * y);
    return y;
}

/* The twin of mirror_sample in shaders/bind/camera.glsl. */
void camera_mirror_sample(const float xy[2], uint32_t x, uint32_t y, float out[2])
{
    out[0] = (x ^ y) & 1u ? -xy[0] : xy[0];
    out[1] = x & 1u ? -xy[1] : xy[1];
}

void camera_ray(const struct gpu_frame *frame, uint32_t kind, uint32_t x, uint32_t y,
                const struct gpu_chunk *sample, struct gpu_ray *ray)
{
    float place[2], lens[2];
    camera_mirror_sample(sample->sample_xy, x, y, place);
    camera_mirror_sample(sample->lens_xy, x, y, lens);
    const float at[2] = {
        ((float)x * 2.0f + 1.0f - (float)frame->width + place[0]) * frame->inv_width,
        ((float)y * 2.0f + 1.0f - (float)frame->height + place[1]) * frame->inv_height};
    float dir[3];
    camera_line(frame, kind, lens, at, ray->origin, dir);
    float shorten = inverse_square_root((dir[0] * dir[0] + dir[1] * dir[1]) + dir[2] * dir[2]);
    for (int i = 0; i < 3; ++i)
        ray->dir[i] = dir[i] * shorten;
    ray->t_min = 0.0f;
    ray->t_max = INFINITY;
}

whit_result camera_all_rays(const whit_log *log, const struct scene_pose *pose,
                            const whit_camera *camera, uint32_t width, uint32_t height,
                            struct gpu_ray *rays)
{
    struct gpu_frame frame = {0};
    struct gpu_chunk sample = {0};
    uint32_t kind;
    whit_result result = camera_frame(log, pose, camera, width, height, &frame, &kind);
    if (result != WHIT_OK)
        return result;
    camera_sample(&frame, 0, &sample);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            camera_ray(&frame, kind, x, y, &sample, rays++);
    return WHIT_OK;
}
