#include "base/same.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Double-double: a number as the sum of two doubles, the second being a rounding error of the first
   (Dekker 1971, "A floating-point technique for extending the available precision"). */
struct dd {
    double hi, lo;
};

/* atan(i / 16) */
static const struct dd atan_of[] = {
    {0x0.0p+0, 0x0.0p+0},
    {0x1.ff55bb72cfdeap-5, -0x1.c934d86d23f1dp-60},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.7b97b4bce5b02p-3, 0x1.347b0b4f881cap-58},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.362773707ebccp-2, -0x1.963a544b672d8p-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.a64eec3cc23fdp-2, -0x1.24dec1b50b7ffp-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.0657e94db30d0p-1, -0x1.d5b495f6349e6p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.345f01cce37bbp-1, 0x1.1021137c71102p-55},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.5d58987169b18p-1, 0x1.0028e4bc5e7cap-57},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.819d0b7158a4dp-1, -0x1.bf76229d3b917p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

/* log((FIRST_LOG + i) / 32) */
enum { FIRST_LOG = 22, LAST_LOG = 46 };
static const struct dd log_of[] = {
    {-0x1.7fafa3bd8151cp-2, 0x1.219024acd3b77p-58},
    {-0x1.522ae0738a3d8p-2, 0x1.8f7e9b38a6979p-57},
    {-0x1.269621134db92p-2, -0x1.e0efadd9db02bp-56},
    {-0x1.f991c6cb3b379p-3, -0x1.f665066f980a2p-57},
    {-0x1.a93ed3c8ad9e3p-3, -0x1.bcafa9de97203p-57},
    {-0x1.5bf406b543db2p-3, 0x1.1f5b44c0df7e7p-61},
    {-0x1.1178e8227e47cp-3, 0x1.0e63a5f01c691p-58},
    {-0x1.9335e5d594989p-4, 0x1.478a85704ccb7p-58},
    {-0x1.08598b59e3a07p-4, 0x1.dd7009902bf32p-58},
    {-0x1.0415d89e74444p-5, -0x1.c05cf1d753622p-59},
    {0x0.0p+0, 0x0.0p+0},
    {0x1.f829b0e783300p-6, 0x1.33e3f04f1ef23p-60},
    {0x1.f0a30c01162a6p-5, 0x1.85f325c5bbacdp-59},
    {0x1.6f0d28ae56b4cp-4, -0x1.906d99184b992p-58},
    {0x1.e27076e2af2e6p-4, -0x1.61578001e0162p-60},
    {0x1.29552f81ff523p-3, 0x1.301771c407dbfp-57},
    {0x1.5ff3070a793d4p-3, -0x1.bc60efafc6f6ep-58},
    {0x1.9525a9cf456b4p-3, 0x1.d904c1d4e2e26p-57},
    {0x1.c8ff7c79a9a22p-3, -0x1.4f689f8434012p-57},
    {0x1.fb9186d5e3e2bp-3, -0x1.caaae64f21acbp-57},
    {0x1.1675cababa60ep-2, 0x1.ce63eab883717p-61},
    {0x1.2e8e2bae11d31p-2, -0x1.8f4cdb95ebdf9p-56},
    {0x1.4618bc21c5ec2p-2, 0x1.f42decdeccf1dp-56},
    {0x1.5d1bdbf5809cap-2, 0x1.4236383dc7fe1p-56},
    {0x1.739d7f6bbd007p-2, -0x1.8c76ceb014b04p-56},
};

