/* B11, R1, R2, R8, U1, U7 and U14 of the catalogue: hits depend neither on the tree nor on the
   order of traversal, and any-hit and closest-hit queries agree. Compared bit for bit, at every
   level, with hits without a tree. tests/peers/equal.c does the same for scenes and devices. */
#include "hard_fixture.h"

#include "sphere_fixture.h"
#include "unit.h"

static const whit_accel_params trees[] = {
    {.build = WHIT_BUILD_BINNED},
    {.build = WHIT_BUILD_BINNED, .leaf_limit = 1, .bins = 5},
    {.build = WHIT_BUILD_BINNED, .leaf_limit = BVH_LEAF_MAX, .bins = 2, .optimize = true},
    {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 2},
    {.build = WHIT_BUILD_MEDIAN, .leaf_limit = 1, .optimize = true},
    {.build = WHIT_BUILD_SWEEP},
    {.build = WHIT_BUILD_SPATIAL},
    {.build = WHIT_BUILD_SPATIAL, .optimize = true},
    {.build = WHIT_BUILD_SPATIAL, .leaf_limit = 1, .spatial_budget = 4.0f, .spatial_alpha = 1e-9f},
    {.build = WHIT_BUILD_NONE},
};
enum { TREES = sizeof trees / sizeof *trees, ORDERS = 3 };

/* ---- Scenes ---- */

/* Each triangle of an integer terrain several times, shuffled, so that there are ties
   everywhere. */
static struct soup soup_layers(uint32_t layers)
{
    struct soup terrain = soup_landscape(8);
    struct soup soup = soup_make("layers", layers * terrain.count);
    for (uint32_t i = 0; i < soup.count; ++i) {
        uint32_t k = i * 7919u % terrain.count;
        soup_set(&soup, i, soup_vertex(&terrain, k, 0), soup_vertex(&terrain, k, 1),
                 soup_vertex(&terrain, k, 2));
    }
    soup_finish(&terrain);
    soup_box(&soup);
    return soup;
}

/* ---- Any tree, any order ---- */

struct counts {
    uint32_t rays, hits, differ, ends;
};

/* Compares hits at every order; `ends` counts rays for which any-hit and closest-hit disagree. */
static void try_orders(const struct level *level, const struct accel *accel,
                       const struct gpu_ray *ray, const struct gpu_hit *wanted,
                       struct counts *counts)
{
    for (uint32_t order = 0; order < ORDERS; ++order) {
        struct gpu_ray cut = *ray;
        bool met = wanted->primitive != HIT_NONE;
        struct gpu_hit hit = level_trace(level, accel, order, false, ray);
        counts->differ += !hits_equal(&hit, wanted);
        counts->ends += (level_trace(level, accel, order, true, ray).primitive != HIT_NONE) != met;
        if (!met)
            continue;
        cut.t_max = wanted->t;
        counts->ends += level_trace(level, accel, order, true, &cut).primitive == HIT_NONE;
        cut.t_max = nextafterf(wanted->t, -INFINITY);
        counts->ends += level_trace(level, accel, order, true, &cut).primitive != HIT_NONE;
    }
}

static struct gpu_ray ray_at_world(const struct world *world, uint32_t i)
{
    if (world->soup.count > 0)
        return soup_ray(&world->soup, &world->accel->meshes[0].box, i);
    if (world->scene->sphere_total > 0)
        return ray_at_spheres(&world->scene->meshes[0], i, 100.0);
    return ray_from_cube(1.0f, random_point(1.0f));
}

static void compare_trees(const struct level *level, const struct world *world,
                          struct accel *const accels[TREES], uint32_t rays, struct counts *counts)
{
    random_state = 17;
    for (uint32_t i = 0; i < rays; ++i) {
        struct gpu_ray ray = ray_at_world(world, i);
        struct gpu_hit wanted = level_brute(level, world->accel, &ray);
        ++counts->rays;
        counts->hits += wanted.primitive != HIT_NONE;
        for (uint32_t t = 0; t < TREES; ++t)
            try_orders(level, accels[t], &ray, &wanted, counts);
    }
}

