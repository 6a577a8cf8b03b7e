/* Normals and texture coordinates as files have them: missing, of length 0, not finite, reversed,
   huge. Kernels have every effect, so that no code is left out that might fail. */
#include "picture_fixture.h"
#include "unit.h"

enum { SIDE = 9 };
static const whit_renderer_params all_params = {
    .width = SIDE, .height = SIDE, .depth = 3, .all_effects = true};

/* A texture of one texel. */
static uint32_t add_texel(struct scene *scene, uint8_t r, uint8_t g, uint8_t b)
{
    return scene_put_texture(scene, 1, 1, (uint8_t[4]){r, g, b, 255});
}

/* Asserts that all channels of all pixels are `expected`. */
static void assert_even(struct scene *scene, double expected, double relative)
{
    own_image image = color_of(scene, NULL, &all_params);
    for (int i = 0; i < SIDE * SIDE; ++i)
        for (int c = 0; c < 3; ++c)
            assert_near(image.pixels[4 * i + c], expected, relative);
}

/* Asserts that all pixels are numbers from 0 to `max`. */
static void assert_sane(struct scene *scene, double max)
{
    own_image image = color_of(scene, NULL, &all_params);
    assert_range(&image, 0, max);
}

/* The floor fills the picture, seen from straight above; the sun is 60 degrees from it. */
#define COS_SUN 0.5
static struct scene *sunny(struct scene *scene, struct scene_mesh mesh, struct scene_material m)
{
    add_object(scene, mesh, m, 0, 0, 0);
    scene_put_sun(scene, sqrt(0.75), -COS_SUN, 0, 1.0f);
    return scene;
}

static struct scene *from_above(void)
{
    return dark_scene((double[]){0, 5, 0}, (double[]){0, 0, 0});
}

static struct scene_material white(void)
{
    return matte(1, 1, 1);
}

static void fill_normals(struct scene_mesh *mesh, float x, float y, float z)
{
    for (uint32_t i = 0; i < mesh->vertex_count; ++i)
        set_rgb(&mesh->normals[3 * i], x, y, z);
}

TEST_BY_TURNS(unusable_normals_are_those_of_the_faces, 0, 2)
{
    static const float wrong[][3] = {{0, 0, 0},        {-0.0f, 0, -0.0f}, {NAN, 1, 0},
                                     {0, INFINITY, 0}, {0, -INFINITY, 1}, {NAN, NAN, NAN},
                                     {0, 1e-44f, 0},   {0, 3.4e38f, 0}}; /* these have one */
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
        struct scene_mesh mesh = mesh_plane(10);
        fill_normals(&mesh, wrong[i][0], wrong[i][1], wrong[i][2]);
        assert_even(sunny(from_above(), mesh, white()), COS_SUN, 1e-6);
    }
    struct scene_mesh flat = mesh_plane(10);
    free(flat.normals);
    flat.normals = NULL;
    assert_even(sunny(from_above(), flat, white()), COS_SUN, 1e-6);
}

/* The length of a normal gives it no more weight where normals are interpolated. */
TEST_BY_TURNS(lengths_of_normals_do_not_matter, 1, 2)
{
    static const float lengths[] = {1e-30f, 1e30f, 3.0f, 0.01f};
    struct scene_mesh mesh = mesh_plane(10), even = mesh_plane(10);
    for (uint32_t i = 0; i < mesh.vertex_count; ++i) {
        float x = i % 2 ? 0.6f : 0.0f, y = i % 2 ? 0.8f : 1.0f;
        set_rgb(&even.normals[3 * i], x, y, 0);
        set_rgb(&mesh.normals[3 * i], x * lengths[i % 4], y * lengths[i % 4], 0);
    }
    struct image images[2];
    for (int k = 0; k < 2; ++k)
        images[k] = color_of(sunny(from_above(), k ? mesh : even, white()), NULL, &all_params);
    for (int i = 0; i < SIDE * SIDE; ++i)
        assert_near(images[1].pixels[4 * i], (double)images[0].pixels[4 * i], 1e-6);
    /* The normals do change the shading over the floor. */
    assert_true(fabsf(images[0].pixels[4] - images[0].pixels[4 * SIDE - 8]) > 0.01f);
    image_finish(&images[0]);
    image_finish(&images[1]);
}

