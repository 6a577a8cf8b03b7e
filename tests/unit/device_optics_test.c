/* shaders/lib/optics.glsl on the device, compared with double precision. The oracles use other
   formulas than the shader, with the exact angle instead of its rounded cosine. */
#include "one_device_fixture.h"
#include "random_fixture.h"

#include "device_optics.h"
#include "unit.h"

#define PI     3.14159265358979323846
#define DEGREE (PI / 180.0)

/* The record of device_optics.comp. */
struct optics_case {
    float dir[3], eta;
    float n[3], cos_in;
    float cos_half, cos_light, cos_view, alpha;
    float shininess, pad[3];
};
struct optics_answer {
    float refracted[3], passes;
    float exact, schlick, blinn, ggx;
};

enum { CASES_MAX = 40000 };

static struct optics_case cases[CASES_MAX];
static struct optics_answer answers[CASES_MAX];
static double angles[CASES_MAX]; /* angle of incidence of each case */
static uint32_t count;

static const double indices[] = {1.33, 1.5, 2.42};

static int begin(void **state)
{
    (void)state;
    memset(cases, 0, sizeof cases);
    count = 0;
    return 0;
}

/* Adds a case: a ray in the xy plane that hits the face y = 0 at `angle` to the normal. */
static struct optics_case *add_angle(double angle, double eta)
{
    assert_true(count < CASES_MAX);
    struct optics_case *c = &cases[count];
    angles[count++] = angle;
    c->dir[0] = (float)sin(angle);
    c->dir[1] = -(float)cos(angle);
    c->n[1] = 1.0f;
    c->cos_in = (float)cos(angle);
    c->eta = (float)eta;
    c->alpha = 1.0f;
    return c;
}

static void run_cases(void)
{
    assert_true(count > 0);
    kernel_answer(device, device_optics, sizeof device_optics, count, cases, sizeof *cases, answers,
                  sizeof *answers);
}

/* --- oracles -------------------------------------------------------------------------------- */

/* Fresnel reflectance by sines and tangents of the two angles (Fresnel 1823). */
static double fresnel(double angle, double eta)
{
    double sine = eta * sin(angle);
    if (eta == 1.0)
        return 0.0;
    if (sine >= 1.0)
        return 1.0;
    if (angle < 1e-8)
        return (1 - eta) / (1 + eta) * ((1 - eta) / (1 + eta));
    double out = asin(sine);
    double s = sin(angle - out) / sin(angle + out), p = tan(angle - out) / tan(angle + out);
    return 0.5 * (s * s + p * p);
}

static double schlick(double angle, double eta)
{
    double sine = eta * sin(angle), f0 = (1 - eta) / (1 + eta) * ((1 - eta) / (1 + eta));
    if (sine >= 1.0)
        return 1.0;
    double cosine = cos(eta > 1.0 ? asin(sine) : angle);
    return f0 + (1 - f0) * pow(1 - cosine, 5);
}

static void assert_within(double value, double expected, double max)
{
    if (!(fabs(value - expected) <= max))
        fail_msg("%.9g is not %.9g within %g", value, expected, max);
}

/* --- Fresnel -------------------------------------------------------------------------------- */

TEST_IN(fresnel_at_known_angles, begin, NULL)
{
    static const double degrees[] = {0, 45, 89};
    /* From the side with the smaller index, by hand: 45 degrees into 1.5 refracts to 28.1255. */
    add_angle(45 * DEGREE, 1 / 1.5);
    add_angle(0, 1.5);
    for (int i = 0; i < 18; i++)
        add_angle(degrees[i / 2 % 3] * DEGREE, i % 2 ? indices[i / 6] : 1 / indices[i / 6]);
    run_cases();
    assert_within((double)answers[0].exact, 0.0502399, 1e-6);
    assert_within((double)answers[1].exact, 0.04, 1e-7);
    for (uint32_t i = 2; i < count; i++) {
        print_message("  %2.0f degrees, eta %.3f: %.6f\n", angles[i] / DEGREE, (double)cases[i].eta,
                      (double)answers[i].exact);
        assert_within((double)answers[i].exact, fresnel(angles[i], (double)cases[i].eta), 1e-6);
    }
}

