/* Where samples are: one sequence of points. */
#ifndef PICTURE_SEQUENCE_H
#define PICTURE_SEQUENCE_H

#include <stdint.h>

enum { SEQUENCE_BITS = 12 }; /* of the index of a sample, below WHIT_SAMPLES_MAX */

/* Point `index` of the sequence, in the unit square, in 2^-32. */
void sequence_point(uint32_t index, uint32_t xy[2]);
/* Which point of it a sample of a pixel takes on the lens, and which run of `light_samples` points
   on flat emitters; in the pixel it takes that of its own index. */
uint32_t sequence_lens(uint32_t sample);
uint32_t sequence_light(uint32_t sample);

#endif
