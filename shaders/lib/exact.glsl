// NUMERICS_EXACT: whether and where a ray meets a triangle, as exact arithmetic on the given floats
// would find. A filter of floats with a proven error bound decides nearly all cases; the rest go to
// integers of many digits, which every device computes alike. docs/numerics-method.md derives the bounds.
// twin/exact.c is this file in C.
#ifndef LIB_EXACT_GLSL
#define LIB_EXACT_GLSL

#include "intersect.glsl"

// ---- The filter ----

const float EXACT_UNIT = 1.0 / 16777216.0;
const float EXACT_TINY = 7.8886090522101181e-31; // 2^-100: more than underflow can add
const float EXACT_LARGE = 1.2676506002282294e+30;

// The part of the answer that floats can decide. The key is the exact t, rounded to nearest.
struct ExactBounds {
    bool outside; // surely missed
    bool inside;  // surely hit, and t, u, v are valid
    bool front;   // valid where `inside`
    float t, u, v;
    float lo, hi; // lo <= key <= hi if it is hit
};

float larger(float a, float b)
{
    return a > b ? a : b;
}

float smaller(float a, float b)
{
    return a < b ? a : b;
}

float largest_magnitude(vec3 p)
{
    vec3 size = abs(p);
    return larger(size.x, larger(size.y, size.z));
}

bool has_integers()
{
    return SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES != 0u;
}

// Whether bounds by floats alone decide hits, or leave them open; the bounds may then be NaN, for
// which all comparisons are written.
bool has_bounds_alone()
{
    return SPEC_NUMERICS == NUMERICS_EXACT && SPEC_SETTLES == 0u;
}

// Decides by floats and bounds of their errors whether the ray surely misses or surely meets the
// triangle, and bounds its t. Vertices are relative to the ray's origin.
ExactBounds exact_filter(RaySetup ray, vec3 a, vec3 b, vec3 c)
{
    vec3 ta = turn_dominant(ray.dominant, a);
    vec3 tb = turn_dominant(ray.dominant, b);
    vec3 tc = turn_dominant(ray.dominant, c);
    vec2 sa, sb, sc;
    vec3 edges;
    shear_triangle(ray, ta, tb, tc, sa, sb, sc, edges);
    float depth = largest_magnitude(vec3(ta.z, tb.z, tc.z));
    float size = larger(larger(larger(abs(sa.x), abs(sa.y)), larger(abs(sb.x), abs(sb.y))),
                        larger(abs(sc.x), abs(sc.y)));
    // Error bounds: of the four factors of an edge function together, and of an edge function.
    precise float factors_error = (34.03125 * EXACT_UNIT) * depth + (12.890625 * EXACT_UNIT) * size;
    precise float edge_error = factors_error * (size + factors_error) + EXACT_TINY;
    float least = smaller(edges.x, smaller(edges.y, edges.z));
    float most = larger(edges.x, larger(edges.y, edges.z));
    Weights w = weigh_triangle(ray, ta.z, tb.z, tc.z, edges);
    float z_lo = smaller(w.z.x, smaller(w.z.y, w.z.z));
    float z_hi = larger(w.z.x, larger(w.z.y, w.z.z));
    precise float z_error = (41.0 * EXACT_UNIT * abs(ray.shear.z)) * depth + EXACT_TINY;
    precise float weights_error = (3.25 * edge_error) * abs(w.inv_det);
    precise float t_error = weights_error * (z_hi - z_lo) + z_error;
    ExactBounds bounds;
    // If an edge function is NaN, these may be of the two others. Opposite signs of two suffice for
    // `outside`; and `inside` is false, as `t` is NaN too.
    bounds.outside = least < -edge_error && most > edge_error;
    bounds.inside = (least > edge_error || most < -edge_error) &&
                    larger(abs(w.det), abs(w.t)) < EXACT_LARGE && weights_error < 0.25;
    bounds.front = (w.det > 0.0) == (ray.shear.z > 0.0);
    bounds.t = w.t;
    bounds.u = w.b;
    bounds.v = w.c;
    float error = bounds.inside ? t_error : z_error;
    precise float lo = (bounds.inside ? w.t : z_lo) - error;
    precise float hi = (bounds.inside ? w.t : z_hi) + error;
    bool known = has_bounds_alone() || lo <= hi; // not NaN
    bounds.lo = known ? lo : uintBitsToFloat(0xff800000u);
    bounds.hi = known ? hi : uintBitsToFloat(0x7f800000u);
    return bounds;
}

