#include "twin/exact.h"

#include <stdint.h>

/* ---- The filter: shaders/lib/exact.glsl, exact_filter ---- */

void exact_filter(const struct ray_setup *ray, struct vec3 a, struct vec3 b, struct vec3 c,
                  struct exact_bounds *out)
{
    struct vec3 ta = turn_dominant(ray, a), tb = turn_dominant(ray, b), tc = turn_dominant(ray, c);
    struct sheared s = shear_triangle(ray, ta, tb, tc);
    float depth = vec3_largest_magnitude(vec3_make(ta.z, tb.z, tc.z));
    float size = float_larger(float_larger(float_larger(fabsf(s.ax), fabsf(s.ay)),
                                           float_larger(fabsf(s.bx), fabsf(s.by))),
                              float_larger(fabsf(s.cx), fabsf(s.cy)));
    float factors_error = (34.03125f * EXACT_UNIT) * depth + (12.890625f * EXACT_UNIT) * size;
    float edge_error = factors_error * (size + factors_error) + EXACT_TINY;
    float least = float_smaller(s.ea, float_smaller(s.eb, s.ec));
    float most = float_larger(s.ea, float_larger(s.eb, s.ec));
    float det = (s.ea + s.eb) + s.ec;
    float az = ray->shear.z * ta.z, bz = ray->shear.z * tb.z, cz = ray->shear.z * tc.z;
    float inv_det = 1.0f / det;
    out->u = s.eb * inv_det;
    out->v = s.ec * inv_det;
    out->t = ((s.ea * inv_det) * az + out->u * bz) + out->v * cz;
    float z_lo = float_smaller(az, float_smaller(bz, cz)),
          z_hi = float_larger(az, float_larger(bz, cz));
    float z_error = (41.0f * EXACT_UNIT * fabsf(ray->shear.z)) * depth + EXACT_TINY;
    float weights_error = (3.25f * edge_error) * fabsf(inv_det);
    float t_error = weights_error * (z_hi - z_lo) + z_error;
    out->edge_error = edge_error;
    /* If an edge function is NaN, these may be of the two others. Opposite signs of two suffice for
       `outside`; and `inside` is false, as `t` is NaN too. */
    out->outside = least < -edge_error && most > edge_error;
    out->inside = (least > edge_error || most < -edge_error) &&
                  float_larger(fabsf(det), fabsf(out->t)) < EXACT_LARGE && weights_error < 0.25f;
    float error = out->inside ? t_error : z_error;
    float lo = (out->inside ? out->t : z_lo) - error, hi = (out->inside ? out->t : z_hi) + error;
    bool known = lo <= hi; /* not NaN */
    out->lo = known ? lo : -INFINITY;
    out->hi = known ? hi : INFINITY;
}

/* ---- The exact test: integers of DIGITS digits of 16 bits, in units of 2^-447 ----

   A float is m 2^(e - 150), m < 2^24 and 1 <= e <= 254; so a product of three is an integer below
   2^72 times 2^(e1 + e2 + e3 - 3) such units. The largest shift is 759: the last digit touched
   is 52. */
enum { DIGITS = 54, WIDE_D = 0, WIDE_B = 1, WIDE_C = 2, WIDE_N = 3, WIDE_COUNT = 4 };
enum { POINT_DIR, POINT_ORIGIN, POINT_A, POINT_B, POINT_C, POINT_COUNT };

struct wide {
    uint32_t mantissa[POINT_COUNT][3]; /* sign in the top bit */
    int32_t exponent[POINT_COUNT][3];
    int32_t digits[WIDE_COUNT][DIGITS];
    int32_t first, last; /* digits in use */
    int32_t sign[WIDE_COUNT], sign_a;
};

static void decode_point(struct wide *w, int at, struct vec3 p)
{
    const float values[3] = {p.x, p.y, p.z};
    for (int i = 0; i < 3; ++i)
        w->mantissa[at][i] = exact_decode(values[i], &w->exponent[at][i]);
}

