/* Shadows through textured and absorbing filters, on smooth meshes, and on shadow catchers. */
#include "picture_fixture.h"
#include "unit.h"

static const double eye_height = 8.0, view = 0.6; /* see dark_scene */
/* Depths of filters are rounded to multiples of 1/64 stop, those of absorption to 1/256 stop, so
   that they are off by half of it at most. */
static const double half_a_step = 0.5 / 64.0 * 0.69314718056,
                    absorbed_half_a_step = 0.5 / 256.0 * 0.69314718056;

/* The sun is at 45 degrees, so that the camera sees the shadow of the pane, but not the pane. */
static struct scene *pane_scene(bool blends)
{
    struct scene *scene = floor_scene(eye_height);
    struct scene_material m = material_plain("pane");
    m.thin_walled = true;
    if (blends) {
        m.alpha = SCENE_ALPHA_BLEND;
        m.opacity = 1.0f;
        use_texture(&m, SCENE_SLOT_OPACITY, add_two_texels(scene, 0, 191));
    } else {
        set_rgb(m.transmission, 1.0f, 0.5f, 0.0f);
        use_texture(&m, SCENE_SLOT_TRANSMISSION, add_two_texels(scene, 255, 64));
    }
    add_object(scene, mesh_plane(2), m, -5, 5, 0);
    scene_put_sun(scene, 1, -1, 0, 1.0f);
    return scene;
}

static void check_pane(bool blends)
{
    const whit_renderer_params params = {.width = 201, .height = 201, .depth = 2};
    own_image image = color_of(pane_scene(blends), NULL, &params);
    uint32_t clear = 0, dark = 0, changes = 0;
    for (uint32_t x = 0; x < image.width; ++x) {
        double at = ((x + 0.5) / image.width * 2.0 - 1.0) * eye_height * tan(view / 2.0);
        const float *pixel = &image.pixels[4 * ((size_t)image.height / 2 * image.width + x)];
        if (fabs(at) > 0.97) {
            if (fabs(at) > 1.03)
                assert_near(pixel[0], sqrt(0.5), 2e-6);
            continue;
        }
        if (fabs(at) < 0.03)
            continue;
        bool is_clear = (double)pixel[0] > 0.5 * sqrt(0.5);
        double texel = blends ? 1.0 - 191.0 / 255.0 : 64.0 / 255.0;
        clear += is_clear;
        dark += !is_clear;
        assert_near(pixel[0], sqrt(0.5) * (is_clear ? 1.0 : texel), half_a_step + 2e-6);
        if (!blends) {
            assert_near(pixel[1], sqrt(0.5) * (is_clear ? 0.5 : 0.5 * texel), half_a_step + 2e-6);
            assert_true(pixel[2] == 0.0f);
        }
        changes += x > 0 && (pixel[0] > 0.6f) != (pixel[-4] > 0.6f);
    }
    /* One half each, side by side. */
    assert_true(clear > 30 && dark > 30 && abs((int)clear - (int)dark) <= 2 && changes <= 1);
}

TEST_BY_TURNS(textures_pattern_shadows, 0, 4)
{
    for (int blends = 0; blends < 2; ++blends)
        check_pane(blends);
}

static const float sigma[3] = {0.3f, 0.7f, 1.5f};

/* A block of glass with index 1, `height` high, with its middle at `y`, above the floor or around
   it, and a light above it or in it. */
struct block {
    const char *name;
    double height, y;
    const whit_camera *camera;
    double sun[3], lamp; /* direction of a sun, height of a lamp; the one that is not 0 is used */
    float strength;
    double light;  /* light that reaches the floor without absorption */
    double length; /* of the light's way through the glass */
    double seen;   /* length of the camera ray's way through the glass */
};

static struct scene *block_scene(const struct block *block, float density)
{
    struct scene *scene = floor_scene(eye_height);
    struct scene_material m = matte(0, 0, 0);
    set_rgb(m.transmission, 1, 1, 1);
    set_rgb(m.absorption, density * sigma[0], density * sigma[1], density * sigma[2]);
    m.ior = 1.0f;
    add_object(scene, mesh_box(6, block->height, 6), m, 0, block->y, 0);
    if (block->lamp > 0)
        scene_put_lamp(scene, 0, block->lamp, 0, block->strength);
    else
        scene_put_sun(scene, block->sun[0], block->sun[1], block->sun[2], block->strength);
    return scene;
}

