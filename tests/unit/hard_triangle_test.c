/* Triangles where they are hardest, beside what exact arithmetic says of them. */
#include "hard_fixture.h"

#include "oracle/oracle.h"
#include "twin/moller.h"

/* What is wrong in any case, whatever the level. */
static bool is_sound(const struct gpu_hit *hit)
{
    return isfinite(hit->t) && hit->u >= 0.0f && hit->v >= 0.0f &&
           hit->u + hit->v <= 1.0f + 4.0f * FLT_EPSILON;
}

struct tally {
    uint32_t rays, met, missed, invented, unsound;
    uint32_t sure, far_off; /* beyond the error bound of floats: another answer, another t */
    double worst_ulp;
    uint32_t over_4_ulp;
};

/* The triangle in double (oracle.c), with the bound of what floats may say of it. */
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

/* Whether the bound leaves room for another answer. */
static bool is_in_doubt(const struct gpu_ray *ray, const struct vec3 v[3])
{
    struct oracle_hit oracle;
    ask_oracle(ray, v, &oracle);
    return fabs(oracle.edge_margin) < 1.0;
}

/* Of a level that is not exact: what it says is wrong only where the bound allows it. */
static void judge_float(const struct gpu_ray *ray, const struct vec3 v[3], bool met, bool exact,
                        float t, struct tally *tally)
{
    struct oracle_hit oracle;
    if (!met && !exact)
        return;
    ask_oracle(ray, v, &oracle);
    if (met != exact)
        tally->sure += !(fabs(oracle.edge_margin) < 1.0);
    else if (oracle.primitive != HIT_NONE)
        tally->far_off += !(fabs((double)t - oracle.t) <= oracle.t_error);
}

static double ulps_between(float a, float b)
{
    float ulp = nextafterf(fabsf(b), INFINITY) - fabsf(b);
    return fabs((double)a - (double)b) / (double)ulp;
}

static void compare_triangle(const struct level *level, struct rational *rational,
                             const struct gpu_ray *ray, const struct vec3 v[3], struct tally *tally)
{
    struct gpu_hit hit = {0};
    float key = NAN;
    bool exact =
        rational_meet(rational, vec3_load(ray->origin), vec3_load(ray->dir), v, &key, NULL);
    exact = exact && key >= ray->t_min && key <= ray->t_max;
    bool met = level_meets(level, ray, v, &hit);
    ++tally->rays;
    tally->met += exact;
    tally->missed += exact && !met;
    tally->invented += met && !exact;
    tally->unsound += met && !is_sound(&hit);
    if (met && exact) {
        double off = ulps_between(hit.t, key);
        tally->worst_ulp = fmax(tally->worst_ulp, off);
        tally->over_4_ulp += off > 4.0;
    }
    if (level->exact) {
        assert_int_equal(met, exact);
        assert_true(!met || hit.t == key);
    } else {
        judge_float(ray, v, met, exact, hit.t, tally);
    }
}

static void tell(const struct level *level, const char *name, const struct tally *tally)
{
    print_message("%-10s %-30s %u of %u missed, %u of %u invented, %u of them not in doubt; %u "
                  "unsound; t within %.3g ulp, %u beyond their bound\n",
                  level->name, name, tally->missed, tally->met, tally->invented,
                  tally->rays - tally->met, tally->sure, tally->unsound, tally->worst_ulp,
                  tally->far_off);
}

typedef void (*make_fn)(struct vec3 v[3], struct gpu_ray *ray);

/* At a point inside, well away from the edges. */
static struct vec3 inner_point(const struct vec3 v[3])
{
    float a = 0.1f + 0.3f * random_float(&random_state),
          b = 0.1f + 0.3f * random_float(&random_state);
    struct vec3 p = vec3_add(vec3_scale(v[0], a), vec3_scale(v[1], b));
    return vec3_add(p, vec3_scale(v[2], 1.0f - a - b));
}

