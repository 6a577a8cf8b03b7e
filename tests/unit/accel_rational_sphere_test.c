/* The rational oracle's spheres: ray by ray what plain fractions say, and answers that are known
   without any: along axes, at tangents, at middles of floats, at the ends of what floats hold. */
#include "accel_fixture.h"

#include "coordinate_fixture.h"
#include "fraction_fixture.h"
#include "oracle/rational.h"

struct subject {
    struct vec3 origin, dir, center;
    float radius;
};

static bool meet(struct rational *rational, const struct subject *s, struct rational_chord *chord)
{
    *chord = (struct rational_chord){.near_key = NAN, .far_key = NAN};
    return rational_meet_sphere(rational, s->origin, s->dir, s->center, s->radius, chord);
}

/* ---- Fractions, as the definition in rational.h is written ---- */

struct equation {
    mpq_t p, s, q, disc;
};

static void set_equation(const struct subject *s, struct equation *out)
{
    mpq_t part[3][3]; /* origin, direction, centre */
    for (int i = 0; i < 9; ++i)
        mpq_init(part[i / 3][i % 3]);
    set_vector(part[0], s->origin);
    set_vector(part[1], s->dir);
    set_vector(part[2], s->center);
    mpq_t product;
    mpq_init(product);
    mpq_inits(out->p, out->s, out->q, out->disc, NULL);
    mpq_set_d(product, (double)s->radius);
    mpq_mul(product, product, product);
    mpq_neg(out->q, product);
    for (int k = 0; k < 3; ++k) {
        mpq_sub(part[2][k], part[2][k], part[0][k]);
        mpq_mul(product, part[1][k], part[1][k]);
        mpq_add(out->p, out->p, product);
        mpq_mul(product, part[2][k], part[1][k]);
        mpq_add(out->s, out->s, product);
        mpq_mul(product, part[2][k], part[2][k]);
        mpq_add(out->q, out->q, product);
    }
    set_product(out->disc, out->s, out->s, out->p, out->q);
    mpq_clear(product);
    for (int i = 0; i < 9; ++i)
        mpq_clear(part[i / 3][i % 3]);
}

static void clear_equation(struct equation *e)
{
    mpq_clears(e->p, e->s, e->q, e->disc, NULL);
}

/* Sign of (S + sqrt(disc)) / P - t, or with a minus: of the root less P t - S. */
static int compare_end(const struct equation *e, bool far, double t)
{
    mpq_t side, square;
    mpq_inits(side, square, NULL);
    mpq_set_d(side, t);
    mpq_mul(side, side, e->p);
    mpq_sub(side, side, e->s);
    if (!far)
        mpq_neg(side, side);
    mpq_mul(square, side, side);
    /* sqrt(disc) beside `side`, which is turned for the near end. */
    int order = mpq_sgn(side) < 0 ? 1 : mpq_cmp(e->disc, square);
    mpq_clears(side, square, NULL);
    return far ? order : -order;
}

/* Neighbours of a float that is not negative; of the largest: where floats would go on. */
static double float_beside(float key, bool above)
{
    float next = nextafterf(key, above ? INFINITY : -INFINITY);
    return isinf(next) ? 0x1p128 : (double)next;
}

static bool is_key(const struct equation *e, bool far, float key)
{
    uint32_t bits;
    memcpy(&bits, &key, sizeof bits);
    if (!isfinite(key) || signbit(key))
        return false;
    int lower = compare_end(e, far, 0.5 * ((double)key + float_beside(key, false)));
    int upper = compare_end(e, far, 0.5 * ((double)key + float_beside(key, true)));
    return lower >= 0 && upper <= 0 && ((lower > 0 && upper < 0) || bits % 2 == 0);
}

static bool is_end_there(const struct equation *e, bool far)
{
    return mpq_sgn(e->disc) >= 0 && compare_end(e, far, 0.0) >= 0 &&
           compare_end(e, far, 0x1.ffffffp127) < 0;
}

struct tally {
    uint32_t cases, near, far, touching, on_surface, equal_keys, wrong;
};

