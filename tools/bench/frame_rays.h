/* The rays of a picture, for Embree. */
#ifndef BENCH_FRAME_RAYS_H
#define BENCH_FRAME_RAYS_H

#include "bench/frame.h"

/* For FRAME_EMBREE: writes the picture's rays to files, and starts whit-embree on its triangles. */
WHIT_CHECK whit_result frame_prepare_rays(struct frame *frame);
/* Times Embree on these rays, one at a time; shadow rays start from the end where Embree is
   faster. */
WHIT_CHECK whit_result frame_trace_rays(struct frame *frame, double *ms);

#endif
