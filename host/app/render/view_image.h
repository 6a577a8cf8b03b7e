/* Pictures of what traversals cost: `whit render --view`, `--counters`. */
#ifndef APP_RENDER_VIEW_IMAGE_H
#define APP_RENDER_VIEW_IMAGE_H

#include "app/cli.h"

struct json_t;

/* The mean, the largest value and the scale of a picture of costs. */
struct view_figures {
    double mean, max, scale; /* over pixels; scale: of the heat map, used or not */
};

/* True for files that get colours in place of numbers. */
bool view_is_png(const char *path);

/* The numbers of the picture just rendered: as a heat map with legend for a .png, as they are for
   other files. */
WHIT_CHECK whit_result view_image(whit_renderer *renderer, const struct settings *settings,
                                  const char *output, struct view_figures *figures,
                                  whit_image **out);

#endif
