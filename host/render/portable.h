/* Kernels that give the same bits on every device (shader/portable.h), and the devices that can run
   them. */
#ifndef RENDER_PORTABLE_H
#define RENDER_PORTABLE_H

#include "device/pipeline.h"
#include "shader/portable.h"

/* How the device computes with floats. It is measured once for a device and its driver, in about a
   second, and kept (base/store.h). */
WHIT_CHECK whit_result portable_find(const whit_log *log, struct device *device,
                                     whit_device_floats *out);

/* Gives what portable kernels of a device are made with. WHIT_ERROR_DEVICE, logged, where it can
   run none: it flushes denormals, or does not round sums to nearest. For tests, environment
   variables put portable functions in place of the device's own operations: WHIT_OWN_DIVISION=0 for
   division, WHIT_OWN_COMPARISON=0 for comparisons. `device` NULL: as for one whose own operations
   all do. */
WHIT_CHECK whit_result portable_choose(const whit_log *log, struct device *device,
                                       struct portable_params *out);

/* A pipeline_rewrite; `user`: a struct portable_params. */
whit_result portable_rewrite(const void *user, const uint32_t *words, size_t word_count,
                             uint32_t **out, size_t *out_words, char why[REWRITE_WHY_BYTES]);
/* A number that differs between params whose kernels differ. */
uint32_t portable_number(const struct portable_params *params);

#endif
