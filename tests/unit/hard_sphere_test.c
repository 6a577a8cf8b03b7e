/* Spheres at `exact` beside fractions: which end of the chord is met, and the floats that its t is
   between; and what the filter says of them. */
#include "hard_fixture.h"

#include "accel/pairs_sphere.h"
#include "fraction_fixture.h"

struct subject {
    struct vec3 origin, dir, center;
    float radius, t_min;
};

typedef struct subject (*make_fn)(void);

/* ---- What is so ---- */

struct truth {
    mpq_t p, s, q; /* the t of both ends: p t^2 - 2 s t + q = 0 */
    mpq_t room;    /* r^2 less the square of the distance of the centre from the line */
    bool met;      /* the line meets the sphere */
};

static void truth_init(struct truth *truth)
{
    mpq_inits(truth->p, truth->s, truth->q, truth->room, NULL);
}

static void truth_clear(struct truth *truth)
{
    mpq_clears(truth->p, truth->s, truth->q, truth->room, NULL);
}

static void add_product(mpq_t sum, const mpq_t a, const mpq_t b)
{
    mpq_t product;
    mpq_init(product);
    mpq_mul(product, a, b);
    mpq_add(sum, sum, product);
    mpq_clear(product);
}

static void find_truth(const struct subject *subject, struct truth *truth)
{
    mpq_t d[3], o[3], m[3], rr;
    mpq_init(rr);
    for (int k = 0; k < 3; ++k)
        mpq_inits(d[k], o[k], m[k], NULL);
    set_vector(d, subject->dir);
    set_vector(o, subject->origin);
    set_vector(m, subject->center);
    mpq_set_ui(truth->p, 0, 1);
    mpq_set_ui(truth->s, 0, 1);
    mpq_set_d(rr, (double)subject->radius);
    mpq_mul(rr, rr, rr);
    mpq_neg(truth->q, rr);
    for (int k = 0; k < 3; ++k) {
        mpq_sub(m[k], m[k], o[k]);
        add_product(truth->p, d[k], d[k]);
        add_product(truth->s, m[k], d[k]);
        add_product(truth->q, m[k], m[k]);
    }
    set_product(truth->room, truth->s, truth->s, truth->p, truth->q);
    mpq_div(truth->room, truth->room, truth->p);
    truth->met = mpq_sgn(truth->room) >= 0;
    for (int k = 0; k < 3; ++k)
        mpq_clears(d[k], o[k], m[k], NULL);
    mpq_clear(rr);
}

/* Where an end is beside t: 1 beyond it. */
static int side_of(const struct truth *truth, const mpq_t t, bool far)
{
    mpq_t slope, f;
    mpq_inits(slope, f, NULL);
    mpq_mul(slope, truth->p, t);
    mpq_sub(slope, slope, truth->s); /* 0 at the middle of the chord */
    int half = mpq_sgn(slope);
    mpq_sub(slope, slope, truth->s);
    mpq_mul(f, slope, t);
    mpq_add(f, f, truth->q); /* below 0 within the chord */
    int within = mpq_sgn(f);
    mpq_clears(slope, f, NULL);
    if (within < 0)
        return far ? 1 : -1;
    if (within == 0 && (half == 0 || (half > 0) == far))
        return 0;
    return half > 0 ? -1 : 1;
}

/* Whether the key of an end is above a float that is not negative. */
static bool is_above(const struct truth *truth, float x, bool far)
{
    uint32_t bits;
    mpq_t middle, next;
    memcpy(&bits, &x, sizeof bits);
    mpq_inits(middle, next, NULL);
    double above = x < FLT_MAX ? (double)nextafterf(x, INFINITY) : 0x1p128;
    mpq_set_d(middle, (double)x);
    mpq_set_d(next, above);
    mpq_add(middle, middle, next);
    mpq_div_2exp(middle, middle, 1);
    int side = side_of(truth, middle, far);
    mpq_clears(middle, next, NULL);
    return side > 0 || (side == 0 && bits % 2 != 0);
}

