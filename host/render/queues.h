/* What the stages of a picture leave to each other, of one tile (abi/queues.h). */
#ifndef RENDER_QUEUES_H
#define RENDER_QUEUES_H

#include "render/renderer.h"

/* target->buffers.queues, of target->buffers.chunk_slots slots. */
WHIT_CHECK whit_result queues_create(struct target *target);
void queues_finish(struct queue_buffers *queues);
/* Room for more rays of a tile, where the device has it. What is bound to the queues must be bound
   anew. */
bool queues_can_grow(const struct target *target);
WHIT_CHECK whit_result queues_grow(struct target *target);

#endif
