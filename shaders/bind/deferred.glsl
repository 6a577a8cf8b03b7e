// NUMERICS_EXACT: the list of deferred items, those with rays whose hits floats do not decide. A
// dispatch without SPEC_SETTLES lists them and does nothing else for them; a later one with
// SPEC_SETTLES takes them from the list. So the integer arithmetic, which few rays need, is in a
// kernel of its own.
#ifndef BIND_DEFERRED_GLSL
#define BIND_DEFERRED_GLSL

#include "../lib/lanes.glsl"
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

// Counts the listed items once, in the dispatch that takes them.
void count_deferred()
{
    if (gl_GlobalInvocationID.x == 0u)
        atomicAdd(status_waits, deferred.count);
}

// Lists an item of each invocation where `wanted`. All invocations of the subgroup must take part.
void list_deferred(bool wanted, uint item)
{
    uint all, before = count_before(uint(wanted), all), at = 0u;
    if (is_first_lane() && all != 0u) {
        at = atomicAdd(deferred.count, all);
        atomicMax(deferred.groups_x, (at + all - 1u) / SPEC_DEFERRED_GROUP + 1u);
    }
    at = from_first(at) + before;
    if (wanted)
        deferred_items[at] = item;
}

// Lists items[r] where wanted[r], for all rays `r` of the invocation. A round of the loop lists one
// of them. lavapipe runs one round always, and mostly no ray needs it.
void list_deferred_rays(bool wanted[SPEC_PACKET_RAYS], uint items[SPEC_PACKET_RAYS])
{
    bool more = false;
    do {
        bool some = false;
        uint item = 0u;
        more = false;
        for (uint r = 0u; r < SPEC_PACKET_RAYS; r++) {
            bool next = wanted[r] && !some;
            item = next ? items[r] : item;
            some = some || next;
            wanted[r] = wanted[r] && !next;
            more = more || wanted[r];
        }
        list_deferred(some, item);
        more = add_up_lanes(uint(more)) != 0u;
    } while (SPEC_PACKET_RAYS > 1u && more);
}

#endif
