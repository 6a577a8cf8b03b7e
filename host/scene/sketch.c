#include "scene/sketch.h"

#include <math.h>
#include <string.h>

#include "base/same.h"
#include "base/vec.h"

#define FILL 0.93 /* of the picture's height or width, by what is seen */

/* As fmin and fmax, but without their treatment of NaN, which makes each a function call. */
static double min(double a, double b)
{
    return a < b ? a : b;
}

static double max(double a, double b)
{
    return a > b ? a : b;
}

void view_make(const double toward_eye[3], double fov_y, struct view *out)
{
    memset(out, 0, sizeof *out);
    for (int i = 0; i < 3; ++i)
        out->forward[i] = -toward_eye[i];
    double3_unit(out->forward);
    double3_cross(out->forward, (const double[]){0, 1, 0}, out->right);
    double3_unit(out->right);
    double3_cross(out->right, out->forward, out->up);
    out->tan_y = same_tan(0.5 * fov_y);
    out->tan_x = out->tan_y * SKETCH_ACROSS / SKETCH_DOWN;
}

static void corner_in_view(const float corner[3], const struct view *view, double out[3])
{
    const double p[3] = {(double)corner[0], (double)corner[1], (double)corner[2]};
    out[0] = double3_dot(p, view->right);
    out[1] = double3_dot(p, view->up);
    out[2] = double3_dot(p, view->forward);
}

/* Puts the eye on the ray from the origin along `way`, as near as it can be with everything in the
   picture. Each side of the picture bounds every corner (x, y, z) relative to the eye c, both in
   the axes right, up, forward: for example x - c.x <= tan_x * (z - c.z). */
static void fit_distance(const float *corners, uint32_t count, const double way[3],
                         struct view *view)
{
    double tx = FILL * view->tan_x, ty = FILL * view->tan_y;
    double side = double3_dot(way, view->right), rise = double3_dot(way, view->up),
           back = -double3_dot(way, view->forward);
    double right = 0.0, left = 0.0, top = 0.0, bottom = 0.0;
    for (size_t i = 0; i < count; ++i) {
        double p[3];
        corner_in_view(corners + 3 * i, view, p);
        right = max(right, p[0] - tx * p[2]), left = max(left, -p[0] - tx * p[2]);
        top = max(top, p[1] - ty * p[2]), bottom = max(bottom, -p[1] - ty * p[2]);
    }
    double distance = fmax(right / (tx * back + side), left / (tx * back - side));
    distance = fmax(distance, top / (ty * back + rise));
    distance = fmax(distance, bottom / (ty * back - rise));
    if (!(distance > 0.0) || !isfinite(distance))
        distance = 1.0 / same_sin(VIEW_FOV_Y / 2.0);
    for (int i = 0; i < 3; ++i)
        view->eye[i] = distance * way[i];
}

/* Turns the view so that what is seen is in the middle of the picture. */
static void aim(const struct soup *soup, struct view *view)
{
    double lo[2] = {INFINITY, INFINITY}, hi[2] = {-INFINITY, -INFINITY}, back[3], eye[3];
    for (int i = 0; i < 3; ++i)
        eye[i] = view->eye[i];
    const double c[3] = {double3_dot(eye, view->right), double3_dot(eye, view->up),
                         double3_dot(eye, view->forward)};
    for (size_t i = 0; i < soup->outline_count; ++i) {
        double p[3];
        corner_in_view(soup->outline[i], view, p);
        for (int k = 0; k < 2; ++k) {
            double slope = (p[k] - c[k]) / fmax(p[2] - c[2], 1e-9);
            lo[k] = min(lo[k], slope), hi[k] = max(hi[k], slope);
        }
    }
    for (int i = 0; i < 3; ++i)
        back[i] = -(view->forward[i] + 0.5 * (lo[0] + hi[0]) * view->right[i] +
                    0.5 * (lo[1] + hi[1]) * view->up[i]);
    view_make(back, VIEW_FOV_Y, view);
    memcpy(view->eye, eye, sizeof eye);
}

void view_fit(const struct soup *soup, const double way[3], bool closely, struct view *view)
{
    double toward_eye[3] = {way[0], way[1], way[2]};
    double3_unit(toward_eye);
    view_make(toward_eye, VIEW_FOV_Y, view);
    fit_distance(soup->outline[0], soup->outline_count, toward_eye, view);
    for (int round = 0; closely && soup->outline_count && round < 4; ++round) {
        aim(soup, view);
        fit_distance(soup->outline[0], soup->outline_count, toward_eye, view);
    }
    if (closely)
        fit_distance(soup->corners, 3 * soup->fit_count, toward_eye, view);
}

/* pixel_from: the first pixel whose centre is at or above `low`. pixel_to: the last one at or below
   `high`. */
static int pixel_from(double low)
{
    double at = max(low - 0.5, 0.0);
    int pixel = at < SKETCH_ACROSS ? (int)at : SKETCH_ACROSS;
    return pixel + (pixel < at);
}

static int pixel_to(double high, int count)
{
    double at = min(high - 0.5, count - 1.0);
    return at >= 0.0 ? (int)at : -1;
}

/* Rasterizes a triangle with corners (pixel x, pixel y, 1 / depth). Of a front and a back in the
   same place the front is kept. */
