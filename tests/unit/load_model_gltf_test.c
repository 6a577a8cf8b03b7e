/* glTF: nodes, cameras, lights, materials and animation from the JSON. */
#include "load/model.h"
#include "load_model_fixture.h"
#include "unit.h"

/* Binary data: 60 floats, of which the first nine are a triangle. */
static const float data[60] = {
    0,     0,      0, 1, 0, 0, 0, 1, 0,          /*   0: a triangle */
    0,     0.5f,   2,                            /*  36: times */
    0,     0,      0, 1, 0, 0, 1, 5, 0,          /*  48: translations */
    1,     2,      3, 4, 5, 6, 7, 8, 9,          /*  84: instances */
    0,     0,      0, 1, 0, 0, 0, 1, 0, 1, 0, 0, /* 120: rotations */
    0.25f, 0.125f, 1, 0, 1, 1,                   /* 168: texture coordinates */
    -1,    1,      2,                            /* 192: times below 0; from 196 on: not rising */
};

#define ACCESSOR(offset, count, type)                                                              \
    "{'bufferView':0,'byteOffset':" #offset ",'componentType':5126,'count':" #count                \
    ",'type':'" type "'}"

#define ASSET "{'asset':{'version':'2.0'},"
/* The file b.bin of so many bytes as the one buffer, and its one view. */
#define BIN(bytes)                                                                                 \
    "'buffers':[{'byteLength':" #bytes ",'uri':'b.bin'}],"                                         \
    "'bufferViews':[{'buffer':0,'byteLength':" #bytes "}],"
#define ONE_NODE "'nodes':[{'mesh':0}]"

/* Writes a glTF with these members of the root, and a buffer, view, accessors and one mesh.
   Accessors: 0 positions, 1 times, 2 translations, 3 instances, 4 rotations, 5 texture
   coordinates, 6 and 7 wrong times. */
static const char *write_gltf(const char *members)
{
    static const char *const accessors[] = {ACCESSOR(0, 3, "VEC3"),     ACCESSOR(36, 3, "SCALAR"),
                                            ACCESSOR(48, 3, "VEC3"),    ACCESSOR(84, 3, "VEC3"),
                                            ACCESSOR(120, 3, "VEC4"),   ACCESSOR(168, 3, "VEC2"),
                                            ACCESSOR(192, 3, "SCALAR"), ACCESSOR(196, 3, "SCALAR")};
    char joined[8 * 96] = "";
    for (size_t i = 0; i < sizeof accessors / sizeof *accessors; i++)
        strcat(strcat(joined, i ? "," : ""), accessors[i]);
    put_data("a.bin", data, sizeof data);
    return put_json("a.gltf",
                    ASSET "'buffers':[{'byteLength':%zu,'uri':'a.bin'}],'bufferViews':[{'buffer':0,"
                          "'byteLength':%zu}],'accessors':[%s],'meshes':[{'name':'tri',"
                          "'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':5}%s}]}],%s}",
                    sizeof data, sizeof data, joined,
                    strstr(members, "'materials'") ? ",'material':0" : "", members);
}

static const struct scene *load(const char *members)
{
    assert_int_equal(fixture_load(write_gltf(members)), WHIT_OK);
    assert_int_equal(messages.errors, 0);
    return fixture.scene;
}

/* --- nodes ---------------------------------------------------------------------------------- */

TEST_IN(nodes_share_a_mesh, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load("'nodes':[{'name':'b','mesh':0,'translation':[1,2,3]},{'name':'a','children':[0,2],"
             "'scale':[2,2,2]},{'mesh':0}],'scene':0,'scenes':[{'nodes':[1]}]");
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->meshes[0].triangle_count, 1);
    assert_string_equal(scene->meshes[0].name, "tri");
    assert_int_equal(scene->instance_count, 2);
    assert_int_equal(scene->node_count, 3);
    assert_string_equal(scene->nodes[0].name, "a");
    assert_int_equal(scene->nodes[0].parent, SCENE_NONE);
    assert_string_equal(scene->nodes[1].name, "b");
    assert_int_equal(scene->nodes[1].parent, 0);
    assert_float_equal(scene->nodes[1].translation[2], 3, 0);
    assert_float_equal(scene->nodes[0].scale[1], 2, 0);
    assert_int_equal(scene->instances[0].node, 1);
    assert_int_equal(scene->instances[1].node, 2);
}

