/* A traversal on the CPU that loses a ray now and then: `whit hard` has to find out. And a device
   whose kernels that are not portable lose one: `whit check` asks it for portable ones. */
#include <math.h>

#include "accel/accel.h"
#include "twin/traverse.h"
#include "whit.h"

void __real_traverse_ray(const struct accel *accel, const struct traverse_params *params,
                         const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                         uint32_t *status);
void __wrap_traverse_ray(const struct accel *accel, const struct traverse_params *params,
                         const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                         uint32_t *status);

void __wrap_traverse_ray(const struct accel *accel, const struct traverse_params *params,
                         const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                         uint32_t *status)
{
    __real_traverse_ray(accel, params, ray, hit, cost, status);
    if (ray->dir[0] > 0.0f && ray->dir[0] < 0.01f)
        *hit = (struct gpu_hit){.t = INFINITY, .primitive = HIT_NONE, .instance = HIT_NONE};
}

whit_result __real_whit_hard_view(whit_device *device, const whit_scene *scene,
                                  const whit_hard_view_params *params, const whit_log *log,
                                  uint64_t *wrong_pixels, uint64_t *other_pixels, whit_image **out);
whit_result __wrap_whit_hard_view(whit_device *device, const whit_scene *scene,
                                  const whit_hard_view_params *params, const whit_log *log,
                                  uint64_t *wrong_pixels, uint64_t *other_pixels, whit_image **out);

whit_result __wrap_whit_hard_view(whit_device *device, const whit_scene *scene,
                                  const whit_hard_view_params *params, const whit_log *log,
                                  uint64_t *wrong_pixels, uint64_t *other_pixels, whit_image **out)
{
    whit_result result =
        __real_whit_hard_view(device, scene, params, log, wrong_pixels, other_pixels, out);
    *wrong_pixels += params == NULL || !params->portable;
    return result;
}
