/* The importer's child process, and the checks of its reply. */
#include <fcntl.h>
#include <unistd.h>

#include "../wrapped.h"
#include "load/importer.h"
#include "load/model.h"
#include "load_model_fixture.h"
#include "unit.h"

/* Wrapped at link time: an importer that never ends, and a clock that each reading advances. */
static bool importer_hangs, importer_opens;

WRAPPED(double, clock_ms, void)
{
    static double now_ms;
    return importer_hangs ? now_ms += 1.0 : __real_clock_ms();
}

WRAPPED(whit_result, importer_assimp_run, void *user, void *to, child_write write,
        struct foreign_answer *answer)
{
    while (importer_hangs)
        for (volatile unsigned i = 0; i < 1000; ++i)
            ;
    if (importer_opens && open("/etc/passwd", O_RDONLY) >= 0)
        return WHIT_OK;
    return __real_importer_assimp_run(user, to, write, answer);
}

/* A reply of one triangle, laid out as the child does. */
struct block {
    struct import_header header;
    struct import_record record;
    char name[8], material[4];
    float positions[9];
    uint32_t indices[3];
};

static struct block good_block(void)
{
    return (struct block){
        .header.part_count = 1,
        .record = {4, 3, 3, 1, 1u << PART_POSITIONS | 1u << PART_INDICES},
        .name = "part",
        .material = "mat",
        .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0},
        .indices = {0, 1, 2},
    };
}

static whit_result parse(struct block *block, size_t size)
{
    struct import_block out = {0};
    whit_result result = importer_parse((uint8_t *)block, size, &out);
    if (result == WHIT_OK) {
        assert_int_equal(out.part_count, 1);
        assert_string_equal(out.parts[0].name, "part");
        assert_string_equal(out.parts[0].material, "mat");
        assert_int_equal(((uint32_t *)out.parts[0].arrays[PART_INDICES])[2], 2);
        assert_null(out.parts[0].arrays[PART_NORMALS]);
    }
    free(out.parts);
    return result;
}

/* A field of the good block, and what it becomes. */
#define FIELD(name) #name, offsetof(struct block, name), sizeof((struct block *)0)->name
static const struct {
    const char *name;
    size_t at, bytes;
    uint64_t value;
} damages[] = {
    {FIELD(header.part_count), 2},
    {FIELD(header.part_count), UINT32_MAX},
    {FIELD(indices[1]), 3},
    {FIELD(record.vertex_count), 0},
    {FIELD(record.vertex_count), 2},
    {FIELD(record.vertex_count), 64},
    {FIELD(record.triangle_count), UINT32_MAX},
    {FIELD(record.arrays), 1u << PART_INDICES},
    {FIELD(record.arrays), 1u << PART_POSITIONS},
    {FIELD(record.arrays), 1u << PART_POSITIONS | 1u << PART_NORMALS | 1u << PART_INDICES},
    {FIELD(record.arrays), 1u << PART_POSITIONS | 3u << PART_INDICES},
    {FIELD(record.name_bytes), 3},
    {FIELD(record.name_bytes), 5},
    {FIELD(record.material_bytes), UINT32_MAX},
};

TEST(damaged_replies_are_refused)
{
    struct block block = good_block();
    assert_int_equal(parse(&block, sizeof block), WHIT_OK);
    assert_int_equal(parse(&block, 3), WHIT_ERROR_INPUT);
    assert_int_equal(parse(&block, sizeof block - 4), WHIT_ERROR_INPUT);
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        block = good_block();
        memcpy((uint8_t *)&block + damages[i].at, &damages[i].value, damages[i].bytes);
        if (parse(&block, sizeof block) != WHIT_ERROR_INPUT)
            fail_msg("damage %zu, of %s, was not seen", i, damages[i].name);
    }
}

TEST(reasons_are_one_line)
{
    char reason[128];
    foreign_text("no\ngood\n", 8, reason, sizeof reason);
    assert_string_equal(reason, "no good");
}

/* --- PLY and STL ---------------------------------------------------------------------------- */

/* Properties of vertices and of faces. */
#define XYZ     "property float x\nproperty float y\nproperty float z\n"
#define CORNERS "property list uchar int vertex_indices\n"

