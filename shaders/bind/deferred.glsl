// NUMERICS_EXACT: the list of deferred items, those with rays whose hits floats do not decide. A
// dispatch without SPEC_SETTLES lists them and does nothing else for them; a later one with
// SPEC_SETTLES takes them from the list. So the integer arithmetic, which few rays need, is in a
// kernel of its own.
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
