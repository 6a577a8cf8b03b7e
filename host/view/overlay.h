/* Draws lines of the scene over the picture, between ui_begin and ui_end; only for perspective
   cameras. */
#ifndef VIEW_OVERLAY_H
#define VIEW_OVERLAY_H

#include <stdbool.h>
#include <stdint.h>

struct view;

bool overlay_is_possible(const struct view *view);
void overlay_line(const struct view *view, const double a[3], const double b[3], uint32_t color,
                  float width);
void overlay_boxes(const struct view *view);

#endif