#define PLY_HEADER                                                                                 \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"                \
    "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"            \
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"

TEST_IN(colors_of_scans, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh = fixture_mesh(
        put_text("a.ply", PLY_HEADER "0 0 0 255 0 0\n1 0 0 0 128 0\n0 1 0 0 0 255\n3 0 1 2\n"));
    assert_non_null(mesh->colors);
    assert_float_equal(mesh->colors[4 * mesh->indices[0]], 1, 1e-6);
    assert_float_equal(mesh->colors[4 * mesh->indices[1] + 1], 0.2158605, 1e-5); /* sRGB 128 */
}

/* Blank lines between elements, of which assimp loses one for each. */
TEST_IN(blank_lines_in_a_ply, fixture_begin, fixture_end)
{
    static const char *const ends[] = {"\n", "\r\n"};
    static const char *const header[] = {"ply",
                                         "format ascii 1.0",
                                         "element vertex 4",
                                         "property float x",
                                         "property float y",
                                         "property float z",
                                         "element face 2",
                                         "property list uchar int vertex_indices",
                                         "end_header",
                                         NULL};
    static const char *const data[] = {"",      "0 0 0",   "", " \t", "1 0 0",   "", "1 1 0",
                                       "0 1 0", "3 0 1 2", "", "",    "3 0 2 3", "", NULL};
    for (int i = 0; i < 2; ++i) {
        char text[1024];
        size_t used = 0;
        for (int k = 0; header[k]; ++k)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", header[k], ends[i]);
        for (int k = 0; data[k]; ++k)
            used += (size_t)snprintf(text + used, sizeof text - used, "%s%s", data[k], ends[i]);
        assert_int_equal(fixture_load(put_text("a.ply", text)), WHIT_OK);
        const struct scene_mesh *mesh = &fixture.scene->meshes[0];
        assert_int_equal(mesh->triangle_count, 2);
        assert_float_equal(mesh->positions[3 * mesh->indices[5] + 1], 1, 0);
    }
}

/* A binary PLY whose first data byte is that of a line end. */
TEST_IN(binary_data_that_looks_like_a_line_end, fixture_begin, fixture_end)
{
    static const char header[] = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n" XYZ
                                 "element face 1\n" CORNERS "end_header\n";
    const uint8_t first[4] = {0x0a, 0xf6, 0xbe, 0x40};
    float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint8_t face[13] = {3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0};
    uint8_t file[sizeof header + sizeof positions + sizeof face];
    memcpy(positions, first, sizeof first);
    memcpy(file, header, sizeof header - 1);
    memcpy(file + sizeof header - 1, positions, sizeof positions);
    memcpy(file + sizeof header - 1 + sizeof positions, face, sizeof face);
    const struct scene_mesh *mesh = fixture_mesh(put_data("a.ply", file, sizeof file - 1));
    assert_int_equal(mesh->triangle_count, 1);
    assert_memory_equal(mesh->positions + 3 * mesh->indices[0], positions, sizeof *positions);
}

#define STRIPS_HEADER(format, vertices)                                                            \
    "ply\nformat " format " 1.0\nelement vertex " #vertices "\nproperty float x\n"                 \
    "property float y\nproperty float z\nelement tristrips 2\n"                                    \
    "property list uchar int vertex_indices\nelement tag 1\nproperty uchar value\nend_header\n"

/* Strips: every second triangle is reversed, -1 begins a new strip, degenerate triangles
   connect. */
static const int32_t strip_numbers[2][9] = {{9 - 1, 0, 1, 2, 3, -1, 3, 1, 0}, {4, 0, 1, 1, 2}};

static void append_strip_file(FILE *file, const char *format)
{
    static const float positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    bool ascii = *format == 'a', big = strstr(format, "big") != NULL;
    for (int i = 0; i < 12; i++) {
        uint32_t bits;
        memcpy(&bits, &positions[i], 4);
        for (int k = 0; k < 4 && !ascii; k++)
            fputc((int)(bits >> 8 * (big ? 3 - k : k) & 255), file);
        if (ascii)
            fprintf(file, "%g%c", (double)positions[i], i % 3 == 2 ? '\n' : ' ');
    }
    for (int strip = 0; strip < 2; strip++)
        for (int i = 0; i <= strip_numbers[strip][0]; i++) {
            int32_t number = strip_numbers[strip][i];
            if (ascii)
                fprintf(file, "%d%c", number, i == strip_numbers[strip][0] ? '\n' : ' ');
            for (int k = 0; k < (i ? 4 : 1) && !ascii; k++)
                fputc((int)((uint32_t)number >> 8 * (i && big ? 3 - k : k) & 255), file);
        }
    fputs(ascii ? "7\n" : "\7", file);
}

