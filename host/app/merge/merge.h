/* Merges parts of a picture into the picture of a single run: `whit merge`. */
#ifndef APP_MERGE_MERGE_H
#define APP_MERGE_MERGE_H

#include "app/render/part.h"

/* A file with a part in it, and what its recipe says. */
struct merge_part {
    const char *path;
    whit_text *texts; /* owned */
    uint32_t text_count;
    struct part_place place;
};

struct merge {
    struct merge_part *parts; /* owned; sorted by merge_check */
    uint32_t count;
    uint32_t tiles, sets; /* of the picture; 1 where it was not divided in that way */
    bool ids;             /* the parts are hit identities, which only the first samples have */
    whit_stats stats;     /* the parts' counters as those of one picture */
    const whit_load_params *load;
};

/* Reads the recipes of `count` files. All functions here print their errors. */
WHIT_CHECK whit_result merge_read(struct merge *merge, const char *const *paths, uint32_t count,
                                  const whit_load_params *load);
/* Checks that the parts are all parts of one picture, each given once, and sorts them by tile, then
   by samples. WHIT_ERROR_INPUT, naming a part that is missing, given twice, or of another
   picture. */
WHIT_CHECK whit_result merge_check(struct merge *merge);
/* Writes the picture tile by tile; only one tile, with sums of its samples, is in memory.
   `progress` is updated after each tile. */
WHIT_CHECK whit_result merge_write(const struct merge *merge, const char *output,
                                   struct cli_progress *progress);
void merge_finish(struct merge *merge);

#endif
