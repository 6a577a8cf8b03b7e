/* Closed surfaces: no ray gets out of them. Other meshes with what is not promised of them. W1 and
   W2 with more rays, and W10, are tests/peers/leaks.c. */
#include "hard_fixture.h"
#include "twin/traverse.h"

enum { RAYS = 30000 };

/* As many as are asked for leave from the middle of a closed mesh for its vertices and edges. */
struct hunt {
    const char *name;
    uint64_t rays, leaks, exact_leaks, other; /* other: not what exact arithmetic says */
};

static void tell(const struct level *level, const struct hunt *hunt)
{
    print_message("%-10s %-32s %llu of %llu rays leak (exactly: %llu), %llu hit another triangle\n",
                  level->name, hunt->name, (unsigned long long)hunt->leaks,
                  (unsigned long long)hunt->rays, (unsigned long long)hunt->exact_leaks,
                  (unsigned long long)hunt->other);
}

static void follow(const struct level *level, const struct accel *accel, struct rational *rational,
                   const struct gpu_ray *ray, struct hunt *hunt)
{
    struct gpu_hit hit;
    struct rational_hit exact;
    level_trace(level, accel, ORDER_DISTANCE, false, ray, &hit, NULL);
    rational_trace(rational, ray, NULL, &exact);
    ++hunt->rays;
    hunt->leaks += hit.primitive == HIT_NONE;
    hunt->exact_leaks += exact.primitive == HIT_NONE;
    hunt->other += hit.primitive != exact.primitive || hit.instance != exact.instance;
    if (level->exact) {
        assert_int_equal(hit.primitive, exact.primitive);
        assert_int_equal(hit.instance, exact.instance);
    }
}

/* A vertex or a point of an edge, in the mesh's space. */
static struct vec3 target_of(const struct soup *soup)
{
    uint32_t triangle = random_below(&random_state, soup->count),
             corner = random_below(&random_state, 3);
    struct vec3 a = vec3_load(soup_vertex(soup, triangle, corner));
    struct vec3 b = vec3_load(soup_vertex(soup, triangle, (corner + 1) % 3));
    float s = random_below(&random_state, 2) ? 0.0f : random_float(&random_state);
    return vec3_add(a, vec3_scale(vec3_sub(b, a), s));
}

/* From near the middle; a fourth level with the target on one axis or two. */
static struct gpu_ray leaving_ray(struct vec3 middle, struct vec3 target, float reach, uint32_t i)
{
    struct vec3 origin = vec3_add(middle, random_point(reach));
    if (i % 4 == 0) {
        float *from[3] = {&origin.x, &origin.y, &origin.z};
        const float to[3] = {target.x, target.y, target.z};
        const float center[3] = {middle.x, middle.y, middle.z};
        uint32_t axis = random_below(&random_state, 3);
        for (uint32_t k = 0; k < 3; ++k)
            if (k != axis && fabsf(to[k] - center[k]) < reach)
                *from[k] = to[k];
    }
    return ray_through(origin, target);
}

/* ---- The meshes ---- */

static void soup_move(struct soup *soup, const float by[3])
{
    for (uint32_t i = 0; i < 9 * soup->count; ++i)
        soup->positions[i] += by[i % 3];
    soup_box(soup);
}

/* Vertices go out and in by turns, as in pbrt's Triangle.Watertight. Equal vertices stay equal. */
static struct soup soup_spikes(void)
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
    soup_box(&soup);
    return soup;
}

struct ball {
    const char *name;
    float at[3];
    bool spiky;
};

