/* Hard triangles: compares the rational oracle, float-floats and all levels with fractions. */
#include "hard_triangle_fixture.h"

#include "fraction_fixture.h"
#include "hard/judge.h"
#include "oracle/oracle.h"
#include "twin/ff_triangle.h"
#include "unit.h"

/* ---- Fractions, as the definition in rational.h is written ---- */

struct fraction_candidate {
    mpq_t t;
    bool met;
    uint32_t edges;
};

static void meet_in_fractions(struct vec3 origin, struct vec3 dir, const struct vec3 v[3],
                              struct fraction_candidate *out)
{
    mpq_t number[6][3], *o = number[0], *d = number[1], *edge = number[5], det;
    mpq_init(det);
    for (int i = 0; i < 18; ++i)
        mpq_init(number[i / 3][i % 3]);
    set_vector(o, origin);
    set_vector(d, dir);
    for (int i = 0; i < 3; ++i) {
        set_vector(number[2 + i], v[i]);
        for (int k = 0; k < 3; ++k)
            mpq_sub(number[2 + i][k], number[2 + i][k], o[k]);
    }
    bool below = false, above = false;
    out->edges = 0;
    for (int i = 0; i < 3; ++i) {
        set_triple(edge[i], d, number[2 + (i + 1) % 3], number[2 + (i + 2) % 3]);
        mpq_add(det, det, edge[i]);
        below |= mpq_sgn(edge[i]) < 0;
        above |= mpq_sgn(edge[i]) > 0;
        out->edges += mpq_sgn(edge[i]) == 0;
    }
    out->met = !(below && above) && mpq_sgn(det) != 0;
    if (out->met) {
        set_triple(out->t, number[2], number[3], number[4]);
        mpq_div(out->t, out->t, det);
    }
    for (int i = 0; i < 18; ++i)
        mpq_clear(number[i / 3][i % 3]);
    mpq_clear(det);
}

/* The next float in direction `way`; beyond the largest one 2^128, where floats would continue. */
static double float_after(float key, double way)
{
    float next = nextafterf(key, (float)(way * (double)INFINITY));
    return isinf(next) ? way * 0x1p128 : (double)next;
}

/* Whether the key is t rounded to the nearest float, ties to even. */
static bool is_rounded(float key, const mpq_t t)
{
    uint32_t bits;
    memcpy(&bits, &key, sizeof bits);
    mpq_t middle;
    mpq_init(middle);
    /* The middle of two floats has one bit more than a float, so it is a double. */
    mpq_set_d(middle, 0.5 * ((double)key + float_after(key, -1.0)));
    int lower = mpq_cmp(t, middle);
    mpq_set_d(middle, 0.5 * ((double)key + float_after(key, 1.0)));
    int upper = mpq_cmp(t, middle);
    mpq_clear(middle);
    return lower >= 0 && upper <= 0 && ((lower > 0 && upper < 0) || bits % 2 == 0);
}

/* Whether t rounded to float would be infinite. */
static bool is_beyond_floats(const mpq_t t)
{
    return mpq_sgn(t) != 0 &&
           (mpz_sizeinbase(mpq_numref(t), 2) + 1 > mpz_sizeinbase(mpq_denref(t), 2) + 127) &&
           (mpq_get_d(t) >= 0x1.ffffffp127 || mpq_get_d(t) <= -0x1.ffffffp127);
}

/* ---- Comparisons ---- */

/* Whether a hit is valid at any level: finite t, barycentric coordinates in range. */
static bool is_sound(const struct gpu_hit *hit)
{
    return isfinite(hit->t) && hit->u >= 0.0f && hit->v >= 0.0f &&
           hit->u + hit->v <= 1.0f + 4.0f * FLT_EPSILON;
}

struct tally {
    uint32_t rays, met, on_edge, on_vertex, wrong; /* wrong: the rational oracle */
    uint32_t sure, wrong_pairs;                    /* float-floats */
    struct {
        uint32_t met, missed, invented, unsound;
        uint32_t undoubted, far_off; /* wrong answers, and wrong t, beyond the bound of floats */
        uint32_t over_4_ulp;
        double worst_ulp;
    } of[LEVELS];
};

