/* Three floats and a spare lane, in SSE where there is SSE. Both paths do the same IEEE operations,
   so they build the same trees; ACCEL_SCALAR forces the plain one. */
#ifndef BVH_F4_H
#define BVH_F4_H

#include <stdint.h>

#if defined(__SSE2__) && !defined(ACCEL_SCALAR)

#include <immintrin.h>

typedef __m128 f4;

static inline f4 f4_load(const float *p)
{
    return _mm_load_ps(p);
}
static inline void f4_store(float *p, f4 a)
{
    _mm_store_ps(p, a);
}
static inline f4 f4_set(float x, float y, float z, float w)
{
    return _mm_setr_ps(x, y, z, w);
}
static inline f4 f4_splat(float a)
{
    return _mm_set1_ps(a);
}
static inline f4 f4_add(f4 a, f4 b)
{
    return _mm_add_ps(a, b);
}
static inline f4 f4_sub(f4 a, f4 b)
{
    return _mm_sub_ps(a, b);
}
static inline f4 f4_mul(f4 a, f4 b)
{
    return _mm_mul_ps(a, b);
}
static inline f4 f4_min(f4 a, f4 b)
{
    return _mm_min_ps(a, b);
}
static inline f4 f4_max(f4 a, f4 b)
{
    return _mm_max_ps(a, b);
}
/* Lanes truncated to integers. */
static inline void f4_truncate(f4 a, int out[4])
{
    _mm_store_si128((__m128i *)(void *)out, _mm_cvttps_epi32(a));
}
/* Bit i: lane i of a is below lane i of b. */
static inline unsigned f4_below(f4 a, f4 b)
{
    return (unsigned)_mm_movemask_ps(_mm_cmplt_ps(a, b));
}
/* The first three lanes, with 0 in the last: an index kept there would be a denormal, with which
   arithmetic is slow. */
static inline f4 f4_xyz(f4 a)
{
    return _mm_and_ps(a, _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0)));
}
/* Half the surface area of a box with these sides: xy + yz + zx. */
static inline float f4_half_area(f4 d)
{
    f4 p = _mm_mul_ps(d, _mm_shuffle_ps(d, d, _MM_SHUFFLE(3, 0, 2, 1)));
    f4 y = _mm_shuffle_ps(p, p, _MM_SHUFFLE(1, 1, 1, 1));
    return _mm_cvtss_f32(_mm_add_ss(_mm_add_ss(p, y), _mm_movehl_ps(p, p)));
}
/* Masks: f4_less returns one, f4_both and f4_select take them. */
static inline f4 f4_less(f4 a, f4 b)
{
    return _mm_cmplt_ps(a, b);
}
static inline f4 f4_both(f4 a, f4 b)
{
    return _mm_and_ps(a, b);
}
static inline f4 f4_select(f4 mask, f4 yes, f4 no)
{
    return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
}
/* Converts four counts below 2^31. */
static inline f4 f4_from_counts(const uint32_t p[4])
{
    return _mm_cvtepi32_ps(_mm_load_si128((const __m128i *)(const void *)p));
}
/* The f4_half_area of each of three vectors, in the first three lanes. */
static inline f4 f4_half_areas(f4 a, f4 b, f4 c)
{
    f4 low = _mm_unpacklo_ps(a, b), high = _mm_unpackhi_ps(a, b);
    f4 x = _mm_shuffle_ps(low, c, _MM_SHUFFLE(3, 0, 1, 0));
    f4 y = _mm_shuffle_ps(low, c, _MM_SHUFFLE(3, 1, 3, 2));
    f4 z = _mm_shuffle_ps(high, c, _MM_SHUFFLE(3, 2, 1, 0));
    f4 sum = _mm_add_ps(_mm_mul_ps(x, y), _mm_mul_ps(y, z));
    return _mm_add_ps(sum, _mm_mul_ps(z, x));
}

#else

typedef struct f4 {
    float v[4];
} f4;

#define F4_EACH(a, b, expression)                                                                  \
    f4 out;                                                                                        \
    for (int i = 0; i < 4; ++i) {                                                                  \
        float x = (a).v[i], y = (b).v[i];                                                          \
        out.v[i] = (expression);                                                                   \
    }                                                                                              \
    return out

static inline f4 f4_load(const float *p)
{
    return (f4){{p[0], p[1], p[2], p[3]}};
}
static inline void f4_store(float *p, f4 a)
{
    for (int i = 0; i < 4; ++i)
        p[i] = a.v[i];
}
static inline f4 f4_set(float x, float y, float z, float w)
{
    return (f4){{x, y, z, w}};
}
static inline f4 f4_splat(float a)
{
    return (f4){{a, a, a, a}};
}
static inline f4 f4_add(f4 a, f4 b)
{
    F4_EACH(a, b, x + y);
}
static inline f4 f4_sub(f4 a, f4 b)
{
    F4_EACH(a, b, x - y);
}
static inline f4 f4_mul(f4 a, f4 b)
{
    F4_EACH(a, b, x * y);
}
static inline f4 f4_min(f4 a, f4 b)
{
    F4_EACH(a, b, x < y ? x : y);
}
static inline f4 f4_max(f4 a, f4 b)
{
    F4_EACH(a, b, x > y ? x : y);
}
static inline void f4_truncate(f4 a, int out[4])
{
    for (int i = 0; i < 4; ++i)
        out[i] = (int)a.v[i];
}
static inline unsigned f4_below(f4 a, f4 b)
{
    unsigned mask = 0;
    for (unsigned i = 0; i < 4; ++i)
        mask |= (unsigned)(a.v[i] < b.v[i]) << i;
    return mask;
}
static inline f4 f4_xyz(f4 a)
{
    return (f4){{a.v[0], a.v[1], a.v[2], 0.0f}};
}
static inline float f4_half_area(f4 d)
{
    return (d.v[0] * d.v[1] + d.v[1] * d.v[2]) + d.v[2] * d.v[0];
}
static inline f4 f4_less(f4 a, f4 b)
{
    F4_EACH(a, b, x < y ? 1.0f : 0.0f);
}
static inline f4 f4_both(f4 a, f4 b)
{
    F4_EACH(a, b, x * y);
}
static inline f4 f4_select(f4 mask, f4 yes, f4 no)
{
    f4 out;
    for (int i = 0; i < 4; ++i)
        out.v[i] = mask.v[i] != 0.0f ? yes.v[i] : no.v[i];
    return out;
}
static inline f4 f4_from_counts(const uint32_t p[4])
{
    return (f4){{(float)p[0], (float)p[1], (float)p[2], (float)p[3]}};
}
static inline f4 f4_half_areas(f4 a, f4 b, f4 c)
{
    return (f4){{f4_half_area(a), f4_half_area(b), f4_half_area(c), 0.0f}};
}
#undef F4_EACH

#endif

#endif