static bool is_ahead(const struct truth *truth, bool far)
{
    mpq_t zero;
    mpq_init(zero);
    bool ahead = side_of(truth, zero, far) >= 0;
    mpq_clear(zero);
    return ahead;
}

static bool is_key(const struct truth *truth, float key, bool far)
{
    return key >= 0.0f && !is_above(truth, key, far) &&
           (key == 0.0f || is_above(truth, nextafterf(key, 0.0f), far));
}

/* Of an end, and of keys from t_min on. */
static bool counts(const struct truth *truth, float t_min, bool far)
{
    return truth->met && is_ahead(truth, far) && !is_above(truth, FLT_MAX, far) &&
           (t_min == 0.0f || is_above(truth, nextafterf(t_min, 0.0f), far));
}

/* ---- Rays and spheres ---- */

static float either_sign(float x)
{
    return random_bits() % 2 ? x : -x;
}

/* Through the sphere or past it; a third grazes it. */
static struct subject aim(float radius, float away, float size)
{
    struct subject s = {.radius = radius, .center = random_point(size)};
    s.origin = vec3_add(s.center, random_point(away));
    struct vec3 to = random_point(1.0f);
    uint32_t kind = random_bits() % 3;
    if (kind == 0) { /* from the line's side at about one radius */
        struct vec3 along = vec3_sub(s.center, s.origin), side = vec3_cross(along, to);
        float length = sqrtf(vec3_dot(side, side));
        to = length > 0.0f ? vec3_scale(side, 1.0f / length) : to;
    }
    s.dir = vec3_sub(vec3_add(s.center, vec3_scale(to, radius)), s.origin);
    return s;
}

static struct subject make_ordinary(void)
{
    return aim(0.1f + random_float(), 5.0f, 3.0f);
}

static struct subject make_inside(void)
{
    return aim(1.0f + random_float(), 0.5f, 3.0f);
}

static struct subject make_far(void)
{
    return aim(0.1f + random_float(), 1e7f, 3.0f);
}

static struct subject make_tiny(void)
{
    return aim(1e-9f * random_float(), 1e-7f, 1e-8f);
}

static struct subject make_huge(void)
{
    return aim(1e11f * random_float(), 1e13f, 1e12f);
}

/* Squares of all that is here are 0 in floats. */
static struct subject make_denormal(void)
{
    return aim(1e-40f * random_float(), 1e-38f, 1e-39f);
}

/* Directions that floats do not square, or do not divide by; components that they lose. */
static struct subject make_stretched(void)
{
    struct subject s = make_ordinary();
    static const float sizes[] = {1e-40f, 1e-33f, 1e33f};
    s.dir = vec3_scale(s.dir, sizes[random_bits() % 3]);
    if (random_bits() % 2)
        s.dir.x *= 1e-30f;
    s.radius = random_bits() % 2 ? 3.0f : s.radius;
    return s;
}

struct frame {
    struct vec3 x, y;
    float length; /* of x and y, which are at right angles, all in integers */
};

/* Of an integer quaternion (Euler, Rodrigues). */
static struct frame integer_frame(int most)
{
    int a = 1 + (int)(random_bits() % (uint32_t)most), b = (int)(random_bits() % (uint32_t)most);
    int c = (int)(random_bits() % (uint32_t)most), d = (int)(random_bits() % (uint32_t)most);
    return (struct frame){
        .x = vec3_make((float)(a * a + b * b - c * c - d * d), (float)(2 * (b * c + a * d)),
                       (float)(2 * (b * d - a * c))),
        .y = vec3_make((float)(2 * (b * c - a * d)), (float)(a * a - b * b + c * c - d * d),
                       (float)(2 * (c * d + a * b))),
        .length = (float)(a * a + b * b + c * c + d * d)};
}

