/* The rational oracle: triangle by triangle what plain fractions say, and in whole scenes by tree
   and filter what it says without them. */
#include "accel_fixture.h"

#include "coordinate_fixture.h"
#include "fraction_fixture.h"
#include "oracle/rational.h"
#include "sphere_fixture.h"

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

/* Neighbours of the largest float: where it would go on. */
static double float_after(float key, double way)
{
    float next = nextafterf(key, (float)(way * (double)INFINITY));
    return isinf(next) ? way * 0x1p128 : (double)next;
}

/* Whether the key is the float nearest to t, with even bits at a tie. */
static bool is_rounded(float key, const mpq_t t)
{
    uint32_t bits;
    memcpy(&bits, &key, sizeof bits);
    mpq_t middle;
    mpq_init(middle);
    /* Middles have one bit more than floats: doubles hold them. */
    mpq_set_d(middle, 0.5 * ((double)key + float_after(key, -1.0)));
    int lower = mpq_cmp(t, middle);
    mpq_set_d(middle, 0.5 * ((double)key + float_after(key, 1.0)));
    int upper = mpq_cmp(t, middle);
    mpq_clear(middle);
    return lower >= 0 && upper <= 0 && ((lower > 0 && upper < 0) || bits % 2 == 0);
}

/* Rounded, it would be infinite. */
static bool is_beyond_floats(const mpq_t t)
{
    return mpq_sgn(t) != 0 &&
           (mpz_sizeinbase(mpq_numref(t), 2) + 1 > mpz_sizeinbase(mpq_denref(t), 2) + 127) &&
           (mpq_get_d(t) >= 0x1.ffffffp127 || mpq_get_d(t) <= -0x1.ffffffp127);
}

struct candidate_tally {
    uint32_t cases, met, on_edge, on_vertex, wrong;
};

static void compare_candidate(struct rational *rational, struct vec3 origin, struct vec3 dir,
                              const struct vec3 v[3], struct candidate_tally *tally)
{
    struct fraction_candidate wanted;
    float key = NAN;
    uint32_t edges = 3;
    mpq_init(wanted.t);
    meet_in_fractions(origin, dir, v, &wanted);
    if (wanted.met && is_beyond_floats(wanted.t))
        wanted.met = false;
    bool met = rational_meet(rational, origin, dir, v, &key, &edges);
    ++tally->cases;
    tally->met += met;
    tally->on_edge += met && edges == 1;
    tally->on_vertex += met && edges == 2;
    tally->wrong +=
        met != wanted.met || (met && (edges != wanted.edges || !is_rounded(key, wanted.t)));
    mpq_clear(wanted.t);
}

/* ---- Cases ---- */

struct subject {
    struct vec3 origin, dir, v[3];
};

static struct subject scattered(float (*coordinate)(void))
{
    struct subject s;
    s.origin = point_of(coordinate);
    s.dir = point_of(coordinate);
    for (int i = 0; i < 3; ++i)
        s.v[i] = point_of(coordinate);
    return s;
}

/* Aimed at a vertex or a point of an edge, as well as a rounded direction can. */
static struct subject case_aimed(void)
{
    struct subject s = scattered(random_below(&random_state, 2) ? in_cube : of_any_size);
    float along = random_below(&random_state, 2) ? 0.0f : random_float(&random_state);
    struct vec3 target = vec3_add(s.v[0], vec3_scale(vec3_sub(s.v[1], s.v[0]), along));
    s.dir = vec3_sub(target, s.origin);
    return s;
}

/* Straight through a vertex, or the middle of an edge. */
static struct subject case_aimed_grid(void)
{
    struct subject s = scattered(of_grid);
    struct vec3 target = s.v[0];
    if (random_below(&random_state, 2))
        target = vec3_scale(vec3_add(s.v[0], s.v[1]), 0.5f);
    s.dir = vec3_scale(vec3_sub(target, s.origin), random_below(&random_state, 2) ? 1.0f : -0.25f);
    return s;
}

static struct subject case_needle(void)
{
    struct subject s = case_aimed();
    float width = (float)pow(10.0, -6.0 - 6.0 * (double)random_float(&random_state));
    s.v[2] = vec3_add(s.v[1], vec3_scale(point_of(in_cube), width));
    return s;
}

/* Origin and direction in the plane. */
static struct subject case_coplanar(void)
{
    struct subject s = scattered(random_below(&random_state, 2) ? of_grid : in_cube);
    uint32_t axis = random_below(&random_state, 3);
    float *of[5] = {&s.origin.x, &s.dir.x, &s.v[0].x, &s.v[1].x, &s.v[2].x};
    for (int i = 0; i < 5; ++i)
        of[i][axis] = i == 1 ? 0.0f : 0.75f;
    return s;
}

