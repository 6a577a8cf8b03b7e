/* Spheres on the device: hits equal those of the float mirror, pictures equal those of meshes that
   are finer than a pixel, and surfaces may be one-sided. */
#include "picture_fixture.h"
#include "ray_fixture.h"
#include "sphere_fixture.h"
#include "unit.h"

/* ---- Hits ---- */

static void check_twin(struct scene *scene, const whit_accel_params *params, const char *label)
{
    enum { RAYS = 100000 };
    own_fixture f = fixture_open(scene, params, NULL);
    own_memory struct gpu_ray *rays = array_alloc(RAYS, sizeof *rays);
    own_memory struct gpu_hit *hits = array_alloc(RAYS, sizeof *hits);
    assert_true(rays && hits);
    for (uint32_t i = 0; i < RAYS; ++i) {
        rays[i] = ray_at_spheres(&scene->meshes[0], i, 1000.0);
        rays[i].t_min = i % 5 == 0 ? 0.5f : 0.0f;
        rays[i].t_max = i % 7 == 0 ? 1.0f : INFINITY;
    }
    check_rays(&f, label, rays, RAYS, hits);
    assert_true(count_met(hits, RAYS) > RAYS / 4);
}

TEST(spheres_equal_twin)
{
    random_state = 11;
    struct scene *scene = scene_begin(&fixture_log, "spheres");
    scene_put(scene, scattered_spheres(300, 1.0, 0.3), NULL);
    check_twin(scene, NULL, "one mesh");
    scene = scene_begin(&fixture_log, "spheres");
    scene_put(scene, scattered_spheres(40, 1.0, 0.3), NULL);
    for (int i = 0; i < 12; ++i) {
        struct affine placed = placement_random(&random_state, 1.5, i % 3 == 0);
        scene_put_again(scene, 0, &(struct put){.matrix = &placed});
    }
    check_twin(scene, NULL, "instances");
}

/* The scene also has triangles in trees with clipped boxes. */
TEST_BY_TURNS(mixed_scene_equals_twin, 0, 2)
{
    random_state = 12;
    const whit_accel_params spatial = {.build = WHIT_BUILD_SPATIAL};
    struct scene *scene = scene_begin(&fixture_log, "spheres");
    scene_put_mesh(scene, scattered_spheres(60, 1.0, 0.3));
    scene_put_mesh(scene, mesh_torus(1.0, 0.3, 20, 10));
    for (uint32_t i = 0; i < 8; ++i) {
        struct affine placed = placement_random(&random_state, 1.0, i % 3 == 0);
        scene_put_again(scene, i % 2, &(struct put){.matrix = &placed});
    }
    check_twin(scene, &spatial, "spheres and rings");
}

/* ---- Pictures ---- */

/* A checker with a stripe across it, so that a picture turned or mirrored is another one. */
static uint32_t add_checker(struct scene *scene)
{
    enum { SIZE = 64 };
    uint8_t rgba[4 * SIZE * SIZE];
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) {
        uint32_t x = i % SIZE, y = i / SIZE;
        bool light = ((x / 8 + y / 8) & 1) != 0, stripe = x > 16 && x < 24 && y < 40;
        rgba[4 * i] = stripe ? 255 : light ? 220 : 60;
        rgba[4 * i + 1] = stripe ? 30 : light ? 210 : 90;
        rgba[4 * i + 2] = (uint8_t)(4 * y);
        /* Holes of a mask, in every other square. */
        rgba[4 * i + 3] = light ? 255 : 0;
    }
    return scene_put_texture(scene, SIZE, SIZE, rgba);
}

enum look { LOOK_TEXTURE, LOOK_MASK, LOOK_BUMP, LOOK_GLASS, LOOK_COUNT };