static void reverse_winding(struct scene_mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        uint32_t other = mesh->indices[3 * t];
        mesh->indices[3 * t] = mesh->indices[3 * t + 1];
        mesh->indices[3 * t + 1] = other;
    }
}

/* With reversed normals, reversed winding, or both, the side that faces the eye is shaded. */
TEST_BY_TURNS(turned_normals_shade_the_same, 0, 2)
{
    for (int i = 0; i < 4; ++i) {
        struct scene_mesh mesh = mesh_plane(10);
        if (i & 1)
            fill_normals(&mesh, 0, -1, 0);
        if (i & 2)
            reverse_winding(&mesh);
        assert_even(sunny(from_above(), mesh, white()), COS_SUN, 1e-6);
    }
}

/* A shading normal that faces away from the eye is replaced by that of the face. */
TEST_BY_TURNS(averted_normals_give_way, 1, 2)
{
    struct scene_mesh mesh = mesh_plane(40);
    fill_normals(&mesh, 0, 0.3f, -1);
    struct scene *scene = dark_scene((double[]){0, 1, 3}, (double[]){0, 0, 0});
    scene->cameras[0].fov_y = 0.1f;
    add_object(scene, mesh, white(), 0, 0, 0);
    scene_put_sun(scene, 0, -1, 0, 1.0f);
    assert_even(scene, 1.0, 1e-6);
    /* With such normals mirrors, glass and highlights give finite light, and not too much. */
    for (int kind = 0; kind < 3; ++kind) {
        struct scene_mesh again = mesh_plane(40);
        struct scene_material m = matte(0.5f, 0.5f, 0.5f);
        fill_normals(&again, kind == 1 ? 5.0f : 0.0f, 0.01f, -1);
        set_rgb(m.reflection, 0.5f, 0.5f, 0.5f);
        if (kind == 1)
            set_rgb(m.transmission, 0.5f, 0.5f, 0.5f);
        m.fresnel = kind == 1;
        if (kind == 2) {
            m.model = WHIT_MODEL_METAL_ROUGH;
            set_rgb(m.specular, 1, 1, 1);
            m.roughness = 0.5f;
            m.metallic = 0.5f;
        }
        scene = dark_scene((double[]){0, 1, 3}, (double[]){0, 0, 0});
        set_rgb(scene->environment.zenith, 1, 1, 1);
        add_object(scene, again, m, 0, 0, 0);
        scene_put_sun(scene, 0.3, -1, 0.2, 1.0f);
        assert_sane(scene, 4.0);
    }
}

static struct scene *textured_floor(const float uvs[4][2], bool bent)
{
    struct scene_mesh mesh = mesh_plane(10);
    assert_int_equal(mesh.vertex_count, 4);
    if (uvs) {
        memcpy(mesh.uvs[0], uvs, 8 * sizeof(float));
    } else {
        free(mesh.uvs[0]);
        mesh.uvs[0] = NULL;
    }
    struct scene_material m = white();
    struct scene *scene = from_above();
    m.textures[SCENE_SLOT_DIFFUSE].texture = add_texel(scene, 188, 188, 188);
    if (bent)
        m.textures[SCENE_SLOT_NORMAL].texture = add_texel(scene, 240, 128, 180);
    return sunny(scene, mesh, m);
}

static struct image bent_floor(bool turned, uint8_t x, uint8_t y)
{
    struct scene_mesh mesh = mesh_plane(10);
    struct scene_material m = white();
    struct scene *scene = from_above();
    m.textures[SCENE_SLOT_NORMAL].texture = add_texel(scene, x, y, 230);
    if (turned) {
        fill_normals(&mesh, 0, -1, 0);
        reverse_winding(&mesh);
    }
    return color_of(sunny(scene, mesh, m), NULL, &all_params);
}

