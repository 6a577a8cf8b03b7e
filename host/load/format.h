/* Recognizes a file's format by its bytes, for standard input, which has no name. */
#ifndef LOAD_FORMAT_H
#define LOAD_FORMAT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

static inline uint32_t load_u32(const uint8_t *at)
{
    return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

/* Sizes in a binary STL, whose header ends with its number of triangles. */
enum { STL_HEADER_BYTES = 84, STL_TRIANGLE_BYTES = 50 };
/* A binary STL has no magic number: it is recognised by its size, which fits that number, *count.
   That is 0 in a shorter file. */
bool format_is_stl(const uint8_t *data, size_t size_bytes, uint32_t *count);

/* The extension of these bytes' format; NULL: unknown. data[size_bytes] must be a zero byte. */
const char *format_find(const uint8_t *data, size_t size_bytes);

#endif
