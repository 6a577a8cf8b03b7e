/* Pictures of what traversals cost: `whit render --view`, `--counters`. */
#ifndef APP_VIEW_IMAGE_H
#define APP_VIEW_IMAGE_H

#include "app/cli.h"

struct json_t;

struct cost_view {
    bool given;
    uint32_t view; /* whit_view */
    uint32_t rays; /* whit_ray_kind; WHIT_RAY_KINDS: all */
    double scale;  /* of the heat map; 0: automatic */
    bool has_rays, has_scale;
};

/* Values of --view, --view-rays and --view-scale; on nonsense they are refused. */
void view_read(struct cli_reader *reader, struct cost_view *view);
void view_read_rays(struct cli_reader *reader, struct cost_view *view);
void view_read_scale(struct cli_reader *reader, struct cost_view *view);
/* Whether the three go together. */
bool view_check(struct cli_reader *reader, const struct cost_view *view);

const char *view_name(const struct cost_view *view);
const char *view_rays_name(const struct cost_view *view);

/* What a picture says about its numbers. */
struct view_figures {
    double mean, most, scale; /* over pixels; scale: of the heat map, used or not */
};

/* True for files that get colours in place of numbers. */
bool view_is_png(const char *path);

/* The numbers of the picture just rendered: as a heat map with legend for a .png, as they are for
   other files. */
WHIT_CHECK whit_result view_image(whit_renderer *renderer, const struct cost_view *view,
                                  const char *output, struct view_figures *figures,
                                  whit_image **out);

/* The costs of a picture by kind of ray: a table on standard output, and JSON. Kinds without rays
   are left out of the table. */
void costs_print(const whit_stats *stats);
struct json_t *costs_document(const whit_stats *stats);

#endif
