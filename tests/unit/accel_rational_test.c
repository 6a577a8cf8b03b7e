/* The rational oracle in whole scenes of triangles and spheres: with trees and filter, and without,
   it finds the first of all points in the order of hits. hard_triangle_test.c and
   hard_sphere_test.c test that these points are right. */
#include "accel_fixture.h"

#include "coordinate_fixture.h"
#include "owned_rational.h"
#include "sphere_fixture.h"
#include "unit.h"

/* ---- Hits by the definition, from all points ---- */

struct listing {
    const struct gpu_ray *world;
    const struct rational_query *query;
    struct rational_hit best;
    uint32_t count; /* number of points and ends of chords that count as hits */
};

static bool comes_before(const struct rational_hit *a, const struct rational_hit *b)
{
    if (a->t != b->t)
        return a->t < b->t;
    return a->instance != b->instance ? a->instance < b->instance : a->primitive < b->primitive;
}

static void list_point(struct listing *list, struct rational_hit point)
{
    if (!(point.t >= list->world->t_min && point.t <= list->world->t_max) ||
        (list->query->behind && !comes_before(list->query->behind, &point)))
        return;
    ++list->count;
    if (comes_before(&point, &list->best))
        list->best = point;
}

static void list_record(struct listing *list, struct rational *rational,
                        const struct gpu_triangle *record, const struct gpu_ray *ray,
                        uint32_t instance)
{
    const struct rational_hit *own = list->query->own;
    struct vec3 origin = vec3_load(ray->origin), dir = vec3_load(ray->dir);
    const struct vec3 v[3] = {vec3_load(record->v0), vec3_load(record->v1), vec3_load(record->v2)};
    struct rational_hit point = {.primitive = record->primitive, .instance = instance};
    bool is_own = own && own->instance == instance && own->primitive == record->primitive;
    struct rational_chord chord;
    if (!(record->flags & TRIANGLE_SPHERE)) {
        if (!is_own && rational_meet(rational, origin, dir, v, &point.t, &point.edges))
            list_point(list, point);
        return;
    }
    if (!rational_meet_sphere(rational, origin, dir, v[0], record->v1[0], &chord))
        return;
    is_own &= !list->query->behind;
    point.t = chord.near_key;
    if (chord.near_there && !is_own)
        list_point(list, point);
    point.t = chord.far_key;
    if (chord.far_there && (!is_own || chord.inward))
        list_point(list, point);
}

/* Finds the first hit in the order of the query by testing every record of every instance. `count`
   is the number of hits; a primitive that trees have split has several records, and counts for
   each. */
static struct rational_hit list_all(struct rational *rational, const struct accel *accel,
                                    const struct gpu_ray *ray, const struct rational_query *query,
                                    uint32_t *count)
{
    struct listing list = {ray, query, {INFINITY, HIT_NONE, HIT_NONE, 0}, 0};
    for (uint32_t i = 0; i < (accel->flat ? 1 : accel->instance_count); ++i) {
        const struct accel_mesh *mesh = &accel->meshes[accel->flat ? 0 : accel->instances[i].mesh];
        struct gpu_ray local = *ray;
        if (!accel->flat && !accel->single_identity)
            local = accel_local_ray(&accel->instances[i], ray);
        for (uint32_t k = 0; k < mesh->record_count && accel_ray_is_usable(&local); ++k) {
            const struct gpu_triangle *record = &accel->triangles[mesh->first_triangle + k];
            list_record(&list, rational, record, &local,
                        accel->flat ? record->flags >> TRIANGLE_INSTANCE_SHIFT : i);
        }
    }
    *count = list.count;
    return list.best;
}

/* ---- Scenes ---- */

