/* Standard input: it is read once, to its end, and kept for later reads. */
#ifndef BASE_INPUT_H
#define BASE_INPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/log.h"

/* Whether a path that the user gave stands for standard input. */
static inline bool is_input(const char *path)
{
    return path[0] == '-' && !path[1];
}

/* Longer input is refused. */
#define INPUT_BYTES_MAX ((size_t)256 << 20)

/* *data stays valid until the process ends, with one zero byte behind its size. The first call,
   from whichever thread, reads; if it fails, later calls fail too. WHIT_ERROR_INPUT, logged:
   standard input is a terminal, is empty, or is too long. */
WHIT_CHECK whit_result input_read(const whit_log *log, const uint8_t **data, size_t *size_bytes);

#endif