static void compare_chord(struct rational *rational, const struct subject *s, struct tally *tally)
{
    struct equation e;
    struct rational_chord chord;
    set_equation(s, &e);
    bool met = meet(rational, s, &chord);
    bool near = is_end_there(&e, false), far = is_end_there(&e, true);
    bool right = met == (near || far);
    if (met)
        right &= chord.near_there == near && chord.far_there == far &&
                 chord.inward == (mpq_sgn(e.s) > 0) &&
                 (!near || is_key(&e, false, chord.near_key)) &&
                 (!far || is_key(&e, true, chord.far_key));
    ++tally->cases;
    tally->near += near;
    tally->far += far;
    tally->touching += met && mpq_sgn(e.disc) == 0;
    tally->on_surface += met && mpq_sgn(e.q) == 0;
    tally->equal_keys += near && far && chord.near_key == chord.far_key;
    tally->wrong += !right;
    clear_equation(&e);
}

/* ---- Cases ---- */

static bool is_null(struct vec3 v)
{
    return v.x == 0.0f && v.y == 0.0f && v.z == 0.0f;
}

static struct subject scattered(float (*coordinate)(void))
{
    struct subject s = {.origin = point_of(coordinate), .center = point_of(coordinate)};
    do
        s.dir = point_of(coordinate);
    while (is_null(s.dir));
    do
        s.radius = fabsf(coordinate());
    while (s.radius == 0.0f);
    return s;
}

/* At a point of the sphere, from anywhere. */
static struct subject case_aimed(void)
{
    struct subject s = scattered(random_below(&random_state, 2) ? in_cube : of_any_size);
    struct vec3 out = point_of(in_cube);
    float length = sqrtf(vec3_dot(out, out));
    if (length > 0.0f)
        s.dir = vec3_sub(vec3_add(s.center, vec3_scale(out, s.radius / length)), s.origin);
    if (is_null(s.dir))
        s.dir.x = 1.0f;
    return s;
}

/* Past it, at the radius give or take some roundings. */
static struct subject case_grazing(void)
{
    struct subject s = scattered(in_cube);
    struct vec3 m = vec3_sub(s.center, s.origin), side = vec3_cross(m, s.dir);
    float length = sqrtf(vec3_dot(side, side));
    float reach = s.radius * (1.0f + 0x1p-22f * in_cube());
    if (length > 0.0f)
        s.dir = vec3_add(m, vec3_scale(side, reach / length));
    return s;
}

static struct subject case_inside(void)
{
    struct subject s = scattered(in_cube);
    s.radius = 0.1f + 10.0f * s.radius;
    s.origin = vec3_add(s.center, vec3_scale(point_of(in_cube), 0.57f * s.radius));
    return s;
}

/* Small and far away, as the float's ray is: keys of both ends are next to each other, or one. */
static struct subject case_small(void)
{
    struct subject s = scattered(in_cube);
    s.radius = ldexpf(s.radius, -15 - (int)random_below(&random_state, 12));
    float reach = s.radius * in_cube();
    s.dir = vec3_add(vec3_sub(s.center, s.origin), vec3_make(reach, 0, 0));
    return s;
}

struct kind {
    const char *name;
    float (*coordinate)(void); /* of scattered ones */
    struct subject (*make)(void);
    uint32_t touching, on_surface, equal_keys; /* at least, of CASES */
};

enum { CASES = 10000 };

static const struct kind kinds[] = {
    {"cube", in_cube, NULL, 0, 0, 0},
    {"10^-8 to 10^8", of_any_size, NULL, 0, 0, 0},
    {"2^-100 to 2^100", of_extreme_size, NULL, 0, 0, 0},
    {"grid", of_grid, NULL, 50, 100, 50},
    {"denormals", denormal, NULL, 1, 1, 1},
    {"any bits", of_any_bits, NULL, 0, 0, 0},
    {"aimed", NULL, case_aimed, 0, 0, 0},
    {"grazing", NULL, case_grazing, 0, 0, 0},
    {"from inside", NULL, case_inside, 0, 0, 0},
    {"small", NULL, case_small, 0, 0, 100},
};