static struct vec3 grid_point(int most)
{
    float range = (float)(2 * most + 1), middle = (float)most;
    float x = floorf(random_float() * range) - middle, y = floorf(random_float() * range) - middle;
    return vec3_make(x, y, floorf(random_float() * range) - middle);
}

/* In one point exactly. */
static struct subject make_tangent(void)
{
    struct frame f = integer_frame(20);
    struct subject s = {.origin = grid_point(10000), .dir = f.x};
    float k = (float)(1 + random_bits() % 50), along = floorf(random_within(100.0f));
    s.radius = k * f.length;
    s.center =
        vec3_add(s.origin, vec3_add(vec3_scale(f.y, either_sign(k)), vec3_scale(f.x, along)));
    return s;
}

/* Within a float of that. */
static struct subject make_nearly_tangent(void)
{
    struct subject s = make_tangent();
    s.radius = nextafterf(s.radius, random_bits() % 2 ? INFINITY : 0.0f);
    return s;
}

/* Through the centre; both t are integers with one bit more than a float has. */
static struct subject make_between(void)
{
    struct frame f = integer_frame(3);
    float half = (float)(random_bits() % 64), t = (float)(64 + random_bits() % 64);
    struct subject s = {.dir = f.x, .radius = (half + 1.0f) * f.length};
    s.origin = vec3_scale(f.x, -16777216.0f);
    s.center = vec3_scale(f.x, t);
    return s;
}

/* On the sphere; inwards, outwards, along it. */
static struct subject make_on_surface(void)
{
    struct frame f = integer_frame(20);
    struct subject s = {.center = grid_point(10000), .radius = f.length, .dir = f.x};
    uint32_t kind = random_bits() % 3;
    if (kind < 2)
        s.dir = vec3_add(f.x, vec3_scale(f.y, either_sign((float)(random_bits() % 10))));
    s.origin = vec3_add(s.center, f.y);
    return s;
}

/* ---- Both beside each other ---- */

struct tally {
    uint32_t rays, met, exits, wrong, sure, wrong_pairs, inside, outside, bad_bounds;
    double worst; /* error of the room, of its bound */
};

static void set_t_min(struct subject *s)
{
    s->t_min = 0.0f;
    struct sphere_meeting m;
    uint32_t kind = random_bits() % 4;
    exact_meet_sphere(s->origin, s->dir, s->center, s->radius, random_bits() % 2, 0.0f, &m);
    if (m.met && kind > 0)
        s->t_min = kind == 1 ? m.key : nextafterf(m.key, kind == 2 ? INFINITY : 0.0f);
}

static bool is_right(const struct truth *truth, const struct sphere_meeting *m, bool near, bool far)
{
    return m->met == (near || far) &&
           (!m->met || (m->at_exit == far && m->inward == (mpq_sgn(truth->s) > 0) &&
                        is_key(truth, m->key, far)));
}

static void check_meeting(const struct subject *s, const struct truth *truth, struct tally *tally)
{
    for (int only_far = 0; only_far < 2; ++only_far) {
        struct sphere_meeting m, of_pairs;
        exact_meet_sphere(s->origin, s->dir, s->center, s->radius, only_far, s->t_min, &m);
        bool sure = pair_meet_sphere(s->origin, s->dir, s->center, s->radius, only_far, s->t_min,
                                     &of_pairs);
        bool near = !only_far && counts(truth, s->t_min, false);
        bool far = !near && counts(truth, s->t_min, true);
        ++tally->rays;
        tally->met += m.met;
        tally->exits += m.met && m.at_exit;
        tally->sure += sure;
        tally->wrong += !is_right(truth, &m, near, far);
        tally->wrong_pairs += sure && !is_right(truth, &of_pairs, near, far);
    }
}

static bool is_bounded(const struct truth *truth, float lo, float hi, bool far)
{
    if (!is_ahead(truth, far))
        return true; /* nothing is said of keys below 0 */
    return (lo <= 0.0f || isinf(lo) || is_above(truth, nextafterf(lo, 0.0f), far)) &&
           (hi == INFINITY || (hi >= 0.0f && !is_above(truth, hi, far)));
}