// ---- The exact test: integers of 54 digits of 16 bits, in units of 2^-447 ----
//
// A float is m 2^(e - 150), m < 2^24 and 1 <= e <= 254; so a product of three is an integer below
// 2^72 times 2^(e1 + e2 + e3 - 3) such units. The largest shift is 759: the last digit touched is 52.

const int WIDE_DIGITS = 54;
const int WIDE_D = 0; // e_a at first, then D = e_a + e_b + e_c
const int WIDE_B = 1;
const int WIDE_C = 2;
const int WIDE_N = 3;
const int POINT_DIR = 0;
const int POINT_ORIGIN = 1;
const int POINT_A = 2;
const int POINT_B = 3;
const int POINT_C = 4;

int wide[4 * WIDE_DIGITS]; // four integers, one after the other
uint wide_mantissa[15]; // x, y, z of POINT_*; sign in the top bit
int wide_exponent[15];

ivec4 load_digits(int i)
{
    return ivec4(wide[i], wide[i + WIDE_DIGITS], wide[i + 2 * WIDE_DIGITS],
                 wide[i + 3 * WIDE_DIGITS]);
}

void store_digits(int i, ivec4 digits)
{
    wide[i] = digits.x;
    wide[i + WIDE_DIGITS] = digits.y;
    wide[i + 2 * WIDE_DIGITS] = digits.z;
    wide[i + 3 * WIDE_DIGITS] = digits.w;
}

void decode_point(int at, vec3 p)
{
    uvec3 bits = floatBitsToUint(p);
    uvec3 exponent = bits >> 23 & 255u;
    bvec3 normal = notEqual(exponent, uvec3(0u));
    uvec3 mantissa =
        (bits & 0x80000000u) | (bits & 0x7fffffu) | mix(uvec3(0u), uvec3(0x800000u), normal);
    ivec3 power = ivec3(mix(uvec3(1u), exponent, normal));
    for (int i = 0; i < 3; i++) {
        wide_mantissa[3 * at + i] = mantissa[i];
        wide_exponent[3 * at + i] = power[i];
    }
}

// The range of digits in use, by the exponents of the values that are not 0. Clears these digits.
ivec2 find_range()
{
    int lo = 254, hi = 1, dir_lo = 254, dir_hi = 1;
    for (int i = 0; i < 15; i++) {
        bool some = (wide_mantissa[i] & 0x7fffffffu) != 0u, of_dir = i < 3;
        int e = wide_exponent[i];
        dir_lo = some && of_dir ? min(dir_lo, e) : dir_lo;
        dir_hi = some && of_dir ? max(dir_hi, e) : dir_hi;
        lo = some && !of_dir ? min(lo, e) : lo;
        hi = some && !of_dir ? max(hi, e) : hi;
    }
    ivec2 range = ivec2((min(dir_lo, lo) + lo + lo - 3) >> 4,
                        ((max(dir_hi, hi) + hi + hi - 3) >> 4) + 6);
    for (int i = range.x; i <= range.y; i++)
        store_digits(i, ivec4(0));
    return range;
}

// Adds the product of three numbers, given by index, to integer `target`; `negative`: subtracts it.
void add_product(int target, ivec3 at, bool negative)
{
    uint p = wide_mantissa[at.x], q = wide_mantissa[at.y], r = wide_mantissa[at.z];
    bool minus = negative != ((p ^ q ^ r) >> 31 != 0u);
    p &= 0x7fffffffu;
    q &= 0x7fffffffu;
    r &= 0x7fffffffu;
    int shift = wide_exponent[at.x] + wide_exponent[at.y] + wide_exponent[at.z] - 3;
    uint pq_high, pq_low, word0, word1, word2, above, carry;
    umulExtended(p, q, pq_high, pq_low);
    umulExtended(pq_low, r, word1, word0);
    umulExtended(pq_high, r, word2, above);
    word1 = uaddCarry(word1, above, carry);
    word2 += carry;
    uint bits = uint(shift) & 15u, back = 16u - bits; // shifts by 32 are undefined
    word2 = word2 << bits | word1 >> 16 >> back;
    word1 = word1 << bits | word0 >> 16 >> back;
    word0 = word0 << bits;
    if (p != 0u && q != 0u && r != 0u) {
        int to = target * WIDE_DIGITS + (shift >> 4), sign = minus ? -1 : 1;
        wide[to] += sign * int(word0 & 0xffffu);
        wide[to + 1] += sign * int(word0 >> 16);
        wide[to + 2] += sign * int(word1 & 0xffffu);
        wide[to + 3] += sign * int(word1 >> 16);
        wide[to + 4] += sign * int(word2 & 0xffffu);
        wide[to + 5] += sign * int(word2 >> 16);
    }
}

