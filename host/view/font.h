/* The font of the window's text. */
#ifndef VIEW_FONT_H
#define VIEW_FONT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Finds a monospaced font of this system by fontconfig. *data: a TrueType file; free() it. False:
   there is none. */
bool font_load(uint8_t **data, size_t *size_bytes);

#endif
