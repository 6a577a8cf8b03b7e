/* The accuracy of hits in instances, compared with the same triangles transformed in double. */
#include "accel_fixture.h"
#include "unit.h"

static struct world sphere_world(const struct affine *matrices, uint32_t count)
{
    struct scene *scene = scene_begin(&silent, "instances");
    uint32_t sphere = scene_put_mesh(scene, mesh_sphere(1.0, 48, 32));
    for (uint32_t i = 0; i < count; ++i)
        scene_put_again(scene, sphere, &(struct put){.matrix = &matrices[i]});
    return world_of(scene, (whit_accel_params){0});
}

/* A corner and the normal of a triangle transformed in double; the normal is on the instance's
   side. */
static void world_plane(const struct scene *scene, const struct affine *matrix, uint32_t primitive,
                        double at[3], double normal[3])
{
    const struct scene_mesh *mesh = &scene->meshes[0];
    double v[3][3], e1[3], e2[3];
    for (size_t k = 0; k < 3; ++k) {
        const float *p = &mesh->positions[3 * (size_t)mesh->indices[3 * (size_t)primitive + k]];
        affine_point(matrix, (const double[3]){(double)p[0], (double)p[1], (double)p[2]}, v[k]);
    }
    for (int i = 0; i < 3; ++i) {
        at[i] = v[0][i];
        e1[i] = v[1][i] - v[0][i];
        e2[i] = v[2][i] - v[0][i];
    }
    double3_cross(e1, e2, normal);
    for (int i = 0; i < 3 && affine_determinant(matrix) < 0.0; ++i)
        normal[i] = -normal[i];
}

/* A ray from outside of the instance to a point in its unit sphere, rounded to floats. */
static struct gpu_ray aimed_ray(const struct affine *matrix, uint64_t *state)
{
    double from[3], to[3], size = 0.0;
    for (int i = 0; i < 3; ++i) {
        from[i] = random_signed(state);
        to[i] = 0.55 * random_signed(state);
        size += from[i] * from[i];
    }
    for (int i = 0; i < 3; ++i)
        from[i] *= 4.0 / sqrt(size);
    affine_point(matrix, from, from);
    affine_point(matrix, to, to);
    struct gpu_ray ray = {.t_max = INFINITY};
    for (int i = 0; i < 3; ++i) {
        ray.origin[i] = (float)from[i];
        ray.dir[i] = (float)(to[i] - (double)ray.origin[i]);
    }
    return ray;
}

struct errors {
    double t_mean, t_max; /* relative */
    double normal_max;    /* radians */
    uint32_t met;
};

enum { RAYS = 20000 };

static struct errors measure(const struct affine *matrix, uint32_t numerics)
{
    own_world world = sphere_world(matrix, 1);
    struct errors errors = {0};
    uint64_t state = 1;
    for (int i = 0; i < RAYS; ++i) {
        struct gpu_ray ray = aimed_ray(matrix, &state);
        struct gpu_hit hit =
            trace_with(world.accel, (struct traverse_params){.numerics = numerics}, &ray, NULL);
        if (hit.primitive == HIT_NONE)
            continue;
        double at[3], normal[3], d[3], across[3], to[3];
        double ng[3] = {(double)hit.ng_x, (double)hit.ng_y, (double)hit.ng_z};
        world_plane(world.scene, matrix, hit.primitive, at, normal);
        for (int k = 0; k < 3; ++k) {
            d[k] = (double)ray.dir[k];
            to[k] = at[k] - (double)ray.origin[k];
        }
        double t = double3_dot(to, normal) / double3_dot(d, normal),
               off = fabs((double)hit.t - t) / t;
        errors.t_mean += off;
        errors.t_max = fmax(errors.t_max, off);
        double3_cross(ng, normal, across);
        double angle = atan2(sqrt(double3_dot(across, across)), double3_dot(ng, normal));
        errors.normal_max = fmax(errors.normal_max, angle);
        ++errors.met;
    }
    errors.t_mean /= errors.met ? errors.met : 1;
    return errors;
}

static struct affine turned(double x, double y, double z, double sx, double sy, double sz)
{
    return affine_from_trs((const double[3]){x, y, z}, (const double[4]){0.3, -0.5, 0.2, 0.8},
                           (const double[3]){sx, sy, sz});
}

static const char *const level_names[] = {
    [NUMERICS_WATERTIGHT] = "watertight", [NUMERICS_EXACT] = "exact"};
static const uint32_t levels[] = {NUMERICS_WATERTIGHT, NUMERICS_EXACT};

/* `stretch`: ratio of the longest and the shortest axis in world space, if the matrix rotates. Each
   object coordinate is then a difference of large world coordinates. */
