/* Repairs the bytes of a PLY, before assimp gets them. */
#ifndef LOAD_PLY_H
#define LOAD_PLY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* assimp 5.2 mistakes a first data byte of 10, as in one binary file of 256, for the end of the
   header's last line: adds one more such byte there. It also loses an element for each blank line
   between elements of an ASCII file: removes these lines. Replaces *data (malloc'ed, with a zero
   byte behind it). False when memory runs out; *data is then intact. */
WHIT_CHECK bool ply_repair(uint8_t **data, size_t *size_bytes);

#endif
