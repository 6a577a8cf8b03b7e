/* Recognizes a file's format by its bytes, for standard input, which has no name. */
#ifndef LOAD_FORMAT_H
#define LOAD_FORMAT_H

#include <stddef.h>
#include <stdint.h>

/* The extension of these bytes' format; NULL: unknown. data[size_bytes] must be a zero byte. */
const char *format_find(const uint8_t *data, size_t size_bytes);

#endif
