/* From a camera of the scene, or ten numbers, to the vectors that camera rays are made of. */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/renderer.h"

static const double PI = 3.14159265358979323846;

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = a[i] - b[i];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* False for the zero vector and for what is not finite. */
static bool normalize(double v[3])
{
    double size = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (!(size > 0.0) || !isfinite(size))
        return false;
    double x = v[0] / size, y = v[1] / size, z = v[2] / size;
    double length = sqrt(x * x + y * y + z * z);
    v[0] = x / length, v[1] = y / length, v[2] = z / length;
    return true;
}

static bool parse_numbers(const char *text, double *numbers, int count)
{
    for (int i = 0; i < count; ++i) {
        char *end;
        errno = 0;
        numbers[i] = strtod(text, &end);
        if (end == text || errno == ERANGE || !isfinite(numbers[i]))
            return false;
        if (*end != (i + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

static whit_result find_camera(const struct log *log, const struct scene_pose *pose,
                               const char *selector, struct scene_camera *out)
{
    if (!selector) {
        if (pose->camera_count == 0)
            return WHIT_ERROR_USAGE;
        *out = pose->cameras[0];
        return WHIT_OK;
    }
    for (uint32_t i = 0; i < pose->camera_count; ++i) {
        if (pose->cameras[i].name && strcmp(pose->cameras[i].name, selector) == 0) {
            *out = pose->cameras[i];
            return WHIT_OK;
        }
    }
    double numbers[10];
    if (parse_numbers(selector, numbers, 10)) {
        *out = (struct scene_camera){.kind = SCENE_CAMERA_PERSPECTIVE,
                                     .node = SCENE_NONE,
                                     .fov_y = (float)(numbers[9] * PI / 180.0)};
        memcpy(out->eye, numbers, sizeof out->eye);
        memcpy(out->target, numbers + 3, sizeof out->target);
        memcpy(out->up, numbers + 6, sizeof out->up);
        return WHIT_OK;
    }
    char *end;
    unsigned long index = strtoul(selector, &end, 10);
    if (end != selector && *end == '\0' && index < pose->camera_count) {
        *out = pose->cameras[index];
        return WHIT_OK;
    }
    log_error(log,
              "camera \"%s\": not a camera of the scene (it has %u), nor "
              "eye,target,up,fov as ten numbers",
              selector, pose->camera_count);
    return WHIT_ERROR_USAGE;
}

static void scale_to_float(const double v[3], double scale, float out[3])
{
    for (int i = 0; i < 3; ++i)
        out[i] = (float)(v[i] * scale);
}

/* Any up that is not along the view; the file's, where it can be. */
static bool make_basis(const struct scene_camera *camera, double forward[3], double right[3],
                       double up[3])
{
    subtract(camera->target, camera->eye, forward);
    if (!normalize(forward))
        return false;
    double wanted[3] = {camera->up[0], camera->up[1], camera->up[2]};
    if (!normalize(wanted))
        wanted[0] = 0.0, wanted[1] = 1.0, wanted[2] = 0.0;
    cross(forward, wanted, right);
    double sine2 = right[0] * right[0] + right[1] * right[1] + right[2] * right[2];
    if (sine2 < 1e-24) {
        int axis = fabs(forward[2]) < 0.5 ? 2 : 0;
        double other[3] = {axis == 0, 0.0, axis == 2};
        cross(forward, other, right);
    }
    if (!normalize(right))
        return false;
    cross(right, forward, up);
    return normalize(up);
}

whit_result camera_frame(const struct log *log, const struct scene_pose *pose, const char *selector,
                         uint32_t width, uint32_t height, struct gpu_frame *frame,
                         bool *orthographic)
{
    struct scene_camera camera;
    whit_result result = find_camera(log, pose, selector, &camera);
    if (result != WHIT_OK)
        return result;
    double forward[3], right[3], up[3];
    if (!make_basis(&camera, forward, right, up)) {
        log_error(log, "camera \"%s\": eye and target are the same point or not finite",
                  selector      ? selector
                  : camera.name ? camera.name
                                : "");
        return WHIT_ERROR_USAGE;
    }
    *orthographic = camera.kind == SCENE_CAMERA_ORTHOGRAPHIC;
    double half = *orthographic ? 0.5 * (double)camera.height : tan(0.5 * (double)camera.fov_y);
    if (!(half > 0.0) || !isfinite(half) || (!*orthographic && !((double)camera.fov_y < PI))) {
        log_error(log, "camera \"%s\": the field of view is not between 0 and 180 degrees",
                  selector      ? selector
                  : camera.name ? camera.name
                                : "");
        return WHIT_ERROR_USAGE;
    }
    double aspect = (double)width / (double)height;
    scale_to_float(camera.eye, 1.0, frame->eye);
    scale_to_float(forward, 1.0, frame->forward);
    scale_to_float(right, half * aspect, frame->right);
    scale_to_float(up, half, frame->up);
    frame->width = width;
    frame->height = height;
    return WHIT_OK;
}

void camera_ray(const struct gpu_frame *frame, bool orthographic, float x, float y,
                struct gpu_ray *ray)
{
    float at_x = x / (float)frame->width * 2.0f - 1.0f;
    float at_y = y / (float)frame->height * 2.0f - 1.0f;
    float dir[3];
    for (int i = 0; i < 3; ++i) {
        float in_plane = frame->right[i] * at_x - frame->up[i] * at_y;
        ray->origin[i] = orthographic ? frame->eye[i] + in_plane : frame->eye[i];
        dir[i] = orthographic ? frame->forward[i] : frame->forward[i] + in_plane;
    }
    float size = sqrtf((dir[0] * dir[0] + dir[1] * dir[1]) + dir[2] * dir[2]);
    for (int i = 0; i < 3; ++i)
        ray->dir[i] = dir[i] / size;
    ray->t_min = 0.0f;
    ray->t_max = INFINITY;
}