static void make_unit(struct vec3 v[3], struct gpu_ray *ray)
{
    for (int i = 0; i < 3; ++i)
        v[i] = random_point(1.0f);
    *ray = ray_from_cube(3.0f, inner_point(v));
}

static float any_size(void)
{
    return random_within((float)pow(10.0, 16.0 * (double)random_float(&random_state) - 8.0));
}

static void make_any_size(struct vec3 v[3], struct gpu_ray *ray)
{
    struct vec3 p[4];
    for (int i = 0; i < 4; ++i) {
        float x = any_size(), y = any_size();
        p[i] = vec3_make(x, y, any_size());
    }
    memcpy(v, p, 3 * sizeof *v);
    *ray = ray_through(p[3], inner_point(v));
}

static void make_edge_aimed(struct vec3 v[3], struct gpu_ray *ray)
{
    make_unit(v, ray);
    float s = random_below(&random_state, 2) ? 0.0f : random_float(&random_state);
    struct vec3 target = vec3_add(v[0], vec3_scale(vec3_sub(v[1], v[0]), s));
    *ray = ray_through(vec3_load(ray->origin), target);
}

static void make_needle(struct vec3 v[3], struct gpu_ray *ray)
{
    make_unit(v, ray);
    float width = (float)pow(10.0, -6.0 - 6.0 * (double)random_float(&random_state));
    v[2] = vec3_add(v[1], random_point(width));
    *ray = ray_through(vec3_load(ray->origin), inner_point(v));
}

static struct vec3 random_grid_point(void)
{
    float x = (float)random_below(&random_state, 9), y = (float)random_below(&random_state, 9);
    return vec3_make(x, y, (float)random_below(&random_state, 9));
}

/* Within 1e-3 to 1e-7 of the plane. */
static void make_grazing(struct vec3 v[3], struct gpu_ray *ray)
{
    make_unit(v, ray);
    struct vec3 n = vec3_cross(vec3_sub(v[1], v[0]), vec3_sub(v[2], v[0]));
    float height = (float)pow(10.0, -3.0 - 4.0 * (double)random_float(&random_state));
    struct vec3 target = inner_point(v),
                far = vec3_sub(vec3_scale(v[0], 3.0f), vec3_scale(v[1], 2.0f));
    *ray = ray_through(vec3_add(far, vec3_scale(vec3_normalize(n), height)), target);
}

struct kind {
    const char *name;
    make_fn make;
    bool plain; /* nothing is near any limit: hits are exact, t within 16 ulp for all but few */
};

static const struct kind kinds[] = {
    {"inside", make_unit, true},          {"T1 10^-8 to 10^8", make_any_size, false},
    {"at edges", make_edge_aimed, false}, {"T2 needles", make_needle, false},
    {"T4 grazing", make_grazing, false},
};

static void decisions_are_sound(void **state)
{
    (void)state;
    enum { KINDS = sizeof kinds / sizeof *kinds, RAYS = 40000 };
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    for (int l = 0; l < LEVELS; ++l)
        for (size_t i = 0; i < KINDS; ++i) {
            struct tally tally = {0};
            random_state = 31 + i;
            for (int r = 0; r < RAYS; ++r) {
                struct vec3 v[3];
                struct gpu_ray ray;
                kinds[i].make(v, &ray);
                compare_triangle(&levels[l], rational, &ray, v, &tally);
            }
            tell(&levels[l], kinds[i].name, &tally);
            assert_int_equal(tally.unsound + tally.sure + tally.far_off, 0);
            assert_true(tally.met > RAYS / 20);
            assert_true(!kinds[i].plain || tally.missed + tally.invented <= RAYS / 10000);
        }
    rational_destroy(rational);
}

/* T1: |dt| of triangles that are not seen at a sharp angle, nor long and thin. None is beyond its
   bound, and nearly all are far within it: one in 1,600 is more than 4 ulp off, whatever the seed.
 */
