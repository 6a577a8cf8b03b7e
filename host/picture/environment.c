/* The environment map, resampled once from longitude and latitude to an octahedral square that
   shaders read without trigonometry. */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/same.h"
#include "base/threads.h"
#include "base/vec.h"
#include "picture/environment.h"

enum { ENVIRONMENT_SIDE_MAX = 2048 };

struct resample {
    const struct scene_environment *from;
    uint32_t size;
    float *to; /* RGBA */
};

/* A point of the octahedral map, 0..1 each, to a unit direction: the inverse of
   lib/octahedron.glsl. */
static void dir_from_octahedron(double x, double y, double dir[3])
{
    double px = 2.0 * x - 1.0, pz = 2.0 * y - 1.0;
    double py = 1.0 - fabs(px) - fabs(pz);
    if (py < 0.0) {
        double folded_x = (1.0 - fabs(pz)) * (px >= 0.0 ? 1.0 : -1.0);
        double folded_z = (1.0 - fabs(px)) * (pz >= 0.0 ? 1.0 : -1.0);
        px = folded_x;
        pz = folded_z;
    }
    double length = sqrt(px * px + py * py + pz * pz);
    dir[0] = px / length, dir[1] = py / length, dir[2] = pz / length;
}

static void sample_map(const struct scene_environment *map, const double dir[3], float out[3])
{
    /* The middle of the map is at -z, u grows to the right as seen from inside; row 0 is up. */
    double u = 0.5 + same_atan2(dir[0], -dir[2]) / (2.0 * PI);
    double v = same_acos(fmax(-1.0, fmin(1.0, dir[1]))) / PI;
    double x = u * map->width - 0.5, y = v * map->height - 0.5;
    double x_floor = floor(x), y_floor = floor(y);
    double fx = x - x_floor, fy = y - y_floor;
    double sum[3] = {0, 0, 0};
    for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 2; ++i) {
            int64_t width = map->width, height = map->height;
            int64_t column = (((int64_t)x_floor + i) % width + width) % width;
            int64_t row = (int64_t)y_floor + j;
            row = row < 0 ? 0 : row >= height ? height - 1 : row;
            double weight = (i ? fx : 1.0 - fx) * (j ? fy : 1.0 - fy);
            const float *texel = &map->rgb[3 * (row * width + column)];
            for (int c = 0; c < 3; ++c)
                sum[c] += weight * (double)texel[c];
        }
    }
    for (int c = 0; c < 3; ++c)
        out[c] = (float)(sum[c] * (double)map->scale[c]);
}

static void resample_row(void *user, uint32_t y)
{
    const struct resample *job = user;
    for (uint32_t x = 0; x < job->size; ++x) {
        double dir[3];
        dir_from_octahedron((x + 0.5) / job->size, (y + 0.5) / job->size, dir);
        sample_map(job->from, dir, &job->to[4 * ((size_t)y * job->size + x)]);
    }
}

bool environment_resample(const struct scene_environment *environment, uint32_t *size,
                          float **texels)
{
    *size = 0;
    *texels = NULL;
    if (environment->kind != WHIT_ENVIRONMENT_MAP || !environment->rgb)
        return true;
    /* The square has about as many texels as the map. */
    double count = (double)environment->width * (double)environment->height;
    uint32_t side = (uint32_t)fmin(ceil(sqrt(count)), ENVIRONMENT_SIDE_MAX);
    struct resample job = {.from = environment, .size = side < 2 ? 2 : side};
    job.to = array_alloc_zeroed((size_t)job.size * job.size, 4 * sizeof(float));
    if (!job.to)
        return false;
    threads_for(0, job.size, resample_row, &job);
    *size = job.size;
    *texels = job.to;
    return true;
}
