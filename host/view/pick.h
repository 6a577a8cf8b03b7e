/* A pixel: what is there, and the rays that made its colour. */
#ifndef VIEW_PICK_H
#define VIEW_PICK_H

struct view;

/* The pixel at a place of the window. */
void pick_at(struct view *view, double x, double y);
/* Looks at what is under the mouse. */
void pick_focus(struct view *view);
/* What came of it. */
void pick_take(struct view *view);
/* The panel, and the pixel's rays in the scene. */
void pick_draw(struct view *view);

#endif
