/* The bytes of a PLY before assimp sees them. */
#ifndef LOAD_PLY_H
#define LOAD_PLY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* assimp reads on for ever behind a header that does not end, and believes counts. Logs, with the
   line, what is wrong with them: an element takes a byte at least. */
WHIT_CHECK whit_result ply_check(const whit_log *log, const char *path, const uint8_t *data,
                                 size_t size_bytes);
/* Makes faces of triangle strips. After ply_check; replaces *data (malloc'ed, with a zero byte
   behind it, as what comes in its place). Strips that are damaged are logged. */
WHIT_CHECK whit_result ply_replace_strips(const whit_log *log, const char *path, uint8_t **data,
                                          size_t *size_bytes);
/* assimp 5.2 takes a first data byte of 10 (one binary file in 256, as chance has it) for the end
   of the header's last line. Such a file gets a second one. Replaces *data (malloc'ed); false when
   memory runs out, *data intact. */
WHIT_CHECK bool ply_repair(uint8_t **data, size_t *size_bytes);

#endif
