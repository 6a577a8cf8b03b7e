/* One set of rays in one order. */
#ifndef BENCH_RAYS_BATCH_H
#define BENCH_RAYS_BATCH_H

#include "bench/rays.h"

/* Makes the rays, in tiles of 8x8 pixels or shuffled, and writes their file; times all sides and
   compares their hits. With --keep the files stay. */
WHIT_CHECK whit_result batch_run(struct model *model, struct batch *batch, enum rays_kind kind,
                                 bool shuffled, struct agreement agreement[PEER_KINDS]);
/* Counts what the rays of the last batch visit. */
WHIT_CHECK whit_result batch_count(struct model *model, struct visits *visits);
/* Embree traces shadow rays in both directions: gives the times of the faster one. */
const struct sample_runs *batch_quicker(const struct batch *batch, enum rays_side side);

#endif
