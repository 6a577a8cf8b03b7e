#version 450
/* Writes one word at an index of the host's choice. */
layout(local_size_x = 1) in;
layout(push_constant) uniform Push { uint index; };
layout(set = 0, binding = 0, std430) buffer Values
{
    uint values[];
};

void main() { values[index] = 1u; }