static void assert_precision(const char *what, struct affine matrix, double stretch)
{
    for (int l = 0; l < 2; ++l) {
        struct errors errors = measure(&matrix, levels[l]);
        print_message(
            "  %s, %s: t off by %.2g on average, %.2g at most, normals by %.2g rad, of %u "
            "hits\n",
            level_names[levels[l]], what, errors.t_mean, errors.t_max, errors.normal_max,
            errors.met);
        if (errors.met <= RAYS * 9 / 10 || errors.t_mean > 2e-7 * stretch ||
            errors.t_max > fmin(1e-4 * stretch, 4.0 * 0x1p-24 * stretch + 1e-4))
            fail_msg("%s", what);
    }
}

TEST(far_translations_keep_their_precision)
{
    assert_precision("at 0", turned(0, 0, 0, 1, 1, 1), 1);
    assert_precision("at 1e3", turned(1e3, -1e3, 0.5e3, 1, 1, 1), 1);
    assert_precision("at 1e5", turned(1e5, -1e5, 0.5e5, 1, 1, 1), 1);
    assert_precision("at 1e6", turned(1e6, -1e6, 0.5e6, 1, 1, 1), 1);
}

TEST(scales_keep_their_precision)
{
    struct affine straight = affine_identity();
    straight.m[5] = 1e2;
    straight.m[10] = 1e4;
    assert_precision("1e-6", turned(1e-6, 2e-6, 3e-6, 1e-6, 1e-6, 1e-6), 1);
    assert_precision("1e6", turned(1e6, 2e6, 3e6, 1e6, 1e6, 1e6), 1);
    assert_precision("1, 1e2, 1e4", straight, 1);
    assert_precision("1, 1e2, 1e4, turned", turned(1, 2, 3, 1, 1e2, 1e4), 1e4);
    assert_precision("mirrored", turned(1, 2, 3, -1, 1, 1), 1);
    assert_precision("mirrored twice", turned(1, 2, 3, -2, -1, 3), 3);
}

/* A ray from `away` that passes a corner of the unit box, turned by the matrix, along an axis or
   nearly so. Corners of the box around it are such corners. */
static struct gpu_ray grazing_ray(const struct affine *matrix, double away, uint64_t *state)
{
    struct gpu_ray ray = {.t_max = INFINITY};
    double corner[3], nudge = 1.0 + 0x1p-22 * random_signed(state);
    uint32_t axis = random_below(state, 3), tilted = random_below(state, 2);
    for (int i = 0; i < 3; ++i)
        corner[i] = random_below(state, 2) ? nudge : -nudge;
    affine_point(matrix, corner, corner);
    for (uint32_t i = 0; i < 3; ++i) {
        double along = i == axis ? 1.0 : tilted ? 1e-4 * random_signed(state) : 0.0;
        ray.origin[i] = (float)(corner[i] - away * along);
        ray.dir[i] = tilted ? (float)(corner[i] - (double)ray.origin[i]) : (float)along;
    }
    return ray;
}

/* The tree over instances must enter what the rays of its meshes hit. From far away the rounded
   transform of a ray moves it by more than the box of an instance is wide of it. */
TEST(rays_from_far_away_enter_what_they_hit)
{
    const struct affine shear = {.m = {1, 0.7, -2, 3, 0, 1, 0.4, -1, 0.3, 0, 1, 0}};
    const struct affine matrices[] = {
        turned(0, 0, 0, 1, 1, 1), turned(5, -2, 3, 2, 0.5, 1),
        affine_multiply(&shear, &(struct affine){.m = {3, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, 0}})};
    struct scene *scene = scene_begin(&silent, "boxes");
    uint32_t box = scene_put_mesh(scene, mesh_box(2, 2, 2)), met = 0, other = 0;
    for (int i = 0; i < 3; ++i)
        scene_put_again(scene, box, &(struct put){.matrix = &matrices[i]});
    own_world world = world_of(scene, (whit_accel_params){0});
    uint64_t random = 7;
    for (int i = 0; i < RAYS; ++i) {
        double away = pow(10.0, 1.0 + 7.0 * random_unit(&random));
        struct gpu_ray ray = grazing_ray(&matrices[i % 3], away, &random);
        struct traverse_params params = {.numerics = levels[i / 3 % 2]};
        struct gpu_hit tree = trace_with(world.accel, params, &ray, NULL);
        params.brute = true;
        struct gpu_hit brute = trace_with(world.accel, params, &ray, NULL);
        met += brute.primitive != HIT_NONE;
        other += !hits_equal(&tree, &brute);
    }
    print_message("  %u of %d rays hit, %u of them otherwise by the tree\n", met, RAYS, other);
    assert_true(met > RAYS / 4);
    assert_int_equal(other, 0);
}

