/* Compares spheres with fractions: the ends of the chord that the rational oracle and numerics
   `exact` find, the floats between which t lies, and the decisions of the filter. */
#include "hard_sphere_fixture.h"

#include "fraction_fixture.h"
#include "twin/ff_sphere.h"
#include "unit.h"

/* ---- Fractions ---- */

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

/* Compares an end of the chord with t: 1 if it is beyond t, -1 before, 0 equal. */
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

/* Whether the key of an end of the chord (its t, rounded to float) is above `x`, which is not
   negative. */
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

/* Whether an end of the chord counts as a hit: it exists, and its key is not below t_min. */
static bool counts(const struct truth *truth, float t_min, bool far)
{
    return truth->met && is_ahead(truth, far) && !is_above(truth, FLT_MAX, far) &&
           (t_min == 0.0f || is_above(truth, nextafterf(t_min, 0.0f), far));
}

/* ---- Comparisons ---- */

struct tally {
    uint32_t rays, met, exits, wrong, sure, wrong_pairs, inside, outside, bad_bounds;
    uint32_t touching, on_surface, equal_keys, wrong_chords; /* by the rational oracle */
    double worst;                                            /* largest error of room / its bound */
};

static bool is_right(const struct truth *truth, const struct sphere_candidate *m, bool near,
                     bool far)
{
    return m->met == (near || far) &&
           (!m->met || (m->at_exit == far && m->inward == (mpq_sgn(truth->s) > 0) &&
                        is_key(truth, m->key, far)));
}

static bool meet(struct rational *rational, const struct subject *s, struct rational_chord *chord)
{
    *chord = (struct rational_chord){.near_key = NAN, .far_key = NAN};
    return rational_meet_sphere(rational, s->origin, s->dir, s->center, s->radius, chord);
}

static void check_chord(struct rational *rational, const struct subject *s,
                        const struct truth *truth, struct tally *tally)
{
    struct rational_chord chord;
    bool met = meet(rational, s, &chord);
    bool near = counts(truth, 0.0f, false), far = counts(truth, 0.0f, true);
    bool right = met == (near || far);
    if (met)
        right &= chord.near_there == near && chord.far_there == far &&
                 chord.inward == (mpq_sgn(truth->s) > 0) &&
                 (!near || is_key(truth, chord.near_key, false)) &&
                 (!far || is_key(truth, chord.far_key, true));
    tally->touching += met && mpq_sgn(truth->room) == 0;
    tally->on_surface += met && mpq_sgn(truth->q) == 0;
    tally->equal_keys += near && far && chord.near_key == chord.far_key;
    tally->wrong_chords += !right;
}

