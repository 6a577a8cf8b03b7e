/* Makes the entry of a golden file from a picture that was drawn. */
#ifndef APP_CHECK_DESCRIBE_H
#define APP_CHECK_DESCRIBE_H

#include "app/check/draw.h"

/* Hashes of colours, or whatever is painted in floats, and of hit identities. Devices give NaN any
   sign and any bits: it counts as one value. */
uint64_t drawing_hash_floats(const whit_image *image);
uint64_t drawing_hash_ids(const whit_image *image);

/* Makes the golden of one drawing; its name is the case's. *found gets the keys of parts too, as
   the parts of a golden with that one case. WHIT_ERROR_MEMORY, said. */
WHIT_CHECK whit_result drawing_describe(const struct drawing *drawing,
                                        const struct check_case *item, struct golden *found);

#endif