/* Tests the triangle in double (oracle.c), with the error bound of the float test. */
static void ask_oracle(const struct gpu_ray *ray, const struct vec3 v[3], struct oracle_hit *oracle)
{
    struct gpu_triangle record = {0};
    struct gpu_instance instance = {0};
    struct accel_mesh mesh = {.record_count = 1, .triangle_count = 1};
    struct accel accel = {.triangles = &record, .instances = &instance, .meshes = &mesh};
    accel.record_count = accel.triangle_count = accel.instance_count = accel.mesh_count = 1;
    accel.single_identity = true;
    vec3_store(record.v0, v[0]);
    vec3_store(record.v1, v[1]);
    vec3_store(record.v2, v[2]);
    oracle_trace(&accel, ray, true, oracle);
}

/* Whether floats may give another answer within the error bound. */
static bool is_in_doubt(const struct gpu_ray *ray, const struct vec3 v[3])
{
    struct oracle_hit oracle;
    ask_oracle(ray, v, &oracle);
    return fabs(oracle.edge_margin) < 1.0;
}

struct truth {
    bool met; /* the ray hits at t >= 0 */
    float key;
};

/* Judges a level: where it is not exact, a wrong answer must be within the error bound. */
static void judge_level(int l, const struct gpu_ray *ray, const struct vec3 v[3],
                        const struct truth *truth, struct tally *tally)
{
    struct gpu_hit hit = {0};
    struct oracle_hit oracle;
    bool met = level_meets(&levels[l], ray, v, &hit);
    tally->of[l].met += met;
    tally->of[l].missed += truth->met && !met;
    tally->of[l].invented += met && !truth->met;
    tally->of[l].unsound += met && !is_sound(&hit);
    if (met && truth->met) {
        double off = hard_ulps_between(hit.t, truth->key);
        tally->of[l].worst_ulp = fmax(tally->of[l].worst_ulp, off);
        tally->of[l].over_4_ulp += off > 4.0;
    }
    if (levels[l].exact) {
        tally->of[l].undoubted += met != truth->met;
        tally->of[l].far_off += met && hit.t != truth->key;
    } else if (met || truth->met) {
        ask_oracle(ray, v, &oracle);
        if (met != truth->met)
            tally->of[l].undoubted += !(fabs(oracle.edge_margin) < 1.0);
        else if (oracle.primitive != HIT_NONE)
            tally->of[l].far_off += !(fabs((double)hit.t - oracle.t) <= oracle.t_error);
    }
}

static void compare(struct rational *rational, const struct subject *s, bool floats,
                    struct tally *tally)
{
    struct fraction_candidate wanted;
    struct exact_candidate pairs;
    uint32_t edges = 3;
    bool key_known;
    float key = NAN;
    mpq_init(wanted.t);
    meet_in_fractions(s->origin, s->dir, s->v, &wanted);
    wanted.met &= !(wanted.met && is_beyond_floats(wanted.t));
    bool met = rational_meet(rational, s->origin, s->dir, s->v, &key, &edges);
    tally->wrong +=
        met != wanted.met || (met && (edges != wanted.edges || !is_rounded(key, wanted.t)));
    const struct truth truth = {met && mpq_sgn(wanted.t) >= 0, key};
    mpq_clear(wanted.t);
    ++tally->rays;
    tally->met += met;
    tally->on_edge += met && edges == 1;
    tally->on_vertex += met && edges == 2;
    bool sure = ff_meet(s->origin, s->dir, s->v[0], s->v[1], s->v[2], &pairs, &key_known);
    tally->sure += sure;
    tally->wrong_pairs += sure && pairs.met != truth.met;
    tally->wrong_pairs += truth.met && (sure || key_known) && pairs.key != key;
    struct gpu_ray ray = ray_along(s->origin, s->dir);
    for (int l = 0; l < LEVELS; ++l)
        if (floats || levels[l].exact)
            judge_level(l, &ray, s->v, &truth, tally);
}

static void tell(const char *name, const struct tally *tally)
{
    print_message("%-30s %u of %u met, %u on an edge, %u at a vertex: %u wrong; pairs: %u sure, %u "
                  "wrong\n",
                  name, tally->met, tally->rays, tally->on_edge, tally->on_vertex, tally->wrong,
                  tally->sure, tally->wrong_pairs);
    for (int l = 0; l < LEVELS; ++l)
        print_message("  %-10s %u missed, %u invented, %u of them not in doubt; %u unsound; t "
                      "within %.3g ulp, %u over 4, %u beyond their bound\n",
                      levels[l].name, tally->of[l].missed, tally->of[l].invented,
                      tally->of[l].undoubted, tally->of[l].unsound, tally->of[l].worst_ulp,
                      tally->of[l].over_4_ulp, tally->of[l].far_off);
}

