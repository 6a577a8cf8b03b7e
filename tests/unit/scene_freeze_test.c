/* scene_freeze drops or repairs invalid parts of a scene, refuses some, and adds missing ones. */
#include "../scenes.h"
#include "base/array.h"
#include "scene/effects.h"
#include "scene/pose.h"
#include "scene/scene.h"
#include "scene/shapes.h"
#include "unit.h"

static struct scene_mesh make_mesh(const float *positions, uint32_t vertices,
                                   const uint32_t *indices, uint32_t triangles)
{
    return (struct scene_mesh){
        .name = string_copy("m"),
        .vertex_count = vertices,
        .triangle_count = triangles,
        .positions = array_copy(positions, vertices, 3 * sizeof(float)),
        .indices = array_copy(indices, triangles, 3 * sizeof(uint32_t)),
    };
}

static struct scene *scene_of(struct scene_mesh mesh)
{
    struct scene *scene = scene_begin(NULL, "test");
    scene_put_again(scene, scene_add_mesh(scene, mesh), NULL);
    return scene;
}

TEST(bad_triangles_are_dropped_and_counted)
{
    const float p[] = {0,          0,      0, 1,     0, 0, 0,      1,     0, /* 0 1 2 */
                       (float)NAN, 0,      0, 2e18f, 0, 0,                   /* 3 4: unusable */
                       2,          0,      0, 1,     0, 0, 1e-30f, 0,     0, /* 5 6 7 */
                       0,          1e-30f, 0, 1e17f, 0, 0, 0,      1e17f, 0};
    const uint32_t indices[] = {0, 1, 2, 0, 1, 3, 0, 1, 4, 0,  1, 99, 0, 1,
                                5, 1, 6, 2, 0, 7, 8, 0, 9, 10, 2, 1,  0};
    struct scene_mesh mesh = make_mesh(p, 11, indices, 9);
    const struct scene_group groups[] = {{string_copy("a"), 0, 3}, {string_copy("b"), 3, 6}};
    mesh.groups = array_copy(groups, 1, sizeof groups);
    mesh.group_count = 2;
    mesh.materials = calloc(9, sizeof(uint32_t));
    own_scene *scene = scene_ready(scene_of(mesh));
    const struct scene_mesh *m = &scene->meshes[0];
    /* These triangles are kept: vertices 0 1 2, the tiny 0 7 8, the huge 0 9 10, and 2 1 0. */
    assert_int_equal(m->triangle_count, 4);
    assert_int_equal(m->indices[4], 7);
    assert_int_equal(m->indices[7], 9);
    assert_int_equal(scene->triangle_total, 4);
    assert_true(scene_noted(scene,
                            "dropped 5 triangles (1 with indices out of range, 2 with vertices not "
                            "finite or beyond 1e18, 2 without area)"));
    assert_int_equal(m->groups[0].triangle_count, 1);
    assert_int_equal(m->groups[1].first_triangle, 1);
    assert_int_equal(m->groups[1].triangle_count, 3);
    assert_true(m->hi[0] == 1e17f && m->lo[0] == 0.0f);
    assert_true(m->positions[9] == 0.0f); /* the NaN is gone */
}