/* Each triangle three times, once with reversed winding. */
static struct soup soup_thrice(uint32_t count)
{
    struct soup once = soup_scattered(count, 2.0f), soup = soup_make("thrice", 3 * count);
    for (uint32_t i = 0; i < count; ++i) {
        const float *a = soup_vertex(&once, i, 0), *b = soup_vertex(&once, i, 1),
                    *c = soup_vertex(&once, i, 2);
        soup_set(&soup, i, a, b, c);
        soup_set(&soup, count + i, c, b, a);
        soup_set(&soup, 2 * count + i, b, c, a);
    }
    soup_finish(&once);
    soup_box(&soup);
    return soup;
}

/* Releases the soup. `placed`: number of instances at random places; 0: one without a transform. */
static struct scene *scene_of(struct soup soup, uint32_t placed, double spread)
{
    struct scene *scene = scene_begin(&silent, soup.name);
    uint32_t mesh = scene_put_mesh(scene, mesh_triangles(soup.positions, soup.count));
    soup_finish(&soup);
    if (placed == 0)
        scene_put_again(scene, mesh, NULL);
    for (uint32_t i = 0; i < placed; ++i) {
        struct affine matrix = placement_random(&random_state, spread, i % 3 == 0);
        if (spread == 0.0) /* not turned: their corners are those of their boxes */
            matrix = affine_from_trs((double[]){3.0 * i, 0.0, 0.0}, (double[]){0, 0, 0, 1},
                                     (double[]){1.1, 0.7, 1.3});
        if (i % 5 == 4) /* stretched a thousandfold */
            for (size_t k = 0; k < 12; k += 4)
                matrix.m[k] *= 1e-3;
        scene_put_again(scene, mesh, &(struct put){.matrix = &matrix});
    }
    return scene;
}

static struct scene_mesh whole_spheres(uint32_t count)
{
    double spheres[4 * 64];
    for (uint32_t i = 0; i < 4 * count; ++i)
        spheres[i] = i % 4 == 3 ? 1.0 + random_below(&random_state, 3)
                                : (double)random_below(&random_state, 9) - 4.0;
    return mesh_balls(spheres, count);
}

/* Spheres of radius 1 stand at these places on the x axis: one alone, and two at one place. All
   else in a scene is at least 20 away from them. */
enum { ALONE = 40, TWINS = 50 };
static const double set_apart[12] = {ALONE, 0, 0, 1, TWINS, 0, 0, 1, TWINS, 0, 0, 1};

/* A scene of one sphere mesh without a transform, with the spheres set apart added to it. */
static struct scene *spheres_apart(struct scene_mesh mesh)
{
    double all[4 * 128];
    uint32_t count = mesh.sphere_count;
    for (uint32_t i = 0; i < 4 * count; ++i)
        all[i] = (double)mesh.spheres[i];
    memcpy(&all[4 * (size_t)count], set_apart, sizeof set_apart);
    scene_mesh_finish(&mesh);
    struct scene *scene = scene_begin(&silent, "spheres");
    scene_put(scene, mesh_balls(all, count + 3), NULL);
    return scene;
}

/* Instances with even numbers have spheres, the others a torus; the spheres set apart are added. */
static struct scene *mixed_scene(struct scene_mesh mesh, double spread, bool even_scale)
{
    struct scene *scene = scene_begin(&silent, "mixed");
    scene_put_mesh(scene, mesh);
    scene_put_mesh(scene, mesh_torus(1.0, 0.4, 12, 6));
    for (uint32_t i = 0; i < 9; ++i) {
        struct affine matrix = placement_random(&random_state, spread, i % 3 == 0);
        if (even_scale) {
            const double at[3] = {sphere_random(), sphere_random(), sphere_random()};
            matrix = affine_from_trs(at, (double[]){0, 0, 0, 1}, (double[]){0.7, 0.7, 0.7});
        }
        scene_put_again(scene, i % 2, &(struct put){.matrix = &matrix});
    }
    scene_put(scene, mesh_balls(set_apart, 3), &(struct put){.at = {spread}});
    return scene;
}

/* ---- Rays ---- */

/* A ray to a point of a record, from nearby or far away; in scenes of triangles a quarter of the
   rays is along an axis. */