/* 2^(i / 32) */
static const struct dd exp2_of[] = {
    {0x1.0000000000000p+0, 0x0.0p+0},
    {0x1.059b0d3158574p+0, 0x1.d73e2a475b465p-55},
    {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54},
    {0x1.11301d0125b51p+0, -0x1.6c51039449b3ap-54},
    {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55},
    {0x1.1d4873168b9aap+0, 0x1.e016e00a2643cp-54},
    {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54},
    {0x1.29e9df51fdee1p+0, 0x1.612e8afad1255p-55},
    {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55},
    {0x1.371a7373aa9cbp+0, -0x1.63aeabf42eae2p-54},
    {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55},
    {0x1.44e086061892dp+0, 0x1.89b7a04ef80d0p-59},
    {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56},
    {0x1.5342b569d4f82p+0, -0x1.07abe1db13cadp-55},
    {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54},
    {0x1.6247eb03a5585p+0, -0x1.383c17e40b497p-54},
    {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54},
    {0x1.71f75e8ec5f74p+0, -0x1.16e4786887a99p-55},
    {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55},
    {0x1.82589994cce13p+0, -0x1.d4c1dd41532d8p-54},
    {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54},
    {0x1.93737b0cdc5e5p+0, -0x1.75fc781b57ebcp-57},
    {0x1.9c49182a3f090p+0, 0x1.c7c46b071f2bep-56},
    {0x1.a5503b23e255dp+0, -0x1.d2f6edb8d41e1p-54},
    {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54},
    {0x1.b7f76f2fb5e47p+0, -0x1.5584f7e54ac3bp-56},
    {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55},
    {0x1.cb720dcef9069p+0, 0x1.503cbd1e949dbp-56},
    {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55},
    {0x1.dfc97337b9b5fp+0, -0x1.1a5cd4f184b5cp-54},
    {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54},
    {0x1.f50765b6e4540p+0, 0x1.9d3e12dd8a18bp-54},
};

static const struct dd half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
static const struct dd pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
static const struct dd log2_e = {0x1.71547652b82fep+0, 0x1.777d0ffda0d24p-56};
static const struct dd log10_e = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};
/* log(2); .hi ends in 17 zero bits, so that its product with an integer of 17 bits is exact. */
static const struct dd ln2 = {0x1.62e42fefa0000p-1, 0x1.cf79abc9e3b3ap-40};

static struct dd sum(double a, double b) /* exact (Knuth's two-sum) */
{
    double s = a + b, from_b = s - a;
    return (struct dd){s, (a - (s - from_b)) + (b - from_b)};
}

static struct dd split(double a)
{
    double c = 134217729.0 * a, hi = c - (c - a);
    return (struct dd){hi, a - hi};
}

static struct dd product(double a, double b) /* exact, but for under- and overflow */
{
    struct dd as = split(a), bs = split(b);
    double p = a * b;
    return (struct dd){p, ((as.hi * bs.hi - p) + as.hi * bs.lo + as.lo * bs.hi) + as.lo * bs.lo};
}

