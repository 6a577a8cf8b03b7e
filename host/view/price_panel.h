/* The price list of this view, beside each switch. */
#ifndef VIEW_PRICE_PANEL_H
#define VIEW_PRICE_PANEL_H

struct prices;
struct view;

/* The prices of this view, asked for or no more. */
void price_switch(struct view *view);
void price_draw(struct view *view);
/* Stops it; it goes once it is at its end, which nobody waits for. NULL is fine. */
void prices_leave(struct view *view, struct prices *prices);
/* Lets those go that are at their end by now. */
void prices_part(struct view *view);

#endif
