/* OBJ and MTL. */
#include "load_model_fixture.h"
#include "owned_image.h"
#include "unit.h"

#define QUAD "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static const struct scene_mesh *only_mesh(void)
{
    assert_int_equal(fixture.scene->mesh_count, 1);
    assert_int_equal(fixture.scene->instance_count, 1);
    assert_int_equal(fixture.scene->instances[0].mesh, 0);
    return &fixture.scene->meshes[0];
}

static const struct scene_mesh *load_obj(const char *text)
{
    fixture_mesh(put_text("a.obj", text));
    return only_mesh();
}

/* Loads a quad with the material of an MTL with this text. */
static const struct scene_material *load_material(const char *mtl)
{
    put_text("a.mtl", mtl);
    load_obj("mtllib a.mtl\n" QUAD "usemtl m\nf 1 2 3 4\n");
    return material_named(fixture.scene, "m");
}

TEST_IN(quads_and_negative_indices, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh =
        load_obj(QUAD "f -4 -3 -2\nf -4 -2 -1\n"
                      "v 2 0 0\nv 3 0 0\nv 3.5 1 0\nv 2.5 2 0\nv 2 1 0\n"
                      "f 5 6 7 8 9\n");
    assert_int_equal(mesh->triangle_count, 2 + 3);
    /* Vertices were merged: one for each position instead of one for each corner of the file. */
    assert_int_equal(mesh->vertex_count, 4 + 5);
    assert_null(mesh->normals);
    for (uint32_t i = 0; i < 6; i++)
        assert_true(mesh->indices[i] < 4);
    assert_int_equal(fixture.scene->instances[0].node, SCENE_NONE);
}

TEST_IN(odd_material_lines_lose_nothing, fixture_begin, fixture_end)
{
    const struct scene_material *m = load_material(
        "# comment\r\nnewmtl m\r\n\taniso 0.5 none\r\n  Kd 0.25 \\\r\n 0.5 0.75 # tail\r\n"
        "d -halo 0.5\r\nKs spectral x.rfl\r\nrubbish\r\nrubbish again\r\nNs 12\r\n");
    assert_float_equal(m->diffuse[0], 0.25, 0);
    assert_float_equal(m->diffuse[1], 0.5, 0);
    assert_float_equal(m->diffuse[2], 0.75, 0);
    assert_float_equal(m->shininess, 12, 0);
    assert_float_equal(m->opacity, 0.5, 0);
    assert_int_equal(m->alpha, SCENE_ALPHA_BLEND);
    assert_int_equal(m->origin.line, 2);
    assert_true(fixture_noted("a.mtl:3: `aniso`"));
    assert_true(fixture_noted("a.mtl:7: `Ks`"));
    assert_true(fixture_noted("a.mtl:8: `rubbish`"));
    assert_false(fixture_noted("a.mtl:9"));
    assert_int_equal(messages.errors, 0);
}

TEST_IN(several_libraries_and_missing_ones, fixture_begin, fixture_end)
{
    put_text("b.mtl", "newmtl b\nKd 0 1 0\n");
    put_text("with blank.mtl", "newmtl c\nKd 0 0 1\n");
    load_obj("mtllib gone.mtl b.mtl\nmtllib with blank.mtl\n" QUAD
             "usemtl b\nf 1 2 3\nusemtl c\nf 1 3 4\nusemtl nobody\nf 2 3 4\n");
    assert_float_equal(material_named(fixture.scene, "b")->diffuse[1], 1, 0);
    assert_float_equal(material_named(fixture.scene, "c")->diffuse[2], 1, 0);
    assert_int_equal(material_named(fixture.scene, "nobody")->illum, -1);
    assert_true(fixture_noted("`gone.mtl`: there is no such file"));
    assert_true(fixture_noted("`nobody` is not defined"));
    assert_int_equal(only_mesh()->group_count, 3);
}

