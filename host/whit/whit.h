/* libwhit: a Whitted ray tracer on Vulkan compute. This header is the whole public face; its
   parts are in the headers that it includes. See tests/example/example.c for a program that uses
   nothing else. C11 or C++11 is needed, or a later one.

   Scenes come from files (whit's own in JSON, glTF, OBJ and other models, see whit_scene_load), not
   from arrays in memory. They do not change once they are loaded; what renderers choose is the time
   of the animation, the camera and their params.

   Ownership: what a function creates, its destroy function ends; destroy accepts NULL. Handles
   borrow what they were made from: scene <- accel <- renderer -> device; destroy in reverse order.
   NULL params mean all defaults. Other pointers, handles included, are not NULL unless their
   comment allows it; a NULL path of a file to load or to write is WHIT_ERROR_USAGE. In params
   structs 0 means the default, except in whit_renderer_params: start that from
   whit_renderer_defaults(), because 0 bounces there means none and a bail-out of 0 traces every
   ray. Params are read during the call only. On failure an out parameter is NULL or untouched, the
   reason went to the log callback as one line (where the call or a handle has one; what a `cancel`
   flag ended may log nothing), and the result says which kind it was. Each function names the
   results that it may give beside WHIT_OK and WHIT_ERROR_MEMORY, which any of them may.

   Threads: different handles may be used from different threads; one handle from one at a time. An
   accel and all renderers and references made from it count as one handle, for its trees stand at
   one time of the animation and are moved to that of the renderer that needs them. Renderers of
   several accels may share a scene and a device. A `cancel` flag may be set from anywhere, a signal
   handler included. Callbacks return: an exception or longjmp that leaves one leaves locks held,
   that of messages among them, and the next call may wait forever. One for messages calls nothing
   that logs, as it would wait for itself.

   Where memory runs out calls give WHIT_ERROR_MEMORY. Compilers within drivers, such as the LLVM of
   lavapipe, may end the process instead, where it is they that run out.

   The program may have set any locale: numbers in files, and in texts about pictures and pixels,
   have a point; those in some messages have the program's sign.
   Threads that call the library round to nearest (fenv.h), as programs begin. Foreign files are
   read in child processes, which the library waits for; the program may ignore SIGCHLD, and wait
   for all children.

   fork(): in the child, the parent's devices and what was made from them can be neither used nor
   destroyed, since threads of their drivers are missing there. It creates its own, and ends by
   _exit(): handlers that drivers have set for exit() may wait for those threads. */
#ifndef WHIT_H
#define WHIT_H

#include "whit_accel.h"
#include "whit_compare.h"
#include "whit_device.h"
#include "whit_hard.h"
#include "whit_image.h"
#include "whit_probe.h"
#include "whit_reference.h"
#include "whit_refine.h"
#include "whit_renderer.h"
#include "whit_scene.h"
#include "whit_shader.h"

#define WHIT_VERSION "0.2.0"

WHIT_C_BEGIN

/* The WHIT_VERSION of the library that runs, for programs that load it without this header. Never
   NULL. */
const char *whit_version(void);

WHIT_C_END

#endif
