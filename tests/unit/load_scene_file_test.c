/* whit's own scene files: their meaning, and the places that errors name. */
#include "load/texture.h"
#include "load_model_fixture.h"
#include "scene/pose.h"

/* In texts ' stands for ". */
static whit_result load_text(const char *text, struct scene **out)
{
    const whit_log log = messages_log(&messages);
    const char *path = put_json("test.json", "%s", text);
    whit_result result = load_scene(&log, path, NULL, out);
    unlink(path);
    return result;
}

/* Checks that there is one error, which begins, after the file's name, with `expected`: its line
   and column. */
static void assert_error(const char *text, const char *expected)
{
    struct scene *scene = NULL;
    assert_int_equal(load_text(text, &scene), WHIT_ERROR_INPUT);
    assert_null(scene);
    assert_int_equal(messages.errors, 1);
    const char *message = messages.last_error + strlen(folder);
    own_memory char *begin = string_format("/test.json:%s", expected);
    if (strncmp(message, begin, strlen(begin)) != 0)
        fail_msg("expected `%s`, got `%s`", expected, message);
}

static struct scene *load_fine(const char *text)
{
    struct scene *scene = NULL;
    whit_result result = load_text(text, &scene);
    if (result != WHIT_OK)
        fail_msg("refused: %s", messages.last_error);
    return scene;
}

TEST_IN(errors_name_line_and_column, folder_begin, folder_end)
{
    assert_error("{\n  'objects': [,]\n}", "2:15: ");
    assert_error("{'ambient': 0.5\n 'objects': [1 2]}",
                 "2:10: '}' expected near '\"objects\"'; is a comma missing before it?");
    assert_error("{'objects': [\n1 2]}",
                 "2:3: ']' expected near '2'; is a comma missing before it?");
    assert_error("{'objects': [],\n}",
                 "2:1: string or '}' expected near '}'; is the comma before it one too many?");
    assert_error("{'objects': [\n{},\n]}",
                 "3:1: unexpected token near ']'; is the comma before it one too many?");
    assert_error("{ // white\n'ambient': 1}",
                 "1:3: string or '}' expected near '/'; JSON has no comments, but");
    assert_error("{'ambient': 1 // white\n}",
                 "1:15: '}' expected near '/'; JSON has no comments, but");
    assert_error("{'materials': {'a': {'mirror': 1}}}",
                 "1:22: materials.a.mirror: unknown key; did you mean `reflection`?");
    assert_error("{'camera': {'position': [0, 1, 5]}}",
                 "1:13: camera.position: unknown key; did you mean `eye`?");
    assert_error("{'camera': {'lookat': [0, 1, 0]}}",
                 "1:13: camera.lookat: unknown key; did you mean `target`?");
    assert_error("{'objects': [{'type': 'box'}]}",
                 "1:15: objects[0].type: unknown key; did you mean `shape`?");
    assert_error("{'lights': [{'type': 'spot'}]}",
                 "1:14: lights[0].type: unknown key; did you mean `kind`?");
    assert_error("{'lights': [{'kind': 'spot', 'angle': 30}]}",
                 "1:30: lights[0].angle: unknown key; did you mean `outer`?");
    assert_error("{\n  'object': []\n}", "2:3: object: unknown key; did you mean `objects`?");
    assert_error("{ 'objects': [\n {'shape':'box'},\n {'shape': 'bxo'}\n] }",
                 "3:3: objects[1].shape: `bxo` is not one of: box, plane, sphere");
    assert_error("{'objects':[{'shape':'sphere','tube':1}]}",
                 "1:31: objects[0].tube: a sphere has no `tube`");
    assert_error("{'objects':[{'shape':'sphere',\n'radius':'big'}]}",
                 "2:1: objects[0].radius: a number is expected");
    assert_error("{'objects':[{'shape':'box',\n'translation':[0,\n0,\n'x']}]}",
                 "4:1: objects[0].translation[2]: a number is expected");
    assert_error("{'objects':[{'shape':'box', 'translation':[0,0]}]}",
                 "1:29: objects[0].translation: 3 numbers in [ ] are expected");
    assert_error("{'objects':[{'shape':'plane', 'size':[1,2,3]}]}",
                 "1:31: objects[0].size: a number, or 2 numbers in [ ], are expected");
    assert_error("{'objects':[{'shape':'box', 'scale':'big'}]}",
                 "1:29: objects[0].scale: a number, or 3 numbers in [ ], are expected");
    assert_error("{'environment': {'map': 'a.hdr',\n'zenith': 1}}",
                 "1:18: environment.map: `map` and `zenith` exclude each other");
    assert_error("{'objects': [\n{}", "2:2: ']' expected near end of file; it has to be closed");
    assert_error("[]", "1:1: an object { } is expected");
    assert_error("{'a': 1, 'a': 2}", "1:");
    assert_error("", "1:1: ");
}

