/* FBX, COLLADA, 3MF and OFF: units, up axis, nodes, materials and textures are imported; notes name
   the things that are not. */
#include <zlib.h>

#include "../random.h"
#include "base/file.h"
#include "base/text.h"
#include "load_model_fixture.h"
#include "unit.h"

static const struct scene *load(const char *path)
{
    if (fixture_load(path) != WHIT_OK)
        fail_msg("%s", messages.last_error);
    assert_int_equal(messages.errors, 0);
    return fixture.scene;
}

/* Checks the world position of a vertex of an instance, through all nodes above it. */
static void assert_place(const struct scene *scene, uint32_t instance, uint32_t vertex, double x,
                         double y, double z)
{
    const struct scene_instance *of = &scene->instances[instance];
    const float *position = scene->meshes[of->mesh].positions + 3 * vertex;
    double at[3] = {(double)position[0], (double)position[1], (double)position[2]};
    const double wanted[3] = {x, y, z};
    for (uint32_t node = of->node; node != SCENE_NONE; node = scene->nodes[node].parent) {
        const struct scene_node *n = &scene->nodes[node];
        struct affine local =
            n->has_matrix ? n->matrix : affine_from_trs(n->translation, n->rotation, n->scale);
        double moved[3];
        for (int i = 0; i < 3; i++)
            moved[i] = local.m[4 * i] * at[0] + local.m[4 * i + 1] * at[1] +
                       local.m[4 * i + 2] * at[2] + local.m[4 * i + 3];
        memcpy(at, moved, sizeof at);
    }
    for (int i = 0; i < 3; i++)
        if (!(fabs(at[i] - wanted[i]) < 1e-6))
            fail_msg("vertex %u is at %g %g %g and should be at %g %g %g", vertex, at[0], at[1],
                     at[2], x, y, z);
}

static const struct scene_material *material_of(const struct scene *scene)
{
    return &scene->materials[scene->meshes[scene->instances[0].mesh].materials[0]];
}

/* Writes a copy of a file of text in which `to` stands for the first `from`. */
static const char *put_edited(const char *path, const char *from, const char *to)
{
    own_memory uint8_t *text = NULL;
    size_t bytes;
    assert_int_equal(file_read(&fixture.log, NULL, path, 0, &text, &bytes), WHIT_OK);
    const char *at = strstr((const char *)text, from);
    assert_non_null(at);
    own_memory char *edited = string_format("%.*s%s%s", (int)(at - (const char *)text),
                                            (char *)text, to, at + strlen(from));
    assert_non_null(edited);
    return put_text(path_name(path), edited);
}

/* --- OFF ------------------------------------------------------------------------------------ */

static const char off[] = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 2 0\n0 2 3\n4 0 1 2 3\n";

TEST_IN(off_has_faces_alone, fixture_begin, fixture_end)
{
    const struct scene *scene = load(put_text("a.off", off));
    assert_int_equal(scene->meshes[0].triangle_count, 2);
    assert_int_equal(scene->meshes[0].vertex_count, 4);
    assert_place(scene, 0, 0, 0, 0, 0);
    assert_false(fixture_noted("extension"));
}

TEST_IN(colors_of_an_off_are_bytes_or_shares, fixture_begin, fixture_end)
{
    load(put_text("a.off", "COFF\n3 1 0\n0 0 0 255 0 51 255\n1 0 0 0 255 0 255\n"
                           "0 1 0 0 0 0 255\n3 0 1 2\n"));
    load(put_text("b.off", "COFF\n3 1 0\n0 0 0 1 0 0.2 1\n1 0 0 0 1 0 1\n"
                           "0 1 0 0 0 0 1\n3 0 1 2\n"));
    for (int i = 0; i < 2; i++) {
        const float *color = fixture.scene->meshes[i].colors;
        assert_non_null(color);
        assert_float_equal(color[0], 1, 0);
        assert_float_equal(color[2], 0.2, 1e-6);
        assert_float_equal(color[3], 1, 0);
    }
}

#define SQUARE "0 0 0\n1 0 0\n1 2 0\n0 2 3\n"

TEST_IN(faces_that_an_off_lacks_are_told, fixture_begin, fixture_end)
{
    fixture_refused(put_text("a.off", "OFF\n4 2 0\n" SQUARE "3 0 1 2\n3 0 2\n"),
                    "a.off: face 2 of 2 is cut short or missing");
    fixture_refused(put_text("a.off", "OFF # x\n4 2 0\n" SQUARE "3 0 1 2\n"),
                    "a.off: face 2 of 2 is cut short or missing");
    fixture_refused(put_text("a.off", "5 0\n" SQUARE), "a.off: vertex 5 of 5 is cut short");
    fixture_refused(put_text("a.off", "OFF\n4 2 0\n" SQUARE "3 0 1 2\n3 0 2 4\n"),
                    "a.off: face 2 of 2 names a vertex that is not there");
    fixture_refused(put_text("a.off", "OFF\n-4 2 0\n" SQUARE "3 0 1 2\n"),
                    "a.off: its number of vertices is below 0");
    fixture_refused(put_text("a.off", "OFF\n4 -2 0\n" SQUARE "3 0 1 2\n"),
                    "a.off: its number of faces is below 0");
    fixture_refused(put_text("a.off", "OFF\n4 1 0\n" SQUARE "10 0 1 2 3 0 1 2 3 0 1\n"),
                    "a.off: all its faces have more than 9 corners");
    fixture_refused(put_text("a.off", "OFF BINARY\n\1"), "a.off: a binary OFF is not read");
    messages.errors = 0;
    load(put_text("a.off", "OFF\n4 2 0\n" SQUARE "3 0 1 2\n10 0 1 2 3 0 1 2 3 0 1\n"));
    assert_true(fixture_noted("a.off: 1 faces of more than 9 corners are not read"));
    assert_false(fixture_noted("colours"));
}

