/* No ray gets out of a closed surface, except if the traversal is compiled with a * b + c
   contracted. Leaks of meshes for which nothing is promised are counted. */
#include "hard_fixture.h"
#include "unit.h"

enum { RAYS = 100000 };

/* ---- host/twin/traverse.c compiled once more, under other names and with contraction ---- */

#ifdef HARD_CONTRACTED
void traverse_ray_contracted(const struct accel *accel, const struct traverse_params *params,
                             const struct gpu_ray *ray, struct gpu_hit *hit, struct gpu_cost *cost,
                             uint32_t *status);
#else
#define traverse_ray_contracted traverse_ray /* never called */
#endif

static bool has_contracted(void)
{
#if !defined(HARD_CONTRACTED)
    return false;
#elif defined(__x86_64__)
    return __builtin_cpu_supports("fma");
#else
    return true;
#endif
}

/* ---- Rays at edges and vertices ---- */

/* A ray from `origin` to `target`, with its direction rounded to floats. */
static struct gpu_ray ray_at(struct vec3 origin, const double target[3])
{
    return ray_along(origin, vec3_make((float)(target[0] - (double)origin.x),
                                       (float)(target[1] - (double)origin.y),
                                       (float)(target[2] - (double)origin.z)));
}

/* A random vertex or point of an edge, in object space. */
static void target_of(const struct soup *soup, double out[3])
{
    uint32_t triangle = random_below(&random_state, soup->count),
             corner = random_below(&random_state, 3);
    const float *a = soup_vertex(soup, triangle, corner),
                *b = soup_vertex(soup, triangle, (corner + 1) % 3);
    double s = random_below(&random_state, 2) ? 0.0 : random_unit(&random_state);
    for (int k = 0; k < 3; ++k)
        out[k] = (double)a[k] + s * ((double)b[k] - (double)a[k]);
}

/* A ray from near the middle of the mesh to `target`. Every fourth one starts at the target's
   coordinate on one axis if it can; only every eighth exactly. */
static struct gpu_ray leaving_ray(const float middle[3], const double target[3], float reach,
                                  uint32_t i)
{
    float origin[3];
    vec3_store(origin, vec3_add(vec3_load(middle), random_point(reach)));
    uint32_t axis = random_below(&random_state, 3);
    for (uint32_t k = 0; k < 3 && i % 4 == 0; ++k)
        if (k != axis && fabs(target[k] - (double)middle[k]) < (double)reach)
            origin[k] = (float)target[k] + (i % 8 ? random_within(1e-6f) : 0.0f);
    return ray_at(vec3_load(origin), target);
}

/* ---- Hunts ---- */

struct hunt {
    const char *name;
    float at[3];
    struct soup (*make)(void);
    struct gpu_ray (*aim)(const struct hunt *hunt, const struct soup *soup, uint32_t i);
    bool placed; /* a rotated and mirrored instance at `at`; else the vertices are moved there */
};

struct tally {
    uint32_t rays, leaks, exact_leaks, contracted_leaks;
    uint32_t other; /* hits that differ from exact arithmetic */
};

static void tell(const struct level *level, const char *name, const struct tally *tally)
{
    print_message("%-10s %-32s %u of %u rays leak (exactly: %u; if contracted: %u), %u hit "
                  "another triangle\n",
                  level->name, name, tally->leaks, tally->rays, tally->exact_leaks,
                  tally->contracted_leaks, tally->other);
}

static void follow(const struct level *level, const struct accel *accel, struct rational *rational,
                   const struct gpu_ray *ray, struct tally *tally)
{
    struct gpu_hit hit = level_trace(level, accel, ORDER_DISTANCE, false, ray);
    struct rational_hit exact;
    rational_trace(rational, ray, NULL, &exact);
    bool other = hit.primitive != exact.primitive || hit.instance != exact.instance;
    ++tally->rays;
    tally->leaks += hit.primitive == HIT_NONE;
    tally->exact_leaks += exact.primitive == HIT_NONE;
    tally->other += other;
    assert_false(level->exact && other);
    if (level->exact || !has_contracted())
        return;
    uint32_t status = 0;
    traverse_ray_contracted(accel, NULL, ray, &hit, NULL, &status);
    tally->contracted_leaks += hit.primitive == HIT_NONE;
}