/* Strings with braces, escapes and wide letters must not confuse the search for a place. */
TEST_IN(places_survive_odd_strings, folder_begin, folder_end)
{
    assert_error("{ 'description': '} ] \\' { \\\\',\n  'materials': {'\xc3\xa4': {'diffuse': 1}, "
                 "'b': {'diffuse': -1}}}",
                 "2:44: materials.b.diffuse: -1 is out of range");
    assert_error("{'objects':[{'name':'[1,{','shape':'box','children':[1]}]}",
                 "1:54: objects[0].children[0]: an object { } is expected");
}

TEST_IN(senseless_content_is_refused, folder_begin, folder_end)
{
    assert_error("{'materials':{'glass':{}},'objects':[{'shape':'box','material':'glas'}]}",
                 "1:53: objects[0].material: there is no material `glas`; did you mean `glass`?");
    assert_error("{'objects':[{'name':'x'}]}",
                 "1:13: objects[0]: an object needs a `shape`, a `model` or `children`");
    assert_error("{'objects':[{'shape':'box','scale':0}]}", "1:28: objects[0].scale: a scale of 0");
    assert_error("{'objects':[{'shape':'box','matrix':[1,0,0,0,0,1,0,0,0,0,1,0],'scale':2}]}",
                 "1:28: objects[0].matrix: `matrix` and `scale` exclude each other");
    assert_error("{'objects':[{'model':'nowhere.obj'}]}",
                 "1:14: objects[0].model: `nowhere.obj`: there is no such file");
    assert_error("{'objects':[{'model':'other.json'}]}",
                 "1:14: objects[0].model: `other.json` is no model");
    assert_error("{'lights':[{'kind':'spot','position':[0,1,0]}]}",
                 "1:12: lights[0]: this light needs a `direction` or a `target`");
    assert_error("{'camera':{'eye':[1,2,3],'target':[1,2,3]}}",
                 "1:2: camera: `eye` and `target` are the same point");
    assert_error("{'environment':{'map':'no.hdr'}}",
                 "1:17: environment.map: `no.hdr`: there is no such file");
    assert_error("{'environment':'#12345'}", "1:2: environment: `#12345` is no colour");
    assert_error("{'materials':{'m':{'diffuse':1,'metallic':1}}}",
                 "1:20: materials.m.diffuse: `diffuse` does not go with `metallic`; use "
                 "`base_color`");
    assert_error("{'materials':{'m':{'color':1}}}",
                 "1:20: materials.m.color: `color` goes with `unlit` only; use `diffuse`");
    assert_error("{'materials':{'m':{'unlit':true,'shininess':1}}}",
                 "1:33: materials.m.shininess: `shininess` does not go with `unlit`");
    assert_error("{'objects':[{'shape':'box','model':'x.obj'}]}",
                 "1:28: objects[0].model: `shape` and `model` exclude each other");
    assert_error("{'objects':[{'children':[],'radius':1}]}",
                 "1:28: objects[0].radius: a group has no `radius`");
    assert_error("{'lights':[{'position':[0,1,0],'direction':[0,1,0]}]}",
                 "1:32: lights[0].direction: a point light has no `direction`");
    assert_error("{'lights':[{'kind':'rectangle','u':[1,0,0],'v':[0,0,1]}]}",
                 "1:12: lights[0]: a rectangle light needs a `position`");
    assert_error("{'lights':[{'kind':'rectangle','position':[0,1,0],'u':[1,0,0],'v':[2,0,0]}]}",
                 "1:12: lights[0]: the light has no area");
    assert_error("{'lights':[{'kind':'triangle','points':[[0,0,0],[1,0,0]]}]}",
                 "1:12: lights[0]: a triangle light needs three `points`");
    assert_error("{'camera':{},\n'cameras':[]}",
                 "2:1: cameras: `camera` and `cameras` exclude each other");
    assert_error("{'objects':[{'shape':'box','animation':{'scale':{'times':[1,1],'values':[[1,1,1],"
                 "[1,1,1]]}}}]}",
                 "1:61: objects[0].animation.scale.times[1]: times must increase");
    assert_error("{'objects':[{'shape':'box','repeat':{'count':[100000,100000,1]}}]}",
                 "1:38: objects[0].repeat.count: more than 4000000 copies");
}