static struct gpu_ray aimed_ray(const struct accel *accel, uint32_t index, float spread)
{
    struct vec3 target = point_of_record(accel, index), away = point_of(in_cube);
    bool along = index % 4 == 1 && accel->scene->sphere_total == 0;
    if (along)
        away = vec3_make(index % 12 == 1 ? 1.0f : 0.0f, index % 12 == 5 ? -1.0f : 0.0f,
                         index % 12 == 9 ? 1.0f : 0.0f);
    bool near = along || index % 4;
    return ray_through(vec3_add(target, vec3_scale(away, near ? spread : 1e4f * spread)), target);
}

/* A ray with an origin and a direction of integers: ends of chords tie, lines touch spheres,
   origins lie on spheres. */
static struct gpu_ray whole_ray(const struct accel *accel, uint32_t index, float spread)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    (void)accel;
    vec3_store(ray.origin, vec3_scale(point_of(of_grid), index % 3 ? 1.0f : spread));
    do
        vec3_store(ray.dir, point_of(of_grid));
    while (ray.dir[0] == 0.0f && ray.dir[1] == 0.0f && ray.dir[2] == 0.0f);
    if (index % 2)
        ray.dir[random_below(&random_state, 3)] = ray.dir[random_below(&random_state, 3)] = 0.0f;
    if (ray.dir[0] == 0.0f && ray.dir[1] == 0.0f && ray.dir[2] == 0.0f)
        ray.dir[index % 3] = -1.0f;
    return ray;
}

/* A ray into a sphere set apart, whose second hit is the far end of the same chord, since all other
   objects are farther away: it goes to within half a radius of the middle, from at least 1.5 radii
   away. `moved`: offset of these spheres along x. */
static struct gpu_ray ray_set_apart(float center, float moved)
{
    struct vec3 middle = vec3_make(moved + center, 0, 0);
    struct vec3 target = vec3_add(middle, vec3_scale(point_of(in_cube), 0.5f));
    return ray_through(vec3_add(vec3_add(middle, vec3_make(0, 2.5f, 0)), point_of(in_cube)),
                       target);
}

/* ---- Comparisons ---- */

struct tally {
    uint32_t rays, hits, steps, on_edges, ties, again, wrong;
};

static struct rational_hit compare(struct rational *rational, const struct accel *accel,
                                   const struct gpu_ray *ray, struct rational_query query,
                                   struct tally *tally)
{
    uint32_t count;
    struct rational_hit wanted = list_all(rational, accel, ray, &query, &count), hit;
    for (int brute = 0; brute < 2; ++brute) {
        query.brute = brute;
        query.any = false;
        rational_trace(rational, ray, &query, &hit);
        tally->wrong += hit.primitive != wanted.primitive || hit.instance != wanted.instance ||
                        hit.t != wanted.t || hit.edges != wanted.edges;
        query.any = true;
        rational_trace(rational, ray, &query, &hit);
        tally->wrong += (hit.primitive != HIT_NONE) != (count > 0) ||
                        (count > 0 && comes_before(&hit, &wanted));
    }
    ++tally->steps;
    tally->on_edges += wanted.edges > 0;
    return wanted;
}

/* Compares all hits along the ray in order, hits of rays that start at the first hit, and rays
   whose interval ends or begins there. */
static void compare_ray(struct rational *rational, const struct accel *accel, struct gpu_ray ray,
                        struct tally *tally)
{
    struct rational_query query = {0};
    struct rational_hit first = compare(rational, accel, &ray, query, tally), before, hit = first;
    ++tally->rays;
    if (first.primitive == HIT_NONE)
        return;
    ++tally->hits;
    for (int i = 0; i < 20 && hit.primitive != HIT_NONE; ++i) {
        before = hit;
        query = (struct rational_query){.behind = &before};
        hit = compare(rational, accel, &ray, query, tally);
        query.own = &hit;
        compare(rational, accel, &ray, query, tally);
        tally->ties += hit.primitive != HIT_NONE && hit.t == before.t;
        tally->again += hit.primitive == before.primitive && hit.instance == before.instance;
    }
    hit = compare(rational, accel, &ray, (struct rational_query){.own = &first}, tally);
    tally->again += hit.primitive == first.primitive && hit.instance == first.instance;
    struct gpu_ray cut = ray;
    cut.t_max = first.t;
    hit = compare(rational, accel, &cut, (struct rational_query){0}, tally);
    tally->wrong += hit.t != first.t;
    cut.t_min = first.t;
    hit = compare(rational, accel, &cut, (struct rational_query){0}, tally);
    tally->wrong += hit.t != first.t;
    ray.t_min = nextafterf(first.t, INFINITY);
    compare(rational, accel, &ray, (struct rational_query){0}, tally);
}

