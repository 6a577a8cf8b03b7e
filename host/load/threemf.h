/* What assimp leaves out of a 3MF. */
#ifndef LOAD_THREEMF_H
#define LOAD_THREEMF_H

#include <stddef.h>
#include <stdint.h>

/* The length of the model's unit in metres; a millimetre, as the format says, where there is none
   or the package cannot be read. */
double threemf_unit_m(const uint8_t *data, size_t size_bytes);

#endif
