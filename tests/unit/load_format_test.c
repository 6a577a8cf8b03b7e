/* Recognizing a file's format by its bytes. */
#include "load/format.h"
#include "unit.h"

static void says(const char *text, const char *extension)
{
    const char *found = format_find((const uint8_t *)text, strlen(text));
    if (!found || !extension)
        assert_ptr_equal(found, extension);
    else
        assert_string_equal(found, extension);
}

TEST(text_tells)
{
    static const char *const cases[][2] = {
        {"glTF\x02", "glb"},
        {"{ \"asset\": {} }", "gltf"},
        {"\xef\xbb\xbf\n{\"nodes\": [{\"asset\": 1}], \"asset\" : {}}", "gltf"},
        {"{ \"asset\": {},", "gltf"},
        {"{}", "json"},
        {"\n { \"objects\": [ { \"asset\": 1 } ] }", "json"},
        {"{ \"name\": \"asset\", \"x\": \"\\\"asset\\\": 1\" }", "json"},
        {"{ \"name", "json"},
        {"{ \"name\\", "json"},
        {"ply\nformat ascii 1.0\n", "ply"},
        {"ply\r\n", "ply"},
        {"solid x\nfacet normal 0 0 1\n", "stl"},
        {"; FBX 7.3.0 project file\n", "fbx"},
        {"Kaydara FBX Binary  ", "fbx"},
        {"<?xml version=\"1.0\"?>\n<COLLADA>", "dae"},
        {"PK\x03\x04", "3mf"},
        {"OFF\n3 1 0\n", "off"},
        {"COFF\n3 1 0\n", "off"},
        {"OFF", "off"},
        {"# made by hand\n\nmtllib a.mtl\nv 0 0 0\n", "obj"},
        {"\xef\xbb\xbfv 0 0 0\n", "obj"},
        {"g\nv 0 0 0", "obj"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        says(cases[i][0], cases[i][1]);
}

TEST(what_nothing_tells_is_nothing)
{
    static const char *const cases[] = {
        "",     "\n",      "#",      "# only a comment", "v",         "version 1.0\n", "[1, 2]",
        "plya", "solid x", "<html>", "<svg xmlns=''/>",  "\x89PNG\r", "OFFSET 1\n",    "STCN4n",
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i)
        says(cases[i], NULL);
}

/* A binary STL is recognized by its size, since its header may begin like that of a text STL. */
TEST(a_binary_stl_is_told_by_its_size)
{
    uint8_t data[84 + 2 * 50 + 1] = "solid facet";
    data[80] = 2;
    assert_string_equal(format_find(data, sizeof data - 1), "stl");
    memcpy(data, "v 0 0 0", 8);
    assert_string_equal(format_find(data, sizeof data - 1), "stl");
    assert_string_equal(format_find(data, sizeof data - 2), "obj");
    data[80] = 0;
    assert_string_equal(format_find(data, 84), "obj");
}