TEST_IN(strips_become_triangles, fixture_begin, fixture_end)
{
    static const struct {
        const char *format, *header;
    } rows[] = {{"ascii", STRIPS_HEADER("ascii", 4)},
                {"little", STRIPS_HEADER("binary_little_endian", 4)},
                {"big", STRIPS_HEADER("binary_big_endian", 4)}};
    const uint32_t wanted[9] = {0, 1, 2, 2, 1, 3, 3, 1, 0};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *bytes = NULL;
        size_t size;
        FILE *file = open_memstream(&bytes, &size);
        assert_non_null(file);
        fputs(rows[i].header, file);
        append_strip_file(file, rows[i].format);
        assert_int_equal(fclose(file), 0);
        const char *path = put_data("strip.ply", bytes, size);
        free(bytes);
        if (fixture_load(path) != WHIT_OK)
            fail_msg("%s: %s", rows[i].format, messages.last_error);
        const struct scene_mesh *mesh = &fixture.scene->meshes[i];
        assert_int_equal(mesh->triangle_count, 3);
        assert_memory_equal(mesh->indices, wanted, sizeof wanted);
    }
}

TEST_IN(damaged_strips_are_refused, fixture_begin, fixture_end)
{
    static const char *const files[] = {
        STRIPS_HEADER("ascii", 3) "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n3 0 1 2\n7\n",
        STRIPS_HEADER("ascii", 3) "0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n3 0 1 2\n7\n",
        STRIPS_HEADER("ascii", 3) "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1",
        STRIPS_HEADER("ascii", 3) "0 0 0\n1 0 0\n0 1 0\n3 0 x 2\n3 0 1 2\n7\n",
        STRIPS_HEADER("binary_little_endian", 1) "\1\1\1\1\1\1\1\1\1\1\1\1\1\1",
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        fixture_refused(put_text("strip.ply", files[i]),
                        "strip.ply: its triangle strips are cut short, are no whole numbers");
    }
}

TEST_IN(facets_are_welded, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh = fixture_mesh(put_text(
        "a.stl",
        "solid s\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nfacet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 1 1 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid s\n"));
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->vertex_count, 4);
    assert_null(mesh->normals);
}

#define FACES_HEADER(format)                                                                       \
    "ply\nformat " format " 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\n"           \
    "property uchar z\nelement face 2\nproperty list uchar uchar vertex_indices\nend_header\n"

TEST_IN(faces_that_a_ply_lacks_are_told, fixture_begin, fixture_end)
{
    static const struct {
        const char *text, *reason;
    } files[] = {
        {FACES_HEADER("ascii") "0 0 0\n1 0 0\n0 1 0\n",
         "face 1 of 2 is cut short, missing or not of numbers"},
        {FACES_HEADER("ascii") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1",
         "face 2 of 2 is cut short, missing or not of numbers"},
        {FACES_HEADER("ascii") "0 0 0\n1 0\n0 1 0\n3 0 1 2\n3 0 1 2\n",
         "vertex 2 of 3 is cut short, missing or not of numbers"},
        {"ply\nformat ascii 1.0\nelement vertex 0\nproperty flout x\nend_header\n",
         "a.ply:4: its header names a type of numbers that PLY does not have"},
        {FACES_HEADER("binary_big_endian") "123456789\3\1\1\1\3\1\1",
         "face 2 of 2 is cut short, missing or not of numbers"},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        fixture_refused(put_text("a.ply", files[i].text), files[i].reason);
    }
    const char *whole = FACES_HEADER("ascii") "0 0 0\n1 0 0\n0 1 0\n\n3 0 1 2\r\n3 0 1 2";
    assert_int_equal(fixture_load(put_text("a.ply", whole)), WHIT_OK);
}