/* Comments anywhere, and no keyword: assimp would take comments for faces, and the first 4 for that
   of `4OFF`. */
TEST_IN(comments_and_colors_of_faces_of_an_off, fixture_begin, fixture_end)
{
    const struct scene *scene = load(
        put_text("a.off", "# x\r\n4 2 0 # y\r\n" SQUARE "  # z\n \n3 0 1 2 # t\n3 0 2 3 255 0 9"));
    assert_int_equal(scene->meshes[0].triangle_count, 2);
    assert_place(scene, 0, 2, 1, 2, 0);
    assert_true(fixture_noted("a.off: colours of 1 faces are not read"));
    load(put_text("b.off", "\xef\xbb\xbf"
                           "OFF\n4 1 0\n" SQUARE "4 0 1 2 3\n"));
    assert_int_equal(scene->meshes[0].triangle_count, 2);
}

/* --- COLLADA -------------------------------------------------------------------------------- */

#define SOURCE(id, count, numbers, stride, params)                                                 \
    "<source id='" id "'><float_array id='" id "a' count='" count "'>" numbers "</float_array>"    \
    "<technique_common><accessor source='#" id "a' count='3' stride='" stride "'>" params          \
    "</accessor></technique_common></source>"
#define PARAM(name) "<param name='" name "' type='float'/>"

static const char two_coordinates[] =
    SOURCE("u", "6", "0.25 0.75 1 0 0 1", "2", PARAM("S") PARAM("T"));
static const char three_coordinates[] =
    SOURCE("u", "9", "0.25 0.75 7 1 0 7 0 1 7", "3", PARAM("S") PARAM("T") PARAM("P"));

static const char positions[] =
    SOURCE("p", "9", "0 0 0 2 0 0 0 0 4", "3", PARAM("X") PARAM("Y") PARAM("Z"));

/* Unit half a metre, z upwards; one triangle on two nodes, the second below the first. */
static const char collada[] =
    "<?xml version='1.0'?>"
    "<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'><asset>"
    "<unit meter='0.5' name='half'/><up_axis>Z_UP</up_axis></asset><library_images><image id='i'>"
    "<init_from>dir\\no%%20such.png</init_from></image></library_images><library_effects>"
    "<effect id='e'><profile_COMMON><newparam sid='s'><surface type='2D'><init_from>i</init_from>"
    "</surface></newparam><newparam sid='t'><sampler2D><source>s</source></sampler2D></newparam>"
    "<technique sid='c'><lambert><emission><color>0.5 0.25 0 1</color></emission><diffuse>"
    "<texture texture='t' texcoord='U'/></diffuse></lambert></technique></profile_COMMON></effect>"
    "<effect id='f'><profile_COMMON><technique sid='c'><lambert><diffuse><color>"
    "0.25 0.5 0.75 1</color></diffuse></lambert></technique></profile_COMMON></effect>"
    "<effect id='h'><profile_COMMON><technique sid='c'><phong><diffuse><color>"
    "0.25 0.5 0.75 1</color></diffuse><specular><color>0.5 0.25 0 1</color></specular><shininess>"
    "<float>32</float></shininess><transparent opaque='A_ONE'><color>1 1 1 0.25</color>"
    "</transparent><transparency><float>1</float></transparency></phong></technique>"
    "</profile_COMMON></effect></library_effects><library_materials>"
    "<material id='m' name='painted'><instance_effect url='#%s'/></material></library_materials>"
    "<library_geometries><geometry id='g' name='tri'><mesh>%s%s<vertices id='v'>"
    "<input semantic='POSITION' source='#p'/></vertices><triangles material='mm' count='1'>"
    "<input semantic='VERTEX' source='#v' offset='0'/>"
    "<input semantic='TEXCOORD' source='#u' offset='0' set='0'/><p>0 1 2</p></triangles></mesh>"
    "</geometry></library_geometries>%s<library_visual_scenes><visual_scene id='w'>"
    "<node id='a' name='a'><translate>2 0 0</translate><instance_geometry url='#g'><bind_material>"
    "<technique_common><instance_material symbol='mm' target='#m'/></technique_common>"
    "</bind_material></instance_geometry><node id='b' name='b'><translate>0 0 6</translate>"
    "<instance_geometry url='#g'><bind_material><technique_common>"
    "<instance_material symbol='mm' target='#m'/></technique_common></bind_material>"
    "</instance_geometry></node>%s</node></visual_scene></library_visual_scenes><scene>"
    "<instance_visual_scene url='#w'/></scene></COLLADA>";

