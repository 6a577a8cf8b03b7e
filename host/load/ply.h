/* Checks and repairs the bytes of a PLY, before assimp gets them. */
#ifndef LOAD_PLY_H
#define LOAD_PLY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* Checks that the header ends, and that its counts of elements are no larger than the data's size
   in bytes: assimp would read on for ever, and trusts counts. Logs an error with its line. */
WHIT_CHECK whit_result ply_check(const whit_log *log, const char *path, const uint8_t *data,
                                 size_t size_bytes);
/* assimp 5.2 mistakes a first data byte of 10, as in one binary file of 256, for the end of the
   header's last line: adds one more such byte there. It also loses an element for each blank line
   between elements of an ASCII file: removes these lines. Replaces *data (malloc'ed, with a zero
   byte behind it). False when memory runs out; *data is then intact. */
WHIT_CHECK bool ply_repair(uint8_t **data, size_t *size_bytes);

#endif
