/* Draws with general kernels while a thread compiles the specialised ones. */
#ifndef RENDER_ASYNC_H
#define RENDER_ASYNC_H

#include "render/renderer.h"

/* Makes renderer->picture.stages the best kernels that are ready: at first the general ones, while
   a thread compiles the specialised ones, and in some later call those. The thread logs when it
   fails; the general kernels then stay. */
WHIT_CHECK whit_result async_prepare(struct renderer *renderer);
/* Waits for the thread, and drops its kernels. */
void async_finish(struct renderer *renderer);

#endif