static struct subject make_case(const struct kind *kind)
{
    return kind->coordinate ? scattered(kind->coordinate) : kind->make();
}

static void spheres_are_met_as_fractions_say(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
    uint32_t wrong = 0;
    assert_non_null(rational);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
        struct tally tally = {0};
        random_state = 300 + i;
        for (int k = 0; k < CASES; ++k) {
            struct subject s = make_case(&kinds[i]);
            compare_chord(rational, &s, &tally);
        }
        print_message("%-16s %u wrong of %u: near end %u, far end %u, touched %u, begins on it %u, "
                      "equal keys %u\n",
                      kinds[i].name, tally.wrong, tally.cases, tally.near, tally.far,
                      tally.touching, tally.on_surface, tally.equal_keys);
        assert_true(tally.far > CASES / 20 && tally.far < CASES + (tally.near == 0));
        assert_true(tally.near > 0 || kinds[i].make == case_inside);
        assert_true(tally.touching >= kinds[i].touching &&
                    tally.on_surface >= kinds[i].on_surface &&
                    tally.equal_keys >= kinds[i].equal_keys);
        wrong += tally.wrong;
    }
    rational_destroy(rational);
    assert_int_equal(wrong, 0);
}

/* ---- Answers known beforehand ---- */

/* Along z, a sphere at height `z`, `aside` of it. */
static struct subject upright(float z, float radius, float aside, float origin, float dir)
{
    return (struct subject){vec3_make(aside, 0, origin), vec3_make(0, 0, dir), vec3_make(0, 0, z),
                            radius};
}

struct known {
    struct subject subject;
    bool near_there, far_there, inward;
    float near, far;
};

static void rays_along_axes_meet_both_ends(void **state)
{
    (void)state;
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
    struct rational *rational = rational_create(NULL);
    struct rational_chord chord;
    assert_non_null(rational);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
        const struct known *k = &cases[i];
        bool met = meet(rational, &k->subject, &chord);
        assert_int_equal(met, k->near_there || k->far_there);
        if (!met)
            continue;
        assert_true(chord.near_there == k->near_there && chord.far_there == k->far_there);
        assert_true(chord.inward == k->inward);
        assert_true(!k->near_there || (chord.near_key == k->near && !signbit(chord.near_key)));
        assert_true(!k->far_there || (chord.far_key == k->far && !signbit(chord.far_key)));
    }
    print_message("%zu rays along axes\n", sizeof cases / sizeof *cases);
    rational_destroy(rational);
}

/* Four whole numbers a^2 + b^2 + c^2 = r^2, turned about: a normal n of whole length; a direction
   across it, all in whole numbers times a power of two. */
static struct subject touching(int *turns)
{
    static const int sides[][4] = {{1, 2, 2, 3},  {2, 3, 6, 7},  {1, 4, 8, 9},   {4, 4, 7, 9},
                                   {2, 6, 9, 11}, {6, 6, 7, 11}, {3, 4, 12, 13}, {2, 10, 11, 15}};
    const int *side = sides[random_below(&random_state, 8)];
    uint32_t turn = random_bits(&random_state);
    float n[3];
    for (uint32_t k = 0; k < 3; ++k)
        n[(turn + (turn & 8 ? k : 3 - k)) % 3] = (float)side[k] * (turn & 16u << k ? 1.0f : -1.0f);
    struct vec3 normal = vec3_load(n), dir;
    do
        dir = vec3_cross(normal, point_of(of_grid));
    while (is_null(dir));
    *turns = (int)random_below(&random_state, 1000);
    int scale = (int)random_below(&random_state, 160) - 80;
    struct subject s = {.center = vec3_scale(point_of(of_grid), 100.0f), .radius = (float)side[3]};
    s.origin = vec3_sub(vec3_add(s.center, normal), vec3_scale(dir, (float)*turns));
    s.dir = vec3_scale(dir, 3.0f); /* t = turns / 3 */
    s.origin = vec3_scale(s.origin, ldexpf(1.0f, scale));
    s.center = vec3_scale(s.center, ldexpf(1.0f, scale));
    s.dir = vec3_scale(s.dir, ldexpf(1.0f, scale));
    s.radius = ldexpf(s.radius, scale);
    return s;
}