static void distances_are_good(void **state)
{
    (void)state;
    enum { RAYS = 100000 };
    struct rational *rational = rational_create(NULL);
    for (int l = 0; l < LEVELS; ++l) {
        struct tally tally = {0};
        random_state = 41;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 v[3];
            struct gpu_ray ray;
            make_unit(v, &ray);
            struct vec3 n = vec3_cross(vec3_sub(v[1], v[0]), vec3_sub(v[2], v[0]));
            struct vec3 d = vec3_load(ray.dir);
            float facing = fabsf(vec3_dot(n, d)) / vec3_length(d);
            if (facing > 0.25f && vec3_length(vec3_sub(vec3_load(ray.origin), v[0])) > 0.5f)
                compare_triangle(&levels[l], rational, &ray, v, &tally);
        }
        tell(&levels[l], "T1 well conditioned", &tally);
        assert_true(tally.met > RAYS / 5 && tally.missed + tally.invented == 0);
        assert_int_equal(tally.far_off, 0);
        assert_true(tally.over_4_ulp <= tally.met / 500);
    }
    rational_destroy(rational);
}

/* Two or three equal corners, or three on a line. */
static void make_without_area(struct vec3 v[3], struct gpu_ray *ray)
{
    struct vec3 p = random_grid_point(), q = random_grid_point();
    uint32_t kind = random_below(&random_state, 3);
    v[0] = random_grid_point();
    v[1] = kind == 0 ? v[0] : q;
    v[2] = kind == 2 ? vec3_sub(vec3_scale(q, 2.0f), v[0]) : v[0];
    *ray = ray_through(p, random_below(&random_state, 2) ? v[1] : random_grid_point());
}

/* From one point of the plane to another. */
static void make_in_plane(struct vec3 v[3], struct gpu_ray *ray)
{
    for (int i = 0; i < 3; ++i)
        v[i] = random_grid_point();
    struct vec3 e = vec3_sub(v[1], v[0]), f = vec3_sub(v[2], v[0]);
    *ray = ray_through(vec3_sub(vec3_sub(v[0], e), f),
                       vec3_add(v[0], random_below(&random_state, 2) ? e : f));
}

/* T3, T5. Integers, so that nothing of it is lost by rounding: there is no one point in which such
   a triangle is met. The shear of the watertight test is rounded all the same, so that it may take
   a triangle that is seen edge-on for one that is not; scenes hold none without area. */
static void what_has_no_point_is_not_met(void **state)
{
    (void)state;
    enum { RAYS = 60000 };
    const struct kind edge_on[] = {{"T3 without area", make_without_area, false},
                                   {"T5 in the plane", make_in_plane, false}};
    struct rational *rational = rational_create(NULL);
    for (int l = 0; l < LEVELS; ++l)
        for (int i = 0; i < 2; ++i) {
            struct tally tally = {0};
            random_state = 3;
            for (int r = 0; r < RAYS; ++r) {
                struct vec3 v[3];
                struct gpu_ray ray;
                edge_on[i].make(v, &ray);
                compare_triangle(&levels[l], rational, &ray, v, &tally);
            }
            tell(&levels[l], edge_on[i].name, &tally);
            assert_int_equal(tally.met + tally.unsound + tally.sure, 0);
            assert_true(!levels[l].exact || tally.invented == 0);
        }
    rational_destroy(rational);
}

/* T6: both ends count, for closest and any hits. The watertight test holds t_min against t as it is
   before it is moved into the triangle's box: where it was moved, the beginning may be past it. */
