#include "view/camera.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/vec.h"
#include "settings/settings.h"

static const double STEEPEST = 0.998; /* largest cosine between direction and up */

/* Makes `a` a unit vector; false: it has no direction. */
static bool normalize(double a[3])
{
    double length = double3_length(a);
    double3_unit(a);
    return length > 0.0 && isfinite(length);
}

/* Rotates `v` around a unit axis (Rodrigues' formula). */
static void rotate(double v[3], const double axis[3], double angle)
{
    double c = cos(angle), s = sin(angle), along = double3_dot(axis, v), side[3];
    double3_cross(axis, v, side);
    for (int i = 0; i < 3; ++i)
        v[i] = v[i] * c + side[i] * s + axis[i] * along * (1.0 - c);
}

void camera_set(struct view_camera *camera, const double eye[3], const double target[3],
                const double up[3], double fov_y_degrees)
{
    *camera = (struct view_camera){.fov_y_degrees = fov_y_degrees};
    memcpy(camera->eye, eye, sizeof camera->eye);
    memcpy(camera->target, target, sizeof camera->target);
    memcpy(camera->up, up, sizeof camera->up);
}

/* Unit vectors of the picture, and the distance to the target. */
struct frame {
    double right[3], up[3], forward[3], distance;
};

static struct frame frame_of(const struct view_camera *camera)
{
    struct frame f;
    for (int i = 0; i < 3; ++i)
        f.forward[i] = camera->target[i] - camera->eye[i];
    f.distance = double3_length(f.forward);
    normalize(f.forward);
    double3_cross(f.forward, camera->up, f.right);
    if (!normalize(f.right)) {
        double other[3] = {0.0, 0.0, 0.0};
        other[fabs(f.forward[0]) < 0.5 ? 0 : 2] = 1.0;
        double3_cross(f.forward, other, f.right);
        normalize(f.right);
    }
    double3_cross(f.right, f.forward, f.up);
    return f;
}

/* Makes y the up axis of a view along it, whose direction `look` becomes as steep as turning
   allows. */
static void stand_up(struct view_camera *camera, double look[3])
{
    double size = double3_length(look), side = look[1] < 0.0 ? 1.0 : -1.0;
    if (!camera->along_y)
        return;
    for (int i = 0; i < 3; ++i)
        look[i] =
            STEEPEST * look[i] + sqrt(1.0 - STEEPEST * STEEPEST) * size * side * camera->up[i];
    memcpy(camera->up, (const double[3]){0.0, 1.0, 0.0}, sizeof camera->up);
    camera->along_y = false;
}

/* Gives the direction to the target, turned by the angles, but not beyond STEEPEST. */
static void turn(struct view_camera *camera, double right, double up, double look[3])
{
    for (int i = 0; i < 3; ++i)
        look[i] = camera->target[i] - camera->eye[i];
    stand_up(camera, look);
    double axis[3], side[3], tilted[3];
    memcpy(axis, camera->up, sizeof axis);
    normalize(axis);
    rotate(look, axis, -right);
    double3_cross(look, axis, side);
    if (!normalize(side))
        return;
    memcpy(tilted, look, sizeof tilted);
    rotate(tilted, side, up);
    double steep = double3_dot(tilted, axis) / double3_length(tilted);
    if (fabs(steep) < STEEPEST ||
        fabs(steep) < fabs(double3_dot(look, axis) / double3_length(look)))
        memcpy(look, tilted, sizeof tilted);
}

void camera_orbit(struct view_camera *camera, double right, double up)
{
    double look[3];
    turn(camera, right, up, look);
    for (int i = 0; i < 3; ++i)
        camera->eye[i] = camera->target[i] - look[i];
}

void camera_turn(struct view_camera *camera, double right, double up)
{
    double look[3];
    turn(camera, right, up, look);
    for (int i = 0; i < 3; ++i)
        camera->target[i] = camera->eye[i] + look[i];
}

void camera_fly(struct view_camera *camera, double right, double up, double forward)
{
    struct frame f = frame_of(camera);
    for (int i = 0; i < 3; ++i) {
        double step = f.distance * (right * f.right[i] + up * f.up[i] + forward * f.forward[i]);
        camera->eye[i] += step;
        camera->target[i] += step;
    }
}

void camera_zoom(struct view_camera *camera, double factor)
{
    double eye[3];
    bool apart = false, finite = true;
    for (int i = 0; i < 3; ++i) {
        eye[i] = camera->target[i] + factor * (camera->eye[i] - camera->target[i]);
        apart = apart || (float)eye[i] != (float)camera->target[i];
        finite = finite && isfinite((float)eye[i]);
    }
    if (apart && finite && factor > 0.0)
        memcpy(camera->eye, eye, sizeof eye);
}

