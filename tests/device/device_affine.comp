#version 450
/* out[i] = i * scale + offset + added: specialization constants and push constants. */
layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint scale = 0;
layout(constant_id = 2) const uint offset = 0;
layout(push_constant) uniform Push
{
    uint count;
    uint added;
};
layout(set = 0, binding = 0, std430) buffer Values
{
    uint values[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < count)
        values[i] = i * scale + offset + added;
}
