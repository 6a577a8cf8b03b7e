/* A pixel that is clicked on: the hit there, and the rays that made its colour. */
#ifndef VIEW_PICK_H
#define VIEW_PICK_H

struct view;

/* Asks for the pixel at (x, y) of the window. */
void pick_at(struct view *view, double x, double y);
/* Frames what is under the mouse. */
void pick_focus(struct view *view);
/* Takes a finished probe from the engine. */
void pick_take(struct view *view);
/* Draws the panel, and the pixel's rays in the scene. */
void pick_draw(struct view *view);

#endif
