/* The bytes of a PLY before assimp sees them. */
#ifndef LOAD_PLY_H
#define LOAD_PLY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/whit_base.h"

/* assimp 5.2 takes a first data byte of 10 (one binary file in 256, as chance has it) for the end
   of the header's last line. Such a file gets a second one. Replaces *data (malloc'ed); false when
   memory runs out, *data intact. */
WHIT_CHECK bool ply_repair(uint8_t **data, size_t *size_bytes);

#endif
