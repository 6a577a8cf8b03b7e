/* Pictures by a general kernel while the specialised one is compiled. */
#ifndef RENDER_ASYNC_H
#define RENDER_ASYNC_H

#include "render/renderer.h"

/* renderer->picture.stages are the best kernels that there are without waiting for them:
   at first the general one, while a thread compiles the specialised one, and from some later call
   on that. The thread logs when it fails; the general kernel then stays. */
WHIT_CHECK whit_result async_prepare(struct renderer *renderer);
/* Waits for the thread. */
void async_finish(struct renderer *renderer);

#endif