/* glTF reverses the normal of a back face after its normal map: what stands out in front is a dent
   behind. 51 and 204 stand for -0.6 and 0.6. */
TEST(maps_are_dents_from_behind)
{
    own_image front = bent_floor(false, 51, 204), behind = bent_floor(true, 204, 51);
    own_image same = bent_floor(true, 51, 204);
    assert_memory_equal(front.pixels, behind.pixels, SIDE * SIDE * 4 * sizeof(float));
    assert_true(fabsf(front.pixels[0] - same.pixels[0]) > 0.1f);
}

static double linear_of(uint8_t srgb)
{
    return pow((srgb / 255.0 + 0.055) / 1.055, 2.4);
}

/* A texture of one colour gives that colour with any coordinates. */
TEST(coordinates_may_be_anything)
{
    static const float uvs[][4][2] = {
        {{0, 0}, {1, 0}, {0, 1}, {1, 1}},
        {{0, 0}, {0, 0}, {0, 0}, {0, 0}},
        {{0.5f, 0.25f}, {0.5f, 0.75f}, {0.5f, 0.5f}, {0.5f, 1}}, /* on a line */
        {{NAN, 0}, {0, NAN}, {NAN, NAN}, {1, 1}},
        {{1e9f, -1e9f}, {-1e9f, 1e9f}, {1e9f, 1e9f}, {0, 0}},
        {{INFINITY, 0}, {0, -INFINITY}, {3e38f, -3e38f}, {1, 1}},
        {{1e-45f, 0}, {0, 1e-45f}, {1e-45f, 1e-45f}, {0, 0}},
    };
    const double linear = linear_of(188);
    for (size_t i = 0; i < sizeof uvs / sizeof *uvs; ++i) {
        assert_even(textured_floor(uvs[i], false), linear * COS_SUN, 2e-6);
        assert_sane(textured_floor(uvs[i], true), linear * 1.000001);
    }
    assert_even(textured_floor(NULL, false), linear * COS_SUN, 2e-6);
    assert_sane(textured_floor(NULL, true), linear * 1.000001);
}

/* Set 0 leads to a texture's first texel, set 1 to its second; each of two textures uses its own
   set. */
TEST(each_texture_has_its_coordinates)
{
    static const uint8_t diffuse[2] = {200, 90}, emission[2] = {60, 140};
    for (uint32_t sets = 0; sets < 4; ++sets) {
        struct scene_mesh mesh = mesh_plane(10);
        mesh.uvs[1] = array_alloc(mesh.vertex_count, 2 * sizeof *mesh.uvs[1]);
        assert_true(mesh.uvs[0] && mesh.uvs[1]);
        for (uint32_t i = 0; i < 2 * mesh.vertex_count; ++i) {
            mesh.uvs[0][i] = i % 2 ? 0.5f : 0.25f;
            mesh.uvs[1][i] = i % 2 ? 0.5f : 0.75f;
        }
        struct scene *scene = from_above();
        struct scene_material m = white();
        set_rgb(m.emission, 1, 1, 1);
        use_texture(&m, SCENE_SLOT_DIFFUSE, add_two_texels(scene, diffuse[0], diffuse[1]));
        use_texture(&m, SCENE_SLOT_EMISSION, add_two_texels(scene, emission[0], emission[1]));
        m.textures[SCENE_SLOT_DIFFUSE].uv_set = sets & 1;
        m.textures[SCENE_SLOT_EMISSION].uv_set = sets >> 1;
        assert_even(sunny(scene, mesh, m),
                    linear_of(diffuse[sets & 1]) * COS_SUN + linear_of(emission[sets >> 1]), 2e-6);
    }
}

static struct scene_mesh coloured_plane(float grey, float alpha)
{
    struct scene_mesh mesh = mesh_plane(10);
    mesh.colors = array_alloc(mesh.vertex_count, 4 * sizeof *mesh.colors);
    assert_non_null(mesh.colors);
    for (uint32_t v = 0; v < mesh.vertex_count; ++v) {
        set_rgb(&mesh.colors[4 * v], grey, grey, grey);
        mesh.colors[4 * v + 3] = alpha;
    }
    return mesh;
}

