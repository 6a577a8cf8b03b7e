/* Triangles of glTF: every kind of accessor, every mode, and Draco. */
#include "load_model_fixture.h"
#include "unit.h"

/* Writes b.bin and a glTF with one mesh that uses it. In the given texts ' stands for ". */
static const char *write_gltf(const void *data, size_t size_bytes, const char *views,
                              const char *accessors, const char *primitives)
{
    put_data("b.bin", data, size_bytes);
    return put_json("a.gltf",
                    "{'asset':{'version':'2.0'},'buffers':[{'byteLength':%zu,'uri':'b.bin'}],"
                    "'bufferViews':[%s],'accessors':[%s],'meshes':[{'primitives':[%s]}],"
                    "'nodes':[{'mesh':0}]}",
                    size_bytes, views, accessors, primitives);
}

static void assert_floats(const float *found, const double *wanted, size_t count, const char *what)
{
    for (size_t i = 0; i < count; i++)
        if (!(fabs((double)found[i] - wanted[i]) <= 1e-6))
            fail_msg("%s: [%zu] is %.9g and should be %.9g", what, i, (double)found[i], wanted[i]);
}

/* --- components ----------------------------------------------------------------------------- */

#define POSITIONS "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}"

/* A buffer: three positions, and behind them the data of a test. */
struct data {
    float positions[9];
    uint8_t more[64];
};

static struct data triangle_data(const void *more, size_t size_bytes)
{
    struct data data = {.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0}};
    memcpy(data.more, more, size_bytes);
    return data;
}

