#include "kernels.h"

#include "kernel_present.h"
#include "kernel_trace.h"
#include "kernel_whitted.h"

const struct kernel_code kernels[KERNEL_COUNT] = {
    [KERNEL_TRACE] = {"trace", kernel_trace, sizeof kernel_trace},
    [KERNEL_PRESENT] = {"present", kernel_present, sizeof kernel_present},
    [KERNEL_WHITTED] = {"whitted", kernel_whitted, sizeof kernel_whitted},
};