/* Without area: equal vertices, or three on a line. */
static struct subject case_degenerate(void)
{
    struct subject s = case_aimed_grid();
    if (random_below(&random_state, 2))
        s.v[2] = s.v[random_below(&random_state, 2)];
    else
        s.v[2] = vec3_sub(vec3_scale(s.v[1], 2.0f), s.v[0]);
    return s;
}

struct kind {
    const char *name;
    float (*coordinate)(void); /* of scattered ones */
    struct subject (*make)(void);
    bool meets, meets_edges; /* some do */
};

static const struct kind kinds[] = {
    {"cube", in_cube, NULL, true, false},
    {"10^-8 to 10^8", of_any_size, NULL, true, false},
    {"2^-100 to 2^100", of_extreme_size, NULL, true, false},
    {"grid", of_grid, NULL, true, true},
    {"denormals", denormal, NULL, true, false},
    {"any bits", of_any_bits, NULL, true, false},
    {"aimed", NULL, case_aimed, true, false},
    {"aimed on a grid", NULL, case_aimed_grid, true, true},
    {"needles", NULL, case_needle, true, false},
    {"coplanar", NULL, case_coplanar, false, false},
    {"no area", NULL, case_degenerate, false, false},
};

static struct subject make_case(const struct kind *kind)
{
    return kind->coordinate ? scattered(kind->coordinate) : kind->make();
}

static void triangles_are_met_as_fractions_say(void **state)
{
    (void)state;
    enum { KINDS = sizeof kinds / sizeof *kinds, CASES = 10000 };
    struct rational *rational = rational_create(NULL);
    uint32_t wrong = 0;
    assert_non_null(rational);
    for (size_t i = 0; i < KINDS; ++i) {
        struct candidate_tally tally = {0};
        random_state = 100 + i;
        for (int k = 0; k < CASES; ++k) {
            struct subject s = make_case(&kinds[i]);
            compare_candidate(rational, s.origin, s.dir, s.v, &tally);
        }
        print_message("%-18s %u wrong of %u: met %u, on an edge %u, at a vertex %u\n",
                      kinds[i].name, tally.wrong, tally.cases, tally.met, tally.on_edge,
                      tally.on_vertex);
        assert_int_equal(tally.met > 0, kinds[i].meets);
        assert_true(!kinds[i].meets_edges || (tally.on_edge > 100 && tally.on_vertex > 0));
        wrong += tally.wrong;
    }
    rational_destroy(rational);
    assert_int_equal(wrong, 0);
}

/* ---- Keys that are hard to round ---- */

/* A wall in the plane z, seen along it: t = (z - origin) / dir. */
static bool key_of(struct rational *rational, float z, float origin, float dir, float *key)
{
    const struct vec3 v[3] = {{-2, -1, z}, {2, -1, z}, {0, 2, z}};
    return rational_meet(rational, vec3_make(0, 0, origin), vec3_make(0, 0, dir), v, key, NULL);
}

static void ties_round_to_even(void **state)
{
    (void)state;
    enum { CASES = 20000 };
    struct rational *rational = rational_create(NULL);
    assert_non_null(rational);
    random_state = 7;
    uint32_t wrong = 0;
    static const float origins[] = {-1.0f, -2.0f, -3.0f, -2.0f - 0x1p-22f, -2.0f + 0x1p-23f};
    for (int i = 0; i < CASES; ++i) {
        /* Between 2^25 and 2^26 floats are 4 apart. */
        float z = 0x1p25f + 4.0f * (float)random_below(&random_state, 1u << 23), key = 0.0f;
        float origin = origins[i % 5];
        int scale = (int)random_below(&random_state, 40) - 20;
        uint32_t quarter = (uint32_t)(((double)z - 0x1p25) / 4.0);
        bool up = origin < -2.0f || (origin == -2.0f && quarter % 2 == 1);
        bool met = key_of(rational, z, origin, ldexpf(1.0f, scale), &key);
        wrong += !met || (double)key != ldexp((double)z + (up ? 4.0 : 0.0), -scale);
    }
    print_message("%u wrong of %u keys at and beside middles of floats\n", wrong, CASES);
    assert_int_equal(wrong, 0);
    wrong = 0;
    for (int i = 0; i < CASES; ++i) { /* t = i 2^-150 */
        float key = 0.0f, max = ldexpf((float)i, -100);
        bool met = key_of(rational, max, 0.0f, 0x1p50f, &key);
        int even = i / 2 + (i % 4 == 3);
        wrong += !met || key != ldexpf((float)even, -149);
    }
    print_message("%u wrong of %u keys at and between denormals\n", wrong, CASES);
    assert_int_equal(wrong, 0);
    rational_destroy(rational);
}

