// Functions that ui.cpp, ui_widgets.cpp and ui_plots.cpp share.
#ifndef VIEW_UI_INSIDE_HPP
#define VIEW_UI_INSIDE_HPP

#include "view/ui.h"

extern float line_scale; // pixels in a unit of length on the screen

float panel_width(); // most width of a panel, pixels

// Call it while a list of choices is open. True: it has to be closed.
bool note_menu();

// Lets ui_item find the last item, or this position, by its label.
void note_item(const char *label);
void note_place(const char *label, float x, float y);

#endif