/* A scene of balls: of fine triangles (`fine`), or as sphere primitives. */
static struct scene *ball_scene(enum look look, bool fine, bool stretched)
{
    const double eye[3] = {0.4, 0.8, 3.6}, target[3] = {0, 0, 0};
    struct scene *scene = dark_scene(eye, target);
    struct scene_material m = material_plain("ball"), floor = material_plain("floor");
    struct scene_mesh mesh = {0};
    uint32_t checker = add_checker(scene);
    set_rgb(m.diffuse, 0.8f, 0.8f, 0.8f);
    set_rgb(floor.diffuse, 0.5f, 0.55f, 0.6f);
    if (look == LOOK_GLASS) {
        set_rgb(m.diffuse, 0, 0, 0);
        set_rgb(m.transmission, 0.9f, 0.95f, 1.0f);
        m.fresnel = true;
    } else {
        m.textures[look == LOOK_BUMP ? SCENE_SLOT_BUMP : SCENE_SLOT_DIFFUSE].texture = checker;
        m.alpha = look == LOOK_MASK ? SCENE_ALPHA_MASK : SCENE_ALPHA_OPAQUE;
        m.alpha_cutoff = 0.5f;
    }
    if (fine)
        mesh = mesh_sphere(1.0, 512, 256);
    else
        mesh = mesh_balls((const double[]){0, 0, 0, 1}, 1);
    const double t[3] = {0.1, 0.05, 0}, q[4] = {0.2, 0.3, 0.1, 0.9}, s[3] = {1.2, 0.7, 0.9};
    const double one[3] = {1, 1, 1};
    struct affine placed = affine_from_trs(t, q, stretched ? s : one);
    scene_put(scene, mesh, &(struct put){.material = &m, .matrix = &placed});
    scene_put(scene, mesh_plane(20.0), &(struct put){.material = &floor, .at = {0, -1.3, 0}});
    set_rgb(scene->environment.zenith, 0.2f, 0.3f, 0.6f);
    set_rgb(scene->environment.horizon, 0.8f, 0.8f, 0.8f);
    set_rgb(scene->environment.ground, 0.2f, 0.2f, 0.2f);
    scene_put_sun(scene, -0.5, -1.0, -0.6, 1.0f);
    return scene;
}

/* No smaller levels of textures: the angle of a surface decides the level, and at the rim that of
   triangles changes in steps. */
static const whit_renderer_params small = {
    .width = 64, .height = 48, .depth = 5, .minification = WHIT_MINIFICATION_NONE};

/* The triangles lie at most 1 - cos(pi / 256) = 8e-5 within the sphere, a hundredth of a pixel, so
   pixels whose middle is that near to an edge may differ: edges of the ball, its shadow and squares
   of the checker cross some 12 times the 64 columns, a hundredth of these makes 8. All others are
   off by what 8e-5 changes in texture coordinates, times the slope of bilinear texels (64 of up to
   0.8 in 2 pi: 6e-4), or in a normal (smooth ones: less), which glass multiplies by some 10. */
TEST_BY_TURNS(balls_look_like_fine_triangles, 1, 2)
{
    static const char *const names[LOOK_COUNT] = {"texture", "mask", "bump", "glass"};
    for (int look = 0; look < LOOK_COUNT; ++look) {
        bool stretched = look != LOOK_TEXTURE;
        own_image ball = color_of(ball_scene((enum look)look, false, stretched), NULL, &small);
        own_image fine = color_of(ball_scene((enum look)look, true, stretched), NULL, &small);
        uint32_t far = 0, lit = 0, pixels = ball.width * ball.height;
        double mean = 0.0;
        for (uint32_t i = 0; i < pixels; ++i) {
            double off = 0.0;
            for (uint32_t k = 0; k < 3; ++k) {
                off = fmax(off,
                           fabs((double)ball.pixels[4 * i + k] - (double)fine.pixels[4 * i + k]));
            }
            lit += ball.pixels[4 * i] > 0.0f;
            far += off > 0.004;
            mean += off / pixels;
        }
        print_message("  %s: %u of %u pixels differ by more than 0.004, %.2g on average\n",
                      names[look], far, pixels, mean);
        assert_true(lit > pixels / 2);
        assert_in_range(far, 0, 8);
    }
}

