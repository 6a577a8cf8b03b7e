/* The rays of a picture, for Embree. */
#ifndef BENCH_FRAME_RAYS_H
#define BENCH_FRAME_RAYS_H

#include "bench/frame.h"

/* The rays of the picture as files, and whit-embree on its triangles: for FRAME_EMBREE. */
WHIT_CHECK whit_result frame_prepare_rays(struct frame *frame);
/* Single rays; shadow rays from the end where Embree is quicker. */
WHIT_CHECK whit_result frame_trace_rays(struct frame *frame, double *ms);

#endif