TEST_IN(camera_kinds_do_not_mix, folder_begin, folder_end)
{
    assert_error("{'camera':{'panorama':true,\n'fov':40}}",
                 "2:1: camera.fov: a panorama has no `fov`");
    assert_error("{'camera':{'panorama':true,\n'focus':4}}",
                 "2:1: camera.focus: a panorama has no `focus`");
    assert_error("{'camera':{'height':2,\n'lens':1}}",
                 "2:1: camera.lens: a parallel view (`height`) has no lens");
    assert_error("{'camera':{\n'focus':1}}",
                 "2:1: camera.focus: `focus` is of a camera with a `lens`");
    assert_error("{'camera':{\n'lens':-1}}", "2:1: camera.lens: ");
    assert_error("{'camera':{'lens':1,\n'focus':0}}", "2:1: camera.focus: ");
    assert_error("{'camera':{\n'panorama':1}}", "2:1: camera.panorama: ");
    assert_error("{'camera':{\n'fov':180}}", "2:1: camera.fov: ");
}

TEST_IN(camera_kinds_are_read, folder_begin, folder_end)
{
    own_scene *scene = load_fine("{'cameras':[{'lens':0.25,'focus':7,'fov':179.9},{'lens':0.5},{'"
                                 "panorama':true},{'panorama':false,'fov':0.001}]}");
    const struct scene_camera *c = scene->cameras;
    assert_int_equal(c[0].kind, WHIT_CAMERA_PERSPECTIVE);
    assert_true(c[0].lens_radius == 0.25f && c[0].focus_distance == 7.0f);
    assert_true(fabs((double)c[0].fov_y - 3.1398473) < 1e-6);
    assert_true(c[1].lens_radius == 0.5f && c[1].focus_distance == 0.0f);
    assert_int_equal(c[2].kind, WHIT_CAMERA_PANORAMA);
    assert_int_equal(c[3].kind, WHIT_CAMERA_PERSPECTIVE);
    assert_true(fabs((double)c[3].fov_y - 1.7453293e-5) < 1e-11 && c[3].lens_radius == 0.0f);
}

TEST_IN(nested_repeats_have_a_limit, folder_begin, folder_end)
{
    assert_error("{'objects':[{'repeat':{'count':[2000,1,1]},'children':[{'shape':'box','repeat':{'"
                 "count':[2001,1,1]}}]}]}",
                 "1:13: objects[0]: more than 4000000 instances");
}

TEST_IN(deep_children_are_refused, folder_begin, folder_end)
{
    enum { DEEP = 100 };
    char text[DEEP * 32] = "{'objects':[";
    for (int i = 0; i < DEEP; ++i)
        strcat(text, "{'children':[");
    for (int i = 0; i < DEEP; ++i)
        strcat(text, "]}");
    strcat(text, "]}");
    assert_error(text, "1:");
}

TEST_IN(shapes_are_placed, folder_begin, folder_end)
{
    own_scene *scene = load_fine(
        "{'objects':[{'shape':'box','size':[1,2,3],'translation':[5,0,0],'rotation':[0,90,0],'"
        "scale':2,'children':[{'shape':'sphere','segments':8,'rings':4,'translation':[0,0,1]}]}]}");
    own_pose pose;
    assert_int_equal(scene->mesh_count, 2);
    assert_int_equal(scene->meshes[0].triangle_count, 12);
    assert_int_equal(scene->meshes[1].triangle_count, 2 * 8 * 3);
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    /* A quarter turn about y takes z to x: the child sits at 5 + 2 * 1. */
    assert_true(fabs(pose.instances[1].m[3] - 7.0) < 1e-12);
    assert_true(fabs(pose.instances[1].m[11]) < 1e-12);
}

