#version 450
/* Keeps the device busy for a while: a xorshift chain, so that no compiler can shorten it. */
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { uint turns; };
layout(set = 0, binding = 0, std430) buffer Values
{
    uint values[];
};

void main()
{
    uint x = gl_GlobalInvocationID.x + 1u;
    uint turn = 0u;
    do {
        x ^= x << 13;
        x ^= x >> 17;
        x ^= x << 5;
    } while (++turn < turns);
    values[gl_LocalInvocationID.x] = x;
}
