// Rows of 16 bytes as words of 64 bits. lavapipe writes to storage buffers lane by lane and word by
// word: rows in such words take 0.7 of the time, pairs of rows at once 0.6. On Intel's processors with
// AVX-512 they take longer, and are not used (SPEC_WIDE_ROWS).
#ifndef LIB_WIDE_GLSL
#define LIB_WIDE_GLSL

u64vec2 wide_row(uvec4 row)
{
    return u64vec2(packUint2x32(row.xy), packUint2x32(row.zw));
}

u64vec4 wide_rows(uvec4 a, uvec4 b)
{
    return u64vec4(wide_row(a), wide_row(b));
}

#endif
