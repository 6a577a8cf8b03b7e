// NUMERICS_EXACT: whether and where a ray meets a sphere, as exact arithmetic on the given floats
// would find. As with triangles (exact.glsl), a filter of floats with a proven error bound decides
// nearly all cases, and integers the rest. docs/numerics-method.md derives the bounds. twin/exact_sphere.c
// is this file in C.
#ifndef LIB_EXACT_SPHERE_GLSL
#define LIB_EXACT_SPHERE_GLSL

#include "exact.glsl"
#include "sphere.glsl"

// ---- The filter ----

SphereBounds bound_sphere(RaySetup ray, vec3 center, float radius)
{
    Foot foot = drop_perpendicular(ray, center, radius);
    precise float grain = EXACT_UNIT * largest_magnitude(foot.c);
    precise float ll =
        (foot.off.x * foot.off.x + foot.off.y * foot.off.y) + foot.off.z * foot.off.z;
    precise float error = grain * (82.0 * largest_magnitude(foot.off) + 18500.0 * grain) +
                          EXACT_UNIT * (4.5 * ll + 2.5 * foot.rr) + EXACT_TINY;
    bool inside = foot.room > error;
    float half_length = inside ? foot.half_length : 0.0;
    precise float root = sqrt(error);
    precise float slack_inside = 1.01 * error / half_length + 40.0 * EXACT_UNIT * half_length;
    precise float slack_beside = 1.5 * root;
    float slack = inside ? slack_inside : slack_beside;
    float stretch = abs(ray.shear.z);
    precise float middle = foot.mid * ray.shear.z;
    precise float t_half = half_length * stretch;
    precise float t_error = stretch * (70.0 * grain + slack) + EXACT_TINY;
    bool known = abs(middle) < EXACT_LARGE && t_half < EXACT_LARGE && t_error < EXACT_LARGE;
    precise float near_lo = (middle - t_half) - t_error;
    precise float near_hi = (middle - t_half) + t_error;
    precise float far_lo = (middle + t_half) - t_error;
    precise float far_hi = (middle + t_half) + t_error;
    precise float mid_error = 53.0 * grain + EXACT_TINY;
    float below = uintBitsToFloat(0xff800000u), above = uintBitsToFloat(0x7f800000u);
    SphereBounds bounds;
    bounds.outside = foot.room < -error;
    bounds.inside = inside && known;
    bounds.inward_known = abs(foot.mid) > mid_error;
    bounds.near_lo = known ? near_lo : below; // also for NaN
    bounds.near_hi = known ? near_hi : above;
    bounds.far_lo = known ? far_lo : below;
    bounds.far_hi = known ? far_hi : above;
    return bounds;
}

// ---- The exact test ----
//
// With m the centre less the origin, the t of the ends are the roots of P t^2 - 2 S t + Q, with P =
// d.d, S = m.d, Q = m.m - r^2. They are integers, each a sum of digit[i] 2^(12 i), the last digit
// of any sign: digits of 12 bits, so that sums of their products fit an int. Directions have the
// unit 2^(e - 150), e being their least exponent, and lengths such a unit of their own; so no
// product is shifted by more than 507 bits, and its last digit is at most number 46.

const int BALL_BITS = 12;
const int BALL_MASK = 0xfff;
const int BALL_DIGITS = 48; // the last for carries
const int BALL_P = 0;
const int BALL_S = 1;
const int BALL_Q = 2;
const int BALL_VALUES = 10; // direction, origin, centre, radius

int ball[3 * BALL_DIGITS];
int ball_product[88]; // digits of t times P
uint ball_mantissa[BALL_VALUES]; // sign in the top bit
int ball_exponent[BALL_VALUES];

// Splits the values into mantissas and exponents, and clears the digits. Returns the last digit in
// use. `unit`: the exponent of lengths less that of directions.
int decode_ball(vec3 origin, vec3 dir, vec3 center, float radius, out int unit)
{
    ivec2 least = ivec2(254), most = ivec2(1); // directions, lengths
    for (int i = 0; i < BALL_VALUES; i++) {
        float value = i < 3 ? dir[i] : i < 6 ? origin[i - 3] : i < 9 ? center[i - 6] : radius;
        uint bits = floatBitsToUint(value), exponent = bits >> 23 & 255u;
        uint mantissa =
            (bits & 0x80000000u) | (bits & 0x7fffffu) | (exponent != 0u ? 0x800000u : 0u);
        int power = exponent != 0u ? int(exponent) : 1;
        bool some = (mantissa & 0x7fffffffu) != 0u;
        bvec2 of = bvec2(some && i < 3, some && i >= 3);
        least = mix(least, min(least, ivec2(power)), of);
        most = mix(most, max(most, ivec2(power)), of);
        ball_mantissa[i] = mantissa;
        ball_exponent[i] = power;
    }
    for (int i = 0; i < BALL_VALUES; i++)
        ball_exponent[i] -= i < 3 ? least.x : least.y;
    unit = least.y - least.x;
    int last = (2 * max(most.x - least.x, most.y - least.y) + 1) / BALL_BITS + 5;
    for (int i = 0; i <= last; i++) {
        ball[i] = 0;
        ball[i + BALL_DIGITS] = 0;
        ball[i + 2 * BALL_DIGITS] = 0;
    }
    return last;
}