static void keys_end_with_the_floats(void **state)
{
    (void)state;
    struct rational *rational = rational_create(NULL);
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
    rational_destroy(rational);
}

/* ---- Scenes ---- */

/* Heights, and all else, are integers: rays along axes and diagonals meet vertices and edges. */
static struct soup soup_grid(uint32_t steps)
{
    struct soup soup = soup_make("grid", 2 * steps * steps);
    int height[33][33];
    for (uint32_t i = 0; i < 33 * 33; ++i)
        height[i / 33][i % 33] = (int)random_below(&random_state, 4);
    for (uint32_t i = 0; i < steps * steps; ++i) {
        uint32_t x = i % steps, y = i / steps;
        float p[4][3];
        for (uint32_t k = 0; k < 4; ++k) {
            uint32_t cx = x + (k & 1), cy = y + (k >> 1);
            p[k][0] = (float)cx;
            p[k][1] = (float)cy;
            p[k][2] = (float)height[cx][cy];
        }
        soup_set(&soup, 2 * i, p[0], p[1], p[3]);
        soup_set(&soup, 2 * i + 1, p[0], p[3], p[2]);
    }
    soup_box(&soup);
    return soup;
}

/* Each triangle three times, one of them turned round. */
static struct soup soup_thrice(uint32_t count)
{
    struct soup soup = soup_make("thrice", 3 * count);
    for (uint32_t i = 0; i < count; ++i) {
        struct subject s = scattered(in_cube);
        float v[3][3];
        for (int k = 0; k < 3; ++k)
            vec3_store(v[k], s.v[k]);
        soup_set(&soup, i, v[0], v[1], v[2]);
        soup_set(&soup, count + i, v[2], v[1], v[0]);
        soup_set(&soup, 2 * count + i, v[1], v[2], v[0]);
    }
    soup_box(&soup);
    return soup;
}

static struct soup soup_cube(void)
{
    const double size[3] = {1.0, 1.0, 1.0};
    struct scene_mesh mesh;
    assert_int_equal(shape_box(size, &mesh), WHIT_OK);
    return soup_of_mesh("cube", &mesh);
}

static struct scene *placed_scene(struct soup *soup, uint32_t count, double spread)
{
    struct scene *scene = scene_begin(&silent, soup->name);
    uint32_t mesh = scene_put_mesh(scene, mesh_triangles(soup->positions, soup->count));
    for (uint32_t i = 0; i < count; ++i) {
        struct affine matrix = placement_random(&random_state, spread, i % 3 == 0);
        if (spread == 0.0) /* not turned: their corners are those of their boxes */
            matrix = affine_from_trs((double[]){3.0 * i, 0.0, 0.0}, (double[]){0, 0, 0, 1},
                                     (double[]){1.1, 0.7, 1.3});
        if (i % 5 == 4) /* stretched a thousandfold */
            for (size_t k = 0; k < 12; k += 4)
                matrix.m[k] *= 1e-3;
        scene_put_again(scene, mesh, &(struct put){.matrix = &matrix});
    }
    return scene_ready(scene);
}

struct world {
    const char *name;
    struct soup soup;
    struct scene *scene;
    struct accel *accel;
};

static struct world world_make(const char *name, struct soup soup, uint32_t placed, double spread,
                               const struct accel_params *params)
{
    struct world world = {.name = name};
    world.scene = placed ? placed_scene(&soup, placed, spread) : soup_scene(&soup);
    world.soup = soup;
    assert_int_equal(accel_create(&silent, world.scene, params, &world.accel), WHIT_OK);
    return world;
}

static void world_finish(struct world *world)
{
    accel_destroy(world->accel);
    scene_destroy(world->scene);
    soup_finish(&world->soup);
}

/* At a vertex, a point of an edge or of the inside of some triangle, from nearby or far away. A
   quarter of them along an axis. */