/* ---- The meshes ---- */

static struct soup make_sphere(void)
{
    return soup_sphere(32, 16);
}

static struct soup make_plane(void)
{
    struct scene_mesh mesh;
    assert_int_equal(shape_plane(4.0, 4.0, 16, 1.0, &mesh), WHIT_OK);
    return soup_of_mesh("plane", mesh);
}

/* A sphere whose vertices are moved outwards and inwards alternately, as in pbrt's
   Triangle.Watertight. Equal vertices stay equal. */
static struct soup make_spikes(void)
{
    struct soup soup = soup_sphere(16, 16);
    for (uint32_t i = 0; i < 3 * soup.count; ++i) {
        float *p = &soup.positions[3 * (size_t)i];
        uint32_t bits[3], mixed = 0;
        memcpy(bits, p, sizeof bits);
        for (int k = 0; k < 3; ++k)
            mixed = (mixed ^ (bits[k] == 0x80000000u ? 0 : bits[k])) * 0x9e3779b9u;
        float factor = 1.0f + 2.0f * (float)(mixed >> 24) / 256.0f;
        for (int k = 0; k < 3; ++k)
            p[k] *= factor;
    }
    return soup;
}

static struct affine placing(const struct hunt *hunt)
{
    const double at[3] = {(double)hunt->at[0], (double)hunt->at[1], (double)hunt->at[2]};
    return affine_from_trs(at, (double[]){0.3, -0.5, 0.2, 0.8}, (double[]){1.0, 1.25, -0.8});
}

/* ---- Aims of the rays ---- */

static struct gpu_ray from_inside(const struct hunt *hunt, const struct soup *soup, uint32_t i)
{
    const struct affine place = placing(hunt);
    double target[3];
    target_of(soup, target);
    if (hunt->placed)
        affine_point(&place, target, target);
    return leaving_ray(hunt->at, target, hunt->placed ? 0.3f : 0.4f, i);
}

/* Rays through inner edges and vertices of a plane, from both sides. */
static struct gpu_ray through_plane(const struct hunt *hunt, const struct soup *soup, uint32_t i)
{
    struct vec3 from = vec3_add(vec3_load(hunt->at), random_point(1.5f));
    double to[3];
    do
        target_of(soup, to);
    while (fmax(fabs(to[0] - (double)hunt->at[0]), fabs(to[2] - (double)hunt->at[2])) > 1.7);
    from.y = hunt->at[1] + (i % 2 ? 1.0f : -1.0f) * (0.01f + random_float(&random_state));
    if (i % 4 == 0) /* in the planes of boxes; every eighth along the axis */
        from.x = (float)to[0];
    if (i % 8 == 0)
        from.z = (float)to[2];
    return ray_at(from, to);
}

/* All of these also test W7 (equal but unshared vertices), since soups share no vertices. */
static const struct hunt hunts[] = {
    {"W1 sphere", {0, 0, 0}, make_sphere, from_inside, false},
    {"W1 sphere at 10", {10, -10, 10}, make_sphere, from_inside, false},
    {"W1 sphere at 1e3", {1e3f, 1e3f, -1e3f}, make_sphere, from_inside, false},
    {"W1 sphere at 1e5", {-1e5f, 1e5f, 1e5f}, make_sphere, from_inside, false},
    {"W2 sphere", {148376, 1234, -223423}, make_sphere, from_inside, false}, /* Embree's */
    {"W2 plane", {148376, 1234, -223423}, make_plane, through_plane, false}, /* Embree's */
    {"W4 spikes", {0, 0, 0}, make_spikes, from_inside, false},
    {"W4 spikes at 1e3", {1e3f, -1e3f, 1e3f}, make_spikes, from_inside, false},
    {"W8 instance", {0, 0, 0}, make_sphere, from_inside, true},
    {"W8 instance at 1e3", {1e3f, -1e3f, 1e3f}, make_sphere, from_inside, true},
    {"W8 instance at 1e5", {1e5f, -1e5f, 1e5f}, make_sphere, from_inside, true},
};

