/* Textures with several texels in a pixel (minification), by the device and by the reference. */
#include "picture/mipmap.h"
#include "picture_fixture.h"
#include "reference_fixture.h"
#include "render/variants.h"
#include "unit.h"

enum { SIDE = 64 };

static uint32_t add_noise(struct scene *scene, uint32_t width, uint32_t height, bool alpha)
{
    uint64_t random = width * 31 + height;
    own_memory uint8_t *rgba = array_alloc((size_t)width * height, 4);
    assert_non_null(rgba);
    for (size_t i = 0; i < 4 * (size_t)width * height; ++i)
        rgba[i] = i % 4 == 3 && !alpha ? 255 : (uint8_t)random_below(&random, 256);
    return scene_put_texture(scene, width, height, rgba);
}

/* Uses a texture that is repeated `times` times across one unit of uv. */
static void use_often(struct scene_material *m, enum scene_slot slot, uint32_t texture, float times,
                      enum scene_wrap wrap)
{
    const float transform[6] = {times, 0.125f * times, 0.1f, -0.25f * times, times, 0.2f};
    use_filtered(m, slot, texture, transform, wrap);
}

/* Textures of all kinds and sizes: on a floor to the horizon, a sphere, a box that blends and a
   wall of metal; seen also through glass and in a mirror. */
static struct scene *far_textures(void)
{
    struct scene *scene = dark_scene((double[]){0.5, 1.2, 6}, (double[]){0, 0.7, 0});
    struct scene_material ground = matte(1, 1, 1), globe = matte(1, 1, 1), leaf = matte(1, 1, 1),
                          glass = matte(0, 0, 0), metal = matte(1, 1, 1),
                          wall = matte(0.5f, 0.5f, 0.5f);
    use_often(&ground, SCENE_SLOT_DIFFUSE, add_noise(scene, 37, 20, false), 16, SCENE_WRAP_REPEAT);
    use_often(&ground, SCENE_SLOT_NORMAL, add_noise(scene, 16, 16, false), 8, SCENE_WRAP_MIRROR);
    ground.normal_scale = 0.3f;
    add_object(scene, mesh_plane(60), ground, 0, 0, 0);
    use_often(&globe, SCENE_SLOT_DIFFUSE, add_noise(scene, 128, 64, false), 1, SCENE_WRAP_REPEAT);
    use_often(&globe, SCENE_SLOT_EMISSION, add_noise(scene, 1, 33, false), 2, SCENE_WRAP_CLAMP);
    set_rgb(globe.emission, 0.2f, 0.1f, 0.3f);
    add_object(scene, mesh_balls((double[]){0, 0, 0, 0.7}, 1), globe, -1.3, 0.8, 1);
    leaf.alpha = SCENE_ALPHA_BLEND;
    use_often(&leaf, SCENE_SLOT_DIFFUSE, add_noise(scene, 64, 64, true), 1, SCENE_WRAP_REPEAT);
    use_often(&leaf, SCENE_SLOT_BUMP, add_noise(scene, 32, 8, false), 1, SCENE_WRAP_REPEAT);
    add_object(scene, mesh_box(0.9, 0.9, 0.9), leaf, 1.4, 0.6, 1.5);
    set_rgb(glass.transmission, 1, 1, 1);
    glass.ior = 1.5f;
    glass.fresnel = true;
    add_object(scene, mesh_balls((double[]){0, 0, 0, 0.5}, 1), glass, 0.1, 0.6, 2.5);
    metal.model = WHIT_MODEL_METAL_ROUGH;
    metal.metallic = 1.0f;
    metal.roughness = 0.5f;
    set_rgb(metal.specular, 1, 1, 1);
    use_often(&metal, SCENE_SLOT_METAL_ROUGH, add_noise(scene, 64, 32, false), 2,
              SCENE_WRAP_MIRROR);
    add_object(scene, mesh_box(8, 4, 0.1), metal, 0, 1.2, -4);
    use_often(&wall, SCENE_SLOT_DIFFUSE, add_noise(scene, 1, 1, false), 3, SCENE_WRAP_REPEAT);
    set_rgb(wall.reflection, 0.4f, 0.4f, 0.4f);
    add_object(scene, mesh_box(0.1, 4, 6), wall, 4.5, 1.2, -1);
    scene_put_sun(scene, -0.3, -1, -0.4, 0.8f);
    set_rgb(scene->ambient, 0.3f, 0.3f, 0.3f);
    return scene;
}

/* ---- Comparison with the reference ---- */