/* Compares all kinds of trees on one world, which has trees of kind trees[0]; releases it. */
static void try_trees(struct world world)
{
    const uint32_t rays = cases_few(1200);
    bool empty = world.soup.count == 0 && world.scene->sphere_total == 0;
    struct accel *accels[TREES] = {world.accel};
    for (uint32_t t = 1; t < TREES; ++t) {
        accels[t] = accel_of(world.scene, trees[t]);
        assert_true(world.soup.count > 0 ||
                    accels[t]->record_count == accels[t]->triangle_count); /* spheres stay whole */
    }
    for (int l = 0; l < LEVELS; ++l) {
        struct counts counts = {0};
        compare_trees(&levels[l], &world, accels, rays, &counts);
        print_message("%-10s R1 %-11s %u of %u hits differ by tree or order; R8 %u any "
                      "hits are unlike closest ones; %u of %u rays hit\n",
                      levels[l].name, world.scene->name, counts.differ,
                      counts.rays * TREES * ORDERS, counts.ends, counts.hits, counts.rays);
        if (counts.differ + counts.ends > 0 || (empty ? counts.hits > 0 : counts.hits <= rays / 8))
            fail_msg("%s", world.scene->name);
    }
    for (uint32_t t = 1; t < TREES; ++t)
        accel_destroy(accels[t]);
    world_finish(&world);
}

/* B11, R1, R8, U14: also where a hit's t is below that of its box, by rounding. */
TEST(trees_and_orders_do_not_matter)
{
    random_state = 100;
    const struct soup soups[] = {
        soup_sphere(32, 16),     soup_terrain(20),
        soup_rooms(200),         soup_rooms(700),
        soup_hair(400, 0.01f),   soup_hair(1000, 1e-3f),
        soup_hair(300, 0.5f),    soup_exponential(200, 1.2),
        soup_garbage(300, 1e6f), soup_of_mesh("torus", mesh_torus(1.0, 0.4, 32, 16)),
        soup_layers(5),          soup_make("nothing", 0),
    };
    for (size_t s = 0; s < sizeof soups / sizeof *soups; ++s)
        try_trees(world_of_soup(soups[s], trees[0]));
}

/* Directions so long or so short that t is denormal, or next to the largest float. There boxes and
   keys are rounded by more than their share of t. */
TEST(keys_at_the_ends_of_floats_do_not_depend_on_the_tree)
{
    random_state = 11;
    own_world world = world_of_soup(soup_terrain(6), (whit_accel_params){.leaf_limit = 1});
    uint32_t met = 0, other = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        struct vec3 target = point_of_record(world.accel, i % 2), from = random_point(1.0f);
        struct gpu_ray ray = {.t_max = INFINITY};
        double t = i % 4 < 2 ? ldexp(1.0 + (double)random_below(&random_state, 4), -149)
                             : (double)FLT_MAX * (1.0 - 0x1p-24 * random_below(&random_state, 8));
        float scale = i % 4 < 2 ? 0x1p-24f : 0x1p20f; /* so that directions stay floats */
        vec3_store(ray.origin, vec3_add(target, vec3_scale(from, scale)));
        for (int k = 0; k < 3; ++k)
            ray.dir[k] = (float)(((double)(&target.x)[k] - (double)ray.origin[k]) / t);
        struct gpu_hit tree = level_trace(&levels[1], world.accel, ORDER_DISTANCE, false, &ray),
                       brute = level_brute(&levels[1], world.accel, &ray);
        met += brute.primitive != HIT_NONE;
        other += !hits_equal(&tree, &brute);
    }
    print_message("  %u of 20000 rays hit, %u of them otherwise by the tree\n", met, other);
    assert_true(met > 5000);
    assert_int_equal(other, 0);
}

/* Directions with denormal components, whose reciprocals may be infinite, at a tiny terrain, which
   they take a ray to in a finite t. */
TEST(denormal_directions_are_met_exactly)
{
    random_state = 12;
    struct soup soup = soup_terrain(6);
    for (uint32_t i = 0; i < 9 * soup.count; ++i)
        soup.positions[i] *= 0x1p-40f;
    soup_box(&soup);
    own_world world = world_of_soup(soup, (whit_accel_params){.leaf_limit = 1});
    own_rational *rational = rational_create(world.accel);
    uint32_t met = 0, other = 0;
    for (uint32_t i = 0; i < 20000; ++i) {
        struct vec3 to = point_of_record(world.accel, i % 2);
        struct gpu_ray ray = {.t_max = INFINITY};
        vec3_store(ray.origin, vec3_add(to, random_point(0x1p-40f)));
        if (i % 3 == 0)
            ray.origin[i / 3 % 3] = (&to.x)[i / 3 % 3] + 0x1p-10f; /* one component is normal */
        for (int k = 0; k < 3; ++k)
            ray.dir[k] = ((&to.x)[k] - ray.origin[k]) * 0x1p-94f;
        struct gpu_hit hit = level_trace(&levels[1], world.accel, i % ORDERS, false, &ray);
        struct rational_hit exact;
        rational_trace(rational, &ray, &(struct rational_query){.brute = true}, &exact);
        met += exact.primitive != HIT_NONE;
        other += hit.primitive != exact.primitive || hit.t != exact.t;
    }
    print_message("  %u of 20000 rays hit, %u of them otherwise at exact\n", met, other);
    assert_true(met > 5000);
    assert_int_equal(other, 0);
}

