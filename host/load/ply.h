/* The bytes of a PLY before assimp sees them. */
#ifndef LOAD_PLY_H
#define LOAD_PLY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/whit_base.h"

/* assimp 5.2 takes blanks and line ends at the start of binary data (one file in fifty, as chance
   has it) for a part of the header. Such a file gets an element of one harmless byte in front.
   Replaces *data (malloc'ed); false when memory runs out, *data intact. */
WHIT_CHECK bool ply_repair(uint8_t **data, size_t *size_bytes);

#endif