/* Tests the colour of the second vertex, 20 bytes behind the first one's, which has offset 4. */
TEST_IN(components_become_floats, fixture_begin, fixture_end)
{
    static const struct {
        int component, bytes, count;
        const char *normalized;
        int64_t values[4];
        double wanted[4];
    } rows[] = {
        {5120, 1, 4, "true", {127, -128, -127, 0}, {1, -1, -1, 0}},
        {5120, 1, 4, "false", {127, -128, 2, 1}, {127, -128, 2, 1}},
        {5121, 1, 4, "true", {255, 51, 0, 102}, {1, 0.2, 0, 0.4}},
        {5121, 1, 4, "false", {255, 51, 0, 1}, {255, 51, 0, 1}},
        {5121, 1, 3, "true", {255, 51, 0}, {1, 0.2, 0, 1}},
        {5122, 2, 4, "true", {32767, -32768, -32767, 0}, {1, -1, -1, 0}},
        {5122, 2, 4, "false", {32767, -32768, 2, 1}, {32767, -32768, 2, 1}},
        {5123, 2, 4, "true", {65535, 13107, 0, 26214}, {1, 0.2, 0, 0.4}},
        {5123, 2, 4, "false", {65535, 256, 0, 1}, {65535, 256, 0, 1}},
        {5125, 4, 4, "false", {16777215, 256, 0, 1}, {16777215, 256, 0, 1}},
        {5126, 4, 4, "false", {0x3f000000, 0x3e800000, 0, 0x3f800000}, {0.5, 0.25, 0, 1}},
        {5126, 4, 3, "false", {0x3f000000, 0x3e800000, 0}, {0.5, 0.25, 0, 1}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t bytes[64] = {0};
        for (int k = 0; k < rows[i].count; k++)
            memcpy(bytes + 4 + 20 + k * rows[i].bytes, &rows[i].values[k], (size_t)rows[i].bytes);
        struct data data = triangle_data(bytes, sizeof bytes);
        own_memory char *accessors = string_format(
            POSITIONS ",{'bufferView':1,'byteOffset':4,'componentType':%d,'normalized':%s,"
                      "'count':3,'type':'VEC%d'}",
            rows[i].component, rows[i].normalized, rows[i].count);
        const struct scene_mesh *mesh =
            fixture_mesh(write_gltf(&data, sizeof data,
                                    "{'buffer':0,'byteLength':36},"
                                    "{'buffer':0,'byteOffset':36,'byteLength':64,'byteStride':20}",
                                    accessors, "{'attributes':{'POSITION':0,'COLOR_0':1}}"));
        assert_int_equal(mesh->indices[1], 1);
        assert_floats(mesh->colors + 4, rows[i].wanted, 4, accessors);
    }
}

/* Elements 0 and 2 are replaced by sparse ones; without a view the others are zeros. */
TEST_IN(sparse_elements_are_replaced, fixture_begin, fixture_end)
{
    static const struct {
        const char *view;
        int component, bytes;
        double wanted[6];
    } rows[] = {
        {"'bufferView':2,", 5121, 1, {5, 6, 0.5, 0.5, 7, 8}},
        {"'bufferView':2,", 5123, 2, {5, 6, 0.5, 0.5, 7, 8}},
        {"'bufferView':2,", 5125, 4, {5, 6, 0.5, 0.5, 7, 8}},
        {"", 5121, 1, {5, 6, 0, 0, 7, 8}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const float values[4] = {5, 1 - 6, 7, 1 - 8}, half[6] = {.5f, .5f, .5f, .5f, .5f, .5f};
        uint8_t bytes[64] = {0};
        bytes[rows[i].bytes] = 2;
        memcpy(bytes + 8, values, sizeof values);
        memcpy(bytes + 24, half, sizeof half);
        struct data data = triangle_data(bytes, sizeof bytes);
        own_memory char *accessors = string_format(
            POSITIONS ",{%s'componentType':5126,'count':3,'type':'VEC2','sparse':{'count':2,"
                      "'indices':{'bufferView':1,'componentType':%d},"
                      "'values':{'bufferView':1,'byteOffset':8}}}",
            rows[i].view, rows[i].component);
        const struct scene_mesh *mesh =
            fixture_mesh(write_gltf(&data, sizeof data,
                                    "{'buffer':0,'byteLength':36},"
                                    "{'buffer':0,'byteOffset':36,'byteLength':24},"
                                    "{'buffer':0,'byteOffset':60,'byteLength':24}",
                                    accessors, "{'attributes':{'POSITION':0,'TEXCOORD_0':1}}"));
        double wanted[6];
        for (int k = 0; k < 6; k++)
            wanted[k] = k % 2 && rows[i].wanted[k] > 4 ? 1 - rows[i].wanted[k] : rows[i].wanted[k];
        assert_floats(mesh->uvs[0], wanted, 6, accessors);
    }
}

/* --- triangles ------------------------------------------------------------------------------ */

TEST_IN(modes_and_indices, fixture_begin, fixture_end)
{
    enum { NONE = 0 };
    static const struct {
        int mode, component, bytes;
        uint32_t corners, indices[6], triangles, wanted[9];
    } rows[] = {
        {4, 5121, 1, 6, {0, 1, 2, 2, 1, 3}, 2, {0, 1, 2, 2, 1, 3}},
        {4, 5123, 2, 5, {3, 1, 2, 2, 1}, 1, {3, 1, 2}},
        {4, 5125, 4, 6, {0, 1, 2, 4, 1, 3}, 1, {0, 1, 2}}, /* there is no vertex 4 */
        {4, NONE, 0, 4, {0}, 1, {0, 1, 2}},
        {5, 5123, 2, 5, {0, 1, 2, 3, 0}, 3, {0, 1, 2, 2, 1, 3, 2, 3, 0}},
        {5, NONE, 0, 4, {0}, 2, {0, 1, 2, 2, 1, 3}},
        {6, 5125, 4, 5, {3, 1, 2, 0, 1}, 3, {3, 1, 2, 3, 2, 0, 3, 0, 1}},
        {6, NONE, 0, 4, {0}, 2, {0, 1, 2, 0, 2, 3}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct {
            float positions[12];
            uint8_t indices[24];
        } data = {.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}};
        for (uint32_t k = 0; k < rows[i].corners && rows[i].bytes; k++)
            memcpy(data.indices + k * (uint32_t)rows[i].bytes, &rows[i].indices[k],
                   (size_t)rows[i].bytes);
        own_memory char *accessors = string_format(
            "{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
            "{'bufferView':0,'byteOffset':48,'componentType':%d,'count':%u,'type':'SCALAR'}",
            rows[i].component, rows[i].corners);
        own_memory char *primitive =
            string_format("{'mode':%d,'attributes':{'POSITION':0}%s}", rows[i].mode,
                          rows[i].component ? ",'indices':1" : "");
        const struct scene_mesh *mesh = fixture_mesh(
            write_gltf(&data, sizeof data, "{'buffer':0,'byteLength':72}", accessors, primitive));
        assert_int_equal(mesh->triangle_count, rows[i].triangles);
        for (uint32_t k = 0; k < 3 * rows[i].triangles; k++)
            if (mesh->indices[k] != rows[i].wanted[k])
                fail_msg("%s %s: corner %u is %u", primitive, accessors, k, mesh->indices[k]);
    }
    assert_true(fixture_noted("meshes[0].primitives[0]: 1 of 2 triangles are damaged and"));
}

/* Invalid normals, and those of a part without any, are replaced by the normals of faces. */
TEST_IN(normals_that_are_missing, fixture_begin, fixture_end)
{
    const float normals[9] = {NAN, 0, 0, 1, 0, 0, 0, 0, 0};
    struct data data = triangle_data(normals, sizeof normals);
    const struct scene_mesh *mesh =
        fixture_mesh(write_gltf(&data, sizeof data, "{'buffer':0,'byteLength':100}",
                                POSITIONS ",{'bufferView':0,'byteOffset':36,'componentType':5126,"
                                          "'count':3,'type':'VEC3'}",
                                "{'attributes':{'POSITION':0,'NORMAL':1}},{'attributes':"
                                "{'POSITION':0}}"));
    const double wanted[18] = {0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    assert_int_equal(mesh->triangle_count, 2);
    for (size_t i = 0; i < 6; i++)
        assert_floats(mesh->normals + 3 * mesh->indices[i], wanted + 3 * i, 3, "normals");
}

TEST_IN(bad_accessors_are_refused, fixture_begin, fixture_end)
{
    static const struct {
        const char *accessors, *primitive, *reason;
    } rows[] = {
        {POSITIONS ",{'bufferView':1,'componentType':5126,'count':3,'type':'VEC3'}",
         "{'attributes':{'POSITION':0,'NORMAL':1}}",
         "accessors[1]: runs past the end of bufferViews[1]"},
        {POSITIONS ",{'bufferView':1,'componentType':5126,'count':2,'type':'VEC3'}",
         "{'attributes':{'POSITION':0,'NORMAL':1}}",
         "meshes[0].primitives[0].attributes: NORMAL has 2 elements where there are 3"},
        {POSITIONS ",{'bufferView':1,'componentType':5126,'count':3,'type':'VEC2'}",
         "{'attributes':{'POSITION':0,'NORMAL':1}}", "NORMAL is not a VEC3"},
        {POSITIONS ",{'bufferView':1,'componentType':5122,'count':3,'type':'SCALAR'}",
         "{'attributes':{'POSITION':0},'indices':1}", "its indices are not unsigned integers"},
        {POSITIONS ",{'bufferView':1,'byteOffset':60,'componentType':5123,'count':3,'type':"
                   "'SCALAR'}",
         "{'attributes':{'POSITION':0},'indices':1}",
         "accessors[1]: runs past the end of bufferViews[1]"},
        {POSITIONS ",{'bufferView':1,'byteOffset':3,'componentType':5121,'count':3,'type':"
                   "'SCALAR'}",
         "{'attributes':{'POSITION':0},'indices':1}",
         "primitives[0]: no triangle has all indices below its 3 vertices"},
        {POSITIONS ",{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':1,'indices':"
                   "{'bufferView':1,'byteOffset':3,'componentType':5121},'values':{'bufferView':"
                   "1}}}",
         "{'attributes':{'POSITION':0,'NORMAL':1}}",
         "accessors[1].sparse: index 9 is out of range, there are 3"},
        {POSITIONS ",{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':1,'indices':"
                   "{'bufferView':1,'componentType':5126},'values':{'bufferView':1}}}",
         "{'attributes':{'POSITION':0,'NORMAL':1}}",
         "accessors[1].sparse: has no indices that are unsigned integers"},
        {POSITIONS ",{'componentType':5126,'count':3,'type':'VEC3','sparse':{'count':3,'indices':"
                   "{'bufferView':1,'componentType':5121},'values':{'bufferView':1}}}",
         "{'attributes':{'POSITION':0,'NORMAL':1}}",
         "accessors[1].sparse: runs past the end of bufferViews[1]"},
        {POSITIONS, "{'attributes':{}}", "primitives[0].attributes: there is no POSITION"},
    };
    static const uint8_t nines[64] = {0, 0, 0, 9, 9, 9};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct data data = triangle_data(nines, sizeof nines);
        const char *path = write_gltf(&data, sizeof data,
                                      "{'buffer':0,'byteLength':36},"
                                      "{'buffer':0,'byteOffset':36,'byteLength':35}",
                                      rows[i].accessors, rows[i].primitive);
        fixture_refused(path, rows[i].reason);
    }
}

/* A small file whose primitives share a sparse accessor with a million elements, nearly all
   zeros. */
TEST_IN(small_files_stay_small, fixture_begin, fixture_end)
{
    struct data data = triangle_data("", 0);
    fixture.scene->memory_limit = UINT64_C(100) << 20;
    const char *path =
        write_gltf(&data, sizeof data, "{'buffer':0,'byteLength':36}",
                   "{'componentType':5126,'count':1000000,'type':'VEC3','sparse':{'count':1,"
                   "'indices':{'bufferView':0,'componentType':5121},'values':{'bufferView':0}}}",
                   "{'attributes':{'POSITION':0}},{'attributes':{'POSITION':0}}");
    assert_int_equal(fixture_load(path), WHIT_ERROR_INPUT);
    assert_non_null(strstr(messages.last_error, "meshes[0].primitives[1] would take"));
    assert_int_equal(fixture.scene->memory_taken, 0);
}

/* --- Draco ---------------------------------------------------------------------------------- */

/* Two triangles of four vertices with texture coordinates and 8-bit colours, encoded by Draco 1.5
   without compression. */
static const uint8_t packed[150] = {
    0x44, 0x52, 0x41, 0x43, 0x4f, 0x02, 0x02, 0x01, 0x00, 0x00, 0x00, 0x02, 0x04, 0x01, 0x00,
    0x01, 0x02, 0x02, 0x01, 0x03, 0x01, 0x03, 0x00, 0x09, 0x03, 0x00, 0x00, 0x03, 0x09, 0x02,
    0x00, 0x01, 0x02, 0x02, 0x03, 0x01, 0x02, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x80, 0x3e, 0x00, 0x00, 0x00, 0x3e, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0x3f, 0x00, 0x00, 0x80, 0x3f,
    0x00, 0x01, 0x01, 0x00, 0x09, 0x03, 0x01, 0x10, 0x01, 0x20, 0x13, 0x01, 0x10, 0x03, 0x00,
    0x90, 0x90, 0x31, 0x30, 0x33, 0xe6, 0x32, 0x00, 0x00, 0x00, 0x00, 0xff, 0x00, 0x00, 0x00};

#define PACKED_PRIMITIVE(more, attributes)                                                         \
    "{'attributes':{'POSITION':0,'TEXCOORD_0':1,'COLOR_0':2" more "},'indices':3,'extensions':"    \
    "{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{" attributes "}}}}"

static const char *write_packed(const uint8_t *bytes, unsigned vertices, const char *uv_type,
                                const char *primitive)
{
    uint8_t data[152 + 48] = {0};
    memcpy(data, bytes, sizeof packed);
    for (size_t i = 0; i < 4; i++)
        memcpy(data + 152 + 12 * i, (const float[3]){0, 0, -1}, 12);
    own_memory char *accessors = string_format(
        "{'componentType':5126,'count':%u,'type':'VEC3'},{%s,'count':%u,'type':'VEC2'},"
        "{'componentType':5121,'normalized':true,'count':%u,'type':'VEC3'},"
        "{'componentType':5125,'count':6,'type':'SCALAR'},"
        "{'bufferView':1,'componentType':5126,'count':%u,'type':'VEC3'}",
        vertices, uv_type, vertices, vertices, vertices);
    return write_gltf(data, sizeof data,
                      "{'buffer':0,'byteLength':150},"
                      "{'buffer':0,'byteOffset':152,'byteLength':48}",
                      accessors, primitive);
}

/* Normals are not in the Draco data: they come from their accessor. */
TEST_IN(draco_is_unpacked, fixture_begin, fixture_end)
{
    const double positions[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    const double uvs[8] = {0.25, 0.125, 1, 0, 0, 1, 1, 1};
    const double colors[16] = {1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0.2, 0.4, 0.8, 1};
    const uint32_t indices[6] = {0, 1, 2, 2, 1, 3};
    const struct scene_mesh *mesh = fixture_mesh(
        write_packed(packed, 4, "'componentType':5126",
                     PACKED_PRIMITIVE(",'NORMAL':4", "'POSITION':0,'TEXCOORD_0':1,'COLOR_0':2")));
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 2);
    assert_floats(mesh->positions, positions, 12, "positions");
    assert_floats(mesh->uvs[0], uvs, 8, "texture coordinates");
    assert_floats(mesh->colors, colors, 16, "colours");
    assert_float_equal(mesh->normals[5], -1, 0);
    assert_memory_equal(mesh->indices, indices, sizeof indices);
}

TEST_IN(bad_draco_is_refused, fixture_begin, fixture_end)
{
    static const char all[] = PACKED_PRIMITIVE("", "'POSITION':0,'TEXCOORD_0':1,'COLOR_0':2");
    static const struct {
        uint8_t first;
        unsigned vertices;
        const char *uv_type, *primitive, *reason;
    } rows[] = {
        {'E', 4, "'componentType':5126", all, "Invalid Draco mesh compression"},
        {'D', 5, "'componentType':5126", all, "count*stride 60 > maxSize 48 in accessors[0]"},
        {'D', 65537, "'componentType':5126", all, "draco: of 65537 vertices: at most 65536 can"},
        {'D', 4, "'componentType':5123", all, "its TEXCOORD_0 is packed by Draco and is not of"},
        {'D', 4, "'componentType':5126", PACKED_PRIMITIVE("", "'COLOR_0':2"),
         "meshes[0].primitives[0].draco: there is no POSITION"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t bytes[sizeof packed];
        memcpy(bytes, packed, sizeof packed);
        bytes[0] = rows[i].first;
        const char *path =
            write_packed(bytes, rows[i].vertices, rows[i].uv_type, rows[i].primitive);
        fixture_refused(path, rows[i].reason);
    }
}
