/* Remembers the cameras of scenes that were viewed, in cameras.json of the user's state folder:
   $XDG_STATE_HOME/whit or ~/.local/state/whit. */
#ifndef VIEW_REMEMBERED_CAMERAS_H
#define VIEW_REMEMBERED_CAMERAS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/log.h"

/* Finds the camera that was kept for this scene file, as text for --camera; false: there is
   none. */
bool memory_find(const char *scene, char *camera, size_t camera_bytes);
/* Keeps a camera; "": forgets it. The last 200 scenes are kept. Errors are only warned about. */
void memory_keep(const whit_log *log, const char *scene, const char *camera);

#endif