TEST_IN(faces_without_corners_are_dropped, fixture_begin, fixture_end)
{
    static const char ascii[] = FACES_HEADER("ascii") "0 0 0\n1 0 0\n0 1 0\n0\n3 0 1 2";
    static const char binary[] = FACES_HEADER("binary_big_endian") "\0\0\0\1\0\0\0\1\0\0\3\0\1\2";
    for (int i = 0; i < 2; i++) {
        const struct scene_mesh *mesh = fixture_mesh(
            put_data("a.ply", i ? binary : ascii, (i ? sizeof binary : sizeof ascii) - 1));
        assert_int_equal(mesh->triangle_count, 1);
        assert_true(fixture_noted("a.ply: 1 faces without corners were dropped"));
    }
}

TEST_IN(faces_may_stand_in_front_of_vertices, fixture_begin, fixture_end)
{
    static const char *const ends[] = {"\n", ""};
    for (int i = 0; i < 2; ++i) {
        char text[512];
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\nelement face 1\n" CORNERS "element vertex 3\n" XYZ
                 "end_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0%s",
                 ends[i]);
        const struct scene_mesh *mesh = fixture_mesh(put_text("a.ply", text));
        assert_int_equal(mesh->triangle_count, 1);
        assert_float_equal(mesh->positions[3 * mesh->indices[1]], 1, 0);
    }
}

#define COLORS_HEADER(type, name)                                                                  \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"                \
    "property float z\nproperty " type " " name "red\nproperty " type " " name                     \
    "green\nproperty " type " " name "blue\nelement face 1\n"                                      \
    "property list uchar int vertex_indices\nend_header\n"

