/* Draws figures, the cheat sheet and messages over the picture. */
#ifndef VIEW_HUD_H
#define VIEW_HUD_H

struct view;

enum view_hud { HUD_OFF, HUD_SMALL, HUD_FULL, HUD_COUNT };

/* Draws everything over the picture, between ui_begin and ui_end. */
void hud_draw(struct view *view);

#endif