// Adds the product of two values to integer `target`; `twice`: doubled; `negative`: subtracts it.
void add_ball_product(int target, int a, int b, bool twice, bool negative)
{
    uint p = ball_mantissa[a], q = ball_mantissa[b];
    bool minus = negative != ((p ^ q) >> 31 != 0u);
    int shift = max(ball_exponent[a] + ball_exponent[b] + (twice ? 1 : 0), 0); // below 0: the product is 0
    uint high, low;
    umulExtended(p & 0x7fffffffu, q & 0x7fffffffu, high, low);
    uint bits = uint(shift % BALL_BITS);
    high = high << bits | low >> 16 >> (16u - bits); // shifts by 32 are undefined
    low = low << bits;
    if ((high | low) != 0u) {
        int to = target * BALL_DIGITS + shift / BALL_BITS, sign = minus ? -1 : 1;
        ball[to] += sign * int(low & 0xfffu);
        ball[to + 1] += sign * int(low >> 12 & 0xfffu);
        ball[to + 2] += sign * int((low >> 24 | high << 8) & 0xfffu);
        ball[to + 3] += sign * int(high >> 4 & 0xfffu);
        ball[to + 4] += sign * int(high >> 16);
    }
}

// Adds the products whose sums P, S and Q are: six for each axis, and r^2.
void add_ball_products()
{
    for (int n = 0; n < 19; n++) {
        int d = n / 6, o = 3 + d, c = 6 + d, kind = n < 18 ? n % 6 : 6;
        int target = kind == 0 ? BALL_P : kind < 3 ? BALL_S : BALL_Q;
        int a = kind == 0 ? d : kind == 2 || kind == 4 ? o : kind == 6 ? 9 : c;
        int b = kind < 3 ? d : kind == 3 ? c : kind == 6 ? 9 : o;
        add_ball_product(target, a, b, kind == 5, kind == 2 || kind >= 5);
    }
}

int sign_of(int carry, int some)
{
    return carry < 0 ? -1 : (carry | some) != 0 ? 1 : 0;
}

// Propagates the carries, after which all digits but the last are 0..4095. Returns the signs of P,
// S and Q.
ivec3 carry_ball(int last)
{
    ivec3 carry = ivec3(0), some = ivec3(0);
    for (int i = 0; i < last; i++) {
        ivec3 sum = carry + ivec3(ball[i], ball[i + BALL_DIGITS], ball[i + 2 * BALL_DIGITS]);
        carry = sum >> BALL_BITS;
        sum &= BALL_MASK;
        some |= sum;
        ball[i] = sum.x;
        ball[i + BALL_DIGITS] = sum.y;
        ball[i + 2 * BALL_DIGITS] = sum.z;
    }
    ball[last] = carry.x;
    ball[last + BALL_DIGITS] = carry.y;
    ball[last + 2 * BALL_DIGITS] = carry.z;
    return ivec3(sign_of(carry.x, some.x), sign_of(carry.y, some.y), sign_of(carry.z, some.z));
}

// The sign of S^2 - P Q; negative: the ray's line misses the sphere.
int sign_of_discriminant(int last)
{
    int carry = 0, some = 0;
    for (int i = 0; i <= 2 * last; i++) {
        for (int k = max(i - last, 0); k <= min(i, last); k++)
            carry += ball[k + BALL_DIGITS] * ball[i - k + BALL_DIGITS] -
                     ball[k] * ball[i - k + 2 * BALL_DIGITS];
        some |= carry & BALL_MASK;
        carry >>= BALL_BITS;
    }
    return sign_of(carry, some);
}

int ball_digit(int k, int last, int i)
{
    return i >= 0 && i <= last ? ball[k * BALL_DIGITS + clamp(i, 0, BALL_DIGITS - 1)] : 0;
}

int product_digit(int last, int i)
{
    return i >= 0 && i <= last ? ball_product[clamp(i, 0, 87)] : 0;
}