/* assimp divides some types by another number than that of the file's range. */
TEST_IN(colors_of_all_types, fixture_begin, fixture_end)
{
    static const struct {
        const char *header, *color;
    } rows[] = {
        {COLORS_HEADER("uchar", ""), "255 128 0"},
        {COLORS_HEADER("uchar", "diffuse_"), "255 128 0"},
        {COLORS_HEADER("int", ""), "255 128 0"},
        {COLORS_HEADER("uint", ""), "255 128 0"},
        {COLORS_HEADER("short", ""), "255 128 0"},
        {COLORS_HEADER("ushort", ""), "65535 32896 0"},
        {COLORS_HEADER("float", ""), "255 128 0"},
        {COLORS_HEADER("double", ""), "1 0.50196078 0"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        own_memory char *text =
            string_format("%s0 0 0 %s\n1 0 0 %s\n0 1 0 %s\n3 0 1 2\n", rows[i].header,
                          rows[i].color, rows[i].color, rows[i].color);
        const struct scene_mesh *mesh = fixture_mesh(put_text("a.ply", text));
        assert_non_null(mesh->colors);
        assert_float_equal(mesh->colors[0], 1, 1e-4);
        assert_float_equal(mesh->colors[1], 0.2158605, 1e-4); /* sRGB 128 */
        assert_float_equal(mesh->colors[2], 0, 1e-5);
        assert_float_equal(mesh->colors[3], 1, 0);
    }
}

TEST_IN(colors_of_faces_and_materials_are_noted, fixture_begin, fixture_end)
{
    const char *text = "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ "element face 1\n" CORNERS
                       "property uchar red\nelement material 1\nproperty uchar "
                       "ambient_red\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255\n7\n";
    assert_int_equal(fixture_load(put_text("a.ply", text)), WHIT_OK);
    assert_true(fixture_noted("a.ply: colours of 1 faces are not read"));
    assert_true(fixture_noted("a.ply: its materials are not read"));
}

/* The file is searched for as those of MTL are. */
TEST_IN(textures_of_a_ply, fixture_begin, fixture_end)
{
    put_text("my bricks.png", "no picture");
    const char *text = "ply\nformat ascii 1.0\ncomment TextureFile dir\\my bricks.png\ncomment "
                       "TextureFile b.png\nelement vertex 3\n" XYZ
                       "property float s\nproperty float t\nelement face 1\n" CORNERS
                       "end_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n";
    const struct scene_mesh *mesh = fixture_mesh(put_text("a.ply", text));
    const struct scene_material *material = &fixture.scene->materials[mesh->materials[0]];
    assert_int_not_equal(material->textures[SCENE_SLOT_DIFFUSE].texture, SCENE_NONE);
    assert_float_equal(material->diffuse[0], 1, 0);
    assert_true(fixture_noted("texture `my bricks.png`"));
    assert_false(fixture_noted("no such file"));
    assert_true(fixture_noted("a.ply: of its textures only the first is drawn"));
    static const char zeros[] =
        "ply\nformat ascii 1.0\ncomment\0TextureFile \0x\nelement vertex 3\nproperty "
        "uchar\0diffuse_red\nelement face 0\n" CORNERS "end_header\n1\n2\n3\n";
    assert_int_equal(fixture_load(put_data("b.ply", zeros, sizeof zeros - 1)), WHIT_ERROR_INPUT);
}

#define UNREAD_HEADER(format)                                                                      \
    "ply\nformat " format " 1.0\ncomment a\nelement cell 2\nproperty int id\nelement vertex 3\n"   \
    "property uchar x\ncomment b\nproperty uchar y\nobj_info c\nproperty uchar z\n"                \
    "element segment 1\nproperty uchar id\nproperty list uchar uchar w\nelement face 1\n"          \
    "property list uchar uchar vertex_indices\nelement tag 1\nproperty uchar value\nend_header\n"

/* Elements and comments, for which assimp skips wrong lines, bytes and properties. */
TEST_IN(unread_elements_of_a_ply_shift_nothing, fixture_begin, fixture_end)
{
    static const char ascii[] =
        UNREAD_HEADER("ascii") "7\n9\n\n1 2 3\n4 2 3\n1 5 3\n8 2 1 1\n3 0 1 2\n6";
    static const char binary[] = UNREAD_HEADER("binary_little_endian") "\7\0\0\0\11\0\0\0"
                                                                       "\1\2\3\4\2\3\1\5\3"
                                                                       "\10\2\1\1"
                                                                       "\3\0\1\2"
                                                                       "\6";
    const float wanted[9] = {1, 2, 3, 4, 2, 3, 1, 5, 3};
    for (int i = 0; i < 2; i++) {
        const char *path =
            put_data("a.ply", i ? binary : ascii, (i ? sizeof binary : sizeof ascii) - 1);
        if (fixture_load(path) != WHIT_OK)
            fail_msg("%s", messages.last_error);
        const struct scene_mesh *mesh = &fixture.scene->meshes[i];
        assert_int_equal(mesh->triangle_count, 1);
        for (uint32_t k = 0; k < 9; k++)
            assert_float_equal(mesh->positions[3 * mesh->indices[k / 3] + k % 3], wanted[k], 0);
    }
}

TEST_IN(polygons_of_missing_vertices_are_dropped, fixture_begin, fixture_end)
{
    const char *text = FACES_HEADER("ascii") "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n6 0 1 2 250 251 252\n";
    assert_int_equal(fixture_load(put_text("a.ply", text)), WHIT_OK);
    assert_true(fixture_noted("a.ply: 1 faces without area or with bad indices were dropped"));
    assert_int_equal(fixture.scene->meshes[0].triangle_count, 1);
}

/* Writes a binary STL of two triangles and 7 more bytes, which says that it has `count`. */
static const char *put_stl(uint8_t count, size_t size_bytes)
{
    uint8_t data[84 + 2 * 50 + 7] = "solid";
    static const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 1, 0, 0, 0, 1}};
    data[80] = count;
    for (size_t i = 0; i < 2; i++)
        memcpy(data + 84 + i * 50 + 12, corners[i], sizeof corners[i]);
    return put_data("a.stl", data, size_bytes);
}

TEST_IN(keywords_of_an_stl_in_upper_case, fixture_begin, fixture_end)
{
    const struct scene_mesh *mesh = fixture_mesh(
        put_text("a.stl", "\xef\xbb\xbf \n SOLID MyPart\nFACET NORMAL 0 0 1\nOUTER LOOP\n"
                          "VERTEX 0 0 0\nVERTEX 1.5E+00 0 0\nVERTEX 0 1 0\nENDLOOP\n"
                          "ENDFACET\nENDSOLID MyPart\n"));
    assert_int_equal(mesh->triangle_count, 1);
    assert_float_equal(mesh->positions[3 * mesh->indices[1]], 1.5, 0);
    assert_string_equal(mesh->groups[0].name, "MyPart");
}