/* The share exp(-sigma length) of the light arrives, within 1/256 stop for rounding at each end of
   the way through the glass. */
TEST_BY_TURNS(bodies_absorb_along_the_way, 1, 4)
{
    /* The first is under the block. */
    static const whit_camera beside = CAMERA_AT(3.9, 0.3, 0, 0, 0, 0, 0, 1, 0, 0.01),
                             above = CAMERA_AT(0, 8, 0, 0, 0, 0, 0, 0, -1, 0.01);
    const double slant = sqrt(1.25);
    const struct block blocks[] = {
        {"sun", 1, 2, &beside, {0, -1, 0}, 0, 2, 2, 1, 0},
        {"slanting sun", 1, 2, &beside, {1, -2, 0}, 0, 2, 2 / slant, slant, 0},
        {"lamp", 1, 2, &beside, {0}, 5, 50, 2, 1, 0},
        {"lamp far above", 1, 2, &beside, {0}, 1e7, 2e14f, 2, 1, 0},
        {"lamp inside", 2, 2, &beside, {0}, 2, 8, 2, 1, 0},
        {"sun on the floor inside", 2, 0, &above, {0, -1, 0}, 0, 2, 2, 1, 1},
        {"lamp on the floor inside", 2, 0, &above, {0}, 2, 8, 2, 1, 1},
        {"lamp and floor inside", 2, 0, &above, {0}, 0.5, 0.5f, 2, 0.5, 1},
    };
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i) {
        const struct block *b = &blocks[i];
        const whit_renderer_params params = {
            .width = 1, .height = 1, .depth = 4, .camera = *b->camera};
        own_image image = color_of(block_scene(b, 1.0f), NULL, &params);
        own_image dark = color_of(block_scene(b, 1e10f), NULL, &params);
        print_message("  %s\n", b->name);
        for (int c = 0; c < 3; ++c) {
            assert_near(image.pixels[c], b->light * exp(-(double)sigma[c] * (b->length + b->seen)),
                        2.0 * absorbed_half_a_step + 1e-5);
            assert_near(dark.pixels[c], 0.0, 1e-5);
        }
    }
}

/* The light that a thin body of 500 a unit takes is a difference of two depths of half a million.
 */
TEST(dense_bodies_keep_their_shadows)
{
    const whit_renderer_params params = {.width = 1,
                                         .height = 1,
                                         .depth = 4,
                                         .camera = CAMERA_AT(3.9, 0.3, 0, 0, 0, 0, 0, 1, 0, 0.01)};
    struct scene *scene = dark_scene((double[]){0, 8, 0}, (double[]){0, 0, 0});
    struct scene_material m = matte(0, 0, 0);
    set_rgb(m.transmission, 1, 1, 1);
    set_rgb(m.absorption, 500, 500, 500);
    m.ior = 1.0f;
    add_object(scene, mesh_plane(20000), matte(1, 1, 1), 0, 0, 0);
    add_object(scene, mesh_box(6, 0.01, 6), m, 0, 2, 0);
    scene_put_lamp(scene, 0, 1000, 0, 1e6f);
    own_image image = color_of(scene, NULL, &params);
    assert_near(image.pixels[0], exp(-5), 0.1);
}

TEST_BY_TURNS(knobs_make_shadows_opaque, 2, 4)
{
    for (int all = 0; all < 2; ++all) {
        whit_renderer_params params = {.width = 201, .height = 1, .shadows = WHIT_SHADOWS_OPAQUE};
        params.all_effects = all;
        params.camera = (whit_camera)CAMERA_AT(0, 8, 0, 0, 0, 0, 0, 0, -1, 0.17);
        for (int blends = 0; blends < 2; ++blends) {
            own_image image = color_of(pane_scene(blends), NULL, &params);
            uint32_t dark = 0;
            for (uint32_t x = 0; x < image.width; ++x) {
                float value = image.pixels[4 * x];
                assert_true(value == 0.0f || fabs((double)value - sqrt(0.5)) < 2e-6);
                dark += value == 0.0f;
            }
            assert_true(dark > 50 && dark < 100);
        }
    }
}