static struct world world_of_hunt(const struct hunt *hunt)
{
    const struct affine place = placing(hunt);
    struct soup soup = hunt->make();
    for (uint32_t i = 0; i < 9 * soup.count && !hunt->placed; ++i)
        soup.positions[i] += hunt->at[i % 3];
    soup_box(&soup);
    struct scene *scene = scene_begin(&silent, hunt->name);
    scene_put(scene, mesh_triangles(soup.positions, soup.count),
              &(struct put){.matrix = hunt->placed ? &place : NULL});
    struct world world = world_of(scene, (whit_accel_params){0});
    assert_int_equal(scene->triangle_total, soup.count); /* closed still */
    world.soup = soup;
    return world;
}

/* W1, W2, W4, W7, W8. W10: the rays are so hard that a contracted traversal leaks. */
TEST(no_ray_gets_through)
{
    uint32_t contracted_leaks = 0;
    for (size_t h = 0; h < sizeof hunts / sizeof *hunts; ++h) {
        own_world world = world_of_hunt(&hunts[h]);
        own_rational *rational = rational_create(world.accel);
        for (int l = 0; l < LEVELS; ++l) {
            struct tally tally = {0};
            random_state = 51 + h;
            for (uint32_t i = 0; i < cases_of(RAYS); ++i) {
                struct gpu_ray ray = hunts[h].aim(&hunts[h], &world.soup, i);
                follow(&levels[l], world.accel, rational, &ray, &tally);
            }
            tell(&levels[l], hunts[h].name, &tally);
            if (tally.exact_leaks > 0 || (levels[l].watertight && tally.leaks > 0))
                fail_msg("%s: rays leak", hunts[h].name);
            contracted_leaks += tally.contracted_leaks;
        }
    }
    assert_true(contracted_leaks > 0 || !has_contracted());
}

/* ---- Crossings ---- */

/* A ray from inside a torus, across its hole. */
static struct gpu_ray ray_in_ring(void)
{
    struct vec3 origin = vec3_add(random_point(0.2f), vec3_make(1, 0, 0)), dir = random_point(1.0f);
    dir.y *= 0.1f;
    return ray_along(origin, dir);
}

struct parity {
    uint32_t rays, crossings, wrong, exact_wrong, other; /* other: lists that differ */
};

/* Compares all hits along the ray with those by fractions. */
static void count_crossings(const struct level *level, const struct accel *accel,
                            struct rational *rational, const struct gpu_ray *ray,
                            struct parity *parity)
{
    struct traverse_params params = {.numerics = level->numerics};
    uint32_t count = 0, exact_count = 0;
    bool same = true;
    struct gpu_hit hit = trace_with(accel, params, ray, NULL);
    struct rational_hit exact;
    struct rational_query query = {0};
    params.behind = &hit;
    rational_trace(rational, ray, &query, &exact);
    while (hit.primitive != HIT_NONE || exact.primitive != HIT_NONE) {
        const struct rational_hit before = exact;
        same &= hit.primitive == exact.primitive && (!level->exact || hit.t == exact.t);
        query.behind = &before;
        if (exact.primitive != HIT_NONE && ++exact_count)
            rational_trace(rational, ray, &query, &exact);
        if (hit.primitive != HIT_NONE && ++count)
            hit = trace_with(accel, params, ray, NULL);
    }
    ++parity->rays;
    parity->crossings += exact_count;
    parity->wrong += count % 2 == 0;
    parity->exact_wrong += exact_count % 2 == 0;
    parity->other += !same;
}

/* W5: a ray from inside a closed surface crosses it an odd number of times, by exact arithmetic and
   at every level. Rays are not aimed at edges, where both triangles may count. */
TEST(crossings_are_odd)
{
    const uint32_t rays = cases_of(RAYS / 3);
    own_world world =
        world_of_soup(soup_of_mesh("torus", mesh_torus(1.0, 0.4, 48, 24)), (whit_accel_params){0});
    own_rational *rational = rational_create(world.accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct parity parity = {0};
        random_state = 5;
        for (uint32_t i = 0; i < rays; ++i) {
            struct gpu_ray ray = ray_in_ring();
            count_crossings(&levels[l], world.accel, rational, &ray, &parity);
        }
        print_message("%-10s W5 even crossings: %u of %u rays, exactly %u; %u crossings, "
                      "%u rays have others\n",
                      levels[l].name, parity.wrong, parity.rays, parity.exact_wrong,
                      parity.crossings, parity.other);
        assert_true(parity.crossings > rays + rays / 4);
        assert_int_equal(parity.exact_wrong + parity.wrong, 0);
        assert_true(!levels[l].exact || parity.other == 0);
    }
}

