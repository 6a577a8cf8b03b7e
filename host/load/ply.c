#include "load/ply.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

static bool starts_with(const uint8_t *line, size_t bytes, const char *word)
{
    size_t length = strlen(word);
    return bytes >= length && memcmp(line, word, length) == 0;
}

/* Offset of the data behind a header of plain lines; 0: an ASCII file, or none that needs care. */
static size_t find_data(const uint8_t *data, size_t size_bytes)
{
    enum { HEADER_LIMIT = 1 << 20 };
    size_t limit = size_bytes < HEADER_LIMIT ? size_bytes : HEADER_LIMIT;
    bool binary = false;
    for (size_t at = 0; at < limit;) {
        const uint8_t *end = memchr(data + at, '\n', limit - at);
        if (!end)
            return 0;
        size_t bytes = (size_t)(end - (data + at));
        binary = binary || starts_with(data + at, bytes, "format binary");
        if (starts_with(data + at, bytes, "end_header"))
            return binary && end[-1] != '\r' ? at + bytes + 1 : 0;
        at += bytes + 1;
    }
    return 0;
}

bool ply_repair(uint8_t **data, size_t *size_bytes)
{
    size_t at = find_data(*data, *size_bytes);
    if (at == 0 || at >= *size_bytes || (*data)[at] != '\n')
        return true;
    uint8_t *out = array_alloc(*size_bytes + 2, 1);
    if (!out)
        return false;
    memcpy(out, *data, at);
    out[at] = '\n';
    memcpy(out + at + 1, *data + at, *size_bytes - at + 1);
    free(*data);
    *data = out;
    *size_bytes += 1;
    return true;
}