static void tangents_touch_in_one_point(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    random_state = 11;
    uint32_t wrong = 0, missed = 0, apart = 0;
    for (int i = 0; i < CASES; ++i) {
        int turns;
        struct rational_chord chord;
        struct subject s = touching(&turns);
        /* No multiple of a third is nearer to a middle of floats than doubles are to each other. */
        float key = (float)(turns / 3.0), radius = s.radius;
        wrong += !meet(rational, &s, &chord) || !chord.near_there || !chord.far_there ||
                 chord.near_key != key || chord.far_key != key;
        s.radius = nextafterf(radius, 0.0f);
        missed += !meet(rational, &s, &chord);
        s.radius = nextafterf(radius, INFINITY);
        bool met = meet(rational, &s, &chord);
        wrong += !met || chord.near_there != (turns > 0) || !chord.far_there ||
                 (turns > 0 && chord.near_key > key) || chord.far_key < key;
        /* By some 1e-5, which is mostly more than floats are apart. */
        apart += turns > 0 && met && chord.near_key < key && chord.far_key > key;
    }
    print_message("%u wrong of %u tangents; a float less of radius: %u missed; a float more: %u "
                  "ends apart\n",
                  wrong, CASES, missed, apart);
    assert_int_equal(wrong, 0);
    assert_int_equal(missed, CASES);
    assert_true(apart > CASES / 10 * 9);
    rational_destroy(rational);
}

/* ---- Keys that are hard to round ---- */

/* Ends at z -+ half; between 2^25 and 2^26 floats are 4 apart, and half is 2 more than a multiple
   of that, or less than that by anything. */
static void ties_round_to_even(void **state)
{
    (void)state;
    static const struct {
        float radius, aside, origin;
        int half;  /* rounded up */
        bool less; /* half of the chord is less, by 2^-302 to 2^-19 */
    } shapes[] = {{6, 0, 0, 6, false},
                  {10, 8, 0, 6, false},
                  {26, 24, 0, 10, false},
                  {6, 0x1p-149f, 0, 6, true},
                  {2, 0x1p-140f, 0, 2, true},
                  {10, 0x1.000002p3f, 0, 6, true},
                  {0x1.7ffffep2f, 0, 0, 6, true},
                  {5, 5, -2, 0, false}}; /* touched in a middle */
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    random_state = 7;
    uint32_t wrong = 0;
    for (int i = 0; i < 2 * CASES; ++i) {
        float z = 0x1p25f + 64.0f + 4.0f * (float)random_below(&random_state, 1u << 22);
        int scale = (int)random_below(&random_state, 40) - 20, shape = i % 8,
            half = shapes[shape].half;
        struct rational_chord chord;
        struct subject s = upright(z, shapes[shape].radius, shapes[shape].aside,
                                   shapes[shape].origin, ldexpf(1.0f, scale));
        /* Ends lie between these floats, in the middle of them or further in. */
        double t = (double)z - (double)shapes[shape].origin;
        double below = t - half - 2.0, above = t + half - 2.0;
        double near = shapes[shape].less || fmod(below, 8.0) != 0.0 ? below + 4.0 : below;
        double far = shapes[shape].less || fmod(above, 8.0) == 0.0 ? above : above + 4.0;
        wrong += !meet(rational, &s, &chord) || (double)chord.near_key != ldexp(near, -scale) ||
                 (double)chord.far_key != ldexp(far, -scale);
    }
    print_message("%u wrong of %u keys at and beside middles of floats\n", wrong, 2 * CASES);
    assert_int_equal(wrong, 0);
    rational_destroy(rational);
}