/* T1 to T5, T12. For kinds marked PLAIN t is nearly always far within its bound: for
   well-conditioned ones 1 in 1,600 is off by more than 4 ulp, with any seed. */
TEST(triangles_are_met_as_fractions_say)
{
    const uint32_t cases = cases_of(80000);
    own_rational *rational = rational_create(NULL);
    assert_non_null(rational);
    for (size_t i = 0; i < sizeof triangle_kinds / sizeof *triangle_kinds; ++i) {
        const struct triangle_kind *kind = &triangle_kinds[i];
        struct tally tally = {0};
        random_state = 100 + i;
        for (uint32_t k = 0; k < cases; ++k) {
            struct subject s = kind->coordinate ? scattered(kind->coordinate) : kind->make();
            compare(rational, &s, kind->what & FLOATS, &tally);
        }
        tell(kind->name, &tally);
        assert_int_equal(tally.wrong + tally.wrong_pairs, 0);
        assert_true(kind->met_min > 0.0 ? tally.met > kind->met_min * cases : tally.met == 0);
        assert_true(!(kind->what & EDGES) || (tally.on_edge > 100 && tally.on_vertex > 0));
        assert_true(tally.sure >= kind->sure_min * cases && tally.sure <= kind->sure_max * cases);
        for (int l = 0; l < LEVELS; ++l) {
            assert_int_equal(tally.of[l].unsound + tally.of[l].undoubted + tally.of[l].far_off, 0);
            assert_true(!(kind->what & PLAIN) ||
                        tally.of[l].missed + tally.of[l].invented <= cases / 10000);
            assert_true(!(kind->what & GOOD) || tally.of[l].over_4_ulp <= tally.met / 500);
        }
    }
}

/* Finds the key of the hit with a large triangle across the ray; false: the ray misses it. */
static bool key_of(struct rational *rational, float z, float origin, float dir, float *key)
{
    struct subject s = wall(z, origin, dir);
    return rational_meet(rational, s.origin, s.dir, s.v, key, NULL);
}

TEST(keys_end_with_the_floats)
{
    own_rational *rational = rational_create(NULL);
    float key = 0.0f;
    assert_true(key_of(rational, FLT_MAX, -0x1.fffffep102f, 1.0f, &key));
    assert_true(key == FLT_MAX);
    assert_false(key_of(rational, FLT_MAX, -0x1p103f, 1.0f, &key));
    assert_false(key_of(rational, -FLT_MAX, 0x1p103f, 1.0f, &key));
    assert_true(key_of(rational, 1.0f, 1.0f, -1.0f, &key));
    assert_true(key == 0.0f && !signbit(key));
    assert_true(key_of(rational, -0x1p-100f, 0.0f, 0x1p100f, &key)); /* -2^-200 */
    assert_true(key == 0.0f && !signbit(key));
    assert_true(key_of(rational, 3.0f, 1.0f, -0.5f, &key)); /* behind */
    assert_true(key == -4.0f);
}

/* T6: hits at both ends of the interval count, for closest-hit and any-hit. The watertight test
   compares t_min with t before t is clamped to the triangle's box, so where t is clamped, t_min may
   be beyond it. */
TEST(ends_of_intervals_count)
{
    enum { RAYS = 5000 };
    own_world world = world_of_soup(soup_terrain(12), (whit_accel_params){0});
    const struct accel *accel = world.accel;
    for (int l = 0; l < LEVELS; ++l) {
        uint32_t wrong_end = 0, wrong_begin = 0, hits = 0;
        random_state = 6;
        for (uint32_t i = 0; i < RAYS; ++i) {
            struct gpu_ray ray = soup_ray(&world.soup, &accel->meshes[0].box, i), cut = ray;
            struct gpu_hit first = level_trace(&levels[l], accel, ORDER_DISTANCE, false, &ray);
            if (first.primitive == HIT_NONE)
                continue;
            ++hits;
            for (uint32_t any = 0; any < 2; ++any) {
                cut = ray;
                cut.t_max = first.t;
                struct gpu_hit again = level_trace(&levels[l], accel, ORDER_DISTANCE, any, &cut);
                wrong_end += again.primitive != first.primitive && !any;
                wrong_end += again.primitive == HIT_NONE;
                cut.t_max = nextafterf(first.t, -INFINITY);
                again = level_trace(&levels[l], accel, ORDER_DISTANCE, any, &cut);
                wrong_end += again.primitive != HIT_NONE;
                cut = ray;
                cut.t_min = first.t;
                again = level_trace(&levels[l], accel, ORDER_DISTANCE, any, &cut);
                wrong_begin += !any && again.primitive != first.primitive;
            }
        }
        print_message("%-10s T6 %u wrong at the end, %u at the beginning of %u hits' intervals\n",
                      levels[l].name, wrong_end, wrong_begin, hits);
        assert_int_equal(wrong_end, 0);
        assert_true(!levels[l].exact || wrong_begin == 0);
        assert_true(wrong_begin * 20 < hits);
        assert_true(hits > RAYS / 2);
    }
}

