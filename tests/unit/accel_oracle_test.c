/* The oracle in double: it is right where the answer is known, gives the same hits by tree and by
   brute force, and its margin explains every difference from the float mirror. */
#include "accel_fixture.h"

#include "oracle/oracle.h"
#include "sphere_fixture.h"
#include "unit.h"

/* ---- Scenes and rays ---- */

static struct world soup_world(void)
{
    random_state = 1;
    return world_of_soup(soup_scattered(400, 0.4f), (whit_accel_params){0});
}

static struct world sphere_world(void)
{
    return world_of_soup(soup_sphere(20, 20), (whit_accel_params){0});
}

/* Instances that are turned, stretched, mirrored and away from the origin, some overlapping. */
static struct world instances_in(whit_instances way)
{
    random_state = 2;
    struct scene *scene = scene_begin(&silent, "test");
    for (int i = 0; i < 12; ++i) {
        struct affine m = placement_random(&random_state, 1.0, i % 2 == 0);
        m.m[11] = i % 3 ? m.m[11] : 1000.0;
        own_soup soup = i % 2 ? soup_sphere(10, 10) : soup_scattered(50, 0.6f);
        scene_put(scene, mesh_triangles(soup.positions, soup.count), &(struct put){.matrix = &m});
    }
    return world_of(scene, (whit_accel_params){.instances = way});
}

static struct world instances_world(void)
{
    return instances_in(WHIT_INSTANCES_ON);
}

static struct world flat_world(void)
{
    return instances_in(WHIT_INSTANCES_OFF);
}

/* Spheres of triangles that are squashed askew: the roundings of a ray from far away in object
   space move it, in the world, by more than one of them is thick. */
static struct world squashed_world(uint32_t count)
{
    struct scene *scene = scene_begin(&silent, "squashed");
    uint32_t sphere = scene_put_mesh(scene, mesh_sphere(1.0, 10, 10));
    for (uint32_t i = 0; i < count; ++i) {
        const double at[3] = {0.1 * i, 0.2 * i, 0.0}, none[3] = {0, 0, 0}, one[3] = {1, 1, 1};
        const struct affine flat =
            affine_from_trs(at, (double[]){0.3, -0.5, 0.2, 0.8}, (double[]){1, 1, 1e-4});
        const struct affine askew = affine_from_trs(none, (double[]){0.1, 0.7, -0.4, 0.5}, one);
        const struct affine matrix = affine_multiply(&flat, &askew);
        scene_put_again(scene, sphere, &(struct put){.matrix = &matrix});
    }
    return world_of(scene, (whit_accel_params){.instances = WHIT_INSTANCES_ON});
}

static struct gpu_ray random_ray(const struct world *world, uint32_t i)
{
    bool far = world->accel->instance_count > 3 && i % 4 == 0;
    struct vec3 away = vec3_make(0, 0, far ? 1000.0f : 0.0f), from = random_point(3.0f);
    struct gpu_ray ray = ray_through(vec3_add(from, away), vec3_add(random_point(1.0f), away));
    if (i % 5 == 0)
        ray.t_min = 0.7f;
    if (i % 7 == 0)
        ray.t_max = 1.1f;
    if (i % 11 == 0)
        ray.dir[i % 3] = i % 2 ? 0.0f : -0.0f;
    return ray;
}

/* A ray through a vertex or a point of an edge of some triangle. */
static struct gpu_ray aimed_ray(const struct world *world, uint32_t i)
{
    struct vec3 target = point_of_record(world->accel, i % 2);
    return ray_through(vec3_add(target, random_point(2.0f)), target);
}

/* ---- Tree and brute force ---- */

