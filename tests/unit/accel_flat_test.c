/* Compares the single-level tree, over all triangles in world space, with instances. */
#include "accel_fixture.h"

#include "accel/flat_choice.h"
#include "accel/pose.h"
#include "unit.h"

static struct scene *new_scene(void)
{
    struct scene *scene = scene_begin(&silent, "flat");
    struct scene_material glass = material_grey("glass");
    glass.transmission[0] = 0.5f;
    scene_put_material(scene, material_grey("grey"));
    scene_put_material(scene, glass);
    return scene;
}

/* A random matrix: rotated, scaled, mirrored (every third) and sheared. */
static struct affine random_matrix(uint64_t *state, uint32_t i)
{
    struct affine placed = placement_random(state, 6.0, i % 3 == 0), shear = affine_identity();
    shear.m[1] = 0.7 * random_signed(state);
    shear.m[6] = 0.5 * random_signed(state);
    return affine_multiply(&placed, &shear);
}

enum { OBJECTS = 40 };

static struct world mixed_world(whit_accel_params params)
{
    struct scene *scene = new_scene();
    uint64_t state = 7;
    scene_put_mesh(scene, mesh_sphere(1.0, 24, 16));
    scene_put_mesh(scene, mesh_wearing(mesh_sphere(1.0, 9, 6), 1));
    uint32_t empty = scene_put_mesh(scene, (struct scene_mesh){0});
    for (uint32_t i = 0; i < OBJECTS; ++i) {
        struct affine matrix = random_matrix(&state, i);
        scene_put_again(scene, i % 13 == 5 ? empty : i % 2,
                        &(struct put){.name = "object", .matrix = &matrix});
    }
    return world_of(scene, params);
}

static const whit_accel_params flatten = {.instances = WHIT_INSTANCES_OFF};

static struct gpu_ray random_ray(void)
{
    return ray_from_cube(9.0f, random_point(6.0f));
}

/* Cosine of the angle between the normals of two hits. */
static double normals_cosine(const struct gpu_hit *a, const struct gpu_hit *b)
{
    double x[3] = {(double)a->ng_x, (double)a->ng_y, (double)a->ng_z};
    double y[3] = {(double)b->ng_x, (double)b->ng_y, (double)b->ng_z};
    double xy = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    return xy / sqrt((x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) *
                     (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]));
}

struct comparison {
    uint32_t other, met;
    double t_off, cosine; /* the largest difference of t, the smallest cosine of normals */
};

static struct comparison compare(const struct accel *instanced, const struct accel *flat,
                                 uint32_t rays)
{
    struct comparison c = {.cosine = 1.0};
    for (uint32_t i = 0; i < rays; ++i) {
        struct gpu_ray ray = random_ray();
        struct gpu_hit a = trace(instanced, &ray), b = trace(flat, &ray);
        c.met += a.primitive != HIT_NONE;
        c.other += !same_ids(&a, &b);
        if (same_ids(&a, &b) && a.primitive != HIT_NONE) {
            c.t_off = fmax(c.t_off, fabs((double)a.t - (double)b.t));
            c.cosine = fmin(c.cosine, normals_cosine(&a, &b));
        }
    }
    return c;
}

TEST(hits_are_those_of_the_instances)
{
    enum { RAYS = 300000 };
    own_world instanced = mixed_world((whit_accel_params){0});
    own_accel *flat = accel_of(instanced.scene, flatten);
    random_state = 1;
    struct comparison c = compare(instanced.accel, flat, RAYS);
    print_message("  %u of %u rays hit another triangle, %u met one; t is off by up to %.2g, "
                  "1 - cosine of normals up to %.2g\n",
                  c.other, RAYS, c.met, c.t_off, 1.0 - c.cosine);
    assert_true(c.met > RAYS / 3);
    assert_true(c.other <= RAYS / 100000);
    assert_true(c.t_off < 1e-4); /* t is 1 at a distance of about 10; grazing hits differ most */
    assert_true(c.cosine > 1.0 - 1e-6);
}

TEST(builders_agree_bit_for_bit)
{
    static const whit_build builders[] = {WHIT_BUILD_MEDIAN, WHIT_BUILD_SWEEP, WHIT_BUILD_SPATIAL,
                                          WHIT_BUILD_NONE};
    own_world first = mixed_world(flatten);
    for (size_t b = 0; b < sizeof builders / sizeof *builders; ++b) {
        own_accel *accel =
            accel_of(first.scene,
                     (whit_accel_params){.build = builders[b], .instances = WHIT_INSTANCES_OFF});
        random_state = 3;
        assert_int_equal(accel->triangle_count, first.accel->triangle_count);
        assert_true(builders[b] != WHIT_BUILD_SPATIAL ||
                    accel->record_count > accel->triangle_count);
        for (uint32_t i = 0; i < cases_of(600); ++i) {
            struct gpu_ray ray = random_ray();
            struct gpu_hit x = trace(first.accel, &ray), y = trace(accel, &ray),
                           z = trace_brute(accel, &ray);
            assert_memory_equal(&x, &y, sizeof x);
            assert_memory_equal(&x, &z, sizeof x);
        }
    }
}

