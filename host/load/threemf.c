#define _GNU_SOURCE /* memmem */
#include "load/threemf.h"

#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "load/picture.h"

/* These are signatures, sizes and compression methods in a ZIP file: in its central directory, and
   in the local header in front of each entry. */
enum {
    ENTRY_MAGIC = 0x02014b50,
    ENTRY_BYTES = 46,
    LOCAL_MAGIC = 0x04034b50,
    LOCAL_BYTES = 30,
    STORED = 0,
    DEFLATED = 8,
    INFLATION_MAX = 1032, /* bytes that a byte of deflated data can stand for */
};

static uint32_t read_le(const uint8_t *at, int bytes)
{
    uint32_t value = 0;
    for (int i = bytes - 1; i >= 0; i--)
        value = value << 8 | at[i];
    return value;
}

/* Reads the file that a central directory's entry describes, as text to free(); NULL: it cannot be
   read, or memory ran out. */
static char *read_text(const uint8_t *data, size_t size_bytes, const uint8_t *entry)
{
    size_t local = read_le(entry + 42, 4), packed = read_le(entry + 20, 4);
    size_t size = read_le(entry + 24, 4);
    uint32_t method = read_le(entry + 10, 2);
    if (local > size_bytes || size_bytes - local < LOCAL_BYTES ||
        read_le(data + local, 4) != LOCAL_MAGIC || (method != STORED && method != DEFLATED))
        return NULL;
    size_t at = local + LOCAL_BYTES + read_le(data + local + 26, 2) + read_le(data + local + 28, 2);
    if (at > size_bytes || packed > size_bytes - at)
        return NULL;
    size_t most = method == STORED ? packed : packed * INFLATION_MAX;
    size = size < most ? size : most;
    char *text = size < INT_MAX ? array_alloc_zeroed(size + 1, 1) : NULL;
    if (text && method == STORED)
        memcpy(text, data + at, size);
    else if (text)
        picture_inflate(data + at, packed, text, (int)size);
    return text;
}

/* --- XML ------------------------------------------------------------------------------------ */

enum { VALUE_BYTES = 128 };

/* The value of an attribute of the tag at `tag`; a longer one is cut. False: it is not there. */
static bool attribute(const char *tag, const char *name, char value[VALUE_BYTES])
{
    size_t length = strlen(name);
    const char *end = tag + strcspn(tag, ">");
    for (const char *at = tag; (at = memmem(at, (size_t)(end - at), name, length)); at += length) {
        const char *equals = at + length + strspn(at + length, " \t\r\n");
        if (at > tag && (unsigned char)at[-1] <= ' ' && *equals == '=')
            return sscanf(equals + 1, " %*1[\"']%127[^\"'>]", value) == 1;
    }
    return false;
}

/* The same of a number; -1: it is not there. */
static int number(const char *tag, const char *name)
{
    char value[VALUE_BYTES];
    return attribute(tag, name, value) ? atoi(value) : -1;
}

static bool is_tag(const char *tag, const char *name)
{
    size_t length = strlen(name);
    return strncmp(tag + 1, name, length) == 0 && strchr(" \t\r\n>/", tag[1 + length]);
}

/* --- the model ------------------------------------------------------------------------------ */

static double unit_of(const char *head)
{
    static const struct {
        const char *name;
        double metres;
    } units[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
                 {"inch", 0.0254}, {"foot", 0.3048},     {"meter", 1}};
    const char *tag = strstr(head, "<model");
    char name[VALUE_BYTES] = "";
    if (tag)
        (void)attribute(tag, "unit", name);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].name, name) == 0)
            return units[i].metres;
    return 1e-3;
}

/* In XML any prefix may stand for the namespace of these lists. */
static uint32_t count_lists(const char *text, const char *name)
{
    uint32_t count = 0;
    while ((text = strstr(text, name))) {
        text++;
        count++;
    }
    return count;
}

/* An object while its tags are read. */
struct object {
    int id, pid, index; /* index: place of the material in the list `pid` */
    int first[2];       /* pid and index of the first material that is met */
    bool has_first, mixed;
};

struct lists {
    int ids[64];
    uint32_t count;
};

static bool is_material(const struct lists *lists, int id)
{
    bool found = false;
    for (uint32_t i = 0; i < lists->count; i++)
        found |= lists->ids[i] == id;
    return found;
}

