/* The font of the window's text. */
#ifndef VIEW_FONT_H
#define VIEW_FONT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Letters of one width, as this system has them, by fontconfig: *data is a TrueType file, for
   free(). False: there is none. */
bool font_load(uint8_t **data, size_t *size_bytes);

#endif