typedef struct gpu_ray (*ray_fn)(const struct accel *accel, uint32_t index, float spread);

/* `apart`: an eighth of the rays hits both ends of the single sphere, and an eighth the two spheres
   at one place, whose ends tie. Gives the number of hits on edges. */
static uint32_t compare_scene(const char *name, struct scene *scene, whit_accel_params params,
                              ray_fn make, uint32_t rays, float spread)
{
    own_world world = world_of(scene, params);
    own_rational *rational = rational_create(world.accel);
    struct tally tally = {0};
    bool apart = scene->sphere_total > 0;
    float moved = scene->node_count ? (float)scene->nodes[0].translation[0] : 0.0f;
    assert_non_null(rational);
    for (uint32_t i = 0; i < rays; ++i) {
        struct tally before = tally;
        if (i % 4 == 0 && apart) {
            compare_ray(rational, world.accel, ray_set_apart(i % 8 ? TWINS : ALONE, moved), &tally);
            assert_true(i % 8 ? tally.ties >= before.ties + 2 : tally.again >= before.again + 2);
        } else {
            compare_ray(rational, world.accel, make(world.accel, i, spread), &tally);
        }
    }
    print_message("%-20s %u wrong of %u answers: %u rays, %u hit; %u on edges, %u ties, a sphere "
                  "again %u\n",
                  name, tally.wrong, tally.steps, tally.rays, tally.hits, tally.on_edges,
                  tally.ties, tally.again);
    if (tally.wrong > 0 || tally.hits <= rays / 3)
        fail_msg("%s", name);
    return tally.on_edges;
}

static const whit_accel_params plain = {0}, flat = {.instances = WHIT_INSTANCES_OFF},
                               split = {.build = WHIT_BUILD_SPATIAL, .spatial_budget = 2.0f},
                               none = {.build = WHIT_BUILD_NONE};

TEST(triangles_are_found_by_trees_and_without)
{
    random_state = 21;
    const struct {
        const char *name;
        struct soup soup;
        uint32_t placed;
        double spread;
        const whit_accel_params *params;
        uint32_t rays;
    } rows[] = {
        {"sphere", soup_sphere(24, 12), 0, 0, &plain, 250},
        {"grid", soup_landscape(16), 0, 0, &plain, 250},
        {"thrice", soup_thrice(60), 0, 0, &plain, 250},
        {"exponential", soup_exponential(80, 1.3), 0, 0, &plain, 200},
        {"split hair", soup_hair(200, 0.01f), 0, 0, &split, 70},
        {"no tree", soup_terrain(8), 0, 0, &none, 200},
        {"placed spheres", soup_sphere(12, 6), 12, 3.0, &plain, 70},
        /* Seen from afar, roundings in object space move hits out of the boxes of instances. */
        {"placed cubes", soup_of_mesh("cube", mesh_box(1, 1, 1)), 12, 0.0, &plain, 1500},
        {"placed far apart", soup_sphere(12, 6), 12, 1e5, &plain, 70},
        {"flat spheres", soup_sphere(12, 6), 12, 3.0, &flat, 70},
        {"placed grids", soup_landscape(4), 20, 3.0, &split, 70},
    };
    uint32_t on_edges = 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i)
        on_edges +=
            compare_scene(rows[i].name, scene_of(rows[i].soup, rows[i].placed, rows[i].spread),
                          *rows[i].params, aimed_ray, cases_few(rows[i].rays), 4);
    assert_true(on_edges > cases_few(500));
}

