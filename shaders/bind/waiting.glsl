// NUMERICS_EXACT: the items of a dispatch whose rays floats leave open. A dispatch without SPEC_LOOKS
// lists them and does nothing else for them; one with SPEC_LOOKS behind it takes them from the list. So
// what hardly any ray needs is in a kernel of its own, which only those rays pay for.
#ifndef BIND_WAITING_GLSL
#define BIND_WAITING_GLSL

#include "trees.glsl"

layout(set = 0, binding = BIND_WAITING, std430) buffer WaitingBuffer
{
    gpu_work waiting;
    uint waiting_items[];
};

bool must_wait(uint status)
{
    return SPEC_LOOKS == 0u && (status & STATUS_RAY_WAITS) != 0u;
}

void list_waiting(uint item)
{
    atomicAdd(status_waits, 1u);
    uint at = atomicAdd(waiting.count, 1u);
    waiting_items[at] = item;
    atomicMax(waiting.groups_x, at / SPEC_GROUP_SIZE + 1u);
}

#endif
