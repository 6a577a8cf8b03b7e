// NUMERICS_EXACT: the items of a dispatch whose rays are deferred, for floats do not decide their hits. A
// dispatch without SPEC_SETTLES lists them and does nothing else for them; one with SPEC_SETTLES behind it
// takes them from the list. So what hardly any ray needs is in a kernel of its own, which only they pay for.
#ifndef BIND_DEFERRED_GLSL
#define BIND_DEFERRED_GLSL

#include "trees.glsl"

layout(set = 0, binding = BIND_DEFERRED, std430) buffer WaitingBuffer
{
    gpu_work deferred;
    uint deferred_items[];
};

bool must_wait(uint status)
{
    return SPEC_SETTLES == 0u && (status & STATUS_RAY_DEFERRED) != 0u;
}

void list_deferred(uint item)
{
    atomicAdd(status_waits, 1u);
    uint at = atomicAdd(deferred.count, 1u);
    deferred_items[at] = item;
    atomicMax(deferred.groups_x, at / SPEC_GROUP_SIZE + 1u);
}

#endif