TEST(spheres_are_found_by_trees_and_without)
{
    random_state = 31;
    const struct {
        const char *name;
        struct scene *scene;
        const whit_accel_params *params;
        ray_fn make;
        uint32_t rays;
        float spread;
    } rows[] = {
        {"scattered", spheres_apart(scattered_spheres(120, 1.0, 0.3)), &plain, aimed_ray, 600, 2},
        {"no tree", spheres_apart(scattered_spheres(40, 1.0, 0.3)), &none, aimed_ray, 300, 2},
        {"placed", mixed_scene(scattered_spheres(20, 1.0, 0.3), 1.5, false), &split, aimed_ray, 250,
         3},
        {"placed far apart", mixed_scene(scattered_spheres(20, 1.0, 0.3), 1e5, false), &plain,
         aimed_ray, 250, 3},
        {"flat", mixed_scene(scattered_spheres(20, 1.0, 0.3), 1.5, true), &flat, aimed_ray, 250, 3},
        {"whole numbers", spheres_apart(whole_spheres(40)), &plain, whole_ray, 1000, 20},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i)
        compare_scene(rows[i].name, rows[i].scene, *rows[i].params, rows[i].make,
                      cases_few(rows[i].rays), rows[i].spread);
}

/* ---- Primitives that the filter leaves out ---- */

/* The filter decides nearly all triangles of random rays, while aimed rays need integers. */
TEST(integers_are_for_hard_cases)
{
    own_world world = world_of_soup(soup_sphere(24, 12), (whit_accel_params){0});
    own_rational *random = rational_create(world.accel), *aimed = rational_create(world.accel);
    random_state = 5;
    for (uint32_t i = 0; i < 20000; ++i) {
        struct vec3 origin = point_of(in_cube);
        struct gpu_ray ray = ray_along(origin, point_of(in_cube));
        struct rational_hit hit;
        rational_trace(random, &ray, NULL, &hit);
        ray = aimed_ray(world.accel, 2 + 4 * i, 4);
        rational_trace(aimed, &ray, NULL, &hit);
    }
    struct rational_work all = rational_work(random), hard = rational_work(aimed);
    print_message("left to integers: of random rays %llu of %llu triangles, of aimed ones %llu of "
                  "%llu\n",
                  (unsigned long long)all.exact, (unsigned long long)all.primitives,
                  (unsigned long long)hard.exact, (unsigned long long)hard.primitives);
    assert_true(all.primitives > 20000 && all.exact * 1000 < all.primitives);
    assert_true(hard.exact > 1000);
}

static struct world world_of_ball(void)
{
    struct scene *scene = scene_begin(&silent, "sphere");
    scene_put(scene, mesh_balls((double[]){0, 0, 0, 1}, 1), NULL);
    return world_of(scene, plain);
}

/* The filter in double leaves out nearly all rays that miss a sphere but enter its box, and none of
   those that touch the sphere. */
TEST(doubles_leave_out_what_misses)
{
    own_world world = world_of_ball();
    struct accel *accel = world.accel;
    own_rational *rational = rational_create(accel);
    uint32_t hits = 0, touched = 0;
    random_state = 5;
    for (uint32_t i = 0; i < 20000; ++i) {
        struct vec3 origin = vec3_scale(point_of(in_cube), 4.0f);
        struct gpu_ray ray = ray_through(origin, point_of(in_cube));
        struct rational_hit hit;
        rational_trace(rational, &ray, NULL, &hit);
        hits += hit.primitive != HIT_NONE;
    }
    struct rational_work work = rational_work(rational);
    for (uint32_t i = 0; i < 20000; ++i) {
        float away = -1.0f - (float)random_below(&random_state, 4096);
        float scale = ldexpf(1.0f, (int)random_below(&random_state, 40) - 20);
        struct gpu_ray ray = {{1, away, 3 * away}, 0, {0, scale, 3 * scale}, INFINITY};
        struct rational_hit hit;
        rational_trace(rational, &ray, NULL, &hit);
        touched += hit.primitive == 0 && hit.t > 0.0f;
    }
    print_message("%u of 20000 hit, %llu of %llu spheres left to integers; %u of 20000 tangents "
                  "touch\n",
                  hits, (unsigned long long)work.exact, (unsigned long long)work.primitives,
                  touched);
    assert_true(work.primitives > work.exact + 1000 && work.exact < hits + 10);
    assert_int_equal(touched, 20000);
}

