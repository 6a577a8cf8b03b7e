/* Finds the programs on this machine that whit can be compared with. */
#ifndef BENCH_FRAME_PEERS_H
#define BENCH_FRAME_PEERS_H

#include "bench/frame.h"

/* Finds the program of --against, or says in the table that none was given. WHIT_ERROR_INPUT: it is
   not whit. */
WHIT_CHECK whit_result peers_find_against(struct peers *peers, struct table *table);
/* Finds the other programs on this machine, and says in the table which are left out. */
void peers_find(struct peers *peers, struct table *table, bool wants_pov);

#endif