static bool same_double(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The same trees without their nodes: brute force reads none. */
static struct accel without_nodes(const struct world *world)
{
    struct accel accel = *world->accel;
    accel.nodes = NULL;
    return accel;
}

static void assert_tree_is_brute(const struct world *world, const struct gpu_ray *ray)
{
    struct oracle_hit tree, brute;
    struct accel bare = without_nodes(world);
    oracle_trace(world->accel, ray, false, &tree);
    oracle_trace(&bare, ray, true, &brute);
    assert_int_equal(tree.primitive, brute.primitive);
    assert_int_equal(tree.instance, brute.instance);
    assert_true(same_double(tree.t, brute.t));
    assert_true(same_double(tree.u, brute.u) && same_double(tree.v, brute.v));
    assert_true(same_double(tree.second_t, brute.second_t));
    assert_true(fmin(fabs(tree.edge_margin), 1.0) == fmin(fabs(brute.edge_margin), 1.0));
}

TEST(tree_gives_what_brute_force_gives)
{
    struct world worlds[] = {soup_world(), sphere_world(), instances_world(), flat_world()};
    for (size_t w = 0; w < sizeof worlds / sizeof *worlds; ++w) {
        random_state = 3 + w;
        for (uint32_t i = 0; i < 1500; ++i) {
            struct gpu_ray ray = i % 3 ? random_ray(&worlds[w], i) : aimed_ray(&worlds[w], i);
            assert_tree_is_brute(&worlds[w], &ray);
        }
        world_finish(&worlds[w]);
    }
}

/* The tree must find what floats may hit, however much instances stretch their errors. */
TEST(squashed_instances_are_entered)
{
    for (uint32_t count = 1; count <= 3; count += 2) {
        own_world world = squashed_world(count);
        uint32_t doubtful = 0;
        random_state = 20 + count;
        for (uint32_t i = 0; i < 3000; ++i) {
            struct gpu_ray ray = ray_through(random_point(i % 2 ? 1e3f : 2.0f), random_point(3.0f));
            struct oracle_hit hit;
            assert_tree_is_brute(&world, &ray);
            oracle_trace(world.accel, &ray, false, &hit);
            doubtful += fabs(hit.edge_margin) < 1.0;
        }
        print_message("  %u of 3000 rays at %u squashed instances are in doubt\n", doubtful, count);
        assert_true(doubtful > 100 && doubtful < 2500);
    }
}

/* ---- The float mirror ---- */

struct tally {
    uint32_t rays, hits, differ, doubtful, off;
    double worst; /* largest error of t, as a share of its bound */
};

/* If the float mirror hits something else, the margin must allow it; else t must be within its
   error bound. */
static void compare_with_twin(const struct world *world, const struct gpu_ray *ray,
                              struct tally *tally)
{
    struct oracle_hit exact;
    struct accel bare = without_nodes(world);
    struct gpu_hit hit = trace_brute(&bare, ray), by_tree = trace(world->accel, ray);
    oracle_trace(world->accel, ray, false, &exact);
    assert_true(same_ids(&by_tree, &hit));
    bool differ = hit.primitive != exact.primitive || hit.instance != exact.instance;
    ++tally->rays;
    tally->hits += exact.primitive != HIT_NONE;
    tally->differ += differ;
    if (fabs(exact.edge_margin) < 1.0) {
        ++tally->doubtful;
    } else if (differ) {
        fail_msg("float %u, exact %u, but the margin is %g", hit.primitive, exact.primitive,
                 exact.edge_margin);
    } else if (hit.primitive != HIT_NONE) {
        double off = fabs((double)hit.t - exact.t) / exact.t_error;
        tally->worst = fmax(tally->worst, off);
        tally->off += off > 1.0;
    }
}

/* The margin does not excuse everything: nearly all random rays are certain, and aimed rays do give
   other answers within it. With spheres, rays are in doubt that graze one or hit two at one place;
   from far away all rays graze. */
static const struct {
    const char *name;
    struct world (*make)(void); /* NULL: scattered spheres of these sizes */
    double spread, radius, away;
    bool placed, aimed;
    uint32_t rays;
    double hits, doubtful_min, doubtful_max; /* shares of rays */
} scenes[] = {
    {"triangles", soup_world, 0, 0, 0, false, false, 20000, 0.05, 0, 0.005},
    {"triangles, aimed", soup_world, 0, 0, 0, false, true, 5000, 0, 0.1, 1},
    {"sphere", sphere_world, 0, 0, 0, false, false, 20000, 0.05, 0, 0.005},
    {"sphere, aimed", sphere_world, 0, 0, 0, false, true, 5000, 0, 0.1, 1},
    {"instances", instances_world, 0, 0, 0, false, false, 20000, 0.05, 0, 0.005},
    {"instances, aimed", instances_world, 0, 0, 0, false, true, 5000, 0, 0.1, 1},
    {"one tree", flat_world, 0, 0, 0, false, false, 20000, 0.05, 0, 0.005},
    {"one tree, aimed", flat_world, 0, 0, 0, false, true, 5000, 0, 0.1, 1},
    {"sizes of 1", NULL, 1.0, 0.3, 100.0, false, false, 40000, 0.25, 0, 0.2},
    {"stretched instances", NULL, 1.0, 0.3, 100.0, true, false, 40000, 0.25, 0, 0.25},
    {"radii from 1e-6", NULL, 1e-5, 1e-6, 100.0, false, false, 40000, 0.25, 0, 0.2},
    {"radii to 1e6", NULL, 1e7, 1e6, 100.0, false, false, 40000, 0.25, 0, 0.2},
    {"up to 1e6 radii away", NULL, 0.0, 1.0, 1e6, false, false, 40000, 0.25, 0, 0.1},
};

TEST(margins_explain_the_float_twin)
{
    for (size_t r = 0; r < sizeof scenes / sizeof *scenes; ++r) {
        random_state = 3;
        own_world world =
            scenes[r].make
                ? scenes[r].make()
                : world_of(sphere_scene(&silent,
                                        scattered_spheres(20, scenes[r].spread, scenes[r].radius),
                                        scenes[r].placed),
                           (whit_accel_params){0});
        struct tally tally = {0};
        for (uint32_t i = 0; i < cases_of(scenes[r].rays); ++i) {
            struct gpu_ray ray = !scenes[r].make
                                     ? ray_at_spheres(&world.scene->meshes[0], i, scenes[r].away)
                                 : scenes[r].aimed ? aimed_ray(&world, i)
                                                   : random_ray(&world, i);
            compare_with_twin(&world, &ray, &tally);
        }
        print_message("  %s: %u rays, %u hit; %u within error bounds of another answer, %u differ; "
                      "t at worst %.2f of its bound\n",
                      scenes[r].name, tally.rays, tally.hits, tally.doubtful, tally.differ,
                      tally.worst);
        if (tally.off > 0 || tally.hits < scenes[r].hits * tally.rays ||
            tally.doubtful < scenes[r].doubtful_min * tally.rays ||
            tally.doubtful > scenes[r].doubtful_max * tally.rays || tally.differ > tally.doubtful ||
            (scenes[r].aimed && tally.differ == 0))
            fail_msg("%s", scenes[r].name);
    }
}

/* ---- Known answers ---- */

static const float unit_triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/* One ray passes the triangle by so little that the float test may be wrong; coordinates this small
   are exact. */
TEST(one_triangle_is_known)
{
    static const struct {
        const char *name;
        float x, t_min, t_max;
        bool met;
        double margin_lo, margin_hi;
    } rows[] = {
        {"inside", 0.25f, 0.0f, INFINITY, true, 1e4, INFINITY},
        {"the interval is closed", 0.25f, 0.0f, 2.0f, true, -1.0, 1.0},
        {"it ends before", 0.25f, 0.0f, 1.99f, false, -INFINITY, INFINITY},
        {"it begins behind", 0.25f, 2.01f, INFINITY, false, -INFINITY, INFINITY},
        {"beside", -1e-7f, 0.0f, INFINITY, false, -INFINITY, -1.0},
        {"on the edge", 0.0f, 0.0f, INFINITY, true, -1.0, 1.0},
    };
    struct scene *scene = scene_begin(&silent, "test");
    scene_put(scene, mesh_triangles(unit_triangle, 1), NULL);
    own_world world = world_of(scene, (whit_accel_params){0});
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        const struct gpu_ray ray = {
            {rows[i].x, 0.5f, 4.0f}, rows[i].t_min, {0, 0, -2}, rows[i].t_max};
        struct oracle_hit hit;
        oracle_trace(world.accel, &ray, i == 4, &hit);
        bool right = hit.primitive == (rows[i].met ? 0 : HIT_NONE) &&
                     hit.t == (rows[i].met ? 2.0 : (double)INFINITY) &&
                     hit.edge_margin >= rows[i].margin_lo && hit.edge_margin <= rows[i].margin_hi;
        if (rows[i].met)
            right &= hit.instance == 0 && hit.u == (double)rows[i].x && hit.v == 0.5 &&
                     hit.second_t == (double)INFINITY;
        if (!right)
            fail_msg("%s: t %g, margin %g", rows[i].name, hit.t, hit.edge_margin);
    }
}

