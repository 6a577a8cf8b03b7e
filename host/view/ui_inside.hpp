// Functions that ui.cpp, ui_widgets.cpp and ui_plots.cpp share.
#ifndef VIEW_UI_INSIDE_HPP
#define VIEW_UI_INSIDE_HPP

#include "view/ui.h"

extern float line_scale; // pixels a unit of lengths on the screen

float panel_width(); // at most, pixels

// A list of choices is open. Whether it is to be closed.
bool note_menu();

// The last item is found under its label by ui_item; or what is at this place.
void note_item(const char *label);
void note_place(const char *label, float x, float y);

#endif