static void ends_of_intervals_count(void **state)
{
    (void)state;
    enum { RAYS = 5000 };
    const struct bvh_params params = {0};
    struct soup soup = soup_terrain(12);
    struct scene *scene = soup_scene(&soup);
    struct accel *accel = soup_accel(scene, &params);
    for (int l = 0; l < LEVELS; ++l) {
        uint32_t wrong_end = 0, wrong_begin = 0, hits = 0;
        random_state = 6;
        for (uint32_t i = 0; i < RAYS; ++i) {
            struct gpu_ray ray = soup_ray(&soup, &accel->meshes[0].box, i), cut = ray;
            struct gpu_hit first, again;
            level_trace(&levels[l], accel, ORDER_DISTANCE, false, &ray, &first, NULL);
            if (first.primitive == HIT_NONE)
                continue;
            ++hits;
            for (uint32_t any = 0; any < 2; ++any) {
                cut = ray;
                cut.t_max = first.t;
                level_trace(&levels[l], accel, ORDER_DISTANCE, any, &cut, &again, NULL);
                wrong_end += again.primitive != first.primitive && !any;
                wrong_end += again.primitive == HIT_NONE;
                cut.t_max = nextafterf(first.t, -INFINITY);
                level_trace(&levels[l], accel, ORDER_DISTANCE, any, &cut, &again, NULL);
                wrong_end += again.primitive != HIT_NONE;
                cut = ray;
                cut.t_min = first.t;
                level_trace(&levels[l], accel, ORDER_DISTANCE, any, &cut, &again, NULL);
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
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

/* T7: from 1e-15 (rays at edges: 1e-11, where products are smaller) to 1e18 in size, bit for bit
   what is at 1, whether directions are as long as scenes are large, or of the length of 1 as those
   of cameras. `fast` multiplies three lengths: from 6e-8 to 7e10. */
static void size_does_not_matter(void **state)
{
    (void)state;
    enum { RAYS = 40000 };
    for (int l = 0; l <= LEVELS; ++l) {
        const struct level *level = l < LEVELS ? &levels[l] : &fast_level;
        uint32_t differ = 0, met = 0;
        random_state = 7;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 v[3], scaled[3];
            struct gpu_ray ray, far;
            struct gpu_hit hit = {0}, other = {0};
            bool at_edge = r % 2 == 0, unit = r % 4 < 2;
            int min = l == LEVELS ? -24 : at_edge ? -36 : -50, max = l == LEVELS ? 36 : 60;
            kinds[at_edge ? 2 : 0].make(v, &ray);
            float scale =
                ldexpf(1.0f, (int)random_below(&random_state, (uint32_t)(max + 1 - min)) + min);
            far = ray;
            for (int k = 0; k < 3; ++k) {
                scaled[k] = vec3_scale(v[k], scale);
                far.origin[k] *= scale;
                far.dir[k] *= unit ? 1.0f : scale;
            }
            bool here = level_meets(level, &ray, v, &hit);
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

/* T8: pbrt-v4, shapes_test.cpp, Triangle.BadCases: it has no area, so that no scene holds it.
   T9: github.com/Oblikovati/Oblikovati, issue 2146: a ray at the diagonal of a square. */
static void known_cases(void **state)
{
    (void)state;
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
    const struct bvh_params params = {0};
    struct soup soup = soup_make("line", 1);
    for (uint32_t i = 0; i < 3; ++i)
        vec3_store(&soup.positions[3 * i], line[i]);
    struct scene *scene = soup_scene(&soup);
    struct accel *accel = soup_accel(scene, &params);
    for (int l = 0; l < LEVELS; ++l) {
        struct gpu_hit hit = {0};
        assert_false(levels[l].exact && level_meets(&levels[l], &at_line, line, &hit));
        level_trace(&levels[l], accel, ORDER_DISTANCE, false, &at_line, &hit, NULL);
        assert_int_equal(hit.primitive, HIT_NONE);
        int met = 0;
        for (int i = 0; i < 2; ++i)
            if (level_meets(&levels[l], &at_square, square[i], &hit)) {
                ++met;
                assert_true(fabsf(hit.t * at_square.dir[0] - 3.375f) < 1e-5f);
            }
        assert_true(met >= 1);
    }
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
    print_message("T8 0 hits of 1 ray, T9 0 leaks of 1 ray\n");
}

/* An edge of a mesh held against a triangle of another part of it: both in one plane but for
   roundings, at least 0.05 of their size apart. Its line passes beside the triangle, or towards it
   and ends before it. */
static void make_edge_apart(bool towards, struct vec3 v[3], struct gpu_ray *ray)
{
    struct vec3 o = random_point(1.0f), u = random_point(1.0f), w = random_point(1.0f), end[2];
    for (int i = 0; i < 2; ++i) {
        float beside = 1.05f + random_float(&random_state),
              along = 4.0f * random_float(&random_state) - 2.0f;
        if (towards) { /* to where the corner o is, from beyond the edge opposite to it */
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
    *ray = ray_through(end[0], end[1]);
    ray->t_max = 1.0f;
}

/* T10: github.com/RenderKit/embree, issue 423: of a triangle and an edge of the same mesh, far
   apart, Embree says that they meet, or not, by whether the processor fuses products and sums. The
   report's numbers are not at hand; these are of its kind. Seen edge-on, a triangle may have edge
   functions that are roundings all, wherever on its plane the ray is: `watertight` does not promise
   that such a ray misses (docs/numerics.md), but that it is in doubt, and that the triangle's box
   is met. */
static void edges_apart_do_not_meet(void **state)
{
    (void)state;
    enum { RAYS = 100000 };
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    for (int towards = 0; towards < 2; ++towards) {
        uint32_t met[LEVELS] = {0}, fast = 0, exactly = 0, sure = 0;
        random_state = 10;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 v[3];
            struct gpu_ray ray;
            struct gpu_hit hit = {0};
            float key;
            make_edge_apart(towards, v, &ray);
            struct vec3 origin = vec3_load(ray.origin), dir = vec3_load(ray.dir);
            exactly += rational_meet(rational, origin, dir, v, &key, NULL) && key >= ray.t_min &&
                       key <= ray.t_max;
            fast += intersect_moller(origin, dir, v[0], v[1], v[2], 0.0f, &hit.t, &hit.u, &hit.v) &&
                    hit.t <= ray.t_max;
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
    rational_destroy(rational);
}

/* T11: turned round, the same rays hit, at the same t; T12 is part of is_sound. */
static void winding_does_not_matter(void **state)
{
    (void)state;
    enum { RAYS = 40000 };
    for (int l = 0; l < LEVELS; ++l) {
        uint32_t differ = 0, met = 0;
        double worst_ulp = 0.0;
        random_state = 11;
        for (int r = 0; r < RAYS; ++r) {
            struct vec3 v[3];
            struct gpu_ray ray;
            struct gpu_hit hit = {0}, other = {0};
            kinds[r % 2 ? 0 : 2].make(v, &ray);
            bool here = level_meets(&levels[l], &ray, v, &hit);
            const struct vec3 turned[3] = {v[0], v[2], v[1]};
            bool there = level_meets(&levels[l], &ray, turned, &other);
            met += here;
            differ += here != there;
            if (here && there)
                worst_ulp = fmax(worst_ulp, ulps_between(other.t, hit.t));
        }
        print_message("%-10s T11 %u of %u differ by winding, %u met, t within %.3g ulp\n",
                      levels[l].name, differ, RAYS, met, worst_ulp);
        assert_true(met > RAYS / 4);
        assert_int_equal(differ, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(decisions_are_sound),          cmocka_unit_test(distances_are_good),
        cmocka_unit_test(what_has_no_point_is_not_met), cmocka_unit_test(ends_of_intervals_count),
        cmocka_unit_test(size_does_not_matter),         cmocka_unit_test(known_cases),
        cmocka_unit_test(winding_does_not_matter),      cmocka_unit_test(edges_apart_do_not_meet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