/* Steps of 1e-7 across the critical angle, then wider ones. Near it F falls as the square root of
   the angle, so that the rounding of the cosine alone moves it by sqrt(6e-8) times a few. */
TEST_IN(critical_angle_is_met, begin, NULL)
{
    for (int n = 0; n < 3; n++) {
        double critical = asin(1 / indices[n]);
        begin(NULL);
        for (int i = -2000; i <= 2000; i++)
            add_angle(critical + i * 1e-7, indices[n]);
        for (int i = -8000; i <= 4000; i++)
            add_angle(critical + i * 5e-5, indices[n]);
        run_cases();
        double near = 0, far = 0;
        for (uint32_t i = 0; i < count; i++) {
            double off = fabs((double)answers[i].exact - fresnel(angles[i], indices[n]));
            bool is_near = fabs(angles[i] - critical) <= 1e-3;
            near = fmax(near, is_near ? off : 0);
            far = fmax(far, is_near ? 0 : off);
            assert_true(isfinite(answers[i].exact));
            /* Total reflection in both: if nothing passes, all is reflected. */
            assert_true((answers[i].passes == 0.0f) == (answers[i].exact == 1.0f));
        }
        print_message("  n %.2f: off by %.2g at the critical angle, %.2g elsewhere\n", indices[n],
                      near, far);
        assert_true(near <= 5e-3);
        assert_true(far <= 1e-5);
    }
}

/* Reflectance and transmittance, the latter from the two directions alone (Born and Wolf,
   1.5.3), sum to 1. Angles near the critical one are left out, where the direction's cosine is
   inaccurate. */
TEST_IN(nothing_is_lost, begin, NULL)
{
    for (int n = 0; n < 3; n++)
        for (int i = 0; i < 900; i++) {
            double angle = i * 0.1 * DEGREE, critical = asin(1 / indices[n]);
            add_angle(angle, 1 / indices[n]);
            if (angle < critical - 0.02)
                add_angle(angle, indices[n]);
        }
    run_cases();
    double max = 0;
    for (uint32_t i = 0; i < count; i++) {
        double in = cos(angles[i]), out = -(double)answers[i].refracted[1];
        double eta = (double)cases[i].eta;
        double s = 2 * eta * in / (eta * in + out), p = 2 * eta * in / (in + eta * out);
        double passed = out / (eta * in) * 0.5 * (s * s + p * p);
        max = fmax(max, fabs(passed + (double)answers[i].exact - 1));
    }
    print_message("  R + T = 1 within %.2g\n", max);
    assert_true(max <= 1e-6);
}

TEST_IN(grazing_rays_are_reflected, begin, NULL)
{
    for (int n = 0; n < 3; n++)
        for (int side = 0; side < 2; side++)
            for (int i = 0; i <= 1000; i++) {
                struct optics_case *c = add_angle(PI / 2, side ? indices[n] : 1 / indices[n]);
                c->cos_in = i == 1 ? 1e-42f : (float)i * 1e-9f;
                c->dir[1] = -c->cos_in;
            }
    run_cases();
    for (uint32_t i = 0; i < count; i++) {
        double angle = PI / 2 - (double)cases[i].cos_in;
        assert_within((double)answers[i].exact, fresnel(angle, (double)cases[i].eta), 1e-6);
        assert_true(answers[i].exact <= 1.0f);
        assert_within((double)answers[i].schlick, 1.0, 6e-6);
        double length = 0;
        for (int k = 0; k < 3; k++)
            length += (double)answers[i].refracted[k] * (double)answers[i].refracted[k];
        assert_within(sqrt(length), cases[i].eta < 1 ? 1 : 0, 2e-6);
    }
}