/* Checks that a record's vertices were placed in double and rounded once, as by `whit scene
   --triangles`. */
static void assert_placed(const struct scene *scene, const struct scene_pose *pose,
                          const struct gpu_triangle *record)
{
    uint32_t instance = record->flags >> TRIANGLE_INSTANCE_SHIFT;
    const struct scene_mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    const float *corners[3] = {record->v0, record->v1, record->v2};
    for (size_t i = 0; i < 3; ++i) {
        size_t vertex = mesh->indices[3 * (size_t)record->primitive + i];
        double world[3];
        for (size_t k = 0; k < 3; ++k)
            world[k] = (double)mesh->positions[3 * vertex + k];
        affine_point(&pose->instances[instance], world, world);
        for (size_t k = 0; k < 3; ++k)
            assert_true(corners[i][k] == (float)world[k]);
    }
}

TEST(records_say_whose_they_are)
{
    own_world world = mixed_world(
        (whit_accel_params){.build = WHIT_BUILD_SWEEP, .instances = WHIT_INSTANCES_OFF});
    const struct scene *scene = world.scene;
    const struct accel *accel = world.accel;
    uint32_t mirrored = 0, filters = 0;
    for (uint32_t i = 0; i < accel->record_count; ++i) {
        uint32_t flags = accel->triangles[i].flags;
        uint32_t instance = flags >> TRIANGLE_INSTANCE_SHIFT;
        assert_true(instance < OBJECTS);
        assert_placed(scene, &world.pose, &accel->triangles[i]);
        assert_int_equal((flags & TRIANGLE_MIRRORED) != 0,
                         affine_determinant(&world.pose.instances[instance]) < 0.0);
        assert_int_equal((flags & TRIANGLE_FILTER) != 0, scene->instances[instance].mesh == 1);
        mirrored += (flags & TRIANGLE_MIRRORED) != 0;
        filters += (flags & TRIANGLE_FILTER) != 0;
    }
    assert_true(mirrored > 0 && filters > 0);
    for (uint32_t i = 0; i < accel->instance_count; ++i) {
        assert_int_equal(accel->instances[i].mesh, scene->instances[i].mesh);
        assert_int_equal(
            accel->instances[i].shade_base,
            scene->instances[i].mesh
                ? scene->meshes[0].triangle_count +
                      (scene->instances[i].mesh > 1 ? scene->meshes[1].triangle_count : 0)
                : 0);
    }
}

TEST(a_pose_builds_anew)
{
    own_world world = mixed_world((whit_accel_params){0});
    own_accel *flat = accel_of(world.scene, flatten);
    struct scene_pose *pose = &world.pose;
    uint64_t seed = 11;
    random_state = 13;
    for (int step = 0; step < 5; ++step) {
        for (uint32_t i = 0; i < pose->instance_count; ++i)
            pose->instances[i] = random_matrix(&seed, i + (uint32_t)step);
        assert_int_equal(accel_pose(flat, pose), WHIT_OK);
        assert_int_equal(accel_pose(world.accel, pose), WHIT_OK);
        assert_int_equal(accel_validate(flat), WHIT_OK);
        struct comparison c = compare(world.accel, flat, 5000);
        assert_true(c.met > 1000 && c.other <= 1);
    }
    const struct gpu_bvh_node *nodes = flat->nodes;
    assert_int_equal(accel_pose(flat, pose), WHIT_OK);
    assert_ptr_equal(flat->nodes, nodes); /* nothing has moved */
    /* A pose that is refused changes nothing. */
    struct gpu_ray ray = random_ray();
    struct gpu_hit before = trace(flat, &ray), after;
    pose->instances[3].m[3] = 1e30;
    assert_int_equal(accel_pose(flat, pose), WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.last_error, "instance 3 `object`"));
    assert_int_equal(accel_validate(flat), WHIT_OK);
    after = trace(flat, &ray);
    assert_memory_equal(&before, &after, sizeof before);
}

TEST(broken_records_are_refused)
{
    own_world world = mixed_world(flatten);
    struct accel *accel = world.accel;
    struct gpu_triangle *triangle = &accel->triangles[accel->record_count / 2];
    const struct change changes[] = {
        {&triangle->flags, triangle->flags + (200u << TRIANGLE_INSTANCE_SHIFT)},
        {&triangle->flags, triangle->flags ^ (2u << TRIANGLE_INSTANCE_SHIFT)},
        {&triangle->primitive, triangle->primitive + 100000},
        {&triangle->v1[1], float_bits(triangle->v1[1] * 0.999f + triangle->v0[1] * 0.001f)},
        {&accel->meshes[0].depth, accel->meshes[0].depth + 1},
        {&accel->meshes[0].triangle_count, accel->meshes[0].triangle_count - 1},
        {&accel->nodes[2].hi[0], float_bits(accel->nodes[2].lo[0])},
    };
    check_changes(accel, changes, sizeof changes / sizeof *changes);
}

/* ---- The choice by WHIT_INSTANCES_AUTO ---- */

