/* Camera rays in double, with the kernels' cameras and sample patterns. */
#include "reference/camera.h"
#include "base/same.h"
#include "base/vec.h"
#include "reference/media.h"

static struct dvec3 in_panorama(const struct gpu_frame *frame, double x, double y)
{
    double longitude = PI * x, latitude = -0.5 * PI * y;
    struct dvec3 level = dvec3_along(d3_scale(d3_load(frame->forward), same_cos(longitude)),
                                     d3_load(frame->right), same_sin(longitude));
    return dvec3_along(d3_scale(level, same_cos(latitude)), d3_load(frame->up), same_sin(latitude));
}

/* Sets a camera ray's origin and direction. x, y: -1..1, left to right and top to bottom. */
static void take_line(const struct reference *reference, double x, double y, const float lens_xy[2],
                      struct ray *ray)
{
    const struct gpu_frame *frame = &reference->frame;
    struct dvec3 right = d3_load(frame->right), up = d3_load(frame->up);
    struct dvec3 aside = dvec3_along(d3_scale(right, x), up, -y);
    ray->origin = d3_load(frame->eye);
    ray->dir = d3_add(d3_load(frame->forward), aside);
    if (reference->camera == CAMERA_PANORAMA)
        ray->dir = in_panorama(frame, x, y);
    if (reference->camera == CAMERA_ORTHOGRAPHIC) {
        ray->origin = d3_add(ray->origin, aside);
        ray->dir = d3_load(frame->forward);
    }
    if (reference->camera == CAMERA_LENS) { /* rays of one (x, y) meet in the focus plane */
        struct dvec3 on_lens =
            dvec3_along(d3_scale(right, (double)lens_xy[0]), up, (double)lens_xy[1]);
        ray->origin = dvec3_along(ray->origin, on_lens, (double)frame->focus_distance);
        ray->dir = dvec3_sub(ray->dir, on_lens);
    }
    ray->dir = d3_unit_or(ray->dir, d3(0, 0, -1));
}

struct ray camera_first_ray(const struct reference *reference, uint32_t x, uint32_t y,
                            uint32_t sample)
{
    const struct gpu_frame *frame = &reference->frame;
    struct gpu_chunk chunk = {0};
    struct ray ray = {.weight = d3_all(1.0),
                      .media = media_around_eye(reference),
                      .kind = REFERENCE_PRIMARY,
                      .skip_instance = HIT_NONE,
                      .skip_primitive = HIT_NONE,
                      .node = REFERENCE_NONE};
    camera_sample(frame, sample, &chunk);
    float place[2], lens[2];
    camera_mirror_sample(chunk.sample_xy, x, y, place);
    camera_mirror_sample(chunk.lens_xy, x, y, lens);
    double at_x = (2.0 * x + 1.0 + (double)place[0]) / frame->width - 1.0;
    double at_y = (2.0 * y + 1.0 + (double)place[1]) / frame->height - 1.0;
    take_line(reference, at_x, at_y, lens, &ray);
    return ray;
}

double camera_texel_area(const struct reference *reference, uint32_t x, uint32_t y, uint32_t sample,
                         double way)
{
    const struct gpu_frame *frame = &reference->frame;
    double area = camera_pixel_area(frame, reference->camera) * mipmap_sample_share(sample) /
                  MIPMAP_PIXEL_TEXELS;
    double at_x = (2.0 * x + 1.0) / frame->width - 1.0;
    double at_y = (2.0 * y + 1.0) / frame->height - 1.0;
    if (reference->camera == CAMERA_ORTHOGRAPHIC)
        return area;
    if (reference->camera == CAMERA_PANORAMA)
        return area * way * way * same_cos(0.5 * PI * at_y);
    double aside_x = at_x * d3_length(d3_load(frame->right));
    double aside_y = at_y * d3_length(d3_load(frame->up));
    return area * way * way / same_pow(1.0 + aside_x * aside_x + aside_y * aside_y, 1.5);
}