/* glTF multiplies the opacity of a mask by the alpha of vertices: below the cutoff nothing is
 * there. */
TEST(masks_heed_the_alpha_of_vertices)
{
    static const float alphas[] = {0.6f, 0.4f};
    for (int i = 0; i < 2; ++i) {
        struct scene_material m = white();
        m.alpha = SCENE_ALPHA_MASK;
        m.alpha_cutoff = 0.5f;
        assert_even(sunny(from_above(), coloured_plane(1, alphas[i]), m), i ? 0.0 : COS_SUN, 1e-6);
    }
}

/* Like textures, vertex colours tint what surfaces send of all light, ambient light too. */
TEST(vertex_colors_tint_all_light)
{
    struct scene *scene = from_above();
    struct scene_material m = white();
    set_rgb(scene->ambient, 0.5f, 0.5f, 0.5f);
    set_rgb(m.ambient, 1, 1, 1);
    use_texture(&m, SCENE_SLOT_DIFFUSE, add_texel(scene, 128, 128, 128));
    assert_even(sunny(scene, coloured_plane(0.25f, 1), m), 0.25 * linear_of(128) * (COS_SUN + 0.5),
                3e-5);
}

/* A square across `n`, with texture coordinates along its sides. */
static struct scene_mesh square_across(const double n[3])
{
    struct scene_mesh mesh = mesh_plane(10);
    double aside[3], up[3];
    int min = fabs(n[0]) < fabs(n[1]) ? (fabs(n[0]) < fabs(n[2]) ? 0 : 2)
                                      : (fabs(n[1]) < fabs(n[2]) ? 1 : 2);
    const double axis[3] = {min == 0, min == 1, min == 2};
    double3_cross(n, axis, aside);
    double length = sqrt(aside[0] * aside[0] + aside[1] * aside[1] + aside[2] * aside[2]);
    for (int k = 0; k < 3; ++k)
        aside[k] /= length;
    double3_cross(n, aside, up);
    for (uint32_t i = 0; i < mesh.vertex_count; ++i) {
        float *p = &mesh.positions[3 * i];
        double s = (double)p[0], t = (double)p[2];
        for (int k = 0; k < 3; ++k) {
            p[k] = (float)(s * aside[k] + t * up[k]);
            mesh.normals[3 * i + (uint32_t)k] = (float)n[k];
        }
    }
    return mesh;
}

/* Normals at which frames built from a normal alone lose their digits (Duff et al. 2017, Building
   an Orthonormal Basis, Revisited). A map that tilts by the same angle everywhere shades the same.
 */
TEST(frames_stand_in_every_direction)
{
    static const double normals[][3] = {
        {0, 0, -1},
        {0, 0, 1},
        {-0.0, -0.0, -1},
        {0.00038527316, 0.00038460016, -0.99999988079},
        {-0.00019813581, -0.00008946839, -0.99999999},
        {1, 0, 0},
        {0, -1, 0},
        {0.57735026919, -0.57735026919, 0.57735026919},
        {1e-8, 1, 0},
    };
    const double v[3] = {204.0 / 127.5 - 1.0, 128.0 / 127.5 - 1.0, 230.0 / 127.5 - 1.0};
    double expected = v[2] / sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (size_t i = 0; i < sizeof normals / sizeof *normals; ++i) {
        const double *n = normals[i];
        struct scene *scene =
            dark_scene((double[]){5 * n[0], 5 * n[1], 5 * n[2]}, (double[]){0, 0, 0});
        struct scene_material m = white();
        m.textures[SCENE_SLOT_NORMAL].texture = add_texel(scene, 204, 128, 230);
        add_object(scene, square_across(n), m, 0, 0, 0);
        scene_put_sun(scene, -n[0], -n[1], -n[2], 1.0f);
        assert_even(scene, expected, 2e-6);
    }
}
