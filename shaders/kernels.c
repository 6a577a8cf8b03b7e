#include "kernels.h"

#include "kernel_aov_hooks.h"
#include "kernel_closest.h"
#include "kernel_closest_hooks.h"
#include "kernel_hit_hooks.h"
#include "kernel_miss_hooks.h"
#include "kernel_portable.h"
#include "kernel_post_hooks.h"
#include "kernel_resolve.h"
#include "kernel_shade.h"
#include "kernel_shade_hooks.h"
#include "kernel_shadow.h"
#include "kernel_shadow_hooks.h"
#include "kernel_shape_hooks.h"
#include "kernel_test_hooks.h"
#include "kernel_trace.h"

const struct kernel_code kernels[KERNEL_COUNT] = {
    [KERNEL_TRACE] = {"trace", kernel_trace, sizeof kernel_trace},
    [KERNEL_CLOSEST] = {"closest", kernel_closest, sizeof kernel_closest},
    [KERNEL_SHADE] = {"shade", kernel_shade, sizeof kernel_shade},
    [KERNEL_SHADOW] = {"shadow", kernel_shadow, sizeof kernel_shadow},
    [KERNEL_RESOLVE] = {"resolve", kernel_resolve, sizeof kernel_resolve},
};

const struct kernel_code hook_kernels[HOOK_KERNEL_COUNT] = {
    [HOOK_KERNEL_CLOSEST] = {"closest", kernel_closest_hooks, sizeof kernel_closest_hooks},
    [HOOK_KERNEL_SHADE] = {"shade", kernel_shade_hooks, sizeof kernel_shade_hooks},
    [HOOK_KERNEL_SHADOW] = {"shadow", kernel_shadow_hooks, sizeof kernel_shadow_hooks},
    [HOOK_KERNEL_RESOLVE] = {"resolve", NULL, 0},
    [HOOK_KERNEL_MISS] = {"miss", kernel_miss_hooks, sizeof kernel_miss_hooks},
    [HOOK_KERNEL_SHAPE] = {"shape", kernel_shape_hooks, sizeof kernel_shape_hooks},
    [HOOK_KERNEL_HIT] = {"hit", kernel_hit_hooks, sizeof kernel_hit_hooks},
    [HOOK_KERNEL_AOV] = {"aov", kernel_aov_hooks, sizeof kernel_aov_hooks},
    [HOOK_KERNEL_POST] = {"post", kernel_post_hooks, sizeof kernel_post_hooks},
    [HOOK_KERNEL_TEST] = {"test", kernel_test_hooks, sizeof kernel_test_hooks},
};

const struct kernel_code portable_kernel = {"portable", kernel_portable, sizeof kernel_portable};
