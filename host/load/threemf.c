#include "load/threemf.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

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
    HEAD_BYTES = 16384, /* bytes of the model file that are read */
};

static uint32_t read_le(const uint8_t *at, int bytes)
{
    uint32_t value = 0;
    for (int i = bytes - 1; i >= 0; i--)
        value = value << 8 | at[i];
    return value;
}

/* Reads the first bytes of the file that a central directory's entry describes, as text. */
static bool read_head(const uint8_t *data, size_t size_bytes, const uint8_t *entry,
                      char head[HEAD_BYTES])
{
    size_t local = read_le(entry + 42, 4), packed = read_le(entry + 20, 4);
    uint32_t method = read_le(entry + 10, 2);
    if (local > size_bytes || size_bytes - local < LOCAL_BYTES ||
        read_le(data + local, 4) != LOCAL_MAGIC)
        return false;
    size_t at = local + LOCAL_BYTES + read_le(data + local + 26, 2) + read_le(data + local + 28, 2);
    if (at > size_bytes || packed > size_bytes - at)
        return false;
    memset(head, 0, HEAD_BYTES);
    if (method == STORED)
        memcpy(head, data + at, packed < HEAD_BYTES ? packed : HEAD_BYTES - 1);
    else if (method == DEFLATED)
        picture_inflate(data + at, packed, head, HEAD_BYTES - 1);
    return true;
}

static double unit_of(const char *head)
{
    static const struct {
        const char *name;
        double metres;
    } units[] = {{"micron", 1e-6}, {"millimeter", 1e-3}, {"centimeter", 1e-2},
                 {"inch", 0.0254}, {"foot", 0.3048},     {"meter", 1}};
    const char *tag = strstr(head, "<model"), *end = tag ? strchr(tag, '>') : NULL;
    const char *unit = tag ? strstr(tag, "unit=") : NULL;
    char name[16] = "";
    if (unit && end && unit < end)
        sscanf(unit + 5, "%*1[\"']%15[a-z]", name);
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].name, name) == 0)
            return units[i].metres;
    return 1e-3;
}

/* In XML any prefix may stand for the namespace of colour groups. */
static uint32_t count_groups(const char *head)
{
    uint32_t count = 0;
    while ((head = strstr(head, ":colorgroup "))) {
        head++;
        count++;
    }
    return count;
}

struct threemf_head threemf_read(const uint8_t *data, size_t size_bytes)
{
    char head[HEAD_BYTES];
    for (size_t at = 0; size_bytes >= ENTRY_BYTES && at <= size_bytes - ENTRY_BYTES; at++) {
        const uint8_t *entry = data + at;
        if (read_le(entry, 4) != ENTRY_MAGIC)
            continue;
        size_t name_bytes = read_le(entry + 28, 2);
        bool model = name_bytes >= 6 && name_bytes <= size_bytes - at - ENTRY_BYTES &&
                     memcmp(entry + ENTRY_BYTES + name_bytes - 6, ".model", 6) == 0;
        if (model && read_head(data, size_bytes, entry, head))
            return (struct threemf_head){unit_of(head), count_groups(head)};
    }
    return (struct threemf_head){.unit_m = 1e-3};
}