TEST_IN(equal_indices_leave_rays_alone, begin, NULL)
{
    for (int i = 0; i <= 9000; i++)
        add_angle(i * 0.01 * DEGREE, 1.0);
    cases[count - 1].cos_in = 0.0f;
    run_cases();
    for (uint32_t i = 0; i < count; i++) {
        assert_true(answers[i].exact == 0.0f);
        assert_true(answers[i].schlick == 0.0f);
        for (int k = 0; k < 3 && i + 1 < count; k++)
            assert_within((double)answers[i].refracted[k], (double)cases[i].dir[k], 2.5e-7);
    }
}

TEST_IN(schlick_is_off_as_stated, begin, NULL)
{
    static const double stated[] = {0.0599, 0.0357, 0.0757};
    for (int n = 0; n < 3; n++) {
        begin(NULL);
        for (int i = 0; i < 9000; i++) {
            double angle = i * 0.01 * DEGREE;
            add_angle(angle, 1 / indices[n]);
            if (fabs(angle - asin(1 / indices[n])) > 1e-3)
                add_angle(angle, indices[n]);
        }
        run_cases();
        double own = 0, off = 0;
        for (uint32_t i = 0; i < count; i++) {
            /* The exact index, not the float. */
            double eta = cases[i].eta > 1 ? indices[n] : 1 / indices[n];
            own = fmax(own, fabs((double)answers[i].schlick - schlick(angles[i], eta)));
            off = fmax(off, fabs((double)answers[i].schlick - fresnel(angles[i], eta)));
        }
        print_message("  n %.2f: Schlick is off by %.4f; its rounding %.2g\n", indices[n], off,
                      own);
        assert_true(own <= 1e-5);
        assert_within(off, stated[n], 1e-4);
    }
}

/* --- refraction ----------------------------------------------------------------------------- */

TEST_IN(snell_at_known_angles, begin, NULL)
{
    for (int n = 0; n < 3; n++)
        for (int i = 0; i < 900; i++) {
            add_angle(i * 0.1 * DEGREE, 1 / indices[n]);
            add_angle(i * 0.1 * DEGREE, indices[n]);
        }
    run_cases();
    double bent = 0, length = 0;
    uint32_t passed = 0;
    for (uint32_t i = 0; i < count; i++) {
        double eta = indices[i / 1800];
        eta = i % 2 ? eta : 1 / eta;
        double sine = eta * sin(angles[i]);
        const float *t = answers[i].refracted;
        if (answers[i].passes == 0.0f) {
            assert_true(sine >= 1 - 1e-6);
            continue;
        }
        passed++;
        double size = sqrt((double)t[0] * (double)t[0] + (double)t[1] * (double)t[1]);
        length = fmax(length, fabs(size - 1));
        bent = fmax(bent, fabs((double)t[0] / size - sine));
        assert_true(t[2] == 0.0f);
        assert_true(t[1] <= 0.0f);
    }
    print_message("  sine off by %.2g, length by %.2g\n", bent, length);
    assert_true(passed > 2700 + 1000);
    assert_true(bent <= 5e-7);
    assert_true(length <= 2e-6);
}

static void unit(float *out)
{
    double v[3], length;
    do {
        length = 0;
        for (int k = 0; k < 3; k++) {
            v[k] = 2.0 * (double)random_float(&random_state) - 1.0;
            length += v[k] * v[k];
        }
    } while (length < 0.01 || length > 1);
    for (int k = 0; k < 3; k++)
        out[k] = (float)(v[k] / sqrt(length));
}

/* For rays and normals in any orientation, the refracted direction is unit, in the plane of ray and
   normal, and on the other side. */