/* Writes a COLLADA file with this effect, `uvs` as its texture coordinates, further `libraries`,
   and `nodes` that use them. */
static const char *write_collada_uvs(const char *effect, const char *uvs, const char *libraries,
                                     const char *nodes)
{
    own_memory char *text = string_format(collada, effect, positions, uvs, libraries, nodes);
    assert_non_null(text);
    return put_text("a.dae", text);
}

static const char *write_collada(const char *effect, const char *libraries, const char *nodes)
{
    return write_collada_uvs(effect, two_coordinates, libraries, nodes);
}

TEST_IN(collada_in_half_metres_and_z_up, fixture_begin, fixture_end)
{
    const struct scene *scene = load(write_collada("f", "", ""));
    assert_int_equal(scene->instance_count, 2);
    assert_int_equal(scene->instances[0].mesh, scene->instances[1].mesh);
    assert_place(scene, 0, 1, 2, 0, 0);
    assert_place(scene, 0, 2, 1, 2, 0);
    assert_place(scene, 1, 2, 1, 5, 0);
    assert_float_equal(material_of(scene)->diffuse[0], 0.25, 1e-6);
    assert_float_equal(material_of(scene)->diffuse[2], 0.75, 1e-6);
}

TEST_IN(collada_names_its_textures, fixture_begin, fixture_end)
{
    const struct scene *scene = load(write_collada("e", "", ""));
    assert_true(fixture_noted("texture `no such.png`"));
    assert_int_not_equal(material_of(scene)->textures[SCENE_SLOT_DIFFUSE].texture, SCENE_NONE);
    assert_float_equal(material_of(scene)->emission[0], 0.5, 1e-6);
    assert_float_equal(scene->meshes[0].uvs[0][0], 0.25, 1e-6);
    assert_float_equal(scene->meshes[0].uvs[0][1], 0.25, 1e-6); /* downwards */
}

TEST_IN(collada_lambert_has_no_highlight, fixture_begin, fixture_end)
{
    const struct scene_material *matt = material_of(load(write_collada("f", "", "")));
    assert_int_equal(matt->model, WHIT_MODEL_METAL_ROUGH);
    assert_float_equal(matt->specular_level, 0, 0);
}

/* The highlight keeps its energy: 8 / (n + 8) of its colour, of which the largest part is missing
   from the diffuse light. */
TEST_IN(collada_highlights_and_opacity, fixture_begin, fixture_end)
{
    const struct scene_material *phong = material_of(load(write_collada("h", "", "")));
    assert_float_equal(phong->specular_level, 1, 0);
    assert_float_equal(phong->specular[0] * 0.04f, 0.1, 1e-6);
    assert_float_equal(phong->specular[1] * 0.04f, 0.05, 1e-6);
    assert_float_equal(phong->diffuse[2], 0.75f * 0.9f, 1e-6);
    assert_float_equal(2 / powf(phong->roughness, 4) - 2, 32, 1e-3);
    assert_float_equal(phong->opacity, 0.25, 1e-6);
    assert_int_equal(phong->alpha, SCENE_ALPHA_BLEND);
}

TEST_IN(collada_with_three_texture_coordinates, fixture_begin, fixture_end)
{
    const struct scene *scene = load(write_collada_uvs("f", three_coordinates, "", ""));
    assert_float_equal(scene->meshes[0].uvs[0][0], 0.25, 1e-6);
    assert_float_equal(scene->meshes[0].uvs[0][3], 1.0, 1e-6);
}

/* Lit by nothing, and no light itself. */
TEST_IN(collada_constant_is_unlit, fixture_begin, fixture_end)
{
    const char *path = put_edited(write_collada("e", "", ""), "<lambert>", "<constant>");
    const struct scene_material *flat =
        material_of(load(put_edited(put_edited(path, "</lambert>", "</constant>"),
                                    "<diffuse><texture texture='t' texcoord='U'/></diffuse>", "")));
    assert_int_equal(flat->model, WHIT_MODEL_UNLIT);
    assert_float_equal(flat->diffuse[0], 0.5, 1e-6);
    assert_float_equal(flat->diffuse[2], 0, 1e-6);
    assert_float_equal(flat->emission[0], 0, 0);
}

/* Draws with the second set if the name of the binding, by which assimp goes, states it. */
TEST_IN(collada_binds_its_textures_to_sets, fixture_begin, fixture_end)
{
    static const char *const names[] = {"CH1", "U"};
    for (uint32_t i = 0; i < 2; i++) {
        own_memory char *texture = string_format("texcoord='%s'", names[i]);
        own_memory char *bound = string_format("target='#m'><bind_vertex_input semantic='%s' "
                                               "input_semantic='TEXCOORD' input_set='1'/>"
                                               "</instance_material>",
                                               names[i]);
        const char *path = put_edited(write_collada("e", "", ""), "texcoord='U'", texture);
        path = put_edited(path, "target='#m'/>", bound);
        path = put_edited(path, "set='0'/>",
                          "set='0'/><input semantic='TEXCOORD' source='#u' offset='0' set='1'/>");
        const struct scene *scene = load(path);
        assert_int_equal(scene->materials[i].textures[SCENE_SLOT_DIFFUSE].uv_set, 1 - i);
        assert_int_equal(fixture_noted("a.dae: 1 binding is not read"), i);
    }
}

