/* Three floats and a spare lane, as vectors with the operators + - * of GCC and Clang. Where SSE is
   faster than what compilers make of these, there is a second path. Both do the same IEEE
   operations, so they build the same trees; ACCEL_SCALAR forces the plain one. */
#ifndef BVH_F4_H
#define BVH_F4_H

#include <stdint.h>
#include <string.h>

typedef float f4 __attribute__((vector_size(16)));
/* Four integers; also a mask, whose lanes are -1 or 0, as comparisons of two f4 give it. */
typedef int32_t i4 __attribute__((vector_size(16)));

/* Three floats in 16-byte aligned memory, with 0 in the last lane: an index that follows them there
   would be a denormal, with which arithmetic is slow. */
static inline f4 f4_load(const float *p)
{
    f4 a;
    memcpy(&a, __builtin_assume_aligned(p, 16), sizeof a);
    return (f4)((i4)a & (i4){-1, -1, -1, 0});
}

/* Three floats at any address, with 0 in the last lane. */
static inline f4 f4_three(const float p[3])
{
    return (f4){p[0], p[1], p[2], 0.0f};
}

static inline f4 f4_splat(float a)
{
    return (f4){a, a, a, a};
}

/* Lanes truncated to integers. */
static inline i4 f4_truncate(f4 a)
{
    return __builtin_convertvector(a, i4);
}

/* Converts four counts below 2^31. */
static inline f4 f4_from_counts(const uint32_t p[4])
{
    i4 counts;
    memcpy(&counts, __builtin_assume_aligned(p, 16), sizeof counts);
    return __builtin_convertvector(counts, f4);
}

static inline f4 f4_select(i4 mask, f4 yes, f4 no)
{
    return (f4)((mask & (i4)yes) | (~mask & (i4)no));
}

#if defined(__SSE2__) && !defined(ACCEL_SCALAR)

#include <immintrin.h>

static inline f4 f4_min(f4 a, f4 b)
{
    return _mm_min_ps(a, b);
}

static inline f4 f4_max(f4 a, f4 b)
{
    return _mm_max_ps(a, b);
}

/* Bit i: lane i of a is below lane i of b. */
static inline unsigned f4_below(f4 a, f4 b)
{
    return (unsigned)_mm_movemask_ps(_mm_cmplt_ps(a, b));
}

/* Half the surface area of a box with these sides: xy + yz + zx. */
static inline float f4_half_area(f4 d)
{
    f4 p = d * _mm_shuffle_ps(d, d, _MM_SHUFFLE(3, 0, 2, 1));
    return (p[0] + p[1]) + p[2];
}

/* The f4_half_area of each of three vectors, in the first three lanes. */
static inline f4 f4_half_areas(f4 a, f4 b, f4 c)
{
    f4 low = _mm_unpacklo_ps(a, b), high = _mm_unpackhi_ps(a, b);
    f4 x = _mm_shuffle_ps(low, c, _MM_SHUFFLE(3, 0, 1, 0));
    f4 y = _mm_shuffle_ps(low, c, _MM_SHUFFLE(3, 1, 3, 2));
    f4 z = _mm_shuffle_ps(high, c, _MM_SHUFFLE(3, 2, 1, 0));
    return (x * y + y * z) + z * x;
}

#else

static inline f4 f4_min(f4 a, f4 b)
{
    return f4_select(a < b, a, b);
}

static inline f4 f4_max(f4 a, f4 b)
{
    return f4_select(a > b, a, b);
}

static inline unsigned f4_below(f4 a, f4 b)
{
    i4 bits = (a < b) & (i4){1, 2, 4, 8};
    return (unsigned)(bits[0] | bits[1] | bits[2] | bits[3]);
}

static inline float f4_half_area(f4 d)
{
    return (d[0] * d[1] + d[1] * d[2]) + d[2] * d[0];
}

static inline f4 f4_half_areas(f4 a, f4 b, f4 c)
{
    return (f4){f4_half_area(a), f4_half_area(b), f4_half_area(c), 0.0f};
}

#endif

#endif