static struct gpu_ray aimed_ray(const struct accel *accel, uint32_t index)
{
    const struct gpu_triangle *triangle =
        &accel->triangles[random_below(&random_state, accel->record_count)];
    uint32_t instance = random_below(&random_state, accel->instance_count);
    struct vec3 a = in_world(accel, instance, vec3_load(triangle->v0));
    struct vec3 b = in_world(accel, instance, vec3_load(triangle->v1));
    struct vec3 c = in_world(accel, instance, vec3_load(triangle->v2));
    float s = index % 3 == 0 ? 0.0f : random_float(&random_state),
          t = index % 3 == 2 ? random_float(&random_state) : 0.0f;
    struct vec3 target = vec3_add(a, vec3_scale(vec3_sub(b, a), s));
    target = vec3_add(target, vec3_scale(vec3_sub(c, a), t * (1.0f - s)));
    struct vec3 away = vec3_scale(point_of(in_cube), random_below(&random_state, 4) ? 4.0f : 1e6f);
    if (index % 4 == 0)
        away = vec3_make(index % 12 == 0 ? 4.0f : 0.0f, index % 12 == 4 ? -4.0f : 0.0f,
                         index % 12 == 8 ? 4.0f : 0.0f);
    struct gpu_ray ray = {.t_max = INFINITY};
    struct vec3 origin = vec3_add(target, away);
    vec3_store(ray.origin, origin);
    vec3_store(ray.dir, vec3_sub(target, origin));
    if (index % 16 == 5)
        ray.t_max = 1.0f;
    if (index % 16 == 9)
        ray.t_min = 1.0f;
    return ray;
}

static bool same_hit(const struct rational_hit *a, const struct rational_hit *b)
{
    return a->primitive == b->primitive && a->instance == b->instance && a->t == b->t &&
           a->edges == b->edges;
}

struct scene_tally {
    uint32_t rays, hits, on_edges, wrong, steps;
};

/* Up to eight hits one behind the other, each without tree and filter too; then whether any is hit,
   and what is when the first is left out. */
static void compare_ray(struct rational *rational, const struct gpu_ray *ray,
                        struct scene_tally *tally)
{
    struct rational_hit fast, brute, before, first;
    struct rational_query query = {0};
    for (int i = 0; i < 8; ++i) {
        query.brute = false;
        rational_trace(rational, ray, &query, &fast);
        query.brute = true;
        rational_trace(rational, ray, &query, &brute);
        tally->wrong += !same_hit(&fast, &brute);
        tally->on_edges += fast.edges > 0;
        ++tally->steps;
        if (i == 0)
            first = fast;
        else if (fast.primitive != HIT_NONE)
            tally->wrong +=
                fast.t < before.t ||
                (fast.t == before.t &&
                 (fast.instance < before.instance ||
                  (fast.instance == before.instance && fast.primitive <= before.primitive)));
        before = fast;
        query.behind = &before;
        if (fast.primitive == HIT_NONE)
            break;
    }
    ++tally->rays;
    tally->hits += first.primitive != HIT_NONE;
    query = (struct rational_query){.any = true};
    rational_trace(rational, ray, &query, &fast);
    tally->wrong += (fast.primitive == HIT_NONE) != (first.primitive == HIT_NONE);
    query = (struct rational_query){.own = &first};
    rational_trace(rational, ray, &query, &fast);
    query = (struct rational_query){.behind = &first};
    rational_trace(rational, ray, &query, &brute);
    tally->wrong += first.primitive != HIT_NONE && !same_hit(&fast, &brute);
}

static uint32_t compare_world(struct world world, uint32_t ray_count)
{
    struct rational *rational = rational_create(world.accel);
    struct scene_tally tally = {0};
    assert_non_null(rational);
    for (uint32_t i = 0; i < ray_count; ++i) {
        struct gpu_ray ray = aimed_ray(world.accel, i);
        compare_ray(rational, &ray, &tally);
    }
    print_message("%-18s %u wrong of %u rays: %u hit, %u steps, %u of these on edges\n", world.name,
                  tally.wrong, tally.rays, tally.hits, tally.steps, tally.on_edges);
    assert_int_equal(tally.wrong, 0);
    assert_true(tally.hits > tally.rays / 2);
    rational_destroy(rational);
    world_finish(&world);
    return tally.on_edges;
}

