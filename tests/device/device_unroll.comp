#version 450
#extension GL_EXT_control_flow_attributes : require
/* Loops that evaluate_loops.c unrolls for small TRIPS, and such as it must leave alone. */
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint TRIPS = 1;
layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    uint cases[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Answers
{
    uint answers[];
};

uint squares[4] = uint[4](0u, 0u, 0u, 0u);

uint mixed(uint a, uint b)
{
    uint sum = a;
    if ((a & 1u) == b)
        return sum * 3u + b;
    [[unroll]] for (uint i = 0u; i < TRIPS; i++)
        sum += squares[i] * b;
    return sum;
}

uint answer(uint a)
{
    uint kept = 5u;
    [[unroll]] for (uint i = 0u; i < TRIPS; i++) {
        uint once;
        if (i == 0u || a > 100u)
            once = i + 7u;
        kept = kept * 3u + once;
        squares[i] = i * i + a;
        [[unroll]] for (uint k = 3u; k > 1u; k -= 1u)
            kept += mixed(kept, i) * k;
    }
    [[unroll]] for (uint i = 0u; i < TRIPS; i++) {
        if ((kept & 4u) != 0u && i == 1u)
            break;
        kept += 11u;
    }
    [[unroll]] for (uint i = 0u; i < TRIPS; i++) {
        uint turns = a & 3u;
        do {
            kept = kept * 5u + i;
        } while (turns-- > 0u);
        if ((kept & 8u) != 0u)
            continue;
        kept ^= 0x55u;
    }
    [[unroll]] for (uint i = 0u; i < TRIPS; i++)
        i += kept & 1u;
    return kept;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < cases.length())
        answers[i] = answer(cases[i]);
}
