/* The price list: what each setting would cost in this view. */
#ifndef VIEW_PRICE_PANEL_H
#define VIEW_PRICE_PANEL_H

struct prices;
struct view;

/* Opens the price list of this view, which starts measuring, or closes it. */
void price_switch(struct view *view);
void price_draw(struct view *view);
/* Tells a measurement to stop without waiting for it, and sets *prices to NULL: prices_part frees
   it once its thread has ended. NULL is fine. */
void prices_leave(struct view *view, struct prices **prices);
/* Frees the measurements that were told to stop and whose threads have ended. */
void prices_part(struct view *view);

#endif