/* A normal transformed by the matrix itself would be off by up to 36.87 degrees for diag(2, 1,
   1). */
TEST(normals_go_by_the_inverse_transpose)
{
    struct affine stretched = affine_identity(), sheared = turned(1, 2, 3, 2, 0.5, -1.5);
    struct affine shear = affine_identity();
    stretched.m[0] = 2.0;
    shear.m[1] = 0.8;
    shear.m[9] = -0.6;
    sheared = affine_multiply(&sheared, &shear);
    const struct affine all[] = {stretched, sheared};
    for (size_t i = 0; i < 4; ++i) {
        struct errors errors = measure(&all[i / 2], levels[i % 2]);
        print_message("  %s: normals off by %.2g rad at most, of %u hits\n",
                      level_names[levels[i % 2]], errors.normal_max, errors.met);
        assert_true(errors.met > RAYS * 9 / 10);
        assert_true(errors.normal_max < 1e-6);
    }
}

/* An identity matrix changes nothing but perhaps the sign of zeros. */
TEST(an_identity_is_no_transform)
{
    struct affine identity = affine_identity();
    own_world world = sphere_world(&identity, 1);
    uint64_t random = 3;
    uint32_t met = 0;
    for (int i = 0; i < 2 * RAYS; ++i) {
        struct gpu_ray ray = aimed_ray(&identity, &random);
        const struct traverse_params params = {.numerics = levels[i / 2 % 2]};
        if (i % 4 == 0)
            ray.dir[i / 4 % 3] = -0.0f;
        world.accel->single_identity = true;
        struct gpu_hit plain = trace_with(world.accel, params, &ray, NULL);
        world.accel->single_identity = false;
        struct gpu_hit moved = trace_with(world.accel, params, &ray, NULL);
        assert_memory_equal(&plain, &moved, offsetof(struct gpu_hit, ng_x));
        assert_true(plain.ng_x == moved.ng_x && plain.ng_y == moved.ng_y &&
                    plain.ng_z == moved.ng_z);
        met += plain.primitive != HIT_NONE;
    }
    print_message("  I9 0 of %u rays differ, %u hit\n", 2 * RAYS, met);
    assert_true(met > RAYS);
}

/* Checks the hit among instances in one place, at every traversal order, and that all of them were
   entered. */
static void assert_all_are_entered(const struct accel *accel, uint32_t count, uint32_t numerics,
                                   uint32_t rays)
{
    const struct affine identity = affine_identity();
    uint64_t random = 5, entered = 0;
    uint32_t depth = 0;
    for (uint32_t i = 0; i < rays; ++i) {
        const struct traverse_params params = {.order = i % 3, .numerics = numerics};
        struct gpu_ray ray = aimed_ray(&identity, &random);
        struct gpu_cost cost = {0};
        struct gpu_hit hit = trace_with(accel, params, &ray, &cost);
        assert_int_not_equal(hit.primitive, HIT_NONE);
        assert_int_equal(hit.instance, 0);
        assert_int_equal(cost.instances, count);
        entered += cost.instances;
        depth = cost.depth > depth ? cost.depth : depth;
    }
    print_message("  %s: %llu of %llu instances in one place entered by %u rays, depth %u\n",
                  level_names[numerics], (unsigned long long)entered,
                  (unsigned long long)count * rays, rays, depth);
}

/* Instances with equal boxes: none can be culled, and the first one is hit. With the label long
   there are a million of them. */
TEST(instances_in_one_place_are_all_entered)
{
    const char *many = getenv("WHIT_TEST_INSTANCES");
    const uint32_t count = many ? (uint32_t)atoi(many) : 10000;
    assert_true(count >= 10000);
    own_memory struct affine *matrices = malloc(count * sizeof *matrices);
    assert_non_null(matrices);
    for (uint32_t i = 0; i < count; ++i)
        matrices[i] = affine_identity();
    own_world world = sphere_world(matrices, count);
    const struct accel *accel = world.accel;
    /* The instance tree halves its instances at each level; 1 more for the mesh tree below. */
    assert_int_equal(accel->instance_node_count, 2 * count);
    assert_true(accel->instance_depth <= 1 + (uint32_t)ceil(log2(count)));
    const uint32_t rays = count > 100000 ? 6 : 21;
    assert_all_are_entered(accel, count, NUMERICS_WATERTIGHT, rays);
    assert_all_are_entered(accel, count, NUMERICS_EXACT, rays);
}