/* Finds the range of digits that nonzero values need, by exponents; clears the digits. */
static void find_range(struct wide *w)
{
    int32_t lo = 254, hi = 1, dir_lo = 254, dir_hi = 1;
    for (int k = 0; k < POINT_COUNT; ++k) {
        for (int i = 0; i < 3; ++i) {
            bool some = (w->mantissa[k][i] & 0x7fffffffu) != 0;
            int32_t e = w->exponent[k][i];
            int32_t *min = k == POINT_DIR ? &dir_lo : &lo;
            int32_t *max = k == POINT_DIR ? &dir_hi : &hi;
            *min = some && e < *min ? e : *min;
            *max = some && e > *max ? e : *max;
        }
    }
    w->first = ((dir_lo < lo ? dir_lo : lo) + lo + lo - 3) >> 4;
    w->last = (((dir_hi > hi ? dir_hi : hi) + hi + hi - 3) >> 4) + 6;
    for (int32_t i = w->first; i <= w->last; ++i) {
        for (int k = 0; k < WIDE_COUNT; ++k)
            w->digits[k][i] = 0;
    }
}

/* Adds the product p.i q.j r.k to the target, or subtracts it. */
static void add_product(struct wide *w, int target, const int points[3], int i, int j, int k,
                        bool negative)
{
    uint32_t p = w->mantissa[points[0]][i], q = w->mantissa[points[1]][j],
             r = w->mantissa[points[2]][k];
    negative ^= ((p ^ q ^ r) >> 31) != 0;
    p &= 0x7fffffffu;
    q &= 0x7fffffffu;
    r &= 0x7fffffffu;
    if (p == 0 || q == 0 || r == 0)
        return;
    int32_t shift =
        w->exponent[points[0]][i] + w->exponent[points[1]][j] + w->exponent[points[2]][k] - 3;
    uint64_t pq = (uint64_t)p * q;
    uint64_t low = (pq & 0xffffffffu) * r, high = (pq >> 32) * r + (low >> 32);
    uint32_t word0 = (uint32_t)low, word1 = (uint32_t)high, word2 = (uint32_t)(high >> 32);
    uint32_t bits = (uint32_t)shift & 15u;
    if (bits != 0) {
        word2 = word2 << bits | word1 >> (32 - bits);
        word1 = word1 << bits | word0 >> (32 - bits);
        word0 = word0 << bits;
    }
    const uint32_t words[3] = {word0, word1, word2};
    for (int n = 0; n < 6; ++n) {
        int32_t digit = (int32_t)(words[n / 2] >> (n % 2 * 16) & 0xffffu);
        w->digits[target][(shift >> 4) + n] += negative ? -digit : digit;
    }
}

/* The determinants of three points: e_a = d.(b x c) about the origin is det(d, b, c) - det(d, b, o)
   - det(d, o, c), and so on; and N = a.(b x c) likewise. */
static const struct {
    int target, points[3];
    bool negative;
} determinants[13] = {
    {WIDE_D, {POINT_DIR, POINT_B, POINT_C}, false},
    {WIDE_D, {POINT_DIR, POINT_B, POINT_ORIGIN}, true},
    {WIDE_D, {POINT_DIR, POINT_ORIGIN, POINT_C}, true},
    {WIDE_B, {POINT_DIR, POINT_C, POINT_A}, false},
    {WIDE_B, {POINT_DIR, POINT_C, POINT_ORIGIN}, true},
    {WIDE_B, {POINT_DIR, POINT_ORIGIN, POINT_A}, true},
    {WIDE_C, {POINT_DIR, POINT_A, POINT_B}, false},
    {WIDE_C, {POINT_DIR, POINT_A, POINT_ORIGIN}, true},
    {WIDE_C, {POINT_DIR, POINT_ORIGIN, POINT_B}, true},
    {WIDE_N, {POINT_A, POINT_B, POINT_C}, false},
    {WIDE_N, {POINT_ORIGIN, POINT_B, POINT_C}, true},
    {WIDE_N, {POINT_A, POINT_ORIGIN, POINT_C}, true},
    {WIDE_N, {POINT_A, POINT_B, POINT_ORIGIN}, true},
};