static struct dd times(struct dd a, struct dd b)
{
    struct dd p = product(a.hi, b.hi);
    return sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

/* a / b, of doubles without errors of their own. */
static struct dd quotient(double a, double b)
{
    double q = a / b;
    struct dd p = product(q, b);
    return (struct dd){q, ((a - p.hi) - p.lo) / b};
}

/* ---- Angles ---- */

struct turn {
    struct dd sine, cosine;
};

/* The sine and cosine of an angle up to pi / 4, by Taylor's series; the first term left out is
   below 2^-62 of the sum. */
static struct turn turn_of(struct dd r)
{
    static const struct {
        double sine, cosine;
    } terms[] = {{-1.0 / 6.0, 1.0 / 24.0},
                 {1.0 / 120.0, -1.0 / 720.0},
                 {-1.0 / 5040.0, 1.0 / 40320.0},
                 {1.0 / 362880.0, -1.0 / 3628800.0},
                 {-1.0 / 39916800.0, 1.0 / 479001600.0},
                 {1.0 / 6227020800.0, -1.0 / 87178291200.0},
                 {-1.0 / 1307674368000.0, 1.0 / 20922789888000.0},
                 {1.0 / 355687428096000.0, -1.0 / 6402373705728000.0},
                 {-1.0 / 121645100408832000.0, 1.0 / 2432902008176640000.0}};
    struct dd square = product(r.hi, r.hi);
    double z = square.hi, s = 0.0, c = 0.0;
    for (size_t i = sizeof terms / sizeof *terms; i-- > 0;) {
        s = terms[i].sine + z * s;
        c = terms[i].cosine + z * c;
    }
    struct dd sine = sum(r.hi, r.hi * z * s + r.lo * (1.0 - 0.5 * z));
    struct dd cosine = sum(1.0, -0.5 * z);
    double low = cosine.lo + (z * z * c - 0.5 * square.lo - r.hi * r.lo);
    return (struct turn){sine, sum(cosine.hi, low)};
}

/* Reduces an angle by multiples of pi / 2, which is given in four parts (Cody and Waite 1980). The
   first three parts have 33 bits, so that their products with integers up to 2^20 are exact. */
static struct turn turn_by(double angle)
{
    static const double parts[] = {0x1.921fb54400000p+0, 0x1.0b4611a600000p-34,
                                   0x1.3198a2e000000p-69, 0x1.b839a252049c1p-104};
    double left = fabs(angle) > 1e6 ? fmod(angle, 2.0 * pi.hi) : angle;
    double quarters = floor(left / half_pi.hi + 0.5);
    struct dd r = sum(left - quarters * parts[0], -quarters * parts[1]);
    struct dd rest = sum(r.hi, -quarters * parts[2]);
    r = sum(rest.hi, rest.lo + (r.lo - quarters * parts[3]));
    struct turn t = turn_of(r);
    struct dd sine = t.sine, cosine = t.cosine;
    uint32_t quarter = (uint32_t)(int32_t)quarters & 3u;
    if (quarter & 1u)
        t = (struct turn){cosine, {-sine.hi, -sine.lo}};
    if (quarter & 2u)
        t = (struct turn){{-t.sine.hi, -t.sine.lo}, {-t.cosine.hi, -t.cosine.lo}};
    return t;
}

double same_sin(double angle)
{
    return angle == 0.0 ? angle : isfinite(angle) ? turn_by(angle).sine.hi : NAN;
}

double same_cos(double angle)
{
    return isfinite(angle) ? turn_by(angle).cosine.hi : NAN;
}

double same_tan(double angle)
{
    if (!isfinite(angle) || angle == 0.0)
        return angle == 0.0 ? angle : NAN;
    struct turn t = turn_by(angle);
    struct dd q = quotient(t.sine.hi, t.cosine.hi);
    return q.hi + (q.lo + (t.sine.lo - q.hi * t.cosine.lo) / t.cosine.hi);
}

/* The angle in 0..pi / 4 whose tangent is `small` / `large`, neither negative: the table's angle of
   a tangent i / 16 near it, plus the rest that the addition theorem gives, by Taylor's series. */
static struct dd small_angle(double small, double large)
{
    int exponent;
    (void)frexp(large, &exponent); /* scaled away from overflow and underflow */
    small = ldexp(small, -exponent);
    large = ldexp(large, -exponent);
    int i = (int)floor(16.0 * (small / large) + 0.5);
    double c = i / 16.0;
    struct dd taken = product(c, large);
    struct dd t = quotient((small - taken.hi) - taken.lo, large + c * small);
    double z = t.hi * t.hi;
    double series =
        -1.0 / 3.0 + z * (1.0 / 5.0 + z * (-1.0 / 7.0 + z * (1.0 / 9.0 + z * (-1.0 / 11.0))));
    struct dd angle = sum(atan_of[i].hi, t.hi);
    return sum(angle.hi, angle.lo + (atan_of[i].lo + (t.hi * z * series + t.lo)));
}

static struct dd difference(struct dd a, struct dd b)
{
    struct dd s = sum(a.hi, -b.hi);
    return sum(s.hi, s.lo + (a.lo - b.lo));
}

/* The angle in 0..pi from the x axis to (x, y), for finite numbers, y not negative, not both 0. */
static struct dd angle_of(double y, double x)
{
    double size = fabs(x);
    struct dd angle = y > size ? difference(half_pi, small_angle(size, y)) : small_angle(y, size);
    return x < 0.0 ? difference(pi, angle) : angle;
}

double same_atan2(double y, double x)
{
    double size = fabs(y);
    if (isnan(y) || isnan(x))
        return NAN;
    if (size == 0.0 || (isinf(x) && !isinf(y)))
        return copysign(signbit(x) ? pi.hi : 0.0, y);
    if (isinf(y))
        return copysign(isinf(x) ? angle_of(1.0, copysign(1.0, x)).hi : half_pi.hi, y);
    return copysign(angle_of(size, x).hi, y);
}

/* The angle of (x, sqrt(1 - x^2)). An error of the root turns the angle by x times as much. */
double same_acos(double x)
{
    if (!(fabs(x) <= 1.0))
        return NAN;
    struct dd square = product(x, x), s = sum(1.0, -square.hi);
    s = sum(s.hi, s.lo - square.lo);
    double y = sqrt(s.hi);
    if (y == 0.0)
        return x < 0.0 ? pi.hi : 0.0;
    struct dd again = product(y, y), angle = angle_of(y, x);
    double low = ((s.hi - again.hi) + (s.lo - again.lo)) / (2.0 * y);
    return angle.hi + (angle.lo + low * x);
}

/* ---- Logarithms and powers ---- */

/* The natural logarithm of a finite x > 0: x = 2^e m, and log(m) = log(c) + 2 artanh(t) with t = (m
   - c) / (m + c), where c is the multiple i / 32 nearest to m. */
static struct dd log_pair(double x)
{
    int e;
    double m = frexp(x, &e);
    if (m < 0.70710678118654752) {
        m *= 2.0;
        --e;
    }
    int i = (int)floor(32.0 * m + 0.5);
    double c = i / 32.0;
    struct dd below = sum(m, c), t = quotient(m - c, below.hi);
    double low = t.lo - t.hi * below.lo / below.hi, z = t.hi * t.hi;
    double series = 1.0 / 3.0 + z * (1.0 / 5.0 + z * (1.0 / 7.0 + z * (1.0 / 9.0)));
    struct dd whole = sum(e * ln2.hi, log_of[i - FIRST_LOG].hi), all = sum(whole.hi, 2.0 * t.hi);
    double rest = e * ln2.lo + log_of[i - FIRST_LOG].lo + 2.0 * (t.hi * z * series + low);
    return sum(all.hi, all.lo + (whole.lo + rest));
}

/* The logarithm where x is not a finite number above 0. */
static double log_end(double x)
{
    return x == 0.0 ? -INFINITY : x > 0.0 ? x : NAN;
}

static bool has_log(double x)
{
    return x > 0.0 && isfinite(x);
}

double same_log(double x)
{
    return has_log(x) ? log_pair(x).hi : log_end(x);
}

double same_log2(double x)
{
    return has_log(x) ? times(log_pair(x), log2_e).hi : log_end(x);
}

double same_log10(double x)
{
    return has_log(x) ? times(log_pair(x), log10_e).hi : log_end(x);
}

/* e to the power x, for x in -746..710: 2^(k / 32) from the table, times Taylor's series of the
   rest. */
static double exp_of(struct dd x)
{
    double k = floor(x.hi * 32.0 / (ln2.hi + ln2.lo) + 0.5);
    double r = ((x.hi - k * (ln2.hi / 32.0)) - k * (ln2.lo / 32.0)) + x.lo;
    double p =
        r *
        (1.0 +
         r * (1.0 / 2.0 +
              r * (1.0 / 6.0 +
                   r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0)))))));
    int32_t whole = (int32_t)k;
    const struct dd *of = &exp2_of[whole & 31];
    return ldexp(of->hi + (of->hi * p + of->lo), (whole - (whole & 31)) / 32);
}

static double exp_pair(struct dd x)
{
    return x.hi > 710.0 ? INFINITY : x.hi < -746.0 ? 0.0 : exp_of(x);
}

double same_exp(double x)
{
    return isnan(x) ? NAN : exp_pair((struct dd){x, 0.0});
}

double same_pow(double x, double y)
{
    if (y == 0.0 || x == 1.0)
        return 1.0;
    if (isnan(y) || !(x >= 0.0))
        return NAN;
    if (x == 0.0 || isinf(x))
        return (x == 0.0) == (y < 0.0) ? INFINITY : 0.0;
    double bounded = fmax(-1e20, fmin(1e20, y));
    struct dd l = log_pair(x), p = product(l.hi, bounded);
    return exp_pair(sum(p.hi, p.lo + l.lo * bounded));
}