/* assimp would make a mesh of the nodes. */
TEST_IN(collada_without_meshes_draws_nothing, fixture_begin, fixture_end)
{
    const struct scene *scene = load(
        put_text("a.dae", "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/"
                          "COLLADASchema' version='1.4.1'><library_visual_scenes>"
                          "<visual_scene id='w'><node id='a'/></visual_scene>"
                          "</library_visual_scenes><scene><instance_visual_scene url='#w'/>"
                          "</scene></COLLADA>"));
    assert_int_equal(scene->mesh_count, 0);
    assert_true(fixture_noted("a.dae: there are no triangles in it"));
}

static const char moving[] =
    "<library_cameras><camera id='k'><optics><technique_common><perspective><yfov>45</yfov><znear>"
    "1</znear><zfar>9</zfar></perspective></technique_common></optics></camera></library_cameras>"
    "<library_lights><light id='l'><technique_common><point><color>1 1 1</color></point>"
    "</technique_common></light></library_lights><library_controllers><controller id='c'>"
    "<skin source='#g'><bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>"
    "<source id='n'><Name_array id='na' count='1'>j</Name_array><technique_common>"
    "<accessor source='#na' count='1' stride='1'><param name='JOINT' type='name'/></accessor>"
    "</technique_common></source><source id='q'><float_array id='qa' count='16'>"
    "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>"
    "<accessor source='#qa' count='1' stride='16'><param name='TRANSFORM' type='float4x4'/>"
    "</accessor></technique_common></source><source id='h'><float_array id='ha' count='1'>"
    "1</float_array><technique_common><accessor source='#ha' count='1' stride='1'>"
    "<param name='WEIGHT' type='float'/></accessor></technique_common></source><joints>"
    "<input semantic='JOINT' source='#n'/><input semantic='INV_BIND_MATRIX' source='#q'/></joints>"
    "<vertex_weights count='3'><input semantic='JOINT' source='#n' offset='0'/>"
    "<input semantic='WEIGHT' source='#h' offset='1'/><vcount>1 1 1</vcount><v>0 0 0 0 0 0</v>"
    "</vertex_weights></skin></controller></library_controllers><library_animations>"
    "<animation id='x'><source id='xt'><float_array id='xta' count='2'>0 1</float_array>"
    "<technique_common><accessor source='#xta' count='2' stride='1'>"
    "<param name='TIME' type='float'/></accessor></technique_common></source><source id='xv'>"
    "<float_array id='xva' count='6'>0 0 0 1 0 0</float_array><technique_common>"
    "<accessor source='#xva' count='2' stride='3'><param name='X' type='float'/>"
    "<param name='Y' type='float'/><param name='Z' type='float'/></accessor></technique_common>"
    "</source><sampler id='xs'><input semantic='INPUT' source='#xt'/>"
    "<input semantic='OUTPUT' source='#xv'/></sampler><channel source='#xs' target='d/tr'/>"
    "</animation></library_animations>";

static const char moving_nodes[] =
    "<node id='d' name='d'><translate sid='tr'>0 0 0</translate><node id='j' sid='j' name='j' "
    "type='JOINT'/><instance_camera url='#k'/><instance_light url='#l'/></node><node id='s'>"
    "<instance_controller url='#c'><skeleton>#j</skeleton></instance_controller></node>";

TEST_IN(what_moves_is_named, fixture_begin, fixture_end)
{
    const struct scene *scene = load(write_collada("f", moving, moving_nodes));
    assert_int_equal(scene->channel_count, 0);
    assert_int_equal(scene->camera_count, 0);
    uint32_t skins = 0;
    for (uint32_t i = 0; i < scene->note_count; i++)
        skins += strstr(scene->notes[i].text, "skins") != NULL;
    assert_int_equal(skins, 1);
    assert_true(fixture_noted("a.dae: skins are not animated: 1 drawn in the bind pose"));
    assert_true(fixture_noted("a.dae: 1 animation is not played"));
    assert_true(fixture_noted("a.dae: 1 light is not read"));
    assert_true(fixture_noted("a.dae: 1 camera is not read"));
}

