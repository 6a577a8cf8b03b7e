/* A traversal on the CPU that loses a ray now and then: `whit hard` has to find out. */
#include <math.h>

#include "accel/accel.h"
#include "twin/traverse.h"

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