static double rmse(const struct image *a, const struct image *b)
{
    size_t values = (size_t)a->width * a->height * 4;
    double sum = 0.0;
    for (size_t i = 0; i < values; ++i)
        sum += pow((double)a->pixels[i] - (double)b->pixels[i], 2.0);
    return sqrt(sum / (double)values);
}

static void check(const char *what, const whit_accel_params *trees, void (*change)(struct scene *),
                  uint32_t samples)
{
    struct scene *scene = far_textures();
    if (change)
        change(scene);
    assert_agrees(what, scene, trees,
                  (whit_renderer_params){
                      .width = SIDE, .height = SIDE, .depth = 4, .sampling.count = samples});
}

static void make_orthographic(struct scene *scene)
{
    scene->cameras[0].kind = WHIT_CAMERA_ORTHOGRAPHIC;
    scene->cameras[0].height = 5.0f;
}

static void make_panorama(struct scene *scene)
{
    scene->cameras[0].kind = WHIT_CAMERA_PANORAMA;
}

static void make_lens(struct scene *scene)
{
    scene->cameras[0].lens_radius = 0.05f;
}

static void widen(struct scene *scene)
{
    scene->cameras[0].fov_y = 2.0f;
}

TEST_BY_TURNS(cameras_agree_with_the_reference, 0, 2)
{
    check("pinhole", NULL, NULL, 1);
    check("wide pinhole", NULL, widen, 1);
    check("four samples", NULL, NULL, 4);
    check("orthographic", NULL, make_orthographic, 1);
    check("panorama", NULL, make_panorama, 1);
    check("lens", NULL, make_lens, 4);
}

TEST_BY_TURNS(a_tree_in_the_world_agrees_too, 1, 2)
{
    const whit_accel_params flat = {.instances = WHIT_INSTANCES_OFF};
    check("one tree", &flat, NULL, 1);
}

/* ---- The use of mipmaps ---- */

/* A checkered floor to the horizon, with squares of size 1. */
static struct scene *checkers(double height)
{
    const uint8_t rgba[16] = {230, 220, 200, 255, 20,  30,  60,  255,
                              20,  30,  60,  255, 230, 220, 200, 255};
    struct scene *scene = dark_scene((double[]){0, height, 0}, (double[]){0.3, height - 0.1, -1});
    struct scene_material m = unlit(1, 1, 1);
    use_texture(&m, SCENE_SLOT_DIFFUSE, scene_put_texture(scene, 2, 2, rgba));
    const float transform[6] = {200, 0, 0, 0, 200, 0};
    struct scene_texture_use *use = &m.textures[SCENE_SLOT_DIFFUSE];
    memcpy(use->transform, transform, sizeof transform);
    use->wrap_u = use->wrap_v = SCENE_WRAP_REPEAT;
    add_object(scene, mesh_plane(400), m, 0, 0, 0);
    return scene;
}

static struct image picture_by(struct fixture *f, whit_minification minification, uint32_t first,
                               uint32_t count)
{
    fixture_renew(f, &(whit_renderer_params){.width = SIDE,
                                             .height = SIDE,
                                             .depth = 4,
                                             .minification = minification,
                                             .sampling = {.first = first, .count = count}});
    return render(f);
}

/* Whether the picture has other bytes than one without mipmaps. */
static bool mipmaps_matter(struct fixture *f, whit_renderer_params params)
{
    fixture_renew(f, &params);
    own_image with = render(f);
    params.minification = WHIT_MINIFICATION_NONE;
    fixture_renew(f, &params);
    own_image without = render(f);
    return pixels_unlike(&with, &without) > 0;
}

TEST_BY_TURNS(one_sample_is_nearer_to_the_truth, 0, 2)
{
    own_fixture f = fixture_open(checkers(1), NULL, NULL);
    own_image truth = picture_by(&f, WHIT_MINIFICATION_NONE, 0, 256);
    own_image plain = picture_by(&f, WHIT_MINIFICATION_NONE, 0, 1);
    own_image smooth = picture_by(&f, WHIT_MINIFICATION_MIPMAP, 0, 1);
    own_image fewer = picture_by(&f, WHIT_MINIFICATION_NONE, 0, 64);
    own_image many = picture_by(&f, WHIT_MINIFICATION_MIPMAP, 0, 256);
    double before = rmse(&plain, &truth), after = rmse(&smooth, &truth);
    double left = rmse(&fewer, &truth), last = rmse(&many, &truth);
    print_message("  RMSE %.3g without, %.3g with; 64 samples without %.2g, 256 with %.2g\n",
                  before, after, left, last);
    assert_true(after < 0.8 * before);
    assert_true(last < 0.5 * left); /* with many samples mipmaps do not blur */
}

