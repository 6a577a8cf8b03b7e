/* The unit of a 3MF, which assimp does not import. */
#ifndef LOAD_THREEMF_H
#define LOAD_THREEMF_H

#include <stddef.h>
#include <stdint.h>

/* The model's unit in metres. A millimetre, the format's default, where the model states none or
   the package cannot be read. */
double threemf_unit_m(const uint8_t *data, size_t size_bytes);

#endif
