/* The queues between the stages of a picture, for the tile being drawn (abi/queues.h). */
#ifndef RENDER_QUEUES_H
#define RENDER_QUEUES_H

#include "render/renderer.h"

/* Creates target->buffers.queues, for target->buffers.chunk_slots slots. */
WHIT_CHECK whit_result queues_create(struct target *target);
void queues_finish(struct queue_buffers *queues);
/* Makes room for more rays of a tile, if the device has it. Whatever is bound to the queues must
   then be bound anew. */
bool queues_can_grow(const struct target *target);
WHIT_CHECK whit_result queues_grow(struct target *target);

#endif
