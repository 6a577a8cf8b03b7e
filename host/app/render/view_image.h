/* Pictures of what traversals cost: `whit render --view`, `--counters`. */
#ifndef APP_RENDER_VIEW_IMAGE_H
#define APP_RENDER_VIEW_IMAGE_H

#include "app/cli.h"

/* The mean, the largest value and the scale of a picture of costs. */
struct view_figures {
    double mean, max, scale; /* mean and max over pixels; scale of the heat map, whether or not one
                                is drawn */
};

/* The cost image of the picture just rendered: as a heat map with a legend for a .png, as numbers
   for other files. */
WHIT_CHECK whit_result view_image(whit_renderer *renderer, const struct settings *settings,
                                  const char *output, struct view_figures *figures,
                                  whit_image **out);

#endif