static void check_bounds(const struct subject *s, const struct truth *truth, struct tally *tally)
{
    struct ray_setup ray = make_ray_setup(s->origin, s->dir);
    struct sphere_bounds bounds;
    bound_ray_setup(&ray);
    bound_sphere(&ray, s->center, s->radius, &bounds);
    struct foot foot = drop_perpendicular(&ray, s->center, s->radius);
    struct chord chord = intersect_sphere(&ray, s->center, s->radius, 0.0f);
    tally->inside += bounds.inside;
    tally->outside += bounds.outside;
    bool good = !(bounds.inside && !truth->met) && !(bounds.outside && truth->met);
    good = good && !(bounds.inward_known && chord.inward != (mpq_sgn(truth->s) > 0));
    if (truth->met)
        good = good && is_bounded(truth, bounds.near_lo, bounds.near_hi, false) &&
               is_bounded(truth, bounds.far_lo, bounds.far_hi, true);
    if (bounds.room_error < INFINITY && isfinite(foot.room)) {
        mpq_t off;
        mpq_init(off);
        mpq_set_d(off, (double)foot.room);
        mpq_sub(off, off, truth->room);
        double share = fabs(mpq_get_d(off)) / (double)bounds.room_error;
        tally->worst = fmax(tally->worst, share);
        good = good && share <= 1.0;
        mpq_clear(off);
    }
    tally->bad_bounds += !good;
}

static void spheres_are_met_as_fractions_say(void **state)
{
    (void)state;
    enum { SUBJECTS = 10000 };
    static const struct {
        const char *name;
        make_fn make;
        double filtered, sure; /* shares that the filter and pairs decide, at least */
    } kinds[] = {
        {"ordinary", make_ordinary, 0.6, 0.9},
        {"from inside", make_inside, 0.9, 0.99},
        {"from far away", make_far, 0.0, 0.0},
        {"tiny", make_tiny, 0.6, 0.6},
        {"huge", make_huge, 0.6, 0.0},
        {"denormals", make_denormal, 0.0, 0.0},
        {"long and short directions", make_stretched, 0.0, 0.0},
        {"exactly tangent", make_tangent, 0.0, 0.0},
        {"tangent but for one float", make_nearly_tangent, 0.0, 0.8},
        {"t between two floats", make_between, 0.0, 0.0},
        {"from the surface", make_on_surface, 0.4, 0.1},
    };
    struct truth truth;
    truth_init(&truth);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        struct tally tally = {0};
        random_state = 11 + k;
        for (int i = 0; i < SUBJECTS; ++i) {
            struct subject s = kinds[k].make();
            if (s.radius == 0.0f || (s.dir.x == 0.0f && s.dir.y == 0.0f && s.dir.z == 0.0f))
                continue;
            find_truth(&s, &truth);
            set_t_min(&s);
            check_meeting(&s, &truth, &tally);
            check_bounds(&s, &truth, &tally);
        }
        print_message("%-26s %u of %u wrong, %u met, %u at the far end; pairs: %u sure, of which "
                      "%u wrong; filter: %u inside, %u outside, %u bad bounds, error of the room "
                      "at most %.3f of its bound\n",
                      kinds[k].name, tally.wrong, tally.rays, tally.met, tally.exits, tally.sure,
                      tally.wrong_pairs, tally.inside, tally.outside, tally.bad_bounds,
                      tally.worst);
        assert_int_equal(tally.wrong, 0);
        assert_int_equal(tally.wrong_pairs, 0);
        assert_int_equal(tally.bad_bounds, 0);
        assert_true(tally.met > SUBJECTS / 10 && tally.exits > SUBJECTS / 20);
        assert_true(tally.inside + tally.outside >= kinds[k].filtered * SUBJECTS);
        assert_true(tally.sure >= kinds[k].sure * tally.rays);
    }
    truth_clear(&truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(spheres_are_met_as_fractions_say)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