static void check_candidate(const struct subject *s, const struct truth *truth, struct tally *tally)
{
    for (int only_far = 0; only_far < 2; ++only_far) {
        struct sphere_candidate m, of_pairs;
        exact_meet_sphere(s->origin, s->dir, s->center, s->radius, only_far, s->t_min, &m);
        bool sure =
            ff_meet_sphere(s->origin, s->dir, s->center, s->radius, only_far, s->t_min, &of_pairs);
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
        return true; /* keys below 0 are not judged */
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

TEST(spheres_are_met_as_fractions_say)
{
    enum { SUBJECTS = 10000 };
    own_rational *rational = rational_create(NULL);
    struct truth truth;
    uint32_t touching = 0, on_surface = 0, equal_keys = 0;
    assert_non_null(rational);
    truth_init(&truth);
    for (uint32_t k = 0; k < SPHERE_KINDS; ++k) {
        struct tally tally = {0};
        random_state = 11 + k;
        for (int i = 0; i < SUBJECTS; ++i) {
            struct subject s = make_subject(k);
            find_truth(&s, &truth);
            check_chord(rational, &s, &truth, &tally);
            check_candidate(&s, &truth, &tally);
            check_bounds(&s, &truth, &tally);
        }
        print_message(
            "%-30s chords: %u wrong, %u touch, %u rays begin on it, %u equal keys; "
            "candidates: %u of %u wrong, %u met, %u at the far end; pairs: %u sure, of which "
            "%u wrong; filter: %u inside, %u outside, %u bad bounds, error of the room "
            "at most %.3f of its bound\n",
            sphere_kinds[k].name, tally.wrong_chords, tally.touching, tally.on_surface,
            tally.equal_keys, tally.wrong, tally.rays, tally.met, tally.exits, tally.sure,
            tally.wrong_pairs, tally.inside, tally.outside, tally.bad_bounds, tally.worst);
        assert_int_equal(tally.wrong_chords, 0);
        assert_int_equal(tally.wrong, 0);
        assert_int_equal(tally.wrong_pairs, 0);
        assert_int_equal(tally.bad_bounds, 0);
        assert_true(tally.met > SUBJECTS / 10 && tally.exits > SUBJECTS / 20);
        touching += tally.touching;
        on_surface += tally.on_surface;
        equal_keys += tally.equal_keys;
        assert_true(tally.inside + tally.outside >= sphere_kinds[k].filtered * SUBJECTS);
        assert_true(tally.sure >= sphere_kinds[k].sure * tally.rays);
    }
    assert_true(touching > SUBJECTS * 9 / 10 && on_surface > SUBJECTS / 2 &&
                equal_keys > SUBJECTS / 2);
    truth_clear(&truth);
}

/* ---- Known answers ---- */

struct known {
    struct subject subject;
    bool near_there, far_there, inward;
    float near, far;
};

TEST(rays_along_axes_meet_both_ends)
{
    const struct known cases[] = {
        {upright(10, 2, 0, 0, 1), true, true, true, 8, 12},
        {upright(10, 2, 0, 0, -1), false, false, false, 0, 0}, /* away */
        {upright(10, 2, 0, 11, 4), false, true, false, 0, 0.25f},
        {upright(10, 2, 0, 9, 4), false, true, true, 0, 0.75f},
        {upright(10, 2, 0, 10, 0.5f), false, true, false, 0, 4}, /* from the centre */
        {upright(10, 5, 3, 0, 1), true, true, true, 6, 14},
        {upright(10, 5, 5, 0, 1), true, true, true, 10, 10},              /* touched */
        {upright(10, 5, 0x1.400002p2f, 0, 1), false, false, false, 0, 0}, /* just not */
        {upright(10, 2, 0, 8, 1), true, true, true, 0, 4},                /* on it, inwards */
        {upright(10, 2, 0, 8, -1), false, true, false, 0, 0},             /* on it, outwards */
        {upright(10, 2, 0, 12, -2), true, true, true, 0, 2},              /* on the other side */
        {upright(10, 2, 2, 10, 1), true, true, false, 0, 0},              /* on it, along it */
        {upright(0x1p100f, 0x1p99f, 0, 0, 0x1p10f), true, true, true, 0x1p89f, 0x1.8p90f},
        {upright(3 * 0x1p-149f, 0x1p-149f, 0, 0, 0x1p-149f), true, true, true, 2, 4},
        {upright(0x1p-149f, 0x1p-149f, 0, 0, 1), true, true, true, 0, 0x1p-148f},
    };
    own_rational *rational = rational_create(NULL);
    struct rational_chord chord;
    assert_non_null(rational);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const struct known *k = &cases[i];
        bool met = meet(rational, &k->subject, &chord),
             right = met == (k->near_there || k->far_there);
        if (met)
            right &= chord.near_there == k->near_there && chord.far_there == k->far_there &&
                     chord.inward == k->inward &&
                     (!k->near_there || (chord.near_key == k->near && !signbit(chord.near_key))) &&
                     (!k->far_there || (chord.far_key == k->far && !signbit(chord.far_key)));
        if (!right)
            fail_msg("row %zu of cases", i);
    }
}

TEST(keys_end_with_the_floats)
{
    own_rational *rational = rational_create(NULL);
    struct rational_chord chord;
    assert_non_null(rational);
    struct subject s = upright(FLT_MAX, 0x1p104f, 0, 0, 1);
    assert_true(meet(rational, &s, &chord) && chord.near_there && !chord.far_there);
    assert_true(chord.near_key == 0x1.fffffcp127f);
    s.radius = 0x1p103f; /* ends in the middle of floats, the far one of FLT_MAX and what follows */
    assert_true(meet(rational, &s, &chord) && chord.near_there && !chord.far_there);
    assert_true(chord.near_key == 0x1.fffffcp127f);
    s.radius = 0x1.fffffep102f;
    assert_true(meet(rational, &s, &chord) && chord.near_there && chord.far_there);
    assert_true(chord.near_key == FLT_MAX && chord.far_key == FLT_MAX);
    s.dir.z = 0.5f;
    assert_false(meet(rational, &s, &chord));
    s = upright(0x1p-100f, 0x1p-101f, 0, 0, 0x1p60f); /* 2^-161 and 3 times as much */
    assert_true(meet(rational, &s, &chord) && chord.near_there && chord.far_there);
    assert_true(chord.near_key == 0.0f && chord.far_key == 0.0f);
    s = upright(FLT_MAX, FLT_MAX, FLT_MAX, 0, 0x1p-149f); /* touched at 2^277 */
    assert_false(meet(rational, &s, &chord));
    s = upright(FLT_MAX, FLT_MAX, 0x1p-149f, -FLT_MAX, FLT_MAX);
    assert_true(meet(rational, &s, &chord) && chord.near_key == 1.0f && chord.far_key == 3.0f);
}