/* W1, W2, W4, W7: soups do not share vertices, so that W7 is what all of them are. */
static void no_ray_leaves_closed_meshes(void **state)
{
    (void)state;
    static const struct ball balls[] = {
        {"W1 sphere", {0, 0, 0}, false},
        {"W1 sphere at 10", {10, -10, 10}, false},
        {"W1 sphere at 1e3", {1e3f, 1e3f, -1e3f}, false},
        {"W1 sphere at 1e5", {-1e5f, 1e5f, 1e5f}, false},
        {"W2 sphere at 148376 1234 -223423", {148376, 1234, -223423}, false},
        {"W4 spikes", {0, 0, 0}, true},
        {"W4 spikes at 1e3", {1e3f, -1e3f, 1e3f}, true},
    };
    const struct bvh_params params = {0};
    const uint32_t rays = cases_of(RAYS);
    for (size_t b = 0; b < sizeof balls / sizeof *balls; ++b) {
        struct soup soup = balls[b].spiky ? soup_spikes() : soup_sphere(32, 16);
        soup_move(&soup, balls[b].at);
        struct scene *scene = soup_scene(&soup);
        struct accel *accel = soup_accel(scene, &params);
        struct rational *rational = rational_create(accel);
        assert_int_equal(scene->triangle_total, soup.count); /* closed still */
        for (int l = 0; l < LEVELS; ++l) {
            struct hunt hunt = {balls[b].name, 0, 0, 0, 0};
            random_state = 51 + b;
            for (uint32_t i = 0; i < rays; ++i) {
                struct gpu_ray ray = leaving_ray(vec3_load(balls[b].at), target_of(&soup), 0.4f, i);
                follow(&levels[l], accel, rational, &ray, &hunt);
            }
            tell(&levels[l], &hunt);
            assert_int_equal(hunt.exact_leaks, 0);
            assert_true(!levels[l].watertight || hunt.leaks == 0);
        }
        rational_destroy(rational);
        accel_destroy(accel);
        scene_destroy(scene);
        soup_finish(&soup);
    }
}

/* A vertex of the plane, or a point of an edge, that is not at its border. */
static struct vec3 inner_target(const struct soup *soup)
{
    for (;;) {
        struct vec3 p = target_of(soup);
        float far = 0.0f;
        for (int k = 0; k < 3; k += 2) {
            float middle =
                0.5f * (soup_vertex(soup, 0, 0)[k] + soup_vertex(soup, soup->count - 1, 1)[k]);
            far = fmaxf(far, fabsf((&p.x)[k] - middle));
        }
        if (far < 1.7f)
            return p;
    }
}

