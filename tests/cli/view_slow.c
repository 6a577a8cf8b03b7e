/* Replaces some calls of whit (--wrap), so that work that takes long without trees takes as long as
   a test needs, on any machine. WHIT_TEST_SLOW names the work:
   kernel    a kernel without trees is never done: it waits until nobody wants it any more
   driver    nor is it then, as inside a driver that takes long to compile
   picture   so does a picture of more than 1024 pixels, behind its first part
   told      pictures are said to have taken 1e7 ms */
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../wrapped.h"
#include "accel/accel.h"
#include "api/handles.h"

enum { SMALL_PIXELS = 1024, SMALL_TILE = 16 };

static whit_renderer_params asked; /* params of the renderer without trees */
static uint64_t pixels;            /* number of pixels that a window asked it for; 0: none yet */

static const char *slow(void)
{
    const char *what = getenv("WHIT_TEST_SLOW");
    return what ? what : "";
}

static void wait_until_cancelled(void)
{
    while (!*asked.cancel || strcmp(slow(), "driver") == 0)
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

static void note_part(void *user, double done)
{
    asked.progress(user, done);
    if (pixels > SMALL_PIXELS)
        wait_until_cancelled();
}

WRAPPED(whit_result, whit_renderer_create, whit_device *device, whit_accel *accel,
        const whit_renderer_params *params, whit_renderer **out)
{
    if (!accel->accel->no_trees)
        return __real_whit_renderer_create(device, accel, params, out);
    whit_renderer_params own = asked = *params;
    if (strcmp(slow(), "kernel") == 0 || strcmp(slow(), "driver") == 0)
        wait_until_cancelled();
    if (strcmp(slow(), "picture") == 0) {
        own.tile_size = SMALL_TILE;
        own.progress = note_part;
    }
    return __real_whit_renderer_create(device, accel, &own, out);
}

WRAPPED(whit_result, whit_renderer_set_view, whit_renderer *renderer,
        const whit_renderer_params *params)
{
    if (renderer->accel->no_trees)
        pixels = (uint64_t)params->width * params->height;
    return __real_whit_renderer_set_view(renderer, params);
}

WRAPPED(void, whit_renderer_get_stats, const whit_renderer *renderer, whit_stats *out)
{
    __real_whit_renderer_get_stats(renderer, out);
    if (strcmp(slow(), "told") == 0)
        out->render_ms = 1e7;
}
