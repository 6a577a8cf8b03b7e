/* Kernels that give the same bits on every device (shader/portable.h), and the devices that they
   run on. */
#ifndef RENDER_PORTABLE_H
#define RENDER_PORTABLE_H

#include "device/pipeline.h"
#include "shader/portable.h"

/* Found out once for a device and its driver, in about a second, and kept (base/store.h). */
WHIT_CHECK whit_result portable_find(const whit_log *log, struct device *device,
                                     whit_device_floats *out);

/* What kernels are made with for a device; WHIT_ERROR_DEVICE, logged, where it cannot be: it
   flushes denormals, or rounds sums otherwise. WHIT_OWN_DIVISION=0 in the environment: with the
   functions in place of the device's own division, for tests; WHIT_OWN_COMPARISON=0: the same of
   comparisons. `device` NULL: as for one that has everything. */
WHIT_CHECK whit_result portable_choose(const whit_log *log, struct device *device,
                                       struct portable_params *out);

/* A pipeline_rewrite; `user`: a struct portable_params. */
whit_result portable_rewrite(const void *user, const uint32_t *words, size_t word_count,
                             uint32_t **out, size_t *out_words, char why[REWRITE_WHY_BYTES]);
/* Another number for params with which other kernels are made. */
uint32_t portable_number(const struct portable_params *params);

#endif