// Adds the six products of each of thirteen determinants of three points: e_a = d.(b x c) about the
// origin is det(d, b, c) - det(d, o, c) - det(d, b, o), and so on; and N = a.(b x c) likewise.
void add_determinants()
{
    for (int n = 0; n < 78; n++) {
        int row = n < 54 ? n / 18 : WIDE_N, part = n < 54 ? n / 6 % 3 : n / 6 - 9;
        ivec3 points = ivec3(POINT_DIR, POINT_A + (row == 2 ? 0 : row + 1),
                             POINT_A + (row == 0 ? 2 : row - 1));
        int moved = part == 0 ? 0 : part + 1; // 1, 2 or 3: the point that the origin replaces
        if (row == WIDE_N) {
            points = ivec3(POINT_A, POINT_B, POINT_C);
            moved = part;
        }
        points.x = moved == 1 ? POINT_ORIGIN : points.x;
        points.y = moved == 2 ? POINT_ORIGIN : points.y;
        points.z = moved == 3 ? POINT_ORIGIN : points.z;
        bool odd = (n & 1) != 0;
        int i = (n >> 1) % 3, j = i == 2 ? 0 : i + 1, k = i == 0 ? 2 : i - 1;
        ivec3 at = 3 * points + ivec3(i, odd ? k : j, odd ? j : k);
        add_product(row, at, (part != 0) != odd);
    }
}

// Propagates the carries, after which digits are 0..65535, in two's complement, and the first
// integer is D. Returns the signs of all integers, and of e_a.
void carry_digits(ivec2 range, out ivec4 signs, out int sign_a)
{
    ivec4 carry = ivec4(0), some = ivec4(0);
    int carry_a = 0, some_a = 0;
    for (int i = range.x; i <= range.y; i++) {
        ivec4 digits = load_digits(i);
        int a = digits[WIDE_D] + carry_a;
        carry_a = a >> 16;
        some_a |= a & 0xffff;
        digits[WIDE_D] += digits[WIDE_B] + digits[WIDE_C];
        digits += carry;
        carry = digits >> 16;
        digits &= 0xffff;
        some |= digits;
        store_digits(i, digits);
    }
    sign_a = carry_a < 0 ? -1 : some_a != 0 ? 1 : 0;
    signs = mix(ivec4(notEqual(some, ivec4(0))), ivec4(-1), lessThan(carry, ivec4(0)));
}

// Negates D, e_b and e_c where D is negative, and N where N is. Returns the indices of the
// highest digits of D (the determinant) and N (the numerator of t) that are not 0.
ivec2 make_positive(ivec2 range, ivec4 signs)
{
    bool flip = signs[WIDE_D] < 0;
    bvec4 flips = bvec4(flip, flip, flip, signs[WIDE_N] < 0);
    ivec4 carry = ivec4(1);
    ivec2 top = range.xx;
    for (int i = range.x; i <= range.y; i++) {
        ivec4 digits = load_digits(i);
        ivec4 inverse = (~digits & 0xffff) + carry;
        carry = inverse >> 16;
        digits = mix(digits, inverse & 0xffff, flips);
        store_digits(i, digits);
        top.x = digits[WIDE_D] != 0 ? i : top.x;
        top.y = digits[WIDE_N] != 0 ? i : top.y;
    }
    return top;
}

uint digit_at(ivec2 range, int k, int i)
{
    return i >= range.x && i <= range.y ? uint(wide[k * WIDE_DIGITS + clamp(i, 0, WIDE_DIGITS - 1)]) : 0u;
}

// 32 bits of integer `k`, from digit `top` down, after the first `shift` < 16 bits.
uint leading_bits(ivec2 range, int k, int top, uint shift)
{
    uint bits = digit_at(range, k, top) << 16 | digit_at(range, k, top - 1);
    return bits << shift | digit_at(range, k, top - 2) >> (16u - shift);
}

// The number of leading zeros in the 16 bits of digit `top` of integer `k`.
uint leading_zeros(ivec2 range, int k, int top)
{
    return uint(clamp(15 - findMSB(digit_at(range, k, top)), 0, 15));
}

