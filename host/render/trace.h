/* Traces batches of rays. */
#ifndef RENDER_TRACE_H
#define RENDER_TRACE_H

#include "render/renderer.h"

void trace_finish(struct trace_state *trace);

#endif