/* T7: scenes scaled by powers of two from 1e-15 (rays at edges, whose products are smaller: 1e-11)
   to 1e18 have bit for bit the hits of size 1, with directions scaled as well, or of length 1 as
   for cameras. `fast`, which multiplies three lengths: from 6e-8 to 7e10. */
TEST(size_does_not_matter)
{
    enum { RAYS = 40000 };
    for (int l = 0; l <= LEVELS; ++l) {
        const struct level *level = l < LEVELS ? &levels[l] : &fast_level;
        uint32_t differ = 0, met = 0;
        random_state = 7;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 scaled[3];
            struct gpu_hit hit = {0}, other = {0};
            bool at_edge = r % 2 == 0, unit = r % 4 < 2;
            int min = l == LEVELS ? -24 : at_edge ? -36 : -50, max = l == LEVELS ? 36 : 60;
            struct subject s = at_edge ? make_at_edge() : make_unit();
            float scale =
                ldexpf(1.0f, (int)random_below(&random_state, (uint32_t)(max + 1 - min)) + min);
            for (int k = 0; k < 3; ++k)
                scaled[k] = vec3_scale(s.v[k], scale);
            struct gpu_ray ray = ray_along(s.origin, s.dir);
            struct gpu_ray far =
                ray_along(vec3_scale(s.origin, scale), vec3_scale(s.dir, unit ? 1.0f : scale));
            bool here = level_meets(level, &ray, s.v, &hit);
            bool there = level_meets(level, &far, scaled, &other);
            hit.t *= unit ? scale : 1.0f;
            met += here;
            differ += here != there ||
                      (here && (hit.t != other.t || hit.u != other.u || hit.v != other.v));
        }
        print_message("%-10s T7 %u of %u differ by scale, %u met\n", level->name, differ, RAYS,
                      met);
        assert_true(met > RAYS / 4);
        assert_int_equal(differ, 0);
    }
}

/* T8: pbrt-v4, shapes_test.cpp, Triangle.BadCases; the triangle has no area, so it is in no scene.
   T9: github.com/Oblikovati/Oblikovati, issue 2146: a ray at the diagonal of a square. */
TEST(known_cases)
{
    const struct vec3 line[3] = {{-1113.45459f, -79.049614f, -56.2431908f},
                                 {-1113.45459f, -87.0922699f, -56.2431908f},
                                 {-1113.45459f, -79.2090149f, -56.2431908f}};
    const struct gpu_ray at_line = {{-1081.47925f, 99.9999542f, 87.7701111f},
                                    0.0f,
                                    {-32.1072998f, -183.355865f, -144.607635f},
                                    0.9999f};
    const struct vec3 square[2][3] = {{{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}},
                                      {{-5, -5, 0}, {5, 5, 0}, {-5, 5, 0}}};
    const struct gpu_ray at_square = {
        {0, 0, 10}, 0.0f, {0.30458447f, 0.30458447f, -0.9024725f}, INFINITY};
    struct soup soup = soup_make("line", 1);
    for (uint32_t i = 0; i < 3; ++i)
        vec3_store(&soup.positions[3 * i], line[i]);
    struct world world = world_of_soup(soup, (whit_accel_params){0});
    for (int l = 0; l < LEVELS; ++l) {
        struct gpu_hit hit = {0};
        assert_false(levels[l].exact && level_meets(&levels[l], &at_line, line, &hit));
        hit = level_trace(&levels[l], world.accel, ORDER_DISTANCE, false, &at_line);
        assert_int_equal(hit.primitive, HIT_NONE);
        int met = 0;
        for (int i = 0; i < 2; ++i)
            if (level_meets(&levels[l], &at_square, square[i], &hit)) {
                ++met;
                assert_true(fabsf(hit.t * at_square.dir[0] - 3.375f) < 1e-5f);
            }
        assert_true(met >= 1);
    }
    world_finish(&world);
    print_message("T8 0 hits of 1 ray, T9 0 leaks of 1 ray\n");
}