TEST_IN(equal_shapes_share_a_mesh, folder_begin, folder_end)
{
    own_scene *scene = load_fine("{'objects':[{'shape':'box'},{'shape':'box','translation':[3,0,0]}"
                                 ",{'shape':'box','size':2}]}");
    assert_int_equal(scene->mesh_count, 2);
    assert_int_equal(scene->instance_count, 3);
    assert_int_equal(scene->instances[0].mesh, scene->instances[1].mesh);
    assert_int_equal(scene->material_count, 1);
}

TEST_IN(repeat_places_copies_around, folder_begin, folder_end)
{
    own_scene *scene =
        load_fine("{'objects':[{'translation':[0,7,0],'repeat':{'count':[3,1,2],'step':[10,0,4]},'"
                  "children':[{'shape':'box'},{'shape':'cone'}]}]}");
    own_pose pose;
    double min_x = 1e9, max_x = -1e9, max_z = -1e9;
    assert_int_equal(scene->instance_count, 12);
    assert_int_equal(scene->mesh_count, 2);
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    for (uint32_t i = 0; i < pose.instance_count; ++i) {
        min_x = fmin(min_x, pose.instances[i].m[3]);
        max_x = fmax(max_x, pose.instances[i].m[3]);
        max_z = fmax(max_z, pose.instances[i].m[11]);
        assert_true(pose.instances[i].m[7] == 7.0);
    }
    assert_true(min_x == -10.0 && max_x == 10.0 && max_z == 2.0);
}

TEST_IN(repeated_animation_moves_every_copy, folder_begin, folder_end)
{
    own_scene *scene =
        load_fine("{'objects':[{'shape':'box','repeat':{'count':[4,1,1],'step':[3,0,0]},'animation'"
                  ":{'translation':{'times':[0,2],'values':[[0,0,0],[0,8,0]]}}}]}");
    own_pose pose;
    assert_int_equal(scene->channel_count, 4);
    assert_int_equal(scene_pose_init(scene, 1.0, &pose), WHIT_OK);
    for (uint32_t i = 0; i < 4; ++i)
        assert_true(fabs(pose.instances[i].m[7] - 4.0) < 1e-6);
}

TEST_IN(sphereflake_is_instances, folder_begin, folder_end)
{
    own_scene *scene = load_fine(
        "{'objects':[{'shape':'sphereflake','level':2,'segments':8,'rings':4,'radius':2}]}");
    own_pose pose;
    assert_int_equal(scene->mesh_count, 1);
    assert_int_equal(scene->instance_count, 91);
    assert_int_equal(scene_pose_init(scene, 0.0, &pose), WHIT_OK);
    assert_true(pose.instances[0].m[0] == 2.0);
    assert_true(fabs(pose.instances[90].m[0]) < 0.3);
}

/* "ball" and "spheres" are sphere primitives; equal balls share a mesh, each list has its own
   mesh. */
