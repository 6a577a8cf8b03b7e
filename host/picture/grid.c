#include "picture/grid.h"

#include <math.h>

#include "base/same.h"

/* The height of the ground, the spacing of its lines, and the centre and radius of the grid. */
struct ground {
    double height, step, center[2], radius;
};

/* The largest of 1, 2 and 5 times powers of ten that is not above `value`. */
static double round_down(double value)
{
    double power = same_pow(10.0, floor(same_log10(value))), digits = value / power;
    return power * (digits >= 5.0 ? 5.0 : digits >= 2.0 ? 2.0 : 1.0);
}

static struct ground find_ground(const struct scene_pose *pose)
{
    const double *lo = pose->lo, *hi = pose->hi;
    double size = fmax(fmax(hi[0] - lo[0], hi[1] - lo[1]), hi[2] - lo[2]);
    if (!(size >= 0.0)) /* the scene is empty */
        return (struct ground){.step = 0.2, .radius = 2.0};
    if (!(size > 0.0))
        size = 1.0;
    return (struct ground){
        /* Slightly below a floor that is the bottom of the scene. */
        .height = lo[1] - 1e-4 * size,
        .step = round_down(size / 5.0),
        .center = {0.5 * (lo[0] + hi[0]), 0.5 * (lo[2] + hi[2])},
        .radius = 2.0 * size,
    };
}

/* Returns the t at which a ray meets the ground, and the place (x, z) in `at`; a negative result
   means that it does not. */
static double meet(const struct ground *ground, const struct gpu_ray *ray, double at[2])
{
    double t = (ground->height - (double)ray->origin[1]) / (double)ray->dir[1];
    if (!(t > 0.0) || !isfinite(t))
        return -1.0;
    at[0] = (double)ray->origin[0] + t * (double)ray->dir[0];
    at[1] = (double)ray->origin[2] + t * (double)ray->dir[2];
    return t;
}

/* The share of a pixel that grid lines cover. `at`, `right` and `below` are the points on the
   ground that the pixel and its two neighbours see. Lines are about a pixel wide, and vanish where
   two would fall into one pixel. */
static double cover_of(const struct ground *ground, const double at[2], const double right[2],
                       const double below[2])
{
    double x = at[0] - ground->center[0], y = at[1] - ground->center[1];
    double most = 0.0, away = sqrt(x * x + y * y);
    for (int k = 0; k < 2; ++k) {
        double wide = fmax(fabs(right[k] - at[k]), fabs(below[k] - at[k])) / ground->step;
        double place = at[k] / ground->step, off = fabs(place - round(place));
        double line = wide > 0.0 ? fmax(1.0 - off / wide, 0.0) : off == 0.0;
        most = fmax(most, line * fmin(fmax(2.0 - 4.0 * wide, 0.0), 1.0));
    }
    return most * fmin(fmax(2.0 - away / ground->radius, 0.0), 1.0);
}

void grid_cover(const struct scene_pose *pose, uint32_t width, uint32_t height,
                struct gpu_ray *rays, float *cover)
{
    const struct ground ground = find_ground(pose);
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            /* Neighbours to the right and below; in the last column or row, to the left or
               above. */
            size_t here = (size_t)y * width + x;
            size_t right = x + 1 < width ? here + 1 : x ? here - 1 : here;
            size_t below = y + 1 < height ? here + width : y ? here - width : here;
            double at[2], beside[2][2], t = meet(&ground, &rays[here], at);
            bool whole = t > 0.0 && meet(&ground, &rays[right], beside[0]) > 0.0 &&
                         meet(&ground, &rays[below], beside[1]) > 0.0;
            cover[here] = whole ? (float)cover_of(&ground, at, beside[0], beside[1]) : 0.0f;
            rays[here].t_max = cover[here] > 0.0f ? (float)t : -1.0f;
        }
    }
}
