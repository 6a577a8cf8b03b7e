/* The places of samples: one sequence of points. */
#ifndef PICTURE_SEQUENCE_H
#define PICTURE_SEQUENCE_H

#include <stdint.h>

enum { SEQUENCE_BITS = 12 }; /* bits of the index of a sample, which is below WHIT_SAMPLES_MAX */

/* Point `index` of the sequence, in the unit square, in units of 2^-32. */
void sequence_point(uint32_t index, uint32_t xy[2]);
/* The index of the point that a sample of a pixel uses on the lens, and of the run of
   `light_samples` points that it uses on flat emitters. In the pixel it uses the point of its own
   index. */
uint32_t sequence_lens(uint32_t sample);
uint32_t sequence_light(uint32_t sample);

#endif
