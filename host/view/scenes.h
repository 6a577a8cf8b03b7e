/* The scene that is shown, and the one that is asked for: their files, and their cameras. */
#ifndef VIEW_SCENES_H
#define VIEW_SCENES_H

#include "settings/settings.h"

struct view;

/* Opens another scene, such as a file dropped on the window. Other settings than camera and time
   stay; animations stop. */
void view_open(struct view *view, const char *path);
/* Opens the scene that stands `by` places behind this one in its folder. */
void scenes_turn(struct view *view, int by);
void scenes_begin(struct view *view);
void scenes_end(struct view *view);
/* Call it when a new picture is the first of another scene. */
void scenes_show(struct view *view);
/* Call it when the request failed: shows the error, each one once, and goes back to the scene that
   is shown. False: it is the shown scene that failed. */
bool scenes_refuse(struct view *view);
/* Goes back to the scene that is shown. False: no other is asked for. */
bool scenes_stop(struct view *view);
/* Forgets the error of a refused scene, and stops watching its file. */
void scenes_forget(struct view *view);
/* The folder that the user has to be asked about, as the scene names a file in it; NULL: none. */
const char *scenes_question(const struct view *view);
/* Ends the question; with `allow` the scene is read again and may read that folder. */
void scenes_answer(struct view *view, bool allow);
/* Reads the scene again if one of its files was written. */
void scenes_watch(struct view *view);
/* Reads the refused scene again, or if there is none the shown one. */
void scenes_read_again(struct view *view);
/* The settings; but if their scene is not shown yet, those of the last picture. */
const struct settings *scenes_shown(const struct view *view);
/* Uses the camera of the scene with this index. */
void view_use_camera(struct view *view, int index);
/* Sets view->camera and view->file_camera by the camera text of the settings. */
void view_learn_camera(struct view *view);

#endif