/* The same of spheres: as they are, in instances, and with rings beside them. */
TEST(trees_and_orders_of_spheres_do_not_matter)
{
    random_state = 1;
    for (int kind = 0; kind < 3; ++kind) {
        struct scene_mesh mesh = scattered_spheres(kind == 0 ? 300 : 40, 1.0, 0.3);
        struct scene *scene = sphere_scene(&silent, mesh, kind > 0);
        uint32_t ring = scene_put_mesh(scene, mesh_torus(1.0, 0.4, 16, 8));
        for (uint32_t i = 0; i < 4 && kind == 2; ++i) {
            struct affine matrix = placement_random(&random_state, 1.0, i % 3 == 0);
            scene_put_again(scene, ring, &(struct put){.matrix = &matrix});
        }
        try_trees(world_of(scene, trees[0]));
    }
}

static const float equal[3][3] = {{-1, -1, 0.5f}, {1.25f, -1, 0.25f}, {0, 1.5f, 0.125f}};

static struct soup soup_equal(uint32_t count)
{
    struct soup soup = soup_make("equal", count);
    for (uint32_t i = 0; i < count; ++i)
        soup_set(&soup, i, equal[0], equal[1], equal[2]);
    soup_box(&soup);
    return soup;
}

/* A ray at a vertex, the middle of an edge or a point inside, with the hit at t = 1; from all eight
   octants, so that order `sign` also visits the second node of every pair first. */
static struct gpu_ray ray_at_equal(uint32_t i)
{
    static const float weights[3][2] = {{0, 0}, {0.5f, 0}, {0.25f, 0.25f}};
    float target[3], from[3];
    for (int k = 0; k < 3; ++k) {
        target[k] = equal[0][k] + weights[i % 3][0] * (equal[1][k] - equal[0][k]) +
                    weights[i % 3][1] * (equal[2][k] - equal[0][k]);
        from[k] = target[k] + (k == 2 ? 2.0f : 1.0f) * (i / 3 >> k & 1 ? 1.0f : -1.0f);
    }
    return ray_through(vec3_load(from), vec3_load(target));
}

/* R2: among many triangles in one place the first is hit, inside, at edges and at vertices. */
TEST(the_first_of_equal_triangles_is_hit)
{
    const uint32_t counts[] = {2, 3, 10, 100, 1000};
    uint32_t rays[LEVELS] = {0}, others[LEVELS] = {0};
    for (size_t n = 0; n < sizeof counts / sizeof *counts * TREES; ++n) {
        own_world world = world_of_soup(soup_equal(counts[n / TREES]), trees[n % TREES]);
        for (int l = 0; l < LEVELS; ++l)
            for (uint32_t i = 0; i < 24 * ORDERS; ++i) {
                struct gpu_ray ray = ray_at_equal(i % 24);
                struct gpu_hit hit = level_trace(&levels[l], world.accel, i / 24, false, &ray);
                ++rays[l];
                others[l] += hit.primitive != 0 || fabsf(hit.t - 1.0f) > FLT_EPSILON ||
                             (levels[l].exact && hit.t != 1.0f);
            }
    }
    for (int l = 0; l < LEVELS; ++l) {
        print_message("%-10s R2 %u of %u rays at equal triangles hit another than the first\n",
                      levels[l].name, others[l], rays[l]);
        assert_int_equal(others[l], 0);
    }
}