TEST_IN(balls_are_spheres, folder_begin, folder_end)
{
    struct scene *scene = load_fine(
        "{'materials':{'a':{'diffuse':1},'b':{'diffuse':0.5}},'objects':[{'shape':'ball','radius':"
        "2,'center':[1,2,3],'material':'b'},{'shape':'ball','radius':2,'center':[1,2,3],'material':"
        "'b','scale':[1,2,3]},{'shape':'ball','radius':2,'material':'b'},{'shape':'balls','spheres'"
        ":[[0,0,0,1],[5,0,-1,0.25]]},{'shape':'sphereflake','level':2,'balls':true}]}");
    assert_int_equal(scene->mesh_count, 4);
    assert_int_equal(scene->instance_count, 5);
    assert_int_equal(scene->triangle_total, 0);
    assert_int_equal(scene->sphere_total, 1 + 1 + 1 + 2 + 91);
    const float first[4] = {1, 2, 3, 2}, second[4] = {5, 0, -1, 0.25f};
    assert_memory_equal(scene->meshes[0].spheres, first, sizeof first);
    assert_memory_equal(scene->meshes[2].spheres + 4, second, sizeof second);
    assert_string_equal(scene->materials[scene->meshes[0].materials[0]].name, "b");
    assert_true(scene->meshes[0].lo[1] <= 0.0f && scene->meshes[0].lo[1] > -1e-6f);
    assert_true(scene->meshes[0].hi[1] >= 4.0f && scene->meshes[0].hi[1] < 4.00001f);
    assert_int_equal(scene->meshes[3].sphere_count, 91);
    scene_destroy(scene);
    assert_error("{'objects':[{'shape':'ball','segments':9}]}",
                 "1:29: objects[0].segments: a ball has no `segments`");
    assert_error("{'objects':[{'shape':'ball','radius':0}]}",
                 "1:29: objects[0].radius: 0 is out of range (1e-15 to 1e+15)");
    assert_error("{'objects':[{'shape':'balls'}]}",
                 "1:13: objects[0].spheres: 1 to 10000000 spheres [x, y, z, radius] are expected");
    assert_error("{'objects':[{'shape':'balls','spheres':[[0,0,0]]}]}",
                 "1:41: objects[0].spheres[0]: 4 numbers in [ ] are expected");
    assert_error("{'objects':[{'shape':'balls','spheres':[[0,0,0,-1]]}]}",
                 "1:41: objects[0].spheres[0]: the radius must be from 1e-15 to 1e+15");
}

TEST_IN(materials_mean_what_they_say, folder_begin, folder_end)
{
    own_scene *scene = load_fine(
        "{'materials':{\n'plain':{'diffuse':'#ff0080'},\n'glass':{'transmission':0.9,'ior':1.33,'"
        "absorption':[1,2,3]},\n'mirror':{'reflection':[0.9,0.8,0.7]},\n'metal':{'base_color':0.5,'"
        "metallic':1,'roughness':0.25},\n'veil':{'opacity':0.5},\n'grid':{'alpha_cutoff':0.3},\n'"
        "sign':{'unlit':true,'color':[0,1,0]},\n'wine':{'transmission':1,'priority':3,'one_sided':"
        "true},\n'stage':{'shadow_catcher':true}}}");
    const struct scene_material *m = material_named(scene, "plain");
    assert_true(m->diffuse[0] == 1.0f && m->diffuse[1] == 0.0f);
    assert_true(fabsf(m->diffuse[2] - 0.21586f) < 1e-4f); /* 0x80 in sRGB */
    assert_memory_equal(m->ambient, m->diffuse, sizeof m->diffuse);
    assert_int_equal(m->origin.line, 2);
    m = material_named(scene, "glass");
    assert_true(m->fresnel && m->ior == 1.33f && m->transmission[1] == 0.9f);
    assert_true(m->absorption[2] == 3.0f && m->diffuse[0] == 0.0f);
    assert_int_equal(m->origin.line, 3);
    m = material_named(scene, "mirror");
    assert_true(!m->fresnel && m->reflection[2] == 0.7f && m->diffuse[0] < 0.08f);
    m = material_named(scene, "metal");
    assert_int_equal(m->model, WHIT_MODEL_METAL_ROUGH);
    assert_true(m->metallic == 1.0f && m->roughness == 0.25f && m->diffuse[1] == 0.5f);
    assert_int_equal(material_named(scene, "veil")->alpha, SCENE_ALPHA_BLEND);
    assert_int_equal(material_named(scene, "grid")->alpha, SCENE_ALPHA_MASK);
    assert_int_equal(material_named(scene, "sign")->model, WHIT_MODEL_UNLIT);
    assert_int_equal(material_named(scene, "wine")->priority, 3);
    assert_true(material_named(scene, "wine")->one_sided);
    assert_true(material_named(scene, "stage")->shadow_catcher);
    assert_false(m->one_sided || m->shadow_catcher || m->priority);
}

