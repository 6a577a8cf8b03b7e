/* Cameras of scenes that were looked at, in the user's state folder: $XDG_STATE_HOME/whit or
   ~/.local/state/whit, cameras.json. */
#ifndef VIEW_REMEMBERED_CAMERAS_H
#define VIEW_REMEMBERED_CAMERAS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/log.h"

/* The text of --camera that was kept for this scene file; false: none. */
bool memory_find(const char *scene, char *camera, size_t camera_bytes);
/* Keeps it; "": forgets it. The last 200 scenes are kept. What goes wrong is a warning. */
void memory_keep(const whit_log *log, const char *scene, const char *camera);

#endif