/* U1: with many triangles in one place leaves are filled up to their limit, and not beyond. */
TEST(equal_triangles_are_shared_out)
{
    const uint32_t count = cases_times() > 1 ? 1000000 : 10000;
    for (uint32_t t = 0; t < TREES; ++t) {
        if (trees[t].spatial_budget > 0.0f || trees[t].build == WHIT_BUILD_NONE)
            continue; /* more than one record a triangle; no tree */
        own_world world = world_of_soup(soup_equal(count), trees[t]);
        const struct accel *accel = world.accel;
        uint32_t limit = trees[t].leaf_limit ? trees[t].leaf_limit : 4, largest = 0, held = 0;
        for (uint32_t n = 0; n < accel->meshes[0].node_count; ++n) {
            uint32_t in_leaf = bvh_count(&accel->nodes[accel->meshes[0].first_node + n]);
            largest = in_leaf > largest ? in_leaf : largest;
            held += in_leaf;
        }
        print_message("U1 builder %u: %u equal triangles, %u in the largest leaf, depth %u\n",
                      (uint32_t)trees[t].build, count, largest, accel->meshes[0].depth);
        assert_true(largest >= 1 && largest <= limit);
        assert_int_equal(held, count);
        assert_true(accel->meshes[0].depth <= 2 + (uint32_t)log2(count));
    }
}

/* Triangles with random bits as coordinates, among them NaN and infinity. */
static struct soup soup_bits(uint32_t count)
{
    struct soup soup = soup_make("bits", count);
    for (uint32_t i = 0; i < 9 * count; ++i) {
        uint32_t bits = random_bits(&random_state);
        if (i % 3) /* two of three get an exponent near that of 1, so that sizes match */
            bits = (bits & 0x807fffffu) | (0x7e + bits % 3) << 23;
        memcpy(&soup.positions[i], &bits, sizeof bits);
    }
    return soup;
}

/* Number of triangles whose indices are in range and whose vertices are below 1e18. */
static uint32_t count_usable(const struct scene_mesh *mesh)
{
    uint32_t usable = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; ++i) {
        bool good = true;
        for (uint32_t k = 0; k < 9 && good; ++k) {
            uint32_t vertex = mesh->indices[3 * i + k / 3];
            good = vertex < mesh->vertex_count &&
                   fabsf(mesh->positions[3 * (size_t)vertex + k % 3]) <= 1e18f;
        }
        usable += good;
    }
    return usable;
}

static struct scene *scene_of_bits(uint32_t meshes, uint32_t *usable)
{
    struct scene *scene = scene_begin(&silent, "bits");
    for (uint32_t i = 0; i < meshes; ++i) {
        struct soup soup = soup_bits(1 + random_below(&random_state, 40));
        struct scene_mesh mesh = mesh_triangles(soup.positions, soup.count);
        soup_finish(&soup);
        if (random_below(&random_state, 4) == 0)
            mesh.indices[random_below(&random_state, mesh.vertex_count)] =
                random_bits(&random_state);
        *usable += count_usable(&mesh);
        scene_put(scene, mesh, NULL);
    }
    return scene;
}

/* U5, U6, U7: a thousand scenes (label long) of twenty meshes with random bits. Unusable triangles
   are dropped, the others have a valid tree, and rays have the same hits with it as without. */
TEST(any_bits_have_trees)
{
    const uint32_t scenes = cases_times() > 1 ? 1000 : 40;
    uint32_t rays = 0, hits = 0, differ = 0, kept = 0, usable = 0;
    random_state = 7;
    for (uint32_t s = 0; s < scenes; ++s) {
        own_world world = world_of(scene_of_bits(20, &usable), trees[s % TREES]);
        const struct scene *scene = world.scene;
        kept += (uint32_t)scene->triangle_total;
        for (uint32_t m = 0; m < scene->mesh_count; ++m)
            assert_int_equal(count_usable(&scene->meshes[m]), scene->meshes[m].triangle_count);
        for (uint32_t i = 0; i < 40; ++i) {
            struct gpu_ray ray = ray_from_cube(2.0f, random_point(1.0f));
            struct gpu_hit wanted = level_brute(&levels[i % LEVELS], world.accel, &ray);
            struct gpu_hit hit =
                level_trace(&levels[i % LEVELS], world.accel, i % ORDERS, false, &ray);
            ++rays;
            hits += wanted.primitive != HIT_NONE;
            differ += !hits_equal(&hit, &wanted);
        }
    }
    print_message(
        "U7 %u scenes of any bits, %u of %u triangles kept: %u of %u rays differ by tree, "
        "%u hit\n",
        scenes, kept, usable, differ, rays, hits);
    assert_true(kept <= usable && usable - kept < usable / 1000); /* some have no area */
    assert_true(kept > scenes * 20 && hits > rays / 100);
    assert_int_equal(differ, 0);
}