TEST_IN(patterns_become_textures, folder_begin, folder_end)
{
    own_scene *scene =
        load_fine("{'materials':{'a':{'texture':{'checker':{'colors':[1,'#204060'],'size':8}}},'b':"
                  "{'texture':{'checker':{'colors':[1,'#204060']}}},'c':{'texture':{'brick':{'"
                  "colors':[1,0]},'rotation':90,'wrap':'mirror'}}}}");
    const struct scene_texture_use *a = &material_named(scene, "a")->textures[0];
    const struct scene_texture_use *c = &material_named(scene, "c")->textures[0];
    assert_int_equal(scene->texture_count, 2); /* equal patterns are one */
    const uint8_t texels[] = {255, 255, 255, 255, 32,  64,  96,  255,
                              32,  64,  96,  255, 255, 255, 255, 255};
    assert_int_equal(scene->textures[a->texture].width, 2);
    assert_memory_equal(scene->textures[a->texture].rgba, texels, sizeof texels);
    assert_true(a->nearest && a->transform[0] == 4.0f && a->transform[4] == 4.0f);
    assert_true(fabsf(c->transform[1] + 1.0f) < 1e-6f && fabsf(c->transform[3] - 1.0f) < 1e-6f);
    assert_int_equal(c->wrap_u, SCENE_WRAP_MIRROR);
    assert_true(material_named(scene, "a")->diffuse[0] == 1.0f);
}

/* Bytes of texel `row` of a pattern one texel wide. */
static const uint8_t *texel_of(const struct scene *scene, const char *material,
                               enum scene_slot slot, uint32_t row)
{
    const struct scene_texture_use *use = &material_named(scene, material)->textures[slot];
    return scene->textures[use->texture].rgba + 4 * (size_t)row;
}

TEST_IN(patterns_of_numbers_are_not_encoded, folder_begin, folder_end)
{
    static const char ramp[] = "{'gradient':{'colors':[0,0.5],'size':";
    char text[1024];
    snprintf(
        text, sizeof text,
        "{'materials':{'comment':'none','a':{'texture':%s1.0}},'opacity_map':%s4}}},'b':{'metallic'"
        ":1,'specular_map':%s1}},'normal_map':{'checker':{'colors':['#8080ff','#8080ff']}}}}}",
        ramp, ramp, ramp);
    own_scene *scene = load_fine(text);
    assert_int_equal(texel_of(scene, "a", SCENE_SLOT_DIFFUSE, 255)[0], 188);
    assert_int_equal(texel_of(scene, "a", SCENE_SLOT_OPACITY, 255)[0], 128);
    assert_int_equal(texel_of(scene, "a", SCENE_SLOT_OPACITY, 102)[0], 51);
    assert_int_equal(texel_of(scene, "b", SCENE_SLOT_SPECULAR, 255)[0], 188);
    assert_int_equal(texel_of(scene, "b", SCENE_SLOT_NORMAL, 0)[0], 128);
    const struct scene_material *a = material_named(scene, "a");
    assert_int_equal(a->textures[SCENE_SLOT_DIFFUSE].wrap_v, SCENE_WRAP_CLAMP);
    assert_int_equal(a->textures[SCENE_SLOT_OPACITY].wrap_v, SCENE_WRAP_REPEAT);
    assert_error("{'materials':{'a':{'texture':{'brick':{'colors':[0,[0,2,0]]}}}}}",
                 "1:52: materials.a.texture.brick.colors[1]: patterns are at most 1");
}

TEST_IN(maps_without_their_factor_are_noted, folder_begin, folder_end)
{
    static const char *const maps[] = {"emission", "specular", "transmission"};
    for (int i = 0; i < 3; ++i) {
        for (int given = 0; given < 2; ++given) {
            char text[256];
            snprintf(text, sizeof text,
                     "\xef\xbb\xbf{'objects':[\n{'shape':'box','material':{'%s':%d,'%s_map':{'"
                     "brick':{'colors':[0,1]}}}}]}",
                     maps[i], given, maps[i]);
            own_scene *scene = load_fine(text);
            snprintf(text, sizeof text, "test.json:2: `%s_map` shows nothing", maps[i]);
            assert_int_equal(scene_noted(scene, text), !given);
        }
    }
}