TEST_IN(matrices_are_columns, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load("'nodes':[{'mesh':0,'matrix':[1,2,3,0,4,5,6,0,7,8,9,0,10,11,12,1]}]");
    const double rows[12] = {1, 4, 7, 10, 2, 5, 8, 11, 3, 6, 9, 12};
    assert_true(scene->nodes[0].has_matrix);
    assert_memory_equal(scene->nodes[0].matrix.m, rows, sizeof rows);
}

TEST_IN(nodes_hang_below_the_given_one, fixture_begin, fixture_end)
{
    struct scene_node node;
    scene_node_init(&node, "placed", SCENE_NONE);
    assert_int_equal(scene_add_node(fixture.scene, node), 0);
    const char *path = write_gltf("'nodes':[{'mesh':0,'camera':0}],'cameras':["
                                  "{'type':'perspective','perspective':{'yfov':1,'znear':1}}]");
    assert_int_equal(load_model(fixture.scene, path, 0, true, false, NULL), WHIT_OK);
    assert_int_equal(fixture.scene->nodes[1].parent, 0);
    assert_int_equal(fixture.scene->camera_count, 0);
}

TEST_IN(only_the_default_scene_is_drawn, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load("'nodes':[{'mesh':0},{'mesh':0},{'mesh':0}],'scene':1,'scenes':[{'nodes':[0,1]},"
             "{'nodes':[2]}]");
    assert_int_equal(scene->instance_count, 1);
    assert_int_equal(scene->node_count, 1);
}

TEST_IN(instances_on_the_gpu, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load("'nodes':[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':"
             "{'TRANSLATION':3}}}}],'extensionsRequired':['EXT_mesh_gpu_instancing']");
    assert_int_equal(scene->instance_count, 3);
    assert_true(scene->instances[1].has_local);
    assert_float_equal(scene->instances[1].local.m[3], 4, 0);
    assert_float_equal(scene->instances[2].local.m[11], 9, 0);
}

/* --- cameras and lights --------------------------------------------------------------------- */

TEST_IN(camera_angles_are_exact, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load("'nodes':[{'camera':0,'translation':[0,0,5]},{'camera':1},{'mesh':0}],'cameras':["
             "{'name':'c','type':'perspective','perspective':{'yfov':0.7,'aspectRatio':1.5,"
             "'znear':0.1}},{'type':'orthographic','orthographic':{'xmag':3,'ymag':2,'zfar':9,"
             "'znear':0}}]");
    assert_int_equal(scene->camera_count, 2);
    const struct scene_camera *camera = &scene->cameras[0];
    assert_string_equal(camera->name, "c");
    assert_float_equal(camera->fov_y, 0.7f, 0);
    assert_float_equal(camera->aspect, 1.5f, 0);
    assert_float_equal(camera->eye[2], 0, 0);
    assert_float_equal(camera->target[2], -1, 0);
    assert_int_equal(camera->node, 0);
    assert_int_equal(scene->cameras[1].kind, WHIT_CAMERA_ORTHOGRAPHIC);
    assert_float_equal(scene->cameras[1].height, 4, 0);
}

/* Lights keep their intensity, divided by pi (glTF's surfaces reflect albedo / pi): 40 / pi * 0.5,
   bright enough at 1 unit to stay unscaled. */
TEST_IN(lights_keep_their_numbers, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load("'nodes':[{'mesh':0},{'extensions':{'KHR_lights_punctual':{'light':0}}}],"
             "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'spot','color':[1,0.5,0],"
             "'intensity':40,'range':7,'spot':{'innerConeAngle':0.25,'outerConeAngle':0.5}}]}}");
    assert_int_equal(scene->light_count, 1);
    const struct scene_light *light = &scene->lights[0];
    assert_int_equal(light->kind, WHIT_LIGHT_SPOT);
    assert_float_equal(light->color[1], 20.0f / 3.14159274f, 1e-5);
    assert_float_equal(light->range, 7, 0);
    assert_true(light->falloff);
    assert_float_equal(light->versine_inner, 1.0f - cosf(0.25f), 1e-6);
    assert_float_equal(light->versine_outer, 1.0f - cosf(0.5f), 1e-6);
    assert_float_equal(light->direction[2], -1, 0);
    assert_int_equal(light->node, 1);
}

static const struct scene_light *load_spot(const char *angles)
{
    own_memory char *members = string_format(
        "'nodes':[{'mesh':0},{'extensions':{'KHR_lights_punctual':{'light':0}}}],'extensions':"
        "{'KHR_lights_punctual':{'lights':[{'type':'spot','spot':{%s}}]}}",
        angles);
    assert_non_null(members);
    return &load(members)->lights[0];
}