// Sign of N - factor D 2^shift, where factor < 2^26 and both terms nearly agree. Not `finished`:
// the driver ended this loop, or one before it.
int compare_product(ivec2 range, uint factor, int shift, out bool finished)
{
    uint bits = uint(shift) & 15u;
    int moved = shift >> 4, borrow = 0, more = 0;
    uint low = factor << bits, f2 = factor >> 16 >> (16u - bits);
    uint f0 = low & 0xffffu, f1 = low >> 16, carry = 0u, d1 = 0u, d2 = 0u;
    int i;
    for (i = range.x; another_iteration(i <= range.y + 3); i++) {
        uint d0 = digit_at(range, WIDE_D, i);
        uint p0 = f0 * d0, p1 = f1 * d1, p2 = f2 * d2;
        uint sum = (p0 & 0xffffu) + (p1 & 0xffffu) + (p2 & 0xffffu) + carry;
        carry = (sum >> 16) + (p0 >> 16) + (p1 >> 16) + (p2 >> 16);
        int difference = int(digit_at(range, WIDE_N, i + moved)) - int(sum & 0xffffu) - borrow;
        borrow = difference < 0 ? 1 : 0;
        more |= difference & 0xffff;
        if (i < range.x + moved) // digits of N below the product's lowest
            more |= int(digit_at(range, WIDE_N, i));
        d2 = d1;
        d1 = d0;
    }
    finished = i > range.y + 3;
    return borrow != 0 ? -1 : more != 0 ? 1 : 0;
}

// The quotient N / D of two positive integers, rounded to nearest, ties to even.
float round_quotient(ivec2 range, int top_d, int top_n, out bool finished)
{
    uint zeros_n = leading_zeros(range, WIDE_N, top_n);
    uint zeros_d = leading_zeros(range, WIDE_D, top_d);
    uint rest = leading_bits(range, WIDE_N, top_n, zeros_n) >> 1;
    uint by = leading_bits(range, WIDE_D, top_d, zeros_d) >> 1;
    uint quotient = 0u;
    for (int n = 0; n < 28; n++) {
        bool one = rest >= by;
        quotient = quotient << 1 | (one ? 1u : 0u);
        rest = (one ? rest - by : rest) << 1;
    }
    // t is quotient 2^(scale - 27), off by at most 2 in the last place.
    int scale = 16 * (top_n - top_d) - int(zeros_n) + int(zeros_d);
    int drop = quotient >> 27 != 0u ? 4 : 3;
    int biased = scale + drop + 123;
    if (biased < 1)
        drop += 1 - biased;
    uint mantissa = drop < 32 ? quotient >> uint(min(drop, 31)) : 0u;
    int side = compare_product(range, 2u * mantissa + 1u, scale - 27 + drop - 1, finished);
    bool up = side > 0 || (side == 0 && (mantissa & 1u) != 0u);
    uint bits = biased < 1 ? mantissa : uint(min(biased, 255)) << 23 | (mantissa & 0x7fffffu);
    bits += up ? 1u : 0u;
    return uintBitsToFloat(biased > 254 ? 0x7f800000u : bits);
}

struct ExactCandidate {
    bool met; // at t >= 0, in the closed triangle, not edge-on; false where the key exceeds the
              // largest float
    bool front;
    float key, u, v;
    bvec3 on_edge; // which edge functions are 0
};

// Decides exactly whether and where the ray meets the triangle. Not `finished`: the driver has
// ended a loop (lavapipe: after 65,535 iterations per subgroup).
ExactCandidate exact_meet(vec3 origin, vec3 dir, vec3 v0, vec3 v1, vec3 v2, out bool finished)
{
    decode_point(POINT_DIR, dir);
    decode_point(POINT_ORIGIN, origin);
    decode_point(POINT_A, v0);
    decode_point(POINT_B, v1);
    decode_point(POINT_C, v2);
    ivec2 range = find_range();
    add_determinants();
    ivec4 signs;
    int sign_a;
    carry_digits(range, signs, sign_a);
    ivec3 edges = ivec3(sign_a, signs[WIDE_B], signs[WIDE_C]);
    int d = signs[WIDE_D], n = signs[WIDE_N];
    ivec2 top = make_positive(range, signs);
    uint zeros = leading_zeros(range, WIDE_D, top.x);
    float whole = float(leading_bits(range, WIDE_D, top.x, zeros));
    ExactCandidate m;
    precise float u = float(leading_bits(range, WIDE_B, top.x, zeros)) / whole;
    precise float v = float(leading_bits(range, WIDE_C, top.x, zeros)) / whole;
    m.u = u;
    m.v = v;
    m.front = d < 0;
    m.on_edge = equal(edges, ivec3(0));
    float quotient = round_quotient(range, top.x, top.y, finished);
    m.key = n == 0 ? 0.0 : quotient;
    bool mixed = any(lessThan(edges, ivec3(0))) && any(greaterThan(edges, ivec3(0)));
    m.met = !mixed && d != 0 && (n == 0 || n == d) && m.key < uintBitsToFloat(0x7f800000u);
    return m;
}

#endif
