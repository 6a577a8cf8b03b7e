/* The mouse and held keys: cameras and time. */
#ifndef VIEW_INPUT_H
#define VIEW_INPUT_H

#include "view/events.h"

struct view;

enum { KEYS_MAX = 320 };

/* What keys that are held, and the mouse, are at. */
struct view_input {
    bool down[KEYS_MAX];
    bool buttons[3];
    double x, y, press_x, press_y; /* of the mouse; where its button went down */
    bool dragged;                  /* since the button went down */
    double step_ms;                /* when held keys were last obeyed */
};

void input_event(struct view *view, const struct view_event *event);
/* Obeys keys that are held, and the animation; true where something moves on by itself. */
bool input_step(struct view *view, double now_ms);

#endif