TEST_IN(what_collada_loses_is_named, fixture_begin, fixture_end)
{
    const char *path = put_edited(write_collada("e", "", ""), "<source>s</source>",
                                  "<source>s</source><wrap_s>WRAP</wrap_s><wrap_t>CLAMP</wrap_t>");
    load(put_edited(path, "<color>0.5 0.25 0 1</color>", "<param ref='s'/>"));
    assert_true(fixture_noted("a.dae: 1 wrap mode is not read"));
    assert_true(fixture_noted("a.dae: 1 parameter of an effect is not read"));
    path = write_collada("f", moving, moving_nodes);
    load(path);
    assert_false(fixture_noted("bind_shape_matrix"));
    load(put_edited(path, "<bind_shape_matrix>1", "<bind_shape_matrix>2"));
    assert_true(fixture_noted("a.dae: 1 bind_shape_matrix is not applied"));
    fixture_refused(put_edited(path, "<translate>", "<skew>9 1 0 0 0 1 0</skew><translate>"),
                    "a.dae: it has a <skew>, which is not read");
}

/* --- FBX ------------------------------------------------------------------------------------ */

/* Unit two centimetres, z upwards, -y is the front. */
static const char fbx[] =
    "; FBX 7.4.0 project file\n"
    "FBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\n"
    "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n"
    "\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\",2\n"
    "\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n"
    "\t\tP: \"FrontAxis\", \"int\", \"Integer\", \"\",1\n"
    "\t\tP: \"FrontAxisSign\", \"int\", \"Integer\", \"\",-1\n"
    "\t\tP: \"CoordAxis\", \"int\", \"Integer\", \"\",0\n"
    "\t\tP: \"CoordAxisSign\", \"int\", \"Integer\", \"\",1\n"
    "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2\n\t}\n}\n"
    "Objects:  {\n"
    "\tGeometry: 11, \"Geometry::tri\", \"Mesh\" {\n"
    "\t\tVertices: *9 {\n\t\t\ta: 0,0,0,50,0,0,0,0,100\n\t\t}\n"
    "\t\tPolygonVertexIndex: *%d {\n\t\t\ta: %s-3\n\t\t}\n\t\tGeometryVersion: 124\n"
    "\t\tLayerElementMaterial: 0 {\n\t\t\tVersion: 101\n\t\t\tName: \"\"\n"
    "\t\t\tMappingInformationType: \"AllSame\"\n"
    "\t\t\tReferenceInformationType: \"IndexToDirect\"\n\t\t\tMaterials: *1 {\n\t\t\t\ta: 0\n"
    "\t\t\t}\n\t\t}\n"
    "\t\tLayer: 0 {\n\t\t\tVersion: 100\n\t\t\tLayerElement:  {\n"
    "\t\t\t\tType: \"LayerElementMaterial\"\n\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t}\n\t}\n"
    "\tModel: 12, \"Model::placed\", \"Mesh\" {\n\t\tVersion: 232\n\t\tProperties70:  {\n"
    "\t\t\tP: \"Lcl Translation\", \"Lcl Translation\", \"\", \"A\",0,0,25\n\t\t}\n"
    "\t\tShading: T\n\t\tCulling: \"CullingOff\"\n\t}\n"
    "\tMaterial: 13, \"Material::painted\", \"\" {\n\t\tVersion: 102\n"
    "\t\tShadingModel: \"lambert\"\n\t\tMultiLayer: 0\n\t\tProperties70:  {\n"
    "\t\t\tP: \"DiffuseColor\", \"Color\", \"\", \"A\",0.25,0.5,0.75\n\t\t}\n\t}\n"
    "\tTexture: 14, \"Texture::t\", \"\" {\n\t\tType: \"TextureVideoClip\"\n\t\tVersion: 202\n"
    "\t\tTextureName: \"Texture::t\"\n\t\tMedia: \"\"\n\t\tFileName: \"C:\\\\work\\\\wood.png\"\n"
    "\t\tRelativeFilename: \"%s\\\\tex\\\\wood.png\"\n\t}\n"
    "}\n"
    "Connections:  {\n\tC: \"OO\",12,0\n\tC: \"OO\",11,12\n\tC: \"OO\",13,12\n"
    "\tC: \"OP\",14,13, \"DiffuseColor\"\n}\n";

/* Writes an FBX with one face of `corners` corners; its texture is named from the folder above or
   from a drive. */
static const char *write_fbx(int corners)
{
    char indices[4096] = "";
    for (int i = 0; i + 1 < corners; i++)
        strcat(indices, i % 2 ? "1," : "0,");
    own_memory char *text = string_format(fbx, corners, indices,
                                          corners == 3   ? ".."
                                          : corners == 4 ? "C:"
                                                         : "C:\\w\xfcrk");
    assert_non_null(text);
    return put_text("a.fbx", text);
}

TEST_IN(faces_of_too_many_corners_are_refused, fixture_begin, fixture_end)
{
    fixture_refused(write_fbx(1025), "a.fbx: face 0 has 1025 corners, at most 1024 are possible");
}

TEST_IN(fbx_in_two_centimetres_and_z_up, fixture_begin, fixture_end)
{
    put_text("wood.png", "no picture");
    const struct scene *scene = load(write_fbx(3));
    assert_int_equal(scene->instance_count, 1);
    assert_place(scene, 0, 1, 1, 0.5, 0);
    assert_place(scene, 0, 2, 0, 2.5, 0);
    assert_float_equal(material_of(scene)->diffuse[1], 0.5, 1e-6);
    for (int corners = 4; corners <= 5; ++corners) { /* the last path is Latin-1 */
        load(write_fbx(corners));
        assert_int_equal(scene->texture_count, 1);
        assert_true(fixture_noted("texture `wood.png`"));
        assert_false(fixture_noted("no such file")); /* it is beside the model */
        assert_false(fixture_noted("outside"));
    }
}

