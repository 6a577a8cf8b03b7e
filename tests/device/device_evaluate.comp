#version 450
#extension GL_EXT_control_flow_attributes : require
/* Loops that evaluate_loops.c unrolls for small TRIPS, and such as it must leave alone; variables
   whose contents evaluate_memory.c follows through branches and loops. */
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint TRIPS = 1;
layout(set = 0, binding = 0, std430) readonly buffer Cases
{
    uint cases[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Answers
{
    uvec2 answers[];
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

uint early(uint a, inout uint b)
{
    b += 1u;
    if ((a & 16u) != 0u)
        return b;
    b += 2u;
    if ((a & 32u) != 0u)
        return a;
    b = 9u;
    return a + b;
}

uint remember(uint a)
{
    uint v = 3u, w = 5u, x = 7u, y = 11u, sum = 0u;
    if ((a & 1u) != 0u) {
        v = 4u;
        sum += v + w;
    } else {
        sum += v * w;
        x = 8u;
    }
    sum = sum * 3u + v + w + x;
    switch (a >> 1 & 3u) {
    case 0u:
        v = 20u;
    case 1u:
        sum += v + y;
        w = 6u;
        break;
    case 2u:
        v = 21u;
        sum += v;
        break;
    }
    sum = sum * 3u + v + w;
    uint z = 13u;
    for (uint i = 0u; i < (a >> 3 & 7u); i++) {
        sum = sum * 3u + v + x + y + z;
        z += 2u;
        if (i == 2u)
            continue;
        v = i;
        if (i == 5u)
            break;
        x += v;
    }
    sum = sum * 3u + v + x + y;
    uint turns = 0u;
    do {
        if ((a >> 6 & 3u) == turns)
            break;
        w = 30u + turns;
        sum += w;
        if ((a >> 8 & 1u) != 0u)
            continue;
        y = 40u;
    } while (turns++ < 2u);
    sum = sum * 3u + w + y;
    z = 17u;
    while ((v & 7u) != 0u) {
        v--;
        sum += z;
        sum += early(a + v, z) + z;
    }
    sum = sum * 3u + early(a >> 2, w);
    return sum * 3u + v + w + x + y + z;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < cases.length())
        answers[i] = uvec2(answer(cases[i]), remember(cases[i]));
}