static void lights_cameras_and_sky(void)
{
    own_scene *scene =
        load_fine("{'ambient':[0.1,0.2,0.3],'environment':{'map':'sky.pfm','scale':2},'cameras':[{'"
                  "eye':[0,0,3],'fov':90},{'eye':[0,0,3],'height':2}],'lights':[{'kind':'spot','"
                  "position':[0,4,0],'target':[0,0,0],'outer':60,'inner':30,'color':[1,0.5,0],'"
                  "intensity':8},{'kind':'directional','direction':[0,-3,4]}]}");
    assert_int_equal(scene->environment.kind, WHIT_ENVIRONMENT_MAP);
    assert_int_equal(scene->environment.width, 2);
    assert_true(scene->environment.rgb[0] == 4.0f); /* PFM starts at the bottom row */
    assert_true(scene->environment.scale[1] == 2.0f);
    assert_true(scene->ambient[2] == 0.3f);
    assert_true(fabsf(scene->cameras[0].fov_y - 1.5707964f) < 1e-6f);
    assert_int_equal(scene->cameras[1].kind, WHIT_CAMERA_ORTHOGRAPHIC);
    const struct scene_light *spot = &scene->lights[0], *sun = &scene->lights[1];
    assert_true(spot->direction[1] == -1.0 && spot->falloff && spot->color[1] == 4.0f);
    assert_true(fabsf(spot->versine_outer - 0.5f) < 1e-6f && spot->versine_inner < 0.14f);
    assert_true(fabs(sun->direction[2] - 0.8) < 1e-12 && !sun->falloff);
}

TEST_IN(flat_emitters, folder_begin, folder_end)
{
    own_scene *scene = load_fine("{'lights':[{'kind':'rectangle','position':[1,4,2],'u':[2,0,0],'v'"
                                 ":[0,0,6],'intensity':8,'two_sided':true},{'kind':'triangle','"
                                 "points':[[1,1,1],[3,1,1],[1,2,1]],'color':[1,2,3]}]}");
    const struct scene_light *panel = &scene->lights[0], *corner = &scene->lights[1];
    assert_int_equal(panel->kind, WHIT_LIGHT_RECTANGLE);
    assert_true(panel->position[0] == 0.0 && panel->position[2] == -1.0 && panel->two_sided);
    assert_true(panel->edge_u[0] == 2.0 && panel->edge_v[2] == 6.0 && panel->color[0] == 8.0f);
    assert_int_equal(corner->kind, WHIT_LIGHT_TRIANGLE);
    assert_true(corner->position[1] == 1.0 && !corner->two_sided && corner->color[2] == 3.0f);
    assert_true(corner->edge_u[0] == 2.0 && corner->edge_v[1] == 1.0);
}

TEST_IN(sky_test, folder_begin, folder_end)
{
    const char header[] = "PF\n2 2\n-1.0\n";
    float pixels[12] = {0};
    for (int i = 6; i < 12; ++i)
        pixels[i] = 4.0f;
    uint8_t file[sizeof header - 1 + sizeof pixels];
    memcpy(file, header, sizeof header - 1);
    memcpy(file + sizeof header - 1, pixels, sizeof pixels);
    put_data("sky.pfm", file, sizeof file);
    lights_cameras_and_sky();
}

/* An uncompressed TGA, found despite the wrong case and slash. */
TEST_IN(textures_are_found, folder_begin, folder_end)
{
    const uint8_t tga[] = {0, 0, 2, 0, 0,  0,    0, 0, 0, 0, 0, 0,
                           2, 0, 1, 0, 24, 0x20, 3, 2, 1, 6, 5, 4};
    put_data("Wood.TGA", tga, sizeof tga);
    own_scene *scene =
        load_fine("{'materials':{'a':{'texture':'.\\\\wood.tga'},'b':{'texture':'Wood.TGA'}}}");
    const struct scene_texture *found =
        &scene->textures[material_named(scene, "a")->textures[0].texture];
    const uint8_t texels[] = {1, 2, 3, 255, 4, 5, 6, 255};
    assert_int_equal(found->width, 2);
    assert_memory_equal(found->rgba, texels, sizeof texels);
}

/* A texture that a scene file names must exist. Missing textures of models become magenta, even if
   the scene file names the same file later. */