/* A ray along an edge, and a triangle elsewhere in the same plane within rounding, at least 0.05 of
   their size apart. The ray passes beside the triangle, or goes towards it and ends before it. */
static struct gpu_ray make_edge_apart(bool towards, struct vec3 v[3])
{
    struct vec3 o = random_point(1.0f), u = random_point(1.0f), w = random_point(1.0f), end[2];
    for (int i = 0; i < 2; ++i) {
        float beside = 1.05f + random_float(&random_state),
              along = 4.0f * random_float(&random_state) - 2.0f;
        if (towards) { /* the ray goes to the corner o, from beyond the opposite edge */
            float share = 0.2f + 0.6f * random_float(&random_state),
                  away = i ? 1.1f : 1.1f + random_float(&random_state);
            beside = share * away;
            along = (1.0f - share) * away;
        }
        end[i] = vec3_add(o, vec3_add(vec3_scale(u, beside), vec3_scale(w, along)));
    }
    if (towards)
        end[0] = vec3_add(o, vec3_scale(vec3_sub(end[1], o), 1.5f + random_float(&random_state)));
    v[0] = o;
    v[1] = vec3_add(o, u);
    v[2] = vec3_add(o, w);
    struct gpu_ray ray = ray_through(end[0], end[1]);
    ray.t_max = 1.0f;
    return ray;
}

/* T10: github.com/RenderKit/embree, issue 423: Embree reports that a triangle and an edge of the
   same mesh, far apart, meet, or not, depending on whether the processor fuses products and sums.
   The numbers of the report are not available; these are similar. If a triangle is seen edge-on,
   all of its edge functions may be rounding errors, wherever in its plane the ray is. So
   `watertight` does not promise that such a ray misses (docs/numerics.md), but only that it is in
   doubt and meets the triangle's box. */
TEST(edges_apart_do_not_meet)
{
    enum { RAYS = 100000 };
    own_rational *rational = rational_create(NULL);
    assert_non_null(rational);
    for (int towards = 0; towards < 2; ++towards) {
        uint32_t met[LEVELS] = {0}, fast = 0, exactly = 0, sure = 0;
        random_state = 10;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 v[3];
            struct gpu_ray ray = make_edge_apart(towards, v);
            struct gpu_hit hit = {0};
            float key;
            struct vec3 origin = vec3_load(ray.origin), dir = vec3_load(ray.dir);
            exactly += rational_meet(rational, origin, dir, v, &key, NULL) && key >= ray.t_min &&
                       key <= ray.t_max;
            fast += level_meets(&fast_level, &ray, v, &hit);
            for (int l = 0; l < LEVELS; ++l) {
                bool meets = level_meets(&levels[l], &ray, v, &hit);
                met[l] += meets;
                sure += meets && !is_in_doubt(&ray, v);
            }
        }
        print_message(
            "T10 edges %s: of %u apart %u meet at fast, %u at watertight (%u of them not in "
            "doubt), %u at exact\n",
            towards ? "that end before" : "beside", (uint32_t)RAYS, fast, met[0], sure, met[1]);
        assert_int_equal(exactly + met[1] + sure, 0);
        assert_true(fast > 100 && met[0] * 4 < fast);
    }
}

/* T11: with reversed winding the same rays hit at the same t. (T12 is part of is_sound.) */
TEST(winding_does_not_matter)
{
    enum { RAYS = 40000 };
    for (int l = 0; l < LEVELS; ++l) {
        uint32_t differ = 0, met = 0;
        double worst_ulp = 0.0;
        random_state = 11;
        for (int r = 0; r < RAYS; ++r) {
            struct subject s = r % 2 ? make_unit() : make_at_edge();
            struct gpu_ray ray = ray_along(s.origin, s.dir);
            struct gpu_hit hit = {0}, other = {0};
            bool here = level_meets(&levels[l], &ray, s.v, &hit);
            const struct vec3 turned[3] = {s.v[0], s.v[2], s.v[1]};
            bool there = level_meets(&levels[l], &ray, turned, &other);
            met += here;
            differ += here != there;
            if (here && there)
                worst_ulp = fmax(worst_ulp, hard_ulps_between(other.t, hit.t));
        }
        print_message("%-10s T11 %u of %u differ by winding, %u met, t within %.3g ulp\n",
                      levels[l].name, differ, RAYS, met, worst_ulp);
        assert_true(met > RAYS / 4);
        assert_int_equal(differ, 0);
    }
}