/* Away from the centre: the far end at radius - 2, a middle of floats, or 2^-324 before it. */
static void ties_from_inside_round_to_even(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    uint32_t wrong = 0;
    random_state = 8;
    for (int i = 0; i < CASES; ++i) {
        float radius = 0x1.8p25f + 4.0f * (float)random_below(&random_state, 1u << 20);
        struct rational_chord chord;
        struct subject s = upright(-2, radius, i % 2 ? 0x1p-149f : 0.0f, 0, 1);
        bool up = i % 2 == 0 && fmod((double)radius, 8.0) == 0.0;
        wrong += !meet(rational, &s, &chord) || chord.near_there || chord.inward ||
                 chord.far_key != (up ? radius : radius - 4.0f);
    }
    print_message("%u wrong of %u keys from inside\n", wrong, CASES);
    assert_int_equal(wrong, 0);
    rational_destroy(rational);
}

/* Ends at i 2^-150 and 2048 more of these. */
static void denormal_ties_round_to_even(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    uint32_t wrong = 0;
    for (int i = 0; i < CASES; ++i) {
        struct rational_chord chord;
        struct subject s = upright(ldexpf((float)(i + 1024), -100), 0x1p-90f, 0.0f, 0.0f, 0x1p50f);
        int even = i / 2 + (i % 4 == 3);
        wrong += !meet(rational, &s, &chord) || chord.near_key != ldexpf((float)even, -149) ||
                 chord.far_key != ldexpf((float)(even + 1024), -149);
    }
    print_message("%u wrong of %u keys at and between denormals\n", wrong, CASES);
    assert_int_equal(wrong, 0);
    rational_destroy(rational);
}

static void keys_end_with_the_floats(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
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
    rational_destroy(rational);
}

/* ---- Beside doubles ---- */

/* Where ends are well apart: by the foot of the centre on the line, in double. With M = |m| + r its
   terms are off by some 20 u M^2 of room and 20 u M of the foot's way, which the root of room makes
   20 u M^2 / chord. */
static void keys_are_what_doubles_say_nearly(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    random_state = 13;
    uint32_t wrong = 0, met = 0, ends = 0;
    for (int i = 0; i < 5 * CASES; ++i) {
        struct subject s = i % 2 ? case_aimed() : scattered(in_cube);
        struct rational_chord chord;
        const float *from[3] = {&s.origin.x, &s.dir.x, &s.center.x};
        double p = 0.0, along = 0.0, size = 0.0, off = 0.0, r = (double)s.radius;
        for (int k = 0; k < 3; ++k) {
            double d = (double)from[1][k], m = (double)from[2][k] - (double)from[0][k];
            p += d * d;
            along += m * d;
            size += m * m;
        }
        for (int k = 0; k < 3; ++k) {
            double across =
                (double)from[2][k] - (double)from[0][k] - along / p * (double)from[1][k];
            off += across * across;
        }
        double room = r * r - off, reach = sqrt(size) + r;
        if (fabs(room) < 0x1p-46 * reach * reach) /* too near to call */
            continue;
        bool line = meet(rational, &s, &chord);
        double half = sqrt(fmax(room, 0.0) / p), error = 0x1p-47 * reach * reach / (half * p);
        for (int far = 0; far < 2 && room > 0.0; ++far) {
            double t = along / p + (far ? half : -half);
            bool there = line && (far ? chord.far_there : chord.near_there);
            double key = (double)(far ? chord.far_key : chord.near_key);
            if (fabs(t) <= error)
                continue;
            ++ends;
            wrong += there != (t > 0.0) || (there && !(fabs(key - t) <= error + 0x1p-23 * t));
        }
        wrong += line && room < 0.0;
        met += line;
    }
    print_message("%u wrong beside doubles: %u of %u met, %u ends\n", wrong, met, 5 * CASES, ends);
    assert_true(met > 10000 && ends > 20000);
    assert_int_equal(wrong, 0);
    rational_destroy(rational);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spheres_are_met_as_fractions_say),
        cmocka_unit_test(rays_along_axes_meet_both_ends),
        cmocka_unit_test(tangents_touch_in_one_point),
        cmocka_unit_test(ties_round_to_even),
        cmocka_unit_test(ties_from_inside_round_to_even),
        cmocka_unit_test(denormal_ties_round_to_even),
        cmocka_unit_test(keys_end_with_the_floats),
        cmocka_unit_test(keys_are_what_doubles_say_nearly),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