/* assimp draws an object in its own material, or else in that of a triangle. */
static struct object begin_object(const char *tag, const struct lists *lists)
{
    struct object object = {
        .id = number(tag, "id"), .pid = number(tag, "pid"), .index = number(tag, "pindex")};
    object.first[0] = object.pid;
    object.first[1] = object.index;
    object.has_first = is_material(lists, object.pid);
    return object;
}

/* Colours and texture coordinates are no materials here: others tell of them. */
static void read_triangle(const char *tag, const struct lists *lists, struct object *object)
{
    int pid = number(tag, "pid"), index = number(tag, "p1");
    pid = pid < 0 ? object->pid : pid;
    index = index < 0 ? object->index : index;
    bool known = is_material(lists, pid);
    const int material[2] = {known ? pid : -1, known ? index : -1};
    if (object->has_first)
        object->mixed |= memcmp(material, object->first, sizeof material) != 0;
    else
        memcpy(object->first, material, sizeof material);
    object->has_first = true;
}

static void read_objects(const char *text, struct threemf_head *head)
{
    struct lists lists = {0};
    struct object object = {.id = -1};
    for (const char *tag = text; (tag = strchr(tag, '<')); tag++) {
        if (is_tag(tag, "triangle")) {
            read_triangle(tag, &lists, &object);
        } else if (is_tag(tag, "basematerials") && lists.count < 64) {
            lists.ids[lists.count++] = number(tag, "id");
        } else if (is_tag(tag, "object")) {
            object = begin_object(tag, &lists);
        } else if (is_tag(tag, "/object")) {
            head->mixed += object.mixed;
        } else if (is_tag(tag, "component") && object.id >= 0 &&
                   number(tag, "objectid") == object.id) {
            snprintf(head->refused, sizeof head->refused, "the object %d is a part of itself",
                     object.id);
        }
    }
}

/* Refuses extensions that a model requires, as the core specification demands, unless whit knows
   what it loses without them. */
static void check_extensions(const char *text, struct threemf_head *head)
{
    static const char *const known[] = {"/material/", "/production/", "/trianglesets/"};
    const char *tag = strstr(text, "<model");
    char prefixes[VALUE_BYTES] = "", *rest = NULL;
    for (const char *part = text; (part = strchr(part, '<')); part++)
        if ((is_tag(part, "component") || is_tag(part, "item")) &&
            memmem(part, strcspn(part, ">"), ":path=", 6))
            snprintf(
                head->refused, sizeof head->refused,
                "it has objects in several files (production extension), which whit does not read");
    if (!tag || !attribute(tag, "requiredextensions", prefixes))
        return;
    for (char *at = strtok_r(prefixes, " \t\r\n", &rest); at;
         at = strtok_r(NULL, " \t\r\n", &rest)) {
        char name[VALUE_BYTES + 8], space[VALUE_BYTES] = "";
        bool is_known = false;
        snprintf(name, sizeof name, "xmlns:%s", at);
        (void)attribute(tag, name, space);
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            is_known |= strstr(space, known[i]) != NULL;
        if (!is_known)
            snprintf(head->refused, sizeof head->refused,
                     "it requires the extension `%.20s` (%.80s), which whit does not read", at,
                     space);
    }
}

struct threemf_head threemf_read(const uint8_t *data, size_t size_bytes)
{
    struct threemf_head head = {.unit_m = 1e-3};
    bool found = false, is_zip = false;
    for (size_t at = 0; size_bytes >= ENTRY_BYTES && at <= size_bytes - ENTRY_BYTES; at++) {
        const uint8_t *entry = data + at;
        if (read_le(entry, 4) != ENTRY_MAGIC)
            continue;
        is_zip = true;
        size_t name_bytes = read_le(entry + 28, 2);
        bool model = name_bytes >= 6 && name_bytes <= size_bytes - at - ENTRY_BYTES &&
                     memcmp(entry + ENTRY_BYTES + name_bytes - 6, ".model", 6) == 0;
        char *text = model ? read_text(data, size_bytes, entry) : NULL;
        if (text && !found) {
            head.unit_m = unit_of(text);
            head.color_groups = count_lists(text, ":colorgroup ");
            head.composites =
                count_lists(text, ":compositematerials ") + count_lists(text, ":multiproperties ");
            read_objects(text, &head);
        }
        if (text)
            check_extensions(text, &head);
        found |= text != NULL;
        free(text);
    }
    if (!is_zip)
        snprintf(head.refused, sizeof head.refused, "it is no ZIP archive, as a 3MF is");
    return head;
}