static void add_determinants(struct wide *w)
{
    for (int n = 0; n < 13; ++n) {
        const int *points = determinants[n].points;
        bool negative = determinants[n].negative;
        for (int i = 0; i < 3; ++i) {
            int j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
            add_product(w, determinants[n].target, points, i, j, k, negative);
            add_product(w, determinants[n].target, points, i, k, j, !negative);
        }
    }
}

/* Propagates the carries, after which digits are 0..65535, in two's complement. The first integer,
   e_a until now, becomes D = e_a + e_b + e_c. */
static void carry_digits(struct wide *w)
{
    int32_t carry[WIDE_COUNT] = {0}, some[WIDE_COUNT] = {0}, carry_a = 0, some_a = 0;
    for (int32_t i = w->first; i <= w->last; ++i) {
        int32_t a = w->digits[WIDE_D][i] + carry_a;
        carry_a = a >> 16;
        some_a |= a & 0xffff;
        w->digits[WIDE_D][i] += w->digits[WIDE_B][i] + w->digits[WIDE_C][i];
        for (int k = 0; k < WIDE_COUNT; ++k) {
            int32_t sum = w->digits[k][i] + carry[k];
            carry[k] = sum >> 16;
            w->digits[k][i] = sum & 0xffff;
            some[k] |= sum & 0xffff;
        }
    }
    w->sign_a = exact_sign(carry_a, some_a);
    for (int k = 0; k < WIDE_COUNT; ++k)
        w->sign[k] = exact_sign(carry[k], some[k]);
}

/* Negates negative numbers. *top_d, *top_n: the highest nonzero digits of D and N. */
static void make_positive(struct wide *w, int32_t *top_d, int32_t *top_n)
{
    bool flip = w->sign[WIDE_D] < 0, flip_n = w->sign[WIDE_N] < 0;
    int32_t carry[WIDE_COUNT] = {1, 1, 1, 1};
    *top_d = w->first;
    *top_n = w->first;
    for (int32_t i = w->first; i <= w->last; ++i) {
        for (int k = 0; k < WIDE_COUNT; ++k) {
            int32_t inverse = (~w->digits[k][i] & 0xffff) + carry[k];
            carry[k] = inverse >> 16;
            if (k == WIDE_N ? flip_n : flip)
                w->digits[k][i] = inverse & 0xffff;
        }
        *top_d = w->digits[WIDE_D][i] != 0 ? i : *top_d;
        *top_n = w->digits[WIDE_N][i] != 0 ? i : *top_n;
    }
}

static uint32_t digit_at(const struct wide *w, int k, int32_t i)
{
    return i >= w->first && i <= w->last ? (uint32_t)w->digits[k][i] : 0u;
}

/* 32 bits of integer `k`, from digit `top` down, after the first `shift` < 16 bits. */
static uint32_t leading_bits(const struct wide *w, int k, int32_t top, uint32_t shift)
{
    uint32_t bits = digit_at(w, k, top) << 16 | digit_at(w, k, top - 1);
    return bits << shift | digit_at(w, k, top - 2) >> (16u - shift);
}

static uint32_t leading_zeros(const struct wide *w, int k, int32_t top)
{
    uint32_t digit = digit_at(w, k, top), zeros = 0;
    while (zeros < 15 && (digit & 0x8000u >> zeros) == 0)
        ++zeros;
    return zeros;
}

