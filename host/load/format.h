/* What kind of file bytes are, where there is no name to tell it. */
#ifndef LOAD_FORMAT_H
#define LOAD_FORMAT_H

#include <stddef.h>
#include <stdint.h>

/* The extension that a file of these bytes would have, or NULL. There is one zero byte behind
   `size_bytes`. */
const char *format_find(const uint8_t *data, size_t size_bytes);

#endif
