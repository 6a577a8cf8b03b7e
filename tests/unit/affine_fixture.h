/* A small kernel with specialization constants, a buffer and push constants. */
#ifndef AFFINE_FIXTURE_H
#define AFFINE_FIXTURE_H

#include "device_fixture.h"

#include "device_affine.h"

/* device_affine.comp; borrows `spec`: group size, factor, summand. It is pushed the number of
   values and one more summand. */
static inline struct pipeline_params affine_params(const uint32_t spec[3])
{
    struct pipeline_params params =
        storage_params(device_affine, sizeof device_affine, 1, "affine");
    params.spec = spec;
    params.spec_count = 3;
    params.push_bytes = 8;
    return params;
}

#endif
