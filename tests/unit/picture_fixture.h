/* Scenes put together by hand, whose radiance is known by formula, and their pictures. */
#ifndef TESTS_PICTURE_FIXTURE_H
#define TESTS_PICTURE_FIXTURE_H

#include "render_fixture.h"

/* Black, and without a name: each use gets its own. */
static inline struct scene_material material(const char *name)
{
    struct scene_material m;
    scene_material_init(&m, name);
    free(m.name);
    m.name = NULL;
    for (int i = 0; i < 3; ++i) {
        m.ambient[i] = 0.0f;
        m.specular[i] = 0.0f;
    }
    return m;
}

static inline void set_rgb(float *rgb, float r, float g, float b)
{
    rgb[0] = r;
    rgb[1] = g;
    rgb[2] = b;
}

/* A scene with nothing but a black background and a camera at `eye` looking at `target`. */
static inline struct scene *dark_scene(const double eye[3], const double target[3])
{
    struct scene *scene = scene_create(&fixture_log, "picture");
    assert_non_null(scene);
    scene->has_environment = true;
    scene->environment.kind = SCENE_ENVIRONMENT_GRADIENT;
    set_rgb(scene->environment.scale, 1.0f, 1.0f, 1.0f);
    scene->has_ambient = true;
    struct scene_camera camera = {.name = string_copy("camera"),
                                  .kind = SCENE_CAMERA_PERSPECTIVE,
                                  .node = SCENE_NONE,
                                  .up = {0, 1, 0},
                                  .fov_y = 0.6f};
    memcpy(camera.eye, eye, sizeof camera.eye);
    memcpy(camera.target, target, sizeof camera.target);
    if (eye[0] == target[0] && eye[2] == target[2])
        camera.up[1] = 0, camera.up[2] = -1;
    assert_int_not_equal(scene_add_camera(scene, camera), SCENE_NONE);
    return scene;
}

static inline void add_sun(struct scene *scene, double x, double y, double z, float strength)
{
    double length = sqrt(x * x + y * y + z * z);
    struct scene_light light = {.name = string_copy("sun"),
                                .kind = SCENE_LIGHT_DIRECTIONAL,
                                .node = SCENE_NONE,
                                .direction = {x / length, y / length, z / length}};
    set_rgb(light.color, strength, strength, strength);
    assert_int_not_equal(scene_add_light(scene, light), SCENE_NONE);
}

static inline void add_lamp(struct scene *scene, double x, double y, double z, float strength)
{
    struct scene_light light = {.name = string_copy("lamp"),
                                .kind = SCENE_LIGHT_POINT,
                                .node = SCENE_NONE,
                                .position = {x, y, z},
                                .falloff = true};
    set_rgb(light.color, strength, strength, strength);
    assert_int_not_equal(scene_add_light(scene, light), SCENE_NONE);
}

/* `mesh` with `m`, moved; the index of the material. */
static inline uint32_t add_object(struct scene *scene, struct scene_mesh mesh,
                                  struct scene_material m, double x, double y, double z)
{
    m.name = string_copy("material");
    uint32_t index = scene_add_material(scene, m);
    for (uint32_t i = 0; i < scene_mesh_primitives(&mesh); ++i)
        mesh.materials[i] = index;
    mesh.name = string_copy("object");
    struct scene_node node;
    scene_node_init(&node, "node", SCENE_NONE);
    node.translation[0] = x;
    node.translation[1] = y;
    node.translation[2] = z;
    struct scene_instance instance = {.name = string_copy("object"),
                                      .mesh = scene_add_mesh(scene, mesh),
                                      .node = scene_add_node(scene, node)};
    assert_int_not_equal(scene_add_instance(scene, instance), SCENE_NONE);
    return index;
}

static inline struct scene_mesh plane(double size)
{
    struct scene_mesh mesh = {0};
    assert_int_equal(shape_plane(size, size, 1, 1.0, &mesh), WHIT_OK);
    return mesh;
}

static inline struct scene_mesh box(double x, double y, double z)
{
    struct scene_mesh mesh = {0};
    assert_int_equal(shape_box((double[]){x, y, z}, &mesh), WHIT_OK);
    return mesh;
}

/* A texture of two texels side by side; see use_texture. */
static inline uint32_t add_two_texels(struct scene *scene, uint8_t first, uint8_t second)
{
    struct scene_texture texture = {.name = string_copy("two"), .width = 2, .height = 1};
    texture.rgba = malloc(8);
    assert_non_null(texture.rgba);
    for (int i = 0; i < 8; ++i)
        texture.rgba[i] = i < 4 ? first : second;
    texture.rgba[3] = texture.rgba[7] = 255;
    return scene_add_texture(scene, texture);
}

/* Nearest texels, held beyond the edges. */
static inline void use_texture(struct scene_material *m, enum scene_slot slot, uint32_t texture)
{
    struct scene_texture_use *use = &m->textures[slot];
    scene_texture_use_init(use);
    use->texture = texture;
    use->nearest = true;
    use->wrap_u = use->wrap_v = SCENE_WRAP_CLAMP;
}

static inline struct image render(struct fixture *f)
{
    struct image image = {0};
    assert_int_equal(renderer_render(f->renderer), WHIT_OK);
    assert_int_equal(renderer_read_color(f->renderer, &image), WHIT_OK);
    return image;
}

static const struct render_params picture_params = {.width = 33, .height = 33, .depth = 8};

static inline const float *middle(const struct image *image)
{
    return &image->pixels[4 * ((size_t)image->height / 2 * image->width + image->width / 2)];
}

static inline void assert_near(float value, double expected, double relative)
{
    if (!(fabs((double)value - expected) <= relative * fabs(expected) + 1e-30))
        fail_msg("%.9g is not %.9g within %g", (double)value, expected, relative);
}

#endif