TEST_BY_TURNS(magnified_textures_keep_their_bytes, 1, 2)
{
    own_fixture f = fixture_open(checkers(60), NULL, NULL);
    for (int far = 0; far < 2; ++far) {
        whit_renderer_params params = {.width = SIDE, .height = SIDE};
        params.camera = (whit_camera)CAMERA_AT(0.2, 4, 0.1, 0, 0, 0, 0, 0, -1, 40);
        params.camera.eye[1] = far ? 300.0 : 4.0;
        assert_int_equal(mipmaps_matter(&f, params), far);
    }
}

/* The viewer adds up pictures of parts of the samples: the picture of four is the sum of its parts.
 */
TEST(parts_of_samples_add_up)
{
    own_fixture f = fixture_open(far_textures(), NULL, NULL);
    struct image whole = picture_by(&f, WHIT_MINIFICATION_MIPMAP, 0, 4), parts[4];
    for (uint32_t i = 0; i < 4; ++i)
        parts[i] = picture_by(&f, WHIT_MINIFICATION_MIPMAP, i, 1);
    for (size_t i = 0; i < (size_t)SIDE * SIDE * 4; ++i) {
        float sum =
            (parts[0].pixels[i] + parts[1].pixels[i]) + (parts[2].pixels[i] + parts[3].pixels[i]);
        assert_true(i % 4 == 3 || 0.25f * sum == whole.pixels[i]);
    }
    image_finish(&whole);
    for (int i = 0; i < 4; ++i)
        image_finish(&parts[i]);
}

/* ---- Cases without smaller levels ---- */

static struct gpu_spec spec_of(struct fixture *f, whit_minification minification)
{
    fixture_renew(f, &(whit_renderer_params){
                         .width = SIDE, .height = SIDE, .depth = 4, .minification = minification});
    return variant_spec(&f->renderer->picture);
}

TEST(scenes_without_textures_have_the_same_kernels)
{
    for (int textured = 0; textured < 2; ++textured) {
        struct scene *scene = textured ? checkers(1) : floor_scene(3);
        own_fixture f = fixture_open(scene, NULL, NULL);
        const struct gpu_spec with = spec_of(&f, WHIT_MINIFICATION_MIPMAP);
        const struct gpu_spec without = spec_of(&f, WHIT_MINIFICATION_NONE);
        assert_int_equal(with.SPEC_MINIFICATION, textured);
        assert_int_equal(memcmp(&with, &without, sizeof with) != 0, textured);
    }
}

/* Masks have only level 0, because traversal reads them and does not know the pixel. */
TEST(masks_have_no_levels)
{
    struct scene *scene = dark_scene((double[]){0, 3, 0}, (double[]){0, 0, 0});
    struct scene_material leaf = matte(1, 1, 1);
    leaf.alpha = SCENE_ALPHA_MASK;
    leaf.alpha_cutoff = 0.5f;
    use_often(&leaf, SCENE_SLOT_OPACITY, add_noise(scene, 8, 8, true), 1, SCENE_WRAP_REPEAT);
    add_object(scene, mesh_plane(4), leaf, 0, 0, 0);
    own_fixture f = fixture_open(scene, NULL, NULL);
    assert_int_equal(spec_of(&f, WHIT_MINIFICATION_MIPMAP).SPEC_MINIFICATION, 0);
}

/* Buffers of devices hold at least 128 MiB, of which level 0 takes nine tenths here: the other
   levels may not fit. */
TEST(levels_that_do_not_fit_are_left_out)
{
    const uint32_t side = 5500;
    struct scene *scene = dark_scene((double[]){0, 3, 0}, (double[]){0, 0, 0});
    struct scene_material m = unlit(1, 1, 1);
    uint8_t *rgba = array_alloc((size_t)side * side, 4);
    assert_non_null(rgba);
    for (size_t i = 0; i < 4 * (size_t)side * side; ++i)
        rgba[i] = (uint8_t)(i * 2654435761u >> 24);
    use_texture(&m, SCENE_SLOT_DIFFUSE, scene_put_texture(scene, side, side, rgba));
    free(rgba);
    add_object(scene, mesh_plane(2), m, 0, 0, 0);
    own_fixture f = fixture_open(scene, NULL, NULL);
    whit_renderer_params params = {.width = SIDE, .height = SIDE, .load_path = WHIT_LOAD_STORAGE};
    bool fits = device_get_info(f.device)->max_storage_range_bytes / 4 >
                mipmap_first(side, side, MIPMAP_LEVELS_MAX);
    assert_int_equal(mipmaps_matter(&f, params), fits);
}