TEST(ties_go_to_the_smaller_index)
{
    float corners[27];
    for (int i = 0; i < 27; ++i)
        corners[i] = unit_triangle[i % 9];
    struct scene *scene = scene_begin(&silent, "test");
    scene_put(scene, mesh_triangles(corners, 3), NULL);
    scene_put(scene, mesh_triangles(corners, 3), NULL);
    own_world world = world_of(scene, (whit_accel_params){0});
    struct gpu_ray ray = {{0.25f, 0.25f, 1.0f}, 0.0f, {0, 0, -1}, INFINITY};
    for (int brute = 0; brute < 2; ++brute) {
        struct oracle_hit hit;
        oracle_trace(world.accel, &ray, brute, &hit);
        assert_int_equal(hit.instance, 0);
        assert_int_equal(hit.primitive, 0);
        assert_true(hit.second_t == hit.t);
        assert_true(hit.edge_margin == 0.0);
    }
}

/* Rays along each axis, from both sides and with components 0 and -0, hit a square across that axis
   at its middle, its borders and its corners. They lie in faces of its box (B3 of the catalogue of
   hard cases). */
TEST(borders_are_met_along_the_axes)
{
    uint32_t rays = 0, missed = 0;
    for (uint32_t axis = 0; axis < 3; ++axis) {
        const uint32_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        float corners[18] = {0};
        for (uint32_t i = 0; i < 6; ++i) {
            uint32_t corner = (const uint32_t[]){0, 1, 2, 0, 2, 3}[i];
            corners[3 * i + axis] = 0.5f;
            corners[3 * i + u] = corner == 1 || corner == 2 ? 3.0f : -1.0f;
            corners[3 * i + v] = corner >= 2 ? 3.0f : -1.0f;
        }
        struct scene *scene = scene_begin(&silent, "test");
        scene_put(scene, mesh_triangles(corners, 2), NULL);
        own_world world = world_of(scene, (whit_accel_params){0});
        for (uint32_t way = 0; way < 9 * 8; ++way) {
            struct gpu_ray ray = {.t_max = INFINITY};
            float side = way & 1 ? 1.0f : -1.0f;
            ray.origin[axis] = 0.5f - 4.0f * side;
            ray.origin[u] = (float)(way / 8 % 3) * 2.0f - 1.0f;
            ray.origin[v] = (float)(way / 24) * 2.0f - 1.0f;
            ray.dir[axis] = side;
            ray.dir[u] = way & 2 ? -0.0f : 0.0f;
            ray.dir[v] = way & 4 ? -0.0f : 0.0f;
            missed += trace(world.accel, &ray).t != 4.0f;
            ++rays;
        }
    }
    print_message("  %u of %u rays miss\n", missed, rays);
    assert_int_equal(missed, 0);
}

TEST(senseless_rays_hit_nothing)
{
    own_world world = sphere_world();
    const struct gpu_ray rays[] = {
        {{0, 0, 0}, 0, {0, 0, 0}, INFINITY},         {{NAN, 0, 0}, 0, {0, 0, 1}, INFINITY},
        {{0, 0, 0}, 0, {0, INFINITY, 1}, INFINITY},  {{0, 0, 0}, 2, {0, 0, 1}, 1},
        {{0, 0, 0}, NAN, {0.1f, 0.2f, 1}, INFINITY}, {{0, 0, 0}, 0, {0.1f, 0.2f, 1}, -1},
    };
    for (size_t i = 0; i < sizeof rays / sizeof *rays; ++i) {
        struct oracle_hit hit;
        oracle_trace(world.accel, &rays[i], false, &hit);
        assert_int_equal(hit.primitive, HIT_NONE);
        assert_tree_is_brute(&world, &rays[i]);
    }
}
