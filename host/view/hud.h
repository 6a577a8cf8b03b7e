/* Draws figures, the cheat sheet and messages over the picture. */
#ifndef VIEW_HUD_H
#define VIEW_HUD_H

struct view;

enum view_hud { HUD_OFF, HUD_SMALL, HUD_FULL, HUD_COUNT };
extern const char *const hud_names[HUD_COUNT];

/* Draws everything over the picture, between ui_begin and ui_end. */
void hud_draw(struct view *view);

enum { HUD_QUALITY_BYTES = 80 };
/* Writes how much of the picture is shown: "full size, 4 samples". */
void hud_quality(const struct view *view, char text[HUD_QUALITY_BYTES]);

#endif