/* W2: Embree's plane, across its edges and vertices, from both sides. */
static void no_ray_passes_a_plane(void **state)
{
    (void)state;
    const struct bvh_params params = {0};
    const float at[3] = {148376, 1234, -223423};
    struct scene_mesh mesh;
    assert_int_equal(shape_plane(4.0, 4.0, 16, 1.0, &mesh), WHIT_OK);
    struct soup soup = soup_of_mesh("plane", &mesh);
    soup_move(&soup, at);
    struct scene *scene = soup_scene(&soup);
    struct accel *accel = soup_accel(scene, &params);
    struct rational *rational = rational_create(accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct hunt hunt = {"W2 plane at 148376 1234 -223423", 0, 0, 0, 0};
        random_state = 52;
        for (uint32_t i = 0; i < cases_of(RAYS); ++i) {
            struct vec3 from = vec3_add(vec3_load(at), random_point(1.5f));
            struct vec3 to = inner_target(&soup);
            from.y = at[1] + (i % 2 ? 1.0f : -1.0f) * (0.01f + random_float(&random_state));
            if (i % 4 == 0) /* down along the axis, or in the planes of boxes */
                from.x = to.x;
            if (i % 8 == 0)
                from.z = to.z;
            struct gpu_ray ray = ray_through(from, to);
            follow(&levels[l], accel, rational, &ray, &hunt);
        }
        tell(&levels[l], &hunt);
        assert_int_equal(hunt.exact_leaks, 0);
        assert_true(!levels[l].watertight || hunt.leaks == 0);
    }
    rational_destroy(rational);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

/* W3: a landscape of integers, rays down along the axis at vertices, edges and diagonals. */
static void no_ray_falls_through_a_grid(void **state)
{
    (void)state;
    enum { STEPS = 24 };
    const struct bvh_params params = {0};
    struct soup soup = soup_terrain(STEPS);
    for (uint32_t i = 0; i < 9 * soup.count; ++i)
        soup.positions[i] = i % 3 == 1 ? rintf(4.0f * soup.positions[i])
                                       : rintf((soup.positions[i] + 5.0f) * (float)STEPS / 10.0f);
    soup_box(&soup);
    struct scene *scene = soup_scene(&soup);
    struct accel *accel = soup_accel(scene, &params);
    struct rational *rational = rational_create(accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct hunt hunt = {"W3 rays along the axis of a grid", 0, 0, 0, 0};
        for (uint32_t i = 0; i < (4 * STEPS - 1) * (4 * STEPS - 1); ++i) {
            struct gpu_ray ray = {.dir = {0, i % 2 ? -1.0f : 1.0f, i % 3 ? 0.0f : -0.0f},
                                  .t_max = INFINITY};
            ray.origin[0] = 0.25f * (float)(1 + i % (4 * STEPS - 1));
            ray.origin[1] = i % 2 ? 1000.0f : -1000.0f;
            ray.origin[2] = 0.25f * (float)(1 + i / (4 * STEPS - 1));
            follow(&levels[l], accel, rational, &ray, &hunt);
        }
        tell(&levels[l], &hunt);
        assert_int_equal(hunt.exact_leaks, 0);
        assert_true(!levels[l].watertight || hunt.leaks == 0);
    }
    rational_destroy(rational);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

/* From inside a ring, across its hole. */
static struct gpu_ray ray_in_ring(void)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    vec3_store(ray.origin, vec3_add(random_point(0.2f), vec3_make(1, 0, 0)));
    vec3_store(ray.dir, random_point(1.0f));
    ray.dir[1] *= 0.1f;
    return ray;
}

struct parity {
    uint64_t rays, crossings, wrong, exact_wrong, other; /* other: lists that differ */
};

/* All hits of the ray, one after the other, beside those of fractions. */
static void count_crossings(const struct level *level, const struct accel *accel,
                            struct rational *rational, const struct gpu_ray *ray,
                            struct parity *parity)
{
    const struct traverse_params params = {
        .numerics = level->numerics, .skip_instance = HIT_NONE, .skip_primitive = HIT_NONE};
    uint32_t count = 0, exact_count = 0, status = 0;
    bool same = true;
    struct gpu_hit hit;
    struct rational_hit exact;
    struct rational_query query = {0};
    traverse_next(accel, &params, ray, NULL, &hit, &status);
    rational_trace(rational, ray, &query, &exact);
    while (hit.primitive != HIT_NONE || exact.primitive != HIT_NONE) {
        const struct rational_hit before = exact;
        same &= hit.primitive == exact.primitive && (!level->exact || hit.t == exact.t);
        query.behind = &before;
        if (exact.primitive != HIT_NONE && ++exact_count)
            rational_trace(rational, ray, &query, &exact);
        if (hit.primitive != HIT_NONE && ++count)
            traverse_next(accel, &params, ray, &hit, &hit, &status);
    }
    assert_int_equal(status, 0);
    ++parity->rays;
    parity->crossings += exact_count;
    parity->wrong += count % 2 == 0;
    parity->exact_wrong += exact_count % 2 == 0;
    parity->other += !same;
}

/* W5: a ray from inside a closed surface crosses it an odd number of times, exactly and at every
   level. Rays are not aimed: one through an edge may count both its triangles. */
static void crossings_are_odd(void **state)
{
    (void)state;
    const struct bvh_params params = {0};
    const uint32_t rays = cases_of(RAYS);
    struct scene_mesh mesh;
    assert_int_equal(shape_torus(1.0, 0.4, 48, 24, &mesh), WHIT_OK);
    struct soup soup = soup_of_mesh("torus", &mesh);
    struct scene *scene = soup_scene(&soup);
    struct accel *accel = soup_accel(scene, &params);
    struct rational *rational = rational_create(accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct parity parity = {0};
        random_state = 5;
        for (uint32_t i = 0; i < rays; ++i) {
            struct gpu_ray ray = ray_in_ring();
            count_crossings(&levels[l], accel, rational, &ray, &parity);
        }
        print_message("%-10s W5 even crossings: %llu of %llu rays, exactly %llu; %llu crossings, "
                      "%llu rays have others\n",
                      levels[l].name, (unsigned long long)parity.wrong,
                      (unsigned long long)parity.rays, (unsigned long long)parity.exact_wrong,
                      (unsigned long long)parity.crossings, (unsigned long long)parity.other);
        assert_true(parity.crossings > rays + rays / 4);
        assert_int_equal(parity.exact_wrong + parity.wrong, 0);
        assert_true(!levels[l].exact || parity.other == 0);
    }
    rational_destroy(rational);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

/* W6: a vertex beside the edge of a larger triangle, by some roundings: the crack is real. What
   leaks there is counted; elsewhere nothing does. */
static void only_t_junctions_leak(void **state)
{
    (void)state;
    const struct bvh_params params = {0};
    const float a[3] = {-1, -1, 0.1f}, b[3] = {1, -1, 0.3f}, c[3] = {1, 1.1f, 0.7f},
                d[3] = {-1, 1, 0.2f};
    const float middle[3] = {a[0] + 0.3f * (c[0] - a[0]), a[1] + 0.3f * (c[1] - a[1]) + 1e-6f,
                             a[2] + 0.3f * (c[2] - a[2])};
    struct soup soup = soup_make("t-junction", 3);
    soup_set(&soup, 0, a, b, c);
    soup_set(&soup, 1, a, middle, d);
    soup_set(&soup, 2, middle, c, d);
    soup_box(&soup);
    struct scene *scene = soup_scene(&soup);
    struct accel *accel = soup_accel(scene, &params);
    struct rational *rational = rational_create(accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct hunt seam = {"W6 at the edge of a T-junction", 0, 0, 0, 0};
        struct hunt sound = {"W6 at the edge below it", 0, 0, 0, 0};
        random_state = 6;
        for (uint32_t i = 0; i < RAYS; ++i) {
            struct vec3 from = vec3_add(random_point(0.5f), vec3_make(0, 0, 3)), target;
            float s = random_float(&random_state);
            target = vec3_add(vec3_load(a), vec3_scale(vec3_sub(vec3_load(c), vec3_load(a)), s));
            struct gpu_ray ray = ray_through(from, target);
            follow(&levels[l], accel, rational, &ray, &seam);
            target = vec3_add(vec3_load(middle),
                              vec3_scale(vec3_sub(vec3_load(d), vec3_load(middle)), s));
            ray = ray_through(from, target);
            if (s > 0.01f && s < 0.99f)
                follow(&levels[l], accel, rational, &ray, &sound);
        }
        tell(&levels[l], &seam);
        tell(&levels[l], &sound);
        assert_true(seam.exact_leaks > 0);
        assert_true(!levels[l].watertight || sound.leaks == 0);
        assert_int_equal(sound.exact_leaks, 0);
    }
    rational_destroy(rational);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

/* ---- Instances ---- */

static struct scene *instance_scene(struct soup *soup, uint32_t count, const struct affine *places)
{
    struct scene *scene = scene_begin(&silent, soup->name);
    uint32_t mesh = scene_put_mesh(scene, mesh_triangles(soup->positions, soup->count));
    for (uint32_t i = 0; i < count; ++i)
        scene_put_again(scene, mesh, &(struct put){.matrix = &places[i]});
    return scene_ready(scene);
}

static struct vec3 placed(const struct affine *place, struct vec3 p)
{
    const double from[3] = {(double)p.x, (double)p.y, (double)p.z};
    double to[3];
    affine_point(place, from, to);
    return vec3_make((float)to[0], (float)to[1], (float)to[2]);
}

/* W8: closed in object space, so closed wherever it is placed. */
static void no_ray_leaves_instances(void **state)
{
    (void)state;
    const double offsets[] = {0.0, 1e3, 1e5}, turn[4] = {0.3, -0.5, 0.2, 0.8};
    for (int o = 0; o < 3; ++o) {
        const double at[3] = {offsets[o], -offsets[o], offsets[o]}, scale[3] = {1.0, 1.25, -0.8};
        const struct affine place = affine_from_trs(at, turn, scale);
        struct soup soup = soup_sphere(32, 16);
        struct scene *scene = instance_scene(&soup, 1, &place);
        struct accel *accel = NULL;
        assert_int_equal(accel_create(&silent, scene, NULL, &accel), WHIT_OK);
        struct rational *rational = rational_create(accel);
        const struct vec3 middle = vec3_make((float)at[0], (float)at[1], (float)at[2]);
        for (int l = 0; l < LEVELS; ++l) {
            struct hunt hunt = {"W8 turned, mirrored instance", 0, 0, 0, 0};
            random_state = 8;
            for (uint32_t i = 0; i < cases_of(RAYS); ++i) {
                struct gpu_ray ray = leaving_ray(middle, placed(&place, target_of(&soup)), 0.3f, i);
                follow(&levels[l], accel, rational, &ray, &hunt);
            }
            tell(&levels[l], &hunt);
            assert_int_equal(hunt.exact_leaks, 0);
            assert_true(!levels[l].watertight || hunt.leaks == 0);
        }
        rational_destroy(rational);
        accel_destroy(accel);
        scene_destroy(scene);
        soup_finish(&soup);
    }
}

/* W9: two halves of a floor, turned alike and placed side by side. Each has its own ray, and so its
   own roundings: not promised, counted. */
static void edges_between_instances_are_counted(void **state)
{
    (void)state;
    const double turn[4] = {0.3, -0.5, 0.2, 0.8}, one[3] = {1, 1, 1}, zero[3] = {0, 0, 0};
    const float corner[3] = {0, -1, 0}, along[3] = {1, 0, 0}, up[3] = {0, 2, 0};
    struct affine places[2];
    places[0] = places[1] = affine_from_trs(zero, turn, one);
    for (int k = 0; k < 3; ++k) /* one to the left along its own x */
        places[1].m[4 * k + 3] = -places[0].m[4 * k];
    struct soup soup = soup_make("half a floor", 2);
    soup_quad(&soup, 0, corner, along, up);
    soup_box(&soup);
    struct scene *scene = instance_scene(&soup, 2, places);
    struct accel *accel = NULL;
    assert_int_equal(accel_create(&silent, scene, NULL, &accel), WHIT_OK);
    struct rational *rational = rational_create(accel);
    for (int l = 0; l < LEVELS; ++l) {
        struct hunt hunt = {"W9 edge between two instances", 0, 0, 0, 0};
        random_state = 9;
        for (uint32_t i = 0; i < RAYS; ++i) {
            struct vec3 target = vec3_make(0, 0.9f * random_within(1.0f), 0);
            struct vec3 from = vec3_add(random_point(0.5f), vec3_make(0, 0, 3));
            struct gpu_ray ray = ray_through(placed(&places[0], from), placed(&places[0], target));
            follow(&levels[l], accel, rational, &ray, &hunt);
        }
        tell(&levels[l], &hunt);
    }
    rational_destroy(rational);
    accel_destroy(accel);
    scene_destroy(scene);
    soup_finish(&soup);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_ray_leaves_closed_meshes),
        cmocka_unit_test(no_ray_passes_a_plane),
        cmocka_unit_test(no_ray_falls_through_a_grid),
        cmocka_unit_test(crossings_are_odd),
        cmocka_unit_test(only_t_junctions_leak),
        cmocka_unit_test(no_ray_leaves_instances),
        cmocka_unit_test(edges_between_instances_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
