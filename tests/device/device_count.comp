#version 450
/* Counts the work groups that ran. */
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Count
{
    uint count;
};

void main() { atomicAdd(count, 1u); }