void camera_focus(struct view_camera *camera, const double point[3])
{
    for (int i = 0; i < 3; ++i) {
        camera->eye[i] += point[i] - camera->target[i];
        camera->target[i] = point[i];
    }
}

void camera_reach(struct view_camera *camera, const double lo[3], const double hi[3])
{
    struct frame f = frame_of(camera);
    double along = 0.0, size = 0.0;
    if (!(lo[0] <= hi[0] && lo[1] <= hi[1] && lo[2] <= hi[2]))
        return;
    for (int i = 0; i < 3; ++i) {
        along += f.forward[i] * (0.5 * (lo[i] + hi[i]) - camera->eye[i]);
        size = fmax(size, hi[i] - lo[i]);
    }
    double distance = fmax(along, 0.25 * size);
    for (int i = 0; distance > 0.0 && isfinite(distance) && i < 3; ++i)
        camera->target[i] = camera->eye[i] + distance * f.forward[i];
}

/* The distance at which a ball just fits into the picture. */
static double distance_for(const struct view_camera *camera, double radius, double aspect)
{
    double half = camera->fov_y_degrees * PI / 360.0;
    if (aspect < 1.0)
        half = atan(tan(half) * aspect);
    return radius / sin(half);
}

void camera_show(struct view_camera *camera, const double lo[3], const double hi[3], double aspect)
{
    struct frame f = frame_of(camera);
    double radius = 0.0;
    for (int i = 0; i < 3; ++i) {
        radius += 0.25 * (hi[i] - lo[i]) * (hi[i] - lo[i]);
        camera->target[i] = 0.5 * (lo[i] + hi[i]);
    }
    radius = sqrt(radius);
    double distance = distance_for(camera, radius > 0.0 && isfinite(radius) ? radius : 1.0, aspect);
    for (int i = 0; i < 3; ++i) {
        if (!(lo[i] <= hi[i]))
            camera->target[i] = 0.0;
        camera->eye[i] = camera->target[i] - distance * f.forward[i];
    }
}

void camera_along(struct view_camera *camera, int axis, int from)
{
    double distance = frame_of(camera).distance;
    for (int i = 0; i < 3; ++i) {
        camera->eye[i] = camera->target[i] + (i == axis ? from * distance : 0.0);
        camera->up[i] = i == (axis == 1 ? 2 : 1) ? (axis == 1 ? -from : 1.0) : 0.0;
    }
    camera->along_y = axis == 1;
}

void camera_to_text(const struct view_camera *camera, char *text, size_t text_bytes)
{
    const double *e = camera->eye, *t = camera->target, *u = camera->up;
    snprintf(text, text_bytes, "%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", e[0], e[1],
             e[2], t[0], t[1], t[2], u[0], u[1], u[2], camera->fov_y_degrees);
}

bool camera_from_text(const char *text, struct view_camera *camera)
{
    const whit_camera read = camera_of_text(text);
    if (!read.own)
        return false;
    camera_set(camera, read.eye, read.target, read.up, read.fov_y_degrees);
    double side[3], look[3];
    for (int i = 0; i < 3; ++i)
        look[i] = read.target[i] - read.eye[i];
    double3_cross(look, camera->up, side);
    return double3_length(side) > 0.0 && read.fov_y_degrees > 0.0 && read.fov_y_degrees < 180.0;
}

bool camera_project(const struct view_camera *camera, const double a[3], const double b[3],
                    double width, double height, double line[4])
{
    struct frame f = frame_of(camera);
    double focal = 0.5 * height / tan(camera->fov_y_degrees * PI / 360.0);
    double near = 1e-3 * f.distance; /* relative to the scale of the view */
    double ends[2][3];
    for (int e = 0; e < 2; ++e) {
        double d[3];
        for (int i = 0; i < 3; ++i)
            d[i] = (e ? b : a)[i] - camera->eye[i];
        ends[e][0] = double3_dot(d, f.right);
        ends[e][1] = double3_dot(d, f.up);
        ends[e][2] = double3_dot(d, f.forward);
    }
    if (ends[0][2] < near && ends[1][2] < near)
        return false;
    for (int e = 0; e < 2; ++e) {
        double *end = ends[e];
        const double *other = ends[1 - e];
        if (end[2] < near) {
            double part = (near - end[2]) / (other[2] - end[2]);
            for (int i = 0; i < 3; ++i)
                end[i] += part * (other[i] - end[i]);
        }
        line[2 * e] = 0.5 * width + focal * end[0] / end[2];
        line[2 * e + 1] = 0.5 * height - focal * end[1] / end[2];
    }
    return true;
}
