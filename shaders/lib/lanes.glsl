// Sums, maxima and other reductions over the invocations of a subgroup, all of which must call them.
#ifndef LIB_LANES_GLSL
#define LIB_LANES_GLSL

#include "../abi/spec.h"

// The bitwise or over the 8 lanes of a packet. On lavapipe shuffles are single instructions, while
// ballots and the like are loops over lanes.
uint gather_lanes(uint bits)
{
    bits |= subgroupShuffleXor(bits, 1u);
    bits |= subgroupShuffleXor(bits, 2u);
    return bits | subgroupShuffleXor(bits, 4u);
}

bool any_lane(bool wanted)
{
    return gather_lanes(uint(wanted)) != 0u;
}

// The sum of `wanted` over the subgroup's invocations before this one; `all`: over all of them.
uint count_before(uint wanted, out uint all)
{
    uint sum = wanted;
    if (SPEC_EIGHT_LANES != 0u) { // lavapipe has no faster way to add up lanes
        uint lane = gl_SubgroupInvocationID;
        uint other = subgroupShuffle(sum, (lane - 1u) & 7u);
        sum += lane >= 1u ? other : 0u;
        other = subgroupShuffle(sum, (lane - 2u) & 7u);
        sum += lane >= 2u ? other : 0u;
        other = subgroupShuffle(sum, (lane - 4u) & 7u);
        sum += lane >= 4u ? other : 0u;
        all = subgroupShuffle(sum, 7u);
    } else {
        sum = subgroupInclusiveAdd(wanted);
        all = subgroupAdd(wanted);
    }
    return sum - wanted;
}

// Whether the invocation is the first of its subgroup.
bool is_first_lane()
{
    return SPEC_EIGHT_LANES != 0u ? gl_SubgroupInvocationID == 0u : subgroupElect();
}

uint from_first(uint value)
{
    return SPEC_EIGHT_LANES != 0u ? subgroupShuffle(value, 0u) : subgroupBroadcastFirst(value);
}

// The maximum over the subgroup's invocations.
uint max_of_lanes(uint value)
{
    if (SPEC_EIGHT_LANES == 0u)
        return subgroupMax(value);
    value = max(value, subgroupShuffleXor(value, 1u));
    value = max(value, subgroupShuffleXor(value, 2u));
    return max(value, subgroupShuffleXor(value, 4u));
}

// The sum over the subgroup. `value` may hold two counters of 16 bits whose sums stay below 2^16.
uint add_up_lanes(uint value)
{
    if (SPEC_EIGHT_LANES == 0u)
        return subgroupAdd(value);
    value += subgroupShuffleXor(value, 1u);
    value += subgroupShuffleXor(value, 2u);
    return value + subgroupShuffleXor(value, 4u);
}

#endif