/* Sign of N - factor D 2^shift, where factor < 2^26 and both terms nearly agree. */
static int32_t compare_product(const struct wide *w, uint32_t factor, int32_t shift)
{
    uint32_t bits = (uint32_t)shift & 15u;
    int32_t moved = shift >> 4, borrow = 0, more = 0;
    uint32_t low = factor << bits, high = bits != 0 ? factor >> (32u - bits) : 0u;
    uint32_t f0 = low & 0xffffu, f1 = low >> 16, carry = 0, d1 = 0, d2 = 0;
    for (int32_t i = w->first; i <= w->last + 3; ++i) {
        uint32_t d0 = digit_at(w, WIDE_D, i);
        uint32_t p0 = f0 * d0, p1 = f1 * d1, p2 = high * d2;
        uint32_t sum = (p0 & 0xffffu) + (p1 & 0xffffu) + (p2 & 0xffffu) + carry;
        carry = (sum >> 16) + (p0 >> 16) + (p1 >> 16) + (p2 >> 16);
        int32_t difference =
            (int32_t)digit_at(w, WIDE_N, i + moved) - (int32_t)(sum & 0xffffu) - borrow;
        borrow = difference < 0 ? 1 : 0;
        more |= difference & 0xffff;
        if (i < w->first + moved) /* digits of N below the product's lowest */
            more |= (int32_t)digit_at(w, WIDE_N, i);
        d2 = d1;
        d1 = d0;
    }
    return borrow ? -1 : more != 0 ? 1 : 0;
}

/* N / D, both positive, rounded to nearest, ties to even. */
static float round_quotient(const struct wide *w, int32_t top_n, int32_t top_d)
{
    uint32_t zeros_n = leading_zeros(w, WIDE_N, top_n), zeros_d = leading_zeros(w, WIDE_D, top_d);
    uint32_t rest = leading_bits(w, WIDE_N, top_n, zeros_n) >> 1;
    uint32_t by = leading_bits(w, WIDE_D, top_d, zeros_d) >> 1, quotient = 0;
    for (int n = 0; n < 28; ++n) {
        bool one = rest >= by;
        quotient = quotient << 1 | (one ? 1u : 0u);
        rest = (one ? rest - by : rest) << 1;
    }
    /* t is quotient 2^(scale - 27), off by at most 2 in the last place. */
    int32_t scale = 16 * (top_n - top_d) - (int32_t)zeros_n + (int32_t)zeros_d;
    int32_t drop = quotient >> 27 != 0 ? 4 : 3;
    int32_t biased = scale + drop + 123;
    if (biased < 1)
        drop += 1 - biased;
    uint32_t mantissa = drop < 32 ? quotient >> drop : 0u;
    int32_t side = compare_product(w, 2 * mantissa + 1, scale - 27 + drop - 1);
    bool up = side > 0 || (side == 0 && (mantissa & 1u) != 0);
    uint32_t bits = biased < 1 ? mantissa : (uint32_t)biased << 23 | (mantissa & 0x7fffffu);
    bits += up ? 1u : 0u;
    bits = biased > 254 ? 0x7f800000u : bits;
    return float_of_bits(bits);
}

void exact_meet(struct vec3 origin, struct vec3 dir, struct vec3 v0, struct vec3 v1, struct vec3 v2,
                struct exact_candidate *out)
{
    struct wide w;
    decode_point(&w, POINT_DIR, dir);
    decode_point(&w, POINT_ORIGIN, origin);
    decode_point(&w, POINT_A, v0);
    decode_point(&w, POINT_B, v1);
    decode_point(&w, POINT_C, v2);
    find_range(&w);
    add_determinants(&w);
    carry_digits(&w);
    int32_t a = w.sign_a, b = w.sign[WIDE_B], c = w.sign[WIDE_C], d = w.sign[WIDE_D];
    int32_t n = w.sign[WIDE_N];
    bool below = a < 0 || b < 0 || c<0, above = a> 0 || b > 0 || c > 0;
    int32_t top_d, top_n;
    make_positive(&w, &top_d, &top_n);
    uint32_t zeros = leading_zeros(&w, WIDE_D, top_d);
    float whole = (float)leading_bits(&w, WIDE_D, top_d, zeros);
    out->u = (float)leading_bits(&w, WIDE_B, top_d, zeros) / whole;
    out->v = (float)leading_bits(&w, WIDE_C, top_d, zeros) / whole;
    out->key = n == 0 ? 0.0f : round_quotient(&w, top_n, top_d);
    out->met = !(below && above) && d != 0 && (n == 0 || n == d) && out->key < INFINITY;
}