/* Light through a ball of glass is filtered where it enters and where it leaves. */
TEST_BY_TURNS(glass_filters_light_twice, 0, 2)
{
    for (int balls = 0; balls < 2; ++balls) {
        struct scene *scene = floor_scene(2);
        struct scene_material glass = matte(0, 0, 0);
        set_rgb(glass.transmission, 0.5f, 0.5f, 0.5f);
        if (balls) /* above the eye */
            add_object(scene, mesh_balls((double[]){0, 4, 0, 0.5}, 1), glass, 0, 0, 0);
        scene_put_sun(scene, 0, -1, 0, 1.0f);
        own_image image = color_of(scene, NULL, &picture_params);
        assert_near(middle(&image)[0], balls ? 0.25 : 1.0, 1e-6);
    }
}

/* ---- One-sided surfaces ---- */

enum { ONE_SIDED_BEHIND = 1, ONE_SIDED_MIRRORED = 2, ONE_SIDED_FLAT = 4 };

/* Looks down on a red leaf, at its front or its back, over a white floor under a sun above both.
   Gives the colours in the middle, and on the floor where the shadow of the leaf would fall. */
static void look_at_leaf(int how, bool one_sided, bool all, float seen[3], float *shadow)
{
    struct scene *scene = floor_scene(4);
    struct scene_material leaf = matte(1, 0, 0);
    leaf.one_sided = one_sided;
    const double up[3] = {0, 1, 0}, over[4] = {1, 0, 0, 0}, straight[4] = {0, 0, 0, 1};
    const double mirror[3] = {-1, 1, 1}, one[3] = {1, 1, 1};
    struct affine placed = affine_from_trs(up, how & ONE_SIDED_BEHIND ? over : straight,
                                           how & ONE_SIDED_MIRRORED ? mirror : one);
    scene_put(scene, mesh_plane(1.0), &(struct put){.material = &leaf, .matrix = &placed});
    scene_put_sun(scene, 0.6, -1, 0, 1.0f); /* moves the shadow 0.6 to the side */
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    whit_renderer_params params = picture_params;
    params.all_effects = all;
    own_image image = color_of(scene, how & ONE_SIDED_FLAT ? &flat : NULL, &params);
    memcpy(seen, middle(&image), 3 * sizeof(float));
    /* 0.9 to the right on the floor, beside the leaf and in its shadow: tan(0.3) * 4 = 1.24 is the
       edge of the picture. */
    *shadow = image.pixels[4 * (16 * 33 + 16 + 12)];
}

TEST_BY_TURNS(one_sided_leaves_are_not_seen_from_behind, 1, 2)
{
    for (int how = 0; how < 8; ++how) {
        float seen[3], shadow;
        bool behind = (how & ONE_SIDED_BEHIND) != 0;
        look_at_leaf(how, true, false, seen, &shadow);
        /* The white floor through the red leaf; light is stopped on both sides. */
        assert_true(seen[0] > 0.5f && (seen[1] > 0.5f) == behind);
        assert_true(shadow == 0.0f);
    }
    float seen[3], general[3], shadow;
    look_at_leaf(ONE_SIDED_BEHIND, true, false, seen, &shadow);
    look_at_leaf(ONE_SIDED_BEHIND, true, true, general, &shadow);
    assert_memory_equal(seen, general, sizeof seen);
    look_at_leaf(ONE_SIDED_BEHIND, false, false, seen, &shadow);
    assert_true(seen[0] > 0.5f && seen[1] == 0.0f);
}

/* From outside a one-sided ball shows its near side; from inside it is invisible. */
TEST(one_sided_balls_hide_their_inside)
{
    for (int inside = 0; inside < 2; ++inside) {
        struct scene *scene = dark_scene((double[]){0, 0, inside ? 0.5 : 4}, (double[]){0, 0, 0});
        struct scene_material m = unlit(1, 0, 0);
        m.one_sided = true;
        add_object(scene, mesh_balls((double[]){0, 0, 0, 1}, 1), m, 0, 0, 0);
        own_image image = color_of(scene, NULL, &picture_params);
        assert_true(middle(&image)[0] == (inside ? 0.0f : 1.0f));
    }
}