/* A mesh of triangles and a sphere of the same size, one instance each, placed by `place`. */
static struct scene *two_objects(const struct affine *place)
{
    const double ball[4] = {0, 0, 0, 1};
    struct scene *scene = new_scene();
    scene_put(scene, mesh_sphere(1.0, 8, 6), &(struct put){.matrix = place});
    scene_put(scene, mesh_balls(ball, 1), &(struct put){.matrix = place});
    return scene;
}

/* Takes ownership of the scene. */
static void takes_one_tree(const char *what, struct scene *scene, uint64_t memory_limit,
                           bool expected)
{
    own_pose pose;
    bool suits;
    scene_ready(scene);
    scene->memory_limit = memory_limit;
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_int_equal(accel_flat_suits(scene, &pose, &suits), WHIT_OK);
    if (suits != expected)
        fail_msg("%s: %s", what, suits ? "takes one tree" : "keeps its instances");
    scene_destroy(scene);
}

static struct affine moved_by(double x, double scale)
{
    struct affine place = affine_identity();
    place.m[0] = place.m[5] = place.m[10] = scale;
    place.m[3] = x;
    return place;
}

static struct scene *one_object(const struct affine *place)
{
    struct scene *scene = new_scene();
    scene_put(scene, mesh_sphere(1.0, 8, 6), &(struct put){.matrix = place});
    return scene;
}

static struct scene *with_another(struct scene *scene, uint32_t mesh)
{
    scene_put_again(scene, mesh, NULL);
    return scene;
}

TEST(a_scene_takes_one_tree_where_nothing_is_lost)
{
    struct affine aside = moved_by(3, 2), turned = moved_by(0, 1), there = moved_by(3, 2);
    turned.m[1] = there.m[1] = 0.5;
    takes_one_tree("moved objects", two_objects(&aside), 0, true);
    takes_one_tree("objects as they are", two_objects(NULL), 0, true);
    takes_one_tree("a sphere no more", two_objects(&turned), 0, false);
    takes_one_tree("no memory", two_objects(&aside), 1 << 10, false);
    takes_one_tree("nothing", new_scene(), 0, false);
    takes_one_tree("triangles twice", with_another(two_objects(&aside), 0), 0, false);
    takes_one_tree("a ball twice", with_another(two_objects(&aside), 1), 0, true);
    takes_one_tree("one object that is where it was", one_object(NULL), 0, false);
    takes_one_tree("one object that is moved", one_object(&there), 0, true);

    /* At distances from 256 times its longest side (2) on, an object's vertices are rounded too
       much. A mesh without a transform is not rounded at all. */
    struct affine near = moved_by(510, 1), far = moved_by(512, 1);
    takes_one_tree("near", two_objects(&near), 0, true);
    takes_one_tree("far", two_objects(&far), 0, false);
    struct scene *made_far = two_objects(NULL);
    scene_put(made_far, mesh_triangles((float[]){9e3f, 0, 0, 9e3f, 1, 0, 9e3f, 0, 1}, 1), NULL);
    takes_one_tree("made far away", made_far, 0, true);

    struct scene *moving = two_objects(NULL);
    scene_put_channel(moving, scene_put_node(moving, SCENE_NONE, 0, 0, 0), SCENE_PATH_TRANSLATION,
                      1, (float[]){0}, (float[]){0, 0, 0});
    takes_one_tree("what may move", moving, 0, false);
}

/* ---- Too many ---- */

/* `unused`: only one triangle of each sphere, among the vertices of all. */
static struct scene *many_spheres(uint32_t count, uint64_t memory_limit, bool unused)
{
    struct scene *scene = new_scene();
    uint32_t mesh = scene_put_mesh(scene, mesh_sphere(1.0, 150, 100));
    if (unused)
        scene->meshes[mesh].triangle_count = 1;
    for (uint32_t i = 0; i < count; ++i)
        scene_put_again(scene, mesh, NULL);
    scene_ready(scene);
    scene->memory_limit = memory_limit;
    return scene;
}

TEST(too_many_triangles_are_refused)
{
    static const struct {
        uint32_t spheres;
        uint64_t memory_limit;
        bool unused;
        const char *said, *also; /* NULL: nothing */
    } rows[] = {
        {5000, 0, false, "flat: its 148500000 triangles without instances are more", ""},
        {80000, 0, true, "flat: its 1220080000 vertices without instances are more", "1073741823"},
        {9, UINT64_C(16) << 20, false, "flat: its 267300 triangles without instances would take",
         "--memory-limit"},
        {9, UINT64_C(160) << 20, false, NULL, NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        own_scene *scene = many_spheres(rows[i].spheres, rows[i].memory_limit, rows[i].unused);
        own_accel *accel = NULL;
        whit_result result = accel_create(&silent, scene, &flatten, &accel);
        assert_int_equal(result, rows[i].said ? WHIT_ERROR_INPUT : WHIT_OK);
        assert_int_equal(accel == NULL, rows[i].said != NULL);
        if (rows[i].said && !(strstr(messages.last_error, rows[i].said) &&
                              strstr(messages.last_error, rows[i].also)))
            fail_msg("row %zu: said `%s`", i, messages.last_error);
    }
}
