#include "load/format.h"
#include "base/text.h"

#include <jansson.h>
#include <string.h>

/* HEAD_BYTES: how far the root of an XML file is looked for, behind its first line and comments. */
enum { HEAD_BYTES = 4096 };

static bool begins(const char *text, const char *word)
{
    return strncmp(text, word, strlen(word)) == 0;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Whether `word` is in the first HEAD_BYTES of data, which may hold zero bytes. */
static bool head_has(const uint8_t *data, size_t size_bytes, const char *word)
{
    size_t length = strlen(word), end = size_bytes < HEAD_BYTES ? size_bytes : HEAD_BYTES;
    for (size_t i = 0; i + length <= end; ++i)
        if (memcmp(data + i, word, length) == 0)
            return true;
    return false;
}

bool format_is_stl(const uint8_t *data, size_t size_bytes, uint32_t *count)
{
    *count = size_bytes < STL_HEADER_BYTES ? 0 : load_u32(data + STL_HEADER_BYTES - 4);
    return *count && size_bytes == STL_HEADER_BYTES + STL_TRIANGLE_BYTES * (uint64_t)*count;
}

/* Whether the outermost JSON object has the key "asset". It tells glTF, which requires it, from
   whit's scene files, which have no such key. A damaged text counts as glTF wherever it has it. */
static bool has_asset(const char *text)
{
    json_t *root = json_loads(text, 0, NULL);
    bool found = root ? json_object_get(root, "asset") != NULL : strstr(text, "\"asset\"") != NULL;
    json_decref(root);
    return found;
}

/* Whether the first line that is no comment begins with a keyword of OBJ. */
static bool is_obj(const char *text)
{
    static const char *const words[] = {"v", "vn", "vt",     "vp",     "f", "g",
                                        "o", "s",  "mtllib", "usemtl", "l", "p"};
    size_t count = sizeof words / sizeof *words, i = 0;
    while (is_blank(*text) || *text == '#')
        text += *text == '#' ? strcspn(text, "\n") : 1;
    size_t length = strcspn(text, " \t\r\n");
    while (i < count && (strlen(words[i]) != length || !begins(text, words[i])))
        i++;
    return i < count && is_blank(text[length]);
}

/* Whether the text begins with the keyword `OFF`, with or without prefix letters such as C and N,
   which say what each point has. */
static bool is_off(const char *text)
{
    text += strspn(text, "STCN4n");
    return begins(text, "OFF") && (is_blank(text[3]) || !text[3]);
}

const char *format_find(const uint8_t *data, size_t size_bytes)
{
    const char *text = (const char *)data;
    uint32_t triangles;
    if (begins(text, "glTF"))
        return "glb";
    if (begins(text, "PK\x03\x04"))
        return "3mf";
    if (begins(text, "Kaydara FBX Binary") || begins(text, "; FBX"))
        return "fbx";
    if (format_is_stl(data, size_bytes, &triangles))
        return "stl";
    text += text_mark_bytes(text);
    while (is_blank(*text))
        text++;
    if (*text == '{')
        return has_asset(text) ? "gltf" : "json";
    if (begins(text, "ply") && (text[3] == '\n' || text[3] == '\r'))
        return "ply";
    if (begins(text, "solid") && head_has(data, size_bytes, "facet"))
        return "stl";
    if (*text == '<' && head_has(data, size_bytes, "<COLLADA"))
        return "dae";
    return is_off(text) ? "off" : is_obj(text) ? "obj" : NULL;
}