#define UV_LAYER                                                                                   \
    "\t\tLayerElementUV: 0 {\n\t\t\tVersion: 101\n\t\t\tName: \"u\"\n"                             \
    "\t\t\tMappingInformationType: \"ByPolygonVertex\"\n"                                          \
    "\t\t\tReferenceInformationType: \"Direct\"\n\t\t\tUV: *6 {\n\t\t\t\ta: "                      \
    "0,0,1,0,0,1\n\t\t\t}\n"                                                                       \
    "\t\t}\n\t\tLayer: 0 {\n\t\t\tLayerElement:  {\n\t\t\t\tType: \"LayerElementUV\"\n"            \
    "\t\t\t\tTypedIndex: 0\n\t\t\t}\n"

/* Scaled about the origin, then moved; v grows downwards here. */
TEST_IN(fbx_moves_its_textures, fixture_begin, fixture_end)
{
    const char *path = put_edited(write_fbx(3), "\t\tLayer: 0 {\n", UV_LAYER);
    path = put_edited(
        path, "\t\tMedia: \"\"\n",
        "\t\tProperties70:  {\n\t\t\tP: \"Translation\", \"Vector\", \"\", \"A\",0.25,0.125,0\n"
        "\t\t\tP: \"Scaling\", \"Vector\", \"\", \"A\",3,2,1\n"
        "\t\t\tP: \"WrapModeU\", \"enum\", \"\", \"\",1\n"
        "\t\t\tP: \"WrapModeV\", \"enum\", \"\", \"\",0\n\t\t}\n");
    const struct scene *scene = load(path);
    const float wanted[6] = {0.25f, 0.875f, 3.25f, 0.875f, 0.25f, -1.125f};
    for (int i = 0; i < 6; i++)
        assert_float_equal(scene->meshes[0].uvs[0][i], wanted[i], 1e-6);
    assert_true(fixture_noted("a.fbx: 1 wrap mode is not read, its texture repeats"));
}

TEST_IN(fbx_has_two_sides_and_weighs_highlights, fixture_begin, fixture_end)
{
    const char *path = put_edited(write_fbx(3), "\"lambert\"", "\"phong\"");
    path = put_edited(path, "0.25,0.5,0.75\n",
                      "0.25,0.5,0.75\n\t\t\tP: \"SpecularColor\", \"Color\", \"\", \"A\",1,1,1\n"
                      "\t\t\tP: \"SpecularFactor\", \"Number\", \"\", \"A\",0.25\n"
                      "\t\t\tP: \"ShininessExponent\", \"Number\", \"\", \"A\",32\n");
    path = put_edited(path, "0,0,25\n",
                      "0,0,25\n\t\t\tP: \"Visibility\", \"Visibility\", \"\", \"A\",0\n");
    const struct scene_material *material = material_of(load(path));
    assert_false(material->one_sided);
    assert_float_equal(material->specular[0] * 0.04f, 0.25 * 8 / 40, 1e-6);
    assert_true(fixture_noted("a.fbx: 1 hidden node is drawn"));
}

/* --- 3MF ------------------------------------------------------------------------------------ */

struct package {
    uint8_t bytes[8192];
    size_t size, directory_size;
    uint8_t directory[1024];
    uint16_t entries;
};

static void put(uint8_t *to, size_t *at, const void *data, size_t bytes)
{
    memcpy(to + *at, data, bytes);
    *at += bytes;
}

/* Adds a file to the ZIP, stored, or deflated as one uncompressed block. */
static void add_file(struct package *package, const char *name, const char *text, bool deflated)
{
    uint16_t bytes = (uint16_t)strlen(text), name_bytes = (uint16_t)strlen(name);
    uint16_t inverse = (uint16_t)~bytes, method = deflated ? 8 : 0;
    const uint32_t offset = (uint32_t)package->size,
                   crc = (uint32_t)crc32(0, (const uint8_t *)text, bytes);
    const uint32_t sizes[2] = {bytes + (deflated ? 5u : 0u), bytes};
    const uint16_t lengths[2] = {name_bytes, 0};
    uint8_t common[26] = {20, 0}; /* what both headers have */
    memcpy(common + 4, &method, 2);
    memcpy(common + 10, &crc, 4);
    memcpy(common + 14, sizes, 8);
    memcpy(common + 22, lengths, 4);
    put(package->bytes, &package->size, "PK\3\4", 4);
    put(package->bytes, &package->size, common, sizeof common);
    put(package->bytes, &package->size, name, name_bytes);
    if (deflated) {
        put(package->bytes, &package->size, "\1", 1);
        put(package->bytes, &package->size, &bytes, 2);
        put(package->bytes, &package->size, &inverse, 2);
    }
    put(package->bytes, &package->size, text, bytes);
    uint8_t rest[14] = {0};
    memcpy(rest + 10, &offset, 4);
    put(package->directory, &package->directory_size, "PK\1\2\24\0", 6);
    put(package->directory, &package->directory_size, common, sizeof common);
    put(package->directory, &package->directory_size, rest, sizeof rest);
    put(package->directory, &package->directory_size, name, name_bytes);
    package->entries++;
}

