// dbg(x) in the kernels of a probed pixel: returns x, and records it under the number of the call.
// In a file it is written dbg(x), and host/shader/dbg.c adds the number; in other kernels x stands
// in its place.
#ifndef HOOK_DBG_GLSL
#define HOOK_DBG_GLSL

#define DBG_OF(kind, scalar, v2, v3, v4, bits)                                                               \
    scalar dbg(uint call, scalar x)                                                                          \
    {                                                                                                        \
        whit_record(call, kind, uvec4(bits(x), 0u, 0u, 0u));                                                 \
        return x;                                                                                            \
    }                                                                                                        \
    v2 dbg(uint call, v2 x)                                                                                  \
    {                                                                                                        \
        whit_record(call, kind + 1u, uvec4(bits(x.x), bits(x.y), 0u, 0u));                                   \
        return x;                                                                                            \
    }                                                                                                        \
    v3 dbg(uint call, v3 x)                                                                                  \
    {                                                                                                        \
        whit_record(call, kind + 2u, uvec4(bits(x.x), bits(x.y), bits(x.z), 0u));                            \
        return x;                                                                                            \
    }                                                                                                        \
    v4 dbg(uint call, v4 x)                                                                                  \
    {                                                                                                        \
        whit_record(call, kind + 3u, uvec4(bits(x.x), bits(x.y), bits(x.z), bits(x.w)));                     \
        return x;                                                                                            \
    }

// The numbers are DBG_FLOAT, DBG_INT, DBG_UINT and DBG_BOOL of abi/shade.h, which is not included,
// so that a user's file may use its names.
DBG_OF(0u, float, vec2, vec3, vec4, floatBitsToUint)
DBG_OF(4u, int, ivec2, ivec3, ivec4, uint)
DBG_OF(8u, uint, uvec2, uvec3, uvec4, uint)
DBG_OF(12u, bool, bvec2, bvec3, bvec4, uint)

#undef DBG_OF

#endif
