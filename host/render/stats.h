/* The figures of a picture. */
#ifndef RENDER_STATS_H
#define RENDER_STATS_H

#include "render/renderer.h"

/* Forgets the last picture, and keeps what was measured before it. */
void stats_clear(struct target *target);

#endif