// On which side an end of the chord is of the middle between the float with these bits and the next
// float: 1 beyond it. The middle is mantissa 2^power. The signs there of the polynomial and of half
// its slope, P t - S, decide; both are multiplied by a power of two where power < 0. Not
// `finished`: the driver has ended a loop (lavapipe: after 65,535 iterations per subgroup), here or
// before.
int side_of_middle(int ball_last, int unit, uint bits, bool far, out bool finished)
{
    uint exponent = bits >> 23;
    uint mantissa = 2u * ((bits & 0x7fffffu) | (exponent != 0u ? 0x800000u : 0u)) + 1u;
    int power = (exponent != 0u ? int(exponent) : 1) - 151 - unit;
    int up = max(power, 0), down = max(-power, 0);
    uint moved = uint(up % BALL_BITS), low = mantissa << moved;
    uint high = mantissa >> 16 >> (16u - moved);
    ivec3 factor = ivec3(low & 0xfffu, low >> 12 & 0xfffu, low >> 24 | high << 8);
    int up_digits = up / BALL_BITS, down_digits = down / BALL_BITS, down_bits = down % BALL_BITS;
    int last = ball_last + max(up_digits + 2, down_digits) + 1;
    int slope_carry = 0, slope_some = 0, carry = 0, some = 0;
    for (int i = 0; i < last; i++) { // computes P t - S, and P t - 2 S into ball_product
        int at = i - up_digits;
        int pt = factor.x * ball_digit(BALL_P, ball_last, at) +
                 factor.y * ball_digit(BALL_P, ball_last, at - 1) +
                 factor.z * ball_digit(BALL_P, ball_last, at - 2);
        int s = ball_digit(BALL_S, ball_last, i - down_digits) * (1 << down_bits);
        slope_carry += pt - s;
        carry += pt - 2 * s;
        slope_some |= slope_carry & BALL_MASK;
        ball_product[i] = carry & BALL_MASK;
        slope_carry >>= BALL_BITS;
        carry >>= BALL_BITS;
    }
    ball_product[last] = carry;
    int slope = sign_of(slope_carry, slope_some);
    int twice_digits = 2 * down / BALL_BITS, twice_bits = 2 * down % BALL_BITS;
    int end = max(last + up_digits + 2, ball_last + twice_digits) + 1, i;
    carry = 0;
    for (i = 0; another_iteration(i < end); i++) { // computes t (P t - 2 S) + Q
        int at = i - up_digits;
        carry += factor.x * product_digit(last, at) + factor.y * product_digit(last, at - 1) +
                 factor.z * product_digit(last, at - 2) +
                 ball_digit(BALL_Q, ball_last, i - twice_digits) * (1 << twice_bits);
        some |= carry & BALL_MASK;
        carry >>= BALL_BITS;
    }
    finished = i == end;
    int f = sign_of(carry, some);
    int side_far = f < 0 || slope < 0 ? 1 : f == 0 ? 0 : -1;
    int side_near = f < 0 || slope > 0 ? -1 : f == 0 ? 0 : 1;
    return far ? side_far : side_near;
}

uint bits_within(float x)
{
    return x > 0.0 ? floatBitsToUint(x) : 0u;
}

struct SphereCandidate {
    bool met;     // at t >= 0; false where the key exceeds the largest float
    bool at_exit; // hit at the far end
    bool inward;  // where it is hit: the centre is ahead of the ray's origin
    float key;
};

// The first end of the chord with t >= 0 whose key is at least `t_min`, which is >= 0; `only_far`:
// only the far end counts. The key is the least float, within its bounds, that t does not round
// above. The loop's first iteration asks that for the float before t_min, to choose the end.
SphereCandidate exact_meet_sphere(vec3 origin, vec3 dir, vec3 center, float radius, bool only_far,
                                float t_min, out bool finished)
{
    SphereBounds bounds = bound_sphere(make_ray_setup(origin, dir), center, radius);
    int unit;
    int last = decode_ball(origin, dir, center, radius, unit);
    add_ball_products();
    ivec3 signs = carry_ball(last);
    bool line_met = sign_of_discriminant(last) >= 0;
    bool near_ahead = signs[BALL_S] >= 0 && signs[BALL_Q] >= 0;
    bool far_ahead = signs[BALL_S] >= 0 || signs[BALL_Q] <= 0;
    bool at_exit = only_far || !near_ahead, choose = true, whole;
    uint before = bits_within(t_min), least = before, most = before;
    finished = true;
    do {
        uint middle = choose ? max(before, 1u) - 1u : least + (most - least) / 2u;
        int side = side_of_middle(last, unit, middle, at_exit && !choose, whole);
        bool beyond = side > 0 || (side == 0 && (middle & 1u) != 0u);
        finished = finished && whole;
        if (choose) {
            at_exit = at_exit || (before != 0u && !beyond);
            least = bits_within(at_exit ? bounds.far_lo : bounds.near_lo);
            most = bits_within(at_exit ? bounds.far_hi : bounds.near_hi);
        } else {
            least = beyond ? middle + 1u : least;
            most = beyond ? most : middle;
        }
        choose = false;
    } while (another_iteration(least < most && finished));
    finished = finished && least >= most;
    SphereCandidate m;
    m.key = uintBitsToFloat(least);
    m.at_exit = at_exit;
    m.inward = signs[BALL_S] > 0;
    m.met = line_met && (at_exit ? far_ahead : near_ahead) && m.key >= t_min &&
            m.key < uintBitsToFloat(0x7f800000u);
    return m;
}

#endif