TEST_IN(keywords_in_the_name_of_an_stl, fixture_begin, fixture_end)
{
    static const char *const names[] = {"my part facet vertex", "my endsolid"};
    for (size_t i = 0; i < 2; i++) {
        own_memory char *text = string_format("solid %s\nfacet normal 0 0 1\nouter loop\n"
                                              "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                                              "endfacet\nendsolid %s\n",
                                              names[i], names[i]);
        assert_int_equal(fixture_mesh(put_text("a.stl", text))->triangle_count, 1);
    }
}

TEST_IN(bytes_behind_the_triangles_of_an_stl_are_noted, fixture_begin, fixture_end)
{
    assert_int_equal(fixture_load(put_stl(2, 184)), WHIT_OK);
    assert_int_equal(fixture.scene->note_count, 0);
    assert_int_equal(fixture_load(put_stl(2, 191)), WHIT_OK);
    assert_true(fixture_noted("a.stl: 7 bytes behind its triangles are not read"));
    assert_int_equal(fixture_load(put_stl(1, 184)), WHIT_OK);
    assert_true(fixture_noted("a.stl: 50 bytes behind its triangles are not read"));
    assert_int_equal(fixture.scene->meshes[1].triangle_count, 2);
    assert_int_equal(fixture.scene->meshes[2].triangle_count, 1);
}

TEST_IN(triangles_that_an_stl_lacks_are_told, fixture_begin, fixture_end)
{
    fixture_refused(put_stl(3, 191), "a.stl: it says that it has 3 triangles, and has room for 2");
    fixture_refused(put_stl(2, 183), "a.stl: it says that it has 2 triangles, and has room for 1");
    fixture_refused(put_stl(0, 184), "a.stl: it says that it has 0 triangles, and has room for 2");
}

/* --- hostile files -------------------------------------------------------------------------- */

/* Errors name the file by its real path, not by the name under which assimp gets it. */
TEST_IN(refusals_name_the_file, fixture_begin, fixture_end)
{
    char rubbish[401] = "";
    memset(rubbish, 'x', sizeof rubbish - 1);
    const char *path = put_text("lamp.stl", rubbish);
    assert_int_equal(fixture_load(path), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, ": assimp: "));
    assert_non_null(strstr(strstr(messages.last_error, ": assimp: "), "lamp.stl"));
    assert_null(strstr(messages.last_error, "model.stl"));
}

