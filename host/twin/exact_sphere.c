#include "twin/exact_sphere.h"

#include "twin/exact.h"

#include <stdint.h>

/* ---- The filter: shaders/lib/exact_sphere.glsl, bound_sphere ---- */

void bound_sphere(const struct ray_setup *ray, struct vec3 center, float radius,
                  struct sphere_bounds *out)
{
    struct foot foot = drop_perpendicular(ray, center, radius);
    struct vec3 off = foot.off;
    float grain = EXACT_UNIT * vec3_largest_magnitude(foot.c);
    float ll = (off.x * off.x + off.y * off.y) + off.z * off.z;
    float error = grain * (82.0f * vec3_largest_magnitude(off) + 18500.0f * grain) +
                  EXACT_UNIT * (4.5f * ll + 2.5f * foot.rr) + EXACT_TINY;
    bool inside = foot.room > error;
    float half = inside ? foot.half_length : 0.0f;
    float slack = inside ? 1.01f * error / half + 40.0f * EXACT_UNIT * half : 1.5f * sqrtf(error);
    float stretch = fabsf(ray->shear.z), middle = foot.mid * ray->shear.z;
    float t_half = half * stretch;
    float t_error = stretch * (70.0f * grain + slack) + EXACT_TINY;
    bool known = fabsf(middle) < EXACT_LARGE && t_half < EXACT_LARGE &&
                 t_error < EXACT_LARGE; /* false for NaN */
    out->room_error = error;
    out->outside = foot.room < -error;
    out->inside = inside && known;
    out->inward_known = fabsf(foot.mid) > 53.0f * grain + EXACT_TINY;
    out->near_lo = known ? (middle - t_half) - t_error : -INFINITY;
    out->near_hi = known ? (middle - t_half) + t_error : INFINITY;
    out->far_lo = known ? (middle + t_half) - t_error : -INFINITY;
    out->far_hi = known ? (middle + t_half) + t_error : INFINITY;
}

/* ---- The exact test ----

   With m the centre less the origin, the t of the ends are the roots of f(t) = P t^2 - 2 S t + Q,
   with P = d.d, S = m.d, Q = m.m - r^2. They are integers, each a sum of digit[i] 2^(12 i), the
   last digit of any sign: digits of 12 bits, so that sums of their products fit an int. Directions
   have the unit 2^(e - 150), e being their least exponent, and lengths such a unit of their own; so
   no product is shifted by more than 507 bits, and its last digit is at most number 46. */
enum {
    DIGIT_BITS = 12,
    DIGIT_MASK = 0xfff,
    DIGITS = 48, /* the last for carries */
    WIDE_P = 0,
    WIDE_S = 1,
    WIDE_Q = 2,
    WIDE_COUNT = 3,
    PRODUCT_DIGITS = 88, /* of t times P */
    VALUES = 10          /* direction, origin, centre, radius */
};

struct ball {
    uint32_t mantissa[VALUES]; /* sign in the top bit */
    int32_t exponent[VALUES];
    int32_t digits[WIDE_COUNT][DIGITS], product[PRODUCT_DIGITS];
    int32_t last; /* digit in use */
    int32_t unit; /* exponent of lengths less that of directions */
};