/* more: behind the triangle. */
static const char *write_3mf_with(const char *unit, bool deflated, const char *more)
{
    struct package package = {0};
    char *model = string_format(
        "<?xml version='1.0' encoding='UTF-8'?><model %s xml:lang='en-US' "
        "xmlns='http://schemas.microsoft.com/3dmanufacturing/core/2015/02' "
        "xmlns:c='http://schemas.microsoft.com/3dmanufacturing/material/2015/02'><resources>"
        "<c:colorgroup id='4'><c:color color='#FF0000'/></c:colorgroup>"
        "<basematerials id='1'><base name='painted' displaycolor='#FF8000'/></basematerials>"
        "<object id='2' type='model' pid='1' pindex='0'><mesh><vertices>"
        "<vertex x='0' y='0' z='0'/><vertex x='100' y='0' z='0'/><vertex x='0' y='50' z='200'/>"
        "</vertices><triangles><triangle v1='0' v2='1' v3='2' pid='1' p1='0'/>%s</triangles></mesh>"
        "</object></resources><build><item objectid='2'/></build></model>",
        unit, more);
    assert_non_null(model);
    add_file(&package, "[Content_Types].xml",
             "<?xml version='1.0'?><Types xmlns='http://schemas.openxmlformats.org/package/2006/"
             "content-types'><Default Extension='model' ContentType='application/vnd.ms-package."
             "3dmanufacturing-3dmodel+xml'/></Types>",
             deflated);
    add_file(&package, "_rels/.rels",
             "<?xml version='1.0'?><Relationships xmlns='http://schemas.openxmlformats.org/package/"
             "2006/relationships'><Relationship Target='/3D/3dmodel.model' Id='rel0' Type='http://"
             "schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/></Relationships>",
             deflated);
    add_file(&package, "3D/3dmodel.model", model, deflated);
    add_file(&package, "Metadata/thumbnail.png", "a picture that is not read", deflated);
    free(model);
    const uint32_t ends[2] = {(uint32_t)package.directory_size, (uint32_t)package.size};
    const uint16_t entries[2] = {package.entries, package.entries};
    put(package.bytes, &package.size, package.directory, package.directory_size);
    put(package.bytes, &package.size, "PK\5\6\0\0\0\0", 8);
    put(package.bytes, &package.size, entries, sizeof entries);
    put(package.bytes, &package.size, ends, sizeof ends);
    put(package.bytes, &package.size, "\0", 2);
    return put_data("a.3mf", package.bytes, package.size);
}

static const char *write_3mf(const char *unit, bool deflated)
{
    return write_3mf_with(unit, deflated, "");
}

TEST_IN(units_of_3mf, fixture_begin, fixture_end)
{
    static const struct {
        const char *unit;
        bool deflated;
        double metres;
    } rows[] = {{"", false, 0.1},
                {"unit='micron'", false, 1e-4},
                {"unit=\"inch\"", true, 2.54},
                {"unit='meter'", true, 100}};
    for (uint32_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const struct scene *scene = load(write_3mf(rows[i].unit, rows[i].deflated));
        assert_int_equal(scene->instance_count, i + 1);
        assert_place(scene, i, 1, rows[i].metres, 0, 0);
        assert_place(scene, i, 2, 0, 2 * rows[i].metres, -rows[i].metres / 2);
    }
    assert_float_equal(material_of(fixture.scene)->diffuse[0], 1, 1e-6);
    assert_float_equal(material_of(fixture.scene)->diffuse[1], 0.2158605, 1e-6); /* sRGB 128 */
    assert_float_equal(material_of(fixture.scene)->diffuse[2], 0, 1e-6);
    assert_float_equal(material_of(fixture.scene)->opacity, 1, 0);
    assert_true(fixture_noted("a.3mf: 1 picture is not read"));
    assert_true(fixture_noted("a.3mf: 1 colour group is not read"));
}

TEST_IN(materials_that_a_3mf_loses_are_named, fixture_begin, fixture_end)
{
    load(write_3mf_with("", true, "<triangle v1='0' v2='2' v3='1'/>"));
    assert_false(fixture_noted("one of its materials"));
    load(write_3mf_with("", true,
                        "</triangles></mesh></object>"
                        "<object id='3' pid='1' pindex='0'><mesh><triangles>"
                        "<triangle v1='0' v2='2' v3='1' p1='1'/>"));
    assert_true(fixture_noted("a.3mf: 1 object is drawn in one of its materials"));
    load(write_3mf_with("", true,
                        "<triangle v1='0' v2='2' v3='1' pid='1' p1='1'/>"
                        "<!--<m:compositematerials id='9'/>-->"));
    assert_true(fixture_noted("a.3mf: 1 object is drawn in one of its materials"));
    assert_true(fixture_noted("a.3mf: 1 list of composite materials is not read"));
}

