/* `whit hard`: the table of cases, and the picture of wrong hits. */
#ifndef HARD_RUN_H
#define HARD_RUN_H

#include "hard/hard.h"

/* An interface to trace rays on a device; this module does not know Vulkan. */
struct hard_device {
    /* Finds the closest hits of `count` rays in `accel`, which is posed at `time_s`, at level
       `numerics` (NUMERICS_*); *device_ms: time of the traversals. WHIT_ERROR_STATUS, logged like
       other errors, where the hits cannot be trusted. */
    whit_result (*trace)(const struct hard_device *device, const whit_log *log, struct accel *accel,
                         double time_s, uint32_t numerics, const struct gpu_ray *rays,
                         uint64_t count, struct gpu_hit *hits, double *device_ms);
    void *user;
    bool equal_bits; /* as of whit_hard_report */
};

/* As whit_hard_run; `device` and `scene` may be NULL; `flatten`: a single tree for the scene. */
WHIT_CHECK whit_result hard_run(const struct hard_device *device, const struct scene *scene,
                                bool flatten, const whit_hard_params *params, const whit_log *log,
                                whit_hard_report **out);
void hard_report_destroy(whit_hard_report *report);

/* As whit_hard_view: `pixels` are 3 floats for each of the rays of params->width x height. */
WHIT_CHECK whit_result hard_view(const struct hard_device *device, const struct scene *scene,
                                 bool flatten, const whit_hard_view_params *params,
                                 const whit_log *log, float *pixels, uint64_t *wrong,
                                 uint64_t *other);

#endif