/* ---- The terminator ---- */

static struct scene *ball_scene(uint32_t segments)
{
    struct scene *scene = dark_scene((double[]){0, 0, 5}, (double[]){0, 0, 0});
    add_object(scene, mesh_sphere(1.0, segments, segments / 2), matte(1, 1, 1), 0, 0, 0);
    scene_put_sun(scene, 1, -0.3, -0.2, 1.0f);
    return scene;
}

static struct image ball_picture(uint32_t segments, bool without)
{
    whit_renderer_params params = {.width = 120, .height = 120};
    if (without)
        params.effects_removed = UINT64_C(1) << SCENE_EFFECT_TERMINATOR;
    return color_of(ball_scene(segments), NULL, &params);
}

/* The error within 0.85 of the ball's radius, as outlines differ in any case. */
static double ball_error(const struct image *a, const struct image *b)
{
    double sum = 0.0, radius = 60.0 / tan(0.3) / sqrt(24.0) * 0.85;
    uint32_t count = 0;
    for (uint32_t y = 0; y < a->height; ++y) {
        for (uint32_t x = 0; x < a->width; ++x) {
            double dx = x + 0.5 - 60.0, dy = y + 0.5 - 60.0;
            if (dx * dx + dy * dy > radius * radius)
                continue;
            size_t at = 4 * ((size_t)y * a->width + x);
            double d = (double)(a->pixels[at] - b->pixels[at]);
            sum += d * d;
            ++count;
        }
    }
    return sqrt(sum / count);
}

/* For the coarsest ball the shape itself adds more to the error than shadows do, so that its limit
   is wider. */
TEST_BY_TURNS(coarse_balls_are_shaded_like_fine_ones, 3, 4)
{
    own_image fine = ball_picture(512, true);
    static const uint32_t segments[] = {12, 20, 32};
    for (int i = 0; i < 3; ++i) {
        own_image with = ball_picture(segments[i], false);
        own_image without = ball_picture(segments[i], true);
        double error = ball_error(&with, &fine), before = ball_error(&without, &fine);
        print_message("  %2u segments: error %.5f, without %.5f\n", segments[i], error, before);
        assert_true(error < (i == 0 ? 0.75 : 0.4) * before);
    }
}

/* Without normals, and with those of the flat triangles. */
static struct scene *flat_scene(bool normals)
{
    struct scene *scene = floor_scene(eye_height);
    struct scene_mesh boxes = mesh_box(1.3, 0.7, 1.1);
    if (!normals) {
        free(boxes.normals);
        boxes.normals = NULL;
    }
    add_object(scene, boxes, matte(1, 1, 1), 0.1, 0.9, 0.2);
    scene->nodes[scene->node_count - 1].rotation[0] = 0.3;
    scene->nodes[scene->node_count - 1].rotation[3] = 0.95;
    scene_put_lamp(scene, 2, 3, 1, 9.0f);
    scene_put_sun(scene, 1, -1, 0.4, 0.3f);
    return scene;
}

TEST_BY_TURNS(flat_meshes_do_not_change, 0, 4)
{
    for (int normals = 0; normals < 2; ++normals) {
        whit_renderer_params params = {.width = 64, .height = 64, .depth = 4, .all_effects = true};
        own_image with = color_of(flat_scene(normals), NULL, &params);
        params.effects_removed = UINT64_C(1) << SCENE_EFFECT_TERMINATOR;
        own_image without = color_of(flat_scene(normals), NULL, &params);
        assert_same_image("without the terminator's mending", &with, &without);
    }
}

