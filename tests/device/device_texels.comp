#version 450
/* The same memory as storage and as texels; binding 1 is left out on purpose. */
layout(local_size_x = 64) in;
layout(set = 0, binding = 0, std430) readonly buffer Rows
{
    uvec4 rows[];
};
layout(set = 0, binding = 2) uniform usamplerBuffer texels;
layout(set = 0, binding = 3, std430) writeonly buffer Sums
{
    uvec4 sums[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= rows.length())
        return;
    uvec4 texel = texelFetch(texels, int(i));
    sums[i] = texel * 2u + uvec4(equal(texel, rows[i]));
}