TEST_IN(equal_cone_angles_are_a_hard_edge, fixture_begin, fixture_end)
{
    const struct scene_light *light = load_spot("'innerConeAngle':0.4,'outerConeAngle':0.4");
    assert_float_equal(light->versine_inner, 1.0f - cosf(0.4f), 1e-6);
    assert_float_equal(light->versine_outer, light->versine_inner, 0);
    assert_false(fixture_noted("cone angles"));
}

TEST_IN(wrong_cone_angles_are_cut, fixture_begin, fixture_end)
{
    const struct scene_light *light = load_spot("'innerConeAngle':1.8,'outerConeAngle':2");
    assert_float_equal(light->versine_inner, 1, 1e-6);
    assert_float_equal(light->versine_outer, 1, 1e-6);
    assert_true(fixture_noted("lights[0]: its cone angles 1.8 and 2 are cut to"));
}

/* --- materials ------------------------------------------------------------------------------ */

TEST_IN(materials_and_extensions, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'materials':[{'name':'m','emissiveFactor':[0.5,1,0.25],'doubleSided':true,"
                      "'alphaMode':'MASK','alphaCutoff':0.25,'pbrMetallicRoughness':"
                      "{'baseColorFactor':[0.1,0.2,0.3,0.4],'metallicFactor':0.5,"
                      "'roughnessFactor':0.75},'extensions':{'KHR_materials_emissive_strength':"
                      "{'emissiveStrength':8},'KHR_materials_specular':{'specularFactor':0.5},"
                      "'KHR_materials_transmission':{'transmissionFactor':0.5},"
                      "'KHR_materials_volume':{'thicknessFactor':1,'attenuationDistance':2,"
                      "'attenuationColor':[0.5,1,1]},'KHR_materials_ior':{'ior':1.25},"
                      "'KHR_materials_clearcoat':{}}}]");
    const struct scene_material *m = &scene->materials[scene->meshes[0].materials[0]];
    assert_string_equal(m->name, "m");
    assert_int_equal(m->model, WHIT_MODEL_METAL_ROUGH);
    assert_float_equal(m->emission[0], 4, 0);
    assert_float_equal(m->emission[1], 8, 0);
    assert_float_equal(m->diffuse[2], 0.3, 1e-7);
    assert_float_equal(m->opacity, 0.4, 1e-7);
    assert_int_equal(m->alpha, SCENE_ALPHA_MASK);
    assert_float_equal(m->alpha_cutoff, 0.25, 0);
    assert_float_equal(m->metallic, 0.5, 0);
    assert_float_equal(m->roughness, 0.75, 0);
    assert_float_equal(m->specular_level, 0.5, 0);
    assert_float_equal(m->transmission[0], 0.5, 0);
    assert_float_equal(m->ior, 1.25, 0);
    assert_float_equal(m->absorption[0], 0.5f * logf(2), 1e-6);
    assert_float_equal(m->absorption[1], 0, 0);
    assert_false(m->thin_walled);
    assert_true(m->two_sided);
    assert_true(fixture_noted("KHR_materials_clearcoat is not drawn"));
}

TEST_IN(specular_colors_are_f0, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'materials':[{'alphaMode':'BLEND','pbrMetallicRoughness':"
                      "{'baseColorFactor':[1,1,1,0.25]},'extensions':"
                      "{'KHR_materials_pbrSpecularGlossiness':{'diffuseFactor':[0.8,0.4,0,1],"
                      "'specularFactor':[0.25,0.5,0],'glossinessFactor':0.75}}},{'extensions':"
                      "{'KHR_materials_ior':{'ior':1},'KHR_materials_pbrSpecularGlossiness':"
                      "{'specularFactor':[0,0,0],'glossinessFactor':0}}}]");
    const struct scene_material *m = &scene->materials[0];
    assert_int_equal(m->model, WHIT_MODEL_METAL_ROUGH);
    assert_float_equal(m->diffuse[0], 0.4, 1e-6);
    assert_float_equal(m->specular[0] * 0.04f, 0.25, 1e-6);
    assert_float_equal(m->metallic, 0, 0);
    assert_float_equal(m->roughness, 0.25, 1e-6);
    assert_float_equal(m->opacity, 0.25, 0);
    assert_float_equal(scene->materials[1].diffuse[0], 1, 0);
    assert_float_equal(scene->materials[1].specular_level, 0, 0);
    assert_float_equal(scene->materials[1].ior, 1.5, 0);
}

TEST_IN(faces_have_one_side_unless_said, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'materials':[{'name':'plain'},{'doubleSided':true},{'extensions':"
                      "{'KHR_materials_transmission':{'transmissionFactor':0.5}}}]");
    assert_true(scene->materials[0].one_sided);
    assert_false(scene->materials[1].one_sided);
    /* Refracted rays leave through the faces by which they entered. */
    assert_false(scene->materials[2].one_sided);
}

TEST_IN(unlit_is_the_base_color_alone, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'materials':[{'emissiveFactor':[1,1,1],'pbrMetallicRoughness':"
                      "{'baseColorFactor':[0.5,0.25,1,1]},'extensions':{'KHR_materials_unlit':"
                      "{},'KHR_materials_transmission':{'transmissionFactor':1}}}]");
    const struct scene_material *m = &scene->materials[0];
    assert_int_equal(m->model, WHIT_MODEL_UNLIT);
    assert_float_equal(m->diffuse[1], 0.25, 0);
    assert_float_equal(m->emission[0], 0, 0);
    assert_float_equal(m->transmission[0], 0, 0);
}

TEST_IN(what_is_not_drawn_is_noted_once, fixture_begin, fixture_end)
{
    load(ONE_NODE ",'extensionsUsed':['KHR_x','KHR_y',7,'KHR_materials_ior'],'materials':["
                  "{'name':'a','extensions':{'KHR_x':{}}},{},{'name':'b','extensions':{'KHR_x':"
                  "{}}}]");
    assert_true(fixture_noted("KHR_x is not drawn: 2 materials, the first is `a`"));
    assert_false(fixture_noted("`b`"));
    assert_true(fixture_noted("the extension KHR_y is not read"));
    assert_false(fixture_noted("the extension KHR_x"));
    assert_false(fixture_noted("ior"));
}

TEST_IN(glass_without_a_volume_is_thin, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'materials':[{'extensions':{'KHR_materials_transmission':"
                      "{'transmissionFactor':1}}}]");
    assert_true(scene->materials[0].thin_walled);
    assert_true(scene->materials[0].fresnel);
}

TEST_IN(texture_transforms, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'images':[{'uri':'no%20such.png'}],'samplers':[{'wrapS':33071,"
                      "'wrapT':33648,'magFilter':9728}],'textures':[{'source':0,'sampler':0}],"
                      "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0,"
                      "'extensions':{'KHR_texture_transform':{'offset':[0.1,0.2],'scale':[2,4],"
                      "'rotation':1.5707963267948966,'texCoord':1}}}}}]");
    const struct scene_texture_use *use = &scene->materials[0].textures[SCENE_SLOT_DIFFUSE];
    const float expected[6] = {0, 4, 0.1f, -2, 0, 0.2f};
    for (int i = 0; i < 6; i++)
        assert_float_equal(use->transform[i], expected[i], 1e-6);
    assert_int_equal(use->uv_set, 1);
    assert_int_equal(use->wrap_u, SCENE_WRAP_CLAMP);
    assert_int_equal(use->wrap_v, SCENE_WRAP_MIRROR);
    assert_true(use->nearest);
    assert_true(fixture_noted("no such.png"));
}

TEST_IN(tangents_under_a_map_are_noted_once, fixture_begin, fixture_end)
{
    static const uint8_t magenta[] = "P6 1 1 255 \377\0\377";
    put_data("b.bin", data, sizeof data);
    put_data("n.ppm", magenta, sizeof magenta - 1);
    for (int mapped = 0; mapped < 2; mapped++) {
        const char *path = put_json(
            "t.gltf",
            ASSET BIN(240) "'accessors':[%s,%s],'images':[{'uri':'n.ppm'}],"
                           "'textures':[{'source':0}],'materials':[{%s}],'meshes':[{'primitives':["
                           "{'material':0,'attributes':{'POSITION':0,'TANGENT':1}},"
                           "{'material':0,'attributes':{'POSITION':0,'TANGENT':1}}]}]," ONE_NODE
                           "}",
            ACCESSOR(0, 3, "VEC3"), ACCESSOR(120, 3, "VEC4"),
            mapped ? "'normalTexture':{'index':0}" : "");
        assert_int_equal(fixture_load(path), WHIT_OK);
        assert_int_equal(fixture_noted("tangents are not read"), mapped);
    }
    assert_true(fixture_noted("texture coordinates do (2 primitives)"));
}

TEST_IN(broken_data_images_are_magenta, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'images':[{'uri':'data:image/png;base64,iVBO\\nRw0K'},"
                      "{'uri':'data:image/png,iVBO'}],'textures':[{'source':0},"
                      "{'source':1}],'materials':[{'normalTexture':{'index':1},"
                      "'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}]");
    const struct scene_texture_use *uses = scene->materials[0].textures;
    assert_int_equal(uses[SCENE_SLOT_NORMAL].texture, SCENE_NONE);
    assert_int_not_equal(uses[SCENE_SLOT_DIFFUSE].texture, SCENE_NONE);
    const uint8_t magenta[4] = {255, 0, 255, 255};
    assert_memory_equal(scene->textures[uses[SCENE_SLOT_DIFFUSE].texture].rgba, magenta, 4);
    assert_true(fixture_noted("images[0]: its data: URI is not base64"));
    assert_true(fixture_noted("magenta takes its place"));
}

TEST_IN(texture_coordinates_grow_downwards, fixture_begin, fixture_end)
{
    const struct scene *scene = load(ONE_NODE);
    const struct scene_mesh *mesh = &scene->meshes[0];
    assert_non_null(mesh->uvs[0]);
    assert_float_equal(mesh->uvs[0][2 * mesh->indices[0]], 0.25, 1e-6);
    assert_float_equal(mesh->uvs[0][2 * mesh->indices[0] + 1], 0.125, 1e-6);
}

/* Normalized shorts, which assimp would read as floats. */
TEST_IN(quantized_attributes, fixture_begin, fixture_end)
{
    const uint16_t uvs[6] = {0, 65535, 32768, 0, 65535, 65535};
    uint8_t bytes[48];
    memcpy(bytes, data, 36);
    memcpy(bytes + 36, uvs, 12);
    put_data("b c.bin", bytes, sizeof bytes);
    const struct scene_mesh *mesh = fixture_mesh(put_json(
        "q.gltf", ASSET
        "'buffers':[{'byteLength':48,'uri':'b%%20c.bin'}],'bufferViews':["
        "{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36,'byteLength':12}],"
        "'accessors':[" ACCESSOR(
            0, 3, "VEC3") ",{'bufferView':1,'componentType':5123,"
                          "'normalized':true,'count':3,'type':'VEC2'}],'meshes':[{'primitives':["
                          "{'mode':0,'attributes':{'POSITION':0}},"
                          "{'attributes':{'POSITION':0,'TEXCOORD_0':1}}]}]," ONE_NODE "}"));
    assert_int_equal(mesh->triangle_count, 1);
    const float expected[6] = {0, 1, 32768.0f / 65535, 0, 1, 1};
    for (uint32_t i = 0; i < 6; i++)
        assert_float_equal(mesh->uvs[0][2 * mesh->indices[i / 2] + i % 2], expected[i], 1e-6);
    assert_true(fixture_noted("1 primitives of points or lines"));
}

TEST_IN(accessors_without_a_view_are_zeros, fixture_begin, fixture_end)
{
    put_data("b.bin", data, 36);
    const struct scene_mesh *mesh = fixture_mesh(
        put_json("z.gltf", ASSET BIN(36) "'accessors':[" ACCESSOR(
                               0, 3, "VEC3") ",{'componentType':5126,"
                                             "'count':3,'type':'VEC2'}],'meshes':[{'primitives':[{'"
                                             "attributes':{'POSITION':0,"
                                             "'TEXCOORD_0':1}}]}]," ONE_NODE "}"));
    assert_int_equal(mesh->triangle_count, 1);
    for (uint32_t i = 0; i < 6; i++)
        assert_float_equal(mesh->uvs[0][2 * mesh->indices[i / 2] + i % 2], 0, 0);
}

/* --- skins ---------------------------------------------------------------------------------- */

/* Writes a triangle whose node has skin 0, with these attributes beside POSITION and with `skins`.
   Accessors: 1 normals, 2 joints (0, 1 and 1), 3 weights, 4 inverses of the joints' transforms, 5
   joints of which the last is 9. Vertex 0 follows joint 0, vertex 1 both alike, vertex 2 joint 1.
 */
static const char *write_skin(const char *attributes, const char *skins)
{
    static const float floats[] = {0, 0, 0, 1, 0, 0, 0, 1, 0,                        /* 0 */
                                   0, 0, 1, 0, 0, 1, 1, 1, 0,                        /* 36 */
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  /* 72 */
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1}; /* 136 */
    static const uint8_t bytes[] = {0,   7, 7, 7, 0,  1,  7, 7, 1,   7, 7, 7,        /* 200 */
                                    255, 0, 0, 0, 99, 99, 0, 0, 255, 0, 0, 0,        /* 212 */
                                    0,   7, 7, 7, 0,  1,  7, 7, 9,   7, 7, 7};       /* 224 */
    uint8_t all[sizeof floats + sizeof bytes];
    memcpy(all, floats, sizeof floats);
    memcpy(all + sizeof floats, bytes, sizeof bytes);
    put_data("b.bin", all, sizeof all);
#define BYTES(offset, more)                                                                        \
    "{'bufferView':0,'byteOffset':" #offset ",'componentType':5121,'count':3," more "'type':'"     \
    "VEC4'}"
    return put_json(
        "s.gltf",
        ASSET BIN(236) "'accessors':[%s,%s,%s,%s,%s,%s],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1%s}}]}],"
                       "'nodes':[{'mesh':0,'skin':0,'translation':[100,0,0]},"
                       "{'translation':[0,0,5],'children':[2]},"
                       "{'translation':[0,1,0],'scale':[4,2,2]},{}],"
                       "'scenes':[{'nodes':[0,1]}],'skins':[%s]}",
        ACCESSOR(0, 3, "VEC3"), ACCESSOR(36, 3, "VEC3"), BYTES(200, ""),
        BYTES(212, "'normalized':true,"), ACCESSOR(72, 2, "MAT4"), BYTES(224, ""), attributes,
        skins);
}

#define INFLUENCES ",'JOINTS_0':2,'WEIGHTS_0':3"
#define SKIN       "{'joints':[1,2],'inverseBindMatrices':4}"

TEST_IN(skins_stand_as_their_joints, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh = fixture_mesh(write_skin(INFLUENCES, SKIN));
    const float expected[9] = {0, 0, 5, 2.5f, -0.5f, 5, 0, 1, 5};
    for (uint32_t i = 0; i < 9; i++)
        assert_float_equal(mesh->positions[3 * mesh->indices[i / 3] + i % 3], expected[i], 1e-6);
    const float *normal = mesh->normals + 3 * (size_t)mesh->indices[2];
    assert_float_equal(normal[1], 2 * normal[0], 1e-6);
    assert_true(normal[0] > 0);
    /* The transform of the mesh's own node does not count. */
    assert_int_equal(fixture.scene->instances[0].node, SCENE_NONE);
    assert_true(fixture_noted("1 drawn as their joints stand at rest"));
}

/* --- animation ------------------------------------------------------------------------------ */

TEST_IN(steps_stay_steps, fixture_begin, fixture_end)
{
    const struct scene *scene =
        load(ONE_NODE ",'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
                      "'path':'translation'}},{'sampler':1,'target':{'node':0,"
                      "'path':'rotation'}}],'samplers':[{'input':1,'output':2,"
                      "'interpolation':'STEP'},{'input':1,'output':4}]}]");
    assert_int_equal(scene->channel_count, 2);
    const struct scene_channel *channel = &scene->channels[0];
    assert_int_equal(channel->interpolation, SCENE_STEP);
    assert_int_equal(channel->path, SCENE_PATH_TRANSLATION);
    assert_int_equal(channel->key_count, 3);
    assert_float_equal(channel->times_s[1], 0.5, 0);
    assert_float_equal(channel->values[7], 5, 0);
    assert_int_equal(scene->channels[1].interpolation, SCENE_LINEAR);
    assert_float_equal(scene->channels[1].values[3], 1, 0);
}

/* Each channel has times and values of its own: 3 keys of 4 floats. */
TEST_IN(keys_of_channels_count_as_memory, fixture_begin, fixture_end)
{
    uint64_t still = load(ONE_NODE)->memory_taken;
    fixture.scene->memory_limit = 2 * still + 2 * 48 + sizeof data - 1; /* data: in their file */
    const char *path =
        write_gltf(ONE_NODE ",'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
                            "'path':'translation'}},{'sampler':0,'target':{'node':0,"
                            "'path':'scale'}}],'samplers':[{'input':1,'output':2}]}]");
    assert_int_equal(fixture_load(path), WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.last_error, "animations[0].channels[1] of 3 keys would take"));
    fixture.scene->memory_limit += still + 48 + 1;
    assert_int_equal(fixture_load(path), WHIT_OK);
}

/* One channel, of the scale, by this accessor of times; `more`: in its sampler. */
#define SCALED(input, more)                                                                        \
    ONE_NODE ",'animations':[{'channels':[{'sampler':0,'target':{'node':0,'path':'scale'}}],"      \
             "'samplers':[{'input':" input ",'output':2" more "}]}]"

/* The model is drawn without a channel that cannot be played. */
TEST_IN(channels_that_cannot_be_played_are_dropped, fixture_begin, fixture_end)
{
    static const char *const rows[][2] = {
        {SCALED("7", ""), "their times do not increase"},
        {SCALED("1", ",'interpolation':'CUBICSPLINE'"), "or not as many as their times need"},
        {SCALED("1", ",'interpolation':'linear'"), "their interpolation is unknown"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint64_t before = fixture.scene->memory_taken, still = load(ONE_NODE)->memory_taken;
        const struct scene *scene = load(rows[i][0]);
        assert_int_equal(scene->memory_taken - still, still - before); /* no keys are counted */
        assert_int_equal(scene_freeze(fixture.scene), WHIT_OK);
        assert_int_equal(scene->channel_count, 0);
        assert_true(scene->instance_count > 0);
        assert_true(scene_noted(scene, rows[i][1]));
    }
}

TEST_IN(negative_times_are_played, fixture_begin, fixture_end)
{
    const struct scene *scene = load(SCALED("6", ""));
    assert_int_equal(scene->channel_count, 1);
    assert_float_equal(scene->channels[0].times_s[0], -1, 0);
}

#define TIMED_CLIP(name, node, path, input)                                                        \
    "{'name':'" name "','channels':[{'sampler':0,'target':{'node':" node ",'path':'" path          \
    "'}}],'samplers':[{'input':" input ",'output':2}]}"
#define CLIP(name, node, path) TIMED_CLIP(name, node, path, "1")
#define CLIPS                                                                                      \
    CLIP("walk", "0", "translation") "," CLIP("run", "0", "scale") "," CLIP("door", "1", "scale")

/* A pose with the move of one clip and the scale of another is in neither. */
TEST_IN(one_clip_is_played_for_a_node, fixture_begin, fixture_end)
{
    const char *members = "'nodes':[{'mesh':0},{'mesh':0}],'animations':[" CLIPS "]";
    const struct scene *scene = load(members);
    assert_int_equal(scene->channel_count, 2);
    assert_int_equal(scene->channels[0].path, SCENE_PATH_TRANSLATION);
    assert_int_equal(scene->channels[1].node, 1);
    assert_true(scene_noted(scene, "animation `walk` is played; `run` is not"));
}

/* A channel of a node with a matrix, and one of times that do not increase. */
TEST_IN(clips_that_move_nothing_leave_others_played, fixture_begin, fixture_end)
{
    const char *path =
        write_gltf("'nodes':[{'mesh':0},{'mesh':0,'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}],"
                   "'animations':[" CLIP("fixed", "1", "scale") "," TIMED_CLIP(
                       "late", "0", "scale",
                       "7") "," CLIP("walk", "0", "scale") "," CLIP("run", "0", "translation") "]");
    whit_load_params params = {.clip = "late"};
    assert_int_equal(fixture_load(path), WHIT_OK);
    assert_int_equal(fixture.scene->channel_count, 1);
    assert_int_equal(fixture.scene->channels[0].path, SCENE_PATH_SCALE);
    assert_true(fixture_noted("animation `walk` is played; `run` is not"));
    assert_int_equal(load_model(fixture.scene, path, SCENE_NONE, true, true, &params), WHIT_OK);
    assert_int_equal(fixture.scene->channel_count, 1);
    assert_true(fixture_noted("nothing of animation `late` is played; `fixed`, `walk`, `run` are"));
}

TEST_IN(a_clip_is_chosen_by_name_or_number, fixture_begin, fixture_end)
{
    const char *path = write_gltf("'nodes':[{'mesh':0},{'mesh':0}],'animations':[" CLIPS "]");
    const char *const wanted[] = {"run", "1"};
    whit_load_params params = {0};
    for (uint32_t i = 0; i < 2; ++i) {
        params.clip = wanted[i];
        assert_int_equal(load_model(fixture.scene, path, SCENE_NONE, true, true, &params), WHIT_OK);
        assert_int_equal(fixture.scene->channel_count, i + 1);
        assert_int_equal(fixture.scene->channels[i].path, SCENE_PATH_SCALE);
    }
    assert_true(scene_noted(fixture.scene, "animation `run` is played; `walk`, `door` are not"));
    params.clip = "jump";
    assert_int_equal(load_model(fixture.scene, path, SCENE_NONE, true, true, &params),
                     WHIT_ERROR_INPUT);
}

/* --- refusals ------------------------------------------------------------------------------- */

TEST_IN(bad_members_are_refused, fixture_begin, fixture_end)
{
    static const struct {
        const char *members, *reason;
    } rows[] = {
        {"'nodes':[{'children':[1]},{'children':[0]}]", "nodes[0]: is its own"},
        {"'nodes':[{'children':[2]},{'children':[2]},{'mesh':0}]",
         "nodes[1].children[0]: node 2 is already"},
        {"'nodes':[{'mesh':7}]", "nodes[0].mesh: index 7 is out of range"},
        {"'nodes':[{'mesh':0,'translation':'up'}]",
         "nodes[0]: `translation` should be an array and is a string"},
        {ONE_NODE ",'extensionsRequired':['KHR_draco_mesh_compression','EXT_moon']", "`EXT_moon`"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        fixture_refused(write_gltf(rows[i].members), rows[i].reason);
}

TEST_IN(bad_skins_are_refused, fixture_begin, fixture_end)
{
    static const struct {
        const char *attributes, *skin, *reason;
    } rows[] = {
        {",'JOINTS_0':5,'WEIGHTS_0':3", SKIN,
         "meshes[0].primitives[0]: a vertex has joint 9, the skin has 2"},
        {",'JOINTS_0':2", SKIN, "has only one of JOINTS_0 and WEIGHTS_0"},
        {INFLUENCES, "{'joints':[1,3]}", "skins[0].joints[1]: node 3 is not in the scene"},
        {INFLUENCES, "{'joints':[1,2,1],'inverseBindMatrices':4}",
         "skins[0]: has 3 joints and 2 inverseBindMatrices"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        fixture_refused(write_skin(rows[i].attributes, rows[i].skin), rows[i].reason);
}

/* A byte order mark, base64 whose last letters are escaped, and one corner too many. */
TEST_IN(odd_files_are_read, fixture_begin, fixture_end)
{
    own_memory char *text = string_format(
        "\xef\xbb\xbf" ASSET
        "'buffers':[{'byteLength':48,'uri':'data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAA'}],"
        "'bufferViews':[{'buffer':0,'byteLength':48}],'accessors':[" ACCESSOR(
            0, 4, "VEC3") "],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]," ONE_NODE
                          "}");
    assert_non_null(text);
    char *last = strstr(text, "AAAA'");
    assert_non_null(last);
    own_memory char *escaped =
        string_format("%.*s%%41%%41AA%s", (int)(last - text), text, last + 4);
    assert_int_equal(fixture_load(put_json("a.gltf", "%s", escaped)), WHIT_OK);
    assert_int_equal(fixture.scene->meshes[0].triangle_count, 1);
    assert_true(fixture_noted("primitives[0]: its last 1 corners are no triangle"));
}

TEST_IN(bad_files_are_refused, fixture_begin, fixture_end)
{
    static const struct {
        const char *text, *reason;
    } rows[] = {
        {"{'asset':{'version':'1.0'}}", "version `1.0`"},
        {"{\n'asset':\n}", "a.gltf:3:"},
        {ASSET BIN(48) "'accessors':[" ACCESSOR(
             0, 2, "VEC3") "],'meshes':[{'primitives':["
                           "{'mode':1,'attributes':{'POSITION':0}}]}]," ONE_NODE "}",
         "a.gltf: there are no triangles in it (1 primitives of points or lines)"},
        {ASSET BIN(48) "'accessors':[{'bufferView':0,'componentType':5123,'count':4000000000,"
                       "'type':'VEC3'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}]"
                       "," ONE_NODE "}",
         "accessors[0]: runs past the end of bufferViews[0]"},
        {ASSET "'buffers':[{'byteLength':4,'uri':'gone.bin'}]}",
         "buffers[0]: its file `gone.bin`: there is no such file"},
    };
    put_data("b.bin", data, 48);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        fixture_refused(put_json("a.gltf", "%s", rows[i].text), rows[i].reason);
}