/* A box of eight vertices, whose normals point away from its middle. */
static struct scene_mesh round_box(void)
{
    static const uint32_t faces[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    struct scene_mesh mesh = mesh_zeroed(8, 12);
    mesh.normals = calloc(24, sizeof *mesh.normals);
    assert_non_null(mesh.normals);
    for (int i = 0; i < 24; ++i) {
        float side = (i / 3) >> (i % 3) & 1 ? 1.0f : -1.0f;
        mesh.positions[i] = side;
        mesh.normals[i] = side * 0.57735027f;
    }
    memcpy(mesh.indices, faces, sizeof faces);
    return mesh;
}

/* A lamp outside lights nothing inside a closed mesh with smooth normals. */
TEST_BY_TURNS(closed_rooms_stay_dark, 1, 4)
{
    static const double lamps[][3] = {{3, 0.2, 0.1}, {1.6, 1.7, 1.5}, {0.3, 1.2, -0.4},
                                      {1.05, 0, 0},  {-2, -3, 0.5},   {0.99, 1.2, 1.2}};
    for (int shape = 0; shape < 2; ++shape) {
        struct scene *scene = dark_scene((double[]){0.3, 0.2, 0.1}, (double[]){0.3, 0.2, -1});
        struct scene_mesh room = shape == 0 ? round_box() : mesh_sphere(1.0, 10, 6);
        scene->cameras[0].fov_y = 2.4f;
        add_object(scene, room, matte(1, 1, 1), 0, 0, 0);
        for (size_t i = 0; i < sizeof lamps / sizeof *lamps; ++i)
            scene_put_lamp(scene, lamps[i][0], lamps[i][1], lamps[i][2], 5.0f);
        const whit_renderer_params params = {.width = 100, .height = 100};
        own_image image = color_of(scene, NULL, &params);
        assert_true(red_sum(&image) == 0.0);
    }
}

/* ---- Catchers ---- */

/* A shadow catcher in front of an even background. A box and a red pane above it are out of view;
   the sun casts their shadows into view. `black`: lamps before and after it that give no light. */
static struct scene *catcher_scene(bool lit, int black)
{
    struct scene *scene = dark_scene((double[]){0, eye_height, 0}, (double[]){0, 0, 0});
    struct scene_material m = material_plain("catcher"), pane = material_plain("pane");
    set_rgb(scene->environment.zenith, 0.5f, 0.25f, 0.75f);
    set_rgb(scene->environment.horizon, 0.5f, 0.25f, 0.75f);
    set_rgb(scene->environment.ground, 0.5f, 0.25f, 0.75f);
    m.shadow_catcher = true;
    set_rgb(m.diffuse, 0.1f, 0, 0);
    set_rgb(pane.transmission, 1.0f, 0.25f, 0.25f);
    pane.thin_walled = true;
    add_object(scene, mesh_plane(40), m, 0, 0, 0);
    add_object(scene, mesh_plane(30), m, 0, 7, 0); /* a catcher above casts no shadow */
    add_object(scene, mesh_box(1, 0.1, 4), pane, -4.5, 5, 0);
    add_object(scene, mesh_box(1, 0.1, 4), material_plain("box"), -6, 5, 0);
    for (int i = 0; i <= black; ++i) {
        if (i != black / 2)
            scene_put_lamp(scene, 0, 6, 0, 0.0f);
        else if (lit)
            scene_put_sun(scene, 1, -1, 0, 3.0f);
        else
            scene_put_lamp(scene, 0, -5, 0, 1.0f); /* below */
    }
    return scene;
}

TEST_BY_TURNS(catchers_show_shadows_alone, 2, 4)
{
    for (int all = 0; all < 2; ++all) {
        whit_renderer_params params = {.width = 201, .height = 1, .depth = 4};
        params.camera = (whit_camera)CAMERA_AT(0, 8, 0, 0, 0, 0, 0, 0, -1, 0.17);
        params.all_effects = all;
        own_image image = color_of(catcher_scene(true, all ? 0 : LIGHT_LISTS + 1), NULL, &params);
        uint32_t clear = 0, dark = 0, red = 0;
        for (uint32_t x = 0; x < image.width; ++x) {
            const float *p = &image.pixels[4 * x];
            clear += p[0] == 0.5f && p[1] == 0.25f && p[2] == 0.75f;
            dark += p[0] == 0.0f && p[1] == 0.0f && p[2] == 0.0f;
            /* The two faces of the pane let a sixteenth pass. */
            red += p[0] == 0.5f && p[1] == 0.25f / 16.0f && p[2] == 0.75f / 16.0f;
        }
        print_message("  clear %u, dark %u, red %u\n", clear, dark, red);
        assert_true(clear > 80 && dark > 30 && red > 30 && clear + dark + red >= 195);
    }
    const whit_renderer_params params = {.width = 1, .height = 1, .depth = 4};
    own_image dark = color_of(catcher_scene(false, 0), NULL, &params);
    assert_true(dark.pixels[0] == 0.5f);
}

/* ---- Traversals that are cut short ---- */

/* A ray that passes more sheets than lavapipe allows loop iterations gives an error and no picture.
   The sheets are on the way of camera rays, or only of shadow rays. */
TEST_BY_TURNS(cut_walks_through_sheets_are_reported, 3, 4)
{
    for (int lit = 0; lit < 2; ++lit) {
        const float y = lit ? 10 : -9, corners[9] = {-2, y, -2, 0, y, 3, 2, y, -2};
        struct scene *scene = lit ? floor_scene(eye_height)
                                  : dark_scene((double[]){0, eye_height, 0}, (double[]){0, 0, 0});
        struct scene_material m = material_plain("sheet");
        m.alpha = lit ? SCENE_ALPHA_BLEND : SCENE_ALPHA_MASK;
        m.alpha_cutoff = 0.5f;
        m.opacity = lit ? 1e-3f : 0.0f; /* 1/64 stop is more: nothing is lost */
        add_object(scene, mesh_stack(70000, corners, 1, 1e-4f), m, 0, 0, 0);
        set_rgb(scene->environment.horizon, 0.5f, 0.5f, 0.5f);
        set_rgb(scene->environment.ground, 0.5f, 0.5f, 0.5f);
        scene_put_sun(scene, 0, -1, 0, lit ? 0.5f : 0.0f);
        const whit_renderer_params params = {.width = 1, .height = 1, .depth = 2};
        own_fixture f = fixture_open(scene, NULL, &params);
        whit_result result = renderer_render(f.renderer);
        print_message("  %s: %s\n", lit ? "light" : "eye", whit_result_name(result));
        if (device_get_limits(f.device)->loop_limited) {
            assert_int_equal(result, WHIT_ERROR_STATUS);
        } else {
            own_image image = {0};
            assert_int_equal(result, WHIT_OK);
            assert_int_equal(renderer_read_color(f.renderer, &image), WHIT_OK);
            assert_near(image.pixels[0], 0.5, 1e-6);
        }
    }
}

/* Two squares in one mesh: a floor, and, `ulps` of its largest coordinate above it, one that is
   seen from below alone. Neither is along an axis. */
static struct scene_mesh sheets_mesh(double offset, uint32_t ulps)
{
    static const double u[3] = {0.8, 0.36, -0.48}, v[3] = {0, 0.8, 0.6}, n[3] = {0.6, -0.48, 0.64};
    static const uint32_t corners[12] = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6};
    struct scene_mesh mesh = mesh_zeroed(8, 4);
    float far = (float)offset + 1.0f, ulp = nextafterf(far, INFINITY) - far;
    memcpy(mesh.indices, corners, sizeof corners);
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 3; ++k) {
            double along = i % 4 == 1 || i % 4 == 2 ? 0.5 : -0.5, up = i % 4 > 1 ? 0.5 : -0.5;
            double away = i > 3 ? ulps * (double)ulp : 0.0, size = i > 3 ? 1.5 : 1.1;
            mesh.positions[3 * i + k] =
                (float)(offset + size * (along * u[k] + up * v[k]) + away * n[k]);
        }
    return mesh;
}

