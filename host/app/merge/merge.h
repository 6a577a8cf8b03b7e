/* Parts of a picture that become the picture of one run: `whit merge`. */
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
    struct merge_part *parts; /* owned; `count` of them, in their order from merge_check on */
    uint32_t count;
    uint32_t tiles, sets; /* of the picture; 1 where it was not divided in that way */
    bool ids;             /* hit identities, of the first samples alone */
    whit_stats stats;     /* the parts' counters as those of one picture */
    const whit_load_params *load;
};

/* Reads the recipes of `count` files. Errors were said, as in all of these. */
WHIT_CHECK whit_result merge_read(struct merge *merge, const char *const *paths, uint32_t count,
                                  const whit_load_params *load);
/* Whether they are of one picture, each there once; puts them in the order of tiles, and of
   samples in these. WHIT_ERROR_INPUT: says which is missing, doubled, or of another picture. */
WHIT_CHECK whit_result merge_check(struct merge *merge);
/* Writes the picture, tile after tile; no more than one of them, and sums of its samples, are in
   memory. `progress`: after each tile, with the share that is done. */
WHIT_CHECK whit_result merge_write(const struct merge *merge, const char *output,
                                   struct cli_progress *progress);
void merge_finish(struct merge *merge);

#endif