static void draw_projected(struct sketch *sketch, const double a[3], const double b[3],
                           const double c[3], bool front, bool pictured)
{
    double area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    int x0 = pixel_from(min(min(a[0], b[0]), c[0])), y0 = pixel_from(min(min(a[1], b[1]), c[1]));
    int x1 = pixel_to(max(max(a[0], b[0]), c[0]), SKETCH_ACROSS);
    int y1 = pixel_to(max(max(a[1], b[1]), c[1]), SKETCH_DOWN);
    if (x0 > x1 || y0 > y1 || area == 0.0)
        return;
    for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
            double px = x + 0.5, py = y + 0.5;
            double u = ((px - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (py - a[1])) / area;
            double v = ((b[0] - a[0]) * (py - a[1]) - (px - a[0]) * (b[1] - a[1])) / area;
            if (u < 0.0 || v < 0.0 || u + v > 1.0)
                continue;
            float near = (float)(a[2] + u * (b[2] - a[2]) + v * (c[2] - a[2]));
            float there = sketch->nearness[y][x];
            if (near > there * (front ? 1.0f - 1e-5f : 1.0f + 1e-5f)) {
                sketch->nearness[y][x] = near;
                sketch->front[y][x] = front;
                sketch->pictured[y][x] = pictured;
            }
        }
    }
}

/* Clips a triangle to depths from `nearest` on; gives how many corners, up to 4, are in `out`. */
static uint32_t clip(double corners[3][3], double nearest, double out[4][3])
{
    uint32_t count = 0;
    for (int i = 0; i < 3; ++i) {
        const double *a = corners[i], *b = corners[(i + 1) % 3];
        if (a[2] >= nearest)
            memcpy(out[count++], a, 3 * sizeof *a);
        if ((a[2] >= nearest) != (b[2] >= nearest)) {
            double s = (nearest - a[2]) / (b[2] - a[2]);
            for (int k = 0; k < 3; ++k)
                out[count][k] = a[k] + s * (b[k] - a[k]);
            ++count;
        }
    }
    return count;
}

static void draw_triangle(const struct view *view, const float *corners, bool pictured,
                          struct sketch *sketch)
{
    double seen[3][3], clipped[4][3];
    for (int i = 0; i < 3; ++i) {
        double p[3];
        for (int k = 0; k < 3; ++k)
            p[k] = (double)corners[3 * i + k] - view->eye[k];
        seen[i][0] = double3_dot(p, view->right) / view->tan_x;
        seen[i][1] = double3_dot(p, view->up) / view->tan_y;
        seen[i][2] = double3_dot(p, view->forward);
    }
    /* Above 0 for a triangle that is counter-clockwise as seen from the eye, since the axes right,
       up, forward are left-handed. */
    double normal[3];
    double3_cross(seen[0], seen[1], normal);
    bool front = double3_dot(normal, seen[2]) > 0.0;
    uint32_t count = clip(seen, 1e-3, clipped);
    for (uint32_t i = 0; i < count; ++i) {
        clipped[i][2] = 1.0 / clipped[i][2];
        clipped[i][0] = 0.5 * SKETCH_ACROSS * (1.0 + clipped[i][0] * clipped[i][2]);
        clipped[i][1] = 0.5 * SKETCH_DOWN * (1.0 - clipped[i][1] * clipped[i][2]);
    }
    for (uint32_t i = 2; i < count; ++i)
        draw_projected(sketch, clipped[0], clipped[i - 1], clipped[i], front, pictured);
}

void sketch_draw(const struct soup *soup, const struct view *view, struct sketch *out)
{
    memset(out, 0, sizeof *out);
    for (uint32_t t = 0; t < soup->count; ++t)
        draw_triangle(view, soup->corners + 9 * (size_t)t, soup->pictured[t], out);
}

struct verdict view_judge(const struct soup *soup, const struct view *view, double nearness,
                          bool board)
{
    struct sketch sketch;
    int left = SKETCH_ACROSS, right = -1, top = SKETCH_DOWN, bottom = -1;
    uint32_t fronts = 0, seen = 0, level = 0, close = 0, pictures = 0, picture_fronts = 0;
    sketch_draw(soup, view, &sketch);
    for (int y = 0; y < SKETCH_DOWN; ++y) {
        for (int x = 0; x < SKETCH_ACROSS; ++x) {
            if (sketch.nearness[y][x] <= 0.0f)
                continue;
            ++seen;
            level += y == SKETCH_DOWN / 2;
            close += (double)sketch.nearness[y][x] >= nearness;
            fronts += sketch.front[y][x];
            pictures += sketch.pictured[y][x];
            picture_fronts += sketch.pictured[y][x] && sketch.front[y][x];
            left = x < left ? x : left, right = x > right ? x : right;
            top = y < top ? y : top, bottom = y;
        }
    }
    /* Too few pixels to judge, as of a sheet that is seen from its edge. */
    if (seen < SKETCH_ACROSS * SKETCH_DOWN / 50)
        return (struct verdict){0};
    double rectangle = (double)(right - left + 1) * (bottom - top + 1);
    double share = board && pictures ? (double)picture_fronts / pictures : (double)fronts / seen;
    return (struct verdict){share, seen / rectangle, (double)close / seen,
                            (double)level / SKETCH_ACROSS};
}