/* Rounded to double, the products of the first triangle cancel, and those of the second do not. */
TEST(area_is_decided_without_rounding)
{
    const float p[] = {0x1p-60f, 0,    0,    1,         1,    0,    2,    2,    0,
                       0x1p-60f, 0,    0,    0x1.8p20f, 0,    0,    0.1f, 0,    0,
                       0.1f,     0.1f, 0.3f, 0.2f,      0.2f, 0.6f, 0.4f, 0.4f, 1.2f};
    const uint32_t indices[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    struct scene_mesh mesh = make_mesh(p, 9, indices, 3);
    mesh.materials = calloc(3, sizeof(uint32_t));
    own_scene *scene = scene_ready(scene_of(mesh));
    assert_int_equal(scene->triangle_total, 1);
    assert_int_equal(scene->meshes[0].indices[1], 1);
}

TEST(bad_spheres_are_dropped_and_counted)
{
    const float spheres[] = {1, 2,          3, 0.5f,  0, 0, 0, 0,          0, 0, 0, -1,
                             0, (float)NAN, 0, 1,     0, 0, 0, (float)NAN, 0, 0, 0, INFINITY,
                             0, 0,          0, 2e18f, 9, 9, 9, 1e-30f,     4, 5, 6, 1e17f};
    const uint32_t materials[] = {0, 0, 0, 0, 0, 0, 0, 1, 0};
    struct scene_mesh mesh = {.name = string_copy("balls"), .sphere_count = 9};
    mesh.spheres = array_copy(spheres, 1, sizeof spheres);
    mesh.materials = array_copy(materials, 1, sizeof materials);
    own_scene *scene = scene_of(mesh);
    scene_put_material(scene, material_grey("grey"));
    scene_put_material(scene, material_grey("grey"));
    scene_ready(scene);
    const struct scene_mesh *m = &scene->meshes[0];
    assert_int_equal(m->sphere_count, 3);
    assert_int_equal(scene->sphere_total, 3);
    assert_true(m->spheres[7] == 1e-30f && m->spheres[11] == 1e17f);
    assert_true(m->materials[0] == 0 && m->materials[1] == 1 && m->materials[2] == 0);
    assert_true(m->lo[0] <= -1e17f && m->hi[2] >= 1e17f);
    assert_true(scene_noted(scene, "6 spheres dropped"));
    struct scene_effects effects;
    scene_effects_scan(scene, false, &effects);
    assert_true(effects.called[SCENE_EFFECT_SPHERES]);
}

static void assert_refused(struct scene *scene)
{
    assert_int_equal(scene_freeze(scene), WHIT_ERROR_INPUT);
    scene_destroy(scene);
}

/* A mesh is of triangles or of spheres. */
TEST(mixed_meshes_are_refused)
{
    const float sphere[] = {0, 0, 0, 1};
    struct scene_mesh mesh = mesh_box(2, 2, 2);
    mesh.sphere_count = 1;
    mesh.spheres = array_copy(sphere, 1, sizeof sphere);
    assert_refused(scene_of(mesh));
}

TEST(attributes_are_mended)
{
    const float p[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5};
    const uint32_t indices[] = {0, 1, 2};
    const float normals[] = {0, 0, 0, (float)NAN, 0, 1, 0, -3, 0, 0, 0, 0};
    const float uvs[] = {0.5f, 0.25f, (float)INFINITY, 0, 2e9f, 1, 0, 0};
    struct scene_mesh mesh = make_mesh(p, 4, indices, 1);
    mesh.normals = array_copy(normals, 1, sizeof normals);
    mesh.uvs[0] = array_copy(uvs, 1, sizeof uvs);
    own_scene *scene = scene_ready(scene_of(mesh));
    const struct scene_mesh *m = &scene->meshes[0];
    const float mended[] = {0, 0, 1, 0, 0, 1, 0, -1, 0, 0, 0, 1};
    const float mended_uvs[] = {0.5f, 0.25f, 0, 0, 0, 0, 0, 0};
    assert_memory_equal(m->normals, mended, sizeof mended);
    assert_memory_equal(m->uvs[0], mended_uvs, sizeof mended_uvs);
    assert_true(scene_noted(scene, "3 normals"));
    assert_true(scene_noted(scene, "2 texture coordinates"));
}

/* Whether freezing keeps a triangle's normals of length |side|; the last one has x = `lean`. */
static bool keeps_normals(float side, float lean)
{
    const float p[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t indices[] = {0, 1, 2};
    const float normals[] = {0, 0, side, 0, 0, side, lean, 0, side};
    struct scene_mesh mesh = make_mesh(p, 3, indices, 1);
    mesh.normals = array_copy(normals, 1, sizeof normals);
    own_scene *scene = scene_ready(scene_of(mesh));
    return scene->meshes[0].normals != NULL;
}

TEST(normals_of_flat_faces_go)
{
    for (int i = 0; i < 2; ++i) {
        float side = i ? -1.0f : 1.0f;
        assert_false(keeps_normals(side, 0.0f));
        assert_false(keeps_normals(side, 5e-5f));
        assert_true(keeps_normals(side, 2e-4f));
    }
}

TEST(materials_are_mended)
{
    own_scene *scene = scene_of(mesh_box(2, 2, 2));
    struct scene_material material = material_grey("odd");
    material.diffuse[0] = (float)NAN;
    material.diffuse[1] = -1.0f;
    material.ior = 0.0f;
    scene_put_material(scene, material);
    scene_ready(scene);
    const struct scene_material *m = &scene->materials[0];
    assert_true(m->diffuse[0] == 0.7f && m->diffuse[1] == 0.0f && m->ior == 1.5f);
    assert_true(scene_noted(scene, "material `odd`: 3 values"));
}

/* A texture of one texel and a mesh with coordinates are as they should be. */
TEST(textures_without_coordinates_are_told_once)
{
    const uint8_t texels[8] = {0};
    for (uint32_t width = 1; width <= 2; ++width) {
        own_scene *scene = scene_begin(NULL, "test");
        struct scene_material material = material_grey("painted");
        material.textures[SCENE_SLOT_DIFFUSE].texture = scene_put_texture(scene, width, 1, texels);
        material.textures[SCENE_SLOT_DIFFUSE].uv_set = 1;
        scene_put(scene, mesh_box(1, 1, 1), &(struct put){.name = "box", .material = &material});
        const char *const names[] = {"bare", "naked"};
        for (int i = 0; i < 2; ++i) {
            struct scene_mesh mesh = mesh_box(1, 1, 1);
            free(mesh.uvs[0]);
            mesh.uvs[0] = NULL;
            scene_put(scene, mesh, &(struct put){.name = names[i], .material = &material});
        }
        scene_ready(scene);
        assert_int_equal(scene_noted(scene, "mesh `bare` has textures and no texture coordinates: "
                                            "they show one texel (meshes of this kind: 2)"),
                         width > 1);
    }
}

TEST(broken_references_are_refused)
{
    struct scene *scenes[4];
    for (int i = 0; i < 4; ++i)
        scenes[i] = scene_of(mesh_box(2, 2, 2));
    scenes[0]->meshes[0].materials[3] = 7;
    scene_put_again(scenes[1], 5, NULL);
    scene_put_node(scenes[2], 0, 0, 0, 0); /* its own parent */
    struct scene_material material = material_grey("m");
    material.textures[SCENE_SLOT_DIFFUSE].texture = 0;
    scene_put_material(scenes[3], material);
    for (int i = 0; i < 4; ++i)
        assert_refused(scenes[i]);
}

TEST(singular_instances_and_unused_meshes_go)
{
    own_scene *scene = scene_begin(NULL, "test");
    scene_put_mesh(scene, mesh_box(2, 2, 2)); /* unused */
    uint32_t mesh = scene_put_mesh(scene, mesh_box(2, 2, 2));
    struct scene_node node;
    scene_node_init(&node, "flat", SCENE_NONE);
    node.scale[1] = 0.0;
    uint32_t flat = scene_add_node(scene, node);
    scene_put_again(scene, mesh, &(struct put){.name = "i", .node = &flat});
    scene_put_again(scene, mesh, NULL);
    scene_ready(scene);
    assert_int_equal(scene->instance_count, 1);
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->instances[0].mesh, 0);
    assert_true(scene_noted(scene, "instance 0 `i` dropped"));
}

TEST(empty_scene_is_a_background)
{
    own_scene *scene = scene_begin(NULL, "test");
    scene_ready(scene);
    assert_int_equal(scene->camera_count, 1);
    assert_int_equal(scene->light_count, 1);
    assert_int_equal(scene->triangle_total, 0);
    assert_true(scene_noted(scene, "nothing to draw"));
}

TEST(scenes_below_the_range_of_floats_are_told)
{
    own_scene *tiny = scene_ready(scene_of(mesh_box(2e-18, 9e-18, 2e-18)));
    assert_true(scene_noted(tiny, "the scene is only 9e-18 wide"));
    own_scene *small = scene_ready(scene_of(mesh_box(2e-18, 2e-17, 2e-18)));
    assert_false(scene_noted(small, "the scene is only"));
}

/* The light comes from behind the camera. */
TEST(missing_camera_and_light_are_made)
{
    own_scene *scene = scene_ready(scene_of(mesh_box(2, 2, 2)));
    const struct scene_camera *camera = &scene->cameras[0];
    const struct scene_light *light = &scene->lights[0];
    double along = 0.0;
    for (int i = 0; i < 3; ++i)
        along += (camera->target[i] - camera->eye[i]) * light->direction[i];
    assert_true(camera->made_by_whit && light->made_by_whit && scene->environment.made_by_whit);
    assert_true(along > 0.0);
    assert_true(scene->ambient[0] == 0.1f && scene->environment.horizon[0] > 0.5f);
}

TEST(own_light_gets_no_company)
{
    own_scene *scene = scene_of(mesh_box(2, 2, 2));
    struct scene_light light = {.kind = WHIT_LIGHT_POINT, .node = SCENE_NONE, .color = {1, 1, -1}};
    scene_put_light(scene, light);
    scene_ready(scene);
    assert_int_equal(scene->light_count, 1);
    assert_true(scene->lights[0].color[2] == 0.0f);
    assert_true(scene->ambient[0] == 0.0f && scene->environment.horizon[0] == 0.0f);
}

/* 2 * steps^2 glowing triangles. */
static struct scene *panel_of(struct scene_material material, uint32_t steps)
{
    struct scene_mesh panel;
    assert_int_equal(shape_plane(2.0, 1.0, steps, 1.0, &panel), WHIT_OK);
    struct scene *scene = scene_of(mesh_box(2, 2, 2));
    scene_put_material(scene, material_grey("plain"));
    struct scene_node node;
    scene_node_init(&node, "up", SCENE_NONE);
    node.translation[1] = 5.0;
    node.scale[0] = 3.0;
    uint32_t up = scene_add_node(scene, node);
    scene_put(scene, panel, &(struct put){.material = &material, .node = &up});
    return scene;
}

static struct scene_material glowing(float radiance)
{
    struct scene_material material = material_grey("panel");
    material.emission[0] = material.emission[1] = material.emission[2] = radiance;
    return material;
}

static struct scene *panel_scene(float radiance, uint32_t steps)
{
    return panel_of(glowing(radiance), steps);
}

/* A lamp of many triangles becomes samples whose intensities add up to radiance * world area / pi,
   and which lie on the panel. */
TEST(tessellated_lamps_become_points)
{
    own_scene *scene = panel_scene(10.0f, 6);
    own_pose pose;
    assert_int_equal(scene_pose_init(scene_ready(scene), 0.0, &pose), WHIT_OK);
    assert_int_equal(pose.light_count, 16);
    double sum = 0.0, mean_x = 0.0;
    for (uint32_t i = 0; i < pose.light_count; ++i) {
        const struct scene_light *light = &pose.lights[i];
        assert_int_equal(light->kind, WHIT_LIGHT_AREA_SAMPLE);
        assert_true(fabs(light->position[1] - 5.0) < 1e-9 && fabs(light->position[0]) <= 3.0);
        assert_true(fabs(light->position[2]) <= 0.5);
        assert_true(fabs(light->direction[1] - 1.0) < 1e-12);
        sum += (double)light->color[0];
        mean_x += light->position[0] / 16.0;
    }
    assert_true(fabs(sum - 10.0 * 6.0 / 3.14159265358979) < 1e-4);
    assert_true(fabs(mean_x) < 0.3);
    assert_true(scene->ambient[0] == 0.03f);
}

TEST(lamps_light_by_their_opacity)
{
    for (uint32_t steps = 1; steps <= 6; steps += 5) {
        struct scene_material material = glowing(10.0f);
        material.opacity = 0.25f;
        material.alpha = SCENE_ALPHA_BLEND;
        own_scene *thin = panel_of(material, steps);
        material.alpha = SCENE_ALPHA_MASK; /* below the cutoff */
        own_scene *none = panel_of(material, steps);
        scene_ready(thin);
        double sum = 0.0, area = steps == 1 ? 1.0 : 6.0 / 3.14159265358979;
        for (uint32_t i = 0; i < thin->light_count; ++i)
            sum += (double)thin->lights[i].color[0];
        assert_true(fabs(sum - 2.5 * area) < 1e-5);
        scene_ready(none);
        assert_int_equal(none->light_count, 1);
        assert_int_equal(none->lights[0].kind, WHIT_LIGHT_DIRECTIONAL);
    }
}

TEST(flat_lamps_become_rectangles)
{
    own_scene *scene = panel_scene(10.0f, 1);
    own_pose pose;
    assert_int_equal(scene_pose_init(scene_ready(scene), 0.0, &pose), WHIT_OK);
    assert_int_equal(pose.light_count, 1);
    const struct scene_light *light = &pose.lights[0];
    assert_int_equal(light->kind, WHIT_LIGHT_RECTANGLE);
    assert_true(light->made_by_whit && light->color[0] == 10.0f);
    assert_true(fabs(light->direction[1] - 1.0) < 1e-12);
    /* From one corner of the panel, -3..3 by -0.5..0.5, to the opposite one. */
    const double *p = light->position, *u = light->edge_u, *v = light->edge_v;
    assert_true(fabs(fabs(p[0]) - 3.0) < 1e-9 && fabs(fabs(p[2]) - 0.5) < 1e-9);
    assert_true(fabs(p[0] + u[0] + v[0] + p[0]) < 1e-9 && fabs(p[2] + u[2] + v[2] + p[2]) < 1e-9);
    assert_true(fabs(p[1] - 5.0) < 1e-9 && fabs(u[1]) + fabs(v[1]) < 1e-9);
    assert_true(u[2] * v[0] - u[0] * v[2] > 5.999);
}

/* Two triangles that form no parallelogram each become a light; they shine upwards also in a
   mirrored node. */
TEST(single_triangles_become_lights)
{
    own_scene *scene = panel_scene(10.0f, 1);
    own_pose pose;
    scene->meshes[1].positions[0] *= 1.5f;
    scene->nodes[scene->node_count - 1].scale[0] = -3.0;
    assert_int_equal(scene_pose_init(scene_ready(scene), 0.0, &pose), WHIT_OK);
    assert_int_equal(pose.light_count, 2);
    for (uint32_t i = 0; i < 2; ++i) {
        const struct scene_light *light = &pose.lights[i];
        const double *u = light->edge_u, *v = light->edge_v;
        assert_int_equal(light->kind, WHIT_LIGHT_TRIANGLE);
        assert_true(light->direction[1] > 0.999);
        assert_true(u[2] * v[0] - u[0] * v[2] > 2.0);
    }
}

TEST(faint_glow_lights_nothing)
{
    own_scene *scene = scene_ready(panel_scene(0.001f, 1));
    assert_int_equal(scene->light_count, 1);
    assert_int_equal(scene->lights[0].kind, WHIT_LIGHT_DIRECTIONAL);
}
