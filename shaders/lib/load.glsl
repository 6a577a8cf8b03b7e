// Converts rows of buffers to values.
#ifndef LIB_LOAD_GLSL
#define LIB_LOAD_GLSL

vec3 row_vec3(uvec4 row)
{
    return uintBitsToFloat(row.xyz);
}

#endif
