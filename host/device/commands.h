/* A command buffer with its fence and timestamps: begin, record, submit, wait, and again. */
#ifndef DEVICE_COMMANDS_H
#define DEVICE_COMMANDS_H

#include "device/device.h"

WHIT_CHECK whit_result commands_create(struct device *device, const char *name,
                                       struct commands **out);
void commands_destroy(struct commands *commands); /* waits first */
WHIT_CHECK whit_result commands_begin(struct commands *commands);
void commands_bind(struct commands *commands, struct pipeline *pipeline, struct binding_set *set);
void commands_push(struct commands *commands, const void *data, uint32_t size_bytes);
void commands_dispatch(struct commands *commands, uint32_t groups_x, uint32_t groups_y,
                       uint32_t groups_z);
void commands_dispatch_indirect(struct commands *commands, struct buffer *buffer,
                                uint64_t offset_bytes);
/* Makes all earlier writes visible to all later accesses by shaders, transfers, indirect dispatches
   and the host. */
void commands_barrier(struct commands *commands);
void commands_fill(struct commands *commands, struct buffer *buffer, uint64_t offset_bytes,
                   uint64_t size_bytes, uint32_t word);
void commands_copy(struct commands *commands, struct buffer *from, uint64_t from_offset_bytes,
                   struct buffer *to, uint64_t to_offset_bytes, uint64_t size_bytes);
/* A labelled span of commands whose device time is measured; at most COMMANDS_SPANS in one
   recording, not nested. */
enum { COMMANDS_SPANS = 256 };
void commands_span_begin(struct commands *commands, const char *label);
void commands_span_end(struct commands *commands);
/* Returns the first error of the recording, such as out of memory, without submitting. */
WHIT_CHECK whit_result commands_submit(struct commands *commands);
/* commands_submit, then commands_wait without a limit. */
WHIT_CHECK whit_result commands_run(struct commands *commands);
/* Waits up to `timeout_ms` (< 0: for ever). After WHIT_ERROR_TIME_LIMIT the submission is still in
   flight. */
WHIT_CHECK whit_result commands_wait(struct commands *commands, double timeout_ms);
/* Device time of span number `span` of the last finished submission; < 0 without timestamps. */
double commands_span_ms(const struct commands *commands, uint32_t span);
uint32_t commands_span_count(const struct commands *commands);

#endif
