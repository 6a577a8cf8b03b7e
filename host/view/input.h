/* The mouse and held keys, which move the camera; playing animations. */
#ifndef VIEW_INPUT_H
#define VIEW_INPUT_H

#include "view/events.h"

struct view;

enum { KEYS_MAX = KEY_ALT + 1 };

/* State of the mouse and of held keys. */
struct view_input {
    bool down[KEYS_MAX];
    bool buttons[3];
    double x, y, press_x, press_y; /* mouse position; where its button went down */
    bool dragged;                  /* the mouse has moved since then: it is no click */
    double step_ms;                /* time of the last input_step */
};

void input_event(struct view *view, const struct view_event *event);
/* Moves the camera by held keys, and the animation; true: something moves on by itself. */
bool input_step(struct view *view, double now_ms);

#endif