TEST_IN(what_a_3mf_requires_is_not_left_out, fixture_begin, fixture_end)
{
    static const char colors[] = "requiredextensions='c'";
    static const char beams[] = "xmlns:b='http://x/beamlattice/' requiredextensions='c b'";
    load(write_3mf(colors, false));
    load(write_3mf_with("requiredextensions = 'c'", false, "<!-- of x:path=here -->"));
    fixture_refused(write_3mf(beams, true),
                    "a.3mf: it requires the extension `b` (http://x/beamlattice/)");
    fixture_refused(write_3mf_with("", false, "<component p:path='/3D/o.model'/>"),
                    "a.3mf: it has objects in several files");
    fixture_refused(write_3mf_with("", false,
                                   "</triangles></mesh></object><object id='3'>"
                                   "<components><component objectid='3'/></components>"
                                   "</object><object id='4'><mesh><triangles>"),
                    "a.3mf: the object 3 is a part of itself");
}

/* --- parts that are not read ---------------------------------------------------------------- */

TEST_IN(rubbish_is_refused, fixture_begin, fixture_end)
{
    static const char *const names[] = {"a.fbx", "a.dae", "a.3mf", "a.off"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        fixture_refused(put_text(names[i], "no model at all\n"),
                        i == 2 ? "it is no ZIP archive" : "assimp: ");
    }
    fixture_refused(write_3mf("<", false), "assimp: the file has no model");
}

/* --- damaged files -------------------------------------------------------------------------- */

enum { DAMAGES = 200, RUN_MAX = 64 };

/* Writes a damaged copy of a file to `to`, which has room for RUN_MAX bytes more, and gives its
   size: some bits are flipped, the end is cut off, or a run of bytes is repeated. */
static size_t damage(uint64_t *random, const uint8_t *from, size_t size_bytes, uint8_t *to)
{
    size_t at = random_below(random, (uint32_t)size_bytes);
    size_t run = 1 + random_below(random, RUN_MAX);
    memcpy(to, from, size_bytes);
    switch (random_below(random, 3)) {
    case 0:
        for (size_t i = 0; i < 1 + run / 16; i++) {
            uint8_t bit = (uint8_t)(1u << random_below(random, 8));
            to[random_below(random, (uint32_t)size_bytes)] ^= bit;
        }
        return size_bytes;
    case 1:
        return at;
    default:
        run = run < size_bytes - at ? run : size_bytes - at;
        memcpy(to + at + run, from + at, size_bytes - at);
        return size_bytes + run;
    }
}

/* The importer is a child in its sandbox; this process checks its reply and reads the GLB in it.
   Gives whether there is a scene. */
static bool load_damaged(const char *name, const uint8_t *data, size_t size_bytes)
{
    own_scene *scene = NULL;
    const char *path = put_data(name, data, size_bytes);
    messages.errors = 0;
    whit_result result = load_scene(&fixture.log, path, NULL, &scene);
    assert_true(result == WHIT_OK || result == WHIT_ERROR_INPUT || result == WHIT_ERROR_MEMORY);
    assert_int_equal(scene != NULL, result == WHIT_OK);
    assert_int_equal(messages.errors, result != WHIT_OK);
    if (messages.errors)
        assert_non_null(strstr(messages.last_error, path));
    for (uint32_t i = 0; scene && i < scene->mesh_count; i++) {
        const struct scene_mesh *mesh = &scene->meshes[i];
        for (size_t k = 0; k < (size_t)mesh->triangle_count * 3; k++)
            assert_true(mesh->indices[k] < mesh->vertex_count);
    }
    unlink(path);
    return result == WHIT_OK;
}

TEST_IN(damaged_files_end_in_a_scene_or_one_error, fixture_begin, fixture_end)
{
    enum { SAMPLES = 4 };
    static const char *const names[SAMPLES] = {"a.off", "a.dae", "a.fbx", "a.3mf"};
    uint64_t random = 1;
    for (int i = 0; i < SAMPLES; i++) {
        const char *path = i == 0   ? put_text(names[i], off)
                           : i == 1 ? write_collada("e", moving, moving_nodes)
                           : i == 2 ? write_fbx(3)
                                    : write_3mf("unit='inch'", false);
        own_memory uint8_t *data = NULL;
        size_t size_bytes = 0;
        uint32_t loaded = 0;
        assert_int_equal(file_read(&fixture.log, NULL, path, 0, &data, &size_bytes), WHIT_OK);
        assert_true(load_damaged(names[i], data, size_bytes)); /* as it is */
        own_memory uint8_t *damaged = malloc(size_bytes + RUN_MAX);
        assert_non_null(damaged);
        for (uint32_t k = 0; k < DAMAGES; k++) {
            size_t bytes = damage(&random, data, size_bytes, damaged);
            loaded += load_damaged(names[i], damaged, bytes);
        }
        print_message("%s: %u of %u loaded\n", names[i], loaded, DAMAGES);
        assert_in_range(loaded, 1, DAMAGES - 1);
    }
}
