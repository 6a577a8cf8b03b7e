#include "load/ply.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

static const char pad_element[] = "element whit_pad 1\nproperty uchar whit_pad\n";

struct header {
    size_t element; /* offset of the first `element` line */
    size_t end;     /* offset of the data */
    bool binary;
};

static bool starts_with(const uint8_t *line, size_t bytes, const char *word)
{
    size_t length = strlen(word);
    return bytes >= length && memcmp(line, word, length) == 0;
}

/* False when there is no header, or one longer than headers are. */
static bool find_header(const uint8_t *data, size_t size_bytes, struct header *out)
{
    enum { HEADER_LIMIT = 1 << 20 };
    size_t limit = size_bytes < HEADER_LIMIT ? size_bytes : HEADER_LIMIT;
    *out = (struct header){0};
    for (size_t at = 0; at < limit;) {
        const uint8_t *end = memchr(data + at, '\n', limit - at);
        if (!end)
            return false;
        size_t bytes = (size_t)(end - (data + at));
        if (starts_with(data + at, bytes, "format binary"))
            out->binary = true;
        if (!out->element && starts_with(data + at, bytes, "element "))
            out->element = at;
        size_t next = at + bytes + 1;
        if (starts_with(data + at, bytes, "end_header")) {
            out->end = next;
            return out->element > 0;
        }
        at = next;
    }
    return false;
}

bool ply_repair(uint8_t **data, size_t *size_bytes)
{
    struct header header;
    if (!find_header(*data, *size_bytes, &header) || !header.binary || header.end >= *size_bytes)
        return true;
    uint8_t first = (*data)[header.end];
    if (first != '\n' && first != '\r' && first != ' ' && first != '\t')
        return true;
    size_t pad = sizeof pad_element - 1, rest = *size_bytes - header.end;
    uint8_t *out = array_alloc(*size_bytes + pad + 2, 1), *to = out;
    if (!out)
        return false;
    memcpy(to, *data, header.element);
    to += header.element;
    memcpy(to, pad_element, pad);
    to += pad;
    memcpy(to, *data + header.element, header.end - header.element);
    to += header.end - header.element;
    *to++ = 1;
    memcpy(to, *data + header.end, rest);
    to[rest] = 0;
    free(*data);
    *data = out;
    *size_bytes += pad + 1;
    return true;
}