/* The number of pixels of the floor that the sun reaches past the sheet above. */
static uint32_t lit_pixels(double offset, uint32_t ulps)
{
    static const double n[3] = {0.6, -0.48, 0.64};
    const whit_renderer_params params = {.width = 33, .height = 33, .depth = 1};
    const double middle_of_floor[3] = {offset, offset, offset};
    double eye[3];
    for (int k = 0; k < 3; ++k)
        eye[k] = offset + 1.5 * n[k];
    struct scene *scene = dark_scene(eye, middle_of_floor);
    struct scene_material lid = material_plain("lid");
    lid.one_sided = true;
    add_object(scene, sheets_mesh(offset, ulps), matte(1, 1, 1), 0, 0, 0);
    uint32_t index = scene_put_material(scene, lid);
    struct scene_mesh *mesh = &scene->meshes[scene->mesh_count - 1];
    mesh->materials[2] = mesh->materials[3] = index;
    scene_put_sun(scene, -0.6, 0.48, -0.64, 1.0f);
    own_image image = color_of(scene, NULL, &params);
    uint32_t lit = 0;
    for (size_t i = 0; i < 33 * 33; ++i)
        lit += image.pixels[4 * i] > 0.0f;
    return lit;
}

/* S2 of the catalogue of hard cases. With a gap of 28 ulp or more no light gets below the sheet, by
   the sum of the bounds in hard_gap_test.c, which searches for the narrowest gap. With 1 ulp, or a
   sheet below the floor, the floor is lit. */