/* The least radius with which the line meets a sphere at `center`, by bisection over the bits of
   floats. */
static float min_radius(struct rational *rational, struct vec3 origin, struct vec3 dir,
                        struct vec3 center)
{
    uint32_t missed = 0, met = 0x7f7fffffu;
    float radius;
    struct rational_chord chord;
    while (met - missed > 1) {
        uint32_t middle = missed + (met - missed) / 2;
        memcpy(&radius, &middle, sizeof radius);
        if (rational_meet_sphere(rational, origin, dir, center, radius, &chord))
            met = middle;
        else
            missed = middle;
    }
    memcpy(&radius, &met, sizeof radius);
    return radius;
}

/* Rays from up to 2^27 radii away, where doubles cancel, hit spheres that they would miss if the
   radius were one float smaller. */
TEST(doubles_leave_out_nothing_that_is_hit)
{
    enum { RAYS = 10000 };
    own_world world = world_of_ball();
    struct accel *accel = world.accel;
    for (uint32_t i = 0; i < accel->node_count; ++i) { /* so that boxes exclude no ray */
        vec3_store(accel->nodes[i].lo, vec3_make(-FLT_MAX, -FLT_MAX, -FLT_MAX));
        vec3_store(accel->nodes[i].hi, vec3_make(FLT_MAX, FLT_MAX, FLT_MAX));
    }
    own_rational *rational = rational_create(accel);
    struct gpu_triangle *sphere = &accel->triangles[0];
    uint32_t missed = 0, met = 0, asked = 0;
    random_state = 9;
    for (uint32_t i = 0; i < RAYS; ++i) {
        struct gpu_ray ray = {.t_max = INFINITY};
        struct rational_hit hit;
        struct vec3 center = point_of(in_cube), aside = point_of(in_cube);
        float far = ldexpf(1.0f, (int)(i % 28));
        vec3_store(sphere->v0, center);
        vec3_store(ray.origin, vec3_scale(point_of(in_cube), far));
        vec3_store(ray.dir, vec3_sub(vec3_add(center, aside), vec3_load(ray.origin)));
        if (vec3_dot(vec3_sub(center, vec3_load(ray.origin)), vec3_load(ray.dir)) < 0.1f)
            continue; /* the sphere may be behind the origin */
        sphere->v1[0] = min_radius(rational, vec3_load(ray.origin), vec3_load(ray.dir), center);
        ++asked;
        rational_trace(rational, &ray, NULL, &hit);
        missed += hit.primitive == HIT_NONE;
        sphere->v1[0] = nextafterf(sphere->v1[0], 0.0f);
        rational_trace(rational, &ray, NULL, &hit);
        met += hit.primitive != HIT_NONE;
    }
    print_message("%u of %u rays that just hit missed, %u that just miss hit\n", missed, asked,
                  met);
    assert_true(asked > RAYS / 2);
    assert_int_equal(missed + met, 0);
}

TEST(senseless_rays_hit_nothing)
{
    own_world world = world_of_soup(soup_sphere(24, 12), (whit_accel_params){0});
    own_rational *rational = rational_create(world.accel);
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
        if (i / 2 == 6) /* a t_max of NaN sets no limit, as in traversal */
            assert_int_not_equal(hit.primitive, HIT_NONE);
        else
            assert_true(hit.primitive == HIT_NONE && hit.t == INFINITY);
    }
}