TEST_IN(missing_textures_are_refused, folder_begin, folder_end)
{
    assert_error("{'materials':{\n'a':{'texture':'no.png'}}}",
                 "2:6: materials.a.texture: texture `");
    assert_error("{'materials':{'a':{'bump_map':{'file':'no.png'}}}}",
                 "1:32: materials.a.bump_map.file: texture `");
    assert_non_null(strstr(messages.last_error, "no.png`: there is no such file"));
    assert_error("{'materials':{'a':{'texture':'test.json'}}}",
                 "1:20: materials.a.texture: texture `");
    assert_non_null(strstr(messages.last_error, "it is not a picture"));
    static const char obj_text[] = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    static const char mtl_text[] = "newmtl m\nmap_Kd no.png\n";
    put_text("a.obj", obj_text);
    put_text("a.mtl", mtl_text);
    struct scene *scene = load_fine("{'objects':[{'model':'a.obj'}]}");
    const uint8_t magenta[] = {255, 0, 255, 255};
    assert_int_equal(scene->texture_count, 1);
    assert_memory_equal(scene->textures[0].rgba, magenta, sizeof magenta);
    scene_destroy(scene);
    assert_error(
        "{'objects':[{'model':'a.obj'},\n{'shape':'box','material':{'texture':'no.png'}}]}",
        "2:28: objects[1].material.texture: texture `");
}

TEST(large_textures_are_halved)
{
    own_scene *scene = scene_create(NULL, "test");
    const whit_load_params params = {.texture_limit = 1};
    uint32_t index;
    const uint8_t tga[] = {0, 0, 2, 0, 0,  0,    0,  0,  0,  0,  0,  0,
                           2, 0, 1, 0, 24, 0x20, 10, 20, 30, 20, 40, 61};
    const uint8_t mean[] = {46, 30, 15, 255};
    assert_int_equal(load_texture(scene, "memory", tga, sizeof tga, &params, &index, NULL),
                     WHIT_OK);
    assert_int_equal(scene->textures[index].width, 1);
    assert_memory_equal(scene->textures[index].rgba, mean, sizeof mean);
    assert_int_equal(load_texture(scene, "cut", tga, 20, &params, &index, NULL), WHIT_OK);
    assert_int_equal(scene->textures[index].width, 1);
}

TEST_IN(unknown_files_are_refused, folder_begin, folder_end)
{
    struct scene *scene;
    const whit_log log = messages_log(&messages);
    assert_int_equal(load_scene(&log, in_folder("nothing.json"), NULL, &scene), WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.last_error, "there is no such file"));
    assert_int_equal(load_scene(&log, put_text("scene.blend", "x"), NULL, &scene),
                     WHIT_ERROR_INPUT);
    assert_null(scene);
    assert_int_equal(messages.errors, 2);
    assert_non_null(strstr(messages.last_error, "`.blend` is not known"));
}

TEST(shipped_scenes_have_their_sizes)
{
    static const struct {
        const char *name;
        uint32_t triangles, instances;
    } scenes[] = {
        {"cube", 12, 1},        {"balls", 0, 5},
        {"8k", 8192, 1},        {"34k", 34226, 7},
        {"54k", 54450, 1},      {"default", 25934, 6},
        {"whitted", 2, 4},      {"sphereflake", 787202, 821},
        {"spin", 9358, 5},      {"many", 169986, 1025},
        {"spotlight", 4356, 5}, {"room", 3992, 8},
        {"layers", 11914, 8},   {"strands", 20002, 2},
        {"atrium", 64616, 1},
    };
    const whit_log log = messages_log(&messages);
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; ++i) {
        char path[512];
        own_scene *scene = NULL;
        snprintf(path, sizeof path, "%s/%s.json", WHIT_SCENES_DIR, scenes[i].name);
        assert_int_equal(load_scene(&log, path, NULL, &scene), WHIT_OK);
        assert_int_equal(scene->triangle_total, scenes[i].triangles);
        assert_int_equal(scene->instance_count, scenes[i].instances);
        for (uint32_t k = 0; k < scene->note_count; ++k)
            assert_int_equal(scene->notes[k].level, SCENE_NOTE_INFO);
    }
}
