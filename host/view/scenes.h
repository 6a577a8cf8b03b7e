/* The scene that is shown, and the one that is asked for: its files, and its cameras. */
#ifndef VIEW_SCENES_H
#define VIEW_SCENES_H

#include "settings/settings.h"

struct view;

/* Another scene, as the file dropped on the window. Keeps all but camera and time, which stands. */
void view_open(struct view *view, const char *path);
void scenes_begin(struct view *view);
void scenes_end(struct view *view);
/* The new picture is of another scene. */
void scenes_show(struct view *view);
/* What is asked for failed: says so, once for one error, and goes back to what is shown. False
   where it is the shown scene that failed. */
bool scenes_refuse(struct view *view);
/* What was refused is no longer of interest. */
void scenes_forget(struct view *view);
/* The folder that the scene may read if the user says so; NULL: there is nothing to ask. */
const char *scenes_question(const struct view *view);
/* Ends the question; where `allow`, reads the scene again with that folder. */
void scenes_answer(struct view *view, bool allow);
/* Reads what was written. */
void scenes_watch(struct view *view);
/* Reads what was refused, else what is shown, again. */
void scenes_read_again(struct view *view);
/* The settings, unless they are of a scene that is not shown yet: then the last picture's. */
const struct settings *scenes_shown(const struct view *view);
/* Sets the camera of the scene with this index; -1: the text of the settings. */
void view_use_camera(struct view *view, int index);
/* The camera as numbers, of what the settings' text says. */
void view_learn_camera(struct view *view);

#endif