TEST_IN(refraction_in_any_frame, begin, NULL)
{
    random_state = 7;
    for (int i = 0; i < 30000; i++) {
        struct optics_case *c = add_angle(0, i % 2 ? indices[i % 3] : 1 / indices[i % 3]);
        unit(c->n);
        unit(c->dir);
        float side = 0;
        for (int k = 0; k < 3; k++)
            side += c->n[k] * c->dir[k];
        for (int k = 0; k < 3; k++)
            c->dir[k] = side > 0 ? -c->dir[k] : c->dir[k];
    }
    run_cases();
    double length = 0, sine = 0;
    for (uint32_t i = 0; i < count; i++) {
        const float *d = cases[i].dir, *n = cases[i].n, *t = answers[i].refracted;
        double in[3], out[3], size = 0, across = 0, off = 0;
        if (answers[i].passes == 0.0f)
            continue;
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            in[k] = (double)d[p] * (double)n[q] - (double)d[q] * (double)n[p];
            out[k] = (double)t[p] * (double)n[q] - (double)t[q] * (double)n[p];
            size += (double)t[k] * (double)t[k];
            across += (double)t[k] * (double)n[k];
            off = fmax(off, fabs(out[k] - (double)cases[i].eta * in[k]));
        }
        length = fmax(length, fabs(sqrt(size) - 1));
        sine = fmax(sine, off);
        assert_true(across <= 0);
    }
    print_message("  length off by %.2g, n x t by %.2g\n", length, sine);
    assert_true(length <= 2e-6);
    assert_true(sine <= 1e-6);
}

/* --- highlights ----------------------------------------------------------------------------- */

/* pow(x, y) is exp2(y log2 x). Vulkan allows log2 an error of 2^-21 between 1/2 and 2 and of 3 ulp
   elsewhere, and exp2 one of 3 + 2 |x| ulp. */
TEST_IN(blinn_is_a_power, begin, NULL)
{
    static const double exponents[] = {0, 1, 10, 60, 1000};
    for (int e = 0; e < 5; e++)
        for (int i = 0; i <= 1000; i++) {
            struct optics_case *c = add_angle(0, 1);
            c->cos_half = (float)i / 1000.0f;
            c->shininess = (float)exponents[e];
        }
    run_cases();
    for (uint32_t i = 0; i < count; i++) {
        double x = (double)cases[i].cos_half, y = (double)cases[i].shininess;
        double expected = x > 0 ? pow(x, y) : 0, power = x > 0 ? fabs(y * log2(x)) : 0;
        double max = log(2) * (y / 2097152.0 + 3 * power / 8388608.0) + (3 + 2 * power) / 8388608.0;
        if (expected > 1e-30)
            assert_within((double)answers[i].blinn, expected, max * expected);
        else
            assert_within((double)answers[i].blinn, 0, 2e-30);
    }
}

/* The lobe times pi: Walter 2007, eq. 33, with Heitz 2014's visibility as Hammon (2017) fits it. */
static double ggx(double half, double light, double view, double alpha)
{
    double tangent2 = (1 - half * half) / (half * half), a2 = alpha * alpha;
    double spread = (1 - alpha) * 2 * light * view + alpha * (light + view);
    return a2 / (pow(half, 4) * (a2 + tangent2) * (a2 + tangent2)) * 0.5 / spread;
}

TEST_IN(ggx_keeps_its_tip, begin, NULL)
{
    static const float alphas[] = {0.02f, 0.1f, 0.5f, 1.0f};
    for (int a = 0; a < 4; a++)
        for (int i = 0; i < 2000; i++) {
            struct optics_case *c = add_angle(0, 1);
            c->cos_half = i < 1000 ? 1.0f - (float)i * 1e-6f : 1.0f - (float)(i - 1000) * 9e-4f;
            c->cos_light = 0.1f + 0.9f * (float)(i % 97) / 96.0f;
            c->cos_view = 0.1f + 0.9f * (float)(i % 89) / 88.0f;
            c->alpha = alphas[a];
        }
    run_cases();
    double max = 0;
    for (uint32_t i = 0; i < count; i++) {
        const struct optics_case *c = &cases[i];
        double expected =
            ggx((double)c->cos_half, (double)c->cos_light, (double)c->cos_view, (double)c->alpha);
        max = fmax(max, fabs((double)answers[i].ggx / expected - 1));
    }
    print_message("  GGX within %.2g of itself\n", max);
    assert_true(max <= 2e-6);
}

TESTS_IN(device_begin, device_end)