TEST_IN(missing_library_is_grey, fixture_begin, fixture_end)
{
    load_obj("mtllib gone.mtl\n" QUAD "usemtl b\nf 1 2 3\n");
    const struct scene_material *m = material_named(fixture.scene, "b");
    assert_float_equal(m->diffuse[0], m->diffuse[1], 0);
    assert_int_equal(messages.errors, 0);
}

TEST_IN(groups_keep_their_materials, fixture_begin, fixture_end)
{
    put_text("a.mtl", "newmtl r\nKd 1 0 0\nnewmtl g\nKd 0 1 0\n");
    const struct scene_mesh *mesh =
        load_obj(QUAD "g left\nusemtl g\nf 1 2 3\ng right\nusemtl r\nf 1 3 4\nf 2 3 4\n");
    assert_int_equal(mesh->group_count, 2);
    assert_string_equal(mesh->groups[0].name, "left");
    assert_int_equal(mesh->groups[1].first_triangle, 1);
    assert_int_equal(mesh->groups[1].triangle_count, 2);
    const struct scene_material *materials = fixture.scene->materials;
    assert_string_equal(materials[mesh->materials[0]].name, "g");
    assert_string_equal(materials[mesh->materials[2]].name, "r");
}

TEST_IN(uvs_grow_downwards, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh = load_obj(QUAD "vt 0.25 0.25\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    assert_non_null(mesh->uvs[0]);
    assert_float_equal(mesh->uvs[0][2 * mesh->indices[0]], 0.25, 0);
    assert_float_equal(mesh->uvs[0][2 * mesh->indices[0] + 1], 0.75, 0);
}

TEST_IN(numbers_without_a_leading_digit, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh = load_obj("v .5 0 -.25\nv 1 .125e1 0\nv 0 1 0\nf 1 2 3\n");
    const float *a = mesh->positions + 3 * mesh->indices[0];
    const float *b = mesh->positions + 3 * mesh->indices[1];
    assert_float_equal(a[0], 0.5, 0);
    assert_float_equal(a[2], -0.25, 0);
    assert_float_equal(b[1], 1.25, 0);
}

TEST_IN(vertex_colors, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh =
        load_obj("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    assert_non_null(mesh->colors);
    assert_float_equal(mesh->colors[4 * mesh->indices[1] + 1], 0.5, 1e-6);
    assert_float_equal(fixture.scene->materials[mesh->materials[0]].diffuse[0], 1, 0);
}

TEST_IN(vertex_colors_may_be_bytes, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh =
        load_obj("v 0 0 0 255 0 0\nv 1 0 0 0 51 0\nv 0 1 0 0 0 255\nf 1 2 3\n");
    assert_float_equal(mesh->colors[4 * mesh->indices[0]], 1, 0);
    assert_float_equal(mesh->colors[4 * mesh->indices[1] + 1], 0.2, 1e-6);
}

/* Vertices without a colour, of which the first stands above all colours: they are white. */
TEST_IN(vertices_without_a_color_among_colors, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh =
        load_obj("v 0 0 9\nv 1 0 0 .25 .5 .75\nv .5 .5 .5\nv 0 1 0 0 0 1\n"
                 "f 2 4 3\nf 1 2 3\n");
    const float wanted[6] = {0.25f, 0, 1, 1, 0.25f, 1}; /* the red of each corner */
    for (int i = 0; i < 6; i++)
        assert_float_equal(mesh->colors[4 * mesh->indices[i]], wanted[i], 0);
    assert_float_equal(mesh->positions[3 * mesh->indices[5]], 0.5, 0);
}

TEST_IN(flat_group_beside_a_smooth_one, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh =
        load_obj(QUAD "vn 0 1 0\ng a\nf 1//1 2//1 3//1\ng b\nf 1 3 4\n");
    assert_non_null(mesh->normals);
    assert_float_equal(mesh->normals[3 * mesh->indices[0] + 1], 1, 0);
    assert_float_equal(mesh->normals[3 * mesh->indices[3] + 2], 1, 1e-6);
}

/* Three faces of a unit cube around the origin as its corner, as quads. */
#define CORNER "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 0\nv 0 1 1\nv 1 0 1\n"

/* The normal of the mesh's vertex at this position, of the first triangle that has it. */
static const float *normal_at(const struct scene_mesh *mesh, float x, float y, float z)
{
    for (uint32_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const float *p = mesh->positions + 3 * (size_t)mesh->indices[i];
        if (p[0] == x && p[1] == y && p[2] == z)
            return mesh->normals + 3 * (size_t)mesh->indices[i];
    }
    fail_msg("no vertex at %g %g %g", (double)x, (double)y, (double)z);
    return NULL;
}

TEST_IN(smoothing_groups_make_normals, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh =
        load_obj(CORNER "vt 0 0\ns 7\nf 1/1 3/1 5/1 2/1\nf 4 6 3 1\ng b\nf 1// 2 7 4\n");
    assert_non_null(mesh->normals);
    /* By angle the three faces count alike, however their quads are cut; group b too. */
    for (int i = 0; i < 3; i++)
        assert_float_equal(normal_at(mesh, 0, 0, 0)[i], -0.57735, 1e-5);
    assert_float_equal(normal_at(mesh, 0, 1, 0)[0], -0.70711, 1e-5);
    assert_float_equal(normal_at(mesh, 0, 1, 0)[1], 0, 1e-5);
    assert_float_equal(normal_at(mesh, 1, 1, 0)[2], -1, 0);
}

TEST_IN(smoothing_groups_have_edges_between_them, fixture_begin, fixture_end)
{
    load_obj(CORNER "s 16777216\nf 1 3 5 2\ns 16777217\nf 1 4 6 3\ns off\n"
                    "f 1//1 2//2 7//1 4//1\n");
    assert_non_null(only_mesh()->normals);
    assert_float_equal(normal_at(only_mesh(), 0, 0, 0)[2], -1, 0);
    assert_float_equal(normal_at(only_mesh(), 0, 1, 1)[0], -1, 0);
    const float *flat = normal_at(only_mesh(), 1, 0, 1);
    assert_true(flat[0] == 0 && flat[1] < 0 && flat[2] == 0);
}

TEST_IN(smoothing_groups_stand_back, fixture_begin, fixture_end)
{
    assert_int_equal(fixture_load(put_text("a.obj", CORNER "s off\nf 1 3 5 2\ns 0\nf 1 4 6 3\n")),
                     WHIT_OK);
    assert_null(only_mesh()->normals);
    assert_int_equal(fixture_load(put_text("a.obj", CORNER "vn 1 0 0\ns 1\nf 1//1 3//1 5//1\n"
                                                           "f 1 4 6 3\n")),
                     WHIT_OK);
    assert_float_equal(fixture.scene->meshes[1].normals[0], 1, 0);
}

TEST_IN(wide_text, fixture_begin, fixture_end)
{
    const char *text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    uint8_t wide[256] = {0xfe, 0xff};
    size_t size = 2;
    for (const char *c = text; *c; c++, size += 2)
        wide[size + 1] = (uint8_t)*c;
    assert_int_equal(fixture_load(put_data("a.obj", wide, size)), WHIT_OK);
    assert_int_equal(only_mesh()->triangle_count, 1);
}

TEST_IN(libraries_are_found_by_other_case_and_slashes, fixture_begin, fixture_end)
{
    put_text("Red.mtl", "newmtl red\nKd 1 0 0\n");
    put_text("green.mtl", "newmtl green\nKd 0 1 0\n");
    load_obj("mtllib RED.MTL\nmtllib .\\Green.mtl\n" QUAD
             "usemtl red\nf 1 2 3\nusemtl green\nf 1 3 4\n");
    assert_float_equal(material_named(fixture.scene, "red")->diffuse[1], 0, 0);
    assert_float_equal(material_named(fixture.scene, "green")->diffuse[0], 0, 0);
    assert_int_equal(fixture.scene->note_count, 0);
}

TEST_IN(libraries_and_pictures_are_found_beside_the_model, fixture_begin, fixture_end)
{
    put_text("wood.png", "no picture");
    put_text("blue.mtl", "newmtl blue\nmap_Kd tex\\Wood.PNG\n");
    load_obj("mtllib C:\\models\\Blue.mtl\n" QUAD "usemtl blue\nf 1 2 3\n");
    assert_true(fixture_noted("texture `wood.png`"));
    assert_false(fixture_noted("no such file"));
}

TEST_IN(lines_are_cleaned, fixture_begin, fixture_end)
{
    put_text("a.mtl", "newmtl red # x\nKd 1 0 0\nnewmtl Material #25\nKd 0 1 0\n");
    const struct scene_mesh *mesh =
        load_obj("\xef\xbb\xbfmtllib a.mtl\n v 0 0 0 # a\n\tv 1 0 0\nv 1 1 0\nv 0 1 0#b\n"
                 "# C:\\max\\\nvt 0\nvt .5 # c\nusemtl red # hm\n f 1/1 2/2 \\\n3/1 # end\n"
                 "usemtl Material #25\nf 1/1 3/2 4/1 # 2\n");
    assert_int_equal(mesh->triangle_count, 2);
    assert_float_equal(mesh->uvs[0][2 * mesh->indices[1]], 0.5, 0);
    assert_float_equal(material_named(fixture.scene, "red")->diffuse[1], 0, 0);
    assert_float_equal(material_named(fixture.scene, "Material #25")->diffuse[1], 1, 0);
    assert_int_equal(fixture.scene->note_count, 0);
}

TEST_IN(lines_may_end_in_a_return_alone, fixture_begin, fixture_end)
{
    put_text("a.mtl", "newmtl red\rKd 1 0 0\r");
    load_obj("mtllib a.mtl\rv 0 0 0\rv 1 0 0\rv 0 1 0\rusemtl red\rf 1 2 3");
    assert_int_equal(only_mesh()->triangle_count, 1);
    assert_float_equal(material_named(fixture.scene, "red")->diffuse[1], 0, 0);
    assert_int_equal(fixture.scene->note_count, 0);
}

TEST_IN(lines_and_points_are_noted, fixture_begin, fixture_end)
{
    load_obj(QUAD "f 1 2 3\nl 1 2 3\np 4\n");
    assert_int_equal(only_mesh()->triangle_count, 1);
    assert_true(fixture_noted("2 lines are not drawn"));
    assert_true(fixture_noted("1 points are not drawn"));
}

TEST_IN(curves_and_surfaces_are_noted, fixture_begin, fixture_end)
{
    load_obj(QUAD "f 1 2 3\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\ncurv 0 1 1 2\nend\n");
    assert_true(fixture_noted("a.obj: 2 curves and surfaces are not drawn"));
}

TEST_IN(damaged_texts_are_refused, fixture_begin, fixture_end)
{
    static const char *const rows[][2] = {
        {QUAD "l 1 2\nl 3 4\n", "no triangles in it (0 points, 2 lines"},
        {QUAD "f 1 2 9\n", "a.obj:5: a face names vertex 9, and there are 4"},
        {QUAD "f 1 2 x\n", "a.obj:5: a face names `x`, which is no number"},
        {QUAD "v 0 0 0 1 1 1 1\nf 1 2 3\n", "a.obj:5: a vertex has 7 numbers"},
        {QUAD "f 1 2 3\nf 1 \\\n2 -5\n", "a.obj:6: a face names vertex -5, and there are 4"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        fixture_refused(put_text("a.obj", rows[i][0]), rows[i][1]);
}

TEST_IN(texture_coordinates_that_are_not_there_are_told, fixture_begin, fixture_end)
{
    load_obj(QUAD "vt 0 0\nvt 1 0\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/2\n");
    assert_true(fixture_noted("a.obj:8: a face names normal 2, and there are 1: its group"));
    assert_int_equal(fixture.scene->note_count, 1);
    fixture_mesh(put_text("a.obj", "f 1// 2 3/ \n" QUAD "vt 0 0\nf 1/1 2/9 3/8\n"));
    assert_true(fixture_noted("a.obj:7: a face names texture coordinate 9, and there are 1"));
    assert_int_equal(fixture.scene->note_count, 2);
    fixture_mesh(put_text("a.obj", QUAD "f 1//1 2//2 3//3\n"));
    assert_int_equal(fixture.scene->note_count, 2);
}

/* --- classes -------------------------------------------------------------------------------- */

/* A field of a material, a float, and its value. */
#define IS(field, value)                                                                           \
    {                                                                                              \
#field, offsetof(struct scene_material, field), value                                      \
    }

/* What the classes of `illum` make of an MTL. */
static const struct {
    const char *mtl;
    struct {
        const char *field;
        size_t at;
        double value;
    } floats[4];
    bool fresnel, shadow_catcher;
    enum scene_alpha alpha;
    const char *note;
} classes[] = {
    {"Ks 1 1 1\nillum 1\n", .floats = {IS(specular[0], 0)}},
    {"Kd 0 0 0\nKs 0.9 0.8 0.7\nillum 3\nTf 1 1 1\n",
     .floats = {IS(reflection[1], 0.8), IS(transmission[0], 0)}},
    {"Ks 1 1 1\nNi 1.33\nTf 0.25 1 0.5\nillum 7\n",
     .floats = {IS(transmission[0], 0.25), IS(transmission[1], 1), IS(ior, 1.33)}, .fresnel = true},
    /* Glass refracts what it does not reflect, and `d` decides over Tf. */
    {"Ks 0.25 0.5 0\nTf 1 0.5 0.5\nillum 6\n",
     .floats = {IS(transmission[0], 0.75), IS(transmission[1], 0.25), IS(transmission[2], 0.5),
                IS(reflection[1], 0.5)}},
    {"d 0.1\nTf 0.9 0.9 0.9\nNi 1.5\nillum 6\n", .floats = {IS(transmission[0], 0.9)}},
    {"Tf 0.1 0.1 0.1\nNi 2.5\nillum 7\n", .floats = {IS(transmission[0], 0.9)}, .fresnel = true,
     .note = "held back"},
    {"Tr 1.0\nillum 7\n", .floats = {IS(transmission[0], 1)}, .fresnel = true},
    {"Tr 0.25\nillum 2\n", .floats = {IS(opacity, 0.75)}, .alpha = SCENE_ALPHA_BLEND},
    {"Tr 1.0\nillum 2\n", .floats = {IS(opacity, 1)}, .note = "Tr 1 is drawn as opaque"},
    {"d 0\nillum 2\n", .floats = {IS(opacity, 1)}, .note = "d 0, as all materials have, is drawn"},
    {"d 0\nnewmtl other\nd 0.5\n", .floats = {IS(opacity, 0)}, .alpha = SCENE_ALPHA_BLEND},
    {"illum 10\n", .shadow_catcher = true},
    {"Ka 0.2 0 0\nKd 0 0 0\nKs 1 1 1\nNs 1\n", /* zeros that are meant */
     .floats = {IS(ambient[0], 0.2), IS(ambient[1], 0), IS(diffuse[0], 0), IS(specular[0], 1)}},
};

TEST_IN(classes_of_materials, fixture_begin, fixture_end)
{
    for (size_t i = 0; i < sizeof classes / sizeof *classes; i++) {
        own_memory char *mtl = string_format("newmtl m%zu\n%s", i, classes[i].mtl);
        own_memory char *obj = string_format("mtllib a.mtl\n" QUAD "usemtl m%zu\nf 1 2 3 4\n", i);
        uint32_t notes = fixture.scene->note_count;
        put_text("a.mtl", mtl);
        fixture_mesh(put_text("a.obj", obj));
        const struct scene_material *m = &fixture.scene->materials[i];
        for (int k = 0; k < 4 && classes[i].floats[k].field; k++) {
            float value;
            memcpy(&value, (const char *)m + classes[i].floats[k].at, sizeof value);
            if (fabs((double)value - classes[i].floats[k].value) > 1e-6)
                fail_msg("%s%s is %g", mtl, classes[i].floats[k].field, (double)value);
        }
        const char *illum = strstr(mtl, "illum ");
        assert_int_equal(m->illum, illum ? atoi(illum + 6) : 2);
        assert_int_equal(m->model, WHIT_MODEL_PHONG);
        assert_int_equal(m->fresnel, classes[i].fresnel);
        assert_int_equal(m->thin_walled, false);
        assert_int_equal(m->shadow_catcher, classes[i].shadow_catcher);
        assert_int_equal(m->alpha, classes[i].alpha);
        assert_int_equal(fixture.scene->note_count - notes, classes[i].note != NULL);
        assert_true(!classes[i].note || fixture_noted(classes[i].note));
    }
}

/* --- maps ----------------------------------------------------------------------------------- */

/* Writes a 4x4 picture whose left half has alpha `left_alpha`. */
static void write_picture(const char *name, float left_alpha)
{
    own_image image = {0};
    const char *path = put_data(name, "", 0);
    assert_int_equal(image_init(&image, 4, 4, 4, false), WHIT_OK);
    for (uint32_t i = 0; i < 16; i++)
        for (uint32_t k = 0; k < 4; k++)
            image.pixels[4 * i + k] = k == 3 && i % 4 < 2 ? left_alpha : 1.0f;
    assert_int_equal(image_save(&fixture.log, &image, NULL, 0, path, NULL, 0), WHIT_OK);
}

TEST_IN(maps_with_options, fixture_begin, fixture_end)
{
    write_picture("a b.png", 1);
    const struct scene_material *m =
        load_material("newmtl m\nmap_Kd -s 2 4 1 -o 0.25 -clamp on a b.png\n"
                      "map_Bump -imfchan r \"a b.png\" -bm 1.5\nmap_Ks gone.png\n");
    const struct scene_texture_use *use = &m->textures[SCENE_SLOT_DIFFUSE];
    /* The picture, and its red channel alone for -imfchan. */
    assert_int_equal(fixture.scene->texture_count, 2);
    assert_int_equal(use->texture, 0);
    assert_int_equal(use->wrap_u, SCENE_WRAP_CLAMP);
    assert_float_equal(use->transform[0], 2, 0);
    assert_float_equal(use->transform[2], 0.25, 0);
    assert_float_equal(use->transform[4], 4, 0);
    assert_float_equal(use->transform[5], 1 - 4, 0); /* v_down = 0 is v = 1, sampled at v = 4 */
    assert_float_equal(m->diffuse[0], 1, 0);
    assert_int_equal(m->textures[SCENE_SLOT_BUMP].texture, 1);
    assert_float_equal(m->normal_scale, 1.5, 0);
    assert_int_equal(m->textures[SCENE_SLOT_SPECULAR].texture, SCENE_NONE);
    assert_true(fixture_noted("a.mtl:4: texture `gone.png`: there is no such file"));
}

/* The red 8-bit code of a map's first texel. */
static int first_texel(const struct scene_material *m, enum scene_slot slot)
{
    assert_true(m->textures[slot].texture < fixture.scene->texture_count);
    return fixture.scene->textures[m->textures[slot].texture].rgba[0];
}

TEST_IN(channels_and_ranges_of_maps, fixture_begin, fixture_end)
{
    struct image image;
    const char *path = put_data("t.png", "", 0);
    assert_int_equal(image_init(&image, 1, 1, 4, false), WHIT_OK);
    for (int k = 0; k < 4; k++)
        image.pixels[k] = k == 3 ? 0.6f : image_linear_from_srgb((float)(50 * (k + 1)) / 255.0f);
    assert_int_equal(image_save(&fixture.log, &image, NULL, 0, path, NULL, 0), WHIT_OK);
    image_finish(&image);
    const struct scene_material *m = load_material(
        "newmtl m\nillum 2\nKd 1 1 1\nmap_Kd -mm 0.2 0.5 t.png\n"
        "map_Ns -imfchan m t.png\nmap_d -imfchan g t.png\nbump -imfchan l t.png\n"
        "map_Ks -t 1 1 1 -cc on -imfchan z -boost 2 t.png\nmap_Ke -imfchan b t.png\n");
    assert_int_equal(first_texel(m, SCENE_SLOT_DIFFUSE), 51 + 25);
    assert_int_equal(first_texel(m, SCENE_SLOT_METAL_ROUGH), 153);
    assert_int_equal(first_texel(m, SCENE_SLOT_OPACITY), 100);
    assert_int_equal(first_texel(m, SCENE_SLOT_BUMP), 93);
    assert_int_equal(first_texel(m, SCENE_SLOT_EMISSION), 150);
    assert_int_equal(first_texel(m, SCENE_SLOT_SPECULAR), 50);
    assert_float_equal(m->textures[SCENE_SLOT_SPECULAR].transform[2], 0, 0);
    assert_true(fixture_noted("`-t` (turbulence) was ignored"));
    assert_true(fixture_noted("`-cc` (colour correction) was ignored"));
    assert_true(fixture_noted("`-imfchan` of that channel was ignored"));
    assert_false(fixture_noted("-boost"));
}

TEST_IN(zeros_that_nobody_means, fixture_begin, fixture_end)
{
    const struct scene_material *m =
        load_material("newmtl m\nKa 0 0 0\nKd 0 0 0\nKs 0.9 0.9 0.9\nNs 0\nillum 3\n"
                      "map_Kd gone.png\nnewmtl other\nKa 1 1 1\nKd 0 0 0\n");
    for (int k = 0; k < 3; k++) {
        assert_float_equal(m->diffuse[k], 1, 0);
        assert_float_equal(m->ambient[k], 1, 0);
        assert_float_equal(m->specular[k], 0, 0);
        assert_float_equal(m->reflection[k], 0.9f, 0);
    }
    assert_true(fixture_noted("map_Kd is drawn as with a Kd of 1"));
    assert_true(fixture_noted("Ns 0 makes no highlight"));
}

TEST_IN(unused_maps_are_named, fixture_begin, fixture_end)
{
    load_material("newmtl m\ndisp d.png\ndecal d.png\nrefl -type sphere d.png\n"
                  "map_Ka a.png\nmap_Kd k.png\n");
    assert_true(fixture_noted("a.mtl:2: `disp` is not used"));
    assert_true(fixture_noted("a.mtl:3: `decal` is not used"));
    assert_true(fixture_noted("a.mtl:4: `refl` is not used"));
    assert_true(fixture_noted("`a.png` of map_Ka"));
}

TEST_IN(alpha_cuts_out_once, fixture_begin, fixture_end)
{
    write_picture("leaf.png", 0);
    const struct scene_material *m =
        load_material("newmtl m\nmap_Kd leaf.png\nmap_d .\\leaf.png\n");
    assert_int_equal(m->alpha, SCENE_ALPHA_MASK);
    assert_float_equal(m->alpha_cutoff, 0.5, 0);
    assert_int_equal(m->textures[SCENE_SLOT_DIFFUSE].texture, 0);
    assert_int_equal(m->textures[SCENE_SLOT_OPACITY].texture, SCENE_NONE);
}

TEST_IN(whole_pictures_cut_out_nothing, fixture_begin, fixture_end)
{
    write_picture("wall.png", 1);
    assert_int_equal(load_material("newmtl m\nmap_Kd wall.png\n")->alpha, SCENE_ALPHA_OPAQUE);
}

TEST_IN(models_too_large_are_refused, fixture_begin, fixture_end)
{
    const char *path = put_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    fixture.scene->memory_limit = 200;
    assert_int_equal(fixture_load(path), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, "mesh `a.obj` of 1 triangles would take"));
    assert_int_equal(fixture.scene->mesh_count, 0);
}
