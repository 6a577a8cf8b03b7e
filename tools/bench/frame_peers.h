/* Finds the programs on this machine that whit can be compared with. */
#ifndef BENCH_FRAME_PEERS_H
#define BENCH_FRAME_PEERS_H

#include "bench/frame.h"

/* The whit that --against names, or says that there is none. WHIT_ERROR_INPUT: it is no whit. */
WHIT_CHECK whit_result peers_find_against(struct peers *peers, struct table *table);
/* Looks who else is here, and says who is left out. */
void peers_find(struct peers *peers, struct table *table, bool wants_pov);

#endif