TEST(narrow_gaps_stay_dark)
{
    static const double offsets[] = {0.0, 1e3, 1e5};
    for (int i = 0; i < 3; ++i) {
        uint32_t touching = lit_pixels(offsets[i], 1), narrow = lit_pixels(offsets[i], 28);
        print_message("  at %g: %u of %d pixels lit through a gap of 1 ulp, %u through 28\n",
                      offsets[i], touching, 33 * 33, narrow);
        assert_true(touching > 0);
        assert_int_equal(narrow, 0);
    }
}

static uint64_t instances_entered(struct scene_mesh mesh)
{
    const whit_renderer_params params = {.width = 33, .height = 33, .count = true};
    struct scene *scene = dark_scene((double[]){0, 3, 4}, (double[]){0, 0, 0});
    struct scene_material white = matte(1, 1, 1);
    uint32_t index = scene_put(scene, mesh, &(struct put){.material = &white});
    scene_put_again(scene, index, &(struct put){.at = {500, 0, 0}});
    scene_put_sun(scene, -0.2, -1, 0.1, 1.0f);
    own_picture picture = picture_of(scene, NULL, &params);
    assert_true(picture.stats.rays_shadow > 50);
    return picture.stats.costs[RAY_SHADOW].instances;
}

/* Primitives of a body that cannot shade itself are not tested (accel_hull). */
TEST(rays_that_leave_a_convex_body_do_not_enter_it)
{
    assert_int_equal(instances_entered(mesh_plane(2)), 0);
    assert_int_equal(instances_entered(mesh_box(1, 1, 1)), 0);
    assert_int_equal(instances_entered(mesh_balls((const double[]){0, 0, 0, 1}, 1)), 0);
    /* Smooth normals: a few rays to a light below their triangle's plane are tested. */
    assert_true(instances_entered(mesh_icosphere(1, 2)) < 10);
    assert_true(instances_entered(mesh_torus(1.0, 0.3, 20, 10)) > 50);
}

/* The light is outside of the body in which the camera is. */
TEST(light_does_not_get_into_a_convex_body)
{
    const whit_renderer_params params = {.width = 33, .height = 33, .depth = 2};
    struct scene_mesh bodies[] = {mesh_box(4, 4, 4), mesh_icosphere(4, 2),
                                  mesh_balls((const double[]){0, 0, 0, 4}, 1)};
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; ++i) {
        struct scene *scene = dark_scene((double[]){0, 0.5, 1}, (double[]){0, 0, 0});
        add_object(scene, bodies[i], matte(1, 1, 1), 0, 0, 0);
        add_object(scene, mesh_plane(1), matte(1, 1, 1), 500, 0, 0);
        scene_put_sun(scene, -0.2, -1, 0.1, 1.0f);
        own_image image = color_of(scene, NULL, &params);
        for (size_t k = 0; k < 33 * 33; ++k)
            assert_true(image.pixels[4 * k] == 0.0f);
    }
}