/* W6: at a T-junction a vertex lies beside the edge of a larger triangle, by rounding, so there is
   a real crack. Leaks there are counted; elsewhere there may be none. */
TEST(only_t_junctions_leak)
{
    const float a[3] = {-1, -1, 0.1f}, b[3] = {1, -1, 0.3f}, c[3] = {1, 1.1f, 0.7f},
                d[3] = {-1, 1, 0.2f};
    const float middle[3] = {a[0] + 0.3f * (c[0] - a[0]), a[1] + 0.3f * (c[1] - a[1]) + 1e-6f,
                             a[2] + 0.3f * (c[2] - a[2])};
    struct soup soup = soup_make("t-junction", 3);
    soup_set(&soup, 0, a, b, c);
    soup_set(&soup, 1, a, middle, d);
    soup_set(&soup, 2, middle, c, d);
    own_world world = world_of_soup(soup, (whit_accel_params){0});
    own_rational *rational = rational_create(world.accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct tally seam = {0}, sound = {0};
        random_state = 6;
        for (uint32_t i = 0; i < RAYS / 3; ++i) {
            struct vec3 from = vec3_add(random_point(0.5f), vec3_make(0, 0, 3)), target;
            float s = random_float(&random_state);
            target = vec3_add(vec3_load(a), vec3_scale(vec3_sub(vec3_load(c), vec3_load(a)), s));
            struct gpu_ray ray = ray_through(from, target);
            follow(&levels[l], world.accel, rational, &ray, &seam);
            target = vec3_add(vec3_load(middle),
                              vec3_scale(vec3_sub(vec3_load(d), vec3_load(middle)), s));
            ray = ray_through(from, target);
            if (s > 0.01f && s < 0.99f)
                follow(&levels[l], world.accel, rational, &ray, &sound);
        }
        tell(&levels[l], "W6 at the edge of a T-junction", &seam);
        tell(&levels[l], "W6 at the edge below it", &sound);
        assert_true(seam.exact_leaks > 0);
        assert_true(!levels[l].watertight || sound.leaks == 0);
        assert_int_equal(sound.exact_leaks, 0);
    }
}

/* W9: two instances are halves of a floor, side by side. The ray is rounded separately in each
   one's object space, so leaks between them are only counted. */
TEST(edges_between_instances_are_counted)
{
    const double turn[4] = {0.3, -0.5, 0.2, 0.8}, one[3] = {1, 1, 1}, zero[3] = {0, 0, 0};
    const float corner[3] = {0, -1, 0}, along[3] = {1, 0, 0}, up[3] = {0, 2, 0};
    struct affine places[2];
    places[0] = places[1] = affine_from_trs(zero, turn, one);
    for (int k = 0; k < 3; ++k) /* one to the left along its own x */
        places[1].m[4 * k + 3] = -places[0].m[4 * k];
    struct soup soup = soup_make("half a floor", 2);
    soup_quad(&soup, 0, corner, along, up);
    struct scene *scene = scene_begin(&silent, soup.name);
    uint32_t mesh = scene_put_mesh(scene, mesh_triangles(soup.positions, soup.count));
    for (int i = 0; i < 2; ++i)
        scene_put_again(scene, mesh, &(struct put){.matrix = &places[i]});
    own_world world = world_of(scene, (whit_accel_params){0});
    world.soup = soup;
    own_rational *rational = rational_create(world.accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct tally tally = {0};
        random_state = 9;
        for (uint32_t i = 0; i < RAYS / 3; ++i) {
            double target[3] = {0, 0.9 * random_signed(&random_state), 0}, from[3];
            random_vec3(&random_state, from);
            from[2] += 3.0;
            affine_point(&places[0], target, target);
            affine_point(&places[0], from, from);
            struct gpu_ray ray =
                ray_at(vec3_make((float)from[0], (float)from[1], (float)from[2]), target);
            follow(&levels[l], world.accel, rational, &ray, &tally);
        }
        tell(&levels[l], "W9 edge between two instances", &tally);
    }
}