static void trees_and_filter_change_nothing(void **state)
{
    (void)state;
    const struct accel_params plain = {0}, flat = {.flatten = true},
                              split = {.mesh = {.builder = BVH_SPATIAL, .spatial_budget = 2.0f}},
                              none = {.mesh = {.builder = BVH_NONE}};
    uint32_t on_edges = 0;
    random_state = 21;
    on_edges +=
        compare_world(world_make("sphere", soup_sphere(24, 12), 0, 0, &plain), cases_of(250));
    on_edges += compare_world(world_make("grid", soup_grid(16), 0, 0, &plain), cases_of(250));
    on_edges += compare_world(world_make("thrice", soup_thrice(60), 0, 0, &plain), cases_of(250));
    on_edges += compare_world(world_make("exponential", soup_exponential(80, 1.3), 0, 0, &plain),
                              cases_of(200));
    on_edges +=
        compare_world(world_make("split hair", soup_hair(200, 0.01f), 0, 0, &split), cases_of(70));
    on_edges += compare_world(world_make("no tree", soup_terrain(8), 0, 0, &none), cases_of(200));
    on_edges += compare_world(world_make("placed spheres", soup_sphere(12, 6), 12, 3.0, &plain),
                              cases_of(70));
    /* Seen from afar, roundings in object space move hits out of the boxes of instances. */
    on_edges +=
        compare_world(world_make("placed cubes", soup_cube(), 12, 0.0, &plain), cases_of(1500));
    on_edges += compare_world(world_make("placed far apart", soup_sphere(12, 6), 12, 1e5, &plain),
                              cases_of(70));
    on_edges +=
        compare_world(world_make("flat spheres", soup_sphere(12, 6), 12, 3.0, &flat), cases_of(70));
    on_edges +=
        compare_world(world_make("placed grids", soup_grid(4), 20, 3.0, &split), cases_of(70));
    assert_true(on_edges > cases_of(500));
}

/* The filter is of use: few of random rays' triangles are left, and aimed rays do need integers. */
static void integers_are_for_hard_cases(void **state)
{
    (void)state;
    const struct accel_params plain = {0};
    struct world world = world_make("sphere", soup_sphere(24, 12), 0, 0, &plain);
    struct rational *random = rational_create(world.accel), *aimed = rational_create(world.accel);
    random_state = 5;
    for (uint32_t i = 0; i < 20000; ++i) {
        struct gpu_ray ray = {.t_max = INFINITY};
        struct rational_hit hit;
        vec3_store(ray.origin, point_of(in_cube));
        vec3_store(ray.dir, point_of(in_cube));
        rational_trace(random, &ray, NULL, &hit);
        ray = aimed_ray(world.accel, 1 + 4 * i);
        rational_trace(aimed, &ray, NULL, &hit);
    }
    struct rational_work all = rational_work(random), hard = rational_work(aimed);
    print_message("left to integers: of random rays %llu of %llu triangles, of aimed ones %llu of "
                  "%llu\n",
                  (unsigned long long)all.exact, (unsigned long long)all.primitives,
                  (unsigned long long)hard.exact, (unsigned long long)hard.primitives);
    assert_true(all.primitives > 20000 && all.exact * 1000 < all.primitives);
    assert_true(hard.exact > 1000);
    rational_destroy(random);
    rational_destroy(aimed);
    world_finish(&world);
}

static void senseless_rays_hit_nothing(void **state)
{
    (void)state;
    const struct accel_params plain = {0};
    struct world world = world_make("sphere", soup_sphere(24, 12), 0, 0, &plain);
    struct rational *rational = rational_create(world.accel);
    const struct gpu_ray rays[] = {
        {{0, 0, 0}, 0, {0, 0, 0}, INFINITY},         {{NAN, 0, 0}, 0, {0, 0, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, INFINITY, 1}, INFINITY},  {{0, 0, 0}, 2, {0, 0, 1}, 1},
        {{0, 0, 0}, NAN, {0.1f, 0.2f, 1}, INFINITY}, {{0, 0, 0}, 0, {0.1f, 0.2f, 1}, -1},
        {{0, 0, 0}, 0, {0.1f, 0.2f, 1}, NAN},
    };
    for (size_t i = 0; i < 2 * sizeof rays / sizeof *rays; ++i) {
        struct rational_hit hit;
        struct rational_query query = {.brute = i % 2 == 1};
        rational_trace(rational, &rays[i / 2], &query, &hit);
        if (i / 2 == 6) /* t_max that is no number: none, as in traversal */
            assert_int_not_equal(hit.primitive, HIT_NONE);
        else
            assert_true(hit.primitive == HIT_NONE && hit.t == INFINITY);
    }
    rational_destroy(rational);
    world_finish(&world);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_are_met_as_fractions_say),
        cmocka_unit_test(ties_round_to_even),
        cmocka_unit_test(keys_end_with_the_floats),
        cmocka_unit_test(trees_and_filter_change_nothing),
        cmocka_unit_test(integers_are_for_hard_cases),
        cmocka_unit_test(senseless_rays_hit_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