static int32_t at_least(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static void decode_values(struct ball *w, const float values[VALUES])
{
    int32_t min[2] = {254, 254}, max[2] = {1, 1};
    for (int i = 0; i < VALUES; ++i) {
        int of = i < 3 ? 0 : 1;
        w->mantissa[i] = exact_decode(values[i], &w->exponent[i]);
        bool some = (w->mantissa[i] & 0x7fffffffu) != 0;
        min[of] = some && w->exponent[i] < min[of] ? w->exponent[i] : min[of];
        max[of] = some && w->exponent[i] > max[of] ? w->exponent[i] : max[of];
    }
    for (int i = 0; i < VALUES; ++i)
        w->exponent[i] -= min[i < 3 ? 0 : 1];
    int32_t widest = at_least(max[0] - min[0], max[1] - min[1]);
    w->last = (2 * widest + 1) / DIGIT_BITS + 5;
    w->unit = min[1] - min[0];
}

/* Adds the product of two values (or `twice` the product) to the target, or subtracts it. */
static void add_product(struct ball *w, int target, int a, int b, bool twice, bool negative)
{
    uint32_t p = w->mantissa[a], q = w->mantissa[b];
    negative ^= ((p ^ q) >> 31) != 0;
    uint64_t pq = (uint64_t)(p & 0x7fffffffu) * (q & 0x7fffffffu);
    int32_t shift = w->exponent[a] + w->exponent[b] + (twice ? 1 : 0);
    if (pq == 0)
        return;
    pq <<= shift % DIGIT_BITS;
    for (int n = 0; n < 5; ++n) {
        int32_t digit = (int32_t)(pq >> (DIGIT_BITS * n)) & DIGIT_MASK;
        w->digits[target][shift / DIGIT_BITS + n] += negative ? -digit : digit;
    }
}

static void add_products(struct ball *w)
{
    for (int k = 0; k < WIDE_COUNT; ++k)
        for (int i = 0; i <= w->last; ++i)
            w->digits[k][i] = 0;
    for (int k = 0; k < 3; ++k) {
        int d = k, o = 3 + k, c = 6 + k;
        add_product(w, WIDE_P, d, d, false, false);
        add_product(w, WIDE_S, c, d, false, false);
        add_product(w, WIDE_S, o, d, false, true);
        add_product(w, WIDE_Q, c, c, false, false);
        add_product(w, WIDE_Q, o, o, false, false);
        add_product(w, WIDE_Q, c, o, true, true);
    }
    add_product(w, WIDE_Q, 9, 9, false, true);
}

/* Propagates the carries, after which all digits but the last are 0..4095. */
static void carry_digits(struct ball *w, int32_t sign[WIDE_COUNT])
{
    for (int k = 0; k < WIDE_COUNT; ++k) {
        int32_t carry = 0, some = 0;
        for (int i = 0; i < w->last; ++i) {
            int32_t sum = w->digits[k][i] + carry;
            carry = sum >> DIGIT_BITS;
            w->digits[k][i] = sum & DIGIT_MASK;
            some |= sum & DIGIT_MASK;
        }
        w->digits[k][w->last] = carry;
        sign[k] = exact_sign(carry, some);
    }
}

/* The sign of the discriminant S^2 - P Q. */
static int32_t sign_of_discriminant(const struct ball *w)
{
    int32_t carry = 0, some = 0;
    for (int32_t i = 0; i <= 2 * w->last; ++i) {
        for (int32_t k = at_least(i - w->last, 0); k <= i && k <= w->last; ++k)
            carry += w->digits[WIDE_S][k] * w->digits[WIDE_S][i - k] -
                     w->digits[WIDE_P][k] * w->digits[WIDE_Q][i - k];
        some |= carry & DIGIT_MASK;
        carry >>= DIGIT_BITS;
    }
    return exact_sign(carry, some);
}

static int32_t digit_at(const int32_t *digits, int32_t last, int32_t i)
{
    return i >= 0 && i <= last ? digits[i] : 0;
}

/* Digit i of a number times a factor of three digits. */
static int32_t product_at(const int32_t *digits, int32_t last, const int32_t factor[3], int32_t i)
{
    return factor[0] * digit_at(digits, last, i) + factor[1] * digit_at(digits, last, i - 1) +
           factor[2] * digit_at(digits, last, i - 2);
}

/* On which side an end of the chord is of the middle between the float with these bits and the next
   float: 1 beyond it. The middle is mantissa 2^power. The signs there of f and of half its slope, P
   t - S, decide; both are multiplied by a power of two where power < 0. */
static int32_t side_of_middle(struct ball *w, uint32_t bits, bool far)
{
    uint32_t exponent = bits >> 23;
    uint64_t mantissa = 2 * ((bits & 0x7fffffu) | (exponent != 0 ? 0x800000u : 0u)) + 1;
    int32_t power = (exponent != 0 ? (int32_t)exponent : 1) - 151 - w->unit;
    int32_t up = at_least(power, 0), down = at_least(-power, 0);
    mantissa <<= up % DIGIT_BITS;
    const int32_t factor[3] = {(int32_t)(mantissa & DIGIT_MASK),
                               (int32_t)(mantissa >> DIGIT_BITS & DIGIT_MASK),
                               (int32_t)(mantissa >> (2 * DIGIT_BITS))};
    int32_t up_digits = up / DIGIT_BITS, down_digits = down / DIGIT_BITS;
    int32_t last = w->last + at_least(up_digits + 2, down_digits) + 1;
    int32_t slope_carry = 0, slope_some = 0, carry = 0, some = 0;
    for (int32_t i = 0; i < last; ++i) { /* computes P t - S, and P t - 2 S into w->product */
        int32_t pt = product_at(w->digits[WIDE_P], w->last, factor, i - up_digits);
        int32_t s =
            digit_at(w->digits[WIDE_S], w->last, i - down_digits) * (1 << down % DIGIT_BITS);
        slope_carry += pt - s;
        carry += pt - 2 * s;
        slope_some |= slope_carry & DIGIT_MASK;
        w->product[i] = carry & DIGIT_MASK;
        slope_carry >>= DIGIT_BITS;
        carry >>= DIGIT_BITS;
    }
    w->product[last] = carry;
    int32_t slope = exact_sign(slope_carry, slope_some), twice_digits = 2 * down / DIGIT_BITS;
    int32_t end = at_least(last + up_digits + 2, w->last + twice_digits) + 1;
    carry = 0;
    for (int32_t i = 0; i < end; ++i) { /* computes t (P t - 2 S) + Q */
        carry +=
            product_at(w->product, last, factor, i - up_digits) +
            digit_at(w->digits[WIDE_Q], w->last, i - twice_digits) * (1 << 2 * down % DIGIT_BITS);
        some |= carry & DIGIT_MASK;
        carry >>= DIGIT_BITS;
    }
    int32_t f = exact_sign(carry, some);
    if (far)
        return f < 0 || slope < 0 ? 1 : f == 0 ? 0 : -1;
    return f < 0 || slope > 0 ? -1 : f == 0 ? 0 : 1;
}

/* Whether the key of an end is above the float with these bits. */
static bool is_beyond(struct ball *w, uint32_t bits, bool far)
{
    int32_t side = side_of_middle(w, bits, far);
    return side > 0 || (side == 0 && (bits & 1u) != 0);
}

static uint32_t bits_within(float x)
{
    return x > 0.0f ? float_bits(x) : 0u;
}

/* The key of an end of the chord: its t rounded to the nearest float, ties to even, by bisection.
 */
static float find_key(struct ball *w, float lo, float hi, bool far)
{
    uint32_t min = bits_within(lo), max = bits_within(hi);
    while (min < max) {
        uint32_t middle = min + (max - min) / 2;
        if (is_beyond(w, middle, far))
            min = middle + 1;
        else
            max = middle;
    }
    return float_of_bits(min);
}

void exact_meet_sphere(struct vec3 origin, struct vec3 dir, struct vec3 center, float radius,
                       bool only_far, float t_min, struct sphere_candidate *out)
{
    struct ball w;
    struct ray_setup ray = make_ray_setup(origin, dir);
    struct sphere_bounds bounds;
    const float values[VALUES] = {dir.x,    dir.y,    dir.z,    origin.x, origin.y,
                                  origin.z, center.x, center.y, center.z, radius};
    int32_t sign[WIDE_COUNT];
    bound_ray_setup(&ray);
    bound_sphere(&ray, center, radius, &bounds);
    decode_values(&w, values);
    add_products(&w);
    carry_digits(&w, sign);
    bool line_met = sign_of_discriminant(&w) >= 0;
    bool near_ahead = sign[WIDE_S] >= 0 && sign[WIDE_Q] >= 0;
    bool far_ahead = sign[WIDE_S] >= 0 || sign[WIDE_Q] <= 0;
    uint32_t before = bits_within(t_min); /* the key is above the float before t_min */
    bool near_counts = near_ahead && (before == 0 || is_beyond(&w, before - 1, false));
    out->at_exit = only_far || !near_counts;
    out->inward = sign[WIDE_S] > 0;
    out->key = out->at_exit ? find_key(&w, bounds.far_lo, bounds.far_hi, true)
                            : find_key(&w, bounds.near_lo, bounds.near_hi, false);
    out->met = line_met && (out->at_exit ? far_ahead : near_ahead) && out->key >= t_min &&
               out->key < INFINITY;
}
