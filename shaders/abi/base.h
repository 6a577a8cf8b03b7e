/* Names of types that both the C compiler and glslang know; both read the files of abi/. Records
   are laid out in 16-byte rows, so that std430, scalar and C layouts agree. */
#ifndef ABI_BASE_H
#define ABI_BASE_H

#ifdef __STDC_VERSION__
#include <stdint.h>
typedef float gpu_float;
typedef uint32_t gpu_uint;
typedef uint32_t gpu_uvec4[4];
typedef float gpu_vec2[2];
typedef float gpu_vec3[3];
typedef float gpu_vec4[4];
#define GPU_ASSERT_SIZE(record, bytes)                                                             \
    _Static_assert(sizeof(struct record) == (bytes), "size of " #record);
#else
#define gpu_float float
#define gpu_uint  uint
#define gpu_uvec4 uvec4
#define gpu_vec2  vec2
#define gpu_vec3  vec3
#define gpu_vec4  vec4
#define GPU_ASSERT_SIZE(record, bytes)
#endif

#endif