TEST_IN(claims_of_endless_memory_are_refused, fixture_begin, fixture_end)
{
    const char *path =
        put_text("a.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\n" XYZ
                          "element face 4000000000\n" CORNERS "end_header\n0123456789");
    fixture_refused(path, ".ply:3: 4000000000 elements, but only 10 bytes behind the header");
    path = put_text("b.ply", "ply\nformat ascii 1.0\nelement vertex 300000000\nproperty float x\n"
                             "end_header");
    fixture_refused(path, ".ply:3: 300000000 elements, but only 0 bytes behind the header");
    path = put_text("d.ply", "ply\nformat ascii 1.0\nelement vertex -3\n" XYZ "end_header\n");
    fixture_refused(path, ".ply:3: it says no number of elements");
    path =
        put_text("c.ply", "ply\nformat ascii 1.0\nelement empty 4000000000\nelement vertex 3\n" XYZ
                          "element face 1\n" CORNERS "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    assert_int_equal(fixture_load(path), WHIT_OK);
}

/* A word of 32 characters is one word: nothing is missing of the element of that name. */
TEST_IN(long_names_of_ply_elements_are_one_word, fixture_begin, fixture_end)
{
    const char *path = put_text(
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ
        "element a23456789b23456789c23456789d2341 0\nproperty float w\nelement face 1\n" CORNERS
        "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    assert_int_equal(fixture_load(path), WHIT_OK);
}

/* Headers without an end are refused, since assimp would read until its time limit. */
TEST_IN(headers_without_an_end_are_refused, fixture_begin, fixture_end)
{
    const char *path = put_text("a.ply", "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\n"
                                         "property float x\r\nend_heade");
    fixture_refused(path, ".ply:6: the file ends within its header");
}

/* `count` corners on a circle, as lines "`word` x y z"; free() it. */
static char *circle(const char *word, unsigned count)
{
    char *text = NULL;
    size_t bytes;
    FILE *file = open_memstream(&text, &bytes);
    assert_non_null(file);
    for (unsigned i = 0; i < count; i++) {
        double angle = 8.0 * atan(1.0) * i / count;
        fprintf(file, "%s%.9g %.9g 0\n", word, cos(angle), sin(angle));
    }
    assert_int_equal(fclose(file), 0);
    return text;
}

/* Writes an OBJ with one face of `count` corners, on two lines joined by a backslash. */
static const char *write_round_obj(const char *name, unsigned count)
{
    char *corners = circle("v ", count), *path = in_folder(name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "%sf 1 2 3\nf", corners);
    for (unsigned i = 1; i <= count; i++)
        fprintf(file, i == count / 2 ? " \\\n%u" : " %u", i);
    fputs("\nf 1 2 4\n", file);
    assert_int_equal(fclose(file), 0);
    free(corners);
    return path;
}

/* assimp takes cubic time in a face's number of corners. */
TEST_IN(faces_of_very_many_corners_are_refused, fixture_begin, fixture_end)
{
    fixture_refused(write_round_obj("a.obj", 1025),
                    "a.obj:1027: a face has 1025 corners, at most 1024 are possible");
    assert_int_equal(fixture_load(write_round_obj("b.obj", 1024)), WHIT_OK);
    assert_int_equal(fixture.scene->meshes[0].triangle_count, 1024);
}

TEST_IN(faces_of_a_ply_are_counted_too, fixture_begin, fixture_end)
{
    own_memory char *corners = circle("", 1025), *text = NULL;
    size_t bytes;
    FILE *file = open_memstream(&text, &bytes);
    assert_non_null(file);
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex 1025\n" XYZ
            "element face 2\nproperty list uint uint vertex_indices\nend_header\n%s3 0 1 2\n1025",
            corners);
    for (unsigned i = 0; i < 1025; i++)
        fprintf(file, " %u", i);
    fputc('\n', file);
    assert_int_equal(fclose(file), 0);
    fixture_refused(put_text("a.ply", text),
                    "a.ply: face 1 has 1025 corners, at most 1024 are possible");
}

/* assimp 5.2 crashes on a face index far out of range; whit must not. */
TEST_IN(crashes_stay_in_the_child, fixture_begin, fixture_end)
{
    const char *path = put_text(
        "a.ply",
        "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" XYZ "element face 1\n" CORNERS
        "end_header\n\1\1\1\1\1\1\1\1\1\1\1\1\377\377\377\377\377\377\377\377\377\377\377\377\377");
    assert_int_equal(fixture_load(path), WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, path));
}

TEST_IN(time_limits_are_kept, fixture_begin, fixture_end)
{
    const whit_load_params params = {.time_limit_s = 2.5e-3};
    const char *path = put_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    importer_hangs = true;
    whit_result result = load_model(fixture.scene, path, SCENE_NONE, true, true, &params);
    importer_hangs = false;
    assert_int_equal(result, WHIT_ERROR_INPUT);
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.last_error, "or 0.0025 s by the clock"));
}

TEST_IN(importers_that_reach_out_are_stopped, fixture_begin, fixture_end)
{
    const char *path = put_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    importer_opens = true;
    fixture_refused(path, "the importer tried on this file what it may not");
    importer_opens = false;
    assert_int_equal(fixture_load(path), WHIT_OK);
}

TEST_IN(cancelling_is_not_the_files_fault, fixture_begin, fixture_end)
{
    const bool cancel = true;
    const whit_load_params params = {.cancel = &cancel};
    const char *path = put_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_int_equal(load_model(fixture.scene, path, SCENE_NONE, true, true, &params),
                     WHIT_ERROR_CANCELLED);
}

TEST_IN(unknown_kinds_are_named, fixture_begin, fixture_end)
{
    fixture_refused(put_text("a.blend", "x"), "`.blend`");
}

TEST_IN(missing_files_are_named, fixture_begin, fixture_end)
{
    fixture_refused(in_folder("gone.obj"), "gone.obj");
}
