#include "load/ply.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

static bool starts_with(const uint8_t *line, size_t bytes, const char *word)
{
    size_t length = strlen(word);
    return bytes >= length && memcmp(line, word, length) == 0;
}

/* Offset of the data behind the header of a PLY whose lines end in \n or \r\n; 0: there is none. */
static size_t find_data(const uint8_t *data, size_t size_bytes, bool *binary)
{
    enum { HEADER_LIMIT = 1 << 20 };
    size_t limit = size_bytes < HEADER_LIMIT ? size_bytes : HEADER_LIMIT;
    *binary = false;
    for (size_t at = 0; at < limit;) {
        const uint8_t *end = memchr(data + at, '\n', limit - at);
        if (!end)
            return 0;
        size_t bytes = (size_t)(end - (data + at));
        *binary = *binary || starts_with(data + at, bytes, "format binary");
        if (starts_with(data + at, bytes, "end_header"))
            return at + bytes + 1;
        at += bytes + 1;
    }
    return 0;
}

/* Removes lines that have only blanks. */
static void remove_blank_lines(uint8_t *data, size_t begin, size_t *size_bytes)
{
    size_t out = begin;
    for (size_t at = begin, next; at < *size_bytes; at = next) {
        const uint8_t *end = memchr(data + at, '\n', *size_bytes - at);
        next = end ? (size_t)(end - data) + 1 : *size_bytes;
        size_t first = at;
        while (first < next && data[first] <= ' ')
            ++first;
        if (first == next)
            continue;
        memmove(data + out, data + at, next - at);
        out += next - at;
    }
    data[out] = 0;
    *size_bytes = out;
}

bool ply_repair(uint8_t **data, size_t *size_bytes)
{
    bool binary;
    size_t at = find_data(*data, *size_bytes, &binary);
    if (at > 0 && !binary)
        remove_blank_lines(*data, at, size_bytes);
    if (!binary || at < 2 || at >= *size_bytes || (*data)[at - 2] == '\r' || (*data)[at] != '\n')
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
